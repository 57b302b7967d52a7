//! What experiments that follow runs share: a run to its end, wherever that is, its attitude error, and the figure.

use std::fmt;

use polhode::body::{Point, Problem};
use polhode::method::Claimed;
use polhode::num::Dd;
use polhode::rotation::rotation_angle;
use polhode::run::{Run, RunError, Sample, Schedule};
use polhode_files::error::{Error, unexpected};
use polhode_pages::figure::Drawing;
use polhode_pages::figure::{Group, RowPlot, Values};
use polhode_pages::table::{Cell, Column, Table};

use crate::measured::LOST;

/// Looks at the energy for its secular slope.
const LOOKS: u64 = 512;

/// Of those, one in so many at the attitude, to see when it is lost.
const ATTITUDE_EVERY: usize = 8;

/// What was seen of a run.
pub(super) struct Followed {
    /// The last finite sample.
    pub(super) last: Sample,
    /// How it ended.
    pub(super) ending: Ending,
    /// Attitude error of the last sample, rad; `None` without a closed form, where it is lost, and of a run that failed.
    pub(super) attitude_error: Option<f64>,
    /// Times of the looks, s.
    pub(super) times: Vec<f64>,
    /// Relative changes of the energy at these times.
    pub(super) energy_changes: Vec<f64>,
}

/// How a run ended.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Ending {
    /// With an attitude that is known.
    Held,
    /// With one that was first seen to be more than a radian off at this time, s.
    Lost(f64),
    /// With a state that is not finite after this time, s.
    Diverged(f64),
    /// With an implicit step that has no solution after this time, s.
    Unsolved(f64),
}

impl Ending {
    /// Columns that say how a run ended, and when.
    pub(super) fn columns() -> [Column; 2] {
        let meaning =
            "ok; lost: the attitude was first seen more than 1 rad off; diverged or unsolved: the run ended";
        [Column::new("status", "", meaning), Column::new("time_reached", "s", "time of the row").hidden()]
    }

    /// Whether the run came to its end.
    pub(super) fn is_whole(self) -> bool {
        matches!(self, Ending::Held | Ending::Lost(_))
    }
}

impl fmt::Display for Ending {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Ending::Held => f.write_str("ok"),
            Ending::Lost(t) => write!(f, "lost at t = {} s", rounded(*t)),
            Ending::Diverged(t) => write!(f, "diverged at t = {} s", rounded(*t)),
            Ending::Unsolved(t) => write!(f, "unsolved at t = {} s", rounded(*t)),
        }
    }
}

/// To two digits: a loss is seen at one look out of many only.
fn rounded(t: f64) -> String {
    let t = format!("{t:.1e}").parse().unwrap_or(t);
    if (1e-3..1e6).contains(&t) { t.to_string() } else { format!("{t:e}") }
}

/// Follows `run` for `steps` steps or until it fails; `exact` is the motion, where it is known.
pub(super) fn follow(
    run: &mut Run,
    steps: u64,
    exact: impl Fn(Dd) -> Option<Point<Dd>>,
) -> Result<Followed, Error> {
    let mut seen = Followed {
        last: run.sample(),
        ending: Ending::Held,
        attitude_error: None,
        times: Vec::new(),
        energy_changes: Vec::new(),
    };
    let error = |sample: &Sample| exact(sample.elapsed).map(|exact| attitude_error(sample, &exact));
    for (look, sample) in run.samples(Schedule::every((steps / LOOKS).max(1), steps)).skip(1).enumerate() {
        let failed = |last: &Sample| last.elapsed.hi();
        seen.last = match sample {
            Ok(sample) => sample,
            Err(RunError::Diverged { last }) => {
                seen.ending = Ending::Diverged(failed(&last));
                *last
            }
            Err(RunError::Unsolved { last, .. }) => {
                seen.ending = Ending::Unsolved(failed(&last));
                *last
            }
            Err(error) => return Err(unexpected(error)),
        };
        if seen.ending == Ending::Held
            && look % ATTITUDE_EVERY == 0
            && error(&seen.last).is_some_and(|error| error > LOST)
        {
            seen.ending = Ending::Lost(failed(&seen.last));
        }
        seen.times.push(seen.last.elapsed.hi());
        seen.energy_changes.push(seen.last.energy_change);
    }
    if seen.ending == Ending::Held {
        seen.attitude_error = error(&seen.last);
        if seen.attitude_error.is_some_and(|error| error > LOST) {
            (seen.attitude_error, seen.ending) = (None, Ending::Lost(seen.last.elapsed.hi()));
        }
    }
    Ok(seen)
}

/// What a run has cost.
pub(super) struct Effort {
    /// Evaluations of the right-hand side: those that a method counts that chooses its steps, else as many for each step as the
    /// method claims. `None` where a step is made of other work.
    pub(super) evaluations: Option<u64>,
    /// Steps that were tried and rejected; `None` where steps are as given.
    pub(super) rejected: Option<u64>,
}

impl Effort {
    /// Of `steps` steps of `method`, taken by `run`.
    pub(super) fn of(run: &Run, method: &(impl Claimed + ?Sized), problem: Problem, steps: u64) -> Self {
        match run.work() {
            Some(work) => Effort { evaluations: Some(work.evaluations), rejected: Some(work.rejected) },
            None => Effort { evaluations: claimed_evaluations(method, problem, steps), rejected: None },
        }
    }

    pub(super) fn columns() -> [Column; 2] {
        let evaluations = "evaluations of the right-hand side; empty where a step is made of other work";
        [
            Column::new("evaluations", "", evaluations).hidden(),
            Column::new("rejected_steps", "", "steps tried and rejected; empty where steps are as given")
                .hidden(),
        ]
    }
}

/// Evaluations of the right-hand side in `steps` steps, where nothing else is evaluated or solved.
pub(super) fn claimed_evaluations(
    method: &(impl Claimed + ?Sized),
    problem: Problem,
    steps: u64,
) -> Option<u64> {
    let cost = method.claims(problem)?.cost;
    (cost.right_sides > 0).then(|| u64::from(cost.right_sides) * steps)
}

/// Angle between the attitude of a sample and that of the exact motion at its time, rad.
pub(super) fn attitude_error(sample: &Sample, exact: &Point<Dd>) -> f64 {
    rotation_angle(sample.point.to_dd().attitude, exact.attitude).hi()
}

/// A row for each method with the errors on all bodies at a coarse and a fine step, of a table with the columns `body`, `method`,
/// `h`, `attitude_error`, `energy_error` and `status`; the method of the least attitude errors comes first.
pub(super) fn rows_of_methods(
    name: &'static str,
    table: &Table,
    body: &str,
    title: String,
    kinds: [&str; 2],
) -> Drawing {
    let columns = [body, "method", "h", "attitude_error", "energy_error", "status"];
    let [body, method, h, attitude, energy, status] = columns.map(|name| table.place(name).unwrap_or(0));
    let number = |cell: &Cell| if let Cell::Number(x) = cell { Some(*x) } else { None };
    let mut rows: Vec<(f64, Group)> = Vec::new();
    let mut names: Vec<String> = table.rows().iter().map(|row| row[method].exact()).collect();
    names.dedup();
    let mut seen = std::collections::HashSet::new();
    names.retain(|name| seen.insert(name.clone()));
    for name in names {
        let of_it: Vec<&Vec<Cell>> = table.rows().iter().filter(|row| row[method].exact() == name).collect();
        let is_coarse = |row: &Vec<Cell>| {
            let steps =
                of_it.iter().filter(|other| other[body] == row[body]).filter_map(|other| number(&other[h]));
            number(&row[h]) == steps.reduce(f64::max)
        };
        let values = |column: usize, coarse: bool| {
            let rows = || of_it.iter().filter(|row| is_coarse(row) == coarse);
            let seen: Vec<f64> = rows().filter_map(|row| number(&row[column])).collect();
            let lost = rows().filter(|row| row[column] == Cell::Empty && row[status].exact() != "ok").count();
            Values { seen, lost }
        };
        let values: Vec<Vec<Values>> =
            [attitude, energy].map(|column| vec![values(column, true), values(column, false)]).to_vec();
        let mut fine = values[0][1].seen.clone();
        fine.extend(std::iter::repeat_n(f64::MAX, values[0][1].lost));
        fine.sort_by(f64::total_cmp);
        let rank = fine.get(fine.len().saturating_sub(1) / 2).copied().unwrap_or(f64::MAX);
        // where most attitudes are lost, the best one decides
        let rank = if rank == f64::MAX {
            fine.first().map_or(f64::MAX, |least| 1.0 + least.min(1e300))
        } else {
            rank
        };
        rows.push((rank, Group { name, values }));
    }
    rows.sort_by(|a, b| a.0.total_cmp(&b.0));
    let plot = RowPlot {
        title,
        kinds: kinds.map(String::from).to_vec(),
        panels: vec!["attitude error (rad)".into(), "relative energy error".into()],
        lost: "lost".into(),
        rows: rows.into_iter().map(|(_, group)| group).collect(),
    };
    Drawing { name, svg: plot.page().svg() }
}

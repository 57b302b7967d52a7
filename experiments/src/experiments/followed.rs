//! What experiments that follow runs share: a run to its end, wherever that is, its attitude error, and the figure.

use polhode::body::{Point, Problem};
use polhode::method::Claimed;
use polhode::num::Dd;
use polhode::run::{Run, Sample, Schedule};
use polhode::truth::{Ending, LOST, attitude_error};
use polhode_files::error::{Error, unexpected};
use polhode_pages::figure::{Drawing, Group, RowPlot, Values};
use polhode_pages::table::{Cell, Column, Table};

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

/// Columns that say how a run ended, and when.
pub(super) fn columns_of_ending() -> [Column; 2] {
    let meaning =
        "ok; lost: the attitude was first seen more than 1 rad off; diverged or unsolved: the run ended";
    [Column::new("status", "", meaning), Column::new("time_reached", "s", "time of the row").hidden()]
}

/// Whether a run came to its end.
pub(super) fn is_whole(ending: Ending) -> bool {
    matches!(ending, Ending::Held | Ending::Lost(_))
}

/// How a run ended.
pub(super) fn status(ending: Ending) -> String {
    let at = |t| format!("{} at t = {} s", ending.word(), rounded(t));
    ending.time().map_or(ending.word().into(), at)
}

/// To two digits: a loss is seen at one look out of many only.
fn rounded(t: f64) -> String {
    let t = format!("{t:.1e}").parse().unwrap_or(t);
    if (1e-3..1e6).contains(&t) { t.to_string() } else { format!("{t:e}") }
}

/// Follows `run` for `steps` steps of `h` s or until it fails; `exact` is the motion, where it is known.
pub(super) fn follow(
    run: &mut Run,
    (steps, h): (u64, f64),
    exact: impl Fn(Dd) -> Option<Point<Dd>>,
) -> Result<Followed, Error> {
    let mut seen = Followed {
        last: run.sample(),
        ending: Ending::Held,
        attitude_error: None,
        times: Vec::new(),
        energy_changes: Vec::new(),
    };
    let error =
        |at: &Sample| exact(at.elapsed).map(|exact| attitude_error(at.point.attitude, exact.attitude));
    for (look, sample) in run.samples(Schedule::every((steps / LOOKS).max(1), steps)).skip(1).enumerate() {
        seen.last = match sample {
            Ok(sample) => sample,
            Err(error) => {
                let last = error.last().copied().unwrap_or(seen.last);
                seen.ending = Ending::of(&error, h).ok_or_else(|| unexpected(error))?;
                last
            }
        };
        if seen.ending == Ending::Held
            && look % ATTITUDE_EVERY == 0
            && error(&seen.last).is_some_and(|error| error > LOST)
        {
            seen.ending = Ending::Lost(seen.last.elapsed.hi());
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

/// Columns of what a run has cost.
pub(super) fn columns_of_effort() -> [Column; 2] {
    let evaluations = "evaluations of the right-hand side; empty where a step is made of other work";
    let rejected = "steps tried and rejected; empty where steps are as given";
    [
        Column::new("evaluations", "", evaluations).hidden(),
        Column::new("rejected_steps", "", rejected).hidden(),
    ]
}

/// What `steps` steps of `method`, taken by `run`, have cost: what a method counts that chooses its steps, else what it claims.
pub(super) fn effort(
    run: &Run,
    method: &(impl Claimed + ?Sized),
    problem: Problem,
    steps: u64,
) -> [Option<u64>; 2] {
    match run.work() {
        Some(work) => [Some(work.evaluations), Some(work.rejected)],
        None => [claimed_evaluations(method, problem, steps), None],
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

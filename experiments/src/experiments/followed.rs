//! What experiments that follow runs share: a run to its end, wherever that is, its attitude error, and the figure.

use std::fmt;

use polhode::body::{Point, Problem};
use polhode::method::{Claimed, catalogue};
use polhode::num::Dd;
use polhode::rotation::rotation_angle;
use polhode::run::{Run, RunError, Sample, Schedule};

use crate::error::{Error, unexpected};
use crate::figure::{Figure, Series};
use crate::table::{Cell, Column, Table};

/// Looks at the energy for its secular slope.
const LOOKS: u64 = 512;

/// Of those, one in so many at the attitude, to see when it is lost.
const ATTITUDE_EVERY: usize = 8;

/// An attitude that is further off than this, rad, is lost: what follows is no error but chance.
pub(super) const LOST: f64 = 1.0;

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
fn rounded(t: f64) -> f64 {
    format!("{t:.1e}").parse().unwrap_or(t)
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

/// Energy error against attitude error, of each method of the catalogue that claims something for `problem`: a point for each
/// row of `table` that has both: runs that were lost or failed have no attitude.
pub(super) fn scatter(name: &'static str, table: &Table, title: &str, problem: Problem) -> Figure {
    let mut figure =
        Figure::log_log(name, title, "attitude error at the end (rad)", "largest relative energy error")
            .scatter();
    let columns = ["method", "attitude_error", "energy_error"];
    let [Some(method), Some(attitude), Some(energy)] = columns.map(|name| table.place(name)) else {
        return figure;
    };
    for method_name in catalogue().iter().filter(|method| method.claims(problem).is_some()).map(|m| m.name())
    {
        let of_it = |row: &&Vec<Cell>| row[method].exact() == method_name;
        let point = |row: &Vec<Cell>| match (&row[attitude], &row[energy]) {
            (Cell::Number(attitude), Cell::Number(energy)) => Some((*attitude, *energy)),
            _ => None,
        };
        let points: Vec<_> = table.rows().iter().filter(of_it).filter_map(point).collect();
        if !points.is_empty() {
            figure.series.push(Series::new(method_name, points));
        }
    }
    figure
}

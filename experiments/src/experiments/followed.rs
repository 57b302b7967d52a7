//! What experiments that follow runs share: a run to its end, wherever that is, its attitude error, and the figure.

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

/// What was seen of a run.
pub(super) struct Followed {
    /// The last finite sample.
    pub(super) last: Sample,
    /// `ok`, `diverged` or `unsolved`.
    pub(super) status: &'static str,
    /// Times of the looks, s.
    pub(super) times: Vec<f64>,
    /// Relative changes of the energy at these times.
    pub(super) energy_changes: Vec<f64>,
}

/// Follows `run` for `steps` steps or until it fails.
pub(super) fn follow(run: &mut Run, steps: u64) -> Result<Followed, Error> {
    let mut seen =
        Followed { last: run.sample(), status: "ok", times: Vec::new(), energy_changes: Vec::new() };
    for sample in run.samples(Schedule::every((steps / LOOKS).max(1), steps)).skip(1) {
        (seen.last, seen.status) = match sample {
            Ok(sample) => (sample, "ok"),
            Err(RunError::Diverged { last }) => (*last, "diverged"),
            Err(RunError::Unsolved { last, .. }) => (*last, "unsolved"),
            Err(error) => return Err(unexpected(error)),
        };
        seen.times.push(seen.last.elapsed.hi());
        seen.energy_changes.push(seen.last.energy_change);
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
/// row of `table` that has both and whose run came to its end.
pub(super) fn scatter(name: &'static str, table: &Table, title: &str, problem: Problem) -> Figure {
    let mut figure =
        Figure::log_log(name, title, "attitude error at the end (rad)", "largest relative energy error")
            .scatter();
    let columns = ["method", "status", "attitude_error", "energy_error"];
    let [Some(method), Some(status), Some(attitude), Some(energy)] = columns.map(|name| table.place(name))
    else {
        return figure;
    };
    for method_name in catalogue().iter().filter(|method| method.claims(problem).is_some()).map(|m| m.name())
    {
        let of_it = |row: &&Vec<Cell>| row[method].exact() == method_name && row[status].exact() == "ok";
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

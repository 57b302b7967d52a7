//! What is left of the attitude error where the phase is taken back, at equal cost beside methods of higher order.

use polhode::body::Problem;
use polhode::flow::FreeMotion;
use polhode::method::{Claimed, PhaseError, method};
use polhode::num::Random;
use polhode::run::{Run, RunError, Watch};
use polhode::truth::{LOST, attitude_error};
use polhode_files::error::{Error, unexpected};
use polhode_pages::table::{Column, Table, row};

use super::super::contestants::weighed;
use super::drawn;
use crate::experiment::{Context, Report};

const SEED: u64 = 2027;

const METHODS: [&str; 14] = [
    "rk4",
    "implicit-midpoint",
    "implicit-midpoint+phase",
    "rattle",
    "rattle+phase",
    "lie-poisson",
    "lie-poisson+phase",
    "two-turn",
    "two-turn+phase",
    "two-turn@suzuki-4",
    "two-turn@suzuki-4+phase",
    "gauss:4+phase",
    "dmv:10",
    "exact-step",
];

/// Evaluations for each radian that the body turns.
const COST: f64 = 40.0;

/// Errors are the largest of so many looks at the end, this many rad apart: over some periods of most bodies.
const LOOKS: u64 = 16;
const APART: f64 = 5.0;

pub(super) fn add(context: &Context, report: &mut Report) -> Result<(), Error> {
    let bodies: u64 = context.scale.pick(2, 3, 20);
    let turns: [f64; 2] = context.scale.pick([1e2, 1e3], [1e3, 1e4], [1e4, 1e6]);
    let mut parts = Vec::new();
    for name in METHODS {
        // the same at the longer end, and half the step at the shorter
        for (turn, halved) in [(turns[0], false), (turns[0], true), (turns[1], false)] {
            parts.extend((0..bodies).map(|member| (name, member, turn, halved)));
        }
    }
    let found = context.in_parallel(parts, |(name, member, turn, halved)| error(name, member, turn, halved));
    let found = found.into_iter().collect::<Result<Vec<_>, Error>>()?;
    let caption = format!(
        "Attitude error over {bodies} random bodies at the cost of {COST} evaluations a radian: medians, none where most are lost, beyond {LOST} rad; with \
         +phase shift and twist are taken back at output, what they are predicted by is not counted."
    );
    let [early, late] = turns;
    let mut table = Table::new("corrected", caption, columns());
    for (name, errors) in METHODS.iter().zip(found.chunks(3 * bodies as usize)) {
        let medians: Vec<Option<f64>> = errors.chunks(bodies as usize).map(median).collect();
        let [first, half, last] = [medians[0], medians[1], medians[2]];
        let slope = |ratio: Option<f64>, base: f64| ratio.map(|ratio| libm::log(ratio) / libm::log(base));
        let over = |a: Option<f64>, b: Option<f64>| Some(a? / b?);
        let late_errors = errors.chunks(bodies as usize).last().unwrap_or_default();
        let lost = late_errors.iter().flatten().filter(|error| **error > LOST).count() as u64;
        let refused = errors.iter().filter(|error| error.is_none()).count() as u64;
        table.push(row![
            *name,
            step(name)?,
            early,
            first,
            slope(over(first, half), 2.0),
            late,
            last,
            slope(over(last, first), late / early),
            lost,
            refused,
            bodies,
            COST,
        ]);
    }
    report.tables.push(table);
    Ok(())
}

/// Turn of the body in a step at equal cost, rad.
fn step(name: &str) -> Result<f64, Error> {
    let claims = method(name).map_err(unexpected)?.claims(Problem::Free);
    Ok(claims.map_or(1.0, |claims| weighed(claims.cost)) / COST)
}

/// The median of those that are not refused; none where it is lost.
fn median(errors: &[Option<f64>]) -> Option<f64> {
    let mut errors: Vec<f64> = errors.iter().flatten().copied().collect();
    errors.sort_by(f64::total_cmp);
    errors.get(errors.len() / 2).copied().filter(|error| *error <= LOST)
}

/// The attitude error at the end, rad; none where the start is refused.
fn error(name: &str, member: u64, turn: f64, halved: bool) -> Result<Option<f64>, Error> {
    let (body, start) = drawn(Random::new(SEED).stream(member))?;
    let h = step(name)? * if halved { 0.5 } else { 1.0 };
    let run = Run::new(&method(name).map_err(unexpected)?, &body, &start, h);
    let mut run = match run {
        Ok(run) => run.watching(Watch::Never),
        Err(RunError::Phase(PhaseError::Unsettled { .. } | PhaseError::Coarse { .. })) => return Ok(None),
        Err(error) => return Err(unexpected(error)),
    };
    let motion = FreeMotion::from_point(body.inertia(), run.start().to_dd());
    let steps = (turn / h) as u64;
    let mut largest = 0.0_f64;
    for look in (0..LOOKS).rev() {
        let sample = run.advance_to(steps - (look as f64 * APART / h) as u64).map_err(unexpected)?;
        let exact = motion.point_at_dd(sample.elapsed);
        largest = largest.max(attitude_error(sample.point.attitude, exact.attitude));
    }
    Ok(Some(largest))
}

fn columns() -> Vec<Column> {
    vec![
        Column::new("method", "", "name in the catalogue"),
        Column::new("step", "rad", "turn of the body in a step").digits(2),
        Column::new("early", "rad", "turn of the body in the shorter run").hidden(),
        Column::new("error", "rad", "median of the attitude error at its end").heading("early").digits(2),
        Column::new("order", "", "slope of this error between the step and half of it").digits(2),
        Column::new("late", "rad", "turn of the body in the longer run").hidden(),
        Column::new("late_error", "rad", "median of the attitude error at its end").heading("late").digits(2),
        Column::new("growth", "", "slope of the error over time between the two ends").digits(2),
        Column::new("lost", "", "bodies whose attitude is lost at the end of the longer run"),
        Column::new("refused", "", "runs of bodies whose phase error is not predicted"),
        Column::new("bodies", "", "random bodies").hidden(),
        Column::new("cost", "1/rad", "evaluations for each radian that the body turns").hidden(),
    ]
}

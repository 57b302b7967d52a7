//! Processor time of a step: a number of this machine, asked for by name only.

use std::time::Instant;

use super::LawsError;
use super::finding::Finding;
use super::subject::Subject;
use super::words::{Law, Quantity, Verdict};
use crate::body::Clock;

/// The middle one of so many measurements counts.
const TRIES: usize = 5;

/// Steps of a measurement.
const STEPS: u64 = 20_000;

/// Seconds a step in double precision, at the step of the other laws.
pub(super) fn measure(subject: &Subject<'_>) -> Result<Vec<Finding>, LawsError> {
    let clock = Clock::new(subject.telling_step(0.0625));
    let mut step = subject.method.prepare_f64(clock, &subject.case.body)?;
    let mut seconds: Vec<f64> = (0..TRIES)
        .map(|_| {
            let mut x = subject.case.start.to_f64();
            let begun = Instant::now();
            step.steps(&mut x, STEPS);
            begun.elapsed().as_secs_f64() / STEPS as f64
        })
        .collect();
    seconds.sort_by(f64::total_cmp);
    let middle = seconds.get(TRIES / 2).copied();
    let finding = Finding::new(subject.problem(), Law::Time, Quantity::Step, "none");
    Ok(vec![Finding { measured: middle, verdict: Verdict::Measured, ..finding }])
}

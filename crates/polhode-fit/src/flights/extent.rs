//! Where a flight begins and ends.

use crate::thresholds::extent::{BESIDE, COMMON, ENDS, FEWEST, NOISE, ROUNDS, USUAL};
use core::ops::Range;

use polhode::record::median;

use crate::flights::consensus::precisions;
use crate::flights::equations::{LOCAL, Normal, Test, Vector};
use crate::flights::flight::FlightLimit;
use crate::physical::coordinates::Coordinates;
use crate::thresholds::flights::MOST_TORQUE;

/// The tests of one flight, and what stands before and after it.
pub(super) struct Extent {
    pub(super) tests: Range<usize>,
    pub(super) before: FlightLimit,
    pub(super) after: FlightLimit,
}

/// Runs of tests that are free.
pub(super) fn runs(free: &[bool]) -> Vec<Range<usize>> {
    let mut runs: Vec<Range<usize>> = Vec::new();
    for k in (0..free.len()).filter(|&k| free[k]) {
        match runs.last_mut() {
            Some(run) if run.end == k => run.end = k + 1,
            _ => runs.push(k..k + 1),
        }
    }
    runs
}

/// What of a run of free tests no torque touches, at a tensor next to `x`.
///
/// Windows agree up to a torque that is large beside what is left within a flight; its ends are where the residuals
/// leave their own level.
pub(super) fn extent(
    tests: &[Test],
    run: Range<usize>,
    x: &Coordinates,
    speed: f64,
    variance: f64,
) -> Option<Extent> {
    let mut mean = Vector::zeros();
    mean.fixed_rows_mut::<5>(0).copy_from(x);
    let mut prior = precisions(speed);
    prior.fixed_rows_mut::<5>(0).fill(COMMON);
    let share = |test: &Test, at: &Vector| test.residual(at).norm() / test.size();
    let mut kept = run.clone();
    let mut at = mean;
    for _ in 0..ROUNDS {
        let mut normal = Normal::prior(&prior, &mean);
        tests[kept.clone()].iter().for_each(|t| normal.add(t, t.scale(MOST_TORQUE, variance), LOCAL));
        at = normal.solve()?;
        let mut shares: Vec<f64> = tests[kept.clone()].iter().map(|t| share(t, &at)).collect();
        let median = median(&mut shares)?;
        let stands_out =
            |t: &Test| share(t, &at) > (USUAL * median).max(NOISE * t.noise(variance).sqrt() / t.size());
        let reach = (ENDS * run.len() as f64) as usize;
        let before = tests[run.start..run.start + reach].iter().rposition(stands_out);
        let after = tests[run.end - reach..run.end].iter().position(stands_out);
        let trimmed =
            before.map_or(run.start, |k| run.start + k + 1)..after.map_or(run.end, |k| run.end - reach + k);
        if trimmed.len() < FEWEST {
            return None;
        }
        if trimmed == kept {
            break;
        }
        kept = trimmed;
    }
    let limit = |beside: &[Test]| {
        if beside.is_empty() {
            return FlightLimit::Edge;
        }
        let slow = beside.iter().filter(|t| t.is_slow(speed)).count();
        match 2 * slow > beside.len() {
            true => FlightLimit::Slow,
            false => FlightLimit::Torque { share: beside.iter().map(|t| share(t, &at)).fold(0.0, f64::max) },
        }
    };
    let before = limit(&tests[kept.start.saturating_sub(BESIDE)..kept.start]);
    let after = limit(&tests[kept.end..(kept.end + BESIDE).min(tests.len())]);
    Some(Extent { tests: kept, before, after })
}

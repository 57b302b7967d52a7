//! A short run of one method, compared with the motion.

use std::time::Instant;

use super::Predicted;
use crate::body::{Body, Clock, Conserved, Point};
use crate::method::AnyMethod;
use crate::num::Dd;
use crate::observe::Monitor;
use crate::run::SOLVED;
use crate::truth::attitude_error;

/// What a run over a horizon showed.
#[derive(Clone, Copy, Debug)]
pub(super) struct Trial {
    /// Horizon, s.
    pub(super) horizon: f64,
    /// Largest attitude error, rad.
    pub(super) attitude: f64,
    /// The same over the first half.
    pub(super) attitude_before: f64,
    /// Largest relative energy error; `None` where energy is not conserved.
    pub(super) energy: Option<f64>,
    /// The same over the first half.
    energy_before: f64,
    /// Processor time before the first step, s.
    pub(super) setup: f64,
    /// Processor time per second of motion.
    pub(super) price: f64,
    /// By which factor it scatters from piece to piece of the run.
    pub(super) scatter: f64,
    /// Steps from look to look.
    pub(super) steps: u64,
}

/// Runs `method` over `horizon` with at least `steps` steps, from look to look at the points `truth` of the motion. `None` where it fails.
pub(super) fn trial(
    method: &dyn AnyMethod,
    (body, start, start_time): (&Body, Point<f64>, f64),
    truth: &[Point<Dd>],
    (horizon, steps): (f64, f64),
) -> Option<Trial> {
    let looks = truth.len();
    let apart = horizon / looks as f64;
    let n = libm::ceil(steps / looks as f64).max(1.0);
    let clock = Clock { start: start_time, step: apart / n };
    let begun = Instant::now();
    let mut step = method.prepare_f64(clock, body).ok()?;
    let mut x = start;
    step.open(&mut x);
    let setup = begun.elapsed().as_secs_f64();
    let monitor = Monitor::new(body, clock, &start);
    let conserved = body.conserved().contains(&Conserved::Energy);
    let (mut attitude, mut energy, mut before) = (0.0_f64, 0.0_f64, (0.0, 0.0));
    let mut prices = Vec::new();
    for (k, exact) in truth.iter().enumerate() {
        let begun = Instant::now();
        step.advance(&mut x, n as u64);
        prices.push(begun.elapsed().as_secs_f64() / apart);
        let seen = step.reading(&x);
        if !seen.is_finite() || step.stuck().is_some() || step.worst_residual() > SOLVED {
            return None;
        }
        attitude = attitude.max(attitude_error(seen.attitude, exact.attitude));
        if conserved {
            energy = energy.max(monitor.energy_change(&seen).abs());
        }
        if 2 * (k + 1) == looks {
            before = (attitude, energy);
        }
    }
    // an interruption lengthens a few pieces: the middle one of all is not among them
    prices.sort_by(f64::total_cmp);
    let quantile = |share: usize| prices[(prices.len() - 1) * share / 4];
    let (price, scatter) = (quantile(2), quantile(3) / quantile(1));
    let (energy, (attitude_before, energy_before)) = (conserved.then_some(energy), before);
    let steps = n as u64;
    Some(Trial { horizon, attitude, attitude_before, energy, energy_before, setup, price, scatter, steps })
}

/// Between two looks the error may be larger than at them by about this factor.
const SAME_RUN: f64 = 1.25;

impl Trial {
    /// The largest attitude error up to `until`: as the second half of the run grew, between √t and t. Where the energy `drifts`,
    /// so does the rate of turning, `rate` rad/s at the start, and the error grows by one power of t more than the energy's.
    pub(super) fn attitude_at(&self, until: f64, rate: f64, drifts: bool) -> Predicted {
        let ratio = until / self.horizon;
        if ratio <= 1.0 {
            return Predicted { value: self.attitude, factor: SAME_RUN };
        }
        let steady = self.attitude * libm::pow(ratio, growth(self.attitude_before, self.attitude));
        let energy = self.energy_at(until, drifts).filter(|_| drifts).unwrap_or(0.0);
        let drifting = energy * rate * until;
        let value = steady + drifting;
        let (most, least) = (self.attitude * ratio + drifting, self.attitude * libm::sqrt(ratio));
        Predicted { value, factor: SAME_RUN * (most / value).max(value / least) }
    }

    /// The largest energy error up to `until`.
    pub(super) fn energy_at(&self, until: f64, drifts: bool) -> Option<f64> {
        let ratio = (until / self.horizon).max(1.0);
        let energy = self.energy?;
        Some(if drifts { energy * libm::pow(ratio, growth(self.energy_before, energy)) } else { energy })
    }
}

/// The power of t with which an error that doubled the time from `before` to `after` grows: from that of rounding, ½, to 1.
fn growth(before: f64, after: f64) -> f64 {
    if after > 0.0 { libm::log2(after / before.max(0.25 * after)).clamp(0.5, 1.0) } else { 1.0 }
}

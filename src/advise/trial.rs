//! A short run of one method, compared with the motion.

use std::time::Instant;

use super::Predicted;
use super::reference::Span;
use crate::body::{Body, Clock, Conserved};
use crate::method::{AnyMethod, SOLVED};
use crate::observe::Monitor;
use crate::truth::{LOST, attitude_error};

/// What a run over a horizon showed.
#[derive(Clone, Copy, Debug)]
pub(super) struct Trial {
    /// Horizon, s.
    pub(super) horizon: f64,
    /// How many times as far the body turns in the whole time.
    times_longer: f64,
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

/// Runs `method` over `span` with at least `steps` steps, from look to look. `None` where it fails, or loses the attitude. `heed` is told
/// what part is done; a run of more than `patience` s is given up.
pub(super) fn trial(
    method: &dyn AnyMethod,
    body: &Body,
    span: &Span,
    (steps, patience): (f64, f64),
    heed: &mut dyn FnMut(f64),
) -> Option<Trial> {
    let first = Instant::now();
    let (horizon, start) = (span.horizon, span.start);
    let looks = span.points.len();
    let apart = horizon / looks as f64;
    let n = libm::ceil(steps / looks as f64).max(1.0);
    let clock = Clock { start: span.start_time, step: apart / n };
    let begun = Instant::now();
    let mut step = method.prepare_f64(clock, body).ok()?;
    let mut x = start;
    step.open(&mut x);
    let setup = begun.elapsed().as_secs_f64();
    let monitor = Monitor::new(body, clock, &start);
    let conserved = body.conserved().contains(&Conserved::Energy);
    let (mut attitude, mut energy, mut before) = (0.0_f64, 0.0_f64, (0.0, 0.0));
    let mut prices = Vec::new();
    for (k, exact) in span.points.iter().enumerate() {
        let begun = Instant::now();
        step.advance(&mut x, n as u64);
        prices.push(begun.elapsed().as_secs_f64() / apart);
        let seen = step.reading(&x);
        if !seen.is_finite() || step.stuck().is_some() || step.worst_residual() > SOLVED {
            return None;
        }
        attitude = attitude.max(attitude_error(seen.attitude, exact.attitude));
        if attitude > LOST || first.elapsed().as_secs_f64() > patience {
            return None;
        }
        heed((k + 1) as f64 / looks as f64);
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
    // where the rate changes, so does the price of a step that is chosen: the mean counts
    let mean = prices.iter().sum::<f64>() / looks as f64;
    let (middle, scatter) = (quantile(2), quantile(3) / quantile(1));
    let price = if method.tolerance().is_some() { mean } else { middle };
    let (energy, (attitude_before, energy_before)) = (conserved.then_some(energy), before);
    let steps = n as u64;
    let times_longer = span.times_longer;
    Some(Trial {
        horizon,
        times_longer,
        attitude,
        attitude_before,
        energy,
        energy_before,
        setup,
        price,
        scatter,
        steps,
    })
}

/// Between two looks the error may be larger than at them by about this factor, and a method that chooses its steps takes others where states are
/// asked for at other times: the largest factor that was seen, of some hundred demands, is 1.6.
pub(super) const SAME_RUN: f64 = 2.0;

impl Trial {
    /// The largest attitude error up to `until`: as the second half of the run grew, between √t and t. Where the energy `drifts`,
    /// so does the rate of turning, `rate` rad/s at the start, and the error grows by one power of t more than the energy's; where
    /// nothing tells its energy, between √t and t².
    pub(super) fn attitude_at(&self, until: f64, rate: f64, drifts: bool) -> Predicted {
        let ratio = self.times_longer;
        if ratio <= 1.0 {
            return Predicted { value: self.attitude, factor: SAME_RUN };
        }
        let fastest = if drifts && self.energy.is_none() { 2.0 } else { 1.0 };
        let steady = self.attitude * libm::pow(ratio, growth(self.attitude_before, self.attitude, fastest));
        let energy = self.energy_at(drifts).filter(|_| drifts).unwrap_or(0.0);
        let drifting = energy * rate * until;
        let value = steady + drifting;
        let most = self.attitude * libm::pow(ratio, fastest) + drifting;
        let least = self.attitude * libm::sqrt(ratio);
        Predicted { value, factor: SAME_RUN * (most / value).max(value / least) }
    }

    /// The largest energy error over the whole time.
    pub(super) fn energy_at(&self, drifts: bool) -> Option<f64> {
        let ratio = self.times_longer.max(1.0);
        let energy = self.energy?;
        Some(if drifts { energy * libm::pow(ratio, growth(self.energy_before, energy, 1.0)) } else { energy })
    }
}

/// The power of t with which an error that doubled the time from `before` to `after` grows: from that of rounding, ½, to `fastest`.
fn growth(before: f64, after: f64, fastest: f64) -> f64 {
    if after > 0.0 { libm::log2(after / before.max(0.25 * after)).clamp(0.5, fastest) } else { 1.0 }
}

#[cfg(test)]
mod tests {
    use super::super::Demand;
    use super::super::reference::Reference;
    use super::*;
    use crate::inertia::Inertia;
    use crate::method::Rk4;

    fn seen(times_longer: f64, [before, attitude]: [f64; 2], energy: Option<[f64; 2]>) -> Trial {
        Trial {
            horizon: 10.0,
            times_longer,
            attitude,
            attitude_before: before,
            energy: energy.map(|energy| energy[1]),
            energy_before: energy.map_or(0.0, |energy| energy[0]),
            setup: 0.0,
            price: 1.0,
            scatter: 1.0,
            steps: 1,
        }
    }

    #[test]
    fn an_error_goes_on_as_it_grew() {
        let near = |a: f64, b: f64| assert!((a / b - 1.0).abs() < 1e-12, "{a:e} for {b:e}");
        let whole = seen(1.0, [1e-6, 2e-6], None).attitude_at(1e3, 2.0, false);
        assert_eq!((whole.value, whole.factor), (2e-6, SAME_RUN));
        // as t, as the root of t, and, where nothing tells the energy, as t²
        let steady = seen(4.0, [1e-6, 2e-6], None).attitude_at(1e3, 2.0, false);
        near(steady.value, 8e-6);
        assert!(steady.value * steady.factor >= 8e-6 && steady.value / steady.factor <= 4e-6);
        near(seen(4.0, [2e-6, 2e-6], None).attitude_at(1e3, 2.0, false).value, 4e-6);
        near(seen(4.0, [5e-7, 2e-6], None).attitude_at(1e3, 2.0, true).value, 32e-6);
        // the rate of turning is off by the energy: 4e-9 of 2 rad/s for 1000 s more than before
        let drifting = seen(4.0, [1e-6, 2e-6], Some([5e-10, 1e-9]));
        near(drifting.energy_at(true).unwrap(), 4e-9);
        near(drifting.attitude_at(1e3, 2.0, true).value, 16e-6);
        near(drifting.attitude_at(1e3, 2.0, false).value, 8e-6);
        assert_eq!(drifting.energy_at(false), Some(1e-9));
    }

    #[test]
    fn a_run_tells_at_every_look_what_part_of_it_is_done() {
        let body = Body::free(Inertia::from_moments([1.0, 2.0, 2.5]).unwrap());
        let start = body.state(Default::default(), [0.4, 1.0, -0.3].into()).unwrap();
        let start = body.enter(&start).unwrap().to_f64();
        let mut reference = Reference::new(&body, start, &Demand::new(10.0, 1e-6), &mut |_| {}).unwrap();
        let span = reference.short().unwrap();
        let mut told = Vec::new();
        let mut heed = |done| told.push(done);
        let found = trial(&Rk4 { normalized: false }, &body, &span, (1.0, f64::INFINITY), &mut heed);
        assert!(found.is_some());
        let looks = span.points.len();
        let parts: Vec<f64> = (1..=looks).map(|k| k as f64 / looks as f64).collect();
        assert_eq!(told, parts);
    }
}

//! Shift and twist along a run, and how fast they grow.

use polhode::flow::{Departure, FreeMotion};
use polhode::method::PhaseDrift;
use polhode::run::Run;
use polhode_files::error::{Error, unexpected};

use super::Rates;

/// One look at a run.
#[derive(Clone, Copy, Debug)]
pub(super) struct Look {
    /// Time, s.
    pub(super) t: f64,
    pub(super) departure: Departure,
}

/// Looks at the steps `steps`, which ascend.
///
/// Shift and twist are followed from look to look: a period or a turn more would look the same. `expected` tells how far they come
/// between two looks, to within half a period and half a turn; next to the separatrix they swing by more than that.
pub(super) fn looks(
    run: &mut Run,
    motion: &FreeMotion,
    steps: &[u64],
    expected: &PhaseDrift,
) -> Result<Vec<Look>, Error> {
    let mut looks: Vec<Look> = Vec::new();
    for &n in steps {
        let sample = run.advance_to(n).map_err(unexpected)?;
        let t = sample.elapsed;
        let mut near = expected.departure(t.hi());
        if let Some(last) = looks.last() {
            let then = expected.departure(last.t);
            near.shift = near.shift + (last.departure.shift - then.shift);
            near.twist = near.twist + (last.departure.twist - then.twist);
        }
        looks.push(Look { t: t.hi(), departure: motion.departure(t, &sample.point.to_dd(), near) });
    }
    Ok(looks)
}

/// The slopes of straight lines through shift and twist against time.
pub(super) fn rates(looks: &[Look]) -> Rates {
    let slope = |value: fn(&Look) -> f64| {
        let count = looks.len() as f64;
        let mean = |of: &dyn Fn(&Look) -> f64| looks.iter().map(of).sum::<f64>() / count;
        let (t, v) = (mean(&|look| look.t), mean(&value));
        let covariance = mean(&|look| (look.t - t) * (value(look) - v));
        covariance / mean(&|look| (look.t - t) * (look.t - t))
    };
    Rates { shift: slope(|look| look.departure.shift.hi()), twist: slope(|look| look.departure.twist.hi()) }
}

/// The slopes between the means over both halves of evenly spaced looks, in which oscillations that are quick beside the run are
/// weighed down to nothing: sin⁴ falls with its first three derivatives at both ends.
pub(super) fn smooth_rates(looks: &[Look]) -> Rates {
    let halves = looks.split_at(looks.len() / 2);
    let mean = |half: &[Look], value: fn(&Look) -> f64| {
        let weight = |k: usize| {
            let (sin, _) = libm::sincos(core::f64::consts::PI * (k as f64 + 0.5) / half.len() as f64);
            sin * sin * sin * sin
        };
        let sum: f64 = (0..half.len()).map(weight).sum();
        half.iter().enumerate().map(|(k, look)| weight(k) * value(look)).sum::<f64>() / sum
    };
    let slope = |value: fn(&Look) -> f64| {
        (mean(halves.1, value) - mean(halves.0, value))
            / (mean(halves.1, |look| look.t) - mean(halves.0, |look| look.t))
    };
    Rates { shift: slope(|look| look.departure.shift.hi()), twist: slope(|look| look.departure.twist.hi()) }
}

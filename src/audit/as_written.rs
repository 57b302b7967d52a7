//! Vectors in space beside those of the motion, in the axes in which they were written.

use super::bodies::Told;
use super::deviation::{Allowances, Deviation, GROUPS};
use super::faults::unit_of_times;
use super::program::Dynamics;
use super::resolution::{Writing, Writings, triples};
use super::start::{Weights, fitted};
use super::states::states;
use super::sweep::Sweep;
use super::{Frame, Reading, Trajectory};
use crate::rotation::Vec3;

/// The part of the rounding of attitudes that the start may be off which is fitted to them.
const LEFT: f64 = 0.25;

/// Whether an angular velocity or a momentum in space is further from that of the motion than its own digits allow.
///
/// Turned into the body by attitudes of few digits, it is off by what they are rounded as well, and a fault of its own that is
/// no larger does not show. Noise that is declared may have come with the attitudes: then nothing is said.
pub(super) fn off_in_space(
    record: &Trajectory,
    reading: &Reading,
    found: &Deviation,
    told: Option<&Told>,
    writings: &Writings,
    allowed: &Allowances,
) -> bool {
    let in_space = |frame: Option<Frame>| frame == Some(Frame::Space);
    let rates = record.rates.as_ref().filter(|_| in_space(reading.omega_frame));
    let momentum = record.momentum.as_ref().filter(|_| in_space(reading.momentum_frame));
    let is_noisy = [allowed.attitude, allowed.rates, allowed.momentum].iter().any(|of| of.noise > 0.0);
    // the digits of times leave a vector open too, whatever its own
    let is_rounded = allowed.attitude.rounding > allowed.tolerance && unit_of_times(record).is_none();
    if record.attitude.is_none() || is_noisy || !is_rounded || (rates, momentum) == (None, None) {
        return false;
    }
    let size = found.size;
    let rows = states(record, reading, &found.start.body, &triples(record.times.len(), GROUPS));
    let weights = Weights { attitude: found.attitude_noise, rates: found.rates_noise, size };
    let Some(start) = fitted(&found.start, told, &rows, weights, true, false) else { return false };
    let dynamics = Dynamics::new(&start.body);
    let scale = found.scale;
    let length = dynamics.momentum(start.row.omega).norm() * scale;
    let unit = reading.unit_of_rates();
    let left = LEFT * allowed.attitude.rounding;
    let limit = |vectors: &[[f64; 3]], writing: &Writing, tolerance: f64, size: f64| {
        let half = vectors.iter().map(|v| Vec3(v.map(|x| writing.half_unit(x))).norm() / size);
        half.fold(tolerance, f64::max) + left
    };
    // an angular velocity within the tolerance has a momentum within this
    let of_momentum = allowed.tolerance * (dynamics.largest_moment() * scale * size / length).max(1.0);
    let limits = [
        rates.map_or(0.0, |rates| limit(rates, &writings.rates, allowed.tolerance, size / unit)),
        momentum.map_or(0.0, |momentum| limit(momentum, &writings.momentum, of_momentum, length)),
    ];
    let mut is_off = false;
    let sweep = Sweep { record, reading, start: &start, size, scale };
    let followed = sweep.every(&mut |seen| {
        let (q, omega) = seen.exact;
        let rates = rates.map_or(0.0, |rates| (Vec3(rates[seen.row]) * unit - q.rotate(omega)).norm() / size);
        let momentum = momentum.map_or(0.0, |momentum| {
            (Vec3(momentum[seen.row]) - q.rotate(dynamics.momentum(omega)) * scale).norm() / length
        });
        is_off = is_off || rates > limits[0] || momentum > limits[1];
    });
    followed.is_some() && is_off
}

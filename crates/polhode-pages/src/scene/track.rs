//! The motion of one body as a page shows it.

use nalgebra::{UnitQuaternion, Vector3};
use polhode::rotation::rotation_angle;
use serde::Serialize;

use super::packed;

/// States of one body at ascending times; from one to the next the page turns it evenly about a fixed axis.
///
/// What is not known is an empty list; the others are as long as `times`.
#[derive(Clone, Debug, Default)]
pub struct Track {
    /// What the page calls it.
    pub name: String,
    /// s.
    pub times: Vec<f64>,
    /// From body axes to those of the page.
    pub attitudes: Vec<UnitQuaternion<f64>>,
    /// Angular velocity, body axes, rad/s.
    pub omegas: Vec<Vector3<f64>>,
    /// Angular momentum, axes of the page, in any unit.
    pub momenta: Vec<Vector3<f64>>,
    /// Angle to the body that is compared with, rad.
    pub angles: Vec<f64>,
    /// Relative change of the energy since the start.
    pub energy_changes: Vec<f64>,
    /// How often it turns over, where that is counted.
    pub flips: Option<Flips>,
    /// When and how its motion ends before the others', s.
    pub ending: Option<(f64, String)>,
}

/// Flips of a motion.
#[derive(Clone, Debug, Default, Serialize)]
pub struct Flips {
    /// Their number.
    pub count: u64,
    /// s; not of all where there are many.
    pub times: Vec<f64>,
}

/// A track as the page reads it; lists in base 64.
#[derive(Serialize)]
pub(super) struct Written {
    name: String,
    /// s.
    times: Times,
    attitudes: String,
    omegas: String,
    /// rad/s: what 1 in the list stands for.
    omega_unit: f64,
    momenta: String,
    angles: String,
    energy_changes: String,
    flips: Option<Flips>,
    ending: Option<(f64, String)>,
}

#[derive(Serialize)]
#[serde(untagged)]
enum Times {
    Even { first: f64, last: f64, count: usize },
    Listed { listed: String },
}

/// Times are even that are within this share of their distance.
const EVEN: f64 = 1e-6;

impl Track {
    /// How far the page is at most from the motion that the attitudes are of, rad: between two of them it is off by about a
    /// quarter of what leaving every second one out amounts to.
    #[must_use]
    pub fn interpolation_error(&self) -> f64 {
        let between =
            self.attitudes.windows(3).map(|three| angle(&between(&three[0], &three[2], 0.5), &three[1]));
        between.fold(0.0, f64::max) / 4.0
    }

    /// The attitude at a time within the track, as the page shows it.
    #[must_use]
    pub fn attitude(&self, t: f64) -> Option<UnitQuaternion<f64>> {
        let after = self.times.partition_point(|time| *time <= t).min(self.times.len().checked_sub(1)?);
        let before = after.saturating_sub(1);
        let (t0, t1) = (self.times[before], self.times[after]);
        if t1 <= t0 {
            return self.attitudes.get(after).copied();
        }
        let share = ((t - t0) / (t1 - t0)).clamp(0.0, 1.0);
        Some(between(&self.attitudes[before], &self.attitudes[after], share))
    }

    fn written_times(&self) -> Times {
        let count = self.times.len();
        let (first, last) =
            (self.times.first().copied().unwrap_or(0.0), self.times.last().copied().unwrap_or(0.0));
        let step = (last - first) / (count.max(2) - 1) as f64;
        let is_even = |(k, t): (usize, &f64)| (t - (first + step * k as f64)).abs() <= EVEN * step.abs();
        if self.times.iter().enumerate().all(is_even) {
            Times::Even { first, last, count }
        } else {
            Times::Listed { listed: packed::doubles(self.times.iter().copied()) }
        }
    }

    pub(super) fn written(&self) -> Written {
        let omega_unit = largest(&self.omegas);
        let momentum_unit = largest(&self.momenta);
        let shares = |list: &[Vector3<f64>], unit: f64| {
            packed::shares(list.iter().flat_map(|v| <[f64; 3]>::from(v / unit)))
        };
        let of = |q: &UnitQuaternion<f64>| [q.w, q.i, q.j, q.k];
        Written {
            name: self.name.clone(),
            times: self.written_times(),
            attitudes: packed::shares(self.attitudes.iter().flat_map(of)),
            omegas: shares(&self.omegas, omega_unit),
            omega_unit,
            momenta: shares(&self.momenta, momentum_unit),
            angles: packed::singles(&self.angles),
            energy_changes: packed::singles(&self.energy_changes),
            flips: self.flips.clone(),
            ending: self.ending.clone(),
        }
    }
}

/// The angle between two attitudes, rad.
pub(super) fn angle(p: &UnitQuaternion<f64>, q: &UnitQuaternion<f64>) -> f64 {
    rotation_angle::<f64>((*p).into(), (*q).into())
}

/// The attitude after a `share` of the turn from one to another.
fn between(p: &UnitQuaternion<f64>, q: &UnitQuaternion<f64>, share: f64) -> UnitQuaternion<f64> {
    let p = p.into_inner();
    let q = if p.coords.dot(&q.coords) < 0.0 { -q.into_inner() } else { q.into_inner() };
    let half = 2.0 * libm::atan2((q - p).norm(), (q + p).norm());
    let sin = libm::sin(half);
    let [a, b] = if sin > 1e-6 {
        [1.0 - share, share].map(|share| libm::sin(share * half) / sin)
    } else {
        [1.0 - share, share]
    };
    UnitQuaternion::new_normalize(p * a + q * b)
}

/// The largest component of vectors; 1 where all are zero.
fn largest(list: &[Vector3<f64>]) -> f64 {
    let found = list.iter().map(Vector3::amax).fold(0.0, f64::max);
    if found > 0.0 { found } else { 1.0 }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Of a turn that grows with t², whose middle is known.
    #[test]
    fn the_error_between_attitudes_is_what_it_is_said_to_be() {
        let turn = |t: f64| UnitQuaternion::from_axis_angle(&Vector3::z_axis(), t * t);
        let times: Vec<f64> = (0..=100).map(|k| 0.01 * f64::from(k)).collect();
        let track = Track { attitudes: times.iter().map(|t| turn(*t)).collect(), times, ..Track::default() };
        let found = (0..100)
            .map(|k| 0.01 * f64::from(k) + 0.005)
            .map(|t| angle(&track.attitude(t).unwrap(), &turn(t)))
            .fold(0.0, f64::max);
        let said = track.interpolation_error();
        // h²/4 of an angle t²
        assert!((found - 2.5e-5).abs() < 1e-7 && (said / found - 1.0).abs() < 0.05, "{said} {found}");
        assert_eq!(track.attitude(0.0), Some(turn(0.0)));
        assert_eq!(track.attitude(2.0), Some(turn(1.0)));
    }

    #[test]
    fn times_that_are_not_even_are_listed() {
        let of = |times: Vec<f64>| Track { times, ..Track::default() }.written_times();
        assert!(matches!(of(vec![1.0, 2.0, 3.0]), Times::Even { first: 1.0, last: 3.0, count: 3 }));
        assert!(matches!(of(vec![1.0, 2.0, 3.5]), Times::Listed { .. }));
        assert!(matches!(of(vec![1.0]), Times::Even { count: 1, .. }));
    }
}

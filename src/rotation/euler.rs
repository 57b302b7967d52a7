//! Euler angles in all twelve sequences, to and from attitudes, with their rates.
//!
//! Intrinsic: `R_i(first) R_j(second) R_k(third)`, each turn about an axis that the ones before have moved. The
//! lecture's φ, θ, ψ are `zxz`. Half sums and half differences of the outer angles are the arguments of two pairs
//! of quaternion components, after E. Bernardes and S. Viollet, PLoS ONE 17 (2022) e0276302.

use core::fmt;
use core::str::FromStr;

use nalgebra::{Quaternion, UnitQuaternion, Vector3};
use thiserror::Error;

use super::{AXES, Quat, Vec3};
use crate::num::{Dd, Precise, Real};

/// A pair of components, or a sine, below this is rounding: the outer angles are then not two but one.
const LOCK: f64 = f64::EPSILON;

/// One of the twelve sequences of axes, by name: `xyx`, `xyz`, …, `zyz`.
///
/// ```
/// use polhode::rotation::EulerSequence;
/// let lecture: EulerSequence = "zxz".parse()?;
/// let attitude = lecture.attitude([0.3, 0.5, -0.2]);
/// let found = lecture.angles(attitude);
/// assert!((found.angles[1] - 0.5).abs() < 1e-15 && !found.locked);
/// # Ok::<(), polhode::rotation::EulerSequenceError>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct EulerSequence([usize; 3]);

/// Three angles, rad, in the order of the sequence.
///
/// ```
/// use polhode::rotation::EulerSequence;
/// let yaw_pitch_roll: EulerSequence = "zyx".parse()?;
/// let upright = yaw_pitch_roll.attitude([0.3, core::f64::consts::FRAC_PI_2, 0.2]);
/// let found = yaw_pitch_roll.angles(upright);
/// assert!(found.locked && found.angles[2] == 0.0);
/// # Ok::<(), polhode::rotation::EulerSequenceError>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[must_use]
#[non_exhaustive]
pub struct EulerAngles {
    /// The outer two in (−π, π], the middle one in [0, π] if the outer axes agree, else in [−π/2, π/2].
    pub angles: [f64; 3],
    /// Gimbal lock: both outer axes lie on one line, only the sum or the difference of their angles is determined,
    /// and the third has been chosen 0. The attitude is right all the same.
    pub locked: bool,
}

impl EulerSequence {
    /// All twelve, sorted by name.
    pub const ALL: [EulerSequence; 12] = [
        EulerSequence([0, 1, 0]),
        EulerSequence([0, 1, 2]),
        EulerSequence([0, 2, 0]),
        EulerSequence([0, 2, 1]),
        EulerSequence([1, 0, 1]),
        EulerSequence([1, 0, 2]),
        EulerSequence([1, 2, 0]),
        EulerSequence([1, 2, 1]),
        EulerSequence([2, 0, 1]),
        EulerSequence([2, 0, 2]),
        EulerSequence([2, 1, 0]),
        EulerSequence([2, 1, 2]),
    ];

    /// The axes, from 0, in the order of the turns.
    #[must_use]
    pub fn axes(self) -> [usize; 3] {
        self.0
    }

    /// The attitude with these angles, rad, each finite; each component is rounded once, but for angles beyond 2¹⁰⁰ rad,
    /// where the sine of the exact number is known to the digits of an `f64`.
    pub fn attitude(self, angles: [f64; 3]) -> UnitQuaternion<f64> {
        let q = self.turn(0, angles) * self.turn(1, angles) * self.turn(2, angles);
        let [w, x, y, z] = q.components().map(Dd::hi);
        UnitQuaternion::new_unchecked(Quaternion::new(w, x, y, z))
    }

    /// The angles of an attitude.
    pub fn angles(self, attitude: UnitQuaternion<f64>) -> EulerAngles {
        let [i, j, _] = self.0;
        let l = 3 - i - j;
        let q = Quat::<Dd>::of(attitude.into()).normalized();
        let cyclic = (i + 1) % 3 == j;
        let sign = |positive: bool, x: Dd| if positive { x } else { -x };
        // R_k is R_i between quarter turns about j, so that q times such a turn has outer axes that agree
        let q = if self.is_proper() {
            q
        } else {
            let quarter = Vec3::unit(j) * sign(!cyclic, Dd::ONE);
            (q * Quat::new(Dd::ONE, quarter)).normalized()
        };
        let upright = self.is_proper() || !cyclic;
        let (a, b) = (q.w, q.v[i]);
        let (c, d) = (sign(upright, q.v[j]), sign(upright == cyclic, q.v[l]));
        let (along, across) = ((a * a + b * b).sqrt(), (c * c + d * d).sqrt());

        let two = Dd::of(2.0);
        let (half_sum, half_difference) = (b.atan2(a), d.atan2(c));
        let (first, tilt, third, locked) = if across.hi() < LOCK {
            (half_sum * two, Dd::ZERO, Dd::ZERO, true)
        } else if along.hi() < LOCK {
            (half_difference * two, Dd::PI, Dd::ZERO, true)
        } else {
            (half_sum + half_difference, across.atan2(along) * two, half_sum - half_difference, false)
        };
        let middle = if self.is_proper() { tilt } else { sign(!cyclic, tilt - Dd::FRAC_PI_2) };
        let within_turn = |x: Dd| x - (x / Dd::TAU).round() * Dd::TAU;
        EulerAngles { angles: [within_turn(first), middle, within_turn(third)].map(Dd::hi), locked }
    }

    /// Angular velocity in body axes, rad/s, of these angles changing at these rates.
    pub fn omega_body(self, angles: [f64; 3], rates: [f64; 3]) -> Vector3<f64> {
        let [i, j, k] = self.0;
        let rate = rates.map(Dd::of);
        let after_second = self.turn(1, angles).rotate_back(Vec3::unit(i) * rate[0]);
        let after_third = self.turn(2, angles).rotate_back(after_second + Vec3::unit(j) * rate[1]);
        (after_third + Vec3::unit(k) * rate[2]).map(Dd::hi).into()
    }

    /// The rates, rad/s, at which these angles change under an angular velocity in body axes.
    ///
    /// In gimbal lock the first rate is chosen 0, and there are none (`None`) if the body turns about the direction
    /// that no rate reaches.
    pub fn rates(self, angles: [f64; 3], omega_body: Vector3<f64>) -> Option<[f64; 3]> {
        let [i, j, k] = self.0;
        let l = 3 - j - k;
        let omega = self.turn(2, angles).rotate(Vec3::of(omega_body.into()));
        let first_axis = self.turn(1, angles).rotate_back(Vec3::unit(i));
        let first = if first_axis[l].magnitude() >= LOCK {
            omega[l] / first_axis[l]
        } else if omega[l].magnitude() <= 4.0 * LOCK * omega.magnitude() {
            Dd::ZERO
        } else {
            return None;
        };
        Some([first, omega[j], omega[k] - first * first_axis[k]].map(Dd::hi))
    }

    /// Whether the outer axes agree, as in `zxz`.
    fn is_proper(self) -> bool {
        self.0[0] == self.0[2]
    }

    /// The turn number `n` of the sequence.
    fn turn(self, n: usize, angles: [f64; 3]) -> Quat<Dd> {
        let (sin, cos) = Dd::of(0.5 * angles[n]).sin_cos();
        Quat::new(cos, Vec3::unit(self.0[n]) * sin)
    }
}

impl Default for EulerSequence {
    /// `zxz`: precession, nutation and spin.
    fn default() -> Self {
        EulerSequence([2, 0, 2])
    }
}

impl fmt::Display for EulerSequence {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let [i, j, k] = self.0.map(|axis| AXES[axis]);
        write!(f, "{i}{j}{k}")
    }
}

/// The text names no sequence.
#[derive(Clone, Debug, PartialEq, Eq, Error)]
#[error("there is no Euler sequence {text:?}; name three axes, no axis twice in a row, such as zxz or zyx")]
#[non_exhaustive]
pub struct EulerSequenceError {
    /// What was given.
    pub text: String,
}

impl FromStr for EulerSequence {
    type Err = EulerSequenceError;
    fn from_str(text: &str) -> Result<Self, EulerSequenceError> {
        Self::ALL
            .into_iter()
            .find(|sequence| sequence.to_string() == text)
            .ok_or_else(|| EulerSequenceError { text: text.into() })
    }
}

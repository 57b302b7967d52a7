//! How far two attitudes are apart.

use super::{Quat, Vec3};
use crate::num::Precise;
use crate::num::trig::sin_cos;

/// Angle in radians of the rotation that takes attitude `a` to attitude `b`, in [0, π].
///
/// `2 atan2(|vec|, |w|)` of `a* ∘ b`: exact to rounding at every angle (an arc cosine loses half the digits
/// near 0 and π), the same for `q` and `−q`, and independent of the norms.
///
/// ```
/// use polhode::rotation::{Quat, rotation_angle};
/// let q = Quat::from_components([1.0, 0.0, 0.0, 1e-9]);
/// assert_eq!(rotation_angle(Quat::identity(), q), 2e-9);
/// ```
pub fn rotation_angle<S: Precise>(a: Quat<S>, b: Quat<S>) -> S {
    let turn = a.conjugate() * b;
    S::of(2.0) * turn.v.norm().atan2(turn.w.abs())
}

/// The rotation by the vector `v`, rad.
pub(crate) fn turn_by(v: Vec3<f64>) -> Quat<f64> {
    let angle = v.norm();
    let (sin, cos) = sin_cos(0.5 * angle);
    Quat::new(cos, v * if angle > 0.0 { sin / angle } else { 0.5 })
}

/// The vector of a rotation, rad, at most half a turn long.
pub(crate) fn rotation_vector(q: Quat<f64>) -> Vec3<f64> {
    let q = if q.w < 0.0 { -q } else { q };
    let sin = q.v.norm();
    q.v * if sin > 0.0 { 2.0 * libm::atan2(sin, q.w) / sin } else { 2.0 }
}

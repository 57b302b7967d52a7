//! How far two attitudes are apart.

use super::Quat;
use crate::num::Precise;

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

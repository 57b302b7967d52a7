//! The turn about a principal axis: the exact flow of `m_i²/(2 I_i)`.

use crate::body::Point;
use crate::num::Real;
use crate::rotation::{Quat, Vec3};

/// As [`turn_about`], about an axis that is known at run time only.
#[inline]
pub(crate) fn turn_about_axis<S: Real>(axis: usize, x: &mut Point<S>, half_rate_time: S) {
    match axis {
        0 => turn_about::<0, S>(x, half_rate_time),
        1 => turn_about::<1, S>(x, half_rate_time),
        _ => turn_about::<2, S>(x, half_rate_time),
    }
}

/// Turns `x` about `AXIS` by the angle `2 · half_rate_time · m_AXIS`, rounding errors carried: the exact flow of the kinetic
/// energy of one axis (McLachlan, Phys. Rev. Lett. 71 (1993) 3043).
///
/// The momentum turns by `v = 2 sin²` and `w = 2 sin cos` of the *half* angle, both from the same sine: then
/// `v² + w² − 2v` is a rounding error of random sign, and |m| walks at random instead of drifting. The quaternion
/// takes the same sine and cosine, so that `q m q*` keeps its direction. The axis is a constant so that the state
/// stays in registers.
#[inline]
pub(crate) fn turn_about<const AXIS: usize, S: Real>(x: &mut Point<S>, half_rate_time: S) {
    turn_by::<AXIS, S>(x, (x.momentum_body[AXIS] * half_rate_time).sin_cos());
}

/// The same by an angle of which half is at most [`SMALL`](crate::num::trig::SMALL).
#[inline(always)]
pub(crate) fn turn_a_little_about<const AXIS: usize, S: Real>(x: &mut Point<S>, half_rate_time: S) {
    turn_by::<AXIS, S>(x, (x.momentum_body[AXIS] * half_rate_time).sin_cos_small());
}

/// The same by sine and cosine of half the angle.
#[inline(always)]
pub(crate) fn turn_by<const AXIS: usize, S: Real>(x: &mut Point<S>, (s, c): (S, S)) {
    let (j, k) = ((AXIS + 1) % 3, (AXIS + 2) % 3);
    let m = x.momentum_body;
    let twice = s + s;
    let (v, w) = (twice * s, twice * c);
    x.add_component(j, w * m[k] - v * m[j]);
    x.add_component(k, -(w * m[j] + v * m[k]));
    // q ∘ (c, s e_i) − q, without the products by zero
    let (q, less) = (x.attitude, S::of(1.0) - c);
    let mut change = Quat::new(-(s * q.v[AXIS] + less * q.w), Vec3::zero());
    change.v[AXIS] = s * q.w - less * q.v[AXIS];
    change.v[j] = s * q.v[k] - less * q.v[j];
    change.v[k] = -(s * q.v[j] + less * q.v[k]);
    x.add_attitude(change);
}

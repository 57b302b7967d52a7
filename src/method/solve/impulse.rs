//! A turn of a body that leaves its momentum in space alone.

use crate::body::Point;
use crate::num::Real;
use crate::rotation::{Quat, Vec3};

/// `q ← q ∘ p`, and `m ← p* (m + impulse) p`: the momentum in space changes by the impulse alone, which is in the axes of
/// the body before the turn. The turn has to be below half of one.
#[inline]
pub(in crate::method) fn turn_with_impulse<S: Real>(x: &mut Point<S>, p: Quat<S>, impulse: Vec3<S>) {
    let momentum = x.momentum_body + impulse;
    let across = p.v.cross(momentum);
    x.add_momentum(impulse + (p.v.cross(across) - across * p.w) * S::of(2.0));
    // 1 − w without cancellation
    let less_one = Quat::new(-(p.v.norm_squared() / (S::of(1.0) + p.w)), p.v);
    x.add_attitude(x.attitude * less_one);
    x.renormalize_at_times();
}

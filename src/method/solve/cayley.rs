//! The turn of a body by Cayley's map.

use crate::body::Point;
use crate::num::Real;
use crate::rotation::{Quat, Vec3};

/// `q ← q ∘ (1, c)/√(1 + |c|²)`, rounding carried: `p₀ − 1 = −|c|²/(α + √α)` has no cancellation.
#[inline(always)]
pub(in crate::method) fn cayley_turn<S: Real>(x: &mut Point<S>, c: Vec3<S>) {
    let squared = c.norm_squared();
    let alpha = S::of(1.0) + squared;
    let root = alpha.sqrt();
    let less_one = Quat::new(-(squared / (alpha + root)), c * (S::of(1.0) / root));
    x.add_attitude(x.attitude * less_one);
    x.renormalize_at_times();
}

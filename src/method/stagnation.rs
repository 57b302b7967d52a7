//! Fixed-point iteration that ends when rounding lets it get no further.

use crate::num::Real;
use crate::rotation::Vec3;

/// More sweeps than any step below 60° of turn takes; a step that needs them has left the range of the iteration.
const SWEEPS: u32 = 60;

/// Iterates `next` from `start` until the change stops decreasing (Hairer, McLachlan and Razakarivony, BIT 48
/// (2008) 231): a fixed tolerance would leave a systematic error that drifts. Returns the last iterate and its
/// change relative to its size.
#[inline]
pub(super) fn iterate<S: Real>(start: Vec3<S>, mut next: impl FnMut(Vec3<S>) -> Vec3<S>) -> (Vec3<S>, f64) {
    let mut x = start;
    let mut change = f64::INFINITY;
    for _ in 0..SWEEPS {
        let new = next(x);
        let moved = (new - x).magnitude();
        x = new;
        if moved == 0.0 {
            return (x, 0.0);
        }
        if moved >= change {
            change = moved;
            break;
        }
        change = moved;
    }
    (x, change / x.magnitude())
}

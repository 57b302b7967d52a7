//! Fixed-point iteration that ends when rounding lets it get no further.

use crate::body::Phase;
use crate::num::Real;
use crate::rotation::Vec3;

/// More sweeps than any step below 50° of turn takes; a step that needs them has left the range of the iteration.
const SWEEPS: u32 = 100;

/// Above this many roundoffs of the size a change that does not decrease is no stagnation but a coincidence, or a
/// contraction that turns: only a change this small can be made of rounding.
const ROUNDING: f64 = 64.0;

/// Iterates `next` from `start` until the change stops decreasing (Hairer, McLachlan and Razakarivony, BIT 48
/// (2008) 231): a fixed tolerance would leave a systematic error that drifts. Returns the last iterate and its
/// change relative to `size`, that of the momenta which the sums of `next` are rounded at.
#[inline]
pub(in crate::method) fn iterate<S: Real>(
    size: f64,
    start: Vec3<S>,
    mut next: impl FnMut(Vec3<S>) -> Vec3<S>,
) -> (Vec3<S>, f64) {
    stagnate::<S, _>(size, start, |x| next(*x), |new, x| (*new - *x).magnitude())
}

/// The same of attitudes and momenta; a change of an attitude counts as one of a momentum `size` times as large.
#[inline]
pub(in crate::method) fn iterate_phases<S: Real, const N: usize>(
    size: f64,
    start: [Phase<S>; N],
    next: impl FnMut(&[Phase<S>; N]) -> [Phase<S>; N],
) -> ([Phase<S>; N], f64) {
    stagnate::<S, _>(size, start, next, |new, x| {
        let changes = new.iter().zip(x).map(|(new, x)| {
            let momentum = (new.momentum_body - x.momentum_body).magnitude();
            momentum.max((new.attitude - x.attitude).magnitude() * size)
        });
        changes.fold(0.0, f64::max)
    })
}

/// Iterates `next`, `distance` being the change from one iterate to the next.
#[inline]
fn stagnate<S: Real, X>(
    size: f64,
    start: X,
    mut next: impl FnMut(&X) -> X,
    distance: impl Fn(&X, &X) -> f64,
) -> (X, f64) {
    let mut x = start;
    let mut change = f64::INFINITY;
    for _ in 0..SWEEPS {
        let new = next(&x);
        let moved = distance(&new, &x);
        x = new;
        if moved == 0.0 {
            return (x, 0.0);
        }
        let stagnates = moved >= change && moved <= ROUNDING * S::ROUNDOFF * size;
        change = moved;
        if stagnates {
            break;
        }
    }
    (x, change / size)
}

//! The turn about a principal axis: the exact flow of `m_i²/(2 I_i)`.

use super::Flow;
use crate::body::{Body, Carry, State};
use crate::num::Real;
use crate::rotation::{Quat, Vec3};

/// The exact flow of the kinetic energy of one axis, `H_i = m_i² / (2 I_i)` (methods.md §4.1).
///
/// Φ_t: with θ = t m_i / I_i, turn (m_j, m_k) by −θ about axis i and the attitude by θ on the right;
/// (i, j, k) cyclic. Keeps m_i, |m| and the momentum in space.
#[derive(Clone, Copy, Debug)]
pub struct AxisTurn<S> {
    axis: usize,
    half_rate: S,
}

impl<S: Real> AxisTurn<S> {
    /// The turn about axis 0, 1 or 2 of `body`.
    pub fn new(body: &Body, axis: usize) -> Self {
        AxisTurn { axis, half_rate: body.inverse_moments::<S>()[axis] * S::of(0.5) }
    }
}

impl<S: Real> Flow<S> for AxisTurn<S> {
    fn flow(&self, t: S, x: &mut State<S>) {
        let mut carry = Carry::default();
        turn(x, &mut carry, self.axis, t * self.half_rate);
        carry.renormalize(x);
    }
}

/// Turns `x` about `axis` by the angle `2 · half_rate_time · m_axis`, rounding errors carried.
///
/// The momentum turns by `v = 2 sin²` and `w = 2 sin cos` of the *half* angle, both from the same sine: then
/// `v² + w² − 2v` is a rounding error of random sign, and |m| walks at random instead of drifting. The quaternion
/// takes the same sine and cosine, so that `q m q*` keeps its direction.
#[inline]
pub fn turn<S: Real>(x: &mut State<S>, carry: &mut Carry<S>, axis: usize, half_rate_time: S) {
    let (j, k) = ((axis + 1) % 3, (axis + 2) % 3);
    let m = x.momentum_body;
    let (s, c) = (m[axis] * half_rate_time).sin_cos();
    let twice = s + s;
    let (v, w) = (twice * s, twice * c);
    carry.add_component(x, j, w * m[k] - v * m[j]);
    carry.add_component(x, k, -(w * m[j]) - v * m[k]);
    let q = x.attitude;
    let along = Quat::new(S::of(0.0), Vec3::unit(axis) * s);
    carry.add_attitude(x, q * along - q * (S::of(1.0) - c));
}

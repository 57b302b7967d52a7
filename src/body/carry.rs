//! What rounding takes from a state, carried to the next step.

use super::State;
use crate::num::Real;
use crate::num::sum::add_carried;
use crate::rotation::{Quat, Vec3};

/// The low-order part of a state that is advanced by increments (Kahan's compensated sum, component by component).
///
/// Compensation turns the rounding of `m += δ` from one unit of m per step into one unit of δ: a random walk that
/// starts thousands of times lower.
#[derive(Clone, Copy, Debug)]
pub struct Carry<S>(State<S>);

impl<S: Real> Default for Carry<S> {
    fn default() -> Self {
        Carry(State::zero())
    }
}

impl<S: Real> Carry<S> {
    /// `m += delta`.
    #[inline]
    pub fn add_momentum(&mut self, x: &mut State<S>, delta: Vec3<S>) {
        for k in 0..3 {
            self.add_component(x, k, delta[k]);
        }
    }

    /// `m[axis] += delta`.
    #[inline]
    pub fn add_component(&mut self, x: &mut State<S>, axis: usize, delta: S) {
        add_carried(&mut x.momentum_body[axis], &mut self.0.momentum_body[axis], delta);
    }

    /// `q += delta`.
    #[inline]
    pub fn add_attitude(&mut self, x: &mut State<S>, delta: Quat<S>) {
        add_carried(&mut x.attitude.w, &mut self.0.attitude.w, delta.w);
        for k in 0..3 {
            add_carried(&mut x.attitude.v[k], &mut self.0.attitude.v[k], delta.v[k]);
        }
    }

    /// Brings |q| back to 1 to first order, `q += ½ (1 − |q|²) q`, without losing what is carried.
    #[inline]
    pub fn renormalize(&mut self, x: &mut State<S>) {
        let q = x.attitude;
        let defect = (S::of(1.0) - q.norm_squared()) * S::of(0.5);
        self.add_attitude(x, q * defect);
    }
}

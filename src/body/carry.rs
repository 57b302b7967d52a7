//! What rounding takes from a state, carried to the next step.

use super::State;
use crate::num::Real;
use crate::num::sum::{Compensated, add_carried, exact_product};
use crate::rotation::{Quat, Vec3};

/// The low-order part of a state that is advanced by increments (Kahan's compensated sum, component by component).
///
/// Compensation turns the rounding of `m += δ` from one unit of m per step into one unit of δ: a random walk that
/// starts thousands of times lower.
#[derive(Clone, Copy, Debug)]
pub struct Carry<S> {
    state: State<S>,
    steps: u32,
}

/// Steps between renormalisations: meanwhile |q| walks by a few units of rounding.
const RENORMALIZE_EVERY: u32 = 8;

impl<S: Real> Default for Carry<S> {
    fn default() -> Self {
        Carry { state: State::zero(), steps: 0 }
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
        add_carried(&mut x.momentum_body[axis], &mut self.state.momentum_body[axis], delta);
    }

    /// `q += delta`.
    #[inline]
    pub fn add_attitude(&mut self, x: &mut State<S>, delta: Quat<S>) {
        add_carried(&mut x.attitude.w, &mut self.state.attitude.w, delta.w);
        for k in 0..3 {
            add_carried(&mut x.attitude.v[k], &mut self.state.attitude.v[k], delta.v[k]);
        }
    }

    /// Ends a step: from time to time |q| is brought back to 1.
    #[inline]
    pub fn end_step(&mut self, x: &mut State<S>) {
        self.steps += 1;
        if self.steps == RENORMALIZE_EVERY {
            self.steps = 0;
            self.renormalize(x);
        }
    }

    /// Brings |q| back to 1 to first order, `q += ½ (1 − |q|²) q`.
    ///
    /// |q|² includes what is carried, to twice the digits: a defect of the rounded q alone is noise that the carry
    /// already holds, and feeding it back turns L steadily, by 1e-20 of it a step.
    pub fn renormalize(&mut self, x: &mut State<S>) {
        let (q, low) = (x.attitude, self.state.attitude.components());
        let mut excess = Compensated::new(S::of(-1.0));
        for (q, low) in q.components().into_iter().zip(low) {
            let (square, rest) = exact_product(q, q);
            excess.add(square);
            excess.add(rest + (q + q) * low);
        }
        self.add_attitude(x, q * (excess.value() * S::of(-0.5)));
    }
}

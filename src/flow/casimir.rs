//! The turn about the momentum: the exact flow of |m|².

use super::Flow;
use crate::body::{Point, Time};
use crate::num::Real;
use crate::rotation::Quat;

/// The exact flow of the energy of a ball, `H = |m|²/(2 I)`.
///
/// Φ_t: the body turns about m by the angle |m| t/I; m stays, in the body and in space. It commutes with every flow
/// of a function of m.
#[derive(Clone, Copy, Debug)]
pub struct Casimir<S> {
    inverse_moment: S,
}

impl<S: Real> Casimir<S> {
    /// The turn with the reciprocal moment of inertia `inverse_moment`, in the scale of the solver frame.
    pub fn new(inverse_moment: S) -> Self {
        Casimir { inverse_moment }
    }
}

impl<S: Real> Flow<S> for Casimir<S> {
    #[inline]
    fn flow(&self, _: Time, t: S, x: &mut Point<S>) {
        let m = x.momentum_body;
        let size = m.norm();
        if size.magnitude() == 0.0 {
            return;
        }
        // half of the half angle: 1 − cos without cancellation
        let (s, c) = (size * t * self.inverse_moment * S::of(0.25)).sin_cos();
        let twice = s + s;
        x.add_attitude(x.attitude * Quat::new(-(twice * s), m * (twice * c / size)));
    }
}

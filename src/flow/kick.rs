//! The kick of a potential: the exact flow of the potential energy alone.

use super::Flow;
use crate::body::{Body, Carry, Gravity, State};
use crate::num::Real;

/// The exact flow of U(q): the attitude stays, Φ_t: `m ← m + t τ(q)`. For a free body nothing happens.
///
/// Keeps L_z: the torque of gravity has no part along the vertical.
#[derive(Clone, Copy, Debug)]
pub struct Kick<S> {
    gravity: Option<Gravity<S>>,
}

impl<S: Real> Kick<S> {
    /// The kick of the gravity on `body`.
    pub fn new(body: &Body) -> Self {
        Kick { gravity: body.gravity() }
    }

    /// The same, rounding errors carried.
    #[inline]
    pub fn carried(&self, t: S, x: &mut State<S>, carry: &mut Carry<S>) {
        if let Some(gravity) = &self.gravity {
            carry.add_momentum(x, gravity.torque(x.attitude) * t);
        }
    }
}

impl<S: Real> Flow<S> for Kick<S> {
    fn flow(&self, t: S, x: &mut State<S>) {
        if let Some(gravity) = &self.gravity {
            x.momentum_body = x.momentum_body + gravity.torque(x.attitude) * t;
        }
    }
}

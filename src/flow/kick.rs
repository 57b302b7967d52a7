//! The kick of a potential: the exact flow of the potential energy alone.

use core::marker::PhantomData;

use super::Flow;
use crate::body::{Field, Point, Time};
use crate::num::Real;
use crate::rotation::Vec3;

/// The exact flow of U at fixed time and attitude: Φ_t: `m ← m + t τ(at, q)`.
///
/// In a linear potential, as under gravity, it keeps L_z, as the torque has no part along the vertical. Where nothing acts nothing happens.
#[derive(Clone, Debug)]
pub struct Kick<S, F> {
    field: F,
    scalar: PhantomData<S>,
}

impl<S: Real, F: Field<S>> Kick<S, F> {
    /// The kick of `field`, which must not depend on the angular velocity.
    pub fn new(field: F) -> Self {
        Kick { field, scalar: PhantomData }
    }

    #[inline]
    pub(crate) fn field(&self) -> &F {
        &self.field
    }
}

impl<S: Real, F: Field<S>> Flow<S> for Kick<S, F> {
    #[inline]
    fn flow(&self, at: Time, t: S, x: &mut Point<S>) {
        if F::ACTS {
            x.add_momentum(self.field.torque(at, x.attitude, Vec3::zero()) * t);
        }
    }
}

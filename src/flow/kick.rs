//! The kick of a potential: the exact flow of the potential energy alone.

use core::marker::PhantomData;

use super::Flow;
use crate::body::{Field, Point, Time};
use crate::num::Real;
use crate::rotation::Vec3;

/// The exact flow of U at fixed time and attitude: Φ_t: `m ← m + t τ(at, q)`.
///
/// In a linear potential, as under gravity, it keeps L_z, as the torque has no part along the vertical. Where nothing acts nothing happens.
/// t and `at` in seconds; m and τ along the principal axes, divided by [`Body::scale`](crate::body::Body::scale).
///
/// ```
/// use nalgebra::{UnitQuaternion, Vector3};
/// use polhode::body::{Body, LinearPotential, Time};
/// use polhode::flow::{Flow, Kick};
/// use polhode::inertia::Inertia;
/// let top = Body::heavy(Inertia::from_moments([1.0, 1.0, 0.25])?, Vector3::new(0.0, 0.0, 2.0))?;
/// let tilted = UnitQuaternion::from_axis_angle(&Vector3::x_axis(), 0.5);
/// let mut x = top.enter(&top.state(tilted, Vector3::zeros())?)?.to_f64();
/// let gravity: LinearPotential<f64> = top.linear_potential().ok_or("no weight")?;
/// Kick::new(gravity).flow(Time::from_seconds(0.0), 0.1, &mut x);
/// assert!((top.leave(&x).momentum().x - 0.1 * 2.0 * libm::sin(0.5)).abs() < 1e-15); // it falls
/// # Ok::<(), polhode::Error>(())
/// ```
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
    #[inline(always)]
    fn flow(&self, at: Time, t: S, x: &mut Point<S>) {
        if F::ACTS {
            x.add_momentum(self.field.torque(at, x.attitude, Vec3::zero()) * t);
        }
    }
}

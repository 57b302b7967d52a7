//! The forces of the cases.

use crate::body::{Conserved, Potential, Time, Torque};
use crate::num::Real;
use crate::rotation::{Quat, Vec3};

/// Linear and quadratic in the vertical, like gravity and a gradient: U = a·Γ + ½ Γ·BΓ, B diagonal. Keeps E and L_z.
#[derive(Clone, Copy, Debug)]
pub(super) struct OfTheVertical {
    pub(super) linear: [f64; 3],
    pub(super) quadratic: [f64; 3],
}

impl<S: Real> Potential<S> for OfTheVertical {
    fn energy(&self, _: Time, attitude: Quat<S>) -> S {
        let up = attitude.rotate_back(Vec3::unit(2));
        up.dot(Vec3::of(Vec3(self.linear))) + up.times(Vec3::of(Vec3(self.quadratic))).dot(up) * S::of(0.5)
    }
    fn torque(&self, _: Time, attitude: Quat<S>) -> Vec3<S> {
        let up = attitude.rotate_back(Vec3::unit(2));
        up.cross(Vec3::of(Vec3(self.linear)) + up.times(Vec3::of(Vec3(self.quadratic))))
    }
    fn conserved(&self) -> Vec<Conserved> {
        vec![Conserved::Energy, Conserved::MomentumZ]
    }
}

/// A torque of time, attitude and angular velocity, along no axis and smooth, of this size.
#[derive(Clone, Copy, Debug)]
pub(super) struct Pushed(pub(super) f64);

impl<S: Real> Torque<S> for Pushed {
    fn torque(&self, at: Time, attitude: Quat<S>, omega_body: Vec3<S>) -> Vec3<S> {
        let (sin, cos) = (at.seconds::<S>() * S::of(1.5)).sin_cos();
        let push = attitude.rotate_back(Vec3([cos, sin, S::of(0.5)]));
        (push - omega_body * S::of(0.25)) * S::of(self.0)
    }
}

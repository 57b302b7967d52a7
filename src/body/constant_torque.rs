//! Torques that are constant in the body or in space.

use nalgebra::Vector3;

use super::force::finite;
use super::{Force, ForceError, Time, Torque};
use crate::num::Real;
use crate::rotation::{Quat, Vec3};

#[derive(Clone, Copy, Debug)]
struct InBody(Vec3<f64>);

#[derive(Clone, Copy, Debug)]
struct InSpace(Vec3<f64>);

impl Force {
    /// The torque `torque`, N m, constant in body axes, such as a thruster's.
    ///
    /// # Errors
    /// Components that are not finite.
    pub fn constant_torque_body(torque: Vector3<f64>) -> Result<Self, ForceError> {
        const NAME: &str = "torque constant in the body";
        Ok(Force::torque(NAME, InBody(components(NAME, torque)?)))
    }

    /// The torque `torque`, N m, constant in the axes of space: L = L₀ + τ t.
    ///
    /// # Errors
    /// Components that are not finite.
    pub fn constant_torque_space(torque: Vector3<f64>) -> Result<Self, ForceError> {
        const NAME: &str = "torque constant in space";
        Ok(Force::torque(NAME, InSpace(components(NAME, torque)?)))
    }
}

fn components(force: &'static str, torque: Vector3<f64>) -> Result<Vec3<f64>, ForceError> {
    for component in torque.iter() {
        finite(force, "a component of the torque", *component)?;
    }
    Ok(torque.into())
}

impl<S: Real> Torque<S> for InBody {
    fn torque(&self, _: Time, _: Quat<S>, _: Vec3<S>) -> Vec3<S> {
        Vec3::of(self.0)
    }
}

impl<S: Real> Torque<S> for InSpace {
    fn torque(&self, _: Time, attitude: Quat<S>, _: Vec3<S>) -> Vec3<S> {
        attitude.rotate_back(Vec3::of(self.0))
    }
}

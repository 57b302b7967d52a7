//! A torque τ₀ that is constant in body axes.

use nalgebra::{Matrix3, Vector3};

use crate::columns::effect::{Class, Effect, Label};
use crate::columns::equation::Equation;
use crate::signal::terms::Terms;

/// The component by its axis.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Constant(pub(crate) usize);

impl Effect for Constant {
    fn label(&self) -> Label {
        Label::new(["torque_x", "torque_y", "torque_z"][self.0.min(2)], "rad/s^2", 2)
    }

    fn class(&self) -> Class {
        Class::Torque
    }

    fn add_to(&self, terms: &mut Terms, value: f64) {
        terms.constant[self.0] += value;
    }

    fn derivative(&self, equation: &Equation<'_>) -> Vector3<f64> {
        Vector3::ith(self.0, -equation.motion.area)
    }

    fn acceleration(&self, inverse: &Matrix3<f64>, _w: &Vector3<f64>) -> Option<Vector3<f64>> {
        Some(inverse * Vector3::ith(self.0, 1.0))
    }
}

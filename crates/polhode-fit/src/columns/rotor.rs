//! A constant momentum inside the body, as of a wheel that nobody knows of.

use nalgebra::Vector3;

use crate::columns::effect::{Class, Effect, Label};
use crate::columns::equation::Equation;

/// The component by its axis, over that of the body.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Rotor(pub(crate) usize);

impl Effect for Rotor {
    fn label(&self) -> Label {
        Label::new(["wheel_x", "wheel_y", "wheel_z"][self.0.min(2)], "of |L|", 0)
    }

    fn class(&self) -> Class {
        Class::Momentum
    }

    fn derivative(&self, equation: &Equation<'_>) -> Vector3<f64> {
        equation.motion.value.cross(&Vector3::ith(self.0, 1.0))
    }
}

//! An error of one component of the momentum of wheels as it is told.

use nalgebra::Vector3;

use crate::columns::effect::{Class, Effect, Label};
use crate::columns::equation::Equation;
use crate::signal::terms::Terms;

/// What the component, by its axis, has beyond the factor of all wheel momenta and torques.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct WheelAxis(pub(crate) usize);

impl Effect for WheelAxis {
    fn label(&self) -> Label {
        Label::new(["told_x", "told_y", "told_z"][self.0.min(2)], "1/(kg m^2)", 0)
    }

    fn class(&self) -> Class {
        Class::Momentum
    }

    fn add_to(&self, terms: &mut Terms, value: f64) {
        terms.of_wheel[self.0] += value;
    }

    fn derivative(&self, equation: &Equation<'_>) -> Vector3<f64> {
        let Equation { terms, motion, inputs, .. } = equation;
        let factors = Vector3::ith(self.0, 1.0);
        inputs.map_or(Vector3::zeros(), |i| motion.by_component(terms, i, &factors))
    }
}

//! The factor of wheel momenta and known torques: one over the trace of the tensor.

use nalgebra::Vector3;

use crate::columns::effect::{Class, Effect, Label};
use crate::columns::equation::Equation;
use crate::signal::terms::Terms;

/// The factor.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Input;

impl Effect for Input {
    fn label(&self) -> Label {
        Label::new("inverse_trace", "1/(kg m^2)", 0)
    }

    fn class(&self) -> Class {
        Class::Input
    }

    fn add_to(&self, terms: &mut Terms, value: f64) {
        terms.input += value;
    }

    fn derivative(&self, equation: &Equation<'_>) -> Vector3<f64> {
        let Equation { terms, motion, inputs, .. } = equation;
        inputs.map_or(Vector3::zeros(), |i| motion.input(terms, i))
    }
}

//! Drag that slows every rotation alike: the torque −k J ω.

use nalgebra::{Matrix3, Vector3};

use crate::columns::effect::{Class, Effect, Label};
use crate::columns::equation::Equation;
use crate::signal::terms::Terms;

/// k.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Drag;

impl Effect for Drag {
    fn label(&self) -> Label {
        Label::new("drag", "1/s", 1)
    }

    fn class(&self) -> Class {
        Class::Drag
    }

    fn add_to(&self, terms: &mut Terms, value: f64) {
        terms.drag += value;
    }

    fn derivative(&self, equation: &Equation<'_>) -> Vector3<f64> {
        equation.terms.j * equation.motion.value
    }

    fn acceleration(&self, _inverse: &Matrix3<f64>, w: &Vector3<f64>) -> Option<Vector3<f64>> {
        Some(-w)
    }
}

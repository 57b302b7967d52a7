//! Drag that grows with the square of the rate: the torque −c |ω| J ω.

use nalgebra::{Matrix3, Vector3};

use crate::columns::effect::{Class, Effect, Label};
use crate::columns::equation::Equation;
use crate::signal::terms::Terms;

/// c.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Quadratic;

impl Effect for Quadratic {
    fn label(&self) -> Label {
        Label::new("quadratic_drag", "1/rad", 0)
    }

    fn class(&self) -> Class {
        Class::Drag
    }

    fn add_to(&self, terms: &mut Terms, value: f64) {
        terms.quadratic += value;
    }

    fn derivative(&self, equation: &Equation<'_>) -> Vector3<f64> {
        equation.terms.j * equation.by_square
    }

    fn acceleration(&self, _inverse: &Matrix3<f64>, w: &Vector3<f64>) -> Option<Vector3<f64>> {
        Some(-w * w.norm())
    }
}

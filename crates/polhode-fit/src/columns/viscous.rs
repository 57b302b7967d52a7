//! Viscous drag: an entry of the diagonal of D in the torque −D ω.

use nalgebra::{Matrix3, Vector3};

use crate::columns::effect::{Class, Effect, Label};
use crate::columns::equation::Equation;
use crate::signal::terms::Terms;

/// The entry by its axis.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Viscous(pub(crate) usize);

impl Effect for Viscous {
    fn label(&self) -> Label {
        Label::new(["drag_xx", "drag_yy", "drag_zz"][self.0.min(2)], "1/s", 1)
    }

    fn class(&self) -> Class {
        Class::Drag
    }

    fn add_to(&self, terms: &mut Terms, value: f64) {
        terms.viscous[(self.0, self.0)] += value;
    }

    fn derivative(&self, equation: &Equation<'_>) -> Vector3<f64> {
        Vector3::ith(self.0, equation.motion.value[self.0])
    }

    fn acceleration(&self, inverse: &Matrix3<f64>, w: &Vector3<f64>) -> Option<Vector3<f64>> {
        Some(inverse * Vector3::ith(self.0, -w[self.0]))
    }
}

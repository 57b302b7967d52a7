//! Viscous drag: an entry of D in the torque −D ω.

use nalgebra::{Matrix3, Vector3};

use crate::columns::effect::{Class, Effect, Label};
use crate::columns::equation::Equation;
use crate::physical::coordinates::symmetric;
use crate::signal::terms::Terms;

/// The entry by its number in the order xx, yy, zz, xy, xz, yz.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Viscous(pub(crate) usize);

impl Effect for Viscous {
    fn label(&self) -> Label {
        let names = ["drag_xx", "drag_yy", "drag_zz", "drag_xy", "drag_xz", "drag_yz"];
        Label::new(names[self.0.min(5)], "1/s", 1)
    }

    fn class(&self) -> Class {
        Class::Drag
    }

    fn add_to(&self, terms: &mut Terms, value: f64) {
        terms.viscous += symmetric(self.0) * value;
    }

    fn derivative(&self, equation: &Equation<'_>) -> Vector3<f64> {
        symmetric(self.0) * equation.motion.value
    }

    fn acceleration(&self, inverse: &Matrix3<f64>, w: &Vector3<f64>) -> Option<Vector3<f64>> {
        Some(-inverse * symmetric(self.0) * w)
    }
}

//! The torque μ × b on a magnet in the body, in a field b that is fixed in space.
//!
//! It is linear in the nine products of their components, those of the field along the axes that the sensor has at the first sample. With
//! the attitude that the rates tell, each product is a column. As a suspension by a spring it is of the same form.

use nalgebra::{Matrix3, Vector3};

use crate::columns::effect::{Class, Effect, Label};
use crate::columns::equation::Equation;

/// A component of the magnet and one of the field, by their axes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Magnet {
    pub(crate) magnet: usize,
    pub(crate) field: usize,
    /// The stretch at whose first sample the field is told, by its number in the record.
    pub(crate) segment: usize,
}

impl Effect for Magnet {
    fn label(&self) -> Label {
        Label::new("magnet", "rad/s^2", 2)
    }

    fn class(&self) -> Class {
        Class::Torque
    }

    fn derivative(&self, _equation: &Equation<'_>) -> Vector3<f64> {
        Vector3::zeros()
    }

    fn torque_at(&self, to_body: &Matrix3<f64>) -> Option<Vector3<f64>> {
        Some(Vector3::ith(self.magnet, 1.0).cross(&to_body.column(self.field)))
    }
}

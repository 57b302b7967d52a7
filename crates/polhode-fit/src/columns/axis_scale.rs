//! The relative error of scale of one axis of the sensor.

use nalgebra::{Matrix3, Vector3};

use crate::columns::effect::{Class, Effect, Label};
use crate::columns::equation::Equation;
use crate::physical::coordinates::symmetric;
use crate::settings::sensor::SensorPriors;
use crate::signal::terms::Terms;
use crate::thresholds::errors::SCALE;

/// The axis.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct AxisScale(pub(crate) usize);

impl Effect for AxisScale {
    fn label(&self) -> Label {
        Label::new(["scale_x", "scale_y", "scale_z"][self.0.min(2)], "", 0)
    }

    fn class(&self) -> Class {
        Class::Sensor
    }

    fn prior(&self, sensor: &SensorPriors, _rms: f64) -> Option<f64> {
        sensor.axis_scales
    }

    fn reported_size(&self) -> Option<f64> {
        Some(SCALE)
    }

    fn add_to(&self, terms: &mut Terms, value: f64) {
        terms.sensor += self.by_value() * value;
    }

    fn derivative(&self, equation: &Equation<'_>) -> Vector3<f64> {
        equation.by_distortion(&self.by_value())
    }

    fn distortion(&self) -> Option<Matrix3<f64>> {
        Some(self.by_value())
    }
}

impl AxisScale {
    /// The derivative of P.
    fn by_value(&self) -> Matrix3<f64> {
        symmetric(self.0)
    }
}

//! The relative error of scale of one axis of the sensor.

use nalgebra::Matrix3;

use crate::columns::effect::{Class, Effect, Label};
use crate::physical::coordinates::symmetric;
use crate::settings::sensor::SensorPriors;
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

    fn distortion(&self) -> Option<Matrix3<f64>> {
        Some(symmetric(self.0))
    }
}

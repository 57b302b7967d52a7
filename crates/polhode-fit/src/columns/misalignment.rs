//! The angle by which a pair of axes of the sensor is not a right one.

use nalgebra::Matrix3;

use crate::columns::effect::{Class, Effect, Label};
use crate::physical::coordinates::symmetric;
use crate::settings::sensor::SensorPriors;
use crate::thresholds::errors::ALIGNMENT;

/// The third axis.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Misalignment(pub(crate) usize);

impl Effect for Misalignment {
    fn label(&self) -> Label {
        Label::new(["misalignment_yz", "misalignment_xz", "misalignment_xy"][self.0.min(2)], "rad", 0)
    }

    fn class(&self) -> Class {
        Class::Sensor
    }

    fn prior(&self, sensor: &SensorPriors, _rms: f64) -> Option<f64> {
        sensor.misalignment
    }

    fn reported_size(&self) -> Option<f64> {
        Some(ALIGNMENT)
    }

    fn distortion(&self) -> Option<Matrix3<f64>> {
        // xy has z as its third axis, and so on
        Some(symmetric(5 - self.0) * 0.5)
    }
}

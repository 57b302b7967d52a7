//! The relative error of scale that all axes of the sensor share.

use nalgebra::Matrix3;

use crate::columns::effect::{Class, Effect, Label};
use crate::settings::sensor::SensorPriors;
use crate::thresholds::errors::SCALE;

/// The error.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Scale;

impl Effect for Scale {
    fn label(&self) -> Label {
        Label::new("scale", "", 0)
    }

    fn class(&self) -> Class {
        Class::Sensor
    }

    fn prior(&self, sensor: &SensorPriors, _rms: f64) -> Option<f64> {
        sensor.scale
    }

    fn reported_size(&self) -> Option<f64> {
        Some(SCALE)
    }

    fn distortion(&self) -> Option<Matrix3<f64>> {
        Some(Matrix3::identity())
    }
}

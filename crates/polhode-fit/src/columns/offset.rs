//! The offset b of the sensor.

use nalgebra::Vector3;

use crate::columns::effect::{Class, Effect, Label};
use crate::columns::equation::{Equation, crossed};
use crate::settings::sensor::SensorPriors;
use crate::signal::terms::Terms;
use crate::thresholds::errors::OFFSET;

/// The component by its axis.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Offset(pub(crate) usize);

impl Effect for Offset {
    fn label(&self) -> Label {
        Label::new(["offset_x", "offset_y", "offset_z"][self.0.min(2)], "rad/s", 1)
    }

    fn class(&self) -> Class {
        Class::Sensor
    }

    fn prior(&self, sensor: &SensorPriors, rms: f64) -> Option<f64> {
        sensor.offset.map(|sigma| sigma / rms)
    }

    fn reported_size(&self) -> Option<f64> {
        Some(OFFSET)
    }

    fn add_to(&self, terms: &mut Terms, value: f64) {
        terms.offset[self.0] += value;
    }

    fn derivative(&self, equation: &Equation<'_>) -> Vector3<f64> {
        let Equation { terms, motion, inputs, .. } = equation;
        let e = Vector3::ith(self.0, 1.0);
        let square = e * motion.value.transpose() + motion.value * e.transpose();
        let own = -(terms.viscous * e) * motion.area - crossed(&square, &terms.j);
        own - inputs.map_or(Vector3::zeros(), |i| equation.by_wheel(e * i.value.transpose()))
    }

    fn change_of_rate(&self, _reading: &Vector3<f64>) -> Option<Vector3<f64>> {
        Some(-Vector3::ith(self.0, 1.0))
    }

    fn change_of_reading(
        &self,
        _w: &Vector3<f64>,
        _slope: &Vector3<f64>,
        _time: f64,
    ) -> Option<Vector3<f64>> {
        Some(Vector3::ith(self.0, 1.0))
    }
}

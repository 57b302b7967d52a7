//! The delay of the readings of an axis of the sensor against the first: they show the motion of an earlier time.

use nalgebra::Vector3;

use crate::columns::effect::{Class, Effect, Label, SampleChange};
use crate::settings::sensor::SensorPriors;
use crate::signal::moments::Group;
use crate::signal::terms::Terms;
use crate::thresholds::errors::DELAY;

/// The axis.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Skew(pub(crate) usize);

impl Effect for Skew {
    fn label(&self) -> Label {
        Label::new(["skew_x", "skew_y", "skew_z"][self.0.min(2)], "s", -1)
    }

    fn class(&self) -> Class {
        Class::Sensor
    }

    fn prior(&self, sensor: &SensorPriors, rms: f64) -> Option<f64> {
        sensor.skew.map(|sigma| sigma * rms)
    }

    fn reported_size(&self) -> Option<f64> {
        Some(DELAY)
    }

    fn add_to(&self, terms: &mut Terms, value: f64) {
        terms.skew[self.0] += value;
    }

    fn sample_change<'a>(&self, terms: &'a Terms) -> Option<SampleChange<'a>> {
        let axis = self.0;
        let Some(inverse) = terms.j.try_inverse() else { return Some(Box::new(|_, _| Vector3::zeros())) };
        Some(Box::new(move |group: &Group, w: &Vector3<f64>| {
            let momentum = terms.j * w + terms.wheel(&group.wheel);
            let drag = terms.viscous * w + terms.j * w * (w.norm() * terms.quadratic);
            let slope = inverse * (terms.constant - w.cross(&momentum) - drag);
            Vector3::ith(axis, slope[axis])
        }))
    }

    fn change_of_reading(&self, _w: &Vector3<f64>, slope: &Vector3<f64>, _time: f64) -> Option<Vector3<f64>> {
        Some(Vector3::ith(self.0, -slope[self.0]))
    }
}

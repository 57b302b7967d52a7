//! A step of the random walk of an offset.

use nalgebra::Vector3;

use crate::columns::effect::{Class, Effect, Label, SampleChange};
use crate::columns::equation::Equation;
use crate::signal::moments::Group;
use crate::signal::terms::Terms;

/// The change of the offset of an axis from one time to another, in proportion to the time between them.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Walk {
    pub(crate) axis: usize,
    pub(crate) from: f64,
    pub(crate) until: f64,
}

impl Walk {
    /// The share of it at `time`.
    fn share(&self, time: f64) -> f64 {
        ((time - self.from) / (self.until - self.from)).clamp(0.0, 1.0)
    }
}

impl Effect for Walk {
    fn label(&self) -> Label {
        Label::new(["walk_x", "walk_y", "walk_z"][self.axis.min(2)], "rad/s", 1)
    }

    fn class(&self) -> Class {
        Class::Sensor
    }

    fn derivative(&self, _equation: &Equation<'_>) -> Vector3<f64> {
        Vector3::zeros()
    }

    /// To first order: the walk adds nothing to the terms.
    fn sample_change<'a>(&self, _terms: &'a Terms) -> Option<SampleChange<'a>> {
        let walk = *self;
        Some(Box::new(move |group: &Group, _| Vector3::ith(walk.axis, -walk.share(group.time))))
    }

    fn change_of_reading(&self, _w: &Vector3<f64>, _slope: &Vector3<f64>, time: f64) -> Option<Vector3<f64>> {
        Some(Vector3::ith(self.axis, self.share(time)))
    }
}

//! What every unknown beside the tensor can say of itself.

use nalgebra::{Matrix3, Vector3};

use crate::columns::equation::Equation;
use crate::settings::sensor::SensorPriors;
use crate::signal::moments::Group;
use crate::signal::terms::Terms;

/// How an unknown is called in a report.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Label {
    pub(crate) name: &'static str,
    /// Its unit, empty for a ratio.
    pub(crate) unit: &'static str,
    /// The power of the unit rate that it goes with.
    power: i32,
}

impl Label {
    pub(crate) const fn new(name: &'static str, unit: &'static str, power: i32) -> Label {
        Label { name, unit, power }
    }

    /// The factor from the units of the fit to SI; `rms` is the unit rate, rad/s.
    pub(crate) fn factor(&self, rms: f64) -> f64 {
        match self.power {
            2 => rms * rms,
            1 => rms,
            -1 => 1.0 / rms,
            _ => 1.0,
        }
    }
}

/// What an unknown belongs to.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Class {
    /// A torque that takes energy.
    Drag,
    /// Another torque.
    Torque,
    /// An error of the sensor.
    Sensor,
    /// A momentum inside the body that nobody measures.
    Momentum,
    /// The factor of wheel momenta and known torques.
    Input,
}

impl Class {
    /// Whether it is a torque rather than an error of the sensor.
    pub(crate) fn is_torque(self) -> bool {
        matches!(self, Class::Drag | Class::Torque)
    }
}

/// The change of the rates at a group of samples of a given rate.
pub(crate) type SampleChange<'a> = Box<dyn Fn(&Group, &Vector3<f64>) -> Vector3<f64> + 'a>;

/// An unknown beside the tensor, in units of the root mean square rate.
pub(crate) trait Effect {
    /// Its line in a report.
    fn label(&self) -> Label;

    /// What it belongs to.
    fn class(&self) -> Class;

    /// The standard deviation of its prior about zero, in units of the rate `rms`; `None` where the sensor is taken to be
    /// right.
    fn prior(&self, _sensor: &SensorPriors, _rms: f64) -> Option<f64> {
        None
    }

    /// The size of it whose effect on the moments is reported where it is taken to be zero, SI.
    fn reported_size(&self) -> Option<f64> {
        None
    }

    /// What `value` of it makes of torque and sensor.
    fn add_to(&self, terms: &mut Terms, value: f64) {
        if let Some(q) = self.distortion() {
            terms.sensor += q * value;
        }
    }

    /// The derivative of the residual of one test function with respect to it.
    fn derivative(&self, equation: &Equation<'_>) -> Vector3<f64> {
        self.distortion().map_or_else(Vector3::zeros, |q| equation.by_distortion(&q))
    }

    /// Instead of that, where it acts on the samples one by one: the change of their rates with it.
    fn sample_change<'a>(&self, _terms: &'a Terms) -> Option<SampleChange<'a>> {
        None
    }

    /// The derivative of the torque with respect to it, where that depends on how the body has turned: `to_body` takes coordinates along the axes that
    /// the body had at the first sample of the stretch to those along its present ones.
    fn torque_at(&self, _to_body: &Matrix3<f64>) -> Option<Vector3<f64>> {
        None
    }

    /// The derivative of P, where it is an error of scale or alignment: that of ω = P y.
    fn distortion(&self) -> Option<Matrix3<f64>> {
        None
    }

    /// The derivative of ω = P y − b at a reading y, where it changes that.
    fn change_of_rate(&self, reading: &Vector3<f64>) -> Option<Vector3<f64>> {
        self.distortion().map(|q| q * reading)
    }

    /// The derivative of ω' at the rate `w` of a body with this inverse of its tensor, where it is a torque.
    fn acceleration(&self, _inverse: &Matrix3<f64>, _w: &Vector3<f64>) -> Option<Vector3<f64>> {
        None
    }

    /// The derivative of the reading of a rate `w` that changes by `slope`, at `time`; where it is an error of the sensor.
    fn change_of_reading(&self, w: &Vector3<f64>, _slope: &Vector3<f64>, _time: f64) -> Option<Vector3<f64>> {
        self.distortion().map(|q| -q * w)
    }
}

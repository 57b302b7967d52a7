//! What the user may set.

pub(crate) mod known;
pub(crate) mod sensor;
pub(crate) mod torque;

use crate::error::FitError;
use crate::physical::limits::Limit;
use crate::physical::prior::Prior;
use crate::setters::setters;
use crate::settings::known::Known;
use crate::settings::sensor::SensorPriors;
use crate::settings::torque::{TorqueModel, TorqueNoise};

/// What the user may set; the default leaves everything to the record.
///
/// ```
/// use nalgebra::Vector3;
/// use polhode_fit::{Known, Limit, Settings};
/// // test functions of half width 0.5 s, at least 0.4 of the trace about z, and a trace of 5.6 kg m²
/// let limit = Limit { axis: Vector3::z(), at_least: Some(0.4), at_most: None };
/// let settings = Settings::default().with_radius(0.5).with_limits(vec![limit]).with_known(Known::Trace(5.6));
/// assert!(settings.noise.is_none() && settings.check_units);
/// ```
#[non_exhaustive]
#[derive(Clone, Debug, PartialEq)]
pub struct Settings {
    /// Half width of the test functions, s; by default that of the least predicted covariance. If it is given, the answer is that of the
    /// weak form, also where wheels act.
    pub radius: Option<f64>,
    /// Standard deviation of the noise of one component, rad/s, at least 1e-10 of the rates; by default found in the samples.
    pub noise: Option<f64>,
    /// Standard deviation of the noise of one component of the rotation vector of an attitude, rad; by default that of the residuals.
    pub attitude_noise: Option<f64>,
    /// What is known of the moments beforehand.
    pub limits: Vec<Limit>,
    /// A tensor that is known beforehand: it is combined with the record, and supplies what the record leaves open.
    pub prior: Option<Prior>,
    /// A known quantity that gives the tensor in kg m².
    pub known: Option<Known>,
    /// Whether the fit is refused if other units explain the record better.
    pub check_units: bool,
    /// The model of an unknown torque.
    pub torque: TorqueModel,
    /// Step of the readings, rad/s; by default found in the readings. Its rounding is noise of variance
    /// q²/12, times the number of equal readings in a row.
    pub quantum: Option<f64>,
    /// The torque noise.
    pub torque_noise: TorqueNoise,
    /// What may be wrong with the sensor.
    pub sensor: SensorPriors,
    /// Whether samples that jump off their neighbours, alone or in bursts, are left out.
    pub leave_out_spikes: bool,
}

impl Default for Settings {
    fn default() -> Self {
        Settings {
            radius: None,
            noise: None,
            attitude_noise: None,
            limits: Vec::new(),
            prior: None,
            known: None,
            check_units: true,
            torque: TorqueModel::default(),
            quantum: None,
            torque_noise: TorqueNoise::default(),
            sensor: SensorPriors::default(),
            leave_out_spikes: true,
        }
    }
}

impl Settings {
    setters! {
        options {
            radius => with_radius(f64),
            noise => with_noise(f64),
            attitude_noise => with_attitude_noise(f64),
            prior => with_prior(Prior),
            known => with_known(Known),
            quantum => with_quantum(f64),
        }
        values {
            limits => with_limits(Vec<Limit>),
            check_units => with_check_units(bool),
            torque => with_torque(TorqueModel),
            torque_noise => with_torque_noise(TorqueNoise),
            sensor => with_sensor(SensorPriors),
            leave_out_spikes => with_leave_out_spikes(bool),
        }
    }

    /// Whether each value is one that a fit can use.
    pub(super) fn check(&self) -> Result<(), FitError> {
        let known = self.known.map(Known::value);
        let density = match self.torque_noise {
            TorqueNoise::Given(density) => Some(density),
            TorqueNoise::None | TorqueNoise::Fitted => None,
        };
        let own = [
            ("the radius", self.radius),
            ("the noise", self.noise),
            ("the noise of the attitudes", self.attitude_noise),
            ("the known quantity", known),
            ("the torque noise", density),
            ("the quantum", self.quantum),
        ];
        for (name, value) in own.into_iter().chain(self.sensor.named()) {
            if let Some(value) = value.filter(|v| !(v.is_finite() && *v > 0.0)) {
                return Err(FitError::Setting { name, value });
            }
        }
        if let Some(prior) = &self.prior {
            prior.check()?;
        }
        if let Some(Known::Moment { axis, .. }) = self.known {
            let size = axis.norm();
            if !(size > 0.0 && size.is_finite()) {
                return Err(FitError::Setting {
                    name: "the length of the axis of the known moment",
                    value: size,
                });
            }
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::Vector3;

    /// Each value passes while it is positive and finite, and is refused by its name and number otherwise.
    #[test]
    fn values_that_are_not_positive_are_refused_by_their_names() {
        type Set = fn(f64) -> Settings;
        let all: [(&str, Set); 9] = [
            ("the radius", |v| Settings::default().with_radius(v)),
            ("the noise", |v| Settings::default().with_noise(v)),
            ("the noise of the attitudes", |v| Settings::default().with_attitude_noise(v)),
            ("the known quantity", |v| Settings::default().with_known(Known::Trace(v))),
            ("the known quantity", |v| Settings::default().with_known(Known::Momentum(v))),
            ("the known quantity", |v| Settings::default().with_known(Known::TwiceEnergy(v))),
            ("the torque noise", |v| Settings::default().with_torque_noise(TorqueNoise::Given(v))),
            ("the quantum", |v| Settings::default().with_quantum(v)),
            ("the length of the axis of the known moment", |v| {
                let known = Known::Moment { axis: Vector3::y() * v, value: 1.0 };
                Settings::default().with_known(known)
            }),
        ];
        for (expected, set) in all {
            assert!(set(1e-3).check().is_ok(), "{expected}");
            for bad in [0.0, f64::INFINITY] {
                let found = set(bad).check();
                let Err(FitError::Setting { name, .. }) = found else { panic!("{expected}: {found:?}") };
                assert_eq!(name, expected);
            }
        }
        let known = Known::Moment { axis: Vector3::y(), value: -2.5 };
        let found = Settings::default().with_known(known).check();
        assert!(matches!(found, Err(FitError::Setting { name: "the known quantity", value: -2.5 })));
    }

    /// Each deviation of the sensor is refused by its own name.
    #[test]
    fn deviations_of_the_sensor_have_their_own_names() {
        let none = SensorPriors::default();
        for (expected, sensor) in [
            ("the deviation of the offset", none.with_offset(-1.0)),
            ("the deviation of the scale", none.with_scale(-1.0)),
            ("the deviation of the axis scales", none.with_axis_scales(-1.0)),
            ("the deviation of the misalignment", none.with_misalignment(-1.0)),
            ("the deviation of the skew", none.with_skew(-1.0)),
        ] {
            let found = Settings::default().with_sensor(sensor).check();
            let Err(FitError::Setting { name, .. }) = found else { panic!("{expected}: {found:?}") };
            assert_eq!(name, expected);
        }
    }
}

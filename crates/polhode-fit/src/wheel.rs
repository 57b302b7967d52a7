//! The inertia of a wheel from records of a body that is known.

use core::fmt;

use polhode::inertia::Inertia;
use polhode::record::Record;

use crate::columns::column::Column;
use crate::columns::input::Input;
use crate::columns::sets::{sensor_columns, torque_columns};
use crate::error::FitError;
use crate::estimator::{noise_of, read_variance};
use crate::physical::coordinates::coordinates;
use crate::physical::failure::SolverFailure;
use crate::report::nuisance::Nuisance;
use crate::settings::Settings;
use crate::settings::torque::{TorqueModel, TorqueNoise};
use crate::signal::covariance::{Levels, acceleration_density};
use crate::signal::normalised::{Normalised, normalised};
use crate::solve::held::held;
use crate::thresholds::noise::{DEVIATIONS, SURE};
use crate::thresholds::warnings::RESIDUALS;

/// The moment of inertia of a wheel about its axis, and what it was found from.
#[non_exhaustive]
#[derive(Clone, Debug, PartialEq)]
pub struct WheelCalibration {
    /// Moment of inertia about the axis, kg m².
    pub inertia: f64,
    /// Its standard deviation, kg m², enlarged by what the noise does not explain; that of the body's own inertia comes
    /// on top of it, in proportion.
    pub sigma: f64,
    /// What was estimated beside it: torques and errors of the sensor.
    pub nuisances: Vec<Nuisance>,
    /// Half width of the test functions, s.
    pub radius: f64,
    /// Noise of one component of the rates, rad/s.
    pub noise_sigma: f64,
    /// Mean square of the residuals over the noise.
    pub chi2_per_dof: f64,
    /// Equations beyond the unknowns.
    pub dof: usize,
    /// Samples of the segments that were long enough.
    pub samples: usize,
    /// Segments that were long enough.
    pub segments: usize,
    /// What limits the use of the answer.
    pub warnings: Vec<WheelWarning>,
}

/// What limits the use of the moment of a wheel. Its `Display` is a sentence.
#[non_exhaustive]
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum WheelWarning {
    /// The residuals ask for a torque at random.
    TorqueNoise {
        /// Largest power spectral density of the angular acceleration among the segments, the mean of the three components, (rad/s²)² s.
        density: f64,
    },
    /// The residuals exceed the noise.
    Residuals {
        /// Mean square of the residuals over the noise.
        misfit: f64,
    },
    /// The moment is not beyond the deviations that noise brings.
    NoWheel {
        /// The moment, kg m².
        value: f64,
        /// Its standard deviation, kg m².
        sigma: f64,
    },
}

impl fmt::Display for WheelWarning {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let unexplained = "the known body and a wheel about this axis do not explain the rates: check the body, its axes, the axis of the wheel, and drag";
        match self {
            Self::TorqueNoise { density } => write!(
                f,
                "{unexplained}; torque noise is fitted in place of the rest, with an angular acceleration of a power spectral density of up to \
                 {density:.1e} (rad/s^2)^2 s"
            ),
            Self::Residuals { misfit } => {
                write!(
                    f,
                    "{unexplained}; the mean square of the residuals is {misfit:.2} times that of the noise"
                )
            }
            Self::NoWheel { value, sigma } => write!(
                f,
                "the record shows no wheel about this axis: its moment of inertia is {value:.2e} +- {sigma:.1e} kg m^2; check the axis and the \
                 speed of the wheel"
            ),
        }
    }
}

/// The moment of inertia of a wheel from records of a body of known inertia in which it turns.
///
/// The wheel momenta of the segments are those of a wheel of 1 kg m²: its axis times its speed relative to the body,
/// rad/s. The weak form of p' = p × ω with p = J ω + j Ω a is linear in j once J is known; `inertia` is that of the body
/// with the wheel at rest, in sensor axes. Of `settings`, radius, noise, torque (`Auto` stands for none), torque noise,
/// errors of the sensor and spikes are used.
///
/// ```
/// use nalgebra::Vector3;
/// use polhode_fit::{Disturbances, Gyroscope, Record, Segment, Settings, calibrate_wheel, simulate_with};
/// use polhode::{inertia::Inertia, num::Random};
/// let body = Inertia::from_moments([1.0, 2.0, 2.6])?;
/// let times: Vec<f64> = (0..1000).map(|i| f64::from(i) / 100.0).collect();
/// // a wheel of 0.01 kg m² about z, at 30 rad/s
/// let wheel = Disturbances::default().with_wheel(Vector3::z() * 0.3);
/// let gyroscope = Gyroscope::default().with_noise(1e-3);
/// let omega = Vector3::new(0.3, 1.0, 0.4);
/// let rates = simulate_with(&body, omega, &times, &wheel, &gyroscope, &mut Random::new(1))?;
///
/// let mut record = Record::default();
/// let speeds = vec![Vector3::z() * 30.0; times.len()];
/// record.segments.push(Segment::new("proof body", times, rates)?.with_wheel(speeds)?);
/// let wheel = calibrate_wheel(&record, &body, &Settings::default())?;
/// assert!((wheel.inertia - 0.01).abs() < 4.0 * wheel.sigma && wheel.sigma < 1e-4);
/// # Ok::<(), polhode::Error>(())
/// ```
///
/// # Errors
/// As of [`fit`](crate::fit); a record without the speed of a wheel, or with torques; a moment that would be negative.
pub fn calibrate_wheel(
    record: &Record,
    inertia: &Inertia,
    settings: &Settings,
) -> Result<WheelCalibration, FitError> {
    settings.check()?;
    let rest = if settings.leave_out_spikes { record.without_spikes() } else { None };
    let rest = rest.map_or_else(|| record.clone(), |(_, rest)| rest);
    if rest.segments.iter().any(|s| s.torque().is_some()) {
        return Err(FitError::WheelWithTorques);
    }
    let Normalised { stretches, rms, input } = normalised(&rest)?;
    let scale = input.filter(|_| rest.segments.iter().all(|s| s.wheel().is_some()));
    let scale = scale.ok_or(FitError::NoWheelSpeed)?;
    let variance = read_variance(settings, &rest, &stretches, rms)?;
    let mut columns = vec![Column::new(Input, None)];
    if settings.torque != TorqueModel::Auto {
        columns.extend(torque_columns(settings.torque));
    }
    columns.extend(sensor_columns(&settings.sensor, rms));
    let trace = inertia.tensor().trace();
    let j = inertia.tensor() / trace;
    let x = coordinates(&j);
    let noise = noise_of(settings, rms, variance);
    let radius = settings.radius.map(|radius| radius * rms);
    let found = held(&stretches, x, &columns, variance, noise, radius)
        .ok_or(FitError::Solver(SolverFailure::Covariance))?;
    let deviation = found.misfit.max(1.0).sqrt();
    let per_unit = trace / scale;
    let (value, sigma) = (found.values[0] * per_unit, found.sigmas[0] * deviation * per_unit);
    if value < -SURE * sigma {
        return Err(FitError::WheelSense { value, sigma });
    }
    let level = |(_, levels): &(usize, Levels)| levels.torque * acceleration_density(levels.shape, &j);
    let density = found.levels.iter().map(level).fold(0.0, f64::max) * variance * rms * rms * rms;
    let is_fitted = settings.torque_noise == TorqueNoise::Fitted;
    let most = RESIDUALS.max(1.0 + DEVIATIONS * (2.0 / found.dof.max(1) as f64).sqrt());
    let warnings = [
        (is_fitted && density > 0.0).then_some(WheelWarning::TorqueNoise { density }),
        (found.misfit > most).then_some(WheelWarning::Residuals { misfit: found.misfit }),
        (value <= SURE * sigma).then_some(WheelWarning::NoWheel { value, sigma }),
    ];
    let nuisances = (1..columns.len())
        .map(|k| Nuisance::new(&columns[k], found.values[k], found.sigmas[k] * deviation, rms));
    let used = || found.levels.iter().map(|(k, _)| &stretches[*k]);
    Ok(WheelCalibration {
        inertia: value,
        sigma,
        nuisances: nuisances.collect(),
        radius: found.radius / rms,
        noise_sigma: variance.sqrt() * rms,
        chi2_per_dof: found.misfit,
        dof: found.dof,
        samples: used().map(|stretch| stretch.times.len()).sum(),
        segments: used().collect::<Vec<_>>().chunk_by(|a, b| a.segment == b.segment).count(),
        warnings: warnings.into_iter().flatten().collect(),
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn warnings_of_a_calibration_say_their_numbers() {
        for (warning, parts) in [
            (WheelWarning::TorqueNoise { density: 2.5e-3 }, ["check the body, its axes", "up to 2.5e-3"]),
            (
                WheelWarning::Residuals { misfit: 1.75 },
                ["check the body, its axes", "1.75 times that of the noise"],
            ),
            (WheelWarning::NoWheel { value: 1.5e-3, sigma: 0.5 }, ["shows no wheel", "1.50e-3 +- 5.0e-1"]),
        ] {
            let text = warning.to_string();
            assert!(parts.iter().all(|part| text.contains(part)), "{text}");
        }
    }
}

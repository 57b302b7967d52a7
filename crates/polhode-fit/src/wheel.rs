//! The inertia of a wheel from records of a body that is known.

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
use crate::settings::torque::TorqueModel;
use crate::signal::normalised::{Normalised, normalised};
use crate::solve::held::held;

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
/// As of [`fit`](crate::fit); a record without the speed of a wheel, or with torques.
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
    let x = coordinates(&(inertia.tensor() / trace));
    let noise = noise_of(settings, rms, variance);
    let radius = settings.radius.map(|radius| radius * rms);
    let found = held(&stretches, x, &columns, variance, noise, radius)
        .ok_or(FitError::Solver(SolverFailure::Covariance))?;
    let deviation = found.misfit.max(1.0).sqrt();
    let per_unit = trace / scale;
    let nuisances = (1..columns.len())
        .map(|k| Nuisance::new(&columns[k], found.values[k], found.sigmas[k] * deviation, rms));
    let used = || found.levels.iter().map(|(k, _)| &stretches[*k]);
    Ok(WheelCalibration {
        inertia: found.values[0] * per_unit,
        sigma: found.sigmas[0] * deviation * per_unit,
        nuisances: nuisances.collect(),
        radius: found.radius / rms,
        noise_sigma: variance.sqrt() * rms,
        chi2_per_dof: found.misfit,
        dof: found.dof,
        samples: used().map(|stretch| stretch.times.len()).sum(),
        segments: used().collect::<Vec<_>>().chunk_by(|a, b| a.segment == b.segment).count(),
    })
}

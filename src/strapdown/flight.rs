//! Free flights: the exact motion of a known body through the rates of a record.

use nalgebra::{Matrix3, UnitQuaternion, Vector3};
use thiserror::Error;

use super::Sensor;
use super::budget::{Budget, Estimate};
use super::error::StrapdownError;
use crate::body::{State, StateError};
use crate::flow::{FreeMotion, TimeError};
use crate::inertia::Inertia;

/// Samples that the first fit goes through; each further one goes through twice as many.
const FIRST: usize = 16;
/// Rounds of Gauss and Newton for each number of samples, at most.
const ROUNDS: usize = 20;
/// The rounds end where the start changes by less than this part of itself.
const SETTLED: f64 = 1e-10;
/// Differences of the start, relative: third root of the rounding, the best for central differences.
const DIFFERENCE: f64 = 6e-6;
/// Residuals that exceed the known errors of the sensor so many times, and this part of the rates, contradict the body.
const CONTRADICTION: (f64, f64) = (5.0, 0.05);

/// Why no motion of a body goes through the rates.
#[derive(Clone, Debug, PartialEq, Error)]
#[non_exhaustive]
pub enum FlightError {
    /// The samples.
    #[error(transparent)]
    Samples(#[from] StrapdownError),
    /// The start.
    #[error(transparent)]
    Start(#[from] StateError),
    /// A time of the record.
    #[error(transparent)]
    Time(#[from] TimeError),
    /// Too few samples.
    #[error("{samples} samples: the start of a free flight needs at least {FIRST}")]
    Few {
        /// Their number.
        samples: usize,
    },
    /// The body does not turn like this when it is free.
    #[error(
        "the body contradicts the record: its nearest free motion misses the rates by {residual:.2e} rad/s (root mean square) of \
         {rate:.2e} rad/s, where the errors of the sensor are {sensor:.2e} rad/s"
    )]
    Contradicted {
        /// Root mean square of what is left, rad/s.
        residual: f64,
        /// Root mean square of the rates, rad/s.
        rate: f64,
        /// What noise, bias and scale error of the sensor leave, rad/s.
        sensor: f64,
    },
    /// The rates do not determine the start.
    #[error("the rates do not determine the start of the motion: the body is at rest")]
    Undetermined,
}

/// The free motion of a body that fits a record of instantaneous rates best: least squares over its angular velocity at the first sample.
///
/// The rates tell nothing of the attitude at the start, which is given; between them and the attitude stands the exact motion, and the
/// noise of all samples is averaged over the three numbers that are free. Derivatives are central differences of the exact motion.
///
/// ```
/// use nalgebra::{UnitQuaternion, Vector3};
/// use polhode::strapdown::{Flight, Sensor};
/// use polhode::{FreeMotion, Inertia};
/// let body = Inertia::from_moments([1.0, 2.0, 3.0])?;
/// let truth = FreeMotion::from_omega(&body, UnitQuaternion::identity(), Vector3::new(0.4, 1.0, -0.3))?;
/// let times: Vec<f64> = (0..200).map(|k| 0.05 * f64::from(k)).collect();
/// let rates = times.iter().map(|t| truth.omega_at(*t)).collect::<Result<Vec<_>, _>>()?;
/// let flight = Flight::fit(&body, &times, &rates, UnitQuaternion::identity(), Sensor::default().with_noise(1e-3))?;
/// let end = flight.at(&times)?[199];
/// assert!(end.error(truth.at(times[199])?.rotation()).norm() < 1e-9);
/// assert!(end.budget.random_walk < 1e-3); // far less than without the body
/// # Ok::<(), polhode::Error>(())
/// ```
#[derive(Clone, Debug)]
pub struct Flight {
    inertia: Inertia,
    attitude: UnitQuaternion<f64>,
    start: f64,
    omega: Vector3<f64>,
    /// Covariances of the angular velocity at the start by noise, bias, scale and stamps.
    covariances: [Matrix3<f64>; 4],
    residual: f64,
    chi2_per_dof: f64,
}

/// Sums of one round.
struct Normal {
    matrix: Matrix3<f64>,
    gradient: Vector3<f64>,
    square: f64,
    /// Jᵀ and Jᵀ diag ω, summed, and Σ JᵀẇẇᵀJ.
    bias: Matrix3<f64>,
    scale: Matrix3<f64>,
    stamps: Matrix3<f64>,
}

impl Flight {
    /// Of a body with this tensor in the axes of the sensor, at `times` (s, ascending), from the attitude `attitude` at the first.
    ///
    /// # Errors
    /// Lists of different lengths, fewer than 16 samples, numbers that are not finite; rates that the body cannot have.
    pub fn fit(
        inertia: &Inertia,
        times: &[f64],
        rates: &[Vector3<f64>],
        attitude: UnitQuaternion<f64>,
        sensor: Sensor,
    ) -> Result<Flight, FlightError> {
        sensor.check()?;
        if times.len() != rates.len() {
            return Err(StrapdownError::Lengths { times: times.len(), readings: rates.len() }.into());
        }
        let samples = times.len();
        if samples < FIRST {
            return Err(FlightError::Few { samples });
        }
        let elapsed: Vec<f64> = times.iter().map(|t| t - times[0]).collect();
        let mut omega = rates[0];
        let mut count = FIRST;
        let (normal, inverse) = loop {
            let (found, normal, inverse) = settle(inertia, &elapsed[..count], &rates[..count], omega)?;
            omega = found;
            if count == samples {
                break (normal, inverse);
            }
            count = (2 * count).min(samples);
        };
        let dof = (3 * samples - 3) as f64;
        let mean_square = normal.square / dof;
        let square = |x: f64| x * x;
        let rate = (rates.iter().map(Vector3::norm_squared).sum::<f64>() / (3 * samples) as f64).sqrt();
        let known = (square(sensor.noise) + square(sensor.bias) + square(sensor.scale * rate)).sqrt();
        let residual = mean_square.sqrt();
        if residual > CONTRADICTION.0 * known && residual > CONTRADICTION.1 * rate {
            return Err(FlightError::Contradicted { residual, rate, sensor: known });
        }
        // what is left beyond the noise counts as noise
        let noise = mean_square.max(square(sensor.noise));
        let spread = |by: &Matrix3<f64>, sigma: f64| {
            let response = inverse * by;
            response * response.transpose() * square(sigma)
        };
        let covariances = [
            inverse * noise,
            spread(&normal.bias, sensor.bias),
            spread(&normal.scale, sensor.scale),
            inverse * normal.stamps * inverse * square(sensor.stamps),
        ];
        let chi2_per_dof = if sensor.noise > 0.0 { mean_square / square(sensor.noise) } else { f64::NAN };
        Ok(Flight {
            inertia: inertia.clone(),
            attitude,
            start: times[0],
            omega,
            covariances,
            residual,
            chi2_per_dof,
        })
    }

    /// Angular velocity at the first sample, body axes, rad/s.
    #[must_use]
    pub fn omega(&self) -> Vector3<f64> {
        self.omega
    }

    /// Root mean square of what is left of a component of the rates, rad/s.
    #[must_use]
    pub fn residual(&self) -> f64 {
        self.residual
    }

    /// Its square over the variance of the noise; `None` where no noise is given.
    #[must_use]
    pub fn chi2_per_dof(&self) -> Option<f64> {
        Some(self.chi2_per_dof).filter(|chi2| chi2.is_finite())
    }

    /// Attitudes at `times`, s, with their budgets: the truncation is 0, the motion is exact.
    ///
    /// # Errors
    /// A time that is not finite or out of reach of the motion.
    pub fn at(&self, times: &[f64]) -> Result<Vec<Estimate>, FlightError> {
        let elapsed: Vec<f64> = times.iter().map(|t| t - self.start).collect();
        let states = |omega: Vector3<f64>| -> Result<Vec<State>, FlightError> {
            Ok(FreeMotion::from_omega(&self.inertia, self.attitude, omega)?.at_many(&elapsed)?)
        };
        let step = DIFFERENCE * self.omega.norm();
        let unit = |axis: usize| Vector3::ith(axis, step);
        let middle = states(self.omega)?;
        let mut sides = Vec::with_capacity(3);
        for axis in 0..3 {
            sides.push([states(self.omega - unit(axis))?, states(self.omega + unit(axis))?]);
        }
        let estimate = |k: usize, state: &State| {
            let column = |axis: usize| {
                let [low, high] = &sides[axis];
                let turn = high[k].attitude * low[k].attitude.conjugate();
                Vector3::from(turn.logarithm()) / (2.0 * step)
            };
            let response = Matrix3::from_columns(&[column(0), column(1), column(2)]);
            let [noise, bias, scale, stamps] = self.covariances.map(|c| response * c * response.transpose());
            Estimate {
                time: times[k],
                attitude: state.rotation(),
                budget: Budget::of(Vector3::zeros(), noise, bias, scale, stamps),
            }
        };
        Ok(middle.iter().enumerate().map(|(k, state)| estimate(k, state)).collect())
    }
}

/// The start nearest to the rates, from one near it, with the sums there and their inverse matrix.
fn settle(
    inertia: &Inertia,
    elapsed: &[f64],
    rates: &[Vector3<f64>],
    mut omega: Vector3<f64>,
) -> Result<(Vector3<f64>, Normal, Matrix3<f64>), FlightError> {
    let mut best: Option<(Vector3<f64>, Normal, Matrix3<f64>)> = None;
    for _ in 0..ROUNDS {
        let normal = normal(inertia, elapsed, rates, omega)?;
        let inverse = normal.matrix.try_inverse().ok_or(FlightError::Undetermined)?;
        let change = inverse * normal.gradient;
        let better = best.as_ref().is_none_or(|(_, known, _)| normal.square < known.square);
        match (better, &best) {
            // half way back to the best so far
            (false, Some((known, ..))) if (omega - known).norm() > SETTLED * known.norm() => {
                omega = (omega + known) * 0.5;
                continue;
            }
            (false, _) => break,
            (true, _) => {}
        }
        best = Some((omega, normal, inverse));
        if change.norm() <= SETTLED * omega.norm() {
            break;
        }
        omega += change;
    }
    best.ok_or(FlightError::Undetermined)
}

fn normal(
    inertia: &Inertia,
    elapsed: &[f64],
    rates: &[Vector3<f64>],
    omega: Vector3<f64>,
) -> Result<Normal, FlightError> {
    let of = |omega: Vector3<f64>| -> Result<Vec<Vector3<f64>>, FlightError> {
        let motion = FreeMotion::from_omega(inertia, UnitQuaternion::identity(), omega)?;
        let states = motion.at_many(elapsed)?;
        Ok(states.iter().map(|state| motion.body().omega_body(state)).collect())
    };
    let step = DIFFERENCE * omega.norm();
    if step == 0.0 {
        return Err(FlightError::Undetermined);
    }
    let middle = of(omega)?;
    let mut slopes = Vec::with_capacity(3);
    for axis in 0..3 {
        let (low, high) = (of(omega - Vector3::ith(axis, step))?, of(omega + Vector3::ith(axis, step))?);
        slopes.push([low, high]);
    }
    let zero = Matrix3::zeros();
    let mut sums = Normal {
        matrix: zero,
        gradient: Vector3::zeros(),
        square: 0.0,
        bias: zero,
        scale: zero,
        stamps: zero,
    };
    for k in 0..elapsed.len() {
        let column = |axis: usize| (slopes[axis][1][k] - slopes[axis][0][k]) / (2.0 * step);
        let transposed = Matrix3::from_columns(&[column(0), column(1), column(2)]).transpose();
        let rest = rates[k] - middle[k];
        sums.matrix += transposed * transposed.transpose();
        sums.gradient += transposed * rest;
        sums.square += rest.norm_squared();
        sums.bias += transposed;
        sums.scale += transposed * Matrix3::from_diagonal(&middle[k]);
        let (low, high) = (k.saturating_sub(1), (k + 1).min(elapsed.len() - 1));
        let moved = transposed * ((middle[high] - middle[low]) / (elapsed[high] - elapsed[low]));
        sums.stamps += moved * moved.transpose();
    }
    Ok(sums)
}

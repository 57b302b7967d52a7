//! Free flights: the exact motion of a known body through the rates of a record.

use nalgebra::{Matrix3, SMatrix, UnitQuaternion, Vector3};
use thiserror::Error;

use super::Sensor;
use super::budget::{Budget, Estimate};
use super::error::StrapdownError;
use crate::body::StateError;
use crate::flow::{DerivativeError, FreeMotion, StateDerivative, TurnAxes};
use crate::inertia::Inertia;

/// Samples that the first fit goes through; each further one goes through twice as many.
const FIRST: usize = 16;
/// Rounds of Gauss and Newton for each number of samples, at most.
const ROUNDS: usize = 20;
/// The rounds end where the start changes by less than this part of itself.
const SETTLED: f64 = 1e-10;
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
    /// A time of the record, or the motion there, which next to the unstable axis no start determines.
    #[error(transparent)]
    Motion(#[from] DerivativeError),
    /// Too few samples.
    #[error("{samples} samples: the start of a free flight needs at least {FIRST}")]
    Few {
        /// Their number.
        samples: usize,
    },
    /// The body does not turn like this when it is free.
    #[error(
        "the record contradicts the body: the free motion that fits best differs from the rates by {residual:.2e} rad/s (root \
         mean square; the rates have {rate:.2e} rad/s), and the errors of the sensor are {sensor:.2e} rad/s"
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
/// noise of all samples is averaged over the three numbers that are free. Derivatives are those of the
/// [exact motion](FreeMotion::at_with_derivative).
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
    /// R of the derivatives: R⁻¹R⁻ᵀ is the covariance of the angular velocity at the start by noise of variance 1.
    root: Matrix3<f64>,
    /// Covariances of R times that angular velocity by noise, bias, scale and stamps.
    covariances: [Matrix3<f64>; 4],
    residual: f64,
    chi2_per_dof: f64,
}

/// The least squares of one round: derivatives J and residuals r as `R x = d`, by Householder's reflections. JᵀJ would not do: J
/// grows with the time in one direction and not in the others.
struct Squares {
    root: Matrix3<f64>,
    right: Vector3<f64>,
    square: f64,
}

impl Squares {
    /// The step to the least square.
    fn change(&self) -> Option<Vector3<f64>> {
        self.root.solve_upper_triangular(&self.right).filter(|change| change.iter().all(|x| x.is_finite()))
    }
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
        let squares = loop {
            let (found, squares) = settle(inertia, &elapsed[..count], &rates[..count], omega)?;
            omega = found;
            if count == samples {
                break squares;
            }
            count = (2 * count).min(samples);
        };
        let dof = (3 * samples - 3) as f64;
        let mean_square = squares.square / dof;
        let square = |x: f64| x * x;
        let rate = (rates.iter().map(Vector3::norm_squared).sum::<f64>() / (3 * samples) as f64).sqrt();
        let known = (square(sensor.noise) + square(sensor.bias) + square(sensor.scale * rate)).sqrt();
        let residual = mean_square.sqrt();
        if residual > CONTRADICTION.0 * known && residual > CONTRADICTION.1 * rate {
            return Err(FlightError::Contradicted { residual, rate, sensor: known });
        }
        // what is left beyond the noise counts as noise
        let noise = mean_square.max(square(sensor.noise));
        let root = squares.root;
        let [mut bias, mut scale, mut stamps] = [Matrix3::zeros(); 3];
        let known = along(inertia, &elapsed, omega)?;
        for (k, (rate, slope)) in known.iter().enumerate() {
            let Some(share) = root.tr_solve_upper_triangular(&slope.transpose()) else {
                return Err(FlightError::Undetermined);
            };
            bias += share;
            scale += share * Matrix3::from_diagonal(rate);
            let (low, high) = (k.saturating_sub(1), (k + 1).min(samples - 1));
            let moved = share * ((known[high].0 - known[low].0) / (elapsed[high] - elapsed[low]));
            stamps += moved * moved.transpose();
        }
        let spread = |by: Matrix3<f64>, sigma: f64| by * by.transpose() * square(sigma);
        let covariances = [
            Matrix3::identity() * noise,
            spread(bias, sensor.bias),
            spread(scale, sensor.scale),
            stamps * square(sensor.stamps),
        ];
        let chi2_per_dof = if sensor.noise > 0.0 { mean_square / square(sensor.noise) } else { f64::NAN };
        Ok(Flight {
            inertia: inertia.clone(),
            attitude,
            start: times[0],
            omega,
            root,
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
        let motion = FreeMotion::from_omega(&self.inertia, self.attitude, self.omega)?;
        let estimate = |time: f64| -> Result<Estimate, FlightError> {
            let there = motion.at_with_derivative(time - self.start)?;
            let [turn, _] = by_start(&there);
            let response = self.root.tr_solve_upper_triangular(&turn.transpose());
            let response = response.ok_or(FlightError::Undetermined)?.transpose();
            let [noise, bias, scale, stamps] = self.covariances.map(|c| response * c * response.transpose());
            let budget = Budget::of(Vector3::zeros(), noise, bias, scale, stamps);
            Ok(Estimate { time, attitude: there.state().rotation(), budget })
        };
        times.iter().map(|time| estimate(*time)).collect()
    }
}

/// The turn in space and the angular velocity by the angular velocity at the start.
fn by_start(there: &StateDerivative) -> [Matrix3<f64>; 2] {
    let whole = there.by_omega(TurnAxes::Space);
    [0, 3].map(|row| whole.fixed_view::<3, 3>(row, 3).into_owned())
}

/// The start nearest to the rates, from one near it, with the least squares there.
fn settle(
    inertia: &Inertia,
    elapsed: &[f64],
    rates: &[Vector3<f64>],
    mut omega: Vector3<f64>,
) -> Result<(Vector3<f64>, Squares), FlightError> {
    let mut best: Option<(Vector3<f64>, Squares)> = None;
    for _ in 0..ROUNDS {
        let squares = squares(inertia, elapsed, rates, omega)?;
        let change = squares.change().ok_or(FlightError::Undetermined)?;
        let better = best.as_ref().is_none_or(|(_, known)| squares.square < known.square);
        match (better, &best) {
            // half way back to the best so far
            (false, Some((known, _))) if (omega - known).norm() > SETTLED * known.norm() => {
                omega = (omega + known) * 0.5;
                continue;
            }
            (false, _) => break,
            (true, _) => {}
        }
        best = Some((omega, squares));
        if change.norm() <= SETTLED * omega.norm() {
            break;
        }
        omega += change;
    }
    best.ok_or(FlightError::Undetermined)
}

/// An angular velocity with its derivative.
type Known = (Vector3<f64>, Matrix3<f64>);

/// The angular velocities of the motion with their derivatives by that at the start.
fn along(inertia: &Inertia, elapsed: &[f64], omega: Vector3<f64>) -> Result<Vec<Known>, FlightError> {
    let motion = FreeMotion::from_omega(inertia, UnitQuaternion::identity(), omega)?;
    let known = elapsed.iter().map(|t| {
        let there = motion.at_with_derivative(*t)?;
        Ok((there.omega_body(), by_start(&there)[1]))
    });
    known.collect()
}

fn squares(
    inertia: &Inertia,
    elapsed: &[f64],
    rates: &[Vector3<f64>],
    omega: Vector3<f64>,
) -> Result<Squares, FlightError> {
    if omega.norm() == 0.0 {
        return Err(FlightError::Undetermined);
    }
    let (mut square, mut stacked) = (0.0, SMatrix::<f64, 6, 4>::zeros());
    for ((rate, slope), measured) in along(inertia, elapsed, omega)?.iter().zip(rates) {
        let rest = measured - rate;
        square += rest.norm_squared();
        stacked.fixed_view_mut::<3, 3>(3, 0).copy_from(slope);
        stacked.fixed_view_mut::<3, 1>(3, 3).copy_from(&rest);
        let reduced = stacked.qr().r();
        stacked.fixed_view_mut::<3, 4>(0, 0).copy_from(&reduced.fixed_rows::<3>(0));
    }
    let root = stacked.fixed_view::<3, 3>(0, 0).into_owned();
    Ok(Squares { root, right: stacked.fixed_view::<3, 1>(0, 3).into_owned(), square })
}

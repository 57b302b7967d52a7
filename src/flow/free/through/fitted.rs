//! The free motion that fits many attitudes best.

use core::cmp::Ordering;

use nalgebra::{Matrix3x6, Matrix6, UnitQuaternion, Vector3, Vector6};

use super::passages::ThroughError;
use crate::body::{Point, State};
use crate::flow::TurnAxes;
use crate::flow::free::FreeMotion;
use crate::inertia::Inertia;
use crate::num::Dd;
use crate::rotation::{Quat, Vec3};

/// Iterations of Gauss and Newton at most.
const ITERATIONS: u32 = 30;
/// Share of a step below which it is not shortened further: rounding keeps the sum of squares from falling.
const SHORTEST: f64 = 1e-6;
/// Share of the sum of squares that a further step would gain, below which it is at its least: the sum has some sixteen digits.
const GAIN: f64 = 1e-12;
/// Square of an angle that is rounding, rad².
const ROUNDING: f64 = 1e-28;

/// The free motion that passes many attitudes as nearly as their noise allows.
#[derive(Clone, Debug)]
#[must_use]
#[non_exhaustive]
pub struct FittedMotion {
    /// The motion, whose t = 0 is the time of the first attitude.
    pub motion: FreeMotion,
    /// Covariance of rotation vector (space axes, rad) and momentum (body axes, kg m²/s) at the first time.
    pub covariance: Matrix6<f64>,
    /// Sum of the squares of the angles to the attitudes over their variance, for each degree of freedom: near 1 where the noise is as
    /// stated.
    pub chi2_per_dof: f64,
    /// Iterations that were taken.
    pub iterations: u32,
}

impl FreeMotion {
    /// The free motion nearest to the attitudes of `table`, of which each component of the rotation vector has the standard deviation
    /// `noise`, rad: least squares, from the start at `guess` (as the first piece of an [`Interpolation`](super::Interpolation)).
    ///
    /// From a `guess` of another body its attitude and angular velocity at t = 0 are taken: what is found is a motion of `inertia`.
    ///
    /// Attitudes are taken on from the first ones, twice as many each time, so that the phase never is off by much.
    ///
    /// # Errors
    /// Fewer than three attitudes, times that do not ascend, a noise that is not positive, and where the iteration does not converge.
    pub fn fitted(
        inertia: &Inertia,
        table: &[(f64, UnitQuaternion<f64>)],
        noise: f64,
        guess: &FreeMotion,
    ) -> Result<FittedMotion, ThroughError> {
        if table.len() < 3 {
            return Err(ThroughError::TooFew { attitudes: table.len() });
        }
        if !(noise > 0.0 && noise.is_finite()) {
            return Err(ThroughError::Noise { noise });
        }
        if let Some(pair) =
            table.windows(2).find(|pair| pair[0].0.partial_cmp(&pair[1].0) != Some(Ordering::Less))
        {
            return Err(ThroughError::NotAscending { before: pair[0].0, after: pair[1].0 });
        }
        let motion = of_body(inertia, guess).ok_or(ThroughError::NotConverged { attitudes: 3 })?;
        let mut fit = Fit { table, motion, iterations: 0 };
        let mut count = 3;
        loop {
            let (chi2, covariance) = fit.converge(count)?;
            if count == table.len() {
                let freedom = (3 * count - 6) as f64;
                return Ok(FittedMotion {
                    motion: fit.motion,
                    covariance: covariance * (noise * noise),
                    chi2_per_dof: chi2 / (noise * noise) / freedom,
                    iterations: fit.iterations,
                });
            }
            count = (2 * count).min(table.len());
        }
    }
}

/// The motion of the body with `inertia` from the attitude and the angular velocity at which `guess` starts.
fn of_body(inertia: &Inertia, guess: &FreeMotion) -> Option<FreeMotion> {
    if guess.body().inertia() == inertia {
        return Some(guess.clone());
    }
    let (start, omega) = (guess.at(0.0).ok()?, guess.omega_at(0.0).ok()?);
    FreeMotion::from_omega(inertia, start.rotation(), omega).ok()
}

struct Fit<'a> {
    table: &'a [(f64, UnitQuaternion<f64>)],
    motion: FreeMotion,
    iterations: u32,
}

impl Fit<'_> {
    /// Sum of squares, gradient and normal matrix of the first `count` attitudes.
    fn equations(&self, motion: &FreeMotion, count: usize) -> Option<(f64, Vector6<f64>, Matrix6<f64>)> {
        let (mut sum, mut gradient, mut normal) = (0.0, Vector6::zeros(), Matrix6::zeros());
        for &(t, attitude) in &self.table[..count] {
            let found = motion.at_with_derivative(t - self.table[0].0).ok()?;
            let attitude: Quat<f64> = attitude.into();
            let rest: Vector3<f64> = (attitude * found.state().attitude.conjugate()).logarithm().into();
            let rows: Matrix3x6<f64> =
                found.by_momentum(TurnAxes::Space).fixed_view::<3, 6>(0, 0).into_owned();
            sum += rest.norm_squared();
            gradient += rows.transpose() * rest;
            normal += rows.transpose() * rows;
        }
        Some((sum, gradient, normal))
    }

    fn converge(&mut self, count: usize) -> Result<(f64, Matrix6<f64>), ThroughError> {
        let lost = ThroughError::NotConverged { attitudes: count };
        let (mut sum, mut gradient, mut normal) =
            self.equations(&self.motion, count).ok_or_else(|| lost.clone())?;
        for _ in 0..ITERATIONS {
            self.iterations += 1;
            // momenta and angles in units of their own
            let unit = Vector6::from_fn(|k, _| 1.0 / normal[(k, k)].sqrt());
            let scaled = Matrix6::from_fn(|i, j| normal[(i, j)] * unit[i] * unit[j]);
            let inverse = scaled.try_inverse().ok_or_else(|| lost.clone())?;
            let step = (inverse * gradient.component_mul(&unit)).component_mul(&unit);
            let covariance = Matrix6::from_fn(|i, j| inverse[(i, j)] * unit[i] * unit[j]);
            let gain = step.dot(&gradient);
            let mut share = 1.0;
            let improved = loop {
                let next = self.moved(step * share).ok_or_else(|| lost.clone())?;
                match self.equations(&next, count) {
                    Some(found) if found.0 <= sum => break Some((next, found)),
                    _ if share < SHORTEST => break None,
                    _ => share *= 0.25,
                }
            };
            let Some((next, found)) = improved else { return Ok((sum, covariance)) };
            self.motion = next;
            (sum, gradient, normal) = found;
            if gain <= GAIN * sum || sum <= ROUNDING * count as f64 {
                return Ok((sum, covariance));
            }
        }
        Err(lost)
    }

    /// The motion from a start that is moved by a rotation vector in space and a momentum in the body.
    fn moved(&self, step: Vector6<f64>) -> Option<FreeMotion> {
        let start = self.motion.at(0.0).ok()?;
        let turn: Vector3<f64> = step.fixed_rows::<3>(0).into_owned();
        let momentum = start.momentum() + step.fixed_rows::<3>(3);
        let attitude = Quat::exponential(Vec3::from(turn)) * start.attitude;
        let state = State { attitude, momentum_body: momentum.into() };
        let body = self.motion.body();
        let inside: Point<Dd> = body.enter(&state).ok()?;
        Some(FreeMotion::from_point(body.inertia(), inside))
    }
}

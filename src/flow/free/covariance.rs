//! What becomes of an uncertain start: covariances on SO(3) × R³ to first order, and how far the first order is to be trusted.

use nalgebra::{Matrix3, Matrix6, SMatrix, SVector, Vector3};
use thiserror::Error;

use super::motion::FreeMotion;
use crate::body::Body;
#[cfg(any(test, feature = "random"))]
use crate::body::{AttitudeSpread, Population};
use crate::flow::{DerivativeError, TurnAxes};
use crate::inertia::Inertia;
use crate::num::Covariance;
use crate::rotation::{Quat, Vec3, rotation_angle};

/// Radians of the turn in one panel of the integral of the process noise.
const PANEL: f64 = 1.0;
/// Most panels.
const MOST_PANELS: f64 = 1e6;
/// Nodes and weights of Gauss and Legendre of six points on (−1, 1), one half of each (Abramowitz and Stegun, table 25.4).
const GAUSS: [(f64, f64); 3] = [
    (0.238_619_186_083_196_9, 0.467_913_934_572_691_04),
    (0.661_209_386_466_264_5, 0.360_761_573_048_138_6),
    (0.932_469_514_203_152, 0.171_324_492_379_170_35),
];

/// How uncertain a start is.
#[derive(Clone, Debug, PartialEq)]
#[must_use]
pub struct StartCovariance {
    /// Of rotation vector (rad), angular velocity (body axes, rad/s), both at t = 0, and the entries xx, yy, zz, xy, xz, yz of the
    /// inertia tensor (kg m², body axes).
    pub matrix: Covariance<12>,
    /// Spectral density of a white torque in body axes, N² m² s: in a time dt its angular impulse has the covariance `torque dt`.
    pub torque: Covariance<3>,
    /// Axes of the rotation vectors, at the start and at the time asked for.
    pub axes: TurnAxes,
}

/// How uncertain a state is.
#[derive(Clone, Copy, Debug, PartialEq)]
#[must_use]
#[non_exhaustive]
pub struct StateCovariance {
    /// Of rotation vector (rad) and angular velocity (body axes, rad/s), to first order.
    pub state: Matrix6<f64>,
    /// What the first order leaves out: of the starts that are one standard deviation away along each principal direction, the
    /// root mean square of the angle between the exact and the first-order attitude, over that of the first-order angle. Below 0.1
    /// the covariance can be used; above, an ensemble of exact motions is what tells the truth. The torque does not enter.
    pub nonlinearity: f64,
}

/// Why there is no covariance.
#[derive(Clone, Debug, PartialEq, Error)]
#[non_exhaustive]
pub enum CovarianceError {
    /// No start one standard deviation away is that of a body.
    #[error(
        "the inertia tensors at plus and minus one standard deviation are not physical; give a smaller covariance"
    )]
    NoBody,
    /// The process noise would take too long.
    #[error(
        "in {t:e} s the body turns by {radians:e} rad; process noise is integrated over at most {MOST_PANELS} rad: give an earlier time"
    )]
    TooLong {
        /// The time, s.
        t: f64,
        /// How far the body turns, rad.
        radians: f64,
    },
    /// There is no derivative.
    #[error(transparent)]
    Derivative(#[from] DerivativeError),
}

impl StartCovariance {
    /// Of a start with this covariance of rotation vector (rad, in the `axes`) and of tensor and angular velocity, and no torque.
    pub fn new(matrix: Covariance<12>, axes: TurnAxes) -> Self {
        StartCovariance { matrix, torque: Covariance::zero(), axes }
    }
}

#[cfg(any(test, feature = "random"))]
impl StartCovariance {
    /// The motion of the mean of a population, and its covariance; `None` where attitudes are anything at all, or where the mean is no body
    /// with a start. Needs the feature `random`.
    ///
    /// ```
    /// use polhode::body::{AttitudeSpread, Population, Tensors};
    /// use polhode::flow::StartCovariance;
    /// use polhode::inertia::Inertia;
    /// use polhode::num::{Covariance, Distribution};
    /// use polhode::rotation::Quat;
    /// let uncertain = Population::Independent {
    ///     attitude: AttitudeSpread::Fixed(Quat::identity()),
    ///     omega_body: Distribution::Normal { mean: [0.4, 1.0, -0.3], covariance: Covariance::independent([1e-4; 3])? },
    ///     inertia: Box::new(Tensors::moments(Inertia::from_moments([1.0, 2.0, 2.5])?, [1e-4; 3])?),
    /// };
    /// let (motion, start) = StartCovariance::of(&uncertain).ok_or("it has a mean")?;
    /// assert!(motion.covariance(100.0, &start)?.nonlinearity < 0.05);
    /// # Ok::<(), polhode::Error>(())
    /// ```
    #[must_use]
    pub fn of(population: &Population) -> Option<(FreeMotion, Self)> {
        let (q0, omega, inertia, matrix) = match population {
            Population::Independent { attitude, omega_body, inertia } => {
                let (q0, turn) = match attitude {
                    AttitudeSpread::Fixed(q0) => (*q0, Covariance::zero()),
                    AttitudeSpread::Near { mean, turn } => {
                        (*mean * Quat::exponential(Vec3(turn.mean())), turn.covariance())
                    }
                    AttitudeSpread::Uniform => return None,
                };
                let (mean, tensor) = inertia.entries().ok()?;
                let rates = omega_body.covariance();
                (q0, Vec3(omega_body.mean()), mean, Covariance::of_parts(&turn, &rates, &tensor))
            }
            Population::Joint { attitude, omega_body, inertia, covariance } => {
                (*attitude, *omega_body, inertia.clone(), (**covariance).clone())
            }
        };
        let start = Body::free(inertia.clone()).enter_omega(q0, omega).ok()?;
        Some((FreeMotion::from_point(&inertia, start), StartCovariance::new(matrix, TurnAxes::Body)))
    }
}

/// Σ x xᵀ of displacements x.
fn sum_of_squares<const N: usize, const M: usize>(
    by: &SMatrix<f64, M, N>,
    covariance: &Covariance<N>,
) -> SMatrix<f64, M, M> {
    let moved = covariance.deviations().map(|deviation| by * SVector::from(deviation));
    moved.iter().map(|x| x * x.transpose()).sum()
}

impl FreeMotion {
    /// How uncertain the state at time `t` (s) is when the start is uncertain: to first order by the derivative of the motion, with a
    /// measure of what that neglects.
    ///
    /// ```
    /// use nalgebra::{UnitQuaternion, Vector3};
    /// use polhode::flow::{FreeMotion, StartCovariance, TurnAxes};
    /// use polhode::inertia::Inertia;
    /// use polhode::num::Covariance;
    /// let body = Inertia::from_moments([1.0, 2.0, 3.0])?;
    /// let motion = FreeMotion::from_omega(&body, UnitQuaternion::identity(), Vector3::new(0.4, 1.0, -0.3))?;
    /// // 1e-5 rad and rad/s, and a tensor that is known
    /// let sure = |k: usize| if k < 6 { 1e-5 } else { 0.0 };
    /// let start = Covariance::independent(core::array::from_fn(sure))?;
    /// let start = StartCovariance::new(start, TurnAxes::Space);
    /// let (soon, late) = (motion.covariance(100.0, &start)?, motion.covariance(1e5, &start)?);
    /// let angle = soon.state.fixed_view::<3, 3>(0, 0).trace().sqrt();
    /// assert!(angle > 1e-4 && angle < 1e-2 && soon.nonlinearity < 0.01);
    /// assert!(late.nonlinearity > 0.1); // nothing is known of the phase any more
    /// # Ok::<(), polhode::Error>(())
    /// ```
    ///
    /// # Errors
    /// A tensor so near to the border of what bodies have that neither side of it can be tried, and
    /// times without a derivative; with process noise, times in which the body turns by more than 10⁶ rad.
    pub fn covariance(&self, t: f64, start: &StartCovariance) -> Result<StateCovariance, CovarianceError> {
        let derivative = self.at_with_derivative(t)?.by_omega(start.axes);
        let mut state = sum_of_squares(&derivative, &start.matrix);
        if start.torque != Covariance::zero() {
            state += self.process_noise(t, start)?;
        }
        Ok(StateCovariance { state, nonlinearity: self.nonlinearity(t, start, &derivative)? })
    }

    /// ∫ Φ B q Bᵀ Φᵀ ds, where Φ leads from the time s to `t` and B is what an impulse does to ω.
    fn process_noise(&self, t: f64, start: &StartCovariance) -> Result<Matrix6<f64>, CovarianceError> {
        let radians = self.fastest_rate() * t.abs();
        let panels = libm::ceil(radians / PANEL).max(1.0);
        if panels > MOST_PANELS {
            return Err(CovarianceError::TooLong { t, radians });
        }
        let whole = self.at_with_derivative(t)?.by_omega(start.axes).fixed_columns::<6>(0).into_owned();
        let impulse = self.inverse_inertia();
        let half = 0.5 * t / panels;
        let mut sum = Matrix6::zeros();
        for panel in 0..panels as u64 {
            let middle = half * (2.0 * panel as f64 + 1.0);
            for (node, weight) in GAUSS {
                for s in [middle - half * node, middle + half * node] {
                    let before = self.at_with_derivative(s)?.by_omega(start.axes);
                    let Some(back) = before.fixed_columns::<6>(0).into_owned().try_inverse() else {
                        continue;
                    };
                    let response = (whole * back).fixed_columns::<3>(3) * impulse;
                    sum += sum_of_squares(&response, &start.torque) * (weight * half.abs());
                }
            }
        }
        Ok(sum)
    }

    /// As [`StateCovariance::nonlinearity`].
    fn nonlinearity(
        &self,
        t: f64,
        start: &StartCovariance,
        derivative: &SMatrix<f64, 6, 12>,
    ) -> Result<f64, CovarianceError> {
        let zero = self.at(0.0).map_err(DerivativeError::Time)?;
        let now = self.at(t).map_err(DerivativeError::Time)?.attitude;
        let omega = self.body().omega_body(&zero);
        let inertia = self.body().inertia();
        let (mut missed, mut moved) = (0.0, 0.0);
        for deviation in start.matrix.deviations() {
            let deviation = SVector::<f64, 12>::from(deviation);
            let mut bodies = 0;
            for change in [deviation, -deviation] {
                let tensor: SVector<f64, 6> = change.fixed_rows::<6>(6).into_owned();
                let other = if tensor.amax() == 0.0 {
                    Ok(inertia.clone())
                } else {
                    Inertia::from_tensor(inertia.tensor() + symmetric(&tensor))
                };
                let Ok(other) = other else { continue };
                bodies += 1;
                let q0 = turned(zero.attitude, change.fixed_rows::<3>(0).into_owned(), start.axes);
                let rate: Vector3<f64> = omega + change.fixed_rows::<3>(3);
                let from = Body::free(other.clone()).enter_omega(q0, rate.into());
                let end = from.ok().and_then(|from| FreeMotion::from_point(&other, from).at(t).ok());
                let turn: Vector3<f64> = derivative.fixed_rows::<3>(0) * change;
                // a turn by more than half a turn is no small one, wherever it ends; nor is one that has no end
                let angle = match end {
                    Some(end) if turn.norm() <= core::f64::consts::PI => {
                        rotation_angle(turned(now, turn, start.axes), end.attitude)
                    }
                    _ => turn.norm(),
                };
                missed += angle * angle;
                moved += turn.norm_squared();
            }
            if bodies == 0 {
                return Err(CovarianceError::NoBody);
            }
        }
        Ok(if moved > 0.0 { (missed / moved).sqrt() } else { 0.0 })
    }
}

/// The attitude `q`, turned by a rotation vector in the `axes`.
fn turned(q: Quat<f64>, by: Vector3<f64>, axes: TurnAxes) -> Quat<f64> {
    let turn = Quat::exponential(Vec3::from(by));
    match axes {
        TurnAxes::Space => turn * q,
        TurnAxes::Body => q * turn,
    }
}

/// The tensor with the entries xx, yy, zz, xy, xz, yz.
fn symmetric(e: &SVector<f64, 6>) -> Matrix3<f64> {
    Matrix3::new(e[0], e[3], e[4], e[3], e[1], e[5], e[4], e[5], e[2])
}

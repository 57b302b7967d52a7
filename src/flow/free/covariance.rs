//! What becomes of an uncertain start: covariances on SO(3) × R³ to first order, and how far the first order is to be trusted.

use nalgebra::{Matrix3, Matrix6, SMatrix, SVector, Vector3};
use thiserror::Error;

use super::derivative::{DerivativeError, TurnAxes};
use super::motion::FreeMotion;
use crate::body::Body;
use crate::inertia::Inertia;
use crate::num::eigen::eigen;
use crate::rotation::{Quat, rotation_angle, turn_by};

/// A covariance may be this far below zero, of its largest eigenvalue: what rounding does to a singular one.
const ROUNDING: f64 = 1e-12;
/// Radians of the turn in one panel of the integral of the process noise.
const PANEL: f64 = 1.0;
/// Most panels.
const MOST_PANELS: f64 = 1e6;
/// Nodes and weights of Gauss–Legendre on (−1, 1), one half of each.
const GAUSS: [(f64, f64); 3] = [
    (0.238_619_186_083_196_9, 0.467_913_934_572_691_04),
    (0.661_209_386_466_264_5, 0.360_761_573_048_138_6),
    (0.932_469_514_203_152, 0.171_324_492_379_170_35),
];

/// How uncertain a start is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StartCovariance {
    /// Of rotation vector (rad) and angular velocity (body axes, rad/s) at t = 0.
    pub state: Matrix6<f64>,
    /// Of the entries xx, yy, zz, xy, xz, yz of the inertia tensor, kg² m⁴; independent of the state.
    pub tensor: Matrix6<f64>,
    /// Spectral density of a white torque in body axes, N² m² s: in a time dt its angular impulse has the covariance `torque dt`.
    pub torque: Matrix3<f64>,
    /// Axes of the rotation vectors, at the start and at the time asked for.
    pub axes: TurnAxes,
}

/// How uncertain a state is.
#[derive(Clone, Copy, Debug, PartialEq)]
#[must_use]
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
    /// An entry is not a number.
    #[error("the covariance of {of} has an entry {value}, which is no finite number")]
    NotFinite {
        /// Of what.
        of: &'static str,
        /// The entry.
        value: f64,
    },
    /// The two halves differ.
    #[error(
        "the covariance of {of} is not symmetric: its entries {row}, {column} are {value:e} and {other:e}"
    )]
    NotSymmetric {
        /// Of what.
        of: &'static str,
        /// Row of the entry, from 0.
        row: usize,
        /// Its column.
        column: usize,
        /// The entry.
        value: f64,
        /// Its mirror image.
        other: f64,
    },
    /// A direction has a negative variance.
    #[error(
        "the covariance of {of} has the eigenvalue {eigenvalue:e} beside {largest:e}: a variance is not negative"
    )]
    NotPositive {
        /// Of what.
        of: &'static str,
        /// The least eigenvalue.
        eigenvalue: f64,
        /// The largest eigenvalue.
        largest: f64,
    },
    /// No tensor one standard deviation away is that of a body.
    #[error(
        "one standard deviation from the inertia tensor, either way, no body has the tensor: use a narrower covariance"
    )]
    NoBody,
    /// The process noise would take too long.
    #[error(
        "in {t:e} s the body turns by {radians:e} rad; process noise is integrated over {MOST_PANELS} rad at most"
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

impl Default for StartCovariance {
    fn default() -> Self {
        StartCovariance {
            state: Matrix6::zeros(),
            tensor: Matrix6::zeros(),
            torque: Matrix3::zeros(),
            axes: TurnAxes::Space,
        }
    }
}

impl StartCovariance {
    fn check(&self) -> Result<(), CovarianceError> {
        check("the state", &self.state)?;
        check("the tensor", &self.tensor)?;
        check("the torque", &self.torque)
    }
}

fn check<const N: usize>(of: &'static str, p: &SMatrix<f64, N, N>) -> Result<(), CovarianceError> {
    if let Some(&value) = p.iter().find(|value| !value.is_finite()) {
        return Err(CovarianceError::NotFinite { of, value });
    }
    for row in 0..N {
        for column in 0..row {
            let (value, other) = (p[(row, column)], p[(column, row)]);
            if (value - other).abs() > ROUNDING * (p[(row, row)].abs() * p[(column, column)].abs()).sqrt() {
                return Err(CovarianceError::NotSymmetric { of, row, column, value, other });
            }
        }
    }
    let (values, _) = eigen(rows(&correlation(p)));
    let (eigenvalue, largest) = (values[0], values[N - 1]);
    if eigenvalue < -ROUNDING * largest.abs() {
        return Err(CovarianceError::NotPositive { of, eigenvalue, largest });
    }
    Ok(())
}

/// `p` in units of its standard deviations, so that no unit of measurement matters.
fn correlation<const N: usize>(p: &SMatrix<f64, N, N>) -> SMatrix<f64, N, N> {
    let unit = |k: usize| if p[(k, k)] > 0.0 { 1.0 / p[(k, k)].sqrt() } else { 1.0 };
    SMatrix::from_fn(|row, column| p[(row, column)] * unit(row) * unit(column))
}

fn rows<const N: usize>(p: &SMatrix<f64, N, N>) -> [[f64; N]; N] {
    core::array::from_fn(|row| core::array::from_fn(|column| p[(row, column)]))
}

/// Displacements by one standard deviation along the principal directions, in units of the standard deviations of the components.
fn deviations<const N: usize>(p: &SMatrix<f64, N, N>) -> Vec<SVector<f64, N>> {
    let (values, vectors) = eigen(rows(&correlation(p)));
    let unit = |k: usize| p[(k, k)].max(0.0).sqrt();
    let one = |n: usize| SVector::from_fn(|k, _| vectors[n][k] * values[n].max(0.0).sqrt() * unit(k));
    (0..N).map(one).filter(|deviation: &SVector<f64, N>| deviation.amax() > 0.0).collect()
}

impl FreeMotion {
    /// How uncertain the state at time `t` (s) is when the start is uncertain: to first order by the derivative of the motion, with a
    /// measure of what that neglects.
    ///
    /// ```
    /// use nalgebra::{Matrix6, UnitQuaternion, Vector3};
    /// use polhode::flow::{FreeMotion, StartCovariance};
    /// use polhode::inertia::Inertia;
    /// let body = Inertia::from_moments([1.0, 2.0, 3.0])?;
    /// let motion = FreeMotion::from_omega(&body, UnitQuaternion::identity(), Vector3::new(0.4, 1.0, -0.3))?;
    /// let sure = 1e-5_f64; // rad and rad/s
    /// let start = StartCovariance { state: Matrix6::identity() * sure.powi(2), ..StartCovariance::default() };
    /// let (soon, late) = (motion.covariance(100.0, &start)?, motion.covariance(1e5, &start)?);
    /// let angle = soon.state.fixed_view::<3, 3>(0, 0).trace().sqrt();
    /// assert!(angle > 1e-4 && angle < 1e-2 && soon.nonlinearity < 0.01);
    /// assert!(late.nonlinearity > 0.1); // nothing is known of the phase any more
    /// # Ok::<(), polhode::Error>(())
    /// ```
    ///
    /// # Errors
    /// Matrices that are no covariances, a tensor so near to the border of what bodies have that neither side of it can be tried, and
    /// times without a derivative; with process noise, times in which the body turns by more than 10⁶ rad.
    pub fn covariance(&self, t: f64, start: &StartCovariance) -> Result<StateCovariance, CovarianceError> {
        start.check()?;
        let derivative = self.at_with_derivative(t)?.by_omega(start.axes);
        let by_state = derivative.fixed_columns::<6>(0);
        let by_tensor = derivative.fixed_columns::<6>(6);
        let mut state =
            by_state * start.state * by_state.transpose() + by_tensor * start.tensor * by_tensor.transpose();
        if start.torque != Matrix3::zeros() {
            state += self.process_noise(t, start)?;
        }
        let nonlinearity = self.nonlinearity(t, start, &derivative)?;
        Ok(StateCovariance { state: (state + state.transpose()) * 0.5, nonlinearity })
    }

    /// ∫ Φ B q Bᵀ Φᵀ ds, where Φ leads from the time s to `t` and B is what an impulse does to ω.
    fn process_noise(&self, t: f64, start: &StartCovariance) -> Result<Matrix6<f64>, CovarianceError> {
        let fastest = self.fastest_rate();
        let radians = fastest * t.abs();
        let panels = libm::ceil(radians / PANEL).max(1.0);
        if panels > MOST_PANELS {
            return Err(CovarianceError::TooLong { t, radians });
        }
        let whole = self.at_with_derivative(t)?.by_omega(start.axes);
        let whole = whole.fixed_columns::<6>(0).into_owned();
        let inverse = self.inverse_inertia();
        let density = inverse * start.torque * inverse.transpose();
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
                    let response = (whole * back).fixed_columns::<3>(3).into_owned();
                    sum += response * density * response.transpose() * (weight * half.abs());
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
        let tensor = self.body().inertia().tensor();
        let axes = start.axes;
        let (mut missed, mut moved) = (0.0, 0.0);
        let mut compare = |inertia: &Inertia, q0: Quat<f64>, omega: Vector3<f64>, turn: Vector3<f64>| {
            let start = Body::free(inertia.clone()).enter_omega(q0, omega.into());
            let end = start.ok().and_then(|start| FreeMotion::from_point(inertia, start).at(t).ok());
            // a turn by more than half a turn is no small one, wherever it ends; nor is one that has no end
            let angle = match end {
                Some(end) if turn.norm() <= core::f64::consts::PI => {
                    rotation_angle(turned(now, turn, axes), end.attitude)
                }
                _ => turn.norm(),
            };
            missed += angle * angle;
            moved += turn.norm_squared();
        };
        for deviation in deviations(&start.state) {
            for sign in [1.0, -1.0] {
                let change: SVector<f64, 6> = deviation * sign;
                let turn = derivative.fixed_view::<3, 6>(0, 0) * change;
                let q0 = turned(zero.attitude, change.fixed_rows::<3>(0).into_owned(), start.axes);
                compare(self.body().inertia(), q0, omega + change.fixed_rows::<3>(3), turn);
            }
        }
        for deviation in deviations(&start.tensor) {
            let mut bodies = 0;
            for sign in [1.0, -1.0] {
                let change: SVector<f64, 6> = deviation * sign;
                let Ok(inertia) = Inertia::from_tensor(tensor + symmetric(&change)) else { continue };
                bodies += 1;
                let turn = derivative.fixed_view::<3, 6>(0, 6) * change;
                compare(&inertia, zero.attitude, omega, turn);
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
    let turn = turn_by(by.into());
    match axes {
        TurnAxes::Space => turn * q,
        TurnAxes::Body => q * turn,
    }
}

/// The tensor with the entries xx, yy, zz, xy, xz, yz.
fn symmetric(e: &SVector<f64, 6>) -> Matrix3<f64> {
    Matrix3::new(e[0], e[3], e[4], e[3], e[1], e[5], e[4], e[5], e[2])
}

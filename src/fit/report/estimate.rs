//! The estimate: a tensor, how well it is known, and what contradicts it.

use nalgebra::{SMatrix, UnitQuaternion};

use super::identifiability::Identifiability;
use super::torque_free::{InvariantTrend, Whiteness};
use super::warning::Warning;
use crate::fit::physical::certificate::Certificate;
use crate::fit::physical::constraint::ActiveConstraint;
use crate::inertia::{Inertia, InertiaShape};

/// Whitened residuals of one segment: standard normal where model and noise are right.
#[derive(Clone, Debug, PartialEq)]
pub struct Residuals {
    /// Which segment of the record.
    pub segment: usize,
    /// Centres of the test functions, s.
    pub times: Vec<f64>,
    /// The residuals of each.
    pub values: Vec<[f64; 3]>,
    /// Their mean square.
    pub mean_square: f64,
}

/// A fitted tensor and how far to trust it.
#[derive(Clone, Debug, PartialEq)]
pub struct Estimate {
    /// The tensor with trace 1, sensor axes.
    pub shape: InertiaShape,
    /// Its principal moments, ascending, as shares of the trace.
    pub principal: [f64; 3],
    /// Their standard deviations.
    pub sigma_principal: [f64; 3],
    /// Takes coordinates along the principal axes (ascending, right-handed) to sensor axes.
    pub axes: UnitQuaternion<f64>,
    /// Standard deviations of the turn about each principal axis, rad; infinite where two moments agree.
    pub sigma_axes: [f64; 3],
    /// I₁/I₃ and I₂/I₃.
    pub ratios: [f64; 2],
    /// Their standard deviations.
    pub sigma_ratios: [f64; 2],
    /// Covariance of the entries xx, yy, zz, xy, xz, yz of the shape; rank 5, less on the face of an active constraint.
    pub covariance: SMatrix<f64, 6, 6>,
    /// Covariance of the same before the physical law was imposed: what a test of other tensors should use.
    pub free_covariance: SMatrix<f64, 6, 6>,
    /// The Cramér–Rao bound on it; `None` where the tensor has no inverse, or no free motion of it explains the samples.
    pub bound: Option<SMatrix<f64, 6, 6>>,
    /// Root of the trace of the covariance over that of the bound.
    pub bound_ratio: Option<f64>,
    /// Absolute tensor, kg m², where something gave the scale.
    pub inertia: Option<Inertia>,
    /// Covariance of its entries.
    pub inertia_covariance: Option<SMatrix<f64, 6, 6>>,
    /// Noise of one component of the rates, rad/s.
    pub noise_sigma: f64,
    /// Mean square of the residuals over the noise; the covariance is multiplied by it, before law and bounds are
    /// imposed, where it exceeds 1.
    pub chi2_per_dof: f64,
    /// Standard deviations by which law and bounds hold the answer off what the record alone says.
    pub pull: f64,
    /// Equations beyond the five unknowns.
    pub dof: usize,
    /// Samples of the segments that were long enough.
    pub samples: usize,
    /// Segments that were long enough.
    pub segments: usize,
    /// Half width of the test functions, s.
    pub radius: f64,
    /// What the record determines.
    pub identifiability: Identifiability,
    /// I₁ + I₂ − I₃ as a share of the trace; never negative.
    pub triangle_slack: f64,
    /// Constraints that hold the answer.
    pub active_constraints: Vec<ActiveConstraint>,
    /// Check of the answer's optimality.
    pub certificate: Certificate,
    /// InvariantTrend of |J ω|.
    pub momentum_trend: InvariantTrend,
    /// InvariantTrend of 2T = ω·J ω.
    pub energy_trend: InvariantTrend,
    /// Correlation of neighbouring residuals.
    pub whiteness: Whiteness,
    /// Residuals by segment.
    pub residuals: Vec<Residuals>,
    /// What a reader of the figures must know.
    pub warnings: Vec<Warning>,
}

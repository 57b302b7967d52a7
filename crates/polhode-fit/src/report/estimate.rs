//! The estimate: a tensor, how well it is known, and what contradicts it.

use nalgebra::{SMatrix, UnitQuaternion};
use polhode::inertia::{Inertia, InertiaShape};
use polhode::record::Spike;

use crate::physical::certificate::Certificate;
use crate::physical::constraint::ActiveConstraint;
use crate::report::attitudes::AttitudeFit;
use crate::report::identifiability::Identifiability;
use crate::report::model::{ErrorFit, ModelFit};
use crate::report::nuisance::{Agreement, FittedTorque, Nuisance, Systematic};
use crate::report::segments::SegmentSummary;
use crate::report::torque_free::{InvariantTrend, Whiteness};
use crate::report::warning::Warning;

/// How a tensor was estimated.
#[non_exhaustive]
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Method {
    /// Weighted least squares of the weak form of Euler's equation, at samples that are moved onto it.
    WeakForm,
    /// Maximum likelihood on the exact motion of the free body.
    ExactMotion,
    /// Maximum likelihood on the exact motion of the body with wheels of constant momentum, next to the estimate of the weak form.
    ExactMotionWithWheels,
    /// Maximum likelihood of attitudes under torques, by a Kalman filter and smoother.
    Smoother,
}

impl Method {
    /// In words.
    #[must_use]
    pub fn words(self) -> &'static str {
        match self {
            Self::WeakForm => "weak form, generalised least squares on denoised samples",
            Self::ExactMotion => "maximum likelihood on the exact motion of the free body",
            Self::ExactMotionWithWheels => "maximum likelihood on the exact motion of the body with wheels",
            Self::Smoother => {
                "maximum likelihood by a Kalman filter and smoother about the motion under torques"
            }
        }
    }
}

impl Estimate {
    /// Correlations of the entries xx, yy, zz, xy, xz, yz of the shape; those of one without a deviation are zero.
    #[must_use]
    pub fn correlation(&self) -> SMatrix<f64, 6, 6> {
        let covariance = &self.covariance;
        SMatrix::from_fn(|i, k| {
            let size = (covariance[(i, i)] * covariance[(k, k)]).sqrt();
            if size > 0.0 { covariance[(i, k)] / size } else { 0.0 }
        })
    }
}

/// Whitened residuals of one segment: standard normal where model and noise are right.
#[non_exhaustive]
#[derive(Clone, Debug, PartialEq)]
pub struct Residuals {
    /// Index of the segment in the record.
    pub segment: usize,
    /// Centres of the test functions, or times of the samples of a likelihood on the exact motion, s.
    pub times: Vec<f64>,
    /// The residuals of each, three components in standard deviations.
    pub values: Vec<[f64; 3]>,
    /// Their mean square.
    pub mean_square: f64,
}

impl Residuals {
    pub(crate) fn new(segment: usize, times: Vec<f64>, values: Vec<[f64; 3]>) -> Self {
        let squares: f64 = values.iter().flatten().map(|v| v * v).sum();
        let mean_square = squares / (3 * values.len()).max(1) as f64;
        Residuals { segment, times, values, mean_square }
    }
}

/// A fitted tensor with its uncertainty.
///
/// ```
/// use nalgebra::Vector3;
/// use polhode_fit::{Record, Settings, Warning, fit, simulate};
/// use polhode::inertia::Inertia;
/// use polhode::num::Random;
/// # let body = Inertia::from_moments([1.0, 2.0, 2.6])?;
/// # let times: Vec<f64> = (0..2000).map(|i| f64::from(i) / 100.0).collect();
/// # let rates = simulate(&body, Vector3::new(0.3, 1.0, 0.4), &times, 1e-3, &mut Random::new(7))?;
/// let estimate = fit(&Record::from_samples(&times, &rates)?, &Settings::default())?;
/// for k in 0..3 {
///     println!("I{} = {:.5} +- {:.5} of the trace", k + 1, estimate.principal[k], estimate.sigma_principal[k]);
/// }
/// let torque = |w: &Warning| matches!(w, Warning::MomentumTrend(_) | Warning::EnergyTrend(_));
/// assert!(!estimate.warnings.iter().any(torque)); // a free body keeps both
/// assert!(estimate.bound_ratio.is_some_and(|ratio| ratio < 1.2)); // next to the Cramér–Rao bound
/// # Ok::<(), polhode::Error>(())
/// ```
#[non_exhaustive]
#[derive(Clone, Debug, PartialEq)]
pub struct Estimate {
    /// The tensor with trace 1, sensor axes.
    pub shape: InertiaShape,
    /// Its principal moments, ascending, as shares of the trace.
    pub principal: [f64; 3],
    /// Their standard deviations, as shares of the trace.
    pub sigma_principal: [f64; 3],
    /// Takes coordinates along the principal axes (ascending, right-handed) to sensor axes.
    pub axes: UnitQuaternion<f64>,
    /// Standard deviations of the turn about each principal axis, rad; infinite where two moments agree.
    pub sigma_axes: [f64; 3],
    /// The ratios I₁/I₃ and I₂/I₃.
    pub ratios: [f64; 2],
    /// Their standard deviations.
    pub sigma_ratios: [f64; 2],
    /// Covariance of the entries xx, yy, zz, xy, xz, yz of the shape, shares² of the trace; rank 5. Of an answer that a
    /// constraint holds it is the mean square distance from it of what the record tells within the constraints.
    pub covariance: SMatrix<f64, 6, 6>,
    /// Covariance of the same before the physical law was imposed, with the prior: what a test of other tensors should use.
    pub free_covariance: SMatrix<f64, 6, 6>,
    /// The Cramér–Rao bound on it, shares² of the trace; `None` where the tensor has no inverse, or no motion of it, free or with wheels of constant momentum, explains the samples.
    pub bound: Option<SMatrix<f64, 6, 6>>,
    /// Root of the trace of the covariance under the chosen model alone, before the physical law is imposed, over that of the bound; 1 is efficient.
    pub bound_ratio: Option<f64>,
    /// Absolute tensor, kg m², sensor axes; `None` where nothing gives its size, as [`Settings::known`](crate::Settings::known)
    /// does, or wheels and torques of the record.
    pub inertia: Option<Inertia>,
    /// Covariance of its entries xx, yy, zz, xy, xz, yz, (kg m²)².
    pub inertia_covariance: Option<SMatrix<f64, 6, 6>>,
    /// Step of each component of the readings, rad/s, as found or given; 0 where there is none.
    pub quanta: [f64; 3],
    /// Root mean square of |ω|, rad/s.
    pub rms_rate: f64,
    /// Noise of one component of the rates, rad/s; 0 where attitudes alone were fitted.
    pub noise_sigma: f64,
    /// Mean square of the residuals over the noise; the covariance is multiplied by it, before law and limits are
    /// imposed, where it exceeds 1.
    pub chi2_per_dof: f64,
    /// Distance, in standard deviations, from the unconstrained estimate: how far the physical law and limits moved it.
    pub pull: f64,
    /// Degrees of freedom: equations beyond the five unknowns.
    pub dof: usize,
    /// Number of samples of the segments that were long enough.
    pub samples: usize,
    /// Number of segments that were long enough.
    pub segments: usize,
    /// How it was estimated.
    pub method: Method,
    /// Half width of the test functions, s; `None` of a likelihood on the exact motion, which has none.
    pub radius: Option<f64>,
    /// Which of the five numbers the record determines; without a prior tensor all.
    pub identifiability: Identifiability,
    /// I₁ + I₂ − I₃ as a share of the trace; never negative.
    pub triangle_slack: f64,
    /// Active constraints: the physical law, or limits.
    pub active_constraints: Vec<ActiveConstraint>,
    /// Residuals of the conditions of optimality.
    pub certificate: Certificate,
    /// Trend of |J ω|; `None` where wheels or known torques act; of a likelihood on the exact motion that of drag, by one step of least squares.
    pub momentum_trend: Option<InvariantTrend>,
    /// Trend of 2T = ω·J ω; `None` where wheels or known torques act, and of a likelihood on the exact motion.
    pub energy_trend: Option<InvariantTrend>,
    /// Correlation of neighbouring residuals.
    pub whiteness: Whiteness,
    /// The fitted torque.
    pub torque: FittedTorque,
    /// Each model of the torque beside it; of a likelihood on the exact motion those that it has. Where the fit has chosen the model, the deviations
    /// of the answer include how far apart these are, each by its share, and by at least a fifth unless that is below a thousandth.
    pub models: Vec<ModelFit>,
    /// What errors of the sensor, and of the momentum of wheels as it is told, make of the record in the place of a torque; of rates alone.
    pub reading_errors: Vec<ErrorFit>,
    /// The estimated errors of the sensor, each with its prior.
    pub nuisances: Vec<Nuisance>,
    /// By how much errors of the sensor that the fit assumes to be zero would move the moments.
    pub systematic: Vec<Systematic>,
    /// How the record agrees with [`Settings::prior`](crate::Settings::prior).
    pub prior: Option<Agreement>,
    /// Each segment that was long enough.
    pub per_segment: Vec<SegmentSummary>,
    /// Share of |dω/dt|² that the free motion of the answer leaves unexplained, beyond the noise of the rates; `None` where
    /// wheels or known torques act, or the record is too short.
    pub unexplained: Option<f64>,
    /// What was found of the attitudes, where they were fitted.
    pub attitudes: Option<AttitudeFit>,
    /// The shape that explains the record as well if its axes are left-handed, as with one axis reversed or two exchanged;
    /// `None` where wheels or known torques act, and of attitudes, which tell the hand.
    pub mirror: Option<InertiaShape>,
    /// Standard deviations of its principal moments, ascending.
    pub sigma_mirror: Option<[f64; 3]>,
    /// The change of each principal moment midway, as a share of the trace, up to which it may go unseen in this record, by its noise as it was fitted:
    /// a larger one brings [`Warning::Halves`] in 999 of 1,000 records. `None` where the halves are not compared, as by a likelihood on the exact motion,
    /// or one of them leaves the tensor open.
    pub unseen_change: Option<[f64; 3]>,
    /// Samples that were left out because they stand out of their neighbours.
    pub spikes: Vec<Spike>,
    /// Residuals by segment.
    pub residuals: Vec<Residuals>,
    /// What limits the use of the estimate.
    pub warnings: Vec<Warning>,
}

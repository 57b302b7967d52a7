//! Inertia from measured angular velocities and attitudes.
//!
//! The angular velocity of a torque-free body determines its inertia tensor up to scale: five numbers. [`fit`]
//! estimates them from a [`Record`] of rates. It solves the weak form of Euler's equation, which differentiates nothing,
//! by least squares weighted with the covariance of its noise, and then takes the nearest physically valid tensor.
//! [`Estimate`] holds the tensor, the standard deviation of each number, the Cramér–Rao bound, and what in the record
//! contradicts a free body.
//!
//! ```
//! use nalgebra::Vector3;
//! use polhode::inertia::Inertia;
//! use polhode_fit::{Known, Record, Settings, fit, simulate};
//! use polhode::num::Random;
//!
//! let body = Inertia::from_moments([1.0, 2.0, 2.6])?;
//! let times: Vec<f64> = (0..3000).map(|i| f64::from(i) / 100.0).collect();
//! let rates = simulate(&body, Vector3::new(0.3, 1.0, 0.4), &times, 1e-3, &mut Random::new(7))?;
//!
//! let record = Record::from_samples(&times, &rates)?;
//! let settings = Settings::default().with_known(Known::Trace(5.6));
//! let estimate = fit(&record, &settings)?;
//! for (k, truth) in [1.0 / 5.6, 2.0 / 5.6, 2.6 / 5.6].into_iter().enumerate() {
//!     assert!((estimate.principal[k] - truth).abs() < 5.0 * estimate.sigma_principal[k]);
//!     assert!(estimate.sigma_principal[k] < 1e-4);
//! }
//! assert!(estimate.warnings.is_empty(), "{:?}", estimate.warnings);
//! let inertia = estimate.inertia.ok_or("a trace was given")?; // kg m², since the trace was
//! assert!((inertia.tensor()[(1, 1)] - 2.0).abs() < 1e-3);
//! # Ok::<(), polhode::Error>(())
//! ```
//!
//! - [`flights()`] finds the spans of free rotation in a recording that also shows how the body was held and caught.
//! - [`fit_poses`] fits measured attitudes ([`Poses`]) by maximum likelihood on the exact motion.
//! - [`fit_carrier`] gives tensors in kg m² of a carrier and an object on it, from several records with and without a proof body.
//! - [`calibrate_wheel`] gives the moment of inertia of a wheel on a known body.

mod bound;
mod carrier;
mod columns;
mod error;
mod estimator;
mod flights;
mod likelihood;
mod models;
mod physical;
mod poses;
mod report;
mod setters;
mod settings;
mod signal;
mod simulate;
mod smoothed;
mod solve;
mod sparse;
#[cfg(test)]
mod tests;
mod thresholds;
mod units;
mod verdict;
mod wheel;

pub use bound::attitudes::foreseen_attitude_bound;
pub use bound::motions::foreseen_bound;
pub use bound::planned::foreseen_bound_with;
pub use carrier::error::CarrierError;
pub use carrier::estimate::{CarrierEstimate, MeasuredBody, MeasuredWheel, Size, SizeSource};
pub use carrier::fit_carrier;
pub use carrier::proof::ProofBody;
pub use carrier::records::{Attached, CarrierRecords};
pub use carrier::warning::CarrierWarning;
pub use error::{Clash, FitError, ToldComponent};
pub use estimator::fit;
pub use flights::flight::{Flight, FlightLimit};
pub use flights::{Flights, during, flights};
pub use models::reading_error::ReadingError;
pub use physical::certificate::Certificate;
pub use physical::constraint::{ActiveConstraint, Constraint};
pub use physical::failure::SolverFailure;
pub use physical::limits::Limit;
pub use physical::prior::Prior;
pub use polhode::record::{Record, RecordError, Segment, Spike};
pub use polhode::units::{RateUnit, TimeUnit};
pub use poses::error::PosesError;
pub use poses::fault::PoseFault;
pub use poses::fit::fit_poses;
pub use poses::record::{PoseSegment, Poses};
pub use report::attitudes::{AlignmentFit, AttitudeFit};
pub use report::averages::AverageAxis;
pub use report::estimate::{Estimate, Method, Residuals};
pub use report::identifiability::{Identifiability, PrincipalAxis, Undetermined};
pub use report::model::{ErrorFit, ModelFit};
pub use report::motion::FittedMotion;
pub use report::next_step::{Contradiction, NextStep, Origin};
pub use report::nuisance::{Agreement, FittedTorque, Nuisance, Systematic};
pub use report::parts::{Halves, Scatter};
pub use report::segments::{SegmentSummary, WithoutSegment};
pub use report::torque_free::{Blow, InvariantTrend, Memory, Whiteness};
pub use report::warning::Warning;
pub use settings::Settings;
pub use settings::known::Known;
pub use settings::sensor::SensorPriors;
pub use settings::torque::{TorqueModel, TorqueNoise};
pub use simulate::{
    Disturbances, Gyroscope, SimulatedPoses, SimulationError, simulate, simulate_poses, simulate_with,
};
pub use units::product::UnitProduct;
pub use wheel::{WheelCalibration, WheelWarning, calibrate_wheel};

/// What the fit decides by, and where that is measured.
pub mod guide {
    #[doc = include_str!("../thresholds.md")]
    pub mod thresholds {}
}

#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct ReadMe;

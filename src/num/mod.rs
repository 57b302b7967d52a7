//! Numbers: the scalars that every kernel is written over, and functions of them. No physics.
//!
//! * the two traits, [`Real`] for explicit kernels and [`Precise`] for what must compare or round;
//! * [`Dd`]: double-double numbers, 106 bits, for constants, references and invariants;
//! * [`trig`]: sine and cosine in `f64`, the same bits on every CPU;
//! * [`Series`], [`Tape`]: truncated power series, and the record of a function of them, which gives the coefficients of
//!   its result one by one;
//! * [`Compensated`]: compensated sums;
//! * [`Expansion`]: exact sums and products of a few numbers;
//! * [`elliptic`]: elliptic integrals and functions;
//! * [`Covariance`]: covariances of vectors;
//! * `Random`, `Distribution`: seeded random numbers and vectors (feature `random`).
//!
//! Nothing here calls the platform's mathematical library or fuses a multiplication with an addition: the
//! same input gives the same bits on every CPU and at every optimisation level.

pub(crate) mod complex;
mod covariance;
pub(crate) mod dd;
#[cfg(any(test, feature = "random"))]
mod distribution;
#[doc(hidden)]
pub mod eigen;
pub mod elliptic;
pub(crate) mod error_free;
mod expansion;
pub(crate) mod exponential;
mod lanes;
#[cfg(any(test, feature = "random"))]
mod random;
mod real;
mod recurrence;
mod series;
mod shown;
pub(crate) mod stumpff;
pub(crate) mod sum;
mod tape;
pub mod trig;
mod triple;

pub use covariance::{Covariance, DistributionError};
pub use dd::{Dd, ParseDdError};
pub(crate) use dd::{DdLanes, Doubled};
#[cfg(any(test, feature = "random"))]
pub use distribution::Distribution;
pub use expansion::Expansion;
pub use lanes::Instructions;
pub(crate) use lanes::{LANES, Lane};
#[cfg(any(test, feature = "random"))]
pub use random::Random;
pub(crate) use real::Several;
pub use real::{Precise, Real};
pub use series::Series;
#[doc(hidden)]
pub use shown::{Computed, Shown};
pub use sum::Compensated;
#[doc(hidden)]
pub use sum::add_carried;
pub use tape::Tape;
pub(crate) use triple::Triple;

//! A carrier, a proof body and an object as one joint fit.
//!
//! A sensor sits on a carrier, which tumbles alone, with a proof body whose mass properties are known, and with an object. A free
//! record tells the shape of the tensor that tumbles, five numbers; with wheels of known momentum or known torques it tells one over
//! the trace besides, and with a wheel of unknown inertia j the quotient j/trace. The tensors differ by what was attached,
//!
//! T = C + \[object\] X + \[proof\] D, D = I + μ (|d|² 1 − d dᵀ), μ = m M/(m + M),
//!
//! with I the tensor of the attached body about its own centre of mass, d from the carrier's centre of mass to that, m and M the
//! two masses: the parallel-axis theorem about the common centre of mass. As D is known, two shapes tell the size of the carrier.
//!
//! Each record is a normal distribution of its readings (errors of the sensor, one over the trace, five coordinates of the shape);
//! torques are of each record by itself, errors of the sensor are the same in all. The sum of their squares is made least by Gauss's
//! and Newton's method, and the tensors of carrier and object are physical.

mod agreement;
pub(crate) mod error;
pub(crate) mod estimate;
mod fit;
mod law;
mod least;
pub(crate) mod proof;
pub(crate) mod records;
mod report;
mod start;
mod system;
mod told;
pub(crate) mod warning;
mod wheels;

pub use fit::fit_carrier;

#[cfg(test)]
mod tests;

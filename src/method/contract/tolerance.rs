//! Why a method cannot be given a tolerance.

use thiserror::Error;

/// A method cannot take a tolerance, or not this one.
#[derive(Clone, Debug, PartialEq, Error)]
#[non_exhaustive]
pub enum ToleranceError {
    /// The method takes steps as given.
    #[error("method {method:?} does not choose its steps and takes no tolerance")]
    FixedSteps {
        /// Name of the method.
        method: String,
    },
    /// The tolerance is too small, too large, or no number.
    #[error("the tolerance {tolerance:e} of {method} must be {range}")]
    OutOfRange {
        /// Name of the method.
        method: &'static str,
        /// What was asked for.
        tolerance: f64,
        /// From which one to which, in words.
        range: &'static str,
    },
}

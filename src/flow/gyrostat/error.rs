//! Why a motion is not answered in closed form.

use thiserror::Error;

/// A regime in which the closed form has not enough digits; the method `taylor` follows such motions.
#[derive(Clone, Copy, Debug, PartialEq, Error)]
#[non_exhaustive]
pub enum GyrostatError {
    /// All but at a steady spin that is not stable.
    #[error(
        "the start is too close to an unstable steady spin for the closed form: in the shortest period of small oscillations \
         the momentum changes by {length:.1e} of its size; use the method taylor"
    )]
    Saddle {
        /// |m × ω|/|m| over the time of one small oscillation.
        length: f64,
    },
    /// All but on a separatrix.
    #[error(
        "the start is too close to a separatrix for the closed form (squared relative distance {apart:.1e}), which would \
         violate the equation of motion by {defect:.1e} of the rates; use the method taylor"
    )]
    Separatrix {
        /// Squared difference of the two roots that meet on the separatrix, over the terms that it is a sum of.
        apart: f64,
        /// Largest defect of the equation of motion over the largest rate.
        defect: f64,
    },
    /// The closed form does not hold the equation of motion, and no regime is known in which that happens.
    #[error(
        "the closed form violates the equation of motion by {defect:.1e} of the rates, more than rounding (1e-15); use the \
         method taylor"
    )]
    Digits {
        /// Largest defect of the equation of motion over the largest rate; undefined where a number has left the range of a double.
        defect: f64,
    },
}

//! Why a motion is not answered in closed form.

use thiserror::Error;

/// A regime in which the closed form has not enough digits; the method `taylor` follows such motions.
#[derive(Clone, Copy, Debug, PartialEq, Error)]
#[non_exhaustive]
pub enum GyrostatError {
    /// All but at a steady spin that is not stable.
    #[error(
        "the start is all but at a steady spin that is not stable: in the shortest period of small oscillations the momentum moves by {length:.1e} of \
         itself; the closed form has too few digits there, and the method taylor follows this motion"
    )]
    Saddle {
        /// |m × ω|/|m| over the time of one small oscillation.
        length: f64,
    },
    /// All but on a separatrix.
    #[error(
        "the start is all but on a separatrix ({apart:.1e} away, squared and of the whole): the closed form would miss the equation of motion by \
         {defect:.1e} of the rates; the method taylor follows this motion"
    )]
    Separatrix {
        /// Squared difference of the two roots that meet on the separatrix, over the terms that it is a sum of.
        apart: f64,
        /// Largest defect of the equation of motion over the largest rate.
        defect: f64,
    },
    /// The closed form does not hold the equation of motion, and no regime is known in which that happens.
    #[error(
        "the closed form misses the equation of motion by {defect:.1e} of the rates, at most 1e-15 is rounding; the method taylor follows this \
         motion"
    )]
    Digits {
        /// Largest defect of the equation of motion over the largest rate; undefined where a number has left the range of a double.
        defect: f64,
    },
}

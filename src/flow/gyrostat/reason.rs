//! Why a motion is not answered in closed form.

use thiserror::Error;

/// A regime in which the closed form has not enough digits; [`taylor`](crate::method) follows these motions.
#[derive(Clone, Copy, Debug, PartialEq, Error)]
#[non_exhaustive]
pub enum Reason {
    /// All but at an unstable or neutral steady spin.
    #[error(
        "the start is all but at a steady spin that is not stable: m turns in the body at {speed:.1e} of the rates; the method taylor follows \
         this motion"
    )]
    Saddle {
        /// |m × ω| over |m| and the largest rate.
        speed: f64,
    },
    /// All but on a separatrix.
    #[error(
        "the start is all but on a separatrix: the closed form misses the equation of motion by {defect:.1e} of the rates (k'^4 = {apart:.1e}); \
         the method taylor follows this motion"
    )]
    Separatrix {
        /// Largest defect of the equation of motion over the largest rate.
        defect: f64,
        /// Relative distance of the two roots that meet on the separatrix, squared.
        apart: f64,
    },
}

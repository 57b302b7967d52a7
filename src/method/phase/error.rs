//! Why the phase error of a method cannot be predicted.

use thiserror::Error;

use super::drift::{MOST_DOUBT, MOST_STEPS};
use super::forced::MOST_LEFT;
use crate::body::StateError;
use crate::flow::TimeError;
use crate::method::StepError;

/// Why the phase error of a method cannot be predicted.
#[derive(Clone, Debug, PartialEq, Error)]
#[non_exhaustive]
pub enum PhaseError {
    /// The method does not keep the energy and |m|.
    #[error(
        "the phase error of method {method:?} grows faster than linearly: {lost}; use a method that keeps energy and |m|, such \
         as two-turn or rattle"
    )]
    NotKept {
        /// Name of the method.
        method: String,
        /// What it loses.
        lost: &'static str,
    },
    /// What is left of the phase error does not grow.
    #[error("method {method:?} corrects its phase error at output, and the rest does not grow")]
    TakenBack {
        /// Name of the method.
        method: String,
    },
    /// Forces are strong.
    #[error(
        "the phase error is predicted for the free body only; under {force} its growth differs by {}, more than {MOST_LEFT:e}",
        share_in_words(*share)
    )]
    Force {
        /// Name of the first force.
        force: String,
        /// Of the growth, from a short run beside the true motion.
        share: f64,
    },
    /// A force that is switched.
    #[error("the phase error is predicted only for forces that act all the time, and {force} is switched")]
    Switched {
        /// Name of the force.
        force: String,
    },
    /// Forces have acted for long.
    #[error(
        "under {force} the phase error can be predicted up to {until:.3e} s, where its growth may differ by a hundredth from \
         that of the free body, not up to {t:e} s"
    )]
    Late {
        /// The time, s.
        t: f64,
        /// Name of the first force.
        force: String,
        /// The last time that has an answer, s.
        until: f64,
    },
    /// Forces have changed the motion.
    #[error(
        "under {force} |L| or the distance from the separatrix has changed by a share of {change:.1e} after {t:e} s, more than \
         {MOST_LEFT:e}: the prediction from the start no longer holds"
    )]
    Changed {
        /// The time, s.
        t: f64,
        /// Name of the first force.
        force: String,
        /// Relative change, the larger of both.
        change: f64,
    },
    /// The time has no answer.
    #[error(transparent)]
    Time(#[from] TimeError),
    /// The method takes no such steps of this body.
    #[error(transparent)]
    Step(#[from] StepError),
    /// The start is none.
    #[error(transparent)]
    Start(#[from] StateError),
    /// The motion has no period.
    #[error(
        "the start is on the separatrix: its motion has no period, and the phase error does not grow linearly"
    )]
    Separatrix,
    /// The short run would be long.
    #[error("the short run would take {steps:.1e} steps, more than {MOST_STEPS:e}; use a larger step")]
    Long {
        /// Steps of the run.
        steps: f64,
    },
    /// A period has too few steps.
    #[error(
        "a period of the momentum has {steps:.1} steps, too few to tell oscillation from growth; use a smaller step"
    )]
    Coarse {
        /// Steps in half a period of the momentum.
        steps: f64,
    },
    /// The step is so long, or the separatrix so near, that shift and twist do not grow linearly.
    #[error(
        "shift and twist do not grow linearly: they differ by a share of {doubt:.1e} between two parts of the short run, more \
         than {MOST_DOUBT:e}. The start is at (|L|^2/2E - I2)/I2 = {distance:.1e}, which is 0 on the separatrix. Use a smaller \
         step"
    )]
    Unsettled {
        /// Relative difference of the growth.
        doubt: f64,
        /// Distance from the separatrix.
        distance: f64,
    },
    /// The short run left the range of numbers, or an implicit step had no solution.
    #[error(
        "the short run of {steps} steps from which the phase error is predicted diverges; use a smaller step"
    )]
    Diverged {
        /// Its steps.
        steps: u64,
    },
}

/// Of a method without a phase error of its own the share has no bound.
fn share_in_words(share: f64) -> String {
    if share < 1.0 { format!("a share of {share:.1e}") } else { "all of it".into() }
}

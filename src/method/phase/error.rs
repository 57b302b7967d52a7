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
        "the phase of method {method:?} has no constant rates: {lost}, so that its error grows faster than time; take a method that \
         keeps both, such as two-turn or rattle"
    )]
    NotKept {
        /// Name of the method.
        method: String,
        /// What it loses.
        lost: &'static str,
    },
    /// What is left of the phase error does not grow.
    #[error("the phase error of method {method:?} is taken back at output: what is left does not grow")]
    TakenBack {
        /// Name of the method.
        method: String,
    },
    /// Forces are strong.
    #[error(
        "the phase error is predicted of the free body, and under {force} {} of its growth is another, more than {MOST_LEFT:e}: nothing is predicted",
        share_in_words(*share)
    )]
    Force {
        /// Name of the first force.
        force: String,
        /// Of the growth, from a short run beside the true motion.
        share: f64,
    },
    /// A force that is switched.
    #[error("the phase error is predicted of forces that act throughout, and {force} is switched")]
    Switched {
        /// Name of the force.
        force: String,
    },
    /// Forces have acted for long.
    #[error(
        "under {force} the phase error is predicted to {until:.3e} s, where a hundredth of its growth may be another than that of the \
         free body, and {t:e} s are asked"
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
         {MOST_LEFT:e}: the phase error is no longer that predicted at the start"
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
        "the start is on the separatrix: its motion has no period, and the phase error no constant rates"
    )]
    Separatrix,
    /// The short run would be long.
    #[error(
        "the short run would take {steps:.1e} steps, more than {MOST_STEPS:e}: nothing is predicted; take \
         longer steps"
    )]
    Long {
        /// Steps of the run.
        steps: f64,
    },
    /// A period has too few steps.
    #[error(
        "the momentum comes round in {steps:.1} steps, too few to tell what oscillates from what grows: nothing is predicted; take \
         shorter steps"
    )]
    Coarse {
        /// Steps in half a period of the momentum.
        steps: f64,
    },
    /// The step is so long, or the separatrix so near, that shift and twist do not grow linearly.
    #[error(
        "shift and twist do not grow linearly: two parts of the short run differ in them by a share of {doubt:.1e}, more than \
         {MOST_DOUBT:e}; (|L|^2/2E - I2)/I2, zero on the separatrix, is {distance:.1e}; take shorter steps"
    )]
    Unsettled {
        /// Relative difference of the growth.
        doubt: f64,
        /// Distance from the separatrix.
        distance: f64,
    },
    /// The short run left the range of numbers, or an implicit step had no solution.
    #[error(
        "the short run of {steps} steps from which the phase error is predicted has no finite end: take shorter steps"
    )]
    Diverged {
        /// Its steps.
        steps: u64,
    },
}

/// Of a method without a phase error of its own the share has no bound.
fn share_in_words(share: f64) -> String {
    if share < 1.0 { format!("a share of {share:.1e}") } else { "all".into() }
}

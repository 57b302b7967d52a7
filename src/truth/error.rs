//! Why a true motion is not known.

use thiserror::Error;

use crate::body::StateError;
use crate::flow::TimeError;
use crate::method::StepError;
use crate::num::Shown;

/// Why a true motion is not known.
#[derive(Clone, Debug, PartialEq, Error)]
#[non_exhaustive]
pub enum TruthError {
    /// The start is not usable.
    #[error(transparent)]
    State(#[from] StateError),
    /// The closed form does not reach so far.
    #[error(transparent)]
    Time(#[from] TimeError),
    /// The times of the looks do not ascend from the start.
    #[error("the time {} s does not come after {} s; times count from the start and must be finite and ascend", Shown(*.time), Shown(*.before))]
    Order {
        /// The time, s.
        time: f64,
        /// The one before it, 0 for the start, s.
        before: f64,
    },
    /// No run in double-double takes the forces.
    #[error("no closed form of the motion is known, and it cannot be followed in double-double: {0}")]
    NotFollowed(#[from] StepError),
    /// A run in double-double to the end would take too long.
    #[error(
        "no closed form of the motion is known, and to follow it to t = {} s would take about {steps:.1e} steps in \
         double-double, more than the {most} allowed; ask for at most {reach:.3e} s",
        Shown(*.until)
    )]
    TooLong {
        /// The end that was asked for, s since the start.
        until: f64,
        /// Steps to there.
        steps: f64,
        /// The most that are taken.
        most: u64,
        /// About how far these lead, s since the start.
        reach: f64,
    },
    /// The numbers of a run are no longer those of a motion.
    #[error(
        "no run continues beyond t = {} s after the start: a force or the state is not finite there, or no step can be solved; \
         ask for a time below that", Shown(*.time)
    )]
    Lost {
        /// When, s since the start.
        time: f64,
    },
    /// The torque jumps.
    #[error(
        "the torque jumps at t = {} s after the start: no method has its order across a jump; end the run there and begin \
         another, or write the torque without jumps", Shown(*.time)
    )]
    Jumps {
        /// When first, s since the start.
        time: f64,
    },
    /// The torque jumps, and runs that choose their steps would take too long.
    #[error(
        "the torque jumps at t = {} s after the start, and a run that follows it from there as closely as asked for would take \
         about {steps:.1e} steps, more than the {most:.1e} allowed; end the run at the jump and begin another, ask for a larger \
         error or a shorter time, or write the torque without jumps", Shown(*.time)
    )]
    LongAcrossJump {
        /// When first, s since the start.
        time: f64,
        /// Steps of a run.
        steps: f64,
        /// The most that are taken in all.
        most: f64,
    },
    /// The motion is not known there.
    #[error("the motion is known from 0 s to {} s after its start, not at {} s", Shown(*.known_until), Shown(*.time))]
    Unknown {
        /// The time, s since the start.
        time: f64,
        /// Up to when it is known, s since the start.
        known_until: f64,
    },
}

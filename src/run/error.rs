//! Why a run could not start or go on.

use thiserror::Error;

use super::{CheckpointError, Sample, ScheduleError};
use crate::body::StateError;
use crate::events::EventError;
use crate::method::{PhaseError, SOLVED, StepError, Stuck};
use crate::num::{Precise, Shown};

/// Why a run could not start or go on.
#[derive(Clone, Debug, Error)]
#[non_exhaustive]
pub enum RunError {
    /// The step is not usable.
    #[error(transparent)]
    Step(#[from] StepError),
    /// The start is not usable.
    #[error(transparent)]
    State(#[from] StateError),
    /// The phase error that the method takes back cannot be predicted.
    #[error(transparent)]
    Phase(#[from] PhaseError),
    /// The checkpoint is not that of this run.
    #[error(transparent)]
    Checkpoint(#[from] CheckpointError),
    /// The run is further on already.
    #[error("{asked} steps were asked for, and the run has taken {taken}; it goes forwards only")]
    Behind {
        /// Steps asked for.
        asked: u64,
        /// Steps taken.
        taken: u64,
    },
    /// The time is none of the run.
    #[error(transparent)]
    Time(#[from] ScheduleError),
    /// The run is past that time already.
    #[error(
        "the state at t = {} s was asked for, and the run is at t = {} s; it goes forwards only", Shown(*asked), Shown(*reached)
    )]
    Past {
        /// The time asked for, s.
        asked: f64,
        /// The time of the run, s.
        reached: f64,
    },
    /// Events could not be looked for.
    #[error(transparent)]
    Event(#[from] EventError),
    /// The next step leaves the range of numbers.
    #[error("diverged after {} steps, t = {} s: the next state is not finite; use a smaller step or another method",
        .last.steps, Shown(.last.time.to_f64()))]
    Diverged {
        /// The last finite sample.
        last: Box<Sample>,
    },
    /// The state is finite in the solver frame, and in the units of the body time, momentum or energy are not.
    #[error(
        "after {steps} steps, t = {} s, time, momentum or energy leave the range of a double in the units of the body; use a \
         smaller step, or change the units", Shown(*time)
    )]
    OutOfRange {
        /// Steps taken.
        steps: u64,
        /// The time then, s.
        time: f64,
    },
    /// A force is not a finite number.
    #[error(
        "{force} is not finite at t = {} s, after {} steps; the state at t = {} s before it is finite: q = {:?}, omega_body = {:?} rad/s",
        Shown(*.time), .last.steps, Shown(.last.time.to_f64()), .last.state.attitude.components(), .last.omega_body.as_slice()
    )]
    Force {
        /// Name of the force.
        force: String,
        /// When it was evaluated, s.
        time: f64,
        /// The last finite sample.
        last: Box<Sample>,
    },
    /// No step that the method can choose has an error within its tolerance.
    #[error(
        "after {} steps, t = {} s, the method finds no step: at t = {} s a step of {:.1e} s {}; the state at t = {} s is q = \
         {:?}, omega_body = {:?} rad/s",
        .last.steps, Shown(.last.time.to_f64()), Shown(.stuck.time), .stuck.step, left(.stuck),
        Shown(.last.time.to_f64()), .last.state.attitude.components(), .last.omega_body.as_slice()
    )]
    Stuck {
        /// The last sample before.
        last: Box<Sample>,
        /// The last step tried.
        stuck: Stuck,
    },
    /// What happens along the run is found in numbers that no longer are those of a rotation.
    #[error("{why}")]
    Nonsense {
        /// Why they are not, as [`Sample::nonsense`] says it.
        why: String,
    },
    /// The equations of an implicit step could not be solved.
    #[error(
        "after {} steps, t = {} s, an implicit step was not solved (relative residual {residual:.1e}, at most {SOLVED:e}): the \
         body turns too far in it; use a step below one radian, which at this rate is {:.2e} s",
        .last.steps, Shown(.last.time.to_f64()), 1.0 / .last.omega_body.norm()
    )]
    Unsolved {
        /// The sample at which it was noticed.
        last: Box<Sample>,
        /// The worst relative residual.
        residual: f64,
    },
}

impl RunError {
    /// The last finite sample of a run that failed on its way; `None` where it could not start, or left the range of numbers in
    /// the units of the body.
    #[must_use]
    pub fn last(&self) -> Option<&Sample> {
        match self {
            RunError::Diverged { last }
            | RunError::Force { last, .. }
            | RunError::Stuck { last, .. }
            | RunError::Unsolved { last, .. } => Some(last),
            _ => None,
        }
    }
}

fn left(stuck: &Stuck) -> String {
    if let Some(needed) = stuck.needed {
        return format!("is one of {needed:.0e} within one step of the run (at most 1e10 are allowed)");
    }
    match stuck.estimate {
        Some(estimate) => format!("still has an error of {estimate:.1e} times the tolerance"),
        None => "still leads to a state that is not finite".into(),
    }
}

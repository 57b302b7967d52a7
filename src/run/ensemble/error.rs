//! What befalls a member, and what befalls all.

use thiserror::Error;

use crate::body::{StateError, WheelError};
use crate::events::EventError;
use crate::flow::{NoClosedForm, TimeError};
use crate::inertia::InertiaError;
use crate::method::StepError;
use crate::num::Shown;
use crate::run::RunError;

/// Why a member has no state.
#[derive(Clone, Debug, Error)]
#[non_exhaustive]
pub enum MemberError {
    /// Its inertia tensor is none of a body.
    #[error(transparent)]
    Inertia(#[from] InertiaError),
    /// Its start, or the weight that acts on it, is not usable.
    #[error(transparent)]
    State(#[from] StateError),
    /// It cannot carry its wheels.
    #[error(transparent)]
    Wheel(#[from] WheelError),
    /// Its motion has no closed form.
    #[error(transparent)]
    NoClosedForm(#[from] NoClosedForm),
    /// It cannot be followed so far.
    #[error(transparent)]
    Time(#[from] TimeError),
    /// Events could not be looked for.
    #[error(transparent)]
    Event(#[from] EventError),
    /// Its run could not go on.
    #[error(transparent)]
    Run(#[from] RunError),
}

/// Why an ensemble could not be propagated.
#[derive(Clone, Debug, PartialEq, Error)]
#[non_exhaustive]
pub enum EnsembleError {
    /// The method, the step or the start time is not usable for its bodies.
    #[error(transparent)]
    Step(#[from] StepError),
    /// A time is not a number.
    #[error("time {} s is not a finite number", Shown(*t))]
    Time {
        /// The time, s.
        t: f64,
    },
    /// The numbers of steps descend.
    #[error("{after} steps follow {before}; give numbers of steps in ascending order")]
    Descending {
        /// The larger one, which stands before.
        before: u64,
        /// The smaller one behind it.
        after: u64,
    },
}

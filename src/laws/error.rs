//! Why laws cannot be measured.

use thiserror::Error;

use crate::body::{ForceError, StateError, WheelError};
use crate::inertia::InertiaError;
use crate::method::{SchemeError, StepError, TaylorOrderError};
use crate::run::HalvingError;

/// Why laws cannot be measured.
#[derive(Clone, Debug, PartialEq, Error)]
#[non_exhaustive]
pub enum LawsError {
    /// The inertia is that of no body.
    #[error(transparent)]
    Inertia(#[from] InertiaError),
    /// The start is not usable.
    #[error(transparent)]
    State(#[from] StateError),
    /// The body cannot carry a wheel.
    #[error(transparent)]
    Wheel(#[from] WheelError),
    /// A force cannot act.
    #[error(transparent)]
    Force(#[from] ForceError),
    /// The method does not take a step.
    #[error(transparent)]
    Step(#[from] StepError),
    /// Errors at halved steps cannot be measured.
    #[error(transparent)]
    Halving(#[from] HalvingError),
    /// The scheme fits no exact flow with kicks.
    #[error(transparent)]
    Scheme(#[from] SchemeError),
    /// There is no Taylor series of the order.
    #[error(transparent)]
    Taylor(#[from] TaylorOrderError),
}

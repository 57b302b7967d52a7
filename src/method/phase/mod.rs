//! The phase error: what becomes of a method that keeps energy and |m| in bounds.
//!
//! Such a method moves the momentum round a polhode, as the exact motion does, and what it does wrong grows in two numbers alone: a
//! shift in time along the polhode, τ(t) = ρ t + …, and a twist about L, ψ(t) = σ t + …. The dots stand for oscillations with the
//! periods of the momentum, which do not grow. Both rates are known [before the run](PhaseDrift), and can be [taken
//! back](PhaseCorrected) at each output.

mod corrected;
mod drift;
mod error;
mod forced;
mod harmonics;
mod undo;

pub use corrected::PhaseCorrected;
pub use drift::PhaseDrift;
pub(super) use drift::TAKEN_BACK;
pub(crate) use drift::throughout;
pub use error::PhaseError;

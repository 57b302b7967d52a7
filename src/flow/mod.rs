//! Exact flows: the atoms that splitting methods are composed of, and the references they are judged by.

mod casimir;
mod exact_motion;
mod free;
mod kick;
mod lagrange;
mod reach;
mod turn;

pub use casimir::Casimir;
pub use exact_motion::{ExactMotion, NoClosedForm};
pub use free::{AtRest, Character, FreeBody, FreeFlow, FreeMotion, Mode, SymmetricTop};
pub use kick::Kick;
pub use lagrange::{LagrangeError, LagrangeTop};
pub use reach::TimeError;
pub(crate) use turn::{AxisTurn, turn_about, turn_about_axis};

use crate::body::{Point, Time};
use crate::num::Real;

/// The exact solution of a vector field: `flow(s)` then `flow(t)` is `flow(s + t)`.
pub trait Flow<S: Real> {
    /// Moves `x` by the time `t` (s) from the time `at` on; negative times go back. What rounding takes is carried in `x`.
    fn flow(&self, at: Time, t: S, x: &mut Point<S>);
}

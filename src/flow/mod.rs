//! Exact flows: the atoms that splitting methods are composed of, and the references they are judged by.

mod casimir;
mod character;
mod circulation;
mod complex;
mod exact_motion;
mod free_body;
mod free_flow;
mod kick;
mod lagrange_top;
mod nutation;
mod phase;
mod polhode;
mod short_flow;
mod symmetric_top;
mod theta;
mod turn;

pub use casimir::Casimir;
pub use character::{AtRest, Character, Mode};
pub use exact_motion::{ExactMotion, NoClosedForm};
pub use free_body::{FreeBody, FreeMotion, TimeError};
pub use free_flow::FreeFlow;
pub use kick::Kick;
pub use lagrange_top::{LagrangeError, LagrangeTop};
pub use symmetric_top::SymmetricTop;
pub use turn::{AxisTurn, turn};

use crate::body::{Point, Time};
use crate::num::Real;

/// The exact solution of a vector field: `flow(s)` then `flow(t)` is `flow(s + t)`.
pub trait Flow<S: Real> {
    /// Moves `x` by the time `t` (s) from the time `at` on; negative times go back. What rounding takes is carried in `x`.
    fn flow(&self, at: Time, t: S, x: &mut Point<S>);
}

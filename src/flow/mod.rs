//! Exact flows: the atoms that splitting methods are composed of, and the references they are judged by.

mod casimir;
mod character;
mod circulation;
mod complex;
mod free_body;
mod kick;
mod lagrange_top;
mod nutation;
mod phase;
mod polhode;
mod short_drift;
mod symmetric_top;
mod theta;
mod turn;

pub use casimir::Casimir;
pub use character::{AtRest, Character, Mode};
pub use free_body::{FreeBody, FreeMotion, TimeError};
pub use kick::Kick;
pub use lagrange_top::{LagrangeError, LagrangeTop};
pub use short_drift::ShortDrift;
pub use symmetric_top::SymmetricTop;
pub use turn::{AxisTurn, turn};

use crate::body::State;
use crate::num::Real;

/// The exact solution of a vector field: `flow(s)` then `flow(t)` is `flow(s + t)`.
pub trait Flow<S: Real> {
    /// Moves `x` by the time `t` (s); negative times go back.
    fn flow(&self, t: S, x: &mut State<S>);
}

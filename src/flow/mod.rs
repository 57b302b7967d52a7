//! Exact flows: the atoms that splitting methods are composed of, and the references they are judged by.

mod character;
mod circulation;
mod free_body;
mod phase;
mod polhode;
mod theta;
mod turn;

pub use character::{AtRest, Character, Mode};
pub use free_body::{FreeBody, FreeMotion, TimeError};
pub use turn::{AxisTurn, turn};

use crate::body::State;
use crate::num::Real;

/// The exact solution of a vector field: `flow(s)` then `flow(t)` is `flow(s + t)`.
pub trait Flow<S: Real> {
    /// Moves `x` by the time `t` (s); negative times go back.
    fn flow(&self, t: S, x: &mut State<S>);
}

//! Methods made of maps: splittings, compositions, and their schemes.

mod composed;
mod kicks;
mod kinetic_split;
mod lengths;
mod processor;
mod scheme_error;
pub mod schemes;
mod splitting;
mod splitting_map;
mod wheels;

pub use composed::{Composed, Symmetric};
pub use kicks::Kicks;
pub use kinetic_split::{InTurn, KineticSplit, Palindrome};
pub(super) use lengths::lengths;
pub use scheme_error::SchemeError;
pub use splitting::{FreePart, Splitting};
pub use wheels::WheelSplit;

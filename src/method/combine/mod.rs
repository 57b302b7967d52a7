//! Methods made of maps: splittings, compositions, and their schemes.

mod composed;
mod kicks;
mod processor;
pub mod schemes;
mod splitting;

pub use composed::{Composed, Symmetric};
pub use kicks::Kicks;
pub(super) use splitting::lengths;
pub use splitting::{FreePart, SchemeError, Splitting};

//! Invariants in double-double, their largest errors over every step, and the statistics of secular drift.

mod circle;
mod drift;
mod errors;
mod flips;
mod forced;
mod invariants;
mod lanes;
mod monitor;

pub use drift::{Drift, secular_drift};
pub use errors::Errors;
pub(crate) use flips::Flips;
pub use invariants::Invariants;
pub use monitor::Monitor;
pub(crate) use monitor::{BLOCK, Memory};

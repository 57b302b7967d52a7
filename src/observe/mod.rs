//! What a run keeps and what it loses: invariants in double-double, their largest errors over every step, and
//! the statistics of drift. Takes states and series only.

mod drift;
mod invariants;
mod monitor;

pub use drift::{Drift, secular_drift};
pub use invariants::Invariants;
pub use monitor::{BLOCK, Errors, Monitor};

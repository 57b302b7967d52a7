//! Long propagation: steps counted in `u64`, samples at scheduled steps or at any time, events, checkpoints, typed errors of runs
//! that diverge, and ensembles of many bodies.

mod between;
mod checkpoint;
mod convergence;
mod ensemble;
mod error;
mod events;
mod phases;
#[allow(clippy::module_inception)]
mod run;
mod sample;
mod schedule;

pub use checkpoint::{Checkpoint, CheckpointError};
pub use convergence::{Halving, HalvingError, halvings, halvings_against, observed_order};
pub use ensemble::{Ensemble, EnsembleError, MemberError, Observed, Rows, Spread, Tally};
pub use error::RunError;
pub use run::Run;
pub use sample::{Sample, Watch};
pub use schedule::{Multiples, Schedule, ScheduleError};

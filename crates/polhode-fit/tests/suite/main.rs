//! The fit as its users call it: one program, so that the solvers are linked once.

#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic)] // what clippy.toml allows inside #[test], for the helpers too

mod answers;
mod carrier;
mod causes;
mod failures;
mod fit;
mod flights;
mod gyrostat;
mod measured;
mod models;
mod next_step;
mod poses;
mod poses_driven;
mod poses_record;
mod prior;
mod report;
mod segments;
mod simulate;
mod sparse;
mod systematic;
mod told;
mod torque;
mod units;
mod wheel;

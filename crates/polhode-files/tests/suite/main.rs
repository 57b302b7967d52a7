//! Files of other programs, as they are read.

#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic)] // what clippy.toml allows inside #[test], for the helpers too

mod logs;
mod meshes;
mod parts;
mod record;
mod trajectory;

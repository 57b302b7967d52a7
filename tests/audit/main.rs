//! Records of known motions in random conventions, and records of programs with a mistake: what is found is what was written.

#![allow(clippy::unwrap_used, clippy::panic, clippy::disallowed_methods)]

mod causes;
mod conventions;
mod every_row;
mod mistakes;
mod records;
mod ties;

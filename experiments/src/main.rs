//! The command line of polhode.

#![allow(dead_code, unused_imports, unused_macros, reason = "the commands that use these modules come next")]

mod arguments;
mod error;
mod files;
mod table;

fn main() {}

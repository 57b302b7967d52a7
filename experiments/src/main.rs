//! The command line of polhode.
fn main() {}

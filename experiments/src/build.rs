//! Which source and which compiler made the program.

/// The commit, or `unknown`.
pub const COMMIT: &str = env!("POLHODE_COMMIT");
/// Whether sources differ from the commit.
pub const CHANGED: &str = env!("POLHODE_DIRTY");
/// Version of the compiler.
pub const RUSTC: &str = env!("POLHODE_RUSTC");
/// Profile of the build.
pub const PROFILE: &str = env!("POLHODE_PROFILE");
/// Processor and system.
pub const TARGET: &str = env!("POLHODE_TARGET");

//! How many random cases the properties look at, and which.

use proptest::test_runner::{Config, RngSeed};

/// The same `count` cases in every run, so that a failure speaks of the change at hand. `PROPTEST_CASES` asks for others,
/// as many as it says.
pub(crate) fn usual(count: u32) -> Config {
    match std::env::var_os("PROPTEST_CASES") {
        Some(_) => Config { failure_persistence: None, ..Config::default() },
        None => Config {
            cases: count,
            rng_seed: RngSeed::Fixed(1851),
            failure_persistence: None,
            ..Config::default()
        },
    }
}

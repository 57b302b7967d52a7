//! Why attitudes cannot be used.

use polhode::num::Shown;
use thiserror::Error;

/// Why attitudes cannot be used. Samples count from 1.
#[non_exhaustive]
#[derive(Clone, Debug, PartialEq, Error)]
pub enum PosesError {
    /// Lists of different lengths.
    #[error("{source_name}: {times} times but {found} {what}; every sample needs both")]
    Lengths {
        /// Where they come from.
        source_name: String,
        /// What there are too few or too many of.
        what: &'static str,
        /// Times.
        times: usize,
        /// How many of the other.
        found: usize,
    },
    /// A number that is not finite.
    #[error("{source_name}, sample {sample}: the {what} is not finite; leave the sample out")]
    Value {
        /// Where it comes from.
        source_name: String,
        /// Which sample.
        sample: usize,
        /// What it is of.
        what: &'static str,
    },
    /// A quaternion that is no rotation; one that was normalised at norm zero is not finite.
    #[error(
        "{source_name}, sample {sample}: the quaternion has norm zero or is not finite, so that it is not an attitude; leave the sample out"
    )]
    NoAttitude {
        /// Where it comes from.
        source_name: String,
        /// Which sample.
        sample: usize,
    },
    /// Times that do not ascend.
    #[error(
        "{source_name}, sample {sample}: time {} s comes after {} s; times must ascend. Sort the samples, or give them as separate files",
        Shown(*time),
        Shown(*before)
    )]
    Order {
        /// Where they come from.
        source_name: String,
        /// Which sample.
        sample: usize,
        /// Its time, s.
        time: f64,
        /// The time before it, s.
        before: f64,
    },
    /// No samples, or none in a window.
    #[error("no samples{}", window.map_or(String::new(), |(a, b)| format!(" between {} s and {} s", Shown(a), Shown(b))))]
    Empty {
        /// The window that has none, s.
        window: Option<(f64, f64)>,
    },
    /// A window that ends before it begins.
    #[error("window {},{}: a window is a start and a later end, in seconds", Shown(*start), Shown(*end))]
    Window {
        /// Its start, s.
        start: f64,
        /// Its end, s.
        end: f64,
    },
}

impl From<PosesError> for polhode::Error {
    fn from(error: PosesError) -> Self {
        polhode::Error::new(error)
    }
}

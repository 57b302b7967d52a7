//! A unit that may have been taken for another.

use core::fmt;

use polhode::units::{RateUnit, TimeUnit};

/// A unit of the record that may have been taken for another.
#[non_exhaustive]
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum MistakenUnit {
    /// Of the rates.
    Rate {
        /// The unit in which the rates seem to be.
        meant: RateUnit,
        /// The unit in which they were read.
        read: RateUnit,
    },
    /// Of the times.
    Time {
        /// The unit in which the times seem to be.
        meant: TimeUnit,
        /// The unit in which they were read.
        read: TimeUnit,
    },
}

impl fmt::Display for MistakenUnit {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Rate { meant, read } => write!(f, "{} taken for {}", meant.words(), read.words()),
            Self::Time { meant, read } => write!(f, "{} taken for {}", meant.words(), read.words()),
        }
    }
}

/// Several in one sentence.
pub(crate) fn alternatives(mistakes: &[MistakenUnit]) -> String {
    mistakes.iter().map(MistakenUnit::to_string).collect::<Vec<_>>().join(", or ")
}

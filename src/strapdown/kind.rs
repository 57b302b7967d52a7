//! What a reading of a gyroscope is.

use core::fmt;
use core::str::FromStr;

use thiserror::Error;

/// What a reading says of the angular velocity ω in body axes. Each stands at the end of the interval that it speaks of.
///
/// The three are not exchangeable: taken for instantaneous rates, averages lag by half an interval, and the coning term of the
/// classical rules differs by a factor of two.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// ω at the time of the sample, rad/s.
    Rate,
    /// ∫ω dt since the sample before, rad. That of the first sample is not used: when it began is not known.
    Increment,
    /// The mean of ω since the sample before, rad/s. That of the first sample is not used.
    Average,
}

impl Kind {
    /// All of them.
    pub const ALL: [Kind; 3] = [Kind::Rate, Kind::Increment, Kind::Average];

    /// The word for it.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Rate => "rate",
            Self::Increment => "increment",
            Self::Average => "average",
        }
    }
}

impl fmt::Display for Kind {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}

/// A word that names no kind of reading.
#[derive(Clone, Debug, PartialEq, Eq, Error)]
#[error("unknown kind of reading '{name}'; known: rate, increment, average")]
#[non_exhaustive]
pub struct UnknownKind {
    /// The word.
    pub name: String,
}

impl FromStr for Kind {
    type Err = UnknownKind;

    fn from_str(name: &str) -> Result<Self, UnknownKind> {
        let known = Kind::ALL.into_iter().find(|kind| kind.name() == name);
        known.ok_or_else(|| UnknownKind { name: name.chars().take(40).collect() })
    }
}

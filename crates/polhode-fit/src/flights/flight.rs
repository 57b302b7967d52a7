//! A span of free rotation.

use core::fmt;

/// Why a flight does not reach further.
#[non_exhaustive]
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum FlightLimit {
    /// There the segment begins or ends.
    Edge,
    /// The body hardly turns there: it rests, or a hand holds it.
    Slow,
    /// A torque acts there.
    Torque {
        /// Its mean over a test function, over the trace of the tensor times |ω|².
        share: f64,
    },
}

impl fmt::Display for FlightLimit {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Edge => f.write_str("no more samples"),
            Self::Slow => f.write_str("hardly turns"),
            Self::Torque { share } => write!(f, "torque {share:.2} tr(J) |w|^2"),
        }
    }
}

/// A span of free rotation, but for drag.
#[non_exhaustive]
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Flight {
    /// Index of its segment in the record.
    pub segment: usize,
    /// Time of its first sample, s.
    pub start: f64,
    /// Time of its last sample, s.
    pub end: f64,
    /// Number of its samples.
    pub samples: usize,
    /// Angle by which the body turned, rad.
    pub turned: f64,
    /// Why it does not begin earlier.
    pub before: FlightLimit,
    /// Why it does not end later.
    pub after: FlightLimit,
}

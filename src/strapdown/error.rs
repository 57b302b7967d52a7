//! Why readings cannot be integrated.

use thiserror::Error;

use super::{Kind, Rule};
use crate::num::{Computed, Shown};

/// Why readings cannot be integrated. Samples count from 0.
#[derive(Clone, Debug, PartialEq, Error)]
#[non_exhaustive]
pub enum StrapdownError {
    /// A time or a reading is not a finite number.
    #[error("sample {sample}: {name} is {}; a finite number is needed", Shown(*value))]
    NotFinite {
        /// The sample.
        sample: usize,
        /// Which number.
        name: &'static str,
        /// Its value.
        value: f64,
    },
    /// Times do not ascend.
    #[error(
        "sample {sample}: time {} s is not after {} s; times must ascend",
        Shown(*time),
        Shown(*before)
    )]
    Order {
        /// The sample.
        sample: usize,
        /// Its time, s.
        time: f64,
        /// The time before, s.
        before: f64,
    },
    /// The body turns more than half a turn between two samples.
    #[error(
        "sample {sample}, at {} s: a turn by {} rad since the sample before, more than half a turn (pi): between samples so far \
         apart the motion is ambiguous (aliasing)",
        Shown(*time), Computed(*angle)
    )]
    HalfTurn {
        /// The sample.
        sample: usize,
        /// Its time, s.
        time: f64,
        /// Rate times interval, or the increment, rad.
        angle: f64,
    },
    /// Lists of different lengths.
    #[error("{times} times but {readings} readings; every sample needs both")]
    Lengths {
        /// Times.
        times: usize,
        /// Readings.
        readings: usize,
    },
    /// The attitude at the start is no quaternion of a turn.
    #[error("the start attitude has the largest component {}; give a finite quaternion other than zero", Shown(*size))]
    Start {
        /// The largest component.
        size: f64,
    },
    /// There are no samples.
    #[error("no samples: an attitude needs at least one")]
    Empty,
    /// A standard deviation of the sensor is not usable.
    #[error("{name} of the sensor is {}; a standard deviation must be at least 0 and below 1e154", Shown(*value))]
    Sensor {
        /// Which one.
        name: &'static str,
        /// Its value.
        value: f64,
    },
    /// The rule is not for this kind of reading.
    #[error("the rule {rule} needs instantaneous rates; these readings are of the kind {kind}")]
    Kind {
        /// The rule.
        rule: Rule,
        /// Kind of the readings.
        kind: Kind,
    },
}

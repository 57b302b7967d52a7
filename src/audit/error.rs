//! Why there is no verdict.

use thiserror::Error;

use crate::body::WheelError;
use crate::num::Shown;

/// Why a record cannot be audited. Rows count from 0.
#[derive(Clone, Debug, PartialEq, Error)]
#[non_exhaustive]
pub enum AuditError {
    /// Too few rows.
    #[error("the record has {rows} rows; a verdict needs at least {needed}")]
    TooFewRows {
        /// How many there are.
        rows: usize,
        /// How many are needed.
        needed: usize,
    },
    /// Times alone.
    #[error("the record has only times; a verdict needs attitudes, angular velocities or angular momenta")]
    NoColumns,
    /// Columns of different lengths.
    #[error(
        "the {column} has {found} rows, and there are {rows} times; every column needs one row for each time"
    )]
    Lengths {
        /// Which column.
        column: &'static str,
        /// Its rows.
        found: usize,
        /// The number of times.
        rows: usize,
    },
    /// Times that do not ascend.
    #[error("row {row}: the time {} s does not come after {} s; times must ascend", Shown(*time), Shown(*previous))]
    TimesNotAscending {
        /// The row, from 0.
        row: usize,
        /// Its time, s.
        time: f64,
        /// The time before, s.
        previous: f64,
    },
    /// Numbers without a digit.
    #[error("the {column} is declared to have 0 significant digits; declare at least 1")]
    NoDigits {
        /// Which column.
        column: &'static str,
    },
    /// A number that is not finite.
    #[error("row {row}: the {column} has the value {value}; every number must be finite")]
    NotFinite {
        /// Which column.
        column: &'static str,
        /// The row, from 0.
        row: usize,
        /// The value.
        value: f64,
    },
    /// A quaternion or a matrix of zeros.
    #[error("row {row}: every component of the attitude is zero, which is not a rotation")]
    NoAttitude {
        /// The row, from 0.
        row: usize,
    },
    /// The tolerance is not usable.
    #[error("the tolerance is {}; it must be above 0 and at most {}, as with more nearly any record would pass", Shown(*value), Shown(*most))]
    Tolerance {
        /// What was given.
        value: f64,
        /// What is allowed at most.
        most: f64,
    },
    /// Noise that is declared is not usable.
    #[error("the noise of the {quantity} is {}; it must be a number from 0 to {}", Shown(*value), Shown(*most))]
    Noise {
        /// Of which column.
        quantity: &'static str,
        /// What was given.
        value: f64,
        /// What is allowed at most.
        most: f64,
    },
    /// Noise that is declared of what the record does not hold.
    #[error("the noise of the {quantity} is declared to be {}, and the record has no {quantity}; declare 0", Shown(*value))]
    NoiseOfNothing {
        /// Of which column.
        quantity: &'static str,
        /// What was given.
        value: f64,
    },
    /// Angular momentum alone, which tells nothing without a body.
    #[error("a record of angular momenta needs the body, whose moments turn them into angular velocities")]
    MomentumNeedsBody,
    /// Wheels of a body that is not given.
    #[error("wheels are given, but no body; give its moments of inertia")]
    WheelsNeedBody,
    /// The body cannot carry the wheels.
    #[error(transparent)]
    Wheel(#[from] WheelError),
    /// Angular momenta of a body with wheels.
    #[error(
        "a column of angular momenta does not show whether it includes that of the wheels; leave it out, and record angular velocities"
    )]
    MomentumOfWheels,
    /// The angular velocity at the first row is not known.
    #[error(
        "the momentum of a free or driven wheel follows from the angular velocity at the first row, which this record does not determine; record angular velocities, or attitudes that turn less from row to row"
    )]
    NoStart,
    /// Nothing turns.
    #[error("nothing turns in the record, so that no convention can be told from another")]
    AtRest,
    /// What is claimed leaves no reading.
    #[error("the record cannot be read as stated: the stated conventions contradict its columns")]
    NoReading,
    /// The moments cannot be found from the record.
    #[error(
        "no body was given, and none is found that moves as the record does; give the moments of inertia"
    )]
    NoBody,
}

//! What is odd about the rows of a record, and what it lacks.

use core::fmt;

/// What a row holds that is not where the motion is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum Misplaced {
    /// The numbers of the row before.
    Repeated,
    /// The state of a neighbour, which holds the state of this row.
    Exchanged,
    /// The state of the row before or behind it: time stamps that are off by one.
    Shifted,
    /// The mean of its neighbours.
    Interpolated,
    /// None of these.
    Unknown,
}

/// Something about the sampling or the writing of a record.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub enum Fault {
    /// The body turns by more than half a turn between rows.
    TooCoarse {
        /// The turn, rad.
        angle: f64,
    },
    /// Attitudes alone that turn by less than ten times what they may be off.
    TooLittle {
        /// The largest turn from the first row, rad.
        turn: f64,
        /// What they may be off, rad.
        open: f64,
    },
    /// An interval is much longer than the others.
    TimeJump {
        /// The row behind it, from 0.
        row: usize,
        /// Its length, s.
        interval: f64,
        /// The usual length, s.
        usual: f64,
        /// How many there are.
        count: usize,
    },
    /// Times of rows that follow each other evenly, rounded.
    RoundedTimes {
        /// The unit of their last digit, s.
        unit: f64,
    },
    /// Quaternions change sign between rows.
    SignFlips {
        /// The first row behind one.
        row: usize,
        /// How many there are.
        count: usize,
    },
    /// Quaternions, or rows of matrices, whose norm is not 1.
    NotNormalized {
        /// Largest | |q| − 1 |.
        error: f64,
        /// The row, from 0.
        row: usize,
    },
    /// Quaternions whose norm is not that of the others, or matrices that are no multiple of a rotation.
    NoRotation {
        /// The row that is furthest off, from 0.
        row: usize,
        /// By how much, relative.
        error: f64,
        /// How many rows.
        count: usize,
    },
    /// A component of the angular velocity that stays the same over rows, as clamped or held rates do.
    Plateau {
        /// The first row.
        row: usize,
        /// How many rows.
        rows: usize,
    },
    /// Angular velocities of other times than the attitudes beside them.
    ShiftedRates {
        /// By how much they are later, s.
        lag: f64,
    },
    /// Angular velocities that differ from those of the attitudes beside them by one factor.
    ScaledRates {
        /// Those that are written over those of the attitudes.
        factor: f64,
    },
    /// Numbers of single precision.
    SinglePrecision,
    /// Numbers of few digits.
    FewDigits {
        /// How many.
        digits: u32,
    },
    /// Forces turn the body so far over the record that its motion is not followed.
    NotFollowed,
    /// Angular velocities alone, and no body is found that moves so.
    NoBodyFound,
    /// Rows that are further from the motion than is allowed.
    Misplaced {
        /// What they hold.
        what: Misplaced,
        /// The first of them, from 0.
        row: usize,
        /// How many there are.
        count: usize,
        /// The largest distance from the motion, rad or relative.
        largest: f64,
    },
    /// The state jumps between two rows.
    Discontinuity {
        /// The row behind the jump, from 0.
        row: usize,
        /// Its size, rad or relative.
        size: f64,
        /// How many there are.
        count: usize,
    },
}

/// What a record lacks.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum Missing {
    /// No attitude: kinematics, L in space and the attitude error are not checked.
    Attitude,
    /// No angular velocity: it is derived from the attitudes.
    Rates,
    /// No body: the moments are fitted up to their scale, so that only their ratios are checked.
    Body,
}

impl fmt::Display for Misplaced {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Misplaced::Repeated => "repeats the row before",
            Misplaced::Exchanged => "is exchanged with a neighbour",
            Misplaced::Shifted => {
                "has the state of a neighbouring row, as if time stamps were shifted by one row"
            }
            Misplaced::Interpolated => "is the mean of its neighbours, as if interpolated",
            Misplaced::Unknown => "deviates from the motion",
        })
    }
}

impl fmt::Display for Fault {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Fault::TooCoarse { angle } => {
                write!(
                    f,
                    "the body turns by {angle:.3} rad between rows; record so often that it turns by less than pi/2 between them"
                )
            }
            Fault::TooLittle { turn, open } => write!(
                f,
                "the attitudes turn by {turn:.1e} rad in all and may be off by {open:.1e} rad; record longer, with more digits or with angular velocities, or allow less by a smaller tolerance"
            ),
            Fault::TimeJump { row, interval, usual, count } => {
                write!(
                    f,
                    "row {row}: {interval} s after the row before, usually {usual} s ({count} such intervals)"
                )
            }
            Fault::RoundedTimes { unit } => {
                write!(f, "the times are rounded to {unit:.0e} s; write them with all digits")
            }
            Fault::SignFlips { row, count } => {
                write!(
                    f,
                    "row {row}: the quaternion changes sign, {count} times in all; q and -q are one attitude"
                )
            }
            Fault::NotNormalized { error, row } => {
                write!(
                    f,
                    "row {row}: the norm of the attitude is off by {error:.1e}; normalise after every step"
                )
            }
            Fault::NoRotation { row, error, count } => write!(
                f,
                "row {row}: the attitude is not a rotation, even when scaled as the other rows are: off by {error:.1e} ({count} such rows)"
            ),
            Fault::Plateau { row, rows } => write!(
                f,
                "row {row}: a component of the angular velocity stays the same over {rows} rows; are rates clamped or held?"
            ),
            Fault::NoBodyFound => f.write_str(
                "no body is found that has this angular velocity; give its moments, or record the attitude too",
            ),
            Fault::NotFollowed => f.write_str(
                "the forces turn the body too far over the record to compute its motion: are the units of times, moments and forces consistent?",
            ),
            Fault::ShiftedRates { lag } => {
                let side = if *lag < 0.0 { "earlier" } else { "later" };
                let lag = lag.abs();
                write!(
                    f,
                    "the angular velocities belong to times {lag:.2e} s {side} than the attitudes beside them, as at half a step; write both at one time"
                )
            }
            Fault::ScaledRates { factor } => write!(
                f,
                "the angular velocities are {factor:.6} times those at which the attitudes turn; is a clock, a unit or the scale of a sensor off?"
            ),
            Fault::SinglePrecision => f.write_str("all numbers are of single precision; write doubles"),
            Fault::FewDigits { digits } => {
                write!(f, "the numbers have {digits} significant digits; write 17")
            }
            Fault::Misplaced { what, row, count, largest } => {
                let rows = if *count == 1 { String::new() } else { format!(" ({count} such rows)") };
                write!(f, "row {row}: {what}{rows}; largest deviation from the motion {largest:.1e} (rad or relative)")
            }
            Fault::Discontinuity { row, size, count } => {
                write!(f, "row {row}: the state jumps by {size:.1e} ({count} such rows)")
            }
        }
    }
}

impl fmt::Display for Missing {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Missing::Attitude => {
                "no attitude: kinematics, the direction of L and the attitude error are not checked"
            }
            Missing::Rates => "no angular velocity: it is derived from the attitudes",
            Missing::Body => "no body: the moments are fitted up to their scale",
        })
    }
}

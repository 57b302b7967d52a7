//! The verdict on a record.

use core::fmt;

use super::{Noise, Reading};
use crate::body::{Body, Conserved};
use crate::observe::Drift;

/// Whether a record is right.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Judgement {
    /// Within the tolerance, or within its own digits and noise, of a motion of the body.
    Right,
    /// Further away than that.
    Wrong,
    /// The record does not tell: digits and noise grow to more than what is asked.
    Undecided,
}

/// What is wrong with a record.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub enum Suspect {
    /// Nothing, or nothing that is known.
    None,
    /// The attitude turns the wrong way: `q̇ = −½ q ω`.
    KinematicsSign,
    /// Angular velocity in body axes used as if it were in space axes, or the other way round.
    OmegaFrame,
    /// A rotation is used, or claimed, where its transpose belongs.
    Transposed,
    /// The moments belong to other axes.
    MomentsOrder,
    /// A unit of angular velocity is taken for another, such as degrees for radians.
    Degrees,
    /// Euler's equations without ω × Iω.
    GyroscopicTermMissing,
    /// A term of ω × Iω with the wrong sign.
    GyroscopicSign,
    /// An integrator, by its name in the catalogue.
    Integrator(String),
    /// The state jumps.
    Discontinuity,
}

/// A reading with what speaks for it.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct Ranked {
    /// The reading.
    pub reading: Reading,
    /// Natural logarithm of the likelihood over that of the first; 0 for the first, negative below.
    pub log_likelihood_ratio: f64,
    /// Typical distance of the rows from the motion that starts at the row before, rad.
    pub attitude_defect: Option<f64>,
    /// The same of the angular velocity, relative to its size.
    pub rate_defect: Option<f64>,
}

/// Why several readings fit a record equally well.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum TieReason {
    /// Moments of inertia agree.
    SymmetricBody,
    /// The body spins steadily about one axis.
    PureSpin,
    /// Columns that would tell are missing.
    MissingColumns,
    /// Noise or digits hide the difference.
    Noise,
}

/// Readings that the record cannot tell apart.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct Tie {
    /// All of them, the first of the ranking among them.
    pub readings: Vec<Reading>,
    /// Why.
    pub reason: TieReason,
}

/// What the record itself leaves open.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct Resolution {
    /// Noise of the attitude, rad, root mean square of a component.
    pub attitude: Option<f64>,
    /// Noise of the angular velocity, relative to its size.
    pub rates: Option<f64>,
    /// Significant decimal digits.
    pub digits: u32,
    /// Whether every number is one of single precision.
    pub single_precision: bool,
}

/// How well a quantity is kept.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct Conservation {
    /// Which.
    pub quantity: Conserved,
    /// Largest relative change from the first row; of the energy of a heavy body relative to T(0) + |c|.
    pub error: f64,
    /// Secular slope per second with its 95 % interval; `None` for fewer than 16 rows.
    pub drift: Option<Drift>,
    /// What noise and digits explain of the error.
    pub resolution: f64,
    /// Whether it is kept within the tolerance or the resolution.
    pub conserved: bool,
}

/// Distance of the attitude from the motion that starts like the record.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct AttitudeError {
    /// Largest angle, rad.
    pub largest: f64,
    /// When, s.
    pub at: f64,
    /// The part along the motion, as if the clock were wrong, at the end, rad.
    pub phase: f64,
    /// The part across, at the end, rad.
    pub drift: f64,
    /// Whether the start is the one, within noise and digits, that fits the record best; else it is the first row.
    pub fitted_start: bool,
    /// Largest angle from the motion that starts at the first row, rad.
    pub from_first_row: f64,
}

/// An integrator that leaves the errors of the record.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct Signature {
    /// Its name in the catalogue.
    pub method: String,
    /// Its step, s.
    pub step: f64,
    /// Steps between rows.
    pub steps_per_row: u64,
    /// Its order, where it has one.
    pub order: Option<u32>,
    /// Attitude error that it predicts at `at`, rad.
    pub predicted_attitude_error: f64,
    /// Attitude error that the record has there, rad.
    pub measured_attitude_error: f64,
    /// Relative change of the energy that it predicts there; `None` where the energy is not kept by the motion.
    pub predicted_energy_change: Option<f64>,
    /// That of the record.
    pub measured_energy_change: Option<f64>,
    /// The time of the comparison, s.
    pub at: f64,
    /// Distance of the record from this hypothesis over its distance from the exact motion.
    pub mismatch: f64,
}

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
    /// Numbers of single precision.
    SinglePrecision,
    /// Numbers of few digits.
    FewDigits {
        /// How many.
        digits: u32,
    },
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

/// Errors at rows of the record, for figures; at most some 2000 rows.
#[derive(Clone, Debug, Default, PartialEq)]
#[non_exhaustive]
pub struct Traces {
    /// Times, s.
    pub times: Vec<f64>,
    /// Relative change of the energy, signed.
    pub energy: Vec<f64>,
    /// Relative change of |m|, signed.
    pub momentum_norm: Vec<f64>,
    /// Angle between L in space and that of the first row, rad, signed by its component across; empty without attitude.
    pub momentum_direction: Vec<f64>,
    /// Attitude error, rad, signed by its part along the motion; empty without attitude.
    pub attitude: Vec<f64>,
}

/// The verdict on a record.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct Verdict {
    /// Right or not.
    pub judgement: Judgement,
    /// What is wrong.
    pub suspect: Suspect,
    /// The reading that fits best.
    pub reading: Reading,
    /// The readings that were weighed, best first.
    pub ranking: Vec<Ranked>,
    /// Readings that the record cannot tell apart.
    pub tie: Option<Tie>,
    /// The body of the verdict: that of the question with its moments in the order of the reading, or the fitted one.
    pub body: Body,
    /// What noise and digits leave open.
    pub resolution: Resolution,
    /// The noise within which an undecided record agrees with the motion, where it is noise that leaves it open; it was not
    /// declared, or declared smaller.
    pub noise: Option<Noise>,
    /// What the motion keeps, and how well the record does.
    pub conservation: Vec<Conservation>,
    /// Distance from the exact motion; `None` without attitude.
    pub attitude_error: Option<AttitudeError>,
    /// Changes of sign of the momentum along the middle axis; `None` of forced bodies.
    pub flips: Option<u64>,
    /// The same of the exact motion.
    pub flips_exact: Option<u64>,
    /// The integrator that leaves such errors.
    pub signature: Option<Signature>,
    /// What is odd about sampling and writing.
    pub faults: Vec<Fault>,
    /// What the record lacks.
    pub missing: Vec<Missing>,
    /// Errors at rows, for figures.
    pub traces: Traces,
}

impl fmt::Display for Judgement {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Judgement::Right => "right",
            Judgement::Wrong => "wrong",
            Judgement::Undecided => "undecided",
        })
    }
}

impl fmt::Display for Suspect {
    /// `none`, `kinematics-sign`, `omega-frame`, `transposed`, `moments-order`, `degrees`, `gyroscopic-term-missing`,
    /// `gyroscopic-sign`, `integrator:NAME` or `discontinuity`.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Suspect::None => "none",
            Suspect::KinematicsSign => "kinematics-sign",
            Suspect::OmegaFrame => "omega-frame",
            Suspect::Transposed => "transposed",
            Suspect::MomentsOrder => "moments-order",
            Suspect::Degrees => "degrees",
            Suspect::GyroscopicTermMissing => "gyroscopic-term-missing",
            Suspect::GyroscopicSign => "gyroscopic-sign",
            Suspect::Integrator(name) => return write!(f, "integrator:{name}"),
            Suspect::Discontinuity => "discontinuity",
        })
    }
}

impl fmt::Display for Misplaced {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Misplaced::Repeated => "repeats the row before",
            Misplaced::Exchanged => "is exchanged with a neighbour",
            Misplaced::Shifted => "holds the state of a neighbour, as time stamps that are off by one row do",
            Misplaced::Interpolated => "is the mean of its neighbours, as interpolated frames are",
            Misplaced::Unknown => "is not where the motion is",
        })
    }
}

impl fmt::Display for TieReason {
    /// The reason, and what to record to tell.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            TieReason::SymmetricBody => {
                "moments of inertia agree; record a body with three different moments to tell"
            }
            TieReason::PureSpin => {
                "the body spins about one axis; record a motion that tumbles, from a tilted attitude, to tell"
            }
            TieReason::MissingColumns => "the columns allow them all; record attitude and angular velocity to tell",
            TieReason::Noise => {
                "noise or digits hide the difference; record more rows, more digits or a faster motion to tell"
            }
        })
    }
}

impl fmt::Display for Fault {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Fault::TooCoarse { angle } => {
                write!(
                    f,
                    "the body turns by {angle:.3} rad between rows; sample at least twice as often as it turns by half"
                )
            }
            Fault::TimeJump { row, interval, usual, count } => {
                write!(
                    f,
                    "row {row}: {interval} s after the row before, usually {usual} s ({count} such intervals)"
                )
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
                "row {row}: what is written is no rotation of the size that the others have, off by {error:.1e} ({count} such rows)"
            ),
            Fault::Plateau { row, rows } => write!(
                f,
                "row {row}: a component of the angular velocity stays the same over {rows} rows; are rates clamped or held?"
            ),
            Fault::SinglePrecision => f.write_str("every number is one of single precision; write doubles"),
            Fault::FewDigits { digits } => {
                write!(f, "the numbers have {digits} significant digits; write 17")
            }
            Fault::Misplaced { what, row, count, largest } => {
                let rows = if *count == 1 { String::new() } else { format!(" ({count} such rows)") };
                write!(f, "row {row}: {what}{rows}; up to {largest:.1e} rad or relative from the motion")
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

//! The verdict on a record.

use core::fmt;

use super::{Fault, Frame, Missing, Noise, Reading};
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

impl Judgement {
    /// Right before undecided, undecided before wrong.
    pub(super) fn is_better_than(self, other: Judgement) -> bool {
        let rank = |judgement| match judgement {
            Judgement::Right => 0,
            Judgement::Undecided => 1,
            Judgement::Wrong => 2,
        };
        rank(self) < rank(other)
    }
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
    /// Euler angles turn about other axes than the names of their columns say.
    AnglesOrder,
    /// Euler's equations without ω × Iω.
    GyroscopicTermMissing,
    /// A term of ω × Iω with the wrong sign.
    GyroscopicSign,
    /// An integrator, by its name in the catalogue.
    Integrator(String),
    /// The state jumps.
    Discontinuity,
    /// The motion of a body with other moments.
    OtherBody,
    /// L changes as another torque would change it.
    OtherTorque,
    /// A wheel has another speed, or is held in place of free.
    OtherWheel,
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
    /// The record is wrong in each of them.
    Misfit,
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
    /// Its name, as [`method()`](crate::method()) takes it.
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

/// The body that moves as the record does, where it is not the given one.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct OtherBody {
    /// Its moments about the axes of the given body, else its principal moments in ascending order; of the same trace as the
    /// given ones, as free motion tells no scale.
    pub moments: [f64; 3],
    /// Whether they are principal moments, as its axes are turned from the given ones.
    pub principal: bool,
}

/// The torque that changes L beside those that act on the given body, in the unit of its moments times rad/s².
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct OtherTorque {
    /// Root mean square over the record.
    pub size: f64,
    /// How many times the torques that are told act, where that explains it: −1 of a wrong sign, 0 of torques that do not act.
    pub factor: Option<f64>,
    /// Its components, where it is constant in the axes of space or of the body.
    pub constant: Option<(Frame, [f64; 3])>,
}

/// The wheel that is not as it was told, of those of [`Question::wheels`](super::Question::wheels).
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct OtherWheel {
    /// Its number, from 1, in the order in which they were told.
    pub number: usize,
    /// The speed that it has at the first row, rad/s.
    pub speed: f64,
    /// Whether it is held at it.
    pub is_held: bool,
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
    /// declared, or declared smaller. 0 of what the record does not hold.
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
    /// The body that moves so, where it is another than the given one.
    pub other_body: Option<OtherBody>,
    /// The torque that acts beside those that are told.
    pub other_torque: Option<OtherTorque>,
    /// The wheel that has another speed or is of another kind than was told, where that explains the record.
    pub other_wheel: Option<OtherWheel>,
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
    /// `none`, `kinematics-sign`, `omega-frame`, `transposed`, `moments-order`, `degrees`, `angles-order`,
    /// `gyroscopic-term-missing`, `gyroscopic-sign`, `integrator:NAME`, `discontinuity`, `other-body`, `other-torque` or `other-wheel`.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Suspect::None => "none",
            Suspect::KinematicsSign => "kinematics-sign",
            Suspect::OmegaFrame => "omega-frame",
            Suspect::Transposed => "transposed",
            Suspect::MomentsOrder => "moments-order",
            Suspect::Degrees => "degrees",
            Suspect::AnglesOrder => "angles-order",
            Suspect::GyroscopicTermMissing => "gyroscopic-term-missing",
            Suspect::GyroscopicSign => "gyroscopic-sign",
            Suspect::Integrator(name) => return write!(f, "integrator:{name}"),
            Suspect::Discontinuity => "discontinuity",
            Suspect::OtherBody => "other-body",
            Suspect::OtherTorque => "other-torque",
            Suspect::OtherWheel => "other-wheel",
        })
    }
}

impl fmt::Display for TieReason {
    /// The reason, and what to record to tell.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            TieReason::SymmetricBody => {
                "the body has equal moments of inertia; record one with three different moments to tell them apart"
            }
            TieReason::PureSpin => {
                "the body spins about a fixed axis; record a tumbling motion from a tilted attitude to tell them apart"
            }
            TieReason::MissingColumns => "the columns cannot tell them apart; record both attitude and angular velocity",
            TieReason::Noise => {
                "noise or missing digits hide the difference; record more rows, more digits or a faster motion"
            }
            TieReason::Misfit => "the rows do not obey the equations of motion in any of them, and the errors are about equal",
        })
    }
}

impl fmt::Display for OtherBody {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let [a, b, c] = self.moments;
        let which = if self.principal { "principal moments" } else { "moments" };
        write!(
            f,
            "The motion is that of another body: {which} {a:.6} : {b:.6} : {c:.6}, scaled to the trace of those given."
        )
    }
}

impl fmt::Display for OtherWheel {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let OtherWheel { number, speed, is_held } = self;
        let kind = if *is_held { "held" } else { "not held" };
        write!(
            f,
            "The motion is that of a body on which wheel {number} is {kind} and has a speed of {speed:.6} rad/s at the first row."
        )
    }
}

impl fmt::Display for OtherTorque {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let size = self.size;
        match (self.factor, self.constant) {
            (Some(factor), _) if factor.abs() < 0.05 => write!(
                f,
                "The given torque does not act: L changes as if it were 0 (root mean square of the missing torque {size:.1e})."
            ),
            (Some(factor), _) => {
                let sign = if factor < 0.0 { ", with the wrong sign" } else { "" };
                write!(f, "The torque that acts is {factor:.2} times the given one{sign}.")
            }
            (None, Some((frame, [x, y, z]))) => write!(
                f,
                "A torque that was not given acts: about {size:.1e}, constant in {frame} axes: {x:.2e}, {y:.2e}, {z:.2e}, in the unit of the moments times rad/s\u{b2}."
            ),
            (None, None) => write!(
                f,
                "A torque that was not given acts: about {size:.1e} (root mean square, in the unit of the moments times rad/s\u{b2})."
            ),
        }
    }
}

//! Is this rotation right, in which convention, and how large is its error?
//!
//! A [`Trajectory`] from elsewhere, in any convention, is read in every [`Reading`] that its columns allow. The reading in which the
//! rows obey the equations of motion is the convention of the record. Then remain the errors of the program that wrote it: which
//! quantities it keeps, how far its attitudes are from the exact motion, and which integrator or mistake leaves such errors.

mod as_written;
mod bodies;
mod candidates;
mod canonical;
mod columns;
mod conservation;
mod detective;
mod deviation;
mod error;
mod exchanged;
mod fault;
mod faults;
mod judge;
mod lag;
mod misplaced;
mod motion;
mod other_body;
mod other_torque;
mod other_wheel;
mod program;
mod question;
mod reading;
mod resolution;
mod rows;
mod shape;
mod signature;
mod start;
mod states;
mod step_length;
mod sweep;
mod trajectory;
mod verdict;

pub use crate::units::{AngleUnit, RateUnit};
pub use error::AuditError;
pub use fault::{Fault, Misplaced, Missing};
pub use question::{Convention, Noise, Question};
pub use reading::{Angles, Direction, Frame, Product, QuaternionOrder, Reading, Turns};
pub use step_length::step_length;
pub use trajectory::{Attitudes, Digits, FEWEST_ROWS, Trajectory};
pub use verdict::{
    AttitudeError, Conservation, Judgement, OtherBody, OtherTorque, OtherWheel, Ranked, Resolution,
    Signature, Suspect, Tie, TieReason, Traces, Verdict,
};

/// The verdict on `record`.
///
/// # Errors
/// Too few rows, times that do not ascend, numbers that are not finite, columns of different lengths, noise that is declared of
/// what the record does not hold, or a body that is needed and not given.
///
/// ```
/// use nalgebra::{UnitQuaternion, Vector3};
/// use polhode::audit::{Attitudes, Direction, Judgement, Question, Trajectory, audit};
/// use polhode::{Body, FreeMotion, Inertia};
///
/// let inertia = Inertia::from_moments([1.0, 2.0, 3.0])?;
/// let motion = FreeMotion::from_omega(&inertia, UnitQuaternion::identity(), Vector3::new(0.4, 1.0, -0.3))?;
/// let times: Vec<f64> = (0..400).map(|k| 0.05 * f64::from(k)).collect();
/// let body = Body::free(inertia);
/// let states = motion.at_many(&times)?;
/// // written by somebody who keeps the inverse attitude
/// let inverses = states.iter().map(|x| x.attitude.conjugate().components()).collect();
/// let rates = states.iter().map(|x| body.omega_body(x).into()).collect();
/// let record = Trajectory::new(times).with_attitude(Attitudes::Quaternions(inverses)).with_rates(rates);
/// let verdict = audit(&record, &Question::new(Some(body)))?;
/// assert_eq!(verdict.judgement, Judgement::Right);
/// assert_eq!(verdict.reading.attitude, Some(Direction::SpaceToBody));
/// # Ok::<(), polhode::Error>(())
/// ```
pub fn audit(record: &Trajectory, question: &Question) -> Result<Verdict, AuditError> {
    record.check()?;
    question.check(record)?;
    let verdict = judged(record, question)?;
    let is_open = question.claims.angles.is_none() && question.claims.angle_unit.is_none();
    let Some(angles) = verdict.reading.angles.filter(|_| is_open && verdict.judgement != Judgement::Right)
    else {
        return Ok(verdict);
    };
    // the angles of a body that spins about one axis fit better, but for their beginnings, in the unit in which it turns by less
    let mut in_other_unit = question.clone();
    in_other_unit.claims.angle_unit = Some(match angles.unit {
        AngleUnit::Radians => AngleUnit::Degrees,
        AngleUnit::Degrees => AngleUnit::Radians,
    });
    match judged(record, &in_other_unit) {
        Ok(other) if other.judgement == Judgement::Right => Ok(other),
        _ => Ok(verdict),
    }
}

fn judged(record: &Trajectory, question: &Question) -> Result<Verdict, AuditError> {
    let finding = detective::investigate(record, question)?;
    judge::judge(record, question, finding)
}

//! Which method, with which step: from short runs of every candidate on the body itself.
//!
//! The reference is the closed form. If there is none, it is two runs of different methods over the whole time, as far as they agree to a
//! tenth of the demand: in `f64`, with steps that follow the rate of turning, or in double-double where the digits of `f64` do not suffice.
//! Each candidate, a method of the catalogue or one with another order or scheme, runs over the short part in which the body turns fastest.
//! Its steps are halved until its error shows the step that the demand needs. The quickest candidates then run over the whole time with the
//! advised step. Runs of more than a few seconds are extrapolated, but only for bodies with a closed form, whose errors grow no faster than the
//! time. Processor times are measured in the same runs.
//!
//! A torque that acts for less than about a fiftieth of a radian of the turn may go unseen.

mod calibration;
mod candidate;
mod check;
mod choice;
mod error;
mod progress;
mod reference;
mod trial;

pub use check::{check, check_telling};
pub use choice::{Advice, Choice, Predicted, Setting};
pub use error::AdviseError;
pub use progress::{Progress, Stage};

use std::time::Instant;

use crate::body::{Body, Conserved, State};
use calibration::Calibration;
use reference::Reference;

/// What a motion is wanted for.
///
/// ```
/// use polhode::advise::Demand;
/// let demand = Demand::new(1e5, 1e-6);
/// assert_eq!((demand.until, demand.attitude_error, demand.energy_error), (1e5, 1e-6, None));
/// ```
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct Demand {
    /// Duration of the motion, s.
    pub until: f64,
    /// The largest attitude error that is allowed up to then, rad.
    pub attitude_error: f64,
    /// The largest relative energy error, where one is asked for.
    pub energy_error: Option<f64>,
    /// The largest processor time, s, where there is a limit.
    pub budget: Option<f64>,
    /// Names or bases of methods that are not wanted; `exact` stands for the closed form and the methods that step along it.
    pub excluded: Vec<String>,
    /// Time of the start, s, for forces that depend on time.
    pub start_time: f64,
}

impl Demand {
    /// An attitude error of at most `attitude_error` rad up to the time `until`, s; the other fields may be set.
    #[must_use]
    pub fn new(until: f64, attitude_error: f64) -> Self {
        Demand {
            until,
            attitude_error,
            energy_error: None,
            budget: None,
            excluded: Vec::new(),
            start_time: 0.0,
        }
    }

    fn check(&self) -> Result<(), AdviseError> {
        let positive = [
            ("the duration", "s", Some(self.until)),
            ("the attitude error", "rad", Some(self.attitude_error)),
            ("the energy error", "", self.energy_error),
            ("the budget", "s", self.budget),
        ];
        for (quantity, unit, value) in positive {
            if let Some(value) = value.filter(|value| !(value.is_finite() && *value > 0.0)) {
                return Err(AdviseError::NotPositive { quantity, unit, value });
            }
        }
        if self.attitude_error > 1.0 {
            return Err(AdviseError::Lost { attitude_error: self.attitude_error });
        }
        if let Some(demand) = self.energy_error.filter(|most| *most < f64::EPSILON) {
            return Err(AdviseError::EnergyBelowRounding { demand });
        }
        if !self.start_time.is_finite() {
            return Err(AdviseError::NotPositive {
                quantity: "the start time",
                unit: "s",
                value: self.start_time,
            });
        }
        Ok(())
    }
}

/// The quickest method that meets `demand` for `body` from `start`, its step or tolerance, what it will do, and why the others
/// were not taken.
///
/// The error constants are those of this body, start and time; nothing is looked up. The answer depends on processor times that
/// are measured: where two methods are equally quick it may differ from call to call.
///
/// # Errors
/// A demand that is not positive, or below what the digits of the start allow; an energy error where energy is not conserved; a body
/// at rest; forces whose motion has no reference; a demand that no candidate meets, or none within the budget: with the nearest.
///
/// ```
/// use nalgebra::{UnitQuaternion, Vector3};
/// use polhode::advise::{Demand, Setting, advise};
/// use polhode::{Body, FreeMotion, Inertia, Run, method};
///
/// let body = Body::free(Inertia::from_moments([1.0, 2.0, 3.0])?);
/// let start = body.state(UnitQuaternion::identity(), Vector3::new(0.4, 1.0, -0.3))?;
/// let mut demand = Demand::new(1000.0, 1e-6);
/// demand.excluded = vec!["exact".into(), "taylor".into(), "dop853".into(), "tsit5".into()]; // of fixed steps only
/// let advice = advise(&body, &start, &demand)?;
/// let Setting::Step(h) = advice.best.setting else { unreachable!("the others are excluded") };
/// let steps = advice.best.steps.unwrap_or(0);
/// let end = Run::new(&method(&advice.best.method)?, &body, &start, h)?.advance_to(steps)?;
/// let exact = FreeMotion::from_state(body.inertia(), &start)?.at(1000.0)?;
/// assert!(end.state.rotation().angle_to(&exact.rotation()) < 1e-6);
/// # Ok::<(), polhode::Error>(())
/// ```
pub fn advise(body: &Body, start: &State, demand: &Demand) -> Result<Advice, AdviseError> {
    advise_telling(body, start, demand, &mut |_| {})
}

/// As [`advise`]; `heed` is told from time to time how far it has come, some ten times a second or more often.
///
/// # Errors
/// As [`advise`].
///
/// ```
/// use polhode::advise::{Demand, advise_telling};
/// use polhode::{Body, Inertia};
/// let body = Body::heavy(Inertia::from_moments([0.5, 0.85, 1.0])?, [0.0, 0.0, 1.0].into())?;
/// let start = body.state(Default::default(), [0.4, 1.2, 0.4].into())?;
/// let mut stages = Vec::new();
/// advise_telling(&body, &start, &Demand::new(10.0, 1e-6), &mut |progress| stages.push(progress.stage.clone()))?;
/// assert!(stages.iter().any(|stage| stage.to_string() == "following the motion by two methods"));
/// # Ok::<(), polhode::Error>(())
/// ```
pub fn advise_telling(
    body: &Body,
    start: &State,
    demand: &Demand,
    heed: &mut dyn FnMut(&Progress),
) -> Result<Advice, AdviseError> {
    let begun = Instant::now();
    demand.check()?;
    if demand.energy_error.is_some() && !body.conserved().contains(&Conserved::Energy) {
        return Err(AdviseError::NotConserved);
    }
    let start = body.enter(start)?.to_f64();
    let mut follow = |done| heed(&Progress::new(&Stage::Motion, done, None));
    let reference = Reference::new(body, start, demand, &mut follow)?;
    Calibration::new(body, demand, reference, (begun, heed))?.advice()
}

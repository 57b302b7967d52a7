//! What a choice really does.

use super::progress::Stage;
use super::reference::{PATIENCE_OF_CHECKS, truth};
use super::{AdviseError, Choice, Demand, Progress, Setting};
use crate::body::{Body, Clock, State};
use crate::method::method;
use crate::num::Dd;
use crate::rotation::rotation_angle;
use crate::run::{Run, Watch};
use crate::truth::evenly;

/// Looks at the motion: not those of the runs behind the advice.
const LOOKS: u64 = 97;

/// Runs `choice` over the whole time of `demand` and compares it with the [true motion](crate::truth): the largest attitude error that was seen, rad.
///
/// # Errors
/// A demand or a start as in [`advise`](super::advise), a method that does not exist or whose run fails, or a motion that is not
/// known to the end.
///
/// ```
/// use polhode::advise::{Demand, advise, check};
/// use polhode::{Body, Inertia};
/// let body = Body::free(Inertia::from_moments([1.0, 2.0, 3.0])?);
/// let start = body.state(Default::default(), [0.4, 1.0, -0.3].into())?;
/// let mut demand = Demand::new(100.0, 1e-8);
/// demand.excluded = vec!["exact".into()];
/// let advice = advise(&body, &start, &demand)?;
/// assert!(check(&body, &start, &demand, &advice.best)? < 1e-8);
/// # Ok::<(), polhode::Error>(())
/// ```
pub fn check(body: &Body, start: &State, demand: &Demand, choice: &Choice) -> Result<f64, AdviseError> {
    check_telling(body, start, demand, choice, &mut |_| {})
}

/// As [`check`]; `heed` is told from time to time how far it has come, and how long the run of the choice takes.
///
/// # Errors
/// As [`check`].
pub fn check_telling(
    body: &Body,
    start: &State,
    demand: &Demand,
    choice: &Choice,
    heed: &mut dyn FnMut(&Progress),
) -> Result<f64, AdviseError> {
    demand.check()?;
    let start = body.enter(start)?.to_f64();
    let times = evenly(demand.until, LOOKS as u32);
    let stage = Stage::Check(choice.method.clone());
    let mut follow = |done| heed(&Progress::new(&Stage::Motion, done, None));
    let truth = truth(body, start, demand, (&times, PATIENCE_OF_CHECKS), &mut follow)?;
    let (step, steps) = match choice.setting {
        Setting::Step(h) => (h, choice.steps.unwrap_or(1)),
        _ => (demand.until / LOOKS as f64, LOOKS),
    };
    let clock = Clock { start: demand.start_time, step };
    let mut worst = 0.0_f64;
    if choice.setting == Setting::Nothing {
        let Some(motion) = truth.closed_form() else { return Err(AdviseError::NoReference) };
        for k in 1..=LOOKS {
            let t = clock.elapsed(k).hi();
            let (Ok(state), exact) = (motion.at(t), motion.point_at_dd(Dd::from(t))) else { continue };
            worst = worst.max(rotation_angle(state.attitude, body.leave(&exact).attitude));
        }
        return Ok(worst);
    }
    let unusable = |why: String| AdviseError::Unusable { method: choice.method.clone(), why };
    let mut method = method(&choice.method).map_err(|error| unusable(error.to_string()))?;
    if let Setting::Tolerance { tolerance, .. } = choice.setting {
        method = method.with_tolerance(tolerance).map_err(|error| unusable(error.to_string()))?;
    }
    let run = Run::from_point(&method, body, start, clock).map_err(|error| unusable(error.to_string()))?;
    let mut run = run.watching(Watch::Never);
    for k in 1..=LOOKS {
        let sample = run.advance_to(steps * k / LOOKS)?;
        worst = worst.max(truth.attitude_error(&sample.point.to_dd(), sample.elapsed)?);
        heed(&Progress::new(&stage, k as f64 / LOOKS as f64, Some(choice.seconds.value)));
    }
    Ok(worst)
}

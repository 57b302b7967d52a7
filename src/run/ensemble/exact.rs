//! Rows of exact motion.

use core::ops::Range;

use super::rows::Reading;
use super::{Ensemble, MemberError, Rows};
use crate::body::{Body, Clock, Phase, Point};
use crate::flow::{ExactMotion, NoClosedForm, TimeError};
use crate::num::Dd;
use crate::observe::Monitor;

/// Of the members `part` at `times`, which are finite.
pub(super) fn rows(ensemble: &Ensemble, part: Range<usize>, times: &[f64]) -> Rows {
    let mut rows = Rows::new(part.start, part.len(), times.len(), ensemble.observed);
    for (n, k) in part.enumerate() {
        let follow = ensemble.member(k).and_then(|(body, start)| {
            let motion = ExactMotion::from_point(&body, start).map_err(reason)?;
            Ok((body, start, motion))
        });
        match follow {
            Ok((body, start, motion)) => {
                if let Err((time, error)) = fill(ensemble, n, &body, start, &motion, times, &mut rows) {
                    rows.fail(n, time, error);
                }
            }
            Err(error) => rows.fail(n, 0, error),
        }
    }
    rows
}

fn reason(error: NoClosedForm) -> MemberError {
    match error {
        NoClosedForm::State(error) => error.into(),
        error => error.into(),
    }
}

/// Writes the rows of the member `n` of the part, up to the first time that has none.
fn fill(
    ensemble: &Ensemble,
    n: usize,
    body: &Body,
    start: Point<Dd>,
    motion: &ExactMotion,
    times: &[f64],
    rows: &mut Rows,
) -> Result<(), (usize, MemberError)> {
    let monitor = ensemble.observed.invariants.then(|| Monitor::new(body, Clock::new(1.0), &start.to_f64()));
    let reading = Reading::of(body);
    let refused = times.iter().enumerate().find_map(|(time, &t)| Some((time, motion.check_time(t).err()?)));
    let times = &times[..refused.map_or(times.len(), |(time, _)| time)];
    let mut first_infinite = None;
    let mut see = |time: usize, x: Phase<f64>| {
        if !rows.set(n, time, &reading, x) {
            first_infinite = first_infinite.or(Some(time));
        } else if let Some(monitor) = &monitor {
            rows.set_errors(n, time, monitor.errors(&Point::new(x.attitude, x.momentum_body)));
        }
        if ensemble.observed.attitude {
            rows.set_attitude_error(n, time, 0.0);
        }
    };
    match motion {
        ExactMotion::Free(motion) => motion.phases_at(times, ensemble.instructions, see),
        other => {
            times.iter().enumerate().for_each(|(time, &t)| see(time, other.point_at(Dd::from(t)).phase()))
        }
    }
    match (first_infinite, refused) {
        (Some(time), _) => {
            Err((time, TimeError::OutOfReach { t: times[time], reach: motion.reach() }.into()))
        }
        (None, Some((time, error))) => Err((time, error.into())),
        (None, None) => Ok(()),
    }
}

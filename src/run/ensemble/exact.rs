//! Rows of exact motion.

use core::ops::Range;

use super::{Ensemble, MemberError, Rows};
use crate::body::{Body, Clock, Point};
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
    for (time, &t) in times.iter().enumerate() {
        motion.check_time(t).map_err(|error| (time, error.into()))?;
        let x = motion.point_at(Dd::from(t));
        if !rows.set(n, time, body, &x) {
            return Err((time, TimeError::OutOfReach { t, reach: motion.reach() }.into()));
        }
        if let Some(monitor) = &monitor {
            rows.set_errors(n, time, monitor.errors(&x));
        }
        if ensemble.observed.attitude {
            rows.set_attitude_error(n, time, 0.0);
        }
    }
    Ok(())
}

//! Rows of motion step by step.

use core::ops::Range;

use super::{Ensemble, MemberError, Rows};
use crate::body::{Body, Clock, Point};
use crate::flow::ExactMotion;
use crate::method::AnyMethod;
use crate::num::{Dd, Precise};
use crate::rotation::rotation_angle;
use crate::run::{Run, Watch};

/// Of the members `part` after the numbers of `steps`, ascending.
pub(super) fn rows(
    ensemble: &Ensemble,
    part: Range<usize>,
    method: &dyn AnyMethod,
    clock: Clock,
    steps: &[u64],
) -> Rows {
    let mut rows = Rows::new(part.start, part.len(), steps.len(), ensemble.observed);
    for (n, k) in part.enumerate() {
        match ensemble.member(k) {
            Ok((body, start)) => {
                if let Err((time, error)) = alone(ensemble, n, &body, start, method, clock, steps, &mut rows)
                {
                    rows.fail(n, time, error);
                }
            }
            Err(error) => rows.fail(n, 0, error),
        }
    }
    rows.sorted()
}

/// Runs the member `n` of the part by itself.
#[expect(clippy::too_many_arguments, reason = "a member, its run and where its rows go")]
fn alone(
    ensemble: &Ensemble,
    n: usize,
    body: &Body,
    start: Point<Dd>,
    method: &dyn AnyMethod,
    clock: Clock,
    steps: &[u64],
    rows: &mut Rows,
) -> Result<(), (usize, MemberError)> {
    let run = Run::from_point(method, body, start.to_f64(), clock).map_err(|error| (0, error.into()))?;
    let mut run = run.watching(Watch::Never);
    let exact = ensemble.observed.attitude.then(|| ExactMotion::from_point(body, start).ok()).flatten();
    for (time, &steps) in steps.iter().enumerate() {
        let sample = run.advance_to(steps).map_err(|error| (time, error.into()))?;
        rows.set(n, time, body, &sample.point);
        if ensemble.observed.invariants {
            rows.set_errors(n, time, sample.errors);
        }
        if let Some(exact) = &exact
            && exact.check_time(sample.elapsed.to_f64()).is_ok()
        {
            let angle = rotation_angle(exact.point_at(sample.elapsed).attitude, sample.point.attitude);
            rows.set_attitude_error(n, time, angle);
        }
    }
    Ok(())
}

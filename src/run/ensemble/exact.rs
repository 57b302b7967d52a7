//! Rows of exact motion.

use core::ops::Range;

use super::rows::Reading;
use super::{Ensemble, Rows};
use crate::body::{Body, Clock, Phase, Point};
use crate::flow::{ExactMotion, NoClosedForm, TimeError};
use crate::num::{Dd, Instructions, LANES};
use crate::observe::Monitor;

/// Members that are followed together through a block of times, so that neighbours in the rows are written while they are in
/// the first cache.
const TOGETHER: usize = 8;

/// Members that are prepared together: several times as many as are worked out side by side, of which each takes one form.
const PREPARED: usize = 64;

/// Of the members `part` at `times`, which are finite.
pub(super) fn rows(ensemble: &Ensemble, part: Range<usize>, times: &[f64]) -> Rows {
    let mut rows = Rows::new(part.start, part.len(), times.len(), ensemble.observed);
    let first = part.start;
    for group in part.clone().step_by(PREPARED) {
        let mut prepared = prepared(ensemble, group..part.end.min(group + PREPARED), first, times, &mut rows);
        for followed in prepared.chunks_mut(TOGETHER) {
            for (block, times) in times.chunks(LANES).enumerate() {
                for member in &mut *followed {
                    member.fill(ensemble, block * LANES, times, &mut rows);
                }
            }
        }
        for member in prepared {
            if let Some((time, error)) = member.failure {
                rows.fail(member.number, time, error.into());
            }
        }
    }
    rows.sorted()
}

/// The members `group` of a part that begins with `first`; those that cannot start fail.
fn prepared(
    ensemble: &Ensemble,
    group: Range<usize>,
    first: usize,
    times: &[f64],
    rows: &mut Rows,
) -> Vec<Followed> {
    let (mut numbers, mut starts) = (Vec::with_capacity(PREPARED), Vec::with_capacity(PREPARED));
    for k in group {
        match ensemble.member(k, 0.0) {
            Ok(start) => {
                numbers.push(k - first);
                starts.push(start);
            }
            Err(error) => rows.fail(k - first, 0, error),
        }
    }
    let mut followed = Vec::with_capacity(PREPARED);
    let prepared = numbers.into_iter().zip(&starts).zip(motions(ensemble, &starts));
    for ((number, (body, start)), motion) in prepared {
        match motion {
            Ok(motion) => followed.push(Followed::new(ensemble, body, start, number, motion, times)),
            Err(NoClosedForm::State(error)) => rows.fail(number, 0, error.into()),
            Err(error) => rows.fail(number, 0, error.into()),
        }
    }
    followed
}

/// The motions from `starts`: side by side by the widest instructions, one by one by narrower ones.
pub(super) fn motions(
    ensemble: &Ensemble,
    starts: &[(Body, Point<Dd>)],
) -> impl Iterator<Item = Result<ExactMotion, NoClosedForm>> {
    let together = if ensemble.instructions == Instructions::Widest { PREPARED } else { 1 };
    starts.chunks(together).flat_map(ExactMotion::from_points)
}

/// A member on its way through the times.
struct Followed {
    /// Among the members of the part.
    number: usize,
    motion: ExactMotion,
    reading: Reading,
    monitor: Option<Box<Monitor>>,
    /// The first time without a state.
    failure: Option<(usize, TimeError)>,
}

impl Followed {
    fn new(
        ensemble: &Ensemble,
        body: &Body,
        start: &Point<Dd>,
        number: usize,
        motion: ExactMotion,
        times: &[f64],
    ) -> Self {
        let observed = ensemble.observed.invariants;
        let monitor = observed.then(|| Box::new(Monitor::new(body, Clock::new(1.0), &start.to_f64())));
        let failure = times.iter().enumerate().find_map(|(n, &t)| Some((n, motion.check_time(t).err()?)));
        Followed { number, motion, reading: Reading::of(body), monitor, failure }
    }

    /// Writes the rows at `times`, before which there are `before`.
    fn fill(&mut self, ensemble: &Ensemble, before: usize, times: &[f64], rows: &mut Rows) {
        let Followed { number, motion, reading, monitor, failure } = self;
        let last = failure.as_ref().map_or(times.len(), |(time, _)| time.saturating_sub(before));
        let times = &times[..last.min(times.len())];
        let mut writer = Writer { number: *number, before, reading, monitor, infinite: None, rows };
        match &*motion {
            ExactMotion::Free(motion) => {
                motion.phases_at(times, ensemble.instructions, |n, x| writer.write(n, x, ensemble));
            }
            other => {
                for (n, &t) in times.iter().enumerate() {
                    writer.write(n, other.point_at(Dd::from(t)).phase(), ensemble);
                }
            }
        }
        let infinite = writer.infinite;
        if let Some(n) = infinite {
            *failure = Some((before + n, TimeError::OutOfReach { t: times[n], reach: motion.reach() }));
        }
    }
}

/// What writes rows of one member, of which there are `before` already.
struct Writer<'a> {
    number: usize,
    before: usize,
    reading: &'a Reading,
    monitor: &'a Option<Box<Monitor>>,
    /// The first row that is not finite.
    infinite: Option<usize>,
    rows: &'a mut Rows,
}

impl Writer<'_> {
    #[inline(always)]
    fn write(&mut self, n: usize, x: Phase<f64>, ensemble: &Ensemble) {
        let (number, time) = (self.number, self.before + n);
        if !self.rows.set(number, time, self.reading, x) {
            self.infinite = self.infinite.or(Some(n));
            return;
        }
        if let Some(monitor) = self.monitor {
            let errors = monitor.errors(&Point::new(x.attitude, x.momentum_body));
            self.rows.set_errors(number, time, errors);
        }
        if ensemble.observed.attitude {
            self.rows.set_attitude_error(number, time, 0.0);
        }
    }
}

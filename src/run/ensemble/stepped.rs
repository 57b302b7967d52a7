//! Rows of motion step by step.

use core::ops::Range;

use super::exact::motions;
use super::rows::Reading;
use super::{Ensemble, MemberError, Rows};
use crate::body::{Body, Clock, Point};
use crate::flow::ExactMotion;
use crate::method::{AnyMethod, Block, SideBySide, Step};
use crate::num::{Dd, LANES, Precise};
use crate::observe::Monitor;
use crate::rotation::rotation_angle;
use crate::run::{Run, RunError, Watch};

/// Blocks that go side by side, at the same places of an orbit. They stay in the second cache.
const BLOCKS: usize = 8;

/// What all members of a run have in common.
pub(super) struct Course<'a> {
    pub(super) ensemble: &'a Ensemble,
    pub(super) method: &'a dyn AnyMethod,
    pub(super) clock: Clock,
    /// Numbers of steps at which it is read, ascending.
    pub(super) steps: &'a [u64],
}

/// A member whose steps are taken side by side with those of others.
struct Member {
    /// Among the members of the part.
    number: usize,
    step: Box<dyn Step<f64>>,
    /// Opened.
    point: Point<f64>,
    side_by_side: SideBySide<f64>,
    observer: Observer,
}

impl Course<'_> {
    /// Rows of the members `part`.
    pub(super) fn rows(&self, part: Range<usize>) -> Rows {
        let mut rows = Rows::new(part.start, part.len(), self.steps.len(), self.ensemble.observed);
        let (mut members, mut starts) = (Vec::new(), Vec::new());
        for (number, k) in part.enumerate() {
            let outcome = match self.enter(number, k) {
                Ok(Entered::Lane(entered)) => {
                    let (member, start) = *entered;
                    members.push(member);
                    if self.ensemble.observed.attitude {
                        starts.push(start);
                    }
                    Ok(())
                }
                Ok(Entered::Alone(member)) => self.alone(number, &member.0, member.1, &mut rows),
                Err(error) => Err((0, error)),
            };
            if let Err((time, error)) = outcome {
                rows.fail(number, time, error);
            }
        }
        for (member, exact) in members.iter_mut().zip(motions(self.ensemble, &starts)) {
            member.observer.exact = exact.ok().map(Box::new);
        }
        // those of one kind behind each other, in their order
        let mut kinds: Vec<Vec<Member>> = Vec::new();
        for member in members {
            match kinds.iter_mut().find(|kind| kind[0].side_by_side.is_like(&member.side_by_side)) {
                Some(kind) => kind.push(member),
                None => kinds.push(vec![member]),
            }
        }
        for kind in &mut kinds {
            for members in kind.chunks_mut(BLOCKS * LANES) {
                self.together(members, &mut rows);
            }
        }
        rows.sorted()
    }

    fn enter(&self, number: usize, k: usize) -> Result<Entered, MemberError> {
        let (body, start) = self.ensemble.member(k, self.clock.start)?;
        let mut step = self.method.prepare_f64(self.clock, &body).map_err(RunError::from)?;
        let mut point = start.to_f64();
        step.open(&mut point);
        if let Some(refusal) = step.refusal() {
            return Err(RunError::from(refusal.clone()).into());
        }
        Ok(match step.side_by_side().and_then(|steps| steps.of(&body)) {
            Some(side_by_side) => {
                let observer = Observer::new(self, &body, start);
                let member = Member { number, step, point, side_by_side, observer };
                Entered::Lane(Box::new((member, (body, start))))
            }
            None => Entered::Alone(Box::new((body, start))),
        })
    }

    /// Takes the steps of members of one kind.
    fn together(&self, members: &mut [Member], rows: &mut Rows) {
        let lanes: Vec<_> = members.iter().map(|member| (member.point, &member.side_by_side)).collect();
        let mut blocks: Vec<Block> =
            lanes.chunks(LANES).filter_map(|lanes| Block::new(self.clock, lanes)).collect();
        let mut alive = vec![true; members.len()];
        for (time, &steps) in self.steps.iter().enumerate() {
            Block::advance_to(&mut blocks, steps, self.ensemble.instructions);
            for ((n, member), alive) in members.iter_mut().enumerate().zip(&mut alive) {
                if !*alive {
                    continue;
                }
                let x = member.step.reading(&blocks[n / LANES].point(n % LANES));
                *alive = x.is_finite() && member.observer.see(self, member.number, time, &x, rows);
                if *alive {
                    continue;
                }
                // alone it runs into the same and says why
                let again = self.ensemble.member(rows.first() + member.number, self.clock.start);
                let outcome = match again {
                    Ok((body, start)) => self.alone(member.number, &body, start, rows),
                    Err(error) => Err((time, error)),
                };
                if let Err((time, error)) = outcome {
                    rows.fail(member.number, time, error);
                }
            }
        }
    }

    /// Runs a member by itself.
    fn alone(
        &self,
        number: usize,
        body: &Body,
        start: Point<Dd>,
        rows: &mut Rows,
    ) -> Result<(), (usize, MemberError)> {
        let run = Run::from_point(self.method, body, start.to_f64(), self.clock);
        let mut run = run.map_err(|error| (0, error.into()))?.watching(Watch::Never);
        let mut observer = Observer::new(self, body, start);
        if self.ensemble.observed.attitude {
            observer.exact = ExactMotion::from_point(body, start).ok().map(Box::new);
        }
        for (time, &steps) in self.steps.iter().enumerate() {
            let sample = run.advance_to(steps).map_err(|error| (time, error.into()))?;
            if !observer.see(self, number, time, &sample.point, rows) {
                return Err((time, RunError::OutOfRange { steps, time: sample.time.hi() }.into()));
            }
        }
        Ok(())
    }
}

/// How a member goes on.
enum Entered {
    Lane(Box<(Member, (Body, Point<Dd>))>),
    Alone(Box<(Body, Point<Dd>)>),
}

/// What writes the rows of one member.
struct Observer {
    reading: Reading,
    monitor: Option<Box<Monitor>>,
    exact: Option<Box<ExactMotion>>,
}

impl Observer {
    /// Without the exact motion.
    fn new(course: &Course<'_>, body: &Body, start: Point<Dd>) -> Self {
        let observed = course.ensemble.observed;
        let monitor =
            observed.invariants.then(|| Box::new(Monitor::new(body, course.clock, &start.to_f64())));
        Observer { reading: Reading::of(body), monitor, exact: None }
    }

    /// Writes a row; whether all of it is finite, as a [`Run`] asks of a sample.
    fn see(&self, course: &Course<'_>, number: usize, time: usize, x: &Point<f64>, rows: &mut Rows) -> bool {
        if !rows.set(number, time, &self.reading, x.phase()) {
            return false;
        }
        if let Some(monitor) = &self.monitor {
            let errors = monitor.errors(x);
            if !errors.is_finite() {
                return false;
            }
            rows.set_errors(number, time, errors);
        }
        let elapsed = course.clock.elapsed(x.steps());
        if let Some(exact) = &self.exact
            && exact.check_time(elapsed.to_f64()).is_ok()
        {
            let angle = rotation_angle(exact.point_at(elapsed).attitude, x.attitude);
            rows.set_attitude_error(number, time, angle);
        }
        true
    }
}

//! The parts of a run between the times at which forces are switched: the field of each is smooth.

use std::borrow::Cow;

use super::schedule::{Place, ScheduleError};
use super::{Run, RunError, Watch};
use crate::body::{Body, Clock, Point, Time};
use crate::method::{AnyMethod, SOLVED, Step, StepError, Stuck};
use crate::num::Dd;

/// When forces are switched, in the direction of the steps: phase n begins with the n-th of them, and phase 0 with the start.
pub(super) struct Phases {
    switches: Vec<Switch>,
}

/// The beginning of a phase.
#[derive(Clone, Copy, Debug)]
pub(super) struct Switch {
    /// Steps that end by then.
    pub(super) steps: u64,
    /// How long after the last of them, s.
    pub(super) later: Dd,
    /// When, s, and since the start.
    time: f64,
    pub(super) elapsed: Dd,
}

impl Phases {
    pub(super) fn of(body: &Body, clock: Clock) -> Result<Self, StepError> {
        let mut times = body.switching_times();
        if clock.step < 0.0 {
            times.reverse();
        }
        let mut switches = Vec::new();
        for time in times.into_iter().filter(|time| (time - clock.start) * clock.step > 0.0) {
            let (steps, later) = match Place::of(clock, time) {
                Ok(place) => place.parts(),
                // no run comes so far
                Err(ScheduleError::TooMany { .. }) => break,
                Err(_) => return Err(StepError::NotATime { t: time }),
            };
            switches.push(Switch { steps, later, time, elapsed: Dd::from(time) - Dd::from(clock.start) });
        }
        Ok(Phases { switches })
    }

    /// The body of phase `n`; `body` itself where nothing is switched.
    pub(super) fn body<'b>(&self, n: usize, body: &'b Body, clock: Clock) -> Cow<'b, Body> {
        if body.switching_times().is_empty() {
            return Cow::Borrowed(body);
        }
        let time = if n == 0 { clock.start } else { self.switches[n - 1].time };
        Cow::Owned(body.acting(time, clock.step > 0.0))
    }

    /// Refuses a method that is not for each of the bodies.
    pub(super) fn check(&self, method: &dyn AnyMethod, body: &Body, clock: Clock) -> Result<(), StepError> {
        let mut kinds = Vec::new();
        for n in 1..=self.switches.len() {
            let acting = self.body(n, body, clock);
            let forces: Vec<_> = acting.forces().iter().map(|force| force.name().to_owned()).collect();
            if !kinds.contains(&forces) {
                method.prepare_f64(clock, &acting)?;
                kinds.push(forces);
            }
        }
        Ok(())
    }

    /// The phase in which the run is that has taken `steps` steps: a switch at the end of a step counts with the next one.
    pub(super) fn after(&self, steps: u64) -> usize {
        self.switches.partition_point(|switch| switch.steps < steps)
    }

    /// The steps that have been taken when the steps of phase `n` begin.
    pub(super) fn begins(&self, n: usize) -> u64 {
        match n.checked_sub(1).map(|n| self.switches[n]) {
            None => 0,
            Some(Switch { steps, later, .. }) => steps + u64::from(later != Dd::ZERO),
        }
    }

    /// The end of phase `n`.
    pub(super) fn end(&self, n: usize) -> Option<Switch> {
        self.switches.get(n).copied()
    }
}

impl Run {
    /// Steps until forces are switched; `None` where that never happens again.
    pub(super) fn steps_ahead(&self) -> Option<u64> {
        self.phases.end(self.phase).map(|switch| switch.steps.saturating_sub(self.point.steps()))
    }

    /// Goes on into the next phase, which begins in the next step or with it. A method that chooses its steps restarts there; of
    /// all others the step is divided.
    pub(super) fn change_phase(&mut self) -> Result<(), RunError> {
        let Some(switch) = self.phases.end(self.phase) else { return Ok(()) };
        if self.step.base().is_some() {
            let at = self.clock.at(0).later(switch.elapsed);
            let mut point = self.point;
            let state = self.step.dense(at, &mut point);
            return if state.is_finite() {
                self.begin(self.phase + 1, at, state)
            } else {
                Err(self.broken())
            };
        }
        self.read();
        let mut point = self.reading;
        if switch.later == Dd::ZERO {
            return self.begin(self.phase + 1, self.clock.at(point.steps()), point);
        }
        point = self.divided(point, Dd::from(self.clock.step))?;
        point.count_steps(1);
        self.begin(self.phases.after(point.steps()), self.clock.at(point.steps()), point)?;
        self.read();
        match self.watch {
            Watch::EveryStep if self.monitor.observe(&[self.reading]) == 0 => Err(self.broken()),
            Watch::EveryStep => Ok(()),
            Watch::AtSamples | Watch::Never => {
                self.missed = true;
                Ok(())
            }
        }
    }

    /// The steps of the phase `n` begin at the time `at` in the state `point`.
    pub(super) fn begin(&mut self, n: usize, at: Time, mut point: Point<f64>) -> Result<(), RunError> {
        self.residual = self.worst_residual();
        self.worked = self.work();
        self.step = self.prepared(n)?;
        self.step.open_at(at, &mut point);
        (self.phase, self.point) = (n, point);
        Ok(())
    }

    /// Steps of the phase `n`.
    pub(super) fn prepared(&self, n: usize) -> Result<Box<dyn Step<f64>>, StepError> {
        self.method.prepare_f64(self.clock, &self.phases.body(n, &self.body, self.clock))
    }

    /// Refuses a state that is not finite, of a part of a step that may have got `stuck`.
    pub(super) fn check(&mut self, point: &Point<f64>, stuck: Option<Stuck>) -> Result<(), RunError> {
        if point.is_finite() {
            return Ok(());
        }
        let last = self.finite_sample()?;
        Err(match stuck {
            Some(stuck) => RunError::Stuck { last, stuck },
            None => RunError::Diverged { last },
        })
    }

    /// The state `until` s behind the step of which `point` is the state, by parts of steps that end where forces are switched.
    pub(super) fn divided(&mut self, mut point: Point<f64>, until: Dd) -> Result<Point<f64>, RunError> {
        let (steps, forward) = (point.steps(), self.clock.step.signum());
        let begun = self.clock.at(steps);
        let (mut phase, mut done) = (self.phases.after(steps), Dd::ZERO);
        loop {
            let next = self.phases.end(phase);
            let next = next.filter(|next| next.steps == steps && (next.later - until).hi() * forward < 0.0);
            let end = next.map_or(until, |next| next.later);
            if end != done {
                let body = self.phases.body(phase, &self.body, self.clock);
                let mut part = self.method.prepare_part(self.clock, end - done, &body)?;
                part.apply(begun.later(done), &mut point);
                let (residual, stuck) = (part.worst_residual(), part.stuck());
                if residual > SOLVED {
                    return Err(self.unsolved(residual));
                }
                self.check(&point, stuck)?;
            }
            if next.is_none() {
                return Ok(point);
            }
            (phase, done) = (phase + 1, end);
        }
    }
}

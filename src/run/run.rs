//! One propagation of one body by one method.

use std::sync::{Arc, OnceLock};

use super::phases::Phases;
use super::{Checkpoint, CheckpointError, RunError, Sample, Schedule, Watch, checkpoint};
use crate::body::{Body, Clock, Point, State, StateError, Witness};
use crate::method::{AnyMethod, SOLVED, Step, Work, throughout};
use crate::num::Dd;
use crate::observe::{BLOCK, Errors, Monitor};

/// Steps between checks of the residual of implicit methods.
const CHUNK: u64 = 4096;

/// One propagation of one body by one method.
///
/// ```
/// use nalgebra::{UnitQuaternion, Vector3};
/// use polhode::body::{Body, Conserved};
/// use polhode::inertia::Inertia;
/// use polhode::method::method;
/// use polhode::run::{Run, Schedule};
///
/// let body = Body::free(Inertia::from_moments([1.0, 2.0, 3.0])?);
/// let start = body.state(UnitQuaternion::identity(), Vector3::new(0.4, 1.0, -0.3))?;
/// let mut run = Run::new(&method("lie-poisson")?, &body, &start, 0.01)?;
/// for sample in run.samples(Schedule::logarithmic(100_000, 2)) {
///     let worst = sample?.worst;
///     assert!(worst.of(Conserved::Energy).is_some_and(|error| error < 1e-6));
///     assert!(worst.of(Conserved::MomentumNorm).is_some_and(|error| error < 1e-14));
/// }
/// # Ok::<(), polhode::Error>(())
/// ```
#[must_use]
pub struct Run {
    pub(super) body: Body,
    pub(super) method: Box<dyn AnyMethod>,
    pub(super) step: Box<dyn Step<f64>>,
    pub(super) clock: Clock,
    /// Of the forces that are switched, and the one that `step` is of.
    pub(super) phases: Phases,
    pub(super) phase: usize,
    pub(super) watch: Watch,
    start: Point<f64>,
    /// In the form in which the step moves it.
    pub(super) point: Point<f64>,
    /// The state behind that form.
    pub(super) reading: Point<f64>,
    pub(super) monitor: Monitor,
    /// The worst of the phases before, and their work.
    pub(super) residual: f64,
    pub(super) worked: Option<Work>,
    /// Whether steps have been taken that were not watched.
    pub(super) missed: bool,
}

/// A step of a run and what was watched up to it.
pub(super) struct Mark {
    point: Point<f64>,
    reading: Point<f64>,
    memory: Vec<f64>,
    monitor: Monitor,
    missed: bool,
}

impl Run {
    /// Prepares `method` for `body` with the step `h` (s), from the state `start` (body axes) at t = 0.
    ///
    /// # Errors
    /// A step or a start that cannot be used, or a body that the method refuses.
    pub fn new(method: &dyn AnyMethod, body: &Body, start: &State, h: f64) -> Result<Self, RunError> {
        Run::by_clock(method, body, start, Clock::new(h))
    }

    /// As [`new`](Self::new), with the step and the time of the start of `clock`.
    ///
    /// # Errors
    /// As [`new`](Self::new).
    pub fn by_clock(
        method: &dyn AnyMethod,
        body: &Body,
        start: &State,
        clock: Clock,
    ) -> Result<Self, RunError> {
        Run::from_point(method, body, body.enter(start)?.to_f64(), clock)
    }

    /// As [`by_clock`](Self::by_clock), from a point of the solver frame, whose attitude has norm 1. Steps are counted from
    /// here, whatever the point has counted.
    ///
    /// # Errors
    /// As [`new`](Self::new).
    pub fn from_point(
        method: &dyn AnyMethod,
        body: &Body,
        start: Point<f64>,
        clock: Clock,
    ) -> Result<Self, RunError> {
        let start = Point::new(start.attitude, start.momentum_body);
        if let Some(&value) =
            start.attitude.components().iter().chain(&start.momentum_body.0).find(|x| !x.is_finite())
        {
            return Err(StateError::NotFinite { quantity: "the start", value }.into());
        }
        let phases = Phases::of(body, clock)?;
        let acting = phases.body(0, body, clock);
        let (mut step, mut point) = (method.prepare_f64(clock, &acting)?, start);
        phases.check(method, body, clock)?;
        if step.takes_back() {
            throughout(body)?;
        }
        step.open(&mut point);
        if let Some(refusal) = step.refusal() {
            return Err(refusal.clone().into());
        }
        Ok(Run {
            step,
            method: method.boxed(),
            monitor: Monitor::new(body, clock, &start),
            body: body.clone(),
            clock,
            phases,
            phase: 0,
            watch: Watch::default(),
            start,
            point,
            reading: start,
            residual: 0.0,
            worked: None,
            missed: false,
        })
    }

    /// The same run, watched as `watch` says from here on.
    pub fn watching(mut self, watch: Watch) -> Self {
        self.watch = watch;
        self
    }

    /// The complete state of the run, to be stored as text.
    ///
    /// ```
    /// use nalgebra::{UnitQuaternion, Vector3};
    /// use polhode::body::Body;
    /// use polhode::inertia::Inertia;
    /// use polhode::method::method;
    /// use polhode::run::Run;
    /// let body = Body::free(Inertia::from_moments([1.0, 2.0, 3.0])?);
    /// let start = body.state(UnitQuaternion::identity(), Vector3::new(0.4, 1.0, -0.3))?;
    /// let rattle = method("rattle")?;
    /// let mut straight = Run::new(&rattle, &body, &start, 0.01)?;
    /// straight.advance_to(1000)?;
    /// let text = straight.checkpoint().to_string();
    /// let mut resumed = Run::resume(&rattle, &body, &text.parse()?)?;
    /// assert_eq!(resumed.advance_to(2000)?.state, straight.advance_to(2000)?.state);
    /// # Ok::<(), polhode::Error>(())
    /// ```
    pub fn checkpoint(&self) -> Checkpoint {
        Checkpoint {
            method: self.method.name().escape_debug().to_string(),
            body: checkpoint::identity(&self.body, self.clock, &self.start),
            clock: self.clock,
            watch: self.watch,
            start: self.start,
            point: self.point,
            method_memory: self.step.memory(),
            memory: self.monitor.memory(),
            residual: self.worst_residual(),
            missed: self.missed,
        }
    }

    /// Resumes the run of `checkpoint`: it continues as if it had not been interrupted, bit for bit.
    ///
    /// # Errors
    /// A method or a body that is not that of the run, or a checkpoint that lacks what the method remembers.
    pub fn resume(method: &dyn AnyMethod, body: &Body, checkpoint: &Checkpoint) -> Result<Self, RunError> {
        checkpoint.check(&method.name(), body)?;
        let mut run = Run::from_point(method, body, checkpoint.start, checkpoint.clock)?;
        run.watch = checkpoint.watch;
        let phase = run.phases.after(checkpoint.point.steps());
        if phase > 0 {
            // what the method remembers tells the rest
            let steps = run.phases.begins(phase);
            run.begin(phase, checkpoint.clock.at(steps), Point::from_parts(checkpoint.start.parts(), steps))?;
        }
        run.point = checkpoint.point;
        let (needed, stored) = (run.step.memory().len(), checkpoint.method_memory.len());
        if needed != stored {
            return Err(CheckpointError::Memory { needed, stored }.into());
        }
        run.step.remember(&checkpoint.method_memory);
        run.read();
        run.monitor.remember(checkpoint.memory);
        run.residual = checkpoint.residual;
        run.missed = checkpoint.missed;
        Ok(run)
    }

    /// The start in the solver frame, as it is integrated: an exact reference has to start from these doubles.
    pub fn start(&self) -> Point<f64> {
        self.start
    }

    /// Advances to `steps` steps from the start and samples the run there.
    ///
    /// # Errors
    /// [`RunError::Diverged`], [`RunError::Force`] and [`RunError::Stuck`] with the last finite sample;
    /// [`RunError::Unsolved`] with the sample at which it was noticed, up to 4096 steps after the step that failed;
    /// [`RunError::OutOfRange`]; [`RunError::Phase`] if forces have acted for too long for the correction `+phase`;
    /// [`RunError::Behind`] if the run has taken more steps already.
    pub fn advance_to(&mut self, steps: u64) -> Result<Sample, RunError> {
        self.go_to(steps)?;
        self.finite_sample().map(|sample| *sample)
    }

    /// The same without the sample.
    pub(super) fn go_to(&mut self, steps: u64) -> Result<(), RunError> {
        let taken = self.point.steps();
        if steps < taken {
            return Err(RunError::Behind { asked: steps, taken });
        }
        loop {
            let residual = self.worst_residual();
            if residual > SOLVED {
                return Err(self.unsolved(residual));
            }
            if self.point.steps() >= steps {
                break;
            }
            let ahead = self.steps_ahead().unwrap_or(u64::MAX);
            if ahead == 0 {
                self.change_phase()?;
                continue;
            }
            let wanted = CHUNK.min(steps - self.point.steps()).min(ahead);
            let finite = match self.watch {
                Watch::EveryStep => self.watched(wanted),
                Watch::AtSamples | Watch::Never => self.unwatched(wanted),
            };
            if !finite && self.worst_residual() <= SOLVED {
                return Err(self.broken());
            }
        }
        self.read();
        if self.watch == Watch::AtSamples && self.monitor.observe(&[self.reading]) == 0 {
            return Err(self.broken());
        }
        Ok(())
    }

    /// Where the run is now, to [go back](Self::go_back) to.
    pub(super) fn marked(&self) -> Mark {
        Mark {
            point: self.point,
            reading: self.reading,
            memory: self.step.memory(),
            monitor: self.monitor.clone(),
            missed: self.missed,
        }
    }

    pub(super) fn go_back(&mut self, mark: Mark) {
        (self.point, self.reading) = (mark.point, mark.reading);
        self.step.remember(&mark.memory);
        (self.monitor, self.missed) = (mark.monitor, mark.missed);
    }

    pub(super) fn unsolved(&mut self, residual: f64) -> RunError {
        match self.finite_sample() {
            Ok(last) => RunError::Unsolved { last, residual },
            Err(error) => error,
        }
    }

    pub(super) fn read(&mut self) {
        self.reading = self.step.reading(&self.point);
    }

    /// The sample at the current step, if it is finite in the units of the body.
    pub(super) fn finite_sample(&mut self) -> Result<Box<Sample>, RunError> {
        self.read();
        if let Some(refusal) = self.step.refusal() {
            return Err(refusal.clone().into());
        }
        let sample = self.sample();
        if sample.is_finite() {
            Ok(Box::new(sample))
        } else {
            Err(RunError::OutOfRange { steps: sample.steps, time: sample.time.hi() })
        }
    }

    /// Takes `wanted` steps and evaluates the errors at each; false, and the run at the last finite point, if one is not finite.
    fn watched(&mut self, mut wanted: u64) -> bool {
        let mut block = [self.point; BLOCK];
        while wanted > 0 {
            let (before, memory) = (self.point, self.step.memory());
            let block = &mut block[..wanted.min(BLOCK as u64) as usize];
            self.step.fill(&mut self.point, block);
            let finite = self.monitor.observe(block);
            if finite < block.len() {
                self.point = before;
                self.step.remember(&memory);
                self.step.advance(&mut self.point, finite as u64);
                return false;
            }
            wanted -= block.len() as u64;
        }
        true
    }

    /// Takes `wanted` steps; false, and the run at the last finite point, if one is not finite.
    fn unwatched(&mut self, wanted: u64) -> bool {
        let (before, mut memory) = (self.point, self.step.memory());
        self.missed = true;
        self.step.advance(&mut self.point, wanted);
        if self.point.is_finite() {
            return true;
        }
        self.point = before;
        self.step.remember(&memory);
        for _ in 0..wanted {
            let mut next = self.point;
            self.step.advance(&mut next, 1);
            if !next.is_finite() {
                self.step.remember(&memory);
                break;
            }
            (self.point, memory) = (next, self.step.memory());
        }
        false
    }

    /// Steps like the next, with forces that report a value that is not finite, and that report; none of a body without them.
    fn probe(&self) -> Option<(Box<dyn Step<f64>>, Witness)> {
        let acting = self.phases.body(self.phase, &self.body, self.clock);
        acting.remainder().next()?;
        let witness = Arc::new(OnceLock::new());
        let mut step = self.method.prepare_f64(self.clock, &acting.witnessed(Arc::clone(&witness))).ok()?;
        step.open(&mut self.point.clone());
        Some((step, witness))
    }

    /// Why the next step is not finite.
    pub(super) fn broken(&mut self) -> RunError {
        let last = match self.finite_sample() {
            Ok(last) => last,
            Err(error) => return error,
        };
        if let Some((mut step, witness)) = self.probe() {
            let mut next = self.point;
            step.remember(&self.step.memory());
            step.advance(&mut next, 1);
            let next = step.reading(&next);
            if let Some(failure) = witness.get() {
                return RunError::Force { force: failure.force.clone(), time: failure.time, last };
            }
            let at = self.clock.at(next.steps());
            // where the attitude is none, no force has an energy, and none is to blame
            let is_attitude = next.is_finite() && next.attitude.magnitude() <= 2.0;
            if let Some(force) = self.body.force_without_energy(at, &next.to_dd()).filter(|_| is_attitude) {
                return RunError::Force { force: force.into(), time: at.seconds(), last };
            }
        }
        let (mut next, memory) = (self.point, self.step.memory());
        self.step.advance(&mut next, 1);
        let stuck = self.step.stuck();
        self.step.remember(&memory);
        match stuck {
            Some(stuck) => RunError::Stuck { last, stuck },
            None => RunError::Diverged { last },
        }
    }

    /// What the steps that the method chooses have cost since the run was made, or taken up; `None` where steps are as given,
    /// each with the cost that is [claimed](crate::method::Claims::cost).
    #[must_use]
    pub fn work(&self) -> Option<Work> {
        match (self.worked, self.step.work()) {
            (Some(before), Some(now)) => Some(before + now),
            (before, now) => before.or(now),
        }
    }

    pub(super) fn worst_residual(&self) -> f64 {
        self.residual.max(self.step.worst_residual())
    }

    /// Samples at the steps of `schedule`, skipping those before the current step; ends after the first error.
    pub fn samples(&mut self, schedule: Schedule) -> impl Iterator<Item = Result<Sample, RunError>> {
        let mut failed = false;
        let taken = self.point.steps();
        schedule.into_iter().filter(move |steps| *steps >= taken).map_while(move |steps| {
            if failed {
                return None;
            }
            let sample = self.advance_to(steps);
            failed = sample.is_err();
            Some(sample)
        })
    }

    /// The sample at the current step.
    #[must_use]
    pub fn sample(&self) -> Sample {
        self.sample_of(self.reading, Dd::ZERO)
    }

    /// The sample of `point`, of the time `later` (s) behind its step.
    pub(super) fn sample_of(&self, point: Point<f64>, later: Dd) -> Sample {
        let at = self.clock.at(point.steps()).later(later);
        let seen = self.monitor.seen(at, &point);
        let scale = self.body.scale();
        let watched = self.watch == Watch::EveryStep && !self.missed;
        Sample {
            steps: point.steps(),
            elapsed: self.clock.elapsed(point.steps()) + later,
            time: at.dd(),
            state: self.body.leave(&point),
            point,
            omega_body: self.body.omega_of(&point),
            energy: seen.energy.hi() * scale,
            momentum_norm: seen.momentum_norm.hi() * scale,
            energy_change: seen.energy_change,
            errors: seen.errors,
            worst: if self.watch == Watch::Never { Errors::NONE } else { self.monitor.worst() },
            watch: self.watch,
            flips: (watched && !self.step.takes_back()).then(|| self.monitor.flips()),
        }
    }
}

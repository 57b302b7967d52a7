//! The state of a run between two of its steps.

use super::schedule::Place;
use super::{Run, RunError, Sample};
use crate::body::Point;
use crate::method::Step;
use crate::num::Dd;

impl Run {
    /// Advances to the last step that ends by the time `t` (s), and samples the motion at `t`, between steps too. The bits of
    /// the run do not depend on it.
    ///
    /// At a step the sample is that of [`advance_to`](Self::advance_to). Behind it, of methods that choose their steps, it
    /// comes from the dense output of the next one: of order 7 of `dop853`, 4 of `tsit5`, and the series itself of `taylor`.
    /// All other methods take one step of their own from there, as long as it has to be: its local error is that of the
    /// order. So does `gauss`, whose collocation polynomial has between nodes half the order of its steps. What that costs is
    /// not counted in [`work`](Self::work), nor watched.
    ///
    /// ```
    /// use nalgebra::{UnitQuaternion, Vector3};
    /// use polhode::{Body, FreeMotion, Inertia, Run, method};
    /// let body = Body::free(Inertia::from_moments([1.0, 2.0, 3.0])?);
    /// let start = body.state(UnitQuaternion::identity(), Vector3::new(0.4, 1.0, -0.3))?;
    /// let mut run = Run::new(&method("dmv:10")?, &body, &start, 0.125)?;
    /// let between = run.at(10.3)?;
    /// let exact = FreeMotion::from_state(body.inertia(), &start)?.at(10.3)?;
    /// assert!(between.state.rotation().angle_to(&exact.rotation()) < 1e-9);
    /// assert_eq!((between.steps, between.time.hi()), (82, 10.3));
    /// # Ok::<(), polhode::Error>(())
    /// ```
    ///
    /// # Errors
    /// As [`advance_to`](Self::advance_to); [`RunError::Time`] of a time before the start, [`RunError::Past`] of one that
    /// the run has passed.
    pub fn at(&mut self, t: f64) -> Result<Sample, RunError> {
        let (steps, later) = Place::of(self.clock, t)?.parts();
        if steps < self.point.steps() {
            let reached = self.clock.at(self.point.steps()).seconds();
            return Err(RunError::Past { asked: t, reached });
        }
        self.go_to(steps)?;
        if later == Dd::ZERO {
            return self.finite_sample().map(|sample| *sample);
        }
        let point = self.here().behind(self, later)?;
        let sample = self.sample_of(point, later);
        if sample.is_finite() { Ok(sample) } else { Err(RunError::OutOfRange { steps, time: t }) }
    }

    /// The step that the run has come to, to look behind it.
    pub(super) fn here(&self) -> Between {
        let (form, memory) = (self.point, self.step.memory());
        Between { form, memory, phase: self.phase, reading: self.reading, dense: None }
    }
}

/// A step of a run, and what lies behind it.
pub(super) struct Between {
    /// The point in the form in which the method moves it, with what the method remembers.
    form: Point<f64>,
    memory: Vec<f64>,
    phase: usize,
    pub(super) reading: Point<f64>,
    dense: Option<Dense>,
}

/// Steps of a method that chooses them, and how far they have come.
struct Dense {
    step: Box<dyn Step<f64>>,
    form: Point<f64>,
    phase: usize,
}

impl Between {
    /// The state `later` s behind the step, of a `run` that has come so far or further.
    pub(super) fn behind(&mut self, run: &mut Run, later: Dd) -> Result<Point<f64>, RunError> {
        if run.step.base().is_none() {
            return run.divided(self.reading, later);
        }
        let until = run.clock.at(0).later(run.clock.elapsed(self.reading.steps()) + later);
        let forward = run.clock.step.signum();
        let behind = |time: Dd, other: Dd| (time - other).hi() * forward > 0.0;
        let ahead = match &self.dense {
            Some(dense) => dense.step.base().is_some_and(|base| behind(base, until.elapsed())),
            None => true,
        };
        if let Some(dense) = self.dense.as_mut().filter(|dense| ahead && dense.phase == self.phase) {
            dense.step.remember(&self.memory);
            dense.form = self.form;
        } else if ahead {
            let mut step = run.prepared(self.phase)?;
            step.open(&mut self.form.clone());
            step.remember(&self.memory);
            self.dense = Some(Dense { step, form: self.form, phase: self.phase });
        }
        let Some(Dense { step, form, phase }) = &mut self.dense else { return Ok(self.reading) };
        while let Some(switch) =
            run.phases.end(*phase).filter(|switch| behind(until.elapsed(), switch.elapsed))
        {
            let at = run.clock.at(0).later(switch.elapsed);
            let state = step.dense(at, form);
            run.check(&state, step.stuck())?;
            (*form, *phase) = (state, *phase + 1);
            *step = run.prepared(*phase)?;
            step.open_at(at, form);
        }
        let point = step.dense(until, form);
        run.check(&point, step.stuck())?;
        Ok(point)
    }
}

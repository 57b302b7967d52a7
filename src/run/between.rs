//! The state of a run between two of its steps.

use super::error::SOLVED;
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
    /// order. What that costs is not counted in [`work`](Self::work), nor watched.
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
        let (steps, later) = match Place::of(self.clock, t)? {
            Place::At(steps) => (steps, Dd::ZERO),
            Place::Behind { steps, later, .. } => (steps, later),
        };
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
        if sample.is_finite() { Ok(sample) } else { Err(RunError::OutOfRange { steps }) }
    }

    /// The step that the run has come to, to look behind it.
    pub(super) fn here(&self) -> Between {
        Between { form: self.point, memory: self.step.memory(), reading: self.reading, dense: None }
    }
}

/// A step of a run, and what lies behind it.
pub(super) struct Between {
    /// The point in the form in which the method moves it, with what the method remembers.
    form: Point<f64>,
    memory: Vec<f64>,
    pub(super) reading: Point<f64>,
    /// Steps of a method that chooses them, and how far they have come.
    dense: Option<(Box<dyn Step<f64>>, Point<f64>)>,
}

impl Between {
    /// The state `later` s behind the step, of a `run` that has come so far or further.
    pub(super) fn behind(&mut self, run: &mut Run, later: Dd) -> Result<Point<f64>, RunError> {
        let begun = run.clock.at(self.reading.steps());
        let (point, residual, stuck) = if run.step.base().is_some() {
            let elapsed = (begun.elapsed() + later).hi();
            let (step, form) = match &mut self.dense {
                Some(dense) => dense,
                none => {
                    let mut step = run.method.prepare_f64(run.clock, &run.body)?;
                    step.open(&mut self.form.clone());
                    step.remember(&self.memory);
                    none.insert((step, self.form))
                }
            };
            if step.base().is_some_and(|base| (elapsed - base.hi()) * run.clock.step < 0.0) {
                step.remember(&self.memory);
                *form = self.form;
            }
            (step.dense(begun.later(later), form), 0.0, step.stuck())
        } else {
            let mut step = run.method.prepare_part(run.clock, later, &run.body)?;
            let mut point = self.reading;
            step.apply(begun, &mut point);
            (point, step.worst_residual(), None)
        };
        if residual > SOLVED {
            return Err(run.unsolved(residual));
        }
        if point.is_finite() {
            return Ok(point);
        }
        let last = run.finite_sample()?;
        Err(match stuck {
            Some(stuck) => RunError::Stuck { last, stuck },
            None => RunError::Diverged { last },
        })
    }
}

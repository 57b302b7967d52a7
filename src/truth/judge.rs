//! A run of one method, watched against the true motion.

use super::{Ending, LOST, Truth, attitude_error};
use crate::body::{Body, Clock};
use crate::method::AnyMethod;
use crate::run::{Run, RunError, Sample, Watch};

/// How a run is watched: unless told, every step and to the end.
#[derive(Clone, Copy, Debug)]
#[non_exhaustive]
pub struct Care {
    /// How often the invariants are evaluated.
    pub watch: Watch,
    /// Whether the run ends where the attitude is lost.
    pub until_lost: bool,
    /// The last look is at this time or before, s since the start.
    pub until: f64,
}

impl Default for Care {
    fn default() -> Self {
        Care { watch: Watch::EveryStep, until_lost: false, until: f64::INFINITY }
    }
}

/// One look at a run.
#[derive(Clone, Copy, Debug)]
#[non_exhaustive]
pub struct Look {
    /// Time since the start, s.
    pub elapsed: f64,
    /// Angle to the true attitude, rad.
    pub attitude_error: f64,
    /// Evaluations so far.
    pub evaluations: u64,
}

/// What a run showed.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct Judged {
    /// Looks as long as the true motion is known, ascending in time.
    pub looks: Vec<Look>,
    /// The last finite sample.
    pub last: Sample,
    /// What became of the run: that the attitude was lost before what came after.
    pub ending: Ending,
    /// Evaluations that a method counts which chooses its steps, else those that it claims, of all kinds together; zero where nothing is
    /// claimed.
    pub evaluations: u64,
}

impl Truth {
    /// Runs `method` by steps of `step` s to the end, and looks at it at the steps next to the times of the looks; of a method that
    /// chooses its steps, `step` is the interval of output. Beyond the time up to which the true motion is known the run goes on
    /// and its attitude is not judged.
    ///
    /// # Errors
    /// As [`Run::from_point`], and a force that is not finite; a run that fails on its way is judged up to there.
    pub fn judge(&self, method: &dyn AnyMethod, step: f64, care: Care) -> Result<Judged, RunError> {
        let clock = Clock { start: self.start_time, step };
        let mut run = Run::from_point(method, &self.body, self.start, clock)?.watching(care.watch);
        let of_step = evaluations(method, &self.body);
        let mut judged =
            Judged { looks: Vec::new(), last: run.sample(), ending: Ending::Held, evaluations: 0 };
        let known = self.known_until();
        let beyond = (known < self.span).then_some(self.span);
        for time in self.times().chain(beyond).take_while(|time| *time <= care.until) {
            let steps = (time / step).round().max(1.0) as u64;
            if steps <= judged.last.steps {
                continue;
            }
            let failure = match run.advance_to(steps) {
                Ok(sample) => {
                    judged.last = sample;
                    (!is_a_rotation(&sample)).then(|| Ending::Diverged(sample.elapsed.hi()))
                }
                Err(error) => {
                    judged.last = error.last().copied().unwrap_or(judged.last);
                    Some(Ending::of(&error, step).ok_or(error)?)
                }
            };
            let Sample { elapsed, point, .. } = judged.last;
            judged.evaluations = run.work().map_or(of_step * judged.last.steps, |work| work.evaluations);
            if let Some(failure) = failure {
                if judged.ending == Ending::Held {
                    judged.ending = failure;
                }
                break;
            }
            if time > known {
                continue;
            }
            let attitude_error = attitude_error(point.attitude, self.point_near(elapsed)?.attitude);
            let (elapsed, evaluations) = (elapsed.hi(), judged.evaluations);
            judged.looks.push(Look { elapsed, attitude_error, evaluations });
            if attitude_error > LOST && judged.ending == Ending::Held {
                judged.ending = Ending::Lost(elapsed);
                if care.until_lost {
                    break;
                }
            }
        }
        Ok(judged)
    }
}

impl Judged {
    /// The attitude error at the last look, rad, of a run that was held.
    #[must_use]
    pub fn attitude_error(&self) -> Option<f64> {
        self.looks.last().filter(|_| self.ending == Ending::Held).map(|look| look.attitude_error)
    }

    /// The largest attitude error up to `elapsed` s since the start, rad; `None` where the run does not come so far, or is lost.
    #[must_use]
    pub fn largest_attitude_error(&self, elapsed: f64) -> Option<f64> {
        let mut before = self.looks.iter().filter(|look| look.elapsed <= elapsed * (1.0 + 1e-9));
        let largest = before.clone().map(|look| look.attitude_error).fold(0.0, f64::max);
        let reached = before.next_back().is_some_and(|look| look.elapsed >= elapsed * (1.0 - 1e-9));
        (reached && largest <= LOST).then_some(largest)
    }
}

/// Evaluations that `method` claims for a step, of all kinds together.
fn evaluations(method: &dyn AnyMethod, body: &Body) -> u64 {
    method.claims(body.problem()).map_or(0, |claims| u64::from(claims.cost.evaluations()))
}

/// Whether the numbers are still those of a rotation: |q| near 1, and no invariant changed by more than itself.
fn is_a_rotation(sample: &Sample) -> bool {
    let norm = sample.point.attitude.norm_squared().sqrt();
    let changed = [sample.worst.energy, sample.worst.momentum_norm];
    (norm - 1.0).abs() <= 0.5 && changed.iter().flatten().all(|error| *error <= 1.0)
}

//! A run of one method, measured: errors against the true motion, cost, and what became of it.

mod reference;
mod timing;

use polhode::body::{Body, Clock, Point};
use polhode::method::{AnyMethod, StepError};
use polhode::num::Dd;
use polhode::observe::Errors;
use polhode::run::{Run, RunError, Sample, Watch};
use polhode_files::error::Error;

pub use reference::Reference;
pub use timing::StepTime;

/// An attitude that is further off than this, rad, is lost: what follows is no error but chance.
pub const LOST: f64 = 1.0;

/// One body from one start on, with the motion that runs are compared with.
pub struct Motion {
    body: Body,
    start: Point<f64>,
    start_time: f64,
    span: f64,
    reference: Reference,
}

/// What becomes of a run.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Ending {
    /// It comes to its end, with the attitude less than a radian off.
    Held,
    /// The attitude is more than a radian off at the time, s since the start.
    Lost(f64),
    /// The numbers are no longer finite, or no longer those of a rotation, s since the start.
    Diverged(f64),
    /// An implicit step could not be solved, s since the start.
    Unsolved(f64),
    /// No step that the method can choose is within its tolerance, s since the start.
    Stuck(f64),
}

/// One look at a run.
#[derive(Clone, Copy, Debug)]
pub struct Look {
    /// Time since the start, s.
    pub elapsed: f64,
    /// Angle to the true attitude, rad.
    pub attitude_error: f64,
    /// Evaluations so far.
    pub evaluations: u64,
}

/// A run that was measured.
#[derive(Clone, Debug)]
pub struct Measured {
    /// Looks as long as the true motion is known, ascending in time.
    pub looks: Vec<Look>,
    /// The last finite sample.
    pub last: Sample,
    pub ending: Ending,
    /// Right sides, turns, elliptic additions, free flows, solutions and kicks together.
    pub evaluations: u64,
}

/// How a run is looked at.
#[derive(Clone, Copy, Debug)]
pub struct Care {
    /// How often the invariants are evaluated.
    pub watch: Watch,
    /// Whether the run ends where the attitude is lost.
    pub until_lost: bool,
    /// Where it ends at the latest, s since the start.
    pub until: f64,
}

impl Care {
    /// Every step watched, to the end.
    pub const FULL: Care = Care { watch: Watch::EveryStep, until_lost: false, until: f64::INFINITY };
}

impl Motion {
    /// `body` from the point `start` of the solver frame at `start_time`, looked at `times` later (s, ascending).
    ///
    /// # Errors
    /// Times that the true motion cannot be followed to.
    pub fn new(body: &Body, start: &Point<Dd>, start_time: f64, times: &[f64]) -> Result<Self, Error> {
        let start = start.to_f64();
        let reference = Reference::new(body, start, start_time, times)?;
        let span = times.last().copied().unwrap_or(0.0);
        Ok(Motion { body: body.clone(), start, start_time, span, reference })
    }

    /// The same up to `span` s, looked at `looks` times at equal distances.
    pub fn evenly(
        body: &Body,
        start: &Point<Dd>,
        start_time: f64,
        span: f64,
        looks: u32,
    ) -> Result<Self, Error> {
        let times: Vec<f64> = (1..=looks).map(|k| span * f64::from(k) / f64::from(looks)).collect();
        Motion::new(body, start, start_time, &times)
    }

    pub fn body(&self) -> &Body {
        &self.body
    }

    pub fn start(&self) -> &Point<f64> {
        &self.start
    }

    /// The motion that runs are compared with.
    pub fn reference(&self) -> &Reference {
        &self.reference
    }

    fn clock(&self, step: f64) -> Clock {
        Clock { start: self.start_time, step }
    }

    /// Runs `method` by steps of `step` to the end.
    ///
    /// # Errors
    /// As [`Run::from_point`], and a force that is not finite; a run that fails on its way is measured up to there.
    pub fn measure(&self, method: &dyn AnyMethod, step: f64, care: Care) -> Result<Measured, RunError> {
        let run = Run::from_point(method, &self.body, self.start, self.clock(step))?;
        let mut run = run.watching(care.watch);
        let of_step = evaluations(method, &self.body);
        let mut measured =
            Measured { looks: Vec::new(), last: run.sample(), ending: Ending::Held, evaluations: 0 };
        let known = self.reference.known_until();
        let beyond = (known < self.span).then_some(self.span);
        for time in self.reference.times().chain(beyond).take_while(|time| *time <= care.until) {
            let steps = (time / step).round().max(1.0) as u64;
            if steps <= run.sample().steps {
                continue;
            }
            let failed = |last: &Sample| last.elapsed.hi();
            let (sample, ending) = match run.advance_to(steps) {
                Ok(sample) => (sample, None),
                Err(RunError::Diverged { last }) => (*last, Some(Ending::Diverged(failed(&last)))),
                Err(RunError::OutOfRange { steps }) => {
                    (measured.last, Some(Ending::Diverged(step * steps as f64)))
                }
                Err(RunError::Unsolved { last, .. }) => (*last, Some(Ending::Unsolved(failed(&last)))),
                Err(RunError::Stuck { last, .. }) => (*last, Some(Ending::Stuck(failed(&last)))),
                Err(error) => return Err(error),
            };
            measured.last = sample;
            measured.evaluations = run.work().map_or(of_step * sample.steps, |work| work.evaluations);
            let elapsed = sample.elapsed.hi();
            let broken = (!is_a_rotation(&sample)).then_some(Ending::Diverged(elapsed));
            if let Some(ending) = ending.or(broken) {
                // where the attitude was lost before, that is what became of the run
                if measured.ending == Ending::Held {
                    measured.ending = ending;
                }
                break;
            }
            if time > known {
                continue;
            }
            let there = self.reference.point_at(sample.elapsed)?;
            let attitude_error = reference::apart(sample.point.attitude, there.attitude);
            let evaluations = measured.evaluations;
            measured.looks.push(Look { elapsed, attitude_error, evaluations });
            if attitude_error > LOST && measured.ending == Ending::Held {
                measured.ending = Ending::Lost(elapsed);
                if care.until_lost {
                    break;
                }
            }
        }
        Ok(measured)
    }

    /// Processor time of a step of `method`; of one that chooses its steps, per interval of output.
    pub fn step_time(&self, method: &dyn AnyMethod, step: f64) -> Result<StepTime, Error> {
        StepTime::measure(method, &self.body, self.start, self.clock(step))
    }

    /// An interval of output of methods that choose their steps, s: that of the looks where they are even.
    pub fn interval(&self) -> f64 {
        self.reference.times().next().unwrap_or(self.span)
    }

    /// max |E − E₀| of the errors `worst` over what kinetic and potential energy exchange; under uniform gravity alone.
    pub fn exchanged_energy_error(&self, worst: &Errors) -> Option<f64> {
        let exchanged = self.reference.exchanged_energy()?;
        let weight = self.body.gravity::<f64>()?.weight_moment.norm() * self.body.scale();
        let start = self.start.to_dd();
        let kinetic = 0.5
            * start.momentum_body.dot(start.momentum_body.times(self.body.rotor().inverse_moments())).hi();
        Some(worst.energy? * (kinetic * self.body.scale() + weight) / exchanged)
    }

    /// Angle between the attitude of `point`, at `elapsed` s since the start, and the true one, rad.
    ///
    /// # Errors
    /// None but those of [`new`](Self::new).
    pub fn attitude_error(&self, point: &Point<Dd>, elapsed: Dd) -> Result<f64, StepError> {
        Ok(reference::apart(point.attitude, self.reference.point_at(elapsed)?.attitude))
    }
}

impl Measured {
    /// The last look at which the attitude is not lost yet, unless it is lost before.
    pub fn attitude_error(&self) -> Option<f64> {
        match self.ending {
            Ending::Held => self.looks.last().map(|look| look.attitude_error),
            _ => None,
        }
    }

    /// The largest error of the attitude up to `elapsed` s since the start; `None` where the run does not come so far, or is lost.
    pub fn largest_attitude_error(&self, elapsed: f64) -> Option<f64> {
        let mut before = self.looks.iter().filter(|look| look.elapsed <= elapsed * (1.0 + 1e-9));
        let largest = before.clone().map(|look| look.attitude_error).fold(0.0, f64::max);
        let reached = before.next_back().is_some_and(|look| look.elapsed >= elapsed * (1.0 - 1e-9));
        (reached && largest <= LOST).then_some(largest)
    }
}

impl Ending {
    /// In words, with times of the clock.
    pub fn words(self, start_time: f64) -> String {
        let at = |elapsed: f64| polhode_files::text::short(rounded(start_time + elapsed));
        match self {
            Ending::Held => "ok".into(),
            Ending::Lost(t) => format!("lost at t = {}", at(t)),
            Ending::Diverged(t) => format!("diverged at t = {}", at(t)),
            Ending::Unsolved(t) => format!("unsolved at t = {}", at(t)),
            Ending::Stuck(t) => format!("no step at t = {}", at(t)),
        }
    }
}

/// To four digits.
fn rounded(t: f64) -> f64 {
    format!("{t:.3e}").parse().unwrap_or(t)
}

/// Evaluations in a step, of all kinds together.
pub fn evaluations(method: &dyn AnyMethod, body: &Body) -> u64 {
    let Some(claims) = method.claims(body.problem()) else { return 0 };
    let cost = claims.cost;
    u64::from(cost.right_sides + cost.turns + cost.additions + cost.free_flows + cost.solves + cost.kicks)
}

/// Whether the numbers are still those of a rotation: |q| near 1, and no invariant changed by more than itself.
fn is_a_rotation(sample: &Sample) -> bool {
    let norm = sample.point.attitude.norm_squared().sqrt();
    let changed = [sample.worst.energy, sample.worst.momentum_norm];
    (norm - 1.0).abs() <= 0.5 && changed.iter().flatten().all(|error| *error <= 1.0)
}

//! Long propagation: steps counted in `u64`, samples at scheduled steps, runs that diverge reported as data.

mod convergence;
mod schedule;

pub use convergence::{Halving, halvings, halvings_against, observed_order};
pub use schedule::Schedule;

use nalgebra::Vector3;
use thiserror::Error;

use crate::body::{Body, State, StateError};
use crate::method::{Advance, AnyMethod, StepError};
use crate::num::{Dd, Precise, Shown};
use crate::observe::{Errors, Invariants, Monitor};

/// An implicit solve that ends further than this from its equation, relative, is no solution: the invariants would be
/// lost by as much in every step. Rounding alone leaves about 1e-16.
const SOLVED: f64 = 1e-13;

/// Steps between looks at the residual of implicit methods.
const CHUNK: u64 = 4096;

/// One propagation of one body by one method.
///
/// ```
/// use nalgebra::{UnitQuaternion, Vector3};
/// use polhode::body::{Body, Inertia};
/// use polhode::method::method;
/// use polhode::run::{Run, Schedule};
///
/// let body = Body::free(Inertia::from_moments([1.0, 2.0, 3.0])?);
/// let start = body.state(UnitQuaternion::identity(), Vector3::new(0.4, 1.0, -0.3))?;
/// let mut run = Run::new(method("lie-poisson")?.as_ref(), &body, &start, 0.01)?;
/// for sample in run.samples(Schedule::logarithmic(100_000, 2)) {
///     let sample = sample?;
///     assert!(sample.worst.energy < 1e-6 && sample.worst.momentum.unwrap_or_default() < 1e-14);
/// }
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub struct Run {
    body: Body,
    step: Box<dyn Advance>,
    h: f64,
    start: State<f64>,
    state: State<f64>,
    steps: u64,
    monitor: Monitor,
}

/// A run as it stands after a number of steps.
#[derive(Clone, Copy, Debug)]
pub struct Sample {
    /// Steps taken.
    pub steps: u64,
    /// Time since the start, steps · h, s: exact.
    pub elapsed: Dd,
    /// Attitude and momentum, body axes.
    pub state: State<f64>,
    /// The same along a kernel's axes, as it was integrated.
    pub inside: State<f64>,
    /// Angular velocity in body axes, rad/s.
    pub omega_body: Vector3<f64>,
    /// Energy, J: kinetic and, under gravity, potential.
    pub energy: f64,
    /// |m|, kg m²/s.
    pub momentum: f64,
    /// (E − E₀) / E₀ of this state, with its sign; relative to T₀ + |c| under gravity.
    pub energy_change: f64,
    /// Errors of this state.
    pub errors: Errors,
    /// The largest errors over every step so far.
    pub worst: Errors,
    /// How often the momentum along the axis of the middle moment has changed sign so far.
    pub flips: u64,
}

/// Why a run could not start or go on.
#[derive(Clone, Debug, Error)]
pub enum RunError {
    /// The step is not usable.
    #[error(transparent)]
    Step(#[from] StepError),
    /// The start is not usable.
    #[error(transparent)]
    State(#[from] StateError),
    /// The next step leaves the range of numbers.
    #[error("diverged after {} steps, t = {} s: the next state is not finite; take a smaller step or another method",
        .last.steps, Shown(.last.elapsed.to_f64()))]
    Diverged {
        /// The last finite sample.
        last: Box<Sample>,
    },
    /// The equations of an implicit step could not be solved.
    #[error(
        "after {} steps, t = {} s, an implicit step was left with a relative residual of {residual:.1e} (at most {SOLVED:e}): \
         it turns too far in one step; take a smaller one", .last.steps, Shown(.last.elapsed.to_f64())
    )]
    Unsolved {
        /// The sample at which it was noticed.
        last: Box<Sample>,
        /// The worst relative residual.
        residual: f64,
    },
}

impl Run {
    /// Prepares `method` for `body` with the step `h` (s), from the state `start` (body axes).
    ///
    /// # Errors
    /// A step or a start that is not usable.
    pub fn new(method: &dyn AnyMethod, body: &Body, start: &State<f64>, h: f64) -> Result<Self, RunError> {
        let exact = body.enter(start)?;
        let start = State {
            attitude: crate::rotation::Quat::from_components(exact.attitude.components().map(Dd::to_f64)),
            momentum_body: crate::rotation::Vec3(exact.momentum_body.0.map(Dd::to_f64)),
        };
        Ok(Run {
            step: method.prepare_f64(h, body, &start)?,
            monitor: Monitor::new(body, &start),
            body: body.clone(),
            h,
            start,
            state: start,
            steps: 0,
        })
    }

    /// The start along a kernel's axes, the doubles that are integrated: what an exact reference has to start from.
    pub fn start(&self) -> State<f64> {
        self.start
    }

    /// Goes on to `steps` steps from the start and looks at the state there.
    ///
    /// # Errors
    /// [`RunError::Diverged`] or [`RunError::Unsolved`], with the last sample that can be relied on.
    pub fn advance_to(&mut self, steps: u64) -> Result<Sample, RunError> {
        while self.steps < steps {
            let wanted = CHUNK.min(steps - self.steps);
            let taken = self.step.advance(&mut self.state, wanted, &mut self.monitor);
            self.steps += taken;
            let residual = self.step.worst_residual();
            if residual > SOLVED {
                return Err(RunError::Unsolved { last: Box::new(self.sample()), residual });
            }
            if taken < wanted {
                return Err(RunError::Diverged { last: Box::new(self.sample()) });
            }
        }
        Ok(self.sample())
    }

    /// Samples at the steps of `schedule`; ends after the first error.
    pub fn samples(&mut self, schedule: Schedule) -> impl Iterator<Item = Result<Sample, RunError>> {
        let mut failed = false;
        schedule.into_iter().map_while(move |steps| {
            if failed {
                return None;
            }
            let sample = self.advance_to(steps);
            failed = sample.is_err();
            Some(sample)
        })
    }

    /// The run as it stands.
    pub fn sample(&self) -> Sample {
        let invariants = Invariants::of(&self.body, &self.state);
        let scale = self.body.scale();
        Sample {
            steps: self.steps,
            elapsed: elapsed(self.steps, self.h),
            state: self.body.leave(&self.state),
            inside: self.state,
            omega_body: self.body.omega_body(&self.state),
            energy: invariants.energy.hi() * scale,
            momentum: invariants.momentum().hi() * scale,
            energy_change: self.monitor.energy_change(&self.state),
            errors: self.monitor.errors(&self.state),
            worst: self.monitor.worst(),
            flips: self.monitor.flips(),
        }
    }
}

/// steps · h without rounding: an increment `t += h` would lose a second in a long enough run.
fn elapsed(steps: u64, h: f64) -> Dd {
    let (high, low) = (steps >> 32, steps & 0xffff_ffff);
    Dd::product(high as f64 * 4_294_967_296.0, h) + Dd::product(low as f64, h)
}

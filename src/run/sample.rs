//! Samples of a run, and how often its errors are evaluated.

use core::fmt;

use nalgebra::Vector3;

use crate::body::{Point, State};
use crate::num::Dd;
use crate::observe::Errors;

/// How often the errors of a run are evaluated.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[non_exhaustive]
pub enum Watch {
    /// At every step.
    #[default]
    EveryStep,
    /// At samples only: [`Sample::worst`] is the largest error over them, and flips are not counted.
    AtSamples,
    /// Never, so that nothing is added to the time of a step. [`Sample::errors`] still has the errors of the sample.
    Never,
}

impl fmt::Display for Watch {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Watch::EveryStep => "every-step",
            Watch::AtSamples => "at-samples",
            Watch::Never => "never",
        })
    }
}

/// State, readings and errors of a run after a number of steps.
///
/// ```
/// use nalgebra::{UnitQuaternion, Vector3};
/// use polhode::body::{Body, Conserved};
/// use polhode::inertia::Inertia;
/// use polhode::method::method;
/// use polhode::run::Run;
/// let body = Body::free(Inertia::from_moments([1.0, 2.0, 3.0])?);
/// let start = body.state(UnitQuaternion::identity(), Vector3::new(0.4, 1.0, -0.3))?;
/// let sample = Run::new(&method("lie-poisson")?, &body, &start, 0.25)?.advance_to(40)?;
/// assert_eq!((sample.steps, sample.time.hi()), (40, 10.0));
/// assert!((sample.omega_body.norm() - 1.0).abs() < 0.5); // rad/s
/// assert!(sample.errors.of(Conserved::Energy) <= sample.worst.of(Conserved::Energy));
/// # Ok::<(), polhode::Error>(())
/// ```
#[derive(Clone, Copy, Debug)]
#[non_exhaustive]
pub struct Sample {
    /// Steps taken.
    pub steps: u64,
    /// Time since the start, s: exact. Steps · h, or more [between steps](super::Run::at).
    pub elapsed: Dd,
    /// Time, s: that of the start and what has elapsed since.
    pub time: Dd,
    /// Attitude and momentum, body axes.
    pub state: State,
    /// The same in the solver frame, as it was integrated.
    pub point: Point<f64>,
    /// Angular velocity in body axes, rad/s.
    pub omega_body: Vector3<f64>,
    /// Kinetic and potential energy, J.
    pub energy: f64,
    /// |m|, kg m²/s.
    pub momentum_norm: f64,
    /// (E − E₀) / E₀ of this state, with its sign; with forces relative to the scale of [`Errors`].
    pub energy_change: f64,
    /// Errors of this state.
    pub errors: Errors,
    /// The largest errors so far, over what was watched; each `None` if nothing was.
    pub worst: Errors,
    /// How often the errors were evaluated.
    pub watch: Watch,
    /// How often the momentum along the axis of the middle moment has changed sign up to the last step, where every step was
    /// watched; `None` with `+phase`, whose states are not those of the steps.
    pub flips: Option<u64>,
}

impl Sample {
    /// Why the numbers no longer are those of a rotation, in words; `None` where they may be.
    #[must_use]
    pub fn nonsense(&self) -> Option<String> {
        let norm = self.point.attitude.norm_squared().sqrt();
        let lost = if (norm - 1.0).abs() > 0.5 {
            format!("the quaternion of the attitude has the norm {norm:.1e}, not 1")
        } else {
            // where nothing is watched, those of this sample
            let (worst, now) = (self.worst, self.errors);
            let errors =
                [("energy", worst.energy.or(now.energy)), ("|m|", worst.momentum_norm.or(now.momentum_norm))];
            let (what, error) =
                errors.into_iter().find(|(_, error)| error.is_some_and(|error| error > 1.0))?;
            format!("the relative error of {what} is {:.1e}", error.unwrap_or_default())
        };
        Some(format!(
            "at {:?} s {lost}: the numbers no longer describe the motion; use a smaller step or another method",
            self.time.hi()
        ))
    }

    /// Whether state, readings and errors are finite numbers in the units of the body.
    pub(super) fn is_finite(&self) -> bool {
        self.state.is_finite()
            && self.time.hi().is_finite()
            && self.energy.is_finite()
            && self.momentum_norm.is_finite()
            && self.energy_change.is_finite()
            && self.errors.is_finite()
            && self.omega_body.iter().all(|w| w.is_finite())
    }
}

//! Methods whose type is known only at run time: the dynamic outside of the static inside.

use core::fmt;

use thiserror::Error;

use super::map::Stepper;
use super::with_wheels::WithWheels;
use crate::body::{Body, Clock, Evaluated, Free, Problem};
use crate::method::{Claimed, Claims, Method, Step, ToleranceError};
use crate::num::{Dd, Shown};

/// A method whose type is known only at run time.
pub trait AnyMethod: Claimed + Send + Sync {
    /// Whole steps of `clock` for `body`, in `f64`.
    ///
    /// # Errors
    /// A step that is zero or not finite, or a body that the method is not for.
    fn prepare_f64(&self, clock: Clock, body: &Body) -> Result<Box<dyn Step<f64>>, StepError>;

    /// The same in double-double, for measuring below the rounding of `f64`.
    ///
    /// # Errors
    /// As [`prepare_f64`](Self::prepare_f64).
    fn prepare_dd(&self, clock: Clock, body: &Body) -> Result<Box<dyn Step<Dd>>, StepError>;

    /// Maps of the length `h` (s) at times of `clock`, in `f64`: parts of its steps.
    ///
    /// # Errors
    /// As [`prepare_f64`](Self::prepare_f64).
    fn prepare_part(&self, clock: Clock, h: Dd, body: &Body) -> Result<Box<dyn Step<f64>>, StepError>;

    /// The same method, to be kept.
    fn boxed(&self) -> Box<dyn AnyMethod>;
}

impl<M: Method<f64> + Method<Dd> + Claimed + Clone + Send + Sync + 'static> AnyMethod for M {
    fn prepare_f64(&self, clock: Clock, body: &Body) -> Result<Box<dyn Step<f64>>, StepError> {
        prepare(self, clock, Dd::from(clock.step), body)
    }
    fn prepare_dd(&self, clock: Clock, body: &Body) -> Result<Box<dyn Step<Dd>>, StepError> {
        prepare(self, clock, Dd::from(clock.step), body)
    }
    fn prepare_part(&self, clock: Clock, h: Dd, body: &Body) -> Result<Box<dyn Step<f64>>, StepError> {
        prepare(self, clock, h, body)
    }
    fn boxed(&self) -> Box<dyn AnyMethod> {
        Box::new(self.clone())
    }
}

impl fmt::Debug for dyn AnyMethod {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.name())
    }
}

impl Clone for Box<dyn AnyMethod> {
    fn clone(&self) -> Self {
        (**self).boxed()
    }
}

impl Claimed for Box<dyn AnyMethod> {
    fn name(&self) -> String {
        (**self).name()
    }
    fn claims(&self, problem: Problem) -> Option<Claims> {
        (**self).claims(problem)
    }
    fn needs_series(&self) -> bool {
        (**self).needs_series()
    }
    fn tolerance(&self) -> Option<f64> {
        (**self).tolerance()
    }
    fn with_tolerance(&self, tolerance: f64) -> Result<Box<dyn AnyMethod>, ToleranceError> {
        (**self).with_tolerance(tolerance)
    }
}

impl AnyMethod for Box<dyn AnyMethod> {
    fn prepare_f64(&self, clock: Clock, body: &Body) -> Result<Box<dyn Step<f64>>, StepError> {
        (**self).prepare_f64(clock, body)
    }
    fn prepare_dd(&self, clock: Clock, body: &Body) -> Result<Box<dyn Step<Dd>>, StepError> {
        (**self).prepare_dd(clock, body)
    }
    fn prepare_part(&self, clock: Clock, h: Dd, body: &Body) -> Result<Box<dyn Step<f64>>, StepError> {
        (**self).prepare_part(clock, h, body)
    }
    fn boxed(&self) -> Box<dyn AnyMethod> {
        (**self).boxed()
    }
}

/// Maps of `method` of the length `h`, compiled for what acts on `body`.
fn prepare<S, M>(method: &M, clock: Clock, h: Dd, body: &Body) -> Result<Box<dyn Step<S>>, StepError>
where
    S: Evaluated,
    M: Method<S> + Claimed,
{
    if !(clock.step.is_finite() && clock.step != 0.0) {
        return Err(StepError::NotAStep { h: clock.step });
    }
    if !clock.start.is_finite() {
        return Err(StepError::NotATime { t: clock.start });
    }
    let problem = body.problem();
    if method.claims(problem).is_none() {
        let what = body.remainder().find(|force| problem != Problem::Torque || !force.has_potential());
        let what = what.map(|force| force.name().to_owned()).or(body.acts()).unwrap_or_default();
        if problem == Problem::Potential && method.claims(Problem::Linear).is_some() {
            return Err(StepError::NoGradient { method: method.name(), force: what });
        }
        return Err(StepError::Refused { method: method.name(), force: what, problem });
    }
    if method.needs_series()
        && let Some(force) = body.remainder().find(|force| force.series.is_none())
    {
        return Err(StepError::Closure { method: method.name(), force: force.name().into() });
    }
    let rotor = body.rotor();
    let together = body.momentum_of_wheels().and_then(|wheels| {
        let map = if problem == Problem::Gyrostat {
            method.wheel_map(h, &rotor, &Free, &wheels)
        } else {
            method.wheel_map(h, &rotor, &body.field_without_wheels::<S>(), &wheels)
        };
        Some(WithWheels::new(map?, wheels, clock, h))
    });
    if let Some(together) = together {
        return Ok(Box::new(together));
    }
    Ok(match (problem, body.linear_potential::<S>()) {
        (Problem::Free, _) => Box::new(Stepper::new(method.map(h, &rotor, &Free), clock)),
        (Problem::Linear, Some(linear)) => Box::new(Stepper::new(method.map(h, &rotor, &linear), clock)),
        _ => Box::new(Stepper::new(method.map(h, &rotor, &body.field::<S>()), clock)),
    })
}

/// Why a method cannot take steps of this size, or of this body.
#[derive(Clone, Debug, PartialEq, Error)]
#[non_exhaustive]
pub enum StepError {
    /// The step is zero or not finite.
    #[error("step {} is not usable; it must be a finite number of seconds other than 0", Shown(*h))]
    NotAStep {
        /// The step asked for, s.
        h: f64,
    },
    /// The time of the start is not finite.
    #[error("start time {} is not usable; it must be a finite number of seconds", Shown(*t))]
    NotATime {
        /// The time asked for, s.
        t: f64,
    },
    /// The method needs the derivative of the torque, and a force other than gravity acts.
    #[error(
        "method {method:?} needs the derivative of the torque, which is known only for uniform gravity, and {force} acts; use \
         kick-drift@srkn-6b, for example"
    )]
    NoGradient {
        /// Name of the method.
        method: String,
        /// Name of the force.
        force: String,
    },
    /// The method does not support the forces on the body.
    #[error("method {method:?} cannot take {force}, {}", remedy(*.problem))]
    Refused {
        /// Name of the method.
        method: String,
        /// Name of the force.
        force: String,
        /// The kind of motion that it makes.
        problem: Problem,
    },
    /// The method evaluates forces on power series, and one is a closure in `f64`.
    #[error(
        "method {method:?} cannot take {force}, a closure in f64: it evaluates laws on power series; write the law for every \
         Real, or use rk4 or, for a potential, kick-drift"
    )]
    Closure {
        /// Name of the method.
        method: String,
        /// Name of the force.
        force: String,
    },
}

fn remedy(problem: Problem) -> &'static str {
    match problem {
        Problem::Torque => "a torque without potential; use rk4 or implicit-midpoint",
        Problem::Gyrostat | Problem::GyrostatPotential => "on a body with wheels; use taylor or lie-poisson",
        _ => "as it is for free motion only; use kick-drift, for example",
    }
}

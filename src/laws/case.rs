//! The bodies that laws are measured on.

use std::sync::OnceLock;

use nalgebra::Vector3;

use super::LawsError;
use super::fields::{OfTheVertical, Pushed};
use crate::body::{Body, Clock, Force, Point, Problem, State, Time, Wheel};
use crate::flow::FreeMotion;
use crate::inertia::Inertia;
use crate::method::{AnyMethod, Taylor};
use crate::num::Dd;
use crate::rotation::{Quat, Vec3};

/// Invariants that hold in exact arithmetic hold to this in double-double after some hundred steps.
pub(super) const EXACT: f64 = 1e-28;

/// Moments, momenta and torques are this many times those of the problems in the literature: a factor whose power of two
/// is not 1 and which is not a power of two itself.
pub(super) const SIZE: f64 = 24.0;

/// Steps of order 40 with which the end of a motion without closed form is computed; half as many agree with them.
const STEPS: u64 = 32;

/// A tri-axial body, a generic start, and where the motion then ends.
#[derive(Debug)]
#[non_exhaustive]
pub struct Case {
    /// The body with what acts on it.
    pub body: Body,
    /// Where it starts, in the solver frame.
    pub start: Point<Dd>,
    /// How long the motion is followed for orders of convergence, s.
    pub span: f64,
    end: OnceLock<Result<Point<Dd>, LawsError>>,
}

impl Case {
    fn new(body: Body, start: Point<Dd>, span: f64) -> Self {
        Case { body, start, span, end: OnceLock::new() }
    }

    /// What kind of motion it is.
    pub fn problem(&self) -> Problem {
        self.body.problem()
    }

    /// Where the motion is after the [span](Self::span), to the digits of double-double: by the closed form, or by Taylor
    /// series of order 40.
    ///
    /// # Errors
    /// None of the library's cases.
    pub fn end(&self) -> Result<Point<Dd>, LawsError> {
        let found = self.end.get_or_init(|| {
            if self.problem() == Problem::Free {
                let motion = FreeMotion::from_point(self.body.inertia(), self.start);
                return Ok(motion.point_at_dd(Dd::from(self.span)));
            }
            let mut x = self.start;
            let clock = Clock::new(self.span / STEPS as f64);
            Taylor::of_order(40)?.prepare_dd(clock, &self.body)?.steps(&mut x, STEPS);
            Ok(x)
        });
        found.clone()
    }

    /// The energy at a point of the motion; no case has one that depends on the time.
    pub(super) fn energy(&self, x: &Point<Dd>) -> Dd {
        self.body.energy_of(Time::from_seconds(0.0), x)
    }
}

pub(super) fn inertia() -> Result<Inertia, LawsError> {
    Ok(Inertia::from_moments([0.625, 0.75, 1.0].map(|i| i * SIZE))?)
}

/// Where the bodies with those moments start.
pub(super) fn start_of(body: &Body) -> Result<Point<Dd>, LawsError> {
    let attitude = Quat::from_components([0.5, -0.25, 0.75, 0.375]);
    let momentum_body = Vec3([1.0, 0.5, -0.75].map(|m| m * SIZE));
    Ok(body.enter(&State { attitude, momentum_body })?)
}

fn of(body: Body) -> Result<Case, LawsError> {
    let start = start_of(&body)?;
    Ok(Case::new(body, start, 2.0))
}

/// The asymmetric heavy body of Hairer, Lubich and Wanner, Geometric Numerical Integration, figure VII.5.3.
fn heavy() -> Result<Case, LawsError> {
    let inertia = Inertia::from_moments([0.5, 0.85, 1.0].map(|i| i * SIZE))?;
    let body = Body::heavy(inertia, [0.0, 0.0, 1.0].map(|c| c * SIZE).into())?;
    let attitude = Quat::from_components([0.4, 0.2, 0.4, 0.8]);
    let start = body.enter(&State { attitude, momentum_body: Vec3([0.2, 1.0, 0.4].map(|m| m * SIZE)) })?;
    Ok(Case::new(body, start, 1.0))
}

/// The potential of the third case.
pub(super) fn of_the_vertical() -> OfTheVertical {
    OfTheVertical {
        linear: [0.1, -0.2, 0.4].map(|a| a * SIZE),
        quadratic: [0.5, -0.25, 0.125].map(|a| a * SIZE),
    }
}

/// The torque of the fourth case.
pub(super) fn pushed() -> Pushed {
    Pushed(0.5 * SIZE)
}

/// The body of the other cases with two wheels, one of them free, along no principal axis; their speeds in proportion to `speed`, rad/s.
fn gyrostat(speed: f64) -> Result<Body, LawsError> {
    let held = Wheel::new(Vector3::new(2.0, -1.0, 2.0), 0.01 * SIZE, 5.0 * speed)?;
    let free = Wheel::new(Vector3::new(0.6, 0.0, -0.8), 0.02 * SIZE, -4.0 * speed)?;
    let free = free.free(Vector3::new(1.5, 0.5, -0.75));
    Ok(Body::free(inertia()?).with_wheel(held)?.with_wheel(free)?)
}

/// One case of each kind of motion: free, under gravity, in a potential, under a torque that depends on everything, with wheels, and
/// with wheels in a potential.
///
/// No moment equals another, no scale is 1, no start is next to a steady turn.
///
/// # Errors
/// None: the cases are constants.
///
/// ```
/// use polhode::body::Problem;
/// let [free, heavy, ..] = polhode::laws::cases()?;
/// assert_eq!((free.problem(), heavy.problem()), (Problem::Free, Problem::Linear));
/// # Ok::<(), polhode::Error>(())
/// ```
pub fn cases() -> Result<&'static [Case; 6], LawsError> {
    static CASES: OnceLock<Result<[Case; 6], LawsError>> = OnceLock::new();
    let build = || {
        let potential = Force::potential("vertical", of_the_vertical());
        Ok([
            of(Body::free(inertia()?))?,
            heavy()?,
            of(Body::free(inertia()?).with(potential))?,
            of(Body::free(inertia()?).with(Force::torque("push", pushed())))?,
            of(gyrostat(10.0)?)?,
            of(gyrostat(10.0)?.with(Force::potential("vertical", of_the_vertical())))?,
        ])
    };
    CASES.get_or_init(build).as_ref().map_err(Clone::clone)
}

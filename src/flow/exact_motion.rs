//! The exact motion of any body that has one in closed form.

use nalgebra::Vector3;
use thiserror::Error;

use super::{FreeMotion, GyrostatError, GyrostatMotion, LagrangeError, LagrangeTop, TimeError};
use crate::body::{Body, Point, Problem, State, StateError};
use crate::num::{Dd, Shown};

/// The motion of a body from one start in closed form: of a free body, of a body with wheels, or of a symmetric top under gravity.
///
/// ```
/// use nalgebra::{UnitQuaternion, Vector3};
/// use polhode::body::Body;
/// use polhode::inertia::Inertia;
/// use polhode::flow::ExactMotion;
/// let top = Body::heavy(Inertia::from_moments([1.25, 1.25, 0.75])?, Vector3::new(0.0, 0.0, 2.0))?;
/// let start = top.state(UnitQuaternion::from_axis_angle(&Vector3::x_axis(), 0.5), Vector3::new(0.0, 0.0, 20.0))?;
/// let later = ExactMotion::new(&top, &start)?.at(1e6)?;
/// assert!((top.energy(&later) / top.energy(&start) - 1.0).abs() < 1e-14);
/// # Ok::<(), polhode::Error>(())
/// ```
#[derive(Clone, Debug)]
#[must_use]
#[non_exhaustive]
pub enum ExactMotion {
    /// Nothing acts on the body.
    Free(Box<FreeMotion>),
    /// A symmetric body under gravity, its weight on the axis.
    Lagrange(Box<LagrangeTop>),
    /// A body with wheels, and nothing else acts.
    Gyrostat(Box<GyrostatMotion>),
}

/// Why a motion has no closed form here.
#[derive(Clone, Debug, PartialEq, Error)]
#[non_exhaustive]
pub enum NoClosedForm {
    /// The body is heavy and no Lagrange top.
    #[error(transparent)]
    Lagrange(#[from] LagrangeError),
    /// The motion of a body with wheels has too few digits in closed form.
    #[error(transparent)]
    Gyrostat(#[from] GyrostatError),
    /// The motor of a wheel works.
    #[error(
        "the motor of a wheel acts with {} N m from {} s to {} s; the closed form holds only while no motor acts: use the \
         method taylor, or start again where the motor ends", Shown(*torque), Shown(*from), Shown(*to)
    )]
    Motor {
        /// N m.
        torque: f64,
        /// When it begins, s.
        from: f64,
        /// When it ends, s; infinite without end.
        to: f64,
    },
    /// A force acts that leaves no closed form.
    #[error(
        "{force} acts on the body; closed forms are available for free bodies, with or without wheels, and for symmetric tops \
         under uniform gravity"
    )]
    Forced {
        /// Name of the force.
        force: String,
    },
    /// The start is not usable.
    #[error(transparent)]
    State(#[from] StateError),
}

impl ExactMotion {
    /// From the state `start` at t = 0.
    ///
    /// # Errors
    /// A start that is not usable, or a body whose motion has no closed form, with the condition that fails.
    pub fn new(body: &Body, start: &State) -> Result<Self, NoClosedForm> {
        Self::from_point(body, body.enter(start)?)
    }

    /// From a point of the solver frame at t = 0, whose attitude has norm 1.
    ///
    /// # Errors
    /// As [`new`](Self::new).
    pub fn from_point(body: &Body, start: Point<Dd>) -> Result<Self, NoClosedForm> {
        if !body.wheels().is_empty() {
            return Ok(Self::Gyrostat(Box::new(GyrostatMotion::from_point(body, start)?)));
        }
        match (body.problem(), body.remainder().next()) {
            (Problem::Free, _) => Ok(Self::Free(Box::new(FreeMotion::from_point(body.inertia(), start)))),
            (_, Some(force)) => Err(NoClosedForm::Forced { force: force.name().into() }),
            _ => Ok(Self::Lagrange(Box::new(LagrangeTop::from_point(body, start)?))),
        }
    }

    /// [From points](Self::from_point) of several bodies: each has the bits that it has alone, and free ones are worked out side by
    /// side.
    pub(crate) fn from_points(starts: &[(Body, Point<Dd>)]) -> Vec<Result<Self, NoClosedForm>> {
        let is_free = |body: &Body| body.wheels().is_empty() && body.problem() == Problem::Free;
        let free = starts.iter().filter(|(body, _)| is_free(body));
        let free: Vec<_> = free.map(|(body, start)| (body.inertia(), *start)).collect();
        let mut free = FreeMotion::from_points(&free).into_iter();
        let motion = |(body, start): &(Body, Point<Dd>)| {
            let side_by_side = if is_free(body) { free.next() } else { None };
            side_by_side
                .map_or_else(|| Self::from_point(body, *start), |motion| Ok(Self::Free(Box::new(motion))))
        };
        starts.iter().map(motion).collect()
    }

    /// The state at the time `t` (s, of either sign), body axes.
    ///
    /// # Errors
    /// A time that is not finite, or so far that the phases have no digits left.
    pub fn at(&self, t: f64) -> Result<State, TimeError> {
        match self {
            Self::Free(motion) => motion.at(t),
            Self::Lagrange(top) => top.at(t),
            Self::Gyrostat(motion) => motion.at(t),
        }
    }

    /// Gives `each` the states at many `times` with their angular velocities, rad/s, body axes, in order: the bits of
    /// [`at`](Self::at), of a free body several times as fast.
    ///
    /// ```
    /// use nalgebra::{UnitQuaternion, Vector3};
    /// use polhode::body::Body;
    /// use polhode::flow::ExactMotion;
    /// use polhode::inertia::Inertia;
    /// let top = Body::heavy(Inertia::from_moments([1.25, 1.25, 0.75])?, Vector3::new(0.0, 0.0, 2.0))?;
    /// let start = top.state(UnitQuaternion::from_axis_angle(&Vector3::x_axis(), 0.5), Vector3::new(0.0, 0.0, 20.0))?;
    /// let (motion, mut lowest) = (ExactMotion::new(&top, &start)?, f64::INFINITY);
    /// let times: Vec<f64> = (0..200).map(|k| 0.01 * f64::from(k)).collect();
    /// motion.each_at(&times, |state, _| lowest = lowest.min((state.rotation() * Vector3::z()).z))?;
    /// assert!((0.8..0.5_f64.cos()).contains(&lowest)); // the axis nods
    /// # Ok::<(), polhode::Error>(())
    /// ```
    ///
    /// # Errors
    /// As [`at`](Self::at), of the first time that has no state; `each` is not called then.
    pub fn each_at(&self, times: &[f64], each: impl FnMut(State, Vector3<f64>)) -> Result<(), TimeError> {
        match self {
            Self::Free(motion) => motion.each_at(times, each),
            Self::Lagrange(top) => top.each_at(times, each),
            Self::Gyrostat(motion) => motion.each_at(times, each),
        }
    }

    /// The largest |t| at which the phases still have digits, s; infinite for a body at rest.
    #[must_use]
    pub fn reach(&self) -> f64 {
        match self {
            Self::Free(motion) => motion.reach(),
            Self::Lagrange(top) => top.reach(),
            Self::Gyrostat(motion) => motion.reach(),
        }
    }

    /// Whether there is a state at the time `t`, s: what [`at`](Self::at) checks, without the state.
    ///
    /// # Errors
    /// As [`at`](Self::at).
    ///
    /// ```
    /// use nalgebra::{UnitQuaternion, Vector3};
    /// use polhode::body::Body;
    /// use polhode::flow::ExactMotion;
    /// use polhode::inertia::Inertia;
    /// let body = Body::free(Inertia::from_moments([1.0, 2.0, 3.0])?);
    /// let start = body.state(UnitQuaternion::identity(), Vector3::new(0.4, 1.0, -0.3))?;
    /// let motion = ExactMotion::new(&body, &start)?;
    /// assert!(motion.check_time(-1e20).is_ok() && motion.check_time(2.0 * motion.reach()).is_err());
    /// # Ok::<(), polhode::Error>(())
    /// ```
    pub fn check_time(&self, t: f64) -> Result<(), TimeError> {
        TimeError::check(t, self.reach())
    }

    /// The point of the solver frame at the time `t`, s, finite and within reach: worked out in `f64`, with phases reduced in
    /// double-double, so that a time that is the difference of two others costs no digits.
    pub fn point_at(&self, t: Dd) -> Point<f64> {
        match self {
            Self::Free(motion) => motion.point_after(t),
            Self::Lagrange(top) => top.point_after(t),
            Self::Gyrostat(motion) => motion.point_after(t),
        }
    }

    /// The point of the solver frame at the time `t`, s, in double-double; `t` finite and within reach.
    pub fn point_at_dd(&self, t: Dd) -> Point<Dd> {
        match self {
            Self::Free(motion) => motion.point_at_dd(t),
            Self::Lagrange(top) => top.point_at_dd(t),
            Self::Gyrostat(motion) => motion.point_at_dd(t),
        }
    }
}

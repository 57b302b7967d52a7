//! Exact motions at any time, and the exact flows that splitting methods are composed of.
//!
//! [`FreeMotion`], [`GyrostatMotion`] (with wheels) and [`LagrangeTop`] are motions from a start, in SI units; [`ExactMotion`] is whichever
//! of them a body and its forces have. The flows:
//!
//! | flow | of the energy | made from |
//! |---|---|---|
//! | [`Turn`] | ½ κ m_k² | a [`Rotor`](crate::body::Rotor), or κ |
//! | [`Casimir`] | \|m\|²/(2I) | a rotor, or 1/I |
//! | [`SymmetricTop`] | \|m\|²/(2A) + ½ (1/C − 1/A) m_k² | a rotor, or C and A |
//! | [`FreeFlow`], [`FreeBody`] | ½ Σ m_k²/I_k | a rotor |
//! | [`Kick`] | U(q) | a [`Field`](crate::body::Field) |
//!
//! Each moves a [`Point`]: principal axes, momenta divided by the scale of the rotor. [`KineticSplit`](crate::method::KineticSplit) makes
//! a method of your own out of them.

mod casimir;
mod derivative;
mod dissipation;
mod exact_motion;
mod free;
mod gyrostat;
mod kick;
mod lagrange;
mod reach;
mod scaled;
mod turn;

pub use casimir::Casimir;
pub(crate) use casimir::{quarter_squared, quarters};
pub use derivative::{DerivativeError, TurnAxes};
pub use dissipation::Dissipation;
pub use exact_motion::{ExactMotion, NoClosedForm};
pub(crate) use free::{Addition, Curve, FreeLanes, FreeOrbit, Last, apart, direction, smallest_turn};
pub use free::{
    AtRest, Character, CovarianceError, Departure, FittedMotion, FreeBody, FreeFlow, FreeMotion,
    Interpolation, Mode, Passage, Passages, PureSpin, Stability, StartCovariance, StateCovariance,
    StateDerivative, SymmetricTop, ThroughError, TumblingElements, TumblingError,
};
#[cfg(any(test, feature = "random"))]
pub use free::{NoElements, NoTumbler, TumblingPopulation, TumblingSolution};
pub use gyrostat::{GyrostatCharacter, GyrostatError, GyrostatMotion, SteadySpin};
pub use kick::Kick;
pub use lagrange::{LagrangeError, LagrangeTop, TopDerivative};
pub use reach::TimeError;
pub use turn::Turn;
pub(crate) use turn::{turn_a_little_about, turn_about, turn_about_axis, turn_by};

use crate::body::{Point, Time};
use crate::num::Real;

/// The exact solution of a vector field: `flow(s)` then `flow(t)` is `flow(s + t)`.
///
/// ```
/// use nalgebra::{UnitQuaternion, Vector3};
/// use polhode::body::{Body, Time};
/// use polhode::flow::{Flow, FreeFlow};
/// use polhode::inertia::Inertia;
/// use polhode::num::{Dd, Real};
/// let body = Body::free(Inertia::from_moments([1.0, 2.0, 3.0])?);
/// let start = body.state(UnitQuaternion::identity(), Vector3::new(0.4, 1.0, -0.3))?;
/// let (flow, now) = (FreeFlow::<Dd>::new(&body.rotor()), Time::from_seconds(0.0));
/// let (mut once, mut twice) = (body.enter(&start)?, body.enter(&start)?);
/// flow.flow(now, Dd::of(2.0), &mut once);
/// flow.flow(now, Dd::of(0.5), &mut twice);
/// flow.flow(now.later(Dd::of(0.5)), Dd::of(1.5), &mut twice);
/// assert!((once.momentum_body - twice.momentum_body).magnitude() < 1e-29);
/// # Ok::<(), polhode::Error>(())
/// ```
pub trait Flow<S: Real> {
    /// Moves `x` by the time `t` (s) from the time `at` on; negative times go back. What rounding takes is carried in `x`.
    fn flow(&self, at: Time, t: S, x: &mut Point<S>);
}

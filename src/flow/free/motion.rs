//! The motion of the free rigid body at any time.

use std::sync::OnceLock;

use nalgebra::{UnitQuaternion, Vector3};

use super::character::{AtRest, Character};
use super::circulation::Circulation;
use super::phase::{Spin, steady};
use super::polhode::{Polhode, exact_separation};
use super::theta::Theta;
use crate::body::{Body, Point, State, StateError};
use crate::flow::reach::{MOST_RADIANS, TimeError};
use crate::inertia::Inertia;
use crate::num::{Dd, Precise};
use crate::rotation::{Quat, Vec3};

/// The motion of one free body from one start: constants worked out once, then any time in O(1).
///
/// ```
/// use nalgebra::{UnitQuaternion, Vector3};
/// use polhode::inertia::Inertia;
/// use polhode::flow::FreeMotion;
///
/// let racket = Inertia::from_moments([1.0, 2.0, 3.0])?;
/// let motion = FreeMotion::from_omega(&racket, UnitQuaternion::identity(), Vector3::new(0.4, 1.0, -0.3))?;
/// let (start, later) = (motion.at(0.0)?, motion.at(1e9)?);
/// let (before, after) = (start.rotation() * start.momentum(), later.rotation() * later.momentum());
/// assert!((before - after).norm() < 1e-14); // L is fixed in space
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug)]
#[must_use]
pub struct FreeMotion {
    body: Body,
    start: Point<Dd>,
    kind: Kind,
    reach: f64,
}

/// What becomes of the momentum in the body.
#[derive(Clone, Debug)]
enum Kind {
    /// There is none: the attitude stays.
    Rest,
    /// It is fixed, and the body turns about it: a sphere, a pure spin.
    Steady(Box<Spin>),
    /// It moves along its polhode.
    Circulating(Box<Orbit>),
}

/// A polhode with both its forms: theta functions in `f64`, Carlson's integrals in double-double when asked for.
#[derive(Clone, Debug)]
struct Orbit {
    polhode: Polhode<Dd>,
    momentum: Vec3<Dd>,
    quick: Theta,
    precise: OnceLock<Circulation<Dd>>,
}

impl Orbit {
    fn precise(&self) -> &Circulation<Dd> {
        self.precise.get_or_init(|| Circulation::of(self.polhode.clone(), self.momentum).with_period())
    }
}

impl FreeMotion {
    /// From the attitude and the angular velocity (rad/s, body axes) at t = 0; the product I ω is formed exactly.
    ///
    /// # Errors
    /// Components that are not finite, or an energy outside the range of a double.
    pub fn from_omega(
        inertia: &Inertia,
        attitude: UnitQuaternion<f64>,
        omega_body: Vector3<f64>,
    ) -> Result<Self, StateError> {
        let start = Body::free(inertia.clone()).enter_omega(attitude.into(), omega_body.into())?;
        Ok(Self::from_point(inertia, start))
    }

    /// From a state at t = 0, body axes.
    ///
    /// # Errors
    /// As [`from_omega`](Self::from_omega).
    pub fn from_state(inertia: &Inertia, start: &State) -> Result<Self, StateError> {
        let start = Body::free(inertia.clone()).enter(start)?;
        Ok(Self::from_point(inertia, start))
    }

    /// From a point of the solver frame at t = 0, whose attitude has norm 1, as those of [`Body::enter`] have. Any other norm
    /// is that of the attitudes at all times.
    pub fn from_point(inertia: &Inertia, start: Point<Dd>) -> Self {
        let body = Body::free(inertia.clone());
        let (moments, momentum) = (body.rotor().moments(), start.momentum_body);
        let norm = momentum.norm();
        let kind = if norm == Dd::ZERO {
            Kind::Rest
        } else if let Some(polhode) =
            Polhode::of(moments, momentum, norm, exact_separation(moments, momentum))
        {
            let quick = Theta::of(&polhode, start.attitude, momentum);
            Kind::Circulating(Box::new(Orbit { polhode, momentum, quick, precise: OnceLock::new() }))
        } else {
            let (axis, rate) = steady(moments, momentum, norm);
            Kind::Steady(Box::new(Spin::new(axis, rate)))
        };
        // no part of the phase runs faster than G/I_l
        let reach = MOST_RADIANS * (moments[moments.ascending()[0]] / norm).to_f64();
        FreeMotion { body, start, kind, reach }
    }

    /// The body that moves.
    pub fn body(&self) -> &Body {
        &self.body
    }

    /// The state at time `t` (s, of either sign), body axes.
    ///
    /// # Errors
    /// A time that is not finite, or beyond [`reach`](Self::reach).
    pub fn at(&self, t: f64) -> Result<State, TimeError> {
        TimeError::check(t, self.reach)?;
        Ok(self.body.leave(&self.point_at(t)))
    }

    /// The largest |t| at which the phase still has digits, s: some 2⁹⁶ rad; infinite at rest.
    #[must_use]
    pub fn reach(&self) -> f64 {
        self.reach
    }

    /// The states at many `times`, body axes.
    ///
    /// # Errors
    /// As [`at`](Self::at), of the first time that has no state.
    pub fn at_many(&self, times: &[f64]) -> Result<Vec<State>, TimeError> {
        times.iter().map(|&t| self.at(t)).collect()
    }

    /// The angular velocity at time `t`, body axes, rad/s.
    ///
    /// # Errors
    /// As [`at`](Self::at).
    pub fn omega_at(&self, t: f64) -> Result<Vector3<f64>, TimeError> {
        TimeError::check(t, self.reach)?;
        Ok(self.body.omega_of(&self.point_at(t)))
    }

    /// Periods, mode and distance to the separatrix.
    ///
    /// # Errors
    /// A body at rest has none of these.
    pub fn character(&self) -> Result<Character, AtRest> {
        match &self.kind {
            Kind::Rest => Err(AtRest),
            Kind::Steady(spin) => {
                let moments: Vec3<Dd> = self.body.rotor().moments();
                let moment = self.start.momentum_body.norm() / spin.rate();
                Ok(Character::steady(spin.rate(), moment, moments[moments.ascending()[1]]))
            }
            Kind::Circulating(orbit) => Ok(Character::circulating(&orbit.polhode, orbit.precise())),
        }
    }

    /// How often the momentum along the axis of the middle moment changes sign between the start and time `t` (s).
    #[must_use]
    pub fn flips(&self, t: Dd) -> u64 {
        match &self.kind {
            Kind::Circulating(orbit) => orbit.precise().flips(t),
            Kind::Rest | Kind::Steady(_) => 0,
        }
    }

    /// The point of the solver frame at time `t` (s), finite and within [`reach`](Self::reach).
    ///
    /// The quaternion is the continuous lift from the start: it does not jump from `q` to `−q`.
    #[inline]
    pub fn point_at(&self, t: f64) -> Point<f64> {
        if t == 0.0 {
            return self.start.to_f64();
        }
        let quick = match &self.kind {
            Kind::Circulating(orbit) => orbit.quick.at(t),
            Kind::Steady(spin) => spin.quick(t).map(|turn| {
                let start = self.start.to_f64();
                (start.attitude * turn, start.momentum_body)
            }),
            Kind::Rest => None,
        };
        match quick {
            Some((attitude, momentum_body)) => Point::new(attitude, momentum_body),
            None => self.point_at_dd(Dd::from(t)).to_f64(),
        }
    }

    /// The same in double-double, by an independent form of the solution.
    pub fn point_at_dd(&self, t: Dd) -> Point<Dd> {
        if t == Dd::ZERO {
            return self.start;
        }
        let (turn, momentum_body) = match &self.kind {
            Kind::Circulating(orbit) => orbit.precise().at(t),
            Kind::Steady(spin) => (spin.precise(t), self.start.momentum_body),
            Kind::Rest => (Quat::identity(), Vec3::zero()),
        };
        Point::new(self.start.attitude * turn, momentum_body)
    }
}

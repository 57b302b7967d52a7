//! The free rigid body: its motion at any time, and the same as a flow for splittings.

use nalgebra::{UnitQuaternion, Vector3};
use thiserror::Error;

use std::sync::OnceLock;

use super::Flow;
use super::character::{AtRest, Character};
use super::circulation::Circulation;
use super::phase::{Spin, turn};
use super::polhode::{Polhode, ascending, exact_separation, rounded_separation};
use super::theta::Theta;
use crate::body::{Body, Phase, Point, Rotor, State, StateError, Time};
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
pub struct FreeMotion {
    body: Body,
    start: Point<Dd>,
    kind: Kind,
    reach: f64,
}

/// Why there is no state at a time.
#[derive(Clone, Copy, Debug, PartialEq, Error)]
pub enum TimeError {
    /// The time is not a number.
    #[error("time {t} s is not a finite number")]
    NotFinite {
        /// The time, s.
        t: f64,
    },
    /// The phase has lost its digits.
    #[error(
        "after {t:e} s the phase has no digits left: it is known to 106 bits, and the body has turned \
         further than 2^96 rad; times up to {reach:e} s can be answered"
    )]
    OutOfReach {
        /// The time, s.
        t: f64,
        /// The largest time that has an answer, s.
        reach: f64,
    },
}

/// Of the 106 bits of a phase in rad, ten are to be left after the whole turns.
pub(super) const MOST_RADIANS: f64 = 79_228_162_514_264_337_593_543_950_336.0; // 2⁹⁶

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

    /// From a point of the solver frame at t = 0.
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
        let reach = MOST_RADIANS * (moments[ascending(moments)[0]] / norm).to_f64();
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
        self.check(t)?;
        Ok(self.body.leave(&self.point_at(t)))
    }

    /// The largest |t| at which the phase still has digits, s: some 2⁹⁶ rad; infinite at rest.
    pub fn reach(&self) -> f64 {
        self.reach
    }

    fn check(&self, t: f64) -> Result<(), TimeError> {
        if !t.is_finite() {
            Err(TimeError::NotFinite { t })
        } else if t.abs() > self.reach {
            Err(TimeError::OutOfReach { t, reach: self.reach })
        } else {
            Ok(())
        }
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
        self.check(t)?;
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
                Ok(Character::steady(spin.rate(), moment, moments[ascending(moments)[1]]))
            }
            Kind::Circulating(orbit) => Ok(Character::circulating(&orbit.polhode, orbit.precise())),
        }
    }

    /// How often the momentum along the axis of the middle moment changes sign between the start and time `t` (s).
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

/// Axis and rate of a turn about a momentum that stays fixed in the body: ω is parallel to m.
fn steady<S: Precise>(moments: Vec3<S>, m: Vec3<S>, norm: S) -> (Vec3<S>, S) {
    let omega = Vec3([m[0] / moments[0], m[1] / moments[1], m[2] / moments[2]]);
    (m * (S::of(1.0) / norm), m.dot(omega) / norm)
}

/// The exact flow of the free body, set up anew from the state at each call, in the state's own scalar.
///
/// The drift between the kicks of a splitting. Only products and differences of `S` go into it: in `f64` a turn of
/// one radian is good to 4e-14 rad; next to the unstable axis, where the phase is as long as the logarithm of the distance,
/// to 2e-13 rad.
#[derive(Clone, Copy, Debug)]
pub struct FreeBody<S> {
    moments: Vec3<S>,
}

impl<S: Precise> FreeBody<S> {
    /// The free flow of a body with the constants `rotor`.
    pub fn new(rotor: &Rotor) -> Self {
        FreeBody { moments: rotor.moments() }
    }
}

impl<S: Precise> Flow<S> for FreeBody<S> {
    fn flow(&self, _: Time, t: S, x: &mut Point<S>) {
        let (i, m) = (self.moments, x.momentum_body);
        let norm = m.norm();
        if norm == S::of(0.0) {
            return;
        }
        if !norm.magnitude().is_finite() {
            // no motion can be told: a run sees it diverge
            x.set_phase(Phase { attitude: x.attitude * S::of(f64::NAN), momentum_body: m });
            return;
        }
        let (turn, momentum_body) = match Polhode::of(i, m, norm, rounded_separation(i, m)) {
            Some(polhode) => {
                let circulation = Circulation::of(polhode, m);
                let near = circulation.is_near(t);
                if near { circulation.at(t) } else { circulation.with_period().at(t) }
            }
            None => {
                let (axis, rate) = steady(i, m, norm);
                (turn(axis, rate * t), m)
            }
        };
        x.set_phase(Phase { attitude: x.attitude * turn, momentum_body });
    }
}

//! Wheels on a body: a gyrostat.
//!
//! # Notation
//! | letter | meaning |
//! |---|---|
//! | a | axis of a wheel, of length 1, body axes |
//! | J | moment of inertia of the wheel about a |
//! | Ω | speed of the wheel relative to the body |
//! | l | J Ω of a wheel held at its speed, J (Ω + a·ω) of one that turns freely or is driven |
//! | I | tensor of body and wheels; less J a aᵀ of each wheel that is not held |
//!
//! The angular momentum is m = I ω + Σ l a, and ṁ = m × ω + τ. Of the carrier, p = I ω, it is ṗ = p × ω + τ + Σ (l a × ω − l̇ a): so a wheel
//! acts on the carrier like a torque that does no work while l is constant (Volterra, Acta Math. 22 (1899) 201; Hughes, Spacecraft Attitude
//! Dynamics, §3.5).

use core::fmt;

use nalgebra::Vector3;
use thiserror::Error;

use super::{Time, Torque};
use crate::inertia::InertiaError;
use crate::num::{Dd, Real, Shown};
use crate::rotation::{Quat, Vec3};

/// A wheel, symmetric about its axis, that is carried by a [`Body`](super::Body): held at its speed relative to the body, free, or driven
/// by a motor.
///
/// ```
/// use nalgebra::Vector3;
/// use polhode::body::{Body, Conserved, Wheel};
/// use polhode::{Inertia, Run, method};
/// let wheel = Wheel::new(Vector3::new(0.0, 1.0, 1.0), 0.01, 300.0)?; // 3 kg m²/s
/// let body = Body::free(Inertia::from_moments([10.0, 12.0, 15.0])?).with_wheel(wheel)?;
/// let start = body.state(Default::default(), Vector3::new(0.1, -0.05, 0.2))?;
/// let end = Run::new(&method("lie-poisson")?, &body, &start, 0.1)?.advance_to(10_000)?;
/// assert!(end.worst.of(Conserved::Momentum).is_some_and(|error| error < 1e-14)); // of body and wheel together
/// # Ok::<(), polhode::Error>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[must_use]
pub struct Wheel {
    axis: Vec3<Dd>,
    inertia: f64,
    drive: Drive,
}

#[derive(Clone, Copy, Debug, PartialEq)]
enum Drive {
    Held {
        speed: f64,
    },
    /// From the time `from` to `to` l grows by `torque` a second, before and after it stays; it is `momentum` at the time `since`, or would
    /// be if the motor worked then.
    Free {
        momentum: Dd,
        since: f64,
        torque: f64,
        from: f64,
        to: f64,
    },
}

/// Why a body cannot carry a wheel.
#[derive(Clone, Debug, PartialEq, Error)]
#[non_exhaustive]
pub enum WheelError {
    /// A number is not finite.
    #[error("{quantity} of the wheel is {value}; it must be a finite number")]
    NotFinite {
        /// What was given.
        quantity: &'static str,
        /// The offending value.
        value: f64,
    },
    /// The axis has no direction.
    #[error("the axis of the wheel is 0, 0, 0, which has no direction")]
    NoAxis,
    /// The inertia about the axis is zero or negative.
    #[error("the inertia of the wheel about its axis is {}; it must be positive", Shown(*inertia))]
    NotPositive {
        /// The offending value, kg m².
        inertia: f64,
    },
    /// The motor works during no interval.
    #[error("the motor of the wheel works from {} s to {} s; it must end after its beginning", Shown(*from), Shown(*to))]
    Interval {
        /// The beginning, s.
        from: f64,
        /// The end, s.
        to: f64,
    },
    /// The wheel has more inertia than the whole that it is a part of.
    #[error(
        "the wheel's inertia of {} kg m^2 is too large for that of body and wheels together, {} kg m^2 about its axis; without \
         the wheel: {rest}", Shown(*inertia), Shown(*about_axis)
    )]
    TooLarge {
        /// Of the wheel about its axis, kg m².
        inertia: f64,
        /// Of body and wheels about the same axis, kg m².
        about_axis: f64,
        /// What is wrong with the rest.
        rest: InertiaError,
    },
}

impl Wheel {
    /// A wheel with the inertia `inertia` (kg m²) about `axis` (body axes, any length) that is held at `speed`, rad/s, relative to the
    /// body, positive about the axis by the right hand. The inertia of the body that carries it includes the wheel, at rest on it.
    ///
    /// # Errors
    /// Numbers that are not finite, an axis without direction, an inertia that is not positive.
    pub fn new(axis: Vector3<f64>, inertia: f64, speed: f64) -> Result<Self, WheelError> {
        let components = axis.iter().map(|&value| ("a component of the axis", value));
        for (quantity, value) in components.chain([("the inertia", inertia), ("the speed", speed)]) {
            if !value.is_finite() {
                return Err(WheelError::NotFinite { quantity, value });
            }
        }
        let given = Vec3::from(axis);
        if given.magnitude() == 0.0 {
            return Err(WheelError::NoAxis);
        }
        if inertia <= 0.0 {
            return Err(WheelError::NotPositive { inertia });
        }
        let near_one = Vec3::<Dd>::of(given.map(|x| libm::scalbn(x, -libm::ilogb(given.magnitude()))));
        let axis = near_one * (Dd::ONE / near_one.norm());
        Ok(Wheel { axis, inertia, drive: Drive::Held { speed } })
    }

    /// The same wheel, turning freely about its axis: it has its speed where the body turns at `omega_body`, rad/s, body axes.
    pub fn free(self, omega_body: Vector3<f64>) -> Self {
        Wheel { drive: Drive::always(self.before_motor(omega_body), 0.0, 0.0), ..self }
    }

    /// l before a motor begins, where the body turns at `omega_body` then.
    fn before_motor(&self, omega_body: Vector3<f64>) -> Dd {
        match self.drive {
            Drive::Held { speed } => {
                (self.axis.dot(Vec3::of(omega_body.into())) + Dd::of(speed)) * self.inertia
            }
            Drive::Free { .. } => self.momentum_at(Dd::of(f64::NEG_INFINITY)),
        }
    }

    /// The same wheel with a motor that turns it by `torque`, N m, about its axis against the body from the time `from` to `to`, s; before
    /// and after it turns freely. It has its speed where the body turns at `omega_body` before the motor begins.
    ///
    /// # Errors
    /// A torque that is not finite, an interval that does not end after its beginning. It may last for ever.
    pub fn driven(
        self,
        torque: f64,
        [from, to]: [f64; 2],
        omega_body: Vector3<f64>,
    ) -> Result<Self, WheelError> {
        if !torque.is_finite() {
            return Err(WheelError::NotFinite { quantity: "the torque of the motor", value: torque });
        }
        // a NaN is no bound either
        if !(from.is_finite() && from < to) {
            return Err(WheelError::Interval { from, to });
        }
        Ok(self.driven_since(f64::NEG_INFINITY, torque, [from, to], omega_body))
    }

    /// The same with its speed at the time `t`, s, with a motor that is as it must be.
    fn driven_since(self, t: f64, torque: f64, [from, to]: [f64; 2], omega_body: Vector3<f64>) -> Self {
        let momentum = self.before_motor(omega_body);
        Wheel { drive: Drive::Free { momentum, since: t.clamp(from, to), torque, from, to }, ..self }
    }

    /// Its axis, of length 1, body axes.
    #[must_use]
    pub fn axis(&self) -> Vector3<f64> {
        self.axis.map(Dd::hi).into()
    }

    /// Its moment of inertia about the axis, kg m².
    #[must_use]
    pub fn inertia(&self) -> f64 {
        self.inertia
    }

    /// Its speed relative to the body at the time `t`, s, where the body turns at `omega_body`; both in rad/s.
    #[must_use]
    pub fn speed(&self, t: f64, omega_body: Vector3<f64>) -> f64 {
        match self.drive {
            Drive::Held { speed } => speed,
            Drive::Free { .. } => {
                let along = self.axis.dot(Vec3::of(omega_body.into()));
                (self.momentum_at(Dd::of(t)) / Dd::of(self.inertia) - along).hi()
            }
        }
    }

    /// Whether it is held at its speed.
    #[must_use]
    pub fn is_held(&self) -> bool {
        matches!(self.drive, Drive::Held { .. })
    }

    /// The torque of its motor, N m, and from when to when it works, s; `None` without a motor.
    #[must_use]
    pub fn motor(&self) -> Option<(f64, [f64; 2])> {
        match self.drive {
            Drive::Free { torque, from, to, .. } if torque != 0.0 => Some((torque, [from, to])),
            _ => None,
        }
    }

    pub(super) fn axis_dd(&self) -> Vec3<Dd> {
        self.axis
    }

    /// l at the time `t`, s, in kg m²/s.
    fn momentum_at(&self, t: Dd) -> Dd {
        match self.drive {
            Drive::Held { speed } => Dd::product(self.inertia, speed),
            Drive::Free { momentum, torque: 0.0, .. } => momentum,
            Drive::Free { momentum, since, torque, from, to } => {
                let worked = if t.hi() < from {
                    Dd::of(from)
                } else if t.hi() < to {
                    t
                } else {
                    Dd::of(to)
                };
                momentum + (worked - Dd::of(since)) * torque
            }
        }
    }

    /// The torque of its motor at the time `t`, s.
    fn torque_at(&self, t: f64) -> f64 {
        match self.motor() {
            Some((torque, [from, to])) if from <= t && t < to => torque,
            _ => 0.0,
        }
    }

    /// l a at the time `at`, body axes, in a scalar in which it may grow with the time.
    pub(crate) fn momentum<S: Real>(&self, at: Time) -> Vec3<S> {
        let momentum = S::linear(self.momentum_at(at.dd()), self.torque_at(at.seconds()));
        self.axis.map(S::from_dd) * momentum
    }

    /// When its motor begins and ends, s.
    pub(super) fn switching_times(&self) -> impl Iterator<Item = f64> {
        self.motor().into_iter().flat_map(|(_, times)| times)
    }

    /// The wheel as its motor drives it just after the time `t`, s, or just before it, as if for ever.
    pub(super) fn acting(&self, t: f64, after: bool) -> Self {
        let Some((torque, [from, to])) = self.motor() else { return *self };
        let begun = if after { from <= t } else { from < t };
        let ended = if after { to <= t } else { to < t };
        let (since, torque) = match (begun, ended) {
            (false, _) => (from, 0.0),
            (true, false) => (from, torque),
            (true, true) => (to, 0.0),
        };
        Wheel { drive: Drive::always(self.momentum_at(Dd::of(since)), since, torque), ..*self }
    }
}

/// A wheel by its speed at the start of a motion that is not known yet: the momentum of one that is not held depends on how the body turns
/// then.
///
/// ```
/// use nalgebra::Vector3;
/// use polhode::body::{Wheel, WheelAtStart};
/// let wheel = WheelAtStart::free(Wheel::new(Vector3::x(), 0.1, 20.0)?);
/// let omega = Vector3::new(3.0, 1.0, 0.0);
/// assert_eq!(wheel.of_start(0.0, omega), Wheel::new(Vector3::x(), 0.1, 20.0)?.free(omega));
/// # Ok::<(), polhode::Error>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[must_use]
pub struct WheelAtStart {
    held: Wheel,
    drive: DriveAtStart,
}

#[derive(Clone, Copy, Debug, PartialEq)]
enum DriveAtStart {
    Held,
    Free,
    /// The torque, N m, and from when to when, s.
    Motor(f64, [f64; 2]),
}

impl WheelAtStart {
    /// The wheel as it is, whose momentum is the same from any start.
    pub fn held(held: Wheel) -> Self {
        WheelAtStart { held, drive: DriveAtStart::Held }
    }

    /// The wheel `held` at the start, which then turns freely.
    pub fn free(held: Wheel) -> Self {
        WheelAtStart { held, drive: DriveAtStart::Free }
    }

    /// The wheel `held` at the start with the motor of [`Wheel::driven`].
    ///
    /// # Errors
    /// As of [`Wheel::driven`].
    pub fn driven(held: Wheel, torque: f64, times: [f64; 2]) -> Result<Self, WheelError> {
        let _ = held.driven(torque, times, Vector3::zeros())?;
        Ok(WheelAtStart { held, drive: DriveAtStart::Motor(torque, times) })
    }

    /// Whether it is held at its speed.
    #[must_use]
    pub fn is_held(&self) -> bool {
        self.drive == DriveAtStart::Held && self.held.is_held()
    }

    /// The wheel held at the speed of the start.
    pub fn at_speed(&self) -> Wheel {
        self.held
    }

    /// The same wheel with the speed `speed`, rad/s, at the start.
    ///
    /// # Errors
    /// A speed that is not finite.
    pub fn with_speed(self, speed: f64) -> Result<Self, WheelError> {
        if !speed.is_finite() {
            return Err(WheelError::NotFinite { quantity: "the speed", value: speed });
        }
        Ok(WheelAtStart { held: Wheel { drive: Drive::Held { speed }, ..self.held }, ..self })
    }

    /// The wheel of a body that turns at `omega_body`, rad/s, body axes, at the time `t`, s, of the start.
    pub fn of_start(&self, t: f64, omega_body: Vector3<f64>) -> Wheel {
        match self.drive {
            DriveAtStart::Held => self.held,
            DriveAtStart::Free => self.held.free(omega_body),
            DriveAtStart::Motor(torque, times) => self.held.driven_since(t, torque, times, omega_body),
        }
    }
}

impl Drive {
    /// l = `momentum` at the time `since`, and a motor that works for ever.
    fn always(momentum: Dd, since: f64, torque: f64) -> Self {
        Drive::Free { momentum, since, torque, from: f64::NEG_INFINITY, to: f64::INFINITY }
    }
}

impl fmt::Display for Wheel {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Vec3([x, y, z]) = self.axis.map(Dd::hi);
        write!(f, "{x:?},{y:?},{z:?},{:?}@", self.inertia)?;
        match self.drive {
            Drive::Held { speed } => write!(f, "{speed:?}"),
            Drive::Free { momentum, since, torque, from, to } => {
                let (high, low) = (momentum.hi(), momentum.lo());
                write!(f, "{high:?}+{low:?} at {since:?}, {torque:?} from {from:?} to {to:?}")
            }
        }
    }
}

impl fmt::Display for WheelAtStart {
    /// `ax,ay,az,I@SPEED`, and behind it `,free` or `,torque=T,from=t,until=t`, in kg m², rad/s, N m and s: as the flag `--wheel` takes it.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}", self.held)?;
        match self.drive {
            DriveAtStart::Held => Ok(()),
            DriveAtStart::Free => f.write_str(",free"),
            DriveAtStart::Motor(torque, [from, to]) => {
                write!(f, ",torque={torque:?},from={from:?}")?;
                if to < f64::INFINITY { write!(f, ",until={to:?}") } else { Ok(()) }
            }
        }
    }
}

/// The momentum of all wheels of a body along its principal axes, divided by [`Body::scale`](super::Body::scale).
#[derive(Clone, Debug)]
#[must_use]
pub struct Wheels {
    constant: Vec3<Dd>,
    /// Those with a motor, and their axes over the scale.
    driven: Vec<(Wheel, Vec3<Dd>)>,
}

impl Wheels {
    /// Of `wheels` with `axis` taking body axes to the solver frame, over the scale.
    pub(super) fn new(wheels: &[Wheel], axis: impl Fn(Vec3<Dd>) -> Vec3<Dd>) -> Self {
        let mut all = Wheels { constant: Vec3::zero(), driven: Vec::new() };
        for wheel in wheels {
            let axis = axis(wheel.axis);
            match wheel.motor() {
                None => all.constant = all.constant + axis * wheel.momentum_at(Dd::ZERO),
                Some(_) => all.driven.push((*wheel, axis)),
            }
        }
        all
    }

    /// Whether it does not change.
    #[must_use]
    pub(crate) fn is_constant(&self) -> bool {
        self.driven.is_empty()
    }

    /// The momentum at the time `at`.
    pub fn at(&self, at: Time) -> Vec3<Dd> {
        let each = self.driven.iter().map(|(wheel, axis)| *axis * wheel.momentum_at(at.dd()));
        each.fold(self.constant, |sum, one| sum + one)
    }
}

/// What a wheel does to the momentum I ω of the body that carries it, body axes.
#[derive(Clone, Copy, Debug)]
pub(super) struct OnCarrier(pub(super) Wheel);

impl<S: Real> Torque<S> for OnCarrier {
    fn torque(&self, at: Time, _: Quat<S>, omega_body: Vec3<S>) -> Vec3<S> {
        let torque = self.0.momentum::<S>(at).cross(omega_body);
        match self.0.torque_at(at.seconds()) {
            0.0 => torque,
            motor => torque - self.0.axis.map(S::from_dd) * S::of(motor),
        }
    }
}

//! The motion of a body with wheels at any time, in body axes.

use nalgebra::Vector3;

use super::{GyrostatOrbit, steady_spins};
use crate::body::{Body, Exit, Point, Problem, State, StateError, Time};
use crate::flow::NoClosedForm;
use crate::flow::free::Stability;
use crate::flow::reach::TimeError;
use crate::num::Dd;
use crate::rotation::Vec3;

/// The motion of one body with [wheels](crate::body::Wheel) that are held or turn freely, from one start: constants worked out once, then any
/// time in O(1).
///
/// The momentum of body and wheels runs on a closed curve in the body, in theta functions of the time, and the body turns about L by a phase
/// beside a periodic part (Volterra, Acta Math. 22 (1899) 201). A start all but on a separatrix or at an unstable steady spin may have too few
/// digits: then [`new`](Self::new) refuses, after a check of the solution against the equation of motion.
///
/// ```
/// use nalgebra::Vector3;
/// use polhode::body::{Body, Wheel};
/// use polhode::flow::GyrostatMotion;
/// use polhode::Inertia;
/// let wheel = Wheel::new(Vector3::new(0.0, 1.0, 1.0), 0.01, 300.0)?;
/// let body = Body::free(Inertia::from_moments([10.0, 12.0, 15.0])?).with_wheel(wheel)?;
/// let start = body.state(Default::default(), Vector3::new(0.1, -0.05, 0.2))?;
/// let motion = GyrostatMotion::new(&body, &start)?;
/// let later = motion.at(1e9)?;
/// let momentum = body.momentum_space(0.0, &start);
/// assert!((body.momentum_space(1e9, &later) - momentum).norm() < 1e-14 * momentum.norm());
/// assert!(motion.character().period.is_some_and(|period| (20.0..60.0).contains(&period)));
/// # Ok::<(), polhode::Error>(())
/// ```
#[derive(Clone, Debug)]
#[must_use]
pub struct GyrostatMotion {
    body: Body,
    wheels: Vec3<Dd>,
    orbit: GyrostatOrbit,
}

/// What kind of motion a body with wheels makes.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct GyrostatCharacter {
    /// Period of the angular velocity in body axes, s; `None` if it is constant.
    pub period: Option<f64>,
    /// By how much the body has turned about L after that, rad, less whole turns.
    pub turn_per_period: Option<f64>,
    /// ½ ω·Iω, J: what wheels leave constant.
    pub energy: f64,
    /// The energies, J, of the unstable steady spins with the same |L|, rising: a motion of such an energy is on a separatrix.
    pub separatrix_energies: Vec<f64>,
}

/// A steady spin of a body with wheels: the angular velocity stays in the body and in space, along L.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct SteadySpin {
    /// rad/s, body axes.
    pub omega_body: Vector3<f64>,
    /// ω·L/|L|, rad/s: negative where the body turns against the momentum of the whole.
    pub rate: f64,
    /// What becomes of a small deviation.
    pub stability: Stability,
    /// Of small oscillations of the axis in the body, rad/s; 0 unless it is stable.
    pub frequency: f64,
    /// At which a small deviation grows, 1/s; 0 unless it is unstable.
    pub growth_rate: f64,
    /// ½ ω·Iω, J.
    pub energy: f64,
    /// Whether it stands for all spins about axes across one of symmetry.
    pub is_circle: bool,
}

impl GyrostatMotion {
    /// Of `body` from the state `start` at t = 0.
    ///
    /// # Errors
    /// A body without wheels, with a force or a motor, a start that is not usable, or one whose motion has too few digits.
    pub fn new(body: &Body, start: &State) -> Result<Self, NoClosedForm> {
        Self::from_point(body, body.enter(start)?)
    }

    /// From a point of the solver frame at t = 0, whose attitude has norm 1.
    ///
    /// # Errors
    /// As [`new`](Self::new).
    pub fn from_point(body: &Body, start: Point<Dd>) -> Result<Self, NoClosedForm> {
        let wheels = constant(body)?;
        let whole = Point::new(start.attitude, start.momentum_body + wheels);
        let orbit = GyrostatOrbit::new(body.rotor().moments(), wheels, whole)?;
        Ok(GyrostatMotion { body: body.clone(), wheels, orbit })
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
        TimeError::check(t, self.reach())?;
        Ok(self.body.leave(&self.point_after(Dd::from(t))))
    }

    /// Gives `each` the states at many `times` with their angular velocities, rad/s, body axes, in order: the bits of
    /// [`at`](Self::at).
    ///
    /// ```
    /// use nalgebra::Vector3;
    /// use polhode::body::{Body, Wheel};
    /// use polhode::flow::GyrostatMotion;
    /// use polhode::Inertia;
    /// let wheel = Wheel::new(Vector3::y(), 0.01, 300.0)?;
    /// let body = Body::free(Inertia::from_moments([10.0, 12.0, 15.0])?).with_wheel(wheel)?;
    /// let start = body.state(Default::default(), Vector3::new(0.1, -0.05, 0.2))?;
    /// let mut fastest = 0.0_f64;
    /// GyrostatMotion::new(&body, &start)?.each_at(&[-2.0, 0.0, 1e6], |_, omega| fastest = fastest.max(omega.norm()))?;
    /// assert!((0.2..0.4).contains(&fastest));
    /// # Ok::<(), polhode::Error>(())
    /// ```
    ///
    /// # Errors
    /// As [`at`](Self::at), of the first time that has no state; `each` is not called then.
    pub fn each_at(&self, times: &[f64], mut each: impl FnMut(State, Vector3<f64>)) -> Result<(), TimeError> {
        times.iter().try_for_each(|&t| TimeError::check(t, self.reach()))?;
        let (exit, inverse_moments) = (Exit::of(&self.body), self.body.rotor().inverse_moments());
        for &t in times {
            let x = self.point_at(t);
            each(exit.state(x.phase()), exit.omega(inverse_moments, x.momentum_body));
        }
        Ok(())
    }

    /// The largest |t| at which the phases still have digits, s.
    #[must_use]
    pub fn reach(&self) -> f64 {
        self.orbit.reach()
    }

    /// The point of the solver frame at the time `t`, s, finite and within reach.
    pub fn point_at(&self, t: f64) -> Point<f64> {
        self.point_after(Dd::from(t))
    }

    /// The same `t` s after the start, in `f64`, with the momentum I ω of the carrier.
    pub(crate) fn point_after(&self, t: Dd) -> Point<f64> {
        let whole = self.orbit.point_after(t);
        Point::new(whole.attitude, whole.momentum_body - self.wheels.map(Dd::hi))
    }

    /// The same in double-double.
    pub fn point_at_dd(&self, t: Dd) -> Point<Dd> {
        let whole = self.orbit.point_at_dd(t);
        Point::new(whole.attitude, whole.momentum_body - self.wheels)
    }

    /// Period, energy, separatrices.
    #[must_use]
    pub fn character(&self) -> GyrostatCharacter {
        let found = self.orbit.character();
        let scale = self.body.scale();
        GyrostatCharacter {
            period: found.period,
            turn_per_period: found.turn_per_period,
            energy: found.energy * scale,
            separatrix_energies: found.separatrix_energies.iter().map(|energy| energy * scale).collect(),
        }
    }

    /// All steady spins with the same |L|, by rising energy: two, four or six, or circles of them where two moments agree.
    #[must_use]
    pub fn steady_spins(&self) -> Vec<SteadySpin> {
        let norm = self.orbit.momentum_norm();
        let exit = Exit::<f64>::of(&self.body);
        let inverse = self.body.rotor().inverse_moments::<f64>();
        let found = steady_spins(self.body.rotor().moments(), self.wheels, norm);
        let of = |spin: &super::steady::SteadySpin| SteadySpin {
            omega_body: exit.omega(inverse, spin.momentum - self.wheels.map(Dd::hi)),
            rate: spin.lambda * norm.hi(),
            stability: spin.stability,
            frequency: spin.frequency,
            growth_rate: spin.growth_rate,
            energy: spin.energy * self.body.scale(),
            is_circle: spin.is_circle,
        };
        found.iter().map(of).collect()
    }
}

/// Momenta of wheels stay below this, in units in which the largest moment is about 1.
const LARGEST: f64 = 1e60;

/// The momentum of the wheels of a body on which nothing else acts.
fn constant(body: &Body) -> Result<Vec3<Dd>, NoClosedForm> {
    if let Some((torque, [from, to])) = body.wheels().iter().find_map(|wheel| wheel.motor()) {
        return Err(NoClosedForm::Motor { torque, from, to });
    }
    match (body.problem(), body.momentum_of_wheels()) {
        (Problem::Gyrostat, Some(wheels)) => {
            let wheels = wheels.at(Time::from_seconds(0.0));
            let value = body.momentum_of_wheels_at(0.0).amax();
            // fourth powers of it are taken
            if wheels.magnitude() < LARGEST {
                Ok(wheels)
            } else {
                Err(StateError::OutOfRange { quantity: "momentum of wheels", value, unit: "kg m^2/s" }.into())
            }
        }
        _ => Err(NoClosedForm::Forced { force: body.acts().unwrap_or_else(|| "no wheel".into()) }),
    }
}

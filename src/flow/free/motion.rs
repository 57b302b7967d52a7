//! The motion of the free rigid body at any time.

use std::sync::OnceLock;

use nalgebra::{Matrix3, UnitQuaternion, Vector3};

use super::character::{AtRest, Character, Mode};
use super::derivative::{Derivative, StateDerivative};
use super::orbit::FreeOrbit;
use super::pure_spin::PureSpin;
use crate::body::{Body, Exit, Phase, Point, State, StateError};
use crate::flow::DerivativeError;
use crate::flow::reach::{MOST_RADIANS, TimeError};
use crate::inertia::Inertia;
use crate::num::{Dd, Instructions, Precise};
use crate::rotation::Vec3;

/// The motion of one free body from one start. Its constants are computed once; then every time costs the same.
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
/// # Ok::<(), polhode::Error>(())
/// ```
#[derive(Clone, Debug)]
#[must_use]
pub struct FreeMotion {
    body: Body,
    orbit: FreeOrbit,
    reach: f64,
    derivative: OnceLock<Box<Derivative>>,
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
        let body = Body::free(inertia.clone());
        let start = body.enter_omega(attitude.into(), omega_body.into())?;
        Ok(Self::of(body, start))
    }

    /// From a state at t = 0, body axes.
    ///
    /// # Errors
    /// As [`from_omega`](Self::from_omega).
    pub fn from_state(inertia: &Inertia, start: &State) -> Result<Self, StateError> {
        let body = Body::free(inertia.clone());
        let start = body.enter(start)?;
        Ok(Self::of(body, start))
    }

    /// From a point of the solver frame at t = 0, whose attitude has norm 1, as those of [`Body::enter`] have. Any other norm
    /// is that of the attitudes at all times.
    pub fn from_point(inertia: &Inertia, start: Point<Dd>) -> Self {
        Self::of(Body::free(inertia.clone()), start)
    }

    /// [From points](Self::from_point) of several bodies: each has the bits that it has alone, and they are worked out side by side.
    pub(crate) fn from_points(starts: &[(&Inertia, Point<Dd>)]) -> Vec<Self> {
        let bodies: Vec<Body> = starts.iter().map(|&(inertia, _)| Body::free(inertia.clone())).collect();
        let moving = bodies.iter().zip(starts).map(|(body, &(_, start))| (body.rotor().moments(), start));
        let orbits = FreeOrbit::of_each(&moving.collect::<Vec<_>>());
        bodies.into_iter().zip(orbits).map(|(body, orbit)| Self::along(body, orbit)).collect()
    }

    /// Of a `body` on which nothing acts.
    fn of(body: Body, start: Point<Dd>) -> Self {
        let orbit = FreeOrbit::new(body.rotor().moments(), start);
        Self::along(body, orbit)
    }

    fn along(body: Body, orbit: FreeOrbit) -> Self {
        let moments: Vec3<Dd> = body.rotor().moments();
        // no part of the phase runs faster than G/I_l
        let reach = MOST_RADIANS * (moments[moments.ascending()[0]] / orbit.momentum_norm()).to_f64();
        FreeMotion { body, orbit, reach, derivative: OnceLock::new() }
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

    /// The state at time `t` (s, of either sign) with its derivative by the state at t = 0 and by the inertia tensor, of a body of
    /// any shape and any motion. The first call computes constants; then every call takes the same time, at any `t`.
    ///
    /// ```
    /// use nalgebra::{UnitQuaternion, Vector3};
    /// use polhode::flow::{FreeMotion, TurnAxes};
    /// use polhode::inertia::Inertia;
    /// let (racket, omega) = (Inertia::from_moments([1.0, 2.0, 3.0])?, Vector3::new(0.4, 1.0, -0.3));
    /// let motion = FreeMotion::from_omega(&racket, UnitQuaternion::identity(), omega)?;
    /// let later = motion.at_with_derivative(100.0)?;
    /// assert_eq!(later.state(), &motion.at(100.0)?);
    /// // what a change of 1e-6 rad/s about the first axis makes of the angular velocity
    /// let change = later.by_omega(TurnAxes::Space).fixed_view::<3, 1>(3, 3) * 1e-6;
    /// let other = FreeMotion::from_omega(&racket, UnitQuaternion::identity(), omega + Vector3::x() * 1e-6)?;
    /// assert!((other.omega_at(100.0)? - motion.omega_at(100.0)? - change).norm() < 1e-3 * change.norm());
    /// # Ok::<(), polhode::Error>(())
    /// ```
    ///
    /// # Errors
    /// As [`at`](Self::at), and a derivative that leaves the range of a double: on the separatrix alone, where it grows for ever, after some
    /// 355 e-folds. There [`at_with_scaled_derivative`](Self::at_with_scaled_derivative) gives it.
    pub fn at_with_derivative(&self, t: f64) -> Result<StateDerivative, DerivativeError> {
        self.check_time(t)?;
        self.derivative().at(&self.body, t, &self.point_at(t)).ok_or(DerivativeError::OutOfRange { t })
    }

    /// The rotation vector in space by the momentum at the start, both in the solver frame.
    pub(super) fn turn_by_momentum(&self, t: f64) -> Matrix3<f64> {
        let columns = self.derivative().columns(t, &self.point_at(t));
        Matrix3::from_fn(|row, column| columns.rotation[column][row])
    }

    /// The rate of the fastest part of the phase, rad/s.
    pub(super) fn fastest_rate(&self) -> f64 {
        MOST_RADIANS / self.reach
    }

    /// I⁻¹ in body axes.
    pub(super) fn inverse_inertia(&self) -> Matrix3<f64> {
        self.derivative().inverse_inertia()
    }

    pub(super) fn derivative(&self) -> &Derivative {
        self.derivative
            .get_or_init(|| Box::new(Derivative::new(&self.body, self.orbit.variation(), self.orbit.start())))
    }

    /// The largest |t|, s, at which the phase still has correct digits, some 2⁹⁶ rad; infinite at rest.
    #[must_use]
    pub fn reach(&self) -> f64 {
        self.reach
    }

    /// Whether there is a state at the time `t`, s.
    pub(crate) fn check_time(&self, t: f64) -> Result<(), TimeError> {
        TimeError::check(t, self.reach)
    }

    /// The states at many `times`, body axes: the same bits as [`at`](Self::at), several times as fast.
    ///
    /// ```
    /// use nalgebra::{UnitQuaternion, Vector3};
    /// use polhode::flow::FreeMotion;
    /// use polhode::inertia::Inertia;
    /// let racket = Inertia::from_moments([1.0, 2.0, 3.0])?;
    /// let motion = FreeMotion::from_omega(&racket, UnitQuaternion::identity(), Vector3::new(0.4, 1.0, -0.3))?;
    /// let states = motion.at_many(&[-2.0, 0.0, 1e6])?;
    /// assert_eq!(states[2], motion.at(1e6)?);
    /// # Ok::<(), polhode::Error>(())
    /// ```
    ///
    /// # Errors
    /// As [`at`](Self::at), of the first time that has no state.
    pub fn at_many(&self, times: &[f64]) -> Result<Vec<State>, TimeError> {
        times.iter().try_for_each(|&t| TimeError::check(t, self.reach))?;
        let (mut states, exit) = (Vec::with_capacity(times.len()), Exit::of(&self.body));
        self.phases_at(times, Instructions::Widest, |_, x| states.push(exit.state(x)));
        Ok(states)
    }

    /// Gives `each` the states at many `times` with their angular velocities, rad/s, body axes, in order: the bits of
    /// [`at`](Self::at) and [`omega_at`](Self::omega_at).
    ///
    /// ```
    /// use nalgebra::{UnitQuaternion, Vector3};
    /// use polhode::flow::FreeMotion;
    /// use polhode::inertia::Inertia;
    /// let racket = Inertia::from_moments([1.0, 2.0, 3.0])?;
    /// let motion = FreeMotion::from_omega(&racket, UnitQuaternion::identity(), Vector3::new(0.4, 1.0, -0.3))?;
    /// let mut fastest = 0.0_f64;
    /// motion.each_at(&[-2.0, 0.0, 1e6], |_, omega| fastest = fastest.max(omega.norm()))?;
    /// assert!(fastest >= motion.omega_at(1e6)?.norm());
    /// # Ok::<(), polhode::Error>(())
    /// ```
    ///
    /// # Errors
    /// As [`at_many`](Self::at_many); `each` is not called then.
    pub fn each_at(&self, times: &[f64], mut each: impl FnMut(State, Vector3<f64>)) -> Result<(), TimeError> {
        times.iter().try_for_each(|&t| TimeError::check(t, self.reach))?;
        let (exit, inverse_moments) = (Exit::of(&self.body), self.body.rotor().inverse_moments());
        self.phases_at(times, Instructions::Widest, |_, x| {
            each(exit.state(x), exit.omega(inverse_moments, x.momentum_body));
        });
        Ok(())
    }

    /// Gives `each` attitude and momentum in the solver frame at `times`, with their numbers; times are finite and within reach.
    pub(crate) fn phases_at(&self, times: &[f64], by: Instructions, each: impl FnMut(usize, Phase<f64>)) {
        self.orbit.at_many(times, by, each);
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
        self.orbit.character()
    }

    /// The axis of a steady spin, and whether it is stable; `None` of a body at rest and of one that tumbles.
    ///
    /// ```
    /// use nalgebra::{UnitQuaternion, Vector3};
    /// use polhode::flow::{FreeMotion, Stability};
    /// use polhode::inertia::Inertia;
    /// let racket = Inertia::from_moments([1.0, 2.0, 3.0])?;
    /// let motion = FreeMotion::from_omega(&racket, UnitQuaternion::identity(), Vector3::new(0.0, -3.0, 0.0))?;
    /// let spin = motion.pure_spin().ok_or("it is steady")?;
    /// assert_eq!((spin.rank, spin.stability, spin.axis.y), (1, Stability::Unstable, -1.0));
    /// assert!((spin.growth_rate - 3.0 / 3_f64.sqrt()).abs() < 1e-15); // e-fold in 0.58 s
    /// # Ok::<(), polhode::Error>(())
    /// ```
    #[must_use]
    pub fn pure_spin(&self) -> Option<PureSpin> {
        let character = self.character().ok().filter(|character| character.mode == Mode::Steady)?;
        let start = self.point_at_dd(Dd::ZERO);
        let omega = self.body.omega_of(&start) / character.spin;
        Some(PureSpin::of(self.body.rotor().moments(), start.momentum_body, omega.normalize()))
    }

    /// How often the momentum along the axis of the middle moment changes sign between the start and time `t` (s).
    #[must_use]
    pub fn flips(&self, t: Dd) -> u64 {
        self.orbit.flips(t)
    }

    /// The point of the solver frame at time `t` (s), finite and within [`reach`](Self::reach).
    ///
    /// The quaternion is the continuous lift from the start: it does not jump from `q` to `−q`.
    #[inline]
    pub fn point_at(&self, t: f64) -> Point<f64> {
        self.point_after(Dd::from(t))
    }

    /// The same at a time in double-double.
    #[inline]
    pub(crate) fn point_after(&self, t: Dd) -> Point<f64> {
        self.orbit.at(t)
    }

    /// The same in double-double, by an independent form of the solution.
    pub fn point_at_dd(&self, t: Dd) -> Point<Dd> {
        self.orbit.at_dd(t)
    }
}

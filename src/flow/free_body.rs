//! The free rigid body: its motion at any time, and the same as a flow for splittings.

use nalgebra::{UnitQuaternion, Vector3};
use thiserror::Error;

use super::Flow;
use super::circulation::{Circulation, ascending, cast, reduce};
use crate::body::{Body, Inertia, State, StateError};
use crate::num::{Dd, Expansion, Precise, Real};
use crate::rotation::{Quat, Vec3};

/// The motion of one free body from one start: constants worked out once, then any time in O(1).
///
/// ```
/// use nalgebra::{UnitQuaternion, Vector3};
/// use polhode::body::Inertia;
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
    start: State<Dd>,
    kind: Kind<Dd>,
}

/// The time asked for is not a number.
#[derive(Clone, Copy, Debug, PartialEq, Error)]
#[error("time {t} s is not a finite number")]
pub struct TimeError {
    /// The time, s.
    pub t: f64,
}

#[derive(Clone, Debug)]
enum Kind<S> {
    /// No momentum: the attitude stays.
    Rest,
    /// Momentum fixed in the body, which turns about it at the given rate: a sphere, a pure spin.
    Steady { axis: Vec3<S>, rate: S },
    /// The momentum moves along its polhode.
    Circulating(Box<Circulation<S>>),
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
        Ok(Self::new(&body, start))
    }

    /// From a state at t = 0, body axes.
    ///
    /// # Errors
    /// As [`from_omega`](Self::from_omega).
    pub fn from_state(inertia: &Inertia, start: &State<f64>) -> Result<Self, StateError> {
        let body = Body::free(inertia.clone());
        let start = body.enter(start)?;
        Ok(Self::new(&body, start))
    }

    /// From a state at t = 0 as kernels see it.
    pub fn new(body: &Body, start: State<Dd>) -> Self {
        let (moments, m) = (body.moments(), start.momentum_body);
        let kind = match Kind::of(moments, m, || separatrix_distance(moments, m)) {
            Kind::Circulating(circulation) => Kind::Circulating(Box::new(circulation.with_period())),
            steady => steady,
        };
        FreeMotion { body: body.clone(), start, kind }
    }

    /// The body that moves.
    pub fn body(&self) -> &Body {
        &self.body
    }

    /// The state at time `t` (s, of either sign), body axes.
    ///
    /// # Errors
    /// A time that is not finite.
    pub fn at(&self, t: f64) -> Result<State<f64>, TimeError> {
        if !t.is_finite() {
            return Err(TimeError { t });
        }
        Ok(self.body.leave(&self.inside_at::<f64>(Dd::from(t))))
    }

    /// How often the momentum along the axis of the middle moment changes sign between the start and time `t` (s).
    pub fn flips(&self, t: Dd) -> u64 {
        match &self.kind {
            Kind::Circulating(polhode) => polhode.flips(t),
            Kind::Rest | Kind::Steady { .. } => 0,
        }
    }

    /// The state at time `t` as kernels see it, in `f64` or double-double; the phases are reduced in
    /// double-double in either case. The quaternion is the continuous lift from the start: it does not jump from
    /// `q` to `−q`.
    pub fn inside_at<S: Precise>(&self, t: Dd) -> State<S> {
        let (turn, momentum_body) = self.kind.at::<S>(t, self.start.momentum_body);
        let attitude = Quat::from_components(self.start.attitude.components().map(S::from_dd)) * turn;
        State { attitude, momentum_body }
    }
}

impl<S: Precise> Kind<S> {
    /// `scaled_delta_mu` gives I_l I_h Δ_μ of the [`Circulation`].
    fn of(moments: Vec3<S>, m: Vec3<S>, scaled_delta_mu: impl FnOnce() -> S) -> Self {
        let squared = m.norm_squared();
        if squared.magnitude() == 0.0 {
            return Kind::Rest;
        }
        let norm = squared.sqrt();
        match Circulation::of(moments, m, norm, scaled_delta_mu()) {
            Some(circulation) => Kind::Circulating(Box::new(circulation)),
            None => {
                let one = S::of(1.0);
                let omega = Vec3([m[0] / moments[0], m[1] / moments[1], m[2] / moments[2]]);
                Kind::Steady { axis: m * (one / norm), rate: m.dot(omega) / norm }
            }
        }
    }

    /// The turn since the start and the momentum at time `t`; `m` is that at the start.
    fn at<T: Precise>(&self, t: S, m: Vec3<S>) -> (Quat<T>, Vec3<T>) {
        match self {
            Kind::Rest => (Quat::identity(), Vec3::zero()),
            Kind::Steady { axis, rate } => {
                let angle = reduce(*rate * t, S::from_dd(Dd::TAU * Dd::of(2.0)));
                let (sin, cos) = cast::<S, T>(angle * S::of(0.5)).sin_cos();
                (Quat::new(cos, Vec3(axis.0.map(cast)) * sin), Vec3(m.0.map(cast)))
            }
            Kind::Circulating(polhode) => polhode.at::<T>(t),
        }
    }
}

/// `I_l I_h Δ_μ = m_h² I_l (I_h − I_μ) − m_l² I_h (I_μ − I_l)`, exactly, then rounded once.
///
/// Its relative error is twice that of the period near the separatrix, where the two terms agree in all digits:
/// nothing less than the exact value will do.
fn separatrix_distance(i: Vec3<Dd>, m: Vec3<Dd>) -> Dd {
    let [l, mu, h] = ascending(i);
    let term = |j: usize, other: usize, higher: usize, lower: usize| {
        let m = Expansion::from(m[j]);
        let difference = &Expansion::from(i[higher]) - &Expansion::from(i[lower]);
        &(&(&m * &m) * &Expansion::from(i[other])) * &difference
    };
    (&term(h, l, h, mu) - &term(l, h, mu, l)).to_dd()
}

/// The exact flow of the free body, set up anew from the state at each call, in the state's own scalar.
///
/// The drift between the kicks of a splitting. Only products and differences of `S` go into it, so very close to
/// the separatrix a long step loses what [`FreeMotion`] keeps; a step below a quarter period loses nothing.
#[derive(Clone, Copy, Debug)]
pub struct FreeBody<S> {
    moments: Vec3<S>,
}

impl<S: Precise> FreeBody<S> {
    /// The flow of `body` without its torque.
    pub fn new(body: &Body) -> Self {
        FreeBody { moments: body.moments() }
    }
}

impl<S: Precise> Flow<S> for FreeBody<S> {
    fn flow(&self, t: S, x: &mut State<S>) {
        let (i, m) = (self.moments, x.momentum_body);
        let [l, mu, h] = ascending(i);
        let kind =
            Kind::of(i, m, || m[h] * m[h] * i[l] * (i[h] - i[mu]) - m[l] * m[l] * i[h] * (i[mu] - i[l]));
        let kind = match kind {
            Kind::Circulating(circulation) if !circulation.is_near(t) => {
                Kind::Circulating(Box::new(circulation.with_period()))
            }
            kind => kind,
        };
        let (turn, momentum_body) = kind.at::<S>(t, m);
        *x = State { attitude: x.attitude * turn, momentum_body };
    }
}

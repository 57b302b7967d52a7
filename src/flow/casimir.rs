//! The turn about the momentum: the exact flow of |m|².

use super::Flow;
use crate::body::{Point, Rotor, Time};
use crate::num::Real;
use crate::rotation::{Quat, Vec3};

/// The exact flow of the energy of a ball, `H = |m|²/(2 I)`.
///
/// Φ_t: the body turns about m by the angle |m| t/I; m stays, in the body and in space. It commutes with every flow
/// of a function of m. t in seconds, I and m in the units of the [solver frame](crate::body::Rotor).
///
/// ```
/// use nalgebra::{UnitQuaternion, Vector3};
/// use polhode::body::{Body, Time};
/// use polhode::flow::{Casimir, Flow};
/// use polhode::inertia::Inertia;
/// let body = Body::free(Inertia::from_moments([1.0, 2.0, 3.0])?);
/// let start = body.state(UnitQuaternion::identity(), Vector3::new(0.0, 0.0, 2.0))?; // |m| = 6
/// let mut x = body.enter(&start)?.to_f64();
/// let [_, ball, _] = Casimir::of(&body.rotor()); // I = 2
/// ball.flow(Time::from_seconds(0.0), 0.5, &mut x);
/// let end = body.leave(&x);
/// assert_eq!(end.momentum(), start.momentum());
/// assert!((end.rotation().angle_to(&start.rotation()) - 1.5).abs() < 1e-15);
/// # Ok::<(), polhode::Error>(())
/// ```
#[derive(Clone, Copy, Debug)]
pub struct Casimir<S> {
    inverse_moment: S,
}

impl<S: Real> Casimir<S> {
    /// The turns of the balls that have one of the three moments of the body each.
    #[must_use]
    pub fn of(rotor: &Rotor) -> [Self; 3] {
        rotor.inverse_moments().0.map(Casimir::new)
    }

    /// The turn with the reciprocal moment of inertia `inverse_moment`, in the scale of the solver frame.
    pub fn new(inverse_moment: S) -> Self {
        Casimir { inverse_moment }
    }
}

impl<S: Real> Casimir<S> {
    /// The quaternion of the body's turn in the time `t`, less one.
    #[inline(always)]
    pub(super) fn turn(&self, t: S, m: Vec3<S>) -> Quat<S> {
        // of half of the half angle, from its square: 1 − cos without cancellation, and no root
        let rate = self.quarter_rate(t);
        quarters(rate, m, quarter_squared(rate, m).sinc_cos_of_root())
    }

    /// A quarter of the angle in the time `t` over |m|.
    #[inline]
    pub(crate) fn quarter_rate(&self, t: S) -> S {
        t * self.inverse_moment * S::of(0.25)
    }
}

/// The square of a quarter of the angle.
#[inline(always)]
pub(crate) fn quarter_squared<S: Real>(rate: S, m: Vec3<S>) -> S {
    m.norm_squared() * (rate * rate)
}

/// The quaternion of the turn, less one, by `sin x / x` and `cos x` of a quarter x of the angle.
#[inline(always)]
pub(crate) fn quarters<S: Real>(rate: S, m: Vec3<S>, (sinc, cos): (S, S)) -> Quat<S> {
    let twice = sinc + sinc;
    Quat::new(-(twice * sinc * quarter_squared(rate, m)), m * (twice * cos * rate))
}

impl<S: Real> Flow<S> for Casimir<S> {
    #[inline]
    fn flow(&self, _: Time, t: S, x: &mut Point<S>) {
        x.add_attitude(x.attitude * self.turn(t, x.momentum_body));
    }
}

//! The Euler step of game engines, `semi-implicit-euler`.

use crate::body::{Field, Point, Problem, Rotor, Time};
use crate::method::runge_kutta::{Equations, claims};
use crate::method::{Claimed, Claims, Map, Method};
use crate::num::{Dd, Real};

/// Semi-implicit Euler as game engines write it: `m' = m + h (m × ω + τ)`, then `q' = norm(q + h/2 q ω')`.
///
/// ```
/// use polhode::body::Problem;
/// use polhode::method::{Claimed, SemiImplicitEuler};
/// let claims = SemiImplicitEuler.claims(Problem::Free).unwrap();
/// assert_eq!((claims.order, claims.symmetric, claims.kept.momentum_norm), (Some(1), false, false));
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct SemiImplicitEuler;

/// A prepared [`SemiImplicitEuler`].
#[derive(Clone, Debug)]
pub struct SemiImplicitEulerMap<S, F> {
    h: S,
    equations: Equations<S, F>,
}

impl Claimed for SemiImplicitEuler {
    fn name(&self) -> String {
        "semi-implicit-euler".into()
    }
    fn claims(&self, _: Problem) -> Option<Claims> {
        claims(1, true, 1, "common in game engines; momentum first, attitude with the new one")
    }
}

impl<S: Real> Method<S> for SemiImplicitEuler {
    type Map<F: Field<S>> = SemiImplicitEulerMap<S, F>;
    fn map<F: Field<S>>(&self, h: Dd, rotor: &Rotor, field: &F) -> SemiImplicitEulerMap<S, F> {
        SemiImplicitEulerMap { h: S::from_dd(h), equations: Equations::new(rotor, field) }
    }
}

impl<S: Real, F: Field<S>> Map<S> for SemiImplicitEulerMap<S, F> {
    #[inline]
    fn apply(&mut self, at: Time, point: &mut Point<S>) {
        let inverse = self.equations.inverse_moments;
        let mut x = point.phase();
        let omega = x.momentum_body.times(inverse);
        x.momentum_body = x.momentum_body + self.equations.momentum_rate(at, &x, omega) * self.h;
        let omega = x.momentum_body.times(inverse);
        x.attitude = (x.attitude + x.attitude.rate(omega) * self.h).normalized();
        point.set_phase(x);
    }
}

//! Euler's explicit method, `explicit-euler`.

use crate::body::{Field, Point, Problem, Rotor, Time};
use crate::method::runge_kutta::{Equations, claims};
use crate::method::{Claimed, Claims, Map, Method};
use crate::num::{Dd, Real};

/// Explicit Euler: `x + h k₁`. Spirals outwards at every step.
///
/// ```
/// use nalgebra::{UnitQuaternion, Vector3};
/// use polhode::body::{Body, Conserved};
/// use polhode::inertia::Inertia;
/// use polhode::method::ExplicitEuler;
/// use polhode::run::Run;
/// let body = Body::free(Inertia::from_moments([1.0, 2.0, 3.0])?);
/// let start = body.state(UnitQuaternion::identity(), Vector3::new(0.4, 1.0, -0.3))?;
/// let end = Run::new(&ExplicitEuler, &body, &start, 0.1)?.advance_to(100)?;
/// assert!(end.worst.of(Conserved::Energy).is_some_and(|error| error > 0.1));
/// # Ok::<(), polhode::Error>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ExplicitEuler;

/// A prepared [`ExplicitEuler`].
#[derive(Clone, Debug)]
pub struct ExplicitEulerMap<S, F> {
    h: S,
    equations: Equations<S, F>,
}

impl Claimed for ExplicitEuler {
    fn name(&self) -> String {
        "explicit-euler".into()
    }
    fn claims(&self, _: Problem) -> Option<Claims> {
        claims(1, false, 1, "Euler 1768; Hairer, Norsett and Wanner, Solving ODEs I, (I.7.3)")
    }
}

impl<S: Real> Method<S> for ExplicitEuler {
    type Map<F: Field<S>> = ExplicitEulerMap<S, F>;
    fn map<F: Field<S>>(&self, h: Dd, rotor: &Rotor, field: &F) -> ExplicitEulerMap<S, F> {
        ExplicitEulerMap { h: S::from_dd(h), equations: Equations::new(rotor, field) }
    }
}

impl<S: Real, F: Field<S>> Map<S> for ExplicitEulerMap<S, F> {
    #[inline]
    fn apply(&mut self, at: Time, point: &mut Point<S>) {
        let x = point.phase();
        point.set_phase(x + self.equations.rate(at, &x) * self.h);
    }
}

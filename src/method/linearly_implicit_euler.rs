//! `linearly-implicit-euler`: the step of MuJoCo's integrators `implicit` and `implicitfast`.

use super::{Claimed, Claims, Cost, Kept, Map, Method};
use crate::body::{Field, Point, Problem, Rotor, Time};
use crate::num::{Dd, Real};
use crate::rotation::{Quat, Vec3};

/// Euler's step of the momentum with the derivative of the gyroscopic term on the left side, and a turn by the new angular
/// velocity.
///
/// Φ_h: `(1 − h J) k = m × ω + τ` with ω = I⁻¹ m and `J δ = δ × ω + m × I⁻¹δ`, the derivative of m × ω; then `m' = m + h k` and
/// `q' = q ∘ exp(h I⁻¹m')`. The integrators `implicit` and `implicitfast` of MuJoCo 4.0.0 step a free body so; its documentation
/// calls it implicit in velocity (Computation, Numerical integration). The torque is that of the start of the step.
/// Keeps |q|; energy and |m| fall, to first order in h.
///
/// It is not in the [catalogue](super::catalogue()), which shows each kind of step once, and is found by its name.
///
/// ```
/// use polhode::body::Problem;
/// use polhode::method::{Claimed, method};
/// let claims = method("linearly-implicit-euler")?.claims(Problem::Free).unwrap();
/// assert_eq!((claims.order, claims.kept.norm, claims.kept.momentum_norm), (Some(1), true, false));
/// # Ok::<(), polhode::method::UnknownMethod>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct LinearlyImplicitEuler;

/// A prepared [`LinearlyImplicitEuler`].
#[derive(Clone, Debug)]
pub struct LinearlyImplicitEulerMap<S, F> {
    h: S,
    inverse_moments: Vec3<S>,
    field: F,
}

impl Claimed for LinearlyImplicitEuler {
    fn name(&self) -> String {
        "linearly-implicit-euler".into()
    }
    fn claims(&self, _: Problem) -> Option<Claims> {
        let kept = Kept { norm: true, ..Kept::NOTHING };
        let cost = Cost::right_sides(1) + Cost::turns(1);
        Some(Claims::new(Some(1), kept, cost, "MuJoCo 4.0.0, implicit and implicitfast"))
    }
}

impl<S: Real> Method<S> for LinearlyImplicitEuler {
    type Map<F: Field<S>> = LinearlyImplicitEulerMap<S, F>;
    fn map<F: Field<S>>(&self, h: Dd, rotor: &Rotor, field: &F) -> LinearlyImplicitEulerMap<S, F> {
        LinearlyImplicitEulerMap {
            h: S::from_dd(h),
            inverse_moments: rotor.inverse_moments(),
            field: field.clone(),
        }
    }
}

impl<S: Real, F: Field<S>> Map<S> for LinearlyImplicitEulerMap<S, F> {
    fn apply(&mut self, at: Time, x: &mut Point<S>) {
        let m = x.momentum_body;
        let omega = m.times(self.inverse_moments);
        let mut rate = m.cross(omega);
        if F::ACTS {
            rate = rate + self.field.torque(at, x.attitude, omega);
        }
        let [a, b, c] = [0, 1, 2].map(|axis| {
            let e = Vec3::unit(axis);
            e - (e.cross(omega) + m.cross(e.times(self.inverse_moments))) * self.h
        });
        // Cramer's rule
        let volume = a.dot(b.cross(c));
        let rate = Vec3([rate.dot(b.cross(c)), a.dot(rate.cross(c)), a.dot(b.cross(rate))]);
        let new = m + rate * (self.h / volume);
        x.momentum_body = new;
        let turn = Quat::exponential(new.times(self.inverse_moments) * self.h);
        x.attitude = (x.attitude * turn).normalized();
    }
}

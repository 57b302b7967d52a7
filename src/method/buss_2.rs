//! `buss-2` and `buss-2-augmented`: one turn a step about a mean angular velocity.

use super::{Claimed, Claims, Cost, Kept, Map, Method};
use crate::body::{Field, Point, Problem, Rotor, Time};
use crate::method::solve::impulse::turn_with_impulse;
use crate::num::{Dd, Real};
use crate::rotation::{Quat, Vec3};

/// Buss's methods of second order, plain and augmented.
///
/// Φ_h: `Q' = Q exp(h ω̄)`, `ω̄ = ω + h/2 ω̇`, `ω̇ = I⁻¹(m × ω + τ)`, with L constant in space. The augmented method takes
/// `ω̄ = ω + h/2 ω̇ + h²/12 ω̇ × ω`: the local error of the turn is then h³/6 ω̈, with ω̈ in space. Under a torque,
/// L' = L + h/2 (τ + τ') in space, τ' at the new attitude. Both keep L. The energy of both drifts, in free motion that of the
/// augmented method 4/3 times as fast, to leading order.
///
/// Reference: S. R. Buss, J. Comput. Phys. 164 (2000) 377. JSBSim turns vehicles by the augmented method
/// (`FGQuatODEIntegration::integrate`, `eBuss2`).
///
/// ```
/// use polhode::body::Problem;
/// use polhode::method::{Buss, Claimed};
/// for augmented in [false, true] {
///     let claims = Buss { augmented }.claims(Problem::Free).unwrap();
///     assert_eq!((claims.order, claims.kept.momentum_space), (Some(2), true));
/// }
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Buss {
    /// Whether the turn takes the term `h²/12 ω̇ × ω`.
    pub augmented: bool,
}

/// A prepared [`Buss`].
#[derive(Clone, Debug)]
pub struct BussMap<S, F> {
    h: S,
    /// h²/12 in the augmented method, s².
    share: Option<S>,
    whole: Dd,
    inverse_moments: Vec3<S>,
    field: F,
}

impl Claimed for Buss {
    fn name(&self) -> String {
        if self.augmented { "buss-2-augmented" } else { "buss-2" }.into()
    }
    fn claims(&self, problem: Problem) -> Option<Claims> {
        let kept = Kept::momentum_alone(problem);
        let cost = Cost::right_sides(if problem == Problem::Free { 1 } else { 2 }) + Cost::turns(1);
        Some(Claims::new(Some(2), kept, cost, "Buss, J. Comput. Phys. 164 (2000) 377"))
    }
}

impl<S: Real> Method<S> for Buss {
    type Map<F: Field<S>> = BussMap<S, F>;
    fn map<F: Field<S>>(&self, h: Dd, rotor: &Rotor, field: &F) -> BussMap<S, F> {
        let share = self.augmented.then(|| S::from_dd(h * h / Dd::of(12.0)));
        let (inverse_moments, field) = (rotor.inverse_moments(), field.clone());
        BussMap { h: S::from_dd(h), share, whole: h, inverse_moments, field }
    }
}

impl<S: Real, F: Field<S>> Map<S> for BussMap<S, F> {
    fn apply(&mut self, at: Time, x: &mut Point<S>) {
        let (h, half, m) = (self.h, self.h * S::of(0.5), x.momentum_body);
        let omega = m.times(self.inverse_moments);
        let torque = if F::ACTS { self.field.torque(at, x.attitude, omega) } else { Vec3::zero() };
        let acceleration = (m.cross(omega) + torque).times(self.inverse_moments);
        let mut mean = omega + acceleration * half;
        if let Some(share) = self.share {
            mean = mean + acceleration.cross(omega) * share;
        }
        let turn = Quat::exponential(mean * h);
        let impulse = if F::ACTS {
            let omega = turn.rotate_back(m + torque * h).times(self.inverse_moments);
            let last = self.field.torque(at.later(self.whole), x.attitude * turn, omega);
            (torque + turn.rotate(last)) * half
        } else {
            Vec3::zero()
        };
        turn_with_impulse(x, turn, impulse);
    }
}

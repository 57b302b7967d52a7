//! `richardson`: the step of LAMMPS's rigid bodies: one Richardson extrapolation of the attitude between half kicks.

use super::{Claimed, Claims, Cost, Kept, Map, Method};
use crate::body::{Field, Point, Problem, Rotor, Time};
use crate::method::solve::impulse::turn_with_impulse;
use crate::num::{Dd, Real};
use crate::rotation::{Quat, Vec3};

/// Richardson's extrapolation of Euler's step of the attitude, L constant, as LAMMPS takes it (fix nve/asphere, fix rigid).
///
/// Φ_h: half a kick; then, with n(q) = q/|q| and ω in space, `q_f = n(q + h/2 ω q)`, `q_h = n(q + h/4 ω q)`,
/// `q_h' = n(q_h + h/4 ω_h q_h)` with ω_h of the attitude q_h and the same L, `q' = n(2 q_h' − q_f)`; then half a kick at q'.
/// Keeps L in free motion; the energy drifts. `MathExtra::richardson` of LAMMPS (Thompson et al., Comput. Phys. Commun. 271
/// (2022) 108171).
///
/// ```
/// use polhode::body::Problem;
/// use polhode::method::{Claimed, Energy, Richardson};
/// let claims = Richardson.claims(Problem::Free).unwrap();
/// assert_eq!((claims.order, claims.kept.momentum_space, claims.kept.energy), (Some(2), true, Energy::Drifts));
/// assert!(Richardson.claims(Problem::Torque).is_none());
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Richardson;

/// A prepared [`Richardson`].
#[derive(Clone, Debug)]
pub struct RichardsonMap<S, F> {
    half: S,
    whole: Dd,
    inverse_moments: Vec3<S>,
    field: F,
}

impl Claimed for Richardson {
    fn name(&self) -> String {
        "richardson".into()
    }
    fn claims(&self, problem: Problem) -> Option<Claims> {
        let free = problem == Problem::Free;
        let kept =
            Kept { momentum_norm: free, momentum_space: free, momentum_z: true, norm: true, ..Kept::NOTHING };
        let kicks = Cost::kicks(if free { 0 } else { 2 });
        let claims =
            Claims::new(Some(2), kept, Cost::right_sides(2) + kicks, "LAMMPS, MathExtra::richardson");
        matches!(problem, Problem::Free | Problem::Linear | Problem::Potential).then_some(claims)
    }
}

impl<S: Real> Method<S> for Richardson {
    type Map<F: Field<S>> = RichardsonMap<S, F>;
    fn map<F: Field<S>>(&self, h: Dd, rotor: &Rotor, field: &F) -> RichardsonMap<S, F> {
        RichardsonMap {
            half: S::from_dd(h * 0.5),
            whole: h,
            inverse_moments: rotor.inverse_moments(),
            field: field.clone(),
        }
    }
}

impl<S: Real, F: Field<S>> RichardsonMap<S, F> {
    #[inline]
    fn kick(&self, at: Time, x: &mut Point<S>) {
        if F::ACTS {
            x.add_momentum(self.field.torque(at, x.attitude, Vec3::zero()) * self.half);
        }
    }

    /// The turn of a free body with the momentum m, in the axes that it begins with.
    #[inline]
    fn turn(&self, m: Vec3<S>) -> Quat<S> {
        let quarter = self.half * S::of(0.5);
        let omega = m.times(self.inverse_moments);
        let one = S::of(1.0);
        let whole = Quat::new(one, omega * self.half).normalized();
        let halfway = Quat::new(one, omega * quarter).normalized();
        let omega = halfway.rotate(halfway.rotate_back(m).times(self.inverse_moments));
        let twice = (halfway + Quat::new(S::of(0.0), omega * quarter) * halfway).normalized();
        (twice * S::of(2.0) - whole).normalized()
    }
}

impl<S: Real, F: Field<S>> Map<S> for RichardsonMap<S, F> {
    fn apply(&mut self, at: Time, x: &mut Point<S>) {
        self.kick(at, x);
        turn_with_impulse(x, self.turn(x.momentum_body), Vec3::zero());
        self.kick(at.later(self.whole), x);
    }
}

//! `mujoco-rk4`: the Runge–Kutta step of MuJoCo.

use super::{Claimed, Claims, Cost, Kept, Map, Method};
use crate::body::{Field, Point, Problem, Rotor, Time};
use crate::num::{Dd, Real};
use crate::rotation::{Quat, Vec3};

/// The classical Runge–Kutta method on the momentum in the body, and in the algebra on the attitude, as MuJoCo takes it.
///
/// Φ_h: `m' = m + h/6 (f₁ + 2f₂ + 2f₃ + f₄)` with f_i = m_i × ω_i + τ; `q' = q ∘ exp(h/6 (k₁ + 2k₂ + 2k₃ + k₄))` with
/// `k_i = ω_i + ½ u_i × ω_i + ¹⁄₁₂ u_i × (u_i × ω_i)`, u_i the turn of the stage: `u₂ = h/2 k₁`, `u₃ = h/2 k₂`, `u₄ = h k₃`
/// (Munthe-Kaas, Appl. Numer. Math. 29 (1999) 115). Found from the motions that MuJoCo 4.0.0 computes, which it reproduces up
/// to rounding (tests/programs.rs). Keeps |q|; [`LieGroup::RKMK_4`](super::LieGroup::RKMK_4) keeps L too.
///
/// ```
/// use polhode::body::Problem;
/// use polhode::method::{Claimed, MujocoRk4};
/// let claims = MujocoRk4.claims(Problem::Torque).unwrap();
/// assert_eq!((claims.order, claims.kept.norm, claims.kept.momentum_norm), (Some(4), true, false));
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct MujocoRk4;

/// A prepared [`MujocoRk4`].
#[derive(Clone, Debug)]
pub struct MujocoRk4Map<S, F> {
    h: S,
    /// Half a step and a whole one, s.
    later: [Dd; 2],
    inverse_moments: Vec3<S>,
    field: F,
}

impl Claimed for MujocoRk4 {
    fn name(&self) -> String {
        "mujoco-rk4".into()
    }
    fn claims(&self, problem: Problem) -> Option<Claims> {
        let turns = if problem == Problem::Free { 1 } else { 4 };
        let kept = Kept { norm: true, ..Kept::NOTHING };
        let cost = Cost::right_sides(4) + Cost::turns(turns);
        Some(Claims::new(Some(4), kept, cost, "MuJoCo 4.0.0; Munthe-Kaas, Appl. Numer. Math. 29 (1999) 115"))
    }
}

impl<S: Real> Method<S> for MujocoRk4 {
    type Map<F: Field<S>> = MujocoRk4Map<S, F>;
    fn map<F: Field<S>>(&self, h: Dd, rotor: &Rotor, field: &F) -> MujocoRk4Map<S, F> {
        MujocoRk4Map {
            h: S::from_dd(h),
            later: [h * 0.5, h],
            inverse_moments: rotor.inverse_moments(),
            field: field.clone(),
        }
    }
}

impl<S: Real, F: Field<S>> MujocoRk4Map<S, F> {
    /// The rate of the turn u of a stage with the momentum m, and the rate of m.
    #[inline]
    fn rates(&self, at: Time, x: &Point<S>, u: Vec3<S>, m: Vec3<S>) -> (Vec3<S>, Vec3<S>) {
        let omega = m.times(self.inverse_moments);
        let mut rate = m.cross(omega);
        if F::ACTS {
            rate = rate + self.field.torque(at, x.attitude * Quat::exponential(u), omega);
        }
        let bracket = u.cross(omega);
        let turn = omega + bracket * S::of(0.5) + u.cross(bracket) * (S::of(1.0) / S::of(12.0));
        (turn, rate)
    }
}

impl<S: Real, F: Field<S>> Map<S> for MujocoRk4Map<S, F> {
    fn apply(&mut self, at: Time, x: &mut Point<S>) {
        let (h, half, two) = (self.h, self.h * S::of(0.5), S::of(2.0));
        let (m, [middle, end]) = (x.momentum_body, self.later.map(|duration| at.later(duration)));
        let (k1, f1) = self.rates(at, x, Vec3::zero(), m);
        let (k2, f2) = self.rates(middle, x, k1 * half, m + f1 * half);
        let (k3, f3) = self.rates(middle, x, k2 * half, m + f2 * half);
        let (k4, f4) = self.rates(end, x, k3 * h, m + f3 * h);
        let sixth = h / S::of(6.0);
        x.momentum_body = m + (f1 + (f2 + f3) * two + f4) * sixth;
        let turn = Quat::exponential((k1 + (k2 + k3) * two + k4) * sixth);
        x.attitude = (x.attitude * turn).normalized();
    }
}

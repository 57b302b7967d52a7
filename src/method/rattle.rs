//! RATTLE, which for the free body is the discrete Moser–Veselov map, on quaternions.
//!
//! # Notation
//! | letter | meaning |
//! |---|---|
//! | c | Cayley vector of the step, `tan(θ/2)` times its axis |
//! | a | (h/2) I⁻¹ m |
//! | F | differences of moments, `F_1 = I_2 − I_3` and cyclic |

use super::implicit_midpoint::cayley_turn;
use super::stagnation::iterate;
use super::{Claimed, Claims, Cost, Energy, Kept, KeptHeavy, Method, Step, StepError, usable};
use crate::body::{Body, Carry, State, of_dd};
use crate::flow::Kick;
use crate::num::{Dd, Real};
use crate::rotation::Vec3;

/// RATTLE on SO(3) = discrete Moser–Veselov = Lie group variational integrator.
///
/// Φ_h: solve `c = (1 + |c|²) a + (F/I) (c₂c₃, c₃c₁, c₁c₂)`, then `q' = q ∘ cay(c)` and
/// `m' = m + 4/(h (1 + |c|²)) F (c₂c₃, c₃c₁, c₁c₂)`.
/// Keeps energy, |m|, L and the Lie–Poisson bracket; it follows a free body with slightly other moments and clock,
/// so its phase is off by O(h²) t: the attitude error grows while every invariant stands still. Under gravity half a
/// [kick](Kick) goes before and after; then L_z is kept and the energy stays within O(h²).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Rattle;

/// A prepared step of [`Rattle`].
#[derive(Clone, Copy, Debug)]
pub struct RattleStep<S> {
    half: Vec3<S>,        // h/2 I⁻¹
    differences: Vec3<S>, // F
    ratios: Vec3<S>,      // F/I
    four_over_h: S,
    half_step: S,
    kick: Kick<S>,
    carry: Carry<S>,
    worst_residual: f64,
}

impl Claimed for Rattle {
    fn name(&self) -> String {
        "rattle".into()
    }
    fn claims(&self) -> Claims {
        Claims {
            order: 2,
            symmetric: true,
            poisson: true,
            free: Kept { energy: Energy::Exact, momentum: true, momentum_space: true, norm: true },
            exact_when_free: false,
            potential: Some(KeptHeavy { energy: Energy::Bounded, momentum_z: true, norm: true }),
            cost: Cost::Solves(1),
            source: "Moser and Veselov, Commun. Math. Phys. 139 (1991) 217; McLachlan and Scovel, J. Nonlinear Sci. 5 (1995) 233",
        }
    }
}

impl<S: Real> Method<S> for Rattle {
    type Step = RattleStep<S>;
    fn prepare(&self, h: f64, body: &Body, _: &State<S>) -> Result<RattleStep<S>, StepError> {
        let h = usable(h)?;
        let moments: Vec3<Dd> = body.moments();
        let differences = cyclic(|_, j, k| moments[j] - moments[k]);
        let round = |v: Vec3<Dd>| Vec3(v.0.map(of_dd));
        Ok(RattleStep {
            half: round(body.inverse_moments::<Dd>() * Dd::of(0.5 * h)),
            differences: round(differences),
            ratios: round(differences.times(body.inverse_moments())),
            four_over_h: S::of(4.0) / S::of(h),
            half_step: S::of(0.5 * h),
            kick: Kick::new(body),
            carry: Carry::default(),
            worst_residual: 0.0,
        })
    }
}

impl<S: Real> Step<S> for RattleStep<S> {
    #[inline]
    fn step(&mut self, x: &mut State<S>) {
        self.kick.carried(self.half_step, x, &mut self.carry);
        let a = x.momentum_body.times(self.half);
        let f = self.ratios;
        let sweep = |c: Vec3<S>| {
            let alpha = S::of(1.0) + c.norm_squared();
            // Gauss–Seidel: each new component serves the next
            let c0 = alpha * a[0] + f[0] * c[1] * c[2];
            let c1 = alpha * a[1] + f[1] * c[2] * c0;
            let c2 = alpha * a[2] + f[2] * c0 * c1;
            Vec3([c0, c1, c2])
        };
        let (c, residual) = iterate(a, sweep);
        self.worst_residual = self.worst_residual.max(residual);
        let alpha = S::of(1.0) + c.norm_squared();
        let products = cyclic(|_, j, k| c[j] * c[k]);
        self.carry.add_momentum(x, self.differences.times(products) * (self.four_over_h / alpha));
        cayley_turn(x, &mut self.carry, c);
        self.kick.carried(self.half_step, x, &mut self.carry);
    }

    fn worst_residual(&self) -> f64 {
        self.worst_residual
    }
}

/// The vector whose component i is `f(i, j, k)`, (i, j, k) cyclic.
#[inline]
fn cyclic<S>(f: impl Fn(usize, usize, usize) -> S) -> Vec3<S> {
    Vec3([f(0, 1, 2), f(1, 2, 0), f(2, 0, 1)])
}

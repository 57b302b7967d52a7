//! RATTLE, which for the free body is the discrete Moser–Veselov map, on quaternions.
//!
//! # Notation
//! | letter | meaning |
//! |---|---|
//! | c | Cayley vector of the step, `tan(θ/2)` times its axis |
//! | u | (2/h) I c, a momentum |

use super::implicit_midpoint::cayley_turn;
use super::stagnation::iterate;
use super::{Claimed, Claims, Cost, Energy, Kept, KeptHeavy, Method, Step, StepError, usable};
use crate::body::{Body, Carry, Gyroscopic, State, of_dd};
use crate::flow::Kick;
use crate::num::{Dd, Real};
use crate::rotation::Vec3;

/// RATTLE on SO(3) = discrete Moser–Veselov = Lie group variational integrator.
///
/// Φ_h: solve `u = (1 + |c|²) m + u × c`, `c = (h/2) I⁻¹ u`, then `q' = q ∘ cay(c)` and
/// `m' = m + 2/(1 + |c|²) u × c`.
/// Keeps energy, |m|, L and the Lie–Poisson bracket; it follows a free body with slightly other moments and clock,
/// so its phase is off by O(h²) t: the attitude error grows while every invariant stands still. Under gravity half a
/// [kick](Kick) goes before and after; then L_z is kept and the energy stays within O(h²).
///
/// `u × c` has the same rounded constants in the equation and in the step, so that the map as computed is symmetric
/// still and has two invariants next to E and |m|: what rounding adds is a random walk.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Rattle;

/// A prepared step of [`Rattle`].
#[derive(Clone, Copy, Debug)]
pub struct RattleStep<S> {
    half: Vec3<S>,             // h/2 I⁻¹
    gyroscopic: Gyroscopic<S>, // u × c
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
        let half = body.inverse_moments::<Dd>() * Dd::of(0.5 * h);
        Ok(RattleStep {
            half: Vec3(half.0.map(of_dd)),
            gyroscopic: Gyroscopic::new(body, 0.5 * h),
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
        let (m, term) = (x.momentum_body, |i, u_j, u_k| self.gyroscopic.component(i, u_j, u_k));
        let sweep = |u: Vec3<S>| {
            let alpha = S::of(1.0) + u.times(self.half).norm_squared();
            // Gauss–Seidel: each new component serves the next
            let u0 = alpha * m[0] + term(0, u[1], u[2]);
            let u1 = alpha * m[1] + term(1, u[2], u0);
            let u2 = alpha * m[2] + term(2, u0, u1);
            Vec3([u0, u1, u2])
        };
        let (u, residual) = iterate(m.magnitude(), m, sweep);
        self.worst_residual = self.worst_residual.max(residual);
        let c = u.times(self.half);
        let alpha = S::of(1.0) + c.norm_squared();
        self.carry.add_momentum(x, self.gyroscopic.at(u) * (S::of(2.0) / alpha));
        cayley_turn(x, &mut self.carry, c);
        self.kick.carried(self.half_step, x, &mut self.carry);
    }

    fn worst_residual(&self) -> f64 {
        self.worst_residual
    }
}

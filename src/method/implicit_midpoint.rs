//! The implicit midpoint rule on m, with the Cayley map on the attitude.

use super::stagnation::iterate;
use super::{Claimed, Claims, Cost, Energy, Kept, KeptHeavy, Method, Step, StepError, usable};
use crate::body::{Body, Carry, Gravity, Gyroscopic, State, vertical};
use crate::num::Real;
use crate::rotation::{Quat, Vec3};

/// Implicit midpoint.
///
/// Φ_h: `m' = m + h m̄ × I⁻¹m̄` with `m̄ = ½(m + m')`, then `q' = q ∘ cay(h/2 I⁻¹m̄)`.
/// Keeps energy and |m|, being quadratic, and L, because the same Cayley map turns m' back into m. It keeps the
/// Lie–Poisson bracket only to O(h²): conservation is not accuracy.
///
/// Under gravity `Γ̄ × c` joins the right side, `Γ̄ = ½(Γ + Γ')`. The Cayley map moves Γ by the midpoint rule too, so
/// that energy and L_z = m·Γ, quadratic in (m, Γ), are kept.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ImplicitMidpoint;

/// A prepared step of [`ImplicitMidpoint`].
#[derive(Clone, Copy, Debug)]
pub struct ImplicitMidpointStep<S> {
    h: S,
    half: S,
    inverse_moments: Vec3<S>,
    gyroscopic: Gyroscopic<S>, // h u × I⁻¹u
    gravity: Option<Gravity<S>>,
    carry: Carry<S>,
    worst_residual: f64,
}

impl Claimed for ImplicitMidpoint {
    fn name(&self) -> String {
        "implicit-midpoint".into()
    }
    fn claims(&self) -> Claims {
        Claims {
            order: 2,
            symmetric: true,
            poisson: false,
            free: Kept { energy: Energy::Exact, momentum: true, momentum_space: true, norm: true },
            exact_when_free: false,
            potential: Some(KeptHeavy { energy: Energy::Exact, momentum_z: true, norm: true }),
            cost: Cost::Solves(1),
            source: "Austin, Krishnaprasad and Wang, J. Comput. Phys. 107 (1993) 105; Lewis and Simo, J. Nonlinear Sci. 4 (1994) 253",
        }
    }
}

impl<S: Real> Method<S> for ImplicitMidpoint {
    type Step = ImplicitMidpointStep<S>;
    fn prepare(&self, h: f64, body: &Body, _: &State<S>) -> Result<ImplicitMidpointStep<S>, StepError> {
        let h = usable(h)?;
        Ok(ImplicitMidpointStep {
            h: S::of(h),
            half: S::of(0.5),
            inverse_moments: body.inverse_moments(),
            gyroscopic: Gyroscopic::new(body, h),
            gravity: body.gravity(),
            carry: Carry::default(),
            worst_residual: 0.0,
        })
    }
}

impl<S: Real> Step<S> for ImplicitMidpointStep<S> {
    #[inline]
    fn step(&mut self, x: &mut State<S>) {
        let m = x.momentum_body;
        let (delta, residual) = match &self.gravity {
            None => iterate(m.magnitude(), self.gyroscopic.at(m), |delta| {
                self.gyroscopic.at(m + delta * self.half)
            }),
            Some(gravity) => self.heavy(gravity, x),
        };
        self.worst_residual = self.worst_residual.max(residual);
        let c = (m + delta * self.half).times(self.inverse_moments) * (self.h * self.half);
        self.carry.add_momentum(x, delta);
        cayley_turn(x, &mut self.carry, c);
    }

    fn worst_residual(&self) -> f64 {
        self.worst_residual
    }
}

impl<S: Real> ImplicitMidpointStep<S> {
    /// The change of m under gravity, and the residual; apart, so that the free step stays in registers.
    #[inline(never)]
    fn heavy(&self, gravity: &Gravity<S>, x: &State<S>) -> (Vec3<S>, f64) {
        let (m, up) = (x.momentum_body, vertical(x.attitude));
        let increment = |middle: Vec3<S>| {
            let omega = middle.times(self.inverse_moments);
            let torque = middle_vertical(up, omega * (self.h * self.half)).cross(gravity.weight_moment);
            self.gyroscopic.at(middle) + torque * self.h
        };
        // next to an equilibrium torques are differences of terms as large as the weight moment
        let size = m.magnitude() + (gravity.weight_moment * self.h).magnitude();
        iterate(size, increment(m), |delta| increment(m + delta * self.half))
    }
}

/// ½(Γ + Γ'), Γ' the vertical after the turn with the Cayley vector c: the solution of `Γ̄ = Γ + Γ̄ × c`.
#[inline]
fn middle_vertical<S: Real>(up: Vec3<S>, c: Vec3<S>) -> Vec3<S> {
    (up + up.cross(c) + c * c.dot(up)) * (S::of(1.0) / (S::of(1.0) + c.norm_squared()))
}

/// `q ← q ∘ (1, c)/√(1 + |c|²)`, rounding carried: `p₀ − 1 = −|c|²/(α + √α)` has no cancellation.
#[inline]
pub(super) fn cayley_turn<S: Real>(x: &mut State<S>, carry: &mut Carry<S>, c: Vec3<S>) {
    let squared = c.norm_squared();
    let alpha = S::of(1.0) + squared;
    let root = alpha.sqrt();
    let less_one = Quat::new(-(squared / (alpha + root)), c * (S::of(1.0) / root));
    carry.add_attitude(x, x.attitude * less_one);
    carry.end_step(x);
}

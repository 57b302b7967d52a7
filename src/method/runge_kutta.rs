//! Explicit methods on (q, m): the yardsticks that people run today.
//!
//! The right-hand side is Euler's equation and the kinematic one, `m' = m × I⁻¹m + τ(q)`, `q' = ½ q ∘ (0, I⁻¹m)`.

use super::{Claimed, Claims, Cost, Energy, Kept, KeptHeavy, Method, Step, StepError, usable};
use crate::body::{Body, Gravity, State};
use crate::num::Real;
use crate::rotation::Vec3;

/// Nothing kept, energy drifting: what an explicit method on (q, m) can say.
const NOTHING: Kept = Kept { energy: Energy::Drifts, momentum: false, momentum_space: false, norm: false };

/// Of motion under gravity neither.
const NOTHING_HEAVY: KeptHeavy = KeptHeavy { energy: Energy::Drifts, momentum_z: false, norm: false };

/// The right-hand side.
#[derive(Clone, Copy, Debug)]
struct Equations<S> {
    inverse_moments: Vec3<S>,
    gravity: Option<Gravity<S>>,
}

impl<S: Real> Equations<S> {
    fn of(body: &Body) -> Self {
        Equations { inverse_moments: body.inverse_moments(), gravity: body.gravity() }
    }

    /// q' and m'.
    #[inline]
    fn rate(&self, x: &State<S>) -> State<S> {
        let omega = x.momentum_body.times(self.inverse_moments);
        State { attitude: x.attitude.rate(omega), momentum_body: self.momentum_rate(x) }
    }

    /// m × I⁻¹m + τ(q).
    #[inline]
    fn momentum_rate(&self, x: &State<S>) -> Vec3<S> {
        let m = x.momentum_body;
        let rate = m.cross(m.times(self.inverse_moments));
        match &self.gravity {
            Some(gravity) => rate + gravity.torque(x.attitude),
            None => rate,
        }
    }
}

/// The classical Runge–Kutta method of order 4.
///
/// Φ_h: `x + h/6 (k₁ + 2k₂ + 2k₃ + k₄)`. Keeps nothing: energy falls ∝ h⁵ t, |q| too unless `normalized`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Rk4 {
    /// Divide q by its norm after every step.
    pub normalized: bool,
}

/// A prepared step of [`Rk4`].
#[derive(Clone, Copy, Debug)]
pub struct Rk4Step<S> {
    h: S,
    equations: Equations<S>,
    normalized: bool,
}

impl Claimed for Rk4 {
    fn name(&self) -> String {
        if self.normalized { "rk4-normalized" } else { "rk4" }.into()
    }
    fn claims(&self) -> Claims {
        Claims {
            order: 4,
            symmetric: false,
            poisson: false,
            free: Kept { norm: self.normalized, ..NOTHING },
            exact_when_free: false,
            potential: Some(KeptHeavy { norm: self.normalized, ..NOTHING_HEAVY }),
            cost: Cost::RightSides(4),
            source: "Kutta 1901; Hairer, Norsett and Wanner, Solving ODEs I, table II.1.2",
        }
    }
}

impl<S: Real> Method<S> for Rk4 {
    type Step = Rk4Step<S>;
    fn prepare(&self, h: f64, body: &Body, _: &State<S>) -> Result<Rk4Step<S>, StepError> {
        let h = S::of(usable(h)?);
        Ok(Rk4Step { h, equations: Equations::of(body), normalized: self.normalized })
    }
}

impl<S: Real> Step<S> for Rk4Step<S> {
    #[inline]
    fn step(&mut self, x: &mut State<S>) {
        let (h, half, two) = (self.h, self.h * S::of(0.5), S::of(2.0));
        let k1 = self.equations.rate(x);
        let k2 = self.equations.rate(&(*x + k1 * half));
        let k3 = self.equations.rate(&(*x + k2 * half));
        let k4 = self.equations.rate(&(*x + k3 * h));
        *x = *x + (k1 + (k2 + k3) * two + k4) * (h / S::of(6.0));
        if self.normalized {
            x.attitude = x.attitude.normalized();
        }
    }
}

/// Explicit Euler: `x + h k₁`. Spirals outwards at every step.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ExplicitEuler;

/// A prepared step of [`ExplicitEuler`].
#[derive(Clone, Copy, Debug)]
pub struct ExplicitEulerStep<S> {
    h: S,
    equations: Equations<S>,
}

impl Claimed for ExplicitEuler {
    fn name(&self) -> String {
        "explicit-euler".into()
    }
    fn claims(&self) -> Claims {
        Claims {
            order: 1,
            symmetric: false,
            poisson: false,
            free: NOTHING,
            exact_when_free: false,
            potential: Some(NOTHING_HEAVY),
            cost: Cost::RightSides(1),
            source: "Euler 1768; Hairer, Norsett and Wanner, Solving ODEs I, (I.7.3)",
        }
    }
}

impl<S: Real> Method<S> for ExplicitEuler {
    type Step = ExplicitEulerStep<S>;
    fn prepare(&self, h: f64, body: &Body, _: &State<S>) -> Result<ExplicitEulerStep<S>, StepError> {
        Ok(ExplicitEulerStep { h: S::of(usable(h)?), equations: Equations::of(body) })
    }
}

impl<S: Real> Step<S> for ExplicitEulerStep<S> {
    #[inline]
    fn step(&mut self, x: &mut State<S>) {
        *x = *x + self.equations.rate(x) * self.h;
    }
}

/// Semi-implicit Euler as game engines write it: `m' = m + h (m × ω + τ)`, then `q' = norm(q + h/2 q ω')`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct SemiImplicitEuler;

/// A prepared step of [`SemiImplicitEuler`].
#[derive(Clone, Copy, Debug)]
pub struct SemiImplicitEulerStep<S> {
    h: S,
    equations: Equations<S>,
}

impl Claimed for SemiImplicitEuler {
    fn name(&self) -> String {
        "semi-implicit-euler".into()
    }
    fn claims(&self) -> Claims {
        Claims {
            order: 1,
            symmetric: false,
            poisson: false,
            free: Kept { norm: true, ..NOTHING },
            exact_when_free: false,
            potential: Some(KeptHeavy { norm: true, ..NOTHING_HEAVY }),
            cost: Cost::RightSides(1),
            source: "common in game engines; momentum first, attitude with the new one",
        }
    }
}

impl<S: Real> Method<S> for SemiImplicitEuler {
    type Step = SemiImplicitEulerStep<S>;
    fn prepare(&self, h: f64, body: &Body, _: &State<S>) -> Result<SemiImplicitEulerStep<S>, StepError> {
        Ok(SemiImplicitEulerStep { h: S::of(usable(h)?), equations: Equations::of(body) })
    }
}

impl<S: Real> Step<S> for SemiImplicitEulerStep<S> {
    #[inline]
    fn step(&mut self, x: &mut State<S>) {
        x.momentum_body = x.momentum_body + self.equations.momentum_rate(x) * self.h;
        let omega = x.momentum_body.times(self.equations.inverse_moments);
        x.attitude = (x.attitude + x.attitude.rate(omega) * self.h).normalized();
    }
}

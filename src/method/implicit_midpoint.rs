//! `implicit-midpoint`: the implicit midpoint rule on m, with the Cayley map on the attitude.

use super::{Claimed, Claims, Cost, Energy, Kept, Map, Method, Symmetric};
use crate::body::{Field, Gyroscopic, Point, Problem, Rotor, Time, vertical};
use crate::method::solve::cayley::cayley_turn;
use crate::method::solve::quadratic::Quadratic;
use crate::method::solve::stagnation::iterate;
use crate::num::{Dd, Real};
use crate::rotation::{Quat, Vec3};

/// Implicit midpoint.
///
/// Φ_h: `m' = m + h m̄ × I⁻¹m̄` with `m̄ = ½(m + m')`, then `q' = q ∘ cay(h/2 I⁻¹m̄)`.
/// Keeps energy and |m|, being quadratic, and L, because the same Cayley map turns m' back into m. It keeps the
/// Lie–Poisson bracket only to O(h²): conservation is not accuracy.
///
/// In a linear potential, as under gravity, `Γ̄ × c` joins the right side, `Γ̄ = ½(Γ + Γ')`. The Cayley map moves Γ by the midpoint rule too, so
/// that energy and L_z = m·Γ, quadratic in (m, Γ), are kept. Any other torque is taken in the middle of the step: at the
/// middle time, at q and half of the turn, and at I⁻¹m̄. Then the energy of a potential is not kept: the map is not symplectic.
///
/// ```
/// use nalgebra::{UnitQuaternion, Vector3};
/// use polhode::body::{Body, Conserved};
/// use polhode::inertia::Inertia;
/// use polhode::method::ImplicitMidpoint;
/// use polhode::run::Run;
/// let body = Body::free(Inertia::from_moments([1.0, 2.0, 3.0])?);
/// let start = body.state(UnitQuaternion::identity(), Vector3::new(0.4, 1.0, -0.3))?;
/// let end = Run::new(&ImplicitMidpoint, &body, &start, 0.1)?.advance_to(1000)?;
/// assert!(end.worst.of(Conserved::Momentum).is_some_and(|error| error < 1e-13));
/// # Ok::<(), polhode::Error>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ImplicitMidpoint;

/// A prepared [`ImplicitMidpoint`].
#[derive(Clone, Debug)]
pub struct ImplicitMidpointMap<S, F> {
    h: S,
    half: S,
    half_duration: Dd,
    inverse_moments: Vec3<S>,
    gyroscopic: Gyroscopic<S>,      // h u × I⁻¹u
    half_gyroscopic: Gyroscopic<S>, // half of it
    field: F,
    worst_residual: f64,
}

impl Symmetric for ImplicitMidpoint {}

impl Claimed for ImplicitMidpoint {
    fn name(&self) -> String {
        "implicit-midpoint".into()
    }
    fn claims(&self, problem: Problem) -> Option<Claims> {
        let kept = match problem {
            Problem::Free | Problem::Gyrostat => Kept::all_of_free_motion(Energy::Exact),
            Problem::Linear => Kept { energy: Energy::Exact, momentum_z: true, norm: true, ..Kept::NOTHING },
            Problem::Potential | Problem::GyrostatPotential | Problem::Torque => {
                Kept { norm: true, ..Kept::NOTHING }
            }
        };
        let source = "Austin, Krishnaprasad and Wang, J. Comput. Phys. 107 (1993) 105; Lewis and Simo, J. Nonlinear Sci. 4 (1994) 253";
        Some(Claims { symmetric: true, ..Claims::new(Some(2), kept, Cost::solves(1), source) })
    }
}

impl<S: Real> Method<S> for ImplicitMidpoint {
    type Map<F: Field<S>> = ImplicitMidpointMap<S, F>;
    fn map<F: Field<S>>(&self, h: Dd, rotor: &Rotor, field: &F) -> Self::Map<F> {
        ImplicitMidpointMap {
            h: S::from_dd(h),
            half: S::of(0.5),
            half_duration: h * 0.5,
            inverse_moments: rotor.inverse_moments(),
            gyroscopic: Gyroscopic::new(rotor, h),
            half_gyroscopic: Gyroscopic::new(rotor, h * 0.5),
            field: field.clone(),
            worst_residual: 0.0,
        }
    }
}

impl<S: Real, F: Field<S>> Map<S> for ImplicitMidpointMap<S, F> {
    #[inline]
    fn apply(&mut self, at: Time, x: &mut Point<S>) {
        if F::ACTS {
            let (delta, residual) = self.forced(at, x);
            self.worst_residual = self.worst_residual.max(residual);
            return self.step(x, delta);
        }
        let (middle, settled) = self.equation(x.momentum_body).near();
        if !settled {
            let Vec3([a, b, c]) = middle;
            return self.step_from(x, a, b, c);
        }
        self.step(x, self.gyroscopic.at(middle));
    }

    fn worst_residual(&self) -> f64 {
        self.worst_residual
    }
}

impl<S: Real, F: Field<S>> ImplicitMidpointMap<S, F> {
    #[inline(always)]
    fn equation(&self, m: Vec3<S>) -> Quadratic<'_, S, false> {
        Quadratic { m, half: self.inverse_moments, gyroscopic: &self.half_gyroscopic }
    }

    /// The step that changes m by `delta`.
    #[inline(always)]
    fn step(&self, x: &mut Point<S>, delta: Vec3<S>) {
        let middle = x.momentum_body + delta * self.half;
        x.add_momentum(delta);
        cayley_turn(x, middle.times(self.inverse_moments) * (self.h * self.half));
    }

    /// The free step from a guess of m̄ that is not good enough, number by number: they stay in registers.
    #[cold]
    #[inline(never)]
    fn step_from(&mut self, x: &mut Point<S>, a: S, b: S, c: S) {
        let (middle, residual) = self.equation(x.momentum_body).iterated(Vec3([a, b, c]));
        self.worst_residual = self.worst_residual.max(residual);
        self.step(x, self.gyroscopic.at(middle));
    }

    /// The change of m with torque, and the residual; apart, so that the free step stays in registers.
    #[inline(never)]
    fn forced(&self, at: Time, x: &Point<S>) -> (Vec3<S>, f64) {
        let (m, up) = (x.momentum_body, vertical(x.attitude));
        let rest = |middle: Vec3<S>| self.rest(at, x.attitude, middle);
        let Some(linear) = self.field.linear_part() else {
            let increment = |middle: Vec3<S>| self.gyroscopic.at(middle) + rest(middle);
            let size = m.magnitude() + rest(m).magnitude();
            return iterate(size, increment(m), |delta| increment(m + delta * self.half));
        };
        let increment = |middle: Vec3<S>| {
            let c = middle.times(self.inverse_moments) * (self.h * self.half);
            let torque = middle_vertical(up, c).cross(linear.moment);
            let increment = self.gyroscopic.at(middle) + torque * self.h;
            if F::HAS_REMAINDER { increment + rest(middle) } else { increment }
        };
        // next to an equilibrium torques are differences of terms as large as the moment
        let moment = (linear.moment * self.h).magnitude();
        let others = if F::HAS_REMAINDER { rest(m).magnitude() } else { 0.0 };
        iterate(m.magnitude() + moment + others, increment(m), |delta| increment(m + delta * self.half))
    }

    /// The change of m by all but the linear part, in the middle of a step with the mean momentum `middle`.
    #[inline(never)]
    fn rest(&self, at: Time, attitude: Quat<S>, middle: Vec3<S>) -> Vec3<S> {
        let omega = middle.times(self.inverse_moments);
        let attitude = attitude * half_turn(omega * (self.h * self.half));
        self.field.remainder(at.later(self.half_duration), attitude, omega) * self.h
    }
}

/// Half of the turn with the Cayley vector c.
#[inline]
fn half_turn<S: Real>(c: Vec3<S>) -> Quat<S> {
    let whole = Quat::cayley(c);
    Quat::new(S::of(1.0) + whole.w, whole.v).normalized()
}

/// ½(Γ + Γ'), Γ' the vertical after the turn with the Cayley vector c: the solution of `Γ̄ = Γ + Γ̄ × c`.
#[inline]
fn middle_vertical<S: Real>(up: Vec3<S>, c: Vec3<S>) -> Vec3<S> {
    (up + up.cross(c) + c * c.dot(up)) * (S::of(1.0) / (S::of(1.0) + c.norm_squared()))
}

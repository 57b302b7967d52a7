//! `lie-poisson-projected`: a symmetric map between two equal shifts, which return it to the energy and the |m| that
//! it began with.

use super::{Claimed, Claims, Cost, Energy, FreePart, Kept, Map, Method, Symmetric};
use crate::body::{Field, Point, Problem, Rotor, Time};
use crate::num::{Dd, Real};
use crate::rotation::Vec3;

/// More iterations than a step takes whose error is small: each multiplies the defect by the error of the step.
const ITERATIONS: u32 = 50;

/// Symmetric projection of a symmetric map of free motion onto energy and |m|.
///
/// Φ_h: `m₁ = m + λ₁ I⁻¹m + λ₂ m`, then the map from (m₁, q) to (m₂, q'), then `m' = m₂ + λ₁ I⁻¹m' + λ₂ m'`, with the λ₁, λ₂ for
/// which m' has the energy and the length of m (Hairer, BIT 40 (2000) 726; Hairer, Lubich and Wanner, Geometric Numerical
/// Integration, algorithm V.4.1). Simplified Newton iteration finds them, with one map in each iteration. The multipliers are the
/// same before and after the map, so that the method is symmetric, as standard projection ([`ProjectedRk4`](super::ProjectedRk4))
/// is not. Where I⁻¹m is parallel to m, next to a turn about a principal axis, nothing is shifted. Keeps energy and |m|. Loses L,
/// as the map turns the body with a shifted momentum, and the Lie–Poisson bracket.
///
/// ```
/// use polhode::body::{Body, Conserved};
/// use polhode::inertia::Inertia;
/// use polhode::method::{AxisSplit, SymmetricProjection};
/// use polhode::run::Run;
/// let body = Body::free(Inertia::from_moments([1.0, 2.0, 3.0])?);
/// let start = body.state(Default::default(), [0.4, 1.0, -0.3].into())?;
/// let method = SymmetricProjection::new(AxisSplit { axes: None });
/// let end = Run::new(&method, &body, &start, 0.1)?.advance_to(1000)?;
/// assert!(end.worst.of(Conserved::Energy).is_some_and(|error| error < 1e-13));
/// assert!(end.worst.of(Conserved::Momentum).is_some_and(|error| error > 1e-9));
/// # Ok::<(), polhode::Error>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct SymmetricProjection<A> {
    base: A,
}

impl<A: FreePart> SymmetricProjection<A> {
    /// Of the free map `base`.
    pub const fn new(base: A) -> Self {
        SymmetricProjection { base }
    }
}

impl<A: FreePart> Symmetric for SymmetricProjection<A> {}

impl<A: FreePart> Claimed for SymmetricProjection<A> {
    fn name(&self) -> String {
        format!("{}-projected", self.base.name())
    }
    fn claims(&self, problem: Problem) -> Option<Claims> {
        let kept = Kept { energy: Energy::Exact, momentum_norm: true, norm: true, ..Kept::NOTHING };
        let cost = Cost::solves(1) + self.base.cost();
        let claims = Claims::new(self.base.order(), kept, cost, "Hairer, BIT 40 (2000) 726");
        (problem == Problem::Free).then_some(Claims { symmetric: true, to_residual: true, ..claims })
    }
}

impl<S: Real, A: FreePart + Method<S>> Method<S> for SymmetricProjection<A> {
    type Map<F: Field<S>> = SymmetricProjectionMap<S, A::Map<F>>;
    fn map<F: Field<S>>(&self, h: Dd, rotor: &Rotor, field: &F) -> Self::Map<F> {
        let inverse_moments = rotor.inverse_moments();
        SymmetricProjectionMap { base: self.base.map(h, rotor, field), inverse_moments, worst_residual: 0.0 }
    }
}

/// A prepared [`SymmetricProjection`].
#[derive(Clone, Debug)]
pub struct SymmetricProjectionMap<S, T> {
    base: T,
    inverse_moments: Vec3<S>,
    worst_residual: f64,
}

/// The two multipliers.
#[derive(Clone, Copy, Debug)]
struct Shift<S> {
    along_omega: S,
    along_m: S,
}

impl<S: Real, T: Map<S>> SymmetricProjectionMap<S, T> {
    /// The step from `x` between two shifts.
    fn shifted(&mut self, at: Time, x: &Point<S>, shift: Shift<S>) -> Point<S> {
        let factors = self.inverse_moments.map(|inverse| inverse * shift.along_omega + shift.along_m);
        let mut end = *x;
        end.momentum_body = x.momentum_body + x.momentum_body.times(factors);
        self.base.apply(at, &mut end);
        end.momentum_body = end.momentum_body.times(factors.map(|factor| S::of(1.0) / (S::of(1.0) - factor)));
        end
    }
}

impl<S: Real, T: Map<S>> Map<S> for SymmetricProjectionMap<S, T> {
    fn apply(&mut self, at: Time, x: &mut Point<S>) {
        let m = x.momentum_body;
        let omega = m.times(self.inverse_moments);
        let (squared, double_energy, omega_squared) = (m.norm_squared(), m.dot(omega), omega.norm_squared());
        let determinant = m.cross(omega).norm_squared();
        if determinant.magnitude() <= S::ROUNDOFF * (squared * omega_squared).magnitude() {
            return self.base.apply(at, x);
        }
        let half = S::of(0.5);
        let mut shift = Shift { along_omega: S::of(0.0), along_m: S::of(0.0) };
        let mut last = f64::INFINITY;
        for _ in 0..ITERATIONS {
            let end = self.shifted(at, x, shift).momentum_body;
            // C and E of m less those of the end, as products with the small difference
            let (lacking, mean) = (m - end, (m + end) * half);
            let (c, e) = (lacking.dot(mean), lacking.dot(mean.times(self.inverse_moments)));
            // half of it before the map, half after it
            let along_omega = (e * squared - c * double_energy) / determinant * half;
            let along_m = (c * omega_squared - e * double_energy) / determinant * half;
            let size = (omega * along_omega + m * along_m).magnitude();
            if size >= last {
                break;
            }
            last = size;
            shift.along_omega = shift.along_omega + along_omega;
            shift.along_m = shift.along_m + along_m;
        }
        self.worst_residual = self.worst_residual.max(last / m.magnitude());
        *x = self.shifted(at, x, shift);
    }

    fn worst_residual(&self) -> f64 {
        self.worst_residual.max(self.base.worst_residual())
    }
}

//! `rk4-projected`: a Runge–Kutta step, projected onto the energy and the momentum that it began with.

use super::rk4::Rk4Map;
use super::{Claimed, Claims, Cost, Energy, Kept, Map, Method, Rk4};
use crate::body::{Field, Point, Problem, Rotor, Time};
use crate::num::{Dd, Real};
use crate::rotation::Vec3;

/// More iterations than a step takes whose error is small: each multiplies the defect by the error of the step.
const ITERATIONS: u32 = 20;

/// The classical Runge–Kutta method with standard projection onto energy and |m|, of free motion.
///
/// Φ_h: m̃ and q' by [`Rk4`] with |q| brought back to 1, then `m' = m̃ + λ₁ I⁻¹m̃ + λ₂ m̃` with the energy and |m| of m, by
/// simplified Newton iteration (Hairer, Lubich and Wanner, Geometric Numerical Integration, algorithm IV.4.2). Where I⁻¹m is
/// parallel to m, next to a turn about a principal axis, the two conditions are one, and only |m| is restored. Keeps |m| and
/// the energy, and yet is neither symmetric nor Poisson, and loses L: conservation is not accuracy.
///
/// ```
/// use polhode::body::{Body, Conserved};
/// use polhode::inertia::Inertia;
/// use polhode::method::ProjectedRk4;
/// use polhode::run::Run;
/// let body = Body::free(Inertia::from_moments([1.0, 2.0, 3.0])?);
/// let start = body.state(Default::default(), [0.4, 1.0, -0.3].into())?;
/// let end = Run::new(&ProjectedRk4, &body, &start, 0.1)?.advance_to(1000)?;
/// assert!(end.worst.of(Conserved::Energy).is_some_and(|error| error < 1e-13));
/// assert!(end.worst.of(Conserved::Momentum).is_some_and(|error| error > 1e-9));
/// # Ok::<(), polhode::Error>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ProjectedRk4;

/// A prepared [`ProjectedRk4`].
#[derive(Clone, Debug)]
pub struct ProjectedRk4Map<S, F> {
    rk4: Rk4Map<S, F>,
    inverse_moments: Vec3<S>,
}

impl Claimed for ProjectedRk4 {
    fn name(&self) -> String {
        "rk4-projected".into()
    }
    fn claims(&self, problem: Problem) -> Option<Claims> {
        let kept = Kept { energy: Energy::Exact, momentum_norm: true, norm: true, ..Kept::NOTHING };
        let source = "Hairer, Lubich and Wanner, Geometric Numerical Integration, algorithm IV.4.2";
        let claims = Claims::new(Some(4), kept, Cost::right_sides(4), source);
        (problem == Problem::Free).then_some(Claims { to_residual: true, ..claims })
    }
}

impl<S: Real> Method<S> for ProjectedRk4 {
    type Map<F: Field<S>> = ProjectedRk4Map<S, F>;
    fn map<F: Field<S>>(&self, h: Dd, rotor: &Rotor, field: &F) -> ProjectedRk4Map<S, F> {
        let rk4 = Rk4 { normalized: true }.map(h, rotor, field);
        ProjectedRk4Map { rk4, inverse_moments: rotor.inverse_moments() }
    }
}

impl<S: Real, F: Field<S>> Map<S> for ProjectedRk4Map<S, F> {
    fn apply(&mut self, at: Time, x: &mut Point<S>) {
        let before = x.momentum_body;
        self.rk4.apply(at, x);
        x.momentum_body = self.projected(before, x.momentum_body);
    }
}

impl<S: Real, F: Field<S>> ProjectedRk4Map<S, F> {
    /// The momentum next to `after` with the energy and the length of `before`.
    fn projected(&self, before: Vec3<S>, after: Vec3<S>) -> Vec3<S> {
        let omega = after.times(self.inverse_moments);
        let (squared, double_energy, omega_squared) =
            (after.norm_squared(), after.dot(omega), omega.norm_squared());
        let determinant = after.cross(omega).norm_squared();
        if determinant.magnitude() <= S::ROUNDOFF * (squared * omega_squared).magnitude() {
            let length = after.norm();
            return if length.magnitude() == 0.0 { after } else { after * (before.norm() / length) };
        }
        let mut m = after;
        let mut last = f64::INFINITY;
        for _ in 0..ITERATIONS {
            // C and E of `before` less those of m, as products with the small difference
            let (lacking, sum) = (before - m, (before + m) * S::of(0.5));
            let (c, e) = (lacking.dot(sum), lacking.dot(sum.times(self.inverse_moments)));
            let along_omega = (e * squared - c * double_energy) / determinant;
            let along_m = (c * omega_squared - e * double_energy) / determinant;
            let correction = omega * along_omega + after * along_m;
            let size = correction.magnitude();
            if size >= last {
                break;
            }
            (m, last) = (m + correction, size);
        }
        m
    }
}

//! `lie-newmark`: Newmark's method on the group of rotations.

use super::{Claimed, Claims, Cost, Energy, Kept, Map, Method};
use crate::body::{Field, Gyroscopic, Point, Problem, Rotor, Time};
use crate::method::solve::cayley::cayley_turn;
use crate::method::solve::quadratic::Quadratic;
use crate::num::{Dd, Real};
use crate::rotation::Vec3;

/// The explicit Newmark method on SO(3), γ = ½ and β = 0, with the Cayley map.
///
/// Φ_h: `m_½ = m + h/2 (m × I⁻¹m + τ)`, `q' = q ∘ cay(h/2 I⁻¹m_½)`, `m' = m_½ + h/2 (m' × I⁻¹m' + τ')`: one torque a step,
/// explicit but for the last equation, of three unknowns (Simo and Vu-Quoc, Comput. Methods Appl. Mech. Eng. 66 (1988) 125;
/// Krysl and Endres, Int. J. Numer. Methods Eng. 62 (2005) 2154). Symmetric where the torque does not depend on ω, which is
/// foretold at the end of the step; neither variational nor symplectic, and in general potentials the energy drifts (Bou-Rabee,
/// Ortolan and Saccon, arXiv:1005.3078). In free motion m follows the trapezoidal rule, which is conjugate to the implicit
/// midpoint rule: the energy stays within O(h²), and under uniform gravity no drift is seen.
///
/// ```
/// use polhode::body::Problem;
/// use polhode::method::{Claimed, Energy, LieNewmark};
/// let energy = |problem| LieNewmark.claims(problem).unwrap().kept.energy;
/// assert_eq!((energy(Problem::Free), energy(Problem::Potential)), (Energy::Bounded, Energy::Drifts));
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct LieNewmark;

/// A prepared [`LieNewmark`].
#[derive(Clone, Debug)]
pub struct LieNewmarkMap<S, F> {
    half: S,
    whole: Dd,
    inverse_moments: Vec3<S>,
    half_gyroscopic: Gyroscopic<S>, // h/2 u × I⁻¹u
    field: F,
    worst_residual: f64,
}

impl Claimed for LieNewmark {
    fn name(&self) -> String {
        "lie-newmark".into()
    }
    fn claims(&self, problem: Problem) -> Option<Claims> {
        let energy = match problem {
            Problem::Free | Problem::Linear => Energy::Bounded,
            Problem::Potential | Problem::Gyrostat | Problem::GyrostatPotential | Problem::Torque => {
                Energy::Drifts
            }
        };
        let kept = Kept { energy, norm: true, ..Kept::NOTHING };
        let source = "Simo and Vu-Quoc, Comput. Methods Appl. Mech. Eng. 66 (1988) 125";
        let torques = Cost::kicks(if problem == Problem::Free { 0 } else { 2 });
        let claims = Claims::new(Some(2), kept, Cost::solves(1) + torques, source);
        // not with a torque that depends on the angular velocity, as that of wheels does
        let symmetric = matches!(problem, Problem::Free | Problem::Linear | Problem::Potential);
        Some(Claims { symmetric, ..claims })
    }
}

impl<S: Real> Method<S> for LieNewmark {
    type Map<F: Field<S>> = LieNewmarkMap<S, F>;
    fn map<F: Field<S>>(&self, h: Dd, rotor: &Rotor, field: &F) -> LieNewmarkMap<S, F> {
        LieNewmarkMap {
            half: S::from_dd(h * 0.5),
            whole: h,
            inverse_moments: rotor.inverse_moments(),
            half_gyroscopic: Gyroscopic::new(rotor, h * 0.5),
            field: field.clone(),
            worst_residual: 0.0,
        }
    }
}

impl<S: Real, F: Field<S>> LieNewmarkMap<S, F> {
    /// h/2 τ of the momentum m.
    #[inline]
    fn impulse(&self, at: Time, x: &Point<S>, m: Vec3<S>) -> Vec3<S> {
        if !F::ACTS {
            return Vec3::zero();
        }
        self.field.torque(at, x.attitude, m.times(self.inverse_moments)) * self.half
    }
}

impl<S: Real, F: Field<S>> Map<S> for LieNewmarkMap<S, F> {
    fn apply(&mut self, at: Time, x: &mut Point<S>) {
        let m = x.momentum_body;
        let first = self.half_gyroscopic.at(m) + self.impulse(at, x, m);
        let middle = m + first;
        cayley_turn(x, middle.times(self.inverse_moments) * self.half);
        let impulse = self.impulse(at.later(self.whole), x, middle + first);
        let equation = Quadratic::<S, false> {
            m: middle + impulse,
            half: self.inverse_moments,
            gyroscopic: &self.half_gyroscopic,
        };
        let (last, residual) = equation.solution();
        self.worst_residual = self.worst_residual.max(residual);
        x.add_momentum(first + (impulse + self.half_gyroscopic.at(last)));
    }

    fn worst_residual(&self) -> f64 {
        self.worst_residual
    }
}

//! `rattle`: the discrete Moser–Veselov map of the free body, on quaternions; with kicks around it, RATTLE.
//!
//! # Notation
//! | letter | meaning |
//! |---|---|
//! | c | Cayley vector of the step, `tan(θ/2)` times its axis |
//! | u | (2/h) I c, a momentum |

use super::{Cost, Energy, FreePart, Kicks, Map, Method, SideBySide, Splitting, Symmetric};
use crate::body::{Field, Gyroscopic, Point, RENORMALIZE_EVERY, Rotor, Time};
use crate::method::contract::lanes::LaneFlow;
use crate::method::solve::cayley::cayley_turn;
use crate::method::solve::quadratic::Quadratic;
use crate::num::{Dd, Real};
use crate::rotation::Vec3;

/// The discrete Moser–Veselov map with [kicks](Kicks) around it.
pub type Rattle = Splitting<Dmv, Kicks>;

/// RATTLE on SO(3) = discrete Moser–Veselov = Lie group variational integrator.
///
/// Φ_h: solve `u = (1 + |c|²) m + u × c`, `c = (h/2) I⁻¹ u`, then `q' = q ∘ cay(c)` and
/// `m' = m + 2/(1 + |c|²) u × c`.
/// Keeps energy, |m|, L and the Lie–Poisson bracket; it follows a free body with slightly other moments and clock,
/// so its phase is off by O(h²) t: the attitude error grows while every invariant stands still. With half a
/// [kick](crate::flow::Kick) before and after, L_z is kept under gravity and the energy stays within O(h²).
///
/// `u × c` has the same rounded constants in the equation and in the step, so that the map as computed is symmetric
/// still and has two invariants close to E and |m|: what rounding adds is a random walk.
///
/// ```
/// use nalgebra::{UnitQuaternion, Vector3};
/// use polhode::body::{Body, Conserved};
/// use polhode::inertia::Inertia;
/// use polhode::method::{Dmv, Kicks, Rattle};
/// use polhode::run::Run;
/// let body = Body::free(Inertia::from_moments([1.0, 2.0, 3.0])?);
/// let start = body.state(UnitQuaternion::identity(), Vector3::new(0.4, 1.0, -0.3))?;
/// let end = Run::new(&Rattle::strang(Dmv, Kicks), &body, &start, 0.1)?.advance_to(1000)?;
/// assert!(end.worst.of(Conserved::Energy).is_some_and(|error| error < 1e-13));
/// # Ok::<(), polhode::Error>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Dmv;

impl Symmetric for Dmv {}

impl FreePart for Dmv {
    fn name(&self) -> String {
        "rattle".into()
    }
    fn order(&self) -> Option<u32> {
        Some(2)
    }
    fn energy(&self) -> Energy {
        Energy::Exact
    }
    fn cost(&self) -> Cost {
        Cost::solves(1)
    }
    fn wheel_cost(&self) -> Option<Cost> {
        Some(self.cost())
    }
    fn source(&self) -> &'static str {
        "Moser and Veselov, Commun. Math. Phys. 139 (1991) 217; McLachlan and Scovel, J. Nonlinear Sci. 5 (1995) 233"
    }
}

impl<S: Real> Method<S> for Dmv {
    type Map<F: Field<S>> = DmvMap<S>;
    fn map<F: Field<S>>(&self, h: Dd, rotor: &Rotor, _: &F) -> DmvMap<S> {
        let half = h * 0.5;
        DmvMap {
            half: (rotor.inverse_moments::<Dd>() * half).map(S::from_dd),
            gyroscopic: Gyroscopic::new(rotor, half),
            worst_residual: 0.0,
        }
    }
}

/// A prepared [`Dmv`].
#[derive(Clone, Copy, Debug)]
pub struct DmvMap<S> {
    half: Vec3<S>,             // h/2 I⁻¹
    gyroscopic: Gyroscopic<S>, // u × c
    worst_residual: f64,
}

/// Numbers that a map is made of.
pub(in crate::method) const DMV_CONSTANTS: usize = 6;

impl<S: Real> DmvMap<S> {
    /// Half a step over each moment, and the factors of u × c.
    pub(in crate::method) fn constants(&self) -> [S; DMV_CONSTANTS] {
        let (Vec3([a, b, c]), Vec3([d, e, f])) = (self.half, self.gyroscopic.factors());
        [a, b, c, d, e, f]
    }

    #[inline(always)]
    pub(in crate::method) fn of([a, b, c, d, e, f]: [S; DMV_CONSTANTS]) -> Self {
        let gyroscopic = Gyroscopic::of_factors(Vec3([d, e, f]));
        DmvMap { half: Vec3([a, b, c]), gyroscopic, worst_residual: 0.0 }
    }

    /// The solution of the equation for the momentum `m`, and whether it is one to rounding.
    #[inline(always)]
    pub(in crate::method) fn near(&self, m: Vec3<S>) -> (Vec3<S>, bool) {
        self.equation(m).near()
    }

    /// The map for the reciprocal moments `s/I + d`, `half` being h/2.
    pub(in crate::method) fn set(&mut self, rotor: &Rotor, half: Dd, s: Dd, d: Dd) {
        let inverse = rotor.inverse_moments::<Dd>();
        self.half = inverse.map(|inverse| S::from_dd((inverse * s + d) * half));
        self.gyroscopic = Gyroscopic::new(rotor, half * s);
    }

    #[inline(always)]
    fn equation(&self, m: Vec3<S>) -> Quadratic<'_, S, true> {
        Quadratic { m, half: self.half, gyroscopic: &self.gyroscopic }
    }

    /// The step with the solution u.
    #[inline(always)]
    pub(in crate::method) fn step(&self, x: &mut Point<S>, u: Vec3<S>) {
        let c = u.times(self.half);
        let alpha = S::of(1.0) + c.norm_squared();
        x.add_momentum(self.gyroscopic.at(u) * (S::of(2.0) / alpha));
        cayley_turn(x, c);
    }

    /// The step from a guess that is not good enough, number by number: they stay in registers.
    #[cold]
    #[inline(never)]
    pub(in crate::method) fn step_from(&mut self, x: &mut Point<S>, a: S, b: S, c: S) {
        let (u, residual) = self.equation(x.momentum_body).iterated(Vec3([a, b, c]));
        self.worst_residual = self.worst_residual.max(residual);
        self.step(x, u);
    }

    /// The same from the map for the moments themselves and d h/2.
    #[inline]
    pub(in crate::method) fn modify(&mut self, plain: &DmvMap<S>, s: S, half_d: S) {
        self.half = plain.half.map(|half| half * s + half_d);
        self.gyroscopic = plain.gyroscopic.scaled(s);
    }
}

impl<S: Real> Map<S> for DmvMap<S> {
    #[inline]
    fn apply(&mut self, _: Time, x: &mut Point<S>) {
        let (u, settled) = self.near(x.momentum_body);
        if !settled {
            let Vec3([a, b, c]) = u;
            return self.step_from(x, a, b, c);
        }
        self.step(x, u);
    }

    fn part_side_by_side(&self) -> Option<SideBySide<S>> {
        let flows = vec![LaneFlow::Dmv(0), LaneFlow::Renormalize(RENORMALIZE_EVERY)];
        Some(SideBySide::reading(flows, self.constants().into_iter().chain([S::of(0.0)]).collect()))
    }

    fn worst_residual(&self) -> f64 {
        self.worst_residual
    }
}

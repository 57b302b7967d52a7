//! `variational-cayley`: the variational integrator on SO(3) with the Cayley map.

use super::{Cost, Energy, FreePart, Map, Method, Symmetric};
use crate::body::{Field, Gyroscopic, Point, Rotor, Time};
use crate::method::solve::cayley::cayley_turn;
use crate::method::solve::stagnation::iterate;
use crate::num::{Dd, Real};
use crate::rotation::Vec3;

/// The variational integrator of the Hamilton–Pontryagin principle with the Cayley map.
///
/// Φ_h: solve `u = m + u × c − (u·c) c` with `c = (h/2) I⁻¹u`, then `q' = q ∘ cay(c)` and `m' = m + 2 u × c` (Bou-Rabee and
/// Marsden, Found. Comput. Math. 9 (2009) 197: their variational Lie–Verlet method on SO(3), which adds half a
/// [kick](crate::flow::Kick) before and after). Keeps |m|, L and the Lie–Poisson bracket, and the energy within O(h²). The
/// [discrete Moser–Veselov map](super::Dmv), which keeps the energy too, has `|c|² m` in place of `−(u·c) c` in the equation.
///
/// ```
/// use polhode::body::{Body, Conserved};
/// use polhode::inertia::Inertia;
/// use polhode::method::{Kicks, Splitting, VariationalCayley};
/// use polhode::run::Run;
/// let body = Body::free(Inertia::from_moments([1.0, 2.0, 3.0])?);
/// let start = body.state(Default::default(), [0.4, 1.0, -0.3].into())?;
/// let method = Splitting::strang(VariationalCayley, Kicks);
/// let end = Run::new(&method, &body, &start, 0.1)?.advance_to(1000)?;
/// assert!(end.worst.of(Conserved::Momentum).is_some_and(|error| error < 1e-13));
/// assert!(end.worst.of(Conserved::Energy).is_some_and(|error| 1e-6 < error && error < 1e-2));
/// # Ok::<(), polhode::Error>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct VariationalCayley;

impl Symmetric for VariationalCayley {}

impl FreePart for VariationalCayley {
    fn name(&self) -> String {
        "variational-cayley".into()
    }
    fn order(&self) -> Option<u32> {
        Some(2)
    }
    fn energy(&self) -> Energy {
        Energy::Bounded
    }
    fn cost(&self) -> Cost {
        Cost::solves(1)
    }
    fn wheel_cost(&self) -> Option<Cost> {
        Some(self.cost())
    }
    fn source(&self) -> &'static str {
        "Bou-Rabee and Marsden, Found. Comput. Math. 9 (2009) 197"
    }
}

impl<S: Real> Method<S> for VariationalCayley {
    type Map<F: Field<S>> = VariationalCayleyMap<S>;
    fn map<F: Field<S>>(&self, h: Dd, rotor: &Rotor, _: &F) -> VariationalCayleyMap<S> {
        let half = h * 0.5;
        VariationalCayleyMap {
            half: (rotor.inverse_moments::<Dd>() * half).map(S::from_dd),
            gyroscopic: Gyroscopic::new(rotor, half),
            worst_residual: 0.0,
        }
    }
}

/// A prepared [`VariationalCayley`].
#[derive(Clone, Copy, Debug)]
pub struct VariationalCayleyMap<S> {
    half: Vec3<S>,             // h/2 I⁻¹
    gyroscopic: Gyroscopic<S>, // u × c
    worst_residual: f64,
}

impl<S: Real> Map<S> for VariationalCayleyMap<S> {
    #[inline]
    fn apply(&mut self, _: Time, x: &mut Point<S>) {
        let m = x.momentum_body;
        let increment = |u: Vec3<S>| {
            let c = u.times(self.half);
            self.gyroscopic.at(u) - c * u.dot(c)
        };
        let (delta, residual) = iterate(m.magnitude(), increment(m), |delta| increment(m + delta));
        self.worst_residual = self.worst_residual.max(residual);
        let u = m + delta;
        x.add_momentum(self.gyroscopic.at(u) * S::of(2.0));
        cayley_turn(x, u.times(self.half));
    }

    fn worst_residual(&self) -> f64 {
        self.worst_residual
    }
}

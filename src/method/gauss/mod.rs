//! `gauss`: collocation at Gauss's nodes: a polynomial that satisfies the equations of motion at the nodes of a step.

mod tableau;

use thiserror::Error;

use self::tableau::{MOST_STAGES, Tableau};
use super::{Claimed, Claims, Cost, Energy, Kept, Map, Method};
use crate::body::{Field, Gyroscopic, Phase, Point, Problem, Rotor, Time};
use crate::method::solve::stagnation::iterate_phases;
use crate::num::{Dd, Real};
use crate::rotation::Vec3;

/// Gauss–Legendre collocation of order 2, 4, 6 or 8, of one stage for each two orders.
///
/// Φ_h: `x' = x + Σ_i l_i` with `l_i = h b_i f(x_i)`, `x_i = x + Σ_j μ_ij l_j`, `μ_ij = a_ij/b_j`, for x = (m, q), m' = m ×
/// I⁻¹m + τ and q' = ½ q ∘ (0, I⁻¹m); the nodes of the stages are the roots of Legendre's polynomial (Kuntzmann 1961; Butcher,
/// Math. Comp. 18 (1964) 50; Hairer, Lubich and Wanner, Geometric Numerical Integration, II.1.3).
///
/// Keeps every quadratic invariant of (m, q), as μ_ij + μ_ji = 1 (Cooper, IMA J. Numer. Anal. 7 (1987) 1): energy, |m| and |q| in
/// free motion, energy and |q| in a potential linear in the vertical, which is quadratic in q. L is cubic: its error is that of the
/// order. The other triangle of μ is the difference to 1, so that the invariants do not follow the rounding of the coefficients
/// (Antoñana, Makazaga and Murua, Numer. Algorithms 76 (2017) 861). All other forces are taken at the stage's attitude
/// divided by its norm. The equations of the stages are iterated until rounding lets the iteration get no further, which takes
/// a turn of less than a radian a step.
///
/// ```
/// use nalgebra::{UnitQuaternion, Vector3};
/// use polhode::body::Conserved;
/// use polhode::method::Gauss;
/// use polhode::{Body, FreeMotion, Inertia, Run};
/// let body = Body::free(Inertia::from_moments([1.0, 2.0, 3.0])?);
/// let start = body.state(UnitQuaternion::identity(), Vector3::new(0.4, 1.0, -0.3))?;
/// let end = Run::new(&Gauss::of_order(8)?, &body, &start, 0.1)?.advance_to(1000)?;
/// let exact = FreeMotion::from_state(body.inertia(), &start)?.at(100.0)?;
/// assert!(end.worst.of(Conserved::Energy).is_some_and(|error| error < 1e-14));
/// assert!(end.state.rotation().angle_to(&exact.rotation()) < 1e-9);
/// assert!(Gauss::of_order(5).is_err());
/// # Ok::<(), polhode::Error>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Gauss {
    stages: usize,
}

/// There is no such order.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Error)]
#[error("there is no Gauss-Legendre method of order {order} here; the orders are 2, 4, 6 and 8")]
#[non_exhaustive]
pub struct GaussOrderError {
    /// What was asked for.
    pub order: u32,
}

impl Gauss {
    /// Two stages.
    pub const ORDER_4: Gauss = Gauss { stages: 2 };
    /// Four stages.
    pub const ORDER_8: Gauss = Gauss { stages: 4 };

    /// The method of order `order`.
    ///
    /// # Errors
    /// An order that is not 2, 4, 6 or 8.
    pub const fn of_order(order: u32) -> Result<Self, GaussOrderError> {
        match order {
            2 | 4 | 6 | 8 => Ok(Gauss { stages: order as usize / 2 }),
            _ => Err(GaussOrderError { order }),
        }
    }
}

impl Claimed for Gauss {
    fn name(&self) -> String {
        format!("gauss:{}", 2 * self.stages)
    }
    fn claims(&self, problem: Problem) -> Option<Claims> {
        let free = matches!(problem, Problem::Free | Problem::Gyrostat);
        let energy = match problem {
            Problem::Free | Problem::Linear | Problem::Gyrostat => Energy::Exact,
            Problem::Potential | Problem::GyrostatPotential | Problem::Torque => Energy::Drifts,
        };
        let kept = Kept { energy, momentum_norm: free, norm: true, ..Kept::NOTHING };
        let stages = self.stages as u32;
        let source = "Butcher, Math. Comp. 18 (1964) 50; Hairer, Lubich and Wanner, Geometric Numerical Integration, II.1.3";
        Some(Claims { symmetric: true, ..Claims::new(Some(2 * stages), kept, Cost::solves(stages), source) })
    }
}

impl<S: Real> Method<S> for Gauss {
    type Map<F: Field<S>> = GaussMap<S, F>;
    fn map<F: Field<S>>(&self, h: Dd, rotor: &Rotor, field: &F) -> GaussMap<S, F> {
        let tableau = Tableau::of_stages(self.stages);
        GaussMap {
            h: S::from_dd(h),
            later: tableau.nodes.map(|node| node * h),
            nodes: tableau.nodes.map(S::from_dd),
            weights: tableau.weights.map(S::from_dd),
            mu: tableau.rounded(),
            stages: self.stages,
            inverse_moments: rotor.inverse_moments(),
            gyroscopic: Gyroscopic::new(rotor, h),
            field: field.clone(),
            half: h * 0.5,
            worst_residual: 0.0,
        }
    }
}

/// A prepared [`Gauss`].
#[derive(Clone, Debug)]
pub struct GaussMap<S, F> {
    h: S,
    half: Dd,
    /// Times of the stages after the beginning of the step, s.
    later: [Dd; MOST_STAGES],
    nodes: [S; MOST_STAGES],
    weights: [S; MOST_STAGES],
    mu: [[S; MOST_STAGES]; MOST_STAGES],
    stages: usize,
    inverse_moments: Vec3<S>,
    gyroscopic: Gyroscopic<S>, // h u × I⁻¹u
    field: F,
    worst_residual: f64,
}

impl<S: Real, F: Field<S>> Map<S> for GaussMap<S, F> {
    fn apply(&mut self, at: Time, point: &mut Point<S>) {
        let x = point.phase();
        let start = self.rise(at, &x);
        let ahead = self.rise(at.later(self.half), &(x + start * S::of(0.5)));
        // rates of the second order, from the present point alone
        let bend = ahead + start * S::of(-1.0);
        let mut rises = [Phase::zero(); MOST_STAGES];
        for (i, rise) in rises.iter_mut().take(self.stages).enumerate() {
            *rise = (start + bend * (self.nodes[i] + self.nodes[i])) * self.weights[i];
        }
        let size = self.size(at, &x, &start);
        let (rises, residual) = iterate_phases(size, rises, |rises| self.rises(at, &x, rises));
        self.worst_residual = self.worst_residual.max(residual);
        let change = self.rise_of(|_| S::of(1.0), &rises);
        point.add_momentum(change.momentum_body);
        point.add_attitude(change.attitude);
        point.renormalize_at_times();
    }

    fn worst_residual(&self) -> f64 {
        self.worst_residual
    }
}

impl<S: Real, F: Field<S>> GaussMap<S, F> {
    /// h f(x).
    #[inline]
    fn rise(&self, at: Time, x: &Phase<S>) -> Phase<S> {
        let omega = x.momentum_body.times(self.inverse_moments);
        let mut momentum = self.gyroscopic.at(x.momentum_body);
        if let Some(linear) = self.field.linear_part() {
            momentum = momentum + linear.torque(x.attitude) * self.h;
        }
        if F::HAS_REMAINDER {
            let torque = self.field.remainder(at, x.attitude.normalized(), omega);
            momentum = momentum + torque * self.h;
        }
        Phase { attitude: x.attitude.rate(omega) * self.h, momentum_body: momentum }
    }

    /// The l_i that follow from those before.
    #[inline]
    fn rises(&self, at: Time, x: &Phase<S>, before: &[Phase<S>; MOST_STAGES]) -> [Phase<S>; MOST_STAGES] {
        let mut rises = [Phase::zero(); MOST_STAGES];
        for (i, rise) in rises.iter_mut().take(self.stages).enumerate() {
            let stage = *x + self.rise_of(|j| self.mu[i][j], before);
            *rise = self.rise(at.later(self.later[i]), &stage) * self.weights[i];
        }
        rises
    }

    /// Σ_j μ_j l_j.
    #[inline]
    fn rise_of(&self, mu: impl Fn(usize) -> S, rises: &[Phase<S>; MOST_STAGES]) -> Phase<S> {
        let terms = rises.iter().take(self.stages).enumerate();
        terms.fold(Phase::zero(), |sum, (j, rise)| sum + *rise * mu(j))
    }

    /// The size of the terms that the sums of momenta are rounded at.
    fn size(&self, at: Time, x: &Phase<S>, start: &Phase<S>) -> f64 {
        let momentum = x.momentum_body.magnitude();
        // next to an equilibrium torques are differences of terms as large as the moment
        let moment = self.field.linear_part().map_or(0.0, |linear| (linear.moment * self.h).magnitude());
        let others = if F::HAS_REMAINDER {
            let omega = x.momentum_body.times(self.inverse_moments);
            (self.field.remainder(at, x.attitude, omega) * self.h).magnitude()
        } else {
            0.0
        };
        momentum.max(start.momentum_body.magnitude()) + moment + others
    }
}

//! Explicit Runge–Kutta methods on the group of rotations: each stage is a product of exponentials.

mod tableau;

pub use self::tableau::LieGroup;
use self::tableau::{Exponential, MOST_STAGES};
pub(super) use self::tableau::{of, with_bracket};
use super::{Claimed, Claims, Cost, Kept, Map, Method};
use crate::body::{Field, Point, Problem, Rotor, Time};
use crate::method::solve::impulse::turn_with_impulse;
use crate::num::{Dd, Real};
use crate::rotation::{Quat, Vec3};

impl Claimed for LieGroup {
    fn name(&self) -> String {
        self.name.into()
    }
    fn claims(&self, problem: Problem) -> Option<Claims> {
        let kept = Kept::momentum_alone(problem);
        let turns = self.stages.iter().chain([&self.last]).map(|product| product.len() as u32).sum();
        let cost = Cost::right_sides(self.stages.len() as u32) + Cost::turns(turns);
        Some(Claims::new(Some(self.order), kept, cost, self.source))
    }
}

impl<S: Real> Method<S> for LieGroup {
    type Map<F: Field<S>> = LieGroupMap<S, F>;
    fn map<F: Field<S>>(&self, h: Dd, rotor: &Rotor, field: &F) -> LieGroupMap<S, F> {
        LieGroupMap {
            h: S::from_dd(h),
            stages: self.stages.iter().map(|product| Stage::new(product, h)).collect(),
            last: Stage::new(self.last, h),
            inverse_moments: rotor.inverse_moments(),
            field: field.clone(),
        }
    }
}

/// A prepared [`LieGroup`].
#[derive(Clone, Debug)]
pub struct LieGroupMap<S, F> {
    h: S,
    stages: Vec<Stage<S>>,
    last: Stage<S>,
    inverse_moments: Vec3<S>,
    field: F,
}

/// The products of exponentials that lead to one stage.
#[derive(Clone, Debug)]
struct Stage<S> {
    /// Time of the stage after the beginning of the step, s.
    later: Dd,
    factors: Vec<Factor<S>>,
    /// What the impulses of the stages before count: on momenta in space, which commute, exponentials are sums.
    impulses: [S; MOST_STAGES],
}

/// One exponential: of Σ weight_j k_j + share k_a × k_b.
#[derive(Clone, Copy, Debug)]
struct Factor<S> {
    weights: [S; MOST_STAGES],
    bracket: Option<(usize, usize, S)>,
}

impl<S: Real> Stage<S> {
    fn new(product: &[Exponential], h: Dd) -> Self {
        let factor = |exponential: &Exponential| Factor {
            weights: exponential.weights().map(S::from_dd),
            bracket: exponential.bracket().map(|(a, b, share)| (a, b, S::from_dd(share))),
        };
        let sums = product.iter().fold([Dd::ZERO; MOST_STAGES], |sums, exponential| {
            let weights = exponential.weights();
            core::array::from_fn(|j| sums[j] + weights[j])
        });
        let node = sums.iter().fold(Dd::ZERO, |sum, weight| sum + *weight);
        let factors = product.iter().map(factor).collect();
        Stage { later: node * h, factors, impulses: sums.map(S::from_dd) }
    }

    /// The turn of the stage, k the turns of those before.
    #[inline]
    fn turn(&self, k: &[Vec3<S>; MOST_STAGES]) -> Quat<S> {
        self.factors.iter().fold(Quat::identity(), |turn, factor| {
            let mut u = sum(&factor.weights, k);
            if let Some((a, b, share)) = factor.bracket {
                u = u + k[a].cross(k[b]) * share;
            }
            turn * Quat::exponential(u)
        })
    }
}

#[inline]
fn sum<S: Real>(weights: &[S; MOST_STAGES], k: &[Vec3<S>; MOST_STAGES]) -> Vec3<S> {
    weights.iter().zip(k).fold(Vec3::zero(), |sum, (weight, k)| sum + *k * *weight)
}

impl<S: Real, F: Field<S>> Map<S> for LieGroupMap<S, F> {
    fn apply(&mut self, at: Time, x: &mut Point<S>) {
        let mut turns = [Vec3::zero(); MOST_STAGES];
        let mut impulses = [Vec3::zero(); MOST_STAGES];
        for (i, stage) in self.stages.iter().enumerate() {
            let turn = stage.turn(&turns);
            let momentum = x.momentum_body + sum(&stage.impulses, &impulses);
            let omega = turn.rotate_back(momentum).times(self.inverse_moments);
            turns[i] = omega * self.h;
            if F::ACTS {
                let torque = self.field.torque(at.later(stage.later), x.attitude * turn, omega);
                impulses[i] = turn.rotate(torque) * self.h;
            }
        }
        turn_with_impulse(x, self.last.turn(&turns), sum(&self.last.impulses, &impulses));
    }
}

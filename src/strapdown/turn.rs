//! The turn of one interval by a rule.

use super::Kind;
use super::magnus::rotation_vector;
use super::rule::Rule;
use super::stages::{Stages, Weighing};
use super::window::Sample;
use crate::num::Real;
use crate::rotation::{Quat, Vec3};

/// Samples that the two-speed rule sums over.
const SUMMED: usize = 4;

/// What a rule remembers, and how it turns the body.
#[derive(Clone, Debug)]
pub(super) struct Turner<S> {
    rule: Rule,
    kind: Kind,
    weighing: Weighing<S>,
    two_speed: TwoSpeed<S>,
}

/// One interval: its stages and the turn.
pub(super) struct Turned<'a, S> {
    pub(super) stages: &'a Stages<S>,
    /// `v_s = h ω` of each stage.
    pub(super) values: [Vec3<S>; 3],
    /// What a unit of a reading counts.
    pub(super) unit: S,
    pub(super) turn: Quat<S>,
}

impl<S: Real> Turner<S> {
    pub(super) fn new(rule: Rule, kind: Kind) -> Self {
        Turner { rule, kind, weighing: Weighing::new(rule, kind), two_speed: TwoSpeed::new() }
    }

    /// The turn from sample `k` of `samples` to the next one. `is_first`: sample `k` is the first of all.
    pub(super) fn turn(&mut self, samples: &[Sample<S>], k: usize, is_first: bool) -> Turned<'_, S> {
        let h = samples[k + 1].time - samples[k].time;
        let unit = Stages::unit(self.kind, h);
        let mut values = self.weighing.stages(samples, k, h, is_first).values(unit, samples);
        let mut turn = self.combined(&values);
        if !turn.magnitude().is_finite() {
            values = self.weighing.straight(k).values(unit, samples);
            turn = self.combined(&values);
        }
        Turned { stages: self.weighing.last(), values, unit, turn }
    }

    fn combined(&mut self, values: &[Vec3<S>; 3]) -> Quat<S> {
        let [first, second, _] = *values;
        match (self.rule, self.kind) {
            (Rule::Magnus(magnus), _) => Quat::exponential(rotation_vector(magnus.order(), values)),
            (Rule::Hold, _) => Quat::exponential(first),
            (Rule::Trapezoid, Kind::Rate) => {
                Quat::exponential((first + second) * S::of(0.5) + first.cross(second) * S::of(1.0 / 12.0))
            }
            (Rule::Trapezoid, _) => Quat::exponential(second + first.cross(second) * S::of(1.0 / 12.0)),
            (Rule::TwoSpeed, _) => self.two_speed.turn(first),
            (Rule::RungeKutta, _) => runge_kutta(first, second),
        }
    }
}

/// Coning summed over some samples: the turn since the last whole one is exp(α + β).
#[derive(Clone, Debug)]
struct TwoSpeed<S> {
    angle: Vec3<S>,  // α
    coning: Vec3<S>, // β
    last: Vec3<S>,   // δ before
    before: Quat<S>, // the turn up to the sample before
    samples: usize,
}

impl<S: Real> TwoSpeed<S> {
    fn new() -> Self {
        let zero = Vec3::zero();
        TwoSpeed { angle: zero, coning: zero, last: zero, before: Quat::identity(), samples: 0 }
    }

    fn turn(&mut self, increment: Vec3<S>) -> Quat<S> {
        if self.samples == SUMMED {
            (self.angle, self.coning, self.before) = (Vec3::zero(), Vec3::zero(), Quat::identity());
            self.samples = 0;
        }
        self.samples += 1;
        // PX4: beta += ((alpha + last/6) % delta) / 2, with alpha before delta
        let lever = self.angle + self.last * S::of(1.0 / 6.0);
        self.coning = self.coning + lever.cross(increment) * S::of(0.5);
        self.angle = self.angle + increment;
        self.last = increment;
        let whole = Quat::exponential(self.angle + self.coning);
        let turn = self.before.conjugate() * whole;
        self.before = whole;
        turn
    }
}

/// The classical step of q̇ = ½ q ω from the identity, with ω linear from `first` to `second`, both times h.
fn runge_kutta<S: Real>(first: Vec3<S>, second: Vec3<S>) -> Quat<S> {
    let half = S::of(0.5);
    let middle = (first + second) * half;
    let start = Quat::identity();
    let k1 = start.rate(first);
    let k2 = (start + k1 * half).rate(middle);
    let k3 = (start + k2 * half).rate(middle);
    let k4 = (start + k3).rate(second);
    (start + (k1 + (k2 + k3) * S::of(2.0) + k4) * S::of(1.0 / 6.0)).normalized()
}

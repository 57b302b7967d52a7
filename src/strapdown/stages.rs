//! Rates at the stages of one interval, as weighted sums of readings.

use super::Kind;
use super::rule::{Magnus, Rule};
use super::window::Sample;
use crate::num::Real;
use crate::rotation::Vec3;

/// Most samples of one polynomial: those of a rule, and two more for the estimate of its error.
pub(super) const MOST_NODES: usize = super::rule::MOST_SAMPLES + 2;

/// Stages of one interval: where they are, what they count in ∫ω dt, and the weights of the readings in each.
///
/// Stage s is `v_s = h ω(t_k + at_s h)`, h times Σ_j weights_sj reading_j, of increments without h.
#[derive(Clone, Copy, Debug)]
pub(super) struct Stages<S> {
    pub(super) count: usize,
    pub(super) at: [S; 3],
    pub(super) share: [S; 3],
    pub(super) weights: [[S; MOST_NODES]; 3],
}

impl<S: Real> Stages<S> {
    fn at(points: &[(S, S)]) -> Self {
        let zero = S::of(0.0);
        let mut stages =
            Stages { count: points.len(), at: [zero; 3], share: [zero; 3], weights: [[zero; MOST_NODES]; 3] };
        for (s, &(at, share)) in points.iter().enumerate() {
            (stages.at[s], stages.share[s]) = (at, share);
        }
        stages
    }

    /// Gauss points of [0, 1] for a Magnus series of this order.
    pub(super) fn gauss(order: u32) -> Self {
        let of = S::of;
        match order {
            2 => Self::at(&[(of(0.5), of(1.0))]),
            4 => {
                let away = of(3.0).sqrt() / of(6.0);
                Self::at(&[(of(0.5) - away, of(0.5)), (of(0.5) + away, of(0.5))])
            }
            _ => {
                let away = of(15.0).sqrt() / of(10.0);
                let (side, middle) = (of(5.0) / of(18.0), of(4.0) / of(9.0));
                Self::at(&[(of(0.5) - away, side), (of(0.5), middle), (of(0.5) + away, side)])
            }
        }
    }

    /// The same stages within `from` to `from + size` of the interval; `v_s` stays h ω.
    pub(super) fn within(mut self, from: S, size: S) -> Self {
        for at in &mut self.at[..self.count] {
            *at = from + size * *at;
        }
        self
    }

    /// Those of a rule that takes readings as they are, for the interval of length `h` from sample `k` to the next one. `is_first`:
    /// sample `k` is the first of all, of which increments and averages say nothing.
    pub(super) fn of_rival(
        rule: Rule,
        kind: Kind,
        samples: &[Sample<S>],
        k: usize,
        h: S,
        is_first: bool,
    ) -> Self {
        let of = S::of;
        let (zero, half, one) = (of(0.0), of(0.5), of(1.0));
        // an average counts for its interval, and h is that of the present one
        let spans = |j: usize| match kind {
            Kind::Average if j > 0 => (samples[j].time - samples[j - 1].time) / h,
            _ => one,
        };
        match (rule, kind) {
            (Rule::Hold, Kind::Rate) => {
                let mut stages = Self::at(&[(half, one)]);
                stages.weights[0][k] = one;
                stages
            }
            (Rule::TwoSpeed, Kind::Rate) => {
                let mut stages = Self::at(&[(half, one)]);
                (stages.weights[0][k], stages.weights[0][k + 1]) = (half, half);
                stages
            }
            (Rule::Trapezoid, Kind::Increment | Kind::Average) => {
                let mut stages = Self::at(&[(zero, zero), (half, one)]);
                // the first has none before it: θ_1 × θ_2 in place of θ_0 × θ_1
                match (is_first, samples.len() > k + 2) {
                    (false, _) => stages.weights[0][k] = spans(k),
                    (true, true) => stages.weights[0][k + 2] = -spans(k + 2),
                    (true, false) => {}
                }
                stages.weights[1][k + 1] = spans(k + 1);
                stages
            }
            (_, Kind::Increment | Kind::Average) => {
                let mut stages = Self::at(&[(half, one)]);
                stages.weights[0][k + 1] = spans(k + 1);
                stages
            }
            (_, Kind::Rate) => {
                let mut stages = Self::at(&[(zero, half), (one, half)]);
                (stages.weights[0][k], stages.weights[1][k + 1]) = (one, one);
                stages
            }
        }
    }

    /// Fills in the weights of the polynomial through the samples at `nodes`, in units of the interval from its start.
    ///
    /// Of rates they are Lagrange's ℓ_j(c) in barycentric form. Increments are differences of their running sum Θ, whose
    /// polynomial has the derivative Σ_j ℓ'_j(c) Θ_j: reading i counts Σ_{j≥i} ℓ'_j(c).
    pub(super) fn interpolate(&mut self, kind: Kind, nodes: &[S]) {
        let (one, n) = (S::of(1.0), nodes.len());
        let mut barycentric = [one; MOST_NODES];
        for j in 0..n {
            let others = (0..n).filter(|l| *l != j);
            barycentric[j] = one / others.fold(one, |product, l| product * (nodes[j] - nodes[l]));
        }
        for s in 0..self.count {
            let c = self.at[s];
            let mut inverse = [one; MOST_NODES];
            let (mut product, mut sum) = (one, S::of(0.0));
            for j in 0..n {
                inverse[j] = one / (c - nodes[j]);
                product = product * (c - nodes[j]);
                sum = sum + inverse[j];
            }
            let weights = &mut self.weights[s];
            for j in 0..n {
                weights[j] = product * barycentric[j] * inverse[j];
            }
            if kind == Kind::Rate {
                continue;
            }
            let mut slope = S::of(0.0);
            for j in (1..n).rev() {
                slope = slope + weights[j] * (sum - inverse[j]);
                weights[j] = if kind == Kind::Average { slope * (nodes[j] - nodes[j - 1]) } else { slope };
            }
            weights[0] = S::of(0.0);
        }
    }

    /// A straight line between samples `k` and `k + 1`, or the one increment between them.
    fn straighten(&mut self, kind: Kind, k: usize) {
        for s in 0..self.count {
            let mut weights = [S::of(0.0); MOST_NODES];
            let end = if kind == Kind::Rate { self.at[s] } else { S::of(1.0) };
            (weights[k], weights[k + 1]) = (S::of(1.0) - end, end);
            self.weights[s] = weights;
        }
    }

    /// What a unit of a reading counts: the interval `h`, or 1 of increments.
    pub(super) fn unit(kind: Kind, h: S) -> S {
        if kind == Kind::Increment { S::of(1.0) } else { h }
    }

    /// v_s of each stage.
    pub(super) fn values(&self, unit: S, samples: &[Sample<S>]) -> [Vec3<S>; 3] {
        let mut values = [Vec3::zero(); 3];
        for (value, weights) in values.iter_mut().zip(&self.weights).take(self.count) {
            let mut sum = Vec3::zero();
            for (sample, weight) in samples.iter().zip(weights) {
                // a large rate for a short time is no large angle
                sum = sum + sample.reading * (*weight * unit);
            }
            *value = sum;
        }
        values
    }
}

/// The stages of a rule in the interval at hand; weights of even steps are worked out once.
#[derive(Clone, Debug)]
pub(super) struct Weighing<S> {
    rule: Rule,
    kind: Kind,
    stages: Stages<S>,
    /// Nodes that the weights are of, in units of the interval from its start; none at first.
    nodes: [S; MOST_NODES],
    count: usize,
}

impl<S: Real> Weighing<S> {
    pub(super) fn new(rule: Rule, kind: Kind) -> Self {
        let order = if let Rule::Magnus(magnus) = rule { Magnus::order(magnus) } else { 2 };
        Self::with(rule, kind, Stages::gauss(order))
    }

    pub(super) fn with(rule: Rule, kind: Kind, stages: Stages<S>) -> Self {
        Weighing { rule, kind, stages, nodes: [S::of(0.0); MOST_NODES], count: 0 }
    }

    /// The stages of the interval of length `h` from sample `k` of `samples` to the next one.
    pub(super) fn stages(&mut self, samples: &[Sample<S>], k: usize, h: S, is_first: bool) -> &Stages<S> {
        if !matches!(self.rule, Rule::Magnus(_)) {
            self.stages = Stages::of_rival(self.rule, self.kind, samples, k, h, is_first);
            return &self.stages;
        }
        let mut nodes = [S::of(0.0); MOST_NODES];
        let (per_interval, start) = (S::of(1.0) / h, samples[k].time);
        for (node, sample) in nodes.iter_mut().zip(samples) {
            *node = (sample.time - start) * per_interval;
        }
        let nodes = &nodes[..samples.len()];
        // steps that differ by the rounding of their times are even
        let largest = samples.iter().map(|sample| sample.time.magnitude()).fold(0.0, f64::max);
        let rounding = 8.0 * S::ROUNDOFF * largest / h.magnitude();
        let known = &self.nodes[..self.count];
        let same = known.len() == nodes.len()
            && known.iter().zip(nodes).all(|(a, b)| (*a - *b).magnitude() <= rounding);
        if !same {
            self.stages.interpolate(self.kind, nodes);
            self.nodes[..nodes.len()].copy_from_slice(nodes);
            self.count = nodes.len();
        }
        &self.stages
    }
    /// The stages that were worked out last.
    pub(super) fn last(&self) -> &Stages<S> {
        &self.stages
    }

    /// The stages of a straight line, where those of the polynomial leave the range of a double: samples are far too uneven.
    pub(super) fn straight(&mut self, k: usize) -> &Stages<S> {
        self.stages.straighten(self.kind, k);
        self.count = 0;
        &self.stages
    }
}

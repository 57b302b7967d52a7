//! The response of the heavy ball to changes of its start at any time, from one nutation.

use std::sync::OnceLock;

use super::ball::Ball;
use super::curve::Curve;
use super::step::{Node, Response};
use super::symmetry::{Symmetry, Three};
use crate::flow::lagrange::nutation::Nutation;
use crate::flow::scaled::FOLDS;
use crate::num::{Dd, Real};

/// Most advance of τ in a step: half a nutation is at least π/2.
const STEP: f64 = 1.0;

/// Most steps where there is no period: beyond, squares of the response leave the range of a double.
const MOST_STEPS: f64 = FOLDS / STEP + 1.0;

/// Responses along one nutation, forwards and backwards, in the units of time of the nutation.
#[derive(Clone, Debug)]
pub(super) struct Passages {
    curve: Curve,
    step: f64,
    period: Option<Period>,
    ways: [OnceLock<Way>; 2],
}

#[derive(Clone, Copy, Debug)]
struct Period {
    duration: Dd,
    frequency: Dd,
    steps: f64,
}

/// Points of one nutation at equal distances in time.
#[derive(Clone, Debug)]
struct Way {
    nodes: Vec<Node>,
    /// At the start.
    symmetry: Symmetry,
    /// C, what each further nutation adds along the flows.
    growth: Three,
}

impl Passages {
    /// Of a nutation whose fastest rate is near 1, with g and ω₃.
    pub(super) fn new(nutation: &Nutation, g: f64, spin: f64) -> Self {
        let curve = Curve::new(nutation, g, spin);
        let most = STEP / curve.rate;
        let period = nutation.period().map(|duration| {
            let steps = libm::ceil(duration.hi() / most);
            Period { duration, frequency: Dd::ONE / duration, steps }
        });
        let step = period.map_or(most, |period| period.duration.hi() / period.steps);
        Passages { curve, step, period, ways: [OnceLock::new(), OnceLock::new()] }
    }

    /// At the time `t`, where the ball is at `end`; at other times it is where `place` has it, each in axes turned about e₃ by any angle.
    /// `None` where that takes too many steps.
    pub(super) fn at(&self, t: Dd, end: &Ball, place: impl Fn(f64) -> Ball) -> Option<Response> {
        let back = t < Dd::ZERO;
        let sign = if back { -1.0 } else { 1.0 };
        let Some(period @ Period { duration, frequency, .. }) = self.period else {
            return self.followed(t, end, place);
        };
        let way = self.ways[usize::from(back)].get_or_init(|| self.way(period, sign, place));
        let whole = (t * sign * frequency).floor();
        let rest = t * sign - whole * duration;
        let number = libm::floor(rest.hi() / self.step).clamp(0.0, way.nodes.len() as f64 - 1.0);
        let within = (rest - Dd::of(number * self.step)).hi();
        let (response, along, symmetry) =
            self.moved(&way.nodes[number as usize], sign * within, end, &way.symmetry);
        Some(response + symmetry.flows * (along + way.growth * whole.hi()))
    }

    /// A time `h` after a node: the response, what was split off from it, and the symmetries there.
    fn moved(&self, node: &Node, h: f64, end: &Ball, start: &Symmetry) -> (Response, Three, Symmetry) {
        let mut response = node.after(&self.curve, h, end);
        let symmetry = Symmetry::of(end, &self.curve);
        let along = node.along + symmetry.split(&mut response);
        // only growth leaves rounding in the constants
        if along.norm_squared() > 0.0 {
            symmetry.hold(start, &mut response);
        }
        (response, along, symmetry)
    }

    /// All of a nutation, forwards or backwards.
    fn way(&self, period: Period, sign: f64, place: impl Fn(f64) -> Ball) -> Way {
        let Period { duration, steps, .. } = period;
        let start = place(0.0);
        let symmetry = Symmetry::of(&start, &self.curve);
        let (mut ball, mut response, mut along) = (start, identity(), Three::zeros());
        let mut nodes = Vec::with_capacity(steps as usize);
        for n in 0..steps as u32 {
            let node = Node::new(&self.curve, &ball, &response, along);
            let [begun, ended] = [n, n + 1].map(|n| f64::from(n) * self.step);
            // at the end it is back but for turns
            let last = f64::from(n) + 1.0 >= steps;
            ball = if last { start } else { place(sign * ended) };
            let step = if last { (duration - Dd::of(begun)).hi() } else { ended - begun };
            (response, along, _) = self.moved(&node, sign * step, &ball, &symmetry);
            nodes.push(node);
        }
        let growth = symmetry.combination(&(response - identity()), &along);
        Way { nodes, symmetry, growth }
    }

    /// Step by step, where there is no period.
    fn followed(&self, t: Dd, end: &Ball, place: impl Fn(f64) -> Ball) -> Option<Response> {
        let sign = if t < Dd::ZERO { -1.0 } else { 1.0 };
        let steps = libm::floor(t.magnitude() / self.step);
        if steps > MOST_STEPS {
            return None;
        }
        let mut ball = place(0.0);
        let start = Symmetry::of(&ball, &self.curve);
        let (mut response, mut along) = (identity(), Three::zeros());
        for n in 0..steps as u32 {
            let node = Node::new(&self.curve, &ball, &response, along);
            let [begun, ended] = [n, n + 1].map(|n| sign * (f64::from(n) * self.step));
            ball = place(ended);
            (response, along, _) = self.moved(&node, ended - begun, &ball, &start);
        }
        let node = Node::new(&self.curve, &ball, &response, along);
        let within = (t - Dd::of(sign * (steps * self.step))).hi();
        let (response, along, symmetry) = self.moved(&node, within, end, &start);
        Some(response + symmetry.flows * along)
    }
}

fn identity() -> Response {
    let mut response = Response::zeros();
    response.fixed_columns_mut::<6>(0).fill_with_identity();
    response
}

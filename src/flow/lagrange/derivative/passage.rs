//! The response of the heavy ball to changes of its start at any time, from one nutation.

use std::sync::OnceLock;

use nalgebra::SMatrix;

use super::series::{Node, Response};
use super::symmetry::{Symmetry, Three};
use crate::flow::lagrange::nutation::Nutation;
use crate::num::{Dd, Real};
use crate::rotation::{Quat, Vec3};

/// Most step over the least distance of a pole, π/2Ω.
const STEP: f64 = 0.15;
/// Most turn in a step, rad.
const TURN: f64 = 0.75;
/// Most steps: where the axis nods so slowly beside the spin that a nutation takes more, it is followed no further.
pub(super) const MOST_STEPS: f64 = 20_000.0;

/// The response at a time, before the turn about e₃.
pub(super) struct Moved {
    pub(super) response: Response,
    /// How far the axes of the body have moved on about e₃, rad.
    pub(super) turn: Dd,
}

/// Responses along one nutation, forwards and backwards, in the units of time of the nutation.
#[derive(Clone, Debug)]
pub(super) struct Passages {
    g: f64,
    spin: f64,
    step: f64,
    period: Option<Period>,
    ways: [OnceLock<Way>; 2],
}

#[derive(Clone, Copy, Debug)]
struct Period {
    duration: Dd,
    steps: f64,
    /// ψ.
    turn: Dd,
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
        let most = (STEP * core::f64::consts::FRAC_PI_2 / nutation.rate.hi()).min(TURN);
        let period = nutation.period().map(|duration| {
            let [alpha, beta] = nutation.advances();
            Period { duration, steps: libm::ceil(duration.hi() / most), turn: alpha - beta }
        });
        let period = period.filter(|period| period.steps <= MOST_STEPS);
        let step = period.map_or(most, |period| period.duration.hi() / period.steps);
        Passages { g, spin, step, period, ways: [OnceLock::new(), OnceLock::new()] }
    }

    /// At the time `t`; `None` where that takes too many steps.
    pub(super) fn at(&self, nutation: &Nutation, t: Dd) -> Option<Moved> {
        let back = t < Dd::ZERO;
        let sign = if back { -1.0 } else { 1.0 };
        let Some(period @ Period { duration, turn, .. }) = self.period else {
            return self.followed(nutation, t).map(|response| Moved { response, turn: Dd::ZERO });
        };
        let way = self.ways[usize::from(back)].get_or_init(|| self.way(nutation, period, sign));
        let whole = (t * sign / duration).floor();
        let rest = t * sign - whole * duration;
        let number = libm::floor(rest.hi() / self.step).clamp(0.0, way.nodes.len() as f64 - 1.0);
        let within = (rest - Dd::product(number, self.step)).hi();
        let (end, symmetry) = self.moved(&way.nodes[number as usize], sign * within, &way.symmetry);
        let response = end.response + symmetry.flows * (end.along + way.growth * whole.hi());
        Some(Moved { response, turn: turn * whole * sign })
    }

    /// A time `h` after a node, and the symmetries there.
    fn moved(&self, node: &Node, h: f64, start: &Symmetry) -> (Node, Symmetry) {
        let mut end = node.after(h, self.g);
        let symmetry = Symmetry::of(&end, self.g);
        end.along += symmetry.split(&mut end.response);
        // only growth leaves rounding in the constants
        if end.along != Three::zeros() {
            symmetry.hold(start, &mut end.response);
        }
        (end, symmetry)
    }

    /// The largest |t| that has an answer, where there is no period.
    pub(super) fn reach(&self) -> f64 {
        MOST_STEPS * self.step
    }

    /// All of a nutation, forwards or backwards.
    fn way(&self, nutation: &Nutation, period: Period, sign: f64) -> Way {
        let Period { duration, steps, turn } = period;
        let mut nodes = vec![self.start(nutation)];
        let symmetry = Symmetry::of(&nodes[0], self.g);
        let mut end = nodes[0].clone();
        for n in 0..steps as u32 {
            let number = f64::from(n);
            if n > 0 {
                nodes.push(self.placed(nutation, sign * number, end));
            }
            let left = (duration - Dd::product(number, self.step)).hi();
            let step = if number + 1.0 < steps { self.step } else { left };
            (end, _) = self.moved(&nodes[n as usize], sign * step, &symmetry);
        }
        let change = turned(end.response, turn * sign) - identity();
        let growth = symmetry.combination(&change, &end.along);
        Way { nodes, symmetry, growth }
    }

    /// Step by step, where there is no period.
    fn followed(&self, nutation: &Nutation, t: Dd) -> Option<Response> {
        let sign = if t < Dd::ZERO { -1.0 } else { 1.0 };
        let steps = libm::floor(t.magnitude() / self.step);
        if steps > MOST_STEPS {
            return None;
        }
        let mut node = self.start(nutation);
        let start = Symmetry::of(&node, self.g);
        for n in 0..steps as u32 {
            let (end, _) = self.moved(&node, sign * self.step, &start);
            node = self.placed(nutation, sign * f64::from(n + 1), end);
        }
        let within = (t - Dd::product(sign * steps, self.step)).hi();
        let (end, symmetry) = self.moved(&node, within, &start);
        Some(end.response + symmetry.flows * end.along)
    }

    fn start(&self, nutation: &Nutation) -> Node {
        let [up, omega] = [Vec3::zero(); 2];
        self.placed(
            nutation,
            0.0,
            Node { up, below: 0.0, omega, response: identity(), along: Three::zeros() },
        )
    }

    /// The node where the closed form has it after `steps`.
    fn placed(&self, nutation: &Nutation, steps: f64, node: Node) -> Node {
        let (q, rate): (Quat<f64>, Quat<f64>) = nutation.at(Dd::product(steps, self.step));
        let Vec3([o1, o2, _]) = (q.conjugate() * rate).v * 2.0;
        let Quat { w, v: Vec3([x, y, z]) } = q;
        let below = 2.0 * (x * x + y * y);
        let up = Vec3([2.0 * (x * z - w * y), 2.0 * (y * z + w * x), 1.0 - below]);
        Node { up, below, omega: Vec3([o1, o2, self.spin]), ..node }
    }
}

fn identity() -> Response {
    let mut response = Response::zeros();
    response.fixed_columns_mut::<6>(0).fill_with_identity();
    response
}

/// The rows turned about e₃ by `angle`, rad.
pub(super) fn turned<const N: usize>(mut rows: SMatrix<f64, 6, N>, angle: Dd) -> SMatrix<f64, 6, N> {
    let (sin, cos) = crate::flow::free::reduce(angle, Dd::TAU).sin_cos();
    let (sin, cos) = (sin.hi(), cos.hi());
    for first in [0, 3] {
        for column in 0..N {
            let (x, y) = (rows[(first, column)], rows[(first + 1, column)]);
            (rows[(first, column)], rows[(first + 1, column)]) = (cos * x - sin * y, sin * x + cos * y);
        }
    }
    rows
}

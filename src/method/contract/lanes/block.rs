//! Points side by side.

use super::SideBySide;
use super::kernel::{self, Kernel};
use crate::body::Point;
use crate::num::{Instructions, LANES, Lane};

/// Numbers of a point: attitude, momentum, and what rounding carries of each.
pub(super) const PARTS: usize = 14;

/// Opened motions of one kind, which have taken the same number of steps.
#[derive(Clone, Debug)]
pub(crate) struct Block {
    kernel: Kernel,
    points: [Lane; PARTS],
    constants: Vec<Lane>,
    steps: u64,
}

impl Block {
    /// Of at most [`LANES`] points, each with the constants of its steps; lanes that are left repeat the first.
    pub(crate) fn new(kernel: &Kernel, members: &[(Point<f64>, &SideBySide<f64>)]) -> Self {
        let count = members.first().map_or(0, |(_, steps)| steps.constants.len());
        let (mut points, mut constants) = ([Lane::ZERO; PARTS], vec![Lane::ZERO; count]);
        let filled = members.iter().chain(members.first().into_iter().cycle()).take(LANES);
        for (n, (point, steps)) in filled.enumerate() {
            for (lane, part) in points.iter_mut().zip(point.parts()) {
                lane[n] = part;
            }
            for (lane, constant) in constants.iter_mut().zip(&steps.constants) {
                lane[n] = *constant;
            }
        }
        let steps = members.first().map_or(0, |(point, _)| point.steps());
        Block { kernel: kernel.clone(), points, constants, steps }
    }

    /// Steps that each body has taken.
    pub(crate) fn steps(&self) -> u64 {
        self.steps
    }

    /// The point in lane `n`.
    pub(crate) fn point(&self, n: usize) -> Point<f64> {
        Point::from_parts(self.points.map(|lane| lane[n]), self.steps)
    }

    /// Takes `n` steps.
    pub(crate) fn advance(&mut self, n: u64, instructions: Instructions) {
        let Block { kernel, points, constants, steps } = self;
        let begin = *steps;
        *steps += n;
        match instructions {
            Instructions::Widest => kernel::widest(kernel, points, constants, begin..*steps),
            Instructions::Avx2 => kernel::avx2(kernel, points, constants, begin..*steps),
            Instructions::Baseline => kernel::steps(kernel, points, constants, begin..*steps),
        }
    }
}

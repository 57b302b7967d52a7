//! Points side by side.

use super::SideBySide;
use super::acting::Acting;
use super::kernel::{self, Kernel};
use crate::body::{Clock, Point};
use crate::flow::FreeLanes;
use crate::num::{Instructions, LANES, Lane};

/// Numbers of a point: attitude, momentum, and what rounding carries of each.
pub(super) const PARTS: usize = 14;

/// Steps whose places on the orbit are held: what a block reads anew for so many is little beside their work.
const AT_ONCE: u64 = 256;

/// Opened motions of one kind, which have taken the same number of steps.
#[derive(Clone, Debug)]
pub(crate) struct Block {
    pub(super) kernel: Kernel,
    pub(super) acting: Acting,
    pub(super) clock: Clock,
    pub(super) points: [Lane; PARTS],
    pub(super) constants: Vec<Lane>,
    /// Where flows of the kernel are free.
    pub(super) free: Option<Box<FreeLanes>>,
    steps: u64,
}

impl Block {
    /// Of at most [`LANES`] points, each with the constants of its steps; lanes that are left repeat the first.
    pub(crate) fn new(clock: Clock, members: &[(Point<f64>, &SideBySide<f64>)]) -> Option<Self> {
        let (first, SideBySide { kernel, acting, constants, .. }) = members.first()?;
        let count = constants.len();
        let (mut points, mut constants) = ([Lane::ZERO; PARTS], vec![Lane::ZERO; count]);
        let filled = || members.iter().chain(members.first().into_iter().cycle()).take(LANES);
        for (n, (point, steps)) in filled().enumerate() {
            for (lane, part) in points.iter_mut().zip(point.parts()) {
                lane[n] = part;
            }
            for (lane, constant) in constants.iter_mut().zip(&steps.constants) {
                lane[n] = *constant;
            }
        }
        let free = filled().filter_map(|(_, steps)| steps.free.as_deref());
        let free = kernel.takes_free_flows().then(|| FreeLanes::new(free).map(Box::new)).flatten();
        let (kernel, acting, steps) = (kernel.clone(), acting.clone(), first.steps());
        Some(Block { kernel, acting, clock, points, constants, free, steps })
    }

    /// The point in lane `n`.
    pub(crate) fn point(&self, n: usize) -> Point<f64> {
        Point::from_parts(self.points.map(|lane| lane[n]), self.steps)
    }

    /// Steps until each of `blocks`, which are of one kind, has taken `steps`. Where their bodies are on the orbit is worked out once.
    pub(crate) fn advance_to(blocks: &mut [Block], steps: u64, instructions: Instructions) {
        while let Some(first) = blocks.first()
            && first.steps < steps
        {
            let most = if first.acting.is_on_orbit() { AT_ONCE } else { u64::MAX };
            let range = first.steps..steps.min(first.steps.saturating_add(most));
            let places = first.kernel.places(&first.acting, &first.clock, range.clone());
            for block in &mut *blocks {
                match instructions {
                    Instructions::Widest => kernel::widest(block, &places, range.clone()),
                    Instructions::Avx2 => kernel::avx2(block, &places, range.clone()),
                    Instructions::Baseline => kernel::baseline(block, &places, range.clone()),
                }
                block.steps = range.end;
            }
        }
    }
}

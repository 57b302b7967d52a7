//! Explicit steps of many bodies at once: one lane for each body, in loops that the compiler turns into the widest
//! vector instructions there are.
//!
//! A lane is moved by the text that moves a single point, so that it has its bits. There is no fused multiply-add, which
//! would round otherwise: the bits are those of every other set of instructions, too.

mod acting;
mod block;
mod dmv;
mod kernel;
mod stages;

use self::acting::Acting;
pub(crate) use self::block::Block;
pub(crate) use self::kernel::{Kernel, LaneFlow, Width};
use crate::body::Body;
use crate::flow::FreeFlow;
use crate::num::Dd;

/// How the steps of an opened map are taken side by side with those of other bodies.
///
/// Bodies whose steps are of one kind share a block. What differs between them are numbers.
#[derive(Clone, Debug)]
pub struct SideBySide<S> {
    kernel: Kernel,
    acting: Acting,
    /// What the kernel reads of each body: with forces their numbers first.
    constants: Vec<S>,
    /// Of the body, where flows of the kernel are free.
    free: Option<Box<FreeFlow<S>>>,
}

impl<S> SideBySide<S> {
    pub(crate) fn new(kernel: Kernel, constants: Vec<S>) -> Self {
        SideBySide { kernel, acting: Acting::default(), constants, free: None }
    }

    /// Flows one after another, each with its constant.
    pub(crate) fn flows(flows: impl IntoIterator<Item = (LaneFlow, S)>) -> Self {
        let (flows, constants) = flows.into_iter().unzip();
        SideBySide::new(Kernel::Flows(flows), constants)
    }

    /// The free flow for the time `t`, and what follows it.
    pub(crate) fn free(flow: FreeFlow<S>, t: S, rest: impl IntoIterator<Item = (LaneFlow, S)>) -> Self {
        let flows = [(LaneFlow::Free, t)].into_iter().chain(rest);
        SideBySide { free: Some(Box::new(flow)), ..SideBySide::flows(flows) }
    }

    /// `flows` one after another, which read `constants` in turn.
    pub(crate) fn reading(flows: Vec<LaneFlow>, constants: Vec<S>) -> Self {
        SideBySide::new(Kernel::Flows(flows), constants)
    }

    /// `parts` one after another, each with the time at which it begins, s since the beginning of the step; `None` if one is no flow.
    pub(crate) fn chained(parts: impl IntoIterator<Item = (Dd, Self)>) -> Option<Self> {
        let (mut all, mut constants, mut free) = (Vec::new(), Vec::new(), None);
        for (begun, part) in parts {
            let Kernel::Flows(flows) = part.kernel else { return None };
            all.extend(flows.into_iter().map(|flow| flow.later(begun)));
            constants.extend(part.constants);
            free = free.or(part.free);
        }
        Some(SideBySide { free, ..SideBySide::new(Kernel::Flows(all), constants) })
    }

    /// Whether a body whose steps are of `other` may share a block.
    pub(crate) fn is_like(&self, other: &Self) -> bool {
        self.kernel == other.kernel && self.acting == other.acting
    }
}

impl SideBySide<f64> {
    /// The steps of `body`, with what acts on it; `None` where not all of that can be taken side by side.
    pub(crate) fn of(self, body: &Body) -> Option<Self> {
        if !self.kernel.takes_forces() {
            return Some(self);
        }
        let (acting, numbers) = Acting::of(&body.known_forces()?);
        let constants = numbers.into_iter().chain(self.constants).collect();
        Some(SideBySide { acting, constants, ..self })
    }
}

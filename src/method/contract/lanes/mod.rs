//! Explicit steps of many free bodies at once: one lane for each body, in loops that the compiler turns into the widest
//! vector instructions there are.
//!
//! A lane is moved by the text that moves a single point, so that it has its bits. There is no fused multiply-add, which
//! would round otherwise: the bits are those of every other set of instructions, too. The benchmark `ensemble` prints what
//! that costs.

mod block;
mod kernel;

pub(crate) use self::block::Block;
pub(crate) use self::kernel::{Kernel, Width};

/// How the steps of an opened map are taken side by side with those of other bodies.
///
/// Bodies whose steps are of one kind share a block. What differs between them are numbers.
#[derive(Clone, Debug)]
pub struct SideBySide<S> {
    pub(crate) kernel: Kernel,
    /// What the kernel reads of each body.
    pub(crate) constants: Vec<S>,
}

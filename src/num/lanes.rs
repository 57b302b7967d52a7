//! Numbers side by side, in loops that the compiler turns into vector instructions.
//!
//! What is done in lanes is written for one number and put into a loop over all of them, in a function that is compiled for
//! several sets of instructions. There is no fused multiply-add, which would round otherwise, and no function with a closure,
//! which would not be compiled for the instructions of its caller.

use core::ops::{Deref, DerefMut};

/// Lanes of a block: its loops fill the longest vectors many times over, and its numbers stay in the first cache.
pub(crate) const LANES: usize = 64;

/// One number for each lane of a block. It begins with a cache line: else half of the vectors would lie across two.
#[derive(Clone, Copy, Debug)]
#[repr(align(64))]
pub(crate) struct Lane([f64; LANES]);

impl Lane {
    pub(crate) const ZERO: Lane = Lane([0.0; LANES]);
}

impl Deref for Lane {
    type Target = [f64; LANES];
    #[inline(always)]
    fn deref(&self) -> &[f64; LANES] {
        &self.0
    }
}

impl DerefMut for Lane {
    #[inline(always)]
    fn deref_mut(&mut self) -> &mut [f64; LANES] {
        &mut self.0
    }
}

/// Sets of vector instructions. All give the same bits; the narrower ones are there to compare.
///
/// ```
/// use polhode::num::Instructions;
/// use polhode::run::Ensemble;
/// let portable = Ensemble::new().by(Instructions::Baseline);
/// assert!(portable.is_empty());
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[non_exhaustive]
pub enum Instructions {
    /// The widest that the processor has.
    #[default]
    Widest,
    /// Nothing beyond AVX2.
    Avx2,
    /// What the program was compiled for: SSE2 on x86-64 and NEON on 64-bit ARM, unless said otherwise.
    Baseline,
}

//! Numbers side by side, in loops that the compiler turns into vector instructions.
//!
//! What is done in lanes is written for one number and put into a loop over all of them, in a function that is compiled for
//! several sets of instructions. There is no fused multiply-add, which would round otherwise, and no function with a closure,
//! which would not be compiled for the instructions of its caller.

/// Lanes of a block: its loops fill the longest vectors many times over, and its numbers stay in the first cache.
pub(crate) const LANES: usize = 64;

/// One number for each lane of a block.
pub(crate) type Lane = [f64; LANES];

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

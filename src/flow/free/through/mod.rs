//! The free motions that lead from one attitude to another.
//!
//! With L = Q₀m₀ = Q₁m₁ the momentum at the end is m₁ = Rᵀm₀, R = Q₀ᵀQ₁: its direction follows from that at the start. The energy
//! is the same, so m₀ lies on the cone `m·(R I⁻¹ Rᵀ − I⁻¹) m = 0`; on its polhode it goes from one known place to another, so
//! that its size is known but for whole periods; and what then is left of the attitude is a turn about L. This makes one equation
//! in one unknown for each number of periods, whose roots are all solutions.
//!
//! We found no earlier method that finds all of them.

mod branch;
mod cone;
mod cubic;
mod fitted;
mod interpolation;
mod passages;
mod search;

pub use fitted::FittedMotion;
pub use interpolation::Interpolation;
pub use passages::{Passage, Passages, ThroughError};

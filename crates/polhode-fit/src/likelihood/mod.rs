//! Maximum likelihood on the exact motion of a free body.
//!
//! Attitudes and rates are those of the free motion Q(t), ω(t) of a tensor J = J(x) from a start (Q₀, ω₀) at the middle of each
//! stretch; an alignment a takes coordinates along the body axes of the attitudes to those of the tensor. What is left of a sample is
//!
//! `r = log((Q a)* q)` of an attitude q, and `r = w − ω` of rates w.
//!
//! With normal noise, q = Q a exp(e), the likelihood is that of least squares. Of a turn Q → Q exp(δ) and an alignment a → a exp(ψ)
//! r changes by −J(r)⁻¹ (aᵀδ + ψ), and as J(r)⁻ᵀ r = r the gradient is exact where J(r) is taken for 1. The derivatives of Q and ω are
//! those of the closed form.
//!
//! The sum of squares has many minima, one for each number of turns that the motion may be ahead or behind: windows that double about
//! the middle of the stretches keep the motion within a part of a turn of the samples.
//!
//! | here | meaning |
//! |---|---|
//! | x | coordinates of the tensor |
//! | start | rotation vector and rate at the middle of a stretch, three numbers each |
//! | common | x and the alignment, which all stretches share |

pub(crate) mod alignment;
pub(crate) mod alternatives;
pub(crate) mod bend;
pub(crate) mod choice;
pub(crate) mod descent;
pub(crate) mod growth;
pub(crate) mod invariants;
pub(crate) mod local;
pub(crate) mod momentum;
pub(crate) mod motion;
pub(crate) mod profile;
pub(crate) mod readings;
pub(crate) mod sums;
pub(crate) mod track;
pub(crate) mod wheels;

#[cfg(test)]
mod tests;

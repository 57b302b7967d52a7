//! The Cramér–Rao bound: what no unbiased estimator can undercut.
//!
//! F = σ⁻² Σ Sᵢᵀ Sᵢ with S = ∂ω/∂(x, ω₀) from the variational equations of J ω' = J ω × ω; each segment has an ω₀ of its
//! own, which the Schur complement takes out.

pub(crate) mod attitudes;
pub(crate) mod motions;
pub(crate) mod nearest_motion;
pub(crate) mod planned;
pub(crate) mod sensitivity;

#[cfg(test)]
mod tests;

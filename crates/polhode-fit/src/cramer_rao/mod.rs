//! The Cramér–Rao bound: what no unbiased estimator can undercut.
//!
//! F = σ⁻² Σ Sᵢᵀ Sᵢ with S = ∂ω/∂(x, ω₀) from the variational equations of J ω' = J ω × ω; each segment has an ω₀ of its
//! own, which the Schur complement takes out.

mod bound;
mod nearest_motion;
mod planned;
mod sensitivity;

pub(crate) use bound::Motions;
pub use bound::foreseen_bound;
pub use planned::foreseen_bound_with;

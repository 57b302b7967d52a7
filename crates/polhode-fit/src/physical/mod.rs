//! The nearest physical tensor: a semidefinite program in whitened increments, by outer approximation.
//!
//! The law ½ − J ⪰ 0 is a semidefinite cone, which is approached from outside, since a solver's own such cone would need
//! BLAS and LAPACK; answers agree with those of one (tests/data/fit/semidefinite.py).
//!
//! x = x̂ + R⁻¹ y with Rᵀ R the information, so that the objective is ½|y|² whatever the conditioning: in raw entries
//! a solver stops at its tolerance long before the badly determined directions have settled. With trace 1 the one
//! physical law is λ_max(J) ≤ ½; it enters as rows vᵀ J v ≤ ½ along principal axes that break it, of x̂ and of each answer,
//! and as second-order cones (2×2 minors of ½ − J in the eigenbasis of the last answer), added until the violation is
//! at most 1e-9.
//! Newton's method on the active face then takes the answer to rounding, and its optimality is certified here, not by
//! the solver's status.
//!
//! | here | meaning |
//! |---|---|
//! | y | increments in standard deviations |
//! | g | gradient of a linear reading of J with respect to y |
//! | Z | multiplier of ½ − J ⪰ 0 on its null space |

pub(crate) mod certificate;
mod conic;
pub(crate) mod constraint;
pub(crate) mod coordinates;
pub(crate) mod dissipation;
pub(crate) mod face;
pub(crate) mod failure;
pub(crate) mod law;
pub(crate) mod limits;
pub(crate) mod nearest;
pub(crate) mod prior;
mod program;
pub(crate) mod truncated;

//! The weak form of Euler's equation: nothing is differentiated.
//!
//! J ω' + ω × J ω = 0, multiplied by a test function φ of compact support and integrated by parts, is
//! ∫ (−φ' J ω + φ ω × J ω) dt = 0: linear in J, and free of bias to first order in the noise of ω.
//!
//! The noise n of the samples enters test m as Σ_i A_mi n_i with A_mi = w_i (−φ'_m J + φ_m ([ω]ₓ J − [J ω]ₓ)), so the
//! residuals have the banded covariance C = Σ_i A_mi A_m'iᵀ (times σ²). Each round solves the least-squares problem
//! weighted by C⁻¹ at the samples ω − n̂ that the round before left on the constraints, n̂ = Aᵀ C⁻¹ r. Its fixed
//! point minimises |n|² subject to the weak equations (Gauss–Helmert), which weights at the raw samples do not.
//!
//! Torques and errors of the sensor are further unknowns, one column of G each. White torque noise of density ρ adds
//! ρ ∫ φ_m φ_m' dt to C, in the same band. From ρ = ∞, where the weights do not depend on J and the problem is convex, the
//! rounds descend to the ρ of the largest restricted likelihood. There its effect is taken out of G, as the noise of the
//! samples is.
//!
//! | here | meaning |
//! |---|---|
//! | r, G | residuals of the weak equations, and their derivatives with respect to the coordinates x of J |
//! | H | Gᵀ C⁻¹ G: information, in units of 1/σ² |
//! | V | what the noise in G adds to H at raw samples, in expectation and in units of 1/σ² |
//! | D | Dᵀ D is what errors of the mean rates may add to H where nothing but their mean stands out of the noise |

pub(crate) mod blocks;
pub(crate) mod completed;
pub(crate) mod driven;
pub(crate) mod held;
pub(crate) mod joint;
pub(crate) mod ladder;
pub(crate) mod levels;
pub(crate) mod linearised;
pub(crate) mod radius;
pub(crate) mod rounds;
pub(crate) mod rows;
pub(crate) mod stacked;
pub(crate) mod triangle;
pub(crate) mod weak_estimate;

#[cfg(test)]
mod tests;

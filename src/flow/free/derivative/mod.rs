//! The derivative of the free motion by its start and by the inertia tensor, in closed form and in every regime.
//!
//! # Notation
//! As in [`polhode`](super::polhode): a, b, c the axis about which m circulates, the middle axis and the third; further
//!
//! | letter | meaning |
//! |---|---|
//! | κ_k | coefficients of Euler's equations ṁ_a = κ_a m_b m_c and so on, κ_a = ±(1/I_c − 1/I_b) |
//! | α, β, γ | κ_bκ_c, κ_aκ_c, κ_aκ_b |
//! | p, q | ν² and k²ν²: `β m_b² − α m_a²` and `β m_b² − γ m_c²`, sums of terms of one sign |
//! | s, c, d | sn(ντ)/ν, cn(ντ), dn(ντ) |
//! | T, V | ∫s² dτ, ∫(s/d)² dτ |
//! | r | `1 − β s² m_b² = c² − α m_a² s²` |
//!
//! # The momentum
//! The addition theorem gives the momentum after the time τ without a phase at the start:
//!
//! `m_a' = (m_a d + κ_a s c m_b m_c)/r`, `m_b' = (m_b c d + κ_b s m_a m_c)/r`, `m_c' = (m_c c + κ_c s d m_a m_b)/r`.
//!
//! Nothing here divides by a difference of moments or by an amplitude, so that it and its derivatives hold for asymmetric and
//! symmetric bodies, spheres, steady spins and the separatrix alike. It depends on the tensor through κ alone; s, c and d depend on
//! (τ, p, q), and of their derivatives only V is new: `∂s/∂q = −½ c d V`, and by p follows from the change of scale.
//!
//! # The products of inertia
//! turn the principal axes, by an angle that is not defined where two moments are equal. By δI the energy changes by −½ ω·δI ω, and
//! the momentum by the flow of its integral over the time; of the end y, seen backwards, that is
//! `δm = y × ∂/∂y ∫ m_i m_j dτ / (I_i I_j)`, where the integral `(m_k' − m_k)/κ_k` is a quotient whose numerator has κ_k as a factor.
//!
//! # The attitude
//! With δQ = \[δθ\]× Q the momentum in space changes by δL = Q δm + δθ × L, a constant: this gives δθ across L. Along L
//! `d(δθ·L)/dt = ω·δm − ω·δI ω`, and as the energy is constant, `ω·δm − ½ ω·δI ω` is a constant too: no derivative of the phase is
//! needed, and for a given tensor `δθ·L` grows in proportion to the time. There are left the integrals of ω_i ω_j, of which T is
//! the only one of the second kind.
//!
//! We found no earlier closed form of this derivative.

#[cfg(test)]
#[allow(clippy::panic)]
mod differences;
mod functions;
mod momentum;
mod scaled;
mod tangent;
mod transition;
mod variation;

pub(super) use transition::Derivative;
pub use transition::StateDerivative;
pub(super) use variation::Variation;

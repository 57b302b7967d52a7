//! The derivative of the motion of Lagrange's top by its start and by its constants, in every regime.
//!
//! # Notation
//! As in [`nutation`](super::nutation): the heavy ball (A, A, A) of the same m, with e₃ along the weight moment; further
//!
//! | letter | meaning |
//! |---|---|
//! | Γ, ω, g | the vertical in the body, m/A, c/A |
//! | δθ, δω | the small turn of the ball and the change of ω, both in the body |
//! | T, ψ | period of the nutation, and the turn about e₃ by which Γ and ω have moved on after it |
//! | D(t) | 6 × 7: δθ and δω at t by δθ and δω at the start and by δg |
//!
//! # The ball
//! The ball obeys `Γ' = Γ × ω`, `ω' = g Γ × e₃`, and changes of its motion
//!
//! `δθ' = δω − ω × δθ`, `δω' = g (Γ × δθ) × e₃ + δg Γ × e₃`.
//!
//! Both are solved within one nutation by Taylor series about points of the closed form. All of it is analytic where zeros of
//! the cubic meet: steady precession, the vertical and the separatrix are ordinary motions. The nearest singularities are the poles
//! of the closed form, K'/Ω ≥ π/2Ω away from the real axis, which bounds the steps.
//!
//! # Any time
//! After a nutation the motion repeats but for turns about the vertical and about e₃, of which the equations do not know. What D(T),
//! turned back by ψ, has beside the identity comes from the derivatives of T, of ψ and of the precession by the constants of the
//! motion: it is `F C`, the [flows](symmetry) F of these constants at the start times a constant matrix C. Flows go on as flows, and leave
//! constants alone: after n nutations and the time s
//!
//! `D(nT + s) = R₃(−nψ) (D(s) + n F(s) C)`,
//!
//! with nT and nψ reduced in double-double. Next to the separatrix, where the response grows and shrinks again, it is held to the values
//! of the constants, which do not.
//!
//! # The top
//! turns about e₃ by `t m₃ (1/C − 1/A)` more, and its rates scale: `ω = m/A`, `g = c/A`.
//!
//! We found no earlier implementation of this derivative.

mod passage;
mod series;
mod symmetry;
mod transition;
mod vertical;

pub(super) use transition::Derivative;
pub use transition::TopDerivative;

//! The derivative of the motion of Lagrange's top by its start and by its constants, in every regime.
//!
//! # Notation
//! As in [`nutation`](super::nutation): the heavy ball (A, A, A) of the same m, with e₃ along the weight moment; further
//!
//! | letter | meaning |
//! |---|---|
//! | Γ, ω, g | the vertical in the body, m/A, c/A |
//! | δθ, δω | the small turn of the ball and the change of ω, both in the body |
//! | P, χ | period of the nutation, and the turn about e₃ by which Γ and ω have moved on after it |
//! | D(t) | 6 × 7: δθ and δω at t by δθ and δω at the start and by δg |
//!
//! Further, after the time h of a part of the nutation,
//!
//! | letter | meaning |
//! |---|---|
//! | f | α, β, or (ω₁ + iω₂) e^{iat/2}; f vanishes where u has the value u_f: −1, 1, u_ζ |
//! | μ₁, μ₂, μ₃ | (b/4)(u_j − u_f), zeros of `μ³ + Aμ² + Bμ − ϖ²` |
//! | p, q | Ω², k²Ω² |
//! | s, c, d | sn(Ωh)/Ω, cn(Ωh), dn(Ωh) |
//! | T, V, U | ∫s², ∫(s/d)², ∫(s/c)² = s³/cd − T − V over h |
//! | r, k | c² + (b/4)(u₃ − u) s², (cd + (b/8) u' s³)/r, of u and u' at the start |
//! | n², ψ | c² + μ₃s² = 1 + μ₁s², ∫ϖs²/n² over h |
//!
//! # A part of the nutation
//! The three functions obey Lamé's equation `f'' = (g u − λ) f` with three constants λ. σ-functions give each from its start, by the addition
//! theorem of ζ, without a phase of the start:
//!
//! `f(h) = e^{iψ} (k f + s f')/n`, where k and s are the same for all.
//!
//! The motion itself is known, and with it e^{iψ} of α and β; for that of ω₁ + iω₂, which may be too small to tell it,
//! `ψ_β − ψ_α − ψ_ζ + ah/2 = arg (cd + i s (a/2 − (b/8)(m·Γ/A − au₁) s²))`. Of its changes we use
//!
//! `δs = ½ cd J − ½ s³ δp`, `J = T δp + V δ(p − q)`,
//! `δψ = (ϖ/2n²) (T δμ₁/μ₁ + d²V δμ₂/μ₂ + c²U δμ₃/μ₃)`;
//!
//! the second, in which a third-kind integral has only second-kind ones left, follows by derivation under the integral and integration by parts.
//! ϖ δμ_j/μ_j is a quotient of polynomials over the differences μ_j − μ_i, which stays finite where ϖ and μ_j vanish. Where two zeros meet, each has
//! a derivative that depends on the direction, but is multiplied by the same function of h as the other, and their sum is smooth.
//! So steady precession, passages through the vertical and the separatrix are ordinary motions.
//! A nutation is composed of parts of Ωh ≤ 1, in which n² stays clear of zero.
//!
//! # Any time
//! After a nutation the motion repeats but for turns about the vertical and about e₃, of which the equations do not know. What D(P),
//! turned back by χ, has beside the identity comes from the derivatives of P, of χ and of the precession by the constants of the
//! motion: it is `F C`, the [flows](symmetry) F of these constants at the start times a constant matrix C. Flows go on as flows, and leave
//! constants alone: after n nutations and the time s
//!
//! `D(nP + s) = R₃(−nχ) (D(s) + n F(s) C)`,
//!
//! where the turn R₃ is taken from the motion. Next to the separatrix, where the response grows and shrinks again, it is held to the values
//! of the constants, which do not.
//!
//! # The top
//! turns about e₃ by `t m₃ (1/C − 1/A)` more, and its rates scale: `ω = m/A`, `g = c/A`.
//!
//! We found no earlier implementation of this derivative.

mod ball;
mod curve;
mod elapsed;
mod passage;
mod scaled;
mod step;
mod symmetry;
mod transition;
mod vertical;

/// Numbers that belong to the columns of a response; the last is empty.
type Row = [f64; 8];

pub(super) use transition::Derivative;
pub use transition::TopDerivative;

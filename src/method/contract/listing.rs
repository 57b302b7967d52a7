//! What a table of methods says of each: its file, and one step as a formula.

use crate::method::phase::TAKEN_BACK;

/// A method of the catalogue, as a table shows it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub struct Listing {
    /// The family that it belongs to, as `explicit Runge-Kutta` or `splitting`; `simulator` are the steps that a simulator has
    /// of its own, `error control` are methods that choose their steps.
    pub family: &'static str,
    /// The file in which it is written, from the root of the sources.
    pub file: &'static str,
    /// One step of size h, from x = (m, q) to x' = (m', q'), with ω = I⁻¹m and the torque τ.
    pub formula: &'static str,
}

/// What tables say of the method called `name`, whatever its argument and scheme; `None` where there is no such method.
///
/// ```
/// use polhode::method::listing;
/// assert_eq!(listing("lie-poisson:321@suzuki-4").map(|listing| listing.file), Some("src/method/lie_poisson/mod.rs"));
/// assert_eq!(listing("rattle+phase").map(|listing| listing.family), Some("phase taken back"));
/// assert_eq!(listing("rk5"), None);
/// ```
#[must_use]
pub fn listing(name: &str) -> Option<Listing> {
    let taken_back = name.strip_suffix(TAKEN_BACK);
    let base = taken_back.unwrap_or(name).split([':', '@']).next()?;
    let found = LISTINGS.iter().find(|(known, ..)| *known == base);
    let own = found.map(|&(_, family, file, formula)| Listing { family, file, formula })?;
    Some(if taken_back.is_some() { CORRECTED } else { own })
}

/// Of any method whose departure from the exact motion is taken back.
const CORRECTED: Listing = Listing {
    family: "phase taken back",
    file: "src/method/phase/corrected.rs",
    formula: "steps of the method before +phase; at output their departure from the exact motion is taken back",
};

/// Base of the name, family, file, formula; `exact` is the closed form.
const LISTINGS: [(&str, &str, &str, &str); 32] = [
    (
        "exact",
        "closed form",
        "src/flow/exact_motion.rs",
        "x(t) at any t, by Jacobi's elliptic and theta functions",
    ),
    ("explicit-euler", "first order", "src/method/explicit_euler.rs", "x' = x + h f(x)"),
    (
        "semi-implicit-euler",
        "first order",
        "src/method/semi_implicit_euler.rs",
        "m' = m + h (m × ω + τ), q' = norm(q + h/2 q ω')",
    ),
    ("rk4", "explicit Runge-Kutta", "src/method/rk4.rs", "x' = x + h/6 (k₁ + 2k₂ + 2k₃ + k₄)"),
    ("rk4-normalized", "explicit Runge-Kutta", "src/method/rk4.rs", "rk4, then q' divided by its norm"),
    (
        "rk4-projected",
        "explicit Runge-Kutta",
        "src/method/rk4_projected.rs",
        "rk4-normalized, then m' + λ₁ I⁻¹m' + λ₂ m' with energy and length of m",
    ),
    ("rk8", "explicit Runge-Kutta", "src/method/rk8.rs", "x' = x + h Σ bₙ kₙ, 12 stages"),
    (
        "tsit5",
        "error control",
        "src/method/tsit5.rs",
        "x' = x + h Σ bₙ kₙ, 6 stages, h by an error estimate of order 4",
    ),
    (
        "dop853",
        "error control",
        "src/method/dop853.rs",
        "x' = x + h Σ bₙ kₙ, 12 stages, h by error estimates of orders 5 and 3",
    ),
    (
        "implicit-midpoint",
        "implicit Runge-Kutta",
        "src/method/implicit_midpoint.rs",
        "m' = m + h n × I⁻¹n, q' = q cay(h/2 I⁻¹n), n = (m + m')/2",
    ),
    (
        "rattle",
        "variational",
        "src/method/rattle.rs",
        "u = (1 + c²) m + u × c, c = h/2 I⁻¹u; m' = m + 2/(1 + c²) u × c, q' = q cay(c)",
    ),
    (
        "dmv",
        "variational",
        "src/method/dmv/mod.rs",
        "rattle with the reciprocal moments s/I + d, s and d series in h²",
    ),
    (
        "lie-poisson",
        "splitting",
        "src/method/lie_poisson/mod.rs",
        "R₁(h/2) R₂(h/2) R₃(h) R₂(h/2) R₁(h/2), Rᵢ the turn of mᵢ²/(2Iᵢ)",
    ),
    ("no-squish", "splitting", "src/method/lie_poisson/mod.rs", "R₃(h/2) R₂(h/2) R₁(h) R₂(h/2) R₃(h/2)"),
    (
        "lie-poisson-projected",
        "splitting",
        "src/method/lie_poisson_projected.rs",
        "lie-poisson between two equal shifts λ₁ I⁻¹m + λ₂ m that return energy and length of m",
    ),
    (
        "two-turn",
        "splitting",
        "src/method/two_turn.rs",
        "C(h) R₁(h/2) R₂(h) R₁(h/2), Rᵢ turns about two axes, C the turn about L",
    ),
    (
        "exact-step",
        "closed form",
        "src/method/exact_step.rs",
        "m' by the addition theorem of Jacobi's functions, q' = q p, pᵢ in proportion to (s/Iᵢ + d) (mᵢ + mᵢ')",
    ),
    (
        "kick-drift",
        "splitting",
        "src/method/kick_drift.rs",
        "K(h/2) D(h) K(h/2), K the kick of the forces, D the exact free flow",
    ),
    ("taylor", "error control", "src/method/taylor/mod.rs", "x' = x + Σ hⁿ xₙ, xₙ by recurrence"),
    (
        "gauss",
        "implicit Runge-Kutta",
        "src/method/gauss/mod.rs",
        "x' = x + h Σ bᵢ f(xᵢ), xᵢ = x + h Σ aᵢⱼ f(xⱼ), at Gauss's nodes",
    ),
    (
        "rkmk4",
        "Lie group",
        "src/method/rkmk4.rs",
        "q' = q exp((k₁ + 2k₂ + 2k₃ + k₄)/6 + k₁ × k₄/12), kᵢ = h ωᵢ, L' = L + its torques",
    ),
    (
        "commutator-free-4",
        "Lie group",
        "src/method/commutator_free_4.rs",
        "q' = q exp(k₁/4 + k₂/6 + k₃/6 − k₄/12) exp(−k₁/12 + k₂/6 + k₃/6 + k₄/4)",
    ),
    (
        "crouch-grossman-3",
        "Lie group",
        "src/method/crouch_grossman_3.rs",
        "q' = q exp(13/51 k₁) exp(−2/3 k₂) exp(24/17 k₃)",
    ),
    (
        "momentum-euler",
        "simulator",
        "src/method/momentum_euler.rs",
        "m' = m + h m × ω brought back to the length of m, + h τ; q' = q exp(h ω')",
    ),
    ("buss-2", "simulator", "src/method/buss_2.rs", "q' = q exp(h (ω + h/2 dω/dt)), L' = L + its torques"),
    (
        "buss-2-augmented",
        "simulator",
        "src/method/buss_2.rs",
        "q' = q exp(h (ω + h/2 dω/dt + h²/12 dω/dt × ω)), L' = L + its torques",
    ),
    (
        "richardson",
        "simulator",
        "src/method/richardson.rs",
        "q' = norm(2r − p), p one step of h and r two of h/2 of q + h/2 ω q, L constant",
    ),
    (
        "mujoco-rk4",
        "simulator",
        "src/method/mujoco_rk4.rs",
        "m' by rk4; q' = q exp(h/6 (k₁ + 2k₂ + 2k₃ + k₄)), kᵢ = ωᵢ + uᵢ × ωᵢ/2 + uᵢ × (uᵢ × ωᵢ)/12",
    ),
    (
        "linearly-implicit-euler",
        "simulator",
        "src/method/linearly_implicit_euler.rs",
        "m' = m + h k, (1 − h J) k = m × ω + τ, J δ = δ × ω + m × I⁻¹δ; q' = q exp(h ω')",
    ),
    (
        "dissipating",
        "inner friction",
        "src/method/dissipating.rs",
        "D(h/2) F(h) D(h/2), D the exact free flow, F the exact flow of the friction",
    ),
    (
        "lie-newmark",
        "Lie group",
        "src/method/lie_newmark.rs",
        "n = m + h/2 (m × ω + τ), q' = q cay(h/2 I⁻¹n), m' = n + h/2 (m' × ω' + τ')",
    ),
    (
        "variational-cayley",
        "variational",
        "src/method/variational_cayley.rs",
        "u = m + u × c − (u·c) c, c = h/2 I⁻¹u; m' = m + 2 u × c, q' = q cay(c)",
    ),
];

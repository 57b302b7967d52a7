//! The level of the energy on the sphere |m| = G that the momentum moves along, and its invariants.
//!
//! Lengths are divided by G and rates by a power of two S, so that n = m/G runs on the unit sphere and the time is
//! τ = S G t. A part of the inverse moments that all three share turns the body about L alone; with b_k = a_k − a_μ,
//! a_k = 1/I_k, and γ_k = a_k h_k/G
//!
//! `n' = n × ν`, `ν = b n − γ`, `ω/G = ν + a_μ n`.
//!
//! In axes (e₁, e₂, n₀) with e₁ along the part of ν₀ across n₀ and `ζ = (n₁ + i n₂)/(1 + n₃)` the level is a biquadratic
//! `f₀ + f₁ζ̄ + f₂ζ̄² = 0`, whose discriminant gives the motion of ζ alone, `ζ'² = −¼ (f₁² − 4 f₀f₂) = Q(ζ)`:
//!
//! `f₀ = p ζ + β ζ²`, `f₁ = p + 2κζ − r ζ²`, `f₂ = β̄ − r̄ ζ + 2γ₃ ζ²`,
//! `p = α − c`, `r = α + c`, `κ = ½(A₁₁ + A₂₂) − A₃₃ + γ₃`, `α = A₁₃ − iA₂₃`, `β = ½(A₁₁ − A₂₂) − iA₁₂`, `c = γ₁ − iγ₂`
//!
//! with A the tensor diag(b) in these axes; p is real by their choice. The same elliptic curve is y² = P(μ),
//!
//! `P(μ) = −Σ_k (ν_k − μ n_k)² Π_{j≠k} (b_j − μ)`,
//!
//! the determinant of the pencil of the two quadrics (energy and sphere), and dτ = dμ/√P on it.

use super::pencil::{Pencil, WideCurve};
use crate::num::complex::Complex;
use crate::num::{Dd, Real};
use crate::rotation::Vec3;

/// Differences of the inverse moments, of the largest rate, that no digit of a phase tells from zero.
const NEGLIGIBLE: f64 = 1e-33;

/// A level with the start on it.
#[derive(Clone, Debug)]
pub(super) struct Level {
    /// e₁, e₂, n₀ in the body.
    pub(super) frame: [Vec3<Dd>; 3],
    /// b/S, γ/S and a_μ/S.
    pub(super) spread: Vec3<Dd>,
    pub(super) wheel: Vec3<Dd>,
    pub(super) common: Dd,
    /// The start: ν₃/S, and the speed p = |ν × n|/S.
    pub(super) along: Dd,
    pub(super) speed: Dd,
    /// S G: how much faster τ runs than t.
    pub(super) rate: Dd,
    kappa: Dd,
    beta: Complex<Dd>,
    r: Complex<Dd>,
    wheel_3: Dd,
    pub(super) pencil: Pencil,
}

/// A point of the curve `Y² = 4X³ − g₂X − g₃`.
#[derive(Clone, Copy, Debug)]
pub(super) struct Place {
    pub(super) x: Complex<Dd>,
    pub(super) y: Complex<Dd>,
}

/// What becomes of the momentum.
#[derive(Clone, Debug)]
pub(super) enum Course {
    /// It is zero and stays zero: the body turns at the rate ω (rad/s), which stays in the body too.
    Empty(Vec3<Dd>),
    /// It is parallel to ω and stays in the body.
    Steady(Vec3<Dd>),
    Moving(Box<Level>),
}

/// The power of two just below |x|, as its exponent; 0 of zero.
fn exponent(x: f64) -> i32 {
    if x == 0.0 { 0 } else { libm::ilogb(x) }
}

impl Level {
    /// Of the principal `moments`, the `wheel` momentum h and the total momentum m.
    pub(super) fn of(moments: Vec3<Dd>, wheel: Vec3<Dd>, m: Vec3<Dd>) -> Course {
        let omega = Vec3([0, 1, 2].map(|k| (m[k] - wheel[k]) / moments[k]));
        if m.magnitude() == 0.0 {
            return Course::Empty(omega);
        }
        let by_g = exponent(m.magnitude());
        let m = m.map(|x| x.scaled(-by_g));
        let norm = m.norm();
        let n = m * (Dd::ONE / norm);
        let middle = moments[moments.ascending()[1]];
        // no difference of reciprocals: near a ball it has fewer digits than the moments
        let spread = moments.map(|i| (middle - i) / (i * middle));
        let turning = Vec3([0, 1, 2].map(|k| wheel[k].scaled(-by_g) / (moments[k] * norm)));
        let nu = spread.times(n) - turning;
        let by_s = exponent(spread.magnitude().max(nu.magnitude()));
        let unit = |v: Vec3<Dd>| v.map(|x| x.scaled(-by_s));
        let (spread, turning, nu) = (unit(spread), unit(turning), unit(nu));
        // ω differs by a_μ n: of the two the smaller has the smaller rounding, and at rest none
        let own = omega.map(|x| (x / norm).scaled(-by_g - by_s));
        let across = n.cross(if own.magnitude() < nu.magnitude() { own } else { nu });
        let speed = across.norm();
        if speed == Dd::ZERO {
            return Course::Steady(omega);
        }
        let e2 = across * (Dd::ONE / speed);
        // the rounding of a small ν × n is not across n
        let e2 = e2 - n * e2.dot(n);
        let e2 = e2 * (Dd::ONE / e2.norm());
        let frame = [e2.cross(n), e2, n];
        let a = |i: usize, j: usize| frame[i].times(spread).dot(frame[j]);
        let g = frame.map(|e| e.dot(turning));
        let alpha = Complex::new(a(0, 2), -a(1, 2));
        let beta = Complex::new((a(0, 0) - a(1, 1)) * 0.5, -a(0, 1));
        let a33 = a(2, 2);
        let exact = || {
            if is_elementary(spread, turning) {
                return None;
            }
            let by_i = exponent(moments.magnitude());
            let [moments, wheel] = [(moments, by_i), (wheel, by_g)].map(|(v, by)| v.map(|x| x.scaled(-by)));
            Some(WideCurve::new(moments, wheel, m, by_s + by_i))
        };
        let pencil = Pencil::of(spread, n, nu, exact);
        Course::Moving(Box::new(Level {
            frame,
            spread,
            wheel: turning,
            common: (Dd::ONE / middle).scaled(-by_s),
            along: nu.dot(n),
            speed,
            rate: norm.scaled(by_g + by_s),
            kappa: (a(0, 0) + a(1, 1)) * 0.5 - a33 + g[2],
            beta,
            r: alpha + Complex::new(g[0], -g[1]),
            wheel_3: g[2],
            pencil,
        }))
    }

    /// Whether ν stays: of a symmetric carrier with the wheel along its axis, and of a ball, which beside a strong wheel any body
    /// is that has hardly any momentum. The motion then is that of two turns.
    pub(super) fn is_elementary(&self) -> bool {
        is_elementary(self.spread, self.wheel)
    }

    /// ζ''/ζ' at the start, `i (κ − β̄)`.
    pub(super) fn bend(&self) -> Complex<Dd> {
        let bend = Complex::new(self.kappa, Dd::ZERO) - self.beta.conjugate();
        Complex::new(-bend.im, bend.re)
    }

    /// α.
    pub(super) fn alpha(&self) -> Complex<Dd> {
        (self.r + Complex::new(self.speed, Dd::ZERO)).scaled(Dd::of(0.5))
    }

    /// Of the time at which ζ is zero again: with Q = c₀ + 4b₁ζ + 6b₂ζ² + 4b₃ζ³ + …, `X = (b₁² − c₀b₂)/c₀` and
    /// `Y = (2b₁³ − 3c₀b₁b₂ + c₀²b₃)/c₀^{3/2}`, both without a quotient.
    pub(super) fn return_of_zero(&self) -> Place {
        let (p, r, beta) = (self.speed, self.r, self.beta);
        let bend = Complex::new(self.kappa, Dd::ZERO) - beta.conjugate();
        // −6 b₂
        let b2 = Complex::new(self.kappa * self.kappa - beta.norm_squared(), Dd::ZERO) - r.scaled(p * 0.5)
            + r.conjugate().scaled(p);
        let sixth = b2.scaled(Dd::ONE / 6.0);
        let square = bend * bend;
        let x = sixth - square.scaled(Dd::of(0.25));
        let b3 = r.scaled(self.kappa) + Complex::new(p * self.wheel_3 * 2.0, Dd::ZERO) - beta * r.conjugate();
        let sum =
            (bend * sixth).scaled(Dd::of(1.5)) - (square * bend).scaled(Dd::of(0.25)) + b3.scaled(p * 0.125);
        // times i
        Place { x, y: Complex::new(-sum.im, sum.re) }
    }

    /// ω over S G at n, along e₁, e₂, n₀.
    pub(super) fn omega(&self, n: [Dd; 3]) -> Vec3<Dd> {
        let [e1, e2, e3] = self.frame;
        let n = e1 * n[0] + e2 * n[1] + e3 * n[2];
        let omega = self.spread.times(n) - self.wheel + n * self.common;
        Vec3(self.frame.map(|e| e.dot(omega)))
    }
}

fn is_elementary(spread: Vec3<Dd>, wheel: Vec3<Dd>) -> bool {
    let same = |k: usize| spread[k] == Dd::ZERO;
    spread.magnitude() < NEGLIGIBLE || (0..3).filter(|&k| same(k) && wheel[k] == Dd::ZERO).count() == 2
}

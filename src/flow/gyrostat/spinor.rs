//! The two theta functions of the attitude, as trigonometric sums.
//!
//! The turn P since the start, p' = ½ p ω, has two Cayley–Klein parameters in the axes (e₁, e₂, n₀) of the
//! [level](super::level), `P = A + B j` with A = w + iz, B = y − ix:
//!
//! `A = e^{iρτ} Z/√N`, `B = −e^{iρτ} W/√N`, `N = |Z|² + |W|²`, `ζ = W/Z`.
//!
//! ζ takes each value twice in a cell of the lattice (T, ω₂), so Z and W are theta functions of the second degree with
//! a common sum d of zeros: with q = e^{iπω₂/T}, E = e^{−iπd/T}, X = e^{2πiτ/T} they are combinations of the even and the odd
//! terms of
//!
//! `Σ_n q^{n²/2} Eⁿ Xⁿ`.
//!
//! ζ(0) = 0 and ζ'(0) make W, and ζ''(0) gives Z'(0)/Z(0) = ½ (W''/W' − ζ''/ζ'). Since W vanishes at 0 and again at
//! d, d is the [return of zero](super::level::Level::return_of_zero).
//!
//! The mean rate at which the body turns about L is that of μ on the curve dτ = dμ/√P, whose poles are at μ = ∞:
//! `2ρ = a_μ + μ̄ + Im (π/T) θ₁'(πv/T)/θ₁(πv/T)` up to a multiple of 2π/T, v = 2i Im d the difference of the two poles, so that ρ
//! needs no start.
//!
//! Sources: V. Volterra, Acta Math. 22 (1899) 201, has the momentum as a quotient of theta functions; the form with the pair
//! (Z, W) was worked out here.

use super::lattice::Lattice;
use super::level::Level;
use super::pencil::Pencil;
use super::weierstrass::Weierstrass;
use crate::num::complex::Complex;
use crate::num::{Dd, Precise, Real};
use crate::rotation::Quat;

/// Most terms on either side.
const MOST_TERMS: usize = 60;

/// Lengths p T of an oscillation about a steady spin below which it is a small one: what the linear theory leaves out is some
/// hundredth of the square of it.
const SMALL: f64 = 2e-8;

/// Z and W with their phases.
#[derive(Clone, Debug)]
pub(super) struct Spinor {
    /// Coefficients of Xⁿ, n = −N, …, N, of Z and W.
    pub(super) terms: Vec<[Complex<Dd>; 2]>,
    /// 2π/T and ρ, for τ.
    pub(super) rate: Dd,
    pub(super) twist: Dd,
    /// What the dual form is made from; `None` where the sums have two or three terms.
    pub(super) basis: Option<Basis>,
}

/// Z and W as combinations of the sums over even and over odd n.
#[derive(Clone, Copy, Debug)]
pub(super) struct Basis {
    pub(super) lattice: Lattice,
    /// d.
    pub(super) place: Complex<Dd>,
    /// What multiplies the even terms in Z and W, and the odd ones.
    pub(super) factors: [[Complex<Dd>; 2]; 2],
}

/// Z, W and their derivatives by τ.
pub(super) struct Value {
    pub(super) functions: [Complex<Dd>; 2],
    pub(super) rates: [Complex<Dd>; 2],
}

impl Spinor {
    pub(super) fn new(level: &Level, lattice: Lattice) -> Self {
        let curve = Weierstrass::new(lattice);
        let rate = Dd::TAU / lattice.period;
        let place = curve.argument(&level.return_of_zero());
        let difference = poles(level, &curve);
        let logarithmic = curve.logarithmic(difference).im;
        let at_start = (level.along + level.common) * 0.5;
        let is_small = Self::is_small(level, &lattice);
        let mut terms = if is_small { small(level, rate) } else { powers(&lattice, place) };
        let mut log_rate = if is_small { first_rate(&terms) } else { log_rate(&terms, level, rate) };
        // the twist for either sign of v, with the share of its unit, half the rate, that the start leaves
        let twist = |sign: f64| {
            let mean = (level.common + level.pencil.centre + logarithmic * sign) * 0.5;
            let multiples = (at_start - log_rate.im * rate - mean) / (rate * 0.5);
            let whole = multiples.round();
            (mean + whole * rate * 0.5, (multiples - whole).magnitude())
        };
        let [plus, minus] = [1.0, -1.0].map(twist);
        // d tells the sign, but on a circle that a symmetric body draws it is lost
        let told = Complex::new(Dd::ZERO, place.im * 2.0);
        let distance = |u: Complex<Dd>| lattice.reduced(u - told).norm_squared();
        let is_plus = if is_small {
            distance(difference) <= distance(Complex::new(-difference.re, -difference.im))
        } else {
            plus.1 <= minus.1
        };
        let twist = if is_plus { plus.0 } else { minus.0 };
        let mut basis = None;
        if !is_small {
            // next to a steady spin the one of the start has fewer digits
            log_rate.im = (at_start - twist) / rate;
            let factors = fitted(&terms, level, rate, log_rate);
            let half = terms.len() / 2;
            for (k, term) in terms.iter_mut().enumerate() {
                let [z, w] = factors[(k + half) % 2];
                *term = [term[0] * z, term[1] * w];
            }
            basis = Some(Basis { lattice, place, factors });
        }
        Spinor { terms, rate, twist, basis }
    }

    /// Whether the start is so near to a steady spin that the linear theory serves.
    pub(super) fn is_small(level: &Level, lattice: &Lattice) -> bool {
        (level.speed * lattice.period).hi() < SMALL
    }

    /// Where ν stays: the body turns by a_μ τ about n₀, then by |ν| τ about ν.
    pub(super) fn elementary(level: &Level) -> Self {
        let rate = (level.along * level.along + level.speed * level.speed).sqrt();
        let (cos, sin) = (level.along / rate, level.speed / rate * 0.5);
        let real = |x: Dd| Complex::new(x, Dd::ZERO);
        let terms = vec![
            [real(Dd::ZERO); 2],
            [real((Dd::ONE - cos) * 0.5), real(-sin)],
            [real((Dd::ONE + cos) * 0.5), real(sin)],
        ];
        Spinor { terms, rate, twist: (level.common - rate) * 0.5, basis: None }
    }

    /// Z and W after `turns` of X.
    pub(super) fn at(&self, turns: Dd) -> [Complex<Dd>; 2] {
        let x = Complex::phase((turns - turns.round()) * Dd::TAU);
        self.sum(x, |term, _| term)
    }

    /// The same with derivatives.
    pub(super) fn with_rates(&self, turns: Dd) -> Value {
        let x = Complex::phase((turns - turns.round()) * Dd::TAU);
        let rates = self.sum(x, |term, n| Complex::new(-(term.im * n), term.re * n));
        Value { functions: self.sum(x, |term, _| term), rates: rates.map(|sum| sum.scaled(self.rate)) }
    }

    fn sum(&self, x: Complex<Dd>, of: impl Fn(Complex<Dd>, f64) -> Complex<Dd>) -> [Complex<Dd>; 2] {
        let half = self.terms.len() / 2;
        let zero = Complex::new(Dd::ZERO, Dd::ZERO);
        [0, 1].map(|k| {
            let (mut up, mut down) = (zero, zero);
            for n in (1..=half).rev() {
                up = (up + of(self.terms[half + n][k], n as f64)) * x;
                down = (down + of(self.terms[half - n][k], -(n as f64))) * x.conjugate();
            }
            up + down + of(self.terms[half][k], 0.0)
        })
    }

    /// e^{iρτ} (A, B) as the quaternion of the turn, along w, e₁, e₂, n₀, unnormalised.
    pub(super) fn turn([z, w]: [Complex<Dd>; 2]) -> Quat<Dd> {
        Quat::from_components([z.re, w.im, -w.re, z.im])
    }

    /// n along e₁, e₂, n₀.
    pub(super) fn direction([z, w]: [Complex<Dd>; 2]) -> [Dd; 3] {
        let (zz, ww) = (z.norm_squared(), w.norm_squared());
        let across = (w * z.conjugate()).scaled(Dd::of(2.0));
        [across.re, across.im, zz - ww].map(|x| x / (zz + ww))
    }
}

/// The difference of the two points μ = ∞ of the curve, up to its sign.
fn poles(level: &Level, curve: &Weierstrass) -> Complex<Dd> {
    let Pencil { single, third, above, .. } = level.pencil;
    // −A₂ beside the single root is told apart from it, and the other two are far from that
    let apart = curve.lattice.roots.map(|root| Complex::new(above + (single - root.re), -root.im));
    curve.argument_apart(apart, Complex::new(Dd::ZERO, third))
}

/// q^{n²/2} Eⁿ for n = −N, …, N.
fn powers(lattice: &Lattice, place: Complex<Dd>) -> Vec<[Complex<Dd>; 2]> {
    let angle = Dd::PI / lattice.period;
    let nome = (-(angle * lattice.height)).exp();
    let root = nome.sqrt();
    let (q, root) = if lattice.is_skew {
        let diagonal = root * Dd::of(0.5).sqrt();
        (Complex::new(Dd::ZERO, nome), Complex::new(diagonal, diagonal))
    } else {
        (Complex::new(nome, Dd::ZERO), Complex::new(root, Dd::ZERO))
    };
    let shift = Complex::phase(-(angle * place.re)).scaled((angle * place.im).exp());
    let side = |factor: Complex<Dd>| {
        let (mut terms, mut term, mut ratio) = (Vec::new(), Complex::new(Dd::ONE, Dd::ZERO), root * factor);
        while terms.len() < MOST_TERMS {
            term = term * ratio;
            ratio = ratio * q;
            if term.norm_squared().hi() < 1e-72 {
                break;
            }
            terms.push(term);
        }
        terms
    };
    let (mut up, mut down) = (side(shift), side(shift.inverse_conjugate().conjugate()));
    let longer = up.len().max(down.len());
    let zero = Complex::new(Dd::ZERO, Dd::ZERO);
    up.resize(longer, zero);
    down.resize(longer, zero);
    let one = Complex::new(Dd::ONE, Dd::ZERO);
    down.into_iter().rev().chain([one]).chain(up).map(|c| [c, c]).collect()
}

/// Sums of the even and the odd terms at X = 1, and their first two derivatives by the angle of X.
fn sums(terms: &[[Complex<Dd>; 2]]) -> [[Complex<Dd>; 2]; 3] {
    let half = terms.len() / 2;
    let mut sums = [[Complex::new(Dd::ZERO, Dd::ZERO); 2]; 3];
    for (k, term) in terms.iter().enumerate() {
        let n = k as f64 - half as f64;
        let parity = (k + half) % 2;
        let c = term[0];
        let turned = Complex::new(-c.im, c.re);
        sums[0][parity] = sums[0][parity] + c;
        sums[1][parity] = sums[1][parity] + turned.scaled(Dd::of(n));
        sums[2][parity] = sums[2][parity] - c.scaled(Dd::of(n * n));
    }
    sums
}

/// Z'(0)/Z(0) by the angle of X.
fn log_rate(terms: &[[Complex<Dd>; 2]], level: &Level, rate: Dd) -> Complex<Dd> {
    let [a, b, c] = sums(terms);
    let first = a[1] * b[0] - a[0] * b[1];
    let second = a[1] * c[0] - a[0] * c[1];
    let ratio = second * first.inverse_conjugate().conjugate();
    (ratio - level.bend().scaled(Dd::ONE / rate)).scaled(Dd::of(0.5))
}

/// What the even and the odd terms of Z and W are multiplied by.
fn fitted(
    terms: &[[Complex<Dd>; 2]],
    level: &Level,
    rate: Dd,
    log_rate: Complex<Dd>,
) -> [[Complex<Dd>; 2]; 2] {
    let [a, b, _] = sums(terms);
    let inverse = (a[0] * b[1] - a[1] * b[0]).inverse_conjugate().conjugate();
    let z = [(b[1] - a[1] * log_rate) * inverse, (a[0] * log_rate - b[0]) * inverse];
    // ζ'(0) = ½ i p
    let speed = level.speed * 0.5 / rate;
    let scale = Complex::new(inverse.im * speed, -(inverse.re * speed));
    [[z[0], a[1] * scale], [z[1], a[0] * scale.scaled(-Dd::ONE)]]
}

/// Coefficients of a small oscillation, to the first order: W = c₊ (X − 1) + c₋ (1/X − 1) with `W'(0) = ½ i p` and
/// `W''(0) = ½ i p ζ''/ζ'`; then `Z'/Z = i Re (αW)` less its mean.
fn small(level: &Level, rate: Dd) -> Vec<[Complex<Dd>; 2]> {
    let speed = Complex::new(level.speed * 0.25 / rate, Dd::ZERO);
    // of W'/i = c₊ − c₋ and −W'' = c₊ + c₋, halves
    let bend = level.bend().scaled(Dd::ONE / rate);
    let sum = speed * Complex::new(bend.im, -bend.re);
    let (plus, minus) = (sum + speed, sum - speed);
    let zero = Complex::new(Dd::ZERO, Dd::ZERO);
    let alpha = level.alpha();
    let turn = (alpha * plus + (alpha * minus).conjugate()).scaled(Dd::of(0.5) / rate);
    let back = zero - turn.conjugate();
    let at_start = Complex::new(Dd::ONE, -(turn.im * 2.0));
    vec![[back, minus], [at_start, zero - plus - minus], [turn, plus]]
}

/// Z'(0)/Z(0) of those.
fn first_rate(terms: &[[Complex<Dd>; 2]]) -> Complex<Dd> {
    Complex::new(Dd::ZERO, terms[2][0].re * 2.0)
}

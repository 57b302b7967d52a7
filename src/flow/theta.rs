//! Motion along a polhode by two theta functions: the quick form in `f64`, with constants and phases in double-double.
//!
//! The Cayley–Klein parameters of the attitude P(t), which takes m to Gσe_a, are theta functions of nome q² at one
//! complex argument:
//!
//! `P_w + iσP_a = e^{iΨ} Z/√n₂`, `P_b + iδP_c = −i e^{iΨ} W/√n₂`, `n₂ = |Z|² + |W|²`,
//! `Z = θ₄(x + iδy; q²)`, `W = θ₁(x + iδy; q²)`, `x = πu/2K`, `y = πη/2K`, `dn(iη) = G/A`, Ψ linear in t.
//!
//! Reason: `ψ' = G/I_a + (2H − G²/I_a)/(G + A dn u)` has simple poles only where dn u = −G/A, with residues ±1 and
//! the periods 2K and 4iK', so that e^{iψ/2} is e^{iΨ} Z/|Z|; and |Z|² and |W|² are proportional to
//! `(G ± A dn) θ₄(x; q)`. The momentum comes from the same two numbers, `m_b + iδm_c = 2G Z̄W/n₂`,
//! `m_a = σG (|Z|² − |W|²)/n₂`, so that L = q m q* is an identity; only along the axis of the smallest moment, where
//! ω = m/I would magnify a rounding error, m is taken from its own theta quotient.
//!
//! No inverse function is left: two pairs of sine and cosine, or one exponential near the separatrix, where Jacobi's
//! imaginary transformation gives the same sums in hyperbolic functions with the complementary nome (*dual* form).
//! Letters as in [`polhode`](super::polhode); q and q' are the nomes, h = e^{−π(K'−η)/K} and g = q/h.
//!
//! Related: C. G. J. Jacobi, J. reine angew. Math. 39 (1850) 293; van Zon and Schofield, J. Comput. Phys. 225 (2007)
//! 145, whose form keeps one arc tangent. We found no earlier use of the pair (Z, W) for the attitude itself.

use super::phase::{Pair, Phase, TOO_FAR, pair};
use super::polhode::Polhode;
use crate::num::dd::{two_prod, two_sum};
use crate::num::elliptic::{Modulus, r_f};
use crate::num::trig::{nearest, sin_cos_turns};
use crate::num::{Dd, Precise, Real};
use crate::rotation::{Quat, Vec3};

/// Below this k'² (nome 0.2) the dual form is used; there both forms truncate below 1e-17.
const SWITCH: f64 = 0.034_147_806_404_921;

/// Terms of Z and W: the first left out are below 3e-20 of the sums.
const TERMS: usize = 4;

/// Terms of the theta quotient along the smallest moment: below 7e-18.
const LEAST_TERMS: usize = 5;

/// Terms where sums are taken in double-double.
const DD_TERMS: usize = 6;

/// The quick form of one motion.
#[derive(Clone, Debug)]
pub(super) struct Theta {
    axes: [usize; 3],
    about_smallest: bool,
    sigma: f64,
    delta: f64,
    norm: f64,
    form: Form,
    phase: Phase, // turns of x; half periods of u; β on the separatrix
    twist: Phase, // Ψ in turns
    z: [[f64; TERMS]; 2],
    w: [[f64; TERMS]; 2],
    least: [f64; LEAST_TERMS],
    /// q0 ∘ P(0)*.
    attitude: Quat<f64>,
}

#[derive(Clone, Copy, Debug)]
enum Form {
    /// Trigonometric sums in x.
    Direct,
    /// Hyperbolic sums in β, which is `width` times the reduced half periods; each half period adds `jump` turns to Ψ.
    Dual { width: f64, jump: Pair },
    /// The dual form for q' so small that only the first terms count.
    Limit { width: f64, jump: Pair },
    /// The same without a period.
    Separatrix,
}

/// Sums in double-double from which the coefficients are made.
struct Sums {
    z_even: [Dd; DD_TERMS],
    z_odd: [Dd; DD_TERMS],
    w_even: [Dd; DD_TERMS],
    w_odd: [Dd; DD_TERMS],
}

impl Theta {
    /// For the attitude `q0` and the momentum `m` at the start.
    pub(super) fn of(polhode: &Polhode<Dd>, q0: Quat<Dd>, m: Vec3<Dd>) -> Self {
        let built = if polhode.complement.hi() >= SWITCH { direct(polhode) } else { dual(polhode) };
        // Z at the start gives the twist of P(0); its swing is that of m
        let (re, im) = built.start;
        let size = (re * re + im * im).sqrt();
        let twist = Quat::new(re / size, Vec3::unit(polhode.axes[0]) * (polhode.sigma * im / size));
        let attitude = q0 * (twist * polhode.swing(m)).conjugate();
        Theta { attitude: Quat::from_components(attitude.components().map(Dd::hi)), ..built.theta }
    }

    /// Attitude and momentum at `t`; `None` where so many turns have passed that `f64` pairs cannot reduce them.
    #[inline]
    pub(super) fn at(&self, t: f64) -> Option<(Quat<f64>, Vec3<f64>)> {
        let (phase, phase_low) = self.phase.at(t);
        let (mut psi, mut psi_low) = self.twist.at(t);
        if !(phase.abs() < TOO_FAR && psi.abs() < TOO_FAR) {
            return None;
        }
        psi -= nearest(psi);
        let (z, w, least);
        if let Form::Direct = self.form {
            let (s, c) = sin_cos_turns(phase - nearest(phase), phase_low);
            let x = (c - s) * (c + s); // cos 2x
            z = [value(&self.z[0], x), 2.0 * s * c * value(&self.z[1], x)];
            w = [s * value(&self.w[0], x), c * value(&self.w[1], x)];
            let sum = least_value(&self.least, x);
            least = if self.about_smallest { sum } else { c * sum };
        } else {
            let (beta, sign) = match self.form {
                Form::Dual { width, jump } | Form::Limit { width, jump } => {
                    let n = nearest(phase);
                    let (turns, rest) = two_prod(jump[0], n);
                    let (sum, error) = two_sum(psi, turns - nearest(turns));
                    psi = sum - nearest(sum);
                    psi_low += error + (rest + jump[1] * n);
                    let odd = nearest(0.5 * n) != 0.5 * n;
                    (((phase - n) + phase_low) * width, if odd { -1.0 } else { 1.0 })
                }
                _ => (phase + phase_low, 1.0),
            };
            // e^{±350} is as good as infinity and its square still finite
            let beta = beta.clamp(-350.0, 350.0);
            let grown = libm::exp(beta.abs());
            let shrunk = 1.0 / grown;
            let cosh = 0.5 * (grown + shrunk);
            let sinh = 0.5 * (grown - shrunk);
            let sinh = if beta < 0.0 { -sinh } else { sinh };
            // cosh 2β, except where all polynomials are constants and it might overflow
            let x = if let Form::Dual { .. } = self.form { cosh * cosh + sinh * sinh } else { 1.0 };
            z = [cosh * value(&self.z[0], x), sinh * value(&self.z[1], x)];
            w = [sign * sinh * value(&self.w[0], x), sign * cosh * value(&self.w[1], x)];
            let sum = match self.form {
                // 1 ± 2q' cosh 4β with q' = e^{−2 width}, and no power of cosh
                Form::Limit { width, .. } => {
                    let end = libm::exp(4.0 * beta.abs() - 2.0 * width);
                    self.least[0] * if self.about_smallest { 1.0 + end } else { 1.0 - end }
                }
                _ => least_value(&self.least, 2.0 * x * x - 1.0),
            };
            least = if self.about_smallest { sum } else { sign * sum };
        }
        Some(self.assemble(z, w, least, sin_cos_turns(psi, psi_low)))
    }

    /// Attitude and momentum from Z, W, the theta quotient times n₂, and sine and cosine of Ψ.
    #[inline]
    fn assemble(&self, z: Pair, w: Pair, least: f64, (sin, cos): (f64, f64)) -> (Quat<f64>, Vec3<f64>) {
        let [a, b, c] = self.axes;
        let (zz, ww) = (z[0] * z[0] + z[1] * z[1], w[0] * w[0] + w[1] * w[1]);
        let r = 1.0 / (zz + ww).sqrt();
        let r2 = r * r;
        let twice = 2.0 * self.norm * r2;
        let mut m = Vec3::zero();
        m[b] = twice * (z[0] * w[0] + z[1] * w[1]);
        if self.about_smallest {
            m[a] = least * r2;
            m[c] = twice * self.delta * (z[0] * w[1] - z[1] * w[0]);
        } else {
            m[a] = self.norm * self.sigma * r2 * (zz - ww);
            m[c] = least * r2;
        }
        let mut v = Vec3::zero();
        v[a] = self.sigma * r * (cos * z[1] + sin * z[0]);
        v[b] = r * (cos * w[1] + sin * w[0]);
        v[c] = -self.delta * r * (cos * w[0] - sin * w[1]);
        (self.attitude * Quat::new(r * (cos * z[0] - sin * z[1]), v), m)
    }
}

/// A form with Z at the start.
struct Built {
    theta: Theta,
    start: (Dd, Dd),
}

/// The constants common to both forms; κ belongs to n₂ = κ/(2G) · (2G) θ, and `least` is made by the caller.
fn common(polhode: &Polhode<Dd>, form: Form, phase: Phase, twist_rate: Dd) -> Theta {
    Theta {
        axes: polhode.axes,
        about_smallest: polhode.about_smallest,
        sigma: polhode.sigma.hi(),
        delta: polhode.delta.hi(),
        norm: polhode.norm.hi(),
        form,
        phase,
        twist: Phase::new(twist_rate / Dd::TAU, Dd::ZERO),
        z: [[0.0; TERMS]; 2],
        w: [[0.0; TERMS]; 2],
        least: [0.0; LEAST_TERMS],
        attitude: Quat::identity(),
    }
}

/// ψ' at u = 0; the form without differences, which would cancel for rods.
fn rate_at_zero(polhode: &Polhode<Dd>) -> Dd {
    let [a, ..] = polhode.amplitude;
    (polhode.twice_energy + polhode.norm * a / polhode.moments[0]) / (polhode.norm + a)
}

/// Half a period of u changes the sign of W and of cn.
fn flip(polhode: &Polhode<Dd>) -> Dd {
    if polhode.half_turned { -Dd::ONE } else { Dd::ONE }
}

fn direct(polhode: &Polhode<Dd>) -> Built {
    let [amp_a, amp_b, amp_c] = polhode.amplitude;
    let (norm, delta) = (polhode.norm, polhode.delta);
    let quarter = Modulus::new(polhode.complement).quarter_period();
    let q = if polhode.parameter == Dd::ZERO {
        Dd::ZERO
    } else {
        (-(Dd::PI * Modulus::new(polhode.parameter).quarter_period() / quarter)).exp()
    };
    // K' − η, finite also for k = 0
    let eta = amp_a / norm * r_f(amp_c * amp_c / (norm * norm), amp_b * amp_b / (norm * norm), Dd::ONE);
    let h = (-(Dd::PI * eta / quarter)).exp();
    let g = q / h;

    // Z = 1 + Σ (−1)ⁿ [(q^{2n²−n} hⁿ + q^{2n²} gⁿ) cos 2nx − iδ (… − …) sin 2nx],
    // W = √h Σ (−1)ⁿ [(q^{2n²+n} hⁿ + q^{2n²+2n} gⁿ⁺¹) sin (2n+1)x + iδ (… − …) cos (2n+1)x]
    let mut sums = Sums {
        z_even: [Dd::ZERO; DD_TERMS],
        z_odd: [Dd::ZERO; DD_TERMS],
        w_even: [Dd::ZERO; DD_TERMS],
        w_odd: [Dd::ZERO; DD_TERMS],
    };
    sums.z_even[0] = Dd::ONE;
    let root = h.sqrt();
    let (mut zh, mut zg, mut wh, mut wg) = (Dd::ONE, Dd::ONE, root, root * g);
    let q4 = (q * q) * (q * q);
    let mut q4n = Dd::ONE; // q^{4n}
    for n in 0..DD_TERMS {
        let sign = if n % 2 == 0 { 1.0 } else { -1.0 };
        if n > 0 {
            q4n = q4n * q4;
            // q^{4n−3} = q^{4(n−1)} q and so on; no division by q, which may be zero
            let before = power(q, 4 * n as u32 - 3);
            zh = zh * before * h;
            zg = zg * before * q * g;
            wh = wh * before * q * q * h;
            wg = wg * q4n * g;
            sums.z_even[n] = (zh + zg) * sign;
            sums.z_odd[n] = (zh - zg) * sign;
        }
        sums.w_even[n] = (wh + wg) * sign;
        sums.w_odd[n] = (wh - wg) * sign;
    }
    let z0 = total(&sums.z_even);
    let slope = (1..DD_TERMS).fold(Dd::ZERO, |sum, n| sum + sums.z_odd[n] * (2.0 * n as f64));
    let per_phase = Dd::FRAC_PI_2 / quarter; // x/u
    let x_rate = polhode.rate * per_phase;
    let twist_rate = rate_at_zero(polhode) * 0.5 + delta * x_rate * slope / z0;
    let x0 = polhode.phase() * per_phase;
    let form = Form::Direct;
    let mut theta = common(polhode, form, Phase::new(x_rate / Dd::TAU, x0 / Dd::TAU), twist_rate);

    // θ constants of nome q
    let (mut t2, mut t3, mut t4) = (Dd::of(2.0), Dd::ONE, Dd::ONE);
    let mut square = Dd::ONE; // q^{n²}
    for n in 1..=7_u32 {
        square = square * power(q, 2 * n - 1);
        t3 = t3 + square * 2.0;
        t4 = t4 + square * if n % 2 == 0 { 2.0 } else { -2.0 };
        t2 = t2 + square * power(q, n) * 2.0;
    }
    let kappa = norm * z0 * z0 * 2.0 / ((norm + amp_a) * t4);
    let flip = flip(polhode);
    theta.z = [polynomial(first(&sums.z_even), T), polynomial(first(&sums.z_odd).map(|v| -(v * delta)), U)];
    theta.w = [
        polynomial(first(&sums.w_even).map(|v| v * flip), V_PLUS),
        polynomial(first(&sums.w_odd).map(|v| v * (flip * delta)), V_MINUS),
    ];
    theta.least = if polhode.about_smallest {
        let scale = polhode.sigma * amp_a * t4 / t3 * kappa;
        let term = |n: u32| power(q, n * n) * scale * if n == 0 { 1.0 } else { 2.0 };
        polynomial([0, 1, 2, 3, 4].map(term), T)
    } else {
        let scale = flip * amp_c * t4 / t2 * kappa * 2.0;
        polynomial([0, 1, 2, 3, 4].map(|n: u32| power(q, n * n + n) * scale), V_MINUS)
    };

    let (s2, c2) = (x0 * 2.0).sin_cos();
    let (mut s, mut c) = (Dd::ZERO, Dd::ONE);
    let (mut re, mut im) = (Dd::ZERO, Dd::ZERO);
    for n in 0..DD_TERMS {
        re = re + sums.z_even[n] * c;
        im = im - delta * sums.z_odd[n] * s;
        (s, c) = (s * c2 + c * s2, c * c2 - s * s2);
    }
    Built { theta, start: (re, im) }
}

fn dual(polhode: &Polhode<Dd>) -> Built {
    let [amp_a, amp_b, amp_c] = polhode.amplitude;
    let [i_a, i_b, i_c] = polhode.moments;
    let (norm, delta) = (polhode.norm, polhode.delta);
    let quarter = polhode.quarter_period();
    let dual_quarter = Modulus::new(polhode.parameter).quarter_period(); // K'; π/2 for k = 1
    let is_limit = polhode.asymptotic.is_some();
    let q = if is_limit { Dd::ZERO } else { (-(Dd::PI * quarter / dual_quarter)).exp() };
    let ratio = amp_c / amp_b; // sn(η | k')
    let cosine = i_a * (i_c - i_b) / (i_b * (i_c - i_a)); // 1 − (C/B)², without cancellation
    let eta = ratio * r_f(cosine, Dd::ONE - polhode.complement * ratio * ratio, Dd::ONE);
    let per_phase = Dd::FRAC_PI_4 / dual_quarter; // β/u
    let alpha = eta * per_phase;

    // Z = Σ q'^{(n²+n)/2} [cos (2n+1)α cosh (2n+1)β + iδ sin (2n+1)α sinh (2n+1)β], W with (−1)ⁿ and cosh ↔ sinh
    let (sin, cos) = alpha.sin_cos();
    let (s2, c2) = (sin * cos * 2.0, (cos - sin) * (cos + sin));
    let (mut s, mut c, mut weight) = (sin, cos, Dd::ONE);
    let mut even = [Dd::ZERO; DD_TERMS];
    let mut odd = [Dd::ZERO; DD_TERMS];
    for n in 0..DD_TERMS {
        if n > 0 {
            weight = weight * power(q, n as u32);
            (s, c) = (s * c2 + c * s2, c * c2 - s * s2);
        }
        even[n] = weight * c;
        odd[n] = weight * s;
    }
    let z0 = total(&even);
    let slope = (0..DD_TERMS).fold(Dd::ZERO, |sum, n| sum + odd[n] * (2.0 * n as f64 + 1.0));
    let beta_rate = polhode.rate * per_phase;
    let twist_rate = rate_at_zero(polhode) * 0.5 - delta * beta_rate * slope / z0;
    let beta = polhode.phase() * per_phase;
    let (form, phase) = if polhode.is_separatrix() {
        (Form::Separatrix, Phase::new(beta_rate, beta))
    } else {
        let half = quarter * 2.0;
        let (width, jump) = ((per_phase * half).hi(), pair(delta * alpha * 2.0 / Dd::TAU));
        let form = if is_limit { Form::Limit { width, jump } } else { Form::Dual { width, jump } };
        (form, Phase::new(polhode.rate / half, polhode.phase() / half))
    };
    let mut theta = common(polhode, form, phase, twist_rate);

    // θ constants of nome q'
    let (mut t2, mut t3, mut t4) = (Dd::ONE, Dd::ONE, Dd::ONE);
    for n in 1..DD_TERMS as u32 {
        let square = power(q, n * n);
        t2 = t2 + square * power(q, n);
        t3 = t3 + square * 2.0;
        t4 = t4 + square * if n % 2 == 0 { 2.0 } else { -2.0 };
    }
    let kappa = norm * z0 * z0 * 2.0 / ((norm + amp_a) * t2);
    let flip = flip(polhode);
    let alternating = |v: [Dd; TERMS]| [v[0], -v[1], v[2], -v[3]];
    let (even4, odd4) = (first(&even), first(&odd).map(|v| v * delta));
    theta.z = [polynomial(even4, V_MINUS), polynomial(odd4, V_PLUS)];
    theta.w = [
        polynomial(alternating(even4).map(|v| v * flip), V_PLUS),
        polynomial(alternating(odd4).map(|v| v * flip), V_MINUS),
    ];
    let scale = if polhode.about_smallest {
        polhode.sigma * amp_a * t2 / t3 * kappa
    } else {
        flip * amp_c * t2 / t4 * kappa
    };
    let term = |n: u32| {
        let sign = if polhode.about_smallest || n.is_multiple_of(2) { 1.0 } else { -1.0 };
        power(q, n * n) * scale * if n == 0 { 1.0 } else { 2.0 * sign }
    };
    theta.least = polynomial([0, 1, 2, 3, 4].map(term), T);

    Built { theta, start: dual_start(even, odd.map(|v| v * delta), beta) }
}

/// Re Z and Im Z at `beta`, up to a common factor.
fn dual_start(even: [Dd; DD_TERMS], odd: [Dd; DD_TERMS], beta: Dd) -> (Dd, Dd) {
    // from here on cosh (2n+1)β overflows, and the terms beyond the first are below e^{−2β} of it
    if beta.hi().abs() > 60.0 {
        return (even[0], if beta.hi() < 0.0 { -odd[0] } else { odd[0] });
    }
    let (grown, shrunk) = (beta.exp(), (-beta).exp());
    let (mut sh, mut ch) = ((grown - shrunk) * 0.5, (grown + shrunk) * 0.5);
    let (sh2, ch2) = (sh * ch * 2.0, ch * ch + sh * sh);
    let (mut re, mut im) = (Dd::ZERO, Dd::ZERO);
    for n in 0..DD_TERMS {
        re = re + even[n] * ch;
        im = im + odd[n] * sh;
        (sh, ch) = (sh * ch2 + ch * sh2, ch * ch2 + sh * sh2);
    }
    (re, im)
}

/// First two members F₀ = c, F₁ = a + bX of a family with F_{n+1} = 2X F_n − F_{n−1}, as [c, a, b].
type Family = [f64; 3];
/// cos 2nx of X = cos 2x.
const T: Family = [1.0, 0.0, 1.0];
/// sin 2nx / sin 2x.
const U: Family = [0.0, 1.0, 0.0];
/// sin (2n+1)x / sin x.
const V_PLUS: Family = [1.0, 1.0, 2.0];
/// cos (2n+1)x / cos x.
const V_MINUS: Family = [1.0, -1.0, 2.0];

/// Coefficients of powers of X in Σ v_n F_n(X), rounded once.
fn polynomial<const N: usize>(v: [Dd; N], [c, a, b]: Family) -> [f64; N] {
    let mut sum = [Dd::ZERO; N];
    let (mut before, mut now) = ([0.0; N], [0.0; N]);
    before[0] = c;
    now[0] = a;
    now[1] = b;
    for v in v {
        for k in 0..N {
            sum[k] = sum[k] + v * before[k];
        }
        let mut next = [0.0; N];
        for k in 0..N {
            next[k] = if k > 0 { 2.0 * now[k - 1] } else { 0.0 } - before[k];
        }
        (before, now) = (now, next);
    }
    sum.map(Dd::hi)
}

/// The cubic at `x`.
#[inline]
fn value(p: &[f64; TERMS], x: f64) -> f64 {
    (p[0] + p[1] * x) + x * x * (p[2] + p[3] * x)
}

/// The quartic at `x`.
#[inline]
fn least_value(p: &[f64; LEAST_TERMS], x: f64) -> f64 {
    let x2 = x * x;
    (p[0] + p[1] * x) + x2 * ((p[2] + p[3] * x) + x2 * p[4])
}

fn first(v: &[Dd; DD_TERMS]) -> [Dd; TERMS] {
    [v[0], v[1], v[2], v[3]]
}

fn total(v: &[Dd; DD_TERMS]) -> Dd {
    v.iter().rev().fold(Dd::ZERO, |sum, &x| sum + x)
}

fn power(x: Dd, n: u32) -> Dd {
    let (mut result, mut base, mut n) = (Dd::ONE, x, n);
    while n > 0 {
        if n % 2 == 1 {
            result = result * base;
        }
        base = base * base;
        n /= 2;
    }
    result
}

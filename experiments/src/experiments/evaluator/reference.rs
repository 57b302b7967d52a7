//! The closed form once more, in double-double and from the text of the article: what one evaluation in doubles is compared with.
//!
//! Constants are worked out once a motion; a state then takes two pairs of sine and cosine, or one exponential, and sums of
//! four or five terms. Nothing is shared with the library's form but the elliptic integrals and the arithmetic: a second form, by
//! Carlson's integral of the third kind, tells how far this one can be trusted.

use polhode::num::elliptic::{Modulus, incomplete, r_f};
use polhode::num::{Dd, Expansion, Precise, Real};
use polhode::rotation::{Quat, Vec3};

use super::grid::Start;

/// Below this k'², that of the nome 0.2, the library takes the hyperbolic sums, and so does this form.
const SWITCH: f64 = 0.034_147_806_404_921;

/// Below this k'² the library takes limits in place of elliptic functions.
const LIMIT: f64 = 3.054_936_363_499_605e-151; // 2⁻⁵⁰⁰

/// Below this k² the motion is next to a steady spin about a stable axis.
const END: f64 = 1e-6;

/// Terms of the sums: the next are below 1e-32 of the first.
const TERMS: usize = 6;

/// Which of its forms the library evaluates.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(super) enum Form {
    End,
    Direct,
    Dual,
    Limit,
}

impl Form {
    pub(super) const ALL: [Form; 4] = [Form::End, Form::Direct, Form::Dual, Form::Limit];

    pub(super) fn name(self) -> &'static str {
        match self {
            Form::End => "direct, next to a steady spin",
            Form::Direct => "direct",
            Form::Dual => "dual",
            Form::Limit => "limit",
        }
    }
}

/// One motion: the letters of the article.
pub(super) struct Reference {
    pub(super) form: Form,
    axes: [usize; 3],
    /// Directions along which the momentum has a positive first component and the axes are right-handed.
    signs: [f64; 3],
    norm: Dd,
    inverse_moments: Vec3<Dd>,
    /// x in turns, or u in half periods: rate and value at the start.
    phase: [Dd; 2],
    /// Ψ in turns: rate, and what a half period adds in the hyperbolic sums.
    twist: [Dd; 2],
    /// 2K π/4K', the width of a half period in β.
    width: Dd,
    /// Real and imaginary coefficients of Z and of W.
    z: [[Dd; TERMS]; 2],
    w: [[Dd; TERMS]; 2],
    terms: usize,
    /// P(0)*.
    back: Quat<Dd>,
}

impl Reference {
    /// Of a body with three different moments that turns about none of its axes.
    pub(super) fn new(start: &Start) -> Self {
        let i: Vec3<Dd> = Vec3::of(Vec3(start.moments));
        let m = Vec3([0, 1, 2].map(|k| Dd::product(start.moments[k], start.omega[k])));
        let norm = m.norm();
        let mut order = [0, 1, 2];
        order.sort_by(|&j, &k| start.moments[j].total_cmp(&start.moments[k]));
        let [l, mu, h] = order;
        // G² − 2H I_b of the middle axis, which decides about the period: without rounding error
        let separation = separation(i, m, order);
        let axes @ [a, b, c] = if separation <= Dd::ZERO { [l, mu, h] } else { [h, mu, l] };
        let (ia, ib, ic) = (i[a], i[b], i[c]);
        let first = if m[a] < Dd::ZERO { -1.0 } else { 1.0 };
        let right_handed = (b + 3 - a) % 3 == 1;
        let signs = [first, 1.0, if right_handed { first } else { -first }];
        let [ma, mb, mc] = [m[a] * signs[0], m[b], m[c] * signs[2]];

        // G² − 2H I_a and 2H I_c − G², sums of terms of one sign
        let from_a = mb * mb * (ib - ia) / ib + mc * mc * (ic - ia) / ic;
        let from_c = ma * ma * (ic - ia) / ia + mb * mb * (ic - ib) / ib;
        let twice_energy = ma * ma / ia + mb * mb / ib + mc * mc / ic;
        let amp_a = (ia * from_c / (ic - ia)).sqrt();
        let amp_b = (ib * from_a / (ib - ia)).sqrt();
        let amp_c = (ic * from_a / (ic - ia)).sqrt();
        let amp_c = if ic < ia { -amp_c } else { amp_c };
        let nu = ((ib - ia) * from_c / (ia * ib * ic)).sqrt();
        let k2 = (ic - ib) * from_a / ((ib - ia) * from_c);
        let complement = -separation * (ic - ia) / ((ib - ia) * from_c);
        let quarter = Modulus::new(complement).quarter_period();
        let dual_quarter = Modulus::new(k2).quarter_period();

        // the phase of the start, from a pair on the unit circle
        let (sn, cn) = (mb / amp_b, mc / amp_c);
        let size = (sn * sn + cn * cn).sqrt();
        let (sn, cn) = (sn / size, cn / size);
        let near = incomplete(sn, cn.abs(), k2, complement);
        let u0 = if cn < Dd::ZERO { quarter * 2.0 - near } else { near };
        // sn(η|k') = C/B, with cn² and dn² = k²G²/B² free of differences that cancel
        let cosine = ia * (ic - ib) / (ib * (ic - ia));
        let eta = amp_c / amp_b * r_f(cosine, k2 * norm * norm / (amp_b * amp_b), Dd::ONE);
        let rate_at_zero = (twice_energy + norm * amp_a / ia) / ((norm + amp_a) * 2.0);

        let dual = complement.hi() < SWITCH;
        let form = match complement.hi() {
            x if x < LIMIT => Form::Limit,
            x if x < SWITCH => Form::Dual,
            _ if k2.hi() < END => Form::End,
            _ => Form::Direct,
        };
        let sums = if dual {
            hyperbolic(quarter, dual_quarter, eta)
        } else {
            trigonometric(quarter, dual_quarter, eta)
        };
        let psi_rate = rate_at_zero + nu * sums.twist_rate;
        let mut motion = Reference {
            form,
            axes,
            signs,
            norm,
            inverse_moments: i.map(|i| Dd::ONE / i),
            phase: [nu * sums.phase_per_u, u0 * sums.phase_per_u],
            twist: [psi_rate / Dd::TAU, sums.jump / Dd::TAU],
            width: sums.width,
            z: sums.z,
            w: sums.w,
            terms: sums.terms,
            back: Quat::identity(),
        };
        motion.back = motion.turn(motion.cayley_klein(0.0)).conjugate();
        motion
    }

    /// Attitude and angular velocity at the time `t`.
    #[inline]
    pub(super) fn at(&self, t: f64) -> (Quat<Dd>, Vec3<Dd>) {
        let pair @ [alpha, beta] = self.cayley_klein(t);
        let square = |[re, im]: [Dd; 2]| re * re + im * im;
        let along = self.norm * (square(alpha) - square(beta));
        // m_b + i m_c = 2iG ᾱβ
        let twice = self.norm * 2.0;
        let b = twice * (alpha[1] * beta[0] - alpha[0] * beta[1]);
        let c = twice * (alpha[0] * beta[0] + alpha[1] * beta[1]);
        let momentum = self.placed([along, b, c]);
        (self.back * self.turn(pair), momentum.times(self.inverse_moments))
    }

    /// The numbers α and β of the article.
    #[inline]
    fn cayley_klein(&self, t: f64) -> [[Dd; 2]; 2] {
        let phase = self.phase[0] * t + self.phase[1];
        let psi = self.twist[0] * t;
        let whole = phase.round();
        let rest = phase - whole;
        let part =
            |k: [Dd; TERMS], f: [Dd; TERMS]| (0..self.terms).fold(Dd::ZERO, |sum, n| sum + k[n] * f[n]);
        let (z, w, psi) = if matches!(self.form, Form::End | Form::Direct) {
            let (s, c) = (rest * Dd::TAU).sin_cos();
            let (even, odd) = harmonics::<-1>(s, c);
            (
                [part(self.z[0], even[0]), part(self.z[1], even[1])],
                [part(self.w[0], odd[1]), part(self.w[1], odd[0])],
                psi,
            )
        } else {
            let grown = (rest * self.width).exp();
            let shrunk = Dd::ONE / grown;
            let (s, c) = ((grown - shrunk) * 0.5, (grown + shrunk) * 0.5);
            let (_, odd) = harmonics::<1>(s, c);
            let sign = if whole.rem_euclid(2.0) == 0.0 { 1.0 } else { -1.0 };
            (
                [part(self.z[0], odd[0]), part(self.z[1], odd[1])],
                [part(self.w[0], odd[1]) * sign, part(self.w[1], odd[0]) * sign],
                psi + self.twist[1] * whole,
            )
        };
        let (sin, cos) = ((psi - psi.round()) * Dd::TAU).sin_cos();
        let size = (z[0] * z[0] + z[1] * z[1] + w[0] * w[0] + w[1] * w[1]).sqrt();
        let (sin, cos) = (sin / size, cos / size);
        // β = −i e^{iΨ} W
        let alpha = [cos * z[0] - sin * z[1], cos * z[1] + sin * z[0]];
        let beta = [cos * w[1] + sin * w[0], sin * w[1] - cos * w[0]];
        [alpha, beta]
    }

    fn turn(&self, [alpha, beta]: [[Dd; 2]; 2]) -> Quat<Dd> {
        Quat::new(alpha[0], self.placed([alpha[1], beta[0], beta[1]]))
    }

    /// Components along a, b, c in the body's own axes.
    fn placed(&self, components: [Dd; 3]) -> Vec3<Dd> {
        let mut v = Vec3::zero();
        for k in 0..3 {
            v[self.axes[k]] = components[k] * self.signs[k];
        }
        v
    }
}

/// The sums of one form, and how their arguments depend on u.
struct Sums {
    z: [[Dd; TERMS]; 2],
    w: [[Dd; TERMS]; 2],
    terms: usize,
    /// Phase in its unit by u.
    phase_per_u: Dd,
    /// What is added to Ψ' at u = 0, by ν.
    twist_rate: Dd,
    jump: Dd,
    width: Dd,
}

/// Z = θ₄(x + iy; q²) and W = θ₁(x + iy; q²), x = πu/2K and y = πη/2K.
fn trigonometric(quarter: Dd, dual_quarter: Dd, eta: Dd) -> Sums {
    let per_u = Dd::FRAC_PI_2 / quarter;
    let y = eta * per_u;
    let nome = |power: f64| -(Dd::PI * dual_quarter / quarter) * power;
    let (mut z, mut w) = ([[Dd::ZERO; TERMS]; 2], [[Dd::ZERO; TERMS]; 2]);
    for n in 0..TERMS {
        let (k, sign) = (n as f64, if n % 2 == 0 { 1.0 } else { -1.0 });
        // q^{2n²} e^{±2ny}, of the logarithm, as either factor alone may leave the range
        let (grown, shrunk) = pair(nome(2.0 * k * k), y * (2.0 * k));
        z[0][n] = if n == 0 { Dd::ONE } else { (grown + shrunk) * sign };
        z[1][n] = (shrunk - grown) * sign;
        let (grown, shrunk) = pair(nome(2.0 * (k + 0.5) * (k + 0.5)), y * (2.0 * k + 1.0));
        w[0][n] = (grown + shrunk) * sign;
        w[1][n] = (grown - shrunk) * sign;
    }
    let slope = (0..TERMS).fold(Dd::ZERO, |sum, n| sum - z[1][n] * (2.0 * n as f64));
    let twist_rate = per_u * slope / total(z[0]);
    Sums { z, w, terms: TERMS, phase_per_u: per_u / Dd::TAU, twist_rate, jump: Dd::ZERO, width: Dd::ZERO }
}

/// The same by Jacobi's imaginary transformation, in β = πu/4K' and α = πη/4K'.
fn hyperbolic(quarter: Dd, dual_quarter: Dd, eta: Dd) -> Sums {
    let per_u = Dd::FRAC_PI_4 / dual_quarter;
    let alpha = eta * per_u;
    let log_nome = -(Dd::PI * quarter / dual_quarter);
    // term n is at most e^{n²/2 log q'} of the first
    let terms = (1..TERMS).find(|n| -0.5 * (n * n) as f64 * log_nome.hi() > 75.0).unwrap_or(TERMS);
    let (mut z, mut w) = ([[Dd::ZERO; TERMS]; 2], [[Dd::ZERO; TERMS]; 2]);
    for n in 0..terms {
        let weight = (log_nome * (0.5 * (n * n + n) as f64)).exp();
        let (s, c) = (alpha * (2.0 * n as f64 + 1.0)).sin_cos();
        let sign = if n % 2 == 0 { 1.0 } else { -1.0 };
        (z[0][n], z[1][n]) = (weight * c, weight * s);
        (w[0][n], w[1][n]) = (z[0][n] * sign, z[1][n] * sign);
    }
    let slope = (0..terms).fold(Dd::ZERO, |sum, n| sum + z[1][n] * (2.0 * n as f64 + 1.0));
    let twist_rate = -(per_u * slope / total(z[0]));
    let half = quarter * 2.0;
    Sums { z, w, terms, phase_per_u: Dd::ONE / half, twist_rate, jump: alpha * 2.0, width: half * per_u }
}

/// e^{x ± y}.
fn pair(x: Dd, y: Dd) -> (Dd, Dd) {
    ((x + y).exp(), (x - y).exp())
}

fn total(v: [Dd; TERMS]) -> Dd {
    v.into_iter().rev().fold(Dd::ZERO, |sum, x| sum + x)
}

/// Cosines and sines of the even multiples and of the odd ones, circular for `SIGN` −1 and hyperbolic for 1.
#[inline]
#[allow(clippy::type_complexity)]
fn harmonics<const SIGN: i32>(s: Dd, c: Dd) -> ([[Dd; TERMS]; 2], [[Dd; TERMS]; 2]) {
    let sign = f64::from(SIGN);
    let (s2, c2) = (s * c * 2.0, c * c + s * s * sign);
    let (mut even, mut odd) = ([[Dd::ONE; TERMS], [Dd::ZERO; TERMS]], [[c; TERMS], [s; TERMS]]);
    for n in 1..TERMS {
        for f in [&mut even, &mut odd] {
            let (c, s) = (f[0][n - 1], f[1][n - 1]);
            (f[0][n], f[1][n]) = (c * c2 + s * s2 * sign, s * c2 + c * s2);
        }
    }
    (even, odd)
}

/// (G² − 2H I_b) with the middle moment I_b, rounded once.
fn separation(i: Vec3<Dd>, m: Vec3<Dd>, [l, mu, h]: [usize; 3]) -> Dd {
    let term = |j: usize, higher: usize, lower: usize, other: usize| {
        let square = &Expansion::from(m[j]) * &Expansion::from(m[j]);
        let difference = &Expansion::from(i[higher]) - &Expansion::from(i[lower]);
        &(&square * &difference) * &Expansion::from(i[other])
    };
    (&term(h, h, mu, l) - &term(l, mu, l, h)).to_dd() / (i[l] * i[h])
}

//! The quick form in `f64`: three theta functions, with constants and phases in double-double.
//!
//! The Cayley–Klein parameters α, β of the ball and its transverse angular velocity ζ = ω₁ + iω₂ = 2 (ᾱβ' − βᾱ') have
//! one zero and one pole each in a period of τ. With x = πτ/2K and the nome q of k therefore
//!
//! `α = e^{iφ_α} Z/√n₂`, `β = e^{iφ_β} W/√n₂`, `ζ = e^{iφ_ζ} V/√n₂`, `n₂ = |Z|² + |W|²`,
//! `Z ∝ θ₁(x ∓ iy_α)`, `W ∝ θ₂(x ∓ iy_β)`, `V ∝ θ₂(x ∓ iy_ζ)`, the three φ linear in t.
//!
//! The poles are those of 1/θ₄(x), and n₂ ∝ θ₄(x)². The zeros y = πη/2K are those of the squares, which are linear in u:
//! `2|α|² = 1 + u`, `2|β|² = 1 − u` and `|ζ|² = b (u_ζ − u)` with u₂ ≤ u_ζ ≤ u₃. The sign of y is that of the numerator of
//! the phase's rate, e, d and `a u_ζ − m·Γ/A`. Other letters as in [`nutation`](super::nutation).
//!
//! Reference: F. Klein and A. Sommerfeld, Über die Theorie des Kreisels, chapter VI.

use super::nutation::{Nutation, sign_of};
use crate::flow::free::{
    LEAST_TERMS as TERMS, Phase, TOO_FAR, V_MINUS, V_PLUS, least_value, polynomial, power, reduce,
};
use crate::num::complex::Complex;
use crate::num::elliptic::{Modulus, r_f};
use crate::num::trig::{nearest, sin_cos_turns};
use crate::num::{Dd, Precise, Real};
use crate::rotation::{Quat, Vec3};

/// The k'² of the nome 0.2, up to which the first term of a sum that is left out is below 4e-18 of it.
const SWITCH: f64 = 0.034_147_806_404_921;

/// The quick form of one motion.
#[derive(Clone, Debug)]
pub(super) struct Theta {
    /// x in turns.
    place: Phase,
    z: Function,
    w: Function,
    /// Times the transverse moment.
    v: Function,
}

/// A theta function along real x, times e^{iφ}.
#[derive(Clone, Debug)]
struct Function {
    /// Polynomials in cos 2x: of the real part over sin x, of the imaginary part over cos x.
    parts: [[f64; TERMS]; 2],
    /// φ in turns.
    angle: Phase,
}

/// The same with its sums, before it is fitted to a motion: coefficients of sin (2n+1)x and of i cos (2n+1)x.
struct Sums {
    sines: [Dd; TERMS],
    cosines: [Dd; TERMS],
    /// φ', in the unit of time of the nutation.
    rate: Dd,
}

impl Theta {
    /// Of a `nutation` in units of time of 2^`unit` s, of the top with the moment `transverse` that turns on its axis by `spin`
    /// rad/s more than the ball. `None` where the nome is too large.
    pub(super) fn new(nutation: &Nutation, transverse: Dd, spin: Dd, unit: i32) -> Option<Self> {
        let quarter = nutation.half?;
        if nutation.complement.hi() < SWITCH {
            return None;
        }
        let nome = if nutation.parameter == Dd::ZERO {
            Dd::ZERO
        } else {
            (-(Dd::PI * Modulus::new(nutation.parameter).quarter_period() / quarter)).exp()
        };
        let half_period = quarter / nutation.rate;
        let per_phase = Dd::FRAC_PI_2 / quarter; // x/τ
        let place = |t: Dd| (nutation.phase + nutation.rate * t) * per_phase;

        let mut sums = sums(nutation, nome, quarter);
        let factor = |sums: &Sums, exact: Complex<Dd>, t: Dd| {
            let found = sums.value(place(t)) * Complex::phase(reduce(sums.rate * t, Dd::TAU));
            exact * found.inverse_conjugate().conjugate()
        };
        // where none of the functions vanishes
        let near = (quarter * 0.5 - nutation.phase) / nutation.rate;
        let exact = functions::<Dd>(nutation, near);
        // half a period on, e^{iφ_ζ} tells the two possible rates apart
        let far = near + half_period;
        let later = functions::<f64>(nutation, far)[2];
        let turned = factor(&sums[2], exact[2], near).conjugate() * factor(&sums[2], later, far);
        if turned.re < Dd::ZERO {
            sums[2].rate = sums[2].rate - Dd::PI / half_period;
        }
        let per_second = |rate: Dd| rate.scaled(-unit) / Dd::TAU;
        let half_spin = spin * 0.5 / Dd::TAU;
        let fitted = |k: usize, scale: Dd, spins: f64| {
            let (sums, factor) = (&sums[k], factor(&sums[k], exact[k], near));
            let size = factor.norm_squared().sqrt() * scale;
            let angle = factor.im.atan2(factor.re) / Dd::TAU;
            Function {
                parts: [
                    polynomial(sums.sines.map(|x| x * size), V_PLUS),
                    polynomial(sums.cosines.map(|x| x * size), V_MINUS),
                ],
                angle: Phase::new(per_second(sums.rate) + half_spin * spins, angle),
            }
        };
        Some(Theta {
            place: Phase::new(per_second(nutation.rate * per_phase), nutation.phase * per_phase / Dd::TAU),
            z: fitted(0, Dd::ONE, 1.0),
            w: fitted(1, Dd::ONE, -1.0),
            v: fitted(2, transverse.scaled(-unit), -2.0),
        })
    }

    /// Attitude and transverse momentum at the time `t`, s, in coordinates with e₃ along the weight moment; `None` where so many
    /// turns have passed that `f64` pairs cannot reduce them.
    #[inline]
    pub(super) fn at(&self, t: f64) -> Option<(Quat<f64>, [f64; 2])> {
        let (x, low) = self.place.at([t, 0.0]);
        if x.is_nan() || x.abs() >= TOO_FAR {
            return None;
        }
        let (sin, cos) = sin_cos_turns(x - nearest(x), low);
        let double = (cos - sin) * (cos + sin); // cos 2x
        let part = |f: &Function| {
            let [sines, cosines] = &f.parts;
            Complex::new(sin * least_value(sines, double), cos * least_value(cosines, double))
        };
        let (z, w, v) = (part(&self.z), part(&self.w), part(&self.v));
        let size = 1.0 / (z.norm_squared() + w.norm_squared()).sqrt();
        let alpha = z * self.z.turned(t, size)?;
        let beta = w * self.w.turned(t, size)?;
        let m = v * self.v.turned(t, size)?;
        Some((Quat::new(alpha.re, Vec3([beta.re, beta.im, alpha.im])), [m.re, m.im]))
    }
}

impl Function {
    /// `size` e^{iφ}.
    #[inline]
    fn turned(&self, t: f64, size: f64) -> Option<Complex<f64>> {
        let (turns, low) = self.angle.at([t, 0.0]);
        if turns.is_nan() || turns.abs() >= TOO_FAR {
            return None;
        }
        let (sin, cos) = sin_cos_turns(turns - nearest(turns), low);
        Some(Complex::new(cos * size, sin * size))
    }
}

impl Sums {
    /// Of θ₁ or, times i, θ₂ at x ∓ iy, the upper sign for `sign` = 1, over a constant: e^{y} ∝ 1/√g with h g = q,
    /// `h = e^{−π(K'−η)/K}`.
    fn new(second: bool, nome: Dd, h: Dd, sign: Dd) -> Self {
        let g = nome / h;
        let mut sums = Sums { sines: [Dd::ZERO; TERMS], cosines: [Dd::ZERO; TERMS], rate: Dd::ZERO };
        for n in 0..TERMS as u32 {
            let weight = power(nome, n * n) * power(h, n);
            let (even, odd) = (Dd::ONE + power(g, 2 * n + 1), Dd::ONE - power(g, 2 * n + 1));
            let k = n as usize;
            if second {
                (sums.sines[k], sums.cosines[k]) = (-(sign * weight * odd), weight * even);
            } else {
                let weight = if n.is_multiple_of(2) { weight } else { -weight };
                (sums.sines[k], sums.cosines[k]) = (weight * even, -(sign * weight * odd));
            }
        }
        sums
    }

    fn value(&self, x: Dd) -> Complex<Dd> {
        let (mut s, mut c) = x.sin_cos();
        let (s2, c2) = (s * c * 2.0, (c - s) * (c + s));
        let mut sum = Complex::new(Dd::ZERO, Dd::ZERO);
        for (sine, cosine) in self.sines.iter().zip(self.cosines) {
            sum = sum + Complex::new(*sine * s, cosine * c);
            (s, c) = (s * c2 + c * s2, c * c2 - s * s2);
        }
        sum
    }
}

/// α, β and ζ at the time `t` of the nutation, with the digits of `S`.
fn functions<S: Precise>(nutation: &Nutation, t: Dd) -> [Complex<Dd>; 3] {
    let (q, rate) = nutation.at::<S>(t);
    let Vec3([o1, o2, _]) = (q.conjugate() * rate).v * S::of(2.0);
    let exactly = |re: S, im: S| Complex::new(re.to_dd(), im.to_dd());
    [exactly(q.w, q.v[2]), exactly(q.v[0], q.v[1]), exactly(o1, o2)]
}

/// Z, W and V. Of φ_ζ' only its value up to a frequency of the nutation is told here.
fn sums(nutation: &Nutation, nome: Dd, quarter: Dd) -> [Sums; 3] {
    let ([x1, x2, x3], [y1, y2], w3) = (nutation.x, nutation.y, nutation.w3);
    let between = x3 - x1;
    let [x, y] = nutation.apex;
    let off = (nutation.e * y + nutation.d * x) * 0.5; // m·Γ/A − a u_ζ
    // (u_ζ − u₂)(u₃ − u_ζ): of the two only the larger is a difference
    let product = off * off * between / (nutation.rate * nutation.rate * 4.0 * (x - x1));
    let above = if x < Dd::ONE { x3 - x } else { w3 + y };
    let below = if x < Dd::ONE { x - x2 } else { y2 - y };
    let (above, below) = if above > below { (above, product / above) } else { (product / below, below) };
    // e^{−π(K' − η)/K}, where K' − η has the functions √s, √(1 − s), √d
    let decay = |s: Dd, rest: Dd, d: Dd| (-(Dd::PI * s.sqrt() * r_f(rest, d, Dd::ONE) / quarter)).exp();
    let top = w3 + y2;
    let (sign_e, sign_d) = (sign_of(nutation.e), sign_of(nutation.d));
    let mut z = Sums::new(false, nome, decay(between / x3, x1 / x3, x2 / x3), sign_e);
    let mut w = Sums::new(true, nome, decay(w3 / top, y2 / top, y1 / between), sign_d);
    let side = above + below;
    let mut v = Sums::new(true, nome, decay(above / side, below / side, (x - x1) / between), -sign_of(off));
    // over a period of u the theta functions themselves turn by ±π
    let [alpha, beta] = nutation.advances();
    let per_time = nutation.rate / (quarter * 2.0);
    z.rate = (alpha - sign_e * Dd::PI) * per_time;
    w.rate = (beta - sign_d * Dd::PI) * per_time;
    v.rate = w.rate - z.rate + Dd::PI * per_time;
    [z, w, v]
}

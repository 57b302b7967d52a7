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
//! Next to the separatrix of the sleeping top, where the nome is large, Jacobi's imaginary transformation gives the same in
//! hyperbolic functions of β = πτ/2K' with the complementary nome q' (*dual* form): `Z ∝ θ₁(iβ ± α)`, `W, V ∝ θ₄(iβ ± α)`,
//! α = πη/2K'. Each period of τ, 2K, then adds a constant to φ.
//!
//! Reference: F. Klein and A. Sommerfeld, Über die Theorie des Kreisels, chapter VI.

use super::nutation::{Nutation, sign_of};
use crate::flow::free::{
    Family, LEAST_TERMS as TERMS, Pair, Phase, Powers, T, TOO_FAR, U, V_MINUS, V_PLUS, least_value, pair,
    polynomial, reduce,
};
use crate::num::complex::Complex;
use crate::num::elliptic::{Modulus, r_f};
use crate::num::error_free::{two_prod, two_sum};
use crate::num::trig::{nearest, sin_cos_turns};
use crate::num::{Dd, Precise, Real};
use crate::rotation::{Quat, Vec3};

/// Below this k'² (nome 0.2) the dual form is used; there both leave out less than 4e-18 of a sum.
const SWITCH: f64 = 0.034_147_806_404_921;

/// Below this k'² the powers in the dual form leave the range of a double.
const LEAST_COMPLEMENT: f64 = 1e-140;

/// The quick form of one motion.
#[derive(Clone, Debug)]
pub(super) struct Theta {
    form: Form,
    /// x in turns; τ/2K in the dual form.
    place: Phase,
    z: Function,
    w: Function,
    /// Times the transverse moment.
    v: Function,
}

#[derive(Clone, Copy, Debug)]
enum Form {
    Direct,
    /// β is `width` times what is left of τ/2K after whole periods.
    Dual {
        width: f64,
    },
}

/// A theta function along the motion, times e^{iφ}.
#[derive(Clone, Debug)]
struct Function {
    /// Real and imaginary part, as polynomials in cos 2x or cosh 2β which [`Place`] multiplies.
    parts: [[f64; TERMS]; 2],
    /// φ in turns.
    angle: Phase,
    /// What each whole period adds to it.
    jump: Pair,
}

/// The same with its sums, before it is fitted to a motion.
struct Sums {
    parts: [[Dd; TERMS]; 2],
    families: [Family; 2],
    /// φ', in the unit of time of the nutation.
    rate: Dd,
    /// Of φ, rad a period.
    jump: Dd,
}

/// Where the functions are evaluated: cos 2x or cosh 2β, and what multiplies the real and the imaginary part of Z, and of W and V.
struct Place<S> {
    double: S,
    z: [S; 2],
    w: [S; 2],
    periods: S,
}

impl<S: Real> Place<S> {
    fn direct((sin, cos): (S, S), periods: S) -> Self {
        Place { double: (cos - sin) * (cos + sin), z: [sin, cos], w: [sin, cos], periods }
    }

    fn dual(sinh: S, cosh: S, periods: S) -> Self {
        let double = cosh * cosh + sinh * sinh;
        Place { double, z: [cosh, sinh], w: [S::of(1.0), S::of(2.0) * sinh * cosh], periods }
    }
}

impl Theta {
    /// Of a `nutation` in units of time of 2^`unit` s, of the top with the moment `transverse` that turns on its axis by `spin`
    /// rad/s more than the ball. `None` on the separatrix and all but on it.
    pub(super) fn new(nutation: &Nutation, transverse: Dd, spin: Dd, unit: i32) -> Option<Self> {
        let quarter = nutation.half?;
        if nutation.complement.hi() < LEAST_COMPLEMENT {
            return None;
        }
        let period = quarter * 2.0 / nutation.rate;
        let is_direct = nutation.complement.hi() >= SWITCH;
        let dual_quarter = Modulus::new(nutation.parameter).quarter_period(); // K'
        let width = Dd::PI * quarter / dual_quarter;
        let place = |t: Dd| {
            let tau = (nutation.phase + nutation.rate * t) / (quarter * 2.0);
            let periods = tau.round();
            if is_direct {
                return Place::direct((tau * Dd::PI).sin_cos(), periods);
            }
            let beta = (tau - periods) * width;
            let (grown, shrunk) = (beta.exp(), (-beta).exp());
            Place::dual((grown - shrunk) * 0.5, (grown + shrunk) * 0.5, periods)
        };

        let mut sums = sums(nutation, quarter, dual_quarter, is_direct);
        let factor = |k: usize, sums: &Sums, exact: Complex<Dd>, (t, place): &(Dd, Place<Dd>)| {
            let jumps =
                if sums.jump == Dd::ZERO { Dd::ZERO } else { reduce(sums.jump * place.periods, Dd::TAU) };
            let angle = reduce(sums.rate * *t, Dd::TAU) + jumps;
            let found =
                sums.value(if k == 0 { place.z } else { place.w }, place.double) * Complex::phase(angle);
            exact * found.inverse_conjugate().conjugate()
        };
        let placed = |t: Dd| (t, place(t));
        // where none of the functions vanishes
        let near = placed((quarter * 0.5 - nutation.phase) / nutation.rate);
        let exact = functions::<Dd>(nutation, near.0);
        let mut factors = [0, 1, 2].map(|k| factor(k, &sums[k], exact[k], &near));
        // half a period on, e^{iφ_ζ} tells the two possible rates apart
        let far = placed(near.0 + period * 0.5);
        let later = functions::<f64>(nutation, far.0)[2];
        let turned = factors[2].conjugate() * factor(2, &sums[2], later, &far);
        if turned.re < Dd::ZERO {
            sums[2].rate = sums[2].rate - Dd::TAU / period;
            factors[2] = factor(2, &sums[2], exact[2], &near);
        }
        let per_second = |rate: Dd| rate.scaled(-unit);
        let half_spin = spin * 0.5 / Dd::TAU;
        let fitted = |k: usize, scale: Dd, spins: f64| {
            let (sums, factor) = (&sums[k], factors[k]);
            let size = factor.norm_squared().sqrt() * scale;
            let part = |part: usize| polynomial(sums.parts[part].map(|x| x * size), sums.families[part]);
            let rate = per_second(sums.rate / Dd::TAU) + half_spin * spins;
            Function {
                parts: [part(0), part(1)],
                angle: Phase::new(rate, factor.im.atan2(factor.re) / Dd::TAU),
                jump: pair(sums.jump / Dd::TAU),
            }
        };
        let (form, unit_of_place) = if is_direct {
            (Form::Direct, quarter * 4.0)
        } else {
            (Form::Dual { width: width.hi() }, quarter * 2.0)
        };
        let place = Phase::new(per_second(nutation.rate / unit_of_place), nutation.phase / unit_of_place);
        Some(Theta {
            form,
            place,
            z: fitted(0, Dd::ONE, 1.0),
            w: fitted(1, Dd::ONE, -1.0),
            v: fitted(2, transverse.scaled(-unit), -2.0),
        })
    }

    /// Attitude and transverse momentum at the time `t`, s, in coordinates with e₃ along the weight moment; `None` where so many
    /// turns have passed that `f64` pairs cannot reduce them.
    #[inline]
    pub(super) fn at(&self, t: f64) -> Option<(Quat<f64>, [f64; 2])> {
        let (phase, low) = self.place.at([t, 0.0]);
        if phase.is_nan() || phase.abs() >= TOO_FAR {
            return None;
        }
        let whole = nearest(phase);
        let place = match self.form {
            Form::Direct => Place::direct(sin_cos_turns(phase - whole, low), 0.0),
            Form::Dual { width } => {
                let beta = ((phase - whole) + low) * width;
                let grown = libm::exp(beta.abs());
                let shrunk = 1.0 / grown;
                let sinh = 0.5 * (grown - shrunk);
                Place::dual(if beta < 0.0 { -sinh } else { sinh }, 0.5 * (grown + shrunk), whole)
            }
        };
        let (z, w, v) = (
            self.z.at(place.z, place.double),
            self.w.at(place.w, place.double),
            self.v.at(place.w, place.double),
        );
        let size = 1.0 / (z.norm_squared() + w.norm_squared()).sqrt();
        let alpha = z * self.z.turned(t, place.periods, size)?;
        let beta = w * self.w.turned(t, place.periods, size)?;
        let m = v * self.v.turned(t, place.periods, size)?;
        Some((Quat::new(alpha.re, Vec3([beta.re, beta.im, alpha.im])), [m.re, m.im]))
    }
}

impl Function {
    #[inline]
    fn at(&self, factors: [f64; 2], double: f64) -> Complex<f64> {
        let [real, imaginary] = &self.parts;
        Complex::new(factors[0] * least_value(real, double), factors[1] * least_value(imaginary, double))
    }

    /// `size` e^{iφ} after `periods`.
    #[inline]
    fn turned(&self, t: f64, periods: f64, size: f64) -> Option<Complex<f64>> {
        let (mut turns, mut low) = self.angle.at([t, 0.0]);
        if turns.is_nan() || turns.abs() >= TOO_FAR {
            return None;
        }
        turns -= nearest(turns);
        if periods != 0.0 {
            let (jumps, rest) = two_prod(self.jump[0], periods);
            let (sum, error) = two_sum(turns, jumps - nearest(jumps));
            turns = sum - nearest(sum);
            low += error + (rest + self.jump[1] * periods);
        }
        let (sin, cos) = sin_cos_turns(turns, low);
        Some(Complex::new(cos * size, sin * size))
    }
}

impl Sums {
    /// Of θ₁ or, times i, θ₂ at x ∓ iy, the upper sign for `sign` = 1, over a constant: e^{y} ∝ 1/√g with h g = q,
    /// `h = e^{−π(K'−η)/K}`.
    fn direct(second: bool, nome: Dd, h: Dd, sign: Dd) -> Self {
        let [of_nome, of_h, of_g] = [nome, h, nome / h].map(Powers::of);
        let term = |n: u32| {
            let weight = of_nome.power(n * n) * of_h.power(n) * if second { 1.0 } else { alternating(n) };
            let (even, odd) = (Dd::ONE + of_g.power(2 * n + 1), Dd::ONE - of_g.power(2 * n + 1));
            let odd = -(sign * weight * odd);
            if second { [odd, weight * even] } else { [weight * even, odd] }
        };
        Sums::of(term, [V_PLUS, V_MINUS])
    }

    /// Of the dual form: θ₁ or, times i, θ₄ at iβ ± α, over a constant.
    fn dual(second: bool, nome: Dd, alpha: Dd, sign: Dd) -> Self {
        let powers = Powers::of(nome);
        let term = |n: u32| {
            let multiple = if second { 2 * n } else { 2 * n + 1 };
            let (sin, cos) = (alpha * f64::from(multiple)).sin_cos();
            let weight = powers.power(if second { n * n } else { n * n + n }) * alternating(n);
            let weight = weight * if second && n > 0 { 2.0 } else { 1.0 };
            if second { [weight * cos, -(sign * weight * sin)] } else { [sign * weight * sin, weight * cos] }
        };
        Sums::of(term, if second { [T, U] } else { [V_MINUS, V_PLUS] })
    }

    fn of(term: impl Fn(u32) -> [Dd; 2], families: [Family; 2]) -> Self {
        let terms: [[Dd; 2]; TERMS] = core::array::from_fn(|n| term(n as u32));
        let parts = [0, 1].map(|part: usize| terms.map(|term| term[part]));
        Sums { parts, families, rate: Dd::ZERO, jump: Dd::ZERO }
    }

    fn value(&self, factors: [Dd; 2], double: Dd) -> Complex<Dd> {
        let part = |k: usize| {
            let [first, a, b] = self.families[k].map(Dd::of);
            let (mut now, mut next) = (first, a + b * double);
            let mut sum = Dd::ZERO;
            for term in self.parts[k] {
                sum = sum + term * now;
                (now, next) = (next, next * double * 2.0 - now);
            }
            sum * factors[k]
        };
        Complex::new(part(0), part(1))
    }
}

/// (−1)ⁿ.
fn alternating(n: u32) -> f64 {
    if n.is_multiple_of(2) { 1.0 } else { -1.0 }
}

/// α, β and ζ at the time `t` of the nutation, with the digits of `S`.
fn functions<S: Precise>(nutation: &Nutation, t: Dd) -> [Complex<Dd>; 3] {
    let (q, rate) = nutation.at::<S>(t);
    let Vec3([o1, o2, _]) = (q.conjugate() * rate).v * S::of(2.0);
    let exactly = |re: S, im: S| Complex::new(re.to_dd(), im.to_dd());
    [exactly(q.w, q.v[2]), exactly(q.v[0], q.v[1]), exactly(o1, o2)]
}

/// Z, W and V from K and K', in the direct form or the dual one. Of φ_ζ' only its value up to a frequency of the nutation is told here.
fn sums(nutation: &Nutation, quarter: Dd, dual_quarter: Dd, is_direct: bool) -> [Sums; 3] {
    let ([x1, x2, x3], [y1, y2], w3) = (nutation.x, nutation.y, nutation.w3);
    let (between, span) = (x3 - x1, nutation.span);
    let x = nutation.apex[0];
    let off = nutation.apex_product();
    let [below, above] = nutation.apex_apart();
    // of each zero: sn², cn², dn² of η, and the same of K' − η, which for k = 0 is the one that is finite
    let second = |y1: Dd, y2: Dd, w3: Dd| {
        let top = y2 + w3;
        [[y2 * between / (y1 * top), span * w3 / (y1 * top), span / y1], [w3 / top, y2 / top, y1 / between]]
    };
    let zeros = [
        [[x1 / x2, span / x2, x3 * span / (x2 * between)], [between / x3, x1 / x3, x2 / x3]],
        second(y1, y2, w3),
        second(x - x1, below, above),
    ];
    let signs = [sign_of(nutation.e), sign_of(nutation.d), -sign_of(off)];
    let argument = |[s, c, d]: [Dd; 3]| s.sqrt() * r_f(c, d, Dd::ONE);
    let exponential = |of: Dd, by: Dd| (-(Dd::PI * of / by)).exp();
    let nome = if !is_direct {
        exponential(quarter, dual_quarter)
    } else if nutation.parameter == Dd::ZERO {
        Dd::ZERO
    } else {
        exponential(dual_quarter, quarter)
    };
    let per_time = nutation.rate / (quarter * 2.0);
    let [mut z, mut w, mut v] = [0, 1, 2].map(|k| {
        let ([eta, rest], sign) = (zeros[k], signs[k]);
        if is_direct {
            return Sums::direct(k > 0, nome, exponential(argument(rest), quarter), sign);
        }
        let alpha = Dd::FRAC_PI_2 * argument(eta) / dual_quarter;
        let mut sums = Sums::dual(k > 0, nome, alpha, sign);
        sums.rate = sign * alpha * per_time * 2.0;
        sums.jump = sign * (Dd::PI - alpha * 2.0);
        sums
    });
    // over a period of u the theta functions of x themselves turn by ±π
    let [alpha, beta] = nutation.advances();
    let z_rate = (alpha - signs[0] * Dd::PI) * per_time;
    let w_rate = (beta - signs[1] * Dd::PI) * per_time;
    z.rate = z.rate + z_rate;
    w.rate = w.rate + w_rate;
    v.rate = v.rate + (w_rate - z_rate + Dd::PI * per_time);
    [z, w, v]
}

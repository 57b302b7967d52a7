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

mod direct;
mod dual;
mod series;

pub(in crate::flow) use self::series::{
    Family, LEAST_TERMS, T, U, V_MINUS, V_PLUS, least_value, polynomial, power,
};
use self::series::{Form, TERMS, value};
use super::phase::{Pair, Phase, TOO_FAR};
use super::polhode::Polhode;
use crate::num::error_free::{two_prod, two_sum};
use crate::num::trig::{nearest, sin_cos_turns};
use crate::num::{Dd, Real};
use crate::rotation::{Quat, Vec3};

/// Below this k'² (nome 0.2) the dual form is used; there both forms truncate below 1e-17.
const SWITCH: f64 = 0.034_147_806_404_921;

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

impl Theta {
    /// For the attitude `q0` and the momentum `m` at the start.
    pub(super) fn of(polhode: &Polhode<Dd>, q0: Quat<Dd>, m: Vec3<Dd>) -> Self {
        let series =
            if polhode.complement.hi() >= SWITCH { direct::series(polhode) } else { dual::series(polhode) };
        // Z at the start gives the twist of P(0); its swing is that of m
        let (re, im) = series.start;
        let size = (re * re + im * im).sqrt();
        let twist = Quat::new(re / size, Vec3::unit(polhode.axes[0]) * (polhode.sigma * im / size));
        let attitude = q0 * (twist * polhode.swing(m)).conjugate();
        Theta {
            axes: polhode.axes,
            about_smallest: polhode.about_smallest,
            sigma: polhode.sigma.hi(),
            delta: polhode.delta.hi(),
            norm: polhode.norm.hi(),
            form: series.form,
            phase: series.phase,
            twist: Phase::new(series.twist_rate / Dd::TAU, Dd::ZERO),
            z: series.z,
            w: series.w,
            least: series.least,
            attitude: attitude.map(Dd::hi),
        }
    }

    /// Attitude and momentum at `t`; `None` where so many turns have passed that `f64` pairs cannot reduce them.
    #[inline]
    pub(super) fn at(&self, t: Pair) -> Option<(Quat<f64>, Vec3<f64>)> {
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

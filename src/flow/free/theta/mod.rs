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
mod lanes;
mod series;

use multiversion::multiversion;

pub(super) use self::lanes::Points;
pub(in crate::flow) use self::series::{
    Family, LEAST_TERMS, Powers, T, U, V_MINUS, V_PLUS, least_value, polynomial,
};
use self::series::{Form, Series, TERMS, value};
use super::phase::{Pair, Phase, TOO_FAR};
use super::polhode::{FEW, Lanes, Polhode, TOGETHER};
use crate::num::error_free::{two_prod, two_sum};
use crate::num::exponential::exp_of_positive;
use crate::num::trig::{nearest, sin_cos_turns};
use crate::num::{Dd, Several};
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
        let series = if is_direct(polhode) { direct::series(polhode) } else { dual::series(polhode) };
        let attitude = from_space(&at_start(polhode, q0, m, &series), &[polhode.axes[0]]);
        Self::of_series(polhode, &series, attitude.map(Dd::hi))
    }

    /// The same of each of `motions`, with the bits that it has alone: those of one form are worked out side by side.
    pub(super) fn of_each(motions: &[(&Polhode<Dd>, Quat<Dd>, Vec3<Dd>)]) -> Vec<Self> {
        if motions.len() < FEW {
            return motions.iter().map(|&(polhode, q0, m)| Self::of(polhode, q0, m)).collect();
        }
        let polhodes = || motions.iter().map(|&(polhode, ..)| polhode);
        let direct: Vec<_> = polhodes().filter(|polhode| is_direct(polhode)).collect();
        let dual: Vec<_> = polhodes().filter(|polhode| is_dual(polhode)).collect();
        let mut direct = direct::series_of_each(&direct).into_iter();
        let mut dual = dual::series_of_each(&dual).into_iter();
        let series = polhodes().map(|polhode| {
            let made = match (is_direct(polhode), is_dual(polhode)) {
                (true, _) => direct.next(),
                (false, true) => dual.next(),
                (false, false) => None,
            };
            made.unwrap_or_else(|| dual::series(polhode))
        });
        let series: Vec<Series> = series.collect();
        let mut all = Vec::with_capacity(motions.len());
        for (motions, series) in motions.chunks(TOGETHER).zip(series.chunks(TOGETHER)) {
            let starts = motions.iter().zip(series);
            let starts = starts.map(|(&(polhode, q0, m), series)| at_start(polhode, q0, m, series));
            let mut axes = [0; TOGETHER];
            axes.iter_mut().zip(motions).for_each(|(axis, (polhode, ..))| *axis = polhode.axes[0]);
            let attitudes = side_by_side(&Lanes::gathered(starts), &axes);
            for (n, ((polhode, ..), series)) in motions.iter().zip(series).enumerate() {
                let attitude = attitudes.each_ref().map(|x| x.get(n).hi());
                all.push(Self::of_series(polhode, series, attitude));
            }
        }
        all
    }

    /// From q0 ∘ P(0)*.
    fn of_series(polhode: &Polhode<Dd>, series: &Series, attitude: [f64; 4]) -> Self {
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
            attitude: Quat::from_components(attitude),
        }
    }

    /// Attitude and momentum at `t`; `None` where so many turns have passed that `f64` pairs cannot reduce them.
    #[inline]
    pub(super) fn at(&self, t: Pair) -> Option<(Quat<f64>, Vec3<f64>)> {
        let phase = self.phase.at(t);
        let (psi, psi_low) = self.twist.at(t);
        if !(phase.0.abs() < TOO_FAR && psi.abs() < TOO_FAR) {
            return None;
        }
        let psi = (psi - nearest(psi), psi_low);
        Some(if self.about_smallest {
            self.after::<true>(phase, psi)
        } else {
            self.after::<false>(phase, psi)
        })
    }

    #[inline(always)]
    fn after<const ABOUT_SMALLEST: bool>(
        &self,
        phase: (f64, f64),
        psi: (f64, f64),
    ) -> (Quat<f64>, Vec3<f64>) {
        let (Sums { z, w, least }, (psi, psi_low)) = match self.form {
            Form::Direct => (self.direct::<ABOUT_SMALLEST>(phase), psi),
            Form::Dual { width, jump } => self.dual::<ABOUT_SMALLEST>(width, jump, phase, psi),
            Form::Limit { width, jump } => self.limit::<ABOUT_SMALLEST>(width, jump, phase, psi),
            Form::Separatrix => {
                let beta = phase.0 + phase.1;
                (self.hyperbolic::<false, ABOUT_SMALLEST>(beta, 1.0), psi)
            }
        };
        let (turn, momentum) = self.assembled::<ABOUT_SMALLEST>(z, w, least, sin_cos_turns(psi, psi_low));
        let (mut m, mut v) = (Vec3::zero(), Vec3::zero());
        for (k, axis) in self.axes.into_iter().enumerate() {
            (m[axis], v[axis]) = (momentum[k], turn[k + 1]);
        }
        (self.attitude * Quat::new(turn[0], v), m)
    }

    #[inline(always)]
    fn direct<const ABOUT_SMALLEST: bool>(&self, (phase, phase_low): (f64, f64)) -> Sums {
        let (s, c) = sin_cos_turns(phase - nearest(phase), phase_low);
        let x = (c - s) * (c + s); // cos 2x
        let sum = least_value(&self.least, x);
        Sums {
            z: [value(&self.z[0], x), 2.0 * s * c * value(&self.z[1], x)],
            w: [s * value(&self.w[0], x), c * value(&self.w[1], x)],
            least: if ABOUT_SMALLEST { sum } else { c * sum },
        }
    }

    /// With Ψ after the jumps of whole half periods.
    #[inline(always)]
    fn dual<const ABOUT_SMALLEST: bool>(
        &self,
        width: f64,
        jump: Pair,
        phase: (f64, f64),
        psi: (f64, f64),
    ) -> (Sums, (f64, f64)) {
        let (beta, sign, psi) = jumped(width, jump, phase, psi);
        (self.hyperbolic::<true, ABOUT_SMALLEST>(beta, sign), psi)
    }

    #[inline]
    fn limit<const ABOUT_SMALLEST: bool>(
        &self,
        width: f64,
        jump: Pair,
        phase: (f64, f64),
        psi: (f64, f64),
    ) -> (Sums, (f64, f64)) {
        let (beta, sign, psi) = jumped(width, jump, phase, psi);
        let sums = self.hyperbolic::<false, ABOUT_SMALLEST>(beta, sign);
        // 1 ± 2q' cosh 4β with q' = e^{−2 width}, and no power of cosh
        let end = libm::exp(4.0 * bounded(beta).abs() - 2.0 * width);
        let sum = self.least[0] * if ABOUT_SMALLEST { 1.0 + end } else { 1.0 - end };
        (Sums { least: if ABOUT_SMALLEST { sum } else { sign * sum }, ..sums }, psi)
    }

    /// With `POWERS`, the polynomials are no constants.
    #[inline(always)]
    fn hyperbolic<const POWERS: bool, const ABOUT_SMALLEST: bool>(&self, beta: f64, sign: f64) -> Sums {
        let beta = bounded(beta);
        let grown = exp_of_positive(beta.abs());
        let shrunk = 1.0 / grown;
        let cosh = 0.5 * (grown + shrunk);
        let sinh = 0.5 * (grown - shrunk);
        let sinh = if beta < 0.0 { -sinh } else { sinh };
        // cosh 2β, except where all polynomials are constants and it might overflow
        let x = if POWERS { cosh * cosh + sinh * sinh } else { 1.0 };
        let sum = least_value(&self.least, 2.0 * x * x - 1.0);
        Sums {
            z: [cosh * value(&self.z[0], x), sinh * value(&self.z[1], x)],
            w: [sign * sinh * value(&self.w[0], x), sign * cosh * value(&self.w[1], x)],
            least: if ABOUT_SMALLEST { sum } else { sign * sum },
        }
    }

    /// The turn from P(0), along w, a, b, c, and the momentum, along a, b, c, from Z, W, the theta quotient times n₂, and sine
    /// and cosine of Ψ.
    #[inline(always)]
    fn assembled<const ABOUT_SMALLEST: bool>(
        &self,
        z: Pair,
        w: Pair,
        least: f64,
        (sin, cos): (f64, f64),
    ) -> ([f64; 4], [f64; 3]) {
        let (zz, ww) = (z[0] * z[0] + z[1] * z[1], w[0] * w[0] + w[1] * w[1]);
        let r = 1.0 / (zz + ww).sqrt();
        let r2 = r * r;
        let twice = 2.0 * self.norm * r2;
        let middle = twice * (z[0] * w[0] + z[1] * w[1]);
        let momentum = if ABOUT_SMALLEST {
            [least * r2, middle, twice * self.delta * (z[0] * w[1] - z[1] * w[0])]
        } else {
            [self.norm * self.sigma * r2 * (zz - ww), middle, least * r2]
        };
        let turn = [
            r * (cos * z[0] - sin * z[1]),
            self.sigma * r * (cos * z[1] + sin * z[0]),
            r * (cos * w[1] + sin * w[0]),
            -self.delta * r * (cos * w[0] - sin * w[1]),
        ];
        (turn, momentum)
    }
}

/// q0, m, G, σ, and Re Z and Im Z.
fn at_start(polhode: &Polhode<Dd>, q0: Quat<Dd>, m: Vec3<Dd>, series: &Series) -> [Dd; 11] {
    let ([w, x, y, z], [m1, m2, m3], (re, im)) = (q0.components(), m.0, series.start);
    [w, x, y, z, m1, m2, m3, polhode.norm, polhode.sigma, re, im]
}

#[multiversion(targets("x86_64+avx512f+avx512dq+avx512vl", "x86_64+avx2"))]
fn side_by_side(at_start: &[Lanes; 11], axes: &[usize; TOGETHER]) -> [Lanes; 4] {
    from_space(at_start, axes)
}

/// q0 ∘ P(0)* of motions about the axes a.
#[inline(always)]
fn from_space<S: Several>(at_start: &[S; 11], axes: &[usize]) -> [S; 4] {
    let [w, x, y, z, m1, m2, m3, norm, sigma, re, im] = *at_start;
    let (q0, one) = ([w, x, y, z], S::of(1.0));
    let mut unit = [S::of(0.0); 3];
    for (n, axis) in axes.iter().enumerate() {
        unit[*axis].set(n, Dd::ONE);
    }
    let [e1, e2, e3] = unit;
    // Z at the start gives the twist of P(0); its swing is the shortest turn of m/G to σe_a
    let size = (re * re + im * im).sqrt();
    let sine = sigma * im / size;
    let twist = [re / size, e1 * sine, e2 * sine, e3 * sine];
    let (a1, a2, a3) = (e1 * sigma, e2 * sigma, e3 * sigma);
    let [w, x, y, z] =
        [norm + (m1 * a1 + m2 * a2 + m3 * a3), m2 * a3 - m3 * a2, m3 * a1 - m1 * a3, m1 * a2 - m2 * a1];
    let scale = one / (w * w + (x * x + y * y + z * z)).sqrt();
    let [w, x, y, z] = product(twist, [w * scale, x * scale, y * scale, z * scale]);
    product(q0, [w, -x, -y, -z])
}

/// Hamilton's product, put into the function that takes it: as an operation of quaternions it would be a call.
#[inline(always)]
fn product<S: Several>([w, x, y, z]: [S; 4], [pw, px, py, pz]: [S; 4]) -> [S; 4] {
    [
        w * pw - (x * px + y * py + z * pz),
        px * w + x * pw + (y * pz - z * py),
        py * w + y * pw + (z * px - x * pz),
        pz * w + z * pw + (x * py - y * px),
    ]
}

fn is_direct(polhode: &Polhode<Dd>) -> bool {
    polhode.complement.hi() >= SWITCH
}

/// Whether it takes the dual form itself, and no limit of that.
fn is_dual(polhode: &Polhode<Dd>) -> bool {
    !is_direct(polhode) && polhode.asymptotic.is_none()
}

/// Z, W and the theta quotient along the smallest moment times n₂.
struct Sums {
    z: Pair,
    w: Pair,
    least: f64,
}

/// β of the rest after whole half periods, the sign that these leave, and Ψ after their jumps.
#[inline(always)]
fn jumped(
    width: f64,
    jump: Pair,
    (phase, phase_low): (f64, f64),
    (psi, psi_low): (f64, f64),
) -> (f64, f64, (f64, f64)) {
    let n = nearest(phase);
    let (turns, rest) = two_prod(jump[0], n);
    let (sum, error) = two_sum(psi, turns - nearest(turns));
    let psi = (sum - nearest(sum), psi_low + (error + (rest + jump[1] * n)));
    let sign = if nearest(0.5 * n) != 0.5 * n { -1.0 } else { 1.0 };
    (((phase - n) + phase_low) * width, sign, psi)
}

/// e^{±350} is as good as infinity and its square still finite.
#[inline(always)]
fn bounded(beta: f64) -> f64 {
    beta.clamp(-350.0, 350.0)
}

//! The curve of the momentum in the body: which axis it encloses, how wide, how fast, and where the start lies on it.
//!
//! # Notation
//! | letter | meaning |
//! |---|---|
//! | I, m, G, H | moments, momentum in the body, \|m\|, energy |
//! | l, μ, h | axes of the smallest, middle, largest moment |
//! | a, b, c | axis about which m circulates (l or h), middle axis, the third |
//! | Δ_k | `G² − 2H I_k`: zero on the separatrix for k = μ |
//! | A, B, C | amplitudes: `m = (σA dn, B sn, C cn)` along (a, b, c) |
//! | σ, δ | sign of m_a; σ if (a, b, c) is an even permutation, else −σ |
//! | k², k'² | parameter and complementary parameter of the elliptic functions |
//! | u, ν, K | phase, its rate, quarter period |
//!
//! # Range
//! A body that turns about its middle axis up to a deviation of 10⁻²⁰⁰ stays there for long, but not for ever: its
//! period is that of ln(4/k'), and k'² = 10⁻⁴⁰⁰ is no double. Squares of momenta are therefore formed of numbers
//! near one: m is divided by a power of two near G, and for Δ_μ the pair (m_l, m_h) by one of its own. Where k'² is
//! below 2⁻⁵⁰⁰, [`Asymptotic`] replaces the elliptic functions by their limits, which are then right in all digits.
//!
//! Source: Landau and Lifshitz, Mechanics, §37, without relabelled vectors and without differences that cancel.

use crate::num::elliptic::{Modulus, incomplete};
use crate::num::{Dd, Expansion, Precise};
use crate::rotation::{Quat, Vec3};

/// Below this k'² the elliptic functions are replaced by their limits for k' → 0.
const NEGLIGIBLE: f64 = power_of_two(-500);

/// Below this cn² has lost digits that are needed, and is no longer needed beside one.
const SMALL: f64 = power_of_two(-200);

/// With less momentum (of G) along its axis, that of a symmetric top stays fixed in the body for 2⁹⁶ rad and longer.
const SYMMETRIC: f64 = power_of_two(-480);

/// Squares of momenta between these, and their products, keep clear of both ends of the range.
const CLEAR_BELOW: f64 = power_of_two(-100);
const CLEAR_ABOVE: f64 = power_of_two(100);

/// 2ⁿ of a normal number.
const fn power_of_two(n: i64) -> f64 {
    f64::from_bits(((1023 + n) as u64) << 52)
}

/// Constants of one polhode and of the start on it.
#[derive(Clone, Debug)]
pub(super) struct Polhode<S> {
    /// a, b, c.
    pub(super) axes: [usize; 3],
    /// Whether a is the axis of the smallest moment: long-axis mode.
    pub(super) about_smallest: bool,
    pub(super) sigma: S,
    pub(super) delta: S,
    /// A, B, C.
    pub(super) amplitude: [S; 3],
    /// I_a, I_b, I_c.
    pub(super) moments: [S; 3],
    pub(super) norm: S,
    pub(super) twice_energy: S,
    pub(super) parameter: S,
    pub(super) complement: S,
    pub(super) rate: S,
    /// sn and cn ≥ 0 of the start; where cn was negative both are turned round, by half a period.
    pub(super) start: (S, S),
    pub(super) half_turned: bool,
    /// Δ_μ; zero also where it is too small for a double.
    pub(super) separation: S,
    /// The exponent of G where that is far from zero.
    pub(super) unit: i32,
    /// Where k'² is below 2⁻⁵⁰⁰.
    pub(super) asymptotic: Option<Asymptotic<S>>,
}

/// The limits of the elliptic functions for k' → 0; what they neglect is k' = 2⁻²⁵⁰ of the values.
#[derive(Clone, Copy, Debug)]
pub(super) struct Asymptotic<S> {
    /// k'; zero also where it is too small for a double.
    modulus: S,
    /// K = ln (4/k'); `None` on the separatrix.
    pub(super) quarter: Option<S>,
    /// The phase of the start.
    phase: S,
}

impl<S: Precise> Asymptotic<S> {
    /// For k'² = 4ⁿ `complement` and a start with sn = ±1 and cn = 2ⁿ `cn` far below one.
    #[cold]
    fn of(complement: S, sn: S, cn: S, n: i32) -> Self {
        let one = S::of(1.0);
        let ln_2 = S::from_dd(Dd::LN_2);
        let power = ln_2 * S::of(f64::from(n));
        let (quarter, to_quarter) = if complement == S::of(0.0) {
            (None, ln_2 - cn.ln() - power) // the phase itself: arsinh (sn/cn)
        } else {
            let x = cn / complement.sqrt();
            // arsinh x, where cn = k' sinh (K − u)
            let rest = (x + (one + x * x).sqrt()).ln();
            let quarter = S::of(2.0) * ln_2 - S::of(0.5) * complement.ln() - power;
            (Some(quarter), quarter - rest)
        };
        Asymptotic {
            modulus: scaled(complement.sqrt(), n),
            quarter,
            phase: if sn < S::of(0.0) { -to_quarter } else { to_quarter },
        }
    }

    /// The same where the pair (sn, cn) keeps all digits.
    #[cold]
    fn usual((sn, cn): (S, S), parameter: S, complement: S) -> Self {
        let separatrix = complement == S::of(0.0);
        Asymptotic {
            modulus: complement.sqrt(),
            quarter: (!separatrix).then(|| Modulus::new(complement).quarter_period()),
            phase: incomplete(sn, cn, parameter, complement),
        }
    }

    /// (sn u, cn u, dn u) for |u| ≤ K.
    pub(super) fn sn_cn_dn(&self, u: S) -> (S, S, S) {
        match self.quarter {
            Some(quarter) if u.abs() * S::of(2.0) > quarter => {
                let (grown, shrunk) = ((quarter - u.abs()).exp(), (u.abs() - quarter).exp());
                let half = self.modulus * S::of(0.5);
                let sn = S::of(if u < S::of(0.0) { -1.0 } else { 1.0 });
                (sn, half * (grown - shrunk), half * (grown + shrunk))
            }
            _ => Modulus::new(S::of(0.0)).sn_cn_dn(u),
        }
    }
}

impl<S: Precise> Polhode<S> {
    /// For moments `i` and momentum `m` of size `norm` > 0, and their [`exact_separation`] or
    /// [`rounded_separation`], whose error decides the accuracy near the separatrix. `None` where the momentum stays
    /// fixed in the body.
    pub(super) fn of(i: Vec3<S>, m: Vec3<S>, norm: S, scaled_separation: S) -> Option<Self> {
        let order = i.ascending();
        let (unit, lift) = (exponent(norm), lift(m, order));
        if unit == 0 && lift == 0 {
            Self::at_scale::<false>(i, m, norm, scaled_separation, order, [0, 0])
        } else {
            Self::at_scale::<true>(i, m, norm, scaled_separation, order, [unit, lift - unit])
        }
    }

    /// The same with powers of two: 2^unit ≈ G, and 2^(unit + n) ≈ the larger of |m_l| and |m_h|.
    fn at_scale<const SCALED: bool>(
        i: Vec3<S>,
        given: Vec3<S>,
        norm: S,
        scaled_separation: S,
        [l, mu, h]: [usize; 3],
        [unit, n]: [i32; 2],
    ) -> Option<Self> {
        let zero = S::of(0.0);
        let scaled = |x: S, n: i32| if SCALED { scaled(x, n) } else { x };
        let m = Vec3(given.0.map(|m| scaled(m, -unit)));
        let square = |k: usize| m[k] * m[k];
        // sums of terms of one sign: nothing cancels
        let delta_l = square(mu) * (i[mu] - i[l]) / i[mu] + square(h) * (i[h] - i[l]) / i[h];
        let delta_h = -(square(l) * (i[h] - i[l]) / i[l] + square(mu) * (i[h] - i[mu]) / i[mu]);
        let separation = scaled_separation / (i[l] * i[h]);
        let about_smallest = separation <= zero;
        let (a, b, c) = if about_smallest { (l, mu, h) } else { (h, mu, l) };
        let (delta_a, delta_c) = if about_smallest { (delta_l, delta_h) } else { (delta_h, delta_l) };
        if delta_a == zero || delta_c == zero || (given[a] == zero && given[c] == zero) {
            return None;
        }

        let one = S::of(1.0);
        let sigma = if given[a] < zero { -one } else { one };
        let delta = if (b + 3 - a) % 3 == 1 { sigma } else { -sigma };
        let (ca, ba, cb) = (i[c] - i[a], i[b] - i[a], i[c] - i[b]);
        if cb == zero && m[a].magnitude() < SYMMETRIC {
            return None;
        }
        // of so small a circle about the axis a the radii are no doubles
        if (i[b] * delta_a).magnitude().min((i[c] * delta_a).magnitude()) < f64::MIN_POSITIVE {
            return None;
        }
        let amp_a = (-(i[a] * delta_c) / ca).sqrt();
        let amp_b = (i[b] * delta_a / ba).sqrt();
        let amp_c = (i[c] * delta_a / ca).sqrt();
        let denominator = if about_smallest { delta_h * (i[mu] - i[l]) } else { delta_l * (i[h] - i[mu]) };
        let (x, y) = (m[b] / amp_b, m[c] / amp_c);
        let half_turned = given[c] < zero;
        let length = (x * x + y * y).sqrt();
        let length = if half_turned { -length } else { length };
        let start = (x / length, y / length);
        let parameter = -(delta_a * cb) / (delta_c * ba);
        let lifted = separation * (i[h] - i[l]) / denominator;
        let complement = scaled(lifted, 2 * n);
        let asymptotic = if complement.magnitude() >= NEGLIGIBLE {
            None
        } else if start.1.magnitude() < SMALL {
            let cn = scaled(given[c], -(n + unit)) / (amp_c * length);
            Some(Asymptotic::of(lifted, start.0, cn, n))
        } else {
            Some(Asymptotic::usual(start, parameter, complement))
        };
        Some(Polhode {
            axes: [a, b, c],
            about_smallest,
            sigma,
            delta,
            amplitude: [amp_a, amp_b, amp_c].map(|amplitude| scaled(amplitude, unit)),
            moments: [i[a], i[b], i[c]],
            norm,
            twice_energy: scaled(square(0) / i[0] + square(1) / i[1] + square(2) / i[2], 2 * unit),
            parameter,
            complement,
            rate: scaled(delta * ca / (i[a] * i[c]) * amp_a * amp_c / amp_b, unit),
            start,
            half_turned,
            separation: scaled(separation, 2 * (n + unit)),
            unit,
            asymptotic,
        })
    }

    /// The phase of the start in [−K, K], from the pair (sn, cn): an angle would lose digits near the separatrix.
    pub(super) fn phase(&self) -> S {
        let (sn, cn) = self.start;
        self.asymptotic
            .map_or_else(|| incomplete(sn, cn, self.parameter, self.complement), |limits| limits.phase)
    }

    /// K, a quarter of the period of the elliptic functions; infinite on the separatrix.
    pub(super) fn quarter_period(&self) -> S {
        let quarter = self.asymptotic.and_then(|limits| limits.quarter);
        quarter.unwrap_or_else(|| Modulus::new(self.complement).quarter_period())
    }

    /// Whether the motion is the separatrix itself, which has no period.
    pub(super) fn is_separatrix(&self) -> bool {
        self.asymptotic.is_some_and(|limits| limits.quarter.is_none())
    }

    /// The shortest turn that takes m/G to σe_a.
    pub(super) fn swing(&self, m: Vec3<S>) -> Quat<S> {
        let along = Vec3::unit(self.axes[0]) * self.sigma;
        Quat::new(self.norm + m.dot(along), m.cross(along)).normalized()
    }
}

/// `x` 2ⁿ.
#[inline]
pub(super) fn scaled<S: Precise>(x: S, n: i32) -> S {
    if n == 0 {
        return x;
    }
    let half = n / 2;
    x * S::of(libm::scalbn(1.0, half)) * S::of(libm::scalbn(1.0, n - half))
}

/// The exponent of `x` > 0, or 0 where the powers of `x` that occur stay clear of both ends of the range.
fn exponent<S: Precise>(x: S) -> i32 {
    let x = x.magnitude();
    if (CLEAR_BELOW..CLEAR_ABOVE).contains(&x) { 0 } else { libm::ilogb(x) }
}

/// The same for the larger of |m_l| and |m_h|; 0 where both are zero.
fn lift<S: Precise>(m: Vec3<S>, [l, _, h]: [usize; 3]) -> i32 {
    let larger = m[l].magnitude().max(m[h].magnitude());
    if larger == 0.0 { 0 } else { exponent(S::of(larger)) }
}

/// `I_l I_h Δ_μ = m_h² I_l (I_h − I_μ) − m_l² I_h (I_μ − I_l)`, exactly, then rounded once; m is divided by 2ⁿ, where n
/// is 0 unless both components are far from one.
///
/// Its relative error is twice that of the period near the separatrix, where the two terms agree in all digits:
/// nothing less than the exact value will do.
pub(super) fn exact_separation(i: Vec3<Dd>, m: Vec3<Dd>) -> Dd {
    let order @ [l, mu, h] = i.ascending();
    let n = lift(m, order);
    let term = |j: usize, other: usize, higher: usize, lower: usize| {
        let m = Expansion::from(scaled(m[j], -n));
        let difference = &Expansion::from(i[higher]) - &Expansion::from(i[lower]);
        &(&(&m * &m) * &Expansion::from(i[other])) * &difference
    };
    (&term(h, l, h, mu) - &term(l, h, mu, l)).to_dd()
}

/// The same in the scalar's own arithmetic.
pub(super) fn rounded_separation<S: Precise>(i: Vec3<S>, m: Vec3<S>) -> S {
    let order @ [l, mu, h] = i.ascending();
    let n = lift(m, order);
    let (low, high) = (scaled(m[l], -n), scaled(m[h], -n));
    high * high * i[l] * (i[h] - i[mu]) - low * low * i[h] * (i[mu] - i[l])
}

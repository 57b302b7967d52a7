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

use multiversion::multiversion;

use crate::num::elliptic::{Modulus, incomplete};
use crate::num::{Dd, DdLanes, Expansion, Precise, Real, Several, Triple};
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

/// Motions that are worked out side by side: a double-double operation is a chain in which each part waits for the one before.
pub(super) const TOGETHER: usize = 16;

/// A number of each of them.
pub(super) type Lanes = DdLanes<TOGETHER>;

/// Fewer are worked out sooner one by one.
pub(super) const FEW: usize = 4;

/// What a polhode is made of, of one body or of several, before powers of two are put back and the range is looked at.
struct Shape<S> {
    sigma: S,
    delta: S,
    amplitude: [S; 3],
    moments: [S; 3],
    twice_energy: S,
    parameter: S,
    /// k'², over a power of two.
    complement: S,
    rate: S,
    start: (S, S),
    /// The size of (m_b/B, m_c/C), negative where m_c is.
    length: S,
    separation: S,
    delta_a: S,
    delta_c: S,
}

/// Component number `place` of the `axes` of each body.
#[inline(always)]
fn along<S: Several>(v: &[S; 3], axes: &[[usize; 3]], place: usize) -> S {
    let mut found = v[0];
    for (n, axes) in axes.iter().enumerate() {
        found.set(n, v[axes[place]].get(n));
    }
    found
}

impl<S: Several> Shape<S> {
    /// For moments `i`, momenta as `given` and as `m` over powers of two, and axes l, μ, h, which become a, b, c.
    #[inline(always)]
    fn of(i: &[S; 3], m: &[S; 3], given: &[S; 3], scaled_separation: S, axes: &mut [[usize; 3]]) -> Self {
        let (i_l, i_mu, i_h) = (along(i, axes, 0), along(i, axes, 1), along(i, axes, 2));
        let (m_l, m_mu, m_h) = (along(m, axes, 0), along(m, axes, 1), along(m, axes, 2));
        // sums of terms of one sign: nothing cancels
        let delta_l = m_mu * m_mu * (i_mu - i_l) / i_mu + m_h * m_h * (i_h - i_l) / i_h;
        let delta_h = -(m_l * m_l * (i_h - i_l) / i_l + m_mu * m_mu * (i_h - i_mu) / i_mu);
        let separation = scaled_separation / (i_l * i_h);
        let (mut delta_a, mut delta_c) = (delta_l, delta_h);
        let (mut upper, mut lower) = (i_mu, i_l);
        for (n, axes) in axes.iter_mut().enumerate() {
            let about_smallest = separation.get(n) <= Dd::ZERO;
            if !about_smallest {
                axes.swap(0, 2);
                delta_a.set(n, delta_h.get(n));
                delta_c.set(n, delta_l.get(n));
                upper.set(n, i_h.get(n));
                lower.set(n, i_mu.get(n));
            }
        }

        let (i_a, i_b, i_c) = (along(i, axes, 0), along(i, axes, 1), along(i, axes, 2));
        let (m_b, m_c) = (along(m, axes, 1), along(m, axes, 2));
        let (ca, ba, cb) = (i_c - i_a, i_b - i_a, i_c - i_b);
        let (given_a, given_c) = (along(given, axes, 0), along(given, axes, 2));
        let mut sigma = S::of(1.0);
        for n in 0..S::COUNT {
            sigma.set(n, if given_a.get(n) < Dd::ZERO { -Dd::ONE } else { Dd::ONE });
        }
        let mut delta = sigma;
        for (n, [a, b, _]) in axes.iter().enumerate() {
            delta.set(n, if (b + 3 - a) % 3 == 1 { sigma.get(n) } else { -sigma.get(n) });
        }
        let amp_a = (-(i_a * delta_c) / ca).sqrt();
        let amp_b = (i_b * delta_a / ba).sqrt();
        let amp_c = (i_c * delta_a / ca).sqrt();
        let denominator = delta_c * (upper - lower);
        let (x, y) = (m_b / amp_b, m_c / amp_c);
        let mut length = (x * x + y * y).sqrt();
        for n in 0..S::COUNT {
            let size = length.get(n);
            length.set(n, if given_c.get(n) < Dd::ZERO { -size } else { size });
        }
        Shape {
            sigma,
            delta,
            amplitude: [amp_a, amp_b, amp_c],
            moments: [i_a, i_b, i_c],
            twice_energy: m[0] * m[0] / i[0] + m[1] * m[1] / i[1] + m[2] * m[2] / i[2],
            parameter: -(delta_a * cb) / (delta_c * ba),
            complement: separation * (i_h - i_l) / denominator,
            rate: delta * ca / (i_a * i_c) * amp_a * amp_c / amp_b,
            start: (x / length, y / length),
            length,
            separation,
            delta_a,
            delta_c,
        }
    }

    /// That of body `n`.
    fn one(&self, n: usize) -> Shape<Dd> {
        Shape {
            sigma: self.sigma.get(n),
            delta: self.delta.get(n),
            amplitude: self.amplitude.each_ref().map(|x| x.get(n)),
            moments: self.moments.each_ref().map(|x| x.get(n)),
            twice_energy: self.twice_energy.get(n),
            parameter: self.parameter.get(n),
            complement: self.complement.get(n),
            rate: self.rate.get(n),
            start: (self.start.0.get(n), self.start.1.get(n)),
            length: self.length.get(n),
            separation: self.separation.get(n),
            delta_a: self.delta_a.get(n),
            delta_c: self.delta_c.get(n),
        }
    }
}

/// |m| of each body, and its shape by the axes l, μ, h, which become a, b, c.
#[multiversion(targets("x86_64+avx512f+avx512dq+avx512vl", "x86_64+avx2"))]
fn side_by_side(
    [i1, i2, i3, m1, m2, m3, scaled_separation]: &[Lanes; 7],
    axes: &mut [[usize; 3]; TOGETHER],
) -> (Lanes, Shape<Lanes>) {
    let (i, m) = ([*i1, *i2, *i3], [*m1, *m2, *m3]);
    let norm = (m[0] * m[0] + m[1] * m[1] + m[2] * m[2]).sqrt();
    (norm, Shape::of(&i, &m, &m, *scaled_separation, axes))
}

impl Polhode<Dd> {
    /// |m| of the momentum `m`, and its polhode in a body with the moments `i`.
    pub(super) fn of_momentum(i: Vec3<Dd>, m: Vec3<Dd>) -> (Dd, Option<Self>) {
        let norm = m.norm();
        let polhode = if norm == Dd::ZERO { None } else { Self::of(i, m, norm, exact_separation(i, m)) };
        (norm, polhode)
    }

    /// The same for the moments and the momentum of each of `bodies`, with the bits that it has alone.
    pub(super) fn of_each(bodies: &[(Vec3<Dd>, Vec3<Dd>)]) -> Vec<(Dd, Option<Self>)> {
        let mut all = Vec::with_capacity(bodies.len());
        for group in bodies.chunks(TOGETHER) {
            if group.len() < FEW {
                all.extend(group.iter().map(|&(i, m)| Self::of_momentum(i, m)));
                continue;
            }
            let numbers = Lanes::gathered(group.iter().map(|&(i, m)| {
                let ([i1, i2, i3], [m1, m2, m3]) = (i.0, m.0);
                [i1, i2, i3, m1, m2, m3, exact_separation(i, m)]
            }));
            let mut orders = [[0, 1, 2]; TOGETHER];
            orders.iter_mut().zip(group).for_each(|(order, (i, _))| *order = i.ascending());
            let mut axes = orders;
            let (norms, shapes) = side_by_side(&numbers, &mut axes);
            for (n, &(i, m)) in group.iter().enumerate() {
                let norm = norms.get(n);
                let is_usual = norm != Dd::ZERO && exponent(norm) == 0 && lift(m, orders[n]) == 0;
                all.push(if is_usual {
                    (norm, Self::of_shape::<false>(&shapes.one(n), axes[n], m, m, norm, [0, 0]))
                } else {
                    Self::of_momentum(i, m)
                });
            }
        }
        all
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
        order: [usize; 3],
        powers @ [unit, _]: [i32; 2],
    ) -> Option<Self> {
        let m = if SCALED { Vec3(given.0.map(|m| scaled(m, -unit))) } else { given };
        let mut axes = [order];
        let shape = Shape::of(&i.0, &m.0, &given.0, scaled_separation, &mut axes);
        Self::of_shape::<SCALED>(&shape, axes[0], m, given, norm, powers)
    }

    /// That of `shape`, where the momentum `m` is that `given` over 2^unit.
    fn of_shape<const SCALED: bool>(
        shape: &Shape<S>,
        axes: [usize; 3],
        m: Vec3<S>,
        given: Vec3<S>,
        norm: S,
        [unit, n]: [i32; 2],
    ) -> Option<Self> {
        let zero = S::of(0.0);
        let scaled = |x: S, n: i32| if SCALED { scaled(x, n) } else { x };
        let ([a, _, c], [i_a, i_b, i_c], [_, _, amp_c]) = (axes, shape.moments, shape.amplitude);
        let (delta_a, delta_c, start) = (shape.delta_a, shape.delta_c, shape.start);
        if delta_a == zero || delta_c == zero || (given[a] == zero && given[c] == zero) {
            return None;
        }
        if i_c - i_b == zero && m[a].magnitude() < SYMMETRIC {
            return None;
        }
        // of so small a circle about the axis a the radii are no doubles
        if (i_b * delta_a).magnitude().min((i_c * delta_a).magnitude()) < f64::MIN_POSITIVE {
            return None;
        }
        let complement = scaled(shape.complement, 2 * n);
        let asymptotic = if complement.magnitude() >= NEGLIGIBLE {
            None
        } else if start.1.magnitude() < SMALL {
            let cn = scaled(given[c], -(n + unit)) / (amp_c * shape.length);
            Some(Asymptotic::of(shape.complement, start.0, cn, n))
        } else {
            Some(Asymptotic::usual(start, shape.parameter, complement))
        };
        Some(Polhode {
            axes,
            about_smallest: shape.separation <= zero,
            sigma: shape.sigma,
            delta: shape.delta,
            amplitude: shape.amplitude.map(|amplitude| scaled(amplitude, unit)),
            moments: [i_a, i_b, i_c],
            norm,
            twice_energy: scaled(shape.twice_energy, 2 * unit),
            parameter: shape.parameter,
            complement,
            rate: scaled(shape.rate, unit),
            start,
            half_turned: given[c] < zero,
            separation: scaled(shape.separation, 2 * (n + unit)),
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
    let order = i.ascending();
    let n = lift(m, order);
    let m = Vec3(m.0.map(|m| scaled(m, -n)));
    quick_separation(i, m, order).unwrap_or_else(|| expanded_separation(i, m, order))
}

/// The same of a momentum near one, where 150 bits leave no doubt: everywhere but next to the separatrix, and in short numbers.
fn quick_separation(i: Vec3<Dd>, m: Vec3<Dd>, [l, mu, h]: [usize; 3]) -> Option<Dd> {
    let term = |j: usize, other: usize, higher: usize, lower: usize| {
        let [m, other, higher, lower] = [m[j], i[other], i[higher], i[lower]].map(Triple::from);
        m * m * other * (higher - lower)
    };
    let square = |k: usize| m[k].hi() * m[k].hi();
    let size = (square(h) * i[l].hi() + square(l) * i[mu].hi()) * i[h].hi();
    // three products and two differences, a quarter of this at most
    (term(h, l, h, mu) - term(l, h, mu, l)).rounded(power_of_two(-145) * size)
}

/// The same exactly.
fn expanded_separation(i: Vec3<Dd>, m: Vec3<Dd>, [l, mu, h]: [usize; 3]) -> Dd {
    let term = |j: usize, other: usize, higher: usize, lower: usize| {
        let m = Expansion::from(m[j]);
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

#[cfg(test)]
mod tests {
    use super::*;

    /// The separation is the exact one, rounded, of moments and momenta of every kind of digits and near the separatrix, and seldom
    /// takes long.
    #[test]
    fn a_quick_separation_is_the_exact_one() {
        let third = Dd::ONE / Dd::of(3.0);
        let (mut quick, mut all) = (0, 0);
        for k in 1..4000_u32 {
            let part = |ratio: f64| (f64::from(k) * ratio).fract();
            let (a, b, c) =
                (part(0.618_033_988_749_895), part(0.754_877_666_246_693), part(0.569_840_290_998_053));
            let near = libm::exp2(-f64::from(k % 30));
            let digits = if k % 2 == 0 { Dd::ONE } else { third };
            let i = Vec3([1.0, 1.0 + a * near, 1.0 + a * near + b].map(|i| Dd::of(i) * digits));
            // m_h as on the separatrix, but for a share of it
            let squared = i[2] * (i[1] - i[0]) / (i[0] * (i[2] - i[1]));
            let m_l = third * c;
            for share in [0.0, 1e-32, 1e-24, 1e-16, 1e-8, 0.3] {
                let m = Vec3([m_l, Dd::ONE, m_l * squared.sqrt() * (Dd::ONE + Dd::of(share))]);
                let order = i.ascending();
                let found = quick_separation(i, m, order);
                let exact = expanded_separation(i, m, order);
                assert_eq!(found.unwrap_or(exact), exact, "{i:?} {m:?}");
                assert_eq!(exact_separation(i, m), exact);
                if share == 0.3 {
                    (quick, all) = (quick + u32::from(found.is_some()), all + 1);
                }
            }
        }
        assert!(100 * quick > 98 * all, "{quick} of {all}");
    }
}

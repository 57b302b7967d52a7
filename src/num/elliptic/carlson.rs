//! Carlson's symmetric integrals.
//!
//! The duplication theorem brings the arguments together, a quarter of the distance at each step, until a series
//! in their elementary symmetric functions serves. With terms up to degree seven the error is of the eighth order,
//! so arguments within ε^⅛ of their mean give full precision ε: four steps in `f64`, seven in `Dd`.
//!
//! The integrals end for every argument: with a negative or undefined one the result is NaN, with an infinite one it is
//! the limit 0.
//!
//! Sources: B. C. Carlson, Numerical computation of real or complex elliptic integrals, Numer. Algorithms 10
//! (1995) 13–26; the series to degree seven from NIST DLMF §19.36(i).

use crate::num::{Dd, Doubled, Precise, Real, Several};

/// Largest relative distance from the mean at which the series serve.
#[inline(always)]
fn tolerance<S: Real>() -> f64 {
    0.5 * S::ROUNDOFF.sqrt().sqrt().sqrt()
}

/// Whether all arguments lie within the tolerance of their mean (or are undefined, which ends the loop too).
fn together<S: Precise, const N: usize>(mean: f64, arguments: [S; N]) -> bool {
    let limit = tolerance::<S>() * mean;
    !arguments.iter().any(|x| (mean - x.to_f64()).abs() > limit)
}

/// 2⁻²³⁰: p so far beyond the other arguments leaves two terms of the series of R_J (NIST DLMF 19.27.11).
const FAR: f64 = 5.795_634_610_449_096e-70;

/// Whether no argument is negative, undefined, or so large that sums and products of roots might leave the range.
#[inline]
fn ordinary<S: Precise, const N: usize>(arguments: [S; N]) -> bool {
    let (mut lowest, mut sum) = (0.0_f64, 0.0);
    for argument in arguments.map(S::to_f64) {
        lowest = lowest.min(argument);
        sum += argument;
    }
    lowest == 0.0 && (1e-150..1e150).contains(&sum)
}

/// The value at arguments that are no ordinary ones, of which `zeros` make the integral diverge.
fn extreme<S: Precise, const N: usize>(arguments: [S; N], zeros: bool) -> Option<S> {
    let mut largest = 0.0_f64;
    for argument in arguments.map(S::to_f64) {
        if argument.is_nan() || argument < 0.0 {
            return Some(S::of(f64::NAN));
        }
        largest = largest.max(argument);
    }
    match (zeros, largest.is_infinite()) {
        (true, _) => Some(S::of(f64::INFINITY)),
        (false, true) => Some(S::of(0.0)),
        (false, false) => None,
    }
}

/// `x` 2ⁿ.
fn scaled<S: Precise>(x: S, n: i32) -> S {
    S::from_dd(x.to_dd().scaled(n))
}

/// Half the exponent of the power of four that takes the largest of `arguments` clear of the ends of the range, where
/// sums overflow and subnormal numbers never meet: R(4ⁿ x) = 2⁻ⁿ R(x), for R_D and R_J 8⁻ⁿ R(x).
fn lift<S: Precise, const N: usize>(arguments: [S; N], range: core::ops::Range<i32>) -> Option<i32> {
    let largest = arguments.iter().fold(0.0_f64, |largest, argument| largest.max(argument.to_f64()));
    match libm::ilogb(largest) {
        n if n < range.start => Some(range.end.min(600) / 2),
        n if n >= range.end => Some((range.end - 2 - n) / 2),
        _ => None,
    }
}

/// Exponents of arguments of which sums and products of two roots are formed.
const SUMS: core::ops::Range<i32> = -900..1020;
/// The same for products of three roots.
const PRODUCTS: core::ops::Range<i32> = -600..600;

/// (denominator + Σ coefficientₖ termₖ) / (denominator · scale).
#[inline(always)]
fn series<S: Real, const N: usize>(denominator: f64, terms: [(f64, S); N], scale: S) -> S {
    let mut sum = S::of(0.0);
    for (coefficient, term) in terms.into_iter().rev() {
        sum = sum + S::of(coefficient) * term;
    }
    (S::of(denominator) + sum) / (S::of(denominator) * scale)
}

/// How many of `arguments` are zero.
fn zeros<S: Precise>(arguments: [S; 3]) -> usize {
    arguments.iter().filter(|&&argument| argument == S::of(0.0)).count()
}

/// R_F(x, y, z) = ½ ∫₀^∞ dt / √((t+x)(t+y)(t+z)) for x, y, z ≥ 0; infinite when two of them are zero.
///
/// ```
/// use polhode::num::elliptic::r_f;
/// assert!((r_f(0.0, 1.0, 1.0) - core::f64::consts::FRAC_PI_2).abs() < 1e-14);
/// ```
pub fn r_f<S: Precise>(x: S, y: S, z: S) -> S {
    let diverges = zeros([x, y, z]) > 1;
    if diverges || !ordinary([x, y, z]) {
        if let Some(value) = extreme([x, y, z], diverges) {
            return value;
        }
        if let Some(n) = lift([x, y, z], SUMS) {
            let [x, y, z] = [x, y, z].map(|argument| scaled(argument, 2 * n));
            return scaled(r_f(x, y, z), n);
        }
    }
    let [value] = duplicated([[x, y, z]]);
    value
}

/// R_F of each of `arguments`: no step for one of them waits for those for another.
#[inline(always)]
pub(crate) fn each_r_f<S: Doubled, const N: usize>(arguments: [[S; 3]; N]) -> [S; N] {
    let mut usual = arguments;
    for (usual, [x, y, z]) in usual.iter_mut().zip(&arguments) {
        for n in 0..S::COUNT {
            if !is_usual([x.get(n), y.get(n), z.get(n)]) {
                for argument in &mut *usual {
                    argument.set(n, Dd::ONE);
                }
            }
        }
    }
    let mut values = duplicated(usual);
    for (value, [x, y, z]) in values.iter_mut().zip(&arguments) {
        for n in 0..S::COUNT {
            let [x, y, z] = [x.get(n), y.get(n), z.get(n)];
            if !is_usual([x, y, z]) {
                value.set(n, r_f(x, y, z));
            }
        }
    }
    values
}

/// Whether these are [`duplicated`] as they are.
#[inline(always)]
fn is_usual(arguments: [Dd; 3]) -> bool {
    zeros(arguments) <= 1 && ordinary(arguments)
}

/// Whether a triple is not [`together`] yet.
#[inline(always)]
fn is_apart<S: Several>([x, y, z]: &[S; 3], n: usize) -> bool {
    let (x, y, z) = (x.get(n).hi(), y.get(n).hi(), z.get(n).hi());
    let mean = (x + y + z) / 3.0;
    let limit = tolerance::<S>() * mean;
    ((mean - x).abs() > limit) | ((mean - y).abs() > limit) | ((mean - z).abs() > limit)
}

/// R_F of each of the triples.
#[inline(always)]
fn duplicated<S: Several, const N: usize>(mut triples: [[S; 3]; N]) -> [S; N] {
    let mut goes_on = true;
    while goes_on {
        goes_on = false;
        for triple in &mut triples {
            let mut apart = false;
            for n in 0..S::COUNT {
                apart |= is_apart(triple, n);
            }
            if !apart {
                continue;
            }
            goes_on = true;
            let [x, y, z] = *triple;
            let (a, b, c) = (x.sqrt(), y.sqrt(), z.sqrt());
            let shift = a * b + b * c + c * a;
            let mut nearer = [x + shift, y + shift, z + shift];
            for argument in &mut nearer {
                *argument = argument.times_power_of_two(0.25);
            }
            for n in 0..S::COUNT {
                let moves = is_apart(triple, n);
                for (argument, nearer) in triple.iter_mut().zip(&nearer) {
                    argument.set(n, if moves { nearer.get(n) } else { argument.get(n) });
                }
            }
        }
    }
    let mut values = [S::of(0.0); N];
    for (value, triple) in values.iter_mut().zip(triples) {
        *value = symmetric(triple);
    }
    values
}

/// R_F of three numbers next to each other.
#[inline(always)]
fn symmetric<S: Real>([x, y, z]: [S; 3]) -> S {
    let mean = (x + y + z) / S::of(3.0);
    let (x, y) = ((mean - x) / mean, (mean - y) / mean);
    let z = -(x + y);
    let (e2, e3) = (x * y - z * z, x * y * z);
    series(
        240_240.0,
        [
            (-24_024.0, e2),
            (17_160.0, e3),
            (10_010.0, e2 * e2),
            (-16_380.0, e2 * e3),
            (6_930.0, e3 * e3),
            (-5_775.0, e2 * e2 * e2),
            (15_015.0, e2 * e2 * e3),
        ],
        mean.sqrt(),
    )
}

/// R_C(x, y) = R_F(x, y, y) for x ≥ 0 and y > 0; infinite at y = 0.
///
/// ```
/// use polhode::num::elliptic::r_c;
/// assert!((r_c(0.0, 1.0) - core::f64::consts::FRAC_PI_2).abs() < 1e-14);
/// ```
pub fn r_c<S: Precise>(x: S, y: S) -> S {
    let diverges = y == S::of(0.0);
    if diverges || !ordinary([x, y]) {
        if let Some(value) = extreme([x, y], diverges) {
            return value;
        }
        if let Some(n) = lift([x, y], SUMS) {
            return scaled(r_c(scaled(x, 2 * n), scaled(y, 2 * n)), n);
        }
    }
    degenerate(x, y)
}

/// R_C of ordinary arguments.
fn degenerate<S: Precise>(mut x: S, mut y: S) -> S {
    while !together((x.to_f64() + 2.0 * y.to_f64()) / 3.0, [x, y]) {
        let shift = S::of(2.0) * x.sqrt() * y.sqrt() + y;
        [x, y] = [x, y].map(|argument| (argument + shift).times_power_of_two(0.25));
    }
    let mean = (x + y + y) / S::of(3.0);
    let s = (y - mean) / mean;
    let (s2, s3) = (s * s, s * s * s);
    series(
        80_080.0,
        [
            (24_024.0, s2),
            (11_440.0, s3),
            (30_030.0, s2 * s2),
            (32_760.0, s2 * s3),
            (61_215.0, s3 * s3),
            (90_090.0, s3 * s3 * s),
        ],
        mean.sqrt(),
    )
}

/// R_J(x, y, z, p) = 3/2 ∫₀^∞ dt / ((t+p) √((t+x)(t+y)(t+z))) for x, y, z, p ≥ 0; infinite when two of x, y, z or p
/// are zero, or when no double holds the value.
///
/// Every step adds a positive R_C(1, 2√p (p+λ)/d): unlike Carlson's 1 + δ/d² it does not cancel when p is small.
///
/// ```
/// use polhode::num::elliptic::r_j;
/// assert!((r_j(4.0, 4.0, 4.0, 4.0) - 0.125).abs() < 1e-15); // of equal arguments x^(−3/2)
/// ```
pub fn r_j<S: Precise>(mut x: S, mut y: S, mut z: S, mut p: S) -> S {
    let zero = S::of(0.0);
    let diverges = p == zero || zeros([x, y, z]) > 1;
    // duplication would take a step for each factor of four between p and the others
    let is_far = x.to_f64() + y.to_f64() + z.to_f64() < FAR * p.to_f64();
    if diverges || is_far || !ordinary([x, y, z, p]) {
        if let Some(value) = extreme([x, y, z, p], diverges) {
            return value;
        }
        if let Some(n) = lift([x, y, z, p], if is_far { SUMS } else { PRODUCTS }) {
            let [x, y, z, p] = [x, y, z, p].map(|argument| scaled(argument, 2 * n));
            return scaled(r_j(x, y, z, p), 3 * n);
        }
        if is_far {
            let second = S::from_dd(Dd::FRAC_PI_2) / p.sqrt();
            return S::of(3.0) / p * (r_f(x, y, z) - second);
        }
    }
    let (mut sum, mut scale) = (zero, S::of(1.0));
    while !together((x.to_f64() + y.to_f64() + z.to_f64() + 2.0 * p.to_f64()) / 5.0, [x, y, z, p]) {
        let (a, b, c, r) = (x.sqrt(), y.sqrt(), z.sqrt(), p.sqrt());
        let shift = a * b + b * c + c * a;
        let d = (r + a) * (r + b) * (r + c);
        let ratio = S::of(2.0) * r * (p + shift) / d; // from 0 to 2
        if ratio.to_f64().is_nan() || ratio == zero {
            return S::of(f64::INFINITY);
        }
        sum = sum + scale / d * degenerate(S::of(1.0), ratio);
        scale = scale.times_power_of_two(0.25);
        [x, y, z, p] = [x, y, z, p].map(|argument| (argument + shift).times_power_of_two(0.25));
    }
    let mean = (x + y + z + p + p) / S::of(5.0);
    S::of(6.0) * sum + scale * third_kind(mean, x, y, z)
}

/// R_D(x, y, z) = R_J(x, y, z, z) for x, y, z ≥ 0; infinite when z or both of x and y are zero, or when no double holds
/// the value.
///
/// ```
/// use polhode::num::elliptic::r_d;
/// assert!((r_d(4.0, 4.0, 4.0) - 0.125).abs() < 1e-15); // of equal arguments x^(−3/2)
/// ```
pub fn r_d<S: Precise>(mut x: S, mut y: S, mut z: S) -> S {
    let zero = S::of(0.0);
    let diverges = z == zero || (x == zero && y == zero);
    if diverges || !ordinary([x, y, z]) {
        if let Some(value) = extreme([x, y, z], diverges) {
            return value;
        }
        if let Some(n) = lift([x, y, z], PRODUCTS) {
            let [x, y, z] = [x, y, z].map(|argument| scaled(argument, 2 * n));
            return scaled(r_d(x, y, z), 3 * n);
        }
    }
    let (mut sum, mut scale) = (zero, S::of(1.0));
    while !together((x.to_f64() + y.to_f64() + 3.0 * z.to_f64()) / 5.0, [x, y, z]) {
        let (a, b, c) = (x.sqrt(), y.sqrt(), z.sqrt());
        let shift = a * b + b * c + c * a;
        sum = sum + scale / (c * (z + shift));
        scale = scale.times_power_of_two(0.25);
        [x, y, z] = [x, y, z].map(|argument| (argument + shift).times_power_of_two(0.25));
    }
    let mean = (x + y + z + z + z) / S::of(5.0);
    S::of(3.0) * sum + scale * third_kind(mean, x, y, z)
}

/// R_J(x, y, z, p) for arguments near their mean (x + y + z + 2p)/5.
fn third_kind<S: Precise>(mean: S, x: S, y: S, z: S) -> S {
    let [x, y, z] = [x, y, z].map(|argument| (mean - argument) / mean);
    let p = (x + y + z) * S::of(-0.5);
    let (product, p2) = (x * y * z, p * p);
    let e2 = x * y + (x + y) * z - S::of(3.0) * p2;
    let e3 = product + S::of(2.0) * p * (e2 + S::of(2.0) * p2);
    let e4 = (S::of(2.0) * product + p * (e2 + S::of(3.0) * p2)) * p;
    let e5 = product * p2;
    series(
        4_084_080.0,
        [
            (-875_160.0, e2),
            (680_680.0, e3),
            (417_690.0, e2 * e2),
            (-556_920.0, e4),
            (-706_860.0, e2 * e3),
            (471_240.0, e5),
            (-255_255.0, e2 * e2 * e2),
            (306_306.0, e3 * e3),
            (612_612.0, e2 * e4),
            (675_675.0, e2 * e2 * e3),
            (-540_540.0, e3 * e4 + e2 * e5),
        ],
        mean * mean.sqrt(),
    )
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::num::DdLanes;

    /// Side by side every integral has the bits that it has alone, ordinary or not.
    #[test]
    fn each_r_f_has_the_bits_of_one_alone() {
        let numbers = [0.0, 1e-300, 1e-12, 0.037, 0.3, 1.0, 7.0, 1e200];
        for (n, &x) in numbers.iter().enumerate() {
            for (k, &y) in numbers.iter().enumerate() {
                let other = numbers[(3 * n + 5 * k) % numbers.len()];
                let triples =
                    [[x, y, 1.0], [y, other, 0.6]].map(|triple| triple.map(|x| Dd::of(x) / Dd::of(3.0)));
                let alone = triples.map(|[x, y, z]| r_f(x, y, z));
                assert_eq!(each_r_f(triples), alone, "{triples:?}");
                let mut lanes = [DdLanes::<2>::all(Dd::ONE); 3];
                for (n, triple) in triples.into_iter().enumerate() {
                    lanes.iter_mut().zip(triple).for_each(|(lanes, x)| lanes.set(n, x));
                }
                let [found] = each_r_f([lanes]);
                assert_eq!([found.get(0), found.get(1)], alone, "{triples:?}");
            }
        }
    }
}

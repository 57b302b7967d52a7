//! Carlson's symmetric integrals.
//!
//! The duplication theorem brings the arguments together, a quarter of the distance at each step, until a series
//! in their elementary symmetric functions serves. With terms up to degree seven the error is of the eighth order,
//! so arguments within ε^⅛ of their mean give full precision ε: four steps in `f64`, seven in `Dd`.
//!
//! Sources: B. C. Carlson, Numerical computation of real or complex elliptic integrals, Numer. Algorithms 10
//! (1995) 13–26; the series to degree seven from NIST DLMF §19.36(i).

use crate::num::Precise;

/// Largest relative distance from the mean at which the series serve.
fn tolerance<S: Precise>() -> f64 {
    0.5 * S::ROUNDOFF.sqrt().sqrt().sqrt()
}

/// Whether all arguments lie within the tolerance of their mean (or are undefined, which ends the loop too).
fn together<S: Precise, const N: usize>(mean: f64, arguments: [S; N]) -> bool {
    let limit = tolerance::<S>() * mean;
    !arguments.iter().any(|x| (mean - x.to_f64()).abs() > limit)
}

/// (denominator + Σ coefficientₖ termₖ) / (denominator · scale).
fn series<S: Precise, const N: usize>(denominator: f64, terms: [(f64, S); N], scale: S) -> S {
    let add = |sum: S, &(coefficient, term): &(f64, S)| sum + S::of(coefficient) * term;
    let sum = S::of(denominator) + terms.iter().rev().fold(S::of(0.0), add);
    sum / (S::of(denominator) * scale)
}

/// R_F(x, y, z) = ½ ∫₀^∞ dt / √((t+x)(t+y)(t+z)) for x, y, z ≥ 0; infinite when two of them are zero.
pub fn r_f<S: Precise>(mut x: S, mut y: S, mut z: S) -> S {
    let zero = S::of(0.0);
    if [x, y, z].iter().filter(|&&argument| argument == zero).count() > 1 {
        return S::of(f64::INFINITY);
    }
    while !together((x.to_f64() + y.to_f64() + z.to_f64()) / 3.0, [x, y, z]) {
        let (a, b, c) = (x.sqrt(), y.sqrt(), z.sqrt());
        let shift = a * b + b * c + c * a;
        [x, y, z] = [x, y, z].map(|argument| (argument + shift) * S::of(0.25));
    }
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
pub fn r_c<S: Precise>(mut x: S, mut y: S) -> S {
    if y == S::of(0.0) {
        return S::of(f64::INFINITY);
    }
    while !together((x.to_f64() + 2.0 * y.to_f64()) / 3.0, [x, y]) {
        let shift = S::of(2.0) * x.sqrt() * y.sqrt() + y;
        [x, y] = [x, y].map(|argument| (argument + shift) * S::of(0.25));
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

/// R_J(x, y, z, p) = 3/2 ∫₀^∞ dt / ((t+p) √((t+x)(t+y)(t+z))) for x, y, z ≥ 0, at most one of them zero, and
/// p > 0; otherwise infinite.
///
/// Every step adds a positive R_C(1, 2√p (p+λ)/d): unlike Carlson's 1 + δ/d² it does not cancel when p is small.
pub fn r_j<S: Precise>(mut x: S, mut y: S, mut z: S, mut p: S) -> S {
    let zero = S::of(0.0);
    if p == zero || [x, y, z].iter().filter(|&&argument| argument == zero).count() > 1 {
        return S::of(f64::INFINITY);
    }
    let (mut sum, mut scale) = (zero, S::of(1.0));
    while !together((x.to_f64() + y.to_f64() + z.to_f64() + 2.0 * p.to_f64()) / 5.0, [x, y, z, p]) {
        let (a, b, c, r) = (x.sqrt(), y.sqrt(), z.sqrt(), p.sqrt());
        let shift = a * b + b * c + c * a;
        let d = (r + a) * (r + b) * (r + c);
        sum = sum + scale / d * r_c(S::of(1.0), S::of(2.0) * r * (p + shift) / d);
        scale = scale * S::of(0.25);
        [x, y, z, p] = [x, y, z, p].map(|argument| (argument + shift) * S::of(0.25));
    }
    let mean = (x + y + z + p + p) / S::of(5.0);
    S::of(6.0) * sum + scale * third_kind(mean, x, y, z)
}

/// R_D(x, y, z) = R_J(x, y, z, z) for x, y ≥ 0, at most one of them zero, and z > 0; otherwise infinite.
pub fn r_d<S: Precise>(mut x: S, mut y: S, mut z: S) -> S {
    let zero = S::of(0.0);
    if z == zero || (x == zero && y == zero) {
        return S::of(f64::INFINITY);
    }
    let (mut sum, mut scale) = (zero, S::of(1.0));
    while !together((x.to_f64() + y.to_f64() + 3.0 * z.to_f64()) / 5.0, [x, y, z]) {
        let (a, b, c) = (x.sqrt(), y.sqrt(), z.sqrt());
        let shift = a * b + b * c + c * a;
        sum = sum + scale / (c * (z + shift));
        scale = scale * S::of(0.25);
        [x, y, z] = [x, y, z].map(|argument| (argument + shift) * S::of(0.25));
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

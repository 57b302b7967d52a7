//! Sine and cosine in `f64`, the same bits on every CPU.
//!
//! Up to π/4 a polynomial alone, without a branch: the turns of a splitting step are mostly smaller. Up to 2²⁰
//! n π/2 is subtracted first in four parts (W. J. Cody, W. Waite, Software manual for the elementary functions,
//! 1980), so that the rest is right also beside the zeros; above, `libm` does it.
//!
//! What is generic here has the digits of `f64` in every scalar: a benchmark counts on a scalar of its own which operations of `f64` wait
//! for each other.
#![doc = include_str!("accuracy/trig.md")]

use core::f64::consts::{FRAC_2_PI, FRAC_PI_4};

use super::Real;
use super::error_free::two_sum;

// Interpolation on [0, (π/4)²] of (sin x − x)/x³ and (cos x − 1 + x²/2)/x⁴ in powers of x², made by
// tests/data/num/kernel.py; the errors left in sin x / x and cos x are below 2⁻⁵⁸.
const SIN: [f64; 6] = [
    -0.16666666666666632,
    0.008333333333322477,
    -0.00019841269829845172,
    2.7557313702348947e-06,
    -2.5050759512060143e-08,
    1.5896867846885788e-10,
];
const COS: [f64; 6] = [
    0.041666666666666644,
    -0.0013888888888881842,
    2.4801587294298722e-05,
    -2.755731573291332e-07,
    2.087590866902402e-09,
    -1.1369106022672304e-11,
];

/// π/2 = Σ parts, the first three of 33 bits: times an integer below 2²⁰ they are exact.
const HALF_PI: [f64; 4] =
    [1.5707963267341256, 6.077100506303966e-11, 2.0222662487111665e-21, 8.4784276603689e-32];

/// Adding and subtracting it rounds to an integer, whose last bits stand last in the sum.
const ROUNDER: f64 = 6_755_399_441_055_744.0; // 1.5 · 2⁵²

/// Sine and cosine of `x` radians; NaN unless `x` is finite. The sine of −0 is +0.
///
/// ```
/// use polhode::num::trig::sin_cos;
/// let (sin, cos) = sin_cos(core::f64::consts::FRAC_PI_6);
/// assert!((sin - 0.5).abs() < 1e-15 && (sin * sin + cos * cos - 1.0).abs() < 1e-15);
/// ```
#[inline]
#[must_use]
pub fn sin_cos(x: f64) -> (f64, f64) {
    if x.abs() <= FRAC_PI_4 { sin_cos_moderate(x) } else { reduced(x) }
}

/// Sine and cosine of `x` radians, |x| ≤ π/4: as [`sin_cos`], without a branch.
#[doc(hidden)]
#[inline(always)]
#[must_use]
pub fn sin_cos_moderate<S: Real>(x: S) -> (S, S) {
    kernel::<false, S>(x, S::of(0.0))
}

/// `sin x` and `1 − cos x` of `x` radians; NaN unless `x` is finite. The second is without cancellation up to |x| = π/4; next to a
/// whole turn it has the absolute error of `1 − cos x`.
///
/// ```
/// use polhode::num::trig::sin_versine;
/// let (_, versine) = sin_versine(1e-9); // ½ x², where 1 − cos x rounds to 0
/// assert!((versine / 5e-19 - 1.0).abs() < 1e-15);
/// ```
#[inline]
#[must_use]
pub fn sin_versine(x: f64) -> (f64, f64) {
    if x.abs() <= FRAC_PI_4 {
        return sin_versine_moderate(x);
    }
    let (s, c) = reduced(x);
    (s, 1.0 - c)
}

/// The same of |x| ≤ π/4, without a branch.
#[doc(hidden)]
#[inline(always)]
#[must_use]
pub fn sin_versine_moderate<S: Real>(x: S) -> (S, S) {
    let z = x * x;
    let z2 = z * z;
    (x + x * z * polynomial(z, z2, SIN), S::of(0.5) * z - z2 * polynomial(z, z2, COS))
}

/// The largest angle of [`sin_versine_small`], rad.
pub const SMALL: f64 = 0.03125;

/// `sin x` and `1 − cos x` of `x` radians, |x| ≤ [`SMALL`]: Taylor polynomials, whose errors in sin x / x and cos x are below
/// 2⁻⁵⁸.
#[inline(always)]
#[must_use]
pub fn sin_versine_small<S: Real>(x: S) -> (S, S) {
    let z = x * x;
    (x + x * z * sine_small(z), S::of(0.5) * z - z * z * cosine_small(z))
}

/// `sin x / x` and `cos x` of the angle x with the square `z`, x ≤ [`SMALL`], by the same polynomials.
#[doc(hidden)]
#[inline(always)]
#[must_use]
pub fn sinc_cos_small<S: Real>(z: S) -> (S, S) {
    (S::of(1.0) + z * sine_small(z), cos_small(z))
}

/// `(sin x / x − 1)/z`, z = x².
#[inline(always)]
fn sine_small<S: Real>(z: S) -> S {
    (z * S::of(1.0 / 120.0) - S::of(1.0 / 6.0)) - z * z * S::of(1.0 / 5040.0)
}

#[inline(always)]
fn cos_small<S: Real>(z: S) -> S {
    let (half, one) = (S::of(0.5) * z, S::of(1.0));
    let c = one - half;
    c + ((one - c) - half + z * z * cosine_small(z))
}

/// `(cos x − 1 + z/2)/z²`, z = x².
#[inline(always)]
fn cosine_small<S: Real>(z: S) -> S {
    (S::of(1.0 / 24.0) - z * S::of(1.0 / 720.0)) + z * z * S::of(1.0 / 40320.0)
}

#[inline(never)]
fn reduced(x: f64) -> (f64, f64) {
    if x.is_nan() || x.abs() >= 1_048_576.0 {
        return libm::sincos(x);
    }
    let shifted = x * FRAC_2_PI + ROUNDER;
    let n = shifted - ROUNDER;
    let (r, e1) = two_sum(x - n * HALF_PI[0], -n * HALF_PI[1]);
    let (r, e2) = two_sum(r, -n * HALF_PI[2]);
    let (s, c) = kernel::<true, _>(r, (e1 + e2) - n * HALF_PI[3]);
    match shifted.to_bits() & 3 {
        0 => (s, c),
        1 => (c, -s),
        2 => (-s, -c),
        _ => (-c, s),
    }
}

/// Sine and cosine of x + tail for |x| ≤ π/4, the tail no more than a few units in its last place.
#[inline(always)]
fn kernel<const TAIL: bool, S: Real>(x: S, tail: S) -> (S, S) {
    let z = x * x;
    let z2 = z * z;
    let mut s = x * z * polynomial(z, z2, SIN);
    let (half, one) = (S::of(0.5) * z, S::of(1.0));
    let c = one - half;
    let mut rest = ((one - c) - half) + z2 * polynomial(z, z2, COS);
    if TAIL {
        s = s + tail * c;
        rest = rest - tail * x;
    }
    (x + s, c + rest)
}

/// Estrin's scheme: a short chain of dependent operations.
#[inline(always)]
fn polynomial<S: Real>(z: S, z2: S, c: [f64; 6]) -> S {
    let [c0, c1, c2, c3, c4, c5] =
        [S::of(c[0]), S::of(c[1]), S::of(c[2]), S::of(c[3]), S::of(c[4]), S::of(c[5])];
    (c0 + z * c1) + z2 * ((c2 + z * c3) + z2 * (c4 + z * c5))
}

/// Sine and cosine of 2π (x + low), |x| ≤ ½, |low| ≤ 2⁻¹⁰: only x is reduced.
///
/// Quarter turns are taken off exactly, so a phase counted in turns meets no rounded π before it is small.
///
/// ```
/// use polhode::num::trig::sin_cos_turns;
/// assert_eq!(sin_cos_turns(0.25, 0.0), (1.0, 0.0));
/// ```
#[inline(always)]
#[must_use]
pub fn sin_cos_turns(x: f64, low: f64) -> (f64, f64) {
    let shifted = 4.0 * x + ROUNDER;
    let rest = (x - 0.25 * (shifted - ROUNDER)) + low;
    let (s, c) = sin_cos_moderate(rest * core::f64::consts::TAU);
    let quadrant = shifted.to_bits() & 3;
    // without branches: the quadrant of a random phase cannot be predicted
    let odd = quadrant & 1 == 1;
    let (s, c) = if odd { (c, s) } else { (s, c) };
    let signed = |x: f64, negative: u64| f64::from_bits(x.to_bits() ^ (negative << 63));
    (signed(s, quadrant >> 1), signed(c, (quadrant ^ (quadrant >> 1)) & 1))
}

/// The integer nearest to `x`, |x| < 2⁵¹; ties to even.
#[inline(always)]
pub(crate) fn nearest(x: f64) -> f64 {
    (x + ROUNDER) - ROUNDER
}

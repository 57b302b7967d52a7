//! Sine, cosine, arctangent, exponential and logarithm of double-double numbers.
//!
//! Each follows one plan: reduce the argument exactly, sum a Taylor polynomial whose last terms need only
//! `f64`, or start from the `f64` function and correct it once through its inverse.

use super::{Dd, Doubled};
use crate::num::Expansion;
use crate::num::error_free::two_prod;

/// Coefficients that matter: 0.79ⁿ/n! drops below 2⁻¹⁰⁷ at n = 28.
const DEGREE: usize = 29;

/// From this degree on a term of the series is so small beside the first that an `f64` carries it.
const LIGHT: usize = 17;

/// 1/n!; every factorial up to 29! is exact in 106 bits.
pub(crate) const INVERSE_FACTORIAL: [Dd; DEGREE + 1] = {
    let mut table = [Dd::ONE; DEGREE + 1];
    let mut factorial = Dd::ONE;
    let mut n = 1;
    while n <= DEGREE {
        factorial = factorial.times_f64(n as f64);
        table[n] = Dd::ONE.over(factorial);
        n += 1;
    }
    table
};

/// π/2 in 318 bits.
const HALF_PI: [f64; 6] = [
    core::f64::consts::FRAC_PI_2,
    6.123233995736766e-17,
    -1.4973849048591698e-33,
    5.562271104316826e-50,
    2.836115989820158e-66,
    8.724931080676243e-84,
];

/// 2¹⁰⁰: up to here the number of quarter turns is an exact `Dd`.
const FAR: f64 = (1u128 << 100) as f64;

/// ln 2 beyond [`Dd::LN_2`].
const LN_2_TAIL: f64 = 5.707708438416212e-34;

/// Σ xᵏ/(FIRST + k STRIDE)!, k = 0, 1, …, up to [`DEGREE`].
#[inline(always)]
fn series<S: Doubled, const FIRST: usize, const STRIDE: usize>(x: S) -> S {
    let mut n = FIRST + (DEGREE - FIRST) / STRIDE * STRIDE;
    let mut sum = S::of(0.0);
    while n >= LIGHT {
        for k in 0..S::COUNT {
            sum.set(k, Dd::exact(INVERSE_FACTORIAL[n].hi + x.get(k).hi * sum.get(k).hi));
        }
        n -= STRIDE;
    }
    while n >= FIRST {
        let product = x * sum;
        for k in 0..S::COUNT {
            sum.set(k, INVERSE_FACTORIAL[n].plus_smaller(product.get(k)));
        }
        n -= STRIDE;
    }
    sum
}

/// Sine and cosine; from [`FAR`] on, where the trailing part itself makes whole turns, to the digits of a `f64`.
pub(super) fn sin_cos(x: Dd) -> (Dd, Dd) {
    if is_near(x) {
        return sin_cos_near(x);
    }
    let (sin, cos) = libm::sincos(x.hi);
    let (s, c) = if x.lo == 0.0 { (Dd::exact(0.0), Dd::ONE) } else { sin_cos(Dd::exact(x.lo)) };
    (s * cos + c * sin, c * cos - s * sin)
}

/// Whether the angle `x` is below [`FAR`].
#[inline(always)]
pub(super) fn is_near(x: Dd) -> bool {
    x.hi.abs() < FAR
}

/// Sine and cosine of angles that are [near](is_near).
#[inline(always)]
pub(super) fn sin_cos_near<S: Doubled>(x: S) -> (S, S) {
    let (mut rest, mut quadrants) = (x, S::of(0.0));
    for k in 0..S::COUNT {
        let x = x.get(k);
        if x.hi.abs() > core::f64::consts::FRAC_PI_4 && is_near(x) {
            let quarters = (x / Dd::FRAC_PI_2 + 0.5).floor();
            rest.set(k, minus_half_pi(x, quarters));
            quadrants.set(k, Dd::exact(quarters.rem_euclid(4.0)));
        }
    }
    let (mut sin, mut cos) = sin_cos_kernel(rest);
    for k in 0..S::COUNT {
        let (s, c) = (sin.get(k), cos.get(k));
        let (s, c) = match quadrants.get(k).hi {
            0.0 => (s, c),
            1.0 => (c, -s),
            2.0 => (-s, -c),
            _ => (-c, s),
        };
        sin.set(k, s);
        cos.set(k, c);
    }
    (sin, cos)
}

/// x − n π/2. Next to a zero, where it may be 10³² times smaller than x, the difference is formed exactly.
fn minus_half_pi(x: Dd, n: Dd) -> Dd {
    let [first, second, third, ..] = HALF_PI;
    let rest = x - Dd::product(n.hi, first) - Dd::product(n.hi, second) - n.hi * third;
    if n.lo == 0.0 && rest.hi.abs() > 1e-12 * n.hi.abs() {
        return rest;
    }
    let words = HALF_PI.iter().flat_map(|&word| [two_prod(-n.lo, word), two_prod(-n.hi, word)]);
    let terms = words.flat_map(|(product, error)| [product, error]).filter(|&term| term != 0.0);
    Expansion::sum([x.hi, x.lo].into_iter().chain(terms)).to_dd()
}

#[inline(always)]
fn sin_cos_kernel<S: Doubled>(x: S) -> (S, S) {
    let minus_square = -(x * x);
    let mut sin = x + x * minus_square * series::<S, 3, 2>(minus_square);
    let mut cos = minus_square * series::<S, 2, 2>(minus_square) + 1.0;
    for k in 0..S::COUNT {
        let x = x.get(k);
        let is_zero = x.hi == 0.0;
        sin.set(k, if is_zero { x } else { sin.get(k) });
        cos.set(k, if is_zero { Dd::ONE } else { cos.get(k) });
    }
    (sin, cos)
}

/// The `f64` angle, turned to the x-axis and corrected by the small angle that is left.
pub(super) fn atan2(y: Dd, x: Dd) -> Dd {
    let angle = libm::atan2(y.hi, x.hi);
    if angle.is_nan() {
        return Dd::exact(angle);
    }
    if y.hi == 0.0 || x.hi == 0.0 || y.hi.is_infinite() || x.hi.is_infinite() {
        return Dd::FRAC_PI_4 * (angle / core::f64::consts::FRAC_PI_4).round();
    }
    let exponent = libm::ilogb(y.hi.abs().max(x.hi.abs()));
    let (y, x) = (y.scaled(-exponent), x.scaled(-exponent));
    let (s, c) = sin_cos(Dd::exact(angle));
    let rest = y * c - x * s;
    Dd::sum(angle, rest.hi / (x.hi * c.hi + y.hi * s.hi))
}

pub(super) fn exp(x: Dd) -> Dd {
    exponential(x)
}

/// x = n ln 2 + r with |r| ≤ ½ ln 2, or the limit at ±∞.
#[inline(always)]
pub(super) fn exponential<S: Doubled>(x: S) -> S {
    let (mut rest, mut powers) = (x, S::of(0.0));
    for k in 0..S::COUNT {
        let x = x.get(k);
        let n = (x.hi / core::f64::consts::LN_2).round();
        rest.set(k, x - Dd::product(n, Dd::LN_2.hi) - Dd::product(n, Dd::LN_2.lo) - n * LN_2_TAIL);
        powers.set(k, Dd::exact(n));
    }
    let mut value = rest * series::<S, 1, 1>(rest) + 1.0;
    for k in 0..S::COUNT {
        let rounded = libm::exp(x.get(k).hi);
        let is_limit = rounded == 0.0 || !rounded.is_finite();
        let scaled = value.get(k).scaled(powers.get(k).hi as i32);
        value.set(k, if is_limit { Dd::exact(rounded) } else { scaled });
    }
    value
}

pub(super) fn exp_m1(x: Dd) -> Dd {
    if x.hi.abs() < 0.35 {
        return if x.hi == 0.0 { x } else { x * series::<Dd, 1, 1>(x) };
    }
    exp(x) - 1.0
}

/// ln x = n ln 2 + y + ln(m e^−y) with x = 2ⁿ m and y the `f64` logarithm of m; near 1 nothing cancels.
pub(super) fn ln(x: Dd) -> Dd {
    if !(x.hi > 0.0 && x.hi.is_finite()) {
        return Dd::exact(libm::log(x.hi));
    }
    let n = libm::ilogb(x.hi * core::f64::consts::FRAC_1_SQRT_2) + 1;
    let m = x.scaled(-n);
    let y = libm::log(m.hi);
    let rest = (m - 1.0) + m * exp_m1(Dd::exact(-y));
    let log = rest - Dd::product(rest.hi, 0.5 * rest.hi) + y;
    Dd::LN_2 * f64::from(n) + log
}

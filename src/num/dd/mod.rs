//! Double-double numbers: an unevaluated sum of two `f64`, about 106 bits.
//!
//! | operation | relative error at most |
//! |---|---|
//! | `+` `−` of two `Dd`, also when they cancel | 3 · 2⁻¹⁰⁶ |
//! | `×` | 7 · 2⁻¹⁰⁶ |
//! | `÷` | 4 · 2⁻¹⁰⁶ |
//! | `sqrt` | 25/8 · 2⁻¹⁰⁶ |
//!
//! Sources: M. Joldes, J.-M. Muller, V. Popescu, Tight and rigorous error bounds for basic building blocks of
//! double-word arithmetic, ACM Trans. Math. Softw. 44 (2017) 15res, algorithms 6 (sum), 10 (product), 4 and 7
//! (with an `f64`); V. Lefèvre, N. Louvet, J.-M. Muller, J. Picot, L. Rideau, Accurate calculation of Euclidean
//! norms using double-word arithmetic, ACM Trans. Math. Softw. 49 (2023) 1 (root). The quotient is summed from
//! three `f64` quotients; its bound follows from those of the product and the sum with an `f64`.
//!
//! The bounds hold while no trailing part under- or overflows: for arguments and results between 2⁻⁹⁶⁸ and
//! 2¹⁰²³. Below, the trailing part fades until a `Dd` is as precise as an `f64`; above, results turn to ±∞.
//! Infinite and undefined results have a zero trailing part and follow the rules of `f64`; a zero keeps its
//! sign, except that a sum that is zero is +0.
#![doc = include_str!("../accuracy/dd.md")]

mod elementary;
pub(crate) use elementary::INVERSE_FACTORIAL;
mod lanes;
pub(crate) use lanes::DdLanes;
mod scalar;
pub(crate) use scalar::Doubled;
mod text;

use core::cmp::Ordering;
use core::ops::{Add, Div, Mul, Neg, Sub};

use super::error_free::{quick_two_sum, two_prod, two_sum};

pub use text::ParseDdError;

/// A number `hi + lo` with |lo| ≤ ½ ulp(hi).
///
/// ```
/// use polhode::num::{Dd, Real};
/// let third = Dd::ONE / 3.0;
/// assert_eq!(third.to_string(), "0.33333333333333333333333333333333");
/// assert_eq!(Dd::from(2.0).sqrt().to_string(), "1.4142135623730950488016887242097");
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[must_use]
pub struct Dd {
    hi: f64,
    lo: f64,
}

impl Dd {
    /// 0.
    pub const ZERO: Dd = Dd::exact(0.0);
    /// 1.
    pub const ONE: Dd = Dd::exact(1.0);
    /// π.
    pub const PI: Dd = Dd { hi: core::f64::consts::PI, lo: 1.2246467991473532e-16 };
    /// 2π.
    pub const TAU: Dd = Dd { hi: core::f64::consts::TAU, lo: 2.4492935982947064e-16 };
    /// π/2.
    pub const FRAC_PI_2: Dd = Dd { hi: core::f64::consts::FRAC_PI_2, lo: 6.123233995736766e-17 };
    /// π/4.
    pub const FRAC_PI_4: Dd = Dd { hi: core::f64::consts::FRAC_PI_4, lo: 3.061616997868383e-17 };
    /// e.
    pub const E: Dd = Dd { hi: core::f64::consts::E, lo: 1.4456468917292502e-16 };
    /// ln 2.
    pub const LN_2: Dd = Dd { hi: core::f64::consts::LN_2, lo: 2.3190468138462996e-17 };

    const fn exact(x: f64) -> Dd {
        Dd { hi: x, lo: 0.0 }
    }

    #[inline(always)]
    const fn quick(a: f64, b: f64) -> Dd {
        let (hi, lo) = quick_two_sum(a, b);
        Dd { hi, lo }
    }

    /// The exact sum of two numbers of any size.
    #[inline]
    pub const fn sum(a: f64, b: f64) -> Dd {
        let (hi, lo) = two_sum(a, b);
        if !hi.is_finite() {
            return Dd::exact(hi);
        }
        if lo.is_finite() {
            return Dd { hi, lo };
        }
        // next to the end of the range a difference within overflows, unless the larger comes first
        if a.abs() < b.abs() { Dd::quick(b, a) } else { Dd::quick(a, b) }
    }

    /// The exact product of two `f64`.
    #[inline]
    pub const fn product(a: f64, b: f64) -> Dd {
        let (hi, lo) = two_prod(a, b);
        if ordinary(hi) { Dd { hi, lo } } else { Dd::exact(hi) }
    }

    /// The leading part, which is the nearest `f64`.
    #[inline]
    #[must_use]
    pub const fn hi(self) -> f64 {
        self.hi
    }

    /// The trailing part.
    #[inline]
    #[must_use]
    pub const fn lo(self) -> f64 {
        self.lo
    }

    /// The largest integer that is not above the number, exactly.
    pub fn floor(self) -> Dd {
        let hi = self.hi.floor();
        if hi == self.hi { Dd::quick(hi, self.lo.floor()) } else { Dd::exact(hi) }
    }

    /// The remainder in [0, `modulus`) of an integer divided by a positive integer below 2⁵³, exactly.
    #[must_use]
    pub fn rem_euclid(self, modulus: f64) -> f64 {
        (self.hi.rem_euclid(modulus) + self.lo.rem_euclid(modulus)) % modulus
    }

    /// The number times 2ⁿ, exactly unless it under- or overflows.
    pub fn scaled(self, n: i32) -> Dd {
        Dd { hi: libm::scalbn(self.hi, n), lo: libm::scalbn(self.lo, n) }
    }

    // Constant functions, so that tables of coefficients are computed and not typed.

    #[inline]
    const fn plus(self, b: Dd) -> Dd {
        let (s, e) = two_sum(self.hi, b.hi);
        if !s.is_finite() {
            return Dd::exact(s);
        }
        let (t, f) = two_sum(self.lo, b.lo);
        let (s, e) = quick_two_sum(s, e + t);
        Dd::quick(s, e + f)
    }

    /// The sum with a number smaller than half of `self`, whose error then is no larger than in `+`.
    #[inline(always)]
    const fn plus_smaller(self, b: Dd) -> Dd {
        let (s, e) = quick_two_sum(self.hi, b.hi);
        Dd::quick(s, e + (self.lo + b.lo))
    }

    #[inline]
    const fn plus_f64(self, b: f64) -> Dd {
        let (s, e) = two_sum(self.hi, b);
        if s.is_finite() { Dd::quick(s, e + self.lo) } else { Dd::exact(s) }
    }

    #[inline]
    const fn times_f64(self, b: f64) -> Dd {
        let (p, e) = two_prod(self.hi, b);
        if ordinary(p) { Dd::quick(p, e + self.lo * b) } else { Dd::exact(p) }
    }

    #[inline]
    const fn negated(self) -> Dd {
        Dd { hi: -self.hi, lo: -self.lo }
    }

    #[inline]
    const fn over(self, b: Dd) -> Dd {
        let q = self.hi / b.hi;
        if !ordinary(q) || b.hi.is_infinite() {
            return Dd::exact(q);
        }
        let r = self.plus(b.times_f64(q).negated());
        let q2 = r.hi / b.hi;
        let (p, e) = two_prod(b.hi, q2);
        let r = ((r.hi - p) - e) + (r.lo - b.lo * q2);
        Dd::quick(q, q2).plus_f64(r / b.hi)
    }
}

/// Neither zero, which would lose its sign, nor infinite or undefined, which would spoil the trailing part.
#[inline]
const fn ordinary(x: f64) -> bool {
    x.abs() > 0.0 && x.abs() < f64::INFINITY
}

impl From<f64> for Dd {
    #[inline]
    fn from(x: f64) -> Dd {
        Dd::exact(x)
    }
}
impl From<i64> for Dd {
    fn from(n: i64) -> Dd {
        let hi = n as f64;
        Dd { hi, lo: (i128::from(n) - hi as i128) as f64 }
    }
}
impl From<u64> for Dd {
    fn from(n: u64) -> Dd {
        let hi = n as f64;
        Dd { hi, lo: (i128::from(n) - hi as i128) as f64 }
    }
}

impl Neg for Dd {
    type Output = Dd;
    #[inline]
    fn neg(self) -> Dd {
        self.negated()
    }
}
impl Add for Dd {
    type Output = Dd;
    #[inline]
    fn add(self, b: Dd) -> Dd {
        self.plus(b)
    }
}
impl Sub for Dd {
    type Output = Dd;
    #[inline]
    fn sub(self, b: Dd) -> Dd {
        self.plus(b.negated())
    }
}
impl Mul for Dd {
    type Output = Dd;
    #[inline]
    fn mul(self, b: Dd) -> Dd {
        let (p, e) = two_prod(self.hi, b.hi);
        if ordinary(p) { Dd::quick(p, e + (self.hi * b.lo + self.lo * b.hi)) } else { Dd::exact(p) }
    }
}
impl Div for Dd {
    type Output = Dd;
    #[inline]
    fn div(self, b: Dd) -> Dd {
        self.over(b)
    }
}

impl Add<f64> for Dd {
    type Output = Dd;
    #[inline]
    fn add(self, b: f64) -> Dd {
        self.plus_f64(b)
    }
}
impl Sub<f64> for Dd {
    type Output = Dd;
    #[inline]
    fn sub(self, b: f64) -> Dd {
        self.plus_f64(-b)
    }
}
impl Mul<f64> for Dd {
    type Output = Dd;
    #[inline]
    fn mul(self, b: f64) -> Dd {
        self.times_f64(b)
    }
}
impl Div<f64> for Dd {
    type Output = Dd;
    #[inline]
    fn div(self, b: f64) -> Dd {
        self.over(Dd::exact(b))
    }
}

impl PartialOrd for Dd {
    #[inline]
    fn partial_cmp(&self, b: &Dd) -> Option<Ordering> {
        match self.hi.partial_cmp(&b.hi) {
            Some(Ordering::Equal) => self.lo.partial_cmp(&b.lo),
            other => other,
        }
    }
}

//! Double-double numbers: an unevaluated sum of two `f64`, about 106 bits.

use core::cmp::Ordering;
use core::ops::{Add, Div, Mul, Neg, Sub};

use super::real::{Precise, Real};

/// `a + b` as a rounded sum and its exact error (Knuth).
#[inline]
pub fn two_sum(a: f64, b: f64) -> (f64, f64) {
    let s = a + b;
    let v = s - a;
    (s, (a - (s - v)) + (b - v))
}

/// `a + b` as a rounded sum and its exact error, for |a| ≥ |b| (Dekker).
#[inline]
pub fn quick_two_sum(a: f64, b: f64) -> (f64, f64) {
    let s = a + b;
    (s, b - (s - a))
}

#[inline]
fn split(a: f64) -> (f64, f64) {
    let t = 134_217_729.0 * a; // 2^27 + 1
    let hi = t - (t - a);
    (hi, a - hi)
}

/// `a · b` as a rounded product and its exact error (Dekker's splitting: the same bits with and without FMA).
#[inline]
pub fn two_prod(a: f64, b: f64) -> (f64, f64) {
    let p = a * b;
    let (ah, al) = split(a);
    let (bh, bl) = split(b);
    (p, ((ah * bh - p) + ah * bl + al * bh) + al * bl)
}

/// A number `hi + lo` with |lo| ≤ ½ ulp(hi).
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Dd {
    hi: f64,
    lo: f64,
}

impl Dd {
    /// π.
    pub const PI: Dd = Dd { hi: core::f64::consts::PI, lo: 1.224_646_799_147_353_2e-16 };
    /// 2π.
    pub const TAU: Dd = Dd { hi: core::f64::consts::TAU, lo: 2.449_293_598_294_706_4e-16 };
    /// 0.
    pub const ZERO: Dd = Dd { hi: 0.0, lo: 0.0 };
    /// 1.
    pub const ONE: Dd = Dd { hi: 1.0, lo: 0.0 };

    /// The normalised sum of two numbers of any size.
    #[inline]
    pub fn sum(a: f64, b: f64) -> Dd {
        let (hi, lo) = two_sum(a, b);
        Dd { hi, lo }
    }
    /// The exact product of two `f64`.
    #[inline]
    pub fn product(a: f64, b: f64) -> Dd {
        let (hi, lo) = two_prod(a, b);
        Dd { hi, lo }
    }
    /// The leading part, which is the nearest `f64`.
    #[inline]
    pub fn hi(self) -> f64 {
        self.hi
    }
    /// The trailing part.
    #[inline]
    pub fn lo(self) -> f64 {
        self.lo
    }
}

impl From<f64> for Dd {
    fn from(x: f64) -> Dd {
        Dd::of(x)
    }
}
impl Add for Dd {
    type Output = Dd;
    #[inline]
    fn add(self, b: Dd) -> Dd {
        let (s, e) = two_sum(self.hi, b.hi);
        let (t, f) = two_sum(self.lo, b.lo);
        let (s, e) = quick_two_sum(s, e + t);
        let (hi, lo) = quick_two_sum(s, e + f);
        Dd { hi, lo }
    }
}
impl Neg for Dd {
    type Output = Dd;
    #[inline]
    fn neg(self) -> Dd {
        Dd { hi: -self.hi, lo: -self.lo }
    }
}
impl Sub for Dd {
    type Output = Dd;
    #[inline]
    fn sub(self, b: Dd) -> Dd {
        self + -b
    }
}
impl Mul for Dd {
    type Output = Dd;
    #[inline]
    fn mul(self, b: Dd) -> Dd {
        let (p, e) = two_prod(self.hi, b.hi);
        let (hi, lo) = quick_two_sum(p, e + (self.hi * b.lo + self.lo * b.hi));
        Dd { hi, lo }
    }
}
impl Div for Dd {
    type Output = Dd;
    #[inline]
    fn div(self, b: Dd) -> Dd {
        let q1 = self.hi / b.hi;
        if !q1.is_finite() || b.hi.is_infinite() {
            return Dd { hi: q1, lo: 0.0 };
        }
        let r = self - b * Dd::of(q1);
        let q2 = r.hi / b.hi;
        let r = r - b * Dd::of(q2);
        let q3 = r.hi / b.hi;
        let (hi, lo) = quick_two_sum(q1, q2);
        Dd { hi, lo } + Dd::of(q3)
    }
}
impl PartialOrd for Dd {
    fn partial_cmp(&self, b: &Dd) -> Option<Ordering> {
        match self.hi.partial_cmp(&b.hi) {
            Some(Ordering::Equal) => self.lo.partial_cmp(&b.lo),
            other => other,
        }
    }
}

impl Real for Dd {
    #[inline]
    fn of(x: f64) -> Dd {
        Dd { hi: x, lo: 0.0 }
    }
    fn sqrt(self) -> Dd {
        if self.hi <= 0.0 {
            return Dd::of(self.hi.sqrt());
        }
        let x = Dd::of(self.hi.sqrt());
        let x = x + (self - x * x) / (x + x);
        x + (self - x * x) / (x + x)
    }
    fn sin_cos(self) -> (Dd, Dd) {
        let quarter = (self / (Dd::PI * Dd::of(0.5))).round();
        let r = self - quarter * (Dd::PI * Dd::of(0.5));
        let x2 = r * r;
        let (mut s, mut c) = (Dd::ZERO, Dd::ZERO);
        for n in (0..16).rev() {
            let k = f64::from(2 * n);
            c = Dd::ONE - x2 * c / Dd::of((k + 1.0) * (k + 2.0));
            s = Dd::ONE - x2 * s / Dd::of((k + 2.0) * (k + 3.0));
        }
        let s = s * r;
        match (quarter.hi % 4.0 + 4.0) % 4.0 {
            0.0 => (s, c),
            1.0 => (c, -s),
            2.0 => (-s, -c),
            _ => (-c, s),
        }
    }
    fn magnitude(self) -> f64 {
        self.hi.abs()
    }
}

impl Precise for Dd {
    const ROUNDOFF: f64 = f64::EPSILON * f64::EPSILON / 4.0;
    fn from_dd(x: Dd) -> Self {
        x
    }
    fn to_dd(self) -> Dd {
        self
    }
    fn to_f64(self) -> f64 {
        self.hi
    }
    fn abs(self) -> Self {
        if self.hi < 0.0 { -self } else { self }
    }
    fn round(self) -> Self {
        let hi = self.hi.round();
        if hi == self.hi {
            let (hi, lo) = quick_two_sum(hi, self.lo.round());
            Dd { hi, lo }
        } else if (hi - self.hi).abs() == 0.5 && (hi > self.hi) == (self.lo < 0.0) && self.lo != 0.0 {
            Dd::of(if hi > self.hi { hi - 1.0 } else { hi + 1.0 })
        } else {
            Dd::of(hi)
        }
    }
    fn atan2(self, x: Self) -> Self {
        let a = Dd::of(libm::atan2(self.hi, x.hi));
        let (s, c) = a.sin_cos();
        let r = (self * self + x * x).sqrt();
        if r.hi == 0.0 || !r.hi.is_finite() {
            return a;
        }
        a + (self * c - x * s) / r
    }
    fn exp(self) -> Self {
        Dd::of(libm::exp(self.hi))
    }
    fn ln(self) -> Self {
        Dd::of(libm::log(self.hi))
    }
}

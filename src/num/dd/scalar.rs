//! Double-double numbers as scalars of kernels.

use core::ops::{Add, Mul};

use super::{Dd, elementary, ordinary};
use crate::num::error_free::two_prod;
use crate::num::{Precise, Real, Several};

/// A double-double number, or several side by side.
pub(crate) trait Doubled: Several + Add<f64, Output = Self> + Mul<f64, Output = Self> {
    /// e to the power of each.
    fn exponential(self) -> Self;
}

impl Doubled for Dd {
    fn exponential(self) -> Dd {
        elementary::exp(self)
    }
}

impl Real for Dd {
    const ROUNDOFF: f64 = f64::EPSILON * f64::EPSILON / 4.0;
    #[inline]
    fn of(x: f64) -> Dd {
        Dd::exact(x)
    }
    #[inline]
    fn from_dd(x: Dd) -> Dd {
        x
    }
    #[inline]
    fn rounded(x: Dd) -> Dd {
        x
    }
    #[inline]
    fn sqrt(self) -> Dd {
        let s = self.hi.sqrt();
        if !ordinary(s) {
            return Dd::exact(s);
        }
        let (square, error) = two_prod(s, s);
        Dd::quick(s, ((self.hi - square - error) + self.lo) / (2.0 * s))
    }
    fn sin_cos(self) -> (Dd, Dd) {
        elementary::sin_cos(self)
    }
    #[inline]
    fn times_power_of_two(self, power: f64) -> Dd {
        Dd { hi: self.hi * power, lo: self.lo * power }
    }
    #[inline]
    fn magnitude(self) -> f64 {
        self.hi.abs()
    }
}

impl Precise for Dd {
    #[inline]
    fn to_dd(self) -> Dd {
        self
    }
    #[inline]
    fn to_f64(self) -> f64 {
        self.hi
    }
    #[inline]
    fn abs(self) -> Self {
        if self.hi.is_sign_negative() { -self } else { self }
    }
    fn round(self) -> Self {
        let size = self.abs();
        let below = size.floor();
        let nearest = if size - below < Dd::exact(0.5) { below } else { below + 1.0 };
        if self.hi < 0.0 { -nearest } else { nearest }
    }
    fn atan2(self, x: Self) -> Self {
        elementary::atan2(self, x)
    }
    fn exp(self) -> Self {
        elementary::exp(self)
    }
    fn exp_m1(self) -> Self {
        elementary::exp_m1(self)
    }
    fn ln(self) -> Self {
        elementary::ln(self)
    }
}

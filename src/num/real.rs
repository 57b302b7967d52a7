//! The traits that kernels are generic over.

use core::fmt::Debug;
use core::ops::{Add, Div, Mul, Neg, Sub};

use super::{Dd, error_free, trig};

/// A scalar that explicit kernels are written over.
///
/// There is no ordering: a kernel cannot branch on a value, so one text serves `f64`, [`Dd`], power [series](super::Series)
/// and several numbers side by side. An iteration ends on [`magnitude`](Real::magnitude), the worst lane as `f64`.
pub trait Real:
    Copy
    + Debug
    + Send
    + Sync
    + 'static
    + Add<Output = Self>
    + Sub<Output = Self>
    + Mul<Output = Self>
    + Div<Output = Self>
    + Neg<Output = Self>
{
    /// Unit roundoff of one operation.
    const ROUNDOFF: f64;
    /// How often Newton's iteration has to be taken from a root that is known as a double: each time doubles the digits that
    /// are right.
    const NEWTON_STEPS: u32 = 2;
    /// The scalar nearest to `x`.
    fn of(x: f64) -> Self;
    /// The scalar nearest to `x`, rounded once where it has fewer digits.
    #[inline]
    #[must_use]
    fn from_dd(x: Dd) -> Self {
        Self::of(x.hi()) + Self::of(x.lo())
    }
    /// `value + slope · t` as a [series](super::Series) in the time t, s; of any other scalar `value`.
    #[inline]
    #[must_use]
    fn linear(value: Dd, _slope: f64) -> Self {
        Self::from_dd(value)
    }
    /// The solution of `x' = rates(x)` in the time, s, through `x` at this moment, as [series](super::Series); `None` of any other scalar.
    #[inline]
    #[must_use]
    fn solution<const N: usize>(
        _x: [Self; N],
        _rates: impl FnOnce([Self; N]) -> [Self; N],
    ) -> Option<[Self; N]> {
        None
    }
    /// `x` rounded to the digits of this scalar: a length of time that every kernel then shares.
    #[inline]
    fn rounded(x: Dd) -> Dd {
        Dd::of(x.hi())
    }
    /// Square root; NaN of a negative number.
    fn sqrt(self) -> Self;
    /// Sine and cosine of an angle in radians, the same bits on every CPU.
    fn sin_cos(self) -> (Self, Self);
    /// `sin x` and `1 − cos x` of an angle in radians; of `f64` the second without cancellation up to |x| = π/4.
    #[inline]
    fn sin_versine(self) -> (Self, Self) {
        let (s, c) = self.sin_cos();
        (s, Self::of(1.0) - c)
    }
    /// The same of an angle of at most π/4, where `f64` needs no branch.
    #[inline]
    fn sin_versine_moderate(self) -> (Self, Self) {
        self.sin_versine()
    }
    /// The same of an angle of at most [`SMALL`](trig::SMALL), where `f64` needs fewer operations.
    #[inline]
    fn sin_versine_small(self) -> (Self, Self) {
        self.sin_versine()
    }
    /// `sin x / x` and `cos x` of the angle x, rad, whose square is `self`; no root where x is at most
    /// [`SMALL`](trig::SMALL) and `f64` needs none.
    #[inline]
    fn sinc_cos_of_root(self) -> (Self, Self) {
        let x = self.sqrt();
        let (sin, cos) = x.sin_cos();
        if x.magnitude() == 0.0 { (Self::of(1.0), cos) } else { (sin / x, cos) }
    }
    /// The number times a power of two, exactly unless it under- or overflows.
    #[inline]
    #[must_use]
    fn times_power_of_two(self, power: f64) -> Self {
        self * Self::of(power)
    }
    /// |x| as `f64`; of several lanes the largest, NaN if one is NaN.
    fn magnitude(self) -> f64;
    /// `self + b` and the error of its rounding (Knuth): exact for `f64`, in any other scalar as good as its own rounding.
    #[inline]
    fn two_sum(self, b: Self) -> (Self, Self) {
        let sum = self + b;
        let added = sum - self;
        (sum, (self - (sum - added)) + (b - added))
    }
    /// `self · b` and the error of its rounding (Dekker): exact for `f64`, in any other scalar as good as its own rounding.
    #[inline]
    fn two_prod(self, b: Self) -> (Self, Self) {
        let split = |x: Self| {
            let t = x * Self::of(134_217_729.0); // 2²⁷ + 1
            let high = t - (t - x);
            (high, x - high)
        };
        let ((a1, a2), (b1, b2), p) = (split(self), split(b), self * b);
        (p, ((a1 * b1 - p) + a1 * b2 + a2 * b1) + a2 * b2)
    }
}

/// A scalar that can be compared, rounded and turned into an angle: `f64` and [`Dd`].
pub trait Precise: Real + PartialOrd {
    /// The same value, exactly.
    fn to_dd(self) -> Dd;
    /// Nearest `f64`.
    fn to_f64(self) -> f64;
    /// Absolute value.
    fn abs(self) -> Self;
    /// Nearest integer, ties away from zero.
    fn round(self) -> Self;
    /// Angle of the point (x, y) = (`x`, `self`) in (−π, π].
    fn atan2(self, x: Self) -> Self;
    /// e to the power of `self`.
    fn exp(self) -> Self;
    /// e to the power of `self`, minus one, without cancellation.
    fn exp_m1(self) -> Self;
    /// Natural logarithm; NaN of a negative number.
    fn ln(self) -> Self;
}

/// A number, or several side by side: each has the bits that it has alone.
///
/// What is done with each of them by itself stands in a loop over all: an iteration goes on until the last has ended, and those that
/// have keep what they are.
pub(crate) trait Several: Real {
    /// How many there are.
    const COUNT: usize;
    /// Number `n`.
    fn get(&self, n: usize) -> Dd;
    /// Makes `x` number `n`.
    fn set(&mut self, n: usize, x: Dd);
}

impl<S: Precise> Several for S {
    const COUNT: usize = 1;
    #[inline(always)]
    fn get(&self, _: usize) -> Dd {
        self.to_dd()
    }
    #[inline(always)]
    fn set(&mut self, _: usize, x: Dd) {
        *self = S::from_dd(x);
    }
}

impl Real for f64 {
    const ROUNDOFF: f64 = f64::EPSILON / 2.0;
    #[inline]
    fn of(x: f64) -> Self {
        x
    }
    #[inline]
    fn from_dd(x: Dd) -> Self {
        x.hi()
    }
    #[inline]
    fn sqrt(self) -> Self {
        f64::sqrt(self)
    }
    #[inline]
    fn sin_cos(self) -> (Self, Self) {
        trig::sin_cos(self)
    }
    #[inline]
    fn sin_versine(self) -> (Self, Self) {
        trig::sin_versine(self)
    }
    #[inline(always)]
    fn sin_versine_moderate(self) -> (Self, Self) {
        trig::sin_versine_moderate(self)
    }
    #[inline(always)]
    fn sin_versine_small(self) -> (Self, Self) {
        trig::sin_versine_small(self)
    }
    #[inline]
    fn sinc_cos_of_root(self) -> (Self, Self) {
        if self <= trig::SMALL * trig::SMALL {
            return trig::sinc_cos_small(self);
        }
        let x = f64::sqrt(self);
        let (sin, cos) = trig::sin_cos(x);
        (sin / x, cos)
    }
    #[inline]
    fn magnitude(self) -> f64 {
        f64::abs(self)
    }
    #[inline]
    fn two_sum(self, b: Self) -> (Self, Self) {
        error_free::two_sum(self, b)
    }
    #[inline]
    fn two_prod(self, b: Self) -> (Self, Self) {
        error_free::two_prod(self, b)
    }
}

impl Precise for f64 {
    #[inline]
    fn to_dd(self) -> Dd {
        Dd::of(self)
    }
    #[inline]
    fn to_f64(self) -> f64 {
        self
    }
    #[inline]
    fn abs(self) -> Self {
        f64::abs(self)
    }
    #[inline]
    fn round(self) -> Self {
        f64::round(self)
    }
    #[inline]
    fn atan2(self, x: Self) -> Self {
        libm::atan2(self, x)
    }
    #[inline]
    fn exp(self) -> Self {
        libm::exp(self)
    }
    #[inline]
    fn exp_m1(self) -> Self {
        libm::expm1(self)
    }
    #[inline]
    fn ln(self) -> Self {
        libm::log(self)
    }
}

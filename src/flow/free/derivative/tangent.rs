//! Numbers with their derivatives in `N` directions.

use core::array::from_fn;
use core::ops::{Add, Div, Mul, Neg, Sub};

/// A value and its derivatives: sums, products and quotients by the rules of differentiation.
#[derive(Clone, Copy, Debug)]
pub(super) struct Tangent<const N: usize> {
    pub(super) value: f64,
    pub(super) by: [f64; N],
}

impl<const N: usize> Tangent<N> {
    #[inline(always)]
    pub(super) fn new(value: f64, by: [f64; N]) -> Self {
        Tangent { value, by }
    }

    /// x².
    #[inline(always)]
    pub(super) fn square(self) -> Self {
        self * self
    }
}

impl<const N: usize> Add for Tangent<N> {
    type Output = Self;
    #[inline(always)]
    fn add(self, b: Self) -> Self {
        Tangent { value: self.value + b.value, by: from_fn(|n| self.by[n] + b.by[n]) }
    }
}
impl<const N: usize> Sub for Tangent<N> {
    type Output = Self;
    #[inline(always)]
    fn sub(self, b: Self) -> Self {
        Tangent { value: self.value - b.value, by: from_fn(|n| self.by[n] - b.by[n]) }
    }
}
impl<const N: usize> Mul for Tangent<N> {
    type Output = Self;
    #[inline(always)]
    #[allow(clippy::suspicious_arithmetic_impl)] // the rule of products has a sum
    fn mul(self, b: Self) -> Self {
        let by = from_fn(|n| self.by[n] * b.value + self.value * b.by[n]);
        Tangent { value: self.value * b.value, by }
    }
}
impl<const N: usize> Div for Tangent<N> {
    type Output = Self;
    #[inline(always)]
    fn div(self, b: Self) -> Self {
        let inverse = 1.0 / b.value;
        let value = self.value * inverse;
        Tangent { value, by: from_fn(|n| (self.by[n] - value * b.by[n]) * inverse) }
    }
}
impl<const N: usize> Neg for Tangent<N> {
    type Output = Self;
    #[inline(always)]
    fn neg(self) -> Self {
        Tangent { value: -self.value, by: self.by.map(|x| -x) }
    }
}

//! Complex numbers, as far as the Cayley–Klein parameters of a top need them.

use core::ops::{Add, Mul, Sub};

use super::Real;

/// `re + i im`.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Complex<S> {
    pub(crate) re: S,
    pub(crate) im: S,
}

impl<S: Real> Complex<S> {
    pub(crate) fn new(re: S, im: S) -> Self {
        Complex { re, im }
    }

    /// e^{iφ}.
    pub(crate) fn phase(angle: S) -> Self {
        let (sin, cos) = angle.sin_cos();
        Complex::new(cos, sin)
    }

    pub(crate) fn conjugate(self) -> Self {
        Complex::new(self.re, -self.im)
    }

    pub(crate) fn norm_squared(self) -> S {
        self.re * self.re + self.im * self.im
    }

    pub(crate) fn scaled(self, k: S) -> Self {
        Complex::new(self.re * k, self.im * k)
    }

    /// 1 / conjugate: `self / |self|²`.
    pub(crate) fn inverse_conjugate(self) -> Self {
        self.scaled(S::of(1.0) / self.norm_squared())
    }
}

impl<S: Real> Add for Complex<S> {
    type Output = Self;
    fn add(self, b: Self) -> Self {
        Complex::new(self.re + b.re, self.im + b.im)
    }
}

impl<S: Real> Sub for Complex<S> {
    type Output = Self;
    fn sub(self, b: Self) -> Self {
        Complex::new(self.re - b.re, self.im - b.im)
    }
}

impl<S: Real> Mul for Complex<S> {
    type Output = Self;
    fn mul(self, b: Self) -> Self {
        Complex::new(self.re * b.re - self.im * b.im, self.re * b.im + self.im * b.re)
    }
}

//! Double-double numbers side by side, in loops that the compiler turns into vector instructions.
//!
//! Each has the bits that it has alone. Where [`Dd`] branches, a lane works out both ways and takes one.

use core::ops::{Add, Div, Mul, Neg, Sub};

use super::{Dd, Doubled, elementary, ordinary};
use crate::num::error_free::{quick_two_sum, two_prod, two_sum};
use crate::num::{Real, Several};

/// `N` numbers.
#[derive(Clone, Copy, Debug)]
#[repr(align(64))]
pub(crate) struct DdLanes<const N: usize> {
    hi: [f64; N],
    lo: [f64; N],
}

impl<const N: usize> DdLanes<N> {
    /// `x` in every lane.
    #[inline(always)]
    pub(crate) fn all(x: Dd) -> Self {
        Self::from_dd(x)
    }

    /// Lane n is of the n-th of `all`; lanes beyond these are as the first.
    pub(crate) fn gathered<const K: usize>(all: impl IntoIterator<Item = [Dd; K]>) -> [Self; K] {
        let mut lanes = [Self::all(Dd::ZERO); K];
        for (n, numbers) in all.into_iter().enumerate() {
            for (lanes, x) in lanes.iter_mut().zip(numbers) {
                if n == 0 {
                    *lanes = Self::all(x);
                }
                lanes.set(n, x);
            }
        }
        lanes
    }

    /// Adds `a b`.
    #[inline(always)]
    pub(crate) fn add_product(&mut self, a: &Self, b: &Self) {
        for n in 0..N {
            self.set(n, plus(self.get(n), times(a.get(n), b.get(n))));
        }
    }
}

impl<const N: usize> Neg for DdLanes<N> {
    type Output = Self;
    #[inline(always)]
    fn neg(mut self) -> Self {
        for n in 0..N {
            self.set(n, -self.get(n));
        }
        self
    }
}
impl<const N: usize> Add for DdLanes<N> {
    type Output = Self;
    #[inline(always)]
    fn add(mut self, b: Self) -> Self {
        for n in 0..N {
            self.set(n, plus(self.get(n), b.get(n)));
        }
        self
    }
}
impl<const N: usize> Sub for DdLanes<N> {
    type Output = Self;
    #[inline(always)]
    fn sub(mut self, b: Self) -> Self {
        for n in 0..N {
            self.set(n, plus(self.get(n), -b.get(n)));
        }
        self
    }
}
impl<const N: usize> Mul for DdLanes<N> {
    type Output = Self;
    #[inline(always)]
    fn mul(mut self, b: Self) -> Self {
        for n in 0..N {
            self.set(n, times(self.get(n), b.get(n)));
        }
        self
    }
}

impl<const N: usize> Div for DdLanes<N> {
    type Output = Self;
    #[inline(always)]
    fn div(mut self, b: Self) -> Self {
        for n in 0..N {
            self.set(n, over(self.get(n), b.get(n)));
        }
        self
    }
}
impl<const N: usize> Add<f64> for DdLanes<N> {
    type Output = Self;
    #[inline(always)]
    fn add(mut self, b: f64) -> Self {
        for n in 0..N {
            self.set(n, plus_f64(self.get(n), b));
        }
        self
    }
}
impl<const N: usize> Mul<f64> for DdLanes<N> {
    type Output = Self;
    #[inline(always)]
    fn mul(mut self, b: f64) -> Self {
        for n in 0..N {
            self.set(n, times_f64(self.get(n), b));
        }
        self
    }
}

impl<const N: usize> Several for DdLanes<N> {
    const COUNT: usize = N;
    #[inline(always)]
    fn get(&self, n: usize) -> Dd {
        Dd { hi: self.hi[n], lo: self.lo[n] }
    }
    #[inline(always)]
    fn set(&mut self, n: usize, x: Dd) {
        (self.hi[n], self.lo[n]) = (x.hi, x.lo);
    }
}

impl<const N: usize> Real for DdLanes<N> {
    const ROUNDOFF: f64 = Dd::ROUNDOFF;
    #[inline(always)]
    fn of(x: f64) -> Self {
        DdLanes { hi: [x; N], lo: [0.0; N] }
    }
    #[inline(always)]
    fn from_dd(x: Dd) -> Self {
        DdLanes { hi: [x.hi; N], lo: [x.lo; N] }
    }
    #[inline(always)]
    fn sqrt(mut self) -> Self {
        for n in 0..N {
            self.set(n, root(self.get(n)));
        }
        self
    }
    #[inline(always)]
    fn sin_cos(self) -> (Self, Self) {
        let (mut sin, mut cos) = elementary::sin_cos_near(self);
        for n in 0..N {
            if !elementary::is_near(self.get(n)) {
                let (s, c) = elementary::sin_cos(self.get(n));
                sin.set(n, s);
                cos.set(n, c);
            }
        }
        (sin, cos)
    }
    #[inline(always)]
    fn times_power_of_two(mut self, power: f64) -> Self {
        for n in 0..N {
            (self.hi[n], self.lo[n]) = (self.hi[n] * power, self.lo[n] * power);
        }
        self
    }
    #[inline(always)]
    fn magnitude(self) -> f64 {
        let mut largest = 0.0_f64;
        for x in self.hi {
            // a NaN stays
            largest = if x.abs() <= largest || largest.is_nan() { largest } else { x.abs() };
        }
        largest
    }
}

impl<const N: usize> Doubled for DdLanes<N> {
    #[inline(always)]
    fn exponential(self) -> Self {
        elementary::exponential(self)
    }
}

/// `a + b`.
#[inline(always)]
fn plus(a: Dd, b: Dd) -> Dd {
    let (s, e) = two_sum(a.hi, b.hi);
    let (t, f) = two_sum(a.lo, b.lo);
    let (r, e) = quick_two_sum(s, e + t);
    either(s.is_finite(), quick_two_sum(r, e + f), s)
}

/// `a b`.
#[inline(always)]
fn times(a: Dd, b: Dd) -> Dd {
    let (p, e) = two_prod(a.hi, b.hi);
    either(ordinary(p), quick_two_sum(p, e + (a.hi * b.lo + a.lo * b.hi)), p)
}

/// `a + b`.
#[inline(always)]
fn plus_f64(a: Dd, b: f64) -> Dd {
    let (s, e) = two_sum(a.hi, b);
    either(s.is_finite(), quick_two_sum(s, e + a.lo), s)
}

/// `a b`.
#[inline(always)]
fn times_f64(a: Dd, b: f64) -> Dd {
    let (p, e) = two_prod(a.hi, b);
    either(ordinary(p), quick_two_sum(p, e + a.lo * b), p)
}

/// `a/b`.
#[inline(always)]
fn over(a: Dd, b: Dd) -> Dd {
    let q = a.hi / b.hi;
    let r = plus(a, -times_f64(b, q));
    let q2 = r.hi / b.hi;
    let (p, e) = two_prod(b.hi, q2);
    let rest = ((r.hi - p) - e) + (r.lo - b.lo * q2);
    let (hi, lo) = quick_two_sum(q, q2);
    let sum = plus_f64(Dd { hi, lo }, rest / b.hi);
    either(ordinary(q) & !b.hi.is_infinite(), (sum.hi, sum.lo), q)
}

/// √a.
#[inline(always)]
fn root(a: Dd) -> Dd {
    let s = a.hi.sqrt();
    let (square, error) = two_prod(s, s);
    either(ordinary(s), quick_two_sum(s, ((a.hi - square - error) + a.lo) / (2.0 * s)), s)
}

/// Both parts, or where they are not regular `x` alone.
#[inline(always)]
fn either(regular: bool, (hi, lo): (f64, f64), x: f64) -> Dd {
    Dd { hi: if regular { hi } else { x }, lo: if regular { lo } else { 0.0 } }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn same(a: Dd, b: Dd) -> bool {
        let same = |a: f64, b: f64| a.to_bits() == b.to_bits() || (a.is_nan() && b.is_nan());
        same(a.hi, b.hi) && same(a.lo, b.lo)
    }

    /// A lane has the bits of a number alone, also where that is zero or infinite, and where its parts under- and overflow.
    #[test]
    fn a_lane_has_the_bits_of_a_number_alone() {
        let third = Dd::ONE / Dd::exact(3.0);
        let sizes = [0, -300, -500, -960, -1020, -1060, 300, 500, 960, 1020];
        let regular = sizes.into_iter().flat_map(|n| [third.scaled(n), -Dd::PI.scaled(n)]);
        let ends =
            [0.0, -0.0, f64::INFINITY, f64::NEG_INFINITY, f64::NAN, f64::MAX, -f64::MAX].map(Dd::exact);
        let numbers: Vec<Dd> = regular.chain(ends).collect();
        for &a in &numbers {
            for &b in &numbers {
                let (x, y) = (DdLanes::<2>::all(a), DdLanes::<2>::all(b));
                let mut sum = DdLanes::<2>::all(third);
                sum.add_product(&x, &y);
                let found = [-x, x + y, x - y, x * y, x / y, sum, x + b.hi, x * b.hi].map(|x| x.get(1));
                let alone = [-a, a + b, a - b, a * b, a / b, third + a * b, a + b.hi, a * b.hi];
                for (found, alone) in found.into_iter().zip(alone) {
                    assert!(same(found, alone), "{a:?}, {b:?}: {found:?}, {alone:?}");
                }
            }
        }
    }

    /// The same of functions, at numbers of every size, and beside the zeros of sine and cosine.
    #[test]
    fn a_function_of_a_lane_has_the_bits_of_one_of_a_number_alone() {
        let small = (0..400).map(|n| Dd::exact(0.11 * f64::from(n) - 22.0) / Dd::exact(3.0));
        let zeros = (-40..=40).map(|n| Dd::FRAC_PI_2 * f64::from(n));
        let large = (-1074..1024).step_by(7).flat_map(|n| [Dd::E.scaled(n), -Dd::E.scaled(n)]);
        let ends = [0.0, -0.0, f64::INFINITY, f64::NEG_INFINITY, f64::NAN, -745.0, 709.7, -800.0, 800.0];
        let numbers: Vec<Dd> = small.chain(zeros).chain(large).chain(ends.map(Dd::exact)).collect();
        for together in numbers.windows(4) {
            let mut x = DdLanes::<4>::of(0.0);
            for (n, &number) in together.iter().enumerate() {
                x.set(n, number);
            }
            let ((sin, cos), root, exp) = (x.sin_cos(), x.sqrt(), x.exponential());
            for (n, &number) in together.iter().enumerate() {
                let (s, c) = number.sin_cos();
                let alone = [s, c, number.sqrt(), number.exponential()];
                for (found, alone) in [sin, cos, root, exp].into_iter().zip(alone) {
                    assert!(same(found.get(n), alone), "{number:?}: {:?}, {alone:?}", found.get(n));
                }
            }
        }
    }
}

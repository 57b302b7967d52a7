//! Double-double numbers side by side, in loops that the compiler turns into vector instructions.
//!
//! Each has the bits that it has alone. Where [`Dd`] branches, a lane works out both ways and takes one.

use core::ops::{Add, Mul, Neg, Sub};

use super::{Dd, ordinary};
use crate::num::error_free::{quick_two_sum, two_prod, two_sum};

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
        DdLanes { hi: [x.hi; N], lo: [x.lo; N] }
    }

    /// The number in lane `n`.
    #[inline(always)]
    pub(crate) fn get(&self, n: usize) -> Dd {
        Dd { hi: self.hi[n], lo: self.lo[n] }
    }

    /// Puts `x` into lane `n`.
    #[inline(always)]
    pub(crate) fn set(&mut self, n: usize, x: Dd) {
        (self.hi[n], self.lo[n]) = (x.hi, x.lo);
    }

    /// Adds `a b`.
    #[inline(always)]
    pub(crate) fn add_product(&mut self, a: &Self, b: &Self) {
        for n in 0..N {
            self.set(n, plus(self.get(n), times(a.get(n), b.get(n))));
        }
    }

    /// The quotient.
    #[inline(always)]
    pub(crate) fn over(mut self, b: &Self) -> Self {
        for n in 0..N {
            self.set(n, self.get(n).over(b.get(n)));
        }
        self
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
                let found = [-x, x + y, x - y, x * y, x.over(&y), sum].map(|lanes| lanes.get(1));
                let alone = [-a, a + b, a - b, a * b, a / b, third + a * b];
                for (found, alone) in found.into_iter().zip(alone) {
                    assert!(same(found, alone), "{a:?}, {b:?}: {found:?}, {alone:?}");
                }
            }
        }
    }
}

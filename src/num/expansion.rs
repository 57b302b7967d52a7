//! Exact sums and products of a few numbers.
//!
//! An expansion is a sum of `f64` whose bits do not overlap, so that its last component alone tells the
//! sign. Sums and products of expansions are exact, and a difference of two products that nearly cancels is
//! rounded once, at the end.
//!
//! Exact holds while no component under- or overflows: let all inputs lie within about 2^±100 of one and
//! multiply no more than a handful of them.
//!
//! ```
//! use polhode::num::Expansion;
//! let [a, b, c, d] = [0.3, 0.7, 0.21, 1.0].map(Expansion::from);
//! let determinant = &(&a * &b) - &(&c * &d);
//! assert_eq!(0.3 * 0.7 - 0.21 * 1.0, 0.0);
//! assert_eq!(determinant.to_dd().hi(), -1.3322676295501878e-17);
//! ```
//!
//! Source: J. R. Shewchuk, Adaptive precision floating-point arithmetic and fast robust geometric
//! predicates, Discrete & Computational Geometry 18 (1997) 305–363: Grow-Expansion (§2.4) with zero
//! elimination, Compress (§2.8).

use core::cmp::Ordering;
use core::ops::{Add, Mul, Neg, Sub};

use super::Dd;
use super::error_free::{quick_two_sum, two_prod, two_sum};

/// An exact sum of floating-point numbers.
#[derive(Clone, Debug, Default)]
#[must_use]
pub struct Expansion {
    /// Without overlap and without zeros, smallest first; zero is the empty sum.
    parts: Vec<f64>,
}

impl Expansion {
    /// The exact sum of `terms`.
    pub fn sum(terms: impl IntoIterator<Item = f64>) -> Expansion {
        let mut sum = Expansion::default();
        for term in terms {
            sum.push(term);
        }
        sum
    }

    /// Order of the value relative to zero.
    #[must_use]
    pub fn sign(&self) -> Ordering {
        match self.parts.last() {
            Some(&largest) if largest > 0.0 => Ordering::Greater,
            Some(_) => Ordering::Less,
            None => Ordering::Equal,
        }
    }

    /// The value rounded once, with relative error at most 2⁻¹⁰⁵; zero exactly when the value is zero.
    pub fn to_dd(&self) -> Dd {
        let parts = self.clone().compressed().parts;
        let Some((&hi, rest)) = parts.split_last() else {
            return Dd::ZERO;
        };
        Dd::sum(hi, rest.iter().sum())
    }

    fn push(&mut self, term: f64) {
        let mut carry = term;
        let mut kept = 0;
        for k in 0..self.parts.len() {
            let (sum, error) = two_sum(carry, self.parts[k]);
            carry = sum;
            if error != 0.0 {
                self.parts[kept] = error;
                kept += 1;
            }
        }
        self.parts.truncate(kept);
        if carry != 0.0 {
            self.parts.push(carry);
        }
    }

    /// The same value in as few components as its bits need.
    fn compressed(mut self) -> Expansion {
        let Some(mut carry) = self.parts.pop() else {
            return self;
        };
        let mut upper = Vec::new();
        while let Some(part) = self.parts.pop() {
            let (sum, error) = quick_two_sum(carry, part);
            if error == 0.0 {
                carry = sum;
            } else {
                upper.push(sum);
                carry = error;
            }
        }
        while let Some(part) = upper.pop() {
            let (sum, error) = quick_two_sum(part, carry);
            if error != 0.0 {
                self.parts.push(error);
            }
            carry = sum;
        }
        self.parts.push(carry);
        self
    }
}

impl From<f64> for Expansion {
    fn from(x: f64) -> Expansion {
        Expansion::sum([x])
    }
}

impl From<Dd> for Expansion {
    fn from(x: Dd) -> Expansion {
        Expansion::sum([x.lo(), x.hi()])
    }
}

impl Neg for &Expansion {
    type Output = Expansion;
    fn neg(self) -> Expansion {
        Expansion { parts: self.parts.iter().map(|part| -part).collect() }
    }
}

impl Add for &Expansion {
    type Output = Expansion;
    fn add(self, other: &Expansion) -> Expansion {
        let mut sum = self.clone();
        for &part in &other.parts {
            sum.push(part);
        }
        sum.compressed()
    }
}

impl Sub for &Expansion {
    type Output = Expansion;
    fn sub(self, other: &Expansion) -> Expansion {
        self + &-other
    }
}

impl Mul for &Expansion {
    type Output = Expansion;
    fn mul(self, other: &Expansion) -> Expansion {
        let pairs = self.parts.iter().flat_map(|&a| other.parts.iter().map(move |&b| two_prod(a, b)));
        Expansion::sum(pairs.flat_map(|(product, error)| [error, product])).compressed()
    }
}

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
use core::fmt;
use core::ops::{Add, Mul, Neg, Sub};

use super::Dd;
use super::error_free::{quick_two_sum, two_prod, two_sum};

/// Components that there is room for. Compressed ones lie 53 bits apart, so that the range of a double holds 40.
const ROOM: usize = 48;

/// An exact sum of floating-point numbers.
#[derive(Clone)]
#[must_use]
pub struct Expansion {
    /// The first `count` are the components, without overlap and without zeros, smallest first; zero is the empty sum.
    parts: [f64; ROOM],
    count: usize,
}

impl Default for Expansion {
    fn default() -> Expansion {
        Expansion { parts: [0.0; ROOM], count: 0 }
    }
}

impl fmt::Debug for Expansion {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_tuple("Expansion").field(&self.parts()).finish()
    }
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
        match self.parts().last() {
            Some(&largest) if largest > 0.0 => Ordering::Greater,
            Some(_) => Ordering::Less,
            None => Ordering::Equal,
        }
    }

    /// The value rounded once, with relative error at most 2⁻¹⁰⁵; zero exactly when the value is zero.
    pub fn to_dd(&self) -> Dd {
        let mut compressed = self.clone();
        compressed.compress();
        let Some((&hi, rest)) = compressed.parts().split_last() else {
            return Dd::ZERO;
        };
        Dd::sum(hi, rest.iter().sum())
    }

    fn parts(&self) -> &[f64] {
        &self.parts[..self.count]
    }

    fn push(&mut self, term: f64) {
        let mut carry = term;
        let mut kept = 0;
        for k in 0..self.count {
            let (sum, error) = two_sum(carry, self.parts[k]);
            carry = sum;
            // without a branch, which nothing foretells: the next one takes the place of a zero
            self.parts[kept] = error;
            kept += usize::from(error != 0.0);
        }
        self.count = kept;
        if carry == 0.0 {
            return;
        }
        if kept == ROOM {
            self.compress();
            self.push(carry);
        } else {
            self.parts[kept] = carry;
            self.count += 1;
        }
    }

    /// Brings the same value into as few components as its bits need.
    fn compress(&mut self) {
        let Some(last) = self.count.checked_sub(1) else { return };
        // from above, sums to the upper end of the same places
        let (mut carry, mut first) = (self.parts[last], self.count);
        for k in (0..last).rev() {
            let (sum, error) = quick_two_sum(carry, self.parts[k]);
            if error == 0.0 {
                carry = sum;
            } else {
                first -= 1;
                self.parts[first] = sum;
                carry = error;
            }
        }
        let mut kept = 0;
        for k in first..self.count {
            let (sum, error) = quick_two_sum(self.parts[k], carry);
            self.parts[kept] = error;
            kept += usize::from(error != 0.0);
            carry = sum;
        }
        self.parts[kept] = carry;
        self.count = kept + 1;
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
        let mut negated = self.clone();
        negated.parts[..self.count].iter_mut().for_each(|part| *part = -*part);
        negated
    }
}

impl Add for &Expansion {
    type Output = Expansion;
    fn add(self, other: &Expansion) -> Expansion {
        let mut sum = self.clone();
        for &part in other.parts() {
            sum.push(part);
        }
        sum.compress();
        sum
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
        let mut sum = Expansion::default();
        for &a in self.parts() {
            for &b in other.parts() {
                let (product, error) = two_prod(a, b);
                sum.push(error);
                sum.push(product);
            }
        }
        sum.compress();
        sum
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn more_components_than_there_is_room_for_are_summed_exactly() {
        // single bits far apart: none of the 51 overlaps another
        let bits = (0..=50).map(|k| libm::ldexp(1.0, -20 * k));
        let sum = Expansion::sum(bits.clone());
        assert!(sum.count < ROOM);
        let rest = bits.take(50).fold(sum, |sum, bit| &sum - &Expansion::from(bit));
        assert_eq!(rest.to_dd(), Dd::from(libm::ldexp(1.0, -1000)));
    }
}

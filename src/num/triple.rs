//! Sums of three `f64`, about 150 bits: enough for most differences of products that nearly cancel.

use core::ops::{Mul, Sub};

use super::Dd;
use super::error_free::{two_prod, two_sum};

/// This many times a trailing part that still rounds away leaves no doubt of the leading one.
const CLEARLY: f64 = 1.001;

/// Three parts. The second is about 2⁻⁵⁰ and the third 2⁻¹⁰⁰ of the sizes of the numbers that were multiplied or subtracted, at most.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Triple([f64; 3]);

impl Triple {
    /// The double-double number nearest to what is within `error` of this one; `None` where that leaves a doubt.
    pub(crate) fn rounded(self, error: f64) -> Option<Dd> {
        let [first, second, third] = self.0;
        let (second, third) = two_sum(second, third);
        let (hi, second) = two_sum(first, second);
        let (lo, rest) = two_sum(second, third);
        let is_hi = hi + CLEARLY * lo == hi;
        let is_lo = lo + (rest + error) == lo && lo + (rest - error) == lo;
        (is_hi && is_lo && error > 0.0).then(|| Dd::sum(hi, lo))
    }
}

impl From<Dd> for Triple {
    fn from(x: Dd) -> Triple {
        Triple([x.hi(), x.lo(), 0.0])
    }
}

/// With an error of at most 2⁻¹⁴⁹ of the product of the two sizes.
impl Mul for Triple {
    type Output = Triple;
    fn mul(self, b: Triple) -> Triple {
        let ([a0, a1, a2], [b0, b1, b2]) = (self.0, b.0);
        let (first, error) = two_prod(a0, b0);
        let (p, p_error) = two_prod(a0, b1);
        let (q, q_error) = two_prod(a1, b0);
        let (sum, sum_error) = two_sum(p, q);
        let (second, second_error) = two_sum(error, sum);
        let errors = (p_error + q_error) + (sum_error + second_error);
        Triple([first, second, errors + (a0 * b2 + a1 * b1 + a2 * b0)])
    }
}

/// With an error of at most 2⁻¹⁵² of the larger size.
impl Sub for Triple {
    type Output = Triple;
    fn sub(self, b: Triple) -> Triple {
        let ([a0, a1, a2], [b0, b1, b2]) = (self.0, b.0);
        let (first, error) = two_sum(a0, -b0);
        let (sum, sum_error) = two_sum(a1, -b1);
        let (second, second_error) = two_sum(error, sum);
        Triple([first, second, (sum_error + second_error) + (a2 - b2)])
    }
}

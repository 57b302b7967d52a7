//! Compensated sums.

use super::Real;
use super::dd::{two_prod, two_sum};

/// A running sum that carries its own rounding error.
///
/// Each addition is as if done in twice the working precision, so the error of `value` stays at one rounding
/// of the sum and of Σ|terms| · ε², however many terms were added. This is Neumaier's sum (ZAMM 54 (1974)
/// 39–51) with Knuth's branch-free exact addition in place of the comparison of magnitudes.
///
/// ```
/// use polhode::num::Compensated;
/// let mut time = Compensated::new(0.0);
/// for _ in 0..1000 {
///     time.add(0.1);
/// }
/// assert_eq!(time.value(), 100.0);
/// ```
#[derive(Clone, Copy, Debug)]
pub struct Compensated<S> {
    sum: S,
    carry: S,
}

impl<S: Real> Compensated<S> {
    /// A sum that starts at `start`.
    #[inline]
    pub fn new(start: S) -> Self {
        Compensated { sum: start, carry: S::of(0.0) }
    }

    /// Adds one term.
    #[inline]
    pub fn add(&mut self, term: S) {
        let sum = self.sum + term;
        let added = sum - self.sum;
        self.carry = self.carry + ((self.sum - (sum - added)) + (term - added));
        self.sum = sum;
    }

    /// The sum, rounded once.
    #[inline]
    pub fn value(&self) -> S {
        self.sum + self.carry
    }
}

/// Adds `delta` to `sum`, carrying in `carry` what the rounded sum could not hold (Kahan).
///
/// Cheaper than [`Compensated`], and right where the terms are small against the sum, as increments of a state are.
#[inline]
pub fn add_carried<S: Real>(sum: &mut S, carry: &mut S, delta: S) {
    let delta = delta + *carry;
    let new = *sum + delta;
    *carry = delta - (new - *sum);
    *sum = new;
}

/// Σ aₖ bₖ as if computed in twice the working precision and rounded once.
///
/// Source: T. Ogita, S. M. Rump, S. Oishi, Accurate sum and dot product, SIAM J. Sci. Comput. 26 (2005)
/// 1955–1988, algorithm 5.3 (Dot2).
#[inline]
pub fn dot<const N: usize>(a: [f64; N], b: [f64; N]) -> f64 {
    let (mut sum, mut carry) = (0.0, 0.0);
    for k in 0..N {
        let (product, rounding) = two_prod(a[k], b[k]);
        let (total, error) = two_sum(sum, product);
        sum = total;
        carry += error + rounding;
    }
    sum + carry
}

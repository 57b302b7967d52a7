//! Compensated sums.

use super::Real;

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

/// `a · b` and the error of its rounding, by Dekker's splitting: exact for `f64` below 1e300, and in any other scalar as
/// good as its own rounding.
#[inline]
pub fn exact_product<S: Real>(a: S, b: S) -> (S, S) {
    let split = |x: S| {
        let t = x * S::of(134_217_729.0); // 2²⁷ + 1
        let high = t - (t - x);
        (high, x - high)
    };
    let ((a1, a2), (b1, b2), p) = (split(a), split(b), a * b);
    (p, ((a1 * b1 - p) + a1 * b2 + a2 * b1) + a2 * b2)
}

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
    #[inline(always)]
    pub fn new(start: S) -> Self {
        Compensated { sum: start, carry: S::of(0.0) }
    }

    /// A sum that starts at the number `high + low`.
    #[inline(always)]
    pub(crate) fn of([high, low]: [S; 2]) -> Self {
        Compensated { sum: high, carry: low }
    }

    /// A sum that starts at minus the number `high + low`.
    #[inline(always)]
    pub(crate) fn minus([high, low]: [S; 2]) -> Self {
        Compensated { sum: -high, carry: -low }
    }

    /// Adds one term.
    #[inline(always)]
    pub fn add(&mut self, term: S) {
        let (sum, error) = self.sum.two_sum(term);
        (self.sum, self.carry) = (sum, self.carry + error);
    }

    /// Adds a term in two parts, the second of the size of a rounding error of the first.
    #[inline(always)]
    pub(crate) fn add_parts(&mut self, term: S, rest: S) {
        let (sum, error) = self.sum.two_sum(term);
        (self.sum, self.carry) = (sum, self.carry + (error + rest));
    }

    /// The rounded sum, and what it lacks.
    #[inline(always)]
    pub(crate) fn parts(self) -> [S; 2] {
        [self.sum, self.carry]
    }

    /// The sum, rounded once.
    #[inline(always)]
    pub fn value(&self) -> S {
        self.sum + self.carry
    }
}

/// Adds `delta` to `sum`, carrying in `carry` what the rounded sum could not hold (Kahan).
///
/// Cheaper than [`Compensated`], and right where the terms are small against the sum, as increments of a state are.
#[inline(always)]
pub fn add_carried<S: Real>(sum: &mut S, carry: &mut S, delta: S) {
    let delta = delta + *carry;
    let new = *sum + delta;
    *carry = delta - (new - *sum);
    *sum = new;
}

/// The same of a term in two parts, without rounding it: a term that is the same linear function of the sum in every step would
/// drift otherwise.
#[inline]
pub(crate) fn add_parts_carried<S: Real>(sum: &mut S, carry: &mut S, delta: S, rest: S) {
    let (delta, rest) = delta.two_sum(*carry + rest);
    let (new, error) = sum.two_sum(delta);
    (*sum, *carry) = (new, error + rest);
}

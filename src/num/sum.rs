//! Sums that remember what rounding took from them.

use super::Real;

/// Adds `delta` to `sum`, carrying in `carry` what the rounded sum could not hold (Kahan).
#[inline]
pub fn add_carried<S: Real>(sum: &mut S, carry: &mut S, delta: S) {
    let delta = delta + *carry;
    let new = *sum + delta;
    *carry = delta - (new - *sum);
    *sum = new;
}

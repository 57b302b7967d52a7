//! Shares of a step as lengths whose sum is the step.

use crate::num::{Dd, Real};

/// The `shares` of `h`, rounded to the digits of `S`; what closes the palindrome, or the last without one, takes up what rounding the others has
/// changed, or the clock would be off.
pub(in crate::method) fn lengths<S: Real>(h: Dd, shares: &[Dd]) -> Vec<Dd> {
    let n = shares.len();
    if !shares.iter().eq(shares.iter().rev()) {
        let but_last = shares[..n - 1].iter().map(|&share| S::rounded(h * share)).collect::<Vec<_>>();
        let left = but_last.iter().fold(h, |left, &length| left - length);
        return but_last.into_iter().chain([S::rounded(left)]).collect();
    }
    let outer = (n - 1) / 2;
    let mut all: Vec<Dd> = Vec::with_capacity(n);
    all.extend(shares[..outer].iter().map(|&share| S::rounded(h * share)));
    let left = all.iter().fold(h, |left, &length| left - length * 2.0);
    if n % 2 == 1 {
        all.push(S::rounded(left));
    } else {
        all.extend([S::rounded(left * 0.5); 2]);
    }
    for k in (0..outer).rev() {
        all.push(all[k]);
    }
    all
}

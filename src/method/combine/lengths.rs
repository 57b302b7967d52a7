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
    let outer: Vec<Dd> = shares[..(n - 1) / 2].iter().map(|&share| S::rounded(h * share)).collect();
    let left = outer.iter().fold(h, |left, &length| left - length * 2.0);
    let centre = if n % 2 == 1 { vec![S::rounded(left)] } else { vec![S::rounded(left * 0.5); 2] };
    outer.iter().copied().chain(centre).chain(outer.iter().rev().copied()).collect()
}

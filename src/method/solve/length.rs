//! The size of a state, by which methods that choose their steps measure errors.

use crate::num::Real;

/// Euclidean length, which turns of space leave as it is, of numbers whose squares may leave the range of a double. NaN where one
/// is NaN.
#[inline]
pub(in crate::method) fn length<S: Real, const N: usize>(components: [S; N]) -> f64 {
    let x = components.map(S::magnitude);
    let squares: f64 = x.iter().map(|x| x * x).sum();
    if (1e-280..1e280).contains(&squares) {
        return squares.sqrt();
    }
    let largest = x.iter().fold(0.0, |a: f64, &b| if b > a || b.is_nan() { b } else { a });
    if largest == 0.0 {
        return 0.0;
    }
    let unit = libm::scalbn(1.0, libm::ilogb(largest).clamp(-1000, 1000));
    let squares: f64 = x.iter().map(|x| (x / unit) * (x / unit)).sum();
    squares.sqrt() * unit
}

//! Stumpff's functions, in which motion on a conic has no singularity at the parabola.

use super::Real;
use super::dd::INVERSE_FACTORIAL;

/// Terms of the series up to a half, to the digits of doubles and of double-double.
const TERMS: [usize; 2] = [9, 14];

/// How often `z` is divided by four until it is at most a half.
pub(crate) fn halvings(z: f64) -> u32 {
    let mut left = z.abs();
    let mut count = 0;
    while left > 0.5 && left < f64::INFINITY {
        left *= 0.25;
        count += 1;
    }
    count
}

/// Stumpff's functions c₀ to c₃ of `z`: cos √z, sin √z/√z, (1 − cos √z)/z and (√z − sin √z)/√z³, entire in z.
///
/// By their series of `z` divided by four as often as `halvings` says, and the formulas of the double angle in a form without
/// cancellation (Battin, An Introduction to the Mathematics and Methods of Astrodynamics, 1999, §4.5).
pub(crate) fn stumpff<S: Real>(z: S, halvings: u32) -> [S; 4] {
    let one = S::of(1.0);
    let mut z = z.times_power_of_two(libm::scalbn(1.0, -2 * halvings.min(500) as i32));
    let last = TERMS[usize::from(S::ROUNDOFF < 1e-20)] - 1;
    let series = |first: usize| {
        let coefficient = |k: usize| S::from_dd(INVERSE_FACTORIAL[first + 2 * k]);
        (0..last).rev().fold(coefficient(last), |sum, k| coefficient(k) - z * sum)
    };
    let [mut c2, mut c3] = [series(2), series(3)];
    let cosine = |z: S, c2: S, c3: S| [one - z * c2, one - z * c3];
    let [mut c0, mut c1] = cosine(z, c2, c3);
    for _ in 0..halvings {
        c3 = (c2 + c0 * c3).times_power_of_two(0.25);
        c2 = (c1 * c1).times_power_of_two(0.5);
        z = z.times_power_of_two(4.0);
        [c0, c1] = cosine(z, c2, c3);
    }
    [c0, c1, c2, c3]
}

//! An RK4 written by hand: the unit of time of the benchmarks.
//!
//! It is a package of its own, which the profiles of the workspace compile at `opt-level = 2` always. There this text is fastest: at 3
//! the compiler packs pairs of its numbers into vectors, and the steps take half as long again. So the unit is the same whatever the
//! library is compiled with, as long as nothing is optimised again when it is linked (`lto = "off"`).

use core::ops::{Add, Div, Mul, Sub};
use std::hint::black_box;

/// Takes `steps` steps of `h` seconds of the textbook's RK4 on quaternion (scalar first) and angular velocity (body axes, rad/s) of a
/// free body with the principal moments 1, 2 and 3 kg m².
#[inline(never)]
pub fn rk4(state: &mut [f64; 7], h: f64, steps: u64) {
    rk4_of(state, h, steps);
}

/// The same of any numbers, so that its operations can be counted.
#[inline(always)]
pub fn rk4_of<S>(state: &mut [S; 7], h: S, steps: u64)
where
    S: Copy + From<f64> + Add<Output = S> + Sub<Output = S> + Mul<Output = S> + Div<Output = S>,
{
    let moments = black_box([1.0, 2.0, 3.0]).map(S::from);
    let inverse = moments.map(|i| S::from(1.0) / i);
    let (half, two, six) = (S::from(0.5), S::from(2.0), S::from(6.0));
    let rate = |y: &[S; 7]| {
        let [w, x, y, z, a, b, c] = *y;
        [
            S::from(-0.5) * (x * a + y * b + z * c),
            half * (w * a + y * c - z * b),
            half * (w * b + z * a - x * c),
            half * (w * c + x * b - y * a),
            (moments[1] - moments[2]) * b * c * inverse[0],
            (moments[2] - moments[0]) * c * a * inverse[1],
            (moments[0] - moments[1]) * a * b * inverse[2],
        ]
    };
    let moved = |y: &[S; 7], k: &[S; 7], t: S| -> [S; 7] { core::array::from_fn(|n| y[n] + t * k[n]) };
    for _ in 0..steps {
        let k1 = rate(state);
        let k2 = rate(&moved(state, &k1, half * h));
        let k3 = rate(&moved(state, &k2, half * h));
        let k4 = rate(&moved(state, &k3, h));
        for n in 0..7 {
            state[n] = state[n] + h / six * (k1[n] + two * k2[n] + two * k3[n] + k4[n]);
        }
    }
}

/// Takes `steps` times an addition and a multiplication of which each waits for the one before.
#[inline(never)]
#[must_use]
pub fn chain(mut x: f64, steps: u64) -> f64 {
    let (sum, factor) = black_box((1e-9, 0.999_999_999));
    for _ in 0..steps {
        x = (x + sum) * factor;
    }
    x
}

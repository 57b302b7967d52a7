//! The exponential in `f64` without branches, for loops over lanes.

/// ln 2 in two parts, the first of 33 bits: times an integer below 2²⁰ it is exact.
const LN_2: [f64; 2] = [6.931_471_803_691_238e-1, 1.908_214_929_270_587_7e-10];

/// Interpolation of x (eˣ + 1)/(eˣ − 1) − 2 in powers of x², |x| ≤ ½ ln 2.
const P: [f64; 5] = [
    1.666_666_666_666_660_2e-1,
    -2.777_777_777_701_559_3e-3,
    6.613_756_321_437_934e-5,
    -1.653_390_220_546_525_2e-6,
    4.138_136_797_057_238_5e-8,
];

/// Adding and subtracting it rounds to an integer, whose last bits stand last in the sum.
const ROUNDER: f64 = 6_755_399_441_055_744.0; // 1.5 · 2⁵²

/// eˣ for 0 ≤ x ≤ 700, with an error below one unit in the last place.
///
/// x = k ln 2 + r with |r| ≤ ½ ln 2 and eʳ = 1 + 2r/(R(r²) − r): the method and the constants of FreeBSD's `e_exp.c` (Sun
/// Microsystems 1993), with its bits; selections stand where it branches.
#[inline(always)]
pub(crate) fn exp_of_positive(x: f64) -> f64 {
    // as there, limits are compared in the leading 32 bits
    const HALF: f64 = f64::from_bits(0x3fd6_2e43_0000_0000);
    const ONE_AND_A_HALF: f64 = f64::from_bits(0x3ff0_a2b2_0000_0000);
    const TINY: f64 = f64::from_bits(0x3e30_0001_0000_0000);
    let shifted = core::f64::consts::LOG2_E * x + 0.5;
    let near = (shifted + ROUNDER) - ROUNDER;
    let below = if near > shifted { near - 1.0 } else { near };
    let k = if x >= ONE_AND_A_HALF { below } else { 1.0 };
    let k = if x >= HALF { k } else { 0.0 };
    let (high, low) = (x - k * LN_2[0], k * LN_2[1]);
    let r = high - low;
    let z = r * r;
    let c = r - z * (P[0] + z * (P[1] + z * (P[2] + z * (P[3] + z * P[4]))));
    let y = 1.0 + (r * c / (2.0 - c) - low + high);
    let power = f64::from_bits(((k + 1023.0) + ROUNDER).to_bits() << 52);
    if x >= TINY { y * power } else { 1.0 + x }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn it_has_the_bits_of_the_function_with_branches() {
        let limits = [0.0, 1e-300, 2e-9, 4e-9, 0.346, 0.347, 1.039, 1.04, 350.0, 700.0];
        let between = (0..200_000).map(|n| 700.0 * (f64::from(n) * 0.618_033_988_749_894_8).fract());
        let small = (0..200_000).map(|n| 1e-5 * f64::from(n) * (1.0 + 1e-7 * f64::from(n)));
        for x in limits.into_iter().chain(between).chain(small) {
            assert_eq!(exp_of_positive(x), libm::exp(x), "{x:e}");
        }
    }
}

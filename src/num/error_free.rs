//! Sums and products of two `f64` with the exact error of their rounding.

/// `a + b` as a rounded sum and its exact error (Knuth).
#[inline(always)]
pub(crate) const fn two_sum(a: f64, b: f64) -> (f64, f64) {
    let s = a + b;
    let v = s - a;
    (s, (a - (s - v)) + (b - v))
}

/// `a + b` as a rounded sum and its exact error, for |a| ≥ |b| (Dekker).
#[inline(always)]
pub(crate) const fn quick_two_sum(a: f64, b: f64) -> (f64, f64) {
    let s = a + b;
    (s, b - (s - a))
}

/// `a` as a sum of two numbers of at most 26 bits. Rounding the bit pattern does what Dekker's
/// multiplication by 2²⁷ + 1 does, and cannot overflow below 2¹⁰²³.
#[inline(always)]
const fn split(a: f64) -> (f64, f64) {
    let hi = f64::from_bits(a.to_bits().wrapping_add(1 << 26) & !((1 << 27) - 1));
    (hi, a - hi)
}

/// `a · b` as a rounded product and its exact error (Dekker's product: the same bits with and without FMA).
#[inline(always)]
pub(crate) const fn two_prod(a: f64, b: f64) -> (f64, f64) {
    let p = a * b;
    let (ah, al) = split(a);
    let (bh, bl) = split(b);
    (p, ((ah * bh - p) + ah * bl + al * bh) + al * bl)
}

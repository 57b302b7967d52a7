//! The periods of the motion: the lattice of `Y² = 4X³ − g₂X − g₃`.
//!
//! T is the real period and ω₂ = iy, or T/2 + iy where two of the roots e_k are no real numbers (*skew*); with the
//! arithmetic-geometric mean M, `T = π/M(√(e₁ − e₃), √(e₁ − e₂))`, e₁ = ℘(T/2), and y likewise.

use super::pencil::Pencil;
use crate::num::complex::Complex;
use crate::num::{Dd, Precise, Real};

/// What rounding leaves of X, of the terms that it is a sum of.
const ROUNDING: f64 = 1e-27;

/// The difference that equal roots are given: the nome then is lost beside one.
const EQUAL: f64 = 1e-36;

/// Real and second period of the curve.
#[derive(Clone, Copy, Debug)]
pub(super) struct Lattice {
    /// e₁ = ℘(T/2), real, e₂ and e₃.
    pub(super) roots: [Complex<Dd>; 3],
    pub(super) g2: Dd,
    pub(super) period: Dd,
    /// y.
    pub(super) height: Dd,
    pub(super) is_skew: bool,
    /// What rounding leaves of X beside equal roots.
    pub(super) rounding: f64,
}

impl Lattice {
    pub(super) fn new(pencil: &Pencil) -> Self {
        let &Pencil { single, mut split, terms, .. } = pencil;
        let is_low = single < Dd::ZERO;
        let g2 = split + single * single * 3.0;
        if split == Dd::ZERO {
            let least = single * EQUAL;
            split = least * least;
        }
        let half = split.abs().sqrt() * 0.5;
        let (middle, lift) = (single * -0.5, single.abs() * 1.5);
        let real = |x: Dd| Complex::new(x, Dd::ZERO);
        let (is_skew, roots, period, height);
        if split > Dd::ZERO {
            is_skew = false;
            let (near, far, apart) = (lift - half, lift + half, half * 2.0);
            // the smaller difference next to the single root, and the difference of the other two
            let [along, across] = [near, apart].map(|other| Dd::PI / mean(far.sqrt(), other.sqrt()));
            if is_low {
                roots = [real(middle + half), real(middle - half), real(single)];
                (period, height) = (across, along);
            } else {
                roots = [real(single), real(middle + half), real(middle - half)];
                (period, height) = (along, across);
            }
        } else {
            is_skew = true;
            let size = (lift * lift + half * half).sqrt();
            let (large, small) = ((size + lift) * 0.5, half * half / ((size + lift) * 2.0));
            let [long, short] = [small, large].map(|square| Dd::PI / mean(square.sqrt(), size.sqrt()));
            roots = [real(single), Complex::new(middle, half), Complex::new(middle, -half)];
            (period, height) = if is_low { (long, short * 0.5) } else { (short, long * 0.5) };
        }
        Lattice { roots, g2, period, height, is_skew, rounding: terms.sqrt() * ROUNDING }
    }

    /// y/T.
    pub(super) fn ratio(&self) -> Dd {
        self.height / self.period
    }

    /// `u` less the period of the lattice that brings it next to zero.
    pub(super) fn reduced(&self, u: Complex<Dd>) -> Complex<Dd> {
        let up = (u.im / self.height).round();
        let im = u.im - up * self.height;
        let re = if self.is_skew { u.re - up * self.period * 0.5 } else { u.re };
        Complex::new(re - (re / self.period).round() * self.period, im)
    }
}

fn mean(mut a: Dd, mut b: Dd) -> Dd {
    for _ in 0..40 {
        if (a - b).magnitude() <= 1e-15 * a.magnitude() {
            break;
        }
        (a, b) = ((a + b) * 0.5, (a * b).sqrt());
    }
    (a + b) * 0.5
}

//! The momentum along the axis of a small moment, by a sum of its own: ω = (m − h)/I would magnify the rounding of m.
//!
//! With M = G e_k of the axes (e₁, e₂, n₀) along the axis k and c = M₁ − iM₂,
//!
//! `(m_k − h_k) N = (M₃ − h_k)|Z|² − (M₃ + h_k)|W|² + 2 Re (c W Z̄) = Σ_j S_j X^j`,
//!
//! a theta function of the fourth degree, whose coefficients are as small as m_k − h_k is.

use super::level::Level;
use super::spinor::Spinor;
use crate::num::complex::Complex;
use crate::num::{Dd, Real};
use crate::rotation::Vec3;

/// A moment below this share of the middle one is small.
const SMALL: f64 = 0.5;

/// Wheel momentum along the axis above this share of G leaves m no digits beyond its own rounding.
const STRONG: f64 = 0.25;

/// Terms of this share of the largest are left out.
const NEGLIGIBLE: f64 = 1e-19;

/// Share of the largest term below which no product of two is needed, though the sum may be small beside them.
const LEAST: f64 = 1e-26;

/// The component along the axis of the smallest moment.
#[derive(Clone, Debug)]
pub(super) struct Least {
    axis: usize,
    wheel: f64,
    constant: f64,
    /// 2 S_j, from the last down to the first.
    terms: Vec<Complex<f64>>,
}

impl Least {
    /// `None` where the smallest of the `moments` is not far below the next, or the wheel along its axis is strong; `norm` is G.
    pub(super) fn new(
        level: &Level,
        spinor: &Spinor,
        moments: Vec3<Dd>,
        wheel: Vec3<Dd>,
        norm: Dd,
    ) -> Option<Self> {
        let [axis, middle, _] = moments.ascending();
        let is_strong = wheel[axis].magnitude() > STRONG * norm.hi();
        if is_strong || moments[axis].hi() >= SMALL * moments[middle].hi() {
            return None;
        }
        let [m1, m2, m3] = level.frame.map(|e| e[axis] * norm);
        let (h, c) = (wheel[axis], Complex::new(m1, -m2));
        let size = |c: Complex<Dd>| c.norm_squared().hi();
        // those that a product can need
        let sizes = || spinor.terms.iter().map(|&[z, w]| size(z).max(size(w)));
        let least = sizes().fold(0.0, f64::max) * LEAST * LEAST;
        let left_out = sizes().take_while(|&size| size < least).count();
        let right_out = sizes().rev().take_while(|&size| size < least).count();
        let used = &spinor.terms[left_out..spinor.terms.len() - right_out];
        let image =
            |&[z, w]: &[Complex<Dd>; 2]| [z.scaled(m3 - h) + c * w, c.conjugate() * z - w.scaled(m3 + h)];
        let images: Vec<[Complex<Dd>; 2]> = used.iter().map(image).collect();
        let sum = |j: usize| {
            let pairs = used.iter().zip(&images[j..]);
            pairs.fold(Complex::new(Dd::ZERO, Dd::ZERO), |sum, ([z, w], [y, x])| {
                sum + z.conjugate() * *y + w.conjugate() * *x
            })
        };
        let mut sums: Vec<Complex<Dd>> = Vec::with_capacity(images.len());
        let mut largest = 0.0_f64;
        for j in 0..images.len() {
            let sum = sum(j);
            largest = largest.max(size(sum));
            // even and odd ones fall on their own
            let is_small =
                |c: Option<&Complex<Dd>>| c.is_some_and(|&c| size(c) < largest * NEGLIGIBLE * NEGLIGIBLE);
            if is_small(Some(&sum)) && is_small(sums.last()) {
                break;
            }
            sums.push(sum);
        }
        let twice = |c: &Complex<Dd>| Complex::new(2.0 * c.re.hi(), 2.0 * c.im.hi());
        let terms = sums[1..].iter().rev().map(twice).collect();
        Some(Least { axis, wheel: h.hi(), constant: sums[0].re.hi(), terms })
    }

    /// Replaces the component of the momentum `m` at X, where 1/N is `inverse`.
    #[inline]
    pub(super) fn replace(&self, m: &mut Vec3<f64>, x: Complex<f64>, inverse: f64) {
        let sum = self.terms.iter().fold(Complex::new(0.0, 0.0), |sum, &term| (sum + term) * x);
        m[self.axis] = self.wheel + (self.constant + sum.re) * inverse;
    }
}

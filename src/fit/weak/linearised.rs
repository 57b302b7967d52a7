//! The weak equations of one stretch, linearised.

use nalgebra::{Matrix3, Vector3};

use super::test_functions::{Seen, Stretch, TestFunctions};
use crate::fit::physical::coordinates::{Coordinates, Form, basis, tensor};
use crate::num::banded::Banded;

/// [ω]ₓ B − [B ω]ₓ: the derivative of ω × B ω.
pub(crate) fn cross_derivative(b: &Matrix3<f64>, w: &Vector3<f64>) -> Matrix3<f64> {
    w.cross_matrix() * b - (b * w).cross_matrix()
}

/// The weak equations of one stretch, linearised at samples `rates` − `noise` and tensor J, whitened by L⁻¹.
pub(crate) struct Linearised {
    tests: TestFunctions,
    factor: Banded,
    /// The coordinates that the last column is the residual of: what is left of x is small, and so is its rounding.
    pub(crate) origin: Coordinates,
    /// L⁻¹ [G | r], row by row.
    pub(crate) rows: Vec<[f64; 6]>,
}

impl Linearised {
    /// `None` where the covariance is not positive, as for a tensor far from physical.
    pub(crate) fn new(
        stretch: &Stretch,
        noise: &[Vector3<f64>],
        origin: Coordinates,
        tests: TestFunctions,
    ) -> Option<Self> {
        let j = &tensor(&origin);
        let size = 3 * tests.count;
        let mut covariance = Banded::zeros(size, 3 * tests.reach + 2);
        let mut rows = vec![[0.0; 6]; size];
        let bases: [Matrix3<f64>; 6] = core::array::from_fn(|k| if k < 5 { basis(k) } else { *j });
        let jj = j * j;
        for (i, noise) in noise.iter().enumerate() {
            let seen = Seen::new(&tests, stretch.times[i], stretch.weights[i]);
            let w = stretch.rates[i] - noise;
            let products = bases.map(|b| b * w);
            let crosses = products.map(|p| w.cross(&p));
            let k = cross_derivative(j, &w);
            let (jn, kn) = (j * noise, k * noise);
            let (jk, kk) = (j * k.transpose(), k * k.transpose());
            let with_noise = |v: &[Vector3<f64>; 6], own: &Vector3<f64>| -> [[f64; 6]; 3] {
                core::array::from_fn(|c| {
                    core::array::from_fn(|l| if l < 5 { v[l][c] } else { v[l][c] + own[c] })
                })
            };
            let (products, crosses) = (with_noise(&products, &jn), with_noise(&crosses, &kn));
            // A Aᵀ by rows p: slope times (slope J J − value J Kᵀ) and value times (value K Kᵀ − slope K J)
            let line = |m: &Matrix3<f64>, p: usize| [m[(p, 0)], m[(p, 1)], m[(p, 2)]];
            let kj = jk.transpose();
            let by_slope: [_; 3] = core::array::from_fn(|p| seen.mix(line(&jj, p), line(&jk, p)));
            let by_value: [_; 3] = core::array::from_fn(|p| seen.mix(line(&kj, p), line(&kk, p)));
            for row in 0..seen.count {
                let (a, b, p) = (seen.slope[row], seen.value[row], row % 3);
                for ((sum, cross), product) in
                    rows[seen.first + row].iter_mut().zip(&crosses[p]).zip(&products[p])
                {
                    *sum += b * cross - a * product;
                }
                let entries = covariance.row_mut(seen.first + row, seen.first, seen.first + row + 1);
                for ((entry, s), v) in entries.iter_mut().zip(&by_slope[p]).zip(&by_value[p]) {
                    *entry += b * v - a * s;
                }
            }
        }
        if !covariance.factor() {
            return None;
        }
        covariance.forward(&mut rows);
        Some(Linearised { tests, factor: covariance, origin, rows })
    }

    /// Whitened residuals at `x`.
    pub(crate) fn residuals(&self, x: &Coordinates) -> Vec<f64> {
        let step = x - self.origin;
        self.rows.iter().map(|row| row[5] + (0..5).map(|k| row[k] * step[k]).sum::<f64>()).collect()
    }

    /// The noise n̂ = Aᵀ C⁻¹ r that carries the samples onto the weak equations of `x`.
    pub(crate) fn noise(
        &self,
        stretch: &Stretch,
        old: &[Vector3<f64>],
        j: &Matrix3<f64>,
        x: &Coordinates,
    ) -> Vec<Vector3<f64>> {
        let mut multipliers = self.residuals(x);
        self.factor.backward(&mut multipliers);
        (0..stretch.times.len())
            .map(|i| {
                let seen = Seen::new(&self.tests, stretch.times[i], stretch.weights[i]);
                let (mut slopes, mut values) = (Vector3::<f64>::zeros(), Vector3::<f64>::zeros());
                for row in 0..seen.count {
                    slopes[row % 3] += multipliers[seen.first + row] * seen.slope[row];
                    values[row % 3] += multipliers[seen.first + row] * seen.value[row];
                }
                let k = cross_derivative(j, &(stretch.rates[i] - old[i]));
                k.transpose() * values - j * slopes
            })
            .collect()
    }

    /// V of this stretch.
    pub(crate) fn inflation(&self, stretch: &Stretch, noise: &[Vector3<f64>]) -> Form {
        let inverse = self.factor.inverse_band();
        let bases: [Matrix3<f64>; 5] = core::array::from_fn(basis);
        let mut sum = Form::zeros();
        for (i, noise) in noise.iter().enumerate() {
            let seen = Seen::new(&self.tests, stretch.times[i], stretch.weights[i]);
            let [aa, ab, bb] = seen.sums(&inverse);
            let ba = ab.transpose();
            let w = stretch.rates[i] - noise;
            let k = bases.map(|b| cross_derivative(&b, &w));
            // Σ tr Z D_l D_kᵀ with D_k = −φ' B_k + φ K_k
            for l in 0..5 {
                let from_slope = bases[l] * aa - k[l] * ba;
                let from_value = k[l] * bb - bases[l] * ab;
                for m in 0..=l {
                    // tr(M Nᵀ) is the entry by entry product
                    sum[(l, m)] += from_slope.dot(&bases[m]) + from_value.dot(&k[m]);
                }
            }
        }
        sum.fill_upper_triangle_with_lower_triangle();
        sum
    }
}

//! Derivatives beyond the range of a double, with a power of two beside them.
//!
//! On the separatrix a motion ends as a steady spin. From there the derivative over a time is the same each time, in axes of the body:
//! over n times it is the n-th power, which repeated squares give.

use nalgebra::SMatrix;

/// Most e-folds of growth in one time; half of them bring the motion to the spin.
pub(super) const FOLDS: f64 = 256.0;

/// Angle from the axis of the spin, as a share, below which no digit of a double-double tells the motion from the spin.
pub(super) const SETTLED: f64 = 1e-40;

/// Of rotation vector, momentum and constants, times 2^exponent.
#[derive(Clone, Copy)]
pub(super) struct Scaled<const N: usize> {
    matrix: SMatrix<f64, N, N>,
    exponent: i64,
}

impl<const N: usize> Scaled<N> {
    /// Of the rows of rotation vector and momentum in axes of the body; the constants stay.
    pub(super) fn of(rows: SMatrix<f64, 6, N>) -> Self {
        let mut matrix = SMatrix::<f64, N, N>::identity();
        matrix.fixed_rows_mut::<6>(0).copy_from(&rows);
        Scaled { matrix, exponent: 0 }
    }

    fn times(&self, first: &Self) -> Self {
        let product = self.matrix * first.matrix;
        let by = libm::ilogb(product.amax());
        Scaled {
            matrix: product.map(|x| libm::scalbn(x, -by)),
            exponent: self.exponent + first.exponent + i64::from(by),
        }
    }

    /// `self` to the `n`-th times `first`.
    pub(super) fn power_times(mut self, mut n: u64, mut first: Self) -> Self {
        while n > 0 {
            if n % 2 == 1 {
                first = self.times(&first);
            }
            self = self.times(&self);
            n /= 2;
        }
        first
    }

    /// The rows again, and the exponent where it is one of an `i32`.
    pub(super) fn rows(&self) -> Option<(SMatrix<f64, 6, N>, i32)> {
        Some((self.matrix.fixed_rows::<6>(0).into_owned(), i32::try_from(self.exponent).ok()?))
    }
}

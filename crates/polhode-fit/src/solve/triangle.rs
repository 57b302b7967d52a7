//! Many rows of a least-squares problem as one upper triangle.

use multiversion::multiversion;
use nalgebra::DMatrix;

use crate::thresholds::stacked::TOGETHER;

/// The upper triangle R with |R u| = |A u| for every u, A being all rows that were pushed: the R of A = QR.
///
/// By Householder's reflections, a block of rows at a time under the triangle of those before (Golub and Van Loan, Matrix
/// Computations, §5.2): squares are never formed. A reflection changes one row of the triangle and the block alone.
pub(crate) struct Triangle {
    r: DMatrix<f64>,
    /// Rows that wait, column by column; rows that are not there yet are zero.
    block: Vec<f64>,
    waiting: usize,
}

impl Triangle {
    pub(crate) fn new(width: usize) -> Self {
        Triangle { r: DMatrix::zeros(width, width), block: vec![0.0; width * TOGETHER], waiting: 0 }
    }

    pub(crate) fn push(&mut self, row: impl IntoIterator<Item = f64>) {
        for (column, value) in self.block.chunks_exact_mut(TOGETHER).zip(row) {
            column[self.waiting] = value;
        }
        self.waiting += 1;
        if self.waiting == TOGETHER {
            self.reflect();
        }
    }

    /// The triangle.
    pub(crate) fn finished(mut self) -> DMatrix<f64> {
        self.reflect();
        self.r
    }

    /// Takes the waiting rows into the triangle.
    fn reflect(&mut self) {
        reflect(&mut self.r, &mut self.block, core::mem::take(&mut self.waiting));
        self.block.fill(0.0);
    }
}

#[multiversion(targets("x86_64+avx512f+avx512dq+avx512vl+fma", "x86_64+avx2+fma"))]
fn reflect(r: &mut DMatrix<f64>, block: &mut [f64], rows: usize) {
    let mut rest = block;
    for j in 0..r.ncols() {
        let (column, later) = rest.split_at_mut(TOGETHER);
        rest = later;
        let column = &mut column[..rows];
        let corner = r[(j, j)];
        let mut size = 0.0_f64;
        // no closures: they would not be compiled for wide registers
        for value in column.iter() {
            size = size.max(value.abs());
        }
        if size == 0.0 {
            continue; // nothing below the corner
        }
        // the reflection I − 2 v vᵀ/|v|², in units of the largest number, so that no square overflows
        let size = size.max(corner.abs());
        for value in column.iter_mut() {
            *value /= size;
        }
        let (top, below) = (corner / size, dot(column, column));
        let first = top + (top * top + below).sqrt().copysign(top);
        let twice = 2.0 / (first * first + below);
        r[(j, j)] = (top - first) * size;
        for (k, other) in rest.chunks_exact_mut(TOGETHER).enumerate() {
            let (other, entry) = (&mut other[..rows], &mut r[(j, j + 1 + k)]);
            let along = twice * (first * *entry + dot(column, other));
            *entry -= along * first;
            for (value, v) in other.iter_mut().zip(&*column) {
                *value -= along * v;
            }
        }
    }
}

/// Sums side by side, which the compiler puts into vectors.
#[inline(always)]
fn dot(a: &[f64], b: &[f64]) -> f64 {
    let (a, a_rest) = a.as_chunks::<8>();
    let (b, b_rest) = b.as_chunks::<8>();
    let mut sums = [0.0; 8];
    for (a, b) in a.iter().zip(b) {
        for k in 0..8 {
            sums[k] += a[k] * b[k];
        }
    }
    let mut rest = 0.0;
    for (a, b) in a_rest.iter().zip(b_rest) {
        rest += a * b;
    }
    let mut sum = 0.0;
    for own in sums {
        sum += own;
    }
    sum + rest
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Rows of a fixed pseudo-random kind, of sizes over many decades.
    fn rows(count: usize, width: usize) -> DMatrix<f64> {
        let mut state = 1_u64;
        DMatrix::from_fn(count, width, |_, k| {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            ((state >> 11) as f64 / (1_u64 << 53) as f64 - 0.5) * [1e3, 1.0, 1e-3, 1e6, 1e-6, 1e9, 1e-9][k]
        })
    }

    fn of(matrix: &DMatrix<f64>) -> DMatrix<f64> {
        let mut triangle = Triangle::new(matrix.ncols());
        matrix.row_iter().for_each(|row| triangle.push(row.iter().copied()));
        triangle.finished()
    }

    #[test]
    fn the_triangle_is_that_of_another_library() {
        for count in [1, 3, 7, TOGETHER - 1, TOGETHER, 2 * TOGETHER + 5] {
            let a = rows(count, 7);
            let (mine, theirs) = (of(&a), a.clone().qr().r());
            for i in 0..count.min(7) {
                // the sign of a row of R is free
                let sign = (mine[(i, i)] * theirs[(i, i)]).signum();
                let apart = (mine.row(i) * sign - theirs.row(i)).norm();
                assert!(apart <= 1e-13 * theirs.row(i).norm(), "{count} rows, row {i}: {apart:e}");
            }
            assert!((0..7).all(|i| (0..i).all(|k| mine[(i, k)] == 0.0)));
        }
    }

    #[test]
    fn sizes_whose_squares_overflow_or_vanish_change_nothing() {
        let a = rows(50, 5);
        for exponent in [1023 + 900, 1023 - 900] {
            let scale = f64::from_bits(exponent << 52); // a power of two
            assert_eq!(of(&(&a * scale)), of(&a) * scale);
        }
    }

    #[test]
    fn a_column_of_zeros_stays() {
        let mut a = rows(20, 4);
        a.column_mut(1).fill(0.0);
        assert!(of(&a).column(1).iter().all(|value| *value == 0.0));
    }
}

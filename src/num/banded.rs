//! Symmetric positive matrices with a narrow band: Cholesky factor, substitutions, and the band of the inverse.

/// The lower band of a symmetric matrix, or of its factor: row i holds columns i − band … i.
#[derive(Clone, Debug)]
pub(crate) struct Banded {
    size: usize,
    band: usize,
    rows: Vec<f64>,
}

impl Banded {
    pub(crate) fn zeros(size: usize, band: usize) -> Self {
        Banded { size, band, rows: vec![0.0; size * (band + 1)] }
    }

    /// Where entry (i, j) stands; i − band ≤ j ≤ i.
    #[inline]
    fn at(&self, i: usize, j: usize) -> usize {
        i * (self.band + 1) + self.band + j - i
    }

    #[inline]
    pub(crate) fn get(&self, i: usize, j: usize) -> f64 {
        let (i, j) = if i < j { (j, i) } else { (i, j) };
        if i - j > self.band { 0.0 } else { self.rows[self.at(i, j)] }
    }

    #[inline]
    pub(crate) fn add(&mut self, i: usize, j: usize, value: f64) {
        let at = self.at(i, j);
        self.rows[at] += value;
    }

    /// Row i from column `from` up to column `to`, exclusive.
    #[inline]
    pub(crate) fn row_mut(&mut self, i: usize, from: usize, to: usize) -> &mut [f64] {
        let at = self.at(i, from);
        &mut self.rows[at..at + (to - from)]
    }

    /// The same to read.
    #[inline]
    pub(crate) fn row(&self, i: usize, from: usize, to: usize) -> &[f64] {
        &self.rows[self.at(i, from)..self.at(i, from) + (to - from)]
    }

    /// Replaces the matrix by its Cholesky factor; false where it is not positive.
    pub(crate) fn factor(&mut self) -> bool {
        for i in 0..self.size {
            let first = i.saturating_sub(self.band);
            for j in first..=i {
                let from = first.max(j.saturating_sub(self.band));
                let sum = self.get(i, j) - dot(self.row(i, from, j), self.row(j, from, j));
                let at = self.at(i, j);
                if j < i {
                    self.rows[at] = sum / self.get(j, j);
                } else if sum > 0.0 {
                    self.rows[at] = sum.sqrt();
                } else {
                    return false;
                }
            }
        }
        true
    }

    /// L⁻¹ b, of a factor, in place; b has rows of `width` numbers, one for each right-hand side.
    pub(crate) fn forward(&self, b: &mut [f64], width: usize) {
        for i in 0..self.size {
            let first = i.saturating_sub(self.band);
            let (known, rest) = b.split_at_mut(i * width);
            let own = &mut rest[..width];
            for (l, row) in self.row(i, first, i).iter().zip(known[first * width..].chunks_exact(width)) {
                own.iter_mut().zip(row).for_each(|(sum, value)| *sum -= l * value);
            }
            let pivot = self.get(i, i);
            own.iter_mut().for_each(|sum| *sum /= pivot);
        }
    }

    /// log |L Lᵀ| of a factor L.
    pub(crate) fn log_determinant(&self) -> f64 {
        2.0 * (0..self.size).map(|i| libm::log(self.get(i, i))).sum::<f64>()
    }

    /// Every entry times `factor`.
    pub(crate) fn scale(&mut self, factor: f64) {
        self.rows.iter_mut().for_each(|entry| *entry *= factor);
    }

    /// L⁻ᵀ b, of a factor, in place.
    pub(crate) fn backward(&self, b: &mut [f64]) {
        for i in (0..self.size).rev() {
            let first = i.saturating_sub(self.band);
            b[i] /= self.get(i, i);
            let x = b[i];
            for (value, l) in b[first..i].iter_mut().zip(self.row(i, first, i)) {
                *value -= l * x;
            }
        }
    }

    /// The band of (L Lᵀ)⁻¹, of a factor.
    ///
    /// Source: Takahashi, Fagan, Chin 1973: Z = L⁻ᵀ D⁻¹ + (1 − Lᵀ) Z with unit L, from the last row up.
    pub(crate) fn inverse_band(&self) -> Banded {
        let mut z = Banded::zeros(self.size, self.band);
        for j in (0..self.size).rev() {
            let last = (j + self.band).min(self.size - 1);
            let diagonal = self.get(j, j);
            let column: Vec<f64> = (j + 1..=last).map(|k| self.get(k, j)).collect();
            for i in (j..=last).rev() {
                let sum: f64 = column.iter().zip(j + 1..).map(|(l, k)| l * z.get(i, k)).sum();
                let own = if i == j { 1.0 / diagonal } else { 0.0 };
                z.add(i, j, (own - sum) / diagonal);
            }
        }
        z
    }
}

#[inline]
fn dot(a: &[f64], b: &[f64]) -> f64 {
    // two accumulators: one chain of additions would wait for itself
    let (mut even, mut odd) = (0.0, 0.0);
    let (pairs, rest) = a.split_at(a.len() & !1);
    for (x, y) in pairs.chunks_exact(2).zip(b.chunks_exact(2)) {
        even += x[0] * y[0];
        odd += x[1] * y[1];
    }
    even + odd + rest.first().zip(b.get(pairs.len())).map_or(0.0, |(x, y)| x * y)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Second differences plus 1: entries −1, 3, −1.
    fn example(size: usize) -> Banded {
        let mut a = Banded::zeros(size, 2);
        for i in 0..size {
            a.add(i, i, 3.0);
            if i > 0 {
                a.add(i, i - 1, -1.0);
            }
            if i > 1 {
                a.add(i, i - 2, 0.25);
            }
        }
        a
    }

    #[test]
    fn solves_and_inverts_inside_its_band() {
        let (a, n) = (example(9), 9);
        let mut factor = a.clone();
        assert!(factor.factor());
        let z = factor.inverse_band();
        for j in 0..n {
            let mut column = vec![0.0; n];
            column[j] = 1.0;
            factor.forward(&mut column, 1);
            factor.backward(&mut column);
            for i in 0..n {
                let product: f64 = (0..n).map(|k| a.get(i, k) * column[k]).sum();
                assert!((product - if i == j { 1.0 } else { 0.0 }).abs() < 1e-15);
                if i.abs_diff(j) <= 2 {
                    assert!((z.get(i, j) - column[i]).abs() < 1e-15);
                }
            }
        }
    }

    #[test]
    fn a_matrix_that_is_not_positive_has_no_factor() {
        let mut a = example(4);
        a.add(3, 3, -3.0);
        assert!(!a.factor());
    }
}

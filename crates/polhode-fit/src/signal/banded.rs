//! Symmetric positive matrices with a narrow band: Cholesky factor, substitutions, and the band of the inverse.
//!
//! Columns are padded with zeros to whole registers, so that a column is added to another without a test of its length.

use core::ops::Range;

use multiversion::multiversion;

use crate::signal::zeros::zeros;

/// Numbers in a register of the widest processors.
pub(crate) const REGISTER: usize = 8;

/// The lower band of a symmetric matrix, or of its factor: column j holds rows j … j + band.
#[derive(Clone, Debug)]
pub(crate) struct Banded {
    size: usize,
    band: usize,
    /// Room of a column.
    pitch: usize,
    columns: Vec<f64>,
}

impl Banded {
    pub(crate) fn zeros(size: usize, band: usize) -> Self {
        let pitch = pitch(band);
        Banded { size, band, pitch, columns: zeros(size * pitch) }
    }

    /// Where entry (i, j) stands; j ≤ i ≤ j + band.
    #[inline]
    fn at(&self, i: usize, j: usize) -> usize {
        j * self.pitch + i - j
    }

    #[inline]
    pub(crate) fn get(&self, i: usize, j: usize) -> f64 {
        let (i, j) = if i < j { (j, i) } else { (i, j) };
        if i - j > self.band { 0.0 } else { self.columns[self.at(i, j)] }
    }

    #[inline]
    pub(crate) fn add(&mut self, i: usize, j: usize, value: f64) {
        let at = self.at(i, j);
        self.columns[at] += value;
    }

    /// Column j from its diagonal down to the end of the band, where rows beyond the last are zero.
    #[inline]
    pub(crate) fn column(&self, j: usize) -> &[f64] {
        &self.columns[j * self.pitch..][..self.band + 1]
    }

    /// Column j from its diagonal down, padded with zeros.
    #[inline]
    pub(crate) fn column_mut(&mut self, j: usize) -> &mut [f64] {
        &mut self.columns[j * self.pitch..][..self.pitch]
    }

    /// Its columns before one and those from there on, each set from its own first.
    pub(crate) fn split_mut(&mut self, column: usize) -> [Columns<'_>; 2] {
        let (before, after) = self.columns.split_at_mut(column * self.pitch);
        let own = |columns, first| Columns { first, pitch: self.pitch, columns };
        [own(before, 0), own(after, column)]
    }

    /// All of its columns, as if there were so many before them.
    pub(crate) fn numbered_from(&mut self, first: usize) -> Columns<'_> {
        Columns { first, pitch: self.pitch, columns: &mut self.columns }
    }

    /// Those of a range.
    pub(crate) fn columns(&self, range: Range<usize>) -> Banded {
        let columns = self.columns[range.start * self.pitch..range.end * self.pitch].to_vec();
        Banded { size: range.len(), columns, ..*self }
    }

    pub(crate) fn scale(&mut self, factor: f64) {
        self.columns.iter_mut().for_each(|entry| *entry *= factor);
    }

    /// Replaces the matrix by its Cholesky factor; false where it is not positive.
    pub(crate) fn factor(&mut self) -> bool {
        eliminated(&mut self.columns, self.size, self.pitch, self.band)
    }

    /// L⁻¹ b, of a factor, in place; b has rows of `width` numbers, one for each right-hand side.
    pub(crate) fn forward(&self, b: &mut [f64], width: usize) {
        forward(&self.columns, self.pitch, self.band, b, width);
    }

    /// log |L Lᵀ| of a factor L.
    pub(crate) fn log_determinant(&self) -> f64 {
        let mut product = Product::ONE;
        (0..self.size).for_each(|i| product.multiply(self.get(i, i)));
        2.0 * product.log()
    }

    /// L⁻ᵀ b, of a factor, in place.
    pub(crate) fn backward(&self, b: &mut [f64]) {
        for j in (0..self.size).rev() {
            let column = self.column(j);
            let known: f64 = column[1..].iter().zip(&b[j + 1..]).map(|(l, value)| l * value).sum();
            b[j] = (b[j] - known) / column[0];
        }
    }

    /// The band of (L Lᵀ)⁻¹, of a factor.
    ///
    /// Source: Takahashi, Fagan, Chin 1973: Z = L⁻ᵀ D⁻¹ + (1 − Lᵀ) Z with unit L, from the last row up.
    pub(crate) fn inverse_band(&self) -> Banded {
        Banded { columns: inverse_band(&self.columns, self.pitch, self.band), ..*self }
    }
}

/// L⁻¹ b as [`Banded::forward`] makes it, to the last bit, where the columns of the matrix come block by block, each with the rows of b
/// that belong to it. What is kept is as long as a block and the band.
#[derive(Default)]
pub(crate) struct Forward {
    columns: Vec<f64>,
    rows: Vec<f64>,
    /// Those of the first columns and rows that were handed over.
    done: usize,
}

impl Forward {
    /// The rows of L⁻¹ b that can be told by now, all where these columns are the last; `None` where the matrix is not positive. The columns of
    /// a factor stay as they are.
    pub(crate) fn solved(
        &mut self,
        block: &Banded,
        is_factor: bool,
        b: &[f64],
        is_last: bool,
    ) -> Option<&[f64]> {
        let (pitch, band, width) = (block.pitch, block.band, b.len() / block.size);
        self.columns.drain(..self.done * pitch);
        self.rows.drain(..self.done * width);
        self.columns.extend_from_slice(&block.columns);
        self.rows.extend_from_slice(b);
        let count = self.columns.len() / pitch;
        self.done = if is_last { count } else { count.saturating_sub(band) / PIVOTS * PIVOTS };
        if !is_factor && !eliminated(&mut self.columns, self.done, pitch, band) {
            return None;
        }
        forward(&self.columns[..self.done * pitch], pitch, band, &mut self.rows, width);
        Some(&self.rows[..self.done * width])
    }
}

/// Some columns of a matrix one beside the other.
pub(crate) struct Columns<'a> {
    first: usize,
    pitch: usize,
    columns: &'a mut [f64],
}

impl Columns<'_> {
    /// Column j of the matrix from its diagonal down, padded with zeros.
    #[inline]
    pub(crate) fn column_mut(&mut self, j: usize) -> &mut [f64] {
        &mut self.columns[(j - self.first) * self.pitch..][..self.pitch]
    }
}

/// Room for a column: the band in whole registers.
const fn pitch(band: usize) -> usize {
    (band + 1).div_ceil(REGISTER) * REGISTER
}

/// log |A| and eᵀ A⁻¹ e of a matrix whose columns are asked for once each, in their order; `None` where it is not positive.
///
/// What is at work is as long as the band, so that nothing of the size of the matrix is kept.
pub(crate) fn likelihood(band: usize, e: &[f64], column: impl Fn(usize, &mut [f64])) -> Option<(f64, f64)> {
    let pitch = pitch(band);
    // as many columns as pivots reach are at work; they move to the front when the room behind them is used up
    let room = (8 * (band + PIVOTS)).min(e.len().max(1));
    let mut columns = vec![0.0; room * pitch];
    let mut rest: Vec<f64> = e.to_vec();
    let (mut determinant, mut squares) = (Product::ONE, 0.0);
    let (mut first, mut loaded) = (0, 0);
    for j in (0..e.len()).step_by(PIVOTS) {
        let pivots = PIVOTS.min(e.len() - j);
        let end = (j + pivots + band).min(e.len());
        if end - first > room {
            columns.copy_within((j - first) * pitch..(loaded - first) * pitch, 0);
            first = j;
        }
        while loaded < end {
            let own = &mut columns[(loaded - first) * pitch..][..pitch];
            own.fill(0.0);
            column(loaded, own);
            loaded += 1;
        }
        let reached = &mut columns[(j - first) * pitch..(end - first) * pitch];
        if !eliminate(reached, pitch, pivots, band) {
            return None;
        }
        for (k, own) in reached.chunks_exact(pitch).take(pivots).enumerate() {
            let value = rest[j + k] / own[0];
            for (sum, l) in rest[j + k + 1..].iter_mut().zip(&own[1..=band]) {
                *sum -= l * value;
            }
            squares += value * value;
            determinant.multiply(own[0]);
        }
    }
    Some((2.0 * determinant.log(), squares))
}

/// Numbers of several matrices side by side.
#[derive(Clone, Copy)]
#[repr(align(64))]
pub(crate) struct Several(pub(crate) [f64; REGISTER]);

/// The same as [`likelihood`] of several matrices with one band, an entry of each beside those of the others; each with the bits that it has
/// alone.
pub(crate) fn likelihoods(
    band: usize,
    e: &[f64],
    column: impl Fn(usize, &mut [Several]),
) -> [Option<(f64, f64)>; REGISTER] {
    const ZERO: Several = Several([0.0; REGISTER]);
    // zeros behind a column for the pivots before it
    let pitch = band + PIVOTS;
    // ones on the diagonal behind the last column, up to whole steps, change nothing
    let size = e.len().div_ceil(PIVOTS) * PIVOTS;
    let room = (4 * pitch).min(size);
    let (mut columns, mut right) = (vec![ZERO; room * pitch], vec![ZERO; room + pitch]);
    let (mut determinants, mut squares) = ([Product::ONE; REGISTER], [0.0; REGISTER]);
    let mut is_positive = [true; REGISTER];
    let (mut first, mut loaded) = (0, 0);
    for j in (0..size).step_by(PIVOTS) {
        let end = (j + pitch).min(size);
        if end - first > room {
            columns.copy_within((j - first) * pitch..(loaded - first) * pitch, 0);
            right.copy_within(j - first..loaded - first, 0);
            first = j;
        }
        while loaded < end {
            let own = &mut columns[(loaded - first) * pitch..][..pitch];
            own.fill(ZERO);
            match e.get(loaded) {
                Some(_) => column(loaded, own),
                None => own[0] = Several([1.0; REGISTER]),
            }
            right[loaded - first] = Several([e.get(loaded).copied().unwrap_or(0.0); REGISTER]);
            loaded += 1;
        }
        let own = &mut columns[(j - first) * pitch..(end - first) * pitch];
        let right = &mut right[j - first..][..pitch];
        eliminate_several(own, right, pitch, &mut is_positive);
        if is_positive == [false; REGISTER] {
            return [None; REGISTER];
        }
        for (own, value) in own.chunks_exact(pitch).zip(right).take(PIVOTS) {
            for lane in 0..REGISTER {
                squares[lane] += value.0[lane] * value.0[lane];
                determinants[lane].multiply(own[0].0[lane]);
            }
        }
    }
    core::array::from_fn(|k| is_positive[k].then(|| (2.0 * determinants[k].log(), squares[k])))
}

/// The logarithm of a product, of which few are taken.
#[derive(Clone, Copy)]
struct Product {
    log: f64,
    rest: f64,
}

impl Product {
    const ONE: Product = Product { log: 0.0, rest: 1.0 };

    /// By the root of a positive number.
    fn multiply(&mut self, factor: f64) {
        self.rest *= factor;
        // any such root times any number in between is neither zero nor infinite, and exact to rounding
        if !(1e-100..1e100).contains(&self.rest) {
            self.log += libm::log(self.rest);
            self.rest = 1.0;
        }
    }

    fn log(&self) -> f64 {
        self.log + libm::log(self.rest)
    }
}

/// Makes the first `count` columns those of the factor, and takes their parts off the others; false where the matrix is not positive.
fn eliminated(columns: &mut [f64], count: usize, pitch: usize, band: usize) -> bool {
    let size = columns.len() / pitch;
    (0..count).step_by(PIVOTS).all(|j| {
        let pivots = PIVOTS.min(size - j);
        let end = (j + pivots + band).min(size);
        eliminate(&mut columns[j * pitch..end * pitch], pitch, pivots, band)
    })
}

#[multiversion(targets("x86_64+avx512f+avx512dq+avx512vl+fma", "x86_64+avx2+fma"))]
fn forward(columns: &[f64], pitch: usize, band: usize, b: &mut [f64], width: usize) {
    for (j, column) in columns.chunks_exact(pitch).enumerate() {
        let (known, rest) = b[j * width..].split_at_mut(width);
        for value in known.iter_mut() {
            *value /= column[0];
        }
        for (l, row) in column[1..=band].iter().zip(rest.chunks_exact_mut(width)) {
            for (sum, value) in row.iter_mut().zip(&*known) {
                *sum -= l * value;
            }
        }
    }
}

#[multiversion(targets("x86_64+avx512f+avx512dq+avx512vl+fma", "x86_64+avx2+fma"))]
fn inverse_band(columns: &[f64], pitch: usize, band: usize) -> Vec<f64> {
    let (size, width) = (columns.len() / pitch, 2 * band + 1);
    // each column with what stands above its diagonal too, so that it is added as a whole
    let mut both = zeros(size * width);
    let (mut inverse, mut products) = (zeros(columns.len()), vec![0.0; band]);
    for j in (0..size).rev() {
        let (column, after) = (&columns[j * pitch..][..pitch], band.min(size - 1 - j));
        products.fill(0.0);
        for k in 0..after {
            let l = column[1 + k];
            let other = &both[(j + 1 + k) * width + band - k..][..band];
            for (sum, entry) in products.iter_mut().zip(other) {
                *sum += l * entry;
            }
        }
        let mut along = 0.0;
        for (k, product) in products.iter().enumerate().take(after) {
            let entry = -product / column[0];
            along += column[1 + k] * entry;
            inverse[j * pitch + 1 + k] = entry;
            both[j * width + band + 1 + k] = entry;
            both[(j + 1 + k) * width + band - 1 - k] = entry;
        }
        let entry = (1.0 / column[0] - along) / column[0];
        inverse[j * pitch] = entry;
        both[j * width + band] = entry;
    }
    inverse
}

/// Pivots that are taken off the columns after them at once.
const PIVOTS: usize = 3;

/// Makes the first `pivots` columns those of the factor, and takes their parts off the columns after them; false where a pivot is not
/// positive.
#[multiversion(targets("x86_64+avx512f+avx512dq+avx512vl+fma", "x86_64+avx2+fma"))]
fn eliminate(columns: &mut [f64], pitch: usize, pivots: usize, band: usize) -> bool {
    let (own, others) = columns.split_at_mut(pivots * pitch);
    // the columns of the factor with zeros behind them
    let mut padded = [[0.0; WIDEST + 2 * REGISTER]; PIVOTS];
    for (k, padded) in padded.iter_mut().enumerate().take(pivots) {
        let (column, later) = own[k * pitch..].split_at_mut(pitch);
        let pivot = column[0];
        // nor is one that is no number
        let is_positive = pivot > 0.0;
        if !is_positive {
            return false;
        }
        let root = pivot.sqrt();
        let inverse = 1.0 / root;
        for (entry, padded) in column.iter_mut().zip(padded.iter_mut()) {
            *entry *= inverse;
            *padded = *entry;
        }
        column[0] = root;
        for (apart, other) in (1..=band).zip(later.chunks_exact_mut(pitch)) {
            let l = padded[apart];
            for (sum, source) in other.iter_mut().zip(&padded[apart..]) {
                *sum -= l * source;
            }
        }
    }
    // a column at a time with all pivots, in their order; what is not there is zero
    for (k, other) in others.chunks_exact_mut(pitch).enumerate() {
        let used = (band - k).div_ceil(REGISTER) * REGISTER;
        // no closures: they would not be compiled for wide registers
        let apart = [k + pivots, k + pivots - 1.min(pivots), k + pivots - 2.min(pivots)];
        let first = &padded[0][apart[0]..apart[0] + used];
        let second = &padded[1][apart[1]..apart[1] + used];
        let third = &padded[2][apart[2]..apart[2] + used];
        let l = [first[0], second[0], third[0]];
        let (first, second, third) =
            (first.chunks_exact(REGISTER), second.chunks_exact(REGISTER), third.chunks_exact(REGISTER));
        let each = other[..used].chunks_exact_mut(REGISTER).zip(first).zip(second).zip(third);
        for (((sums, first), second), third) in each {
            for lane in 0..REGISTER {
                let mut sum = sums[lane];
                sum -= l[0] * first[lane];
                sum -= l[1] * second[lane];
                sum -= l[2] * third[lane];
                sums[lane] = sum;
            }
        }
    }
    true
}

/// a − b c.
#[inline(always)]
fn less(a: Several, b: Several, c: Several) -> Several {
    let mut rest = a;
    for lane in 0..REGISTER {
        rest.0[lane] -= b.0[lane] * c.0[lane];
    }
    rest
}

/// a b.
#[inline(always)]
fn times(a: Several, b: Several) -> Several {
    let mut product = a;
    for lane in 0..REGISTER {
        product.0[lane] *= b.0[lane];
    }
    product
}

/// The root of a pivot, and one over it.
#[inline(always)]
fn root(pivot: Several, is_positive: &mut [bool; REGISTER]) -> (Several, Several) {
    let (mut root, mut inverse) = (pivot, pivot);
    for (lane, is_positive) in is_positive.iter_mut().enumerate() {
        *is_positive &= pivot.0[lane] > 0.0;
        root.0[lane] = pivot.0[lane].sqrt();
        inverse.0[lane] = 1.0 / root.0[lane];
    }
    (root, inverse)
}

/// The number of a right-hand side that belongs to a pivot.
#[inline(always)]
fn over(a: Several, root: Several) -> Several {
    let mut quotient = a;
    for lane in 0..REGISTER {
        quotient.0[lane] /= root.0[lane];
    }
    quotient
}

/// The same of the first columns of several matrices and of their right-hand sides.
#[multiversion(targets("x86_64+avx512f+avx512dq+avx512vl+fma", "x86_64+avx2+fma"))]
fn eliminate_several(
    columns: &mut [Several],
    right: &mut [Several],
    pitch: usize,
    is_positive: &mut [bool; REGISTER],
) {
    let (own, others) = columns.split_at_mut(PIVOTS * pitch);
    let (a, rest) = own.split_at_mut(pitch);
    let (b, c) = rest.split_at_mut(pitch);
    // the pivots, each less the parts of those before it
    let (root_a, per_a) = root(a[0], is_positive);
    let (l_ab, l_ac) = (times(a[1], per_a), times(a[2], per_a));
    let (root_b, per_b) = root(less(b[0], l_ab, l_ab), is_positive);
    let l_bc = times(less(b[1], l_ab, l_ac), per_b);
    let (root_c, per_c) = root(less(less(c[0], l_ac, l_ac), l_bc, l_bc), is_positive);
    let of_a = over(right[0], root_a);
    let of_b = over(less(right[1], l_ab, of_a), root_b);
    let of_c = over(less(less(right[2], l_ac, of_a), l_bc, of_b), root_c);
    (a[0], a[1], a[2], b[0], b[1], c[0]) = (root_a, l_ab, l_ac, root_b, l_bc, root_c);
    (right[0], right[1], right[2]) = (of_a, of_b, of_c);
    // a row at a time
    let rows = a[3..].iter_mut().zip(&mut b[2..]).zip(&mut c[1..]).zip(&mut right[3..]);
    for (((a, b), c), right) in rows {
        *a = times(*a, per_a);
        *b = times(less(*b, *a, l_ab), per_b);
        *c = times(less(less(*c, *a, l_ac), *b, l_bc), per_c);
        *right = less(less(less(*right, *a, of_a), *b, of_b), *c, of_c);
    }
    for (k, other) in others.chunks_exact_mut(pitch).enumerate() {
        let (a, b, c) = (&a[k + 3..], &b[k + 2..], &c[k + 1..]);
        let (l_a, l_b, l_c) = (a[0], b[0], c[0]);
        for (((sum, a), b), c) in other.iter_mut().zip(a).zip(b).zip(c) {
            *sum = less(less(less(*sum, l_a, *a), l_b, *b), l_c, *c);
        }
    }
}

/// Widest column.
const WIDEST: usize = 64;

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

    /// Rows and columns that come block by block are solved for as those of the whole, to the last bit, also by blocks shorter than the band.
    #[test]
    fn blocks_are_solved_for_as_the_whole() {
        let (a, b) = (example(15), (0..30).map(|k| f64::from(k * k % 7) - 2.6).collect::<Vec<f64>>());
        let (mut factor, mut expected) = (a.clone(), b.clone());
        assert!(factor.factor());
        factor.forward(&mut expected, 2);
        for (together, is_factor) in [(1, false), (3, false), (4, false), (15, false), (1, true), (4, true)] {
            let (mut forward, mut found) = (Forward::default(), Vec::new());
            for first in (0..15).step_by(together) {
                let own = first..15.min(first + together);
                let block = if is_factor { &factor } else { &a }.columns(own.clone());
                let rows = &b[2 * own.start..2 * own.end];
                found.extend_from_slice(forward.solved(&block, is_factor, rows, own.end == 15).unwrap());
            }
            assert_eq!(found, expected, "{together} {is_factor}");
        }
        // the last pivot is zero
        let mut singular = Banded::zeros(2, 1);
        for (i, j) in [(0, 0), (1, 0), (1, 1)] {
            singular.add(i, j, 1.0);
        }
        assert!(Forward::default().solved(&singular, false, &[1.0, 1.0], true).is_none());
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
    fn the_likelihood_is_that_of_the_factor() {
        for (size, band) in [(9, 2), (200, 2), (60, 23), (7, 9)] {
            let entry =
                |i: usize, j: usize| if i == j { 2.5 } else { 0.4 / (1 + i * j + i.abs_diff(j)) as f64 };
            let mut factor = Banded::zeros(size, band);
            for j in 0..size {
                (j..size.min(j + band + 1)).for_each(|i| factor.add(i, j, entry(i, j)));
            }
            let e: Vec<f64> = (0..size).map(|i| 1.0 + (i % 5) as f64).collect();
            let column = |j: usize, into: &mut [f64]| {
                (j..size.min(j + band + 1)).for_each(|i| into[i - j] = entry(i, j));
            };
            let (determinant, squares) = likelihood(band, &e, column).unwrap_or_default();
            assert!(factor.factor());
            let mut white = e.clone();
            factor.forward(&mut white, 1);
            let expected: f64 = white.iter().map(|w| w * w).sum();
            assert!((determinant / factor.log_determinant() - 1.0).abs() < 1e-14, "{size} {band}");
            assert!((squares / expected - 1.0).abs() < 1e-14, "{size} {band}");
        }
        assert!(likelihood(2, &[1.0; 4], |j, into| into[0] = 2.0 - j as f64).is_none());
    }

    /// Also where some of them are not positive.
    #[test]
    fn several_likelihoods_have_the_bits_of_each() {
        for (size, band) in [(9, 2), (200, 2), (61, 23), (250, 26), (7, 9), (2, 5)] {
            let entry = |lane: usize, i: usize, j: usize| match i == j {
                true => 2.5 + lane as f64 - if lane == 3 && i > 5 { 7.0 } else { 0.0 },
                false => 0.4 / (1 + i * j + lane + i.abs_diff(j)) as f64,
            };
            let e: Vec<f64> = (0..size).map(|i| 1.0 + (i % 5) as f64).collect();
            let together = likelihoods(band, &e, |j, into| {
                (j..size.min(j + band + 1)).for_each(|i| {
                    (0..REGISTER).for_each(|lane| into[i - j].0[lane] = entry(lane, i, j));
                });
            });
            for (lane, found) in together.into_iter().enumerate() {
                let alone = likelihood(band, &e, |j, into| {
                    (j..size.min(j + band + 1)).for_each(|i| into[i - j] = entry(lane, i, j));
                });
                assert_eq!(found, alone, "{size} {band} {lane}");
                assert_eq!(found.is_none(), lane == 3 && size > 6, "{size} {band} {lane}");
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

//! Weak-form estimation of nonlinear dynamics (WENDy): the weak form with errors in variables.
//!
//! Test functions φ(u) = exp(−9/(1 − u²)), equations −∫ φ' J ω + ∫ φ ω × J ω = 0 by the trapezoidal rule, ordinary least
//! squares first, then least squares weighted by the covariance of the residuals, linearised about the samples as they
//! are and about the last answer, until the answer rests.
//!
//! As published, the test functions have four widths, each twice the one before, and are replaced by their leading right singular
//! vectors, as many as the corner of the sum of singular values says. With one width they stay as they are.
//!
//! Source: D. M. Bortz, D. A. Messenger, V. Dukic, Bull. Math. Biol. 85 (2023) 110, doi 10.1007/s11538-023-01208-6.

use multiversion::multiversion;
use nalgebra::{DMatrix, Matrix3, Matrix5, Vector3, Vector5};

use super::Answer;
use super::coordinates::{basis, tensor};
use super::euler::cross_derivative;
use super::record::Stretch;

/// Test functions for each radius where there is one.
const PER_RADIUS: f64 = 6.0;
/// Where there are several. Centres as dense at each width as the width is large weigh the widths as equally dense ones of norm 1.
const OF_SEVERAL: f64 = 3.0;
/// Several radii over the smallest.
const WIDTHS: [f64; 4] = [1.0, 2.0, 4.0, 8.0];
/// Fewest combinations of test functions: twice the coordinates.
const FEWEST: usize = 10;
const ROUNDS: usize = 20;
/// Standard deviations of a coordinate between two points of a difference quotient of the likelihood.
const APART: f64 = 0.2;
/// Combinations, or rows of a matrix, that are worked on together.
const FEW: usize = 8;
/// Step, in standard deviations, that ends the rounds, and the search for the largest likelihood.
const NEAR: f64 = 1e-2;

/// A test function on the samples that it sees: values and slopes, times the weights of the trapezoidal rule.
struct Test {
    first: usize,
    values: Vec<f64>,
    slopes: Vec<f64>,
}

/// Coefficients of one combination of test functions.
type Combination = Vec<f64>;

/// The weak equations of a record.
struct Weak {
    /// Of each stretch: how many test functions, and what their residuals' covariance is made of.
    shared: Vec<(usize, Vec<Shared>)>,
    /// Orthonormal ones that take the place of the test functions, if any do.
    combinations: Vec<Option<Vec<Combination>>>,
    equations: Vec<Vec<[f64; 6]>>,
}

impl Weak {
    fn new(stretches: &[Stretch], radius: f64) -> Self {
        let tests: Vec<Vec<Test>> = stretches.iter().map(|s| tests(s, radius, PER_RADIUS)).collect();
        let equations = stretches.iter().zip(&tests).map(|(s, t)| equations(s, t)).collect();
        let shared = stretches.iter().zip(&tests).map(|(s, t)| (t.len(), shared(s, t))).collect();
        Weak { shared, combinations: tests.iter().map(|_| None).collect(), equations }
    }

    /// Of several widths, from `radius` on.
    fn of_several(stretches: &[Stretch], radius: f64) -> Self {
        let (mut all, mut combinations, mut all_equations) = (Vec::new(), Vec::new(), Vec::new());
        for s in stretches {
            let mut several: Vec<Test> =
                WIDTHS.iter().flat_map(|width| tests(s, radius * width, OF_SEVERAL)).collect();
            several.sort_by_key(|test| test.first);
            let leading = leading(&several);
            let rows = equations(s, &several);
            let combined = |combination: &Combination, c: usize| {
                let mut sum = [0.0; 6];
                for (factor, row) in combination.iter().zip(rows.iter().skip(c).step_by(3)) {
                    (0..6).for_each(|k| sum[k] += factor * row[k]);
                }
                sum
            };
            all_equations.push(leading.iter().flat_map(|v| (0..3).map(|c| combined(v, c))).collect());
            combinations.push(Some(leading));
            all.push((several.len(), shared(s, &several)));
        }
        Weak { shared: all, combinations, equations: all_equations }
    }

    /// The equations whitened by their covariance at `x`, and the logarithm of its determinant.
    fn whitened(&self, x: &Vector5<f64>) -> Option<(Vec<Vec<[f64; 6]>>, f64)> {
        let (mut whitened, mut determinant) = (Vec::with_capacity(self.equations.len()), 0.0);
        let parts = self.shared.iter().zip(&self.combinations).zip(&self.equations);
        for (((tests, shared), combinations), rows) in parts {
            let mut covariance = covariance(*tests, shared, x);
            if let Some(combinations) = combinations {
                covariance = covariance.of(combinations);
            }
            covariance.factor()?;
            determinant += covariance.log_determinant();
            let mut rows = rows.clone();
            covariance.forward(&mut rows);
            whitened.push(rows);
        }
        Some((whitened, determinant))
    }

    /// Least squares weighted again and again, from `start` or from unweighted ones on, until the answer rests, with its information.
    fn reweighted(&self, start: Option<Vector5<f64>>, sigma: f64) -> Option<(Vector5<f64>, Matrix5<f64>)> {
        let mut x = start.or_else(|| solve(&self.equations).map(|(x, _)| x))?;
        for _ in 0..ROUNDS {
            let (next, information) = solve(&self.whitened(&x)?.0)?;
            let (step, information) = (next - x, information / (sigma * sigma));
            x = next;
            if step.dot(&(information * step)).sqrt() < NEAR {
                return Some((x, information));
            }
        }
        None
    }

    /// Twice the negative logarithm of the likelihood, but for a constant.
    fn cost(&self, x: &Vector5<f64>, sigma: f64) -> Option<f64> {
        let (rows, determinant) = self.whitened(x)?;
        let left = |row: &[f64; 6]| row[5] + (0..5).map(|k| row[k] * x[k]).sum::<f64>();
        let squares: f64 = rows.iter().flatten().map(|row| left(row) * left(row)).sum();
        Some(squares / (sigma * sigma) + determinant)
    }
}

/// With several half widths, from `radius` on. Where the rounds end is not where they begin: with the answer of the widest alone, which
/// takes little time and is found in more noise. `None` where the rounds do not come to rest.
pub(super) fn answer(stretches: &[Stretch], radius: f64, sigma: f64) -> Option<Answer> {
    let start = Weak::new(stretches, radius * WIDTHS[3]).reweighted(None, sigma).map(|(x, _)| x);
    let (x, information) = Weak::of_several(stretches, radius).reweighted(start, sigma)?;
    Answer::constrained(x, information)
}

/// The largest likelihood of the weak residuals, whose covariance depends on the tensor, too (WENDy-MLE): from the answer of least
/// squares by the scoring of Fisher, with difference quotients. `None` where the search does not come to rest.
///
/// Source: N. Rummel, D. A. Messenger, S. Becker, V. Dukic, D. M. Bortz, arXiv 2502.08881 (2025).
pub(super) fn likeliest(stretches: &[Stretch], radius: f64, sigma: f64) -> Option<Answer> {
    let weak = Weak::new(stretches, radius);
    let (mut x, information) = weak.reweighted(None, sigma)?;
    let covariance = information.try_inverse()?;
    for _ in 0..ROUNDS {
        let mut gradient = Vector5::zeros();
        for k in 0..5 {
            let apart = Vector5::ith(k, 0.5 * APART * covariance[(k, k)].sqrt());
            let [after, before] = [x + apart, x - apart].map(|x| weak.cost(&x, sigma));
            gradient[k] = (after? - before?) / (2.0 * apart[k]);
        }
        let step = covariance * gradient * -0.5;
        x += step;
        if step.dot(&(information * step)).sqrt() < NEAR {
            return Answer::constrained(x, information);
        }
    }
    None
}

fn tests(s: &Stretch, radius: f64, per_radius: f64) -> Vec<Test> {
    let count = s.times.len();
    // the widest is as long as the stretch
    let radius = radius.min(0.5 * (s.times[count - 1] - s.times[0]));
    let (start, end) = (s.times[0] + radius, s.times[count - 1] - radius);
    let room = (end - start).max(0.0);
    let centres = (room * per_radius / radius).floor() as usize + 1;
    let weight = |i: usize| {
        let next = s.times[(i + 1).min(count - 1)];
        let last = s.times[i.saturating_sub(1)];
        0.5 * (next - last)
    };
    (0..centres)
        .map(|k| {
            let centre = start + room * k as f64 / (centres - 1).max(1) as f64;
            let first = s.times.partition_point(|t| *t <= centre - radius);
            let last = s.times.partition_point(|t| *t < centre + radius);
            let (mut values, mut slopes) = (Vec::new(), Vec::new());
            for i in first..last {
                let u = (s.times[i] - centre) / radius;
                let width = 1.0 - u * u;
                let value = libm::exp(9.0 - 9.0 / width) * weight(i);
                values.push(value);
                slopes.push(-18.0 * u / (width * width * radius) * value);
            }
            Test { first, values, slopes }
        })
        .collect()
}

/// The leading right singular vectors of the test functions, as combinations of them.
fn leading(tests: &[Test]) -> Vec<Combination> {
    let gram = DMatrix::from_fn(tests.len(), tests.len(), |m, l| {
        let (one, two) =
            if tests[m].first < tests[l].first { (&tests[m], &tests[l]) } else { (&tests[l], &tests[m]) };
        let shared = one.values.iter().skip(two.first - one.first).zip(&two.values);
        shared.map(|(a, b)| a * b).sum::<f64>()
    });
    let eigen = gram.symmetric_eigen();
    let mut order: Vec<usize> = (0..tests.len()).collect();
    order.sort_by(|a, b| eigen.eigenvalues[*b].total_cmp(&eigen.eigenvalues[*a]));
    let singular = |k: usize| eigen.eigenvalues[k].max(0.0).sqrt();
    order.truncate(corner(order.iter().map(|k| singular(*k))).max(FEWEST).min(tests.len()));
    order.iter().map(|&k| eigen.eigenvectors.column(k).iter().map(|u| u / singular(k)).collect()).collect()
}

/// How many singular values lie before the corner of their sums: two straight lines through the first, that and the last are nearest to
/// the sums.
fn corner(singular: impl Iterator<Item = f64>) -> usize {
    let mut sum = 0.0;
    let sums: Vec<f64> = singular
        .map(|value| {
            sum += value;
            sum
        })
        .collect();
    let off = |from: usize, to: usize| -> f64 {
        let slope = (sums[to] - sums[from]) / (to - from).max(1) as f64;
        (from..=to).map(|i| (1.0 - (sums[from] + slope * (i - from) as f64) / sums[i]).abs()).sum()
    };
    let last = sums.len() - 1;
    let all = (0..=last).map(|k| off(0, k) + off(k, last));
    1 + all.enumerate().min_by(|a, b| a.1.total_cmp(&b.1)).map_or(last, |(k, _)| k)
}

fn equations(s: &Stretch, tests: &[Test]) -> Vec<[f64; 6]> {
    let bases: [Matrix3<f64>; 6] =
        core::array::from_fn(|k| if k < 5 { basis(k) } else { Matrix3::identity() / 3.0 });
    let mut rows = vec![[0.0; 6]; 3 * tests.len()];
    for (m, test) in tests.iter().enumerate() {
        for (n, (value, slope)) in test.values.iter().zip(&test.slopes).enumerate() {
            let w = s.rates[test.first + n];
            for (k, b) in bases.iter().enumerate() {
                let product = b * w;
                let part = w.cross(&product) * *value - product * *slope;
                (0..3).for_each(|c| rows[3 * m + c][k] += part[c]);
            }
        }
    }
    rows
}

/// Sums over the samples that two test functions φ and ψ share.
struct Shared {
    /// Places of the two.
    pair: (usize, usize),
    /// φ ψ ω_a ω_b: of xx, yy, zz, xy, xz, yz.
    second: [f64; 6],
    /// φ ψ' ω, φ' ψ ω.
    first: [Vector3<f64>; 2],
    /// φ' ψ'.
    zeroth: f64,
}

fn shared(s: &Stretch, tests: &[Test]) -> Vec<Shared> {
    let mut all = Vec::new();
    for (m, test) in tests.iter().enumerate() {
        let last = test.first + test.values.len();
        for (l, other) in tests.iter().enumerate().skip(m).take_while(|(_, other)| other.first < last) {
            let shift = other.first - test.first;
            let one = test.values[shift..].iter().zip(&test.slopes[shift..]);
            let two = other.values.iter().zip(&other.slopes);
            let mut sums =
                Shared { pair: (m, l), second: [0.0; 6], first: [Vector3::zeros(); 2], zeroth: 0.0 };
            for ((w, (value, slope)), (other_value, other_slope)) in
                s.rates[other.first..].iter().zip(one).zip(two)
            {
                let weighted = w * (value * other_value);
                let products = [
                    weighted.x * w.x,
                    weighted.y * w.y,
                    weighted.z * w.z,
                    weighted.x * w.y,
                    weighted.x * w.z,
                    weighted.y * w.z,
                ];
                sums.second.iter_mut().zip(products).for_each(|(sum, product)| *sum += product);
                sums.first[0] += w * (value * other_slope);
                sums.first[1] += w * (slope * other_value);
                sums.zeroth += slope * other_slope;
            }
            all.push(sums);
        }
    }
    all
}

/// Covariance of the residuals, in units of the variance of a sample: Σ (φ K − φ' J) (ψ K − ψ' J)ᵀ, where K is linear in ω.
fn covariance(tests: usize, shared: &[Shared], x: &Vector5<f64>) -> Banded {
    let j = tensor(x);
    let [a, b, c] = [Vector3::x(), Vector3::y(), Vector3::z()].map(|axis| cross_derivative(&j, &axis));
    let both = |k: &Matrix3<f64>, l: &Matrix3<f64>| k * l.transpose() + l * k.transpose();
    let squares =
        [a * a.transpose(), b * b.transpose(), c * c.transpose(), both(&a, &b), both(&a, &c), both(&b, &c)];
    let [after, before] = [[a, b, c].map(|k| k * j), [a, b, c].map(|k| j * k.transpose())];
    let own = j * j;
    let reach = shared.iter().map(|s| s.pair.1 - s.pair.0 + 1).max().unwrap_or(1);
    let mut sum = Banded::zeros(3 * tests, 3 * reach);
    for s in shared {
        let mut block = own * s.zeroth;
        squares.iter().zip(s.second).for_each(|(square, factor)| block += square * factor);
        for k in 0..3 {
            block -= after[k] * s.first[0][k] + before[k] * s.first[1][k];
        }
        let (m, l) = s.pair;
        for p in 0..3 {
            for q in 0..3 {
                sum.add(3 * l + q, 3 * m + p, block[(p, q)]);
            }
        }
    }
    sum
}

/// The coordinates that leave least of `rows`, and their information.
fn solve(rows: &[Vec<[f64; 6]>]) -> Option<(Vector5<f64>, Matrix5<f64>)> {
    let (mut information, mut right) = (Matrix5::zeros(), Vector5::zeros());
    for row in rows.iter().flatten() {
        let g = Vector5::from_column_slice(&row[..5]);
        information += g * g.transpose();
        right -= g * row[5];
    }
    let x = information.cholesky()?.solve(&right);
    x.iter().all(|v| v.is_finite()).then_some((x, information))
}

/// The lower half of a symmetric matrix with a band, and after [`factor`](Banded::factor) its Cholesky factor.
struct Banded {
    size: usize,
    width: usize,
    /// Row by row, the diagonal last.
    entries: Vec<f64>,
}

impl Banded {
    fn zeros(size: usize, width: usize) -> Self {
        Banded { size, width, entries: vec![0.0; size * (width + 1)] }
    }

    fn place(&self, row: usize, column: usize) -> usize {
        row * (self.width + 1) + self.width + column - row
    }

    /// Adds to an entry of the lower half; one of the upper half stands there already.
    fn add(&mut self, row: usize, column: usize, value: f64) {
        if row >= column {
            let place = self.place(row, column);
            self.entries[place] += value;
        }
    }

    /// The covariance of combinations of the test functions, the whole lower half.
    fn of(&self, combinations: &[Combination]) -> Banded {
        let (size, count) = (3 * combinations.len(), self.size / 3);
        // the lower half with half of the diagonal, times the combinations from the left and then from the right
        let mut left = vec![vec![0.0; self.size]; size];
        // a few combinations at a time, whose sums stay near the processor
        for (chunk, some) in combinations.chunks(FEW).enumerate() {
            let left = &mut left[3 * FEW * chunk..][..3 * some.len()];
            from_left(&self.entries, self.width, some, left);
        }
        let across: Vec<Vec<f64>> = (0..count).map(|k| combinations.iter().map(|c| c[k]).collect()).collect();
        let mut result = Banded::zeros(size, size - 1);
        let mut sums = vec![0.0; FEW * size];
        for (chunk, left) in left.chunks(FEW).enumerate() {
            from_right(left, &across, &mut sums);
            for (row, sums) in sums.chunks_exact(size).take(left.len()).enumerate() {
                let row = FEW * chunk + row;
                for column in 0..size {
                    let half = sums[column % 3 * combinations.len() + column / 3];
                    let (low, high) = (row.min(column), row.max(column));
                    result.add(high, low, if low == high { 2.0 * half } else { half });
                }
            }
        }
        result
    }

    /// `None` where the matrix is not positive.
    fn factor(&mut self) -> Option<()> {
        factor(&mut self.entries, self.size, self.width).then_some(())
    }

    /// Of the matrix, once it is factored.
    fn log_determinant(&self) -> f64 {
        (0..self.size).map(|i| 2.0 * libm::log(self.entries[self.place(i, i)])).sum()
    }

    /// L⁻¹ times the rows.
    fn forward(&self, rows: &mut [[f64; 6]]) {
        for i in 0..self.size {
            let (before, rest) = rows.split_at_mut(i);
            let first = i.saturating_sub(self.width);
            for (k, other) in before.iter().enumerate().skip(first) {
                let factor = self.entries[self.place(i, k)];
                (0..6).for_each(|c| rest[0][c] -= factor * other[c]);
            }
            let diagonal = self.entries[self.place(i, i)];
            rest[0] = rest[0].map(|v| v / diagonal);
        }
    }
}

/// Adds the rows of the lower half of a band, with half of the diagonal, times the combinations to `left`: three rows for each.
#[multiversion(targets("x86_64+avx512f+avx512dq+avx512vl+fma", "x86_64+avx2+fma"))]
fn from_left(entries: &[f64], width: usize, combinations: &[Combination], left: &mut [Vec<f64>]) {
    for (row, entries) in entries.chunks_exact(width + 1).enumerate() {
        let first = row.saturating_sub(width);
        let entries = &entries[width + first - row..];
        let (before, diagonal) = (&entries[..row - first], 0.5 * entries[row - first]);
        for (a, combination) in combinations.iter().enumerate() {
            let factor = combination[row / 3];
            let sums = &mut left[3 * a + row % 3];
            for (sum, entry) in sums[first..row].iter_mut().zip(before) {
                *sum += factor * entry;
            }
            sums[row] += factor * diagonal;
        }
    }
}

/// For each row of `left`, x by x, y by y and z by z, its product with every combination, whose coefficients are given by test function.
#[multiversion(targets("x86_64+avx512f+avx512dq+avx512vl+fma", "x86_64+avx2+fma"))]
fn from_right(left: &[Vec<f64>], across: &[Vec<f64>], sums: &mut [f64]) {
    sums.fill(0.0);
    for (k, coefficients) in across.iter().enumerate() {
        let count = coefficients.len();
        for (left, sums) in left.iter().zip(sums.chunks_exact_mut(3 * count)) {
            for (factor, sums) in left[3 * k..3 * k + 3].iter().zip(sums.chunks_exact_mut(count)) {
                for (sum, coefficient) in sums.iter_mut().zip(coefficients) {
                    *sum += factor * coefficient;
                }
            }
        }
    }
}

/// The Cholesky factor in place of the lower half of a band; false where it is not positive.
#[multiversion(targets("x86_64+avx512f+avx512dq+avx512vl+fma", "x86_64+avx2+fma"))]
fn factor(entries: &mut [f64], size: usize, width: usize) -> bool {
    let stride = width + 1;
    // the columns of the factor from the diagonal on: what is taken off a row lies side by side there
    let mut columns = vec![0.0; entries.len()];
    for start in (0..size).step_by(FEW) {
        let end = (start + FEW).min(size);
        // a few rows at a time, so that a column that all of them need is fetched once
        for l in start.saturating_sub(width)..end {
            for i in start.max(l)..end.min(l + stride) {
                let column = &mut columns[l * stride..][..=i - l];
                let row = &mut entries[i * stride + width + l - i..(i + 1) * stride];
                if i == l {
                    if row[0].is_nan() || row[0] <= 0.0 {
                        return false;
                    }
                    row[0] = row[0].sqrt();
                    column[0] = row[0];
                    continue;
                }
                let entry = row[0] / column[0];
                row[0] = entry;
                column[i - l] = entry;
                for (sum, other) in row[1..].iter_mut().zip(&column[1..]) {
                    *sum -= entry * other;
                }
            }
        }
    }
    true
}

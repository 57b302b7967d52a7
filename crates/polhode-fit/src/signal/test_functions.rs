//! Test functions of compact support on a stretch of samples, and their weights in sums over samples.

use crate::thresholds::test_functions::{ROUNDED, SAMPLES_PER_TEST, TESTS_PER_RADIUS, TIE};
use core::ops::Range;
use std::sync::Arc;

use multiversion::multiversion;
use nalgebra::{Matrix3, Matrix4, Vector4};

use crate::signal::banded::Banded;
use crate::signal::stretch::Stretch;
use crate::signal::zeros::zeros;

/// The test functions of one stretch: φ = (1 − u²)⁴, u = (t − centre)/radius, centres evenly spaced.
#[derive(Clone, Debug)]
pub(crate) struct TestFunctions {
    first: f64,
    spacing: f64,
    pub(crate) radius: f64,
    pub(crate) count: usize,
    /// How many neighbours on one side a test overlaps.
    pub(crate) reach: usize,
    /// Cubics q(u) of each test, with which φ' + φ q/radius sums by parts exactly: see [`by_parts`].
    corrections: Arc<Corrections>,
    /// ∫ φ_m φ_n dt of tests that are 0, 1, … `reach` apart.
    overlaps: Arc<[f64]>,
}

/// Coefficients of cubics, those of one power side by side and as many zeros behind them as are read together.
#[derive(Clone, Debug)]
struct Corrections([Vec<f64>; 4]);

impl Corrections {
    fn zeros(count: usize) -> Self {
        Corrections(core::array::from_fn(|_| zeros(count + LANES)))
    }
}

impl TestFunctions {
    /// `None` where the stretch is shorter than one test function, or has too few samples for it.
    pub(crate) fn new(stretch: &Stretch, radius: f64) -> Option<TestFunctions> {
        let mut tests = TestFunctions::places(stretch, radius)?;
        tests.overlaps = overlaps(&tests);
        tests.corrections = Arc::new(by_parts(&tests, stretch));
        Some(tests)
    }

    /// The same without what asks for a pass over the samples: how many there are, and where.
    pub(crate) fn places(stretch: &Stretch, radius: f64) -> Option<TestFunctions> {
        let duration = stretch.duration();
        let samples = stretch.times.len() as f64;
        // a radius that was cut from this very duration may exceed half of it by rounding
        if 2.0 * radius > duration * (1.0 + ROUNDED) || samples * 2.0 * radius < SAMPLES_PER_TEST * duration {
            return None;
        }
        let room = (duration - 2.0 * radius).max(0.0);
        // nudged off the ties, so that a change of units cannot change the count
        let steps = (TESTS_PER_RADIUS * room / radius + TIE).round();
        let count = steps as usize + 1;
        let spacing = if count > 1 { room / steps } else { radius };
        let overlap = if count > 1 { (2.0 * radius / spacing - ROUNDED) as usize } else { 0 };
        Some(TestFunctions {
            first: stretch.times[0] + radius,
            spacing,
            radius,
            count,
            reach: overlap.min(count - 1),
            corrections: Arc::new(Corrections::zeros(count)),
            overlaps: Arc::new([]),
        })
    }

    /// u of test `m` at `t`.
    fn position(&self, m: usize, t: f64) -> f64 {
        (t - self.first - m as f64 * self.spacing) / self.radius
    }

    /// The same of test `first` and those after it.
    #[inline(always)]
    fn positions(&self, first: usize, t: f64) -> [f64; LANES] {
        let (from, inverse) = (t - self.first, 1.0 / self.radius);
        let mut u = [0.0; LANES];
        for (k, u) in u.iter_mut().enumerate() {
            *u = (from - (first as f64 + k as f64) * self.spacing) * inverse;
        }
        u
    }

    /// The tests that are not zero at `t`.
    #[inline(always)]
    pub(crate) fn at(&self, t: f64) -> Range<usize> {
        let low = ((t - self.radius - self.first) / self.spacing).ceil().max(0.0) as usize;
        let high = ((t + self.radius - self.first) / self.spacing).floor();
        if high < 0.0 { 0..0 } else { low.min(self.count)..(high as usize + 1).min(self.count) }
    }

    /// Zeros for one number of each test, and behind them for as many as are read together.
    pub(crate) fn room(&self) -> Vec<f64> {
        zeros(self.count + LANES)
    }

    pub(crate) fn centres(&self) -> Vec<f64> {
        (0..self.count).map(|m| self.first + m as f64 * self.spacing).collect()
    }

    /// ∫ φ_m φ_n dt of tests that are 0, 1, … `reach` apart.
    pub(crate) fn overlaps(&self) -> &[f64] {
        &self.overlaps
    }

    /// φ_m at `t`.
    fn value(&self, m: usize, t: f64) -> f64 {
        let u = self.position(m, t);
        let v = (1.0 - u * u).max(0.0);
        v * v * v * v
    }
}

fn overlaps(tests: &TestFunctions) -> Arc<[f64]> {
    // the integrand vanishes with its first seven derivatives at both ends, so that a plain sum is exact to rounding
    const PARTS: usize = 64;
    let step = 2.0 * tests.radius / PARTS as f64;
    let overlap = |apart: usize| {
        let at = |i: usize| tests.first - tests.radius + (i as f64 + 0.5) * step;
        (0..PARTS).map(|i| tests.value(0, at(i)) * tests.value(apart, at(i))).sum::<f64>() * step
    };
    (0..=tests.reach).map(overlap).collect()
}

/// Numbers of Σ w φ u^j, j from 0 to 6, and of Σ w (φ' radius u^j + φ j u^(j−1)), j from 0 to 3.
const SUMS: usize = 11;

/// The cubics q that make Σ w (φ' + φ q/radius) p + Σ w φ p' = 0 for every cubic p.
///
/// It is by this identity that the weak form rests on Euler's equation; a quadrature alone obeys it up to its error,
/// which a short support or irregular times would make a bias.
fn by_parts(tests: &TestFunctions, stretch: &Stretch) -> Corrections {
    let mut sums: [Vec<f64>; SUMS] = core::array::from_fn(|_| tests.room());
    add_powers(tests, stretch, &mut sums);
    let mut corrections = Corrections::zeros(tests.count);
    for m in 0..tests.count {
        let powers = Matrix4::from_fn(|i, k| sums[i + k][m]);
        let right = -Vector4::from_fn(|i, _| sums[7 + i][m]);
        let cubic = powers.cholesky().map_or(Vector4::zeros(), |powers| powers.solve(&right));
        corrections.0.iter_mut().zip(&cubic).for_each(|(of_power, q)| of_power[m] = *q);
    }
    corrections
}

#[multiversion(targets("x86_64+avx512f+avx512dq+avx512vl+fma", "x86_64+avx2+fma"))]
fn add_powers(tests: &TestFunctions, stretch: &Stretch, sums: &mut [Vec<f64>; SUMS]) {
    for (&t, &weight) in stretch.times.iter().zip(&stretch.weights) {
        let first = tests.at(t).start;
        let u = tests.positions(first, t);
        let (mut of_slope, mut of_value) = ([0.0; LANES], [0.0; LANES]);
        for k in 0..LANES {
            let v = (1.0 - u[k] * u[k]).max(0.0);
            let cube = weight * (v * v * v);
            of_value[k] = cube * v;
            of_slope[k] = -8.0 * u[k] * cube;
        }
        let mut power = [1.0; LANES];
        for j in 0..7 {
            let (mut with_value, mut with_slope) = ([0.0; LANES], [0.0; LANES]);
            for k in 0..LANES {
                with_value[k] = of_value[k] * power[k];
                with_slope[k] = of_slope[k] * power[k];
                power[k] *= u[k];
            }
            add(&with_value, 1.0, &mut sums[j][first..first + LANES]);
            if j < 4 {
                add(&with_slope, 1.0, &mut sums[7 + j][first..first + LANES]);
            }
            if j < 3 {
                add(&with_value, (j + 1) as f64, &mut sums[8 + j][first..first + LANES]);
            }
        }
    }
}

#[inline(always)]
fn add(of: &[f64; LANES], number: f64, sums: &mut [f64]) {
    for k in 0..LANES {
        sums[k] += of[k] * number;
    }
}

/// By halves, whole registers at a time.
#[inline(always)]
fn dot(a: &[f64; LANES], b: &[f64]) -> f64 {
    let (mut eight, mut four) = ([0.0; LANES / 2], [0.0; LANES / 4]);
    for k in 0..8 {
        eight[k] = a[k] * b[k] + a[k + 8] * b[k + 8];
    }
    for k in 0..4 {
        four[k] = eight[k] + eight[k + 4];
    }
    (four[0] + four[2]) + (four[1] + four[3])
}

/// Most tests that overlap at one time.
pub(crate) const MOST: usize = 10;
/// Tests that are evaluated together: those, in whole registers.
pub(crate) const LANES: usize = 16;

/// The tests that are not zero at one time, with their φ' and φ; what stands beyond `count` says nothing.
pub(crate) struct Seen {
    pub(crate) first: usize,
    pub(crate) count: usize,
    pub(crate) slope: [f64; LANES],
    pub(crate) value: [f64; LANES],
}

impl Seen {
    // part of loops that are compiled for wide registers
    #[inline(always)]
    pub(crate) fn new(tests: &TestFunctions, t: f64) -> Seen {
        let range = tests.at(t);
        let first = range.start;
        let mut seen = Seen { first, count: range.len().min(MOST), slope: [0.0; LANES], value: [0.0; LANES] };
        let u = tests.positions(first, t);
        let inverse = 1.0 / tests.radius;
        let q = &tests.corrections.0;
        let range = first..first + LANES;
        let (a, b, c, d) = (&q[0][range.clone()], &q[1][range.clone()], &q[2][range.clone()], &q[3][range]);
        for k in 0..LANES {
            let v = (1.0 - u[k] * u[k]).max(0.0);
            let cube = v * v * v;
            let cubic = a[k] + u[k] * (b[k] + u[k] * (c[k] + u[k] * d[k]));
            seen.slope[k] = (v * cubic - 8.0 * u[k]) * cube * inverse;
            seen.value[k] = v * cube;
        }
        seen
    }

    /// Σ φ' and Σ φ times numbers of the tests, with zeros behind them.
    #[inline(always)]
    pub(crate) fn dot(&self, numbers: &[f64]) -> (f64, f64) {
        let own = &numbers[self.first..self.first + LANES];
        (dot(&self.slope, own), dot(&self.value, own))
    }

    /// Each test with its φ' and φ.
    pub(crate) fn each(&self) -> impl Iterator<Item = (usize, f64, f64)> {
        (0..self.count).map(|k| (self.first + k, self.slope[k], self.value[k]))
    }
}

/// The blocks of a symmetric matrix between the tests that are seen together, which most times share with those before them.
pub(crate) struct Blocks<'a> {
    of: &'a Banded,
    seen: Range<usize>,
    /// Of each pair of tests, column by column with zeros behind.
    pairs: Vec<[f64; LANES]>,
}

impl<'a> Blocks<'a> {
    pub(crate) fn of(matrix: &'a Banded) -> Self {
        Blocks { of: matrix, seen: 0..0, pairs: Vec::new() }
    }

    /// Σ over pairs of tests of their blocks, weighted by slope·slope, value·slope and value·value; in the second the row belongs to the
    /// value.
    pub(crate) fn sums(&mut self, seen: &Seen) -> [Matrix3<f64>; 3] {
        let tests = seen.first..seen.first + seen.count;
        if self.seen != tests {
            let pairs = tests.clone().flat_map(|m| tests.clone().map(move |n| (m, n)));
            let block = |(m, n): (usize, usize)| {
                let entry = |k: usize| self.of.get(3 * m + k % 3, 3 * n + k / 3);
                core::array::from_fn(|k| if k < 9 { entry(k) } else { 0.0 })
            };
            self.pairs = pairs.map(block).collect();
            self.seen = tests;
        }
        sums(seen, &self.pairs).map(|sum| Matrix3::from_column_slice(&sum[..9]))
    }
}

#[multiversion(targets("x86_64+avx512f+avx512dq+avx512vl+fma", "x86_64+avx2+fma"))]
fn sums(seen: &Seen, pairs: &[[f64; LANES]]) -> [[f64; LANES]; 3] {
    let (mut with_slopes, mut mixed, mut with_values) = ([0.0; LANES], [0.0; LANES], [0.0; LANES]);
    for (m, row) in pairs.chunks_exact(seen.count.max(1)).enumerate() {
        let (a, b) = (seen.slope[m], seen.value[m]);
        for (n, block) in row.iter().enumerate() {
            let (c, d) = (seen.slope[n], seen.value[n]);
            let (by_slopes, by_both, by_values) = (a * c, b * c, b * d);
            for k in 0..LANES {
                with_slopes[k] += block[k] * by_slopes;
                mixed[k] += block[k] * by_both;
                with_values[k] += block[k] * by_values;
            }
        }
    }
    [with_slopes, mixed, with_values]
}

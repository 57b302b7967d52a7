//! The covariance of the weak equations of one stretch by the noise of the rates and by torque noise: a narrow band.

use core::ops::Range;

use multiversion::multiversion;
use nalgebra::{Matrix3, Vector3};
use polhode::record::both;

use crate::physical::coordinates::ENTRIES;
use crate::signal::banded::{Banded, Columns, REGISTER, Several, likelihood, likelihoods};
use crate::signal::moments::{Group, group, ranges};
use crate::signal::stretch::Stretch;
use crate::signal::terms::{Terms, cross_derivative};
use crate::signal::test_functions::{MOST, Seen, TestFunctions};
use crate::thresholds::radius::LONG;

/// Variances of the noise of the rates and of the torque noise, over the variance of the noise of the record.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Levels {
    pub(crate) white: f64,
    pub(crate) torque: f64,
    pub(crate) shape: Shape,
}

/// Along which axes torque noise acts.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Shape {
    /// As the moments of inertia: J ξ with white ξ, an angular acceleration that is alike along all axes.
    Moments,
    /// Alike along all axes, with the same mean square as the other at a sphere.
    Alike,
}

impl Levels {
    pub(crate) const WHITE: Levels = Levels { white: 1.0, torque: 0.0, shape: Shape::Moments };
}

/// The covariance of the components of torque noise of level 1.
pub(crate) fn torque_shape(shape: Shape, j: &Matrix3<f64>) -> Matrix3<f64> {
    match shape {
        Shape::Moments => j * j,
        Shape::Alike => Matrix3::identity() / 9.0,
    }
}

/// Power spectral density of the angular acceleration that torque noise of level 1 makes: the mean of the three components.
pub(crate) fn acceleration_density(shape: Shape, j: &Matrix3<f64>) -> f64 {
    match shape {
        Shape::Moments => 1.0,
        // a third of the trace of J⁻¹ (1/9) J⁻¹
        Shape::Alike => j.try_inverse().map_or(0.0, |inverse| (inverse * inverse).trace() / 27.0),
    }
}

/// The covariance of the equations of one stretch at any levels of noise.
#[derive(Clone)]
pub(crate) struct Covariance {
    tests: TestFunctions,
    j: Matrix3<f64>,
    /// By the noise of the rates, per its variance.
    noise: Banded,
}

impl Covariance {
    /// Of equations that were linearised at the samples of `stretch` less their `noise`.
    pub(crate) fn new(
        stretch: &Stretch,
        noise: &[Vector3<f64>],
        terms: &Terms,
        tests: &TestFunctions,
    ) -> Self {
        let noise = OfRates::new(stretch, noise, terms, tests).all();
        Covariance { tests: tests.clone(), j: terms.j, noise }
    }

    /// Its factor; `None` where it is not positive, as for a tensor far from physical.
    pub(crate) fn factor(&self, levels: Levels) -> Option<Banded> {
        self.clone().into_factor(levels)
    }

    /// The same, in the place of the covariance.
    pub(crate) fn into_factor(mut self, levels: Levels) -> Option<Banded> {
        if levels != Levels::WHITE {
            let torque = self.of_torque(levels);
            for j in 0..3 * self.tests.count {
                let used = self.used(j);
                let column = self.noise.column_mut(j);
                for (entry, torque) in column[..used].iter_mut().zip(&torque[j % 3]) {
                    *entry = *entry * levels.white + torque;
                }
            }
        }
        self.noise.factor().then_some(self.noise)
    }

    /// log |C| and eᵀ C⁻¹ e of residuals `e`.
    pub(crate) fn likelihood(&self, e: &[f64], levels: Levels) -> Option<(f64, f64)> {
        let torque = self.of_torque(levels);
        likelihood(3 * self.tests.reach + 2, e, |j, into| {
            let each = self.noise.column(j).iter().zip(&torque[j % 3]);
            for (entry, (noise, torque)) in into[..self.used(j)].iter_mut().zip(each) {
                *entry = noise * levels.white + torque;
            }
        })
    }

    /// The same at several levels side by side, none more than there are numbers in a register; the last of them stands for those that are
    /// not there.
    pub(crate) fn likelihoods(&self, e: &[f64], levels: &[Levels]) -> [Option<(f64, f64)>; REGISTER] {
        let Some(last) = levels.last() else { return [None; REGISTER] };
        let each: [Levels; REGISTER] = core::array::from_fn(|k| *levels.get(k).unwrap_or(last));
        let of_each = each.map(|levels| self.of_torque(levels));
        let torque: [Vec<Several>; 3] = [0, 1, 2].map(|q| {
            let row = |row: usize| Several(core::array::from_fn(|k| of_each[k][q][row]));
            (0..3 * self.tests.reach + 3).map(row).collect()
        });
        let white = Several(each.map(|levels| levels.white));
        likelihoods(3 * self.tests.reach + 2, e, |j, into| {
            add_levels(&mut into[..self.used(j)], self.noise.column(j), white, &torque[j % 3]);
        })
    }

    /// Mean variances of the residuals by noise of the rates and by torque noise of level 1.
    pub(crate) fn mean_variances(&self) -> (f64, f64) {
        let size = 3 * self.tests.count;
        let white = (0..size).map(|i| self.noise.get(i, i)).sum::<f64>() / size as f64;
        (white, self.tests.overlaps().first().copied().unwrap_or(0.0) / 9.0)
    }

    /// How many entries of a column the matrix has.
    fn used(&self, column: usize) -> usize {
        (3 * self.tests.count - column).min(3 * self.tests.reach + 3)
    }

    /// What torque noise adds to the columns of each test, from their diagonals down.
    fn of_torque(&self, levels: Levels) -> [Vec<f64>; 3] {
        let shape = torque_shape(levels.shape, &self.j);
        [0, 1, 2].map(|q| {
            let mut column = vec![0.0; 3 * self.tests.reach + 3];
            for (row, overlap) in self.tests.overlaps().iter().enumerate() {
                for p in if row == 0 { q } else { 0 }..3 {
                    column[3 * row + p - q] = levels.torque * shape[(p, q)] * overlap;
                }
            }
            column
        })
    }
}

/// The same column by column, where torque noise has no part in it, and nothing of it is kept.
pub(crate) struct Whites<'a> {
    rates: OfRates<'a>,
    level: f64,
}

impl<'a> Whites<'a> {
    pub(crate) fn new(
        stretch: &'a Stretch,
        noise: &'a [Vector3<f64>],
        terms: &'a Terms,
        tests: &'a TestFunctions,
        level: f64,
    ) -> Self {
        Whites { rates: OfRates::new(stretch, noise, terms, tests), level }
    }

    /// The columns of some tests.
    pub(crate) fn of(&self, own: Range<usize>) -> Banded {
        let mut columns = self.rates.of(own);
        columns.scale(self.level);
        columns
    }
}

/// A column of several matrices: the noise of the rates at each level of it, and torque noise.
#[multiversion(targets("x86_64+avx512f+avx512dq+avx512vl+fma", "x86_64+avx2+fma"))]
fn add_levels(into: &mut [Several], noise: &[f64], white: Several, torque: &[Several]) {
    let (mut entries, mut noise, mut torque) = (into.iter_mut(), noise.iter(), torque.iter());
    // zipped, eight rows would be gathered into the registers in the place of one
    while let (Some(entry), Some(noise), Some(torque)) = (entries.next(), noise.next(), torque.next()) {
        let mut own = *torque;
        for k in 0..REGISTER {
            own.0[k] += noise * white.0[k];
        }
        *entry = own;
    }
}

/// Rows of all tests that overlap at one time, in whole registers.
const ROWS: usize = (3 * MOST).div_ceil(REGISTER) * REGISTER;
/// With as many behind them as are read together.
const ROOM: usize = ROWS + REGISTER;

/// Σ A Aᵀ with A = −φ' J + φ K by pairs of tests.
struct OfRates<'a> {
    stretch: &'a Stretch,
    noise: &'a [Vector3<f64>],
    tests: &'a TestFunctions,
    maker: Maker<'a>,
    groups: Vec<Range<usize>>,
    /// The first group of the second half of a long stretch, and the first test that it sees.
    middle: usize,
    split: usize,
}

impl<'a> OfRates<'a> {
    fn new(
        stretch: &'a Stretch,
        noise: &'a [Vector3<f64>],
        terms: &'a Terms,
        tests: &'a TestFunctions,
    ) -> Self {
        let groups: Vec<Range<usize>> = ranges(stretch, tests.radius, 0).collect();
        let half = if noise.len() > LONG { noise.len() / 2 } else { 0 };
        let middle = groups.partition_point(|range| range.start < half);
        let first = groups.get(middle).filter(|_| middle > 0).map(|range| stretch.times[range.start]);
        let split = first.map_or(0, |first| tests.at(first).start);
        OfRates { stretch, noise, tests, maker: Maker::new(terms), groups, middle, split }
    }

    /// The whole.
    fn all(&self) -> Banded {
        let mut sum = Banded::zeros(3 * self.tests.count, 3 * self.tests.reach + 2);
        // the halves of a long stretch side by side, whatever the machine is
        let [mut before, mut after] = sum.split_mut(3 * self.split);
        both(
            self.split > 0,
            || self.add(&mut before, 0..self.split),
            || self.add(&mut after, self.split..self.tests.count),
        );
        sum
    }

    /// The columns of some tests.
    fn of(&self, own: Range<usize>) -> Banded {
        let mut sum = Banded::zeros(3 * own.len(), 3 * self.tests.reach + 2);
        self.add(&mut sum.numbered_from(3 * own.start), own);
        sum
    }

    /// Adds up the columns of some tests. Each has the groups of the second half before those of the first, whatever is asked for.
    fn add(&self, sum: &mut Columns<'_>, own: Range<usize>) {
        let seen = |sample: usize| self.tests.at(self.stretch.times[sample]);
        let (first, second) = self.groups.split_at(self.middle);
        for groups in [second, first] {
            let from = groups.partition_point(|range| seen(range.end - 1).end <= own.start);
            let groups = groups[from..].iter().take_while(|range| seen(range.start).start < own.end);
            for range in groups {
                let group = group(self.stretch, self.noise, range.clone());
                add_pairs(sum, self.tests, own.clone(), group.time, &self.maker.products(&group));
            }
        }
    }
}

/// J J, J Kᵀ and K Kᵀ of a group of samples.
struct Products {
    jj: Matrix3<f64>,
    jk: Matrix3<f64>,
    kk: Matrix3<f64>,
}

/// What they are made of beside the groups.
struct Maker<'a> {
    terms: &'a Terms,
    jj: Matrix3<f64>,
    pairs: [Matrix3<f64>; 6],
}

impl<'a> Maker<'a> {
    fn new(terms: &'a Terms) -> Self {
        // K is linear in the rate
        let per_rate: [Matrix3<f64>; 3] =
            core::array::from_fn(|a| cross_derivative(&terms.j, &terms.sensor.column(a).into_owned()));
        let pairs = core::array::from_fn(|entry| {
            let (a, b) = ENTRIES[entry];
            let product = per_rate[a] * per_rate[b].transpose();
            if a == b { product } else { product + product.transpose() }
        });
        Maker { terms, jj: terms.j * terms.j, pairs }
    }

    fn products(&self, group: &Group) -> Products {
        let k = self.terms.by_rate(&self.terms.rate(&group.reading), &group.wheel);
        let mut kk = k * k.transpose();
        for (pair, (a, b)) in self.pairs.iter().zip(ENTRIES) {
            kk += pair * group.scatter[(a, b)];
        }
        Products {
            jj: self.jj * group.square,
            jk: self.terms.j * k.transpose() * group.square,
            kk: kk * group.square,
        }
    }
}

/// A column of a matrix again and again, for all tests of a column of blocks.
// no closure: one would not be compiled for wide registers
#[inline(always)]
fn repeated(m: &Matrix3<f64>, column: usize) -> [f64; ROWS] {
    let three = [m[(0, column)], m[(1, column)], m[(2, column)]];
    // three registers hold whole columns
    let mut period = [0.0; 3 * REGISTER];
    for (k, entry) in period.iter_mut().enumerate() {
        *entry = three[k % 3];
    }
    let mut all = [0.0; ROWS];
    for (k, entry) in all.iter_mut().enumerate() {
        *entry = period[k % (3 * REGISTER)];
    }
    all
}

/// Adds A Aᵀ of a group of samples at `time` to the columns of some tests.
#[multiversion(targets("x86_64+avx512f+avx512dq+avx512vl+fma", "x86_64+avx2+fma"))]
fn add_pairs(
    sum: &mut Columns<'_>,
    tests: &TestFunctions,
    own: Range<usize>,
    time: f64,
    products: &Products,
) {
    let Products { jj, jk, kk } = products;
    let kj = jk.transpose();
    let seen = Seen::new(tests, time);
    let rows = 3 * seen.count;
    let [start, end] = [own.start, own.end].map(|test| test.saturating_sub(seen.first).min(seen.count));
    // the blocks of all tests in a column of this one: one multiplies its φ', the other its φ
    let (mut slopes, mut values) = ([0.0; ROWS], [0.0; ROWS]);
    let of_tests = seen.slope.iter().zip(&seen.value).take(seen.count);
    let rows_of_tests = slopes.as_chunks_mut::<3>().0.iter_mut().zip(values.as_chunks_mut::<3>().0);
    for ((slopes, values), (slope, value)) in rows_of_tests.zip(of_tests) {
        (*slopes, *values) = ([*slope; 3], [*value; 3]);
    }
    for q in 0..3 {
        let (jj, kj) = (repeated(jj, q), repeated(&kj, q));
        let (jk, kk) = (repeated(jk, q), repeated(kk, q));
        let (mut by_slope, mut by_value) = ([0.0; ROOM], [0.0; ROOM]);
        for k in 0..ROWS {
            by_slope[k] = kj[k] * values[k] - jj[k] * slopes[k];
            by_value[k] = kk[k] * values[k] - jk[k] * slopes[k];
        }
        for row in start..end {
            let (c, d) = (seen.slope[row], seen.value[row]);
            let from = 3 * row + q;
            // whole registers: behind the last row stand zeros; tests that only touch add nothing
            let registers = (rows - from).div_ceil(REGISTER);
            let values = by_value[from..].as_chunks::<REGISTER>().0;
            let slopes = by_slope[from..].as_chunks::<REGISTER>().0;
            let column = sum.column_mut(3 * (seen.first + row) + q).as_chunks_mut::<REGISTER>().0;
            for ((into, value), slope) in column.iter_mut().zip(values).zip(slopes).take(registers) {
                let mut own = *into;
                for k in 0..REGISTER {
                    own[k] += value[k] * d - slope[k] * c;
                }
                *into = own;
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use polhode::num::Random;

    /// Likelihoods at several levels are those at each, to the last bit; the last level stands for those that are not there. They are those of the
    /// factor.
    #[test]
    fn likelihoods_of_several_levels_are_those_of_each() {
        let mut random = Random::new(7);
        let times: Vec<f64> = (0..201).map(|k| 0.1 * f64::from(k)).collect();
        let stretch = Stretch::new(times, (0..201).map(|_| random.normal_vector()).collect());
        let tests = TestFunctions::new(&stretch, 1.0).unwrap();
        let terms = Terms::at(Matrix3::new(0.2, 0.01, -0.02, 0.01, 0.35, 0.03, -0.02, 0.03, 0.45));
        let covariance = Covariance::new(&stretch, &vec![Vector3::zeros(); 201], &terms, &tests);
        let e: Vec<f64> = (0..3 * tests.count).map(|_| random.normal()).collect();
        let levels = [
            Levels::WHITE,
            Levels { white: 1.7, torque: 0.3, shape: Shape::Moments },
            Levels { white: 0.6, torque: 5.0, shape: Shape::Alike },
        ];
        let found = covariance.likelihoods(&e, &levels);
        for (k, found) in found.into_iter().enumerate() {
            let level = levels[k.min(2)];
            assert_eq!(found, covariance.likelihood(&e, level), "{k}");
            let (determinant, squares) = found.unwrap();
            let factor = covariance.factor(level).unwrap();
            let mut white = e.clone();
            factor.forward(&mut white, 1);
            let expected: f64 = white.iter().map(|w| w * w).sum();
            assert!((squares / expected - 1.0).abs() < 1e-6, "{k}: {squares} {expected}");
            assert!((determinant - factor.log_determinant()).abs() < 1e-9 * (1.0 + determinant.abs()), "{k}");
        }
        assert_eq!(covariance.likelihoods(&e, &[]), [None; REGISTER]);
    }

    /// The columns of some tests are to the last bit what they are among those of all, also where the halves of a long stretch meet.
    #[test]
    fn columns_of_some_tests_are_those_among_all() {
        let mut random = Random::new(8);
        let count = LONG + 50;
        let times: Vec<f64> = (0..count).map(|k| 0.02 * k as f64).collect();
        let stretch = Stretch::new(times, (0..count).map(|_| random.normal_vector()).collect());
        let noise: Vec<Vector3<f64>> = (0..count).map(|_| random.normal_vector() * 0.01).collect();
        let tests = TestFunctions::new(&stretch, 1.0).unwrap();
        let terms = Terms::at(Matrix3::new(0.2, 0.01, -0.02, 0.01, 0.35, 0.03, -0.02, 0.03, 0.45));
        let all = Covariance::new(&stretch, &noise, &terms, &tests).noise;
        let whites = Whites::new(&stretch, &noise, &terms, &tests, 2.0);
        assert!((tests.count / 3..2 * tests.count / 3).contains(&whites.rates.split));
        for together in [1500, tests.count] {
            for first in (0..tests.count).step_by(together) {
                let own = first..tests.count.min(first + together);
                let found = whites.of(own.clone());
                for j in 3 * own.start..3 * own.end {
                    let column = found.column(j - 3 * own.start);
                    assert!(column.iter().zip(all.column(j)).all(|(a, b)| *a == 2.0 * b), "{j}");
                }
            }
        }
    }

    /// Both shapes of torque noise are one at a sphere; a body of unequal moments turns by torques that are alike by the mean of its inverses.
    #[test]
    fn torque_noise_of_both_shapes_is_alike_at_a_sphere() {
        let sphere = Matrix3::identity() / 3.0;
        let [one, other] = [Shape::Moments, Shape::Alike].map(|shape| torque_shape(shape, &sphere));
        assert!((one - other).amax() < 1e-16);
        assert!((acceleration_density(Shape::Alike, &sphere) - 1.0).abs() < 1e-14);
        let j = Matrix3::from_diagonal(&Vector3::new(0.25, 0.25, 0.5));
        // (16 + 16 + 4)/27
        assert!((acceleration_density(Shape::Alike, &j) - 4.0 / 3.0).abs() < 1e-14);
        assert_eq!(acceleration_density(Shape::Moments, &j), 1.0);
        assert_eq!(torque_shape(Shape::Moments, &j).diagonal(), Vector3::new(0.0625, 0.0625, 0.25));
        assert_eq!(acceleration_density(Shape::Alike, &Matrix3::zeros()), 0.0);
    }
}

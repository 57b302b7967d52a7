//! What the writing of a record leaves open: digits, single precision, noise.

use super::{Attitudes, Reading, Trajectory};
use crate::rotation::Vec3;

/// Most rows whose digits are counted.
const MOST: usize = 2000;

/// Digits of a double.
const ALL_DIGITS: u32 = 17;

/// How the numbers of one column, or of all, were written.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Writing {
    pub(super) digits: u32,
    pub(super) single_precision: bool,
    /// Digits behind the point, where all numbers have as many.
    pub(super) decimals: Option<i32>,
}

/// How the numbers of each column were written; a column that is not there has all digits.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Writings {
    pub(super) attitude: Writing,
    pub(super) rates: Writing,
    pub(super) momentum: Writing,
}

impl Writings {
    pub(super) fn of(record: &Trajectory) -> Self {
        let rows = record.times.len();
        let some = || (0..rows).step_by(rows.div_ceil(MOST));
        let of_vectors = |vectors: &Option<Vec<[f64; 3]>>, known| {
            let values = vectors.iter().flat_map(|vectors| some().flat_map(|row| vectors[row])).collect();
            Writing::of(values, known)
        };
        let attitude = record.attitude.iter();
        let attitude =
            attitude.flat_map(|attitude| some().flat_map(|row| attitude.row(row).to_vec())).collect();
        let mut found = Writings {
            attitude: Writing::of(attitude, record.digits.attitude),
            rates: of_vectors(&record.rates, record.digits.rates),
            momentum: of_vectors(&record.momentum, record.digits.momentum),
        };
        // the digits of a vector that stays the same are those of one number: it was written like its neighbours
        let stays = |vectors: &Option<Vec<[f64; 3]>>| {
            vectors.as_ref().is_some_and(|vectors| vectors.windows(2).all(|pair| pair[0] == pair[1]))
        };
        let finest = |own: Writing, others: [(bool, Writing); 2]| {
            let there = others.into_iter().filter(|(is_there, _)| *is_there);
            // with as many digits, though not with as many decimals
            there.fold(own, |a, (_, b)| if a.digits > b.digits { a } else { Writing { decimals: None, ..b } })
        };
        let attitude = (record.attitude.is_some(), found.attitude);
        if stays(&record.rates) {
            found.rates = finest(found.rates, [attitude, (record.momentum.is_some(), found.momentum)]);
        }
        if stays(&record.momentum) {
            found.momentum = finest(found.momentum, [attitude, (record.rates.is_some(), found.rates)]);
        }
        found
    }

    /// The coarsest.
    pub(super) fn coarsest(&self) -> Writing {
        let rank = |writing: &Writing| (writing.digits, u32::from(!writing.single_precision));
        [self.rates, self.momentum]
            .into_iter()
            .fold(self.attitude, |a, b| if rank(&b) < rank(&a) { b } else { a })
    }
}

impl Writing {
    /// Of some `values`, whose digits may be `known`.
    fn of(values: Vec<f64>, known: Option<u32>) -> Self {
        // zeros are written in any number of digits
        let values: Vec<f64> = values.into_iter().filter(|x| *x != 0.0).collect();
        if values.is_empty() {
            return Writing { digits: known.unwrap_or(ALL_DIGITS), single_precision: false, decimals: None };
        }
        let mut counts: Vec<u32> = values.iter().map(|&x| significant_digits(x)).collect();
        counts.sort_unstable();
        // trailing zeros shorten a tenth of the numbers and more
        let longest = counts.get(counts.len() * 98 / 100).copied().unwrap_or(ALL_DIGITS);
        let exact = values.iter().all(|&x| f64::from(x as f32) == x);
        let printed = || values.iter().all(|&x| (x as f32).to_string().parse() == Ok(x));
        // the shortest forms of single precision have up to 9 digits; of 7 any number is one
        let single_precision = (exact && longest > 9) || ((8..=9).contains(&longest) && printed());
        let seen = if longest >= 16 { ALL_DIGITS } else { longest.max(1) };
        let digits = known.unwrap_or(if single_precision { 7 } else { seen });
        Writing { digits, single_precision, decimals: decimals(&values) }
    }

    /// Half a unit of the last place of `x`.
    pub(super) fn half_unit(&self, x: f64) -> f64 {
        let least = 0.5 * f64::EPSILON * x.abs();
        if self.single_precision {
            return 0.5 * f64::from(f32::EPSILON) * x.abs();
        }
        if self.digits >= ALL_DIGITS {
            return least;
        }
        // a zero that is written with significant digits is one
        if x == 0.0 && self.decimals.is_none() {
            return 0.0;
        }
        let places = self.decimals.map_or_else(|| exponent(x) - self.digits as i32 + 1, |places| -places);
        (0.5 * libm::exp10(f64::from(places))).max(least)
    }

    /// What a column of `vectors` may be off, relative to their size: with as many decimals everywhere, each component by half a
    /// unit of the last one.
    pub(super) fn rounding_of(&self, vectors: &[[f64; 3]]) -> f64 {
        let squares = vectors.iter().map(|v| Vec3(*v).norm_squared()).sum::<f64>();
        let off = self.half_unit(0.0) * (3.0 * vectors.len() as f64 / squares).sqrt();
        if off.is_finite() { self.rounding().max(off) } else { self.rounding() }
    }

    /// Half a unit of the last digit, relative to the largest number with that exponent.
    pub(super) fn rounding(&self) -> f64 {
        if self.single_precision {
            return f64::from(f32::EPSILON) / 2.0;
        }
        let more = self.digits.min(ALL_DIGITS).saturating_sub(1);
        (0..more).fold(0.5_f64, |unit, _| unit / 10.0).max(f64::EPSILON / 2.0)
    }
}

/// Digits behind the point, where most of `values` have as many and none has more.
fn decimals(values: &[f64]) -> Option<i32> {
    let each: Vec<i32> = values.iter().map(|&x| significant_digits(x) as i32 - 1 - exponent(x)).collect();
    let most = *each.iter().max()?;
    // one in ten ends with a zero
    (5 * each.iter().filter(|places| **places == most).count() > 3 * each.len()).then_some(most)
}

/// The decade of `x`, 0 of zero.
fn exponent(x: f64) -> i32 {
    if x == 0.0 { 0 } else { libm::floor(libm::log10(x.abs())) as i32 }
}

/// Significant decimal digits of the shortest number that reads as `x`.
fn significant_digits(x: f64) -> u32 {
    let text = format!("{:e}", x.abs());
    let mantissa = text.split('e').next().unwrap_or_default();
    mantissa.chars().filter(char::is_ascii_digit).count() as u32
}

/// Rows of the record in groups of three neighbours, or all where there are few.
pub(super) fn triples(rows: usize, most: usize) -> Vec<usize> {
    if rows <= 3 * most {
        return (0..rows).collect();
    }
    (0..most)
        .flat_map(|k| {
            let first = k * (rows - 3) / (most - 1);
            first..first + 3
        })
        .collect()
}

/// Noise of `values` at `rows`, root mean square: of neighbours the second difference, which a smooth error leaves out.
pub(super) fn noise(rows: &[usize], values: &[f64]) -> f64 {
    let mut squares: Vec<f64> = rows
        .windows(3)
        .zip(values.windows(3))
        .filter(|(rows, _)| rows[2] == rows[0] + 2)
        .map(|(_, v)| {
            let second = v[2] - 2.0 * v[1] + v[0];
            second * second / 6.0
        })
        .collect();
    squares.sort_by(f64::total_cmp);
    // without the largest tenth, jumps, which leaves 1/1.267² of the variance of normal deviates
    let kept = &squares[..(squares.len() * 9).div_ceil(10)];
    if kept.is_empty() { 0.0 } else { 1.267 * (kept.iter().sum::<f64>() / kept.len() as f64).sqrt() }
}

/// Rows at which the turn that digits leave open is looked for.
const TURNED: usize = 300;

impl Trajectory {
    /// The largest turn, rad, that the rounding of the numbers of an attitude may make, where they are read by `reading`.
    #[doc(hidden)]
    #[must_use]
    pub fn rounding(&self, reading: &Reading) -> f64 {
        rounding_turn(self, reading, Writings::of(self).attitude)
    }
}

impl Attitudes {
    /// The attitude of row `k` alone.
    fn alone(&self, k: usize) -> Self {
        match self {
            Attitudes::Quaternions(rows) => Attitudes::Quaternions(vec![rows[k]]),
            Attitudes::Matrices(rows) => Attitudes::Matrices(vec![rows[k]]),
            Attitudes::Angles(rows) => Attitudes::Angles(vec![rows[k]]),
            Attitudes::Rodrigues(rows) => Attitudes::Rodrigues(vec![rows[k]]),
        }
    }

    fn numbers(&mut self) -> &mut [f64] {
        match self {
            Attitudes::Quaternions(rows) => rows.as_flattened_mut(),
            Attitudes::Matrices(rows) => rows.as_flattened_mut(),
            Attitudes::Angles(rows) | Attitudes::Rodrigues(rows) => rows.as_flattened_mut(),
        }
    }
}

/// The largest turn, rad, that half a unit in the last place of every number of an attitude makes, over some rows.
pub(super) fn rounding_turn(record: &Trajectory, reading: &Reading, writing: Writing) -> f64 {
    let Some(attitudes) = &record.attitude else { return 0.0 };
    let of_row = |k: usize| {
        let mut one = Trajectory::new(vec![0.0]).with_attitude(attitudes.alone(k));
        let own = reading.attitude(&one, 0)?;
        let mut turns = Vec::new();
        for (n, &x) in attitudes.row(k).iter().enumerate() {
            // large enough to be seen beside the rounding of doubles; turns this small grow in proportion
            let (half, step) = (writing.half_unit(x), 1e-7);
            one.attitude.as_mut()?.numbers()[n] = x + step;
            turns.push((own.conjugate() * reading.attitude(&one, 0)?).logarithm() * (half / step));
            one.attitude.as_mut()?.numbers()[n] = x;
        }
        // each number may be off to either side
        let signs = |pattern: usize| {
            let sum = |sum: Vec3<f64>, (n, turn): (usize, &Vec3<f64>)| {
                if pattern >> n & 1 == 1 { sum - *turn } else { sum + *turn }
            };
            turns.iter().enumerate().fold(Vec3::zero(), sum).norm()
        };
        Some((0..1 << turns.len().saturating_sub(1)).map(signs).fold(0.0, f64::max))
    };
    let rows = attitudes.len();
    let turns = (0..rows).step_by(rows.div_ceil(TURNED).max(1)).filter_map(of_row);
    turns.filter(|turn| turn.is_finite()).fold(0.0, f64::max)
}

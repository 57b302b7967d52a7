//! What many numbers amount to: the share of some and their median with intervals, quantiles, the largest, and the digits that are worth a line of a table.

use polhode::num::Random;

/// The normal deviate that one in twenty exceeds, either sign.
const ONE_IN_TWENTY: f64 = 1.959_963_984_540_054;

/// A share with its 95 % interval.
#[derive(Clone, Copy)]
pub(crate) struct Interval {
    pub(crate) share: f64,
    pub(crate) low: f64,
    pub(crate) high: f64,
}

impl Interval {
    /// Source: E. B. Wilson, J. Am. Stat. Assoc. 22 (1927) 209. `None` of nothing.
    pub(crate) fn new(count: u64, of: u64) -> Option<Self> {
        Self::wide(count, of, ONE_IN_TWENTY)
    }

    /// Of another number of standard deviations.
    pub(crate) fn wide(count: u64, of: u64, z: f64) -> Option<Self> {
        if of == 0 {
            return None;
        }
        let (n, share) = (of as f64, count as f64 / of as f64);
        let square = z * z / n;
        let centre = (share + 0.5 * square) / (1.0 + square);
        let half = z / (1.0 + square) * (share * (1.0 - share) / n + 0.25 * square / n).sqrt();
        // none and all end at the end, whatever the rounding
        let low = if count == 0 { 0.0 } else { (centre - half).max(0.0) };
        let high = if count == of { 1.0 } else { (centre + half).min(1.0) };
        Some(Interval { share, low, high })
    }
}

/// The chance that at least `count` of `of` have what each has with the chance `each`. For rare ones: Wilson's interval of a small count
/// begins too high there.
pub(crate) fn chance_of(count: u64, of: u64, each: f64) -> f64 {
    let (none, odds) = (libm::pow(1.0 - each, of as f64), each / (1.0 - each));
    let fewer = (0..count).scan(none, |term, k| {
        let now = *term;
        *term *= (of.saturating_sub(k)) as f64 / (k + 1) as f64 * odds;
        Some(now)
    });
    1.0 - fewer.sum::<f64>()
}

/// 10 %, median and 90 % of an ensemble.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Quantiles {
    pub(crate) low: f64,
    pub(crate) median: f64,
    pub(crate) high: f64,
}

impl Quantiles {
    /// By the nearest rank; `None` of no values. What is infinite stays so.
    pub(crate) fn of(mut values: Vec<f64>) -> Option<Self> {
        values.sort_by(f64::total_cmp);
        let last = values.len().checked_sub(1)? as f64;
        let [low, median, high] = [0.1, 0.5, 0.9].map(|share| values[(share * last).round() as usize]);
        Some(Quantiles { low, median, high })
    }
}

/// Ensembles that are drawn for an interval.
const DRAWS: usize = 400;

/// The 95 % interval of the median of `values`, by ensembles that are drawn from them with repetition. `None` of no values. What is
/// infinite stays so.
///
/// Source: B. Efron, Ann. Stat. 7 (1979) 1.
pub(crate) fn median_interval(values: &[f64], mut random: Random) -> Option<(f64, f64)> {
    let middle = values.len().checked_sub(1)?.div_ceil(2);
    let mut medians: Vec<f64> = (0..DRAWS)
        .map(|_| {
            let draw = |_| values[random.below(values.len() as u64) as usize];
            let mut drawn: Vec<f64> = (0..values.len()).map(draw).collect();
            *drawn.select_nth_unstable_by(middle, f64::total_cmp).1
        })
        .collect();
    medians.sort_by(f64::total_cmp);
    Some((medians[DRAWS / 40], medians[DRAWS - 1 - DRAWS / 40]))
}

/// The larger of two numbers; NaN if one is NaN, which `f64::max` would drop.
pub(crate) fn larger(a: f64, b: f64) -> f64 {
    if a.is_nan() || a >= b { a } else { b }
}

/// The largest of some numbers that are not negative; NaN if one is NaN.
pub(crate) fn largest(numbers: impl IntoIterator<Item = f64>) -> f64 {
    numbers.into_iter().fold(0.0, larger)
}

/// To four digits: what an ensemble or a measured time can bear, and the same on every machine.
pub(crate) fn rounded(x: f64) -> f64 {
    format!("{x:.3e}").parse().unwrap_or(x)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn intervals_are_those_of_the_published_example() {
        // Newcombe, Stat. Med. 17 (1998) 857, table I: 81 of 263, and 0 of 20
        let i = Interval::new(81, 263).unwrap();
        assert!((i.low - 0.2553).abs() < 5e-5 && (i.high - 0.3662).abs() < 5e-5, "{} {}", i.low, i.high);
        let i = Interval::new(0, 20).unwrap();
        assert!(
            i.low == 0.0 && Interval::new(0, 18).unwrap().low == 0.0 && (i.high - 0.1611).abs() < 5e-5,
            "{}",
            i.high
        );
        assert!(Interval::new(0, 0).is_none());
    }

    #[test]
    fn chances_are_those_of_the_binomial_distribution() {
        // sums of the terms in exact fractions
        let known = [
            (2, 216, 1e-3, 0.020_157_559_191_097_543),
            (2, 11, 1e-3, 5.467_098_815_430_802e-5),
            (5, 10, 0.5, 0.623_046_875),
        ];
        for (count, of, each, chance) in known {
            assert!((chance_of(count, of, each) / chance - 1.0).abs() < 1e-9, "{count} of {of}");
        }
        assert_eq!((chance_of(0, 5, 0.3), chance_of(0, 0, 0.3)), (1.0, 1.0));
    }

    #[test]
    fn the_interval_of_a_median_covers_it_as_often_as_it_says() {
        let covers = |seed: u64| {
            let mut random = Random::new(7).stream(seed);
            let values: Vec<f64> = (0..101).map(|_| random.normal()).collect();
            let (low, high) = median_interval(&values, random).unwrap();
            assert!(low < high && high - low < 1.0, "{low} {high}");
            low <= 0.0 && 0.0 <= high
        };
        // 95 % of 400 and four standard deviations
        let covered = (0..400).filter(|seed| covers(*seed)).count();
        assert!((362..=398).contains(&covered), "{covered}");
        let lost = f64::INFINITY;
        assert_eq!(median_interval(&[lost; 3], Random::new(1)), Some((lost, lost)));
        assert_eq!(median_interval(&[], Random::new(1)), None);
    }

    #[test]
    fn a_number_that_is_none_is_the_largest() {
        assert_eq!(largest([1.0, 3.0, 2.0]), 3.0);
        assert!(
            [[1.0, f64::NAN, 2.0], [f64::NAN, 1.0, 2.0], [1.0, 2.0, f64::NAN]]
                .into_iter()
                .all(|x| largest(x).is_nan())
        );
    }

    #[test]
    fn four_digits_are_left_of_any_number() {
        assert_eq!([0.123_456, -9.999_96e9, 0.0].map(rounded), [0.1235, -1e10, 0.0]);
        assert!(rounded(f64::NAN).is_nan());
    }
}

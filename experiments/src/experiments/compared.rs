//! One method beside another over an ensemble: the ratio of their errors or costs, and how often the first is the better one.

use polhode::num::Random;
use polhode_pages::table::{Cell, row};

use crate::statistics::{Interval, Quantiles, median_interval};

/// Ratios of what one method has to what another has, from every start; infinite where the first one is lost.
pub(super) struct Compared {
    pub(super) ratios: Quantiles,
    /// 95 % interval of their median, over ensembles drawn from the starts.
    interval: (f64, f64),
    /// Of the starts from which they are below 1.
    better: Interval,
    count: u64,
}

impl Compared {
    /// Starts from which both are lost do not count. `None` where none is left.
    pub(super) fn new(mine: &[f64], theirs: &[f64], seed: u64) -> Option<Self> {
        let ratios = mine.iter().zip(theirs).map(|(mine, theirs)| mine / theirs);
        let ratios: Vec<f64> = ratios.filter(|ratio| !ratio.is_nan()).collect();
        let (better, count) =
            (ratios.iter().filter(|ratio| **ratio < 1.0).count() as u64, ratios.len() as u64);
        let interval = median_interval(&ratios, Random::new(seed).stream(1 << 40))?;
        Some(Compared {
            interval,
            better: Interval::new(better, count)?,
            count,
            ratios: Quantiles::of(ratios)?,
        })
    }

    /// Starts that count.
    pub(super) fn count(&self) -> u64 {
        self.count
    }

    /// 10 % of the ratios, their median with its interval, 90 %, and the share of those below 1 with its interval.
    pub(super) fn cells(&self) -> [Cell; 8] {
        // empty where the attitude is lost
        let held = |ratio: f64| Some(ratio).filter(|ratio| ratio.is_finite());
        let Compared { ratios: Quantiles { low, median, high }, interval, better, .. } = self;
        row![
            held(*low),
            held(*median),
            held(interval.0),
            held(interval.1),
            held(*high),
            better.share,
            better.low,
            better.high,
        ]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn starts_from_which_both_are_lost_do_not_count() {
        let lost = f64::INFINITY;
        let found = Compared::new(&[2.0, lost, lost, 1.0], &[1.0, lost, 1.0, lost], 1).unwrap();
        assert_eq!(found.ratios, Quantiles { low: 0.0, median: 2.0, high: lost });
        assert_eq!((found.better.share, found.count()), (1.0 / 3.0, 3));
        assert!(found.interval.0 <= 2.0 && found.interval.1 >= 2.0, "{:?}", found.interval);
        assert!(Compared::new(&[lost], &[lost], 1).is_none());
    }
}

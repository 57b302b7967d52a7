//! What the answers of one estimator to many records amount to.

use crate::experiments::tensors::ELLIPSOID;
use crate::statistics::rounded;
use polhode_pages::table::{Cell, row, to_digits};

/// The squared error of one answer, eᵀ C⁻¹ e.
#[derive(Clone, Copy)]
pub(super) struct Outcome {
    /// With C the Cramér–Rao bound.
    pub(super) over_bound: f64,
    /// With the covariance that the estimator states, if it states one.
    pub(super) own: Option<f64>,
}

/// All answers of one estimator.
pub(super) struct Summary {
    pub(super) answered: usize,
    /// Root of the mean square error over the bound.
    pub(super) over_bound: f64,
    /// Its 95 % interval, for the scatter of the records.
    pub(super) interval: (f64, f64),
    median: Option<f64>,
    quantile_90: Option<f64>,
    over_likelihood: Option<f64>,
    coverage: Option<f64>,
}

impl Summary {
    /// Of the outcomes of each record, beside those of maximum likelihood.
    pub(super) fn new(outcomes: &[Option<Outcome>], likelihood: &[Option<Outcome>]) -> Self {
        let answers: Vec<Outcome> = outcomes.iter().flatten().copied().collect();
        let mut sorted: Vec<f64> = answers.iter().map(|o| (o.over_bound / 5.0).sqrt()).collect();
        sorted.sort_by(f64::total_cmp);
        let stated: Vec<f64> = answers.iter().filter_map(|o| o.own).collect();
        let covered = stated.iter().filter(|square| **square < ELLIPSOID).count();
        let both = outcomes.iter().zip(likelihood).filter_map(|(a, b)| Some(((*a)?, (*b)?)));
        let (own, other) =
            both.fold((0.0, 0.0), |(own, other), (a, b)| (own + a.over_bound, other + b.over_bound));
        let over_bound =
            (answers.iter().map(|o| o.over_bound).sum::<f64>() / (5 * answers.len()) as f64).sqrt();
        let spread = libm::exp(half_width(&answers, 5.0 * over_bound * over_bound));
        Summary {
            answered: answers.len(),
            over_bound,
            interval: (over_bound / spread, over_bound * spread),
            median: quantile(&sorted, 0.5),
            quantile_90: quantile(&sorted, 0.9),
            over_likelihood: (other > 0.0).then(|| (own / other).sqrt()),
            coverage: (!stated.is_empty()).then(|| covered as f64 / stated.len() as f64),
        }
    }

    /// In one line.
    pub(super) fn conclusion(&self) -> String {
        let coverage = self.coverage.map_or(String::new(), |share| {
            format!("; {:.0} % of its 95 % ellipsoids hold the truth", 100.0 * share)
        });
        format!(
            "the fit's errors are {} times the Cramer-Rao bound ({} to {}){coverage}",
            to_digits(self.over_bound, 3),
            to_digits(self.interval.0, 2),
            to_digits(self.interval.1, 2)
        )
    }

    /// A row of the table of all.
    pub(super) fn row(
        &self,
        body: &str,
        estimator: &str,
        choice: &str,
        noise: f64,
        refused: u64,
    ) -> [Cell; 11] {
        row![
            body,
            estimator,
            choice,
            noise,
            rounded(self.over_bound),
            self.median.map(rounded),
            self.quantile_90.map(rounded),
            self.over_likelihood.map(rounded),
            self.coverage.map(rounded),
            self.answered as u64,
            refused,
        ]
    }
}

/// The choice that most records are answered with, and of those the one with the smallest median error.
pub(super) fn best(choices: impl Iterator<Item = Summary>) -> Option<(usize, Summary)> {
    choices.enumerate().min_by(|(_, a), (_, b)| {
        let error = |s: &Summary| s.median.unwrap_or(f64::INFINITY);
        b.answered.cmp(&a.answered).then(error(a).total_cmp(&error(b)))
    })
}

/// Half width of the 95 % interval of the logarithm of the root of the mean square, whose mean is `mean`.
fn half_width(answers: &[Outcome], mean: f64) -> f64 {
    let n = answers.len() as f64;
    let square = |o: &Outcome| (o.over_bound - mean) * (o.over_bound - mean);
    let variance = answers.iter().map(square).sum::<f64>() / (n - 1.0).max(1.0);
    1.96 * (variance / n).sqrt() / (2.0 * mean)
}

/// Of ascending values, by linear interpolation.
fn quantile(sorted: &[f64], share: f64) -> Option<f64> {
    let last = sorted.len().checked_sub(1)?;
    let place = share * last as f64;
    let below = place.floor() as usize;
    let above = (below + 1).min(last);
    Some(sorted[below] + (place - below as f64) * (sorted[above] - sorted[below]))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn outcome(over_bound: f64, own: Option<f64>) -> Option<Outcome> {
        Some(Outcome { over_bound, own })
    }

    #[test]
    fn a_summary_counts_what_was_answered() {
        let outcomes = [outcome(5.0, Some(1.0)), None, outcome(20.0, Some(12.0)), outcome(45.0, None)];
        let likelihood = [outcome(5.0, None), outcome(5.0, None), outcome(5.0, None), None];
        let s = Summary::new(&outcomes, &likelihood);
        assert_eq!((s.answered, s.median, s.coverage), (3, Some(2.0), Some(0.5)));
        assert_eq!(s.over_bound, (70.0_f64 / 15.0).sqrt());
        // of 5, 20 and 45: mean 70/3, standard deviation 20.2
        let relative = libm::log(s.interval.1 / s.over_bound);
        assert!((relative - 1.96 * 20.207_259_421_636_9 / 3.0_f64.sqrt() / (140.0 / 3.0)).abs() < 1e-12);
        assert!((s.interval.0 * s.interval.1 - s.over_bound * s.over_bound).abs() < 1e-12);
        assert_eq!(s.over_likelihood, Some(2.5_f64.sqrt()));
        assert_eq!(s.quantile_90, Some(2.0 + 0.8));
        let none = Summary::new(&[None], &[None]);
        assert_eq!((none.answered, none.median, none.coverage, none.over_likelihood), (0, None, None, None));
        let (choice, _) = best([none, s].into_iter()).unwrap();
        assert_eq!(choice, 1);
    }
}

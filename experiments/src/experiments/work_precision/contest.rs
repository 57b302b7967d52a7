//! Who reaches an accuracy at the least cost, over an ensemble of starts.

use crate::statistics::Quantiles;

/// One method at one step or tolerance, from every start.
#[derive(Clone, Debug)]
pub(in crate::experiments) struct Run {
    /// Evaluations per unit of time, by start.
    pub(in crate::experiments) evaluations: Vec<f64>,
    /// Processor time per unit of time in steps of rk4, by start.
    pub(in crate::experiments) time: Vec<f64>,
    /// The largest attitude error up to each horizon, by start: infinite where the attitude is lost, `None` where the run was
    /// not made.
    pub(in crate::experiments) errors: Vec<Vec<Option<f64>>>,
}

/// A method, with its runs from coarse to fine.
pub(in crate::experiments) struct Contestant {
    pub(in crate::experiments) name: String,
    pub(in crate::experiments) runs: Vec<Run>,
}

/// What is counted.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(in crate::experiments) enum Currency {
    Evaluations,
    Time,
}

/// Free motion is exact at any step of this one: it wins wherever it takes part.
pub(in crate::experiments) const CLOSED_FORM: &str = "exact-step";

impl Run {
    pub(in crate::experiments) fn costs(&self, currency: Currency) -> &[f64] {
        match currency {
            Currency::Evaluations => &self.evaluations,
            Currency::Time => &self.time,
        }
    }

    /// Errors up to a horizon, over the starts from which the run was made.
    pub(in crate::experiments) fn errors(&self, horizon: usize) -> Option<Quantiles> {
        Quantiles::of(self.errors.get(horizon)?.iter().copied().flatten().collect())
    }
}

impl Contestant {
    /// Median cost and errors of the runs that hold the attitude to a horizon from half of the starts, ascending in cost.
    pub(in crate::experiments) fn points(&self, horizon: usize, currency: Currency) -> Vec<(f64, Quantiles)> {
        let point = |run: &Run| {
            let errors = run.errors(horizon).filter(|errors| errors.median.is_finite())?;
            Some((Quantiles::of(run.costs(currency).to_vec())?.median, errors))
        };
        let mut points: Vec<_> = self.runs.iter().filter_map(point).collect();
        points.sort_by(|a, b| a.0.total_cmp(&b.0));
        points
    }

    /// The least cost at which the error from one start is at most `accuracy`, between two runs as a power law; infinite where
    /// no run is so accurate.
    pub(in crate::experiments) fn cost_from(
        &self,
        start: usize,
        accuracy: f64,
        horizon: usize,
        currency: Currency,
    ) -> f64 {
        let point = |run: &Run| {
            let error = run.errors.get(horizon)?.get(start).copied().flatten()?;
            Some((*run.costs(currency).get(start)?, error))
        };
        let mut points: Vec<(f64, f64)> = self.runs.iter().filter_map(point).collect();
        points.sort_by(|a, b| a.0.total_cmp(&b.0));
        let Some(first) = points.iter().position(|point| point.1 <= accuracy) else { return f64::INFINITY };
        let (cost, error) = points[first];
        match first.checked_sub(1).map(|before| points[before]) {
            Some((cheaper, worse)) if error > 0.0 && worse.is_finite() => {
                let share = libm::log(worse / accuracy) / libm::log(worse / error);
                cheaper * libm::pow(cost / cheaper, share)
            }
            _ => cost,
        }
    }

    /// The cost at which errors are at most `accuracy`, over `starts`; `None` where fewer than half of them get so far.
    pub(in crate::experiments) fn cost_of(
        &self,
        accuracy: f64,
        horizon: usize,
        currency: Currency,
        starts: &[usize],
    ) -> Option<Quantiles> {
        let costs = starts.iter().map(|&start| self.cost_from(start, accuracy, horizon, currency));
        Quantiles::of(costs.collect()).filter(|cost| cost.median.is_finite())
    }
}

/// All that reach an accuracy, the cheapest first.
pub(in crate::experiments) fn ranked<'a>(
    contestants: &'a [Contestant],
    accuracy: f64,
    horizon: usize,
    currency: Currency,
    starts: &[usize],
) -> Vec<(&'a str, Quantiles)> {
    let cost = |contestant: &'a Contestant| {
        let cost = contestant.cost_of(accuracy, horizon, currency, starts)?;
        Some((contestant.name.as_str(), cost))
    };
    let mut found: Vec<(&str, Quantiles)> = contestants.iter().filter_map(cost).collect();
    found.sort_by(|a, b| a.1.median.total_cmp(&b.1.median));
    found
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Runs at the costs `points`, with the errors of as many starts.
    fn contestant(name: &str, points: &[(f64, &[f64])]) -> Contestant {
        let run = |&(cost, errors): &(f64, &[f64])| Run {
            evaluations: vec![cost; errors.len()],
            time: vec![2.0 * cost; errors.len()],
            errors: vec![errors.iter().map(|error| Some(*error)).collect()],
        };
        Contestant { name: name.into(), runs: points.iter().map(run).collect() }
    }

    #[test]
    fn costs_between_two_runs_follow_a_power_law() {
        let lost = f64::INFINITY;
        let fourth = contestant("fourth", &[(10.0, &[lost]), (20.0, &[1e-2]), (40.0, &[6.25e-4])]);
        let cost = |accuracy, currency| fourth.cost_of(accuracy, 0, currency, &[0]).map(|cost| cost.median);
        let evaluations = |accuracy| cost(accuracy, Currency::Evaluations);
        assert!((evaluations(1e-2 / 4.0).unwrap() - 20.0 * libm::sqrt(2.0)).abs() < 1e-9);
        assert_eq!((evaluations(0.5), evaluations(1e-2)), (Some(20.0), Some(20.0)));
        assert_eq!(evaluations(1e-4), None);
        assert_eq!(cost(1e-2, Currency::Time), Some(40.0));
    }

    #[test]
    fn an_accuracy_is_reached_where_half_of_the_starts_reach_it() {
        let spread = contestant("spread", &[(1.0, &[1e-3, 0.5, 0.5]), (4.0, &[1e-6, 1e-3, 0.5])]);
        let cost = |accuracy, starts: &[usize]| spread.cost_of(accuracy, 0, Currency::Evaluations, starts);
        let all = cost(1e-3, &[0, 1, 2]).unwrap();
        assert_eq!((all.low, all.median, all.high), (1.0, 4.0, f64::INFINITY));
        assert_eq!(cost(1e-6, &[0, 1, 2]), None);
        assert!(cost(1e-6, &[0]).is_some());
        assert_eq!(spread.points(0, Currency::Time)[1].1, Quantiles { low: 1e-6, median: 1e-3, high: 0.5 });
    }

    #[test]
    fn the_cheapest_comes_first_and_who_cannot_is_left_out() {
        let all = [
            contestant("slow", &[(100.0, &[1e-8])]),
            contestant("fast", &[(10.0, &[1e-3]), (20.0, &[1e-6])]),
        ];
        let names = |accuracy| -> Vec<&str> {
            ranked(&all, accuracy, 0, Currency::Time, &[0]).into_iter().map(|found| found.0).collect()
        };
        assert_eq!(names(1e-3), ["fast", "slow"]);
        assert_eq!(names(1e-7), ["slow"]);
    }
}

//! Who reaches an accuracy at the least cost.

use polhode::method::AnyMethod;

/// One run of a method: what it cost a unit of time, and the largest attitude error up to each horizon.
#[derive(Clone, Debug)]
pub(super) struct Run {
    pub(super) evaluations: f64,
    /// In steps of rk4.
    pub(super) time: f64,
    /// `None` where the attitude is lost before.
    pub(super) errors: Vec<Option<f64>>,
}

/// A method, with its runs from coarse to fine.
pub(super) struct Contestant {
    pub(super) name: String,
    pub(super) runs: Vec<Run>,
}

/// What is counted.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Currency {
    Evaluations,
    Time,
}

/// Free motion is exact at any step of this one: it wins wherever it takes part.
pub(super) const CLOSED_FORM: &str = "exact-step";

impl Run {
    pub(super) fn cost(&self, currency: Currency) -> f64 {
        match currency {
            Currency::Evaluations => self.evaluations,
            Currency::Time => self.time,
        }
    }
}

impl Contestant {
    pub(super) fn new(method: &dyn AnyMethod, runs: Vec<Run>) -> Self {
        // one name for all tolerances
        let name = method.name();
        let base = name.split(':').next().unwrap_or(&name);
        let adaptive = crate::measured::is_adaptive(&name);
        Contestant { name: if adaptive { base.to_owned() } else { name }, runs }
    }

    /// Cost and error of the runs that hold the attitude to a horizon, ascending in cost.
    pub(super) fn points(&self, horizon: usize, currency: Currency) -> Vec<(f64, f64)> {
        let point = |run: &Run| Some((run.cost(currency), run.errors.get(horizon).copied().flatten()?));
        let mut points: Vec<(f64, f64)> = self.runs.iter().filter_map(point).collect();
        points.sort_by(|a, b| a.0.total_cmp(&b.0));
        points
    }

    /// The least cost at which the error is at most `accuracy`, between two runs as a power law; `None` where no run is so
    /// accurate.
    pub(super) fn cost_of(&self, accuracy: f64, horizon: usize, currency: Currency) -> Option<f64> {
        let points = self.points(horizon, currency);
        let first = points.iter().position(|point| point.1 <= accuracy)?;
        let (cost, error) = points[first];
        let Some(&(cheaper, worse)) = first.checked_sub(1).and_then(|before| points.get(before)) else {
            return Some(cost);
        };
        if error <= 0.0 {
            return Some(cost);
        }
        let share = libm::log(worse / accuracy) / libm::log(worse / error);
        Some(cheaper * libm::pow(cost / cheaper, share))
    }
}

/// The cheapest of `contestants` at an accuracy, with its cost, and the next.
pub(super) fn ranked<'a>(
    contestants: &'a [Contestant],
    accuracy: f64,
    horizon: usize,
    currency: Currency,
) -> Vec<(&'a str, f64)> {
    let cost = |contestant: &'a Contestant| {
        Some((contestant.name.as_str(), contestant.cost_of(accuracy, horizon, currency)?))
    };
    let mut found: Vec<(&str, f64)> = contestants.iter().filter_map(cost).collect();
    found.sort_by(|a, b| a.1.total_cmp(&b.1));
    found
}

#[cfg(test)]
mod tests {
    use super::*;

    fn contestant(name: &str, points: &[(f64, Option<f64>)]) -> Contestant {
        let run = |&(cost, error): &(f64, Option<f64>)| Run {
            evaluations: cost,
            time: 2.0 * cost,
            errors: vec![error],
        };
        Contestant { name: name.into(), runs: points.iter().map(run).collect() }
    }

    #[test]
    fn costs_between_two_runs_follow_a_power_law() {
        let fourth = contestant("fourth", &[(10.0, None), (20.0, Some(1e-2)), (40.0, Some(6.25e-4))]);
        let cost = |accuracy| fourth.cost_of(accuracy, 0, Currency::Evaluations);
        assert!((cost(1e-2 / 4.0).unwrap() - 20.0 * libm::sqrt(2.0)).abs() < 1e-9);
        assert_eq!((cost(0.5), cost(1e-2)), (Some(20.0), Some(20.0)));
        assert_eq!(cost(1e-4), None);
        assert_eq!(fourth.cost_of(1e-2, 0, Currency::Time), Some(40.0));
    }

    #[test]
    fn the_cheapest_comes_first_and_who_cannot_is_left_out() {
        let all = [
            contestant("slow", &[(100.0, Some(1e-8))]),
            contestant("fast", &[(10.0, Some(1e-3)), (20.0, Some(1e-6))]),
        ];
        let names = |accuracy| -> Vec<&str> {
            ranked(&all, accuracy, 0, Currency::Time).into_iter().map(|found| found.0).collect()
        };
        assert_eq!(names(1e-3), ["fast", "slow"]);
        assert_eq!(names(1e-7), ["slow"]);
    }
}

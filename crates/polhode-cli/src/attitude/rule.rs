//! By which rule, and what another one would have said.

use clap::{Args, ValueEnum};
use polhode::record::Record;
use polhode::strapdown::{MOST_SAMPLES, Rule, Sensor, StrapdownError, choose};
use polhode_files::error::Error;

use super::readings::Readings;

/// Order, samples and rule.
#[derive(Args, Clone, Debug)]
#[command(next_help_heading = "Method")]
pub(super) struct RuleArguments {
    /// Order of the Magnus series
    #[arg(long, value_enum, default_value_t = Order::Auto)]
    order: Order,
    /// Number of samples that a polynomial goes through, even [default: chosen from the record and its noise]
    #[arg(long, value_name = "N", allow_hyphen_values = true)]
    samples: Option<usize>,
    /// Use a rule of other programs instead of the Magnus series
    #[arg(long, value_enum, conflicts_with_all = ["order", "samples"])]
    rule: Option<RivalName>,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
enum Order {
    Auto,
    #[value(name = "2")]
    Two,
    #[value(name = "4")]
    Four,
    #[value(name = "6")]
    Six,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
enum RivalName {
    /// Each rate is held to the next sample
    Hold,
    /// Linear interpolation of the rates, with a coning term
    Trapezoid,
    /// Coning summed over four samples, as PX4 does
    TwoSpeed,
    /// Runge-Kutta method on linearly interpolated rates
    RungeKutta,
}

impl RuleArguments {
    /// As asked for, or chosen by the longest segment of the `record`.
    pub(super) fn rule(&self, readings: &Readings, record: &Record, sensor: Sensor) -> Result<Rule, Error> {
        let rule = match self.rule {
            Some(RivalName::Hold) => Rule::Hold,
            Some(RivalName::Trapezoid) => Rule::Trapezoid,
            Some(RivalName::TwoSpeed) => Rule::TwoSpeed,
            Some(RivalName::RungeKutta) => Rule::RungeKutta,
            None => return self.magnus(readings, record, sensor),
        };
        rule.check(readings.kind)
            .map_err(|error| Error::Input(format!("--rule: {error}; name another rule")))?;
        Ok(rule)
    }

    fn magnus(&self, readings: &Readings, record: &Record, sensor: Sensor) -> Result<Rule, Error> {
        let order = match self.order {
            Order::Auto => None,
            Order::Two => Some(2),
            Order::Four => Some(4),
            Order::Six => Some(6),
        };
        if let Some(samples) = self.samples.filter(|n| *n % 2 == 1 || !(2..=MOST_SAMPLES).contains(n)) {
            let rule =
                format!("a polynomial goes through an even number of samples from 2 to {MOST_SAMPLES}");
            return Err(Error::input("--samples", &samples.to_string(), &rule, "give such a number"));
        }
        if let (Some(order), Some(samples)) = (order, self.samples) {
            return Rule::magnus(order, samples).map_err(|error| Error::Input(format!("--samples: {error}")));
        }
        let longest = record.segments.iter().max_by_key(|segment| segment.times().len());
        let Some(segment) = longest else {
            return Rule::magnus(2, 2).map_err(polhode_files::error::unexpected);
        };
        let chosen = choose(segment.times(), segment.rates(), readings.kind, order, self.samples, sensor);
        chosen.map_err(|error| match error.downcast_ref() {
            Some(refusal) => {
                let sample = match refusal {
                    StrapdownError::HalfTurn { sample, .. } => *sample,
                    _ => 0,
                };
                readings.refused(segment, sample, refusal)
            }
            None => Error::Input(error.to_string()),
        })
    }
}

/// The rule in words.
pub(super) fn words(rule: Rule) -> String {
    match rule {
        Rule::Magnus(magnus) => format!("order {} through {} samples", magnus.order(), magnus.samples()),
        other => other.to_string(),
    }
}

//! Rules by which readings become turns.

use core::fmt;
use core::ops::Range;

use thiserror::Error;

use super::Kind;
use super::error::StrapdownError;

/// Most samples of a rule.
pub const MOST_SAMPLES: usize = 12;

/// Samples that the first turn of the other rules waits for: an increment without one before it takes the one after it.
const START: usize = 3;

/// How the turn between two samples is found.
///
/// | rule | turn of the interval from t_k to t_{k+1} = t_k + h | order |
/// |---|---|---|
/// | `magnus:P,N` | exponential of the Magnus series of order P of the polynomial through N samples about the interval | min(P, N) |
/// | `hold` | exp(h ω_k); of increments exp(θ_{k+1}) | 1; 2 |
/// | `trapezoid` | exp(h (ω_k + ω_{k+1})/2 + h² ω_k×ω_{k+1}/12); of increments exp(θ_{k+1} + θ_k×θ_{k+1}/12) | 2; 3 |
/// | `two-speed` | four samples at a time: exp(α + β) with α = Σ δ, β += ½ (α + δ_last/6) × δ; δ by the trapezoid or the increment | 2; 3 |
/// | `runge-kutta` | the classical step of order 4 of q̇ = ½ q ω, ω linear between the samples | 2 |
///
/// For increments, the error of order 3 of the trapezoid oscillates and does not grow; what grows with the time is of order 4.
///
/// The last four are what flight controllers, loggers and textbooks run. For instantaneous rates their error is that of the
/// straight line between samples, which no coning term mends.
///
/// ```
/// use polhode::strapdown::Rule;
/// let rule = Rule::magnus(6, 8)?;
/// assert_eq!((rule.to_string(), rule.delay()), ("magnus:6,8".into(), 3));
/// assert_eq!(Rule::magnus(6, 7).unwrap_err().to_string(), "7 samples: a rule of order 6 takes an even number from 6 to 12");
/// # Ok::<(), polhode::strapdown::RuleError>(())
/// ```
///
/// Sources: order 4 and 6, Blanes, Casas, Ros, BIT 40 (2000) 434; a polynomial used in its middle, Wu, arXiv 2107.04722; coning term of
/// increments, Miller, J. Guidance 6 (1983) 287, and Savage, J. Guidance Control Dyn. 21 (1998) 19; two speeds as PX4's `Integrator.hpp` runs them.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum Rule {
    /// Magnus series of a local polynomial; made by [`Rule::magnus`].
    Magnus(Magnus),
    /// The reading is held.
    Hold,
    /// Trapezoid with coning.
    Trapezoid,
    /// Coning summed over four samples.
    TwoSpeed,
    /// Runge and Kutta on linear rates.
    RungeKutta,
}

/// Order and number of samples of a [`Rule::Magnus`].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Magnus {
    order: u32,
    samples: usize,
}

impl Magnus {
    /// 2, 4 or 6.
    #[must_use]
    pub fn order(self) -> u32 {
        self.order
    }

    /// Samples that the polynomial goes through, an even number; of increments and averages one less are readings.
    #[must_use]
    pub fn samples(self) -> usize {
        self.samples
    }
}

/// An order or a number of samples that no rule has.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Error)]
#[non_exhaustive]
pub enum RuleError {
    /// Not 2, 4 or 6.
    #[error("order {order}: known orders are 2, 4 and 6")]
    Order {
        /// The order.
        order: u32,
    },
    /// Odd, too few or too many.
    #[error("{samples} samples: a rule of order {order} takes an even number from {order} to {MOST_SAMPLES}")]
    Samples {
        /// The order.
        order: u32,
        /// The number of samples.
        samples: usize,
    },
}

impl Rule {
    /// The rules that people run.
    pub const RIVALS: [Rule; 4] = [Rule::Hold, Rule::Trapezoid, Rule::TwoSpeed, Rule::RungeKutta];

    /// The Magnus series of `order` 2, 4 or 6 of the polynomial through `samples` samples, half of them on each side of the
    /// interval that it is used in.
    ///
    /// # Errors
    /// Other orders; an odd number of samples, or one outside of the order and [`MOST_SAMPLES`].
    pub fn magnus(order: u32, samples: usize) -> Result<Rule, RuleError> {
        if ![2, 4, 6].contains(&order) {
            return Err(RuleError::Order { order });
        }
        if samples % 2 == 1 || !(order as usize..=MOST_SAMPLES).contains(&samples) {
            return Err(RuleError::Samples { order, samples });
        }
        Ok(Rule::Magnus(Magnus { order, samples }))
    }

    /// Samples after the end of an interval that its turn waits for: the attitude at a sample is known when so many more have
    /// come. At the start of a record the first attitudes wait until the first polynomial is complete.
    #[must_use]
    pub fn delay(self) -> usize {
        match self {
            Rule::Magnus(Magnus { samples, .. }) => samples / 2 - 1,
            _ => 0,
        }
    }

    /// Whether there is such a rule for readings of this kind.
    ///
    /// # Errors
    /// `runge-kutta` of increments and averages.
    pub fn check(self, kind: Kind) -> Result<(), StrapdownError> {
        match (self, kind) {
            (Rule::RungeKutta, Kind::Increment | Kind::Average) => {
                Err(StrapdownError::Kind { rule: self, kind })
            }
            _ => Ok(()),
        }
    }

    /// One by which the error of this rule is estimated: with two samples more, at least four.
    pub(super) fn richer(self) -> Rule {
        let samples = if let Rule::Magnus(Magnus { samples, .. }) = self { samples + 2 } else { 4 };
        Rule::Magnus(Magnus { order: 6, samples })
    }

    /// The samples that the turn from sample `k` to the next one is made of, of `count` that there are: half of them on each
    /// side, and at the ends of a record the nearest.
    pub(super) fn range(self, k: usize, count: usize) -> Range<usize> {
        match self {
            Rule::Magnus(Magnus { samples, .. }) => {
                let samples = samples.min(count);
                let first = (k + self.delay() + 2).saturating_sub(samples).min(count - samples);
                first..first + samples
            }
            _ => k.saturating_sub(1)..(k + 2).max(START).min(count),
        }
    }

    /// Whether `count` samples are enough for the turn from sample `k` to the next one, while more may come.
    pub(super) fn is_ready(self, k: usize, count: usize) -> bool {
        let complete = match self {
            Rule::Magnus(Magnus { samples, .. }) => samples,
            _ => START,
        };
        count >= complete.max(k + 2 + self.delay())
    }
}

impl fmt::Display for Rule {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Rule::Magnus(Magnus { order, samples }) => write!(f, "magnus:{order},{samples}"),
            Rule::Hold => f.write_str("hold"),
            Rule::Trapezoid => f.write_str("trapezoid"),
            Rule::TwoSpeed => f.write_str("two-speed"),
            Rule::RungeKutta => f.write_str("runge-kutta"),
        }
    }
}

impl fmt::Display for Magnus {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        Rule::Magnus(*self).fmt(f)
    }
}

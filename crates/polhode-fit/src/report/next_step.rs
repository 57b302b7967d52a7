//! What to do next: which error limits the answer, and what would make it smaller.

use core::fmt;

use crate::report::estimate::Estimate;
use crate::report::nuisance::Systematic;
use crate::thresholds::next_step::{SURE, UNEVEN};

/// What would make an answer surer. Its `Display` is a sentence.
#[non_exhaustive]
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum NextStep {
    /// An error that the sensor may have changes a moment by more than half its 95 % interval.
    Sensor {
        /// Name of the error, as in [`Estimate::systematic`].
        name: &'static str,
        /// Its size.
        size: f64,
        /// The unit of that.
        unit: &'static str,
        /// What it changes a moment by, over half the 95 % interval of that moment: the most of the three.
        times: f64,
    },
    /// The deviations are larger than what errors of the sensor do.
    Longer,
    /// One of the five combinations is known far less well than another.
    OtherStart {
        /// Deviation of the weakest combination over that of the best.
        times: f64,
        /// Which is the weakest: the axis about which the others may be turned, from 1, or the moment.
        turn: bool,
        /// Number of this axis or moment, from 1.
        number: usize,
    },
}

impl fmt::Display for NextStep {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match *self {
            Self::Sensor { name, size, unit, times } => {
                let size = format!("{size} {unit}");
                write!(
                    f,
                    "calibrate the sensor, or give the fit the deviation of its errors: {name} of {} would change a moment by {times:.1} times half its 95 % interval",
                    size.trim_end()
                )
            }
            Self::Longer => write!(
                f,
                "measure longer, or more often: noise is the largest error, and four times the record halves it"
            ),
            Self::OtherStart { times, turn: true, number } => write!(
                f,
                "start with more rotation across axis {number}: the turn of the axes about it is known {times:.0} times less well than the best-known combination"
            ),
            Self::OtherStart { times, number, .. } => write!(
                f,
                "start about another axis: I{number} is known {times:.0} times less well than the best-known combination"
            ),
        }
    }
}

impl Estimate {
    /// What would make the answer surer, the largest error first.
    pub fn next_steps(&self) -> Vec<NextStep> {
        [self.largest_error(), self.weakest()].into_iter().flatten().collect()
    }

    /// `None` where the errors of the sensor are not known.
    fn largest_error(&self) -> Option<NextStep> {
        let of_sensor = self.systematic.iter().filter(|line| line.is_of_sensor());
        let times = |line: &Systematic| {
            let share = |k: usize| line.principal[k].abs() / (SURE * self.sigma_principal[k]);
            (0..3).map(share).filter(|share| share.is_finite()).fold(0.0, f64::max)
        };
        let line = of_sensor.max_by(|a, b| times(a).total_cmp(&times(b)))?;
        let sensor =
            NextStep::Sensor { name: line.name, size: line.size, unit: line.unit, times: times(line) };
        Some(if times(line) > 1.0 { sensor } else { NextStep::Longer })
    }

    /// In shares of the trace: a turn by δ about axis k moves the entry between the others by (I_i − I_j) δ, twice in the tensor.
    fn weakest(&self) -> Option<NextStep> {
        let [least, .., most] = self.identifiability.deviations;
        let times = most / least;
        let by_turn = |k: usize| {
            let apart = (self.principal[(k + 1) % 3] - self.principal[(k + 2) % 3]).abs();
            (core::f64::consts::SQRT_2 * apart * self.sigma_axes[k], true, k + 1)
        };
        let of_moment = |k: usize| (self.sigma_principal[k], false, k + 1);
        let all = (0..3).map(by_turn).chain((0..3).map(of_moment)).filter(|of| of.0.is_finite());
        let (_, turn, number) = all.max_by(|a, b| a.0.total_cmp(&b.0))?;
        (times > UNEVEN && times.is_finite()).then_some(NextStep::OtherStart { times, turn, number })
    }
}

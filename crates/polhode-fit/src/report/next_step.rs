//! What to do next: which error limits the answer, and what would make it smaller.

use core::fmt;

use nalgebra::{SMatrix, Vector3};
use polhode::inertia::Inertia;
use polhode::num::Shown;

use crate::bound::attitudes::foreseen_attitude_bound;
use crate::bound::motions::foreseen_bound;
use crate::physical::coordinates::symmetric;
use crate::report::estimate::{Estimate, Method};
use crate::report::nuisance::Systematic;
use crate::report::warning::Warning;
use crate::thresholds::next_step::{HELPS, PLANNED, SURE, UNEVEN};

/// What would make an answer surer. Its `Display` is a sentence.
#[non_exhaustive]
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum NextStep {
    /// Something contradicts the fit: more records of the same kind do not average it out.
    FindCause(Contradiction),
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
    /// Noise is the largest error that is known.
    Longer,
    /// From one attitude to the next the body turns so far that another motion might look the same.
    MoreOften {
        /// Largest turn from one attitude to the next, rad.
        turn: f64,
    },
    /// One of the five combinations is known far less well than another.
    OtherStart {
        /// Deviation of the weakest combination over that of the best.
        times: f64,
        /// Which is the weakest: the axis about which the others may be turned, from 1, or the moment.
        turn: bool,
        /// Number of this axis or moment, from 1.
        number: usize,
        /// By how much its deviation would be smaller if the rate had been spread evenly over the three axes, by the Cramér–Rao bound of a
        /// free body; `None` where torques or wheels act.
        gain: Option<f64>,
    },
}

/// Where something comes from that a fit takes to be zero and the record shows.
#[non_exhaustive]
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Origin {
    /// A constant error of the sensor, which a fit can estimate with a prior.
    Sensor,
    /// Offsets of the sensor that change.
    Drift,
    /// The momentum of wheels as the record tells it.
    Wheels,
    /// The body, or what acts on it: a wheel of which the record tells nothing, a magnet.
    Body,
}

impl Origin {
    /// What helps, in words that go on from what the tensor may be.
    pub(crate) fn remedy(self) -> &'static str {
        match self {
            Self::Sensor => "; calibrate the sensor, or fit this error too, with a prior",
            Self::Wheels => "; check the inertia, the axis and the speed of each wheel",
            Self::Drift | Self::Body => "",
        }
    }
}

/// What contradicts a fit.
#[non_exhaustive]
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Contradiction {
    /// Something that the fit takes to be zero.
    LeftOut {
        /// What it is, in words.
        what: &'static str,
        /// Where it comes from.
        origin: Origin,
    },
    /// The parts of the record contradict each other.
    Parts,
    /// The fitted motion leaves more than noise.
    Residuals,
}

impl fmt::Display for Contradiction {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match *self {
            Self::LeftOut { what, origin: Origin::Sensor } => write!(
                f,
                "calibrate the sensor, or fit its error with a prior: the record shows {what}; further records do not average out this error"
            ),
            Self::LeftOut { what, origin: Origin::Drift } => write!(
                f,
                "let the sensor warm up, use one that drifts less, or record for a shorter time: the record shows {what}"
            ),
            Self::LeftOut { what, origin: Origin::Wheels } => write!(
                f,
                "check the inertia, the axis and the speed of each wheel: the record shows {what}; further records do not average it out"
            ),
            Self::LeftOut { what, origin: Origin::Body } => write!(
                f,
                "find out whether there is {what}, and remove it: the record shows it; further records do not average it out"
            ),
            Self::Parts => f.write_str(
                "find out why the parts of the record differ: fit them one by one, and check how the sensor is fixed to the body, whether \
                 something moves in it, and the drag of the air; further records of the same kind do not average this out",
            ),
            Self::Residuals => f.write_str(
                "find out why the residuals are more than noise: a torque, a moving part, or a sensor that filters or drifts; further samples \
                 of the same kind do not average this out",
            ),
        }
    }
}

impl fmt::Display for NextStep {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match *self {
            Self::FindCause(what) => what.fmt(f),
            Self::Sensor { name, size, unit, times } => write!(
                f,
                "calibrate the sensor, or fit its errors with a prior: {name} of {} changes a moment by {times:.1} times its 95 % uncertainty \
                 from noise; {name} of {} would change it by as much as this uncertainty",
                with_unit(size, unit),
                with_unit(format!("{:.1e}", size / times).parse().unwrap_or(size), unit)
            ),
            Self::Longer => f.write_str(
                "measure longer, or more often: noise is the largest known error, and a record four times as long at least halves it",
            ),
            Self::MoreOften { turn } => write!(
                f,
                "measure more often: from one attitude to the next the body turns by up to {turn:.2} rad, and beyond 3.14 rad attitudes do not \
                 determine a motion"
            ),
            Self::OtherStart { times, turn, number, gain } => {
                if turn {
                    write!(f, "start with more rotation perpendicular to axis {number}: the rotation of the other axes about it")?;
                } else {
                    write!(f, "start about another axis: I{number}")?;
                }
                write!(f, " has {times:.0} times the standard deviation of the best-known combination of the entries")?;
                match gain {
                    Some(gain) => write!(f, "; with the same rate, spread evenly over the three axes, its standard deviation would be {gain:.0} times smaller"),
                    None => Ok(()),
                }
            }
        }
    }
}

fn with_unit(size: f64, unit: &str) -> String {
    format!("{} {unit}", Shown(size)).trim_end().into()
}

impl Estimate {
    /// What would make the answer surer, the largest error first.
    pub fn next_steps(&self) -> Vec<NextStep> {
        let cause = self.contradiction().map(NextStep::FindCause);
        // more of what contradicts itself is no surer
        let largest = self.largest_error().filter(|step| cause.is_none() || *step != NextStep::Longer);
        let coarse = self.warnings.iter().find_map(|warning| match warning {
            Warning::CoarseAttitudes { turn } => Some(NextStep::MoreOften { turn: *turn }),
            _ => None,
        });
        [cause, largest, coarse, self.weakest()].into_iter().flatten().collect()
    }

    /// The clearest of what warnings say.
    fn contradiction(&self) -> Option<Contradiction> {
        let of = |warning: &Warning| match warning {
            Warning::LeftOut { what, origin, .. } => Some(Contradiction::LeftOut { what, origin: *origin }),
            Warning::RefutedPrior { what, .. } => {
                Some(Contradiction::LeftOut { what, origin: Origin::Sensor })
            }
            Warning::Halves(_)
            | Warning::Scatter(_)
            | Warning::Differing { .. }
            | Warning::TwoTensors { .. } => Some(Contradiction::Parts),
            Warning::Residuals { .. }
            | Warning::AttitudeResiduals { .. }
            | Warning::ConstantTorque { .. }
            | Warning::MovingAxes { .. }
            | Warning::RateOffset { is_fitted: false, .. }
            | Warning::RateScale { is_fitted: false, .. }
            | Warning::RateResiduals { .. }
            | Warning::Memory(_)
            | Warning::Blow(_)
            | Warning::Vibration { .. } => Some(Contradiction::Residuals),
            _ => None,
        };
        let rank = |of: &Contradiction| match of {
            Contradiction::LeftOut { .. } => 0,
            Contradiction::Parts => 1,
            Contradiction::Residuals => 2,
        };
        self.warnings.iter().filter_map(of).min_by_key(rank)
    }

    /// `None` of equations whose errors of the sensor are not known.
    fn largest_error(&self) -> Option<NextStep> {
        let is_weak = matches!(self.method, Method::WeakForm | Method::ExactMotionWithWheels);
        let of_sensor = self.systematic.iter().filter(|line| line.is_of_sensor());
        let times = |line: &Systematic| {
            let share = |k: usize| line.principal[k].abs() / (SURE * self.sigma_principal[k]);
            (0..3).map(share).filter(|share| share.is_finite()).fold(0.0, f64::max)
        };
        let line = of_sensor.max_by(|a, b| times(a).total_cmp(&times(b)));
        let Some(line) = line else { return (!is_weak).then_some(NextStep::Longer) };
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
        let (deviation, turn, number) = all.max_by(|a, b| a.0.total_cmp(&b.0))?;
        if !(times > UNEVEN && times.is_finite()) {
            return None;
        }
        let gain = self.of_even_start(turn, number - 1).map(|foreseen| deviation / foreseen);
        // of a slender body no start tells all alike
        gain.is_none_or(|gain| gain > HELPS).then_some(NextStep::OtherStart { times, turn, number, gain })
    }

    /// The deviation of a turn or a moment, in shares of the trace, that a record as long as this one with the rate spread evenly over the
    /// three axes has at best.
    fn of_even_start(&self, turn: bool, k: usize) -> Option<f64> {
        let is_driven = self.attitudes.is_none() && self.mirror.is_none();
        if is_driven || self.per_segment.iter().any(|segment| segment.torque_noise > 0.0) {
            return None;
        }
        let longest = self.residuals.iter().max_by_key(|of| of.times.len())?;
        let seconds = longest.times.last()? - longest.times.first()?;
        let own = self.per_segment.iter().filter(|of| of.segment == longest.segment);
        let count = own.map(|of| of.samples).max()?.clamp(2, PLANNED);
        let times: Vec<f64> = (0..count).map(|i| seconds * i as f64 / (count - 1) as f64).collect();
        let body = Inertia::from_tensor(self.shape.tensor()).ok()?;
        let axis = |k: usize| self.axes * Vector3::ith(k, 1.0);
        let omega = (axis(0) + axis(1) + axis(2)) * (self.rms_rate / 3.0_f64.sqrt());
        let bound = match &self.attitudes {
            Some(attitudes) => foreseen_attitude_bound(&body, omega, &times, attitudes.noise_sigma),
            None => foreseen_bound(&body, omega, &times, self.noise_sigma),
        }?;
        let (one, other) = if turn { (axis((k + 1) % 3), axis((k + 2) % 3)) } else { (axis(k), axis(k)) };
        let slope = SMatrix::<f64, 6, 1>::from_fn(|entry, _| one.dot(&(symmetric(entry) * other)));
        let all = self.samples as f64 / count as f64;
        let deviation = (slope.dot(&(bound * slope)) / all).sqrt();
        let in_tensor = if turn { core::f64::consts::SQRT_2 } else { 1.0 };
        Some(in_tensor * deviation).filter(|deviation| *deviation > 0.0)
    }
}

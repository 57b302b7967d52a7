//! What limits the use of an estimate.

use core::fmt;

use crate::error::{UNSTATED, per_cent, with_sigma};
use crate::models::reading_error::ReadingError;
use crate::physical::constraint::ActiveConstraint;
use crate::physical::law::LARGEST_SHARE;
use crate::report::next_step::Origin;
use crate::report::nuisance::FittedTorque;
use crate::report::parts::{Halves, Scatter};
use crate::report::torque_free::{Blow, InvariantTrend, Memory, Whiteness};
use crate::thresholds::flights::BEYOND;
use crate::thresholds::likelihood::LINEAR;
use crate::thresholds::warnings::NEGATIVE;
use crate::units::product::{UnitProduct, alternatives};
use polhode::num::Shown;

/// What limits the use of an estimate. Its `Display` is a sentence.
#[non_exhaustive]
#[derive(Clone, Debug, PartialEq)]
pub enum Warning {
    /// Samples of the same time were averaged.
    Merged {
        /// Samples that were merged into another.
        samples: usize,
    },
    /// Samples that repeat the reading before were left out: the log is written faster than the sensor reads.
    Repeated {
        /// Samples that were left out.
        samples: usize,
        /// The rate at which new readings come, 1/s.
        rate: f64,
    },
    /// Samples in which a sensor repeated its reading before were left out.
    Stale {
        /// Samples that were left out.
        samples: usize,
    },
    /// Samples at the end of the sensor's range were left out.
    Saturated {
        /// Samples that were left out.
        samples: usize,
    },
    /// Samples that stand out of their neighbours were left out.
    Spikes {
        /// Samples that were left out.
        samples: usize,
        /// Line of the first of them.
        line: usize,
    },
    /// Samples in bursts were left out: rows of them that stand out of the samples before and after.
    Bursts {
        /// Samples that were left out.
        samples: usize,
        /// Bursts in which they lie.
        bursts: usize,
        /// Line of the first of them.
        line: usize,
    },
    /// The residuals ask for a torque at random, which is more than a small part of what drives the body.
    TorqueNoise {
        /// Largest power spectral density of the angular acceleration among the segments, the mean of the three components, (rad/s²)² s.
        density: f64,
        /// Share of |dω/dt|² that free motion leaves unexplained, where it is known.
        unexplained: Option<f64>,
    },
    /// Segments were left out as too short: for the test functions, or for a motion of their own.
    ShortSegments {
        /// Segments that were left out.
        short: usize,
        /// Segments of the record.
        segments: usize,
    },
    /// The noise that the user states is not that of the readings.
    StatedNoise {
        /// Noise of one component as it is stated, rad/s.
        stated: f64,
        /// The same as the readings show it, rad/s.
        shown: f64,
    },
    /// The noise of the attitudes that the user states is more than theirs.
    StatedAttitudeNoise {
        /// Noise of one component as it is stated, rad.
        stated: f64,
        /// What the motion leaves of one component, rad.
        shown: f64,
    },
    /// The noise of readings is correlated from one to the next, as where these were averaged, filtered or interpolated before they were sampled.
    Filtered {
        /// Correlation of the noise of a reading with that of the next.
        correlation: f64,
        /// Deviation of the noise over many readings, over that which neighbours show.
        times: f64,
    },
    /// The residuals exceed the noise.
    Residuals {
        /// Root mean square of the residuals over the noise.
        times: f64,
        /// Noise of one component, rad/s.
        noise: f64,
    },
    /// The iteration had not converged where it ended.
    NotConverged {
        /// Standard deviations by which a further round would move the tensor.
        moved: f64,
    },
    /// Other units explain the record as well as those in which it was read.
    Units {
        /// What else the units may be, the smallest product first.
        products: Vec<UnitProduct>,
        /// Share of |dω/dt|² that free bodies leave unexplained in the units that were read.
        unexplained: f64,
        /// The same in the best of the others.
        other: f64,
    },
    /// The residuals are not white.
    Correlated(Whiteness),
    /// The residuals within one turn of the body are correlated.
    Memory(Memory),
    /// One residual stands out of all others, and of the torque noise: something happened there.
    Blow(Blow),
    /// The free motion of the tensor leaves more of the samples than their noise, and the equations do not see it.
    Vibration {
        /// Root mean square of what it leaves over the noise.
        times: f64,
        /// Noise of one component, rad/s.
        noise: f64,
    },
    /// The angular momentum |J ω| changes.
    MomentumTrend(InvariantTrend),
    /// The energy ω·J ω changes.
    EnergyTrend(InvariantTrend),
    /// Wheel momenta and torques of the record are zero in all its samples: they give the tensor no size, and the fit is that of a body without.
    ZeroInputs,
    /// Wheel momenta and torques of the record are too small to give the tensor its size, or give it a negative one.
    NoScale {
        /// One over the trace that they give, in its standard deviations.
        size: f64,
    },
    /// A torque was found and is part of the fit.
    Torque(FittedTorque),
    /// An error of the sensor, or of the momentum of wheels, explains the record without a torque as well as the torque that was chosen; the deviations reach both.
    AsWell {
        /// The error.
        error: ReadingError,
        /// Its largest component: an angle, rad, a ratio, an offset, rad/s, or a delay, s.
        size: f64,
        /// Log-likelihood with it less that with the torque.
        gain: f64,
    },
    /// Two tensors, one of the first segments and one of the rest, explain the record without a torque as well as the torque that was chosen.
    TwoTensors {
        /// The tensors, and the share of the equations of the first segments.
        parts: Halves,
        /// Log-likelihood with them less that with the torque.
        gain: f64,
    },
    /// A constant torque that is no part of the fit would explain the record better.
    ConstantTorque {
        /// Gain of log-likelihood with it, to first order.
        gain: f64,
        /// By how much it would turn the body within half of the longest segment, rad.
        turn: f64,
    },
    /// What the fit takes to be zero, as errors of the sensor, a wheel, a magnet, explains the record better than what was fitted.
    LeftOut {
        /// What it is, in words.
        what: &'static str,
        /// The largest of its components.
        size: f64,
        /// Its unit, empty for a ratio.
        unit: &'static str,
        /// Gain of log-likelihood with it, the torque noise as it was fitted without it.
        gain: f64,
        /// Where it comes from.
        origin: Origin,
    },
    /// An error of the sensor is larger than the standard deviation that was given for it allows.
    RefutedPrior {
        /// What it is, in words.
        what: &'static str,
        /// The largest of its components, where its deviation is that of a poor sensor.
        size: f64,
        /// The standard deviation that was given.
        prior: f64,
        /// The unit of both, empty for a ratio.
        unit: &'static str,
        /// Gain of log-likelihood by that other deviation, the torque noise as it was fitted without it.
        gain: f64,
    },
    /// Two parts of the record contradict each other.
    Halves(Halves),
    /// The parts of the record scatter by more than their noise; the deviations are enlarged accordingly.
    Scatter(Scatter),
    /// The parts of the record differ in unknowns beside the tensor by more than their noise; the deviations of these, and of what is
    /// correlated with them, are enlarged accordingly.
    Differing {
        /// Their names, each with the factor by which its deviation is enlarged.
        unknowns: Vec<(&'static str, f64)>,
    },
    /// The residuals of one segment exceed those of the median segment.
    NoisySegment {
        /// Which segment of the record, from 0.
        segment: usize,
        /// Its first time, s.
        start: f64,
        /// Root mean square of its residuals over that of the median segment.
        times: f64,
    },
    /// The physical law or a limit is active.
    Held(ActiveConstraint),
    /// The record contradicts the physical law or the limits.
    Contradiction {
        /// Distance, in standard deviations, from the unconstrained estimate.
        pull: f64,
    },
    /// The tensor is so uncertain that the linear covariance is only a guide.
    Uncertain {
        /// Standard deviation of the tensor, as a share of its trace.
        deviation: f64,
    },
    /// Two moments agree within their errors, so that their axes are arbitrary.
    EqualMoments {
        /// The lower of the two, from 1.
        low: usize,
        /// The higher, from 1.
        high: usize,
    },
    /// Attitudes were left out because they repeat the one before.
    RepeatedAttitudes {
        /// How many.
        samples: usize,
    },
    /// Attitudes were left out because they jump or stand out of the noise.
    Outliers {
        /// How many.
        samples: usize,
    },
    /// The body turns far between attitudes.
    CoarseAttitudes {
        /// Largest turn from one to the next, rad.
        turn: f64,
    },
    /// What the motion leaves of the attitudes exceeds their noise.
    AttitudeResiduals {
        /// Over the noise.
        times: f64,
        /// The noise of a component, rad.
        noise: f64,
    },
    /// The axes of rates and attitudes move against each other.
    MovingAxes {
        /// By how much from the first sample to the last, rad.
        turn: f64,
        /// Gain of log-likelihood with that.
        gain: f64,
    },
    /// The rates beside attitudes have a constant offset.
    RateOffset {
        /// Its length, rad/s.
        size: f64,
        /// Gain of log-likelihood with it, by one step of least squares.
        gain: f64,
        /// Whether the fit takes it out.
        is_fitted: bool,
    },
    /// The rates beside attitudes have an error of scale.
    RateScale {
        /// The share by which they are too large.
        scale: f64,
        /// Gain of log-likelihood with it, by one step of least squares.
        gain: f64,
        /// Whether the fit takes it out.
        is_fitted: bool,
    },
    /// What the motion leaves of the rates beside attitudes exceeds their noise.
    RateResiduals {
        /// Over the noise.
        times: f64,
        /// The noise of a component, rad/s.
        noise: f64,
    },
    /// The likelihood falls less than a normal distribution would: the deviations are those at which it falls as far.
    Profile {
        /// The deviation of the tensor over that of the second derivative of the likelihood.
        times: f64,
    },
    /// Few equations beyond the unknowns.
    FewEquations {
        /// Degrees of freedom.
        dof: usize,
    },
}

impl fmt::Display for Warning {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Merged { samples } => {
                write!(f, "{} merged with the sample of the same time", counted(*samples))
            }
            Self::Repeated { samples, rate } => write!(
                f,
                "{} left out as repeated readings: the log is written faster than the sensor reads; new readings come at {} Hz",
                counted(*samples),
                four_digits(*rate)
            ),
            Self::Stale { samples } => write!(
                f,
                "{} left out as repeating the reading before: the sensor or its log stalled there",
                counted(*samples)
            ),
            Self::Saturated { samples } => {
                let (subject, verb) = if *samples == 1 { ("sample", "was") } else { ("samples", "were") };
                write!(f, "{samples} {subject} at the end of the sensor's range (saturated) {verb} left out")
            }
            Self::Spikes { samples, line } => write!(
                f,
                "{} left out as far from what the neighbouring samples predict (spikes); the first is in line {line}",
                counted(*samples)
            ),
            Self::Bursts { samples, bursts, line } => {
                let plural = if *bursts == 1 { "burst" } else { "bursts" };
                write!(
                    f,
                    "{} left out in {bursts} {plural} of consecutive samples, far from those before and after, which agree with each \
                     other; the first is in line {line}",
                    counted(*samples)
                )
            }
            Self::TorqueNoise { density, unexplained } => {
                write!(
                    f,
                    "torque noise is part of the fit: its angular acceleration has a power spectral density of up to {density:.1e} \
                     (rad/s^2)^2 s"
                )?;
                if let Some(share) = unexplained {
                    write!(f, "; free motion leaves {} of the squared angular acceleration unexplained", per_cent(*share))?;
                }
                f.write_str("; errors of the measurement may look like torque noise")
            }
            Self::ShortSegments { short, segments } => {
                let verb = if *short == 1 { "was" } else { "were" };
                write!(f, "{short} of {segments} segments {verb} left out as too short for the fit")
            }
            Self::StatedNoise { stated, shown } => write!(
                f,
                "the stated noise is {stated:.2e} rad/s, and the readings show {shown:.2e} rad/s: {UNSTATED}"
            ),
            Self::StatedAttitudeNoise { stated, shown } => write!(
                f,
                "the stated noise of the attitudes is {stated:.2e} rad, and they show {shown:.2e} rad, so that the standard deviations are too large: {UNSTATED}"
            ),
            Self::Filtered { correlation, times } => write!(
                f,
                "the noise of neighbouring readings has the correlation {correlation:.2}: the sensor or the log may average, filter or \
                 interpolate. Over many readings the noise is {times:.1} times what neighbours show. Standard deviations that the residuals \
                 have not enlarged may be too small by up to this factor, and fitted torque noise may be noise of the readings"
            ),
            Self::Residuals { times, noise } => {
                let times = if *times < 1e4 { format!("{times:.1}") } else { format!("{times:.1e}") };
                write!(
                    f,
                    "the residuals are {times} times what the noise of {noise:.2e} rad/s explains: torques, outliers, or a sensor that \
                     filters; the standard deviations are enlarged by this factor"
                )
            }
            Self::NotConverged { moved } => write!(
                f,
                "the iteration did not converge: a further round would move the tensor by {moved:.2} standard \
                 deviations"
            ),
            Self::Units { products, unexplained, other } => write!(
                f,
                "the record cannot tell its units: with {}, another body would explain it as well ({} of the squared angular acceleration \
                 unexplained, {} as read); check the units",
                alternatives(products),
                per_cent(*other),
                per_cent(*unexplained)
            ),
            Self::Memory(Memory { chi2, dof }) => write!(
                f,
                "residuals within one turn of the body are correlated (chi squared {chi2:.0} of {dof} degrees of freedom): a torque acts that \
                 is not white noise, such as that of a magnet, a fluid or a moving part, or the sensor has errors; the standard deviations do \
                 not include this"
            ),
            Self::Blow(Blow { segment, time, deviations }) => write!(
                f,
                "at {time:.3} s of segment {} the residual of the equations is {deviations:.1} standard deviations, more than noise explains: \
                 a blow, or a sudden change of the body or the sensor. The tensor may be wrong by more than its standard deviations; fit the \
                 parts before and after separately",
                segment + 1
            ),
            Self::Vibration { times, noise } => write!(
                f,
                "the samples differ from the free motion of this tensor by {times:.2} times their noise of {noise:.3e} rad/s: a part of the \
                 body moves or vibrates, or the sensor has errors"
            ),
            Self::Correlated(Whiteness { correlation, sigma }) => write!(
                f,
                "the correlation of neighbouring residuals is {correlation:.2} +- {sigma:.2}: the noise is not white, or the model is wrong"
            ),
            Self::MomentumTrend(trend) => torque(f, "momentum |J w|", trend),
            Self::EnergyTrend(trend) => torque(f, "energy w J w", trend),
            Self::ZeroInputs => f.write_str(
                "the wheel momenta and torques of the record are zero in all samples: the fit is that of a body without them, and the size of \
                 the tensor is unknown; if a wheel turned, give its momentum",
            ),
            Self::NoScale { size } if *size < -NEGATIVE => write!(
                f,
                "the wheel momenta and torques give the tensor a negative size, by {:.0} standard deviations: their sign is wrong",
                -size
            ),
            Self::NoScale { .. } => f.write_str(
                "the size of the tensor is unknown: the effect of the wheel momenta and torques does not exceed the noise",
            ),
            Self::Torque(torque) => reckoned(f, torque),
            Self::AsWell { error, size, gain } => write!(
                f,
                "instead of this torque, {} of up to {} would explain the record as well (log-likelihood {} by {:.1}); the standard \
                 deviations cover both",
                error.in_words(),
                error.of_size(*size),
                if *gain < 0.0 { "lower" } else { "higher" },
                gain.abs()
            ),
            Self::TwoTensors { parts: Halves { share, first, second, .. }, gain } => write!(
                f,
                "instead of this torque, two tensors would explain the record as well (log-likelihood {} by {:.1}): I1 : I2 : I3 = {} for the \
                 first {:.0} % and {} for the rest. Check that all segments are of one body, with the sensor fixed to it in the same way. The \
                 standard deviations do not include this",
                if *gain < 0.0 { "lower" } else { "higher" },
                gain.abs(),
                moments(first),
                100.0 * share,
                moments(second)
            ),
            Self::ConstantTorque { gain, turn } => write!(
                f,
                "a constant torque, which is not part of the fit, would explain the record better (log-likelihood higher by {gain:.1}). It would \
                 turn the body by {turn:.2} rad within half of the longest segment; fit it in windows so short that this is less than {LINEAR} \
                 rad, or fit the rates"
            ),
            Self::LeftOut { what, size, unit, gain, origin } => {
                let size = format!("{size:.1e} {unit}");
                write!(
                    f,
                    "{what}, up to {}, would explain the record better than the fitted model (log-likelihood higher by {gain:.0}): \
                     the tensor may be wrong by more than its standard deviations{}",
                    size.trim_end(),
                    origin.remedy()
                )
            }
            Self::RefutedPrior { what, size, prior, unit, gain } => {
                let (times, size, prior) =
                    (size / prior, format!("{size:.1e} {unit}"), format!("{prior:.1e} {unit}"));
                write!(
                    f,
                    "{what}, up to {}, {times:.0} times the prior standard deviation of {} that was given, would explain the record better \
                     (log-likelihood higher by {gain:.0}): the tensor may be wrong by more than its standard deviations; give a larger prior \
                     standard deviation",
                    size.trim_end(),
                    prior.trim_end()
                )
            }
            Self::Halves(Halves { share, first, second, chi2 }) => write!(
                f,
                "the first {:.0} % of the record give I1 : I2 : I3 = {}, the rest {} (chi squared {chi2:.0} of 5 degrees of freedom): the tensor \
                 changes, for instance because something moves in the body, or a torque or an error of the sensor is not part of the fit",
                100.0 * share,
                of_part(first),
                of_part(second)
            ),
            Self::Scatter(scatter @ Scatter { parts, chi2, dof }) => write!(
                f,
                "the tensors of {parts} parts of the record scatter by more than their noise (chi squared {chi2:.0} of {dof} degrees of \
                 freedom): the tensor changes, or a torque or an error of the sensor is not part of the fit; the standard deviations are \
                 enlarged by a factor of {:.1}",
                scatter.excess().sqrt()
            ),
            Self::Differing { unknowns } => {
                f.write_str("the parts of the record differ by more than their noise in ")?;
                for (k, (name, times)) in unknowns.iter().enumerate() {
                    let comma = if k > 0 { ", " } else { "" };
                    write!(f, "{comma}{name} (standard deviation enlarged by a factor of {times:.1})")?;
                }
                f.write_str(
                    ": the torque has another form than that of the fit, or the sensor changes; the standard deviations of what is correlated \
                     with these grow too",
                )
            }
            Self::NoisySegment { segment, start, times } => write!(
                f,
                "segment {} (from {start} s) has {times:.1} times the residuals of the median segment: check it",
                segment + 1
            ),
            Self::Held(ActiveConstraint { constraint, multiplier }) => {
                write!(f, "{constraint} is an active constraint (Lagrange multiplier {multiplier:.3e})")
            }
            Self::Contradiction { pull } => write!(
                f,
                "the physical limits (I1 + I2 >= I3, no negative drag) and those that were given move the tensor by {pull:.1} standard \
                 deviations: the record contradicts them"
            ),
            Self::Uncertain { deviation } => write!(
                f,
                "the tensor has a standard deviation of {:.1} per cent of its trace; above half a per cent its covariance, which is computed to \
                 first order, is only approximate",
                100.0 * deviation
            ),
            Self::EqualMoments { low, high } => write!(
                f,
                "moments {low} and {high} agree within their standard deviations: the directions of their axes are undetermined"
            ),
            Self::RepeatedAttitudes { samples } => {
                write!(f, "{} left out as repeating the attitude before", counted(*samples))
            }
            Self::Outliers { samples } => write!(
                f,
                "{} left out as far from the fitted motion, in attitude or rate",
                counted(*samples)
            ),
            Self::CoarseAttitudes { turn } => write!(
                f,
                "from one attitude to the next the body turns by up to {turn:.2} rad: a turn by {:.2} rad the other way round would give the \
                 same attitudes; make sure that the body is not that fast",
                core::f64::consts::TAU - turn
            ),
            Self::AttitudeResiduals { times, noise } => write!(
                f,
                "the residuals of the attitudes are {times:.1} times what their noise of {noise:.2e} rad explains: torques, or errors that last \
                 over many attitudes; the standard deviations are enlarged by this factor"
            ),
            Self::MovingAxes { turn, gain } => write!(
                f,
                "the axes of attitudes and rates turn against each other by {turn:.2e} rad from the first sample to the last (log-likelihood \
                 higher by {gain:.0}): the fit includes a uniform turn; fix both sensors to the body, or compare their clocks"
            ),
            Self::RateOffset { size, gain, is_fitted } => write!(
                f,
                "an offset of the rates of {size:.1e} rad/s explains the record better (log-likelihood higher by {gain:.0}); {}. Calibrate the \
                 gyroscope at rest",
                taken_out(*is_fitted)
            ),
            Self::RateScale { scale, gain, is_fitted } => write!(
                f,
                "a scale error of the rates of {:+.2} % explains the record better (log-likelihood higher by {gain:.0}); {}. Calibrate the \
                 gyroscope",
                100.0 * scale,
                taken_out(*is_fitted)
            ),
            Self::RateResiduals { times, noise } => write!(
                f,
                "the residuals of the rates are {times:.1} times what their noise of {noise:.2e} rad/s explains: torques, or errors of the \
                 gyroscope that last over many samples, such as a delay or axes that are not at right angles; the standard deviations are \
                 enlarged by this factor"
            ),
            Self::Profile { times } => write!(
                f,
                "tensors far from this one explain the record nearly as well: the standard deviations are enlarged by a factor of {times:.1} to \
                 include them; a motion with more wobble, or a longer record, would tell them apart"
            ),
            Self::FewEquations { dof } => {
                write!(f, "only {dof} degrees of freedom: chi squared is not a reliable check")
            }
        }
    }
}

/// What the fit makes of an error of the rates.
fn taken_out(is_fitted: bool) -> &'static str {
    if is_fitted {
        "the fit corrects for it"
    } else {
        "it is not part of the fit, and the tensor may be wrong by more than its standard deviations"
    }
}

/// The moments by a part of a record, which may tell no more than that it is no rotation of a body.
fn of_part(shares: &[f64; 3]) -> String {
    let is_of_body = shares[0] > -BEYOND && shares[2] < LARGEST_SHARE + BEYOND;
    moments(shares) + if is_of_body { "" } else { ", which no rigid body has" }
}

/// As shares of the trace.
fn moments([a, b, c]: &[f64; 3]) -> String {
    format!("{a:.4} : {b:.4} : {c:.4}")
}

fn torque(f: &mut fmt::Formatter<'_>, name: &str, trend: &InvariantTrend) -> fmt::Result {
    let change = with_sigma(100.0 * trend.rate, 100.0 * trend.sigma);
    write!(f, "not free of torques: the {name} changes by {change} per cent per second")
}

fn reckoned(f: &mut fmt::Formatter<'_>, torque: &FittedTorque) -> fmt::Result {
    let values =
        torque.coefficients.iter().map(|c| format!("{} {} {}", c.name, with_sigma(c.value, c.sigma), c.unit));
    let values: Vec<String> = values.collect();
    write!(f, "not free of torques: the fit includes {}", values.join(", "))?;
    match torque.ratios_without {
        Some([first, second]) => write!(f, "; without it I1/I3 would be {first:.4} and I2/I3 {second:.4}"),
        None => Ok(()),
    }
}

/// `x` to four digits.
fn four_digits(x: f64) -> Shown {
    Shown(format!("{x:.3e}").parse().unwrap_or(x))
}

/// "1 sample was", "2 samples were".
fn counted(count: usize) -> String {
    if count == 1 { "1 sample was".into() } else { format!("{count} samples were") }
}

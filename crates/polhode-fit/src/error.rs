//! Why a fit is refused.

use polhode::num::Shown;
use polhode::units::RateUnit;
use thiserror::Error;

use crate::models::reading_error::two_digits;
use crate::physical::constraint::Constraint;
use crate::physical::failure::SolverFailure;
use crate::poses::fault::PoseFault;
use crate::report::averages::AverageAxis;
use crate::report::identifiability::Identifiability;
use crate::thresholds::noise::MOST;
use crate::thresholds::test_functions::TESTS_PER_RADIUS;
use crate::units::product::{UnitProduct, alternatives};

/// Two constraints that no physically valid tensor meets together.
#[non_exhaustive]
#[derive(Clone, Debug, PartialEq)]
pub struct Clash {
    /// The first of the two.
    pub first: Constraint,
    /// The second of the two.
    pub second: Constraint,
    /// By how much each would have to be relaxed, as a share of the trace; negative where both can be met.
    pub gap: f64,
}

/// How many times as large as the record says a component of the momentum of wheels is.
#[non_exhaustive]
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ToldComponent {
    /// Its axis: 0, 1 or 2.
    pub axis: usize,
    /// How many times as large, the others as told.
    pub factor: f64,
    /// Its standard deviation.
    pub sigma: f64,
}

/// What helps against a noise that is stated and is not that of the readings.
pub(crate) const UNSTATED: &str =
    "check its value and its unit, or leave it out, so that the samples give it";

impl From<FitError> for polhode::Error {
    fn from(error: FitError) -> Self {
        polhode::Error::new(error)
    }
}

/// Why a fit was refused.
#[non_exhaustive]
#[derive(Clone, Debug, PartialEq, Error)]
pub enum FitError {
    /// Too few samples for even one test function.
    #[error(
        "{samples} samples, at most {longest} without a gap (segments: {segments}, left out as saturated: \
         {saturated}); a fit needs a segment of at least {needed} samples: record longer or faster{}",
        if *saturated > 0 { ", with a sensor of a larger range" } else { "" }
    )]
    TooFewSamples {
        /// Samples.
        samples: usize,
        /// Segments.
        segments: usize,
        /// Samples of the longest segment.
        longest: usize,
        /// Samples left out for flat tops.
        saturated: usize,
        /// Fewest samples of a usable segment.
        needed: usize,
    },
    /// The angular velocity is zero, or a quarter and more of its mean square is noise.
    #[error(
        "the rotation is too slow for the noise: the rates have a root mean square of {rms:.3e} rad/s, their noise is \
         {noise:.3e} rad/s; spin the body{}", faster(*noise)
    )]
    NoRotation {
        /// Root mean square rate, rad/s.
        rms: f64,
        /// Noise of a component, rad/s.
        noise: f64,
    },
    /// A quarter and more of the mean square rate would be noise as it is stated, and not as the readings show it.
    #[error(
        "the stated noise of {stated:.2e} rad/s is {} times the {shown:.2e} rad/s that neighbouring readings show, and too large \
         for rates of a root mean square of {rms:.3e} rad/s: {}",
        two_digits(*stated / *shown), UNSTATED
    )]
    StatedNoise {
        /// Root mean square rate, rad/s.
        rms: f64,
        /// Noise of a component as it is stated, rad/s.
        stated: f64,
        /// The same as neighbouring readings show it, rad/s.
        shown: f64,
    },
    /// The record determines fewer than five numbers of the tensor.
    #[error("the record does not determine the tensor: {}. {}", .0.verdict(), capital(&.0.next_record()))]
    Unidentifiable(Box<Identifiability>),
    /// The iteration did not converge at any radius of the test functions, although the rates change.
    #[error(
        "the rates change, but the iteration did not converge ({rounds} rounds at each half width of the test functions). The noise \
         of {noise:.3e} rad/s may hide the motion, torques may act, or the body may be slender: record longer, with a larger \
         wobble{}{}{}{}",
        slowed(*fall), smaller(*factor), known(axes), left_handed(mirror.as_deref())
    )]
    Unsettled {
        /// Rounds of reweighting at each radius.
        rounds: usize,
        /// Noise of a component, rad/s.
        noise: f64,
        /// Factor on rate × time from which on units would explain the record, if they do.
        factor: Option<f64>,
        /// What is known all the same, if no torque acted.
        axes: Vec<AverageAxis>,
        /// Relative rate at which the rotation slows, 1/s, where it does and no torque was to be fitted.
        fall: Option<f64>,
        /// Moments, shares of the trace, of the body that explains the record if its axes are left-handed.
        mirror: Option<Box<[f64; 3]>>,
    },
    /// An axis reads one number all the time, and the others read noise.
    #[error(
        "the rate about {axis} is {} rad/s in all {samples} samples of {place}, while the other axes have a noise of {noise:.2e} rad/s: \
         this axis is saturated, or is not read; use a larger range, or check its column",
        Shown(*value)
    )]
    HeldAxis {
        /// Which segment.
        place: String,
        /// x, y or z.
        axis: char,
        /// What it reads, rad/s.
        value: f64,
        /// Samples of the segment.
        samples: usize,
        /// Deviation of the noise of the others, rad/s.
        noise: f64,
    },
    /// Two axes read the same numbers, down to their noise, or one reads the negative of the other.
    #[error(
        "the rates about {} and {} agree up to their sign in all {samples} samples of {place}, their noise of {noise:.2e} rad/s \
         included: one column was read for both axes; name the columns of all three axes",
        axes[0], axes[1]
    )]
    SameAxes {
        /// Which segment.
        place: String,
        /// x, y or z.
        axes: [char; 2],
        /// Samples of the segment.
        samples: usize,
        /// Deviation of their noise, rad/s.
        noise: f64,
    },
    /// Errors of the sensor that were to be fitted leave the tensor open, which the record tells without them.
    #[error(
        "the record cannot separate the errors of the sensor that are to be fitted from the tensor; without them the fit has an answer. \
         Give them smaller standard deviations, fit fewer of them or none, or record longer or faster"
    )]
    UntoldSensor,
    /// Momenta of wheels or torques of the record contradict its rates.
    #[error(
        "the wheel momenta and torques of the record contradict its rates: with them the best tensor leaves {} of the squared angular \
         acceleration unexplained. Check their axes, signs and units. A record with the wheels at rest and without these torques shows \
         whether something else drives the body",
        per_cent(*unexplained)
    )]
    Contradicted {
        /// Share of the squared derivative of the rates.
        unexplained: f64,
    },
    /// Components of the momentum of wheels stand in another order, or have other signs, than the rates tell.
    #[error(
        "the momentum of the wheels contradicts the rates, but ({}) in place of (hx, hy, hz) would explain them: check the order, the \
         signs and the axes of its components",
        components(*order, *signs)
    )]
    Exchanged {
        /// Which component of the record stands for each.
        order: [usize; 3],
        /// Sign of each.
        signs: [f64; 3],
    },
    /// One component of the momentum of wheels is larger or smaller than what the record says.
    #[error(
        "the momentum of the wheels contradicts the rates, but would explain them if {}: check the inertia, the axis and the speed of each wheel",
        so_many_times(.0)
    )]
    Told(Vec<ToldComponent>),
    /// The momenta of wheels and the torques of the record are zero throughout, and a wheel explains it, or the fit of a body without any is
    /// refused, and why.
    #[error(
        "the wheel momenta and torques of the record are zero in all samples, so that they do not give the size, and a body without wheels \
         does not move like this. Give the momenta of the wheels, or leave the columns out if there are no wheels{}",
        .0.as_ref().map_or(String::new(), |error| format!(". Without wheels: {error}"))
    )]
    ZeroInputs(Option<Box<FitError>>),
    /// Torques drive the body: its motion is not that of a free one.
    #[error(
        "torques drive the body, so that the record does not determine its tensor: {}; throw the body, fit only the part of the record \
         in which it is free, or check the units",
        driven(*unexplained, *growth, *pull)
    )]
    Driven {
        /// Share of |dω/dt|² that the motion of a free body under drag and a constant torque leaves unexplained.
        unexplained: Option<f64>,
        /// Relative change of |J ω| per second.
        growth: f64,
        /// Standard deviations by which the physical law moves the tensor.
        pull: f64,
    },
    /// Attitudes that cannot be fitted.
    #[error(transparent)]
    Poses(#[from] PoseFault),
    /// Nowhere in the record does the body rotate freely.
    #[error(
        "the body rotates freely nowhere in the record: torques above 0.3 tr(J) |w|^2 act in {:.0} per cent of the time in \
         which it turns, and {}; throw the body, or choose the window yourself",
        100.0 * share, nearest(*torque, *most)
    )]
    NoFlight {
        /// Share of the time with a turning body in which large torques act.
        share: f64,
        /// Least torque of a window that drag does not explain, over the trace times |ω|²; `None` without a window.
        torque: Option<f64>,
        /// Largest of a flight.
        most: f64,
    },
    /// Other units of the rates or times explain the record, and those in which it was read do not.
    #[error(
        "the units look mistaken: {}? Free motion would then leave {} of the squared angular acceleration unexplained; as read it leaves {}. \
         The motion depends only on the product of rate and time. Name the units, or switch this check off. To find them, turn the sensor \
         once about one axis: the sum of rate times time step is 6.28 in rad/s and s, 360 in deg/s and s",
        alternatives(products), per_cent(*better), per_cent(*unexplained)
    )]
    Units {
        /// What the units may be, the smallest product first.
        products: Vec<UnitProduct>,
        /// Share of |dω/dt|² that free bodies leave unexplained in the units that were read.
        unexplained: f64,
        /// The same in the best of the others.
        better: f64,
    },
    /// The body turns by more than half a turn from sample to sample.
    #[error(
        "from one sample to the next, a time step of {step:.3e} s, the body turns by {turn:.3e} rad: beyond pi = 3.14 rad samples do not \
         determine a motion; the units of rates or times are probably mistaken, else record more than {:.3e} samples a second",
        *turn / (core::f64::consts::PI * *step)
    )]
    Undersampled {
        /// Median of |ω| Δt, rad.
        turn: f64,
        /// Median of Δt, s.
        step: f64,
    },
    /// Limits that exclude each other.
    #[error("{} and {} exclude each other: each would have to be relaxed by {:.3e} of the trace", demand(&.0.first), demand(&.0.second), .0.gap)]
    Contradiction(Box<Clash>),
    /// Limits that leave less than a millionth of the trace between them.
    #[error("{} and {} leave no room between them; widen each by at least a millionth of the trace", demand(&.0.first), demand(&.0.second))]
    NoRoom(Box<Clash>),
    /// Coefficients of a torque that the record cannot tell.
    #[error(
        "the record does not determine {}{}: ask for a simpler torque, or record longer, with a larger wobble, or several throws \
         about different axes", names.join(", "),
        if *rank < 5 { format!(" together with the tensor, of which it determines {rank} of 5 numbers with them, and all 5 without") }
        else { String::new() }
    )]
    Untold {
        /// Their names.
        names: Vec<&'static str>,
        /// How many of the five numbers of the tensor are determined with them.
        rank: usize,
    },
    /// A momentum or an energy is to give the size, and what was fitted changes it, or the readings that tell its mean.
    #[error(
        "{quantity} gives the size of the tensor only if it is constant and read without errors of the sensor, but {} fitted too: \
         give the trace or the moment about an axis instead, or leave it out for the shape alone",
        were(names)
    )]
    SizeVaries {
        /// The angular momentum or the kinetic energy.
        quantity: &'static str,
        /// Names of the coefficients that were fitted.
        names: Vec<&'static str>,
    },
    /// A momentum or an energy is to give the size, and differs between the segments.
    #[error(
        "{quantity} gives the size of the tensor only if it is the same in all segments, but that of segment {} is {factor:.3} times \
         that of segment {}: fit only the segment to which it belongs, give the trace or the moment about an axis instead, or leave it \
         out for the shape alone",
        largest + 1, smallest + 1
    )]
    SizeDiffers {
        /// The angular momentum or the kinetic energy.
        quantity: &'static str,
        /// The largest over the smallest.
        factor: f64,
        /// The segment of the largest, from 0.
        largest: usize,
        /// The segment of the smallest, from 0.
        smallest: usize,
    },
    /// A wheel is to be calibrated from a record that does not tell its speed.
    #[error(
        "no wheel turns in the record: record again with the wheel turning; each segment needs its speed, which must not be zero throughout"
    )]
    NoWheelSpeed,
    /// A wheel is to be calibrated from a record that has torques.
    #[error(
        "the record has torques: calibrate a wheel from records in which no torque but that of the air acts"
    )]
    WheelWithTorques,
    /// The moment of a wheel that is to be found would be negative.
    #[error(
        "the moment of inertia of the wheel would be {value:.3e} +- {sigma:.1e} kg m^2, {:.1} standard deviations below zero: reverse the axis of \
         the wheel, or the sign of its speed",
        -*value / *sigma
    )]
    WheelSense {
        /// The moment, kg m².
        value: f64,
        /// Its standard deviation, kg m².
        sigma: f64,
    },
    /// Segments that hold different quantities.
    #[error(
        "{with} has {what} and {without} has none: give them for both, as zeros where no wheel turns and no torque acts, or \
         fit the two separately"
    )]
    Sensors {
        /// The quantity.
        what: &'static str,
        /// The first segment that has it.
        with: String,
        /// The first that has not.
        without: String,
    },
    /// A segment whose rates have a unit beside one whose unit is a guess.
    #[error(
        "{named} is in {unit} by its header, and {unnamed} names no unit and would be read in rad/s: name the unit of both"
    )]
    MixedUnits {
        /// The segment whose unit is named.
        named: String,
        /// Its unit.
        unit: RateUnit,
        /// The first segment whose unit is not.
        unnamed: String,
    },
    /// The covariance of a prior tensor is not one.
    #[error(
        "{}; give a symmetric one without eigenvalues that are zero or negative",
        if *symmetric { format!("the covariance of the prior tensor is not positive definite: its smallest eigenvalue is {least:.3e} (kg m^2)^2") }
        else { "the covariance of the prior tensor is not symmetric".into() }
    )]
    PriorCovariance {
        /// Its smallest eigenvalue, (kg m²)²; NaN where an entry is not finite.
        least: f64,
        /// Whether it is symmetric.
        symmetric: bool,
    },
    /// The prior tensor and a limit, or the physical law, exclude each other.
    #[error(
        "the prior tensor and {} exclude each other: it lies {pull:.1} of its standard deviations outside; check the \
         signs of its products of inertia, give it larger standard deviations, or leave one of the two out",
        demand(constraint)
    )]
    PriorOutside {
        /// The limit or the law.
        constraint: Constraint,
        /// Distance, in standard deviations of the prior.
        pull: f64,
    },
    /// The prior tensor and the record exclude each other.
    #[error(
        "the prior tensor and the record exclude each other: (xx, yy, zz, xy, xz, yz) over the trace is {} by the prior \
         and {} by the record, chi squared {chi2:.1} of {dof} degrees of freedom; check the axes of the prior, the signs of its \
         products of inertia and its unit, give it larger standard deviations, or leave it out{}",
        six(prior),
        six(record),
        left_handed(mirror.as_deref())
    )]
    PriorContradicted {
        /// Entries xx, yy, zz, xy, xz, yz of the prior, over its trace.
        prior: [f64; 6],
        /// The same of what the record says.
        record: Box<[f64; 6]>,
        /// Square of their distance in standard deviations of it.
        chi2: f64,
        /// Its degrees of freedom.
        dof: usize,
        /// Moments, shares of the trace, of the body that agrees with the prior if the axes of the record are left-handed.
        mirror: Option<Box<[f64; 3]>>,
    },
    /// The prior tensor has another size than the known quantity says.
    #[error(
        "the prior tensor has the trace {prior:.4e} +- {sigma:.1e} kg m^2, and the known quantity gives {known:.4e} kg m^2: \
         they exclude each other; correct one of them, or give the prior as a shape"
    )]
    PriorSize {
        /// Trace of the prior, kg m².
        prior: f64,
        /// Its standard deviation, kg m².
        sigma: f64,
        /// Trace by the known quantity, kg m².
        known: f64,
    },
    /// The axis of a limit has no direction.
    #[error("limit {limit} has the axis {axis:?}; it must be a finite vector that is not zero")]
    LimitAxis {
        /// Which limit, from 1.
        limit: usize,
        /// Its axis.
        axis: [f64; 3],
    },
    /// The value of a limit is not a share of the trace.
    #[error("limit {limit} is {value}; it must be a share of the trace, from 0 to 1")]
    LimitValue {
        /// Which limit, from 1.
        limit: usize,
        /// Its value.
        value: f64,
    },
    /// A setting that must be positive and finite is not.
    #[error(
        "{name} is {value:?}; it must be a positive number whose square neither underflows nor overflows"
    )]
    Setting {
        /// Which one.
        name: &'static str,
        /// Its value.
        value: f64,
    },
    /// The size of the tensor is given twice.
    #[error(
        "the wheel momenta or torques of the record give the size of the tensor, and so does the known quantity; leave out one of them"
    )]
    TwoScales,
    /// Test functions that no segment has room for.
    #[error(
        "a radius (half width of the test functions) of {radius} s needs a segment of {:.4} s, for two of them with at least {needed} samples \
         each; the longest lasts {longest} s: give a smaller radius, or record longer", (2.0 + 0.5 / TESTS_PER_RADIUS) * radius
    )]
    Radius {
        /// The radius, s.
        radius: f64,
        /// Duration of the longest segment, s.
        longest: f64,
        /// Fewest samples in one test function.
        needed: usize,
    },
    /// Test functions so short that their equations are nearly as many as the samples.
    #[error(
        "a radius (half width of the test functions) of {radius} s gives nearly as many equations as there are samples, so that the \
         covariance of their noise is singular; give a larger radius"
    )]
    Dense {
        /// The radius, s.
        radius: f64,
    },
    /// The program for the nearest physical tensor has no certified answer.
    #[error("the search for the physically valid tensor that fits best failed: {0}")]
    Solver(SolverFailure),
}

/// The law said in full, where it stands against a limit.
fn demand(constraint: &Constraint) -> String {
    match constraint {
        Constraint::Triangle => "the law I1 + I2 >= I3 (a moment is at most half the trace)".into(),
        limit => limit.to_string(),
    }
}

fn six(entries: &[f64; 6]) -> String {
    format!("({})", entries.map(|entry| format!("{entry:.4}")).join(", "))
}

fn nearest(torque: Option<f64>, most: f64) -> String {
    torque.filter(|torque| *torque > most).map_or("no part with free rotation is long enough for a fit".into(), |torque| {
        format!("the part nearest to free rotation with drag has torques of {torque:.3} tr(J) |w|^2, where at most {most} is allowed")
    })
}

/// Components of a momentum in another order and with signs.
fn components(order: [usize; 3], signs: [f64; 3]) -> String {
    let each = order.iter().zip(signs);
    let names =
        each.map(|(&k, sign)| format!("{}h{}", if sign < 0.0 { "-" } else { "" }, ["x", "y", "z"][k]));
    names.collect::<Vec<_>>().join(", ")
}

/// Components of a momentum with their factors.
fn so_many_times(told: &[ToldComponent]) -> String {
    let each = told.iter().map(|told| {
        let ToldComponent { axis, factor, sigma } = told;
        format!(
            "h{} were {} times what the record has",
            ["x", "y", "z"][(*axis).min(2)],
            with_sigma(*factor, *sigma)
        )
    });
    each.collect::<Vec<_>>().join(", or ")
}

/// Both to two digits of the deviation.
pub(crate) fn with_sigma(value: f64, sigma: f64) -> String {
    let digits = if sigma > 0.0 { 1.0 - libm::floor(libm::log10(sigma)) } else { 2.0 };
    let digits = digits.clamp(0.0, 15.0) as usize;
    format!("{value:.digits$} +- {sigma:.digits$}")
}

fn were(names: &[&str]) -> String {
    format!("{} {}", names.join(", "), if names.len() == 1 { "was" } else { "were" })
}

/// A share in per cent, to two digits.
pub(crate) fn per_cent(share: f64) -> String {
    let value = 100.0 * share;
    if value >= 10.0 {
        format!("{value:.0} %")
    } else if value >= 1.0 {
        format!("{value:.1} %")
    } else if value >= 1e-3 {
        format!("{} %", two_digits(value))
    } else {
        "less than 0.001 %".into()
    }
}

fn left_handed(moments: Option<&[f64; 3]>) -> String {
    moments.map_or(String::new(), |[a, b, c]| {
        format!(
            ". A mirrored axis would explain it: in left-handed axes (one reversed, or two exchanged) the record is that of a body \
             with I1 : I2 : I3 = {a:.4} : {b:.4} : {c:.4}"
        )
    })
}

fn driven(unexplained: Option<f64>, growth: f64, pull: f64) -> String {
    let mut facts = Vec::new();
    if let Some(share) = unexplained.filter(|share| *share >= 0.01) {
        facts.push(format!(
            "free motion with drag and a constant torque leaves {} of the squared angular acceleration unexplained",
            per_cent(share)
        ));
    }
    if growth > 0.0 && growth.is_finite() {
        facts.push(format!("|J w| grows by {:.2} per cent per second", 100.0 * growth));
    }
    if pull > 1.0 {
        facts.push(format!("the physical limits (I1 + I2 >= I3, no negative drag) move the tensor by {pull:.1} standard deviations"));
    }
    facts.join(", ")
}

fn slowed(fall: Option<f64>) -> String {
    fall.map_or(String::new(), |fall| {
        format!(". The rates fall by {:.2} per cent per second: let the fit include drag", 100.0 * fall)
    })
}

fn smaller(factor: Option<f64>) -> String {
    factor.map_or(String::new(), |factor| {
        format!(
            ". Check the units: with rate times time {factor:.4} times as large, or larger, a nearly spherical body would move like this"
        )
    })
}

/// The rate from which on noise is at most a quarter of the mean square.
fn faster(noise: f64) -> String {
    let needed = noise * (3.0 / MOST - 3.0).sqrt();
    if needed > 0.0 { format!(" at {needed:.1e} rad/s or faster") } else { String::new() }
}

/// With a capital letter first.
pub(crate) fn capital(words: &str) -> String {
    let mut letters = words.chars();
    letters.next().map_or(String::new(), |first| first.to_uppercase().chain(letters).collect())
}

fn known(axes: &[AverageAxis]) -> String {
    axes.iter().map(|axis| format!(". Known: {axis}")).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn shares_are_printed_to_two_digits() {
        for (share, text) in [
            (0.5, "50 %"),
            (0.123, "12 %"),
            (0.1, "10 %"),
            (0.0456, "4.6 %"),
            (0.0104, "1.0 %"),
            (0.01, "1.0 %"),
            (0.000_789, "0.079 %"),
            (1.2e-5, "0.0012 %"),
            (1e-5, "0.001 %"),
            (9e-6, "less than 0.001 %"),
        ] {
            assert_eq!(per_cent(share), text);
        }
    }

    /// A value and its deviation have two digits of that, of none two behind the point, and never more than fifteen.
    #[test]
    fn values_have_the_digits_of_their_deviations() {
        for (value, sigma, text) in [
            (1234.0, 25.0, "1234 +- 25"),
            (1.0345, 0.002, "1.0345 +- 0.0020"),
            (1.5, 0.25, "1.50 +- 0.25"),
            (1.5, 0.0, "1.50 +- 0.00"),
            (2.0, 3e-20, "2.000000000000000 +- 0.000000000000000"),
        ] {
            assert_eq!(with_sigma(value, sigma), text);
        }
    }
}

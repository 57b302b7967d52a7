//! Free rotation found in a whole recording: throws between hands that hold the body, wait and catch.
//!
//! The weak form of Euler's equation with drag is linear in tensor and drag. Short windows of it, where they determine
//! the tensor, propose one; that on which most windows agree is the body's. Windows that agree, each with its own drag,
//! are free, and each run of them is a flight up to where a torque begins.
//!
//! Source: consensus by random samples, Fischler, Bolles 1981, Communications of the ACM 24, 381, with all windows as
//! samples and their information in place of a count of inliers within each.

mod consensus;
mod equations;
mod extent;
pub(crate) mod flight;

use crate::flights::flight::{Flight, FlightLimit};
use crate::thresholds::flights::{MOST_TORQUE, OTHERS};
use crate::thresholds::noise::LEAST;

use nalgebra::Vector3;
use polhode::record::{Record, Segment};

use crate::error::FitError;
use crate::settings::Settings;
use crate::signal::noise;
use crate::signal::normalised::{Normalised, normalised};
use crate::signal::stretch::Stretch;
use crate::thresholds::test_functions::SAMPLES_PER_TEST;
use crate::units::Motion;
use crate::verdict::units::open_units;
use consensus::{Consensus, Contradiction, NoConsensus, consensus, consensus_beside, is_held};
use equations::{Test, tests};
use extent::{Extent, extent, runs};

/// The parts of `record` in which `flights` were found, one segment each.
#[must_use]
pub fn during(record: &Record, flights: &[Flight]) -> Record {
    record.spans(flights.iter().map(|flight| (flight.segment, flight.start, flight.end)))
}

/// The flights of a record.
#[non_exhaustive]
#[derive(Clone, Debug, PartialEq)]
pub struct Flights {
    /// Each flight, in the order of the record.
    pub list: Vec<Flight>,
    /// Whether the record as a whole may be that of one free body: its flights are then its segments.
    pub whole: bool,
    /// Where the readings are those of a free body too, but of another tensor: an axis may have changed its sign there, two may have been
    /// exchanged, or it is another body.
    pub others: Vec<Flight>,
}

impl Flights {
    /// What is to be said of the spans with another tensor.
    #[must_use]
    pub fn remark_on_others(&self) -> Option<String> {
        let first = self.others.first()?;
        let more = match self.others.len() - 1 {
            0 => String::new(),
            1 => ", and in one more span,".into(),
            more => format!(", and in {more} more spans,"),
        };
        Some(format!(
            "from {:.3} s to {:.3} s{more} the readings are those of a free body with another tensor: an axis of the sensor was reversed or \
             exchanged with another, or it is another body; fit each part separately",
            first.start, first.end
        ))
    }
}

/// Finds the spans of a record in which the body rotates freely, but for drag; [`during`] cuts them out.
///
/// A record that nowhere contradicts a free body, or one under the torques that [`fit`](super::fit) has columns for, is
/// one flight from end to end; a rest that begins or ends within a turn by about one radian contradicts them. Otherwise
/// a flight is what one tensor explains together with other flights, up to torques of 0.02 tr J |ω|². A flight must turn
/// the body; one at less than a tenth of the record's usual rate is not seen.
///
/// ```
/// use nalgebra::Vector3;
/// use polhode_fit::{Record, Settings, during, fit, flights, simulate};
/// use polhode::inertia::Inertia;
/// use polhode::num::Random;
///
/// // held still for a second, thrown for one, and held again
/// let body = Inertia::from_moments([1.0, 2.0, 2.6])?;
/// let times: Vec<f64> = (0..300).map(|i| f64::from(i) / 100.0).collect();
/// let mut random = Random::new(7);
/// let thrown = simulate(&body, Vector3::new(2.0, 9.0, 4.0), &times[100..200], 1e-2, &mut random)?;
/// let held = |random: &mut Random| random.normal_vector() * 1e-2;
/// let rates: Vec<Vector3<f64>> = (0..300)
///     .map(|i| if (100..200).contains(&i) { thrown[i - 100] } else { held(&mut random) })
///     .collect();
///
/// let record = Record::from_samples(&times, &rates)?;
/// let found = flights(&record, &Settings::default())?;
/// assert!(!found.whole && found.list.len() == 1);
/// let flight = found.list[0];
/// assert!((flight.start - 1.0).abs() < 0.1 && (flight.end - 2.0).abs() < 0.1);
/// let estimate = fit(&during(&record, &found.list), &Settings::default())?;
/// assert!((estimate.principal[0] - 1.0 / 5.6).abs() < 5.0 * estimate.sigma_principal[0]);
/// # Ok::<(), polhode::Error>(())
/// ```
///
/// # Errors
/// A setting that no fit can use; too few samples; no rotation; a record that is not free as a whole and has no flight:
/// because of mistaken units, where such explain it.
pub fn flights(record: &Record, settings: &Settings) -> Result<Flights, FitError> {
    settings.check()?;
    let cleaned = if settings.leave_out_spikes { record.without_spikes() } else { None };
    let Normalised { stretches, rms, input } = normalised(cleaned.as_ref().map_or(record, |(_, rest)| rest))?;
    let variance = match settings.noise {
        Some(sigma) => (sigma / rms) * (sigma / rms),
        None => noise::variance(&stretches),
    };
    // readings of a noiseless record carry at least the quadrature's error
    let variance = variance.max(LEAST);
    let speed = speed(&stretches);
    let radius = radius(&stretches, speed);
    let all: Vec<Vec<Test>> = stretches.iter().map(|stretch| tests(stretch, radius)).collect();
    let Some(contradiction) = Contradiction::new(&all, speed, variance) else { return Ok(whole(record)) };
    // known wheels and torques may stop a body, and a throw may be too short to be found beside a rest
    let may_be_whole = contradiction.is_none();
    if may_be_whole && (input.is_some() || !is_held(&all, speed)) {
        return Ok(whole(record));
    }
    let none = |torque: Option<f64>| {
        // in a wrong unit of rate or time nothing is free; wheels and torques of the record are in units of their own
        let is_asked = settings.check_units && input.is_none();
        let motion = if is_asked { Motion::new(&stretches, variance) } else { None };
        match open_units(record, &stretches, motion.as_ref(), rms) {
            Err(mistaken) => mistaken,
            Ok(_) => FitError::NoFlight { share: contradiction.share(), torque, most: MOST_TORQUE },
        }
    };
    let agreed = match consensus(&all, speed, variance) {
        Ok(agreed) => agreed,
        Err(_) if may_be_whole => return Ok(whole(record)),
        Err(NoConsensus { least }) => return Err(none(least.map(|least| MOST_TORQUE * least.sqrt()))),
    };
    let flights_of = |agreed: &Consensus| {
        let mut list: Vec<Flight> = Vec::new();
        for (stretch, (tests, free)) in stretches.iter().zip(all.iter().zip(&agreed.free)) {
            let segment = stretch.segment;
            let extents =
                runs(free).into_iter().filter_map(|run| extent(tests, run, &agreed.x, speed, variance));
            for found in extents {
                let span = [
                    (tests[found.tests.start].centre - radius) / rms,
                    (tests[found.tests.end - 1].centre + radius) / rms,
                ];
                // neighbours that a short blow parts share no sample
                let last = list.last().filter(|last| last.segment == segment).map(|last| last.end);
                list.extend(flight(&record.segments[segment], stretch, rms, span, &found, last));
            }
        }
        list
    };
    let list = flights_of(&agreed);
    if list.is_empty() {
        return if may_be_whole { Ok(whole(record)) } else { Err(none(None)) };
    }
    let rest = consensus_beside(&agreed.free, &all, speed, variance);
    let mut others = rest.map_or_else(|_| Vec::new(), |agreed| flights_of(&agreed));
    // a hand may lead the body for a moment as if it were free
    let most = list.iter().map(|flight| flight.turned).fold(0.0, f64::max);
    others.retain(|other| other.turned > OTHERS * most);
    Ok(Flights { list, whole: false, others })
}

/// Every segment as one flight.
fn whole(record: &Record) -> Flights {
    let each = record.segments.iter().enumerate().filter_map(|(k, segment)| {
        let (start, end) = (*segment.times().first()?, *segment.times().last()?);
        let (before, after) = (FlightLimit::Edge, FlightLimit::Edge);
        Some(Flight {
            segment: k,
            start,
            end,
            samples: segment.times().len(),
            turned: turned(segment.times(), segment.rates()),
            before,
            after,
        })
    });
    Flights { list: each.collect(), whole: true, others: Vec::new() }
}

/// The samples of a segment in a span of seconds from the start of a stretch of it, those up to `last` left out; `None` where there are
/// too few for a fit.
fn flight(
    segment: &Segment,
    stretch: &Stretch,
    rms: f64,
    span: [f64; 2],
    found: &Extent,
    last: Option<f64>,
) -> Option<Flight> {
    let (times, origin) = (segment.times(), stretch.start);
    let low = match found.before {
        FlightLimit::Edge => times.partition_point(|t| *t < origin),
        _ => times.partition_point(|t| t - origin < span[0]),
    };
    let low = low.max(last.map_or(0, |last| times.partition_point(|t| *t <= last)));
    let high = match found.after {
        FlightLimit::Edge => times.partition_point(|t| (t - origin) * rms <= stretch.duration()),
        _ => times.partition_point(|t| t - origin <= span[1]),
    };
    let own = times.get(low..high)?;
    let (start, end) = (*own.first()?, *own.last()?);
    let enough = own.len() >= 2 * SAMPLES_PER_TEST as usize;
    enough.then(|| Flight {
        segment: stretch.segment,
        start,
        end,
        samples: own.len(),
        turned: turned(own, &segment.rates()[low..high]),
        before: found.before,
        after: found.after,
    })
}

/// ∫ |ω| dt.
fn turned(times: &[f64], rates: &[Vector3<f64>]) -> f64 {
    times
        .windows(2)
        .zip(rates.windows(2))
        .map(|(t, w)| 0.5 * (t[1] - t[0]) * (w[0].norm() + w[1].norm()))
        .sum()
}

/// The rate of the motion, not of what is held beside it: the mean square of the rates, each weighted with its own.
fn speed(stretches: &[Stretch]) -> f64 {
    let squares = || stretches.iter().flat_map(|s| &s.rates).map(|w| w.norm_squared());
    let (square, fourth) = (squares().sum::<f64>(), squares().map(|s| s * s).sum::<f64>());
    (fourth / square).sqrt()
}

/// Half width of the test functions: the time of a turn by one radian, or of a few samples.
fn radius(stretches: &[Stretch], speed: f64) -> f64 {
    let intervals = stretches.iter().map(|s| s.times.len().saturating_sub(1)).sum::<usize>();
    let mean = stretches.iter().map(Stretch::duration).sum::<f64>() / intervals.max(1) as f64;
    (SAMPLES_PER_TEST * mean).max(1.0 / speed)
}

#[cfg(test)]
mod tests;

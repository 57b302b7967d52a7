//! What the attitudes of runs are compared with: the true motion at looks, over the whole time and over a part of it.

use std::collections::HashMap;

use super::{AdviseError, Demand};
use crate::body::{Body, Point, Time};
use crate::num::Dd;
use crate::rotation::{Vec3, rotation_angle};
use crate::truth::{Truth, TruthError, Turning, Wanted};

/// Looks at a motion, at equal times, at least and at most: between these two to four a radian.
const LEAST_LOOKS: f64 = 32.0;
const MOST_LOOKS: f64 = 512.0;

/// The turn, rad, over which each candidate is tried first.
const SHORT: f64 = 512.0;

/// The part of the demand to which two runs agree, and the largest that may be left to them.
const AGREEMENT: f64 = 0.1;
const BEARABLE: f64 = 0.25;

/// How long runs in double-double may take where two in `f64` do not agree, s; and for a check.
const PATIENCE: f64 = 0.7;
pub(super) const PATIENCE_OF_CHECKS: f64 = 30.0;

/// Of the largest rate, the part at which the start stands for the whole time.
const AS_FAST: f64 = 0.7;

/// A part of the motion with looks at it.
#[derive(Clone, Debug)]
pub(super) struct Span {
    pub(super) start: Point<f64>,
    /// Of the clock of the forces, s.
    pub(super) start_time: f64,
    /// Its length, s.
    pub(super) horizon: f64,
    /// How many times as far the body turns in the whole time.
    pub(super) times_longer: f64,
    /// The motion at equal times up to the horizon, a power of two of them.
    pub(super) points: Vec<Point<Dd>>,
}

/// The motion from one start.
#[derive(Debug)]
pub(super) struct Reference {
    truth: Truth,
    start: Point<f64>,
    start_time: f64,
    until: f64,
    /// The largest rate of turning, rad/s; an estimate where the motion has a closed form.
    pub(super) rate: f64,
    /// By how often the time is halved, 0 for the whole; of a motion without closed form the whole and one short span.
    spans: HashMap<u32, Span>,
    short: u32,
}

/// The true motion of the body of a demand at `times`.
pub(super) fn truth(
    body: &Body,
    start: Point<f64>,
    demand: &Demand,
    (times, patience): (&[f64], f64),
    heed: &mut dyn FnMut(f64),
) -> Result<Truth, AdviseError> {
    let wanted = demand.attitude_error;
    let (accuracy, bearable) = (AGREEMENT * wanted, BEARABLE * wanted);
    let wanted = Wanted { accuracy, bearable, attainable: wanted, patience };
    let truth = Truth::within(body, start, demand.start_time, times, wanted, heed)
        .map_err(|error| AdviseError::of(error, demand.attitude_error))?;
    let agree_until = truth.known_until();
    match times.last() {
        Some(end) if agree_until < *end => {
            // how a start with another last digit fares tells whether the motion or the runs are to blame
            let turning = truth.turning();
            let attainable = turning.map_or(0.0, |turning| f64::EPSILON * turning.growth);
            let until = *end;
            Err(if turning.is_none_or(Turning::is_chaotic) {
                AdviseError::Chaotic { demand: demand.attitude_error, agree_until }
            } else if attainable > demand.attitude_error {
                AdviseError::Conditioning { demand: demand.attitude_error, attainable, until }
            } else {
                AdviseError::Undecided { demand: demand.attitude_error, agree_until }
            })
        }
        _ => Ok(truth),
    }
}

impl Reference {
    pub(super) fn new(
        body: &Body,
        start: Point<f64>,
        demand: &Demand,
        heed: &mut dyn FnMut(f64),
    ) -> Result<Self, AdviseError> {
        let (until, start_time) = (demand.until, demand.start_time);
        let rate = rate(body, start.to_dd(), start_time, until);
        let mut looks = looks(until * rate);
        let mut truth_at = |count: u64| {
            let times: Vec<f64> = times(until, count).map(Dd::hi).collect();
            truth(body, start, demand, (&times, PATIENCE), heed)
        };
        let mut known = truth_at(looks)?;
        let turning = known.turning().map(|turning| (turning.largest(), turning.angle));
        if let Some((_, angle)) = turning.filter(|_| looks < MOST_LOOKS as u64)
            && self::looks(angle) > looks
        {
            // the body turned further than its start let expect
            looks = self::looks(angle);
            known = truth_at(looks)?;
        }
        let rate = turning.map_or(rate, |(rate, _)| rate);
        if rate == 0.0 {
            return Err(AdviseError::AtRest);
        }
        let spans = HashMap::new();
        let mut found = Reference { truth: known, start, start_time, until, rate, spans, short: 0 };
        match turning {
            None => found.short = (0..200).find(|level| found.halved(*level) <= SHORT / rate).unwrap_or(0),
            Some((_, angle)) => {
                let points = times(until, looks).map(|time| found.truth.point_at(time));
                let points = points.collect::<Result<_, _>>()?;
                let whole = Span { start, start_time, horizon: until, times_longer: 1.0, points };
                found.spans.insert(0, whole);
                if angle > 2.0 * SHORT {
                    found.short = 1;
                    let window = found.window(body, demand)?;
                    found.spans.insert(1, window);
                }
            }
        }
        Ok(found)
    }

    /// The true motion.
    pub(super) fn truth(&self) -> &Truth {
        &self.truth
    }

    /// A short part of a motion without closed form, where the body turns fastest.
    fn window(&self, body: &Body, demand: &Demand) -> Result<Span, AdviseError> {
        let (mut begin, mut start) = (0.0, self.start);
        let (angle, from_start) = self
            .truth
            .turning()
            .map_or((0.0, 0.0), |turning| (turning.angle, turning.largest_between(0.0, SHORT / self.rate)));
        let horizon = SHORT / self.rate;
        if let Some(turning) = self.truth.turning().filter(|_| from_start < AS_FAST * self.rate) {
            let fastest = |from: f64| turning.largest_between(from, (from + horizon).min(self.until));
            let latest = self.until - horizon;
            let begins = self.truth.times().filter(|time| *time <= latest);
            let of = begins.max_by(|a, b| fastest(*a).total_cmp(&fastest(*b)));
            if let Some(time) = of {
                (begin, start) = (time, self.truth.point_at(time.into())?.to_f64());
            }
        }
        let start_time = self.start_time + begin;
        let times_longer = angle / SHORT;
        let count = looks(SHORT);
        let at: Vec<f64> = times(horizon, count).map(Dd::hi).collect();
        let accuracy = AGREEMENT * demand.attitude_error / times_longer;
        let wanted = Wanted { accuracy, bearable: 1e-3, attainable: 1e-3, patience: 0.1 };
        let truth = Truth::within(body, start, start_time, &at, wanted, &mut |_| {})
            .map_err(|error| AdviseError::of(error, demand.attitude_error))?;
        let points: Vec<_> =
            truth.times().map(|time| truth.point_at(time.into())).collect::<Result<_, _>>()?;
        if points.len() < at.len() {
            let agree_until = begin + truth.known_until();
            return Err(AdviseError::Undecided { demand: demand.attitude_error, agree_until });
        }
        Ok(Span { start, start_time, horizon, times_longer, points })
    }

    /// The short part over which every candidate is tried.
    pub(super) fn short(&mut self) -> Result<Span, TruthError> {
        self.span(self.short)
    }

    /// The longest part that takes at most `seconds` at a `price` in s per s; whole where the motion has no closed form.
    pub(super) fn long(&mut self, price: f64, seconds: f64) -> Result<Span, TruthError> {
        let closed = self.truth.closed_form().is_some();
        let level = (0..self.short).find(|level| price * self.halved(*level) <= seconds);
        self.span(if closed { level.unwrap_or(self.short) } else { 0 })
    }

    fn span(&mut self, level: u32) -> Result<Span, TruthError> {
        if let Some(span) = self.spans.get(&level) {
            return Ok(span.clone());
        }
        let horizon = self.halved(level);
        let times = times(horizon, looks(horizon * self.rate));
        let points = times.map(|time| self.truth.point_at(time)).collect::<Result<_, _>>()?;
        let (start, start_time) = (self.start, self.start_time);
        let times_longer = self.until / horizon;
        let span = Span { start, start_time, horizon, times_longer, points };
        self.spans.insert(level, span.clone());
        Ok(span)
    }

    fn halved(&self, level: u32) -> f64 {
        libm::scalbn(self.until, -(level.cast_signed()))
    }

    /// How far a start with other last bits is away at the whole time, rad: what no method can be asked to better.
    pub(super) fn conditioning(&self) -> Result<f64, TruthError> {
        if let Some(turning) = self.truth.turning() {
            return Ok(f64::EPSILON * turning.growth);
        }
        let ulp = Dd::from(f64::EPSILON);
        let (start, last) = (self.truth.point_at(Dd::ZERO)?, self.truth.point_at(self.until.into())?);
        let mut worst = 0.0_f64;
        for changed in [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]] {
            let mut start = start;
            start.momentum_body = start.momentum_body.times(Vec3(changed.map(|up| Dd::ONE + ulp * up)));
            let end = self.truth.point_from(start, self.until)?;
            worst = worst.max(rotation_angle(end.attitude, last.attitude).hi());
        }
        Ok(worst)
    }
}

/// Looks at a motion that turns by `angle` rad: a power of two.
fn looks(angle: f64) -> u64 {
    libm::exp2(libm::ceil(libm::log2((2.0 * angle).clamp(LEAST_LOOKS, MOST_LOOKS)))) as u64
}

/// `count` equal times up to `horizon`, s since the start.
fn times(horizon: f64, count: u64) -> impl Iterator<Item = Dd> {
    let apart = Dd::from(horizon / count as f64);
    (1..=count).map(move |k| apart * Dd::from(k))
}

/// The rate of turning, rad/s: of the start, and of what its torque alone would bring about in a radian or in the whole time.
fn rate(body: &Body, start: Point<Dd>, start_time: f64, until: f64) -> f64 {
    let torque = body.torque_of(Time::from_seconds(start_time), &start);
    let acceleration = torque.times(body.rotor().inverse_moments()).magnitude();
    let tipped = libm::sqrt(acceleration).min(acceleration * until);
    body.omega_of(&start).norm().max(tipped)
}

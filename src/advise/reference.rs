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
        let (turning, horizon) = (self.truth.turning(), SHORT / self.rate);
        let angle = turning.map_or(0.0, |turning| turning.angle);
        let is_slow = |turning: &&Turning| turning.largest_between(0.0, horizon) < AS_FAST * self.rate;
        if let Some(turning) = turning.filter(is_slow) {
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

#[cfg(test)]
mod tests {
    use nalgebra::Vector3;

    use super::*;
    use crate::body::Force;
    use crate::inertia::Inertia;

    fn body() -> Body {
        Body::free(Inertia::from_moments([1.0, 2.0, 2.5]).unwrap())
    }

    fn start(body: &Body, omega: [f64; 3]) -> Point<f64> {
        body.enter(&body.state(Default::default(), omega.into()).unwrap()).unwrap().to_f64()
    }

    #[test]
    fn there_are_two_to_four_looks_a_radian_within_bounds() {
        assert_eq!([0.0, 16.0, 16.1, 100.0, 128.5, 300.0, 1e9].map(looks), [32, 32, 64, 256, 512, 512, 512]);
        assert_eq!(times(10.0, 4).map(Dd::hi).collect::<Vec<f64>>(), [2.5, 5.0, 7.5, 10.0]);
    }

    /// From rest a torque turns a body by half its acceleration times t²: a radian takes about 1/√a.
    #[test]
    fn the_rate_is_that_of_the_start_or_what_its_torque_brings_about() {
        let pushed = body().with(Force::constant_torque_body(Vector3::new(0.0, 0.18, 0.0)).unwrap());
        let near = |a: f64, b: f64| assert!((a / b - 1.0).abs() < 1e-12, "{a} for {b}");
        let of = |body: &Body, omega, until| rate(body, start(body, omega).to_dd(), 0.0, until);
        near(of(&body(), [0.0, 3.0, 4.0], 10.0), 5.0);
        near(of(&pushed, [0.0; 3], 100.0), 0.3);
        near(of(&pushed, [0.0; 3], 2.0), 0.18);
        near(of(&pushed, [0.0, 3.0, 4.0], 100.0), 5.0);
    }

    /// Of a closed form every half of a half of the time can be the part; the longest that is paid for is taken.
    #[test]
    fn a_run_is_as_long_as_it_is_affordable() {
        let (body, demand) = (body(), Demand::new(4096.0, 1e-6));
        let start = start(&body, [0.6, 0.0, 0.8]);
        let mut reference = Reference::new(&body, start, &demand, &mut |_| {}).unwrap();
        assert_eq!((reference.rate, reference.short), (1.0, 3));
        for (price, horizon) in [(1e-6, 4096.0), (0.9 / 4096.0, 4096.0), (1.1 / 4096.0, 2048.0), (1.0, 512.0)]
        {
            let span = reference.long(price, 1.0).unwrap();
            assert_eq!((span.horizon, span.times_longer), (horizon, 4096.0 / horizon));
            let exact = reference.truth.point_at(Dd::from(horizon)).unwrap();
            assert!(rotation_angle(span.points[span.points.len() - 1].attitude, exact.attitude).hi() < 1e-25);
        }
    }

    /// A body that spins up is fastest at the end, one that drag stops at the start.
    #[test]
    fn the_short_part_is_where_the_body_turns_fastest() {
        for (force, from) in [
            (Force::constant_torque_body(Vector3::new(0.0, 0.0, 0.02)).unwrap(), 0.5),
            (Force::drag(5e-4, 0.0).unwrap(), 0.0),
        ] {
            let (body, demand) = (body().with(force), Demand::new(1600.0, 1e-3));
            let start = start(&body, [0.1, 0.1, 1.0]);
            let mut reference = Reference::new(&body, start, &demand, &mut |_| {}).unwrap();
            let angle = reference.truth.turning().unwrap().angle;
            let (rate, span) = (reference.rate, reference.short().unwrap());
            assert!((span.horizon * rate / SHORT - 1.0).abs() < 1e-12 && span.points.len() == 512);
            assert!((span.times_longer * SHORT / angle - 1.0).abs() < 1e-12);
            let (begin, latest) = (span.start_time, 1600.0 - span.horizon);
            assert!(
                if from > 0.0 { begin > latest - 20.0 && begin <= latest } else { begin == 0.0 },
                "{begin}"
            );
            // the motion of the part is that of the whole
            let whole = reference.truth.point_at(Dd::from(begin)).unwrap().to_f64();
            assert_eq!(span.start, whole);
            assert_eq!(reference.long(1e9, 1.0).unwrap().horizon, 1600.0);
        }
    }
}

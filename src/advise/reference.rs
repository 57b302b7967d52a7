//! What the attitudes of runs are compared with: the true motion at looks on the way to horizons, each half the one before.

use std::collections::HashMap;

use super::{AdviseError, Demand};
use crate::body::{Body, Point, Time};
use crate::num::Dd;
use crate::rotation::{Vec3, rotation_angle};
use crate::truth::{Truth, TruthError};

/// Most looks at a motion on the way to a horizon, at equal times: over shorter ways one in two radians.
const MOST_LOOKS: f64 = 64.0;

/// The turn, rad, over which each candidate is tried first.
const SHORT: f64 = 512.0;

/// The part of the demand to which two runs in double-double agree.
const AGREEMENT: f64 = 0.05;

/// Of how far runs in double-double lead, the part that is waited for.
const BEARABLE: f64 = 0.5;

/// The motion from one start.
#[derive(Debug)]
pub(super) struct Reference {
    truth: Truth,
    until: f64,
    /// An estimate of the rate of turning, rad/s; 0 for a body that stays at rest.
    pub(super) rate: f64,
    /// Levels of the longest horizon at a bearable cost, and of short runs.
    pub(super) longest: u32,
    pub(super) short: u32,
    points: HashMap<u32, Vec<Point<Dd>>>,
}

/// The true motion of the body of a demand at `times`.
pub(super) fn truth(
    body: &Body,
    start: Point<f64>,
    demand: &Demand,
    times: &[f64],
) -> Result<Truth, AdviseError> {
    let agreement = AGREEMENT * demand.attitude_error;
    let truth = Truth::from_point(body, start, demand.start_time, times, agreement)?;
    let agree_until = truth.known_until();
    match times.last() {
        Some(end) if agree_until < *end => {
            Err(AdviseError::Chaotic { demand: demand.attitude_error, agree_until })
        }
        _ => Ok(truth),
    }
}

impl Reference {
    pub(super) fn new(body: &Body, start: Point<f64>, demand: &Demand) -> Result<Self, AdviseError> {
        let until = demand.until;
        let rate = rate(body, start.to_dd(), demand.start_time, until);
        if rate == 0.0 {
            return Err(AdviseError::AtRest);
        }
        let truth_at = |times: &[f64]| truth(body, start, demand, times);
        let (truth, points) = (truth_at(&[])?, HashMap::new());
        let level = |horizon: f64, from: u32| {
            (from..from + 200).find(|level| halved(until, *level) <= horizon).unwrap_or(from)
        };
        let longest = level(BEARABLE * truth.reach(), 0);
        let short = level(SHORT / rate, longest);
        let mut found = Reference { truth, until, rate, longest, short, points };
        // a closed form is worked out where it is asked for
        if found.truth.closed_form().is_none() {
            let mut times: Vec<f64> =
                (longest..=short).flat_map(|level| found.times(level)).map(Dd::hi).collect();
            times.sort_by(f64::total_cmp);
            times.dedup();
            found.truth = truth_at(&times)?;
        }
        Ok(found)
    }

    /// The true motion.
    pub(super) fn truth(&self) -> &Truth {
        &self.truth
    }

    /// The horizon `level`, s: the whole time divided by 2^level.
    pub(super) fn horizon(&self, level: u32) -> f64 {
        halved(self.until, level)
    }

    /// Looks on the way to the horizon `level`: a power of two, at least 8.
    pub(super) fn looks(&self, level: u32) -> u64 {
        let wanted = (0.5 * self.horizon(level) * self.rate).clamp(8.0, MOST_LOOKS);
        libm::exp2(libm::floor(libm::log2(wanted))) as u64
    }

    /// Times of these looks, s since the start.
    fn times(&self, level: u32) -> impl Iterator<Item = Dd> + use<> {
        let looks = self.looks(level);
        let apart = Dd::from(self.horizon(level) / looks as f64);
        (1..=looks).map(move |k| apart * Dd::from(k))
    }

    /// The motion at these looks.
    pub(super) fn points(&mut self, level: u32) -> Result<&[Point<Dd>], TruthError> {
        if !self.points.contains_key(&level) {
            let points = self.times(level).map(|time| self.truth.point_at(time));
            let points = points.collect::<Result<_, _>>()?;
            self.points.insert(level, points);
        }
        Ok(self.points.get(&level).map_or(&[], Vec::as_slice))
    }

    /// How far a start with other last bits is away at the whole time, rad: what no method can be asked to better. Where
    /// it is known for a part of the time only, as if it grew in proportion to it.
    pub(super) fn conditioning(&self) -> Result<f64, TruthError> {
        let ulp = Dd::from(f64::EPSILON);
        // each component by itself where a motion costs next to nothing, else all in turn up and down
        let each = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
        let closed = self.truth.closed_form().is_some();
        let (level, changes) = if closed { (0, &each[..]) } else { (self.short, &[[1.0, -1.0, 1.0]][..]) };
        let horizon = self.horizon(level);
        let (start, last) = (self.truth.point_at(Dd::ZERO)?, self.truth.point_at(horizon.into())?);
        let mut worst = 0.0_f64;
        for changed in changes {
            let mut start = start;
            start.momentum_body = start.momentum_body.times(Vec3(changed.map(|up| Dd::ONE + ulp * up)));
            let end = self.truth.point_from(start, horizon)?;
            worst = worst.max(rotation_angle(end.attitude, last.attitude).hi());
        }
        Ok(libm::scalbn(worst, level.cast_signed()))
    }
}

/// `until` divided by 2^level.
fn halved(until: f64, level: u32) -> f64 {
    libm::scalbn(until, -(level.cast_signed()))
}

/// The rate of turning, rad/s: of the start, and of what its torque alone would bring about in a radian or in the whole time.
fn rate(body: &Body, start: Point<Dd>, start_time: f64, until: f64) -> f64 {
    let torque = body.torque_of(Time::from_seconds(start_time), &start);
    let acceleration = torque.times(body.rotor().inverse_moments()).magnitude();
    let tipped = libm::sqrt(acceleration).min(acceleration * until);
    body.omega_of(&start).norm().max(tipped)
}

//! Two runs in double-double, as long as they agree.

use std::time::Instant;

use super::together::together;
use super::{TruthError, attitude_error};
use crate::body::{Body, Clock, Point, Time};
use crate::method::{AdaptiveTaylor, AnyMethod as _, Rk8, Step, StepError};
use crate::num::Dd;
use crate::observe::Flips;

/// Up to this angle, rad, two runs in double-double agree unless told: below it a double has no digits.
pub const AGREEMENT: f64 = 1e-13;

/// The turn of an interval, rad: series of the second run begin anew after each, and the first, whose series are good for about
/// twice as much, looks at the flips there.
const ANGLE: f64 = 0.25;

/// Intervals of a run, and series of its own, at most: a minute or a few, by force.
const MOST_STEPS: u64 = 1 << 17;

/// A rate of so many times that at the start sets intervals of its own.
const SPUN_UP: f64 = 2.0;

/// Steps of the Runge–Kutta method in an interval, for forces that no series takes.
const FINE: u64 = 16;
const LESS_FINE: u64 = 12;

/// Series whose times tell how long a run takes.
const SERIES_TIMED: u32 = 5;

/// Which steps a run takes.
#[derive(Clone, Copy, PartialEq)]
enum Steps {
    /// As long as its series are good for.
    OfTheirOwn,
    /// A new series at every interval.
    Anew,
}

/// A point at a time since the start, s, and how often the body has flipped since the look before.
pub(super) struct Followed {
    pub(super) elapsed: f64,
    pub(super) point: Point<Dd>,
    pub(super) flips: u64,
}

/// Runs of a body in double-double.
#[derive(Clone, Debug)]
pub(super) struct Follower {
    body: Body,
    start_time: f64,
    /// |ω| at the start, and the rate at which weight or torque can turn the body, rad/s.
    speed: f64,
}

/// |ω| at the time `at`, s, of the clock of the forces, and the rate at which weight, torque or wheels can turn the body, rad/s.
fn speed(body: &Body, at: f64, x: &Point<Dd>) -> f64 {
    let least = body.rotor().moments::<f64>().0.into_iter().fold(f64::INFINITY, f64::min);
    let weight = body.linear_potential::<f64>().map_or(0.0, |linear| linear.moment.norm());
    let at = Time::from_seconds(at);
    let wheels = body.momentum_of_wheels().map_or(0.0, |wheels| wheels.at(at).norm().hi());
    let torque = body.torque_of(at, x);
    // the square of one may be beyond the range of numbers
    let torque = Some(torque.norm().hi()).filter(|norm| norm.is_finite()).unwrap_or(torque.magnitude());
    body.omega_of(x).norm() + libm::sqrt(weight.max(torque) / least) + wheels / least
}

impl Follower {
    pub(super) fn new(body: &Body, start: &Point<Dd>, start_time: f64) -> Self {
        let speed = speed(body, start_time, start);
        Follower { body: body.clone(), start_time, speed }
    }

    /// How long two runs to `until` take about, s, from the time of the quickest of a few series: of one thread each.
    pub(super) fn seconds(&self, x: &Point<Dd>, angle: f64) -> Result<f64, TruthError> {
        let (h, mut least) = (ANGLE / self.speed, f64::INFINITY);
        // other programs on the machine make some slower
        for _ in 0..SERIES_TIMED {
            let begun = Instant::now();
            self.carry(&mut x.clone(), (0.0, h, h), &mut 0, Steps::Anew)?;
            least = least.min(begun.elapsed().as_secs_f64());
        }
        Ok(least * angle / ANGLE)
    }

    /// How far a run leads, s since the start.
    pub(super) fn reach(&self) -> f64 {
        MOST_STEPS as f64 * ANGLE / self.speed
    }

    /// Two runs from `start` through `times`, as long as they agree to `agreement` rad. Both are taken at the same time, where the
    /// system grants a thread.
    pub(super) fn agreeing(
        &self,
        start: Point<Dd>,
        times: &[f64],
        agreement: f64,
    ) -> Result<Vec<Followed>, TruthError> {
        let until = times.last().copied().unwrap_or(0.0);
        let pass = |which: usize| {
            let steps = if which == 0 { Steps::OfTheirOwn } else { Steps::Anew };
            let (mut x, mut from, mut taken) = (start, 0.0, 0);
            move |&elapsed: &f64| {
                let flips = self.carry(&mut x, (from, elapsed, until), &mut taken, steps)?;
                from = elapsed;
                Ok::<_, TruthError>(Followed { elapsed, point: x, flips })
            }
        };
        let mut agreed: Vec<Followed> = Vec::with_capacity(times.len());
        together(times, pass, |look: Followed, other: Followed| {
            let apart = attitude_error(other.point.attitude, look.point.attitude);
            let agree = apart <= agreement;
            if agree {
                agreed.push(look);
            }
            agree
        })?;
        Ok(agreed)
    }

    /// One run from `start` to `until`, s since the start.
    pub(super) fn once(&self, start: Point<Dd>, until: f64) -> Result<Point<Dd>, TruthError> {
        let mut x = start;
        self.carry(&mut x, (0.0, until, until), &mut 0, Steps::OfTheirOwn)?;
        Ok(x)
    }

    /// Moves `x` from `from` to `to` s after the start, on the way to `until`; returns its flips, and adds to the series `taken`.
    fn carry(
        &self,
        x: &mut Point<Dd>,
        (from, to, until): (f64, f64, f64),
        taken: &mut u64,
        steps: Steps,
    ) -> Result<u64, TruthError> {
        let too_long = |steps: f64, reach: f64| TruthError::TooLong { until, steps, most: MOST_STEPS, reach };
        let span = to - from;
        // a body that spins up turns faster than at its start
        let now = speed(&self.body, self.start_time + from, x);
        let speed = if now > SPUN_UP * self.speed { now } else { self.speed };
        let count = libm::ceil(span * speed / ANGLE).max(1.0);
        // the count is known before the first step
        let all = (until * self.speed / ANGLE).max(count);
        if all.is_nan() || all > MOST_STEPS as f64 {
            return Err(too_long(all, self.reach()));
        }
        let clock = Clock { start: self.start_time + from, step: span / count };
        let (mut step, fine) = self.prepared(clock, steps)?;
        let mut flips = Flips::new(self.body.rotor().middle_axis());
        flips.observe(&x.momentum_body.map(Dd::hi));
        let mut moved = Point::new(x.attitude, x.momentum_body);
        step.open(&mut moved);
        for n in 1..=count as u64 {
            match steps {
                Steps::OfTheirOwn => {
                    step.advance(&mut moved, fine);
                    *x = step.reading(&moved);
                }
                Steps::Anew => {
                    step.steps(&mut moved, fine);
                    *x = moved;
                }
            }
            flips.observe(&x.momentum_body.map(Dd::hi));
            // a body that spins up takes more of them than its start lets expect
            let accepted = *taken + step.work().map_or(0, |work| work.accepted);
            if accepted > MOST_STEPS {
                let reached = from + clock.elapsed(n).hi();
                return Err(too_long(accepted as f64 * until / reached, reached));
            }
        }
        *taken += step.work().map_or(0, |work| work.accepted);
        // steps · h is not the span to the digits of double-double
        *x = self.nudged(x, to, Dd::from(span) - clock.elapsed(count as u64))?;
        Ok(flips.count)
    }

    /// The point `duration` s after `x`, which is at `elapsed` s.
    pub(super) fn nudged(&self, x: &Point<Dd>, elapsed: f64, duration: Dd) -> Result<Point<Dd>, StepError> {
        let mut x = Point::new(x.attitude, x.momentum_body);
        if duration.hi() != 0.0 {
            let clock = Clock { start: self.start_time + elapsed, step: duration.hi() };
            let (mut step, fine) = self.prepared(clock, Steps::OfTheirOwn)?;
            step.steps(&mut x, fine);
        }
        Ok(x)
    }

    /// Steps by the intervals of `clock`, and how many of them an interval takes: one series, or short steps of a Runge–Kutta
    /// method of order 8 where the forces take no series.
    fn prepared(&self, clock: Clock, steps: Steps) -> Result<(Box<dyn Step<Dd>>, u64), StepError> {
        if let Ok(series) = AdaptiveTaylor::to_rounding().prepare_dd(clock, &self.body) {
            return Ok((series, 1));
        }
        let fine = if steps == Steps::OfTheirOwn { FINE } else { LESS_FINE };
        let clock = Clock { step: clock.step / fine as f64, ..clock };
        Ok((Rk8.prepare_dd(clock, &self.body)?, fine))
    }
}

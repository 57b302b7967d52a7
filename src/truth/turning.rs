//! How fast a body turns along its motion, from one coarse run, and runs whose steps follow that rate.

use super::together::together;
use super::{TruthError, attitude_error};
use crate::body::{Body, Clock, Field as _, Point, Problem, Time};
use crate::method::{AnyMethod, Rk8, SOLVED};
use crate::rotation::Vec3;

/// The turn of a piece of the motion, rad, by the rate at its beginning.
const PIECE: f64 = 8.0;

/// Pieces at least: a body at rest may be pushed later.
const LEAST_PIECES: f64 = 256.0;

/// The turn of a step of the coarse run, and of the two that show how changes of the start grow, rad.
const COARSE: f64 = 0.5;
const LESS_COARSE: f64 = 0.4;

/// Turns that are followed in `f64`, rad: a few minutes.
pub(super) const MOST_TURN: f64 = 1e7;

/// The turn between looks at the torque, rad.
const STRIDE: f64 = 0.05;

/// The part of the largest torque that a jump is at least.
const NOTICED: f64 = 1e-9;

/// A small change, relative, and the turn at which its growth is no longer looked at, rad.
const SMALL: f64 = 1e-11;
const GROWN: f64 = 0.1;

/// Looks at the torque at most, about.
const MOST_LOOKS: f64 = 3e5;

/// Jumps after which no more are counted.
pub(super) const MANY: usize = 256;

/// Halvings of a step in which the torque seems to jump: to a millionth of it.
const HALVINGS: u32 = 20;

/// Under a torque without potential, a turn that the start lets expect may be so many times as long.
const SLOWED: f64 = 1e3;

/// The rate of a body from piece to piece of its motion.
#[derive(Clone, Debug)]
pub(crate) struct Turning {
    body: Body,
    start_time: f64,
    /// Ends of the pieces, s since the start, ascending.
    ends: Vec<f64>,
    /// The largest rate seen in each, rad/s.
    rates: Vec<f64>,
    /// The turn to the last end, rad.
    pub(crate) angle: f64,
    /// Where the coarse run ends.
    end: Point<f64>,
    /// How many times as large as a small relative change of the momentum at the start the largest turn is that it brings about.
    pub(crate) growth: f64,
    /// The error of `rk8` in steps of a radian, rad, where the coarse runs show it.
    pub(super) error: Option<f64>,
}

/// |ω|, and the rate at which weight, torque or wheels can turn the body, rad/s.
pub(super) fn rate(body: &Body, at: Time, x: &Point<f64>) -> f64 {
    let inverse = body.rotor().inverse_moments::<f64>();
    let omega = x.momentum_body.times(inverse);
    let weight = body.linear_potential::<f64>().map_or(0.0, |linear| linear.moment.norm());
    let torque = body.field::<f64>().torque(at, x.attitude, omega);
    // the square of one may be beyond the range of numbers
    let torque = Some(torque.norm()).filter(|norm| norm.is_finite()).unwrap_or(torque.magnitude());
    let least = inverse.0.into_iter().fold(0.0, f64::max);
    let wheels = body.momentum_of_wheels().map_or(0.0, |wheels| wheels.at(at).norm().hi());
    omega.norm() + libm::sqrt(weight.max(torque) * least) + wheels * least
}

impl Turning {
    /// Of `body` from `start` at `start_time`, over `until` s, and how changes of the start grow up to `times`. `heed` is told from
    /// time to time what part is done.
    ///
    /// # Errors
    /// A motion that turns too far, or forces that are not finite.
    pub(super) fn of(
        body: &Body,
        start: Point<f64>,
        start_time: f64,
        times: &[f64],
        heed: &mut dyn FnMut(f64),
    ) -> Result<Self, TruthError> {
        let until = times.last().copied().unwrap_or(0.0);
        let (body, ends, rates, angle) = (body.clone(), Vec::new(), Vec::new(), 0.0);
        let mut turning =
            Turning { body, start_time, ends, rates, angle, end: start, growth: 0.0, error: None };
        let (mut x, mut from) = (start, 0.0);
        let mut before = turning.rate_at(0.0, &x)?;
        while from < until {
            // what is left may be shorter than a piece, and a body at rest has none
            let span = (PIECE / before).min(until / LEAST_PIECES).min(until - from);
            let to = if from + span < until { from + span } else { until };
            let steps = libm::ceil(before * (to - from) / COARSE).max(1.0);
            let expected = turning.angle + (until - from) * before;
            // drag may slow a body down
            let most = if turning.body.problem() == Problem::Torque { SLOWED * MOST_TURN } else { MOST_TURN };
            let far = turning.angle > MOST_TURN || (turning.ends.is_empty() && expected > most);
            if far || to <= from {
                let reach = if from > 0.0 { from } else { MOST_TURN / before };
                let (steps, most) = (expected.max(turning.angle), MOST_TURN as u64);
                return Err(TruthError::TooLong { until, steps, most, reach });
            }
            x = turning.advanced(&Rk8, &x, (from, to), steps)?;
            let after = turning.rate_at(to, &x)?;
            turning.ends.push(to);
            turning.rates.push(before.max(after));
            turning.angle += 0.5 * (before + after) * (to - from);
            if turning.ends.len().is_multiple_of(256) {
                heed(to / until);
            }
            (from, before) = (to, after);
        }
        turning.end = x;
        turning.disturb(start, times, heed)?;
        Ok(turning)
    }

    /// Sees in two more runs how a small change of the start grows, and from where the first of them ends the error of `rk8`.
    fn disturb(
        &mut self,
        start: Point<f64>,
        times: &[f64],
        heed: &mut dyn FnMut(f64),
    ) -> Result<(), TruthError> {
        let changed = Vec3([1.0, -1.0, 1.0].map(|sign| 1.0 + sign * SMALL));
        let starts = [start, Point::new(start.attitude, start.momentum_body.times(changed))];
        let (mut largest, mut last) = (0.0_f64, None);
        let turning = &*self;
        let pass = |which: usize| {
            let (mut x, mut from) = (starts[which], 0.0);
            move |&to: &f64| {
                turning.carry(&Rk8, LESS_COARSE, &mut x, (from, to))?;
                from = to;
                Ok::<_, TruthError>((to, x))
            }
        };
        let last_time = times.last().copied().unwrap_or(0.0);
        together(times, pass, |(time, one), (_, other)| {
            heed(time / last_time);
            largest = largest.max(attitude_error(one.attitude, other.to_dd().attitude));
            last = Some(one).filter(|_| time == last_time);
            largest <= GROWN
        })?;
        let error = last.map(|last| attitude_error(last.attitude, turning.end.to_dd().attitude));
        let shares = libm::pow(COARSE, 8.0) - libm::pow(LESS_COARSE, 8.0);
        self.error = error.filter(|error| *error < GROWN).map(|error| error / shares);
        self.growth = largest / SMALL;
        Ok(())
    }

    fn rate_at(&self, elapsed: f64, x: &Point<f64>) -> Result<f64, TruthError> {
        let rate = rate(&self.body, Time::from_seconds(self.start_time + elapsed), x);
        if rate.is_finite() { Ok(rate) } else { Err(TruthError::Lost { time: elapsed }) }
    }

    /// `x` moved from `from` to `to` s after the start in `steps` equal steps.
    fn advanced(
        &self,
        method: &dyn AnyMethod,
        x: &Point<f64>,
        (from, to): (f64, f64),
        steps: f64,
    ) -> Result<Point<f64>, TruthError> {
        let clock = Clock { start: self.start_time + from, step: (to - from) / steps };
        let mut step = method.prepare_f64(clock, &self.body)?;
        // what rounding carries goes on, the count of steps begins anew
        let mut moved = Point::from_parts(x.parts(), 0);
        step.open(&mut moved);
        step.advance(&mut moved, steps as u64);
        let mut end = step.reading(&moved);
        end.renormalize();
        let solved = step.worst_residual() <= SOLVED && step.stuck().is_none();
        if end.is_finite() && solved { Ok(end) } else { Err(TruthError::Lost { time: from }) }
    }

    /// Whether a change of the last digits of the start grows to what is seen: far more than the turn does by itself.
    pub(crate) fn is_chaotic(&self) -> bool {
        self.growth * SMALL > GROWN
    }

    /// What the rounding of runs in `f64` amounts to, rad, about: in steps of a tenth of a radian it walks at random, and the
    /// attitude goes on turning.
    pub(super) fn rounding(&self) -> f64 {
        f64::EPSILON * libm::sqrt(0.1 * self.angle) * self.angle
    }

    /// The largest rate up to the end, rad/s.
    pub(crate) fn largest(&self) -> f64 {
        self.rates.iter().copied().fold(0.0, f64::max)
    }

    /// The largest rate between two times, rad/s.
    pub(crate) fn largest_between(&self, from: f64, to: f64) -> f64 {
        self.pieces(from, to).map(|(_, _, rate)| rate).fold(0.0, f64::max)
    }

    /// The pieces between two times: from, to, and the largest rate.
    fn pieces(&self, from: f64, to: f64) -> impl Iterator<Item = (f64, f64, f64)> + '_ {
        let first = self.ends.partition_point(|end| *end <= from);
        let last = self.ends.len().saturating_sub(1);
        (first..=last).map_while(move |k| {
            let begin = if k == first { from } else { self.ends[k - 1] };
            let end = if k == last { to } else { self.ends[k].min(to) };
            (begin < end).then_some((begin, end, self.rates[k]))
        })
    }

    /// Moves `x` from `from` to `to` s after the start by `method` in steps of at most `angle` rad each; where that is infinite, the
    /// method chooses them.
    pub(super) fn carry(
        &self,
        method: &dyn AnyMethod,
        angle: f64,
        x: &mut Point<f64>,
        (from, to): (f64, f64),
    ) -> Result<(), TruthError> {
        if angle.is_infinite() {
            *x = self.advanced(method, x, (from, to), 1.0)?;
            return Ok(());
        }
        for (begin, end, rate) in self.pieces(from, to) {
            let steps = libm::ceil((end - begin) * rate / angle).max(1.0);
            *x = self.advanced(method, x, (begin, end), steps)?;
        }
        Ok(())
    }

    /// When the torque first jumps before `until`, s since the start, and how often it seems to; `None` where it does not.
    ///
    /// A jump is a change from one step to the next that is much larger than those next to it and that does not become smaller where
    /// the step is divided.
    pub(super) fn jumps(&self, start: Point<f64>, until: f64) -> Option<(f64, usize)> {
        let (mut first, mut count) = (None, 0);
        let mut x = start;
        let stride = STRIDE.max(self.angle / MOST_LOOKS);
        // changes of the torque over the last two steps, and where the one between them began
        let mut seen: Vec<(f64, f64, Point<f64>, f64)> = Vec::new();
        let mut size = 0.0_f64;
        for (begin, end, rate) in self.pieces(0.0, until) {
            let steps = libm::ceil((end - begin) * rate / stride).max(1.0);
            let h = (end - begin) / steps;
            let clock = Clock { start: self.start_time + begin, step: h };
            let mut step = Rk8.prepare_f64(clock, &self.body).ok()?;
            let mut moved = Point::from_parts(x.parts(), 0);
            let mut torque = self.torque(begin, &moved);
            for n in 0..steps as u64 {
                let (from, before) = (begin + n as f64 * h, torque);
                x = moved;
                step.steps(&mut moved, 1);
                torque = self.torque(from + h, &moved);
                if !moved.is_finite() || count >= MANY {
                    return first.zip(Some(count));
                }
                size = size.max(torque.norm());
                seen.push(((torque - before).norm(), from, x, h));
                if let [(before, ..), (change, from, x, h), (after, ..)] = seen[..]
                    && change > 4.0 * before.max(after)
                    && change > NOTICED * size
                    && let Some(time) = self.persistent(&x, (from, h), change)
                {
                    first = first.or(Some(time));
                    count += 1;
                }
                if seen.len() == 3 {
                    let _ = seen.remove(0);
                }
            }
            x = moved;
            x.renormalize();
        }
        first.zip(Some(count))
    }

    /// Where in the step of `h` s from `x` the torque changes by half of `change` or more in no time.
    fn persistent(&self, x: &Point<f64>, (from, h): (f64, f64), change: f64) -> Option<f64> {
        let at = |s: f64| {
            let moved = if s > 0.0 { self.advanced(&Rk8, x, (from, from + s), 1.0).ok()? } else { *x };
            Some(self.torque(from + s, &moved))
        };
        let (mut low, mut high) = (0.0, h);
        let (mut left, mut right) = (at(low)?, at(high)?);
        for _ in 0..HALVINGS {
            let middle = 0.5 * (low + high);
            let torque = at(middle)?;
            if (torque - left).norm() > (right - torque).norm() {
                (high, right) = (middle, torque);
            } else {
                (low, left) = (middle, torque);
            }
        }
        ((right - left).norm() > 0.5 * change).then_some(from + high)
    }

    fn torque(&self, elapsed: f64, x: &Point<f64>) -> Vec3<f64> {
        let omega = x.momentum_body.times(self.body.rotor().inverse_moments::<f64>());
        self.body.field::<f64>().torque(Time::from_seconds(self.start_time + elapsed), x.attitude, omega)
    }
}

//! The motion that a run is compared with: the closed form, or two runs in double-double as long as they agree.

use polhode::body::{Body, Clock, Point};
use polhode::flow::ExactMotion;
use polhode::method::{AdaptiveTaylor, AnyMethod as _, StepError};
use polhode::num::{Dd, Precise};
use polhode::rotation::{Quat, Vec3, rotation_angle};
use polhode_files::error::Error;

/// Two runs in double-double agree up to this angle, rad: below it a double has no digits.
const AGREEMENT: f64 = 1e-13;

/// Turn between two looks at the flips of the run in double-double, rad.
const FLIP_ANGLE: f64 = 0.25;

/// Turn after which the series of the second run begin anew, rad: less than the first run takes in a step.
const SECOND_ANGLE: f64 = 0.25;

/// The motion of a body from one start, at times that are counted from it.
pub struct Reference {
    body: Body,
    start_time: f64,
    closed: Option<ExactMotion>,
    /// Time since the start, s, and the points there and how often the body has flipped; ascending, from 0 on.
    looks: Vec<Look>,
    /// About how fast the body turns, rad/s.
    speed: f64,
}

/// Which steps a run in double-double takes.
#[derive(Clone, Copy)]
enum Steps {
    /// As long as its series are good for.
    OfTheirOwn,
    /// A new series at every interval.
    AsGiven,
}

#[derive(Clone, Copy)]
struct Look {
    elapsed: f64,
    point: Point<Dd>,
    flips: Option<u64>,
}

impl Reference {
    /// Of `body` from the doubles `start` on; `times` since the start, s, ascending and positive.
    ///
    /// # Errors
    /// Times beyond the reach of the closed form, and a body that no run in double-double can follow.
    pub fn new(body: &Body, start: Point<f64>, start_time: f64, times: &[f64]) -> Result<Self, Error> {
        // the rounding of |q| would scale the torque
        let Point { attitude, momentum_body, .. } = start.to_dd();
        let point = Point::new(attitude.normalized(), momentum_body);
        let speed = speed(body, &point);
        let begin = Look { elapsed: 0.0, point, flips: Some(0) };
        let closed = ExactMotion::from_point(body, point).ok();
        let (body, looks) = (body.clone(), vec![begin]);
        let mut found = Reference { body, start_time, closed, looks, speed };
        match &found.closed {
            Some(motion) => {
                if let Some(last) = times.last() {
                    motion
                        .check_time(*last)
                        .map_err(|error| Error::Input(format!("--until: {last:?}: {error}")))?;
                }
                let look = |&elapsed: &f64| {
                    let t = Dd::from(elapsed);
                    let flips = match motion {
                        ExactMotion::Free(free) => Some(free.flips(t)),
                        _ => None,
                    };
                    Look { elapsed, point: motion.point_at_dd(t), flips }
                };
                let looks: Vec<Look> = times.iter().map(look).collect();
                found.looks.extend(looks);
            }
            None => found.follow(times).map_err(|error| {
                Error::Input(format!("no closed form of the motion is known, and it cannot be followed in double-double: {error}"))
            })?,
        }
        Ok(found)
    }

    /// Two runs, as long as they agree.
    fn follow(&mut self, times: &[f64]) -> Result<(), StepError> {
        let mut other = self.looks[0].point;
        for &elapsed in times {
            let before = self.looks[self.looks.len() - 1];
            let span = elapsed - before.elapsed;
            let steps = |angle: f64| libm::ceil(span * self.speed / angle).max(1.0) as u64;
            let (mut point, mut flips) = (before.point, Flips::new(&self.body, before.point));
            self.carry(&mut point, (before.elapsed, span), steps(FLIP_ANGLE), Steps::OfTheirOwn, |x| {
                flips.observe(x);
            })?;
            self.carry(&mut other, (before.elapsed, span), steps(SECOND_ANGLE), Steps::AsGiven, |_| ())?;
            let apart = rotation_angle(point.attitude, other.attitude).hi();
            if apart.is_nan() || apart > AGREEMENT {
                return Ok(());
            }
            let flips = before.flips.map(|count| count + flips.count);
            self.looks.push(Look { elapsed, point, flips });
        }
        Ok(())
    }

    /// Moves `x` from `from` s after the start on by `span` s, in `count` intervals, the end of each shown to `seen`.
    fn carry(
        &self,
        x: &mut Point<Dd>,
        (from, span): (f64, f64),
        count: u64,
        steps: Steps,
        mut seen: impl FnMut(&Point<Dd>),
    ) -> Result<(), StepError> {
        let clock = Clock { start: self.start_time + from, step: span / count as f64 };
        let mut step = AdaptiveTaylor::to_rounding().prepare_dd(clock, &self.body)?;
        let mut moved = Point::new(x.attitude, x.momentum_body);
        step.open(&mut moved);
        for _ in 0..count {
            match steps {
                Steps::OfTheirOwn => {
                    step.advance(&mut moved, 1);
                    *x = step.reading(&moved);
                }
                Steps::AsGiven => {
                    step.steps(&mut moved, 1);
                    *x = moved;
                }
            }
            seen(x);
        }
        // steps · h is not the span to the digits of double-double
        *x = self.nudged(x, from + span, Dd::from(span) - clock.elapsed(count))?;
        Ok(())
    }

    /// The point `duration` s after `x`, which is at `elapsed` s, by one series.
    fn nudged(&self, x: &Point<Dd>, elapsed: f64, duration: Dd) -> Result<Point<Dd>, StepError> {
        let mut x = Point::new(x.attitude, x.momentum_body);
        if duration.hi() != 0.0 {
            let clock = Clock { start: self.start_time + elapsed, step: duration.hi() };
            let mut step = AdaptiveTaylor::to_rounding().prepare_dd(clock, &self.body)?;
            step.steps(&mut x, 1);
        }
        Ok(x)
    }

    /// Times of the looks after the start up to which the motion is known, s since the start.
    pub fn times(&self) -> impl DoubleEndedIterator<Item = f64> + '_ {
        self.looks.iter().skip(1).map(|look| look.elapsed)
    }

    /// Up to when the motion is known, s since the start.
    pub fn known_until(&self) -> f64 {
        self.looks.last().map_or(0.0, |look| look.elapsed)
    }

    /// The point at `elapsed` since the start.
    ///
    /// # Errors
    /// None but those of [`new`](Self::new).
    pub fn point_at(&self, elapsed: Dd) -> Result<Point<Dd>, StepError> {
        let distance = |look: &Look| (elapsed - Dd::from(look.elapsed)).hi().abs();
        let after = self.looks.partition_point(|look| look.elapsed < elapsed.hi());
        let before = &self.looks[after.saturating_sub(1)];
        let near = self.looks.get(after).filter(|look| distance(look) < distance(before)).unwrap_or(before);
        let apart = elapsed - Dd::from(near.elapsed);
        match &self.closed {
            _ if apart.hi() == 0.0 => Ok(near.point),
            Some(motion) => Ok(motion.point_at_dd(elapsed)),
            None => self.nudged(&near.point, near.elapsed, apart),
        }
    }

    /// How often the body has flipped until the look at `elapsed` s after the start; `None` where that is not counted.
    pub fn flips_until(&self, elapsed: f64) -> Option<u64> {
        self.looks.iter().rev().find(|look| look.elapsed <= elapsed).and_then(|look| look.flips)
    }

    /// How often the body has flipped until `elapsed` s after the start: at any time of a closed form, else at looks alone.
    pub fn flips_at(&self, elapsed: f64) -> Option<u64> {
        match &self.closed {
            Some(ExactMotion::Free(free)) => Some(free.flips(Dd::from(elapsed))),
            _ => self.looks.iter().find(|look| look.elapsed == elapsed).and_then(|look| look.flips),
        }
    }

    /// The largest less the smallest potential energy over the looks, J.
    pub fn exchanged_energy(&self) -> Option<f64> {
        let gravity = self.body.gravity::<Dd>().filter(|_| self.body.forces().is_empty())?;
        let vertical = Vec3([Dd::ZERO, Dd::ZERO, Dd::ONE]);
        let potential =
            |look: &Look| look.point.attitude.rotate_back(vertical).dot(gravity.weight_moment).hi();
        let (low, high) = self
            .looks
            .iter()
            .map(potential)
            .fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), u| (low.min(u), high.max(u)));
        Some((high - low) * self.body.scale()).filter(|range| *range > 0.0)
    }
}

/// |ω| at the start, and the rate at which its weight can turn it.
fn speed(body: &Body, start: &Point<Dd>) -> f64 {
    let least = body.rotor().moments::<f64>().0.into_iter().fold(f64::INFINITY, f64::min);
    let weight = body.gravity::<f64>().map_or(0.0, |gravity| gravity.weight_moment.norm());
    let torque = body.torque_of(polhode::body::Time::from_seconds(0.0), start).norm().hi();
    body.omega_of(start).norm() + (weight.max(torque) / least).sqrt()
}

/// Changes of sign of the momentum along the axis of the middle moment.
struct Flips {
    axis: usize,
    positive: Option<bool>,
    count: u64,
}

impl Flips {
    fn new(body: &Body, start: Point<Dd>) -> Self {
        let moments = body.rotor().moments::<f64>();
        let mut axes = [0, 1, 2];
        axes.sort_by(|&i, &j| moments[i].total_cmp(&moments[j]));
        let axis = axes[1];
        let mut flips = Flips { axis, positive: None, count: 0 };
        flips.observe(&start);
        flips
    }

    fn observe(&mut self, x: &Point<Dd>) {
        let along = x.momentum_body[self.axis].hi();
        if along != 0.0 {
            let turned = self.positive.is_some_and(|before| before != (along > 0.0));
            self.count += u64::from(turned);
            self.positive = Some(along > 0.0);
        }
    }
}

/// Angle between two attitudes, rad.
pub(super) fn apart<S: Precise>(a: Quat<S>, b: Quat<Dd>) -> f64 {
    rotation_angle(a.map(S::to_dd), b).hi()
}

//! What the attitude of a run is compared with: the closed form, or two runs in double-double that agree.

use std::collections::HashMap;
use std::thread;

use crate::body::{Body, Clock, Point};
use crate::flow::ExactMotion;
use crate::method::{AnyMethod, Rk8, Step, Taylor};
use crate::num::Dd;
use crate::rotation::{Vec3, rotation_angle};

/// Most looks at a motion on the way to a horizon, at equal times: over shorter ways one in two radians.
const MOST_LOOKS: f64 = 64.0;

/// Steps that a run in double-double may take.
const MOST_STEPS: f64 = 65_536.0;

/// The turn of a step of that run, rad.
const ANGLE: f64 = 0.125;

/// Points of the motion at the looks on the way to one horizon.
#[derive(Debug)]
pub(super) struct Truth {
    /// At the looks, the last of them at the horizon.
    pub(super) points: Vec<Point<Dd>>,
    /// How far two runs in double-double are apart at each look, rad; 0 for the closed form.
    pub(super) doubt: Vec<f64>,
}

/// The motion from one start.
#[derive(Debug)]
pub(super) struct Reference {
    body: Body,
    start: Point<Dd>,
    start_time: f64,
    until: f64,
    /// An estimate of the rate of turning, rad/s.
    rate: f64,
    closed: Option<ExactMotion>,
    truths: HashMap<u32, Truth>,
}

impl Reference {
    pub(super) fn new(body: &Body, start: Point<Dd>, start_time: f64, until: f64) -> Self {
        // the rounding of |q| would scale the torque
        let start = Point::new(start.attitude.normalized(), start.momentum_body);
        let closed = ExactMotion::from_point(body, start).ok();
        let rate = rate(body, start, start_time, until);
        let (body, truths) = (body.clone(), HashMap::new());
        Reference { body, start, start_time, until, rate, closed, truths }
    }

    /// Estimated rate of turning, rad/s; 0 for a body that stays at rest.
    pub(super) fn rate(&self) -> f64 {
        self.rate
    }

    /// The closed form, where there is one.
    pub(super) fn closed(&self) -> Option<&ExactMotion> {
        self.closed.as_ref()
    }

    /// The horizon `level`, s: the whole time divided by 2^level.
    pub(super) fn horizon(&self, level: u32) -> f64 {
        libm::scalbn(self.until, -(level.cast_signed()))
    }

    /// Looks on the way to the horizon `level`: a power of two, at least 8.
    pub(super) fn looks(&self, level: u32) -> u64 {
        let wanted = (0.5 * self.horizon(level) * self.rate).clamp(8.0, MOST_LOOKS);
        libm::exp2(libm::floor(libm::log2(wanted))) as u64
    }

    /// The smallest level that a reference reaches at a bearable cost.
    pub(super) fn longest(&self) -> u32 {
        if self.closed.is_some() {
            return 0;
        }
        let steps = self.until * self.rate / ANGLE;
        (0..200).find(|level: &u32| libm::scalbn(steps, -level.cast_signed()) <= MOST_STEPS).unwrap_or(200)
    }

    /// The motion on the way to the horizon `level`; `None` where no method in double-double takes the forces.
    pub(super) fn truth(&mut self, level: u32) -> Option<&Truth> {
        if !self.truths.contains_key(&level) {
            let truth = self.made(level)?;
            self.truths.insert(level, truth);
        }
        self.truths.get(&level)
    }

    /// How far a start with other last bits is away at the whole time, rad: what no method can be asked to better. Where
    /// it is known for a part of the time only, as if it grew in proportion to it.
    pub(super) fn conditioning(&mut self, level: u32) -> Option<f64> {
        let ulp = Dd::from(f64::EPSILON);
        let horizon = self.horizon(level);
        let last = self.truth(level)?.points.last().copied()?;
        let mut worst = 0.0_f64;
        // each component by itself where a motion costs next to nothing, else all in turn up and down
        let each = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
        let changes = if self.closed.is_some() { &each[..] } else { &[[1.0, -1.0, 1.0]] };
        for changed in changes {
            let mut start = self.start;
            start.momentum_body = start.momentum_body.times(Vec3(changed.map(|up| Dd::ONE + ulp * up)));
            let end = match ExactMotion::from_point(&self.body, start) {
                Ok(motion) if self.closed.is_some() => motion.point_at_dd(Dd::from(horizon)),
                _ => self.run(level, start, false)?.last().copied()?,
            };
            worst = worst.max(rotation_angle(end.attitude, last.attitude).hi());
        }
        Some(libm::scalbn(worst, level.cast_signed()))
    }

    fn made(&self, level: u32) -> Option<Truth> {
        let looks = self.looks(level);
        if let Some(motion) = &self.closed {
            let apart = Dd::from(self.horizon(level) / looks as f64);
            let points = (1..=looks).map(|k| motion.point_at_dd(apart * Dd::from(k))).collect();
            return Some(Truth { points, doubt: vec![0.0; looks as usize] });
        }
        let (first, second) = thread::scope(|scope| {
            let first = scope.spawn(|| self.run(level, self.start, false));
            let second = self.run(level, self.start, true);
            (first.join().ok().flatten(), second)
        });
        let (first, second) = (first?, second?);
        let pairs = first.iter().zip(&second);
        let doubt = pairs.map(|(a, b)| rotation_angle(a.attitude, b.attitude).hi()).collect();
        Some(Truth { points: second, doubt })
    }

    /// One run in double-double; the second is the more exact.
    fn run(&self, level: u32, start: Point<Dd>, second: bool) -> Option<Vec<Point<Dd>>> {
        let looks = self.looks(level);
        let apart = self.horizon(level) / looks as f64;
        let steps = |angle: f64| libm::ceil(apart * self.rate / angle).max(1.0);
        let series = Taylor::of_order(if second { 22 } else { 18 }).ok()?;
        let prepare = |method: &dyn AnyMethod, n: f64| {
            method.prepare_dd(Clock { start: self.start_time, step: apart / n }, &self.body).ok()
        };
        let n = steps(ANGLE);
        // of forces that no series takes, a Runge-Kutta method of order 8 in short steps
        let few = steps(ANGLE * if second { 0.125 } else { 0.1875 });
        let (mut step, n): (Box<dyn Step<Dd>>, f64) = match prepare(&series, n) {
            Some(step) => (step, n),
            None => (prepare(&Rk8, few)?, few),
        };
        let mut x = start;
        step.open(&mut x);
        let points = (0..looks).map(|_| {
            step.advance(&mut x, n as u64);
            step.reading(&x)
        });
        Some(points.collect())
    }
}

/// The rate of turning, rad/s: of the start, and of what its torque alone would bring about in a radian or in the whole time.
fn rate(body: &Body, start: Point<Dd>, start_time: f64, until: f64) -> f64 {
    let rotor = body.rotor();
    let torque = body.torque_of(crate::body::Time::from_seconds(start_time), &start);
    let acceleration = torque.times(rotor.inverse_moments()).magnitude();
    let tipped = libm::sqrt(acceleration).min(acceleration * until);
    body.omega_of(&start).norm().max(tipped)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::inertia::Inertia;
    use crate::rotation::Quat;

    #[test]
    fn the_rounding_of_the_norm_of_the_start_does_not_reach_the_motion() {
        // a heavy body that no closed form is known of, from an attitude whose norm is off by some roundings
        let inertia = Inertia::from_moments([0.5, 0.85, 1.0]).unwrap();
        let body = Body::heavy(inertia, [0.0, 0.0, 1.0].into()).unwrap();
        let attitude = Quat::new(0.6, Vec3([0.0, 0.8 * (1.0 + 8.0 * f64::EPSILON), 0.0]));
        let start = |attitude: Quat<Dd>| Point::new(attitude, Vec3::of(Vec3([0.3, 1.0, -0.2])));
        let end = |attitude| {
            let mut reference = Reference::new(&body, start(attitude), 0.0, 16.0);
            reference.truth(0).and_then(|truth| truth.points.last().copied()).unwrap().attitude
        };
        let given = Quat::<Dd>::of(attitude);
        let unit = given.normalized();
        assert!((given.norm_squared() - Dd::ONE).hi().abs() > f64::EPSILON);
        assert!(rotation_angle(end(given), end(unit)).hi() < 1e-25);
        assert!((end(given).norm_squared() - Dd::ONE).hi().abs() < 1e-25);
    }
}

//! The true motion from one start, known at its looks and near them.

use super::follow::Follower;
use super::{AGREEMENT, TruthError, attitude_error};
use crate::body::{Body, Point, Problem, State};
use crate::flow::ExactMotion;
use crate::method::StepError;
use crate::num::Dd;
use crate::observe::Errors;
use crate::rotation::Vec3;

/// The true motion of a body from one start, at times that count from it.
#[derive(Clone, Debug)]
#[must_use]
pub struct Truth {
    pub(super) body: Body,
    /// The doubles that runs start from.
    pub(super) start: Point<f64>,
    pub(super) start_time: f64,
    /// The last time asked for, s since the start.
    pub(super) span: f64,
    closed: Option<ExactMotion>,
    follower: Follower,
    looks: Vec<Known>,
}

/// The motion at a look.
#[derive(Clone, Copy, Debug)]
struct Known {
    /// s since the start; ascending, from 0 on.
    elapsed: f64,
    point: Point<Dd>,
    /// Flips so far; of a closed form, which has them at any time, none.
    flips: u64,
}

/// `count` times at equal distances up to `span`, s.
///
/// ```
/// assert_eq!(polhode::truth::evenly(2.0, 4), [0.5, 1.0, 1.5, 2.0]);
/// ```
#[must_use]
pub fn evenly(span: f64, count: u32) -> Vec<f64> {
    (1..=count).map(|k| span * f64::from(k) / f64::from(count)).collect()
}

impl Truth {
    /// Of `body` from the state `start` (body axes) at t = 0, looked at `times` (s, ascending). Attitude and momentum are rounded
    /// to the doubles that runs start from, so that this rounding does not count as their error.
    ///
    /// # Errors
    /// A start that is not usable, times that do not ascend or that the closed form does not reach, forces that no run in
    /// double-double takes, or a run of too many steps.
    pub fn new(body: &Body, start: &State, times: &[f64]) -> Result<Self, TruthError> {
        Truth::from_point(body, body.enter(start)?.to_f64(), 0.0, times, AGREEMENT)
    }

    /// As [`new`](Self::new), from a point of the solver frame at `start_time` s of the clock of the forces; two runs in
    /// double-double are taken to agree up to `agreement` rad. Its times still count from the start.
    ///
    /// # Errors
    /// As [`new`](Self::new).
    pub fn from_point(
        body: &Body,
        start: Point<f64>,
        start_time: f64,
        times: &[f64],
        agreement: f64,
    ) -> Result<Self, TruthError> {
        let mut before = 0.0;
        for &time in times {
            if !(time.is_finite() && time > before) {
                return Err(TruthError::Order { time, before });
            }
            before = time;
        }
        // the rounding of |q| would scale the torque
        let point = Point::new(start.to_dd().attitude.normalized(), start.to_dd().momentum_body);
        let closed = ExactMotion::from_point(body, point).ok();
        let follower = Follower::new(body, &point, start_time);
        let mut looks = vec![Known { elapsed: 0.0, point, flips: 0 }];
        if let Some(motion) = &closed {
            motion.check_time(before)?;
            let at = |&elapsed: &f64| Known { elapsed, point: motion.point_at_dd(elapsed.into()), flips: 0 };
            looks.extend(times.iter().map(at));
        } else {
            let mut count = 0;
            for look in follower.agreeing(point, times, agreement)? {
                count += look.flips;
                looks.push(Known { elapsed: look.elapsed, point: look.point, flips: count });
            }
        }
        Ok(Truth { body: body.clone(), start, start_time, span: before, closed, follower, looks })
    }

    /// The closed form, where there is one.
    #[must_use]
    pub fn closed_form(&self) -> Option<&ExactMotion> {
        self.closed.as_ref()
    }

    /// The body that moves.
    pub fn body(&self) -> &Body {
        &self.body
    }

    /// The start in the solver frame.
    pub fn start(&self) -> Point<f64> {
        self.start
    }

    /// What the clock of the forces shows at the start, s.
    #[must_use]
    pub fn start_time(&self) -> f64 {
        self.start_time
    }

    /// Times of the looks at which the motion is known, s since the start.
    pub fn times(&self) -> impl DoubleEndedIterator<Item = f64> + '_ {
        self.looks.iter().skip(1).map(|look| look.elapsed)
    }

    /// The last look at which the motion is known, s since the start; 0 where it is known at the start alone.
    #[must_use]
    pub fn known_until(&self) -> f64 {
        self.times().next_back().unwrap_or(0.0)
    }

    /// How far the motion could be asked for, s since the start: the reach of the closed form, or of a run in double-double.
    #[must_use]
    pub fn reach(&self) -> f64 {
        self.closed.as_ref().map_or_else(|| self.follower.reach(), ExactMotion::reach)
    }

    /// The state `elapsed` s after the start, body axes.
    ///
    /// # Errors
    /// A time at which the motion is not known.
    pub fn at(&self, elapsed: f64) -> Result<State, TruthError> {
        self.point_at(elapsed.into()).map(|point| self.body.leave(&point))
    }

    /// The point of the solver frame `elapsed` s after the start.
    ///
    /// # Errors
    /// A time at which the motion is not known.
    pub fn point_at(&self, elapsed: Dd) -> Result<Point<Dd>, TruthError> {
        let (time, known_until) = (elapsed.hi(), self.known_until());
        // an end that was reached by steps may be off by a rounding
        if (0.0..=known_until * (1.0 + 4.0 * f64::EPSILON)).contains(&time) {
            return Ok(self.point_near(elapsed)?);
        }
        let motion = self.closed.as_ref().ok_or(TruthError::Unknown { time, known_until })?;
        motion.check_time(time)?;
        Ok(motion.point_at_dd(elapsed))
    }

    /// The same, from the next look on.
    pub(super) fn point_near(&self, elapsed: Dd) -> Result<Point<Dd>, StepError> {
        let distance = |look: &Known| (elapsed - Dd::from(look.elapsed)).hi().abs();
        let after = self.looks.partition_point(|look| look.elapsed < elapsed.hi());
        let before = &self.looks[after.saturating_sub(1)];
        let near = self.looks.get(after).filter(|look| distance(look) < distance(before)).unwrap_or(before);
        let apart = elapsed - Dd::from(near.elapsed);
        match &self.closed {
            _ if apart.hi() == 0.0 => Ok(near.point),
            Some(motion) => Ok(motion.point_at_dd(elapsed)),
            None => self.follower.nudged(&near.point, near.elapsed, apart),
        }
    }

    /// Angle between the attitude of `point`, at `elapsed` s since the start, and the true one, rad.
    ///
    /// # Errors
    /// A time at which the motion is not known.
    pub fn attitude_error(&self, point: &Point<Dd>, elapsed: Dd) -> Result<f64, TruthError> {
        Ok(attitude_error(point.attitude, self.point_at(elapsed)?.attitude))
    }

    /// How often the momentum along the middle axis has changed sign until `elapsed` s after the start: at any time of a free
    /// body, never counted of a top in closed form, else at looks alone.
    #[must_use]
    pub fn flips(&self, elapsed: f64) -> Option<u64> {
        match &self.closed {
            Some(ExactMotion::Free(free)) => Some(free.flips(elapsed.into())),
            Some(_) => None,
            None => self.looks.iter().find(|look| look.elapsed == elapsed).map(|look| look.flips),
        }
    }

    /// max |E − E₀| of the errors `worst` of a run over max U − min U at the looks, what kinetic and potential energy exchange;
    /// `None` of all but a linear potential, such as that of gravity.
    #[must_use]
    pub fn exchanged_energy_error(&self, worst: &Errors) -> Option<f64> {
        let linear = self.body.linear_potential::<Dd>().filter(|_| self.body.problem() == Problem::Linear)?;
        let vertical = Vec3([Dd::ZERO, Dd::ZERO, Dd::ONE]);
        let height = |look: &Known| look.point.attitude.rotate_back(vertical).dot(linear.moment).hi();
        let (low, high) = self
            .looks
            .iter()
            .map(height)
            .fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), u| (low.min(u), high.max(u)));
        let scale = self.body.scale();
        let exchanged = Some((high - low) * scale).filter(|range| *range > 0.0)?;
        let m = self.start.to_dd().momentum_body;
        let kinetic = 0.5 * m.dot(m.times(self.body.rotor().inverse_moments())).hi();
        let weight = linear.moment.map(Dd::hi).norm() * scale;
        Some(worst.energy? * (kinetic * scale + weight) / exchanged)
    }

    /// The point `elapsed` s after another start `start`, by the closed form or by one run in double-double.
    pub(crate) fn point_from(&self, start: Point<Dd>, elapsed: f64) -> Result<Point<Dd>, TruthError> {
        match (&self.closed, ExactMotion::from_point(&self.body, start)) {
            (Some(_), Ok(motion)) => Ok(motion.point_at_dd(elapsed.into())),
            _ => self.follower.once(start, elapsed),
        }
    }
}

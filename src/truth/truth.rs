//! The true motion from one start, known at its looks and near them.

use super::follow::Follower;
use super::turning::Turning;
use super::{AGREEMENT, LOST, TruthError, attitude_error, pair};
use crate::body::{Body, Point, Problem, State};
use crate::flow::ExactMotion;
use crate::method::{Dop853, StepError};
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
    /// The largest angle between two runs in `f64`, rad, of a motion that is known from them.
    apart: Option<f64>,
    /// When the torque first jumps, s since the start, where that was noticed.
    jump: Option<f64>,
    /// How the body turns, where it was asked.
    turning: Option<Turning>,
}

/// What a motion is to be known for.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Wanted {
    /// Two runs are to agree to this angle, rad.
    pub(crate) accuracy: f64,
    /// Where they do not, to this one at least, rad.
    pub(crate) bearable: f64,
    /// Nothing is followed where a start with another last digit is further away at the end, rad.
    pub(crate) attainable: f64,
    /// For how long runs in double-double may go on, s, where two in `f64` do not agree.
    pub(crate) patience: f64,
}

/// By what their steps are shortened where two runs do not agree, and which part of their distance has to be left then.
const FINER: f64 = 0.6;
const SHRINKS: f64 = 0.3;
const ATTEMPTS: i32 = 4;

/// Two runs of a chaotic motion that part before this part of the time do so in shorter steps too: as many digits again are lost in
/// the rest.
const EARLY: f64 = 0.5;

/// The part of an accuracy that runs are made for.
const AIM: f64 = 0.2;

/// Of what rounding amounts to, the part by which two runs that agree may be off Taylor's method in double-double: of spin-ups 0.85 was
/// seen, and twice this part is counted.
const ROUNDED: f64 = 0.5;

/// The motion at a look.
#[derive(Clone, Copy, Debug)]
struct Known {
    /// s since the start; ascending, from 0 on.
    elapsed: f64,
    point: Point<Dd>,
    /// Flips so far; of a closed form, which has them at any time, and of runs in `f64` not counted.
    flips: Option<u64>,
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
        let before = span(times)?;
        // the rounding of |q| would scale the torque
        let point = Point::new(start.to_dd().attitude.normalized(), start.to_dd().momentum_body);
        let closed = ExactMotion::from_point(body, point).ok();
        let follower = Follower::new(body, &point, start_time);
        let mut looks = vec![Known { elapsed: 0.0, point, flips: Some(0) }];
        if let Some(motion) = &closed {
            motion.check_time(before)?;
            let at =
                |&elapsed: &f64| Known { elapsed, point: motion.point_at_dd(elapsed.into()), flips: None };
            looks.extend(times.iter().map(at));
        } else {
            let mut count = 0;
            for look in follower.agreeing(point, times, agreement)? {
                count += look.flips;
                looks.push(Known { elapsed: look.elapsed, point: look.point, flips: Some(count) });
            }
        }
        let (body, span) = (body.clone(), before);
        let (apart, jump, turning) = (None, None, None);
        Ok(Truth { body, start, start_time, span, closed, follower, looks, apart, jump, turning })
    }

    /// As [`from_point`](Self::from_point), where a motion without closed form is known as long as two runs of different methods in
    /// `f64` agree to `accuracy` rad: over far longer times than runs in double-double can be waited for, and to fewer digits.
    ///
    /// ```
    /// use polhode::truth::{Truth, evenly};
    /// use polhode::{Body, Inertia};
    /// let body = Body::heavy(Inertia::from_moments([0.5, 0.85, 1.0])?, [0.0, 0.0, 1.0].into())?;
    /// let start = body.state(Default::default(), [0.4, 1.2, 0.4].into())?;
    /// let from = body.enter(&start)?.to_f64();
    /// let truth = Truth::to_accuracy(&body, from, 0.0, &evenly(100.0, 4), 1e-9)?;
    /// assert_eq!(truth.known_until(), 100.0);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    /// As [`new`](Self::new), and a torque that jumps.
    pub fn to_accuracy(
        body: &Body,
        start: Point<f64>,
        start_time: f64,
        times: &[f64],
        accuracy: f64,
    ) -> Result<Self, TruthError> {
        let wanted = Wanted { accuracy, bearable: accuracy, attainable: accuracy, patience: 0.0 };
        Truth::within(body, start, start_time, times, wanted, &mut |_| {})
    }

    /// As [`from_point`](Self::from_point), as well as `wanted`, at least cost: the closed form, else two runs of different methods
    /// in `f64`, else two in double-double. `heed` is told from time to time what part of a pass is done.
    ///
    /// # Errors
    /// As [`from_point`](Self::from_point), and a torque that jumps.
    pub(crate) fn within(
        body: &Body,
        start: Point<f64>,
        start_time: f64,
        times: &[f64],
        wanted: Wanted,
        heed: &mut dyn FnMut(f64),
    ) -> Result<Self, TruthError> {
        let until = span(times)?;
        let mut truth = Truth::from_point(body, start, start_time, &[], wanted.accuracy)?;
        if truth.closed.is_some() {
            return Truth::from_point(body, start, start_time, times, wanted.accuracy);
        }
        let from = truth.looks[0].point;
        let start = from.to_f64();
        let turning = Turning::of(body, start, start_time, times, heed)?;
        if f64::EPSILON * turning.growth > wanted.attainable && !turning.is_chaotic() {
            // no run can be asked for that
            (truth.span, truth.turning) = (until, Some(turning));
            return Ok(truth);
        }
        let (mut best, mut nearest, mut jump) = (pair::Pair::default(), f64::INFINITY, None);
        let rounded = ROUNDED * turning.rounding();
        // where rounding alone is too much, the runs tell how far they agree and no more
        let (error, most) = if rounded > wanted.bearable {
            (rounded, wanted.bearable)
        } else {
            (AIM * wanted.accuracy, LOST)
        };
        // a closure may jump: to look costs less than two long runs whose steps do not help
        let closure = body.forces().iter().any(|force| force.series.is_none());
        if closure && pair::are_long(&turning, &pair::smooth(&turning, error, 1.0)) {
            jump = turning.jumps(start, until);
        }
        let attempts = if jump.is_some() { 0 } else { ATTEMPTS };
        for attempt in 0..attempts {
            let legs = pair::smooth(&turning, error, libm::pow(FINER, f64::from(attempt)));
            let pair = pair::run(&turning, start, (times, most), &legs, heed)?;
            let (worst, before) = (pair.worst(times), nearest);
            if worst <= nearest {
                (best, nearest) = (pair, worst);
            }
            // what is left of rounding does not shrink with the steps
            if worst <= wanted.accuracy.max(turning.rounding()) || most < LOST {
                break;
            }
            // a closure may do what no law on series does
            if attempt == 0 && closure {
                let parted = times.get(best.agreed(wanted.accuracy)).copied().unwrap_or(until);
                jump = turning.jumps(start, parted);
                if jump.is_some() {
                    break;
                }
            }
            // shorter steps add fewer digits than the rest of a chaotic motion takes
            let early = times.get(best.looks.len()).is_some_and(|lost| *lost < EARLY * until);
            let hopeless = turning.is_chaotic() && early;
            // shorter steps do not help: chaos, or a torque that jumps
            if hopeless || (attempt > 0 && (worst.is_infinite() || worst > SHRINKS * before)) {
                let parted = times.get(best.agreed(wanted.accuracy)).copied().unwrap_or(until);
                jump = turning.jumps(start, parted);
                break;
            }
        }
        if let Some((time, count)) = jump {
            best = pair::across(&turning, start, (times, wanted.accuracy), (time, count), heed)?;
            nearest = best.worst(times);
            if nearest > wanted.bearable {
                return Err(TruthError::Jumps { time });
            }
        }
        if nearest > wanted.accuracy && jump.is_none() {
            let seconds = truth.follower.seconds(&from, turning.angle)?;
            let slow = seconds > wanted.patience;
            let doubled = || Truth::from_point(body, truth.start, start_time, times, wanted.accuracy).ok();
            if let Some(mut truth) = (!slow).then(doubled).flatten() {
                truth.turning = Some(turning);
                return Ok(truth);
            }
        }
        let limit = if nearest > wanted.bearable { wanted.accuracy } else { wanted.bearable };
        let agreed = best.agreed(limit);
        let known = times.iter().zip(&best.looks).take(agreed);
        let known = known.map(|(&elapsed, point)| Known { elapsed, point: point.to_dd(), flips: None });
        truth.looks.extend(known);
        truth.span = until;
        let apart = best.apart.iter().take(agreed).copied().fold(0.0, f64::max);
        (truth.apart, truth.jump, truth.turning) = (Some(apart), jump.map(|(time, _)| time), Some(turning));
        Ok(truth)
    }

    /// How far the motion itself may be off, rad, where it is known from runs in `f64`: what the two are apart, and at least what both
    /// may have rounded alike; 0 of any other.
    pub(crate) fn apart(&self) -> f64 {
        let rounded = self.turning.as_ref().map_or(0.0, |turning| ROUNDED * turning.rounding());
        self.apart.map_or(0.0, |apart| apart.max(rounded))
    }

    /// When the torque first jumps, s since the start, where that was noticed.
    pub(crate) fn jump(&self) -> Option<f64> {
        self.jump
    }

    /// How the body turns, of a motion that was asked for by [`within`](Self::within) and has no closed form.
    pub(crate) fn turning(&self) -> Option<&Turning> {
        self.turning.as_ref()
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
            None => match self.turning.as_ref().filter(|_| self.apart.is_some()) {
                Some(turning) => Ok(moved(turning, near, apart)),
                None => self.follower.nudged(&near.point, near.elapsed, apart),
            },
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
            None => self.looks.iter().find(|look| look.elapsed == elapsed).and_then(|look| look.flips),
        }
    }

    /// max |E − E₀| of the errors `worst` of a run over max U − min U at the looks, what kinetic and potential energy exchange;
    /// `None` of all but a linear potential, such as that of gravity.
    #[must_use]
    pub fn exchanged_energy_error(&self, worst: &Errors) -> Option<f64> {
        let linear = self.body.linear_potential::<Dd>().filter(|_| self.body.problem() == Problem::Linear)?;
        let height = |look: &Known| look.point.attitude.rotate_back(Vec3::unit(2)).dot(linear.moment).hi();
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

/// The point `apart` s behind a look, or before it, in `f64`.
fn moved(turning: &Turning, look: &Known, apart: Dd) -> Point<Dd> {
    let mut x = look.point.to_f64();
    let (method, to) = (Dop853::of_tolerance(1e-14), look.elapsed + apart.hi());
    let moved = method.map(|method| turning.carry(&method, f64::INFINITY, &mut x, (look.elapsed, to)));
    if matches!(moved, Ok(Ok(()))) { x.to_dd() } else { look.point }
}

/// The last of `times`, s since the start.
fn span(times: &[f64]) -> Result<f64, TruthError> {
    let mut before = 0.0;
    for &time in times {
        if !(time.is_finite() && time > before) {
            return Err(TruthError::Order { time, before });
        }
        before = time;
    }
    Ok(before)
}

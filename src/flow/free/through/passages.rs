//! The free motions through two attitudes.

use nalgebra::{UnitQuaternion, Vector3};
use thiserror::Error;

use super::cone::Cone;
use super::search::{Found, Search};
use crate::body::{Body, Point};
use crate::flow::free::FreeMotion;
use crate::inertia::Inertia;
use crate::num::{Dd, Real};
use crate::rotation::{Quat, Vec3, rotation_angle};

/// Most turns between two attitudes that are searched.
const MOST_TURNS: f64 = 1000.0;
/// Newton's iterations after the search; two are enough where the attitudes are not conjugate.
const ITERATIONS: u32 = 8;
/// Angle to the attitude asked for that no iteration makes smaller, rad: that attitude is itself rounded to 2⁻⁵².
const REACHED: f64 = 1e-15;
/// The same above which a momentum leads elsewhere, rad. Where the attitudes are conjugate the derivative has no inverse, and the root
/// of the rounding is left.
const ELSEWHERE: f64 = 1e-9;
/// Step of Newton's iteration, of the momentum, from which on it may lead to another motion.
const LONG: f64 = 0.5;
/// Difference of angular velocities (relative) and of turns up to which two motions are one that was met twice: the search leaves some
/// 10⁻¹² before Newton's iteration.
const SAME: f64 = 1e-9;
/// Of the angle between the axis of a turn and a principal axis, below which it is rounding.
const ALONG: f64 = 1e-13;

/// One free motion through two attitudes.
#[derive(Clone, Debug)]
#[must_use]
#[non_exhaustive]
pub struct Passage {
    /// The motion, whose t = 0 is the earlier of the two times.
    pub motion: FreeMotion,
    /// Angular velocity at the earlier time, body axes, rad/s.
    pub omega_body: Vector3<f64>,
    /// Mean spin 2E/|L| times the time between, in turns.
    pub turns: f64,
    /// Angle between the attitude that it reaches and that asked for, rad.
    pub miss: f64,
    /// Newton's iterations that were taken after the search.
    pub iterations: u32,
    /// Whether the search that found it is known to have found all others.
    pub complete: bool,
}

/// All free motions through two attitudes up to a number of turns.
#[derive(Clone, Debug)]
#[must_use]
#[non_exhaustive]
pub struct Passages {
    /// In ascending order of their turns.
    pub list: Vec<Passage>,
    /// Whether the list is known to be complete, but for motions that almost coincide with others.
    pub complete: bool,
    /// Whether the attitudes differ by a symmetry of the ellipsoid of inertia, as equal ones do: then there are, besides those of the list,
    /// families of motions with a continuous parameter, as the full turns of a sphere about any axis.
    pub families: bool,
}

/// Why no motion through two attitudes can be found.
#[derive(Clone, Debug, PartialEq, Error)]
#[non_exhaustive]
pub enum ThroughError {
    /// A time is not a number.
    #[error("time {t} s is not a finite number")]
    NotFinite {
        /// The time, s.
        t: f64,
    },
    /// Both attitudes have the same time.
    #[error("both attitudes are at t = {t} s; their times must differ")]
    SameTime {
        /// The time, s.
        t: f64,
    },
    /// The number of turns is not positive, or too large to search.
    #[error("{turns} turns between the attitudes; give a number above 0 and up to {MOST_TURNS}")]
    Turns {
        /// The number given.
        turns: f64,
    },
    /// Too few attitudes.
    #[error("{attitudes} attitudes are too few; an interpolation needs two, a fit three")]
    TooFew {
        /// How many there are.
        attitudes: usize,
    },
    /// Times of a table do not ascend.
    #[error("the attitude at {after} s follows that at {before} s in the table; times must ascend")]
    NotAscending {
        /// A time, s.
        before: f64,
        /// The time after it, s.
        after: f64,
    },
    /// A time is not between the attitudes.
    #[error("{t} s is not between the first attitude, at {first} s, and the last, at {last} s")]
    Outside {
        /// The time, s.
        t: f64,
        /// The first time, s.
        first: f64,
        /// The last time, s.
        last: f64,
    },
    /// The noise of attitudes is no standard deviation.
    #[error("the standard deviation of the attitudes is {noise} rad; it must be positive")]
    Noise {
        /// The noise, rad.
        noise: f64,
    },
    /// Least squares that do not converge.
    #[error(
        "the least-squares fit of the first {attitudes} attitudes does not converge: the start is too far from them"
    )]
    NotConverged {
        /// How many attitudes were taken.
        attitudes: usize,
    },
    /// No free motion of so few turns leads from one attitude to the other.
    #[error(
        "no free motion of at most {turns} turns connects the attitudes, which are {angle} rad apart; allow more turns"
    )]
    NoneWithin {
        /// The most turns.
        turns: f64,
        /// Angle between the attitudes, rad.
        angle: f64,
    },
}

impl Passages {
    /// The motion whose angular velocity at the earlier time is nearest to `omega_body`, rad/s, body axes.
    #[must_use]
    pub fn nearest(&self, omega_body: Vector3<f64>) -> Option<&Passage> {
        let distance = |passage: &&Passage| (passage.omega_body - omega_body).norm();
        self.list.iter().min_by(|a, b| distance(a).total_cmp(&distance(b)))
    }
}

impl FreeMotion {
    /// All free motions of a body through two attitudes (body → space) at two times (s) that turn at most `turns` times between
    /// them, counted by the mean spin 2E/|L|.
    ///
    /// A momentum has the same energy at both attitudes only along a cone; along it the number of periods between gives its size,
    /// and the turn about it is one smooth function of which the derivative is known too. Pieces of the cone are halved until function
    /// and derivative agree at their ends; then each root has a bracket, and where the function turns round two roots have one each,
    /// however near they are. Where that is not reached, [`Passages::complete`] is false. A motion that is so near to the separatrix that
    /// no double tells it apart may be missed.
    ///
    /// ```
    /// use nalgebra::{UnitQuaternion, Vector3};
    /// use polhode::flow::FreeMotion;
    /// use polhode::inertia::Inertia;
    /// let body = Inertia::from_moments([1.0, 2.0, 3.0])?;
    /// let (before, after) = (UnitQuaternion::identity(), UnitQuaternion::from_euler_angles(0.3, -0.8, 0.5));
    /// let motions = FreeMotion::through(&body, (10.0, before), (12.0, after), 1.0)?;
    /// for passage in &motions.list {
    ///     assert!(passage.motion.at(2.0)?.rotation().angle_to(&after) < 1e-14);
    /// }
    /// assert!(motions.list.len() > 1 && motions.list[0].turns < 0.5);
    /// # Ok::<(), polhode::Error>(())
    /// ```
    ///
    /// # Errors
    /// Times that coincide or are no numbers, a number of turns that is not positive or above 1000, and attitudes that no motion of
    /// so few turns connects.
    pub fn through(
        inertia: &Inertia,
        first: (f64, UnitQuaternion<f64>),
        second: (f64, UnitQuaternion<f64>),
        turns: f64,
    ) -> Result<Passages, ThroughError> {
        Self::through_finely(inertia, first, second, turns, 1)
    }

    /// The same with a search that takes `finer` times as many looks at the cone.
    #[doc(hidden)]
    pub fn through_finely(
        inertia: &Inertia,
        first: (f64, UnitQuaternion<f64>),
        second: (f64, UnitQuaternion<f64>),
        turns: f64,
        finer: u32,
    ) -> Result<Passages, ThroughError> {
        for t in [first.0, second.0] {
            if !t.is_finite() {
                return Err(ThroughError::NotFinite { t });
            }
        }
        if first.0 == second.0 {
            return Err(ThroughError::SameTime { t: first.0 });
        }
        if !(turns > 0.0 && turns <= MOST_TURNS) {
            return Err(ThroughError::Turns { turns });
        }
        let (first, second) = if first.0 < second.0 { (first, second) } else { (second, first) };
        let task = Task::new(inertia, first, second, turns);
        let passages = task.passages(finer);
        if passages.list.is_empty() {
            let angle = rotation_angle(Quat::from(first.1), Quat::from(second.1));
            return Err(ThroughError::NoneWithin { turns, angle });
        }
        Ok(passages)
    }
}

/// Two attitudes of a body.
struct Task<'a> {
    inertia: &'a Inertia,
    moments: Vec3<f64>,
    from: Quat<Dd>,
    to: Quat<Dd>,
    time: f64,
    turns: f64,
}

impl<'a> Task<'a> {
    fn new(
        inertia: &'a Inertia,
        (t0, q0): (f64, UnitQuaternion<f64>),
        (t1, q1): (f64, UnitQuaternion<f64>),
        turns: f64,
    ) -> Self {
        let inside = |q: UnitQuaternion<f64>| inertia.attitude_of_axes(Quat::<Dd>::of(q.into()).normalized());
        Task {
            inertia,
            moments: Body::free(inertia.clone()).rotor().moments(),
            from: inside(q0),
            to: inside(q1),
            time: t1 - t0,
            turns,
        }
    }

    fn passages(&self, finer: u32) -> Passages {
        let turn = (self.from.conjugate() * self.to).map(Dd::hi);
        let cone = Cone::of(self.moments, turn);
        let mut found = match &cone {
            Some(cone) => Search { moments: self.moments, turn, turns: self.turns, cone, finer }.run(),
            None => Found::default(),
        };
        self.steady(turn, &mut found.momenta);
        let count = found.momenta.len();
        let mut list: Vec<Passage> = found.momenta.into_iter().filter_map(|m| self.polished(m)).collect();
        let lost = count - list.len();
        list.extend(found.candidates.into_iter().filter_map(|m| self.polished(m)));
        list.sort_by(|a, b| a.turns.total_cmp(&b.turns));
        // one that was met from both sides
        list.dedup_by(|a, b| {
            (a.omega_body - b.omega_body).norm() <= SAME * b.omega_body.norm() && a.turns - b.turns < SAME
        });
        let complete = found.unresolved == 0 && lost == 0;
        list.iter_mut().for_each(|passage| passage.complete = complete);
        Passages { list, complete, families: cone.is_none() }
    }

    /// Momenta of steady spins for the time 1: the axis of the turn is a principal axis.
    fn steady(&self, turn: Quat<f64>, momenta: &mut Vec<Vec3<f64>>) {
        let angle = 2.0 * libm::atan2(turn.v.norm(), turn.w.abs());
        let most = core::f64::consts::TAU * self.turns;
        if turn.v.norm() == 0.0 {
            momenta.push(Vec3::zero());
        }
        let mut about = |axis: Vec3<f64>, moment: f64, angle: f64| {
            let mut total = angle;
            while total <= most {
                momenta.push(axis * (total * moment));
                total += core::f64::consts::TAU;
            }
        };
        if turn.v.norm() == 0.0 {
            for k in 0..3 {
                about(Vec3::unit(k), self.moments[k], core::f64::consts::TAU);
                about(-Vec3::unit(k), self.moments[k], core::f64::consts::TAU);
            }
            return;
        }
        let sign = if turn.w < 0.0 { -1.0 } else { 1.0 };
        let axis = turn.v * (sign / turn.v.norm());
        let m = self.moments.times(axis);
        if axis.cross(m).norm() <= ALONG * m.norm() {
            let moment = axis.dot(m);
            about(axis, moment, angle);
            about(-axis, moment, core::f64::consts::TAU - angle);
        }
    }

    /// The motion that starts with the momentum `m` for the time 1, after Newton's iterations; `None` where they lead elsewhere.
    fn polished(&self, m: Vec3<f64>) -> Option<Passage> {
        let mut start = Point::new(self.from, (m * (1.0 / self.time)).map(Dd::of));
        let mut iterations = 0;
        let mut motion = FreeMotion::from_point(self.inertia, start);
        let mut miss = self.miss(&motion);
        while iterations < ITERATIONS && miss.1 > REACHED {
            let Some(next) = self.improved(&motion, start, miss.0) else { break };
            let other = FreeMotion::from_point(self.inertia, next);
            let missed = self.miss(&other);
            iterations += 1;
            if missed.1 < miss.1 {
                (start, motion, miss) = (next, other, missed);
            } else {
                break;
            }
        }
        let omega_body = motion.body().omega_of(&start);
        let norm = start.momentum_body.norm().hi();
        let twice_energy =
            start.momentum_body.dot(start.momentum_body.times(motion.body().rotor().inverse_moments())).hi();
        let turns = if norm == 0.0 { 0.0 } else { twice_energy / norm * self.time / core::f64::consts::TAU };
        (miss.1 <= ELSEWHERE).then_some(Passage {
            motion,
            omega_body,
            turns,
            miss: miss.1,
            iterations,
            complete: true,
        })
    }

    /// Rotation vector in space from the attitude that `motion` reaches to that asked for, and its angle.
    fn miss(&self, motion: &FreeMotion) -> (Vec3<f64>, f64) {
        let reached = motion.point_after(Dd::of(self.time)).attitude.map(Dd::of);
        let rest = self.to * reached.conjugate();
        let rest = if rest.w < Dd::ZERO { -rest } else { rest };
        (rest.v.map(|x| 2.0 * x.hi()), rotation_angle(reached, self.to).hi())
    }

    /// The start after one step of Newton's iteration.
    fn improved(&self, motion: &FreeMotion, start: Point<Dd>, miss: Vec3<f64>) -> Option<Point<Dd>> {
        let derivative = motion.turn_by_momentum(self.time);
        let change = derivative.lu().solve(&miss.into())?;
        let change = Vec3([change.x, change.y, change.z]);
        // a step as long as the momentum is none that this iteration can vouch for
        let small = change.norm() < LONG * start.momentum_body.norm().hi();
        small.then(|| Point::new(start.attitude, start.momentum_body + change.map(Dd::of)))
    }
}

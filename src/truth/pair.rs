//! Two runs in `f64` by methods of different families, whose steps follow the rate of turning: what is known of a motion at a small
//! multiple of the cost of one run.
//!
//! At a turn of `a` rad a step the error of both is about `c a⁸ Θ²` rad after Θ rad, as measured on asymmetric bodies under
//! drag, constant torques and gravity gradients.

use super::together::together;
use super::turning::{self, Turning};
use super::{LOST, TruthError, attitude_error};
use crate::body::Point;
use crate::method::{AnyMethod, Dop853, Gauss, Rk8, Tsit5};

/// A method, and the turn of a step of it, rad; infinite where it chooses its steps.
type Leg = (Box<dyn AnyMethod>, f64);

/// c of `rk8` and of `gauss:8`, and the steps that they take at least and at most.
const EXPLICIT: (f64, f64, f64) = (4e-11, 0.02, 0.3);
const IMPLICIT: (f64, f64, f64) = (1e-13, 0.05, 0.5);

/// By which factors c of one body may differ from these: one look alone may see too little.
const SEEN: (f64, f64) = (0.003, 30.0);

/// The error over tolerance · Θ² of `dop853` and `tsit5`.
const ADAPTIVE: f64 = 4e-3;

/// Steps of `tsit5` a radian at a tolerance of 1e-12, and the most that it takes in all its runs: a second, about.
const SMALL_STEPS: f64 = 40.0;
const MOST_SMALL_STEPS: f64 = 2e6;

/// Steps of two runs that take about half a second.
const MANY_STEPS: f64 = 5e5;

/// Parts of an accuracy, one after the other, for runs across a jump of the torque, whose error is not that of smooth ones.
const JUMPING: [f64; 3] = [0.1, 1e-3, 1e-5];

/// Θ counts as this at least.
const LEAST_ANGLE: f64 = 30.0;

/// What two runs showed.
#[derive(Clone, Debug, Default)]
pub(super) struct Pair {
    /// Points of the first at the times, as long as the two are near each other.
    pub(super) looks: Vec<Point<f64>>,
    /// How far they are apart at each, rad.
    pub(super) apart: Vec<f64>,
}

impl Pair {
    /// The largest distance, rad; infinite where the runs part before the last of `times`.
    pub(super) fn worst(&self, times: &[f64]) -> f64 {
        if self.apart.len() < times.len() {
            f64::INFINITY
        } else {
            self.apart.iter().copied().fold(0.0, f64::max)
        }
    }

    /// The looks up to which the runs agree to `limit` rad.
    pub(super) fn agreed(&self, limit: f64) -> usize {
        self.apart.iter().take_while(|apart| **apart <= limit).count()
    }
}

/// The runs in fixed steps for an error of about `error` rad, shorter ones by the factor `finer`.
pub(super) fn smooth(turning: &Turning, error: f64, finer: f64) -> [Leg; 2] {
    let angle = turning.angle.max(LEAST_ANGLE);
    // what the coarse runs show of this body counts more than what others showed
    let usual = EXPLICIT.0 * angle * angle;
    let seen = turning.error.map_or(1.0, |error| (error / usual).clamp(SEEN.0, SEEN.1));
    let of = |(c, least, most): (f64, f64, f64)| {
        finer * libm::pow(error / (seen * c * angle * angle), 0.125).clamp(least, most)
    };
    [(Box::new(Rk8), of(EXPLICIT)), (Box::new(Gauss::ORDER_8), of(IMPLICIT))]
}

/// Whether `legs` take so many steps that to look for a jump of the torque first costs less.
pub(super) fn are_long(turning: &Turning, [(_, explicit), (_, implicit)]: &[Leg; 2]) -> bool {
    // one that is solved for costs as much as two others
    turning.angle / explicit + 2.0 * turning.angle / implicit > MANY_STEPS
}

/// Runs that choose their steps through `times`, for a torque that jumps `count` times, first at `time` s since the start: those of
/// several tolerances that agree best, to `accuracy` rad if they can.
///
/// # Errors
/// Runs of too many steps, and as [`run`].
pub(super) fn across(
    turning: &Turning,
    start: Point<f64>,
    (times, accuracy): (&[f64], f64),
    (time, count): (f64, usize),
    heed: &mut dyn FnMut(f64),
) -> Result<Pair, TruthError> {
    let (mut best, mut nearest) = (Pair::default(), f64::INFINITY);
    let (mut taken, mut before) = (0.0, 0.0);
    for part in JUMPING {
        let Some((legs, steps)) = jumping(turning, part * accuracy) else { break };
        // the least tolerance may have been the one before
        if steps <= before || count >= turning::MANY {
            break;
        }
        if taken + steps > MOST_SMALL_STEPS {
            if taken == 0.0 {
                return Err(TruthError::LongAcrossJump { time, steps, most: MOST_SMALL_STEPS });
            }
            break;
        }
        (taken, before) = (taken + steps, steps);
        let pair = run(turning, start, (times, LOST), &legs, heed)?;
        let worst = pair.worst(times);
        if worst < nearest {
            (best, nearest) = (pair, worst);
        }
        if nearest <= accuracy {
            break;
        }
    }
    Ok(best)
}

/// The runs that choose their steps, for a torque that jumps, and how many steps the second takes, about.
fn jumping(turning: &Turning, error: f64) -> Option<([Leg; 2], f64)> {
    let angle = turning.angle.max(LEAST_ANGLE);
    let tolerance = (error / (ADAPTIVE * angle * angle)).clamp(1e-15, 1e-6);
    let steps = SMALL_STEPS * angle * libm::pow(1e-12 / tolerance, 0.2);
    let (first, second) = (Dop853::of_tolerance(tolerance).ok()?, Tsit5::of_tolerance(tolerance).ok()?);
    Some(([(Box::new(first), f64::INFINITY), (Box::new(second), f64::INFINITY)], steps))
}

/// Runs `legs` from `start` through `times`, as long as they are at most `most` rad apart.
pub(super) fn run(
    turning: &Turning,
    start: Point<f64>,
    (times, most): (&[f64], f64),
    legs: &[Leg; 2],
    heed: &mut dyn FnMut(f64),
) -> Result<Pair, TruthError> {
    let last = times.last().copied().unwrap_or(0.0);
    let mut pair = Pair::default();
    let pass = |which: usize| {
        let (method, angle) = &legs[which];
        let (mut x, mut from) = (start, 0.0);
        move |&to: &f64| {
            turning.carry(method.as_ref(), *angle, &mut x, (from, to))?;
            from = to;
            Ok((to, x))
        }
    };
    let each = |(time, one): (f64, Point<f64>), (_, other): (f64, Point<f64>)| {
        heed(time / last);
        let apart = attitude_error(one.attitude, other.to_dd().attitude);
        if apart > most {
            return false;
        }
        pair.looks.push(one);
        pair.apart.push(apart);
        true
    };
    match together(times, pass, each) {
        // what is known until then stays known
        Err(TruthError::Lost { .. }) | Ok(()) => Ok(pair),
        Err(error) => Err(error),
    }
}

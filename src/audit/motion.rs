//! The motion that a record is compared with: the closed form where there is one, else steps of a power series.

use super::states::Row;
use crate::body::{Body, Clock, Point, Problem};
use crate::flow::ExactMotion;
use crate::method::{AdaptiveTaylor, AnyMethod, Rk8, Step};
use crate::num::{Dd, Precise};
use crate::rotation::{Quat, Vec3};

/// Longest way, rad, that is run in double-double more than once.
const FAR: f64 = 2000.0;

/// Longest way, rad, that is run at all, between two rows typically and in all.
const FARTHEST: [f64; 2] = [10.0, 1e5];

/// The turn of a step where no power series takes the forces, rad.
const STEP: f64 = 0.05;

/// Attitude, body → space, and angular velocity, body axes, of the motion from `start` at each of `times`, not before its own;
/// `None` where it cannot be followed. `precise`: in double-double, where it has to be run.
pub(super) fn follow(
    body: &Body,
    start: &Row,
    times: &mut dyn Iterator<Item = f64>,
    precise: bool,
    each: &mut dyn FnMut(Quat<f64>, Vec3<f64>),
) -> Option<()> {
    let attitude = start.attitude.unwrap_or(Quat::identity());
    let inside = body.enter_omega(attitude, start.omega).ok()?;
    let mut read = |point: Point<f64>| {
        let state = body.leave(&point);
        each(state.attitude, Vec3::from(body.omega_of(&point)));
    };
    if let Ok(exact) = ExactMotion::from_point(body, inside) {
        times.for_each(|t| read(exact.point_at(Dd::from(t) - Dd::from(start.time))));
        return Some(());
    }
    let series = AdaptiveTaylor::to_rounding();
    if precise {
        let prepare =
            |clock, acting: &Body| prepared(&series, |method| method.prepare_dd(clock, acting).ok());
        let rate = |point: &Point<Dd>| body.omega_of(point).norm();
        return stepped(body, prepare, inside, start.time, rate, times, &mut |point| read(point.to_f64()));
    }
    let prepare = |clock, acting: &Body| prepared(&series, |method| method.prepare_f64(clock, acting).ok());
    let rate = |point: &Point<f64>| body.omega_of(point).norm();
    stepped(body, prepare, inside.to_f64(), start.time, rate, times, &mut |point| read(*point))
}

/// The same in a list.
pub(super) fn motion(
    body: &Body,
    start: &Row,
    times: impl Iterator<Item = f64>,
    precise: bool,
) -> Option<Vec<(Quat<f64>, Vec3<f64>)>> {
    let times: Vec<f64> = times.collect();
    let mut found = Vec::with_capacity(times.len());
    let precise = precise && way(body, start, &times)? < FAR;
    follow(body, start, &mut times.into_iter(), precise, &mut |q, omega| found.push((q, omega)))?;
    Some(found)
}

/// How far the body turns up to the last of `times`, rad: a motion without closed form is run for that, and that of a free body
/// counts as none; `None` where it cannot be followed.
pub(super) fn way(body: &Body, start: &Row, times: &[f64]) -> Option<f64> {
    if body.problem() == Problem::Free {
        return Some(0.0);
    }
    let (mut way, mut before, mut at) = (0.0, start.time, 0);
    let mut measure = |_, omega: Vec3<f64>| {
        way += omega.norm() * (times[at] - before);
        (before, at) = (times[at], at + 1);
    };
    follow(body, start, &mut times.iter().copied(), false, &mut measure)?;
    Some(way)
}

/// A step of `series`, or of a Runge-Kutta method where a force is a closure; and whether it chooses its own substeps.
fn prepared<S: Precise>(
    series: &AdaptiveTaylor,
    prepare: impl Fn(&dyn AnyMethod) -> Option<Box<dyn Step<S>>>,
) -> Option<(Box<dyn Step<S>>, bool)> {
    prepare(series).map(|step| (step, true)).or_else(|| Some((prepare(&Rk8)?, false)))
}

fn stepped<S: Precise>(
    body: &Body,
    prepare: impl Fn(Clock, &Body) -> Option<(Box<dyn Step<S>>, bool)>,
    start: Point<S>,
    start_time: f64,
    rate_of: impl Fn(&Point<S>) -> f64,
    times: &mut dyn Iterator<Item = f64>,
    each: &mut dyn FnMut(&Point<S>),
) -> Option<()> {
    let (mut x, mut t) = (start, start_time);
    let (rate, mut way) = (rate_of(&start), 0.0);
    // no step goes over the switching of a force or a motor
    let switchings = body.switching_times();
    let mut acting = body.acting(t, true);
    for (row, time) in times.enumerate() {
        while time > t {
            let next = switchings.iter().copied().find(|switching| *switching > t);
            let end = next.map_or(time, |next| next.min(time));
            let (mut step, adaptive) = prepare(Clock { start: t, step: end - t }, &acting)?;
            let mut n = 1;
            if !adaptive {
                n = ((end - t) * rate / STEP).ceil().clamp(1.0, 1e6) as u64;
                step = prepare(Clock { start: t, step: (end - t) / n as f64 }, &acting)?.0;
            }
            step.open(&mut x);
            step.advance(&mut x, n);
            let reached = step.reading(&x);
            x = Point::new(reached.attitude, reached.momentum_body);
            way += rate_of(&x) * (end - t);
            t = end;
            if next == Some(t) {
                acting = body.acting(t, true);
            }
        }
        if !x.is_finite() || way > FARTHEST[1].max(FARTHEST[0] * row as f64) {
            return None;
        }
        each(&x);
    }
    Some(())
}

//! The torque that a record shows beside what acts on its body.

use super::program::Dynamics;
use super::rows::Windows;
use super::states::{Row, states};
use super::{Frame, OtherTorque, Reading, Trajectory};
use crate::body::{Body, Problem, Time};
use crate::record::median;
use crate::rotation::Vec3;

/// A change of L over a window this many times what a row may be off stands out.
const STANDS_OUT: f64 = 5.0;

/// The attitudes turn by the angular velocities within this share of the change of L: else it is no torque that changes it.
const KINEMATIC: f64 = 0.3;

/// A torque of one form explains this share of the squares.
const EXPLAINED: f64 = 0.9;

/// Windows grow by this factor until a torque that is told and does not act so stands out.
const GROWTH: usize = 4;

/// Most windows of one length.
const MOST: usize = 96;

/// A change of L above so many times the noise is one.
const SEEN_IN_NOISE: f64 = 3.0;

/// One window of the record: what changes L over it, as means over its time, in units of the solver frame.
struct Look {
    /// The change of L that the torques of the body leave, in space and in the axes of the body.
    rest: [Vec3<f64>; 2],
    /// Of the torques of the body, in space.
    told: Vec3<f64>,
    /// Duration, s.
    time: f64,
    /// By which the attitudes turn otherwise than the angular velocities say, rad.
    kinematic: f64,
    /// |L|.
    momentum: f64,
    /// Noise of a component of L, relative; `None` of two rows.
    noise: Option<f64>,
    /// Square of the largest turn between rows.
    coarse: f64,
}

/// The torque that changes L beside those of `body`, from attitudes and angular velocities; `None` where L changes no more than by
/// what a row may be off, `allowed` and noise, or where the attitudes do not turn by the angular velocities. `noise`: of a
/// row, where the windows are too short to show it.
///
/// A torque that is told is looked for up to the length of the record, over which what is missing of it adds up.
pub(super) fn other_torque(
    record: &Trajectory,
    reading: &Reading,
    body: &Body,
    allowed: f64,
    noise: f64,
) -> Option<OtherTorque> {
    record.attitude.as_ref()?;
    record.rates.as_ref()?;
    let Windows { starts, mut stride, .. } = Windows::of(record, 1);
    let dynamics = Dynamics::new(body);
    let free = body.problem() == Problem::Free;
    let of_windows = |starts: &[usize], stride: usize| -> Vec<Look> {
        let of_window = |&start: &usize| {
            let rows: Vec<usize> = (start..=start + stride).collect();
            look(&states(record, reading, body, &rows), &dynamics, body, free)
        };
        starts.iter().filter_map(of_window).collect()
    };
    let looks = of_windows(&starts, stride);
    let off = allowed + SEEN_IN_NOISE * middle(&looks, |look| look.noise).unwrap_or(noise);
    if let Some(found) = told(&looks, body, off) {
        return Some(found);
    }
    let last = record.times.len() - 1;
    while !free && stride < last {
        stride = (GROWTH * stride).min(last);
        let count = (last / stride).min(MOST);
        let starts: Vec<usize> = (0..count).map(|k| k * (last - stride) / (count - 1).max(1)).collect();
        let found = told(&of_windows(&starts, stride), body, off);
        if let Some(found) = found.filter(|found| found.factor.is_some()) {
            return Some(found);
        }
    }
    None
}

/// The torque that `looks` tell of, where it stands out of `off`.
fn told(looks: &[Look], body: &Body, off: f64) -> Option<OtherTorque> {
    let change = middle(looks, |look| Some(look.rest[0].norm() * look.time / look.momentum))?;
    let turned = middle(looks, |look| Some(look.kinematic))?;
    if change.partial_cmp(&(STANDS_OUT * off)) != Some(core::cmp::Ordering::Greater)
        || turned > KINEMATIC * change
    {
        return None;
    }
    let squares = looks.iter().map(|look| look.rest[0].norm_squared()).sum::<f64>();
    let count = looks.len() as f64;
    let told = looks.iter().map(|look| look.told.norm_squared()).sum::<f64>();
    let along = looks.iter().map(|look| look.rest[0].dot(look.told)).sum::<f64>();
    let factor = (told > 0.0 && along * along > EXPLAINED * told * squares).then(|| 1.0 + along / told);
    // sums over rows for integrals leave as much
    let coarse = looks.iter().map(|look| look.coarse).fold(0.0, f64::max);
    if factor.is_some_and(|factor| (factor - 1.0).abs() < coarse) {
        return None;
    }
    let mean = |axes: usize| {
        looks.iter().fold(Vec3::zero(), |sum: Vec3<f64>, look| sum + look.rest[axes]) * (1.0 / count)
    };
    let constant = [(0, Frame::Space), (1, Frame::Body)].into_iter().find_map(|(n, frame)| {
        let mean = mean(n);
        let explains = factor.is_none() && mean.norm_squared() * count > EXPLAINED * squares;
        explains.then(|| (frame, (mean * body.scale()).0))
    });
    Some(OtherTorque { size: (squares / count).sqrt() * body.scale(), factor, constant })
}

/// The middle of what `looks` have.
fn middle(looks: &[Look], of: impl Fn(&Look) -> Option<f64>) -> Option<f64> {
    let mut values: Vec<f64> = looks.iter().filter_map(of).collect();
    median(&mut values)
}

fn look(rows: &[Row], dynamics: &Dynamics, body: &Body, free: bool) -> Option<Look> {
    let (first, last) = (rows.first()?, rows.last()?);
    let momentum = |row: &Row| Some(row.attitude?.rotate(dynamics.momentum(row.omega)));
    let torque = |row: &Row| -> Option<Vec3<f64>> {
        let q = row.attitude?;
        if free {
            return Some(Vec3::zero());
        }
        let point = body.enter_omega(q, row.omega).ok()?;
        let inside = body.torque_of(Time::from_seconds(row.time), &point).map(|x| x.hi());
        // solver frame: along the principal axes
        let axes = body.inertia().frame().map(|x| x.hi());
        Some((q * axes).rotate(inside))
    };
    // of Euler's equations, body axes
    let rate = |row: &Row| -> Option<Vec3<f64>> {
        let torque = row.attitude?.rotate_back(torque(row)?);
        Some(dynamics.omega((dynamics.momentum(row.omega).cross(row.omega) + torque) * body.scale()))
    };
    let time = last.time - first.time;
    let (mut impulse, mut kinematic, mut coarse) = (Vec3::zero(), Vec3::zero(), 0.0_f64);
    let mut kept = vec![momentum(first)?];
    for pair in rows.windows(2) {
        let [a, b] = [&pair[0], &pair[1]];
        let dt = b.time - a.time;
        impulse = impulse + (torque(a)? + torque(b)?) * (0.5 * dt);
        kept.push(momentum(b)? - impulse);
        let turned = (a.attitude?.conjugate() * b.attitude?).logarithm();
        // Magnus's series to fourth order, with the integral of a cubic
        let bent = a.omega.cross(b.omega) + rate(a)? - rate(b)?;
        let by_rates = (a.omega + b.omega) * (0.5 * dt) + bent * (dt * dt / 12.0);
        kinematic = kinematic + turned - by_rates;
        coarse = coarse.max(turned.norm_squared());
    }
    let rest = (kept[kept.len() - 1] - kept[0]) * (1.0 / time);
    let middle = rows[rows.len() / 2].attitude?;
    let size = kept[0].norm();
    // what is left of three neighbours, which a torque changes evenly
    let second: Vec<f64> =
        kept.windows(3).map(|l| (l[2] - l[1] * 2.0 + l[0]).norm_squared() / 18.0).collect();
    let mean = second.iter().sum::<f64>() / second.len() as f64;
    Some(Look {
        rest: [rest, middle.rotate_back(rest)],
        told: impulse * (1.0 / time),
        time,
        kinematic: kinematic.norm(),
        momentum: size,
        noise: (!second.is_empty()).then(|| mean.sqrt() / size),
        coarse,
    })
}

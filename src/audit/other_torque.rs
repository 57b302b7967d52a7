//! The torque that a record shows beside what acts on its body.

use super::columns::rotation_vector;
use super::program::Dynamics;
use super::rows::Windows;
use super::states::{Row, states};
use super::{Frame, OtherTorque, Reading, Trajectory};
use crate::body::{Body, Problem, Time};
use crate::rotation::Vec3;

/// A change of L over a window this many times what a row may be off stands out.
const STANDS_OUT: f64 = 5.0;

/// The attitudes turn by the angular velocities within this share of the change of L: else it is no torque that changes it.
const KINEMATIC: f64 = 0.3;

/// A torque of one form explains this share of the squares.
const EXPLAINED: f64 = 0.9;

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
}

/// The torque that changes L beside those of `body`, from attitudes and angular velocities; `None` where L changes no more than by
/// `off`, what a row may be off, or where the attitudes do not turn by the angular velocities.
pub(super) fn other_torque(
    record: &Trajectory,
    reading: &Reading,
    body: &Body,
    off: f64,
) -> Option<OtherTorque> {
    record.attitude.as_ref()?;
    record.rates.as_ref()?;
    let windows = Windows::of(record, 1);
    let dynamics = Dynamics::new(body);
    let free = body.problem() == Problem::Free;
    let looks: Vec<Look> = windows
        .starts
        .iter()
        .filter_map(|&start| {
            let rows: Vec<usize> = (start..=start + windows.stride).collect();
            look(&states(record, reading, body, &rows), &dynamics, body, free)
        })
        .collect();
    let middle = |of: &dyn Fn(&Look) -> f64| -> Option<f64> {
        let mut values: Vec<f64> = looks.iter().map(of).collect();
        values.sort_by(f64::total_cmp);
        values.get(values.len() / 2).copied()
    };
    let change = middle(&|look| look.rest[0].norm() * look.time / look.momentum)?;
    let turned = middle(&|look| look.kinematic)?;
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
    let time = last.time - first.time;
    let (mut impulse, mut kinematic) = (Vec3::zero(), Vec3::zero());
    for pair in rows.windows(2) {
        let [a, b] = [&pair[0], &pair[1]];
        let dt = b.time - a.time;
        impulse = impulse + (torque(a)? + torque(b)?) * (0.5 * dt);
        let turned = rotation_vector(a.attitude?.conjugate() * b.attitude?);
        // Magnus's series up to the commutator
        let by_rates = (a.omega + b.omega) * (0.5 * dt) + a.omega.cross(b.omega) * (dt * dt / 12.0);
        kinematic = kinematic + turned - by_rates;
    }
    let rest = (momentum(last)? - momentum(first)? - impulse) * (1.0 / time);
    let middle = rows[rows.len() / 2].attitude?;
    Some(Look {
        rest: [rest, middle.rotate_back(rest)],
        told: impulse * (1.0 / time),
        time,
        kinematic: kinematic.norm(),
        momentum: momentum(first)?.norm(),
    })
}

//! The exact motion nearest to a computed one: what no choice of the start can explain is the error of the method.

use nalgebra::{Matrix6, Vector3, Vector6};
use polhode::body::Body;
use polhode::flow::FreeMotion;
use polhode::rotation::{Quat, Vec3, rotation_angle};

use super::motion::Row;
use crate::statistics::largest;

/// Rows that the start is fitted to.
const FITTED: usize = 48;

/// Change of the start for derivatives, rad and relative.
const CHANGE: f64 = 1e-6;

const ROUNDS: usize = 4;

/// The largest distance of `rows` from the exact motion of `body` that fits them best, from the first row on: rad, or relative
/// to the angular velocity. `None` where no start near the first row fits better than it.
pub(super) fn distance(body: &Body, rows: &[Row]) -> Option<f64> {
    let first = rows.first()?;
    let speed = first.omega.norm();
    let motion = |p: &Vector6<f64>| {
        // arithmetic alone, so that the numbers are the same everywhere
        let turn = Quat::cayley(Vec3([p[0], p[1], p[2]]) * 0.5);
        let attitude = (first.attitude * turn).normalized();
        let omega = Vector3::from(first.omega) + Vector3::new(p[3], p[4], p[5]) * speed;
        FreeMotion::from_omega(body.inertia(), attitude.into(), omega).ok()
    };
    let apart = |motion: &FreeMotion, row: &Row| apart(body, motion, row, speed);
    let every = rows.len().div_ceil(FITTED);
    let mut p = Vector6::zeros();
    for _ in 0..ROUNDS {
        let centre = motion(&p)?;
        let mut around = Vec::new();
        for k in 0..6 {
            let mut moved = p;
            moved[k] += CHANGE;
            around.push(motion(&moved)?);
        }
        let (mut normal, mut side) = (Matrix6::zeros(), Vector6::zeros());
        for row in rows.iter().step_by(every) {
            let here = apart(&centre, row)?;
            let there = around.iter().map(|motion| apart(motion, row)).collect::<Option<Vec<_>>>()?;
            for n in 0..6 {
                let slope = Vector6::from_fn(|k, _| (here[n] - there[k][n]) / CHANGE);
                normal += slope * slope.transpose();
                side += slope * here[n];
            }
        }
        p += normal.try_inverse()? * side;
    }
    let best = motion(&p)?;
    let distances = rows.iter().map(|row| {
        let state = best.at(row.t).ok()?;
        let omega = (Vector3::from(row.omega) - body.omega_body(&state)).norm() / speed;
        Some(rotation_angle(state.attitude, row.attitude).max(omega))
    });
    distances.collect::<Option<Vec<f64>>>().map(largest).filter(|x| x.is_finite())
}

/// The turn from the attitude of `motion` to that of `row`, for small ones its vector in rad, and the difference of their angular
/// velocities over `size`.
pub(super) fn apart(body: &Body, motion: &FreeMotion, row: &Row, size: f64) -> Option<[f64; 6]> {
    let state = motion.at(row.t).ok()?;
    let turn = state.attitude.conjugate() * row.attitude.normalized();
    let turn = turn.v * if turn.w < 0.0 { -2.0 } else { 2.0 };
    let omega: Vector3<f64> = (Vector3::from(row.omega) - body.omega_body(&state)) / size;
    Some([turn[0], turn[1], turn[2], omega.x, omega.y, omega.z])
}

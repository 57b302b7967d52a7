//! The bookkeeping of energy and angular momentum: what the torque did, by an orbit and a torque that are worked out here.

use polhode::body::{Clock, Point};
use polhode::method::method;
use polhode::rotation::Vec3;
use polhode_files::error::{Error, unexpected};

use super::clone::Approach;
use super::inputs::{ECCENTRICITY, GM, PERIGEE, PLANE, encountering};

/// Time between two values of the integrals, s; four intervals are one of Boole's rule.
const INTERVAL: f64 = 60.0;
const BOOLE: [f64; 4] = [14.0, 32.0, 12.0, 32.0];

/// What is left of the balances after the encounter, relative to energy and momentum before it.
#[derive(Clone, Copy, Debug)]
pub(super) struct Balance {
    pub(super) energy: f64,
    pub(super) momentum: f64,
    /// Share of the energy that was exchanged.
    pub(super) exchanged: f64,
}

/// Of a clone that is followed by the method `name`.
pub(super) fn balance(approach: &Approach, name: &str) -> Result<Balance, Error> {
    let body = encountering(approach.inertia.clone())?;
    let intervals = (2.0 * approach.window / (4.0 * INTERVAL)) as u64 * 4;
    let clock = Clock { start: -approach.window, step: 2.0 * approach.window / intervals as f64 };
    let mut step = method(name).map_err(unexpected)?.prepare_f64(clock, &body).map_err(unexpected)?;
    let mut point = approach.point;
    let state = |point: &Point<f64>| {
        let state = body.leave(point);
        let omega = Vec3(body.omega_of(point).into());
        (state.attitude, omega, state.momentum_body)
    };
    let kept = |point: &Point<f64>| {
        let (attitude, omega, momentum) = state(point);
        (0.5 * momentum.dot(omega), attitude.rotate(momentum))
    };
    let (energy, momentum) = kept(&point);
    let (mut work, mut impulse) = (0.0, Vec3([0.0; 3]));
    for k in 0..=intervals {
        let (attitude, omega, _) = state(&point);
        let t = clock.start + clock.step * k as f64;
        let moments = approach.inertia.principal_moments();
        let torque = torque(attitude.rotate_back(place(t)), moments);
        // both ends of Boole's rule count once, those between two intervals twice
        let weight = if k == 0 || k == intervals { 7.0 } else { BOOLE[(k % 4) as usize] };
        let share = weight * clock.step * (2.0 / 45.0);
        work += share * omega.dot(torque);
        impulse = impulse + attitude.rotate(torque) * share;
        if k < intervals {
            step.steps(&mut point, 1);
        }
    }
    let (energy_after, momentum_after) = kept(&point);
    Ok(Balance {
        energy: ((energy_after - energy) - work).abs() / energy,
        momentum: (momentum_after - momentum - impulse).norm() / momentum.norm(),
        exchanged: (energy_after - energy).abs() / energy,
    })
}

/// 3 GM/r³ r̂ × I r̂ in principal axes, for a body at `place`, km.
fn torque(place: Vec3<f64>, moments: [f64; 3]) -> Vec3<f64> {
    let r = place.norm();
    let unit = place * (1.0 / r);
    let turned = Vec3([0, 1, 2].map(|k| moments[k] * unit[k]));
    unit.cross(turned) * (3.0 * GM / (r * r * r))
}

/// The place at the time `t` s after the perigee, km, by Kepler's equation of the hyperbola, M = e sinh F − F.
fn place(t: f64) -> Vec3<f64> {
    let e = ECCENTRICITY;
    let a = PERIGEE / (e - 1.0);
    let mean = t * libm::sqrt(GM / (a * a * a));
    let mut f = libm::asinh(mean / e);
    for _ in 0..50 {
        let step = (e * libm::sinh(f) - f - mean) / (e * libm::cosh(f) - 1.0);
        f -= step;
        if step.abs() <= 1e-15 * f.abs() {
            break;
        }
    }
    let in_plane = Vec3([a * (e - libm::cosh(f)), a * libm::sqrt(e * e - 1.0) * libm::sinh(f), 0.0]);
    let [node, inclination, argument] = PLANE.map(f64::to_radians);
    about_z(about_x(about_z(in_plane, argument), inclination), node)
}

fn about_z(Vec3([x, y, z]): Vec3<f64>, angle: f64) -> Vec3<f64> {
    let (sin, cos) = libm::sincos(angle);
    Vec3([cos * x - sin * y, sin * x + cos * y, z])
}

fn about_x(Vec3([x, y, z]): Vec3<f64>, angle: f64) -> Vec3<f64> {
    let (sin, cos) = libm::sincos(angle);
    Vec3([x, cos * y - sin * z, sin * y + cos * z])
}

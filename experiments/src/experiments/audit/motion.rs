//! Random bodies, and their motions: exact, and by a method of the catalogue.

use nalgebra::{Quaternion, UnitQuaternion, Vector3};
use polhode::body::{Body, State};
use polhode::flow::FreeMotion;
use polhode::inertia::Inertia;
use polhode::method::{Claimed as _, without_projections};
use polhode::num::Random;
use polhode::rotation::{Quat, Vec3, rotation_angle};
use polhode::run::{Run, Watch};
use polhode_files::error::{Error, unexpected};

use super::nearest::distance;
use crate::statistics::largest;

/// A row before it is written: time, attitude from body to space, angular velocity in body axes.
#[derive(Clone, Copy)]
pub(super) struct Row {
    pub(super) t: f64,
    pub(super) attitude: Quat<f64>,
    pub(super) omega: Vec3<f64>,
}

/// A motion as a program computes it.
pub(super) struct Motion {
    /// `None` of the exact motion.
    pub(super) method: Option<String>,
    pub(super) moments: [f64; 3],
    pub(super) rows: Vec<Row>,
    /// The exact motion at the same times, from the same start.
    pub(super) exact: Vec<Row>,
}

impl Motion {
    /// The largest distance from the exact motion with the same start: rad, or relative to the angular velocity.
    pub(super) fn error(&self) -> f64 {
        let distance = |(a, b): (&Row, &Row)| {
            rotation_angle(a.attitude, b.attitude).max((a.omega - b.omega).norm() / b.omega.norm())
        };
        largest(self.rows.iter().zip(&self.exact).map(distance))
    }

    /// The largest distance from the nearest exact motion, where that is less than the distance `error` from the same start.
    pub(super) fn least_error(&self, error: f64) -> Result<f64, Error> {
        let body = Body::free(Inertia::from_moments(self.moments).map_err(unexpected)?);
        Ok(distance(&body, &self.rows).map_or(error, |nearest| nearest.min(error)))
    }

    /// A body of one of three kinds in a random motion; half of them exact, half by a random method.
    pub(super) fn random(random: &mut Random) -> Result<Self, Error> {
        let kind = random.below(20);
        let moments = match kind {
            0 | 1 => symmetric(random),
            _ => distinct(random),
        };
        let body = Body::free(Inertia::from_moments(moments).map_err(unexpected)?);
        let speed = libm::exp10(random.between(-1.0, 1.0));
        let direction = match kind {
            // a pure spin
            2 => Vector3::ith(random.below(3) as usize, 1.0),
            _ => generic(random),
        };
        let start = body.state(attitude(random), direction * speed).map_err(unexpected)?;
        let count = 100 + random.below(400);
        let mut interval = libm::exp10(random.between(-2.3, -0.5)) / speed;
        let methods = without_projections();
        let chosen = methods.get(random.below(2 * methods.len() as u64) as usize);
        loop {
            let exact = exact(&body, &start, interval, count)?;
            let rows = match chosen {
                None => exact.clone(),
                Some(method) => {
                    let run = Run::new(method, &body, &start, interval).map_err(unexpected)?;
                    let mut run = run.watching(Watch::Never);
                    let row = |k: u64| {
                        let sample = run.advance_to(k).ok()?;
                        let (attitude, omega) = (sample.state.attitude, Vec3::from(sample.omega_body));
                        // a run that diverges is no trajectory
                        let whole = attitude.norm_squared() < 4.0 && omega.norm() < 4.0 * speed;
                        whole.then_some(Row { t: k as f64 * interval, attitude, omega })
                    };
                    (0..count).map_while(row).collect()
                }
            };
            if rows.len() == exact.len() {
                let method = chosen.map(|method| method.name());
                return Ok(Motion { method, moments, rows, exact });
            }
            interval *= 0.5;
        }
    }
}

pub(super) fn exact(body: &Body, start: &State, interval: f64, count: u64) -> Result<Vec<Row>, Error> {
    let motion = FreeMotion::from_state(body.inertia(), start).map_err(unexpected)?;
    let row = |k: u64| {
        let t = k as f64 * interval;
        let state = motion.at(t).map_err(unexpected)?;
        Ok(Row { t, attitude: state.attitude, omega: body.omega_body(&state).into() })
    };
    (0..count).map(row).collect()
}

/// Moments of a body with three different radii of gyration.
pub(super) fn distinct(random: &mut Random) -> [f64; 3] {
    loop {
        let [a, b, c] = [0; 3].map(|_| random.between(0.1, 1.0));
        let moments = [b + c, a + c, a + b];
        let apart = |i: usize, j: usize| (moments[i] - moments[j]).abs() > 0.08 * moments[i];
        if apart(0, 1) && apart(1, 2) && apart(0, 2) {
            return moments;
        }
    }
}

/// Two moments agree, and the third is apart.
pub(super) fn symmetric(random: &mut Random) -> [f64; 3] {
    let axis = random.below(3) as usize;
    let ratio = if random.below(2) == 0 { random.between(0.3, 0.9) } else { random.between(1.1, 1.9) };
    let mut moments = [1.0; 3];
    moments[axis] = ratio;
    moments
}

/// A direction away from the axes.
pub(super) fn generic(random: &mut Random) -> Vector3<f64> {
    loop {
        let direction = random.normal_vector().normalize();
        if direction.amin() > 0.15 {
            return direction;
        }
    }
}

pub(super) fn attitude(random: &mut Random) -> UnitQuaternion<f64> {
    let [w, x, y, z] = [0; 4].map(|_| random.normal());
    UnitQuaternion::new_normalize(Quaternion::new(w, x, y, z))
}

//! A record before it is written: the body, the motion that it was made from, and its rows.

use nalgebra::{UnitQuaternion, Vector3};
use polhode::body::Body;
use polhode::flow::FreeMotion;
use polhode::inertia::Inertia;
use polhode::method::AnyMethod;
use polhode::num::Random;
use polhode::rotation::{Vec3, rotation_angle};
use polhode::run::{Run, Watch};
use polhode_files::error::{Error, unexpected};

use super::motion::{Row, attitude, distinct, exact, generic, symmetric};
use super::writing::one_of;

/// Rows of a free motion, as they should be or not.
pub(super) struct Specimen {
    pub(super) moments: [f64; 3],
    /// Attitude and angular velocity of the motion at time 0.
    pub(super) start: (UnitQuaternion<f64>, Vector3<f64>),
    pub(super) interval: f64,
    pub(super) rows: Vec<Row>,
}

/// Distances from a motion, the largest of all rows.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Distance {
    /// rad.
    pub(super) attitude: f64,
    /// Of the angular velocity, relative to its root mean square.
    pub(super) rates: f64,
}

/// What a body is like.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Kind {
    Distinct,
    Symmetric,
    Sphere,
}

impl Specimen {
    /// The exact motion of a random body, `rows` rows of it, or some hundred.
    pub(super) fn random(kind: Kind, rows: Option<u64>, random: &mut Random) -> Result<Self, Error> {
        let moments = match kind {
            Kind::Distinct => distinct(random),
            Kind::Symmetric => symmetric(random),
            Kind::Sphere => [random.between(0.1, 1.0); 3],
        };
        let speed = libm::exp10(random.between(-1.0, 1.0));
        let start = (attitude(random), generic(random) * speed);
        let count = rows.unwrap_or(150 + random.below(250));
        let interval = libm::exp10(random.between(-1.8, -0.8)) / speed;
        let mut right = Specimen { moments, start, interval, rows: Vec::new() };
        let body = right.body()?;
        let state = body.state(start.0, start.1).map_err(unexpected)?;
        right.rows = exact(&body, &state, interval, count)?;
        Ok(right)
    }

    /// The rows that `method` computes from the same start, with some steps a row; fewer where it diverges.
    pub(super) fn by(&self, method: &dyn AnyMethod, random: &mut Random) -> Result<Self, Error> {
        let steps = one_of(random, [1, 1, 2, 5]);
        let body = self.body()?;
        let start = body.state(self.start.0, self.start.1).map_err(unexpected)?;
        let step = self.interval / steps as f64;
        let mut run = Run::new(method, &body, &start, step).map_err(unexpected)?.watching(Watch::Never);
        let row = |k: u64| {
            let sample = run.advance_to(k * steps).ok()?;
            let (attitude, omega) = (sample.state.attitude, Vec3::from(sample.omega_body));
            Some(Row { t: k as f64 * self.interval, attitude, omega })
        };
        let rows = (0..self.rows.len() as u64).map_while(row).collect();
        Ok(Specimen { rows, ..*self })
    }

    pub(super) fn body(&self) -> Result<Body, Error> {
        Ok(Body::free(Inertia::from_moments(self.moments).map_err(unexpected)?))
    }

    /// Root mean square of the angular velocity, rad/s.
    pub(super) fn size(&self) -> f64 {
        let squares = self.rows.iter().map(|row| row.omega.norm_squared()).sum::<f64>();
        (squares / self.rows.len() as f64).sqrt()
    }

    /// How far the rows are from the motion that they were made from, at the times that they state.
    pub(super) fn distance(&self) -> Result<Distance, Error> {
        let body = self.body()?;
        let (attitude, omega) = self.start;
        let motion = FreeMotion::from_omega(body.inertia(), attitude, omega).map_err(unexpected)?;
        let size = self.size();
        let mut most = Distance::default();
        for row in &self.rows {
            let there = motion.at(row.t).map_err(unexpected)?;
            most.attitude = most.attitude.max(rotation_angle(row.attitude.normalized(), there.attitude));
            let omega = Vec3::from(body.omega_body(&there));
            most.rates = most.rates.max((row.omega - omega).norm() / size);
        }
        Ok(most)
    }
}

/// Whether a method keeps L in space.
pub(super) fn keeps_momentum(method: &dyn AnyMethod) -> bool {
    method.claims(polhode::body::Problem::Free).is_some_and(|claims| claims.kept.momentum_space)
}

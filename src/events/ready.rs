//! Events of bodies that are ready to use.

use nalgebra::{UnitQuaternion, Vector3};

use super::event::Bound;
use super::{Event, EventError};
use crate::body::{Body, State};
use crate::rotation::{Quat, Vec3};

/// Rounding of an angle of axes, and of a momentum as a share of it: several times what attitudes and their products have.
const ROUNDING: f64 = 16.0 * f64::EPSILON;

/// Angle between two vectors, rad, exact to rounding at every angle.
fn angle(a: Vec3<f64>, b: Vec3<f64>) -> f64 {
    libm::atan2(a.cross(b).norm(), a.dot(b))
}

/// Momentum of the wheels of `body` at the time `t`, s; the momentum without it has its rounding.
fn of_wheels(body: &Body, t: f64) -> f64 {
    body.momentum_of_wheels_at(t).norm()
}

fn axis(quantity: &'static str, of: Vector3<f64>) -> Result<Vec3<f64>, EventError> {
    let size = of.norm();
    if size.is_normal() {
        Ok((of / size).into())
    } else {
        Err(EventError::Parameter { quantity, value: size, rule: "it must be a vector with a direction" })
    }
}

impl Event {
    /// `body` turns over: its angular velocity about the axis of its middle moment changes sign.
    pub fn flip(body: &Body) -> Self {
        let axis: Vec3<f64> = (body.inertia().principal_axes() * Vector3::y()).into();
        let [_, moment, _] = body.inertia().principal_moments();
        let body = body.clone();
        Event::zero("flip", move |_, x| x.momentum_body.dot(axis) / moment)
            .bounded(Bound::PerRate(1.0))
            .known_to(move |t, x| ROUNDING / moment * (x.momentum_body.magnitude() + of_wheels(&body, t)))
    }

    /// The axis `of_body` (body axes) comes nearer to `in_space` (space axes) than `half_angle`, rad; from outside to inside.
    ///
    /// # Errors
    /// A vector without direction, or an angle outside (0, π).
    pub fn enters_cone(
        of_body: Vector3<f64>,
        in_space: Vector3<f64>,
        half_angle: f64,
    ) -> Result<Self, EventError> {
        let (a, b) = (axis("the axis of the body", of_body)?, axis("the axis in space", in_space)?);
        if !(half_angle > 0.0 && half_angle < core::f64::consts::PI) {
            let rule = "it must be between 0 and pi rad";
            return Err(EventError::Parameter { quantity: "the half angle", value: half_angle, rule });
        }
        let law = move |_: f64, x: &State| half_angle - angle(x.attitude.rotate(a), b);
        let event = Event::zero("enters cone", law).lasting().bounded(Bound::PerRadian(1.0));
        Ok(event.known_to(|_, _| ROUNDING))
    }

    /// |ω| of `body` rises above `limit`, rad/s.
    ///
    /// # Errors
    /// A limit that is not positive.
    pub fn rate_above(body: &Body, limit: f64) -> Result<Self, EventError> {
        Event::rate("rate above limit", 1.0, body, limit)
    }

    /// |ω| of `body` falls below `limit`, rad/s.
    ///
    /// # Errors
    /// A limit that is not positive.
    pub fn rate_below(body: &Body, limit: f64) -> Result<Self, EventError> {
        Event::rate("rate below limit", -1.0, body, limit)
    }

    fn rate(name: &str, sign: f64, body: &Body, limit: f64) -> Result<Self, EventError> {
        if !(limit > 0.0 && limit.is_finite()) {
            let rule = "it must be a positive number of rad/s";
            return Err(EventError::Parameter { quantity: "the rate", value: limit, rule });
        }
        let [least, ..] = body.inertia().principal_moments();
        let (body, carrier) = (body.clone(), body.clone());
        let law = move |_: f64, x: &State| sign * (body.omega_body(x).norm() - limit);
        let event = Event::zero(name, law).lasting().bounded(Bound::PerRate(1.0));
        Ok(event.known_to(move |t, _| ROUNDING * (limit + of_wheels(&carrier, t) / least)))
    }

    /// The attitude of `body` is as near to `target` (body → space) as it comes: the angle between them begins to grow.
    pub fn nearest(body: &Body, target: UnitQuaternion<f64>) -> Self {
        let (body, target): (Body, Quat<f64>) = (body.clone(), target.into());
        // the cosine of half the angle is |w|: g is −2 d(w²)/dt over |ω|
        Event::zero("nearest approach", move |_, x| {
            let from_target = target.conjugate() * x.attitude;
            let omega: Vec3<f64> = body.omega_body(x).into();
            let rate = omega.norm();
            if rate > 0.0 { 2.0 * from_target.w * from_target.v.dot(omega) / rate } else { 0.0 }
        })
        .rising()
        .known_to(|_, _| ROUNDING)
    }
}

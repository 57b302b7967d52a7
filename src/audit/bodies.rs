//! The body of the question with its moments in every order.

use nalgebra::Matrix3;

use super::columns::{Columns, Source};
use super::program::Dynamics;
use super::{Reading, Trajectory};
use crate::body::{Body, WheelAtStart};
use crate::inertia::Inertia;
use crate::rotation::Vec3;

/// Iterations by which ω of attitudes alone and the momenta of wheels are found from each other.
const ITERATIONS: usize = 12;

/// A body with wheels by their speed at the start: of those that are not held the momentum follows from ω there, whose digits and noise
/// it shares. So another start is that of another body.
#[derive(Clone, Debug)]
pub(super) struct Told {
    pub(super) body: Body,
    pub(super) wheels: Vec<WheelAtStart>,
}

impl Told {
    /// The body that turns at `omega`, body axes, at the time `t`.
    pub(super) fn at(&self, t: f64, omega: Vec3<f64>) -> Option<Body> {
        self.body.clone().with_wheels_at_start(&self.wheels, t, omega.into()).ok()
    }

    /// The body that turns as the first row of `record` has it by `reading`; `None` where it does not tell.
    pub(super) fn started(&self, record: &Trajectory, reading: &Reading) -> Option<Body> {
        let columns = Columns::new(record);
        let t = record.times[0];
        if columns.source == Source::Rates {
            return self.at(t, reading.omega_body(record, 0)?);
        }
        let stride = columns.windows().stride;
        let (mut omega, mut body) = (Vec3::zero(), self.at(t, Vec3::zero())?);
        for _ in 0..ITERATIONS {
            let next = columns.shot(reading, &Dynamics::new(&body), 0, stride)?;
            let moved = (next - omega).norm();
            (omega, body) = (next, self.at(t, next)?);
            if moved <= f64::EPSILON * omega.norm() {
                break;
            }
        }
        omega.norm().is_finite().then_some(body)
    }
}

/// The body with the moment number `order[k]` on axis k: rows and columns of its tensor change places, what acts stays.
pub(super) fn reordered(body: &Body, order: [usize; 3]) -> Option<Body> {
    if order == [0, 1, 2] {
        return Some(body.clone());
    }
    if !body.wheels().is_empty() {
        return None; // their axes stay where they are
    }
    let inertia = body.inertia();
    let tensor = inertia.tensor();
    let reordered = if inertia.is_along_principal_axes() {
        Inertia::from_positive_moments(order.map(|k| tensor[(k, k)]))
    } else {
        Inertia::from_tensor(Matrix3::from_fn(|i, j| tensor[(order[i], order[j])]))
    };
    Some(body.forces().iter().cloned().fold(Body::free(reordered.ok()?), Body::with))
}

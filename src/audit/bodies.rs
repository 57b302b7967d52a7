//! The body of the question with its moments in every order.

use nalgebra::{Matrix3, Vector3};

use crate::body::Body;
use crate::inertia::Inertia;
use crate::num::Dd;

/// The body with the moment number `order[k]` on axis k: rows and columns of its tensor change places, what acts stays.
pub(super) fn reordered(body: &Body, order: [usize; 3]) -> Option<Body> {
    if order == [0, 1, 2] {
        return Some(body.clone());
    }
    let inertia = body.inertia();
    let tensor = inertia.tensor();
    let reordered = if inertia.is_along_principal_axes() {
        Inertia::from_positive_moments(order.map(|k| tensor[(k, k)]))
    } else {
        Inertia::from_tensor(Matrix3::from_fn(|i, j| tensor[(order[i], order[j])]))
    };
    let weight = body.gravity::<Dd>().map_or(Vector3::zeros(), |gravity| {
        let body_axes = inertia.frame().rotate(gravity.weight_moment);
        Vector3::from(body_axes.0.map(|c| c.hi() * inertia.scale()))
    });
    let bare = Body::heavy(reordered.ok()?, weight).ok()?;
    Some(body.forces().iter().cloned().fold(bare, Body::with))
}

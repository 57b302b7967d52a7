//! The body of the question with its moments in every order.

use nalgebra::Matrix3;

use crate::body::Body;
use crate::inertia::Inertia;

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

//! Tensors with trace 1 as five coordinates, and the physical one nearest to a point.

use nalgebra::{Matrix3, Matrix5, Vector3, Vector5};

/// The k-th of an orthonormal basis of the symmetric matrices of trace 0, the order of which is of no importance.
pub(super) fn basis(k: usize) -> Matrix3<f64> {
    let half = 0.5_f64.sqrt();
    match k {
        0 => Matrix3::from_diagonal(&Vector3::new(half, -half, 0.0)),
        1 => Matrix3::from_diagonal(&(Vector3::new(1.0, 1.0, -2.0) / 6.0_f64.sqrt())),
        _ => {
            let (i, j) = [(0, 1), (0, 2), (1, 2)][k - 2];
            let mut b = Matrix3::zeros();
            b[(i, j)] = half;
            b[(j, i)] = half;
            b
        }
    }
}

pub(super) fn tensor(x: &Vector5<f64>) -> Matrix3<f64> {
    (0..5).fold(Matrix3::identity() / 3.0, |sum, k| sum + basis(k) * x[k])
}

/// Largest moment as a share of the trace: the other two together are not less.
const LIMIT: f64 = 0.5;

/// The physical tensor nearest to `centre` in the metric `information`, by projected gradients with momentum (Nesterov)
/// that start anew where they turn back.
pub(super) fn nearest(centre: Vector5<f64>, information: &Matrix5<f64>) -> Vector5<f64> {
    let rate = 1.0 / information.symmetric_eigenvalues().max();
    let mut x = physical(&centre);
    let (mut ahead, mut weight) = (x, 1.0_f64);
    for _ in 0..100_000 {
        let gradient = information * (ahead - centre);
        let next = physical(&(ahead - gradient * rate));
        let step = next - x;
        if step.norm() <= 1e-15 {
            return next;
        }
        let heavier = 0.5 * (1.0 + (1.0 + 4.0 * weight * weight).sqrt());
        (ahead, weight) = if (ahead - next).dot(&step) > 0.0 {
            (next, 1.0)
        } else {
            (next + step * ((weight - 1.0) / heavier), heavier)
        };
        x = next;
    }
    x
}

/// The physical tensor whose entries are nearest: its moments exceed half the trace no longer, and share the rest.
pub(super) fn physical(x: &Vector5<f64>) -> Vector5<f64> {
    let eigen = tensor(x).symmetric_eigen();
    let top = eigen.eigenvalues.imax();
    let excess = eigen.eigenvalues[top] - LIMIT;
    if excess <= 0.0 {
        return *x;
    }
    let mut moments = eigen.eigenvalues.map(|m| m + 0.5 * excess);
    moments[top] = LIMIT;
    let other = (0..3).filter(|&k| k != top).find(|&k| moments[k] > LIMIT);
    if let Some(other) = other {
        moments = Vector3::zeros();
        moments[top] = LIMIT;
        moments[other] = LIMIT;
    }
    let v = eigen.eigenvectors;
    let j = v * Matrix3::from_diagonal(&moments) * v.transpose();
    Vector5::from_fn(|k, _| basis(k).dot(&j))
}

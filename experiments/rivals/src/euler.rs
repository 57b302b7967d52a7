//! Free motion over a short time, with its derivatives with respect to its start and to the tensor.

use nalgebra::{Matrix3, SMatrix, Vector3, Vector5};

use super::coordinates::{basis, tensor};

/// ∂ω/∂x and ∂ω/∂ω₀, side by side.
pub(super) type Sensitivity = SMatrix<f64, 3, 8>;

/// [ω]ₓ B − [B ω]ₓ, the derivative of ω × B ω.
pub(super) fn cross_derivative(b: &Matrix3<f64>, w: &Vector3<f64>) -> Matrix3<f64> {
    w.cross_matrix() * b - (b * w).cross_matrix()
}

/// Euler's equation of one tensor.
pub(super) struct Euler {
    j: Matrix3<f64>,
    inverse: Matrix3<f64>,
}

/// Longest step of the integrator, in radians: errors of order 1e-7.
const STEP: f64 = 0.05;

impl Euler {
    /// `None` where the tensor has no inverse.
    pub(super) fn new(x: &Vector5<f64>) -> Option<Self> {
        let j = tensor(x);
        Some(Euler { j, inverse: j.try_inverse()? })
    }

    fn derivative(&self, w: &Vector3<f64>, s: &Sensitivity) -> (Vector3<f64>, Sensitivity) {
        let slope = -self.inverse * w.cross(&(self.j * w));
        let mut ds = -self.inverse * (cross_derivative(&self.j, w) * s);
        for k in 0..5 {
            let b = basis(k);
            let own = self.inverse * (w.cross(&(b * w)) + b * slope);
            ds.set_column(k, &(ds.column(k) - own));
        }
        (slope, ds)
    }

    /// Moves a rate and its sensitivities on by `time` with the classical Runge–Kutta step.
    pub(super) fn advance(&self, w: &mut Vector3<f64>, s: &mut Sensitivity, time: f64) {
        let parts = (w.norm() * time.abs() / STEP).ceil().clamp(1.0, 100.0);
        let h = time / parts;
        for _ in 0..parts as usize {
            let (w1, s1) = self.derivative(w, s);
            let (w2, s2) = self.derivative(&(*w + w1 * (0.5 * h)), &(*s + s1 * (0.5 * h)));
            let (w3, s3) = self.derivative(&(*w + w2 * (0.5 * h)), &(*s + s2 * (0.5 * h)));
            let (w4, s4) = self.derivative(&(*w + w3 * h), &(*s + s3 * h));
            *w += (w1 + (w2 + w3) * 2.0 + w4) * (h / 6.0);
            *s += (s1 + (s2 + s3) * 2.0 + s4) * (h / 6.0);
        }
    }
}

/// Sensitivities at a start.
pub(super) fn at_start() -> Sensitivity {
    Sensitivity::from_fn(|i, k| if k == i + 5 { 1.0 } else { 0.0 })
}

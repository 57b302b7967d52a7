//! Free motion over a short time, with or without a drag −d J ω, and its derivatives.

use nalgebra::{Matrix3, SMatrix, Vector3, Vector5};

use super::coordinates::{basis, tensor};

/// ∂ω/∂x and ∂ω/∂ω₀ side by side, eight columns, or nine with ∂ω/∂d before them.
pub(super) type Sensitivity<const N: usize> = SMatrix<f64, 3, N>;

/// [ω]ₓ B − [B ω]ₓ, the derivative of ω × B ω.
pub(super) fn cross_derivative(b: &Matrix3<f64>, w: &Vector3<f64>) -> Matrix3<f64> {
    w.cross_matrix() * b - (b * w).cross_matrix()
}

/// Euler's equation of one tensor and one drag.
pub(super) struct Euler {
    j: Matrix3<f64>,
    inverse: Matrix3<f64>,
    drag: f64,
}

/// Longest step of the integrator, in radians: errors of order 1e-7.
const STEP: f64 = 0.05;

impl Euler {
    /// `None` where the tensor has no inverse.
    pub(super) fn new(x: &Vector5<f64>) -> Option<Self> {
        let j = tensor(x);
        Some(Euler { j, inverse: j.try_inverse()?, drag: 0.0 })
    }

    pub(super) fn with_drag(self, drag: f64) -> Self {
        Euler { drag, ..self }
    }

    /// ω' without drag.
    fn free(&self, w: &Vector3<f64>) -> Vector3<f64> {
        -self.inverse * w.cross(&(self.j * w))
    }

    fn derivative<const N: usize>(
        &self,
        w: &Vector3<f64>,
        s: &Sensitivity<N>,
    ) -> (Vector3<f64>, Sensitivity<N>) {
        let free = self.free(w);
        let mut ds = -self.inverse * (cross_derivative(&self.j, w) * s) - s * self.drag;
        for k in 0..5 {
            let b = basis(k);
            let own = self.inverse * (w.cross(&(b * w)) + b * free);
            ds.set_column(N - 8 + k, &(ds.column(N - 8 + k) - own));
        }
        if N > 8 {
            ds.set_column(0, &(ds.column(0) - w));
        }
        (free - w * self.drag, ds)
    }

    /// Moves a rate and its sensitivities on by `time` with the classical Runge–Kutta step.
    pub(super) fn advance<const N: usize>(&self, w: &mut Vector3<f64>, s: &mut Sensitivity<N>, time: f64) {
        let parts = parts(w, time);
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

    /// The rate alone, to the same bits.
    pub(super) fn carry(&self, w: &mut Vector3<f64>, time: f64) {
        let slope = |w: &Vector3<f64>| self.free(w) - w * self.drag;
        let parts = parts(w, time);
        let h = time / parts;
        for _ in 0..parts as usize {
            let w1 = slope(w);
            let w2 = slope(&(*w + w1 * (0.5 * h)));
            let w3 = slope(&(*w + w2 * (0.5 * h)));
            let w4 = slope(&(*w + w3 * h));
            *w += (w1 + (w2 + w3) * 2.0 + w4) * (h / 6.0);
        }
    }
}

/// Steps of the integrator in `time`.
fn parts(w: &Vector3<f64>, time: f64) -> f64 {
    (w.norm() * time.abs() / STEP).ceil().clamp(1.0, 100.0)
}

/// Sensitivities at a start.
pub(super) fn at_start<const N: usize>() -> Sensitivity<N> {
    Sensitivity::from_fn(|i, k| if k == i + N - 3 { 1.0 } else { 0.0 })
}

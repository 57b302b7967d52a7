//! How a free motion depends on its tensor and its start, by the variational equations.

use nalgebra::{Matrix3, SMatrix, Vector3};

use crate::fit::physical::coordinates::{Form, basis};
use crate::fit::weak::linearised::cross_derivative;

/// ∂ω/∂(x, ω₀), or ∂ω/∂ω₀ alone where N is 3.
pub(super) type Sensitivity<const N: usize> = SMatrix<f64, 3, N>;

/// Largest turn of one step of the integrator, in units of the Jacobian's norm: errors of order 1e-6, plenty for a bound.
const STEP: f64 = 0.1;

pub(super) struct Euler {
    j: Matrix3<f64>,
    inverse: Matrix3<f64>,
}

impl Euler {
    pub(super) fn new(j: Matrix3<f64>) -> Option<Euler> {
        Some(Euler { j, inverse: j.try_inverse()? })
    }

    /// ω' and S'.
    fn derivative<const N: usize>(
        &self,
        w: &Vector3<f64>,
        s: &Sensitivity<N>,
    ) -> (Vector3<f64>, Sensitivity<N>) {
        let rate = -self.inverse * w.cross(&(self.j * w));
        let mut ds = self.inverse * cross_derivative(&self.j, w) * -s;
        for k in 0..N - 3 {
            let b = basis(k);
            let own = self.inverse * (w.cross(&(b * w)) + b * rate);
            ds.set_column(k, &(ds.column(k) - own));
        }
        (rate, ds)
    }

    /// The classical Runge–Kutta step, in as many parts as the rate asks for.
    fn advance<const N: usize>(&self, w: &mut Vector3<f64>, s: &mut Sensitivity<N>, time: f64) {
        let speed = (self.inverse * cross_derivative(&self.j, w)).norm();
        let parts = (speed * time.abs() / STEP).ceil().clamp(1.0, 100.0);
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

    /// The motion through `start`, with its sensitivities: `visit` sees it at each of `times`.
    pub(super) fn sweep<const N: usize>(
        &self,
        times: &[f64],
        start: &Start,
        mut visit: impl FnMut(usize, &Vector3<f64>, &Sensitivity<N>),
    ) {
        let identity = Sensitivity::from_fn(|i, k| if k + 3 == i + N { 1.0 } else { 0.0 });
        let split = times.partition_point(|&t| t < start.time);
        let mut go = |i: usize, last: &mut f64, w: &mut Vector3<f64>, s: &mut Sensitivity<N>| {
            self.advance(w, s, times[i] - *last);
            *last = times[i];
            visit(i, w, s);
        };
        let (mut last, mut w, mut s) = (start.time, start.rate, identity);
        (split..times.len()).for_each(|i| go(i, &mut last, &mut w, &mut s));
        let (mut last, mut w, mut s) = (start.time, start.rate, identity);
        (0..split).rev().for_each(|i| go(i, &mut last, &mut w, &mut s));
    }

    /// Σ Sᵀ S.
    pub(super) fn information(&self, times: &[f64], start: &Start) -> SMatrix<f64, 8, 8> {
        let mut sum = SMatrix::zeros();
        self.sweep(times, start, |_, _, s: &Sensitivity<8>| sum += s.transpose() * s);
        sum
    }
}

/// Where a motion is at one time.
#[derive(Clone, Copy)]
pub(super) struct Start {
    pub(super) time: f64,
    pub(super) rate: Vector3<f64>,
}

/// Information about x alone.
pub(super) fn of_tensor(information: &SMatrix<f64, 8, 8>) -> Option<Form> {
    let own = information.fixed_view::<3, 3>(5, 5).into_owned().cholesky()?;
    let mixed = information.fixed_view::<3, 5>(5, 0).into_owned();
    Some(information.fixed_view::<5, 5>(0, 0) - mixed.transpose() * own.solve(&mixed))
}

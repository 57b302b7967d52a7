//! The Cramér–Rao bound: what no unbiased estimator can undercut.
//!
//! F = σ⁻² Σ Sᵢᵀ Sᵢ with S = ∂ω/∂(x, ω₀) from the variational equations of J ω' = J ω × ω; each segment has an ω₀ of its
//! own, which the Schur complement takes out.

use nalgebra::{Matrix3, SMatrix, Vector3};

use super::coordinates::{Coordinates, Form, basis, tensor};
use super::weak::{Stretch, cross_derivative};

type Sensitivity = SMatrix<f64, 3, 8>;

/// Largest turn of one step of the integrator, in units of the Jacobian's norm: errors of order 1e-6, plenty for a bound.
const STEP: f64 = 0.1;

struct Euler {
    j: Matrix3<f64>,
    inverse: Matrix3<f64>,
}

impl Euler {
    /// ω' and S'.
    fn derivative(&self, w: &Vector3<f64>, s: &Sensitivity) -> (Vector3<f64>, Sensitivity) {
        let rate = -self.inverse * w.cross(&(self.j * w));
        let mut ds = self.inverse * cross_derivative(&self.j, w) * -s;
        for k in 0..5 {
            let b = basis(k);
            let own = self.inverse * (w.cross(&(b * w)) + b * rate);
            ds.set_column(k, &(ds.column(k) - own));
        }
        (rate, ds)
    }

    /// The classical Runge–Kutta step, in as many parts as the rate asks for.
    fn advance(&self, w: &mut Vector3<f64>, s: &mut Sensitivity, time: f64) {
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
}

/// The bound on the covariance of the coordinates; `None` where the tensor has no inverse or the record does not
/// determine it. Motions start from a local cubic through the samples within `radius` of each middle.
pub(super) fn cramer_rao(stretches: &[Stretch], x: &Coordinates, radius: f64, variance: f64) -> Option<Form> {
    let j = tensor(x);
    let euler = Euler { j, inverse: j.try_inverse()? };
    let mut information = Form::zeros();
    for s in stretches.iter().filter(|s| s.times.len() >= 5) {
        let middle = s.times.len() / 2;
        let (centre, _) = local_cubic(s, middle, radius)?;
        let mut fisher = SMatrix::<f64, 8, 8>::zeros();
        let times = &s.times;
        let start = Sensitivity::from_fn(|i, k| if k == i + 5 { 1.0 } else { 0.0 });
        let steps_up: Vec<f64> = (middle + 1..times.len()).map(|i| times[i] - times[i - 1]).collect();
        let steps_down: Vec<f64> = (0..middle).rev().map(|i| times[i] - times[i + 1]).collect();
        fisher += start.transpose() * start;
        for steps in [steps_up, steps_down] {
            let (mut w, mut sensitivity) = (centre, start);
            for step in steps {
                euler.advance(&mut w, &mut sensitivity, step);
                fisher += sensitivity.transpose() * sensitivity;
            }
        }
        let own = fisher.fixed_view::<3, 3>(5, 5).into_owned().cholesky()?;
        let mixed = fisher.fixed_view::<3, 5>(5, 0).into_owned();
        information += fisher.fixed_view::<5, 5>(0, 0) - mixed.transpose() * own.solve(&mixed);
    }
    Some((information / variance).cholesky()?.inverse())
}

/// Value and slope at sample `at` of the cubic through all samples within `radius`, or the nearest few.
pub(super) fn local_cubic(s: &Stretch, at: usize, radius: f64) -> Option<(Vector3<f64>, Vector3<f64>)> {
    let t = s.times[at];
    let low = s.times.partition_point(|&u| u < t - radius).min(at.saturating_sub(3));
    let high = s.times.partition_point(|&u| u <= t + radius).max((at + 4).min(s.times.len()));
    let unit = (s.times[high - 1] - s.times[low]).max(f64::MIN_POSITIVE);
    let mut normal = SMatrix::<f64, 4, 4>::zeros();
    let mut right = SMatrix::<f64, 4, 3>::zeros();
    for i in low..high {
        let u = (s.times[i] - t) / unit;
        let powers = SMatrix::<f64, 4, 1>::new(1.0, u, u * u, u * u * u);
        normal += powers * powers.transpose();
        right += powers * s.rates[i].transpose();
    }
    let solution = normal.cholesky()?.solve(&right);
    Some((solution.row(0).transpose(), solution.row(1).transpose() / unit))
}

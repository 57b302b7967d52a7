//! The Cramér–Rao bound: what no unbiased estimator can undercut.
//!
//! F = σ⁻² Σ Sᵢᵀ Sᵢ with S = ∂ω/∂(x, ω₀) from the variational equations of J ω' = J ω × ω; each segment has an ω₀ of its
//! own, which the Schur complement takes out.

use nalgebra::{Matrix3, SMatrix, Vector3};

use super::coordinates::{Coordinates, Form, basis, eigen, entries_of_coordinates, tensor};
use super::test_functions::Stretch;
use super::weak::cross_derivative;
use crate::body::Inertia;

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

/// The motion through `start` at sample `middle`, with its sensitivities to (x, start): `visit` sees every sample.
fn sweep(
    euler: &Euler,
    times: &[f64],
    middle: usize,
    start: Vector3<f64>,
    mut visit: impl FnMut(usize, &Vector3<f64>, &Sensitivity),
) {
    let identity = Sensitivity::from_fn(|i, k| if k == i + 5 { 1.0 } else { 0.0 });
    visit(middle, &start, &identity);
    let (mut w, mut sensitivity) = (start, identity);
    for i in middle + 1..times.len() {
        euler.advance(&mut w, &mut sensitivity, times[i] - times[i - 1]);
        visit(i, &w, &sensitivity);
    }
    let (mut w, mut sensitivity) = (start, identity);
    for i in (0..middle).rev() {
        euler.advance(&mut w, &mut sensitivity, times[i] - times[i + 1]);
        visit(i, &w, &sensitivity);
    }
}

/// What a sweep says of (x, start), and how far the samples are from it.
struct Fisher {
    information: SMatrix<f64, 8, 8>,
    gradient: Vector3<f64>,
    misfit: f64,
}

impl Fisher {
    fn new(euler: &Euler, s: &Stretch, middle: usize, start: Vector3<f64>) -> Fisher {
        let mut sum = Fisher { information: SMatrix::zeros(), gradient: Vector3::zeros(), misfit: 0.0 };
        sweep(euler, &s.times, middle, start, |i, w, sensitivity| {
            sum.information += sensitivity.transpose() * sensitivity;
            let residual = s.rates[i] - w;
            sum.gradient += sensitivity.fixed_view::<3, 3>(0, 5).transpose() * residual;
            sum.misfit += residual.norm_squared();
        });
        sum
    }

    /// The Gauss–Newton step of the start, the tensor held.
    fn step(&self) -> Option<Vector3<f64>> {
        Some(self.information.fixed_view::<3, 3>(5, 5).into_owned().cholesky()?.solve(&self.gradient))
    }

    /// Information about x alone.
    fn of_tensor(&self) -> Option<Form> {
        let own = self.information.fixed_view::<3, 3>(5, 5).into_owned().cholesky()?;
        let mixed = self.information.fixed_view::<3, 5>(5, 0).into_owned();
        Some(self.information.fixed_view::<5, 5>(0, 0) - mixed.transpose() * own.solve(&mixed))
    }
}

/// Sweeps that look for a better start of one stretch.
const STARTS: usize = 4;
/// A step of the start, in units of the mean square rate, that no longer changes the bound.
const STILL: f64 = 1e-3;

/// The bound on the covariance of the coordinates; `None` where the tensor has no inverse or the record does not
/// determine it. Motions start from a local cubic through the samples within one radian of each middle, which
/// least squares over the whole stretch then improve: a weak wobble is known by all samples together only.
pub(super) fn cramer_rao(stretches: &[Stretch], x: &Coordinates, variance: f64) -> Option<Form> {
    let j = tensor(x);
    let euler = Euler { j, inverse: j.try_inverse()? };
    let mut information = Form::zeros();
    for s in stretches.iter().filter(|s| s.times.len() >= 5) {
        let middle = s.times.len() / 2;
        let (mut start, _) = local_cubic(s, middle, 1.0)?;
        let mut fisher = Fisher::new(&euler, s, middle, start);
        for _ in 1..STARTS {
            let step = fisher.step().filter(|step| step.norm() > STILL);
            let Some(step) = step else { break };
            let next = Fisher::new(&euler, s, middle, start + step);
            // where torques act, the samples may lead away from any free motion
            if next.misfit.is_nan() || next.misfit >= fisher.misfit {
                break;
            }
            (start, fisher) = (start + step, next);
        }
        information += fisher.of_tensor()?;
    }
    Some((information / variance).cholesky()?.inverse())
}

/// The Cramér–Rao bound on the tensor with trace 1 of a body that is known: what a record of its free motion can tell
/// at best, before it is made. Covariance of the entries xx, yy, zz, xy, xz, yz in body axes.
///
/// `omega_body` (rad/s, body axes) is the angular velocity at the first of `times` (s, ascending); `sigma` is the
/// standard deviation of the noise of one component, rad/s.
///
/// ```
/// use nalgebra::Vector3;
/// use polhode::{body::Inertia, fit::foreseen_bound};
/// let body = Inertia::from_moments([1.0, 2.0, 2.6])?;
/// let times: Vec<f64> = (0..1000).map(|i| f64::from(i) / 100.0).collect();
/// let tumble = foreseen_bound(&body, Vector3::new(0.3, 1.0, 0.4), &times, 1e-3).ok_or("tumbles")?;
/// let wobble = foreseen_bound(&body, Vector3::new(0.03, 0.03, 1.0), &times, 1e-3).ok_or("wobbles")?;
/// assert!(wobble.trace() > 100.0 * tumble.trace());
/// assert!(foreseen_bound(&body, Vector3::new(0.0, 0.0, 1.0), &times, 1e-3).is_none()); // a pure spin
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// `None` where the motion does not determine the tensor, or an argument is not finite.
pub fn foreseen_bound(
    inertia: &Inertia,
    omega_body: Vector3<f64>,
    times: &[f64],
    sigma: f64,
) -> Option<SMatrix<f64, 6, 6>> {
    let shape = inertia.tensor() / inertia.tensor().trace();
    let euler = Euler { j: shape, inverse: shape.try_inverse()? };
    // in units of the rate, as in a fit
    let rate = omega_body.norm();
    let times: Vec<f64> = times.iter().map(|t| t * rate).collect();
    let mut information = SMatrix::zeros();
    sweep(&euler, &times, 0, omega_body / rate, |_, _, s| information += s.transpose() * s);
    let fisher = Fisher { information, gradient: Vector3::zeros(), misfit: 0.0 };
    let deviation = sigma / rate;
    let information = fisher.of_tensor()?;
    let (spectrum, _) = eigen(information);
    // what a pure spin leaves open is zero up to the rounding of sums of squares
    if spectrum[0].is_nan() || spectrum[0] <= 1e-12 * spectrum[4] {
        return None;
    }
    let bound = (information / (deviation * deviation)).cholesky()?.inverse();
    let entries = entries_of_coordinates();
    Some(entries * bound * entries.transpose()).filter(|b| b.iter().all(|v| v.is_finite()))
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

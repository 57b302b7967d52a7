//! What is usually done, for comparison only: each as a least-squares program with the same physical law, so that
//! tables show what the formulation costs.

use nalgebra::{DMatrix, Matrix3, Matrix5, SMatrix, Vector3, Vector5};
use polhode::fit::{Record, Segment};
use polhode::num::Real;

/// A formulation to compare with.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Baseline {
    /// J ω' + ω × J ω = 0 at every sample, ω' by central differences. Noise of size σ/h enters the regressor: the
    /// answer is pulled towards the sphere.
    CentralDifferences,
    /// The same with ω and ω' from local cubics over `window` samples (Savitzky–Golay).
    SavitzkyGolay {
        /// Samples of the window, odd.
        window: usize,
    },
    /// R(t) J ω(t) = L with the attitude R by integration of the same ω, whose error grows like a random walk.
    Momentum,
}

impl Baseline {
    /// Its name, as tables print it.
    pub(super) fn name(self) -> String {
        match self {
            Self::CentralDifferences => "baseline: central differences".into(),
            Self::SavitzkyGolay { window } => format!("baseline: Savitzky-Golay {window}"),
            Self::Momentum => "baseline: momentum".into(),
        }
    }

    /// The tensor with trace 1, unweighted: no covariance is given, since none of these is honest. `None` where the
    /// equations do not determine it.
    pub(super) fn shape(self, record: &Record) -> Option<Matrix3<f64>> {
        let mut rows = Vec::new();
        for s in &normalised(record) {
            match self {
                Baseline::CentralDifferences => strong(s, &mut rows, |i| {
                    let slope = (s.rates[i + 1] - s.rates[i - 1]) / (s.times[i + 1] - s.times[i - 1]);
                    Some((s.rates[i], slope))
                }),
                Baseline::SavitzkyGolay { window } => strong(s, &mut rows, |i| {
                    let half = window / 2;
                    if i < half || i + half >= s.times.len() {
                        return None;
                    }
                    let radius = (s.times[i + half] - s.times[i]).max(s.times[i] - s.times[i - half]);
                    local_cubic(s, i, radius)
                }),
                Baseline::Momentum => momentum(s, &mut rows),
            }
        }
        if rows.len() < 6 {
            return None;
        }
        let r = DMatrix::from_row_iterator(rows.len(), 6, rows.iter().flatten().copied()).qr().r();
        let root = r.fixed_view::<5, 5>(0, 0).into_owned();
        let centre = root.solve_upper_triangular(&-r.fixed_view::<5, 1>(0, 5))?;
        centre.iter().all(|v| v.is_finite()).then(|| tensor(&nearest(centre, &(root.transpose() * root))))
    }
}

/// A segment in units of the root mean square rate of its record and its inverse.
struct Stretch {
    times: Vec<f64>,
    rates: Vec<Vector3<f64>>,
}

fn normalised(record: &Record) -> Vec<Stretch> {
    let rates = || record.segments.iter().flat_map(Segment::rates);
    let largest = rates().map(|w| w.amax()).fold(0.0, f64::max);
    let mean = rates().map(|w| (w / largest).norm_squared()).sum::<f64>() / record.samples() as f64;
    let rms = largest * mean.sqrt();
    let scaled = |s: &Segment| Stretch {
        times: s.times().iter().map(|t| (t - s.times()[0]) * rms).collect(),
        rates: s.rates().iter().map(|w| w / rms).collect(),
    };
    record.segments.iter().map(scaled).collect()
}

/// The k-th of an orthonormal basis of the symmetric matrices of trace 0, the order of which is of no importance.
fn basis(k: usize) -> Matrix3<f64> {
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

fn tensor(x: &Vector5<f64>) -> Matrix3<f64> {
    (0..5).fold(Matrix3::identity() / 3.0, |sum, k| sum + basis(k) * x[k])
}

/// Largest moment as a share of the trace: the other two together are not less.
const LIMIT: f64 = 0.5;

/// The physical tensor nearest to `centre` in the metric `information`, by projected gradients with momentum (Nesterov)
/// that start anew where they turn back.
fn nearest(centre: Vector5<f64>, information: &Matrix5<f64>) -> Vector5<f64> {
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
fn physical(x: &Vector5<f64>) -> Vector5<f64> {
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

fn regressor(mut column: impl FnMut(&Matrix3<f64>) -> Vector3<f64>, rows: &mut Vec<[f64; 6]>) {
    let columns: [Vector3<f64>; 6] =
        core::array::from_fn(|k| column(&if k < 5 { basis(k) } else { Matrix3::identity() / 3.0 }));
    rows.extend((0..3).map(|c| columns.map(|v| v[c])));
}

fn strong(s: &Stretch, rows: &mut Vec<[f64; 6]>, at: impl Fn(usize) -> Option<(Vector3<f64>, Vector3<f64>)>) {
    for i in 1..s.times.len().saturating_sub(1) {
        if let Some((w, slope)) = at(i) {
            regressor(|b| b * slope + w.cross(&(b * w)), rows);
        }
    }
}

/// Value and slope at sample `at` of the cubic through all samples within `radius`, from which rounding may leave out the
/// outermost.
fn local_cubic(s: &Stretch, at: usize, radius: f64) -> Option<(Vector3<f64>, Vector3<f64>)> {
    let t = s.times[at];
    let low = s.times.partition_point(|&u| u < t - radius);
    let high = s.times.partition_point(|&u| u <= t + radius);
    let unit = s.times[high - 1] - s.times[low];
    let (mut normal, mut right) = (SMatrix::<f64, 4, 4>::zeros(), SMatrix::<f64, 4, 3>::zeros());
    for i in low..high {
        let u = (s.times[i] - t) / unit;
        let powers = SMatrix::<f64, 4, 1>::new(1.0, u, u * u, u * u * u);
        normal += powers * powers.transpose();
        right += powers * s.rates[i].transpose();
    }
    let solution = normal.cholesky()?.solve(&right);
    Some((solution.row(0).transpose(), solution.row(1).transpose() / unit))
}

fn momentum(s: &Stretch, rows: &mut Vec<[f64; 6]>) {
    let (times, rates) = (&s.times, &s.rates);
    let mut attitude = Matrix3::<f64>::identity();
    let first = rows.len();
    for i in 0..times.len() {
        if i > 0 {
            attitude *= turn((rates[i] + rates[i - 1]) * (0.5 * (times[i] - times[i - 1])));
        }
        regressor(|b| attitude * (b * rates[i]), rows);
    }
    // L is whatever the mean says
    for c in 0..3 {
        let mut mean = [0.0; 6];
        for row in rows[first + c..].iter().step_by(3) {
            (0..6).for_each(|k| mean[k] += row[k] / times.len() as f64);
        }
        for row in rows[first + c..].iter_mut().step_by(3) {
            (0..6).for_each(|k| row[k] -= mean[k]);
        }
    }
}

/// The rotation by the vector `angle`, rad (Rodrigues).
fn turn(angle: Vector3<f64>) -> Matrix3<f64> {
    let size = angle.norm();
    if size == 0.0 {
        return Matrix3::identity();
    }
    let (sin, cos) = Real::sin_cos(size);
    let n = (angle / size).cross_matrix();
    Matrix3::identity() + n * sin + n * n * (1.0 - cos)
}

#[cfg(test)]
mod tests {
    use nalgebra::{Quaternion, UnitQuaternion};
    use polhode::fit::{Settings, fit, simulate};
    use polhode::inertia::Inertia;
    use polhode::num::Random;

    use super::*;

    fn example(sigma: f64) -> (Matrix3<f64>, Record) {
        let mut random = Random::new(99);
        let (w, v) = (random.normal(), random.normal_vector());
        let turn = UnitQuaternion::from_quaternion(Quaternion::new(w, v.x, v.y, v.z)).to_rotation_matrix();
        let moments = Vector3::new(1.0, 2.0, 2.6) / 5.6;
        let j = turn.matrix() * Matrix3::from_diagonal(&moments) * turn.matrix().transpose();
        let j = (j + j.transpose()) * 0.5;
        let times: Vec<f64> = (0..1500).map(|i| 0.02 * f64::from(i)).collect();
        let body = Inertia::from_tensor(j).unwrap();
        let omega = Vector3::new(0.3, -0.8, 0.6);
        let rates = simulate(&body, omega, &times, sigma, &mut random).unwrap();
        (j, Record::from_samples(&times, &rates).unwrap())
    }

    #[test]
    fn baselines_are_right_without_noise_and_lose_to_it() {
        let (j, record) = example(0.0);
        for form in [Baseline::CentralDifferences, Baseline::SavitzkyGolay { window: 7 }, Baseline::Momentum]
        {
            let error = (form.shape(&record).unwrap() - j).norm();
            assert!(error < 1e-3, "{}: {error:e}", form.name());
        }
        let (j, record) = example(1e-2);
        let own = (fit(&record, &Settings::default()).unwrap().shape.tensor() - j).norm();
        let error = |form: Baseline| (form.shape(&record).unwrap() - j).norm();
        assert!(error(Baseline::CentralDifferences) > 50.0 * own);
        for form in [Baseline::SavitzkyGolay { window: 21 }, Baseline::Momentum] {
            assert!(error(form) > own, "{}", form.name());
        }
    }

    /// In the metric of entries the nearest physical tensor is the clipped spectrum; in any metric no step towards another
    /// physical tensor leads nearer.
    #[test]
    fn the_nearest_physical_tensor_is_nearest() {
        let coordinates = |d: [f64; 3]| {
            let j = Matrix3::from_diagonal(&Vector3::from(d));
            Vector5::from_fn(|k, _| basis(k).dot(&j))
        };
        for (far, near) in [([0.05, 0.25, 0.7], [0.15, 0.35, 0.5]), ([-0.4, 0.65, 0.75], [0.0, 0.5, 0.5])] {
            let found = nearest(coordinates(far), &Matrix5::identity());
            assert!((found - coordinates(near)).norm() < 1e-14, "{found}");
        }
        let mut random = Random::new(4);
        for _ in 0..20 {
            let root = Matrix5::from_fn(|i, k| if i == k { 3.0 } else { random.normal() });
            let information = root.transpose() * root;
            let centre = Vector5::from_fn(|_, _| 0.3 * random.normal());
            let found = nearest(centre, &information);
            for _ in 0..20 {
                let other = physical(&Vector5::from_fn(|_, _| random.normal()));
                let slope = (information * (found - centre)).dot(&(other - found));
                assert!(slope > -1e-10, "{slope:e}");
            }
        }
    }
}

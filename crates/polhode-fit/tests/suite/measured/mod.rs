//! Noisy records of known bodies, and the distance of an estimate in its own covariance.

pub(crate) mod torques;

use nalgebra::{Matrix3, Quaternion, Rotation3, SMatrix, UnitQuaternion, Vector3};
use polhode::inertia::Inertia;
use polhode::num::Random;
use polhode_fit::{Record, simulate};

pub(crate) const ENTRIES: [(usize, usize); 6] = [(0, 0), (1, 1), (2, 2), (0, 1), (0, 2), (1, 2)];

pub(crate) fn entries(j: &Matrix3<f64>) -> SMatrix<f64, 6, 1> {
    SMatrix::from_fn(|k, _| j[ENTRIES[k]])
}

pub(crate) fn random_rotation(random: &mut Random) -> Rotation3<f64> {
    let (w, v) = (random.normal(), random.normal_vector());
    UnitQuaternion::from_quaternion(Quaternion::new(w, v.x, v.y, v.z)).to_rotation_matrix()
}

pub(crate) fn turned(moments: [f64; 3], r: &Rotation3<f64>) -> Matrix3<f64> {
    let j = r.matrix() * Matrix3::from_diagonal(&Vector3::from(moments)) * r.matrix().transpose();
    (j + j.transpose()) * 0.5
}

/// 100 Hz for `seconds`.
pub(crate) fn times(seconds: usize) -> Vec<f64> {
    sampled(100, seconds)
}

/// `rate` Hz for `seconds`.
pub(crate) fn sampled(rate: usize, seconds: usize) -> Vec<f64> {
    (0..=rate * seconds).map(|i| i as f64 / rate as f64).collect()
}

pub(crate) fn record(
    j: &Matrix3<f64>,
    omega: Vector3<f64>,
    times: &[f64],
    sigma: f64,
    random: &mut Random,
) -> Record {
    let rates = simulate(&Inertia::from_tensor(*j).unwrap(), omega, times, sigma, random).unwrap();
    Record::from_samples(times, &rates).unwrap()
}

/// eᵀ C⁺ e, C singular along the trace only: adding the trace direction makes it regular and changes nothing.
pub(crate) fn distance(e: &SMatrix<f64, 6, 1>, c: &SMatrix<f64, 6, 6>) -> f64 {
    let trace = SMatrix::<f64, 6, 1>::new(1.0, 1.0, 1.0, 0.0, 0.0, 0.0);
    let regular = c + trace * trace.transpose() * c.trace();
    e.dot(&regular.cholesky().unwrap().solve(e))
}

pub(crate) fn example(sigma: f64) -> (Matrix3<f64>, Vec<f64>, Vec<Vector3<f64>>) {
    let mut random = Random::new(99);
    let j = turned([1.0 / 5.6, 2.0 / 5.6, 2.6 / 5.6], &random_rotation(&mut random));
    let times: Vec<f64> = (0..1500).map(|i| 0.02 * f64::from(i)).collect();
    let body = Inertia::from_tensor(j).unwrap();
    let rates = simulate(&body, Vector3::new(0.3, -0.8, 0.6), &times, sigma, &mut random).unwrap();
    (j, times, rates)
}

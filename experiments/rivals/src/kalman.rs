//! Extended Kalman filter with the rate and the tensor as its state.
//!
//! The tensor does not change and no torque acts, so there is no process noise. The filter runs over the record several
//! times, each time linearised about the tensor that the last run ended with, and with the wide prior of the first.

use nalgebra::{Matrix3, SMatrix, SVector, Vector3, Vector5};

use super::Answer;
use super::coordinates::tensor;
use super::euler::{Euler, at_start};
use super::record::Stretch;

const RUNS: usize = 3;
/// Standard deviation of each coordinate of the tensor beforehand, a share of the trace.
const PRIOR: f64 = 0.1;
/// Moments stay above this share of the trace, where a step of the filter would take them below.
const SMALLEST: f64 = 0.01;

type State = SVector<f64, 8>;
type Covariance = SMatrix<f64, 8, 8>;

/// From the coordinates `x`. `None` where the filter has diverged.
pub(super) fn answer(stretches: &[Stretch], mut x: Vector5<f64>, sigma: f64) -> Option<Answer> {
    for run in 0..RUNS {
        let mut covariance = SMatrix::<f64, 5, 5>::identity() * (PRIOR * PRIOR);
        for s in stretches {
            let (z, p) = filter(s, &x, &covariance, sigma)?;
            x = z.fixed_rows::<5>(0).into_owned();
            covariance = p.fixed_view::<5, 5>(0, 0).into_owned();
        }
        if run + 1 == RUNS {
            return Answer::constrained(x, covariance.try_inverse()?);
        }
    }
    None
}

fn filter(
    s: &Stretch,
    x: &Vector5<f64>,
    prior: &SMatrix<f64, 5, 5>,
    sigma: f64,
) -> Option<(State, Covariance)> {
    let variance = sigma * sigma;
    let mut z = State::zeros();
    z.fixed_rows_mut::<5>(0).copy_from(x);
    z.fixed_rows_mut::<3>(5).copy_from(&s.rates[0]);
    let mut p = Covariance::identity() * variance;
    p.fixed_view_mut::<5, 5>(0, 0).copy_from(prior);
    for i in 1..s.times.len() {
        let mut rate = Vector3::new(z[5], z[6], z[7]);
        let mut sensitivity = at_start();
        Euler::new(&z.fixed_rows::<5>(0).into_owned())?.advance(
            &mut rate,
            &mut sensitivity,
            s.times[i] - s.times[i - 1],
        );
        let mut moved = Covariance::identity();
        moved.fixed_view_mut::<3, 8>(5, 0).copy_from(&sensitivity);
        p = moved * p * moved.transpose();
        let innovation = p.fixed_view::<3, 3>(5, 5) + Matrix3::identity() * variance;
        let gain = p.fixed_view::<8, 3>(0, 5) * innovation.try_inverse()?;
        z.fixed_rows_mut::<3>(5).copy_from(&rate);
        z += gain * (s.rates[i] - rate);
        p -= gain * p.fixed_view::<3, 8>(5, 0).into_owned();
        p = (p + p.transpose()) * 0.5;
        let physical = bounded(&z.fixed_rows::<5>(0).into_owned());
        z.fixed_rows_mut::<5>(0).copy_from(&physical);
        if !z.iter().all(|v| v.is_finite()) {
            return None;
        }
    }
    Some((z, p))
}

/// The coordinates moved towards the sphere until no moment is too small.
fn bounded(x: &Vector5<f64>) -> Vector5<f64> {
    let eigen = tensor(x).symmetric_eigenvalues();
    let smallest = eigen.min();
    if smallest >= SMALLEST {
        return *x;
    }
    x * ((1.0 / 3.0 - SMALLEST) / (1.0 / 3.0 - smallest))
}

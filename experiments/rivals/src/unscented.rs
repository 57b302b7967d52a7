//! Unscented Kalman filter with the rate and the tensor as its state: mean and covariance are carried from sample to sample by
//! sixteen motions in place of derivatives.
//!
//! The readings are the rates themselves, so that an update is that of the linear filter. Without process noise the points are drawn
//! from the covariance of the update before. As the extended filter it runs over the record several times, each time from the
//! tensor that the last run ended with, and with the wide prior of the first.
//!
//! Source: S. J. Julier and J. K. Uhlmann, Proc. IEEE 92 (2004) 401: symmetric points without one at the centre (κ = 0), whose weight
//! would be negative for a normal state of eight components.

use nalgebra::{Matrix3, Matrix5, SMatrix, SVector, Vector3, Vector5};

use super::Answer;
use super::euler::Euler;
use super::kalman::bounded;
use super::record::Stretch;

const RUNS: usize = 3;
const STATE: usize = 8;
/// Weight of a point.
const WEIGHT: f64 = 0.5 / STATE as f64;

type State = SVector<f64, STATE>;
type Covariance = SMatrix<f64, STATE, STATE>;

/// From the coordinates `x`, which are known to `prior` beforehand, a share of the trace. `None` where the filter has diverged.
pub(super) fn filtered(stretches: &[Stretch], x: Vector5<f64>, prior: f64, sigma: f64) -> Option<Answer> {
    let (mut x, mut covariance) = (x, Matrix5::zeros());
    for _ in 0..RUNS {
        covariance = Matrix5::identity() * (prior * prior);
        for s in stretches {
            let (z, p) = filter(s, &x, &covariance, sigma)?;
            x = z.fixed_rows::<5>(0).into_owned();
            covariance = p.fixed_view::<5, 5>(0, 0).into_owned();
        }
    }
    Answer::constrained(x, covariance.try_inverse()?)
}

fn filter(s: &Stretch, x: &Vector5<f64>, prior: &Matrix5<f64>, sigma: f64) -> Option<(State, Covariance)> {
    let variance = sigma * sigma;
    let mut z = State::zeros();
    z.fixed_rows_mut::<5>(0).copy_from(x);
    z.fixed_rows_mut::<3>(5).copy_from(&s.rates[0]);
    let mut p = Covariance::identity() * variance;
    p.fixed_view_mut::<5, 5>(0, 0).copy_from(prior);
    for i in 1..s.times.len() {
        (z, p) = moved(&z, &p, s.times[i] - s.times[i - 1])?;
        let innovation = p.fixed_view::<3, 3>(5, 5) + Matrix3::identity() * variance;
        let gain = p.fixed_view::<STATE, 3>(0, 5) * innovation.try_inverse()?;
        z += gain * (s.rates[i] - z.fixed_rows::<3>(5));
        p -= gain * p.fixed_view::<3, STATE>(5, 0).into_owned();
        p = (p + p.transpose()) * 0.5;
        let physical = bounded(&z.fixed_rows::<5>(0).into_owned());
        z.fixed_rows_mut::<5>(0).copy_from(&physical);
        if !z.iter().all(|v| v.is_finite()) {
            return None;
        }
    }
    Some((z, p))
}

/// Mean and covariance after `time`. The tensor stays: only the rate's part of them changes.
fn moved(z: &State, p: &Covariance, time: f64) -> Option<(State, Covariance)> {
    let root = (p * STATE as f64).cholesky()?.unpack();
    let rate_of = |point: State| -> Option<Vector3<f64>> {
        let mut rate = point.fixed_rows::<3>(5).into_owned();
        Euler::new(&point.fixed_rows::<5>(0).into_owned())?.carry(&mut rate, time);
        Some(rate)
    };
    let mut rates = [[Vector3::zeros(); 2]; STATE];
    let mut mean = Vector3::zeros();
    for (k, pair) in rates.iter_mut().enumerate() {
        let column = root.column(k);
        *pair = [rate_of(z + column)?, rate_of(z - column)?];
        mean += (pair[0] + pair[1]) * WEIGHT;
    }
    let mut own = Matrix3::zeros();
    let mut cross = SMatrix::<f64, 3, 5>::zeros();
    for (k, [ahead, behind]) in rates.iter().enumerate() {
        for off in [ahead - mean, behind - mean] {
            own += off * off.transpose() * WEIGHT;
        }
        cross += (ahead - behind) * root.fixed_view::<5, 1>(0, k).transpose() * WEIGHT;
    }
    let (mut z, mut p) = (*z, *p);
    z.fixed_rows_mut::<3>(5).copy_from(&mean);
    p.fixed_view_mut::<3, 3>(5, 5).copy_from(&own);
    p.fixed_view_mut::<3, 5>(5, 0).copy_from(&cross);
    p.fixed_view_mut::<5, 3>(0, 5).copy_from(&cross.transpose());
    Some((z, p))
}

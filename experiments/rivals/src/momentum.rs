//! R(t) J ω(t) = L: the momentum in space is constant.

use nalgebra::{Matrix3, SMatrix, UnitQuaternion, Vector3, Vector5};
use polhode::num::Real;

use super::Answer;
use super::coordinates::{basis, tensor};
use super::record::Stretch;
use super::strong::{Rows, regressor};

/// Rows with the attitude by integration of the same rates, whose error grows like a random walk; L is whatever the
/// mean says.
pub(super) fn integrated(s: &Stretch) -> Rows {
    let (times, rates) = (&s.times, &s.rates);
    let mut attitude = Matrix3::<f64>::identity();
    let mut rows = Vec::new();
    for i in 0..times.len() {
        if i > 0 {
            attitude *= turn((rates[i] + rates[i - 1]) * (0.5 * (times[i] - times[i - 1])));
        }
        regressor(|b| attitude * (b * rates[i]), &mut rows);
    }
    for c in 0..3 {
        let mut mean = [0.0; 6];
        for row in rows[c..].iter().step_by(3) {
            (0..6).for_each(|k| mean[k] += row[k] / times.len() as f64);
        }
        for row in rows[c..].iter_mut().step_by(3) {
            (0..6).for_each(|k| row[k] -= mean[k]);
        }
    }
    rows
}

const ROUNDS: usize = 40;
/// Longest step of a round, in shares of the trace.
const LONGEST: f64 = 0.1;
/// Step, in standard deviations, that ends the rounds.
const STILL: f64 = 1e-4;

/// With attitudes (body to space) from another instrument, one for each sample of the only stretch: the rates are
/// J⁻¹ Rᵀ L, whose x and L follow by least squares (Gauss–Newton from `x`), weighted by the noise of the rates, `sigma`,
/// and of the attitudes, `tilt` rad. `None` where the rounds do not come to rest.
pub(super) fn measured(
    s: &Stretch,
    attitudes: &[UnitQuaternion<f64>],
    mut x: Vector5<f64>,
    sigma: f64,
    tilt: f64,
) -> Option<Answer> {
    let turns: Vec<Matrix3<f64>> =
        attitudes.iter().map(|q| q.to_rotation_matrix().into_inner().transpose()).collect();
    let j = tensor(&x);
    let mut momentum = s.rates.iter().zip(&turns).map(|(w, r)| r.transpose() * (j * w)).sum::<Vector3<f64>>()
        / s.rates.len() as f64;
    for _ in 0..ROUNDS {
        let inverse = tensor(&x).try_inverse()?;
        let (mut normal, mut right) = (SMatrix::<f64, 8, 8>::zeros(), SMatrix::<f64, 8, 1>::zeros());
        for (rate, r) in s.rates.iter().zip(&turns) {
            let m = r * momentum;
            let predicted = inverse * m;
            let mut row = SMatrix::<f64, 3, 8>::zeros();
            (0..5).for_each(|k| row.set_column(k, &(-inverse * (basis(k) * predicted))));
            row.fixed_view_mut::<3, 3>(0, 5).copy_from(&(inverse * r));
            let by_tilt = inverse * m.cross_matrix() * tilt;
            let noise = Matrix3::identity() * (sigma * sigma) + by_tilt * by_tilt.transpose();
            let weighted = row.transpose() * noise.try_inverse()?;
            normal += weighted * row;
            right += weighted * (rate - predicted);
        }
        let step = normal.cholesky()?.solve(&right);
        let change = step.fixed_rows::<5>(0).into_owned();
        let share = (LONGEST / change.norm()).min(1.0);
        x += change * share;
        momentum += step.fixed_rows::<3>(5) * share;
        if share == 1.0 && step.dot(&(normal * step)) < STILL * STILL {
            let covariance = normal.try_inverse()?.fixed_view::<5, 5>(0, 0).into_owned();
            return Answer::constrained(x, covariance.try_inverse()?);
        }
    }
    None
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

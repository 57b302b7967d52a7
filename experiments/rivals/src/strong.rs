//! Euler's equation at every sample, J ω' + ω × J ω = 0, with a derivative from the samples.

use nalgebra::{Matrix3, SMatrix, Vector3};

use super::coordinates::basis;
use super::record::Stretch;

/// The rows of five coordinates and what the sphere leaves, three for each sample.
pub(super) type Rows = Vec<[f64; 6]>;

pub(super) fn regressor(mut column: impl FnMut(&Matrix3<f64>) -> Vector3<f64>, rows: &mut Rows) {
    let columns: [Vector3<f64>; 6] =
        core::array::from_fn(|k| column(&if k < 5 { basis(k) } else { Matrix3::identity() / 3.0 }));
    rows.extend((0..3).map(|c| columns.map(|v| v[c])));
}

/// With ω' by central differences. Noise of size σ/h enters the regressor: the answer is pulled towards the sphere.
pub(super) fn central_differences(s: &Stretch) -> Rows {
    equations(s, |i| {
        let slope = (s.rates[i + 1] - s.rates[i - 1]) / (s.times[i + 1] - s.times[i - 1]);
        Some((s.rates[i], slope))
    })
}

/// With ω and ω' from local cubics over `window` samples, an odd number (Savitzky–Golay).
pub(super) fn savitzky_golay(s: &Stretch, window: usize) -> Rows {
    let half = window / 2;
    equations(s, |i| {
        if i < half || i + half >= s.times.len() {
            return None;
        }
        local_cubic(s, i - half..i + half + 1, s.times[i])
    })
}

fn equations(s: &Stretch, at: impl Fn(usize) -> Option<(Vector3<f64>, Vector3<f64>)>) -> Rows {
    let mut rows = Vec::new();
    for i in 1..s.times.len().saturating_sub(1) {
        if let Some((w, slope)) = at(i) {
            regressor(|b| b * slope + w.cross(&(b * w)), &mut rows);
        }
    }
    rows
}

/// Value and slope at `time` of the cubic through the samples of a range.
pub(super) fn local_cubic(
    s: &Stretch,
    range: core::ops::Range<usize>,
    time: f64,
) -> Option<(Vector3<f64>, Vector3<f64>)> {
    let unit = s.times[range.end - 1] - s.times[range.start];
    let (mut normal, mut right) = (SMatrix::<f64, 4, 4>::zeros(), SMatrix::<f64, 4, 3>::zeros());
    for i in range {
        let u = (s.times[i] - time) / unit;
        let powers = SMatrix::<f64, 4, 1>::new(1.0, u, u * u, u * u * u);
        normal += powers * powers.transpose();
        right += powers * s.rates[i].transpose();
    }
    let solution = normal.cholesky()?.solve(&right);
    Some((solution.row(0).transpose(), solution.row(1).transpose() / unit))
}

//! What is usually done, for comparison only: each as a least-squares program with the same physical law, so that
//! tables show what the formulation costs. None of them is used by [`fit`](super::fit).

use nalgebra::{Matrix3, Vector3};

use super::cramer_rao::local_cubic;
use super::error::FitError;
use super::physical::coordinates::{basis, tensor};
use super::physical::nearest::nearest;
use super::record::Record;
use super::report::facts::shape_of;
use super::weak::normalised::normalised;
use super::weak::stacked::Stacked;
use super::weak::test_functions::Stretch;
use crate::inertia::InertiaShape;
use crate::num::Real;

/// A formulation to compare with.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Baseline {
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
    pub fn name(self) -> String {
        match self {
            Self::CentralDifferences => "baseline: central differences".into(),
            Self::SavitzkyGolay { window } => format!("baseline: Savitzky-Golay {window}"),
            Self::Momentum => "baseline: momentum".into(),
        }
    }
}

/// The tensor by a baseline, unweighted: no covariance is given, since none of these is honest.
///
/// # Errors
/// Too few samples, no rotation, or a program without a certified answer.
pub fn baseline(record: &Record, form: Baseline) -> Result<InertiaShape, FitError> {
    let stretches = normalised(record)?.stretches;
    let mut rows = Vec::new();
    for s in &stretches {
        match form {
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
    let stacked = Stacked::of_rows(&rows);
    let centre = stacked.minimiser().filter(|x| x.iter().all(|v| v.is_finite()));
    let centre =
        centre.ok_or_else(|| FitError::Solver { status: "the baseline's matrix is singular".into() })?;
    let spread = (stacked.misfit / rows.len() as f64).sqrt();
    let root = if spread > 0.0 { stacked.root / spread } else { stacked.root };
    shape_of(&tensor(&nearest(centre, root, &[])?.x))
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

fn momentum(s: &Stretch, rows: &mut Vec<[f64; 6]>) {
    let mut attitude = Matrix3::<f64>::identity();
    let first = rows.len();
    for i in 0..s.times.len() {
        if i > 0 {
            attitude *= turn((s.rates[i] + s.rates[i - 1]) * (0.5 * (s.times[i] - s.times[i - 1])));
        }
        regressor(|b| attitude * (b * s.rates[i]), rows);
    }
    // L is whatever the mean says
    for c in 0..3 {
        let mut mean = [0.0; 6];
        for row in rows[first + c..].iter().step_by(3) {
            (0..6).for_each(|k| mean[k] += row[k] / s.times.len() as f64);
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

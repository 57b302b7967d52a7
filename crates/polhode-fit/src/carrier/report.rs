//! Tensors and covariances of an answer.

use nalgebra::{DMatrix, DVector, Matrix3, Rotation3, SMatrix, UnitQuaternion, Vector3};
use polhode::inertia::Inertia;

use crate::carrier::estimate::{MeasuredBody, MeasuredWheel};
use crate::carrier::system::System;
use crate::columns::column::Column;
use crate::physical::coordinates::{eigen, symmetric};
use crate::report::nuisance::Nuisance;

/// What answers are drawn from.
pub(super) struct Report<'a> {
    pub(super) system: &'a System,
    pub(super) answer: &'a DVector<f64>,
    pub(super) covariance: &'a DMatrix<f64>,
}

impl Report<'_> {
    /// A body with `added` to its tensor.
    pub(super) fn body(&self, placed: (usize, f64), added: Matrix3<f64>) -> MeasuredBody {
        let (place, unit) = placed;
        let tensor = self.system.body(placed, self.answer) + added;
        let covariance = SMatrix::<f64, 6, 6>::from_fn(|i, k| self.covariance[(place + i, place + k)]);
        let covariance = covariance * (unit * unit);
        let (moments, _) = eigen(tensor);
        let axes = Inertia::from_tensor(tensor).map_or_else(|_| frame(&tensor), |i| i.principal_axes());
        let sigma = |k: usize| {
            let v = axes * Vector3::ith(k, 1.0);
            let slope = SMatrix::<f64, 6, 1>::from_fn(|e, _| v.dot(&(symmetric(e) * v)));
            slope.dot(&(covariance * slope)).max(0.0).sqrt()
        };
        MeasuredBody {
            tensor,
            covariance,
            principal: moments.into(),
            sigma_principal: [0, 1, 2].map(sigma),
            axes,
        }
    }

    /// The wheel, where its inertia is an unknown.
    pub(super) fn wheel(&self) -> Option<MeasuredWheel> {
        let (place, unit) = self.system.wheel?;
        Some(MeasuredWheel { inertia: self.answer[place] * unit, sigma: self.sigma(place) * unit })
    }

    /// The errors of the sensor, which are the first unknowns, in deviations of their priors.
    pub(super) fn nuisances(&self, sensor: &[Column]) -> Vec<Nuisance> {
        let each = sensor.iter().zip(&self.system.priors).enumerate();
        each.map(|(k, (column, prior))| {
            Nuisance::new(column, self.answer[k] * prior, self.sigma(k) * prior, 1.0)
        })
        .collect()
    }

    /// The standard deviation of an unknown.
    fn sigma(&self, place: usize) -> f64 {
        self.covariance[(place, place)].max(0.0).sqrt()
    }

    /// The covariance of carrier, object and wheel.
    pub(super) fn joint(&self) -> DMatrix<f64> {
        let each = |placed: (usize, f64)| (0..6).map(move |k| (placed.0 + k, placed.1));
        let bodies = [Some(self.system.carrier), self.system.object].into_iter().flatten().flat_map(each);
        let all: Vec<(usize, f64)> = bodies.chain(self.system.wheel).collect();
        DMatrix::from_fn(all.len(), all.len(), |i, k| {
            let ((i, of_i), (k, of_k)) = (all[i], all[k]);
            self.covariance[(i, k)] * of_i * of_k
        })
    }
}

/// The principal axes of a tensor that no body has, or that of a rod.
fn frame(tensor: &Matrix3<f64>) -> UnitQuaternion<f64> {
    let (_, mut axes) = eigen(*tensor);
    if axes.determinant() < 0.0 {
        axes.column_mut(0).neg_mut();
    }
    UnitQuaternion::from_rotation_matrix(&Rotation3::from_matrix_unchecked(axes))
}

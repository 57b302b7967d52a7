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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::columns::sets::sensor_columns;
    use crate::settings::sensor::SensorPriors;

    /// An error of scale, the wheel, the object and the carrier, each in a unit of its own.
    fn system() -> System {
        System {
            parts: Vec::new(),
            priors: vec![0.1],
            wheel: Some((1, 4.0)),
            object: Some((2, 2.0)),
            carrier: (8, 0.5),
        }
    }

    /// Values and deviations are those of the unknowns times their units; a covariance has the units of both.
    #[test]
    fn answers_are_unknowns_in_their_units() {
        let (system, answer) = (system(), DVector::from_fn(14, |k, _| 0.5 + k as f64));
        let product = |i: usize, k: usize| ((i + 1) * (k + 1)) as f64;
        let covariance = DMatrix::from_fn(14, 14, product) + DMatrix::identity(14, 14);
        let report = Report { system: &system, answer: &answer, covariance: &covariance };
        let wheel = report.wheel().unwrap();
        // 1.5 units of 4, with a variance of 2 · 2 + 1
        assert!(wheel.inertia == 6.0 && (wheel.sigma - 4.0 * 5.0_f64.sqrt()).abs() < 1e-14);
        let scale = sensor_columns(&SensorPriors::default().with_scale(0.1), 1.0);
        let found = report.nuisances(&scale);
        assert!(found.len() == 1 && found[0].name == "scale" && found[0].prior == Some(0.1), "{found:?}");
        let (value, sigma) = (found[0].value, found[0].sigma);
        assert!((value - 0.05).abs() < 1e-15 && (sigma - 0.1 * 2.0_f64.sqrt()).abs() < 1e-15);
        // the carrier first, then the object and the wheel
        let joint = report.joint();
        assert_eq!(joint.shape(), (13, 13));
        // 9 · 9 + 1, 9 · 3, 14 · 2 and 2 · 2 + 1
        assert_eq!([joint[(0, 0)], joint[(0, 6)]], [82.0 * 0.25, 27.0]);
        assert_eq!([joint[(5, 12)], joint[(12, 5)], joint[(12, 12)]], [56.0, 56.0, 80.0]);
        let without = System { wheel: None, object: None, ..system };
        let report = Report { system: &without, answer: &answer, covariance: &covariance };
        assert!(report.wheel().is_none() && report.joint().nrows() == 6);
    }

    /// The moment along v has the slope v_i v_j by an entry on the diagonal and twice that by one off it.
    #[test]
    fn moments_have_the_deviations_along_their_axes() {
        let system = system();
        let mut answer = DVector::<f64>::zeros(14);
        // half of it: xx, yy, zz and xy of 1, 1, 3 and 1
        answer.rows_mut(8, 4).copy_from_slice(&[2.0, 2.0, 6.0, 2.0]);
        let mut covariance = DMatrix::<f64>::zeros(14, 14);
        let own = [(0, 0, 4.0), (1, 1, 4.0), (2, 2, 16.0), (3, 3, 1.0), (0, 3, 1.0), (3, 0, 1.0)];
        own.into_iter().for_each(|(i, k, value)| covariance[(8 + i, 8 + k)] = value);
        let report = Report { system: &system, answer: &answer, covariance: &covariance };
        let added = Matrix3::from_diagonal(&Vector3::new(1.0, 1.0, 0.5));
        let found = report.body(system.carrier, added);
        let tensor = Matrix3::new(2.0, 1.0, 0.0, 1.0, 2.0, 0.0, 0.0, 0.0, 3.5);
        assert_eq!(found.tensor, tensor);
        let of = |i, k| found.covariance[(i, k)];
        assert_eq!([of(0, 0), of(2, 2), of(0, 3), of(3, 3)], [1.0, 4.0, 0.25, 0.25]);
        // along (1, −1, 0)/√2 it is ¼ + ¼ + ¼ − ¼, along (1, 1, 0)/√2 the sum of the four
        for (k, (moment, variance)) in [(1.0, 0.5), (3.0, 1.0), (3.5, 4.0)].into_iter().enumerate() {
            assert!((found.principal[k] - moment).abs() < 1e-13, "{k}: {}", found.principal[k]);
            assert!((found.sigma_principal[k] - f64::sqrt(variance)).abs() < 1e-13, "{k}");
        }
        let axes = found.axes.to_rotation_matrix();
        let along = axes.matrix().transpose() * tensor * axes.matrix();
        assert!((along - Matrix3::from_diagonal(&Vector3::new(1.0, 3.0, 3.5))).amax() < 1e-13, "{along}");
    }

    /// A tensor that no body has is along axes that are right-handed too.
    #[test]
    fn axes_of_any_tensor_are_a_rotation() {
        for moments in [[1.0, 2.0, 5.0], [5.0, 2.0, 1.0], [2.0, 1.0, 5.0], [2.0, 5.0, 1.0]] {
            let tensor = Matrix3::from_diagonal(&Vector3::from(moments));
            let axes = frame(&tensor).to_rotation_matrix();
            let along = axes.matrix().transpose() * tensor * axes.matrix();
            let expected = Matrix3::from_diagonal(&Vector3::new(1.0, 2.0, 5.0));
            assert!((along - expected).amax() < 1e-13, "{moments:?}: {along}");
        }
        // y, x and z are left-handed: the first of them turns
        let axes = frame(&Matrix3::from_diagonal(&Vector3::new(2.0, 1.0, 5.0))).to_rotation_matrix();
        let expected = Matrix3::new(0.0, 1.0, 0.0, -1.0, 0.0, 0.0, 0.0, 0.0, 1.0);
        assert!((axes.matrix() - expected).amax() < 1e-15, "{axes}");
    }
}

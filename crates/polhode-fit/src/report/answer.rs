//! A tensor in all its forms, and what a covariance of its coordinates means for them.

use nalgebra::{Matrix3, SMatrix, UnitQuaternion, Vector3};
use polhode::inertia::{Inertia, InertiaShape};

use crate::error::FitError;
use crate::physical::coordinates::{Coordinates, Form, eigen, entries_of_coordinates, pair, tensor};
use crate::physical::failure::SolverFailure;
use crate::solve::joint::factor;

/// A tensor of trace 1.
pub(crate) struct Answer {
    pub(crate) shape: InertiaShape,
    /// Ascending.
    pub(crate) moments: Vector3<f64>,
    /// Takes coordinates along the principal axes to those of the tensor.
    pub(crate) axes: UnitQuaternion<f64>,
    /// The principal axes.
    pub(crate) v: [Vector3<f64>; 3],
}

impl Answer {
    pub(crate) fn new(x: &Coordinates) -> Result<Answer, FitError> {
        let shape = shape_of(&tensor(x))?;
        let j = shape.tensor();
        let (moments, _) = eigen(j);
        let axes = Inertia::from_tensor(j).map_or(UnitQuaternion::identity(), |i| i.principal_axes());
        let v = core::array::from_fn(|k| axes * Vector3::ith(k, 1.0));
        Ok(Answer { shape, moments, axes, v })
    }
}

/// I₁/I₃ and I₂/I₃ with their standard deviations, by a factor of the covariance.
pub(crate) fn ratios(factor: &Form, v: &[Vector3<f64>; 3], moments: &Vector3<f64>) -> [(f64, f64); 2] {
    [0, 1].map(|k| {
        let slope = (pair(&v[k], &v[k]) - pair(&v[2], &v[2]) * (moments[k] / moments[2])) / moments[2];
        (moments[k] / moments[2], (factor.transpose() * slope).norm())
    })
}

/// I₁/I₃ and I₂/I₃ of any tensor, also one that no body has.
pub(crate) fn ratios_at(x: &Coordinates) -> [f64; 2] {
    let (moments, _) = eigen(tensor(x));
    [moments[0] / moments[2], moments[1] / moments[2]]
}

/// The same with their standard deviations; `covariance` is that of its coordinates.
pub(crate) fn ratios_of(x: &Coordinates, covariance: &Form) -> [(f64, f64); 2] {
    let (moments, axes) = eigen(tensor(x));
    ratios(&factor(covariance), &[0, 1, 2].map(|k| axes.column(k).into_owned()), &moments)
}

/// The covariance of the entries by a factor of that of the coordinates, so that no variance is negative.
pub(crate) fn of_entries(factor: &Form) -> SMatrix<f64, 6, 6> {
    let entries = entries_of_coordinates();
    (entries * factor) * (entries * factor).transpose()
}

/// Standard deviations of the principal moments, and of the turn about each principal axis.
pub(crate) fn sigmas(factor: &Form, v: &[Vector3<f64>; 3], moments: &Vector3<f64>) -> ([f64; 3], [f64; 3]) {
    let deviation = |g: Coordinates| (factor.transpose() * g).norm();
    let sigma_principal = core::array::from_fn(|k| deviation(pair(&v[k], &v[k])));
    let sigma_axes = core::array::from_fn(|k| {
        let (a, b) = ((k + 1) % 3, (k + 2) % 3);
        deviation(pair(&v[a], &v[b])) / (moments[a] - moments[b]).abs()
    });
    (sigma_principal, sigma_axes)
}

/// A tensor as a checked shape.
pub(crate) fn shape_of(j: &Matrix3<f64>) -> Result<InertiaShape, FitError> {
    InertiaShape::from_tensor(*j).map_err(|error| FitError::Solver(SolverFailure::Shape(error)))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::physical::coordinates::ENTRIES;

    /// The covariance of two entries is that of the readings of the tensor along their axes.
    #[test]
    fn entries_vary_as_the_readings_along_the_axes() {
        let factor = Form::from_fn(|i, k| 1e-3 / (1.0 + ((3 * i + 2 * k) % 5) as f64));
        let covariance = factor * factor.transpose();
        let found = of_entries(&factor);
        let reading = |k: usize| {
            let (a, b) = ENTRIES[k];
            pair(&Vector3::ith(a, 1.0), &Vector3::ith(b, 1.0))
        };
        for k in 0..6 {
            for l in 0..6 {
                let expected = reading(k).dot(&(covariance * reading(l)));
                assert!((found[(k, l)] - expected).abs() < 1e-12 * covariance.amax(), "{k} {l}");
            }
        }
        // the trace is 1 and does not vary
        assert!(found.fixed_view::<3, 3>(0, 0).sum().abs() < 1e-12 * covariance.amax());
    }
}

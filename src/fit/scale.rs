//! The absolute size of a tensor whose shape is known.

use nalgebra::{Matrix3, SMatrix, SVector, Vector3};

use super::coordinates::entries_of_coordinates;
use super::coordinates::{Coordinates, ENTRIES, Form, basis};
use super::record::Record;

/// A quantity that is known besides the motion, in SI units.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Known {
    /// The magnitude |L| of the angular momentum of every segment, kg m²/s.
    Momentum(f64),
    /// Twice the kinetic energy of every segment, kg m²/s².
    TwiceEnergy(f64),
    /// The moment about an axis (any non-zero vector in sensor axes), kg m².
    Moment {
        /// The axis.
        axis: Vector3<f64>,
        /// The moment, kg m².
        value: f64,
    },
    /// The trace of the tensor, kg m².
    Trace(f64),
}

impl Known {
    /// The given value.
    pub(super) fn value(self) -> f64 {
        match self {
            Known::Momentum(v) | Known::TwiceEnergy(v) | Known::Trace(v) | Known::Moment { value: v, .. } => {
                v
            }
        }
    }

    /// The trace of the tensor and its gradient with respect to the coordinates of the shape `j`, given the noise
    /// variance of the rates.
    pub(super) fn trace(self, record: &Record, j: &Matrix3<f64>, variance: f64) -> (f64, Coordinates) {
        let samples = record.samples() as f64;
        let rates = || record.segments.iter().flat_map(|s| &s.rates);
        match self {
            Known::Trace(value) => (value, Coordinates::zeros()),
            Known::Moment { axis, value } => {
                let n = axis.normalize();
                let share = n.dot(&(j * n));
                let slope = Coordinates::from_fn(|k, _| n.dot(&(basis(k) * n)));
                (value / share, slope * (-value / (share * share)))
            }
            Known::TwiceEnergy(value) => {
                // noise adds σ² tr J = σ² to the mean
                let energy = rates().map(|w| w.dot(&(j * w))).sum::<f64>() / samples - variance;
                let slope = Coordinates::from_fn(|k, _| {
                    rates().map(|w| w.dot(&(basis(k) * w))).sum::<f64>() / samples
                });
                (value / energy, slope * (-value / (energy * energy)))
            }
            Known::Momentum(value) => {
                let square = rates().map(|w| (j * w).norm_squared()).sum::<f64>() / samples
                    - variance * j.norm_squared();
                let size = square.sqrt();
                let slope = Coordinates::from_fn(|k, _| {
                    let b = basis(k);
                    rates().map(|w| (j * w).dot(&(b * w))).sum::<f64>() / samples - variance * j.dot(&b)
                });
                (value / size, slope * (-value / (size * square)))
            }
        }
    }
}

/// Covariance of the entries of trace × J.
pub(super) fn inertia_covariance(
    j: &Matrix3<f64>,
    covariance: &Form,
    trace: f64,
    slope: &Coordinates,
) -> SMatrix<f64, 6, 6> {
    let entries = SVector::<f64, 6>::from_fn(|k, _| j[ENTRIES[k]]);
    let map = entries_of_coordinates() * trace + entries * slope.transpose();
    map * covariance * map.transpose()
}

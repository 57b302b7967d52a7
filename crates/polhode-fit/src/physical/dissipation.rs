//! Drag takes energy: its coefficients are not negative, and a matrix of them has no negative eigenvalue.

use nalgebra::{DVector, Matrix3};

use crate::physical::constraint::Constraint;
use crate::physical::coordinates::{ENTRIES, eigen, symmetric};

/// A condition on coefficients of drag, by their places among the unknowns of the program.
#[derive(Clone, Debug)]
pub(crate) enum Dissipation {
    /// One coefficient that is not negative.
    Coefficient { place: usize, name: &'static str, segment: Option<usize> },
    /// The entries xx, yy, zz, xy, xz, yz of a positive semidefinite matrix.
    Matrix { places: [usize; 6], segment: Option<usize> },
}

impl Dissipation {
    pub(crate) fn constraint(&self) -> Constraint {
        match *self {
            Self::Coefficient { name, segment, .. } => Constraint::Drag { name, segment },
            Self::Matrix { segment, .. } => Constraint::DragMatrix { segment },
        }
    }

    fn matrix(places: &[usize; 6], z: &DVector<f64>) -> Matrix3<f64> {
        (0..6).fold(Matrix3::zeros(), |sum, k| sum + symmetric(k) * z[places[k]])
    }

    /// Whether unknowns obey it.
    pub(crate) fn allows(&self, z: &DVector<f64>) -> bool {
        match self {
            Self::Coefficient { place, .. } => z[*place] >= 0.0,
            Self::Matrix { places, .. } => eigen(Self::matrix(places, z)).0[0] >= 0.0,
        }
    }

    /// Takes off what rounding leaves below zero.
    pub(crate) fn clip(&self, z: &mut DVector<f64>) {
        match self {
            Self::Coefficient { place, .. } => z[*place] = z[*place].max(0.0),
            Self::Matrix { places, .. } => {
                let (values, axes) = eigen(Self::matrix(places, z));
                if values[0] < 0.0 {
                    let kept = Matrix3::from_diagonal(&values.map(|value| value.max(0.0)));
                    let matrix = axes * kept * axes.transpose();
                    places.iter().zip(ENTRIES).for_each(|(place, entry)| z[*place] = matrix[entry]);
                }
            }
        }
    }
}

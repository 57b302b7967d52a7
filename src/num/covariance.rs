//! Covariances of vectors.

use thiserror::Error;

use super::eigen::eigen;
use super::shown::Shown;

/// Rounding that a covariance may show, as a share of its variances: symmetry and signs are judged up to it.
const ROUNDING: f64 = 1e-12;

/// The covariance of a vector: a symmetric positive semidefinite matrix.
///
/// Kept as a factor F with C = F Fᵀ, whose columns are the principal axes times their standard deviations; they are those of
/// the matrix of correlations, so that units of the components do not matter.
#[derive(Clone, Debug, PartialEq)]
#[must_use]
pub struct Covariance<const N: usize> {
    columns: [[f64; N]; N],
}

impl<const N: usize> Covariance<N> {
    /// From the matrix. Eigenvalues that rounding has pushed below zero, by less than 1e-12 of the variances, count as zero.
    ///
    /// # Errors
    /// Entries that are not finite, a matrix that is not symmetric, and an eigenvalue below zero.
    ///
    /// ```
    /// use polhode::num::Covariance;
    /// let error = Covariance::new([[1.0, 2.0], [2.0, 1.0]]).unwrap_err();
    /// assert!(error.to_string().contains("eigenvalue -1"));
    /// ```
    pub fn new(matrix: [[f64; N]; N]) -> Result<Self, DistributionError> {
        finite(matrix.as_flattened())?;
        let deviations: [f64; N] = core::array::from_fn(|k| matrix[k][k].abs().sqrt());
        let over = |x: f64, deviation: f64| if deviation == 0.0 { x } else { x / deviation };
        let correlation = |i: usize, j: usize| over(over(matrix[i][j], deviations[i]), deviations[j]);
        let mut pairs = (0..N).flat_map(|i| (0..i).map(move |j| (j, i)));
        let differs = |(j, i): &(usize, usize)| (correlation(*i, *j) - correlation(*j, *i)).abs() > ROUNDING;
        if let Some((row, column)) = pairs.find(differs) {
            let (upper, lower) = (matrix[row][column], matrix[column][row]);
            return Err(DistributionError::NotSymmetric { row, column, upper, lower });
        }
        let mean = |i: usize, j: usize| 0.5 * (correlation(i, j) + correlation(j, i));
        let (values, axes) = eigen::<f64, N>(core::array::from_fn(|i| core::array::from_fn(|j| mean(i, j))));
        if values.iter().any(|value| *value < -ROUNDING * N as f64) {
            let own = core::array::from_fn(|i| core::array::from_fn(|j| matrix[i.min(j)][i.max(j)]));
            let (own, _) = eigen::<f64, N>(own);
            return Err(DistributionError::Negative { eigenvalue: own[0], of_correlations: values[0] });
        }
        let columns = core::array::from_fn(|k| {
            core::array::from_fn(|i| axes[k][i] * values[k].max(0.0).sqrt() * deviations[i])
        });
        Ok(Self { columns })
    }

    /// Of independent components with these standard deviations.
    ///
    /// # Errors
    /// A standard deviation that is negative or not finite.
    pub fn independent(deviations: [f64; N]) -> Result<Self, DistributionError> {
        finite(&deviations)?;
        if let Some(&value) = deviations.iter().find(|deviation| **deviation < 0.0) {
            return Err(DistributionError::NegativeDeviation { value });
        }
        let entry = |k: usize, i: usize| if i == k { deviations[k] } else { 0.0 };
        Ok(Self { columns: core::array::from_fn(|k| core::array::from_fn(|i| entry(k, i))) })
    }

    /// Of a vector that is known exactly.
    pub fn zero() -> Self {
        Self { columns: [[0.0; N]; N] }
    }

    /// From displacements, the sum of whose squares x xᵀ it is.
    #[cfg(any(test, feature = "random"))]
    pub(crate) fn of_deviations(columns: [[f64; N]; N]) -> Self {
        Self { columns }
    }

    /// Displacements by one standard deviation along the principal axes: the sum of their squares x xᵀ is the matrix.
    #[must_use]
    pub fn deviations(&self) -> [[f64; N]; N] {
        self.columns
    }
}

#[cfg(any(test, feature = "random"))]
impl Covariance<12> {
    /// Of three vectors that are independent of each other, one after the other.
    pub(crate) fn of_parts(first: &Covariance<3>, second: &Covariance<3>, third: &Covariance<6>) -> Self {
        let mut columns = [[0.0; 12]; 12];
        for k in 0..3 {
            columns[k][..3].copy_from_slice(&first.columns[k]);
            columns[3 + k][3..6].copy_from_slice(&second.columns[k]);
        }
        for k in 0..6 {
            columns[6 + k][6..].copy_from_slice(&third.columns[k]);
        }
        Self { columns }
    }
}

pub(super) fn finite(values: &[f64]) -> Result<(), DistributionError> {
    match values.iter().find(|value| !value.is_finite()) {
        Some(&value) => Err(DistributionError::NotFinite { value }),
        None => Ok(()),
    }
}

/// Why nothing can be drawn from a distribution.
#[derive(Clone, Debug, PartialEq, Error)]
#[non_exhaustive]
pub enum DistributionError {
    /// A number is not finite.
    #[error("has the entry {value}; every entry must be a finite number")]
    NotFinite {
        /// The offending value.
        value: f64,
    },
    /// The covariance is not symmetric.
    #[error(
        "is not symmetric: {} in row {}, column {} and {} across the diagonal; cov(x, y) = cov(y, x)",
        Shown(*upper), row + 1, column + 1, Shown(*lower)
    )]
    NotSymmetric {
        /// Row of the entry above the diagonal, from 0.
        row: usize,
        /// Its column, from 0.
        column: usize,
        /// The entry above the diagonal.
        upper: f64,
        /// The entry below it.
        lower: f64,
    },
    /// The covariance is not positive semidefinite.
    #[error(
        "is not positive semidefinite: it has the eigenvalue {} ({} for its matrix of correlations), and a variance cannot be negative",
        Shown(*eigenvalue), Shown(*of_correlations)
    )]
    Negative {
        /// Its smallest eigenvalue.
        eigenvalue: f64,
        /// The same of the matrix of correlations, which is free of units.
        of_correlations: f64,
    },
    /// A standard deviation is negative.
    #[error("has the standard deviation {}; it must be 0 or more", Shown(*value))]
    NegativeDeviation {
        /// The offending value.
        value: f64,
    },
    /// The ends of a range stand the wrong way round.
    #[error("has the range from {} to {} for component {}; give the lower end first", Shown(*low), Shown(*high), component + 1)]
    Reversed {
        /// Of which component, from 0.
        component: usize,
        /// The end that came first.
        low: f64,
        /// The end that came second.
        high: f64,
    },
}

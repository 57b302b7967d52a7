//! Distributions of vectors, to draw from. Needs the feature `random`.

use thiserror::Error;

use super::Random;
use super::eigen::eigen;
use super::shown::Shown;

/// Rounding that a covariance may show, as a share of its variances: symmetry and signs are judged up to it.
const ROUNDING: f64 = 1e-12;

/// A distribution of vectors of `N` components.
///
/// ```
/// use polhode::num::{Covariance, Distribution, Random};
/// let covariance = Covariance::new([[4.0, 1.9], [1.9, 1.0]])?;
/// let pair = Distribution::Normal { mean: [10.0, 0.0], covariance };
/// let [x, y] = pair.draw(&mut Random::new(1));
/// assert!((x - 10.0).abs() < 12.0 && y.abs() < 6.0);
/// let inside = Distribution::uniform([[0.5, 1.5], [-1.0, -1.0]])?;
/// assert_eq!(inside.draw(&mut Random::new(1))[1], -1.0);
/// # Ok::<(), polhode::num::DistributionError>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub enum Distribution<const N: usize> {
    /// Always the same vector.
    Fixed([f64; N]),
    /// The normal distribution.
    Normal {
        /// Mean.
        mean: [f64; N],
        /// Covariance.
        covariance: Covariance<N>,
    },
    /// Uniform in a box; `[low, high]` of each component.
    Uniform([[f64; 2]; N]),
}

impl<const N: usize> Distribution<N> {
    /// Uniform in the box between `[low, high]` of each component; the two may be equal.
    ///
    /// # Errors
    /// Ends that are not finite or stand the wrong way round.
    pub fn uniform(ranges: [[f64; 2]; N]) -> Result<Self, DistributionError> {
        for (component, [low, high]) in ranges.into_iter().enumerate() {
            finite(&[low, high, high - low])?;
            if low > high {
                return Err(DistributionError::Reversed { component, low, high });
            }
        }
        Ok(Self::Uniform(ranges))
    }

    /// The next vector of `random`. A fixed one takes no numbers of it, a uniform one `N`.
    pub fn draw(&self, random: &mut Random) -> [f64; N] {
        match self {
            Self::Fixed(value) => *value,
            Self::Normal { mean, covariance } => {
                let deviation = covariance.draw(random);
                core::array::from_fn(|k| mean[k] + deviation[k])
            }
            Self::Uniform(ranges) => {
                ranges.map(|[low, high]| if low == high { low } else { random.between(low, high) })
            }
        }
    }
}

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

    /// A vector with mean zero, from the next `N` normal numbers of `random`.
    pub fn draw(&self, random: &mut Random) -> [f64; N] {
        let mut sum = [0.0; N];
        for column in &self.columns {
            let deviate = random.normal();
            for (sum, entry) in sum.iter_mut().zip(column) {
                *sum += deviate * entry;
            }
        }
        sum
    }
}

fn finite(values: &[f64]) -> Result<(), DistributionError> {
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
        "is not positive semidefinite: it has the eigenvalue {} ({} of its correlations), and a variance cannot be negative",
        Shown(*eigenvalue), Shown(*of_correlations)
    )]
    Negative {
        /// Its smallest eigenvalue.
        eigenvalue: f64,
        /// The same of the matrix of correlations, which is free of units.
        of_correlations: f64,
    },
    /// A standard deviation is negative.
    #[error("has the standard deviation {}, and none is negative", Shown(*value))]
    NegativeDeviation {
        /// The offending value.
        value: f64,
    },
    /// The ends of a range stand the wrong way round.
    #[error("has the range from {} to {} of component {}; the lower end comes first", Shown(*low), Shown(*high), component + 1)]
    Reversed {
        /// Of which component, from 0.
        component: usize,
        /// The end that came first.
        low: f64,
        /// The end that came second.
        high: f64,
    },
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn draws_have_the_covariance() {
        const COUNT: usize = 40_000;
        // a full one, one of rank 1, and one in units far apart
        for matrix in [
            [[2.0, -0.6, 0.3], [-0.6, 1.0, 0.2], [0.3, 0.2, 0.5]],
            [[1.0, 2.0, -1.0], [2.0, 4.0, -2.0], [-1.0, -2.0, 1.0]],
            [[1e60, 5e29, 0.0], [5e29, 1.0, 1e-31], [0.0, 1e-31, 1e-60]],
        ] {
            let covariance = Covariance::new(matrix).unwrap();
            let mut random = Random::new(7);
            let mut sum = [[0.0; 3]; 3];
            for _ in 0..COUNT {
                let x = covariance.draw(&mut random);
                for (i, row) in sum.iter_mut().enumerate() {
                    row.iter_mut().zip(x).for_each(|(sum, other)| *sum += x[i] * other / COUNT as f64);
                }
            }
            for (i, j) in (0..9).map(|k| (k / 3, k % 3)) {
                // five standard deviations of a product of two normal numbers
                let width = 5.0 * (2.0 * matrix[i][i] * matrix[j][j] / COUNT as f64).sqrt();
                assert!((sum[i][j] - matrix[i][j]).abs() < width, "{matrix:?}: {sum:?}");
            }
        }
    }

    #[test]
    fn what_is_no_covariance_is_refused_by_the_law_that_it_breaks() {
        let refused = |matrix: [[f64; 2]; 2]| Covariance::new(matrix).unwrap_err();
        assert_eq!(
            refused([[1.0, 2.0], [2.0, 1.0]]),
            DistributionError::Negative { eigenvalue: -1.0, of_correlations: -1.0 }
        );
        // 1 of its own, 2 and -1 between: the variance of the second is zero
        assert!(
            matches!(refused([[1.0, 0.5], [0.5, 0.0]]), DistributionError::Negative { eigenvalue, .. } if eigenvalue < 0.0)
        );
        assert!(matches!(
            refused([[-1.0, 0.0], [0.0, 1.0]]),
            DistributionError::Negative { eigenvalue: -1.0, .. }
        ));
        assert!(matches!(
            refused([[1.0, 0.1], [0.2, 1.0]]),
            DistributionError::NotSymmetric { row: 0, column: 1, .. }
        ));
        assert!(matches!(refused([[1.0, f64::NAN], [0.2, 1.0]]), DistributionError::NotFinite { .. }));
        assert!(Covariance::new([[1.0, 1.0], [1.0, 1.0]]).is_ok() && Covariance::new([[0.0; 2]; 2]).is_ok());
        assert!(Distribution::uniform([[1.0, 0.0]]).is_err() && Covariance::independent([-1.0]).is_err());
    }

    #[test]
    fn a_uniform_vector_stays_in_its_box_and_fills_it() {
        let ranges = [[-1.0, 2.0], [5.0, 5.0]];
        let drawn = Distribution::uniform(ranges).unwrap();
        let mut random = Random::new(3);
        let values: Vec<f64> = (0..10_000).map(|_| drawn.draw(&mut random)[0]).collect();
        let (least, most) = values.iter().fold((2.0, -1.0), |(a, b): (f64, f64), x| (a.min(*x), b.max(*x)));
        assert!((-1.0..-0.99).contains(&least) && most > 1.99 && most < 2.0);
    }
}

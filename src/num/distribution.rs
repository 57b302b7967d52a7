//! Distributions of vectors, to draw from. Needs the feature `random`.

use super::Random;
use super::covariance::{Covariance, DistributionError, finite};

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

    /// The mean.
    #[must_use]
    pub fn mean(&self) -> [f64; N] {
        match self {
            Self::Fixed(mean) | Self::Normal { mean, .. } => *mean,
            Self::Uniform(ranges) => ranges.map(|[low, high]| low + 0.5 * (high - low)),
        }
    }

    /// The covariance.
    pub fn covariance(&self) -> Covariance<N> {
        match self {
            Self::Fixed(_) => Covariance::zero(),
            Self::Normal { covariance, .. } => covariance.clone(),
            Self::Uniform(ranges) => {
                let deviation = |k: usize| (ranges[k][1] - ranges[k][0]) / 12_f64.sqrt();
                let entry = |k: usize, i: usize| if i == k { deviation(k) } else { 0.0 };
                Covariance::of_deviations(core::array::from_fn(|k| core::array::from_fn(|i| entry(k, i))))
            }
        }
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

impl<const N: usize> Covariance<N> {
    /// A vector with mean zero, from the next `N` normal numbers of `random`.
    pub fn draw(&self, random: &mut Random) -> [f64; N] {
        let mut sum = [0.0; N];
        for column in &self.deviations() {
            let deviate = random.normal();
            for (sum, entry) in sum.iter_mut().zip(column) {
                *sum += deviate * entry;
            }
        }
        sum
    }
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

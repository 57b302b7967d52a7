//! Whether the motion is torque-free, and the noise white.

use crate::thresholds::trend::SIGNIFICANT;
use nalgebra::Matrix3;

use crate::signal::stretch::Stretch;

/// Relative change per second of a quantity that a free body keeps.
#[non_exhaustive]
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct InvariantTrend {
    /// Relative rate, 1/s; negative where the quantity decreases.
    pub rate: f64,
    /// Its standard deviation from the noise of the rates, 1/s.
    pub sigma: f64,
}

impl InvariantTrend {
    /// Whether it exceeds five standard deviations.
    pub fn significant(self) -> bool {
        self.rate.abs() > SIGNIFICANT * self.sigma
    }
}

/// Correlation between neighbouring whitened residuals; zero on average where the noise is white and the model right.
#[non_exhaustive]
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Whiteness {
    /// Correlation at lag 1, between −1 and 1.
    pub correlation: f64,
    /// Its standard deviation under white noise.
    pub sigma: f64,
}

impl Whiteness {
    /// Of residuals with three components per test, test after test.
    pub(crate) fn new<'a>(residuals: impl Iterator<Item = &'a [f64]>) -> Self {
        let (mut product, mut square, mut pairs) = (0.0, 0.0, 0.0);
        for e in residuals {
            square += e.iter().map(|e| e * e).sum::<f64>();
            product += e.iter().zip(e.iter().skip(3)).map(|(a, b)| a * b).sum::<f64>();
            pairs += e.len().saturating_sub(3) as f64;
        }
        let correlation = if square > 0.0 { product / square } else { 0.0 };
        Whiteness { correlation, sigma: 1.0 / f64::max(pairs, 1.0).sqrt() }
    }

    /// Whether it exceeds five standard deviations of white noise.
    pub fn significant(self) -> bool {
        self.correlation.abs() > SIGNIFICANT * self.sigma
    }
}

/// Trends of |J ω| and of ω·J ω: slopes of their squares against time about each stretch's own mean.
///
/// Each sample of |J ω|² has the variance 4 σ² |J² ω|², of ω·J ω the variance 4 σ² |J ω|²; the noise adds a constant to
/// both means, which no slope sees.
pub(crate) fn trends(
    stretches: &[Stretch],
    j: &Matrix3<f64>,
    variance: f64,
) -> (InvariantTrend, InvariantTrend) {
    let jj = j * j;
    let momentum = slope(stretches, |w| (w.dot(&(jj * w)), 4.0 * variance * (jj * w).norm_squared()));
    let energy = slope(stretches, |w| (w.dot(&(j * w)), 4.0 * variance * (j * w).norm_squared()));
    // |Jω| changes half as fast as its square
    (InvariantTrend { rate: 0.5 * momentum.rate, sigma: 0.5 * momentum.sigma }, energy)
}

fn slope(stretches: &[Stretch], reading: impl Fn(&nalgebra::Vector3<f64>) -> (f64, f64)) -> InvariantTrend {
    let (mut numerator, mut denominator, mut noise) = (0.0, 0.0, 0.0);
    for s in stretches.iter().filter(|s| s.times.len() > 2) {
        let n = s.times.len() as f64;
        let middle = s.times.iter().sum::<f64>() / n;
        let values: Vec<(f64, f64)> = s.rates.iter().map(&reading).collect();
        let mean = values.iter().map(|v| v.0).sum::<f64>() / n;
        let spread = values.iter().map(|v| v.1).sum::<f64>() / n;
        if !(mean > 0.0 && spread > 0.0) {
            continue;
        }
        let weight = mean / spread;
        for (t, (value, variance)) in s.times.iter().zip(&values) {
            let u = t - middle;
            numerator += weight * u * (value - mean);
            denominator += weight * mean * u * u;
            noise += weight * weight * u * u * variance;
        }
    }
    if denominator > 0.0 {
        InvariantTrend { rate: numerator / denominator, sigma: noise.sqrt() / denominator }
    } else {
        InvariantTrend { rate: 0.0, sigma: f64::MAX }
    }
}

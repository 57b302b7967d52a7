//! Whether the motion is torque-free, and the noise white.

use crate::report::estimate::Residuals;
use crate::report::parts::quantile;
use crate::thresholds::trend::{BLOW, MEMORY, SIGNIFICANT};
use nalgebra::{Matrix3, Vector3};

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

/// Correlations of whitened residuals with those within one turn of the body after them: what acts on the body is no white noise.
#[non_exhaustive]
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Memory {
    /// Sum of their squares in standard deviations, each component with each: χ² where the noise is white and the model right.
    pub chi2: f64,
    /// Its degrees of freedom.
    pub dof: usize,
}

/// The memory of residuals, where it is more than chance brings.
///
/// Source: J. R. M. Hosking, J. Am. Stat. Assoc. 75 (1980) 602.
pub(crate) fn memory(residuals: &[Residuals], lags: usize) -> Option<Memory> {
    let squares: f64 = residuals.iter().flat_map(|r| r.values.as_flattened()).map(|v| v * v).sum();
    let count = residuals.iter().map(|r| r.values.len()).sum::<usize>();
    let square = squares / (3 * count) as f64;
    let mut chi2 = 0.0;
    for lag in 1..=lags {
        let (mut product, mut pairs) = (Matrix3::zeros(), 0.0);
        for r in residuals {
            for (a, b) in r.values.iter().zip(r.values.iter().skip(lag)) {
                product += Vector3::from(*a) * Vector3::from(*b).transpose();
                pairs += 1.0;
            }
        }
        chi2 += product.norm_squared() / (square * square * f64::max(pairs, 1.0));
    }
    let found = Memory { chi2, dof: 9 * lags };
    (lags > 0 && chi2 > quantile(found.dof as f64, MEMORY)).then_some(found)
}

/// The place whose residual stands farthest out of the noise.
#[non_exhaustive]
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Blow {
    /// Index of the segment in the record.
    pub segment: usize,
    /// When it was, s.
    pub time: f64,
    /// The length of the residual, in standard deviations of a component.
    pub deviations: f64,
}

/// The largest residual, where noise makes one as large in less than one record of a million; `misfit` is the mean square of all.
///
/// The square of the length of three normal numbers exceeds s with a chance of erfc √(s/2) + √(2 s/π) exp(−s/2).
pub(crate) fn blow(residuals: &[Residuals], misfit: f64) -> Option<Blow> {
    let noise = misfit.max(1.0).sqrt();
    let of = |r: &Residuals| {
        let each = r.times.iter().zip(&r.values);
        let blow = |(time, value): (&f64, &[f64; 3])| Blow {
            segment: r.segment,
            time: *time,
            deviations: Vector3::from(*value).norm() / noise,
        };
        each.map(blow).collect::<Vec<_>>()
    };
    let all: Vec<Blow> = residuals.iter().flat_map(of).collect();
    let largest = all.iter().max_by(|a, b| a.deviations.total_cmp(&b.deviations))?;
    let half = 0.5 * largest.deviations * largest.deviations;
    let chance = libm::erfc(half.sqrt()) + core::f64::consts::FRAC_2_SQRT_PI * half.sqrt() * libm::exp(-half);
    (all.len() as f64 * chance < BLOW).then_some(*largest)
}

/// Trends of |J ω| and of ω·J ω: slopes of their squares against time about each stretch's own mean, ω being the `rate` of a reading. `torque` is the
/// spectral density of the torque noise of each stretch, by its number.
///
/// Each sample of |J ω|² has the variance 4 σ² |J² ω|², of ω·J ω the variance 4 σ² |J ω|²; the noise adds a constant to
/// both means, which no slope sees. White torque noise of density S lets them walk at random, by 4 (J ω)·S J ω and 4 ω·S ω a unit
/// of time.
pub(crate) fn trends(
    stretches: &[Stretch],
    rate: impl Fn(&Vector3<f64>) -> Vector3<f64>,
    j: &Matrix3<f64>,
    variance: f64,
    torque: impl Fn(usize) -> Matrix3<f64>,
) -> (InvariantTrend, InvariantTrend) {
    let jj = j * j;
    let momentum = slope(stretches, &rate, &torque, |w, s| Reading {
        value: w.dot(&(jj * w)),
        variance: 4.0 * variance * (jj * w).norm_squared(),
        walk: 4.0 * (j * w).dot(&(s * j * w)),
    });
    let energy = slope(stretches, &rate, &torque, |w, s| Reading {
        value: w.dot(&(j * w)),
        variance: 4.0 * variance * (j * w).norm_squared(),
        walk: 4.0 * w.dot(&(s * w)),
    });
    // |Jω| changes half as fast as its square
    (InvariantTrend { rate: 0.5 * momentum.rate, sigma: 0.5 * momentum.sigma }, energy)
}

/// A quantity at one sample.
struct Reading {
    value: f64,
    /// Its variance by the noise of the rates.
    variance: f64,
    /// By how much the variance of the quantity itself grows a unit of time.
    walk: f64,
}

fn slope(
    stretches: &[Stretch],
    rate: impl Fn(&Vector3<f64>) -> Vector3<f64>,
    torque: impl Fn(usize) -> Matrix3<f64>,
    reading: impl Fn(&Vector3<f64>, &Matrix3<f64>) -> Reading,
) -> InvariantTrend {
    let (mut numerator, mut denominator, mut noise) = (0.0, 0.0, 0.0);
    for (k, s) in stretches.iter().enumerate().filter(|(_, s)| s.times.len() > 2) {
        let n = s.times.len() as f64;
        let density = torque(k);
        let middle = s.times.iter().sum::<f64>() / n;
        let values: Vec<Reading> = s.rates.iter().map(|w| reading(&rate(w), &density)).collect();
        let mean = values.iter().map(|v| v.value).sum::<f64>() / n;
        let spread = values.iter().map(|v| v.variance).sum::<f64>() / n;
        let walk = values.iter().map(|v| v.walk).sum::<f64>() / n;
        if !(mean > 0.0 && spread > 0.0) {
            continue;
        }
        // a straight line through a walk of rate D over a time T has a slope of variance 6 D/(5 T), through noise 12 σ²/(n T²)
        let by_walk = walk * s.duration() * n / 10.0;
        let weight = mean / (spread + by_walk);
        let mut later: f64 = s.times.iter().map(|t| weight * (t - middle)).sum();
        let mut before = middle;
        for (t, v) in s.times.iter().zip(&values) {
            let u = t - middle;
            // what the walk gains from one sample to the next stays in all later ones
            noise += later * later * walk * (t - before).max(0.0);
            before = *t;
            later -= weight * u;
            numerator += weight * u * (v.value - mean);
            denominator += weight * mean * u * u;
            noise += weight * weight * u * u * v.variance;
        }
    }
    if denominator > 0.0 {
        InvariantTrend { rate: numerator / denominator, sigma: noise.sqrt() / denominator }
    } else {
        InvariantTrend { rate: 0.0, sigma: f64::MAX }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_trend_is_significant_beyond_five_deviations_of_either_sign() {
        let significant = |rate| InvariantTrend { rate, sigma: 0.1 }.significant();
        assert!([0.51, -0.51].into_iter().all(significant));
        assert!(![0.49, -0.49, 0.0].into_iter().any(significant));
    }

    /// The largest residual is a blow beyond the square that chi squared of three degrees of freedom exceeds once in a million times, over the
    /// number of places: 30.665 of one place, 40.130 of a hundred; times the misfit where that exceeds 1.
    #[test]
    fn a_blow_is_what_noise_brings_in_no_record() {
        let of = |count: usize, square: f64, misfit: f64| {
            let size = (square / 3.0).sqrt();
            let mut values = vec![[1.0, -1.0, 0.5]; count];
            values[count / 2] = [size, -size, size];
            let times = (0..count).map(|k| 0.5 * k as f64).collect();
            blow(&[Residuals { segment: 4, times, values, mean_square: 1.0 }], misfit)
        };
        for (count, square) in [(1, 30.664_85), (100, 40.13)] {
            for misfit in [0.5, 1.0, 4.0] {
                let most = square * f64::max(misfit, 1.0);
                assert_eq!(of(count, 0.999 * most, misfit), None);
                let found = of(count, 1.001 * most, misfit).unwrap();
                assert!((found.deviations / (1.001 * square).sqrt() - 1.0).abs() < 1e-12, "{found:?}");
                assert_eq!((found.segment, found.time), (4, 0.5 * (count / 2) as f64));
            }
        }
        assert_eq!(blow(&[], 1.0), None);
    }

    /// Where |ω|² is a straight line in time, energy changes by its slope and momentum by half of that, with the deviations that the noise
    /// of each sample and the walk by torque noise make: by their double sums.
    #[test]
    fn a_straight_line_has_its_slope_and_its_deviation() {
        let n = Vector3::new(0.6, -0.4, 0.5);
        let j = Matrix3::new(0.2, 0.01, -0.02, 0.01, 0.35, 0.03, -0.02, 0.03, 0.45);
        let density = Matrix3::new(3.0, 1.0, 0.0, 1.0, 2.0, 0.5, 0.0, 0.5, 1.0) * 1e-3;
        let times: Vec<f64> = (0..21).map(f64::from).collect();
        let rates = times.iter().map(|t| n * (1.0 + 0.02 * (t - 10.0)).sqrt()).collect();
        let s = Stretch::new(times.clone(), rates);
        let squares: f64 = times.iter().map(|t| (t - 10.0) * (t - 10.0)).sum();
        let pairs = times.iter().flat_map(|a| times.iter().map(move |b| (a - 10.0) * (b - 10.0) * a.min(*b)));
        let walk: f64 = pairs.sum();
        let of = |value: f64, lever: Vector3<f64>, growth: Vector3<f64>| {
            let growth = 4.0 * growth.dot(&(density * growth));
            (4e-4 * lever.norm_squared() * squares + growth * walk).sqrt() / (value * squares)
        };
        let (momentum, energy) = trends(core::slice::from_ref(&s), Clone::clone, &j, 1e-4, |_| density);
        let jn = j * n;
        let of_momentum = 0.5 * of(jn.norm_squared(), j * jn, jn);
        for (found, rate, sigma) in [(momentum, 0.01, of_momentum), (energy, 0.02, of(n.dot(&jn), jn, n))] {
            assert!((found.rate - rate).abs() < 1e-12, "{found:?} {rate}");
            assert!((found.sigma / sigma - 1.0).abs() < 1e-9, "{found:?} {sigma:e}");
        }
        // the same twice beside two samples, of which no slope is told; and twice as fast
        let short = Stretch::new(vec![0.0, 1.0], vec![n, n * 2.0]);
        let (_, twice) = trends(&[s.clone(), short, s.clone()], Clone::clone, &j, 1e-4, |_| density);
        assert!((twice.rate - 0.02).abs() < 1e-12);
        assert!((twice.sigma * 2.0_f64.sqrt() / energy.sigma - 1.0).abs() < 1e-9);
        let (_, fast) = trends(&[s], |w| w * 2.0, &j, 1e-4, |_| density);
        assert!((fast.rate - 0.02).abs() < 1e-12 && (fast.sigma * 2.0 / energy.sigma - 1.0).abs() < 1e-9);
    }

    /// Residuals without a neighbour, or all zero, have no correlation; of either sign it is significant beyond five deviations.
    #[test]
    fn a_correlation_needs_neighbours() {
        for few in [&[][..], &[1.0, 2.0, 3.0], &[0.0, 0.0, 0.0]] {
            let found = Whiteness::new([few].into_iter());
            assert_eq!(found, Whiteness { correlation: 0.0, sigma: 1.0 });
        }
        // (1 · 2 + 1 · 3)/(1 + 4 + 1 + 9)
        let found = Whiteness::new([&[1.0, 0.0, 0.0, 2.0][..], &[0.0, 1.0, 0.0, 0.0, 3.0]].into_iter());
        assert!((found.correlation - 5.0 / 15.0).abs() < 1e-15, "{found:?}");
        assert!((found.sigma - 1.0 / 3.0_f64.sqrt()).abs() < 1e-15, "{found:?}");
        let significant = |correlation| Whiteness { correlation, sigma: 0.1 }.significant();
        assert!(significant(0.51) && significant(-0.51) && !significant(0.49) && !significant(-0.49));
    }
}

//! Sums of a record over test functions, and their products weighted with the noise of the rates and of torques.

use nalgebra::{SMatrix, Vector3};

use crate::physical::coordinates::ENTRIES;
use crate::signal::banded::Banded;
use crate::signal::stretch::Stretch;
use crate::signal::test_functions::{Seen, TestFunctions};
use crate::solve::radius::{longest, pilot};
use crate::thresholds::radius::ROOM;
use crate::thresholds::test_functions::{ROUNDED, SAMPLES_PER_TEST};
use crate::thresholds::units::{RADII, SAMPLES, TORQUES};

/// ∫ φ ω' (three), the entries of ∫ φ ω ωᵀ (six), ∫ φ ω (three) and ∫ φ.
pub(super) const FEATURES: usize = 13;
/// Products of these, summed over the test functions.
pub(super) type Gram = SMatrix<f64, FEATURES, FEATURES>;

/// The sums of one stretch.
struct Own {
    tests: TestFunctions,
    /// Row by row.
    features: Vec<f64>,
    /// Covariance of one component of ∫ φ ω' by the noise of the rates, per its variance.
    noise: Banded,
}

impl Own {
    fn new(stretch: &Stretch, radius: f64) -> Option<Own> {
        let tests = TestFunctions::new(stretch, radius)?;
        let mut features = vec![0.0; tests.count * FEATURES];
        let mut noise = Banded::zeros(tests.count, tests.reach);
        for ((&t, w), &weight) in stretch.times.iter().zip(&stretch.rates).zip(&stretch.weights) {
            let products = ENTRIES.map(|(a, b)| w[a] * w[b]);
            let seen = Seen::new(&tests, t);
            for (m, slope, value) in seen.each() {
                let row = &mut features[m * FEATURES..][..FEATURES];
                let (slope, value) = (weight * slope, weight * value);
                (0..3).for_each(|p| row[p] -= slope * w[p]);
                (0..6).for_each(|p| row[3 + p] += value * products[p]);
                (0..3).for_each(|p| row[9 + p] += value * w[p]);
                row[12] += value;
                for (n, other, _) in seen.each().skip(m - seen.first).take(tests.reach + 1) {
                    noise.add(n, m, slope * weight * other);
                }
            }
        }
        Some(Own { tests, features, noise })
    }
}

/// The sums of all stretches, at one half width of the test functions.
pub(super) struct Sums {
    own: Vec<Own>,
    /// Σ |∫ φ ω'|².
    slopes: f64,
    /// Mean variance of a component of ∫ φ ω' by the noise of the rates, per its variance.
    noise: f64,
    count: usize,
}

/// Products at one ratio of torque noise to noise of the rates.
pub(super) struct Weighted {
    pub(super) gram: Gram,
    /// log |C| of all components.
    pub(super) log_determinant: f64,
}

impl Sums {
    fn new(stretches: &[Stretch], radius: f64) -> Option<Sums> {
        let own: Vec<Own> = stretches.iter().filter_map(|s| Own::new(s, radius)).collect();
        let count = own.iter().map(|own| own.tests.count).sum::<usize>();
        let rows = own.iter().flat_map(|own| own.features.chunks_exact(FEATURES));
        let slopes = rows.map(|row| Vector3::from_column_slice(&row[..3]).norm_squared()).sum::<f64>();
        let noise = own.iter().flat_map(|own| (0..own.tests.count).map(|m| own.noise.get(m, m))).sum::<f64>()
            / count.max(1) as f64;
        (count > 0 && noise > 0.0).then_some(Sums { own, slopes, noise, count })
    }

    /// At half the width at which the changes of the rates stand out of their noise most: there, the test functions are about as
    /// long as the changes last, in whatever units.
    pub(super) fn of(stretches: &[Stretch]) -> Option<Sums> {
        let samples: usize = stretches.iter().map(|s| s.times.len()).sum();
        let longest_stretch = stretches.iter().map(Stretch::duration).fold(0.0, f64::max);
        let duration: f64 = stretches.iter().map(Stretch::duration).sum();
        let lowest = 0.5 * SAMPLES_PER_TEST * duration / samples as f64 * (1.0 + ROUNDED);
        let radii = core::iter::successors(Some(lowest), |r| Some(2.0 * r));
        let radii = radii.take(RADII).take_while(|r| *r == lowest || ROOM * r <= longest_stretch);
        let part = longest(stretches, SAMPLES);
        // the number of independent sums falls with their width, as their count does
        let clear =
            |&radius: &f64| Some((radius, Sums::new(&part, radius).map(|sums| sums.slopes / sums.noise)?));
        let all: Vec<(f64, f64)> = radii.filter_map(|radius| clear(&radius)).collect();
        let best = (0..all.len()).max_by(|&a, &b| all[a].1.total_cmp(&all[b].1))?;
        Sums::new(&pilot(stretches), all[best.saturating_sub(1)].0)
    }

    /// Components of all sums.
    pub(super) fn rows(&self) -> usize {
        3 * self.count
    }

    /// Σ |∫ φ ω'|², and Σ |∫ φ |ω|²|².
    pub(super) fn sizes(&self) -> [f64; 2] {
        let rows = self.own.iter().flat_map(|own| own.features.chunks_exact(FEATURES));
        let squares = rows.map(|row| {
            let square: f64 = row[3..6].iter().sum();
            square * square
        });
        [self.slopes, squares.sum()]
    }

    /// Share of Σ |∫ φ ω'|² that noise of this variance accounts for.
    pub(super) fn noise_share(&self, variance: f64) -> f64 {
        variance * self.noise * self.rows() as f64 / self.slopes
    }

    /// Products without weights.
    pub(super) fn plain(&self) -> Gram {
        let mut gram = Gram::zeros();
        self.own.iter().for_each(|own| add_products(&mut gram, &own.features));
        gram
    }

    /// Products weighted with noise of the rates alone, and with more and more torque noise beside it.
    pub(super) fn weighted(&self) -> Vec<Weighted> {
        let ratios = core::iter::once(0.0).chain(TORQUES);
        ratios.filter_map(|ratio| self.weighted_with(ratio)).collect()
    }

    fn weighted_with(&self, ratio: f64) -> Option<Weighted> {
        let mut weighted = Weighted { gram: Gram::zeros(), log_determinant: 0.0 };
        for own in &self.own {
            let mut factor = own.noise.clone();
            let overlaps = own.tests.overlaps();
            let torque = ratio * self.noise / overlaps.first()?;
            for m in 0..own.tests.count {
                for (apart, overlap) in overlaps.iter().enumerate().take(own.tests.count - m) {
                    factor.add(m + apart, m, torque * overlap);
                }
            }
            if !factor.factor() {
                return None;
            }
            let mut features = own.features.clone();
            factor.forward(&mut features, FEATURES);
            add_products(&mut weighted.gram, &features);
            weighted.log_determinant += 3.0 * factor.log_determinant();
        }
        Some(weighted)
    }
}

fn add_products(gram: &mut Gram, features: &[f64]) {
    for row in features.chunks_exact(FEATURES) {
        for i in 0..FEATURES {
            for k in 0..=i {
                gram[(i, k)] += row[i] * row[k];
            }
        }
    }
    gram.fill_upper_triangle_with_lower_triangle();
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::DMatrix;
    use polhode::num::Random;

    /// Products weighted by the covariance of the slopes of noise and of the overlaps of torque noise, with its determinant.
    #[test]
    fn weighted_products_are_those_of_the_dense_covariance() {
        let mut random = Random::new(3);
        let times: Vec<f64> = (0..200).map(|k| 0.1 * f64::from(k)).collect();
        let rates = times.iter().map(|_| random.normal_vector()).collect();
        let stretch = Stretch::new(times, rates);
        let sums = Sums::new(core::slice::from_ref(&stretch), 1.0).unwrap();
        let own = &sums.own[0];
        let count = own.tests.count;
        let (mut noise, mut slopes) = (DMatrix::<f64>::zeros(count, count), vec![Vector3::zeros(); count]);
        for ((t, w), weight) in stretch.times.iter().zip(&stretch.rates).zip(&stretch.weights) {
            let seen: Vec<(usize, f64, f64)> = Seen::new(&own.tests, *t).each().collect();
            for (m, a, _) in &seen {
                slopes[*m] -= w * (a * weight);
                seen.iter().for_each(|(n, b, _)| noise[(*m, *n)] += a * b * weight * weight);
            }
        }
        assert!((sums.noise * count as f64 / noise.trace() - 1.0).abs() < 1e-12);
        let all: f64 = slopes.iter().map(Vector3::norm_squared).sum();
        assert!((sums.sizes()[0] / all - 1.0).abs() < 1e-12 && sums.rows() == 3 * count);
        assert!((sums.noise_share(0.2) / (0.2 * 3.0 * noise.trace() / all) - 1.0).abs() < 1e-12);
        let features = DMatrix::from_row_slice(count, FEATURES, &own.features);
        assert!((sums.plain() - features.tr_mul(&features)).amax() < 1e-9);
        assert_eq!(sums.weighted().len(), 1 + TORQUES.len());
        for (ratio, weighted) in core::iter::once(0.0).chain(TORQUES).zip(sums.weighted()) {
            let overlaps = own.tests.overlaps();
            let torque = ratio * noise.trace() / count as f64 / overlaps[0];
            let of = |m: usize, n: usize| overlaps.get(m.abs_diff(n)).map_or(0.0, |overlap| torque * overlap);
            let dense = (&noise + DMatrix::from_fn(count, count, of)).cholesky().unwrap();
            let expected = features.tr_mul(&dense.solve(&features));
            assert!((weighted.gram - &expected).amax() < 1e-6 * expected.amax(), "{ratio}");
            let determinant: f64 = 6.0 * dense.l().diagonal().map(libm::log).sum();
            assert!((weighted.log_determinant - determinant).abs() < 1e-6 * determinant.abs(), "{ratio}");
        }
    }

    /// Of a constant rate no slope is seen, and its products are those of one number: ∫ φ.
    #[test]
    fn sums_of_a_constant_rate_are_multiples_of_one() {
        let w = Vector3::new(0.3, -0.8, 0.5);
        let stretch = Stretch::new((0..200).map(|k| 0.1 * f64::from(k)).collect(), vec![w; 200]);
        let sums = Sums::new(&[stretch], 1.0).unwrap();
        let mut squares = 0.0;
        for row in sums.own[0].features.chunks_exact(FEATURES) {
            let all = row[12];
            squares += all * all;
            for (k, (a, b)) in ENTRIES.into_iter().enumerate() {
                assert!((row[3 + k] - all * w[a] * w[b]).abs() < 1e-12, "{k}");
            }
            assert!(row[..3].iter().all(|slope| slope.abs() < 1e-9), "{row:?}");
            assert!((0..3).all(|k| (row[9 + k] - all * w[k]).abs() < 1e-12), "{row:?}");
        }
        let [slopes, sizes] = sums.sizes();
        assert!(slopes < 1e-15 && squares > 0.0);
        assert!((sizes / (squares * w.norm_squared() * w.norm_squared()) - 1.0).abs() < 1e-12);
        assert_eq!(sums.rows(), 3 * sums.own[0].tests.count);
    }

    /// Of rates that change evenly the longest test functions tell most, of eight that double from eight samples on, or of those of which a stretch
    /// holds four: those of half the width are taken.
    #[test]
    fn sums_are_taken_at_half_the_width_that_tells_most() {
        for (samples, times) in [(12, 1.0), (100, 2.0), (4000, 64.0)] {
            let even = (0..samples).map(|k| Vector3::x() * (1e-3 * k as f64)).collect();
            let stretch = Stretch::new((0..samples).map(|k| k as f64).collect(), even);
            let sums = Sums::of(&[stretch]).unwrap();
            let lowest = 4.0 * (samples - 1) as f64 / samples as f64;
            let radius = sums.own[0].tests.radius;
            assert!((radius / (times * lowest) - 1.0).abs() < 1e-8, "{samples}: {radius} {lowest}");
        }
    }
}

//! Sums for drag that grows with the square of the rate: those of |ω| ω against the test functions.

use core::ops::Range;

use multiversion::multiversion;
use nalgebra::Vector3;
use polhode::record::both;

use crate::columns::column::Column;
use crate::columns::quadratic::Quadratic;
use crate::signal::stretch::Stretch;
use crate::signal::terms::{Terms, slope};
use crate::signal::test_functions::{LANES, Seen, TestFunctions};
use crate::thresholds::radius::LONG;

/// Σ w φ |ω| ω of each test function, ω = P y − b.
pub(crate) struct Squared {
    /// At the readings less the noise.
    pub(crate) motion: Vec<Vector3<f64>>,
    /// The same, with the noise to first order.
    pub(crate) readings: Vec<Vector3<f64>>,
    /// The derivative with respect to each column that is an offset or an error of scale or alignment.
    pub(crate) sensor: Vec<Vec<Vector3<f64>>>,
}

impl Squared {
    /// `None` where no column asks for it.
    pub(crate) fn new(
        stretch: &Stretch,
        noise: &[Vector3<f64>],
        terms: &Terms,
        tests: &TestFunctions,
        columns: &[Column],
    ) -> Option<Self> {
        let quadratic = Column::new(Quadratic, None);
        if !columns.iter().any(|column| column.is_alike(&quadratic)) {
            return None;
        }
        let none = || vec![Vector3::zeros(); tests.count];
        // where there is none of this drag, errors of the rates change nothing of it
        let acts = terms.quadratic != 0.0;
        let of_sensor = |column: &Column| acts && column.effect().change_of_rate(&Vector3::zeros()).is_some();
        let mut sums = Squared {
            motion: motion(stretch, noise, terms, tests),
            readings: none(),
            sensor: columns.iter().map(|c| if of_sensor(c) { none() } else { Vec::new() }).collect(),
        };
        for (i, n) in noise.iter().enumerate().filter(|_| acts) {
            let reading = stretch.rates[i] - n;
            let w = terms.rate(&reading);
            let slope = slope(&w);
            let linear = w * w.norm() + slope * (terms.sensor * n);
            let change = |column: &Column| column.effect().change_of_rate(&reading).map(|c| slope * c);
            let changes: Vec<Option<Vector3<f64>>> = columns.iter().map(change).collect();
            for (m, _, by) in Seen::new(tests, stretch.times[i]).each() {
                let by = by * stretch.weights[i];
                sums.readings[m] += linear * by;
                for (sum, change) in sums.sensor.iter_mut().zip(&changes) {
                    if let (Some(sum), Some(change)) = (sum.get_mut(m), change) {
                        *sum += change * by;
                    }
                }
            }
        }
        Some(sums)
    }
}

/// Σ w φ |ω| ω at the readings less the noise.
fn motion(
    stretch: &Stretch,
    noise: &[Vector3<f64>],
    terms: &Terms,
    tests: &TestFunctions,
) -> Vec<Vector3<f64>> {
    // the halves of a long stretch side by side, whatever the machine is
    let (count, long) = (noise.len(), noise.len() > LONG);
    let middle = if long { count / 2 } else { 0 };
    let of = |samples: Range<usize>| {
        let mut sums = core::array::from_fn(|_| tests.room());
        add(stretch, noise, samples, terms, tests, &mut sums);
        sums
    };
    let (later, before) = both(long, || of(middle..count), || of(0..middle));
    (0..tests.count).map(|m| Vector3::from_fn(|p, _| later[p][m] + before[p][m])).collect()
}

#[multiversion(targets("x86_64+avx512f+avx512dq+avx512vl+fma", "x86_64+avx2+fma"))]
fn add(
    stretch: &Stretch,
    noise: &[Vector3<f64>],
    samples: Range<usize>,
    terms: &Terms,
    tests: &TestFunctions,
    sums: &mut [Vec<f64>; 3],
) {
    for i in samples {
        let w = terms.rate(&(stretch.rates[i] - noise[i]));
        let value = w * (w.norm() * stretch.weights[i]);
        let seen = Seen::new(tests, stretch.times[i]);
        for p in 0..3 {
            let own = &mut sums[p][seen.first..seen.first + LANES];
            for (sum, by) in own.iter_mut().zip(&seen.value) {
                *sum += by * value[p];
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::Matrix3;

    /// The halves of a long stretch together are all of it, sample by sample.
    #[test]
    fn a_long_stretch_is_the_sum_of_its_halves() {
        let count = LONG + 1;
        let times: Vec<f64> = (0..count).map(|k| k as f64 / 1024.0).collect();
        let rates = (0..count).map(|k| Vector3::new(0.5, (k % 7) as f64, -0.25)).collect();
        let (stretch, noise) = (Stretch::new(times, rates), vec![Vector3::new(0.0, 0.0, 0.25); count]);
        let tests = TestFunctions::new(&stretch, 16.0).unwrap();
        let found = motion(&stretch, &noise, &Terms::at(Matrix3::identity()), &tests);
        let mut expected = vec![Vector3::<f64>::zeros(); tests.count];
        for (i, t) in stretch.times.iter().enumerate() {
            let w = stretch.rates[i] - noise[i];
            for (m, _, by) in Seen::new(&tests, *t).each() {
                expected[m] += w * (w.norm() * by * stretch.weights[i]);
            }
        }
        assert_eq!(found.len(), expected.len());
        for (found, expected) in found.iter().zip(&expected) {
            assert!((found - expected).amax() < 1e-9 * expected.amax(), "{found} {expected}");
        }
    }
}

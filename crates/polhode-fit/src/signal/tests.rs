//! Test functions, sums and covariances of long stretches, and the noise, beside their definitions.

use nalgebra::{DMatrix, Matrix3, Vector3};
use polhode::num::Random;

use crate::columns::column::{Column, Unknowns};
use crate::columns::quadratic::Quadratic;
use crate::columns::walk::Walk;
use crate::physical::coordinates::{Coordinates, tensor};
use crate::signal::covariance::{Covariance, Levels};
use crate::signal::moments::{Moments, group, ranges};
use crate::signal::noise::{contradicting, variance};
use crate::signal::stretch::Stretch;
use crate::signal::terms::Terms;
use crate::signal::test_functions::{Seen, TestFunctions};
use crate::solve::linearised::Linearised;
use crate::thresholds::radius::LONG;

fn irregular(count: usize, low: f64, high: f64) -> Vec<f64> {
    let mut random = Random::new(17);
    let mut times = vec![1.5];
    for k in 1..count {
        times.push(times[k - 1] + random.between(low, high));
    }
    times
}

fn at_rest(times: Vec<f64>) -> Stretch {
    let rates = vec![Vector3::zeros(); times.len()];
    Stretch::new(times, rates)
}

/// The power of a test function: (1 − u²)⁴.
fn value(u: f64) -> f64 {
    let v = (1.0 - u * u).max(0.0);
    v * v * v * v
}

/// At any times they have the values of their formula, and sum by parts exactly against every cubic.
#[test]
fn test_functions_sum_by_parts_at_irregular_times() {
    let stretch = at_rest(irregular(300, 0.02, 0.08));
    let tests = TestFunctions::new(&stretch, 1.3).unwrap();
    let centres = tests.centres();
    let mut sums = vec![[0.0; 4]; tests.count];
    for (t, weight) in stretch.times.iter().zip(&stretch.weights) {
        let seen = Seen::new(&tests, *t);
        let all: Vec<(usize, f64, f64)> = seen.each().collect();
        for (m, centre) in centres.iter().enumerate() {
            let u = (t - centre) / 1.3;
            match all.iter().find(|(k, ..)| *k == m) {
                Some((_, slope, found)) => {
                    assert!((found - value(u)).abs() < 1e-12);
                    // of each power of u and its derivative
                    let powers = [[1.0, 0.0], [u, 1.0], [u * u, 2.0 * u], [u * u * u, 3.0 * u * u]];
                    for ([p, derivative], sum) in powers.into_iter().zip(&mut sums[m]) {
                        *sum += weight * (slope * p + found * derivative / 1.3);
                    }
                }
                None => assert!(value(u) < 1e-12, "{m} {u}"),
            }
        }
    }
    assert!(sums.iter().flatten().all(|sum| sum.abs() < 1e-13), "{sums:?}");
    // on a fine grid the slopes are the derivative
    let fine = at_rest((0..2000).map(|k| 0.01 * f64::from(k)).collect());
    let tests = TestFunctions::new(&fine, 1.0).unwrap();
    for t in &fine.times {
        for (m, slope, _) in Seen::new(&tests, *t).each() {
            let u = t - tests.centres()[m];
            let v = (1.0 - u * u).max(0.0);
            assert!((slope + 8.0 * u * v * v * v).abs() < 1e-4);
        }
    }
}

/// From end to end of a stretch, four to a half width, as far as it has room and samples for them.
#[test]
fn test_functions_fill_a_stretch_evenly() {
    for (duration, radius, count) in
        [(20.0, 1.0, 73), (20.0, 2.5, 25), (6.0, 3.0, 1), (6.5, 3.0, 2), (7.0, 1.5, 12)]
    {
        let stretch = at_rest((0..=200).map(|k| 3.0 + duration * f64::from(k) / 200.0).collect());
        let tests = TestFunctions::new(&stretch, radius).unwrap();
        let centres = tests.centres();
        assert_eq!((tests.count, centres.len()), (count, count), "{duration} {radius}");
        assert!((centres[0] - 3.0 - radius).abs() < 1e-12);
        assert!((centres[count - 1] - 3.0 - duration + radius).abs() < 1e-11);
        let apart = |k: usize| centres.get(k).map_or(f64::INFINITY, |c| c - centres[0]);
        assert_eq!(tests.reach, (1..=count).take_while(|k| apart(*k) < 2.0 * radius * (1.0 - 1e-9)).count());
        for (k, overlap) in tests.overlaps().iter().enumerate() {
            let at = |i: usize| (i as f64 + 0.5) / 1000.0 * 2.0 - 1.0;
            let product = |u: f64| value(u) * value(u - apart(k) / radius);
            let expected = (0..1000).map(|i| product(at(i))).sum::<f64>() * radius / 500.0;
            assert!((overlap - expected).abs() < 1e-6 * radius, "{duration} {radius} {k}");
        }
        assert_eq!(tests.overlaps().len(), tests.reach + 1);
    }
    let stretch = at_rest((0..=20).map(|k| 0.1 * f64::from(k)).collect());
    // longer than the stretch, or fewer than eight samples in one
    assert!(TestFunctions::new(&stretch, 1.01).is_none() && TestFunctions::new(&stretch, 0.37).is_none());
    assert!(TestFunctions::new(&stretch, 1.0).is_some() && TestFunctions::new(&stretch, 0.39).is_some());
}

/// A cubic has none, white noise its own, and single blows add nothing.
#[test]
fn the_noise_is_what_cubics_leave() {
    let times = irregular(3000, 0.01, 0.03);
    let cubic = |t: &f64| Vector3::new(1.0 - t, 0.1 * t * t, 0.01 * t * t * t);
    let smooth: Vec<Vector3<f64>> = times.iter().map(cubic).collect();
    let read = |rates: Vec<Vector3<f64>>| variance(&[Stretch::new(times.clone(), rates)]);
    assert!(read(smooth.clone()) < 1e-20);
    let mut random = Random::new(2);
    let mut noisy: Vec<Vector3<f64>> = smooth.iter().map(|w| w + random.normal_vector() * 0.3).collect();
    let found = read(noisy.clone());
    assert!((found / 0.09 - 1.0).abs() < 0.08, "{found}");
    noisy[1000] += Vector3::new(1e3, 0.0, 0.0);
    assert!((read(noisy) / found - 1.0).abs() < 0.02);
    assert_eq!(variance(&[Stretch::new(vec![0.0, 1.0, 2.0, 3.0], vec![Vector3::x(); 4])]), 0.0);
}

/// Readings whose noise is white contradict another one that is stated. Where the motion is fast, the sensor filters, or rounding or residuals
/// are as large as what is stated, it stays open.
#[test]
fn a_stated_noise_is_contradicted_where_the_readings_tell_it() {
    let (count, sigma) = (2000, 0.01);
    let mut random = Random::new(12);
    let noise: Vec<Vector3<f64>> = (0..count).map(|_| random.normal_vector() * sigma).collect();
    // a filter keeps a share of the noise before
    let read = |turn: f64, kept: f64| {
        let (mut times, mut rates, mut last) = (Vec::new(), Vec::new(), Vector3::<f64>::zeros());
        for (k, own) in noise.iter().enumerate() {
            let phase = turn * k as f64;
            last = last * kept + own;
            times.push(k as f64);
            rates.push(Vector3::new(libm::sin(phase), libm::cos(phase), 0.3) + last);
        }
        [Stretch::new(times, rates)]
    };
    let said = |of: &[Stretch], times: f64, rounding: f64, misfit: f64| {
        contradicting(of, sigma * sigma * times * times, rounding, (misfit, 300))
    };
    let slow = read(0.02, 0.0);
    for times in [60.0, 5.0, 0.2, 1.0 / 60.0] {
        let found = said(&slow, times, 0.0, 1.0 / (times * times)).unwrap();
        assert!((found / (sigma * sigma) - 1.0).abs() < 0.25, "{times}: {found}");
    }
    for times in [1.5, 1.0, 1.0 / 1.5] {
        assert_eq!(said(&slow, times, 0.0, 1.0 / (times * times)), None, "{times}");
    }
    // residuals of the stated size, and steps of that size or of that of the noise
    assert_eq!(said(&slow, 60.0, 0.0, 1.0), None);
    assert_eq!(said(&slow, 60.0, sigma * sigma * 3600.0, 1.0 / 3600.0), None);
    assert_eq!(said(&slow, 1.0 / 60.0, sigma * sigma, 3600.0), None);
    for other in [read(0.5, 0.0), read(0.02, 0.9)] {
        for times in [60.0, 1.0 / 60.0] {
            assert_eq!(said(&other, times, 0.0, 1.0 / (times * times)), None, "{times}");
        }
    }
}

/// Twice the noise is contradicted, enlarged by ten deviations of chance in as many numbers: by noise that is stated with rounding beside it, and by
/// less than the noise or the rounding, where the residuals of the stated one are as small.
#[test]
fn a_contradiction_is_beyond_twice_the_noise_and_chance() {
    let mut random = Random::new(12);
    let rates = (0..2000).map(|_| Vector3::z() + random.normal_vector() * 0.01).collect();
    let of = [Stretch::new((0..2000).map(f64::from).collect(), rates)];
    let shown = variance(&of);
    let chance = |numbers: f64| 1.0 + 10.0 * (2.0 / numbers).sqrt();
    let most = 4.0 * chance(6000.0);
    for (share, is_told) in [(0.999, true), (1.001, false)] {
        let expected = is_told.then_some(shown);
        let all = share * shown / most;
        for rounding in [0.0, 0.75 * all] {
            assert_eq!(contradicting(&of, all - rounding, rounding, (9.0, 300)), expected, "{share}");
        }
        for rounding in [0.0, 2.0 * shown] {
            let stated = most * shown.max(rounding) / share;
            assert_eq!(contradicting(&of, stated, rounding, (0.0, 0)), expected, "{share}");
        }
        for residuals in [1, 300] {
            let misfit = share / (4.0 * chance(residuals as f64));
            assert_eq!(contradicting(&of, 1e3 * shown, 0.0, (misfit, residuals)), expected, "{share}");
        }
    }
}

/// Halves of a long stretch that are summed side by side are the whole: sums, covariance and columns beside plain sums over all samples.
#[test]
fn a_long_stretch_is_the_sum_of_all_its_samples() {
    let count = LONG + 11;
    let times: Vec<f64> = (0..count).map(|k| 1e-3 * k as f64).collect();
    let rate = Vector3::new(0.6, -0.5, 0.62);
    let stretch = Stretch::new(times, vec![rate; count]);
    let tests = TestFunctions::new(&stretch, 10.0).unwrap();
    let noise = vec![Vector3::zeros(); count];
    let x = Coordinates::new(0.05, 0.02, 0.01, -0.03, 0.02);
    let j = tensor(&x);
    let seen: Vec<Vec<(usize, f64, f64)>> =
        stretch.times.iter().map(|t| Seen::new(&tests, *t).each().collect()).collect();
    let moments = Moments::new(&stretch, &noise, &tests);
    let (mut slopes, mut areas) = (vec![0.0; tests.count], vec![0.0; tests.count]);
    for (seen, weight) in seen.iter().zip(&stretch.weights) {
        for (m, slope, value) in seen {
            slopes[*m] += weight * slope;
            areas[*m] += weight * value;
        }
    }
    for m in 0..tests.count {
        assert!((moments.area(m) / areas[m] - 1.0).abs() < 1e-10);
        for sums in [moments.readings(m), moments.motion(m)] {
            assert!(
                (sums.value - rate * areas[m]).amax() < 1e-9 && (sums.slope - rate * slopes[m]).amax() < 1e-9
            );
            assert!((sums.square - rate * rate.transpose() * areas[m]).amax() < 1e-9);
        }
    }

    // the derivative of ω × J ω at a rate that stays
    let by_rate = Matrix3::from_columns(&[0, 1, 2].map(|k| {
        let e = Vector3::ith(k, 1.0);
        e.cross(&(j * rate)) + rate.cross(&(j * e))
    }));
    let walk = Walk { axis: 2, from: 30.0, until: 70.0 };
    let columns = [Column::new(walk, None).of_segment(0), Column::new(Quadratic, None)];
    let size = 3 * tests.count;
    let (mut dense, mut walked) = (DMatrix::zeros(size, size), vec![Vector3::zeros(); tests.count]);
    for range in ranges(&stretch, 10.0, 0) {
        let own = group(&stretch, &noise, range.clone());
        let (weight, square) = stretch.weights[range].iter().fold((0.0, 0.0), |(a, b), w| (a + w, b + w * w));
        let each: Vec<(usize, Matrix3<f64>)> = Seen::new(&tests, own.time)
            .each()
            .map(|(m, slope, value)| (m, by_rate * value - j * slope))
            .collect();
        for (m, a) in &each {
            let share = ((own.time - 30.0) / 40.0).clamp(0.0, 1.0);
            walked[*m] += a * Vector3::ith(2, -share * weight);
            for (n, b) in &each {
                let mut block = dense.fixed_view_mut::<3, 3>(3 * m, 3 * n);
                block += a * b.transpose() * square;
            }
        }
    }
    let terms = Terms::at(j);
    let factor = Covariance::new(&stretch, &noise, &terms, &tests).into_factor(Levels::WHITE).unwrap();
    let l = DMatrix::from_fn(size, size, |i, k| if i >= k { factor.get(i, k) } else { 0.0 });
    assert!((&l * l.transpose() - &dense).amax() < 1e-10 * dense.amax());

    let part = Linearised::new(&stretch, &noise, &columns, Unknowns::at(x, &columns), tests.clone());
    for m in 0..tests.count {
        let row = |p: usize| &part.rows[(3 * m + p) * part.width..][..part.width];
        for (p, walked) in walked[m].iter().enumerate() {
            assert!((row(p)[0] - walked).abs() < 1e-9, "{m} {p}");
            let squared = (j * rate)[p] * rate.norm() * areas[m];
            assert!((row(p)[1] - squared).abs() < 1e-9, "{m} {p}");
        }
    }
}

//! Motions nearest to samples and their sensitivities, beside simulated motions and plain sums.

use nalgebra::{Matrix3, SMatrix, Vector3};
use polhode::inertia::Inertia;
use polhode::num::Random;

use crate::bound::motions::Motions;
use crate::bound::nearest_motion::nearest_motion;
use crate::bound::sensitivity::{Euler, Sensitivity, Start, of_tensor};
use crate::physical::coordinates::{coordinates, tensor};
use crate::signal::stretch::Stretch;
use crate::simulate::simulate;

fn body() -> Matrix3<f64> {
    Matrix3::new(0.2, 0.01, -0.02, 0.01, 0.35, 0.03, -0.02, 0.03, 0.45)
}

fn start() -> Vector3<f64> {
    Vector3::new(0.5, 0.8, -0.4)
}

fn samples(times: Vec<f64>, sigma: f64) -> Stretch {
    let rates = simulate(&Inertia::from_tensor(body()).unwrap(), start(), &times, sigma, &mut Random::new(2));
    Stretch::new(times, rates.unwrap())
}

/// The nearest motion leaves the noise and starts where the samples do, also with a third of the rate as noise; no motion of another
/// body is taken for one of these.
#[test]
fn the_nearest_motion_is_the_one_that_was_simulated() {
    let euler = Euler::new(body()).unwrap();
    for (step, sigma) in [(0.02, 1e-3), (0.1, 1e-3), (0.02, 0.3)] {
        let times: Vec<f64> = (0..1500).map(|k| step * f64::from(k)).collect();
        let s = samples(times, sigma);
        let (found, left) = nearest_motion(&euler, &s, sigma * sigma).unwrap();
        // 4497 components beyond the start: to √(2/4497) = 0.02
        assert!((left / (4497.0 * sigma * sigma) - 1.0).abs() < 0.1, "{step} {sigma}: {left:e}");
        let exact = simulate(
            &Inertia::from_tensor(body()).unwrap(),
            start(),
            &[found.time],
            0.0,
            &mut Random::new(1),
        );
        let apart = (found.rate - exact.unwrap()[0]).norm();
        assert!(apart < 5.0 * sigma * (3.0 / 1500.0_f64).sqrt() * 3.0, "{step} {sigma}: {apart:e}");
        let motions =
            Motions::nearest(core::slice::from_ref(&s), &coordinates(&body()), sigma * sigma).unwrap();
        assert!((motions.left.0 - left / 4497.0 / (sigma * sigma)).abs() < 1e-9 && motions.left.1 == 4497.0);
    }
    let times: Vec<f64> = (0..1500).map(|k| 0.05 * f64::from(k)).collect();
    let other = tensor(
        &(coordinates(&body()) + coordinates(&Matrix3::from_diagonal(&Vector3::new(0.09, -0.09, 0.0)))),
    );
    assert!(nearest_motion(&Euler::new(other).unwrap(), &samples(times, 1e-3), 1e-6).is_none());
}

/// Dense samples within a step of the integrator count by their cubics as by themselves, before the start and after it.
#[test]
fn the_information_of_dense_samples_is_the_sum_over_them() {
    let euler = Euler::new(body()).unwrap();
    let mut random = Random::new(6);
    let mut times = vec![0.0];
    for k in 0..800 {
        times.push(times[k] + random.between(0.002, 0.02));
    }
    for place in [0, 300, 800] {
        let start = Start { time: times[place], rate: start() };
        let mut expected = SMatrix::<f64, 8, 8>::zeros();
        let mut seen = vec![0; times.len()];
        euler.sweep(&times, &start, |k, _, s: &Sensitivity<8>| {
            expected += s.transpose() * s;
            seen[k] += 1;
        });
        assert!(seen.iter().all(|count| *count == 1));
        let found = euler.information(&times, &start);
        assert!(
            (found - expected).amax() < 1e-4 * expected.amax(),
            "{place}: {:e}",
            (found - expected).amax() / expected.amax()
        );
        // the start is taken out as the inverse of the block of the inverse
        let covariance = expected.try_inverse().unwrap().fixed_view::<5, 5>(0, 0).into_owned();
        let own = of_tensor(&expected).unwrap();
        assert!((own * covariance - SMatrix::<f64, 5, 5>::identity()).amax() < 1e-6);
    }
}

/// Sensitivities are differences of motions, after the start and before it.
#[test]
fn sensitivities_are_those_of_differences() {
    let times = [-4.0, -1.0, 0.5, 3.0];
    let here = Start { time: 0.0, rate: start() };
    let rates = |j: Matrix3<f64>, rate: Vector3<f64>| {
        simulate(&Inertia::from_tensor(j).unwrap(), rate, &times, 0.0, &mut Random::new(1)).unwrap()
    };
    let h = 1e-5;
    Euler::new(body()).unwrap().sweep(&times, &here, |i, w, s: &Sensitivity<8>| {
        assert!((w - rates(body(), start())[i]).norm() < 1e-6);
        for k in 0..8 {
            let moved = |by: f64| {
                let (mut x, mut rate) = (coordinates(&body()), start());
                if k < 5 {
                    x[k] += by
                } else {
                    rate[k - 5] += by
                }
                rates(tensor(&x), rate)[i]
            };
            let slope = (moved(h) - moved(-h)) / (2.0 * h);
            assert!((slope - s.column(k)).amax() < 1e-5 * (1.0 + slope.amax()), "{i} {k}");
        }
    });
}

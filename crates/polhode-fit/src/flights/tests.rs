//! Tests of single functions against motions whose tensor, drag, torque and wheels are known, and sums that are least.

use nalgebra::{Matrix3, Vector3};
use polhode::inertia::Inertia;
use polhode::num::Random;

use crate::flights::consensus::precisions;
use crate::flights::equations::{LOCAL, Normal, Test, UNKNOWNS, Vector, tests};
use crate::flights::extent::{extent, runs};
use crate::flights::flight::FlightLimit;
use crate::physical::coordinates::{Coordinates, coordinates};
use crate::signal::stretch::{KnownInputs, Stretch};
use crate::simulate::{Disturbances, Gyroscope, simulate_with};

fn body() -> Matrix3<f64> {
    Matrix3::from_diagonal(&Vector3::new(0.2, 0.35, 0.45))
}

/// Readings for 30 s at 20 Hz of a body of trace 1 with a wheel that the record tells in half of its unit, and all unknowns of its tests.
fn example(sigma: f64) -> (Stretch, Vector) {
    let (drag, torque) = (Vector3::new(0.01, 0.02, 0.03), Vector3::new(0.004, -0.002, 0.003));
    let (wheel, change) = (Vector3::new(0.05, 0.1, -0.02), Vector3::new(0.002, 0.0, 0.001));
    let by = Disturbances::default().with_drag(drag).with_torque(torque);
    let by = by.with_wheel(wheel).with_wheel_rate(change);
    let times: Vec<f64> = (0..600).map(|k| 0.05 * f64::from(k)).collect();
    let gyroscope = Gyroscope::default().with_noise(sigma);
    let start = Vector3::new(0.5, 0.8, -0.4);
    let inertia = Inertia::from_tensor(body()).unwrap();
    let rates = simulate_with(&inertia, start, &times, &by, &gyroscope, &mut Random::new(3)).unwrap();
    let told = times.iter().map(|t| (wheel + change * *t) * 2.0).collect();
    let none = vec![Vector3::zeros(); times.len()];
    let inputs = Some(KnownInputs { wheel: told, torque: none });
    let mut x = Vector::zeros();
    x.fixed_rows_mut::<5>(0).copy_from(&coordinates(&body()));
    x.fixed_rows_mut::<3>(5).copy_from(&drag);
    x[8] = 0.5;
    x.fixed_rows_mut::<3>(9).copy_from(&torque);
    (Stretch { inputs, ..Stretch::new(times, rates) }, x)
}

/// The weak equation of every test holds at the true unknowns, each of which it needs; noise leaves no more than its bound.
#[test]
fn tests_hold_for_the_motion_that_was_simulated() {
    let (exact, x) = example(0.0);
    for test in tests(&exact, 1.0) {
        let size = test.size();
        assert!(test.residual(&x).norm() < 1e-6 * size, "{:e}", test.residual(&x).norm() / size);
        assert!(
            test.at_sphere().norm() > 1e-4 * size || test.residual(&Vector::zeros()).norm() > 1e-4 * size
        );
    }
    let all = tests(&exact, 1.0);
    for k in 0..UNKNOWNS {
        let mut off = x;
        off[k] += 0.01;
        let worst = all.iter().map(|test| test.residual(&off).norm() / test.size()).fold(0.0, f64::max);
        assert!(worst > 1e-4, "{k}: {worst:e}");
    }
    // mean squares of noise over its bound, with short tests, where slopes carry it, and with long ones, where products do
    let sigma = 1e-3;
    let (noisy, _) = example(sigma);
    for radius in [0.3, 1.0, 4.0] {
        let (of_exact, of_noisy) = (tests(&exact, radius), tests(&noisy, radius));
        let mean = |with: &dyn Fn(&Test, &Test) -> f64| {
            of_exact.iter().zip(&of_noisy).map(|(a, b)| with(a, b)).sum::<f64>() / of_exact.len() as f64
        };
        let squares = mean(&|a, b| (b.residual(&x) - a.residual(&x)).norm_squared());
        // twice the deviations, squared
        let bound = mean(&|_, b| b.noise(sigma * sigma)) / 4.0;
        assert!((0.1..1.1).contains(&(squares / bound)), "{radius}: {squares:e} {bound:e}");
        let torque = 0.02 * of_noisy[0].size();
        let scale = (torque * torque + of_noisy[0].noise(sigma * sigma)).sqrt();
        assert!((of_noisy[0].scale(0.02, sigma * sigma) / scale - 1.0).abs() < 1e-14);
    }
}

/// The mean square of the residuals as a function of the tensor is that of all unknowns, the others at their best.
#[test]
fn the_other_unknowns_are_at_their_best_for_a_tensor() {
    let (stretch, x) = example(1e-3);
    let (all, mut mean) = (tests(&stretch, 1.0), Vector::zeros());
    mean.fixed_rows_mut::<5>(0).copy_from(&x.fixed_rows::<5>(0));
    mean[6] = 0.03;
    let prior = precisions(1.0);
    let mut normal = Normal::prior(&prior, &mean);
    let own: Vec<(&Test, f64)> = all[10..40].iter().map(|test| (test, test.scale(0.02, 1e-6))).collect();
    own.iter().for_each(|(test, scale)| normal.add(test, *scale, LOCAL));
    assert_eq!(normal.count, 90);
    let squares = |at: &Vector| {
        let of_prior: f64 = (0..UNKNOWNS).map(|k| prior[k] * (at[k] - mean[k]) * (at[k] - mean[k])).sum();
        own.iter().map(|(test, scale)| (test.residual(at) / *scale).norm_squared()).sum::<f64>() + of_prior
    };
    // all slopes of the sum of squares vanish at its least, and it is least there
    let best = normal.solve().unwrap();
    for k in 0..LOCAL {
        let at = |by: f64| {
            let mut at = best;
            at[k] += by;
            squares(&at)
        };
        let (above, below) = (at(1e-3), at(-1e-3));
        assert!((above - below).abs() < 1e-6 * (above + below - 2.0 * squares(&best)), "{k}");
    }
    let reduced = normal.of_tensor().unwrap();
    let least = best.fixed_rows::<5>(0).into_owned();
    assert!((reduced.mean_square(&least) * 90.0 / squares(&best) - 1.0).abs() < 1e-8);
    // at another tensor no other drag and wheel leave less
    let other: Coordinates = least + Coordinates::new(0.02, 0.01, -0.02, 0.0, 0.01);
    let found = reduced.mean_square(&other) * 90.0;
    let mut random = Random::new(1);
    let mut at = best;
    at.fixed_rows_mut::<5>(0).copy_from(&other);
    for _ in 0..200 {
        let mut step = Vector::from_fn(|_, _| 0.02 * random.normal());
        step.fixed_rows_mut::<5>(0).fill(0.0);
        assert!(squares(&(at + step)) >= found * (1.0 - 1e-9));
    }
}

#[test]
fn runs_are_rows_of_free_tests() {
    let free = [true, true, false, true, false, false, true, true, true];
    assert_eq!(runs(&free), [0..2, 3..4, 6..9]);
    assert!(runs(&[false; 3]).is_empty() && runs(&[]).is_empty());
}

/// A run is cut where a blow begins, whose torque it tells, and at the edge nothing is.
#[test]
fn a_run_ends_where_a_torque_begins() {
    let inertia = Inertia::from_tensor(body()).unwrap();
    let times: Vec<f64> = (0..600).map(|k| 0.05 * f64::from(k)).collect();
    let free = Disturbances::default();
    let (start, gyroscope) = (Vector3::new(0.5, 0.8, -0.4), Gyroscope::default().with_noise(1e-4));
    let mut rates = simulate_with(&inertia, start, &times, &free, &gyroscope, &mut Random::new(3)).unwrap();
    // from 24 s on the rate is that of a hand
    for (t, w) in times.iter().zip(&mut rates).skip(480) {
        *w += Vector3::new(1.0, -0.7, 0.4) * libm::sin(3.0 * (t - 24.0));
    }
    let stretch = Stretch::new(times, rates);
    let all = tests(&stretch, 1.0);
    let count = all.len();
    // a test that a hand touches reaches beyond 24 s
    let touched = all.iter().position(|test| test.centre + 1.0 > 24.0).unwrap();
    let found = extent(&all, 0..touched + 6, &coordinates(&body()), 1.0, 1e-8).unwrap();
    assert!(found.tests.start == 0 && found.tests.end.abs_diff(touched) <= 2, "{:?} {touched}", found.tests);
    assert_eq!(found.before, FlightLimit::Edge);
    assert!(matches!(found.after, FlightLimit::Torque { share } if share > 0.02), "{:?}", found.after);
    // free tests before and after them are no torque
    let inner = extent(&all, 20..60, &coordinates(&body()), 1.0, 1e-8).unwrap();
    assert_eq!(inner.tests, 20..60);
    assert!(matches!(inner.before, FlightLimit::Torque { share } if share < 0.01), "{:?}", inner.before);
    // held still, the body hardly turns
    let still = extent(&all, 20..60, &coordinates(&body()), 100.0, 1e-8).unwrap();
    assert_eq!((still.before, still.after), (FlightLimit::Slow, FlightLimit::Slow));
    // four tests are a flight, three are none
    assert!(extent(&all, 20..24, &coordinates(&body()), 1.0, 1e-8).is_some());
    assert!(extent(&all, 20..23, &coordinates(&body()), 1.0, 1e-8).is_none());
    assert!(count > touched + 6);
}

//! Tests of single functions against motions whose tensor, drag, torque and wheels are known, and sums that are least.

use nalgebra::{Matrix3, Vector3};
use polhode::inertia::Inertia;
use polhode::num::Random;
use polhode::record::{Record, Segment};

use crate::flights::consensus::precisions;
use crate::flights::equations::{LOCAL, Normal, Test, UNKNOWNS, Vector, tests};
use crate::flights::extent::{Extent, extent, runs};
use crate::flights::flight::FlightLimit;
use crate::flights::{flight, radius, speed, turned, whole};
use crate::physical::coordinates::{Coordinates, coordinates};
use crate::signal::stretch::{KnownInputs, Stretch};
use crate::simulate::{Disturbances, Gyroscope, simulate_with};
use crate::thresholds::flights::SLOW;

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

/// The way of a rate of 1, 3 and 5 at 0, 1 and 3 s is 2 + 8; squares of 1 and 4 weighted with themselves are 17/5; eight samples of 5/3
/// are longer than a radian at a rate of 1, and not at 1/20.
#[test]
fn ways_rates_and_radii_are_those_of_the_samples() {
    let along = |sizes: &[f64]| sizes.iter().map(|size| Vector3::y() * *size).collect::<Vec<_>>();
    assert_eq!(turned(&[0.0, 1.0, 3.0], &along(&[1.0, 3.0, 5.0])), 10.0);
    let of = |times: &[f64], sizes: &[f64]| Stretch::new(times.to_vec(), along(sizes));
    let all = [of(&[0.0], &[1.0]), of(&[0.0], &[-2.0])];
    assert!((speed(&all) - 3.4_f64.sqrt()).abs() < 1e-15);
    let all = [of(&[0.0, 1.0, 2.0], &[1.0; 3]), of(&[5.0, 8.0], &[1.0; 2])];
    assert!((radius(&all, 1.0) - 40.0 / 3.0).abs() < 1e-14);
    assert_eq!(radius(&all, 0.05), 20.0);
}

/// A flight ends at the samples of its stretch, or at those within its span, and shares none with the one before.
#[test]
fn a_flight_has_the_samples_within_its_span() {
    // 40 s at 2 Hz, of which the stretch has 5 to 35 s in half seconds
    let times: Vec<f64> = (0..81).map(|k| 0.5 * f64::from(k)).collect();
    let segment = Segment::new("a", times, vec![Vector3::z() * 2.0; 81]).unwrap();
    let own: Vec<f64> = (0..61).map(f64::from).collect();
    let stretch = Stretch { segment: 3, start: 5.0, ..Stretch::new(own, vec![Vector3::z(); 61]) };
    let edge = (FlightLimit::Edge, FlightLimit::Edge);
    let torque = (FlightLimit::Slow, FlightLimit::Torque { share: 0.5 });
    let of = |span: [f64; 2], (before, after): (FlightLimit, FlightLimit), last: Option<f64>| {
        flight(&segment, &stretch, 2.0, span, &Extent { tests: 0..1, before, after }, last)
    };
    for (span, limits, last, expected) in [
        ([2.0, 12.0], edge, None, (5.0, 35.0, 61)),
        ([2.0, 12.0], edge, Some(9.0), (9.5, 35.0, 52)),
        ([2.0, 12.0], torque, None, (7.0, 17.0, 21)),
        ([2.0, 12.0], torque, Some(9.0), (9.5, 17.0, 16)),
        ([2.2, 12.2], (edge.0, torque.1), None, (5.0, 17.0, 25)),
        ([2.2, 12.2], (torque.0, edge.1), None, (7.5, 35.0, 56)),
    ] {
        let found = of(span, limits, last).unwrap();
        assert_eq!((found.start, found.end, found.samples), expected, "{span:?} {last:?}");
        // at a rate of 2
        assert_eq!(found.turned, 2.0 * (expected.1 - expected.0));
        assert_eq!((found.segment, found.before, found.after), (3, limits.0, limits.1));
    }
    // sixteen samples are enough, fifteen are not
    assert!(of([2.0, 9.5], torque, None).is_some() && of([2.0, 9.0], torque, None).is_none());
}

/// A record that nowhere contradicts a free body has its segments as flights.
#[test]
fn a_whole_record_is_its_segments() {
    let mut record = Record::default();
    for start in [0.0, 10.0] {
        let times = vec![start, start + 1.0, start + 3.0];
        record.segments.push(Segment::new("a", times, vec![Vector3::x() * 2.0; 3]).unwrap());
    }
    let found = whole(&record);
    assert!(found.whole && found.list.len() == 2);
    for (k, flight) in found.list.iter().enumerate() {
        let start = 10.0 * k as f64;
        assert_eq!((flight.segment, flight.start, flight.end), (k, start, start + 3.0));
        assert_eq!((flight.samples, flight.turned), (3, 6.0));
        assert_eq!((flight.before, flight.after), (FlightLimit::Edge, FlightLimit::Edge));
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
    // the largest of eight tests beyond
    let mut x = Vector::zeros();
    x.fixed_rows_mut::<5>(0).copy_from(&coordinates(&body()));
    let beyond = all[found.tests.end..found.tests.end + 8].iter();
    let most = beyond.map(|test| test.residual(&x).norm() / test.size()).fold(0.0, f64::max);
    let is_most = |share: f64| share > 0.02 && (share / most - 1.0).abs() < 0.05;
    assert!(
        matches!(found.after, FlightLimit::Torque { share } if is_most(share)),
        "{:?} {most}",
        found.after
    );
    // free tests before and after them are no torque
    let inner = extent(&all, 20..60, &coordinates(&body()), 1.0, 1e-8).unwrap();
    assert_eq!(inner.tests, 20..60);
    assert!(matches!(inner.before, FlightLimit::Torque { share } if share < 0.01), "{:?}", inner.before);
    // held still, the body hardly turns
    let still = extent(&all, 20..60, &coordinates(&body()), 100.0, 1e-8).unwrap();
    assert_eq!((still.before, still.after), (FlightLimit::Slow, FlightLimit::Slow));
    // half of eight tests are not most of them, five are
    let mut rates: Vec<f64> = all[12..20].iter().map(Test::rate).collect();
    rates.sort_by(f64::total_cmp);
    for (k, is_slow) in [(3, false), (4, true)] {
        let speed = 0.5 * (rates[k] + rates[k + 1]) / SLOW;
        let found = extent(&all, 20..60, &coordinates(&body()), speed, 1e-8).unwrap();
        assert_eq!(found.before == FlightLimit::Slow, is_slow, "{k}: {:?}", found.before);
    }
    // four tests are a flight, three are none
    assert!(extent(&all, 20..24, &coordinates(&body()), 1.0, 1e-8).is_some());
    assert!(extent(&all, 20..23, &coordinates(&body()), 1.0, 1e-8).is_none());
    assert!(count > touched + 6);
}

/// Whatever its moments, the rate of a free body stays above 1/√2 of its largest, and a flat needle comes next to that.
#[test]
fn free_rates_vary_by_less_than_the_root_of_two() {
    let times: Vec<f64> = (0..4000).map(|k| 0.05 * f64::from(k)).collect();
    let (free, gyroscope) = (Disturbances::default(), Gyroscope::default());
    let mut most = 0.0_f64;
    for moments in [[0.02, 1.0, 1.02], [0.02, 1.0, 1.001], [0.3, 1.0, 1.3], [1.0, 2.0, 2.6], [1.0, 1.05, 1.9]]
    {
        let body = Inertia::from_moments(moments).unwrap();
        for start in [[0.01, 1.0, 0.0], [0.0, 1.0, 0.01], [0.5, 1.0, 0.3], [3.0, 1.0, 0.1], [0.1, 0.2, 1.0]] {
            let start = Vector3::from(start);
            let rates = simulate_with(&body, start, &times, &free, &gyroscope, &mut Random::new(1)).unwrap();
            let of = |rates: &[Vector3<f64>]| {
                let own = rates.iter().map(Vector3::norm);
                own.clone().fold(0.0, f64::max) / own.fold(f64::INFINITY, f64::min)
            };
            let ratio = of(&rates);
            assert!(ratio < core::f64::consts::SQRT_2, "{moments:?} {start}: {ratio}");
            most = most.max(ratio);
        }
    }
    assert!(most > 1.38, "{most}");
}

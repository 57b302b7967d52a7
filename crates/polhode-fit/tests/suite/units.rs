//! Units of rate and time: what a record tells of their product, and what it cannot tell.

use std::f64::consts::PI;

use nalgebra::{Matrix3, UnitQuaternion, Vector3};
use polhode::body::Body;
use polhode::flow::FreeMotion;
use polhode::inertia::Inertia;
use polhode::num::Random;
use polhode_fit::{
    Disturbances, Estimate, FitError, Gyroscope, Prior, Record, Settings, UnitProduct, Warning, fit,
    simulate_with,
};

const DEGREE: f64 = PI / 180.0;

/// A toss of 2 s at 12 rad/s with torque noise, rad/s² √s of a body of trace 3.
fn toss(moments: [f64; 3], omega: [f64; 3], torque_noise: f64, seed: u64) -> (Vec<f64>, Vec<Vector3<f64>>) {
    let trace: f64 = moments.iter().sum();
    let body = Inertia::from_moments(moments).unwrap();
    let times: Vec<f64> = (0..200).map(|i| f64::from(i) / 100.0).collect();
    let acting = Disturbances::default().with_torque_noise(torque_noise * trace / 3.0);
    let sensor = Gyroscope::default().with_noise(1e-2);
    let omega = Vector3::from(omega).normalize() * 12.0;
    let rates = simulate_with(&body, omega, &times, &acting, &sensor, &mut Random::new(seed)).unwrap();
    (times, rates)
}

/// Fits what is read of times and rates that are these many times as large.
fn read((times, rates): &(Vec<f64>, Vec<Vector3<f64>>), by: [f64; 2]) -> Result<Estimate, FitError> {
    let times: Vec<f64> = times.iter().map(|t| t * by[0]).collect();
    let rates: Vec<Vector3<f64>> = rates.iter().map(|w| w * by[1]).collect();
    fit(&Record::from_samples(&times, &rates).unwrap(), &Settings::default())
}

fn open_products(estimate: &Estimate) -> &[UnitProduct] {
    let units = estimate.warnings.iter().find_map(|warning| match warning {
        Warning::Units { products, .. } => Some(products.as_slice()),
        _ => None,
    });
    units.unwrap_or_default()
}

#[test]
fn torque_noise_hides_no_mistaken_unit_and_makes_none() {
    for (k, torque_noise) in [0.0, 1e-3, 1e-2, 3e-2, 6e-2].into_iter().enumerate() {
        let record = toss([1.0, 2.0, 2.6], [0.3, 1.0, 0.4], torque_noise, 7 + k as u64);
        let right = read(&record, [1.0, 1.0]).unwrap();
        assert!(open_products(&right).is_empty() && right.unexplained.unwrap() < 0.02, "{torque_noise}");
        for (by, named) in [
            ([1.0, 1.0 / DEGREE], "rates in deg/s read as rad/s"),
            ([1e3, 1.0], "times in ms read as s"),
            ([1e3, 1.0 / DEGREE], "rates in deg/s read as rad/s, and times in ms read as s"),
            ([1e6, 1e3 / DEGREE], "rates in mdeg/s read as rad/s, and times in us read as s"),
            ([1.0, 16.4 / DEGREE], "rates in counts of 1/16.4 deg/s read as rad/s"),
            ([1.0, DEGREE], "rates in rad/s read as deg/s"),
            ([1e-3, 1.0], "times in s read as ms"),
        ] {
            let refused = read(&record, by).unwrap_err();
            let FitError::Units { products, .. } = &refused else {
                panic!("{torque_noise}, {named}: {refused}")
            };
            // of units with the same product those of the fewest mistakes are named
            let is_meant = |product: &UnitProduct| (product.factor * by[0] * by[1] - 1.0).abs() < 1e-6;
            assert!(products.iter().any(is_meant), "{torque_noise}, {named}: {refused}");
            assert!(named.contains(", and") || refused.to_string().contains(named), "{named}: {refused}");
        }
    }
}

/// A body with two equal moments moves in larger units as one nearer to a sphere does: the ratios of its moments sum to zero in
/// each.
#[test]
fn a_symmetric_body_leaves_its_units_open_and_is_not_refused() {
    for torque_noise in [0.0, 1e-2] {
        let record = toss([1.0, 1.0, 1.5], [0.3, 1.0, 0.4], torque_noise, 3);
        let right = read(&record, [1.0, 1.0]).unwrap();
        assert!(!open_products(&right).is_empty(), "{:?}", right.warnings);
        // nearer to a sphere, as that body is in deg/s
        let wrong = read(&record, [1.0, 6.0]);
        match wrong {
            Ok(wrong) => assert!(!open_products(&wrong).is_empty(), "{:?}", wrong.warnings),
            Err(error) => assert!(!matches!(error, FitError::Solver(_)), "{error}"),
        }
    }
}

#[test]
fn what_turns_by_more_than_half_a_turn_between_samples_is_refused_with_its_numbers() {
    // a spin, which tells no units
    let record = toss([1.0, 2.0, 2.6], [0.0, 0.0, 1.0], 0.0, 5);
    let refused = read(&record, [1.0, 1.0 / DEGREE]).unwrap_err();
    let FitError::Undersampled { turn, step } = refused else { panic!("{refused}") };
    assert!((turn - 12.0 / DEGREE * 0.01).abs() < 0.05 * turn && (step - 0.01).abs() < 1e-9, "{turn} {step}");
    assert!(refused.to_string().contains("probably mistaken"), "{refused}");
}

/// The share is that of torques alone: without any nothing is left, whatever the noise of the rates.
#[test]
fn the_share_that_free_motion_leaves_unexplained_is_that_of_torques() {
    let of = |torque_noise: f64| {
        read(&toss([1.0, 2.0, 2.6], [0.3, 1.0, 0.4], torque_noise, 2), [1.0, 1.0])
            .unwrap()
            .unexplained
            .unwrap()
    };
    let (none, weak, strong) = (of(0.0), of(2e-1), of(2.0));
    assert!(none < 2e-4 && weak > 2.0 * none && strong > 10.0 * weak, "{none} {weak} {strong}");
}

/// With one axis reversed the record is that of another body, which is the mirror that the report names.
#[test]
fn a_mirrored_axis_gives_the_tensor_that_the_report_of_the_right_axes_names() {
    let record = toss([1.0, 2.0, 2.6], [0.3, 1.0, 0.4], 1e-3, 11);
    let mirrored = (record.0.clone(), record.1.iter().map(|w| Vector3::new(-w.x, w.y, w.z)).collect());
    let (right, wrong) = (read(&record, [1.0, 1.0]).unwrap(), read(&mirrored, [1.0, 1.0]).unwrap());
    // by hand: 1.8 : 1.6 : 0.52
    let truth = [0.52, 1.6, 1.8].map(|moment| moment / 3.92);
    let named = right.mirror.unwrap().principal_moments();
    for k in 0..3 {
        assert!((named[k] - truth[k]).abs() < 5e-3, "{named:?}");
        assert!((wrong.principal[k] - truth[k]).abs() < 5e-3, "{:?}", wrong.principal);
    }
    let back = wrong.mirror.unwrap().principal_moments();
    assert!((0..3).all(|k| (back[k] - right.principal[k]).abs() < 1e-2), "{back:?}");
}

#[test]
fn a_prior_that_the_mirror_agrees_with_names_it() {
    let (times, rates) = toss([1.0, 2.0, 2.6], [0.3, 1.0, 0.4], 1e-3, 12);
    let rates: Vec<Vector3<f64>> = rates.iter().map(|w| Vector3::new(w.x, -w.y, w.z)).collect();
    let record = Record::from_samples(&times, &rates).unwrap();
    let prior = Matrix3::from_diagonal(&Vector3::new(1.0, 2.0, 2.6));
    let with = |prior: Matrix3<f64>| {
        fit(&record, &Settings::default().with_prior(Some(Prior::relative(prior, 0.02).shape_only())))
    };
    let refused = with(prior).unwrap_err();
    let FitError::PriorContradicted { mirror: Some(mirror), .. } = &refused else { panic!("{refused}") };
    let [a, b, _] = **mirror;
    assert!((a - 1.0 / 5.6).abs() < 5e-3 && (b - 2.0 / 5.6).abs() < 5e-3, "{refused}");
    assert!(refused.to_string().contains("A mirrored axis would explain it"), "{refused}");
    // of a prior that is wrong in either hand nothing is said
    let refused = with(Matrix3::from_diagonal(&Vector3::new(2.6, 1.0, 2.0))).unwrap_err();
    assert!(matches!(refused, FitError::PriorContradicted { mirror: None, .. }), "{refused}");
}

/// A hand that turns the body to and fro about slowly changing axes: no body moves so by itself.
#[test]
fn a_body_that_a_hand_drives_gets_no_tensor() {
    let mut refused = 0;
    for seed in 0..5 {
        let mut random = Random::new(900 + seed);
        let waves: Vec<[Vector3<f64>; 2]> =
            (0..4).map(|_| [random.normal_vector(), random.normal_vector() * 2.0]).collect();
        let times: Vec<f64> = (0..1000).map(|i| f64::from(i) / 100.0).collect();
        let rates: Vec<Vector3<f64>> = times
            .iter()
            .map(|t| {
                let waves = waves.iter().enumerate().map(|(k, [a, b])| {
                    let (sin, cos) = libm::sincos(t * (0.7 + 0.6 * k as f64));
                    a * sin + b * cos
                });
                waves.sum::<Vector3<f64>>() + random.normal_vector() * 5e-3
            })
            .collect();
        match fit(&Record::from_samples(&times, &rates).unwrap(), &Settings::default()) {
            Ok(estimate) => panic!("{seed}: {:?} {:?}", estimate.principal, estimate.unexplained),
            Err(error) => refused += usize::from(matches!(error, FitError::Driven { .. })),
        }
    }
    assert!(refused > 0, "none for that reason");
}

/// Drag takes momentum. A torque k J w gives it: the motion is the free one, run through ever faster.
#[test]
fn a_body_that_gains_half_of_its_momentum_gets_no_tensor() {
    let inertia = Inertia::from_moments([1.0, 2.0, 2.6]).unwrap();
    let free =
        FreeMotion::from_omega(&inertia, UnitQuaternion::identity(), Vector3::new(0.6, 2.0, 0.8)).unwrap();
    let of = |k: f64| {
        let mut random = Random::new(33);
        let times: Vec<f64> = (0..3000).map(|i| f64::from(i) / 100.0).collect();
        let rates: Vec<Vector3<f64>> = times
            .iter()
            .map(|t| {
                let grown = libm::exp(k * t);
                let state = free.at((grown - 1.0) / k).unwrap();
                Body::free(inertia.clone()).omega_body(&state) * grown + random.normal_vector() * 1e-2
            })
            .collect();
        fit(&Record::from_samples(&times, &rates).unwrap(), &Settings::default())
    };
    assert!(of(-0.02).is_ok(), "drag");
    assert!(matches!(of(0.02).unwrap_err(), FitError::Driven { growth, .. } if growth > 0.0));
}

//! What errors that a fit takes to be zero do to the moments, beside fits of records that have them.

use nalgebra::{Matrix3, Quaternion, UnitQuaternion, Vector3};
use polhode::inertia::Inertia;
use polhode::num::Random;
use polhode_fit::{
    Disturbances, Estimate, Gyroscope, Method, Record, SensorPriors, Settings, TorqueModel, TorqueNoise,
    Warning, fit, simulate_with,
};

use crate::measured::{sampled, turned};

/// Test functions of one length and one noise for all: others would make another change.
fn settings() -> Settings {
    let settings = Settings::default().with_torque(TorqueModel::None).with_torque_noise(TorqueNoise::None);
    settings.with_radius(1.0).with_noise(1e-2)
}

fn body() -> Matrix3<f64> {
    let axis = nalgebra::Unit::new_normalize(Vector3::new(0.3, -0.7, 0.5));
    turned([1.0, 2.0, 2.6], &nalgebra::Rotation3::from_axis_angle(&axis, 0.8))
}

const START: Vector3<f64> = Vector3::new(0.4, -0.9, 0.5);

fn fitted(by: &Disturbances, gyroscope: &Gyroscope) -> Estimate {
    let (times, body) = (sampled(25, 30), Inertia::from_tensor(body()).unwrap());
    let rates = simulate_with(&body, START, &times, by, gyroscope, &mut Random::new(1)).unwrap();
    fit(&Record::from_samples(&times, &rates).unwrap(), &settings()).unwrap()
}

/// A sensor with the error of a line of the report, of this size; it has none of a wheel.
fn with_error(name: &str, size: f64, right: &Gyroscope) -> Gyroscope {
    let axis = ["x", "y", "z"].iter().position(|letter| name.ends_with(letter)).unwrap_or(0);
    let (along, right) = (Vector3::ith(axis, size), right.clone());
    // the true rate is the reading with the error added to its scale: the reading has it taken off
    match name {
        "scale" => right.with_scale(-size),
        "misalignment_xy" => right.with_misalignment(Vector3::x() * (-size / 2.0)),
        "misalignment_xz" => right.with_misalignment(Vector3::y() * (-size / 2.0)),
        "misalignment_yz" => right.with_misalignment(Vector3::z() * (-size / 2.0)),
        name if name.starts_with("scale_") => right.with_axis_scales(-along),
        name if name.starts_with("offset_") => right.with_offset(along),
        // a delay reads what was
        name if name.starts_with("skew_") => right.with_skew(-along),
        name if name.starts_with("wheel_") => right,
        name => panic!("{name}"),
    }
}

/// The change of the moments by fits of records with and without the error is the one that the report foresees.
#[test]
fn errors_change_the_moments_as_the_report_says() {
    let (free, right) = (Disturbances::default(), Gyroscope::default());
    let exact = fitted(&free, &right);
    let rates = simulate_with(
        &Inertia::from_tensor(body()).unwrap(),
        START,
        &sampled(25, 30),
        &free,
        &right,
        &mut Random::new(1),
    );
    let rates = rates.unwrap();
    let squares = rates.iter().map(|w| (body() * w).norm_squared()).sum::<f64>() / rates.len() as f64;
    let mut seen = Vec::new();
    for line in exact.systematic.iter().filter(|line| !["magnet", "walk"].contains(&line.name)) {
        let axis = ["x", "y", "z"].iter().position(|letter| line.name.ends_with(letter)).unwrap_or(0);
        // a tenth of it, so that the change is linear
        let size = 0.1 * line.size;
        let along = Vector3::ith(axis, size);
        let wheel = if line.name.starts_with("wheel_") { along * squares.sqrt() } else { Vector3::zeros() };
        let with = fitted(&free.clone().with_wheel(wheel), &with_error(line.name, size, &right));
        let largest = line.principal.iter().fold(0.0, |most: f64, v| most.max(v.abs()));
        for k in 0..3 {
            let change = 10.0 * (with.principal[k] - exact.principal[k]);
            let near = 0.1 * largest + 1e-6;
            assert!(
                (change - line.principal[k]).abs() < near,
                "{} {k}: {change:e} {:e}",
                line.name,
                line.principal[k]
            );
        }
        for k in 0..2 {
            let change = 10.0 * (with.ratios[k] - exact.ratios[k]);
            let near = 0.3 * largest + 3e-6;
            assert!(
                (change - line.ratios[k]).abs() < near,
                "{} {k}: {change:e} {:e}",
                line.name,
                line.ratios[k]
            );
        }
        seen.push(line.name);
    }
    // a scale, three of each axis, three angles, three offsets, two delays, three wheels
    assert_eq!(seen.len(), 15, "{seen:?}");
}

/// The same of rates that are too sparse for the weak form, for each error of the sensor.
#[test]
fn errors_change_the_moments_of_sparse_rates_as_the_report_says() {
    let (noise, none) = (0.01, Disturbances::default());
    let times: Vec<f64> = (0..124).map(|i| 0.65 * f64::from(i)).collect();
    let body = Inertia::from_tensor(body()).unwrap();
    let settings = Settings::default().with_torque(TorqueModel::None).with_noise(noise);
    let fitted = |gyroscope: &Gyroscope| {
        let rates = simulate_with(&body, START, &times, &none, gyroscope, &mut Random::new(8)).unwrap();
        let e = fit(&Record::from_samples(&times, &rates).unwrap(), &settings).unwrap();
        assert_eq!(e.method, Method::ExactMotion);
        e
    };
    let right = Gyroscope::default().with_noise(noise);
    let exact = fitted(&right);
    // a scale, three of each axis, three angles, three offsets, two delays
    assert_eq!(exact.systematic.len(), 12);
    for line in &exact.systematic {
        // small beside the noise, and far more than where the search ends
        let part = if line.name.starts_with("skew") { 2.0 } else { 0.2 };
        let with = fitted(&with_error(line.name, part * line.size, &right));
        let largest = line.principal.iter().fold(0.0, |most: f64, v| most.max(v.abs()));
        for k in 0..3 {
            let change = (with.principal[k] - exact.principal[k]) / part;
            let near = 0.05 * largest;
            assert!((change - line.principal[k]).abs() < near, "{} {k}: {change:e} {line:?}", line.name);
        }
        for k in 0..2 {
            let change = (with.ratios[k] - exact.ratios[k]) / part;
            assert!(
                (change - line.ratios[k]).abs() < 0.2 * largest,
                "{} {k}: {change:e} {line:?}",
                line.name
            );
        }
    }
}

/// Rates of the body under the torque of a magnet along one of its axes in a field along one of the axes that it begins with.
fn in_a_field(magnet: usize, field: usize, size: f64) -> Vec<Vector3<f64>> {
    let (j, times) = (body(), sampled(25, 30));
    let inverse = j.try_inverse().unwrap();
    let field = Vector3::ith(field, 1.0);
    let slope = |(q, w): &(Quaternion<f64>, Vector3<f64>)| {
        let here = UnitQuaternion::new_normalize(*q).inverse_transform_vector(&field);
        let torque = Vector3::ith(magnet, size).cross(&here);
        (q * Quaternion::from_imag(*w) * 0.5, inverse * (torque - w.cross(&(j * w))))
    };
    let plus = |a: &(Quaternion<f64>, Vector3<f64>), b: &(Quaternion<f64>, Vector3<f64>), h: f64| {
        (a.0 + b.0 * h, a.1 + b.1 * h)
    };
    let (mut at, mut rates) = ((Quaternion::identity(), START), vec![START]);
    for pair in times.windows(2) {
        let h = (pair[1] - pair[0]) / 2.0;
        for _ in 0..2 {
            let a = slope(&at);
            let b = slope(&plus(&at, &a, 0.5 * h));
            let c = slope(&plus(&at, &b, 0.5 * h));
            let d = slope(&plus(&at, &c, h));
            at = plus(&plus(&plus(&plus(&at, &a, h / 6.0), &b, h / 3.0), &c, h / 3.0), &d, h / 6.0);
        }
        rates.push(at.1);
    }
    rates
}

/// Of a magnet and a field in random directions each product of components has a third of the size as its deviation.
#[test]
fn a_magnet_in_a_random_direction_changes_the_moments_as_the_report_says() {
    let exact = fitted(&Disturbances::default(), &Gyroscope::default());
    let line = exact.systematic.iter().find(|line| line.name == "magnet").unwrap();
    // over the trace, rad/s²; so small that the motion stays what it is
    let (small, times) = (1e-2 * line.size, sampled(25, 30));
    let mut squares = [0.0; 3];
    for (magnet, field) in (0..3).flat_map(|magnet| (0..3).map(move |field| (magnet, field))) {
        let rates = in_a_field(magnet, field, small * body().trace());
        let with = fit(&Record::from_samples(&times, &rates).unwrap(), &settings()).unwrap();
        for (k, sum) in squares.iter_mut().enumerate() {
            let change = (with.principal[k] - exact.principal[k]) * line.size / small;
            *sum += change * change;
        }
    }
    for (k, sum) in squares.iter().enumerate() {
        let expected = sum.sqrt() / 3.0;
        assert!(
            (line.principal[k] / expected - 1.0).abs() < 0.1,
            "{k}: {:e} {expected:e}",
            line.principal[k]
        );
    }
}

/// An axis that is read later than its time says has a negative delay, for which a reading shows the motion of a later time.
#[test]
fn an_axis_that_is_read_late_has_a_negative_delay() {
    let (times, body) = (sampled(20, 30), Inertia::from_tensor(body()).unwrap());
    let gyroscope = Gyroscope::default().with_noise(1e-3).with_skew(Vector3::new(0.0, 0.02, -0.01));
    let none = Disturbances::default();
    let rates = simulate_with(&body, START, &times, &none, &gyroscope, &mut Random::new(4)).unwrap();
    let settings = Settings::default().with_sensor(SensorPriors::default().with_skew(0.05));
    let e = fit(&Record::from_samples(&times, &rates).unwrap(), &settings).unwrap();
    for (name, delay) in [("skew_y", -0.02), ("skew_z", 0.01)] {
        let found = e.nuisances.iter().find(|one| one.name == name).unwrap();
        assert!((found.value - delay).abs() < 0.005 && found.sigma < 0.005, "{name}: {found:?}");
    }
}

/// Offsets of twenty times the deviation that is given for them are named with both; those within it are not.
#[test]
fn offsets_that_their_prior_does_not_allow_are_named() {
    let (times, body) = (sampled(25, 30), Inertia::from_tensor(body()).unwrap());
    let gyroscope = Gyroscope::default().with_offset(Vector3::new(0.02, -0.02, 0.02));
    let none = Disturbances::default();
    let rates = simulate_with(&body, START, &times, &none, &gyroscope, &mut Random::new(6)).unwrap();
    let record = Record::from_samples(&times, &rates).unwrap();
    for given in [1e-3, 0.05] {
        let settings = settings().with_sensor(SensorPriors::default().with_offset(given));
        let e = fit(&record, &settings).unwrap();
        let found = e.warnings.iter().find_map(|warning| match warning {
            Warning::RefutedPrior { what, size, prior, .. } => Some((*what, *size, *prior)),
            _ => None,
        });
        assert_eq!(found.is_some(), given < 0.02, "{:?}", e.warnings);
        let Some((what, size, prior)) = found else { continue };
        assert_eq!(what, "offsets of the sensor");
        assert!((size / 0.02 - 1.0).abs() < 0.3 && (prior / given - 1.0).abs() < 1e-9, "{size} {prior}");
        let suspects = |w: &Warning| matches!(w, Warning::RefutedPrior { .. } | Warning::LeftOut { .. });
        let first = e.warnings.iter().find(|warning| suspects(warning)).unwrap();
        assert!(matches!(first, Warning::RefutedPrior { .. }), "{first}");
    }
}

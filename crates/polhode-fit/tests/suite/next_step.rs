//! What a report advises: the largest error first, and a start that tells more.

use nalgebra::Vector3;
use polhode::inertia::Inertia;
use polhode::num::Random;
use polhode_fit::{
    Contradiction, Disturbances, Estimate, Gyroscope, NextStep, Origin, Poses, Record, Settings, fit,
    fit_poses, simulate, simulate_poses, simulate_with,
};

fn fitted(omega: Vector3<f64>, noise: f64, seconds: u32) -> Estimate {
    of_body([1.0, 2.0, 2.6], omega, noise, seconds)
}

fn of_body(moments: [f64; 3], omega: Vector3<f64>, noise: f64, seconds: u32) -> Estimate {
    let body = Inertia::from_moments(moments).unwrap();
    let times: Vec<f64> = (0..50 * seconds).map(|i| f64::from(i) / 50.0).collect();
    let rates = simulate(&body, omega, &times, noise, &mut Random::new(5)).unwrap();
    fit(&Record::from_samples(&times, &rates).unwrap(), &Settings::default()).unwrap()
}

/// In a quiet record one per cent of scale does more than noise, in a noisy and short one noise does more.
#[test]
fn the_largest_error_is_named_first() {
    let tumbling = Vector3::new(0.5, 1.0, 0.4);
    let quiet = fitted(tumbling, 1e-3, 60);
    let [NextStep::Sensor { name, times, .. }, ..] = quiet.next_steps()[..] else {
        panic!("{:?}", quiet.next_steps())
    };
    let line = quiet.systematic.iter().find(|line| line.name == name).unwrap();
    let of = |k: usize| line.principal[k].abs() / (1.96 * quiet.sigma_principal[k]);
    let most = of(0).max(of(1)).max(of(2));
    assert!((times / most - 1.0).abs() < 1e-4 && times > 1.0, "{name} {times} {most}");
    let is_more = |line: &polhode_fit::Systematic| {
        (0..3).any(|k| line.principal[k].abs() > 1.001 * times * 1.96 * quiet.sigma_principal[k])
    };
    assert!(!quiet.systematic.iter().any(|line| !line.name.starts_with("wheel") && is_more(line)));

    // calibrated to the size that is named, the error is half a 95 % interval
    let told = quiet.next_steps()[0].to_string();
    let calibrated = format!("{:.1e}", line.size / times).parse::<f64>().unwrap();
    assert!(told.contains(&format!("{name} of {calibrated}")), "{told}");

    let noisy = fitted(tumbling, 0.1, 20);
    assert_eq!(noisy.next_steps().first(), Some(&NextStep::Longer));
}

/// Next to a steady spin about axis 3 the turn of the axes about it is known worst; a start across the axis knows it better.
#[test]
fn a_start_across_the_weakest_axis_tells_more() {
    let weak = fitted(Vector3::new(0.02, 0.02, 1.0), 1e-3, 60);
    let found = weak.next_steps().into_iter().find_map(|step| match step {
        NextStep::OtherStart { times, turn, number, gain } => Some((times, turn, number, gain.unwrap())),
        _ => None,
    });
    let (times, turn, number, gain) = found.unwrap();
    assert!(times > 10.0 && number == 3 && turn, "{times} {turn} {number}");
    let even = fitted(Vector3::repeat(1.0008 / 3.0_f64.sqrt()), 1e-3, 60);
    let measured = weak.sigma_axes[2] / even.sigma_axes[2];
    assert!((0.8..1.25).contains(&(gain / measured)), "foreseen {gain}, measured {measured}");
    let other = fitted(Vector3::new(0.7, 0.7, 0.2), 1e-3, 60);
    assert!(other.sigma_axes[2] < 0.2 * weak.sigma_axes[2], "{:?} {:?}", other.sigma_axes, weak.sigma_axes);
    assert!(!other.next_steps().iter().any(|step| matches!(step, NextStep::OtherStart { .. })));
}

/// Of a slender body some combinations are known far less well from every start.
#[test]
fn another_start_that_would_not_help_is_not_advised() {
    let e = of_body([0.02, 2.0, 2.01], Vector3::repeat(0.6), 1e-3, 60);
    let [least, .., most] = e.identifiability.deviations;
    assert!(most > 10.0 * least, "{:?}", e.identifiability.deviations);
    let is_other = |step: &NextStep| matches!(step, NextStep::OtherStart { .. });
    assert!(!e.next_steps().iter().any(is_other), "{:?}", e.next_steps());
}

/// Attitudes have no systematic lines: noise is the largest error that is known, and four times the record at least halves it.
#[test]
fn of_attitudes_noise_is_the_largest_error_that_is_known() {
    let body = Inertia::from_moments([1.0, 2.0, 2.6]).unwrap();
    let of = |seconds: u32| {
        let times: Vec<f64> = (0..20 * seconds).map(|i| f64::from(i) / 20.0).collect();
        let omega = Vector3::new(0.5, 1.0, 0.4);
        let (none, no_rates) = (Disturbances::default(), Gyroscope::default());
        let made = simulate_poses(&body, omega, &times, &none, &no_rates, 0.01, &mut Random::new(8)).unwrap();
        fit_poses(&Poses::new("markers", &times, &made.attitudes).unwrap(), &Settings::default()).unwrap()
    };
    let (short, long) = (of(10), of(40));
    assert_eq!(short.next_steps().first(), Some(&NextStep::Longer));
    for k in 0..3 {
        assert!(long.sigma_principal[k] < 0.5 * short.sigma_principal[k], "{k}");
    }
}

/// Further parts of a record that contradicts itself do not make its answer surer.
#[test]
fn what_contradicts_the_fit_comes_before_a_longer_record() {
    let body = Inertia::from_moments([1.0, 2.0, 2.6]).unwrap();
    let times: Vec<f64> = (0..3000).map(|i| f64::from(i) / 50.0).collect();
    let gyroscope = Gyroscope::default().with_noise(0.02).with_offset(Vector3::new(0.03, -0.03, 0.03));
    let omega = Vector3::new(0.5, 1.0, 0.4);
    let none = Disturbances::default();
    let rates = simulate_with(&body, omega, &times, &none, &gyroscope, &mut Random::new(5)).unwrap();
    let e = fit(&Record::from_samples(&times, &rates).unwrap(), &Settings::default()).unwrap();
    let steps = e.next_steps();
    let NextStep::FindCause(Contradiction::LeftOut { origin: Origin::Sensor, .. }) = steps[0] else {
        panic!("{steps:?}: {:?}", e.warnings)
    };
    assert!(
        steps[0].to_string().starts_with("calibrate the sensor") && !steps.contains(&NextStep::Longer),
        "{steps:?}"
    );
}

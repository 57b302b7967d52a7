//! What a report advises: the largest error first, and a start that tells more.

use nalgebra::Vector3;
use polhode::inertia::Inertia;
use polhode::num::Random;
use polhode_fit::{Estimate, NextStep, Record, Settings, fit, simulate};

fn fitted(omega: Vector3<f64>, noise: f64, seconds: u32) -> Estimate {
    let body = Inertia::from_moments([1.0, 2.0, 2.6]).unwrap();
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

    let noisy = fitted(tumbling, 0.1, 20);
    assert_eq!(noisy.next_steps().first(), Some(&NextStep::Longer));
}

/// Next to a steady spin about axis 3 the turn of the axes about it is known worst; a start across the axis knows it better.
#[test]
fn a_start_across_the_weakest_axis_tells_more() {
    let weak = fitted(Vector3::new(0.02, 0.02, 1.0), 1e-3, 60);
    let found = weak.next_steps().into_iter().find_map(|step| match step {
        NextStep::OtherStart { times, turn, number } => Some((times, turn, number)),
        _ => None,
    });
    let (times, turn, number) = found.unwrap();
    assert!(times > 10.0 && number == 3 && turn, "{times} {turn} {number}");
    let other = fitted(Vector3::new(0.7, 0.7, 0.2), 1e-3, 60);
    assert!(other.sigma_axes[2] < 0.2 * weak.sigma_axes[2], "{:?} {:?}", other.sigma_axes, weak.sigma_axes);
    assert!(!other.next_steps().iter().any(|step| matches!(step, NextStep::OtherStart { .. })));
}

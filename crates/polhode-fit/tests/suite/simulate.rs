//! Simulated records against closed forms of the motion and against the stated errors of the sensor.

use nalgebra::{Matrix3, Vector3};
use polhode::body::Wheel;
use polhode::inertia::Inertia;
use polhode::num::Random;
use polhode_fit::{Disturbances, Gyroscope, SimulationError, simulate, simulate_poses, simulate_with};

fn grid(until: f64, count: usize) -> Vec<f64> {
    (0..=count).map(|i| until * i as f64 / count as f64).collect()
}

fn undisturbed(body: &Inertia, omega: Vector3<f64>, times: &[f64], with: &Gyroscope) -> Vec<Vector3<f64>> {
    simulate_with(body, omega, times, &Disturbances::default(), with, &mut Random::new(3)).unwrap()
}

fn moved(body: &Inertia, omega: Vector3<f64>, times: &[f64], by: &Disturbances) -> Vec<Vector3<f64>> {
    simulate_with(body, omega, times, by, &Gyroscope::default(), &mut Random::new(3)).unwrap()
}

/// With u = (1 − e^(−kt))/k, ω(t) = e^(−kt) ω_free(u) solves J ω' + ω × J ω = −k J ω.
#[test]
fn relative_drag_is_free_motion_on_a_clock_that_slows_down() {
    let tensor = Matrix3::new(2.0, 0.3, -0.1, 0.3, 1.7, 0.2, -0.1, 0.2, 1.1);
    let body = Inertia::from_tensor(tensor * 1e-5).unwrap();
    let omega = Vector3::new(3.0, -8.0, 6.0);
    for k in [1e-3, 0.2, 3.0] {
        let times: Vec<f64> = grid(10.0, 317).into_iter().map(|t| t - 0.4).collect();
        let drag = Disturbances::default().with_relative_drag(k);
        let found = moved(&body, omega, &times, &drag);
        let clock: Vec<f64> = times.iter().map(|t| -libm::expm1(-k * t) / k).collect();
        let free = simulate(&body, omega, &clock, 0.0, &mut Random::new(1)).unwrap();
        for ((t, found), free) in times.iter().zip(&found).zip(&free) {
            let expected = free * libm::exp(-k * t);
            let error = (found - expected).norm() / expected.norm();
            assert!(error < 1e-12, "k {k}, t {t}: {error:e}");
        }
    }
}

#[test]
fn torque_and_viscous_drag_change_a_spin_as_they_must() {
    let body = Inertia::from_moments([1.0, 2.0, 2.6]).unwrap();
    let times = grid(30.0, 50);
    let spin = Vector3::new(0.0, 0.0, 2.0);
    let torque = Disturbances::default().with_torque(Vector3::new(0.0, 0.0, 0.3));
    let drag = Disturbances::default().with_drag(Vector3::new(0.1, 0.2, 0.3));
    let (torque, drag) = (moved(&body, spin, &times, &torque), moved(&body, spin, &times, &drag));
    for (i, t) in times.iter().enumerate() {
        assert!((torque[i].z - (2.0 + 0.3 / 2.6 * t)).abs() < 1e-13);
        assert!((drag[i].z - 2.0 * libm::exp(-0.3 / 2.6 * t)).abs() < 1e-14);
    }
    // a torque on a body at rest
    let rest = moved(
        &body,
        Vector3::zeros(),
        &times,
        &Disturbances::default().with_torque(Vector3::new(0.5, 0.0, 0.0)),
    );
    assert!((rest[50].x - 15.0).abs() < 1e-13, "{}", rest[50].x);
}

/// The transverse rate of a symmetric body with a wheel h on its axis turns at ((I₃ − I₁) ω₃ + h)/I₁.
#[test]
fn a_wheel_on_the_axis_shifts_the_nutation() {
    let body = Inertia::from_moments([2.0, 2.0, 3.0]).unwrap();
    let wheel = Disturbances::default().with_wheel(Vector3::new(0.0, 0.0, 1.5));
    let times = grid(40.0, 80);
    let found = moved(&body, Vector3::new(0.4, 0.0, 1.0), &times, &wheel);
    let rate = ((3.0 - 2.0) * 1.0 + 1.5) / 2.0;
    for (t, w) in times.iter().zip(&found) {
        let expected = Vector3::new(0.4 * libm::cos(rate * t), 0.4 * libm::sin(rate * t), 1.0);
        assert!((w - expected).norm() < 1e-12, "{t}: {w} {expected}");
    }
    // a wheel that spins up takes its momentum from the body
    let ramp = Disturbances::default().with_wheel_rate(Vector3::new(0.0, 0.0, 0.6));
    let found = moved(&body, Vector3::new(0.0, 0.0, 1.0), &times, &ramp);
    for (t, w) in times.iter().zip(&found) {
        assert!((w.z - (1.0 - 0.2 * t)).abs() < 1e-13);
    }
}

/// ω of a ball is its start plus a Wiener process; the variance of its sample variance is 2/n.
#[test]
fn white_torque_makes_a_ball_walk() {
    let body = Inertia::from_moments([2.0; 3]).unwrap();
    let by = Disturbances::default().with_torque_noise(0.3);
    let mut random = Random::new(8);
    let (mut half, mut whole, mut both) = (0.0, 0.0, 0.0);
    for _ in 0..1000 {
        let w =
            simulate_with(&body, Vector3::zeros(), &[0.0, 2.0, 4.0], &by, &Gyroscope::default(), &mut random)
                .unwrap();
        half += w[1].norm_squared() / 3000.0;
        whole += w[2].norm_squared() / 3000.0;
        both += w[1].dot(&(w[2] - w[1])) / 3000.0;
    }
    let unit = 0.15 * 0.15;
    let near = |found: f64, expected: f64| {
        (found - expected * unit).abs() < 4.0 * unit * 4.0 * (2.0_f64 / 3000.0).sqrt()
    };
    assert!(near(half, 2.0) && near(whole, 4.0) && near(both, 0.0), "{half} {whole} {both}");
}

#[test]
fn the_sensor_errs_as_it_is_told_to() {
    let body = Inertia::from_moments([1.0, 2.0, 2.6]).unwrap();
    let omega = Vector3::new(0.3, 1.0, 0.4);
    let times = grid(20.0, 4000);
    let none = Gyroscope::default();
    let exact = undisturbed(&body, omega, &times, &none);
    let linear = none
        .clone()
        .with_offset(Vector3::new(0.1, -0.2, 0.3))
        .with_scale(0.02)
        .with_axis_scales(Vector3::new(0.01, 0.0, -0.03))
        .with_misalignment(Vector3::new(0.01, 0.02, -0.03));
    let lean = Matrix3::new(1.0, 0.01, 0.02, 0.01, 1.0, -0.03, 0.02, -0.03, 1.0);
    let scales = Matrix3::from_diagonal(&Vector3::new(1.01, 1.0, 0.97)) * 1.02;
    for (w, read) in exact.iter().zip(undisturbed(&body, omega, &times, &linear)) {
        assert!((scales * lean * w + linear.offset - read).norm() < 1e-15);
    }
    // each axis is late by its own time
    let skew = Vector3::new(0.0, 0.004, -0.002);
    let late = undisturbed(&body, omega, &times, &none.clone().with_skew(skew));
    for k in 0..3 {
        let shifted: Vec<f64> = times.iter().map(|t| t + skew[k]).collect();
        let shifted = undisturbed(&body, omega, &shifted, &none);
        assert!(late.iter().zip(&shifted).all(|(a, b)| a[k] == b[k]));
    }
    let quantum = 0.0625;
    let stepped = undisturbed(&body, omega, &times, &none.clone().with_quantum(quantum));
    for (w, read) in exact.iter().zip(&stepped) {
        assert!((w - read).amax() <= 0.5 * quantum && (read / quantum).iter().all(|x| x.fract() == 0.0));
    }
    // the noise does not depend on what else is wrong
    let noisy = undisturbed(&body, omega, &times, &none.clone().with_noise(0.1));
    let both = none.clone().with_noise(0.1).with_spikes(0.02).with_spike_size(50.0);
    let spiked = undisturbed(&body, omega, &times, &both);
    let hit: Vec<Vector3<f64>> =
        noisy.iter().zip(&spiked).map(|(a, b)| b - a).filter(|d| d.norm() > 0.0).collect();
    assert!((40..=120).contains(&hit.len()), "{} spikes", hit.len()); // 80 ± 9
    assert!(hit.iter().all(|d| (d.norm() - 50.0).abs() < 1e-12 && (d.amax() - 50.0).abs() < 1e-12));
    // upwards and downwards on every axis
    assert!((0..3).all(|k| hit.iter().any(|d| d[k] > 49.0) && hit.iter().any(|d| d[k] < -49.0)));
    let noise: Vec<Vector3<f64>> = exact.iter().zip(&noisy).map(|(a, b)| b - a).collect();
    let variance = noise.iter().map(|n| n.norm_squared()).sum::<f64>() / (3.0 * noise.len() as f64);
    assert!((variance / 0.01 - 1.0).abs() < 4.0 * (2.0_f64 / 12_000.0).sqrt(), "{variance}");
    // increments of the walk
    let walking = undisturbed(&body, omega, &times, &none.clone().with_offset_walk(0.2));
    let walk: Vec<Vector3<f64>> = exact.iter().zip(&walking).map(|(a, b)| b - a).collect();
    let steps = walk.windows(2).map(|p| (p[1] - p[0]).norm_squared()).sum::<f64>() / 3.0;
    assert!(walk[0].norm() == 0.0 && (steps / (0.04 * 20.0) - 1.0).abs() < 0.15, "{steps}");
}

#[test]
fn the_same_seed_gives_the_same_record_and_another_body_of_the_same_shape_the_same_rates() {
    let make = |mass: f64, seed: u64| {
        let body = Inertia::from_moments([1.0, 2.0, 2.6].map(|i| i * mass)).unwrap();
        let by = Disturbances::default()
            .with_relative_drag(0.1)
            .with_drag(Vector3::new(0.01, 0.0, 0.02) * mass)
            .with_torque(Vector3::new(0.0, 0.01, 0.0) * mass)
            .with_torque_noise(0.01 * mass)
            .with_wheel(Vector3::new(0.0, 0.5, 0.0) * mass)
            .with_wheel_rate(Vector3::new(0.01, 0.0, 0.0) * mass);
        let sensor = Gyroscope::default().with_noise(0.01);
        let start = Vector3::new(0.3, 1.0, 0.4);
        simulate_with(&body, start, &grid(10.0, 200), &by, &sensor, &mut Random::new(seed)).unwrap()
    };
    assert_eq!(make(1.0, 5), make(1.0, 5));
    assert_ne!(make(1.0, 5), make(1.0, 6));
    assert_eq!(make(1.0, 5), make(libm::scalbn(1.0, -160), 5));
}

#[test]
fn what_cannot_be_simulated_is_refused_by_name() {
    let body = Inertia::from_moments([1.0, 2.0, 2.6]).unwrap();
    let refused = |omega: f64, time: f64, by: &Disturbances, with: &Gyroscope| {
        let omega = Vector3::new(omega, 1.0, 0.4);
        simulate_with(&body, omega, &[0.0, time], by, with, &mut Random::new(1)).unwrap_err().to_string()
    };
    let (free, good) = (Disturbances::default(), Gyroscope::default());
    assert!(refused(f64::NAN, 1.0, &free, &good).contains("NaN"));
    assert!(refused(0.1, f64::INFINITY, &free, &good).contains("time"));
    let noise = good.clone().with_noise(-0.1);
    assert_eq!(refused(0.1, 1.0, &free, &noise), "the noise is -0.1; give a finite number of at least 0");
    let spikes = good.clone().with_spikes(1.5);
    assert_eq!(refused(0.1, 1.0, &free, &spikes), "the share of spikes is 1.5; give a share from 0 to 1");
    let offset = good.clone().with_offset(Vector3::new(0.0, f64::NAN, 0.0));
    assert!(refused(0.1, 1.0, &free, &offset).starts_with("the offset is NaN"));
    let drag = free.clone().with_relative_drag(-1.0);
    assert!(refused(0.1, 1.0, &drag, &good).starts_with("the relative drag is -1"));
    let torque = free.clone().with_torque(Vector3::new(1e9, 0.0, 1e8));
    assert!(refused(0.1, 1e9, &torque, &good).contains("cannot be followed beyond"));
    let far = simulate_with(&body, Vector3::x(), &[1e9], &torque, &good, &mut Random::new(1));
    assert!(matches!(far, Err(SimulationError::TooFast { .. })));
}

/// Each number of the sensor and of what acts is refused by its name, where it is not finite, and where a size is negative.
#[test]
fn every_setting_of_a_simulation_is_checked_by_its_name() {
    let body = Inertia::from_moments([1.0, 2.0, 2.6]).unwrap();
    let refused = |by: &Disturbances, with: &Gyroscope| {
        let found = simulate_with(&body, Vector3::x(), &[0.0, 1.0], by, with, &mut Random::new(1));
        let Err(SimulationError::Setting { name, value, .. }) = found else { panic!("{found:?}") };
        (name, value.is_nan())
    };
    let (free, good, nan) = (Disturbances::default(), Gyroscope::default(), f64::NAN);
    let off = Vector3::new(0.0, 0.0, nan);
    for (name, by) in [
        ("the relative drag", free.clone().with_relative_drag(nan)),
        ("a drag", free.clone().with_drag(off)),
        ("a torque", free.clone().with_torque(off)),
        ("the noise of the torque", free.clone().with_torque_noise(nan)),
        ("a momentum of the wheel", free.clone().with_wheel(off)),
        ("a change of the wheel's momentum", free.clone().with_wheel_rate(off)),
    ] {
        assert_eq!(refused(&by, &good), (name, true));
    }
    for (name, with) in [
        ("the noise", good.clone().with_noise(nan)),
        ("the offset", good.clone().with_offset(off)),
        ("the walk of the offset", good.clone().with_offset_walk(nan)),
        ("the scale error", good.clone().with_scale(nan)),
        ("a scale error of an axis", good.clone().with_axis_scales(off)),
        ("a misalignment", good.clone().with_misalignment(off)),
        ("a time skew", good.clone().with_skew(off)),
        ("the quantum", good.clone().with_quantum(nan)),
        ("the share of spikes", good.clone().with_spikes(nan)),
        ("the size of spikes", good.clone().with_spike_size(nan)),
    ] {
        assert_eq!(refused(&free, &with), (name, true));
    }
    for (by, with) in [
        (free.clone().with_drag(-Vector3::y()), good.clone()),
        (free.clone().with_torque_noise(-1.0), good.clone()),
        (free.clone(), good.clone().with_offset_walk(-1.0)),
        (free.clone(), good.clone().with_quantum(-1.0)),
        (free.clone(), good.clone().with_spikes(-0.1)),
        (free.clone(), good.clone().with_spike_size(-1.0)),
    ] {
        assert!(!refused(&by, &with).1);
    }
}

/// Rates of another simulation are read with the errors of the same seed; a skew, and another number of rates than times, are refused.
#[test]
fn rates_of_another_simulation_are_read_with_the_same_errors() {
    let body = Inertia::from_moments([1.0, 2.0, 2.6]).unwrap();
    let (omega, times) = (Vector3::new(0.3, 1.0, 0.4), grid(2.0, 20));
    let exact = undisturbed(&body, omega, &times, &Gyroscope::default());
    // a spike on every sample is the largest share
    let with = Gyroscope::default().with_noise(0.1).with_offset_walk(0.2).with_scale(0.5);
    let with = with.with_spikes(1.0).with_spike_size(8.0);
    let read = with.read(&times, &exact, &mut Random::new(3)).unwrap();
    assert_eq!(read, undisturbed(&body, omega, &times, &with));
    let refused = |with: &Gyroscope, rates: &[Vector3<f64>]| {
        let found = with.read(&times, rates, &mut Random::new(3));
        let Err(SimulationError::Setting { name, value, .. }) = found else { panic!("{found:?}") };
        (name, value)
    };
    let late = with.clone().with_skew(Vector3::new(0.0, 0.0, -0.25));
    assert_eq!(refused(&late, &exact), ("a time skew", -0.25));
    assert_eq!(refused(&with, &exact[1..]), ("the number of rates", 20.0));
}

/// Motors turn wheels against the body while they work, before time 0 as after it: on one axis the body loses what the wheels gain.
#[test]
fn motors_turn_the_body_back_while_they_work() {
    let body = Inertia::from_moments([1.0, 2.0, 2.6]).unwrap();
    let before = Vector3::new(0.0, 0.0, 0.5);
    let wheel = |inertia: f64, speed: f64| Wheel::new(Vector3::z() * 2.0, inertia, speed).unwrap();
    let wheels = vec![
        wheel(0.01, 30.0).driven(0.26, [-2.0, 1.5], before).unwrap(),
        wheel(0.02, -10.0).driven(-0.52, [2.0, 3.0], before).unwrap(),
    ];
    let (by, none) = (Disturbances::default().with_wheels(wheels), Gyroscope::default());
    let times: [f64; 10] = [-3.0, -2.0, -1.25, 0.0, 1.0, 1.5, 2.0, 2.5, 3.0, 7.0];
    let read = simulate_poses(&body, Vector3::z(), &times, &by, &none, 0.0, &mut Random::new(1)).unwrap();
    for (k, t) in times.iter().enumerate() {
        // how long each has worked, the first for 2 s before time 0
        let (one, two) = (t.clamp(-2.0, 1.5) + 2.0, t.clamp(2.0, 3.0) - 2.0);
        let turned = 1.0 - (0.26 * (one - 2.0) - 0.52 * two) / 2.6;
        assert!((read.rates[k] - Vector3::z() * turned).amax() < 1e-13, "{t}: {}", read.rates[k]);
        // relative to the body, which takes part in the turn of both
        let momentum = 0.01 * 30.5 + 0.26 * one - 0.02 * 9.5 - 0.52 * two - 0.03 * turned;
        assert!((read.wheel[k] - Vector3::z() * momentum).amax() < 1e-13, "{t}: {}", read.wheel[k]);
    }
}

/// A motion that is followed backwards, and from there forwards again, is the same in rates and attitudes.
#[test]
fn a_motion_followed_backwards_comes_back() {
    let tensor = Matrix3::new(2.0, 0.3, -0.1, 0.3, 1.7, 0.2, -0.1, 0.2, 1.1);
    let body = Inertia::from_tensor(tensor).unwrap();
    let by = Disturbances::default()
        .with_relative_drag(0.02)
        .with_drag(Vector3::new(0.01, 0.02, 0.03))
        .with_torque(Vector3::new(0.05, -0.03, 0.02))
        .with_wheel(Vector3::new(0.4, 0.0, -0.3));
    let of = |start: Vector3<f64>, times: &[f64]| {
        simulate_poses(&body, start, times, &by, &Gyroscope::default(), 0.0, &mut Random::new(1)).unwrap()
    };
    let start = Vector3::new(0.3, -0.8, 0.6);
    let back = of(start, &[-1.0, -5.0, 0.0]);
    let again = of(back.rates[1], &[4.0, 5.0]);
    assert!((back.rates[2] - start).amax() < 1e-14);
    for (k, earlier) in [(0, back.rates[0]), (1, start)] {
        assert!((again.rates[k] - earlier).amax() < 1e-11, "{k}: {} {earlier}", again.rates[k]);
    }
    for (k, earlier) in [(0, back.attitudes[0]), (1, back.attitudes[2])] {
        let apart = (back.attitudes[1] * again.attitudes[k]).inverse() * earlier;
        assert!(apart.imag().norm() < 1e-11, "{k}: {apart}");
    }
    assert!((again.rates[1] - again.rates[0]).amax() > 1e-2);
}

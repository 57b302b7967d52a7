//! Rates that are too sparse for the weak form.

use nalgebra::{Matrix3, UnitQuaternion, Vector3};
use polhode::{inertia::Inertia, num::Random};
use polhode_fit::{
    Contradiction, Disturbances, Estimate, FitError, Gyroscope, Method, NextStep, Origin, Record,
    SensorPriors, Settings, Warning, fit, simulate, simulate_with,
};

/// Half a sample a second of a body that turns by two radians in between, as of a satellite's beacon: the likelihood on the exact motion.
#[test]
fn sparse_telemetry_goes_to_the_likelihood() {
    let mut squares = 0.0;
    for stream in 0..6 {
        let mut random = Random::new(31).stream(stream);
        let turn = UnitQuaternion::from_scaled_axis(random.normal_vector()).to_rotation_matrix();
        let j =
            turn.matrix() * Matrix3::from_diagonal(&Vector3::new(1.0, 2.0, 2.6)) * turn.matrix().transpose()
                / 5.6;
        let body = Inertia::from_tensor((j + j.transpose()) * 0.5).unwrap();
        // well off every axis
        let omega =
            if stream < 3 { turn * Vector3::new(0.6, 0.6, -0.5) } else { random.normal_vector().normalize() };
        let times: Vec<f64> = (0..600).map(|i| 2.0 * f64::from(i)).collect();
        let rates = simulate(&body, omega, &times, 0.01, &mut random).unwrap();
        let e = match fit(&Record::from_samples(&times, &rates).unwrap(), &Settings::default()) {
            Ok(e) => e,
            Err(error) => {
                println!("{error}");
                continue;
            }
        };
        assert_eq!(e.method, Method::ExactMotion);
        assert!((e.noise_sigma / 0.01 - 1.0).abs() < 0.15 && e.mirror.is_some() && e.attitudes.is_none());
        for (k, moment) in [1.0, 2.0, 2.6].into_iter().enumerate() {
            let off = (e.principal[k] - moment / 5.6) / e.sigma_principal[k];
            squares += off * off;
            assert!(e.sigma_principal[k] < 1e-3);
        }
    }
    assert!((0.3..2.5).contains(&(squares / 18.0)), "{squares}");
}

/// Of a body that turns by two thirds of a radian from one sample to the next.
fn beacon(gyroscope: &Gyroscope) -> (Vec<f64>, Vec<Vector3<f64>>) {
    let body = Inertia::from_moments([1.0, 2.0, 2.6]).unwrap();
    let times: Vec<f64> = (0..124).map(|i| 0.65 * f64::from(i)).collect();
    let (omega, none) = (Vector3::new(0.3, 1.0, 0.4), Disturbances::default());
    let rates = simulate_with(&body, omega, &times, &none, gyroscope, &mut Random::new(8)).unwrap();
    (times, rates)
}

/// What the likelihood leaves out is told as by the weak form: samples that stand out, and segments that are too short.
#[test]
fn what_is_left_out_of_sparse_rates_is_told() {
    let gyroscope = Gyroscope::default().with_noise(0.01).with_spikes(0.06).with_spike_size(3.0);
    let (times, rates) = beacon(&gyroscope);
    let short = Record::from_samples(&times[..5], &rates[..5]).unwrap();
    let record = Record::from_samples(&times, &rates).unwrap().join(short);
    let e = fit(&record, &Settings::default()).unwrap();
    assert_eq!(e.method, Method::ExactMotion);
    let outliers = e.warnings.iter().find_map(|warning| match warning {
        Warning::Outliers { samples } => Some(*samples),
        _ => None,
    });
    let spikes = e.spikes.iter().filter(|spike| spike.segment == 0).count();
    let left_out = times.len() - e.samples;
    assert!(left_out > 0 && outliers.unwrap_or(0) + spikes == left_out, "{left_out}: {:?}", e.warnings);
    let is_of_spikes = |w: &Warning| matches!(w, Warning::Spikes { .. } | Warning::Bursts { .. });
    assert_eq!(e.warnings.iter().any(is_of_spikes), !e.spikes.is_empty());
    assert!(e.warnings.contains(&Warning::ShortSegments { short: 1, segments: 2 }), "{:?}", e.warnings);
}

/// The rounding of readings whose step is given is noise of the likelihood too.
#[test]
fn a_step_that_is_given_is_noise_of_sparse_rates() {
    let (times, rates) = beacon(&Gyroscope::default().with_noise(0.01));
    let record = Record::from_samples(&times, &rates).unwrap();
    let plain = fit(&record, &Settings::default()).unwrap();
    for (settings, noise) in [
        (Settings::default().with_quantum(0.1), 0.1 / 12.0_f64.sqrt()),
        (Settings::default().with_quantum(0.1).with_noise(0.02), (0.01_f64 / 12.0 + 4e-4).sqrt()),
    ] {
        let told = fit(&record, &settings).unwrap();
        assert!(plain.method == Method::ExactMotion && told.method == Method::ExactMotion);
        assert_eq!((plain.quanta, told.quanta), ([0.0; 3], [0.1; 3]));
        assert!((told.noise_sigma / noise - 1.0).abs() < 1e-6, "{} for {noise}", told.noise_sigma);
        for k in 0..3 {
            assert!((told.principal[k] - plain.principal[k]).abs() < 0.1 * plain.sigma_principal[k]);
            assert!(told.sigma_principal[k] > 2.0 * plain.sigma_principal[k]);
        }
    }
}

/// An offset that the motion of another tensor takes up for the most part is named, with its size, as it explains the record better than a torque.
#[test]
fn an_offset_of_sparse_rates_is_named() {
    let body = Inertia::from_moments([1.0, 2.0, 2.6]).unwrap();
    let times: Vec<f64> = (0..124).map(|i| 1.25 * f64::from(i)).collect();
    let (omega, none) = (Vector3::new(0.3, 1.0, 0.4), Disturbances::default());
    let of = |offset: f64, seed: u64| {
        let gyroscope = Gyroscope::default().with_noise(0.01).with_offset(Vector3::repeat(offset));
        let rates = simulate_with(&body, omega, &times, &none, &gyroscope, &mut Random::new(seed)).unwrap();
        let e = fit(&Record::from_samples(&times, &rates).unwrap(), &Settings::default()).ok()?;
        // a record that the weak form fits too has its own tests
        (e.method == Method::ExactMotion).then_some(e)
    };
    let named = |e: &Estimate| {
        e.warnings.iter().find_map(|warning| match warning {
            Warning::LeftOut { what, size, unit, origin: Origin::Sensor, .. } => Some((*what, *size, *unit)),
            _ => None,
        })
    };
    // two records of which the exact motion alone has the answer
    for seed in [2, 14] {
        if let Some(honest) = of(0.0, seed) {
            assert_eq!(named(&honest), None, "{seed}");
        }
        let off = of(0.01, seed).unwrap();
        let Some((what, size, unit)) = named(&off) else { panic!("{seed}: {:?}", off.warnings) };
        assert_eq!((what, unit), ("offsets of the sensor", "rad/s"), "{seed}");
        assert!((0.005..0.025).contains(&size), "{seed}: {size}");
        let remedy = NextStep::FindCause(Contradiction::LeftOut { what, origin: Origin::Sensor });
        assert_eq!(off.next_steps().first(), Some(&remedy), "{seed}");
    }
}

/// Errors of the sensor are fitted in the weak form alone: where only the likelihood on the exact motion has an answer, they are what is not told.
#[test]
fn errors_of_the_sensor_are_what_sparse_rates_do_not_tell() {
    let body = Inertia::from_moments([1.0, 2.0, 2.6]).unwrap();
    let times: Vec<f64> = (0..77).map(|i| 2.6 * f64::from(i)).collect();
    let settings = Settings::default().with_sensor(SensorPriors::default().with_offset(0.02));
    let mut named = 0;
    for seed in 0..3 {
        let mut random = Random::new(seed);
        let rates = simulate(&body, Vector3::new(0.3, 1.0, 0.4), &times, 3e-3, &mut random).unwrap();
        let record = Record::from_samples(&times, &rates).unwrap();
        if fit(&record, &Settings::default()).is_err() {
            continue;
        }
        match fit(&record, &settings) {
            Ok(_) => {}
            Err(FitError::UntoldSensor) => named += 1,
            Err(other) => {
                let is_of_motion = matches!(other, FitError::Unidentifiable(_) | FitError::NoRotation { .. });
                assert!(!is_of_motion, "seed {seed}: {other}");
            }
        }
    }
    assert!(named > 0);
}

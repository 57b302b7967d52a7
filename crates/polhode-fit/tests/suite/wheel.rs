//! The inertia of a wheel from a body that is known; segments whose sensors differ.

use nalgebra::Vector3;
use polhode::inertia::Inertia;
use polhode::num::Random;
use polhode_files::record::{self, ReadOptions};
use polhode_fit::{
    Disturbances, FitError, Gyroscope, Record, Segment, SensorPriors, Settings, TorqueModel, WheelWarning,
    calibrate_wheel, fit, simulate_with,
};

use crate::measured::{random_rotation, sampled, turned};

/// A wheel of 0.012 kg m² that runs up along an axis that is none of the body's.
const WHEEL: f64 = 0.012;

fn spun(
    body: &Inertia,
    acting: &Disturbances,
    gyroscope: &Gyroscope,
    seconds: usize,
    random: &mut Random,
) -> Record {
    let times = sampled(50, seconds);
    let axis = Vector3::new(0.6, 0.0, 0.8);
    // from 5 rad/s, 0.5 rad/s² more
    let acting = acting.clone().with_wheel(axis * (5.0 * WHEEL)).with_wheel_rate(axis * (0.5 * WHEEL));
    let omega = random.normal_vector().normalize();
    let rates = simulate_with(body, omega, &times, &acting, gyroscope, random).unwrap();
    let speeds = times.iter().map(|t| axis * (5.0 + 0.5 * t)).collect();
    let mut record = Record::default();
    record.segments.push(Segment::new("proof", times, rates).unwrap().with_wheel(speeds).unwrap());
    record
}

/// Errors over their deviations scatter by 1, over 60 records to √(1/120) = 0.09, over all to 0.046; 95 % of them lie within 1.96, to 0.028.
#[test]
fn a_wheel_is_calibrated_to_its_deviation() {
    let mut random = Random::new(81);
    let free = Disturbances::default();
    let drag = Disturbances::default().with_relative_drag(0.02);
    let turbulent = Disturbances::default().with_torque_noise(3e-3);
    let quiet = Gyroscope::default().with_noise(1e-3);
    let off = quiet.clone().with_offset(Vector3::new(0.01, -0.02, 0.01));
    let plain = Settings::default();
    let with_drag = Settings::default().with_torque(TorqueModel::Drag);
    let sensor = SensorPriors::default().with_offset(0.02);
    let with_offset = Settings::default().with_sensor(sensor);
    let mut all = Vec::new();
    for (name, acting, gyroscope, settings) in [
        ("free", &free, &quiet, &plain),
        ("drag", &drag, &quiet, &with_drag),
        ("torque noise", &turbulent, &quiet, &plain),
        ("offset", &free, &off, &with_offset),
    ] {
        let (mut squares, mut covered, count) = (0.0, 0, 60);
        for _ in 0..count {
            let body = Inertia::from_tensor(turned([1.0, 2.0, 2.6], &random_rotation(&mut random))).unwrap();
            let record = spun(&body, acting, gyroscope, 10, &mut random);
            let wheel = calibrate_wheel(&record, &body, settings).unwrap();
            let z = (wheel.inertia - WHEEL) / wheel.sigma;
            squares += z * z;
            covered += usize::from(z.abs() < 1.96);
        }
        let scatter = (squares / f64::from(count)).sqrt();
        println!("{name}: errors over deviations {scatter:.3}, coverage {covered} of {count}");
        assert!((0.63..1.37).contains(&scatter), "{name}: {scatter}");
        assert!(covered >= 50, "{name}: {covered}");
        all.push(scatter * scatter);
    }
    let all = (all.iter().sum::<f64>() / all.len() as f64).sqrt();
    assert!((0.82..1.18).contains(&all), "{all}");
}

/// Spikes are left out of a calibration, and spoil it where they are kept.
#[test]
fn spikes_are_left_out_of_a_calibration() {
    let body = Inertia::from_moments([1.0, 2.0, 2.6]).unwrap();
    let spiky = Gyroscope::default().with_noise(1e-3).with_spikes(0.01).with_spike_size(2.0);
    let record = spun(&body, &Disturbances::default(), &spiky, 20, &mut Random::new(83));
    let without = calibrate_wheel(&record, &body, &Settings::default()).unwrap();
    assert!((without.inertia - WHEEL).abs() < 5.0 * without.sigma && without.sigma < 0.05 * WHEEL);
    assert!((without.noise_sigma / 1e-3 - 1.0).abs() < 0.1 && without.samples < 1001);
    // of a radius that is given
    let given = calibrate_wheel(&record, &body, &Settings::default().with_radius(0.7)).unwrap();
    assert!((given.radius - 0.7).abs() < 1e-12 && (given.inertia - WHEEL).abs() < 5.0 * given.sigma);
    let kept = Settings::default().with_leave_out_spikes(false);
    let with = calibrate_wheel(&record, &body, &kept);
    assert!(with.is_err() || with.is_ok_and(|with| with.samples == 1001 && with.sigma > 5.0 * without.sigma));
}

/// Speeds of the wrong sign, torques that are not those of body and wheel, and a wheel that does not act.
#[test]
fn what_contradicts_a_calibration_is_said() {
    let body = Inertia::from_moments([1.0, 2.0, 2.6]).unwrap();
    let quiet = Gyroscope::default().with_noise(1e-3);
    let record = |acting: &Disturbances| spun(&body, acting, &quiet, 20, &mut Random::new(84));
    let calibrated = |record: &Record| calibrate_wheel(record, &body, &Settings::default());
    let with_speeds = |speed: f64, rates: &[Vector3<f64>]| {
        let times = sampled(50, 20);
        let speeds = times.iter().map(|t| Vector3::new(0.6, 0.0, 0.8) * (speed * (5.0 + 0.5 * t))).collect();
        let mut record = Record::default();
        let segment = Segment::new("proof", times, rates.to_vec()).unwrap();
        record.segments.push(segment.with_wheel(speeds).unwrap());
        record
    };
    let plain = record(&Disturbances::default());
    let right = calibrated(&plain).unwrap();
    assert!(right.warnings.is_empty(), "{:?}", right.warnings);

    let reversed = calibrated(&with_speeds(-1.0, plain.segments[0].rates())).unwrap_err();
    let FitError::WheelSense { value, sigma } = reversed else { panic!("{reversed}") };
    assert!((value + WHEEL).abs() < 5.0 * sigma && value < -5.0 * sigma, "{value} {sigma}");
    assert!(reversed.to_string().contains("reverse the axis of the wheel"), "{reversed}");

    let turbulent = calibrated(&record(&Disturbances::default().with_torque_noise(3e-3))).unwrap();
    let said =
        |warning: &WheelWarning| matches!(warning, WheelWarning::TorqueNoise { density } if *density > 0.0);
    assert!(turbulent.warnings.iter().any(said), "{:?}", turbulent.warnings);
    let text = turbulent.warnings[0].to_string();
    assert!(text.contains("check the body, its axes, the axis of the wheel"), "{text}");

    let omega = Vector3::new(0.3, 1.0, 0.4);
    let free = Disturbances::default();
    let rates = simulate_with(&body, omega, &sampled(50, 20), &free, &quiet, &mut Random::new(85)).unwrap();
    let none = calibrated(&with_speeds(1.0, &rates)).unwrap();
    assert!(matches!(none.warnings[..], [WheelWarning::NoWheel { .. }]), "{:?}", none.warnings);
}

/// A unit of mass is that of the moment alone; in a unit of time a quarter as long rates are a quarter and their squares over the third power
/// of that, a density of accelerations, a sixty-fourth.
#[test]
fn a_calibration_goes_with_its_units() {
    let body = Inertia::from_moments([1.0, 2.0, 2.6]).unwrap();
    let read = Gyroscope::default().with_noise(1e-3).with_offset(Vector3::new(0.01, -0.02, 0.01));
    let turbulent = Disturbances::default().with_torque_noise(3e-3);
    let record = spun(&body, &turbulent, &read, 20, &mut Random::new(84));
    let of = |mass: f64, time: f64| {
        let own = &record.segments[0];
        let slow = |list: &[Vector3<f64>]| list.iter().map(|w| w / time).collect::<Vec<_>>();
        let times = own.times().iter().map(|t| t * time).collect();
        let segment = Segment::new("proof", times, slow(own.rates())).unwrap();
        let mut record = Record::default();
        record.segments.push(segment.with_wheel(slow(own.wheel().unwrap())).unwrap());
        let settings = Settings::default().with_sensor(SensorPriors::default().with_offset(0.02 / time));
        calibrate_wheel(&record, &Inertia::from_tensor(body.tensor() * mass).unwrap(), &settings).unwrap()
    };
    let (one, other) = (of(1.0, 1.0), of(0.125, 4.0));
    let density = |warnings: &[WheelWarning]| match warnings {
        [WheelWarning::TorqueNoise { density }, ..] => *density,
        other => panic!("{other:?}"),
    };
    assert_eq!((one.dof, one.samples, one.segments), (other.dof, other.samples, other.segments));
    assert_eq!(one.nuisances.len(), 3);
    let [own, scaled] = [&one, &other].map(|of| [of.nuisances[1].value, of.nuisances[1].sigma]);
    for (ratio, expected) in [
        (other.inertia / one.inertia, 0.125),
        (other.sigma / one.sigma, 0.125),
        (other.radius / one.radius, 4.0),
        (other.noise_sigma / one.noise_sigma, 0.25),
        (other.chi2_per_dof / one.chi2_per_dof, 1.0),
        (scaled[0] / own[0], 0.25),
        (scaled[1] / own[1], 0.25),
        (density(&other.warnings) / density(&one.warnings), 1.0 / 64.0),
    ] {
        assert!((ratio / expected - 1.0).abs() < 1e-9, "{ratio} {expected}");
    }
    // the torque over the moments, the mean of the squares of whose inverses is 0.466
    let expected = 9e-6 * (1.0 + 0.25 + 1.0 / 6.76) / 3.0;
    assert!((0.1..10.0).contains(&(density(&one.warnings) / expected)), "{:?}", one.warnings);
    assert!((0.5..2.0).contains(&(one.noise_sigma / 1e-3)), "{}", one.noise_sigma);
}

#[test]
fn what_cannot_be_calibrated_is_refused() {
    let body = Inertia::from_moments([1.0, 2.0, 2.6]).unwrap();
    let quiet = Gyroscope::default().with_noise(1e-3);
    let record = spun(&body, &Disturbances::default(), &quiet, 10, &mut Random::new(82));
    let bare =
        |segment: &Segment| Segment::new("bare", segment.times().to_vec(), segment.rates().to_vec()).unwrap();
    let mut none = Record::default();
    none.segments.push(bare(&record.segments[0]));
    assert_eq!(calibrate_wheel(&none, &body, &Settings::default()), Err(FitError::NoWheelSpeed));
    let mut still = none.clone();
    let count = still.segments[0].times().len();
    still.segments[0] = still.segments[0].clone().with_wheel(vec![Vector3::zeros(); count]).unwrap();
    assert_eq!(calibrate_wheel(&still, &body, &Settings::default()), Err(FitError::NoWheelSpeed));
    let mut pushed = record.clone();
    pushed.segments[0] = pushed.segments[0].clone().with_torque(vec![Vector3::x(); count]).unwrap();
    assert_eq!(calibrate_wheel(&pushed, &body, &Settings::default()), Err(FitError::WheelWithTorques));

    // one segment with a wheel, one without
    let mixed = record.join(none);
    for error in [
        fit(&mixed, &Settings::default()).unwrap_err(),
        calibrate_wheel(&mixed, &body, &Settings::default()).unwrap_err(),
    ] {
        let text = error.to_string();
        assert!(text.contains("segment 1 (proof, from 0 s) has wheel momenta"), "{text}");
        assert!(text.contains("segment 2 (bare, from 0 s) has none"), "{text}");
    }
}

#[test]
fn a_named_unit_beside_a_guessed_one_is_refused() {
    let read = |unit: &str, name: &str| {
        let mut text = format!("t,wx{unit},wy{unit},wz{unit}\n");
        for i in 0..100 {
            text += &format!("{},{},{},2\n", 0.01 * f64::from(i), i % 7, i % 5);
        }
        record::read(&text, name, &ReadOptions::default()).unwrap().record
    };
    let mixed = read(" (deg/s)", "a.csv").join(read("", "b.csv"));
    let text = fit(&mixed, &Settings::default()).unwrap_err().to_string();
    assert!(text.contains("segment 1 (a.csv, from 0 s) is in deg/s by its header"), "{text}");
    assert!(text.contains("segment 2 (b.csv, from 0 s) names no unit"), "{text}");
    for same in
        [read(" (deg/s)", "a.csv").join(read(" (rad/s)", "b.csv")), read("", "a.csv").join(read("", "b.csv"))]
    {
        let error = fit(&same, &Settings::default()).err();
        assert!(!matches!(error, Some(FitError::MixedUnits { .. })), "{error:?}");
    }
}

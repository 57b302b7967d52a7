//! Whole answers, every field of them, beside those of an earlier build in `tests/data/fit/answers.txt`.
//!
//! No truth is told here: the other tests compare with it. This one notices what they do not look at: starts and windows of searches, the
//! order of fallbacks, single fields of a report. Numbers agree to 1e-5, since the solvers differ between processors in the last digits. An
//! intended change is written with `POLHODE_BLESS=1`, and the commit says why the answers move.

use core::fmt::Debug;
use std::fs;
use std::path::Path;

use nalgebra::{Matrix3, UnitQuaternion, Vector3};
use polhode::inertia::Inertia;
use polhode::num::Random;
use polhode_fit::{
    CarrierRecords, Disturbances, FitError, Gyroscope, Known, Limit, Poses, Prior, ProofBody, Record,
    Segment, SensorPriors, Settings, TorqueModel, TorqueNoise, calibrate_wheel, fit, fit_carrier, fit_poses,
    flights, simulate_poses, simulate_with,
};

use crate::measured::{random_rotation, sampled, turned};

/// Fields with more numbers are told by their count, sum and sum of squares.
const SHOWN: usize = 20;

/// Relative, of each number.
const AGREEMENT: f64 = 1e-5;

/// Numbers so much smaller than the largest of their field are its rounding.
const ROUNDING: f64 = 1e-9;

const START: Vector3<f64> = Vector3::new(0.4, 0.9, -0.5);
const NOISE: f64 = 2e-3;

fn tensor(moments: [f64; 3]) -> Matrix3<f64> {
    turned(moments, &random_rotation(&mut Random::new(7)))
}

fn body() -> Inertia {
    Inertia::from_tensor(tensor([1.0, 2.0, 2.6])).unwrap()
}

fn free() -> Disturbances {
    Disturbances::default()
}

fn quiet() -> Gyroscope {
    Gyroscope::default().with_noise(NOISE)
}

/// 20 Hz for half a minute.
fn times() -> Vec<f64> {
    sampled(20, 30)
}

fn read(body: &Inertia, start: Vector3<f64>, times: &[f64], by: &Disturbances, with: &Gyroscope) -> Record {
    let rates = simulate_with(body, start, times, by, with, &mut Random::new(11)).unwrap();
    Record::from_samples(times, &rates).unwrap()
}

fn record(by: &Disturbances, with: &Gyroscope) -> Record {
    read(&body(), START, &times(), by, with)
}

/// A body of these moments, turning about `start`.
fn shaped(moments: [f64; 3], start: Vector3<f64>) -> Record {
    read(&Inertia::from_tensor(tensor(moments)).unwrap(), start, &times(), &free(), &quiet())
}

/// With the momentum that is told of wheels, or the torque.
fn told(by: &Disturbances, wheel: Option<f64>, torque: Option<Vector3<f64>>) -> Record {
    let times = times();
    let rates = simulate_with(&body(), START, &times, by, &quiet(), &mut Random::new(11)).unwrap();
    let mut segment = Segment::new("told", times.clone(), rates).unwrap();
    if let Some(factor) = wheel {
        let of = |t: &f64| by.wheel_at(*t).component_mul(&Vector3::new(factor, 1.0, 1.0));
        segment = segment.with_wheel(times.iter().map(of).collect()).unwrap();
    }
    if let Some(torque) = torque {
        segment = segment.with_torque(vec![torque; times.len()]).unwrap();
    }
    let mut record = Record::default();
    record.segments.push(segment);
    record
}

/// A hand at work: three sines a component.
fn driven() -> Record {
    let rate = |t: f64, k: usize| {
        (1..4).map(|n| libm::sin(t * (0.7 * n as f64 + 0.31 * k as f64) + k as f64) / n as f64).sum()
    };
    let times = times();
    let rates: Vec<_> = times.iter().map(|t| Vector3::from_fn(|k, _| rate(*t, k))).collect();
    Record::from_samples(&times, &rates).unwrap()
}

/// Still, thrown, held, thrown.
fn recording() -> Record {
    let mut random = Random::new(13);
    let (mut times, mut rates) = (Vec::new(), Vec::new());
    let mut add = |part: Vec<Vector3<f64>>| {
        for rate in part {
            times.push(times.len() as f64 / 100.0);
            rates.push(rate);
        }
    };
    let span: Vec<f64> = sampled(100, 1);
    let throw = |start: [f64; 3], random: &mut Random| {
        simulate_with(&body(), start.into(), &span, &free(), &quiet().with_noise(0.01), random).unwrap()
    };
    add((0..80).map(|_| random.normal_vector() * 0.01).collect());
    add(throw([2.0, 9.0, 4.0], &mut random));
    add(driven().segments[0].rates()[..150].to_vec());
    add(throw([8.0, 1.0, 3.0], &mut random));
    Record::from_samples(&times, &rates).unwrap()
}

fn poses(by: &Disturbances, sigma: f64) -> (Vec<f64>, Vec<UnitQuaternion<f64>>, Vec<Vector3<f64>>) {
    let times = sampled(10, 30);
    let made = simulate_poses(&body(), START, &times, by, &quiet(), sigma, &mut Random::new(17)).unwrap();
    (times, made.attitudes, made.rates)
}

/// Carrier, carrier with proof body, carrier with object; all carry a wheel.
fn bench() -> CarrierRecords {
    let of = |moments: [f64; 3], seed| turned(moments, &random_rotation(&mut Random::new(seed)));
    let carrier = of([0.010, 0.017, 0.021], 1);
    let (object, proof) = (of([0.004, 0.006, 0.009], 2), of([0.003, 0.011, 0.012], 3));
    let axis = Vector3::new(0.6, 0.0, 0.8) * 2e-4;
    let by = free().with_wheel(axis * 40.0).with_wheel_rate(axis * 8.0);
    let times = sampled(40, 8);
    let record = |tensor: Matrix3<f64>, start: [f64; 3], seed| {
        let body = Inertia::from_tensor(tensor).unwrap();
        let mut random = Random::new(seed);
        let rates = simulate_with(&body, start.into(), &times, &by, &quiet(), &mut random).unwrap();
        let momenta = times.iter().map(|t| by.wheel_at(*t)).collect();
        let mut record = Record::default();
        record
            .segments
            .push(Segment::new("bench", times.clone(), rates).unwrap().with_wheel(momenta).unwrap());
        record
    };
    CarrierRecords::new(record(carrier, [1.0, 2.5, 1.5], 21))
        .with_proof(record(carrier + proof, [2.0, 1.0, 2.0], 22), ProofBody::adding(proof).unwrap())
        .with_object(record(carrier + object, [-1.0, 2.0, 2.0], 23))
}

/// The fields of a value, one a line, and those of what follows from it.
fn lines(value: &impl Debug) -> Vec<String> {
    let text = format!("{value:#?}");
    let mut fields: Vec<String> = Vec::new();
    for line in text.lines() {
        let begins = line.starts_with("    ") && !line[4..].starts_with([' ', ']', '}', ')']);
        match fields.last_mut() {
            Some(last) if !begins => {
                last.push(' ');
                last.push_str(line.trim());
            }
            _ => fields.push(line.trim().into()),
        }
    }
    // the certificate is rounding, and what a record leaves open has any basis
    let has_digits =
        |field: &&String| !["certificate", "Identifiability"].iter().any(|name| field.starts_with(name));
    fields.iter().filter(has_digits).map(|field| shown(field)).collect()
}

/// Words and numbers without brackets, numbers to seven digits.
fn shown(field: &str) -> String {
    let words: Vec<&str> =
        field.split(|c: char| c.is_whitespace() || "[](){},".contains(c)).filter(|w| !w.is_empty()).collect();
    let numbers: Vec<f64> = words.iter().filter_map(|word| word.parse().ok()).collect();
    if numbers.len() > SHOWN {
        let finite = || numbers.iter().filter(|x| x.is_finite());
        let (sum, squares) = (finite().sum::<f64>(), finite().map(|x| x * x).sum::<f64>());
        return format!("{} numbers {} sum {sum:.6e} squares {squares:.6e}", words[0], numbers.len());
    }
    let word = |word: &&str| word.parse::<f64>().map_or(word.to_string(), |x| format!("{x:.6e}"));
    words.iter().map(word).collect::<Vec<_>>().join(" ")
}

fn of_fit(record: &Record, settings: &Settings) -> Vec<String> {
    told_by(fit(record, settings), Some(record))
}

fn told_by(found: Result<polhode_fit::Estimate, FitError>, record: Option<&Record>) -> Vec<String> {
    let estimate = match found {
        Ok(estimate) => estimate,
        Err(error) => return [lines(&error), vec![shown(&format!("says: {error}"))]].concat(),
    };
    let mut all = lines(&estimate);
    let rms = |record: &Record| estimate.fitted(record).iter().map(|motion| motion.rms()).collect::<Vec<_>>();
    all.push(shown(&format!("motions: {:?}", record.map(rms))));
    all.push(shown(&format!("next: {:?}", estimate.next_steps())));
    all.push(shown(&format!("verdict: {}", estimate.identifiability.verdict())));
    all.extend(estimate.warnings.iter().map(|warning| shown(&format!("warns: {warning}"))));
    all
}

/// Each answer with the name of its case.
fn answers() -> Vec<(&'static str, Vec<String>)> {
    let plain = Settings::default();
    let sensor = |sensor| plain.clone().with_sensor(sensor);
    let torque = |model| plain.clone().with_torque(model);
    let off = Vector3::new(0.01, -0.02, 0.015);
    let constant = free().with_torque(Vector3::new(4e-3, -2e-3, 6e-3));
    let drag = free().with_relative_drag(2e-3);
    let noisy = free().with_torque_noise(2e-2);
    let everything = quiet().with_offset(off).with_scale(0.01).with_axis_scales(off).with_misalignment(off);
    let priors = SensorPriors::default()
        .with_offset(0.02)
        .with_scale(0.02)
        .with_axis_scales(0.02)
        .with_misalignment(0.02)
        .with_skew(1e-3);
    let held = free().with_wheel(Vector3::new(0.3, 0.0, 0.4));
    let up = held.clone().with_wheel_rate(Vector3::new(0.03, 0.01, 0.0));
    let known_torque = Vector3::new(4e-3, -2e-3, 6e-3);
    let limit = Limit { axis: Vector3::new(1.0, 1.0, 0.0), at_least: Some(0.4), at_most: None };
    let degrees = |record: Record| {
        let rates: Vec<_> = record.segments[0].rates().iter().map(|w| w.map(f64::to_degrees)).collect();
        Record::from_samples(record.segments[0].times(), &rates).unwrap()
    };
    let clipped = |record: Record| {
        let rates: Vec<_> =
            record.segments[0].rates().iter().map(|w| w.map(|x| x.clamp(-0.6, 0.6))).collect();
        Record::from_samples(record.segments[0].times(), &rates).unwrap()
    };
    let second = || read(&body(), Vector3::new(-0.7, 0.3, 0.6), &sampled(20, 20), &drag, &quiet());
    let other = || shaped([1.0, 2.0, 2.3], Vector3::new(-0.7, 0.3, 0.6));
    let steady = body().principal_axes() * Vector3::new(0.0, 0.0, 1.0);
    let near = |axis: [f64; 3]| body().principal_axes() * Vector3::from(axis);
    let moments = [1.0, 2.0, 2.6];

    let rates: Vec<(&'static str, Record, Settings)> = vec![
        ("free", record(&free(), &quiet()), plain.clone()),
        ("much noise", record(&free(), &quiet().with_noise(0.1)), plain.clone()),
        (
            "noise and radius told",
            record(&free(), &quiet()),
            plain.clone().with_noise(NOISE).with_radius(0.8),
        ),
        ("drag", record(&drag, &quiet()), plain.clone()),
        (
            "drag about three axes",
            record(&free().with_drag(Vector3::new(2e-3, 0.02, 5e-3)), &quiet()),
            plain.clone(),
        ),
        ("quadratic drag asked for", record(&drag, &quiet()), torque(TorqueModel::Quadratic)),
        ("constant torque", record(&constant, &quiet()), plain.clone()),
        (
            "constant torque asked for, no noise of it",
            record(&constant, &quiet()),
            torque(TorqueModel::Constant).with_torque_noise(TorqueNoise::None),
        ),
        ("torque noise", record(&noisy, &quiet()), plain.clone()),
        (
            "torque noise told",
            record(&noisy, &quiet()),
            plain.clone().with_torque_noise(TorqueNoise::Given(4e-3)),
        ),
        (
            "constant torque and noise of it",
            record(&constant.clone().with_torque_noise(5e-3), &quiet()),
            plain.clone(),
        ),
        ("offset", record(&free(), &quiet().with_offset(off)), plain.clone()),
        (
            "offset with a prior",
            record(&free(), &quiet().with_offset(off)),
            sensor(SensorPriors::default().with_offset(0.02)),
        ),
        ("every error of the sensor with priors", record(&free(), &everything), sensor(priors)),
        ("misaligned", record(&free(), &quiet().with_misalignment(off)), plain.clone()),
        ("skew", record(&free(), &quiet().with_skew(Vector3::new(0.0, 4e-3, -4e-3))), plain.clone()),
        ("offset that walks", record(&free(), &quiet().with_offset_walk(2e-3)), plain.clone()),
        ("steps", record(&free(), &quiet().with_quantum(0.02)), plain.clone()),
        ("steps told", record(&free(), &quiet().with_quantum(0.02)), plain.clone().with_quantum(0.02)),
        ("spikes", record(&free(), &quiet().with_spikes(0.02).with_spike_size(1.0)), plain.clone()),
        (
            "spikes kept",
            record(&free(), &quiet().with_spikes(0.02).with_spike_size(1.0)),
            plain.clone().with_leave_out_spikes(false),
        ),
        ("clipped", clipped(record(&free(), &quiet())), plain.clone()),
        ("2 Hz", read(&body(), START, &sampled(2, 150), &free(), &quiet()), plain.clone()),
        (
            "0.5 Hz",
            read(
                &body(),
                START,
                &(0..400).map(|k| 2.0 * f64::from(k)).collect::<Vec<_>>(),
                &free(),
                &quiet(),
            ),
            plain.clone(),
        ),
        ("two segments with drag", record(&drag, &quiet()).join(second()), plain.clone()),
        ("segments of two bodies", record(&free(), &quiet()).join(other()), plain.clone()),
        ("needle", shaped([0.03, 1.0, 1.01], START), plain.clone()),
        ("nearly a sphere", shaped([1.0, 1.02, 1.04], START), plain.clone()),
        ("symmetric", shaped([1.0, 1.0, 1.8], START), plain.clone()),
        ("lamina", shaped([1.0, 2.0, 3.0], START), plain.clone()),
        ("steady spin", shaped(moments, steady), plain.clone()),
        ("near the major axis", shaped(moments, near([0.02, 0.01, 1.0])), plain.clone()),
        ("near the middle axis", shaped(moments, near([0.02, 1.0, 0.01])), plain.clone()),
        ("deg/s taken for rad/s", degrees(record(&free(), &quiet())), plain.clone()),
        (
            "deg/s taken for rad/s, unchecked",
            degrees(record(&free(), &quiet())),
            plain.clone().with_check_units(false),
        ),
        ("driven", driven(), plain.clone()),
        ("short", read(&body(), START, &sampled(20, 2), &free(), &quiet()), plain.clone()),
        ("known trace", record(&free(), &quiet()), plain.clone().with_known(Known::Trace(5.6))),
        (
            "known moment",
            record(&free(), &quiet()),
            plain.clone().with_known(Known::Moment { axis: off, value: 2.0 }),
        ),
        ("known momentum", record(&free(), &quiet()), plain.clone().with_known(Known::Momentum(2.0))),
        ("known energy", record(&free(), &quiet()), plain.clone().with_known(Known::TwiceEnergy(2.0))),
        (
            "prior",
            record(&free(), &quiet()),
            plain.clone().with_prior(Prior::relative(tensor([1.01, 1.99, 2.61]), 0.01)),
        ),
        (
            "prior near a spin",
            shaped(moments, near([0.02, 0.01, 1.0])),
            plain.clone().with_prior(Prior::relative(tensor([1.01, 1.99, 2.61]), 0.01)),
        ),
        ("limit", record(&free(), &quiet()), plain.clone().with_limits(vec![limit])),
        ("wheel held", told(&held, Some(1.0), None), plain.clone()),
        ("wheel that runs up", told(&up, Some(1.0), None), plain.clone()),
        ("wheel told wrongly", told(&up, Some(1.3), None), plain.clone()),
        ("wheel not told", told(&held, None, None), plain.clone()),
        ("torque told", told(&constant, None, Some(known_torque)), plain.clone()),
    ];
    let mut all: Vec<_> =
        rates.iter().map(|(name, record, settings)| (*name, of_fit(record, settings))).collect();

    let of_poses = |poses: Poses, settings: &Settings| told_by(fit_poses(&poses, settings), None);
    for (name, by, sigma) in [
        ("attitudes", &free(), 5e-3),
        ("attitudes with drag", &drag, 5e-3),
        ("attitudes with a constant torque", &constant, 5e-3),
        ("attitudes with torque noise", &noisy, 1e-3),
        ("coarse attitudes", &free(), 0.1),
    ] {
        let (times, attitudes, _) = poses(by, sigma);
        all.push((name, of_poses(Poses::new("markers", &times, &attitudes).unwrap(), &plain)));
    }
    let (times, mut attitudes, rates) = poses(&free(), 5e-3);
    let mounted = random_rotation(&mut Random::new(3));
    let own: Vec<_> = rates.iter().map(|w| mounted * w).collect();
    let both = Poses::with_rates("both", &times, &attitudes, &own).unwrap();
    all.push(("attitudes beside rates of other axes", of_poses(both, &plain)));
    let poses = Poses::new("inverse", &times, &attitudes).unwrap();
    all.push(("attitudes of space to body", of_poses(poses.inverse().with_open_direction(), &plain)));
    attitudes[40] *= UnitQuaternion::from_axis_angle(&Vector3::x_axis(), 0.5);
    all.push(("an attitude that jumps", of_poses(Poses::new("jump", &times, &attitudes).unwrap(), &plain)));

    all.push((
        "carrier",
        fit_carrier(&bench(), &plain).map_or_else(|error| lines(&error), |found| lines(&found)),
    ));
    let wheel = calibrate_wheel(&told(&up, Some(1.0), None), &body(), &plain);
    all.push(("wheel calibrated", wheel.map_or_else(|error| lines(&error), |found| lines(&found))));
    let found = flights(&recording(), &plain);
    all.push(("flights", found.map_or_else(|error| lines(&error), |found| lines(&found))));
    all
}

/// Whether two lines say the same, numbers to within [`AGREEMENT`].
fn agree(found: &str, expected: &str) -> bool {
    let words = |line: &str| line.split(' ').map(String::from).collect::<Vec<_>>();
    let (found, expected) = (words(found), words(expected));
    let number = |word: &String| word.parse::<f64>().ok();
    let largest =
        expected.iter().filter_map(number).filter(|x| x.is_finite()).map(f64::abs).fold(0.0, f64::max);
    found.len() == expected.len()
        && found.iter().zip(&expected).all(|(a, b)| match (number(a), number(b)) {
            (Some(x), Some(y)) => {
                let size = x.abs().max(y.abs());
                x == y || (x - y).abs() <= AGREEMENT * size || size <= ROUNDING * largest
            }
            _ => a == b,
        })
}

#[test]
fn whole_answers_are_those_of_an_earlier_build() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/data/fit/answers.txt");
    let found = answers();
    let block = |(name, lines): &(&str, Vec<String>)| format!("== {name}\n{}\n", lines.join("\n"));
    if std::env::var_os("POLHODE_BLESS").is_some() {
        fs::write(&path, found.iter().map(block).collect::<String>()).unwrap();
    }
    let expected = fs::read_to_string(&path).unwrap();
    let mut blocks = expected.split("== ").skip(1);
    let mut different = Vec::new();
    for (name, lines) in &found {
        let (title, rest) = blocks.next().unwrap_or_default().split_once('\n').unwrap_or_default();
        assert_eq!(title, *name, "cases of the file");
        let rest: Vec<&str> = rest.lines().collect();
        if rest.len() != lines.len() {
            different.push(format!("{name}: {} lines for {}", lines.len(), rest.len()));
        }
        let pairs = lines.iter().zip(rest).filter(|(a, b)| !agree(a, b));
        different.extend(pairs.map(|(a, b)| format!("{name}: {a}\n  for {b}")));
    }
    assert!(blocks.next().is_none(), "the file has cases that are not here");
    assert!(different.is_empty(), "{} lines differ:\n{}", different.len(), different.join("\n"));
}

#[test]
fn agreement_sees_a_digit_and_a_word() {
    assert!(agree("a: 1.00000000e0 none", "a: 1.000001e0 none"));
    assert!(!agree("a: 1.0 none", "a: 1.0001 none") && !agree("a: 1.0 none", "a: 1.0 some"));
    assert!(!agree("a: 1.0", "a: 1.0 2.0") && agree("a: 1.0 1e-17", "a: 1.0 -3e-17"));
    assert!(!agree("a: 1e-5 1.0", "a: 2e-5 1.0"));
}

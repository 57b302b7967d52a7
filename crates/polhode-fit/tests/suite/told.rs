//! What only a model tells: the scale of a sensor by the torque, an offset that is taken for a torque.

use nalgebra::Matrix3;
use polhode::inertia::Inertia;
use polhode::num::Random;
use polhode_fit::{
    Disturbances, Gyroscope, Nuisance, Record, SensorPriors, Settings, TorqueModel, TorqueNoise, Warning,
    fit, simulate_with,
};

use crate::measured::torques::motion;
use crate::measured::{distance, entries, random_rotation, sampled, turned};

const SHAPE: [f64; 3] = [1.0 / 5.6, 2.0 / 5.6, 2.6 / 5.6];
/// Where the 99.9 % ellipsoid of five numbers ends.
const REGION: f64 = 20.515;

/// A record whose sensor has this error of scale.
fn scaled(
    shape: [f64; 3],
    seconds: usize,
    rate: f64,
    noise: f64,
    scale: f64,
    seed: u64,
) -> (Matrix3<f64>, Record) {
    let mut random = Random::new(seed);
    let j = turned(shape, &random_rotation(&mut random));
    let omega = random.normal_vector().normalize() * rate;
    let times = sampled(100, seconds);
    let sensor = Gyroscope::default().with_noise(noise).with_scale(scale);
    let body = Inertia::from_tensor(j).unwrap();
    let rates = simulate_with(&body, omega, &times, &Disturbances::default(), &sensor, &mut random).unwrap();
    (j, Record::from_samples(&times, &rates).unwrap())
}

/// Three unequal moments tell the scale; as a scale of nothing would leave no equation, the first round must not be free to choose it.
#[test]
fn a_scale_of_wide_prior_is_told_by_free_motion() {
    for (seconds, rate, noise) in [(1, 12.0, 0.02), (20, 1.0, 0.01)] {
        for (seed, prior) in [0.03, 0.1, 1.0, 10.0].into_iter().enumerate() {
            let (j, record) = scaled(SHAPE, seconds, rate, noise, 0.02, 300 + seed as u64);
            let settings = Settings::default().with_sensor(SensorPriors::default().with_scale(prior));
            let e = fit(&record, &settings).unwrap();
            let [scale] = &e.nuisances[..] else { panic!("{:?}", e.nuisances) };
            println!("{seconds} s, prior {prior}: scale {:.4} +- {:.4}", scale.value, scale.sigma);
            assert!(scale.sigma < prior && scale.sigma < 0.03, "{scale:?}");
            // ω = (1 + scale) y of readings y
            assert!((scale.value - (1.0 / 1.02 - 1.0)).abs() < 4.0 * scale.sigma, "{scale:?}");
            let off = distance(&entries(&(e.shape.tensor() - j)), &e.free_covariance);
            assert!(off < REGION, "{seconds} {prior}: {off}");
        }
    }
    // two equal moments tell none: the deviation is that of the prior, and the tensor has its part in it
    let (j, record) = scaled([0.2, 0.4, 0.4], 20, 1.0, 0.01, 0.03, 320);
    let settings = Settings::default().with_sensor(SensorPriors::default().with_scale(0.03));
    let e = fit(&record, &settings).unwrap();
    assert!((e.nuisances[0].sigma / 0.03 - 1.0).abs() < 0.1, "{:?}", e.nuisances);
    let off = entries(&(e.shape.tensor() - j));
    assert!(distance(&off, &e.free_covariance) < REGION);
    assert!(e.sigma_principal[0] > 1e-3, "{:?}", e.sigma_principal);
}

/// Tosses, on each of which a constant torque of its own acts, fitted with one; and the same without a torque.
#[test]
fn what_parts_of_a_record_differ_in_is_less_certain() {
    let times = sampled(100, 1);
    let settings =
        Settings::default().with_torque(TorqueModel::Constant).with_torque_noise(TorqueNoise::None);
    let (mut squares, mut named, count) = ([0.0; 2], 0, 3);
    for trial in 0..count {
        let mut random = Random::new(330 + trial);
        let j = turned(SHAPE, &random_rotation(&mut random));
        for (k, size) in [0.03, 0.0].into_iter().enumerate() {
            let mut record = Record::default();
            for _ in 0..16 {
                let omega = random.normal_vector().normalize() * (8.0 + 8.0 * random.uniform());
                let own = random.normal_vector() * size;
                let rates: Vec<_> = motion(&j, omega, &times, &|_, _| own)
                    .iter()
                    .map(|w| w + random.normal_vector() * 0.02)
                    .collect();
                record = record.join(Record::from_samples(&times, &rates).unwrap());
            }
            let e = fit(&record, &settings).unwrap();
            let differing = e.warnings.iter().find_map(|w| match w {
                Warning::Differing { unknowns } => Some(unknowns),
                _ => None,
            });
            let squared = |c: &Nuisance| (c.value / c.sigma) * (c.value / c.sigma);
            let sum: f64 = e.torque.coefficients.iter().map(squared).sum::<f64>() / 3.0;
            squares[k] += sum / count as f64;
            println!("{size}: {differing:?}, squares {sum:.2}");
            match k {
                0 => named += usize::from(differing.is_some()),
                _ => assert!(differing.is_none(), "{differing:?}"),
            }
        }
    }
    // no torque acts on average: three means of three squares are 1 within a half
    assert!(named > 0 && squares.iter().all(|s| *s < 2.5), "{named} {squares:?}");
}

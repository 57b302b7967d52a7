//! Fits of bodies on which torques act, against the Cramér–Rao bound with the torque among the unknowns.

use nalgebra::{Matrix3, SMatrix, Vector3};
use polhode::inertia::Inertia;
use polhode::num::Random;
use polhode_fit::{
    Disturbances, Estimate, FitError, Gyroscope, Known, Record, Segment, SensorPriors, Settings, TorqueModel,
    TorqueNoise, Warning, fit, simulate_with,
};

use crate::measured::torques::{bound, motion};
use crate::measured::{distance, entries, random_rotation, sampled, turned};

/// The 95 % point of χ² with 5 degrees of freedom.
const REGION: f64 = 11.070_497_693_516_35;

/// Errors of many fits against a bound.
#[derive(Default)]
struct Trials {
    over_bound: f64,
    covered: usize,
    refused: usize,
    silent: usize,
    models: Vec<TorqueModel>,
    count: usize,
}

impl Trials {
    fn add(&mut self, result: Result<Estimate, FitError>, truth: &Matrix3<f64>, bound: &SMatrix<f64, 6, 6>) {
        self.count += 1;
        match result {
            Ok(e) => {
                let error = entries(&(e.shape.tensor() - truth));
                self.over_bound += distance(&error, bound);
                self.covered += usize::from(distance(&error, &e.free_covariance) < REGION);
                self.silent += usize::from(e.warnings.is_empty());
                self.models.push(e.torque.model);
            }
            Err(error) => {
                println!("{error}");
                self.refused += 1;
            }
        }
    }

    /// √(mean eᵀ C⁻¹ e / 5) with C the bound.
    fn over_bound(&self) -> f64 {
        (self.over_bound / (5 * (self.count - self.refused)) as f64).sqrt()
    }

    fn print(&self, name: &str) {
        let answered = (self.count - self.refused) as f64;
        let share = |m: TorqueModel| self.models.iter().filter(|&&n| n == m).count();
        println!(
            "{name}: {} refused of {}, error/bound {:.3}, coverage {:.3}, silent {}, none/drag/drag3/constant {}/{}/{}/{}",
            self.refused,
            self.count,
            self.over_bound(),
            self.covered as f64 / answered,
            self.silent,
            share(TorqueModel::None),
            share(TorqueModel::Drag),
            share(TorqueModel::Drag3),
            share(TorqueModel::Constant)
        );
    }
}

/// Drag of `drag` 1/s on J = (1, 2, 2.6), 1 rad/s at the start.
fn with_drag(count: usize, times: &[f64], drag: f64, sigma: f64, model: TorqueModel, seed: u64) -> Trials {
    let mut random = Random::new(seed);
    let mut trials = Trials::default();
    for _ in 0..count {
        let j = turned([1.0 / 5.6, 2.0 / 5.6, 2.6 / 5.6], &random_rotation(&mut random));
        let omega = random.normal_vector().normalize();
        let rates =
            |j: &Matrix3<f64>, k: &[f64], omega: Vector3<f64>| motion(j, omega, times, &|_, w| j * w * -k[0]);
        let bound = bound(&j, omega, &[drag], &[None], sigma, &rates);
        let noisy: Vec<_> =
            rates(&j, &[drag], omega).iter().map(|w| w + random.normal_vector() * sigma).collect();
        let settings = Settings::default().with_torque(model);
        trials.add(fit(&Record::from_samples(times, &noisy).unwrap(), &settings), &j, &bound);
    }
    trials
}

/// With 24 trials the mean of χ²₅/5 scatters by √(2/120) = 0.13, its root by 0.065: four of these about 1, and the share
/// of trials that are covered by 0.045.
#[test]
#[ignore = "an ensemble: takes seconds, `.ci/run` does it"]
fn drag_is_found_and_fitted_at_its_bound() {
    for (drag, sigma) in [(1e-3, 1e-3), (1e-2, 1e-2), (0.1, 1e-3)] {
        let trials = with_drag(24, &sampled(10, 30), drag, sigma, TorqueModel::Auto, 5);
        trials.print(&format!("drag {drag}, noise {sigma}"));
        assert_eq!(trials.refused, 0);
        assert!(trials.over_bound() < 1.26, "{:.3}", trials.over_bound());
        assert!(trials.covered >= 19, "{} of 24", trials.covered);
        assert!(trials.models.iter().all(|m| *m == TorqueModel::Drag), "{:?}", trials.models);
    }
}

/// Drag that differs from axis to axis by more than a common one explains, and torque noise that is given: in any unit of time.
#[test]
fn unequal_drags_are_chosen_and_a_given_torque_noise_has_its_unit() {
    let body = Inertia::from_moments([1.0 / 5.6, 2.0 / 5.6, 2.6 / 5.6]).unwrap();
    let times = sampled(20, 40);
    let drag = Disturbances::default().with_drag(Vector3::new(2e-3, 7e-3, 1.4e-2));
    let gyroscope = Gyroscope::default().with_noise(1e-3);
    let omega = Vector3::new(0.5, 0.3, 0.8);
    let rates = simulate_with(&body, omega, &times, &drag, &gyroscope, &mut Random::new(2)).unwrap();
    let chosen = fit(&Record::from_samples(&times, &rates).unwrap(), &Settings::default()).unwrap();
    assert_eq!(chosen.torque.model, TorqueModel::Drag3);
    let given = |factor: f64| {
        let times: Vec<f64> = times.iter().map(|t| t / factor).collect();
        let rates: Vec<_> = rates.iter().map(|w| w * factor).collect();
        let noise = TorqueNoise::Given(1e-6 * factor * factor * factor);
        fit(&Record::from_samples(&times, &rates).unwrap(), &Settings::default().with_torque_noise(noise))
            .unwrap()
    };
    let (one, other) = (given(1.0), given(16.0));
    assert!((one.shape.tensor() - other.shape.tensor()).amax() < 1e-9);
    assert!((0..3).all(|k| (one.sigma_principal[k] / other.sigma_principal[k] - 1.0).abs() < 1e-6));
    assert!(one.sigma_principal[0] > 2.0 * chosen.sigma_principal[0]);
}

/// Without any drag half of the records would have it drive the body: its coefficient is then zero, with the deviation of
/// what the record leaves possible, and the tensor keeps its own.
#[test]
fn drag_takes_energy() {
    let mut random = Random::new(61);
    let times = sampled(20, 20);
    for (model, most) in [(TorqueModel::Drag, 1), (TorqueModel::Drag3, 3)] {
        let (mut active, mut coefficients, mut told, mut covered) = (0, 0, 0, 0);
        let count = 16;
        for _ in 0..count {
            let j = turned([1.0 / 5.6, 2.0 / 5.6, 2.6 / 5.6], &random_rotation(&mut random));
            let omega = random.normal_vector().normalize();
            let noisy: Vec<_> =
                free(&j, omega, &times).iter().map(|w| w + random.normal_vector() * 1e-3).collect();
            let settings = Settings::default().with_torque(model);
            let e = fit(&Record::from_samples(&times, &noisy).unwrap(), &settings).unwrap();
            let drags = e.active_constraints.iter().filter(|c| c.constraint.to_string().contains("drag"));
            let held = drags.count();
            assert!(held <= most);
            active += held;
            let of: Vec<f64> = e.torque.coefficients.iter().map(|c| c.value).collect();
            assert!(of.iter().all(|drag| *drag >= 0.0), "{of:?}");
            assert!(e.torque.coefficients.iter().all(|c| c.sigma > 0.0), "{:?}", e.torque);
            coefficients += of.len();
            told += e.torque.coefficients.iter().filter(|c| c.value.abs() < 1.96 * c.sigma).count();
            // one moment at a time: along an active face the covariance is no longer that of a normal distribution
            let errors = entries(&(e.shape.tensor() - j));
            covered += (0..6).filter(|&k| errors[k].abs() < 1.96 * e.covariance[(k, k)].sqrt()).count();
        }
        let share = covered as f64 / (6 * count) as f64;
        println!(
            "{model:?}: {active} active, {told} of {coefficients} drags and {share:.3} of entries covered"
        );
        assert!(active >= count / 4, "{model:?}: {active}");
        assert!(told as f64 > 0.88 * coefficients as f64, "{model:?}: {told} of {coefficients}");
        assert!(share > 0.88, "{model:?}: {share}");
    }
}

/// A motor makes the momentum grow, which drag cannot: no tensor, and the reason with its numbers.
#[test]
fn a_body_that_a_motor_drives_contradicts_drag() {
    let mut random = Random::new(62);
    let times = sampled(50, 20);
    let j = turned([1.0 / 5.6, 2.0 / 5.6, 2.6 / 5.6], &random_rotation(&mut random));
    let driven = motion(&j, Vector3::new(0.3, 1.0, 0.4), &times, &|_, w| j * w * 0.02);
    let noisy: Vec<_> = driven.iter().map(|w| w + random.normal_vector() * 1e-3).collect();
    let settings = Settings::default().with_torque(TorqueModel::Drag);
    let refused = fit(&Record::from_samples(&times, &noisy).unwrap(), &settings).unwrap_err();
    let FitError::Driven { growth, pull, .. } = refused else { panic!("{refused}") };
    assert!((growth - 0.02).abs() < 2e-3 && pull > 20.0, "{growth} {pull}");
    let text = refused.to_string();
    assert!(
        text.starts_with("torques drive the body")
            && text.contains("does not determine its tensor: |J w| grows by 1.9"),
        "{text}"
    );
}

/// Torque noise turns the body, and so it stands in the slopes of the rates as well as in the residuals: least squares that forget
/// it find the smallest moment too small by one standard deviation. The mean of 40 normal deviates scatters by 0.16.
#[test]
#[ignore = "an ensemble: takes seconds, `.ci/run` does it"]
fn torque_noise_does_not_bias_the_moments() {
    let mut random = Random::new(66);
    let times = sampled(12, 60);
    let acting = Disturbances::default().with_torque_noise(3e-3);
    let sensor = Gyroscope::default().with_noise(7e-3);
    let (mut deviates, mut of_shape, count) = (Vector3::zeros(), 0.0, 40);
    for _ in 0..count {
        let j = turned([1.0 / 5.6, 2.0 / 5.6, 2.6 / 5.6], &random_rotation(&mut random));
        let omega = random.normal_vector().normalize();
        let body = Inertia::from_tensor(j).unwrap();
        let rates = simulate_with(&body, omega, &times, &acting, &sensor, &mut random).unwrap();
        let e = fit(&Record::from_samples(&times, &rates).unwrap(), &Settings::default()).unwrap();
        let axes = e.axes.to_rotation_matrix();
        let errors = axes.matrix().transpose() * (e.shape.tensor() - j) * axes.matrix();
        deviates += Vector3::from_fn(|k, _| errors[(k, k)] / e.sigma_principal[k]) / f64::from(count);
        of_shape += distance(&entries(&(e.shape.tensor() - j)), &e.free_covariance) / 5.0 / f64::from(count);
    }
    println!("mean deviates {deviates:.2?}, chi squared over its degrees {of_shape:.3}");
    assert!(deviates.amax() < 0.6, "{deviates:?}");
    assert!((of_shape - 1.0).abs() < 0.4, "{of_shape}");
}

/// Readings at a tensor, further unknowns, a start and times.
type Readings<'a> = dyn Fn(&Matrix3<f64>, &[f64], Vector3<f64>, &[f64]) -> Vec<Vector3<f64>> + 'a;

/// A record as a sensor sees it, and the settings of its fit.
struct Field<'a> {
    name: &'a str,
    readings: &'a Readings<'a>,
    /// The further unknowns, each by the standard deviation that it is drawn with, and its prior in the bound.
    drawn: &'a [(f64, Option<f64>)],
    settings: Settings,
}

impl Field<'_> {
    fn trials(&self, count: usize, rate: usize, sigma: f64, seed: u64) -> Trials {
        let mut random = Random::new(seed);
        let times = sampled(rate, 60);
        let mut trials = Trials::default();
        for _ in 0..count {
            let j = turned([1.0 / 5.6, 2.0 / 5.6, 2.6 / 5.6], &random_rotation(&mut random));
            let omega = random.normal_vector().normalize();
            let others: Vec<f64> = self.drawn.iter().map(|(size, _)| size * random.normal()).collect();
            let priors: Vec<Option<f64>> = self.drawn.iter().map(|(_, prior)| *prior).collect();
            let rates = |j: &Matrix3<f64>, others: &[f64], omega: Vector3<f64>| {
                (self.readings)(j, others, omega, &times)
            };
            let bound = bound(&j, omega, &others, &priors, sigma, &rates);
            let noisy: Vec<_> =
                rates(&j, &others, omega).iter().map(|w| w + random.normal_vector() * sigma).collect();
            trials.add(fit(&Record::from_samples(&times, &noisy).unwrap(), &self.settings), &j, &bound);
        }
        trials.print(&format!("{}, noise {sigma}", self.name));
        trials
    }
}

fn free(j: &Matrix3<f64>, omega: Vector3<f64>, times: &[f64]) -> Vec<Vector3<f64>> {
    motion(j, omega, times, &|_, _| Vector3::zeros())
}

/// Offsets of 0.01 rad/s with a prior of 0.02, a scale of 2 %, and both with drag.
fn sensors(count: usize, rate: usize, sigma: f64) -> [Trials; 3] {
    let with = |sensor| Settings::default().with_sensor(sensor);
    let offset = SensorPriors::default().with_offset(0.02);
    let scale = SensorPriors::default().with_scale(0.02);
    let offsets = |rates: Vec<Vector3<f64>>, b: &[f64]| {
        rates.iter().map(|w| w + Vector3::new(b[0], b[1], b[2])).collect::<Vec<_>>()
    };
    [
        Field {
            name: "offset",
            readings: &|j, others, omega, times| offsets(free(j, omega, times), others),
            drawn: &[(0.01, Some(0.02)); 3],
            settings: with(offset),
        }
        .trials(count, rate, sigma, 21),
        Field {
            name: "scale",
            readings: &|j, others, omega, times| {
                free(j, omega, times).iter().map(|w| w / (1.0 + others[0])).collect()
            },
            drawn: &[(0.02, Some(0.02))],
            settings: with(scale),
        }
        .trials(count, rate, sigma, 22),
        Field {
            name: "drag, offset and scale",
            readings: &|j, others, omega, times| {
                let rates = motion(j, omega, times, &|_, w| j * w * (-0.01 - others[4]));
                offsets(rates.iter().map(|w| w / (1.0 + others[3])).collect(), others)
            },
            drawn: &[
                (0.01, Some(0.02)),
                (0.01, Some(0.02)),
                (0.01, Some(0.02)),
                (0.02, Some(0.02)),
                (1e-3, None),
            ],
            settings: Settings::default().with_sensor(offset.with_scale(0.02)).with_torque(TorqueModel::Drag),
        }
        .trials(count, rate, sigma, 23),
    ]
}

#[test]
#[ignore = "an ensemble: takes seconds, `.ci/run` does it"]
fn errors_of_the_sensor_are_covered_by_their_priors() {
    for trials in sensors(16, 10, 1e-2) {
        assert_eq!(trials.refused, 0);
        // 0.95 − 4 √(0.95·0.05/16)
        assert!(trials.covered >= 12, "{} of 16", trials.covered);
        assert!(trials.over_bound() < 1.4, "{:.3}", trials.over_bound());
    }
}

/// Two of a hundred samples fifty deviations off.
#[test]
fn spikes_are_left_out_and_named() {
    let mut random = Random::new(41);
    let times = sampled(100, 30);
    let mut trials = Trials::default();
    for _ in 0..16 {
        let j = turned([1.0 / 5.6, 2.0 / 5.6, 2.6 / 5.6], &random_rotation(&mut random));
        let omega = random.normal_vector().normalize();
        let bound =
            bound(&j, omega, &[], &[], 1e-2, &|j: &Matrix3<f64>, _: &[f64], omega| free(j, omega, &times));
        let mut noisy: Vec<_> =
            free(&j, omega, &times).iter().map(|w| w + random.normal_vector() * 1e-2).collect();
        let mut spikes = 0;
        for rate in &mut noisy {
            if random.uniform() < 0.02 {
                *rate += random.normal_vector().normalize() * 0.5;
                spikes += 1;
            }
        }
        let result = fit(&Record::from_samples(&times, &noisy).unwrap(), &Settings::default());
        if let Ok(e) = &result {
            assert!(
                (spikes * 9 / 10..=spikes + 3).contains(&e.spikes.len()),
                "{} of {spikes}",
                e.spikes.len()
            );
            assert!(
                e.warnings.iter().any(|w| w.to_string().contains("what the neighbouring samples predict"))
            );
        }
        trials.add(result, &j, &bound);
    }
    trials.print("spikes");
    assert!(trials.refused == 0 && trials.over_bound() < 1.3, "{:.3}", trials.over_bound());
    assert!(trials.covered >= 12);
}

/// Twenty bursts of three to six samples in a minute, fifty deviations off on each component.
fn with_bursts(count: usize, seed: u64) -> Trials {
    let mut random = Random::new(seed);
    let times = sampled(100, 60);
    let mut sums = [0; 3];
    let mut trials = Trials::default();
    for _ in 0..count {
        let j = turned([1.0 / 5.6, 2.0 / 5.6, 2.6 / 5.6], &random_rotation(&mut random));
        let omega = random.normal_vector().normalize();
        let bound =
            bound(&j, omega, &[], &[], 1e-2, &|j: &Matrix3<f64>, _: &[f64], omega| free(j, omega, &times));
        let mut noisy: Vec<_> =
            free(&j, omega, &times).iter().map(|w| w + random.normal_vector() * 1e-2).collect();
        let mut is_off = vec![false; noisy.len()];
        for _ in 0..20 {
            // one that begins with the record has no side before it
            let first = 5 + random.below(noisy.len() as u64 - 16) as usize;
            let error = Vector3::from_fn(|_, _| if random.uniform() < 0.5 { -0.5 } else { 0.5 });
            for sample in first..first + 3 + random.below(4) as usize {
                noisy[sample] += error;
                is_off[sample] = true;
            }
        }
        let result = fit(&Record::from_samples(&times, &noisy).unwrap(), &Settings::default());
        if let Ok(e) = &result {
            let put = is_off.iter().filter(|off| **off).count();
            let found = e.spikes.iter().filter(|spike| is_off[spike.sample]).count();
            sums = [sums[0] + put, sums[1] + found, sums[2] + e.spikes.len() - found];
            let named = e.warnings.iter().find_map(|w| match w {
                Warning::Bursts { samples, bursts, .. } => Some((*samples, *bursts)),
                _ => None,
            });
            let (samples, bursts) = named.unwrap();
            assert!(samples + 12 >= put && (14..=21).contains(&bursts), "{samples} of {put} in {bursts}");
        }
        trials.add(result, &j, &bound);
    }
    let [put, found, wrong] = sums;
    println!("{found} of {put} samples of bursts, {wrong} others");
    // two long bursts that are off alike may be taken for one between them
    assert!(100 * found >= 99 * put && 100 * wrong <= put, "{found} of {put}, {wrong} others");
    trials.print("bursts");
    trials
}

#[test]
fn bursts_are_left_out_and_counted() {
    let trials = with_bursts(16, 42);
    assert!(trials.refused == 0 && trials.over_bound() < 1.3, "{:.3}", trials.over_bound());
    assert!(trials.covered >= 12);
}

/// A sum over samples across the hole would be off by more than the noise: seen as errors of the sensor.
#[test]
fn a_long_burst_parts_its_segment() {
    let mut random = Random::new(43);
    let times = sampled(20, 60);
    for _ in 0..8 {
        let j = turned([1.0 / 5.6, 2.0 / 5.6, 2.6 / 5.6], &random_rotation(&mut random));
        let omega = random.normal_vector().normalize();
        let mut rates: Vec<_> =
            free(&j, omega, &times).iter().map(|w| w + random.normal_vector() * 1e-2).collect();
        let first = 200 + random.below(800) as usize;
        rates[first..first + 12].iter_mut().for_each(|rate| *rate += Vector3::new(0.5, -0.5, 0.5));
        let e = fit(&Record::from_samples(&times, &rates).unwrap(), &Settings::default()).unwrap();
        assert_eq!((e.spikes.len(), e.segments, e.per_segment.len(), e.samples), (12, 1, 2, 1189));
        assert_eq!(e.per_segment.iter().map(|part| part.samples).sum::<usize>(), 1189);
        assert!(e.per_segment.iter().all(|part| part.segment == 0));
        let is_suspect = |w: &Warning| !matches!(w, Warning::Bursts { samples: 12, bursts: 1, .. });
        assert!(!e.warnings.iter().any(is_suspect), "{:?}", e.warnings);
    }
}

/// A torque that is alike along all axes is told by the angular acceleration that it makes, the mean of the three.
#[test]
fn the_density_of_torque_noise_is_that_of_the_angular_acceleration() {
    let moments = [1.0, 2.0, 2.6];
    let body = Inertia::from_moments(moments).unwrap();
    let impulse = 0.05;
    let truth = impulse * impulse * moments.iter().map(|i| 1.0 / (i * i)).sum::<f64>() / 3.0;
    let by = Disturbances::default().with_torque_noise(impulse);
    let gyroscope = Gyroscope::default().with_noise(5e-4);
    let settings = Settings::default().with_torque(TorqueModel::None);
    let (times, start) = (sampled(20, 60), Vector3::new(0.6, 1.0, 0.8));
    for seed in 1..4 {
        let rates = simulate_with(&body, start, &times, &by, &gyroscope, &mut Random::new(seed)).unwrap();
        let e = fit(&Record::from_samples(&times, &rates).unwrap(), &settings).unwrap();
        let found = e.per_segment[0].torque_noise;
        // some 400 numbers tell it to a tenth
        assert!((0.7..1.4).contains(&(found / truth)), "{found} for {truth}");
    }
}

/// A wheel whose momentum is known gives the tensor its size.
#[test]
fn a_wheel_gives_the_absolute_tensor() {
    let mut random = Random::new(51);
    let times = sampled(50, 40);
    let (mut sum, count) = (0.0, 16);
    for _ in 0..count {
        let j = turned([1.0, 2.0, 2.6], &random_rotation(&mut random));
        let omega = random.normal_vector().normalize();
        let wheel = random.normal_vector().normalize() * 0.4;
        let rates = motion(&j, omega, &times, &|_, w| -w.cross(&wheel));
        let noisy: Vec<_> = rates.iter().map(|w| w + random.normal_vector() * 1e-3).collect();
        let segment = Segment::new("wheel", times.clone(), noisy).unwrap();
        let mut record = Record::default();
        record.segments.push(segment.with_wheel(vec![wheel; times.len()]).unwrap());
        let e = fit(&record, &Settings::default()).unwrap();
        let error = entries(&(e.inertia.expect("a size").tensor() - j));
        let covariance = e.inertia_covariance.unwrap();
        sum += error.dot(&covariance.cholesky().expect("six entries").solve(&error));
        assert!(e.warnings.is_empty(), "{:?}", e.warnings);
        let twice = Settings::default().with_known(Known::Trace(5.6));
        assert!(matches!(fit(&record, &twice), Err(FitError::TwoScales)));
    }
    // the mean of χ²₆/6 over 16 trials scatters by √(2/96) = 0.14
    let mean = sum / (6 * count) as f64;
    println!("wheel: mean of chi squared over its degrees {mean:.3}");
    assert!((0.45..1.6).contains(&mean), "{mean:.3}");
}

/// The figures that reports quote; minutes, so only on request.
#[test]
#[ignore = "paper scale"]
fn drag_over_many_trials() {
    for sigma in [1e-3, 1e-2] {
        for drag in [1e-3, 1e-2, 0.1] {
            for model in [TorqueModel::Drag, TorqueModel::Auto] {
                let start = std::time::Instant::now();
                let trials = with_drag(30, &sampled(100, 60), drag, sigma, model, 11);
                trials.print(&format!("{model:?}, drag {drag}, noise {sigma}"));
                println!("   {:.3} s a trial", start.elapsed().as_secs_f64() / 30.0);
            }
        }
    }
}

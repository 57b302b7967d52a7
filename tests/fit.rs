//! Inertia from noisy rates: efficient, covariant, physical, and not fooled by any record of the failure table.
#![cfg(feature = "fit")]
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic)]

use nalgebra::{Matrix3, Quaternion, Rotation3, SMatrix, UnitQuaternion, Vector3};
use polhode::fit::{
    Constraint, Estimate, FitError, Known, Limit, Reading, Record, RecordError, Segment, Settings,
    Undetermined, fit, foreseen_bound, simulate,
};
use polhode::inertia::Inertia;
use polhode::num::Random;

const ENTRIES: [(usize, usize); 6] = [(0, 0), (1, 1), (2, 2), (0, 1), (0, 2), (1, 2)];

fn entries(j: &Matrix3<f64>) -> SMatrix<f64, 6, 1> {
    SMatrix::from_fn(|k, _| j[ENTRIES[k]])
}

fn random_rotation(random: &mut Random) -> Rotation3<f64> {
    let (w, v) = (random.normal(), random.normal_vector());
    UnitQuaternion::from_quaternion(Quaternion::new(w, v.x, v.y, v.z)).to_rotation_matrix()
}

fn turned(moments: [f64; 3], r: &Rotation3<f64>) -> Matrix3<f64> {
    let j = r.matrix() * Matrix3::from_diagonal(&Vector3::from(moments)) * r.matrix().transpose();
    (j + j.transpose()) * 0.5
}

/// 100 Hz for `seconds`.
fn times(seconds: usize) -> Vec<f64> {
    (0..=100 * seconds).map(|i| i as f64 / 100.0).collect()
}

fn record(j: &Matrix3<f64>, omega: Vector3<f64>, times: &[f64], sigma: f64, random: &mut Random) -> Record {
    let rates = simulate(&Inertia::from_tensor(*j).unwrap(), omega, times, sigma, random).unwrap();
    Record::from_samples(times, &rates).unwrap()
}

/// eᵀ C⁺ e, C singular along the trace only: adding the trace direction makes it regular and changes nothing.
fn distance(e: &SMatrix<f64, 6, 1>, c: &SMatrix<f64, 6, 6>) -> f64 {
    let trace = SMatrix::<f64, 6, 1>::new(1.0, 1.0, 1.0, 0.0, 0.0, 0.0);
    let regular = c + trace * trace.transpose() * c.trace();
    e.dot(&regular.cholesky().unwrap().solve(e))
}

fn is_physical(estimate: &Estimate) -> bool {
    Inertia::from_tensor(estimate.shape.tensor()).is_ok() && estimate.principal[2] <= 0.5
}

struct Trials {
    /// √(mean eᵀ C⁻¹ e / 5) with C the Cramér–Rao bound.
    over_bound: f64,
    /// Share of trials whose own 95 % ellipsoid holds the truth.
    coverage: f64,
}

/// J = (1, 2, 2.6) turned at random, random starts of 1 rad/s, 100 Hz for 60 s; every trial must be physical.
fn trials(count: usize, sigma: f64, seed: u64) -> Trials {
    let mut random = Random::new(seed);
    let times = times(60);
    let (mut sum, mut covered) = (0.0, 0);
    for trial in 0..count {
        let j = turned([1.0 / 5.6, 2.0 / 5.6, 2.6 / 5.6], &random_rotation(&mut random));
        let omega = random.normal_vector().normalize();
        let estimate = fit(&record(&j, omega, &times, sigma, &mut random), &Settings::default())
            .unwrap_or_else(|error| panic!("trial {trial}: {error}"));
        assert!(is_physical(&estimate), "trial {trial}");
        assert!(estimate.certificate.violation <= 1e-9 && estimate.certificate.stationarity <= 1e-9);
        let e = entries(&(estimate.shape.tensor() - j));
        let bound = foreseen_bound(&Inertia::from_tensor(j).unwrap(), omega, &times, sigma).unwrap();
        sum += distance(&e, &bound);
        // the 95 % point of χ² with 5 degrees of freedom
        covered += usize::from(distance(&e, &estimate.free_covariance) < 11.070_497_693_516_35);
    }
    Trials { over_bound: (sum / (5 * count) as f64).sqrt(), coverage: covered as f64 / count as f64 }
}

/// With 40 trials the mean of χ²₅/5 scatters by √(2/200) = 0.1, its root by 0.05: four of these about 1.
#[test]
fn efficient_at_low_noise_and_nearly_so_at_high() {
    for (sigma, low, high) in [(1e-3, 0.8, 1.2), (1e-2, 0.8, 1.2), (1e-1, 0.8, 1.6)] {
        let t = trials(40, sigma, 20_240);
        println!("noise {sigma}: error over bound {:.3}, coverage {:.3}", t.over_bound, t.coverage);
        assert!((low..high).contains(&t.over_bound), "noise {sigma}: {:.3} of the bound", t.over_bound);
        // 0.95 − 4 √(0.95·0.05/40)
        assert!(t.coverage >= 0.81, "noise {sigma}: coverage {}", t.coverage);
    }
}

/// The figures that reports quote; a few minutes, so only on request.
#[test]
#[ignore = "paper scale"]
fn efficient_over_400_trials() {
    for (sigma, high) in [(1e-1, 1.6), (1e-2, 1.1), (1e-3, 1.1)] {
        let t = trials(400, sigma, 4);
        println!("noise {sigma}: error over bound {:.4}, coverage {:.4}", t.over_bound, t.coverage);
        assert!((0.9..high).contains(&t.over_bound), "noise {sigma}: {:.3} of the bound", t.over_bound);
    }
}

fn example(sigma: f64) -> (Matrix3<f64>, Vec<f64>, Vec<Vector3<f64>>) {
    let mut random = Random::new(99);
    let j = turned([1.0 / 5.6, 2.0 / 5.6, 2.6 / 5.6], &random_rotation(&mut random));
    let times: Vec<f64> = (0..1500).map(|i| 0.02 * f64::from(i)).collect();
    let body = Inertia::from_tensor(j).unwrap();
    let rates = simulate(&body, Vector3::new(0.3, -0.8, 0.6), &times, sigma, &mut random).unwrap();
    (j, times, rates)
}

/// Largest relative difference of what two fits report, the second turned back by `r`.
fn difference(a: &Estimate, b: &Estimate, r: &Matrix3<f64>) -> f64 {
    let back = r.transpose() * b.shape.tensor() * r;
    let tensor = (back - a.shape.tensor()).amax();
    let relative = |x: f64, y: f64| (x - y).abs() / x.abs();
    let figures = (0..3).map(|k| relative(a.sigma_principal[k], b.sigma_principal[k])).fold(0.0, f64::max);
    tensor.max(figures).max(relative(a.bound_ratio.unwrap(), b.bound_ratio.unwrap()))
}

#[test]
fn no_unit_and_no_rotation_of_the_sensor_changes_the_answer() {
    for sigma in [1e-6, 1e-2, 0.1] {
        let (_, times, rates) = example(sigma);
        let reference = fit(&Record::from_samples(&times, &rates).unwrap(), &Settings::default()).unwrap();
        let mut random = Random::new(3);
        for factor in [0.5, 1024.0, 1e-6, 1e3, 57.3, 0.1234567, 1e150] {
            // a unit of time `factor` as large, with rates per that unit
            let t: Vec<f64> = times.iter().map(|t| t / factor).collect();
            let r = random_rotation(&mut random);
            let w: Vec<_> = rates.iter().map(|w| r * w * factor).collect();
            let other = fit(&Record::from_samples(&t, &w).unwrap(), &Settings::default()).unwrap();
            let apart = difference(&reference, &other, r.matrix());
            assert!(apart < 1e-8, "noise {sigma}, factor {factor}: {apart:.1e}");
            // residuals of 1e-6 carry the rounding of terms a million times as large
            assert!((other.chi2_per_dof / reference.chi2_per_dof - 1.0).abs() < 1e-13 / sigma + 1e-10);
            assert!((other.radius * factor / reference.radius - 1.0).abs() < 1e-12);
            assert!((other.noise_sigma / factor / reference.noise_sigma - 1.0).abs() < 1e-9);
        }
    }
}

/// Sensitivities by differences of the exact motion, whose formulas share nothing with the variational equations.
#[test]
fn the_bound_is_that_of_the_exact_motion() {
    let (j, _, _) = example(0.0);
    let times: Vec<f64> = (0..600).map(|i| 0.03 * f64::from(i)).collect();
    let omega = Vector3::new(0.3, -0.8, 0.6);
    let motion = |j: Matrix3<f64>, omega| {
        simulate(&Inertia::from_tensor(j).unwrap(), omega, &times, 0.0, &mut Random::new(0)).unwrap()
    };
    // any five independent changes of trace 0, then the three of the start
    let change = |k: usize| {
        let mut b = Matrix3::zeros();
        let (i, l) = ENTRIES[if k < 2 { k } else { k + 1 }];
        b[(i, l)] = 1.0;
        b[(l, i)] = 1.0;
        b[(2, 2)] -= if k < 2 { 1.0 } else { 0.0 };
        b
    };
    let h = 1e-5;
    let columns: Vec<Vec<Vector3<f64>>> = (0..8)
        .map(|k| {
            let moved = |h: f64| match k {
                0..5 => motion(j + change(k) * h, omega),
                _ => motion(j, omega + Vector3::ith(k - 5, h)),
            };
            moved(h).iter().zip(moved(-h)).map(|(a, b)| (a - b) / (2.0 * h)).collect()
        })
        .collect();
    let sigma = 1e-3;
    let information = SMatrix::<f64, 8, 8>::from_fn(|k, l| {
        columns[k].iter().zip(&columns[l]).map(|(a, b)| a.dot(b)).sum::<f64>() / (sigma * sigma)
    });
    let covariance = information.try_inverse().unwrap().fixed_view::<5, 5>(0, 0).into_owned();
    let map = SMatrix::<f64, 6, 5>::from_fn(|row, k| change(k)[ENTRIES[row]]);
    let expected = map * covariance * map.transpose();
    let bound = foreseen_bound(&Inertia::from_tensor(j * 3.0).unwrap(), omega, &times, sigma).unwrap();
    let apart = (bound - expected).norm() / expected.norm();
    assert!(apart < 1e-5, "{apart:e}");
}

/// √ of the trace of a fit's own bound over that of the bound at the true motion.
fn over_true_bound(
    estimate: &Estimate,
    j: &Matrix3<f64>,
    omega: Vector3<f64>,
    times: &[f64],
    sigma: f64,
) -> f64 {
    let body = Inertia::from_tensor(*j).unwrap();
    let truth = foreseen_bound(&body, omega, times, sigma).unwrap();
    (estimate.bound.expect("a motion explains this record").trace() / truth.trace()).sqrt()
}

/// Noise of a quarter of the rate over thirty turns, and a motion that stays at the saddle for a minute.
#[test]
fn the_bound_is_that_of_the_motion_that_was_measured() {
    let j = Matrix3::from_diagonal(&Vector3::new(1.0, 2.0, 2.6));
    let times: Vec<f64> = (0..=4000).map(|i| 0.05 * f64::from(i)).collect();
    for (omega, sigma) in [(Vector3::new(0.3, 1.0, 0.4), 0.25), (Vector3::new(0.001, 1.0, 0.001), 1e-3)] {
        for seed in 1..=6 {
            let record = record(&j, omega, &times, sigma, &mut Random::new(seed));
            let estimate = fit(&record, &Settings::default()).unwrap();
            // the bound at an estimate two deviations off is up to a tenth another
            let apart = over_true_bound(&estimate, &j, omega, &times, sigma);
            assert!((0.85..1.15).contains(&apart), "{omega:?}, seed {seed}: {apart:.3}");
            let ratio = estimate.bound_ratio.unwrap();
            assert!((0.95..1.3).contains(&ratio), "{omega:?}, seed {seed}: {ratio:.3}");
        }
    }
}

#[test]
fn the_bound_of_random_records_is_that_of_their_motion() {
    let mut random = Random::new(41);
    for trial in 0..40 {
        let sigma = [1e-4, 1e-3, 1e-2, 5e-2][trial % 4];
        let times: Vec<f64> = (0..2000).map(|i| [0.02, 0.05, 0.1][trial % 3] * f64::from(i)).collect();
        let r = random_rotation(&mut random);
        let j = turned([0.12 + 0.1 * random.uniform(), 0.33, 0.45], &r);
        let omega = random.normal_vector().normalize();
        let estimate = fit(&record(&j, omega, &times, sigma, &mut random), &Settings::default()).unwrap();
        // beyond a per cent of the trace it depends on where the estimate is
        if estimate.free_covariance.trace().sqrt() < 1e-2 {
            let apart = over_true_bound(&estimate, &j, omega, &times, sigma);
            assert!((0.8..1.25).contains(&apart), "trial {trial}: {apart:.3}");
        }
    }
}

/// A rate that a torque takes up by a half over fifty turns: a free motion stays in phase for a few of them only.
#[test]
fn where_no_free_motion_explains_the_samples_there_is_no_bound() {
    let j = Matrix3::from_diagonal(&Vector3::new(1.0, 2.0, 2.6));
    let body = Inertia::from_tensor(j).unwrap();
    let mut random = Random::new(17);
    let times: Vec<f64> = (0..8000).map(|i| 0.02 * f64::from(i)).collect();
    // t + t²/4T runs through the same motion ever faster
    let clock: Vec<f64> = times.iter().map(|t| t + t * t / 640.0).collect();
    let free = simulate(&body, Vector3::new(0.3, 1.0, 0.4), &clock, 0.0, &mut random).unwrap();
    let speed = times.iter().map(|t| 1.0 + t / 320.0);
    let rates: Vec<_> = free.iter().zip(speed).map(|(w, s)| w * s + random.normal_vector() * 1e-3).collect();
    let known = Some(Known::TwiceEnergy(3.0));
    let settings = Settings { known, ..Settings::default() };
    let estimate = fit(&Record::from_samples(&times, &rates).unwrap(), &settings).unwrap();
    assert!(estimate.bound.is_none() && estimate.bound_ratio.is_none());
    let covariance = estimate.inertia_covariance.unwrap();
    assert!(covariance.trace() > 0.0 && covariance.iter().all(|v| v.is_finite()));
}

#[test]
fn without_noise_the_tensor_is_exact_to_the_quadrature() {
    let (j, times, rates) = example(0.0);
    let estimate = fit(&Record::from_samples(&times, &rates).unwrap(), &Settings::default()).unwrap();
    let error = (estimate.shape.tensor() - j).amax();
    // what is left is the quadrature of fourth derivatives, (h/r)⁴ (r/polhode)⁴ with h = 0.02 s and a polhode of 10 s
    assert!(error < 1e-9, "{error:e}");
}

#[test]
fn irregular_times_and_several_segments_share_one_tensor() {
    let mut random = Random::new(12);
    let j = turned([0.2, 0.35, 0.45], &random_rotation(&mut random));
    let mut all = Record::default();
    for _ in 0..4 {
        let mut t = 0.0;
        let times: Vec<f64> = (0..500)
            .map(|_| {
                t += 0.002 + 0.016 * random.uniform();
                t
            })
            .collect();
        let omega = random.normal_vector() * 6.0;
        all = all.join(record(&j, omega, &times, 0.02, &mut random));
    }
    let estimate = fit(&all, &Settings::default()).unwrap();
    assert_eq!(estimate.segments, 4);
    let e = entries(&(estimate.shape.tensor() - j));
    // the 99.99 % point of χ²₅
    assert!(distance(&e, &estimate.covariance) < 25.75, "{}", distance(&e, &estimate.covariance));
    assert!((estimate.noise_sigma / 0.02 - 1.0).abs() < 0.1, "{}", estimate.noise_sigma);
    assert!(estimate.warnings.is_empty(), "{:?}", estimate.warnings);
}

/// 25 Hz for 20 s with noise of 1e-3, from elliptic functions at 40 digits in mpmath 1.3: see generate.py beside it.
#[test]
fn a_record_made_elsewhere_gives_the_tensor_it_was_made_of() {
    let text = include_str!("data/fit/asymmetric.csv");
    let record = Record::read(text, "asymmetric.csv", Reading::default()).unwrap();
    let estimate = fit(&record, &Settings::default()).unwrap();
    let j = Matrix3::new(0.25, -0.03, 0.02, -0.03, 0.35, 0.05, 0.02, 0.05, 0.4);
    let e = entries(&(estimate.shape.tensor() - j));
    assert!(distance(&e, &estimate.covariance) < 25.75, "{}", distance(&e, &estimate.covariance));
    assert!(e.amax() < 2e-3, "{e}");
    assert!((estimate.noise_sigma / 1e-3 - 1.0).abs() < 0.2, "{}", estimate.noise_sigma);
    assert!((estimate.chi2_per_dof - 1.0).abs() < 0.5, "{}", estimate.chi2_per_dof);
}

/// A plate at twice the noise of its slack: about half the free answers are no bodies, no returned one is.
#[test]
fn a_flat_body_comes_out_physical_and_says_what_holds_it() {
    let mut random = Random::new(31);
    let times = times(20);
    let mut held = 0;
    for _ in 0..12 {
        let j = turned([1.0 / 6.0, 2.0 / 6.0, 3.0 / 6.0], &random_rotation(&mut random));
        let omega = random.normal_vector().normalize();
        let estimate = fit(&record(&j, omega, &times, 0.02, &mut random), &Settings::default()).unwrap();
        assert!(is_physical(&estimate));
        if let Some(constraint) = estimate.active_constraints.first() {
            held += 1;
            assert_eq!(constraint.constraint, Constraint::Triangle);
            assert!(constraint.multiplier > 0.0 && estimate.triangle_slack < 1e-12);
            assert!(estimate.warnings.iter().any(|w| w.to_string().contains("I1 + I2 >= I3")));
            // on the face I₃ is ½, without error
            assert!(estimate.sigma_principal[2] < 1e-3 * estimate.sigma_principal[0]);
        }
    }
    assert!((2..=10).contains(&held), "{held} of 12 held by the law");
}

#[test]
fn scale_from_what_is_known_besides() {
    let (j, times, rates) = example(1e-3);
    let body = j * 7.0;
    let record = Record::from_samples(&times, &rates).unwrap();
    let omega = Vector3::new(0.3, -0.8, 0.6);
    let axis = Vector3::new(0.0, 3.0, 0.0);
    for known in [
        Known::Trace(7.0),
        Known::Momentum((body * omega).norm()),
        Known::TwiceEnergy(omega.dot(&(body * omega))),
        Known::Moment { axis, value: body[(1, 1)] },
    ] {
        let estimate = fit(&record, &Settings { known: Some(known), ..Settings::default() }).unwrap();
        let e = entries(&(estimate.inertia.unwrap().tensor() - body));
        let c = estimate.inertia_covariance.unwrap();
        assert!(e.amax() < 0.02, "{known:?}: {e}");
        for k in 0..6 {
            assert!(e[k].abs() < 5.0 * c[(k, k)].sqrt() + 1e-12, "{known:?}, entry {k}");
        }
    }
    let shape_only = fit(&record, &Settings::default()).unwrap();
    assert!(shape_only.inertia.is_none() && shape_only.inertia_covariance.is_none());
}

/// The mean energy and momentum carry noise of their own, and share some with the shape.
#[test]
fn a_scale_from_energy_or_momentum_scatters_as_it_claims() {
    let j = Matrix3::from_diagonal(&Vector3::new(1.0, 1.5, 2.0));
    let omega = Vector3::new(0.5, 1.0, 0.6);
    let times: Vec<f64> = (0..600).map(|i| 0.05 * f64::from(i)).collect();
    let momentum = j * omega;
    let count = 40;
    for known in [Known::TwiceEnergy(omega.dot(&momentum)), Known::Momentum(momentum.norm())] {
        let settings = Settings { known: Some(known), ..Settings::default() };
        let (mut scatter, mut claim) = (SMatrix::<f64, 6, 1>::zeros(), SMatrix::<f64, 6, 1>::zeros());
        for seed in 0..count {
            let record = record(&j, omega, &times, 0.01, &mut Random::new(seed));
            let estimate = fit(&record, &settings).unwrap();
            let e = entries(&(estimate.inertia.unwrap().tensor() - j));
            scatter += e.component_mul(&e);
            claim += estimate.inertia_covariance.unwrap().diagonal();
        }
        for k in 0..6 {
            // a root of χ²/count scatters by 1/√(2 count)
            let ratio = (scatter[k] / claim[k]).sqrt();
            let four = 4.0 / (2.0 * count as f64).sqrt();
            assert!((ratio - 1.0).abs() < four, "{known:?}, entry {k}: {ratio:.2}");
        }
    }
}

/// Rates whose squares vanish, and a known quantity that leaves a tensor of ordinary size.
#[test]
fn the_scale_knows_no_smallest_rate() {
    let (j, times, rates) = example(1e-3);
    let omega = Vector3::new(0.3, -0.8, 0.6);
    let (momentum, energy) = ((j * omega).norm(), omega.dot(&(j * omega)));
    for factor in [1e-85, 1e-120, 1e-154, 1e120] {
        let t: Vec<f64> = times.iter().map(|t| t / factor).collect();
        let w: Vec<_> = rates.iter().map(|w| w * factor).collect();
        let slow = Record::from_samples(&t, &w).unwrap();
        let record = Record::from_samples(&times, &rates).unwrap();
        for (here, there) in [
            (Known::Momentum(momentum), Known::Momentum(momentum * factor)),
            (Known::TwiceEnergy(energy), Known::TwiceEnergy(energy * factor * factor)),
        ] {
            let of = |record, known| fit(record, &Settings { known: Some(known), ..Settings::default() });
            let (a, b) = (of(&record, here).unwrap(), of(&slow, there).unwrap());
            let (a, b) = (a.inertia_covariance.unwrap(), b.inertia_covariance.unwrap());
            assert!((b - a).amax() < 1e-8 * a.amax(), "{factor:e}, {there:?}: {b}");
            // a value that asks for a tensor no number can hold
            let known = Known::TwiceEnergy(energy);
            match fit(&slow, &Settings { known: Some(known), ..Settings::default() }) {
                Ok(e) => assert!(e.inertia_covariance.unwrap().iter().all(|v| v.is_finite()), "{factor:e}"),
                Err(FitError::Setting { name: "the known quantity", .. }) => {}
                Err(error) => panic!("{factor:e}: {error}"),
            }
        }
    }
}

// ---- the failure table ----

fn refusal(record: &Record) -> FitError {
    fit(record, &Settings::default()).expect_err("this record must be refused")
}

#[test]
fn pure_spin_tells_an_axis_and_no_ratio() {
    for sigma in [0.0, 1e-6, 1e-3, 1e-1] {
        let mut random = Random::new(8);
        let r = random_rotation(&mut random);
        let axis = r * Vector3::z();
        let times = times(20);
        let rates: Vec<_> = times.iter().map(|_| axis * 3.0 + random.normal_vector() * sigma).collect();
        let record = Record::from_samples(&times, &rates).unwrap();
        let FitError::Unidentifiable(what) = refusal(&record) else {
            panic!("noise {sigma}: {}", refusal(&record))
        };
        assert_eq!(what.rank, 2, "noise {sigma}: {:?}", what.deviations);
        assert_eq!(what.null_directions[0], Undetermined::TransverseRatio);
        assert!(what.known[0].axis.cross(&axis).norm() < 1e-2, "noise {sigma}: {:?}", what.known);
    }
}

/// A flat body that spins almost about its largest axis: at most units there is some tensor for so small a wobble, so
/// that none of them may be called the right one. What averages tell of the axes is told, and true.
#[test]
fn a_drowned_spin_tells_its_axis_and_no_mistake_of_units() {
    let mut random = Random::new(60);
    let times = times(60);
    for trial in 0..4 {
        let r = random_rotation(&mut random);
        let j = turned([1.0 / 6.0, 2.0 / 6.0, 3.0 / 6.0], &r);
        let omega = r * Vector3::new(-0.066, -0.079, -0.995);
        let error = refusal(&record(&j, omega, &times, 0.1, &mut random));
        match &error {
            FitError::Unidentifiable(what) => assert!(!what.known.is_empty(), "trial {trial}: {what:?}"),
            FitError::Unsettled { axes, .. } => {
                assert!(!axes.is_empty(), "trial {trial}: {error}");
                for known in axes {
                    assert!(known.to_string().ends_with("of the trace"), "{known}");
                    let across = j * known.axis - known.axis * known.axis.dot(&(j * known.axis));
                    assert!(across.norm() < known.product, "trial {trial}: {} of {known}", across.norm());
                }
            }
            _ => panic!("trial {trial}: {error}"),
        }
    }
}

/// A mean rate is off its axis by noise, which must not pass for a wobble about it, however long the record.
#[test]
fn two_pure_spins_tell_all_axes_and_no_ratio() {
    let mut random = Random::new(18);
    for (seconds, sigma) in [(10, 1e-4), (10, 1e-2), (20, 1e-1), (40, 1e-3)] {
        let times = times(seconds);
        for trial in 0..4 {
            let r = random_rotation(&mut random);
            let spin = |k: usize, random: &mut Random| {
                let axis = r * Vector3::ith(k, 2.0);
                let rates: Vec<_> = times.iter().map(|_| axis + random.normal_vector() * sigma).collect();
                Record::from_samples(&times, &rates).unwrap()
            };
            let both = spin(0, &mut random).join(spin(2, &mut random));
            let FitError::Unidentifiable(what) = refusal(&both) else { panic!("{seconds} s, trial {trial}") };
            assert_eq!(what.rank, 3, "{seconds} s, trial {trial}: {what:?}");
            assert!(what.null_directions.iter().all(|d| d.to_string().contains("ratio")), "{what:?}");
            assert_eq!(what.known.len(), 3, "{:?}", what.known);
        }
    }
}

#[test]
fn zero_rates_and_mere_noise_are_no_rotation() {
    let times = times(10);
    let still = Record::from_samples(&times, &vec![Vector3::zeros(); times.len()]).unwrap();
    assert!(matches!(refusal(&still), FitError::NoRotation { .. }));
    let mut random = Random::new(2);
    let noise: Vec<_> = times.iter().map(|_| random.normal_vector() * 1e-3).collect();
    assert!(matches!(refusal(&Record::from_samples(&times, &noise).unwrap()), FitError::NoRotation { .. }));
}

#[test]
fn a_sphere_looks_like_a_pure_spin_until_it_is_thrown_three_ways() {
    let times = times(10);
    let mut random = Random::new(21);
    let j = Matrix3::identity() / 3.0;
    let one = record(&j, Vector3::new(1.0, 2.0, -0.5), &times, 1e-3, &mut random);
    let FitError::Unidentifiable(what) = refusal(&one) else { panic!() };
    assert_eq!(what.rank, 2);
    let mut all = one;
    for omega in [Vector3::new(-1.0, 1.0, 1.0), Vector3::new(0.5, 0.2, 2.0)] {
        all = all.join(record(&j, omega, &times, 1e-3, &mut random));
    }
    let estimate = fit(&all, &Settings::default()).unwrap();
    for k in 0..3 {
        assert!((estimate.principal[k] - 1.0 / 3.0).abs() < 5.0 * estimate.sigma_principal[k]);
    }
    assert!(
        estimate.warnings.iter().any(|w| w.to_string().contains("agree within their errors")),
        "{:?}",
        estimate.warnings
    );
}

#[test]
fn two_samples_are_too_few() {
    let record = Record::from_samples(&[0.0, 0.01], &[Vector3::x(), Vector3::y()]).unwrap();
    let message = refusal(&record).to_string();
    assert!(message.starts_with("2 samples, at most 2 without a gap"), "{message}");
}

#[test]
fn a_radius_without_room_is_refused() {
    let (_, times, rates) = example(1e-2);
    let record = Record::from_samples(&times, &rates).unwrap();
    for radius in [16.0, 0.05] {
        let refused = fit(&record, &Settings { radius: Some(radius), ..Settings::default() });
        assert!(matches!(refused, Err(FitError::Radius { .. })), "{radius}");
    }
    let given = fit(&record, &Settings { radius: Some(2.0), ..Settings::default() }).unwrap();
    assert!((given.radius - 2.0).abs() < 1e-12);
}

#[test]
fn tiny_and_huge_units_change_nothing_and_a_bad_noise_is_refused() {
    // P scaled by 1e±14 and tr J = 1e-6 or 1e8 in the table: here no unit reaches the solver at all
    let (j, times, rates) = example(1e-3);
    for factor in [1e-100, 1e100] {
        let t: Vec<f64> = times.iter().map(|t| t / factor).collect();
        let w: Vec<_> = rates.iter().map(|w| w * factor).collect();
        let estimate = fit(&Record::from_samples(&t, &w).unwrap(), &Settings::default()).unwrap();
        assert!((estimate.shape.tensor() - j).amax() < 1e-3);
    }
    let record = Record::from_samples(&times, &rates).unwrap();
    for bad in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        let settings = Settings { noise: Some(bad), ..Settings::default() };
        assert!(matches!(fit(&record, &settings), Err(FitError::Setting { name: "the noise", .. })));
    }
}

#[test]
fn units_mistaken_by_57_are_named() {
    let (_, times, rates) = example(1e-3);
    let text = |unit: &str, factor: f64| {
        let rows = times
            .iter()
            .zip(&rates)
            .map(|(t, w)| format!("{t},{},{},{}\n", w.x * factor, w.y * factor, w.z * factor));
        format!("t,wx {unit},wy {unit},wz {unit}\n{}", rows.collect::<String>())
    };
    let degrees = 180.0 / std::f64::consts::PI;
    for (unit, factor, hint) in [
        ("", degrees, "degrees per second taken for radians per second"),
        ("(deg/s)", 1.0, "radians per second taken for degrees per second"),
        ("", 30.0 / std::f64::consts::PI, "revolutions per minute taken for radians per second"),
    ] {
        let record = Record::read(&text(unit, factor), "toss.csv", Reading::default()).unwrap();
        let FitError::Units { mistakes, .. } = refusal(&record) else { panic!("{hint}") };
        assert_eq!(mistakes.iter().map(ToString::to_string).collect::<Vec<_>>(), [hint]);
        let unchecked = Settings { check_units: false, ..Settings::default() };
        if let Ok(estimate) = fit(&record, &unchecked) {
            assert!(!estimate.warnings.is_empty());
        }
    }
    let right = Record::read(&text("(deg/s)", degrees), "toss.csv", Reading::default()).unwrap();
    assert!(fit(&right, &Settings::default()).unwrap().warnings.is_empty());
}

/// At the unit it is read in no tensor settles; of larger ones that explain it several are named where noise leaves
/// several, and where it leaves them all the question is asked.
#[test]
fn mistaken_units_are_named_where_no_tensor_settles() {
    let mut random = Random::new(3);
    let pi = std::f64::consts::PI;
    let rpm = "radians per second taken for revolutions per minute";
    let mistakes = [
        (1.0, pi / 30.0, rpm),
        (1.0, pi / 180.0, "radians per second taken for degrees per second"),
        (1e-3, 1.0, "seconds taken for milliseconds"),
        (1e-6, 1.0, "seconds taken for microseconds"),
    ];
    let times = times(10);
    let thrown = |moments: [f64; 3], omega: [f64; 3], noise: f64, random: &mut Random| {
        let body = Inertia::from_moments(moments).unwrap();
        simulate(&body, Vector3::from(omega), &times, noise, random).unwrap()
    };
    let read = |rates: &[Vector3<f64>], of_times: f64, of_rates: f64| {
        let t: Vec<f64> = times.iter().map(|t| t * of_times).collect();
        let w: Vec<_> = rates.iter().map(|w| w * of_rates).collect();
        fit(&Record::from_samples(&t, &w).unwrap(), &Settings::default())
    };
    for (moments, omega, noise) in [
        ([1.0, 2.0, 2.6], [0.4, 1.0, -0.3], 5e-2),
        ([1.0, 1.5, 2.0], [3.0, 0.5, 0.4], 1e-2),
        ([0.2, 0.35, 0.45], [0.1, 0.2, 1.5], 1e-3),
    ] {
        let rates = thrown(moments, omega, noise, &mut random);
        assert!(read(&rates, 1.0, 1.0).is_ok(), "{moments:?}");
        for (of_times, of_rates, hint) in mistakes {
            match read(&rates, of_times, of_rates) {
                Err(FitError::Units { mistakes, .. }) => {
                    let named: Vec<String> = mistakes.iter().map(ToString::to_string).collect();
                    assert_eq!(named, [hint], "{moments:?}");
                }
                other => panic!("{moments:?}, {hint}: {other:?}"),
            }
        }
    }
    // in so much noise the wobble of a small body in the right unit is that of one next to a sphere in another
    let rates = thrown([1.0, 1.5, 2.0], [3.0, 0.5, 0.4], 5e-2, &mut random);
    for (of_times, of_rates, hint) in mistakes {
        let message = read(&rates, of_times, of_rates).unwrap_err().to_string();
        assert!(
            message.contains("did not converge") && message.contains("are the units right?"),
            "{hint}: {message}"
        );
    }
    // next to a sphere two units may do, of which one is right
    let rates = thrown([1.0, 1.05, 1.1], [1.0, 2.0, 1.0], 1e-3, &mut random);
    let message = read(&rates, 1.0, pi / 30.0).unwrap_err().to_string();
    assert!(message.contains(rpm) || message.contains("are the units right?"), "{message}");
}

#[test]
fn flat_tops_are_left_out_with_a_warning() {
    let mut random = Random::new(44);
    let j = turned([0.2, 0.35, 0.45], &random_rotation(&mut random));
    let times = times(30);
    let body = Inertia::from_tensor(j).unwrap();
    let mut rates = simulate(&body, Vector3::new(2.0, 4.0, -1.0), &times, 2e-3, &mut random).unwrap();
    let top = rates.iter().map(|w| w.amax()).fold(0.0, f64::max) * 0.95;
    rates.iter_mut().for_each(|w| *w = w.map(|c| c.clamp(-top, top)));
    let record = Record::from_samples(&times, &rates).unwrap();
    assert!(record.saturated() > 50);
    let estimate = fit(&record, &Settings::default()).unwrap();
    assert!(estimate.warnings.iter().any(|w| w.to_string().contains("flat tops")), "{:?}", estimate.warnings);
    let e = entries(&(estimate.shape.tensor() - j));
    assert!(distance(&e, &estimate.free_covariance) < 40.0, "{}", distance(&e, &estimate.free_covariance));
}

#[test]
fn contradictory_limits_are_named() {
    let (_, times, rates) = example(1e-2);
    let record = Record::from_samples(&times, &rates).unwrap();
    let limit = |axis, at_least, at_most| Limit { axis, at_least, at_most };
    let with = |limits| fit(&record, &Settings { limits, ..Settings::default() });
    let clash = with(vec![
        limit(Vector3::x(), None, Some(0.3)),
        limit(Vector3::y(), Some(0.1), None),
        limit(Vector3::x() * 2.0, Some(0.35), None),
    ]);
    let message = clash.unwrap_err().to_string();
    assert!(
        message.contains("limit 1") && message.contains("limit 3") && !message.contains("limit 2"),
        "{message}"
    );
    let law = with(vec![limit(Vector3::z(), Some(0.51), None)]).unwrap_err().to_string();
    assert!(law.contains("at most half the trace"), "{law}");
    assert!(matches!(
        with(vec![limit(Vector3::zeros(), None, None)]),
        Err(FitError::LimitAxis { limit: 1, .. })
    ));
    assert!(matches!(
        with(vec![limit(Vector3::x(), Some(f64::NAN), None)]),
        Err(FitError::LimitValue { limit: 1, .. })
    ));
    let free = with(Vec::new()).unwrap();
    let low = free.shape.tensor()[(0, 0)] - 0.01;
    let held = with(vec![limit(Vector3::x(), None, Some(low))]).unwrap();
    assert!((held.shape.tensor()[(0, 0)] - low).abs() < 1e-12);
    assert!(matches!(held.active_constraints[0].constraint, Constraint::AtMost { limit: 1, .. }));
}

#[test]
fn values_that_are_not_finite_never_reach_the_solver() {
    let (_, times, mut rates) = example(1e-2);
    rates[7].y = f64::NAN;
    let message = Record::from_samples(&times, &rates).unwrap_err().to_string();
    assert!(message.contains("line 8") && message.contains("(wy)"), "{message}");
}

#[test]
fn duplicate_times_are_merged_and_counted() {
    let (j, times, rates) = example(1e-3);
    let t: Vec<f64> = times.iter().flat_map(|t| [*t, *t]).collect();
    let w: Vec<_> = rates.iter().flat_map(|w| [*w, *w]).collect();
    let estimate = fit(&Record::from_samples(&t, &w).unwrap(), &Settings::default()).unwrap();
    assert!((estimate.shape.tensor() - j).amax() < 1e-3);
    assert_eq!(estimate.warnings[0].to_string(), "1500 samples were merged with the sample of the same time");
}

#[test]
fn torque_is_seen_in_the_drifts() {
    let (_, times, mut rates) = example(1e-3);
    for (t, w) in times.iter().zip(&mut rates) {
        *w *= 1.0 - 1e-3 * t;
    }
    let estimate = fit(&Record::from_samples(&times, &rates).unwrap(), &Settings::default()).unwrap();
    let drift = estimate.momentum_trend;
    assert!((drift.rate + 1e-3).abs() < 5e-5, "{drift:?}");
    assert!((estimate.energy_trend.rate + 2e-3).abs() < 1e-4, "{:?}", estimate.energy_trend);
    assert!(
        estimate.warnings.iter().any(|w| w.to_string().contains("not free of torques")),
        "{:?}",
        estimate.warnings
    );
}

/// Two degrees off the major axis with a noise of a tenth of the rate: the wobble drowns.
#[test]
fn a_drowned_wobble_is_refused_or_flagged() {
    let mut random = Random::new(6);
    let r = random_rotation(&mut random);
    let j = turned([1.0 / 5.6, 2.0 / 5.6, 2.6 / 5.6], &r);
    let omega = r * Vector3::new(0.035, 0.0, 0.9994);
    for sigma in [1e-2, 1e-1] {
        match fit(&record(&j, omega, &times(60), sigma, &mut random), &Settings::default()) {
            Ok(estimate) => {
                assert!(
                    estimate.warnings.iter().any(|w| w.to_string().contains("only approximate")),
                    "{:?}",
                    estimate.warnings
                );
            }
            Err(FitError::Unidentifiable(_)) => {}
            Err(error) => panic!("{error}"),
        }
    }
}

/// J = n nᵀ solves the weak equations of any spin about n, with residuals and covariance that vanish together.
#[test]
fn the_trivial_tensor_of_a_short_record_is_no_answer() {
    let body = Inertia::from_moments([0.2876, 0.2876, 0.4246]).unwrap();
    let times: Vec<f64> = (0..=120).map(|i| 0.0009 * f64::from(i)).collect();
    for seed in 1..=12 {
        let mut random = Random::new(seed);
        let rates = simulate(&body, Vector3::new(0.26, 26.3, 0.26), &times, 2.7e-4, &mut random).unwrap();
        let error = refusal(&Record::from_samples(&times, &rates).unwrap());
        let named = matches!(error, FitError::Unidentifiable(_) | FitError::Unsettled { .. });
        assert!(named, "seed {seed}: {error}");
    }
}

/// Rounds that lose the smallest moment of a slender body have no covariance to go on with.
#[test]
fn a_pencil_is_fitted_where_its_wobble_is_plain() {
    let body = Inertia::from_moments([0.00227, 1.0, 1.0]).unwrap();
    let times: Vec<f64> = (0..1000).map(|i| 0.03 * f64::from(i)).collect();
    let mut fitted = 0;
    for seed in 1..=8 {
        let rates =
            simulate(&body, Vector3::new(1.0, 0.3, 0.3), &times, 1e-2, &mut Random::new(seed)).unwrap();
        let Ok(estimate) = fit(&Record::from_samples(&times, &rates).unwrap(), &Settings::default()) else {
            continue;
        };
        fitted += 1;
        let off = (estimate.principal[0] - 0.00227 / 2.00227).abs();
        assert!(off < 5.0 * estimate.sigma_principal[0].max(1e-4), "seed {seed}: {off:e}");
    }
    assert!(fitted >= 6, "{fitted} of 8");
}

/// Times that scatter widely leave a misfit of the quadrature, which a wrong unit must not be taken to explain.
#[test]
fn irregular_times_are_no_mistake_of_units() {
    let body = Inertia::from_moments([1.0, 1.9, 2.6]).unwrap();
    for seed in 1..=4 {
        let mut random = Random::new(seed);
        let times: Vec<f64> =
            (0..600).map(|i| 0.2 * (f64::from(i) + 0.95 * (random.uniform() - 0.5))).collect();
        let rates = simulate(&body, Vector3::new(0.4, 1.0, 0.5), &times, 1e-5, &mut random).unwrap();
        let estimate = fit(&Record::from_samples(&times, &rates).unwrap(), &Settings::default()).unwrap();
        for (share, truth) in estimate.principal.iter().zip([1.0, 1.9, 2.6]) {
            assert!((share - truth / 5.5).abs() < 1e-4, "seed {seed}: {:?}", estimate.principal);
        }
    }
}

#[test]
fn limits_that_contradict_the_record_are_seen_in_the_misfit() {
    let mut random = Random::new(12);
    let times = times(30);
    let body = Inertia::from_moments([1.0, 2.0, 2.6]).unwrap();
    let rates = simulate(&body, Vector3::new(0.3, 1.0, 0.4), &times, 1e-2, &mut random).unwrap();
    let record = Record::from_samples(&times, &rates).unwrap();
    let limited = |at_least, at_most| {
        let limits = vec![Limit { axis: Vector3::x(), at_least, at_most }];
        fit(&record, &Settings { limits, ..Settings::default() }).unwrap()
    };
    let free = limited(Some(0.1), None);
    assert_eq!(free.pull, 0.0);
    assert!(free.chi2_per_dof < 1.2);
    for held in [limited(Some(0.4), None), limited(Some(0.3), Some(0.300_01))] {
        assert!(held.pull > 100.0 && held.chi2_per_dof > 10.0, "{} {}", held.pull, held.chi2_per_dof);
        let mean = held.residuals[0].mean_square;
        assert!((mean / held.chi2_per_dof - 1.0).abs() < 0.1, "{mean} {}", held.chi2_per_dof);
        assert!(
            held.warnings.iter().any(|w| w.to_string().contains("contradicts them")),
            "{:?}",
            held.warnings
        );
        let variances = held.covariance.diagonal();
        assert!(variances.iter().all(|v| *v >= 0.0), "{variances}");
    }
}

#[test]
fn settings_out_of_range_are_refused_with_their_rule() {
    let mut random = Random::new(13);
    let times = times(10);
    let body = Inertia::from_moments([1.0, 2.0, 2.6]).unwrap();
    let rates = simulate(&body, Vector3::new(0.3, 1.0, 0.4), &times, 1e-2, &mut random).unwrap();
    let record = Record::from_samples(&times, &rates).unwrap();
    let with = |settings| fit(&record, &settings).expect_err("must be refused").to_string();
    for noise in [1e-200, 1e-160, 1e200] {
        let message = with(Settings { noise: Some(noise), ..Settings::default() });
        assert!(message.contains("whose square neither underflows nor overflows"), "{message}");
    }
    let message = with(Settings { radius: Some(0.0401), ..Settings::default() });
    assert!(message.contains("nearly as many equations as there are samples"), "{message}");
}

#[test]
fn a_segment_is_consistent_or_refused() {
    let rates = |n: usize| vec![Vector3::new(0.5, 1.0, -2.0); n];
    let good = Segment::new("a", vec![-1.0, 0.0, 5e-324], rates(3)).unwrap();
    assert_eq!((good.source(), good.times(), good.rates()), ("a", &[-1.0, 0.0, 5e-324][..], &rates(3)[..]));
    let refused = |times: Vec<f64>, rates: Vec<Vector3<f64>>| Segment::new("a", times, rates).unwrap_err();
    let times: Vec<f64> = (0..40).map(f64::from).collect();
    assert_eq!(refused(times, rates(3)), RecordError::Lengths { times: 40, rates: 3 });
    let file = String::from("a");
    assert_eq!(
        refused(vec![0.0, 2.0, 1.0], rates(3)),
        RecordError::Order { file: file.clone(), line: 3, time: 1.0, before: 2.0 }
    );
    assert!(matches!(refused(vec![0.0, 0.0], rates(2)), RecordError::Order { line: 2, .. }));
    assert_eq!(refused(vec![], vec![]), RecordError::Empty { file, window: None, span: (0.0, 0.0) });
    let mut broken = rates(3);
    broken[1].y = f64::NAN;
    assert_eq!(
        refused(vec![0.0, 1.0, 2.0], broken).to_string(),
        "a, line 2, column 3 (wy): \"NaN\" is not a finite number; remove the row, or leave a gap"
    );
    assert!(matches!(
        refused(vec![0.0, f64::INFINITY], rates(2)),
        RecordError::Value { line: 2, column: 1, .. }
    ));
}

/// Principal axes and moments of tensors drawn from the covariance scatter as the report says.
#[test]
fn deviations_of_axes_and_moments_are_those_of_the_covariance() {
    let (_, times, rates) = example(1e-2);
    let e = fit(&Record::from_samples(&times, &rates).unwrap(), &Settings::default()).unwrap();
    let spread = e.covariance.symmetric_eigen();
    let factor = spread.eigenvectors
        * SMatrix::<f64, 6, 6>::from_diagonal(&spread.eigenvalues.map(|v| v.max(0.0).sqrt()));
    let mean = e.axes.to_rotation_matrix().into_inner();
    let mut random = Random::new(5);
    let (mut turns, mut moments, mut ratios) = ([0.0; 3], [0.0; 3], [0.0; 2]);
    let square = |x: f64| x * x;
    let count = 4000.0;
    for _ in 0..4000 {
        let noise = factor * SMatrix::<f64, 6, 1>::from_fn(|_, _| random.normal());
        let mut j = e.shape.tensor();
        for (k, (a, b)) in ENTRIES.into_iter().enumerate() {
            j[(a, b)] = e.shape.tensor()[(a, b)] + noise[k];
            j[(b, a)] = j[(a, b)];
        }
        let drawn = j.symmetric_eigen();
        let mut order = [0, 1, 2];
        order.sort_by(|&a, &b| drawn.eigenvalues[a].total_cmp(&drawn.eigenvalues[b]));
        let value = |k: usize| drawn.eigenvalues[order[k]];
        for k in 0..3 {
            // the turn about axis k takes the next axis towards the one after
            let (a, b) = ((k + 1) % 3, (k + 2) % 3);
            let (next, after) = (drawn.eigenvectors.column(order[a]), mean.column(b));
            turns[k] += square(next.dot(&after)) / count;
            moments[k] += square(value(k) - e.principal[k]) / count;
        }
        for (k, (sum, ratio)) in ratios.iter_mut().zip(e.ratios).enumerate() {
            *sum += square(value(k) / value(2) - ratio) / count;
        }
    }
    let compare = |found: &[f64], said: &[f64]| {
        for (found, said) in found.iter().zip(said) {
            assert!((found.sqrt() / said - 1.0).abs() < 0.06, "{} but {said}", found.sqrt());
        }
    };
    compare(&turns, &e.sigma_axes);
    compare(&moments, &e.sigma_principal);
    compare(&ratios, &e.sigma_ratios);
}

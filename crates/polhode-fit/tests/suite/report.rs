//! Fields of the report beside each other and beside what was simulated.

use nalgebra::Vector3;
use polhode::inertia::Inertia;
use polhode::num::Random;
use polhode_fit::{
    Disturbances, Estimate, FitError, Gyroscope, Known, Method, Poses, Prior, Record, Settings, TorqueModel,
    TorqueNoise, fit, fit_poses, simulate_poses, simulate_with,
};

use crate::measured::sampled;

const MOMENTS: [f64; 3] = [1.0, 2.0, 2.6];
const START: Vector3<f64> = Vector3::new(0.4, 0.9, -0.5);

fn body() -> Inertia {
    Inertia::from_moments(MOMENTS).unwrap()
}

fn record(by: &Disturbances, sigma: f64, seconds: &[usize], seed: u64) -> Record {
    let mut random = Random::new(seed);
    let mut all = Record::default();
    for (k, seconds) in seconds.iter().enumerate() {
        let (times, omega) =
            (sampled(20, *seconds), if k % 2 == 0 { START } else { Vector3::new(-0.7, 0.3, 0.6) });
        let gyroscope = Gyroscope::default().with_noise(sigma);
        let rates = simulate_with(&body(), omega, &times, by, &gyroscope, &mut random).unwrap();
        all = all.join(Record::from_samples(&times, &rates).unwrap());
    }
    all
}

fn near(e: &Estimate) {
    for (k, moment) in MOMENTS.into_iter().enumerate() {
        assert!((e.principal[k] - moment / 5.6).abs() < 5.0 * e.sigma_principal[k], "{k}: {:?}", e.principal);
    }
}

/// Without torque noise the gain of a drag is half the square of its deviations, in the choice and beside the other models; without it the
/// ratios are those of the fit without a torque.
#[test]
fn the_gain_of_a_torque_is_that_of_its_deviations() {
    let drag = 4e-5;
    let by = Disturbances::default().with_relative_drag(drag);
    let record = record(&by, 3e-3, &[40, 30], 3);
    let settings = Settings::default().with_torque_noise(TorqueNoise::None);
    let e = fit(&record, &settings).unwrap();
    near(&e);
    let [own] = &e.torque.coefficients[..] else { panic!("{:?}", e.torque) };
    assert!(e.torque.model == TorqueModel::Drag && e.torque.is_chosen && own.name == "drag");
    assert!((own.value - drag).abs() < 5.0 * own.sigma, "{own:?}");
    let gain = e.torque.gain.unwrap();
    let z = own.value / own.sigma;
    assert!((gain / (0.5 * z * z) - 1.0).abs() < 0.15, "{gain} {z}");
    let of = |model| e.models.iter().find(|one| one.model == model).unwrap();
    assert!(
        (of(TorqueModel::Drag).gain - gain).abs() < 1e-6 * gain && of(TorqueModel::None).gain.abs() < 1e-9
    );
    let shares = e.models.iter().map(|one| one.share).chain(e.reading_errors.iter().map(|one| one.share));
    assert!((shares.sum::<f64>() - 1.0).abs() < 1e-9);
    let none = fit(&record, &settings.clone().with_torque(TorqueModel::None)).unwrap();
    let without = e.torque.ratios_without.unwrap();
    for k in 0..2 {
        assert!(
            (without[k] - none.ratios[k]).abs() < 0.2 * none.sigma_ratios[k],
            "{without:?} {:?}",
            none.ratios
        );
        assert!((of(TorqueModel::None).ratios[k] - none.ratios[k]).abs() < 0.2 * none.sigma_ratios[k]);
    }
    // momentum falls by the drag, energy twice as fast
    for (trend, times) in [(none.momentum_trend.unwrap(), 1.0), (none.energy_trend.unwrap(), 2.0)] {
        assert!((trend.rate + times * drag).abs() < 5.0 * trend.sigma && trend.sigma < 3e-5, "{trend:?}");
    }
    // the longer segment tells more, and each says the same by itself
    assert_eq!((e.segments, e.samples), (2, 801 + 601));
    assert!((e.per_segment.iter().map(|s| s.weight).sum::<f64>() - 1.0).abs() < 1e-9);
    for segment in &e.per_segment {
        let without = segment.without.unwrap();
        assert!((0..2).all(|k| (without.ratios[k] - e.ratios[k]).abs() < 5.0 * without.sigma_ratios[k]));
        assert!((segment.noise_sigma / 3e-3 - 1.0).abs() < 0.1 && segment.torque_noise == 0.0);
    }
    assert!((e.noise_sigma / 3e-3 - 1.0).abs() < 0.1 && (e.chi2_per_dof - 1.0).abs() < 0.3);
    let rms = record.segments.iter().flat_map(|s| s.rates()).map(|w| w.norm_squared()).sum::<f64>()
        / e.samples as f64;
    assert!((e.rms_rate / rms.sqrt() - 1.0).abs() < 1e-12);
    let correlation = e.correlation();
    assert!(
        (0..6).all(|k| (correlation[(k, k)] - 1.0).abs() < 1e-12)
            && correlation.iter().all(|c| c.abs() < 1.0 + 1e-12)
    );
}

fn poses(by: &Disturbances, sigma: f64, seed: u64) -> Poses {
    let times = sampled(10, 30);
    let made =
        simulate_poses(&body(), START, &times, by, &Gyroscope::default(), sigma, &mut Random::new(seed));
    Poses::new("markers", &times, &made.unwrap().attitudes).unwrap()
}

/// The drag of attitudes is the trend of their momentum, with its gain and what the tensor would be without it; also by the smoother.
#[test]
fn attitudes_tell_their_drag_with_its_gain() {
    let drag = 3e-4;
    let measured = poses(&Disturbances::default().with_relative_drag(drag), 3e-3, 5);
    let exact = fit_poses(&measured, &Settings::default()).unwrap();
    assert!(exact.method == Method::ExactMotion && exact.torque.model == TorqueModel::Drag);
    near(&exact);
    let [own] = &exact.torque.coefficients[..] else { panic!("{:?}", exact.torque) };
    let trend = exact.momentum_trend.unwrap();
    assert_eq!((trend.rate, trend.sigma), (-own.value, own.sigma));
    assert!((own.value - drag).abs() < 5.0 * own.sigma && own.sigma < 0.2 * drag, "{own:?}");
    // the tensor without it, as among the models
    let none = exact.models.iter().find(|one| one.model == TorqueModel::None).unwrap();
    let without = exact.torque.ratios_without.unwrap();
    assert!((0..2).all(|k| (without[k] - none.ratios[k]).abs() < 1e-9), "{without:?} {:?}", none.ratios);
    let of_drag = exact.models.iter().find(|one| one.model == TorqueModel::Drag).unwrap();
    assert!((of_drag.gain / exact.torque.gain.unwrap() - 1.0).abs() < 1e-9 && none.gain == 0.0);
    let attitudes = exact.attitudes.as_ref().unwrap();
    assert!((attitudes.noise_sigma / 3e-3 - 1.0).abs() < 0.15 && attitudes.left_out == 0);
    assert!(exact.noise_sigma == 0.0 && exact.per_segment[0].noise_sigma == 0.0);
    assert!((exact.residuals[0].mean_square - 1.0).abs() < 0.05 && exact.residuals[0].times.len() == 301);
    assert!((exact.residuals[0].times[300] - 30.0).abs() < 1e-9 && exact.residuals[0].times[0].abs() < 1e-9);

    // drag with the square of the rate is left to the smoother
    let settings = Settings::default().with_torque(TorqueModel::Quadratic);
    let e = fit_poses(&measured, &settings).unwrap();
    assert!(e.method == Method::Smoother && e.torque.coefficients.len() == 1 && !e.torque.is_chosen);
    near(&e);
    // a torque that was asked for is compared with none
    assert!(e.torque.gain.is_none() && e.torque.ratios_without.is_none());
    assert!((e.attitudes.as_ref().unwrap().noise_sigma / 3e-3 - 1.0).abs() < 0.15 && e.noise_sigma == 0.0);
    assert!((e.chi2_per_dof - 1.0).abs() < 0.3 && e.samples == 301 && e.segments == 1);
    // −c |ω| J ω is the drag at the rates that the body has
    let c = &e.torque.coefficients[0];
    assert!((c.value * e.rms_rate / drag - 1.0).abs() < 0.5, "{c:?}");
    assert!((e.residuals[0].mean_square - 1.0).abs() < 0.05 && e.per_segment[0].weight == 1.0);
    let given = Settings::default().with_torque_noise(TorqueNoise::Given(1e-6));
    let noisy = fit_poses(&measured, &given).unwrap();
    assert!((noisy.per_segment[0].torque_noise / 1e-6 - 1.0).abs() < 0.2, "{:?}", noisy.per_segment);
    if let Some(without) = noisy.torque.ratios_without {
        let none = fit_poses(&measured, &given.with_torque(TorqueModel::None)).unwrap();
        assert!((0..2).all(|k| (without[k] - none.ratios[k]).abs() < 1e-3), "{without:?} {:?}", none.ratios);
    }
}

/// What a spin tells by itself is said of the record alone, also where a prior tensor supplies the rest.
#[test]
fn a_prior_completes_a_spin_and_leaves_what_it_tells() {
    let times = sampled(20, 30);
    let gyroscope = Gyroscope::default().with_noise(3e-3);
    let spin = Vector3::new(0.0, 0.0, 1.0);
    let free = Disturbances::default();
    let rates = simulate_with(&body(), spin, &times, &free, &gyroscope, &mut Random::new(9)).unwrap();
    let record = Record::from_samples(&times, &rates).unwrap();
    let Err(FitError::Unidentifiable(alone)) = fit(&record, &Settings::default()) else { panic!() };
    assert_eq!(alone.rank, 2);
    let prior = Prior::relative(body().tensor(), 0.01);
    let e = fit(&record, &Settings::default().with_prior(prior)).unwrap();
    let agreement = e.prior.unwrap();
    // the 99.99 % point of χ² with five degrees of freedom
    assert!(agreement.chi2 < 25.75 && agreement.dof == 5, "{agreement:?}");
    for k in 0..2 {
        let ratio = e.identifiability.deviations[k] / alone.deviations[k];
        // weighted as for a sphere where no tensor is known
        assert!((0.1..10.0).contains(&ratio), "{k}: {ratio}");
    }
    near(&e);
    // no surer of the moments than the prior, and no less
    assert!(
        (0..3).all(|k| (0.2..1.2).contains(&(e.sigma_principal[k] / (0.01 * MOMENTS[k] / 5.6)))),
        "{:?}",
        e.sigma_principal
    );
}

/// A trace scales the covariance of the shape by its square; a moment that is known about an axis leaves no variance there.
#[test]
fn known_sizes_scale_the_covariance_of_the_shape() {
    let axis = Vector3::new(0.6, 0.0, 0.8);
    let along = nalgebra::SMatrix::<f64, 6, 1>::new(0.36, 0.0, 0.64, 0.0, 2.0 * 0.48, 0.0);
    let moment = axis.dot(&(body().tensor() * axis));
    let measured = poses(&Disturbances::default(), 3e-3, 6);
    let rates = record(&Disturbances::default(), 3e-3, &[30], 4);
    let fits: [&dyn Fn(&Settings) -> Estimate; 2] =
        [&|settings| fit(&rates, settings).unwrap(), &|settings| fit_poses(&measured, settings).unwrap()];
    for fit in fits {
        let of_trace = fit(&Settings::default().with_known(Known::Trace(5.6)));
        let (own, shape) = (of_trace.inertia_covariance.unwrap(), of_trace.covariance * (5.6 * 5.6));
        assert!((own - shape).amax() < 1e-9 * shape.amax());
        let of_moment =
            fit(&Settings::default().with_known(Known::Moment { axis: axis * 2.0, value: moment }));
        let (tensor, covariance) =
            (of_moment.inertia.unwrap().tensor(), of_moment.inertia_covariance.unwrap());
        assert!((axis.dot(&(tensor * axis)) / moment - 1.0).abs() < 1e-12);
        assert!(along.dot(&(covariance * along)) < 1e-6 * covariance.amax());
        // the other entries are right within their deviations
        for (k, truth) in [1.0, 2.0, 2.6].into_iter().enumerate() {
            assert!(
                (tensor[(k, k)] - truth).abs() < 5.0 * covariance[(k, k)].sqrt() + 1e-12,
                "{k}: {tensor}"
            );
        }
    }
}

/// A prior that attitudes exclude is refused with both tensors, and one that agrees with them joins them.
#[test]
fn attitudes_refuse_a_prior_that_they_exclude() {
    let measured = poses(&Disturbances::default(), 3e-3, 6);
    let right = Settings::default().with_prior(Prior::relative(body().tensor(), 0.01));
    let e = fit_poses(&measured, &right).unwrap();
    let free = fit_poses(&measured, &Settings::default()).unwrap();
    near(&e);
    assert!(e.prior.unwrap().chi2 < 25.75 && e.prior.unwrap().dof == 5 && free.prior.is_none());
    assert!((0..3).all(|k| e.sigma_principal[k] <= free.sigma_principal[k] * 1.001));
    let wrong = Inertia::from_moments([2.0, 1.0, 2.6]).unwrap().tensor();
    for settings in [Settings::default(), Settings::default().with_torque(TorqueModel::Quadratic)] {
        let settings = settings.with_prior(Prior::relative(wrong, 0.01));
        let Err(FitError::PriorContradicted { prior, record, dof: 5, .. }) = fit_poses(&measured, &settings)
        else {
            panic!()
        };
        assert!((prior[0] - 2.0 / 5.6).abs() < 1e-12 && (record[0] - 1.0 / 5.6).abs() < 0.01);
    }
}

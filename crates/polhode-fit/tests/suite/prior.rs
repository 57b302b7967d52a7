//! Fits with a tensor that is known beforehand.

use nalgebra::{Matrix3, SMatrix, Vector3};
use polhode::inertia::Inertia;
use polhode::num::Random;
use polhode_fit::{FitError, Known, Limit, Prior, Record, Segment, Settings, fit, simulate};

use crate::measured::{distance, entries, random_rotation, sampled, turned};

const MOMENTS: [f64; 3] = [1.0, 2.0, 2.6];

/// A tensor drawn from a prior about `model`.
fn drawn(model: &Matrix3<f64>, share: f64, random: &mut Random) -> Matrix3<f64> {
    let mut body = *model;
    for i in 0..3 {
        for j in 0..=i {
            let deviation = share * (model[(i, i)] * model[(j, j)]).sqrt();
            body[(i, j)] += deviation * random.normal();
            body[(j, i)] = body[(i, j)];
        }
    }
    body
}

fn record(body: &Matrix3<f64>, sigma: f64, random: &mut Random) -> Record {
    let times = sampled(20, 20);
    let omega = random.normal_vector().normalize();
    let body = Inertia::from_tensor(*body).unwrap();
    let rates = simulate(&body, omega, &times, sigma, random).unwrap();
    Record::from_samples(&times, &rates).unwrap()
}

/// Bodies are drawn from the prior: e is then normal with the covariance that the fit states, of shape and of size. The
/// mean of χ² over its 5 and 6 degrees of freedom scatters over 60 bodies by √(2/300) = 0.08 and 0.075.
#[test]
#[ignore = "an ensemble: takes seconds, `.ci/run` does it"]
fn bodies_from_a_prior_are_covered_by_the_joint_covariance() {
    let mut random = Random::new(71);
    let model = turned(MOMENTS, &random_rotation(&mut random));
    let share = 3e-3;
    let (mut of_shape, mut of_size, mut of_agreement, mut narrower) = (0.0, 0.0, 0.0, 0.0);
    let count = 60;
    for _ in 0..count {
        let body = drawn(&model, share, &mut random);
        let record = record(&body, 1e-2, &mut random);
        let prior = Prior::relative(model, share);
        let e = fit(&record, &Settings::default().with_prior(prior)).unwrap();
        let alone = fit(&record, &Settings::default()).unwrap();
        of_shape += distance(&entries(&(e.shape.tensor() - body / body.trace())), &e.free_covariance) / 5.0;
        let error = entries(&(e.inertia.expect("a size").tensor() - body));
        let covariance = e.inertia_covariance.unwrap();
        of_size += error.dot(&covariance.cholesky().expect("six entries").solve(&error)) / 6.0;
        let agreement = e.prior.unwrap();
        assert_eq!(agreement.dof, 5);
        of_agreement += agreement.chi2 / 5.0;
        narrower += e.free_covariance.trace() / alone.free_covariance.trace();
    }
    let mean = |sum: f64| sum / f64::from(count);
    println!(
        "chi squared over its degrees: shape {:.3}, size {:.3}, agreement {:.3}; variance over that of the record {:.3}",
        mean(of_shape),
        mean(of_size),
        mean(of_agreement),
        mean(narrower)
    );
    for (value, scatter) in [(mean(of_shape), 0.082), (mean(of_size), 0.075), (mean(of_agreement), 0.082)] {
        assert!((value - 1.0).abs() < 4.0 * scatter, "{value:.3}");
    }
    assert!(mean(narrower) < 0.8);
}

/// Bodies are drawn from the prior and spin about a principal axis: the record tells that axis and no ratio, the prior the
/// rest. The mean of χ² over its 5 degrees of freedom scatters over 40 bodies by √(2/200) = 0.1.
#[test]
#[ignore = "an ensemble: takes seconds, `.ci/run` does it"]
fn a_prior_fills_what_a_pure_spin_leaves_open() {
    let mut random = Random::new(75);
    let model = turned(MOMENTS, &random_rotation(&mut random));
    let share = 2e-2;
    let (mut of_shape, mut of_axis, count) = (0.0, 0.0, 40);
    for k in 0..count {
        let body = drawn(&model, share, &mut random);
        let inertia = Inertia::from_tensor(body).unwrap();
        let axis = if k % 2 == 0 { 2 } else { 0 };
        let times = sampled(20, 20);
        let spin = inertia.principal_axes() * Vector3::ith(axis, 1.0);
        let rates = simulate(&inertia, spin, &times, 1e-2, &mut random).unwrap();
        let record = Record::from_samples(&times, &rates).unwrap();
        let alone = fit(&record, &Settings::default()).unwrap_err();
        assert!(matches!(&alone, FitError::Unidentifiable(what) if what.rank == 2), "{alone}");
        let prior = Prior::relative(model, share);
        let e = fit(&record, &Settings::default().with_prior(prior)).unwrap();
        // the axis to the mean rate's 0.01/√400 over the difference of two moments, which is a third of the trace at most
        let told = e.identifiability.deviations;
        assert!(e.identifiability.rank == 2 && told[1] < 5e-4 && told[2] > 0.1, "{told:?}");
        assert!(e.inertia.is_some() && e.prior.unwrap().chi2 < 30.0);
        of_shape += distance(&entries(&(e.shape.tensor() - body / body.trace())), &e.free_covariance) / 5.0;
        // the mean rate has a deviation of 0.01/√400 a component
        let found = e.axes * Vector3::ith(axis, 1.0);
        of_axis += found.cross(&spin).norm() / f64::from(count);
    }
    let of_shape = of_shape / f64::from(count);
    println!("chi squared over its degrees {of_shape:.3}, mean error of the axis {of_axis:.2e} rad");
    assert!((of_shape - 1.0).abs() < 0.4 && of_axis < 1e-3);
}

/// By the formula of two normal distributions, from the record's own answer and the derivatives of the shape by differences.
#[test]
fn record_and_prior_join_as_two_normal_distributions() {
    let mut random = Random::new(72);
    let body = turned(MOMENTS, &random_rotation(&mut random));
    let model = drawn(&body, 2e-3, &mut random);
    let record = record(&body, 3e-3, &mut random);
    let alone = fit(&record, &Settings::default()).unwrap();
    let prior = Prior::relative(model, 2e-3).shape_only();
    let e = fit(&record, &Settings::default().with_prior(prior)).unwrap();
    assert!(e.inertia.is_none());
    // entries of the shape as a function of those of the tensor
    let shape = |t: &SMatrix<f64, 6, 1>| t / (t[0] + t[1] + t[2]);
    let (at, h) = (entries(&model), 1e-6);
    let mut slope = SMatrix::<f64, 6, 6>::zeros();
    for k in 0..6 {
        let mut step = SMatrix::<f64, 6, 1>::zeros();
        step[k] = h;
        slope.set_column(k, &((shape(&(at + step)) - shape(&(at - step))) / (2.0 * h)));
    }
    let deviations = SMatrix::<f64, 6, 6>::from_diagonal(&SMatrix::from_fn(|k, _| {
        let (i, j) = [(0, 0), (1, 1), (2, 2), (0, 1), (0, 2), (1, 2)][k];
        4e-6 * model[(i, i)] * model[(j, j)]
    }));
    let of_prior = slope * deviations * slope.transpose();
    let inverse = |c: &SMatrix<f64, 6, 6>| c.pseudo_inverse(1e-12 * c.amax()).unwrap();
    // both have rank 5 with the same null vector, the trace
    let information = inverse(&alone.free_covariance) + inverse(&of_prior);
    let expected = information.pseudo_inverse(1e-9 * information.amax()).unwrap();
    assert!((e.free_covariance - expected).amax() < 1e-5 * expected.amax());
    let mean = expected
        * (inverse(&alone.free_covariance) * entries(&alone.shape.tensor())
            + inverse(&of_prior) * shape(&at));
    // where the trace is put aside, a third of it stays on the diagonal
    let apart = entries(&(e.shape.tensor() - Matrix3::identity() / 3.0)) - mean;
    assert!(apart.amax() < 1e-4 * expected.diagonal().amax().sqrt(), "{apart}");
}

/// A wheel and a prior both tell the size: the answer lies between, nearer to the better known.
#[test]
fn a_wheel_and_a_prior_share_the_size() {
    let mut random = Random::new(73);
    let j = turned(MOMENTS, &random_rotation(&mut random));
    let times = sampled(50, 20);
    let wheel = Vector3::new(0.1, 0.3, 0.25);
    let rates =
        crate::measured::torques::motion(&j, Vector3::new(0.3, 1.0, 0.4), &times, &|_, w| -w.cross(&wheel));
    let noisy: Vec<_> = rates.iter().map(|w| w + random.normal_vector() * 1e-2).collect();
    let segment = Segment::new("wheel", times.clone(), noisy).unwrap();
    let mut record = Record::default();
    record.segments.push(segment.with_wheel(vec![wheel; times.len()]).unwrap());
    let trace = |settings: &Settings| fit(&record, settings).unwrap().inertia.unwrap().tensor().trace();
    let sigma = |settings: &Settings| {
        let c = fit(&record, settings).unwrap().inertia_covariance.unwrap();
        c.fixed_view::<3, 3>(0, 0).sum().sqrt()
    };
    let alone = Settings::default();
    // each entry to one part in a hundred: the trace to √Σ I_kk² of it
    let prior = Prior::relative(j * 1.01, 0.01);
    let of_prior = 0.0101 * j.diagonal().norm();
    let joined = Settings::default().with_prior(prior);
    let of_wheel = sigma(&alone);
    let expected = of_wheel * of_prior / (of_wheel * of_wheel + of_prior * of_prior).sqrt();
    println!("{} {} {expected}", trace(&joined), sigma(&joined));
    // the shape tells of the size, too, so that the deviation may fall below that of two numbers alone
    assert!(sigma(&joined) < 1.05 * expected && sigma(&joined) > 0.5 * expected);
    assert!((trace(&joined) - 5.6).abs() < 4.0 * sigma(&joined));
}

#[test]
fn contradictions_are_named_with_their_numbers() {
    let mut random = Random::new(74);
    let body = turned(MOMENTS, &random_rotation(&mut random));
    let record = record(&body, 1e-3, &mut random);
    let with = |prior: Prior, settings: Settings| {
        let error = fit(&record, &settings.with_prior(prior)).unwrap_err();
        println!("{error}");
        (error.to_string(), error)
    };
    // the signs of the products, as some CAD systems print them
    let mirrored = Matrix3::from_fn(|i, k| if i == k { body[(i, k)] } else { -body[(i, k)] });
    let (text, error) = with(Prior::relative(mirrored, 0.01), Settings::default());
    assert!(matches!(error, FitError::PriorContradicted { dof: 5, .. }));
    assert!(text.contains("the signs of its products") && text.contains("of 5 degrees of freedom"), "{text}");
    let spread = Matrix3::from_diagonal(&Vector3::new(1.0, 1.0, 3.0));
    let (text, error) = with(Prior::relative(spread, 0.01), Settings::default());
    assert!(matches!(error, FitError::PriorOutside { .. }));
    assert!(text.contains("the law I1 + I2 >= I3"), "{text}");
    let limit = Limit { axis: Vector3::z(), at_least: None, at_most: Some(0.1) };
    let (text, _) = with(Prior::relative(body, 0.01), Settings::default().with_limits(vec![limit]));
    assert!(text.contains("limit 1: moment about (0, 0, 1) <= 0.1"), "{text}");
    let known = Some(Known::Trace(8.0));
    let (text, _) = with(Prior::relative(body, 0.01), Settings::default().with_known(known));
    assert!(text.contains("has the trace 5.6000e0 +- ") && text.contains("gives 8.0000e0"), "{text}");
    let known = Some(Known::Trace(5.62));
    let settings = Settings::default().with_known(known).with_prior(Prior::relative(body, 0.01));
    assert!((fit(&record, &settings).unwrap().inertia.unwrap().tensor().trace() - 5.62).abs() < 1e-12);
    let (text, _) = with(Prior::relative(body, 0.0), Settings::default());
    assert!(text.contains("smallest eigenvalue is 0.000e0"), "{text}");
}

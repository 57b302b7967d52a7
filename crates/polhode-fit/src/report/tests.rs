//! Numbers and warnings of a report against simulations and differences, and what is said where a number passes its threshold.

use std::sync::OnceLock;

use nalgebra::{Matrix3, SMatrix, Vector3};
use polhode::inertia::Inertia;
use polhode::num::Random;
use polhode::record::{Record, Segment};
use polhode::rotation::Quat;

use crate::error::FitError;
use crate::estimator::{Fitted, fit, fitted};
use crate::likelihood::alternatives::RateError;
use crate::likelihood::descent::Levels;
use crate::likelihood::growth::Followed;
use crate::likelihood::track::Model;
use crate::models::equations::Equations;
use crate::models::reading_error::ReadingError;
use crate::physical::constraint::{ActiveConstraint, Constraint};
use crate::physical::coordinates::{Coordinates, Form, basis, coordinates, eigen, tensor};
use crate::poses::free::{Free, Read};
use crate::poses::misread::Misread;
use crate::report::answer::{Answer, ratios_of, sigmas};
use crate::report::attitudes::AttitudeFit;
use crate::report::estimate::{Estimate, Method, Residuals};
use crate::report::exact::size;
use crate::report::identifiability::{Identifiability, Undetermined};
use crate::report::likelihood::{Of, absolute, identify};
use crate::report::next_step::{Contradiction, NextStep, Origin};
use crate::report::nuisance::Systematic;
use crate::report::parts::{Halves, Scatter, instead, quantile, rows_between};
use crate::report::suspect::{Refuted, Suspect};
use crate::report::torque_free::{InvariantTrend, Memory, Whiteness, memory, trends};
use crate::report::warning::Warning;
use crate::report::warnings::{
    Doubts, Grounds, has_zero_inputs, of_answer, of_likelihood, of_rates, of_record, of_smoothed,
    short_segments, warnings,
};
use crate::settings::Settings;
use crate::settings::known::Known;
use crate::settings::torque::{TorqueModel, TorqueNoise};
use crate::signal::normalised::{Normalised, normalised};
use crate::signal::stretch::Stretch;
use crate::simulate::{Disturbances, Gyroscope, simulate_with};
use crate::solve::weak_estimate::WeakEstimate;
use crate::thresholds::noise::SURE;
use crate::thresholds::poses::DOUBTFUL;
use crate::thresholds::warnings::{APART, AS_WELL, FAR, FEW, NOISY, RESIDUALS, SEEN, UNCERTAIN, UNEXPLAINED};
use crate::units::Others;
use crate::units::product::UnitProduct;
use crate::verdict::driven::check_driven;

fn body() -> Matrix3<f64> {
    Matrix3::new(0.2, 0.01, -0.02, 0.01, 0.35, 0.03, -0.02, 0.03, 0.45)
}

fn rates(by: &Disturbances, sigma: f64, count: u32, random: &mut Random) -> (Vec<f64>, Vec<Vector3<f64>>) {
    let times: Vec<f64> = (0..count).map(|k| 0.05 * f64::from(k)).collect();
    let gyroscope = Gyroscope::default().with_noise(sigma);
    let (body, start) = (Inertia::from_tensor(body()).unwrap(), Vector3::new(0.5, 0.8, -0.4));
    let rates = simulate_with(&body, start, &times, by, &gyroscope, random).unwrap();
    (times, rates)
}

/// Momentum falls by the drag and energy twice as fast, and both scatter as they say: by noise, and by torque noise.
#[test]
fn trends_of_momentum_and_energy_are_those_of_the_drag() {
    let mut random = Random::new(31);
    let (drag, density, sigma) = (0.01, 2e-3, 5e-3);
    for is_noisy in [false, true] {
        let density = if is_noisy { density } else { 0.0 };
        let by = Disturbances::default().with_relative_drag(drag).with_torque_noise(density);
        let (mut means, mut squares, count) = ([0.0; 2], [0.0; 2], 120);
        for _ in 0..count {
            let (times, rates) = rates(&by, sigma, 120, &mut random);
            let s = [Stretch::new(times, rates)];
            let torque = |_| Matrix3::identity() * (density * density);
            let (momentum, energy) = trends(&s, Clone::clone, &body(), sigma * sigma, torque);
            for (k, (trend, truth)) in [(momentum, -drag), (energy, -2.0 * drag)].into_iter().enumerate() {
                let z = (trend.rate - truth) / trend.sigma;
                means[k] += z / f64::from(count);
                squares[k] += z * z / f64::from(count);
            }
        }
        // to √(1/120) = 0.09, and the mean square to √(2/120) = 0.13; a little of the drag is quadratic in time
        assert!(means.iter().all(|mean| mean.abs() < 0.45), "{is_noisy}: {means:?}");
        assert!(squares.iter().all(|square| (0.6..1.5).contains(square)), "{is_noisy}: {squares:?}");
    }
    let (times, rates) = rates(&Disturbances::default(), 0.0, 2, &mut random);
    let (momentum, _) =
        trends(&[Stretch::new(times, rates)], Clone::clone, &body(), 1e-6, |_| Matrix3::zeros());
    assert!(!momentum.significant() && momentum.rate == 0.0, "two samples have no trend");
}

/// Two bodies in two segments explain a record as well as a constant torque; where that torque acts on one body, or none does, they do not.
#[test]
fn two_bodies_explain_a_record_as_well_as_a_torque() {
    let times: Vec<f64> = (0..600).map(|k| 0.05 * f64::from(k)).collect();
    let sigma = 2e-3;
    let torque = Vector3::new(12e-3, -6e-3, 18e-3);
    for (moment, torque, model) in [
        (2.62, Vector3::zeros(), TorqueModel::None),
        (2.6, torque, TorqueModel::Constant),
        (2.6, Vector3::zeros(), TorqueModel::None),
    ] {
        let mut random = Random::new(41);
        let gyroscope = Gyroscope::default().with_noise(sigma);
        let by = Disturbances::default().with_torque(torque);
        let mut toss = |largest: f64, start: Vector3<f64>| {
            let body = Inertia::from_moments([1.0, 2.0, largest]).unwrap();
            let rates = simulate_with(&body, start, &times, &by, &gyroscope, &mut random).unwrap();
            Record::from_samples(&times, &rates).unwrap()
        };
        let first = toss(2.6, Vector3::new(0.5, 0.8, -0.4));
        let record = first.join(toss(moment, Vector3::new(-0.7, 0.3, 0.6)));
        let settings = Settings::default().with_noise(sigma).with_torque(model);
        let settings = settings.with_torque_noise(TorqueNoise::None).with_check_units(false);
        let drawn = fitted(&record, &settings).unwrap().drawn.unwrap();
        let Normalised { stretches, rms, .. } = normalised(&record).unwrap();
        let variance = (sigma / rms) * (sigma / rms);
        let equations = Equations::new(&stretches, &drawn.weak, &[], &[], variance).unwrap();
        let found = instead(&equations, TorqueModel::Constant, variance);
        assert_eq!(found.is_some(), moment != 2.6, "{found:?}");
        // a drag has one coefficient, and is not asked
        assert_eq!(instead(&equations, TorqueModel::Drag, variance), None);
        let Some((Halves { share, first, second, chi2 }, gain)) = found else { continue };
        assert!((share - 0.5).abs() < 1e-12 && chi2 > 50.0 && gain > -1.0, "{share} {chi2} {gain}");
        for (found, largest) in [(first, 2.6), (second, moment)] {
            let trace = 3.0 + largest;
            for (found, truth) in found.into_iter().zip([1.0 / trace, 2.0 / trace, largest / trace]) {
                assert!((found - truth).abs() < 5e-4, "{found} {truth}");
            }
        }
    }
}

fn residuals(values: Vec<[f64; 3]>) -> Residuals {
    let times = (0..values.len()).map(|k| k as f64).collect();
    let squares: f64 = values.as_flattened().iter().map(|v| v * v).sum();
    let mean_square = squares / (3 * values.len()) as f64;
    Residuals { segment: 0, times, values, mean_square }
}

/// White residuals have no memory; what repeats has one, at the lag with which it does.
#[test]
fn residuals_remember_what_repeats() {
    let mut random = Random::new(7);
    let mut white = || -> Vec<[f64; 3]> { (0..400).map(|_| random.normal_vector().into()).collect() };
    let (one, other) = (white(), white());
    assert!(memory(&[residuals(one.clone()), residuals(other.clone())], 6).is_none());
    let correlation = Whiteness::new([one.as_flattened(), other.as_flattened()].into_iter());
    assert!(!correlation.significant() && (correlation.sigma - 1.0 / 2394.0_f64.sqrt()).abs() < 1e-12);
    // half of each residual comes again three later
    let mut repeated = one;
    for k in 3..repeated.len() {
        let [before, own] = [repeated[k - 3], repeated[k]].map(Vector3::from);
        repeated[k] = (before * 0.5 + own * 0.75_f64.sqrt()).into();
    }
    let all = [residuals(repeated)];
    assert!(memory(&all, 2).is_none() && memory(&all, 0).is_none());
    let found = memory(&all, 3).unwrap();
    // three components of a correlation of a half, 397 times
    assert!(found.dof == 27 && (found.chi2 / (3.0 * 397.0 * 0.25 + 24.0) - 1.0).abs() < 0.25, "{found:?}");
    let alternating: Vec<f64> = (0..300).map(|k| if (k / 3) % 2 == 0 { 1.0 } else { -1.0 }).collect();
    let found = Whiteness::new([alternating.as_slice()].into_iter());
    assert!(found.significant() && (found.correlation + 0.99).abs() < 1e-12, "{found:?}");
}

/// Deviations of moments, ratios and axes are those of tensors that are drawn from the covariance, to first order: by differences.
#[test]
fn deviations_of_the_answer_are_those_of_differences() {
    let x = coordinates(&body());
    let factor = Form::from_fn(|i, k| 1e-3 / (1.0 + ((3 * i + 2 * k) % 5) as f64));
    let Answer { moments, v, axes, .. } = Answer::new(&x).unwrap();
    let (sigma_principal, sigma_axes) = sigmas(&factor, &v, &moments);
    let ratios = ratios_of(&x, &(factor * factor.transpose()));
    let numbers = |x: &Coordinates| {
        let (moments, turned) = eigen(tensor(x));
        // the turn about axis k takes the next axis towards the one after it
        let along = |k: usize| {
            let (a, b) = ((k + 1) % 3, (k + 2) % 3);
            let own = turned.column(a) * turned.column(a).dot(&v[a]).signum();
            own.dot(&v[b])
        };
        [
            moments[0],
            moments[1],
            moments[2],
            moments[0] / moments[2],
            moments[1] / moments[2],
            along(0),
            along(1),
            along(2),
        ]
    };
    let h = 1e-3;
    let mut squares = [0.0; 8];
    for by in factor.column_iter() {
        let (above, below) = (numbers(&(x + by * h)), numbers(&(x - by * h)));
        for k in 0..8 {
            squares[k] += (above[k] - below[k]) * (above[k] - below[k]) / (4.0 * h * h);
        }
    }
    let found = sigma_principal.into_iter().chain(ratios.map(|ratio| ratio.1)).chain(sigma_axes);
    for (k, (found, square)) in found.zip(squares).enumerate() {
        assert!((found / square.sqrt() - 1.0).abs() < 1e-5, "{k}: {found:e} {:e}", square.sqrt());
    }
    assert!((0..2).all(|k| (ratios[k].0 - moments[k] / moments[2]).abs() < 1e-12));
    assert!((axes * Vector3::x() - v[0]).norm() < 1e-14);
}

fn clean_record() -> Record {
    let (times, rates) = rates(&Disturbances::default(), 1e-3, 1200, &mut Random::new(5));
    Record::from_samples(&times, &rates).unwrap()
}

fn clean() -> Estimate {
    static CLEAN: OnceLock<Estimate> = OnceLock::new();
    CLEAN.get_or_init(|| fit(&clean_record(), &Settings::default()).unwrap()).clone()
}

/// Each number of an answer is warned of just beyond its threshold, by its value, and not before it.
#[test]
fn an_answer_is_warned_of_beyond_its_thresholds() {
    let clean = clean();
    assert!(clean.warnings.is_empty() && of_answer(&clean).is_empty(), "{:?}", clean.warnings);
    let warned = |change: &dyn Fn(&mut Estimate)| {
        let mut e = clean.clone();
        change(&mut e);
        of_answer(&e)
    };
    assert!(warned(&|e| e.pull = FAR * 0.99).is_empty());
    assert_eq!(warned(&|e| e.pull = FAR * 1.01), [Warning::Contradiction { pull: FAR * 1.01 }]);
    // the Frobenius norm counts each product twice
    let spread = |share: f64| {
        let variances =
            [1.0, 2.0, 1.0, 0.5, 1.0, 0.5].map(|v| v / 8.0 * (share * UNCERTAIN) * (share * UNCERTAIN));
        SMatrix::<f64, 6, 6>::from_diagonal(&variances.into())
    };
    assert!(warned(&|e| e.free_covariance = spread(0.999)).is_empty());
    let found = warned(&|e| e.free_covariance = spread(1.001));
    assert!(
        matches!(found[..], [Warning::Uncertain { deviation }] if (deviation / UNCERTAIN - 1.001).abs() < 1e-9),
        "{found:?}"
    );
    for (low, high) in [(0, 1), (1, 2)] {
        let near = |share: f64| {
            warned(&|e: &mut Estimate| {
                e.sigma_principal = [1e-9; 3];
                let gap = e.principal[high] - e.principal[low];
                // the middle moment has a part in both
                let outer = if low == 0 { low } else { high };
                e.sigma_principal[outer] = 0.96 * gap / APART * share;
                e.sigma_principal[1] = 0.28 * gap / APART * share;
            })
        };
        assert!(near(0.99).is_empty());
        assert_eq!(near(1.01), [Warning::EqualMoments { low: low + 1, high: high + 1 }]);
    }
    assert!(warned(&|e| e.dof = FEW).is_empty());
    assert_eq!(warned(&|e| e.dof = FEW - 1), [Warning::FewEquations { dof: FEW - 1 }]);
}

/// What speaks against a likelihood is passed on with its numbers, each by itself.
#[test]
fn doubts_about_a_likelihood_are_warned_of_with_their_numbers() {
    let clean = clean();
    let none = Doubts { misfit: None, widened: None, constant: None, outliers: 0 };
    assert!(of_likelihood(&clean, &none).is_empty());
    let doubts = Doubts { widened: Some(1.7), constant: Some((9.0, 0.4)), ..none };
    let expected = [Warning::Profile { times: 1.7 }, Warning::ConstantTorque { gain: 9.0, turn: 0.4 }];
    assert_eq!(of_likelihood(&clean, &doubts), expected);
    // of rates alone too
    let doubts = Doubts { outliers: 4, ..none };
    assert_eq!(of_likelihood(&clean, &doubts), [Warning::Outliers { samples: 4 }]);
    let mut e = clean.clone();
    e.momentum_trend = Some(InvariantTrend { rate: 0.06, sigma: 0.01 });
    assert_eq!(
        of_likelihood(&e, &none),
        [Warning::MomentumTrend(InvariantTrend { rate: 0.06, sigma: 0.01 })]
    );
    // with a torque in the fit its trend is no contradiction
    e.torque.model = TorqueModel::Drag;
    assert!(of_likelihood(&e, &none).is_empty());
    e.torque.gain = Some(12.0);
    assert_eq!(of_likelihood(&e, &none), [Warning::Torque(e.torque.clone())]);
    e.whiteness = Whiteness { correlation: 0.3, sigma: 0.01 };
    assert!(of_likelihood(&e, &none).contains(&Warning::Correlated(e.whiteness)));
    assert!(of_smoothed(&clean, None, 0.0).is_empty());
    let density = Warning::TorqueNoise { density: 2e-4, unexplained: clean.unexplained };
    assert_eq!(of_smoothed(&clean, None, 2e-4), [density]);
    // of attitudes what was left out, and their noise without what the motion leaves beside it
    let mut e = clean;
    let attitudes = AttitudeFit {
        noise_sigma: 0.03,
        noise_is_given: false,
        residual: 0.03,
        local_noise: Some(0.01),
        is_inverse: false,
        direction_gain: None,
        largest_turn: DOUBTFUL * 0.99,
        left_out: 0,
        repeated: 0,
        alignment: None,
    };
    e.attitudes = Some(attitudes.clone());
    assert!(of_likelihood(&e, &none).is_empty());
    let turn = DOUBTFUL * 1.01;
    e.attitudes = Some(AttitudeFit { largest_turn: turn, left_out: 3, repeated: 2, ..attitudes });
    let expected = [
        Warning::RepeatedAttitudes { samples: 2 },
        Warning::Outliers { samples: 3 },
        Warning::CoarseAttitudes { turn },
        Warning::AttitudeResiduals { times: 3.0, noise: 0.01 },
    ];
    assert_eq!(of_likelihood(&e, &Doubts { misfit: Some(9.0), outliers: 3, ..none }), expected);
    assert_eq!(of_smoothed(&e, Some(9.0), 0.0), expected);
    // chance brings more in few numbers: five deviations of what neighbours tell of the noise
    let is_told = |dof: usize, misfit: f64| {
        let e = Estimate { dof, ..e.clone() };
        let list = of_likelihood(&e, &Doubts { misfit: Some(misfit), ..none });
        list.iter().any(|warning| matches!(warning, Warning::AttitudeResiduals { .. }))
    };
    assert!(!is_told(160, 2.2) && is_told(160, 2.3));
    assert!(!is_told(1_000_000, 1.19) && is_told(1_000_000, 1.21));
    // a noise that is given more than twice as large as what the motion leaves and neighbours show
    let is_named = |misfit: f64, local_noise: Option<f64>, noise_is_given: bool, method: Method| {
        let own = e.attitudes.clone();
        let own = own.map(|own| AttitudeFit { noise_is_given, local_noise, residual: 0.01, ..own });
        let e = Estimate { dof: 1_000_000, attitudes: own, method, ..e.clone() };
        let list = of_likelihood(&e, &Doubts { misfit: Some(misfit), ..none });
        list.contains(&Warning::StatedAttitudeNoise { stated: 0.03, shown: 0.01 })
    };
    for method in [Method::ExactMotion, Method::Smoother] {
        assert!(is_named(0.24, Some(0.0149), true, method) && !is_named(0.24, Some(0.0151), true, method));
        assert!(!is_named(0.25, Some(0.01), true, method) && !is_named(0.24, Some(0.01), false, method));
        // of attitudes that are far apart the motion alone tells it
        assert_eq!(is_named(0.24, None, true, method), method == Method::ExactMotion);
    }
}

fn open(singular: [f64; 5], scatter: Matrix3<f64>) -> Identifiability {
    Identifiability::new(&(singular.into(), Form::identity()), &scatter, &tensor(&coordinates(&body())))
}

/// What the information leaves open is named by the tensors that it says nothing of.
#[test]
fn combinations_that_are_open_are_named() {
    let scatter = Matrix3::from_diagonal(&Vector3::new(1.0, 0.8, 0.6));
    let all = open([1e4, 1e3, 1e3, 1e3, 1e2], scatter);
    assert!(all.complete() && all.rank == 5 && all.null_directions.is_empty() && all.null_tensors.is_empty());
    assert_eq!(all.deviations, [1e-4, 1e-3, 1e-3, 1e-3, 1e-2]);
    // the last of the basis is the product yz: the moments along the lines between these axes
    let product = open([1e4, 1e4, 1e4, 1e4, 0.0], scatter);
    assert_eq!((product.rank, product.known.len()), (4, 3));
    assert_eq!(product.null_directions, [Undetermined::Ratio { low: 1, high: 3 }]);
    let between = Vector3::new(0.0, 1.0, 1.0).normalize();
    assert!(product.known.iter().any(|known| known.axis.dot(&between).abs() > 1.0 - 1e-9));
    assert!(product.deviations[4].is_infinite() && !product.complete());
    let nothing = open([0.0; 5], scatter);
    assert_eq!(nothing.null_directions, [Undetermined::Everything]);
    let spin = Matrix3::from_diagonal(&Vector3::new(1e-8, 1.0, 1e-8));
    let pure = open([1e4, 1e4, 0.0, 0.0, 0.0], spin);
    let three = [Undetermined::TransverseRatio, Undetermined::SpinRatio, Undetermined::TransverseAxes];
    assert_eq!(pure.null_directions, three);
    assert!(pure.known.len() == 1 && pure.known[0].axis.y.abs() > 0.999 && pure.known[0].number.is_none());
}

/// A direction is open where its deviation exceeds a tenth of the trace; a record is a pure spin where the rates across the axis have less
/// than a twentieth of the mean square.
#[test]
fn what_is_open_has_a_deviation_of_a_tenth() {
    let scatter = |middle: f64| Matrix3::from_diagonal(&Vector3::new(0.0, middle, 1.0));
    for (singular, rank) in [(10.1, 5), (10.0, 5), (9.9, 4)] {
        let found = open([1e4, 1e4, 1e4, 1e4, singular], scatter(0.8));
        assert_eq!((found.rank, found.complete(), found.null_tensors.len()), (rank, rank == 5, 5 - rank));
        assert!((found.deviations[4] * singular - 1.0).abs() < 1e-12);
    }
    let two = [1e4, 1e4, 0.0, 0.0, 0.0];
    let first = |middle: f64| open(two, scatter(middle)).null_directions[0];
    let is_pure = |middle: f64| first(middle) == Undetermined::TransverseRatio;
    assert!(is_pure(0.049) && !is_pure(0.051));
    assert!(open(two, scatter(0.049)).known[0].axis.z.abs() > 1.0 - 1e-12);
    // three numbers are too many for a pure spin
    let three = open([1e4, 1e4, 1e4, 0.0, 0.0], scatter(0.049));
    assert!(!three.null_directions.contains(&Undetermined::TransverseRatio), "{:?}", three.null_directions);
}

/// Two open moments of common axes are both ratios; products of two planes are turns about two axes of the body.
#[test]
fn open_moments_are_ratios_and_open_products_are_turns() {
    let flat = Matrix3::from_diagonal(&Vector3::new(0.2, 0.35, 0.45));
    let scatter = Matrix3::from_diagonal(&Vector3::new(1.0, 0.8, 0.6));
    let of = |singular: [f64; 5]| Identifiability::new(&(singular.into(), Form::identity()), &scatter, &flat);
    let moments = of([0.0, 0.0, 1e4, 1e4, 1e4]);
    assert_eq!(moments.null_directions, [Undetermined::Ratios]);
    let numbers: Vec<_> = moments.known.iter().map(|known| known.number).collect();
    assert_eq!(numbers, [Some(1), Some(2), Some(3)]);
    // xy and yz
    let products = of([1e4, 1e4, 0.0, 1e4, 0.0]);
    assert_eq!(
        products.null_directions,
        [Undetermined::Axes { low: 1, high: 2, about: 3 }, Undetermined::Axes { low: 2, high: 3, about: 1 }]
    );
    assert!(products.known.is_empty() && products.rank == 3);
}

/// The contradiction that says most comes first, and with one a longer record is not advised; what the fit takes out is none.
#[test]
fn the_clearest_contradiction_comes_first() {
    let mut e = clean();
    e.systematic.clear();
    e.method = Method::ExactMotion;
    let mut steps = |warnings: Vec<Warning>| {
        e.warnings = warnings;
        e.next_steps()
    };
    assert_eq!(steps(Vec::new())[0], NextStep::Longer);
    let memory = || Warning::Memory(Memory { chi2: 99.0, dof: 27 });
    let scatter = || Warning::Scatter(Scatter { parts: 8, chi2: 140.0, dof: 35 });
    let refuted =
        || Warning::RefutedPrior { what: "offsets", size: 0.05, prior: 1e-3, unit: "rad/s", gain: 120.0 };
    let found = steps(vec![memory()]);
    assert!(found[0] == NextStep::FindCause(Contradiction::Residuals) && !found.contains(&NextStep::Longer));
    let found = steps(vec![memory(), scatter(), memory()]);
    assert_eq!(found[0], NextStep::FindCause(Contradiction::Parts));
    let found = steps(vec![scatter(), memory(), refuted()]);
    let left_out = Contradiction::LeftOut { what: "offsets", origin: Origin::Sensor };
    assert_eq!(found[0], NextStep::FindCause(left_out));
    for is_fitted in [true, false] {
        let first = if is_fitted { NextStep::Longer } else { NextStep::FindCause(Contradiction::Residuals) };
        assert_eq!(steps(vec![Warning::RateOffset { size: 0.02, gain: 225.0, is_fitted }])[0], first);
        assert_eq!(steps(vec![Warning::RateScale { scale: -0.05, gain: 60.0, is_fitted }])[0], first);
    }
    let found = steps(vec![Warning::CoarseAttitudes { turn: 1.5 }]);
    assert_eq!(found[..2], [NextStep::Longer, NextStep::MoreOften { turn: 1.5 }]);
}

/// The error of the sensor that changes a moment by most of its 95 % intervals is named, where that is more than half of one.
#[test]
fn the_largest_error_of_the_sensor_is_measured_by_the_intervals() {
    let mut e = clean();
    e.sigma_principal = [1e-3, 1e-2, 1e-3];
    e.method = Method::ExactMotion;
    let line = |name, principal| Systematic { name, size: 0.01, unit: "rad/s", principal, ratios: [0.0; 2] };
    e.systematic = vec![
        line("scale", [1.9e-3, 1e-2, 0.0]),
        line("offset_x", [1e-3, 2.5e-2, -3e-3]),
        line("wheel_x", [1.0, 1.0, 1.0]),
        line("magnet", [1.0, 1.0, 1.0]),
    ];
    let found = e.next_steps();
    let NextStep::Sensor { name, size, unit, times } = found[0] else { panic!("{found:?}") };
    assert_eq!((name, size, unit), ("offset_x", 0.01, "rad/s"));
    assert!((times - 3.0 / 1.959_964).abs() < 1e-5, "{times}");
    e.systematic.remove(1);
    assert_eq!(e.next_steps()[0], NextStep::Longer);
    // of equations whose errors of the sensor are not known nothing is said
    e.systematic.clear();
    assert_eq!(e.next_steps()[0], NextStep::Longer);
    for method in [Method::WeakForm, Method::ExactMotionWithWheels] {
        e.method = method;
        assert!(!e.next_steps().contains(&NextStep::Longer), "{method:?}");
    }
}

/// A combination that is known ten times less well than another asks for another start: the turn or the moment that is known least, in shares
/// of the trace.
#[test]
fn the_weakest_combination_is_the_one_of_the_largest_deviation() {
    let mut e = clean();
    // no bound is foreseen where torques or wheels act, which have no mirror
    e.mirror = None;
    e.principal = [0.2, 0.35, 0.45];
    e.sigma_axes = [f64::INFINITY, 0.0, 0.1];
    e.identifiability.deviations = [1e-4, 2e-4, 2e-4, 2e-4, 1.1e-3];
    // a turn by 0.1 about axis 3 moves the tensor by √2 · 0.15 · 0.1 = 0.0212
    for (middle, turn, number) in [(0.0210, true, 3), (0.0214, false, 2)] {
        e.sigma_principal = [0.02, middle, 0.01];
        let found = e.next_steps().pop();
        let Some(NextStep::OtherStart { times, turn: of, number: k, gain: None }) = found else {
            panic!("{found:?}")
        };
        assert!((times - 11.0).abs() < 1e-9 && (of, k) == (turn, number), "{found:?}");
    }
    e.identifiability.deviations[4] = 9e-4;
    assert!(!e.next_steps().iter().any(|step| matches!(step, NextStep::OtherStart { .. })));
}

/// Under torques at random, however weak, no start is foreseen; without them the one of an even rate is.
#[test]
fn torque_noise_leaves_no_start_to_foresee() {
    let mut e = clean();
    e.sigma_axes = [f64::INFINITY, 0.0, 0.1];
    e.identifiability.deviations = [1e-4, 2e-4, 2e-4, 2e-4, 1.1e-3];
    for (torque_noise, is_foreseen) in [(0.0, true), (1e-9, false)] {
        e.per_segment[0].torque_noise = torque_noise;
        let found = e.next_steps().pop();
        let Some(NextStep::OtherStart { turn: true, number: 3, gain, .. }) = found else {
            panic!("{found:?}")
        };
        assert_eq!(gain.is_some(), is_foreseen, "{torque_noise}");
    }
}

/// A body is driven whose momentum grows by half while drag stands at its bound, by a tenth where the law holds the tensor far off.
#[test]
fn a_body_that_grows_at_the_bound_of_drag_is_driven() {
    let mut e = clean();
    // 10 units of time at 2 rad/s are 5 s
    let stretches = [Stretch::new(vec![0.0, 10.0], vec![Vector3::x(); 2])];
    let drag = ActiveConstraint { constraint: Constraint::Drag { name: "drag" }, multiplier: 1.0 };
    let triangle = ActiveConstraint { constraint: Constraint::Triangle, multiplier: 1.0 };
    for (active, rate, sigma, pull, is_driven) in [
        (&drag, 0.11, 0.02, 0.0, true),
        (&drag, 0.09, 0.01, 0.0, false),
        (&drag, 0.11, 0.03, 0.0, false),
        (&triangle, 0.11, 0.02, 0.0, false),
        (&drag, -0.11, 0.02, 0.0, false),
        (&drag, 0.021, 0.004, 5.1, true),
        (&drag, 0.019, 0.001, 5.1, false),
        (&drag, 0.021, 0.004, 4.9, false),
    ] {
        e.active_constraints = vec![active.clone()];
        e.momentum_trend = Some(InvariantTrend { rate, sigma });
        e.pull = pull;
        let expected = FitError::Driven { unexplained: None, growth: rate, pull };
        let expected = if is_driven { Err(expected) } else { Ok(()) };
        assert_eq!(check_driven(&e, None, &stretches, 2.0), expected, "{rate} {sigma} {pull}");
    }
    e.momentum_trend = None;
    assert_eq!(check_driven(&e, None, &stretches, 2.0), Ok(()));
}

/// What changes its sign from one residual to the next has a correlation of one with each after it, in its own component: of two segments of
/// n with the mean square 1, χ² is 9 · 2 (n − lag) at each lag, and pairs across segments are none.
#[test]
fn alternating_residuals_remember_each_lag_alike() {
    let size = 3.0_f64.sqrt();
    let alternating: Vec<[f64; 3]> =
        (0..100).map(|k| [if k % 2 == 0 { size } else { -size }, 0.0, 0.0]).collect();
    let all = [residuals(alternating.clone()), residuals(alternating)];
    for (lags, pairs) in [(1, 198.0), (2, 198.0 + 196.0)] {
        let found = memory(&all, lags).unwrap();
        assert!(found.dof == 9 * lags && (found.chi2 / (9.0 * pairs) - 1.0).abs() < 1e-12, "{found:?}");
    }
}

/// Of one it is said that it was left out, of more that they were; residuals of ten thousand times the noise are told as a power of ten.
#[test]
fn warnings_count_in_words_that_agree() {
    let flat = |samples: usize| Warning::Saturated { samples }.to_string();
    assert_eq!(flat(1), "1 sample at the end of the sensor's range (saturated) was left out");
    assert_eq!(flat(2), "2 samples at the end of the sensor's range (saturated) were left out");
    let short = |short: usize| Warning::ShortSegments { short, segments: 3 }.to_string();
    assert_eq!(short(1), "1 of 3 segments was left out as too short for the fit");
    assert_eq!(short(2), "2 of 3 segments were left out as too short for the fit");
    let left = |times: f64| Warning::Residuals { times, noise: 0.01 }.to_string();
    assert!(left(9999.0).starts_with("the residuals are 9999.0 times what the noise of 1.00e-2 rad/s"));
    assert!(left(1e4).starts_with("the residuals are 1.0e4 times what the noise of 1.00e-2 rad/s"));
}

/// Nothing that speaks against the fit of a free body.
fn no_grounds<'a>(record: &'a Record, weak: &'a WeakEstimate, e: &Estimate) -> Grounds<'a> {
    let noise = e.noise_sigma / e.rms_rate;
    Grounds {
        record,
        weak,
        misfit: e.chi2_per_dof,
        variance: noise * noise,
        open: None,
        contradicted: None,
        filtered: None,
        suspect: None,
        refuted: None,
        as_well: None,
        instead: None,
        left: None,
        scatter: None,
        differing: None,
        found: true,
        noise_found: true,
        driven: false,
        size: None,
    }
}

/// What speaks against a fit is warned of with its numbers, each by itself, just beyond its threshold and not before it.
#[test]
fn grounds_are_warned_of_beyond_their_thresholds() {
    let record = clean_record();
    let Fitted { estimate: clean, drawn } = fitted(&record, &Settings::default()).unwrap();
    let weak = drawn.unwrap().weak;
    let quiet = || no_grounds(&record, &weak, &clean);
    let of = |grounds: Grounds<'_>| warnings(&clean, &grounds);
    assert!(of(quiet()).is_empty(), "{:?}", of(quiet()));

    let residuals = |dof: usize, misfit: f64| {
        let e = Estimate { dof, ..clean.clone() };
        warnings(&e, &Grounds { misfit, ..quiet() })
    };
    // 1 + 5 √(2/5000) = 1.1 is less, and 1 + 5 √(2/200) = 1.5 more
    for (dof, most) in [(5000, RESIDUALS), (200, 1.5)] {
        assert!(residuals(dof, most - 0.01).is_empty());
        let times = f64::sqrt(most + 0.01);
        assert_eq!(residuals(dof, most + 0.01), [Warning::Residuals { times, noise: clean.noise_sigma }]);
    }
    // 1 + 10 √(2/5000) = 1.2
    let left = |left: f64| of(Grounds { left: Some((left, 5000.0)), ..quiet() });
    assert!(left(1.19).is_empty());
    assert_eq!(left(1.21), [Warning::Vibration { times: 1.21_f64.sqrt(), noise: clean.noise_sigma }]);

    let scatter = Scatter { parts: 8, chi2: 140.0, dof: 35 };
    assert_eq!(of(Grounds { scatter: Some(scatter), ..quiet() }), [Warning::Scatter(scatter)]);
    let stated = Warning::StatedNoise { stated: 0.06, shown: 1e-3 };
    assert_eq!(of(Grounds { contradicted: Some((0.06, 1e-3)), ..quiet() }), [stated]);
    let products = vec![UnitProduct::numbered(0.01)];
    let others = Others { products: products.clone(), as_read: 0.2, best: 0.1 };
    let expected = Warning::Units { products, unexplained: 0.2, other: 0.1 };
    assert_eq!(of(Grounds { open: Some(&others), ..quiet() }), [expected]);

    // an error that its prior does not allow is named unless what is left out surely explains more
    let (what, origin, unit) = ("a magnet", Origin::Body, "rad/s^2");
    let suspect = Suspect { what, origin, size: 2.0, unit, gain: 53.0, reached: None };
    let left_out = Warning::LeftOut { what, size: 2.0, unit, gain: 53.0, origin };
    let refuted = |gain: f64, suspect: Option<&Suspect>| {
        let own = Refuted { what: "offsets", size: 0.05, prior: 1e-3, unit: "rad/s", gain };
        of(Grounds { suspect, refuted: Some(own), ..quiet() })
    };
    let named =
        |gain: f64| Warning::RefutedPrior { what: "offsets", size: 0.05, prior: 1e-3, unit: "rad/s", gain };
    let most = 53.0 - AS_WELL;
    assert_eq!(refuted(most + 0.1, Some(&suspect)), [named(most + 0.1), left_out.clone()]);
    assert_eq!(refuted(most - 0.1, Some(&suspect)), [left_out]);
    assert_eq!(refuted(1.0, None), [named(1.0)]);

    let mut e = clean.clone();
    e.whiteness = Whiteness { correlation: -0.3, sigma: 0.01 };
    assert_eq!(warnings(&e, &quiet()), [Warning::Correlated(e.whiteness)]);

    let weak = WeakEstimate { moved: 0.3, ..weak };
    let found = warnings(&clean, &no_grounds(&record, &weak, &clean));
    assert_eq!(found, [Warning::NotConverged { moved: 0.3 }]);
}

/// Trends count without a torque and wheels, what stands in the place of a torque beside one that was found, torque noise where free motion
/// leaves a hundredth, and a noisy segment beside two others.
#[test]
fn torques_are_warned_of_where_they_are_part_of_the_fit() {
    let record = clean_record();
    let Fitted { estimate: clean, drawn } = fitted(&record, &Settings::default()).unwrap();
    let weak = drawn.unwrap().weak;
    let quiet = || no_grounds(&record, &weak, &clean);
    let trend = InvariantTrend { rate: -0.06, sigma: 0.01 };
    let mut e = clean.clone();
    (e.momentum_trend, e.energy_trend) = (Some(trend), Some(trend));
    assert_eq!(warnings(&e, &quiet()), [Warning::MomentumTrend(trend), Warning::EnergyTrend(trend)]);
    let driven = |e: &Estimate, size| warnings(e, &Grounds { driven: true, size, ..quiet() });
    assert!(driven(&e, None).is_empty());
    assert_eq!(driven(&e, Some(2.0)), [Warning::NoScale { size: 2.0 }]);
    let sized = Estimate { inertia: Some(Inertia::from_tensor(body()).unwrap()), ..e.clone() };
    assert!(driven(&sized, Some(2.0)).is_empty());

    let parts = Halves { share: 0.25, first: [0.1, 0.4, 0.5], second: [0.2, 0.3, 0.5], chi2: 44.0 };
    let (error, size) = (ReadingError::Delays, 1e-3);
    let beside = |found: bool| Grounds {
        found,
        as_well: Some((error, size, -1.0)),
        instead: Some((parts, -2.0)),
        ..quiet()
    };
    assert!(warnings(&clean, &beside(true)).is_empty());
    e.torque.model = TorqueModel::Drag;
    let torque = Warning::Torque(e.torque.clone());
    let two = Warning::TwoTensors { parts, gain: -2.0 };
    assert_eq!(warnings(&e, &beside(true)), [torque, Warning::AsWell { error, size, gain: -1.0 }, two]);
    assert!(warnings(&e, &beside(false)).is_empty());

    let noisy = |unexplained: Option<f64>, noise_found: bool| {
        let mut e = Estimate { unexplained, ..clean.clone() };
        e.per_segment[0].torque_noise = 2e-4;
        warnings(&e, &Grounds { noise_found, ..quiet() })
    };
    for unexplained in [None, Some(1.01 * UNEXPLAINED)] {
        assert_eq!(noisy(unexplained, true), [Warning::TorqueNoise { density: 2e-4, unexplained }]);
        assert!(noisy(unexplained, false).is_empty());
    }
    assert!(noisy(Some(0.99 * UNEXPLAINED), true).is_empty());

    let segments = |levels: &[f64]| {
        let mut e = clean.clone();
        let own = |mean_square| Residuals { segment: 0, times: Vec::new(), values: Vec::new(), mean_square };
        e.residuals.extend(levels.iter().copied().map(own));
        e.residuals[0].mean_square = 1.0;
        warnings(&e, &quiet())
    };
    let times = f64::sqrt(1.01 * NOISY);
    let noisy = Warning::NoisySegment { segment: 0, start: 0.0, times };
    assert_eq!(segments(&[1.01 * NOISY, 1.0]), [noisy]);
    assert!(segments(&[0.99 * NOISY, 1.0]).is_empty() && segments(&[9.0 * NOISY]).is_empty());

    // residuals that change their sign from one to the next remember as many as lie within one turn
    let mut e = clean.clone();
    let values = &mut e.residuals[0].values;
    values.iter_mut().enumerate().for_each(|(k, v)| *v = [if k % 2 == 0 { 1.0 } else { -1.0 }, 0.0, 0.0]);
    let (count, centres) = (e.residuals[0].times.len(), &e.residuals[0].times);
    let turn = (centres[count - 1] - centres[0]) / (count - 1) as f64 * clean.rms_rate;
    let lags = ((core::f64::consts::TAU / turn) as usize).min(count / 4);
    let found = warnings(&e, &quiet());
    let [Warning::Memory(Memory { dof, .. })] = found[..] else { panic!("{found:?}") };
    assert!(dof == 9 * lags && lags > 2, "{dof} {lags}");
}

/// Momenta and torques that are told are zero where all of them are; a record without any has none that are.
#[test]
fn inputs_that_are_zero_are_told_from_none() {
    let of = |wheel: Option<f64>, torque: Option<f64>| {
        let mut segment = Segment::new("toss", vec![0.0, 1.0], vec![Vector3::x(); 2]).unwrap();
        let list = |size: f64| vec![Vector3::zeros(), Vector3::z() * size];
        if let Some(size) = wheel {
            segment = segment.with_wheel(list(size)).unwrap();
        }
        if let Some(size) = torque {
            segment = segment.with_torque(list(size)).unwrap();
        }
        let mut record = Record::default();
        record.segments.push(segment);
        has_zero_inputs(&record)
    };
    assert!(!of(None, None) && of(Some(0.0), None) && of(None, Some(0.0)) && of(Some(0.0), Some(0.0)));
    assert!(!of(Some(1.0), None) && !of(Some(0.0), Some(-1.0)) && !of(Some(1.0), Some(0.0)));
}

/// What was left out of a record is counted, each kind by itself, and segments that were not used.
#[test]
fn what_was_left_out_of_a_record_is_counted() {
    let of = |time: fn(u32) -> f64, reading: fn(u32) -> u32| {
        let times: Vec<f64> = (0..400).map(time).collect();
        let rates = (0..400).map(|i| Vector3::new(f64::from(reading(i) * reading(i)), 1.0, 0.0));
        Record::from_samples(&times, &rates.collect::<Vec<_>>()).unwrap()
    };
    let plain = of(|i| f64::from(i) / 100.0, |i| i);
    assert!(of_record(&plain, &[], 1).is_empty());
    assert_eq!(of_record(&plain, &[], 0), [Warning::ShortSegments { short: 1, segments: 1 }]);
    let merged = of(|i| f64::from(i / 2) / 100.0, |i| i);
    assert_eq!(of_record(&merged, &[], 1), [Warning::Merged { samples: 200 }]);
    let repeated = of(|i| f64::from(i) / 400.0, |i| i / 4);
    let found = of_record(&repeated, &[], 1);
    let [Warning::Repeated { samples: 300, rate }] = found[..] else { panic!("{found:?}") };
    assert!((rate - 100.0).abs() < 1e-9, "{rate}");
    let stale = of(|i| f64::from(i) / 100.0, |i| if (200..209).contains(&i) { 200 } else { i });
    // the record is parted there
    assert_eq!(of_record(&stale, &[], 2), [Warning::Stale { samples: 8 }]);
    assert_eq!((short_segments(2, 2), short_segments(3, 2)), (None, None));
    assert_eq!(short_segments(1, 3), Some(Warning::ShortSegments { short: 2, segments: 3 }));
}

/// Ascending eigenvalues of the information become descending singular values; one below 1e-12 of the largest is rounding, and leaves its
/// number open.
#[test]
fn information_that_is_rounding_leaves_a_number_open() {
    let s = [Stretch::new(vec![0.0, 1.0], vec![Vector3::new(0.3, -0.8, 0.5); 2])];
    let of = |least: f64| {
        let information = Form::from_diagonal(&Coordinates::new(1e8, least, 1e6, 4e6, 1e4));
        identify(&s, &coordinates(&body()), &information)
    };
    let known = of(1.1e-4);
    let expected = [1e-4, 5e-4, 1e-3, 1e-2, 1.0 / 1.1e-4_f64.sqrt()];
    for (found, expected) in known.deviations.into_iter().zip(expected) {
        assert!((found / expected - 1.0).abs() < 1e-3, "{found:e} {expected:e}");
    }
    let open = of(0.9e-4);
    assert!(open.deviations[4].is_infinite() && (open.rank, known.rank) == (4, 4), "{:?}", open.deviations);
    assert!((open.null_tensors[0].dot(&basis(1)).abs() - 1.0).abs() < 1e-6, "{:?}", open.null_tensors);
}

/// Parts of a record are cut at whole equations, three for a test function, one part after the other without a gap.
#[test]
fn parts_of_a_record_are_all_of_its_equations() {
    let (times, read) = rates(&Disturbances::default(), 1e-3, 500, &mut Random::new(5));
    let head = |count: usize| Record::from_samples(&times[..count], &read[..count]).unwrap();
    let settings = Settings::default().with_torque(TorqueModel::None).with_radius(1.0);
    let settings = settings.with_torque_noise(TorqueNoise::None).with_check_units(false);
    let weak = fitted(&head(500).join(head(300)), &settings).unwrap().drawn.unwrap().weak;
    assert_eq!((weak.parts.len(), weak.columns.len()), (2, 0));
    let all: Vec<f64> = weak.parts.iter().flat_map(|part| part.rows.iter().copied()).collect();
    // six numbers in a row
    let (width, mut joined) = (3 * 6, Vec::new());
    let before = |k: usize| k * (all.len() / width) / 8;
    for k in 0..8 {
        let own = rows_between(&weak, [k, k + 1].map(|k| k as f64 / 8.0)).concat();
        assert_eq!(own.len(), width * (before(k + 1) - before(k)), "{k}");
        joined.extend(own);
    }
    assert!(joined == all);
    assert!(rows_between(&weak, [0.5, 0.5]).concat().is_empty());
}

/// Halves that tell the same differ by four times the covariance of the whole: a change may go unseen up to twice as many of its deviations.
#[test]
fn a_change_midway_may_go_unseen_up_to_twice_its_deviations() {
    let (times, read) = rates(&Disturbances::default(), 1e-3, 500, &mut Random::new(5));
    let one = || Record::from_samples(&times, &read).unwrap();
    let settings = Settings::default().with_torque(TorqueModel::None).with_radius(1.0);
    let settings = settings.with_torque_noise(TorqueNoise::None).with_check_units(false);
    let e = fit(&one().join(one()), &settings).unwrap();
    for (unseen, sigma) in e.unseen_change.unwrap().into_iter().zip(e.sigma_principal) {
        assert!((unseen / (2.0 * SEEN * sigma) - 1.0).abs() < 1e-6, "{unseen:e} {sigma:e}");
    }
}

/// The energy of a segment is known as the slope of a straight line through its turns, with the variance 12 σ²/T² of a rate: two energies that are
/// a hundredth apart contradict each other where half the square of that is more than chance brings. Under torques at random they may differ.
#[test]
fn energies_of_attitudes_differ_beyond_their_slopes() {
    let (j, rate, more, count, lasts) = (body(), Vector3::new(0.3, -0.8, 0.5), 1.01_f64, 21, 5.0);
    let of = |segment: usize, rate: Vector3<f64>| {
        let times = (0..count).map(|k| lasts * k as f64 / (count - 1) as f64).collect();
        Stretch { segment, ..Stretch::new(times, vec![rate; count]) }
    };
    let faster = rate * more.sqrt();
    let rates = [of(0, rate), of(1, faster)];
    let settings = Settings::default().with_known(Known::TwiceEnergy(3.0));
    let found = |attitude: f64| {
        let (covariance, x) = (Form::zeros(), coordinates(&j));
        let scale = |known: Known, path: &[Stretch], of: Of| size(known, path, of, 2.0, &j, (attitude, 0.0));
        absolute(&settings, &rates, TorqueModel::None, &j, &covariance, &x, scale)
    };
    // of ω·J ω the variance is 4 s |J ω|² over the number of samples, where that of a rate is s
    let apart = (more - 1.0) * rate.dot(&(j * rate));
    let each = 4.0 * ((j * rate).norm_squared() + (j * faster).norm_squared()) / count as f64;
    let most = 0.5 * apart * apart / (each * quantile(1.0, SURE));
    let attitude = |variance: f64| lasts * (variance / 12.0).sqrt();
    match found(attitude(0.98 * most)) {
        Err(FitError::SizeDiffers { factor, largest: 1, smallest: 0, .. }) => {
            assert!((factor - more).abs() < 1e-12, "{factor}");
        }
        other => panic!("{other:?}"),
    }
    let (inertia, covariance) = found(attitude(1.02 * most)).unwrap();
    // the trace is what is known over the mean of both in units of 2 rad/s
    let trace = 3.0 / 4.0 / (rate.dot(&(j * rate)) * 0.5 * (1.0 + more));
    assert!((inertia.unwrap().tensor() - j * trace).amax() < 1e-12 * trace && covariance.is_some());
}

/// A correlation is the covariance over both deviations, and one with what has none is zero.
#[test]
fn correlations_are_covariances_over_deviations() {
    let sizes = [3.0, 0.5, 0.0, 2.0, 1.0, 4.0];
    let shared = |i: usize, k: usize| if i == k { 1.0 } else { 1.0 / (i + k + 2) as f64 };
    let mut e = clean();
    e.covariance = SMatrix::from_fn(|i, k| shared(i, k) * sizes[i] * sizes[k]);
    let found = e.correlation();
    for i in 0..6 {
        for k in 0..6 {
            let expected = if sizes[i] * sizes[k] > 0.0 { shared(i, k) } else { 0.0 };
            assert!(f64::abs(found[(i, k)] - expected) < 1e-14, "{i} {k}");
        }
    }
}

/// Of rates beside attitudes what was taken out of them is told, in rad/s or as a share, and what the motion leaves of them where it is more than
/// chance brings over the noise that is given, or told by neighbours: of 40 numbers 1 + 5 √(10/40) of the square. A noise that is given
/// and more than twice the root of that times as large is named.
#[test]
fn rates_beside_attitudes_are_warned_of_by_what_is_left() {
    let free = |times: f64, misread: Option<Misread>, is_aligned: bool| {
        let (x, alignment) = (coordinates(&body()), Quat::identity());
        let model = Model { x, alignment, is_aligned, drag: None, starts: Vec::new() };
        let levels = Levels { attitude: 0.1, rate: 0.5 * times };
        let read = Read { rate_noise: Some(1.0), has_rates: true, ..Read::nothing() };
        Free { misread, ..Free::of(Followed::at(model, levels, [100.0, 40.0]), read) }
    };
    let most = f64::sqrt(3.5);
    assert!(of_rates(&free(0.999 * most, None, true), None).is_empty());
    let left = |times: f64, noise: f64, given: Option<f64>| {
        let found = of_rates(&free(times, None, true), given);
        let [Warning::RateResiduals { times: found, noise: of }] = found[..] else { panic!("{found:?}") };
        assert!((found * noise / times - 1.0).abs() < 1e-12 && of == noise, "{found} {of}");
    };
    left(1.001 * most, 1.0, None);
    left(1.001 * most, 0.5, Some(0.5));
    assert!(of_rates(&free(1.001 * most, None, true), Some(2.0)).is_empty());
    // 2 √3.5 is 3.7417
    assert!(of_rates(&free(1.0, None, true), Some(3.741)).is_empty());
    let (stated, shown) = (3.742, 1.0);
    assert_eq!(of_rates(&free(shown, None, true), Some(stated)), [Warning::StatedNoise { stated, shown }]);
    // that of neighbours nobody has stated
    assert!(of_rates(&free(0.01, None, true), None).is_empty());
    // without both there is no alignment
    assert!(of_rates(&free(9.0, None, false), None).is_empty());
    assert!(of_rates(&free(0.01, None, false), Some(9.0)).is_empty());
    let misread = |error| {
        let offset = Vector3::new(0.375, 0.0, -0.5);
        Some(Misread { error, offset, scale: -0.05, gain: 60.0, spread: Form::zeros() })
    };
    let of = |error| of_rates(&free(1.0, misread(error), true), None);
    let is_fitted = true;
    assert_eq!(of(RateError::Offset), [Warning::RateOffset { size: 1.25, gain: 60.0, is_fitted }]);
    assert_eq!(of(RateError::Scale), [Warning::RateScale { scale: -0.05, gain: 60.0, is_fitted }]);
}

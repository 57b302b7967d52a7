//! The estimator: from a record to a physical tensor.

use nalgebra::{Matrix3, Vector3};
use polhode::record::{Record, Spike};

use crate::columns::dissipation::dissipation;
use crate::columns::model::{Column, Kind, STEPS, is_drag, is_torque, named, sensor_columns, walk_columns};
use crate::error::FitError;
use crate::physical::constraint::ActiveConstraint;
use crate::physical::coordinates::{Coordinates, ENTRIES, Form, tensor};
use crate::physical::failure::SolverFailure;
use crate::physical::nearest::{Normal, nearest};
use crate::physical::prior::{Prior, Told};
use crate::report::averages;
use crate::report::estimate::Estimate;
use crate::report::facts::Facts;
use crate::report::identifiability::Identifiability;
use crate::report::nuisance::Agreement;
use crate::report::torque_free::trends;
use crate::settings::Settings;
use crate::settings::torque::{TorqueModel, TorqueNoise, TorqueScope};
use crate::signal::noise;
use crate::signal::normalised::{Normalised, normalised};
use crate::signal::stretch::Stretch;
use crate::signal::test_functions::SAMPLES_PER_TEST;
use crate::solve::completed::completed;
use crate::solve::joint::Joint;
use crate::solve::ladder::{Demand, Halt, climb};
use crate::solve::other_units::{Better, better_unit, suspicious};
use crate::solve::radius::Failure;
use crate::solve::rounds::{Noise, ROUNDS};
use crate::solve::weak_estimate::WeakEstimate;

/// Fits one tensor to all segments of a record.
///
/// The estimator solves the weak form of Euler's equation by least squares, weighted with the covariance of its noise.
/// Each round corrects the samples by the noise that the round before estimated, and linearises again. A quadratic
/// program then finds the nearest physically valid tensor within the limits, in the metric of the information.
/// Neither the units of rate and time nor a rotation of the sensor change the result beyond rounding.
///
/// ```
/// use nalgebra::Vector3;
/// use polhode_fit::{FitError, Record, Settings, fit, simulate};
/// use polhode::inertia::Inertia;
/// use polhode::num::Random;
///
/// let body = Inertia::from_moments([1.0, 2.0, 2.6])?;
/// let times: Vec<f64> = (0..1000).map(|i| f64::from(i) / 100.0).collect();
/// let mut random = Random::new(7);
/// let tumbling = simulate(&body, Vector3::new(0.3, 1.0, 0.4), &times, 1e-3, &mut random)?;
/// let estimate = fit(&Record::from_samples(&times, &tumbling)?, &Settings::default())?;
/// assert!((estimate.ratios[0] - 1.0 / 2.6).abs() < 5.0 * estimate.sigma_ratios[0]);
///
/// let spinning = simulate(&body, Vector3::new(0.0, 0.0, 1.0), &times, 1e-3, &mut random)?;
/// let refused = fit(&Record::from_samples(&times, &spinning)?, &Settings::default());
/// assert!(matches!(refused, Err(FitError::Unidentifiable(what)) if what.rank == 2)); // an axis, and no ratio
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Errors
/// Too few samples; no rotation; a record that does not determine the tensor, with what it does determine; units that
/// look mistaken; limits that contradict each other or the physical law; a program without a certified answer.
pub fn fit(record: &Record, settings: &Settings) -> Result<Estimate, FitError> {
    settings.check()?;
    match if settings.leave_out_spikes { record.without_spikes() } else { None } {
        Some((spikes, rest)) => fit_to(&rest, settings, spikes),
        None => fit_to(record, settings, Vec::new()),
    }
}

/// The same of a record whose spikes were left out.
fn fit_to(record: &Record, settings: &Settings, spikes: Vec<Spike>) -> Result<Estimate, FitError> {
    let Normalised { stretches, rms, input } = normalised(record)?;
    if input.is_some() && settings.known.is_some() {
        return Err(FitError::TwoScales);
    }
    let variance = read_variance(settings, record, &stretches, rms)?;
    let singular = || FitError::Solver(SolverFailure::Covariance);
    let mut columns = sensor_columns(&settings.sensor, rms);
    columns.extend(input.map(|_| Column::new(Kind::Input, None)));
    if let Some(walk) = settings.offset_walk {
        // per √(unit of time), which is one over the unit of rate
        columns.extend(walk_columns(&stretches, walk / rms / rms.sqrt(), STEPS));
    }
    let long = |s: &&Stretch| s.times.len() >= 2 * SAMPLES_PER_TEST as usize;
    let alone: Vec<usize> = match settings.torque_scope {
        TorqueScope::Segment => stretches.iter().filter(long).map(|s| s.index).collect(),
        TorqueScope::Record => Vec::new(),
    };
    let demand = Demand {
        radius: settings.radius.map(|r| r * rms),
        torque: settings.torque,
        noise: noise_of(settings, rms, variance),
        columns: &columns,
        alone: &alone,
        units: settings.check_units && input.is_none(),
    };
    let mut chosen = climb(&stretches, demand, variance).map_err(|halt| match halt {
        Halt::Failure(Failure::Dense) => {
            settings.radius.map_or_else(singular, |radius| FitError::Dense { radius })
        }
        Halt::Failure(Failure::TooShort) => too_short(record, settings, &stretches, rms),
        Halt::Failure(Failure::Singular) => singular(),
        Halt::Units(misfit, better) => mistaken(misfit, &better),
    })?;
    let weak = &chosen.weak;
    let misfit = weak.misfit(variance);
    // torque noise may hide a mistaken unit, which must then explain the record without any
    let noisy = weak.levels().iter().any(|levels| levels.torque > 0.0);
    let doubtful = misfit > 4.0 || noisy || !weak.settled();
    let better = chosen.better.clone().filter(|_| doubtful).or_else(|| {
        let asks = demand.units && suspicious(weak, variance);
        asks.then(|| better_unit(&stretches, Some(weak), variance)).flatten()
    });
    // a unit of any size must not convince: there is a tensor next to the sphere for any small wobble in large enough a unit
    if let Some(better) = better.as_ref().filter(|b| b.credible && !b.vague) {
        return Err(mistaken(misfit, better));
    }
    // torque noise that explains what a unit would explain without any explains nothing
    let hidden = noisy && better.as_ref().is_some_and(|b| b.vague && b.far);
    let prior = settings.prior.as_ref().map(|prior| consistent(prior, settings)).transpose()?;
    // what the noise does not explain enlarges the deviations
    let mut identifiability = identify(weak, &stretches, variance * misfit.max(1.0)).ok_or_else(singular)?;
    let open = !weak.settled() || !identifiability.complete();
    let filled = prior.as_ref().filter(|_| open && input.is_none()).and_then(|prior| {
        let filled = completed(&stretches, weak, &prior.shape_root(), prior.x, variance)?;
        identifiability =
            Identifiability::new(&filled.alone, &scatter_of(&stretches), &tensor(&filled.weak.x()));
        Some(filled)
    });
    let agreed = filled.as_ref().map(|filled| Agreement { chi2: filled.chi2, dof: 5 });
    let is_filled = filled.is_some();
    if let Some(filled) = filled {
        chosen.weak = filled.weak;
    } else if hidden || (!weak.settled() && misfit > weak.expected_misfit()) {
        return Err(unsettled(settings, &stretches, misfit, variance, rms, better.map(|b| b.factor)));
    } else {
        told_by(weak, settings, &stretches, variance * misfit.max(1.0), &identifiability)?;
    }
    let weak = &chosen.weak;
    let misfit = weak.misfit(variance);
    let information = || FitError::Solver(SolverFailure::Information);
    let kept = |column: &Column| is_drag(column) || column.kind == Kind::Input;
    let joint = Joint::new(weak, kept, (variance * misfit.max(1.0)).sqrt()).ok_or_else(information)?;
    let dissipation = dissipation(&weak.columns, &joint.kept);
    let (told, agreed) = match &prior {
        Some(prior) if !is_filled => with_prior(&joint, weak, prior, input)?,
        _ => (joint.told.clone(), agreed),
    };
    if let Some((prior, agreed)) = prior.as_ref().zip(agreed) {
        check_agreement(prior, agreed, weak)?;
    }
    let answer = nearest(&told, &settings.limits, &dissipation)?;
    let facts = Facts {
        record,
        settings,
        stretches: &stretches,
        rms,
        variance,
        chosen: &chosen,
        misfit,
        spikes,
        input,
        joint: &joint,
        told: &told,
        prior: agreed,
        dissipation: &dissipation,
    };
    facts.report(answer, identifiability, better.as_ref().filter(|b| b.credible))
}

/// Variance of the noise of a component of the rates, in units of the mean square rate.
pub(super) fn read_variance(
    settings: &Settings,
    record: &Record,
    stretches: &[Stretch],
    rms: f64,
) -> Result<f64, FitError> {
    let rounding = |quanta: Vector3<f64>| record.rounding(&quanta) / rms / rms;
    let given = settings.quantum.map_or(0.0, |quantum| rounding(Vector3::repeat(quantum)));
    let variance = match settings.noise {
        Some(sigma) => Some((sigma / rms) * (sigma / rms))
            .filter(|v| v.is_normal())
            .ok_or(FitError::Setting { name: "the noise", value: sigma })?,
        // slow motions rest on a step: their differences tell too little of its rounding
        None => noise::variance(stretches).max(rounding(record.quanta())),
    };
    let variance = match settings.noise {
        Some(_) => variance + given,
        None => variance.max(given),
    };
    // readings of a noiseless record carry at least the quadrature's error
    let variance = variance.max(1e-20);
    // the mean square is 1, of which the noise of three components is 3 σ²: a quarter is too much to fit
    if 3.0 * variance > 0.25 {
        return Err(FitError::NoRotation { rms, noise: variance.sqrt() * rms });
    }
    Ok(variance)
}

/// The torque noise that is asked for, in units of the rate and of the noise of its readings.
pub(super) fn noise_of(settings: &Settings, rms: f64, variance: f64) -> Noise {
    match settings.torque_noise {
        TorqueNoise::None => Noise::White,
        TorqueNoise::Given(density) => Noise::Given(density / (rms * rms * rms) / variance),
        TorqueNoise::Fitted => Noise::Fitted,
    }
}

/// Chance of a distance between prior and record by which they exclude each other: χ² of 5 and of 6 degrees of freedom.
const EXCLUDED: [f64; 2] = [35.888_186_879_672_87, 38.258_336_377_209_69]; // one in a million

/// Standard deviations of a prior by which it may lie outside limits and law.
const OUTSIDE: f64 = 6.0;

/// A prior that limits and law allow.
fn consistent(prior: &Prior, settings: &Settings) -> Result<Told, FitError> {
    let prior = prior.told()?;
    let alone = nearest(&prior.shape(), &settings.limits, &[])?;
    let pulls = |c: &&ActiveConstraint| c.multiplier;
    if let Some(active) = alone.active.iter().max_by(|a, b| pulls(a).total_cmp(&pulls(b)))
        && alone.pull > OUTSIDE
    {
        return Err(FitError::PriorOutside { constraint: active.constraint, pull: alone.pull });
    }
    Ok(prior)
}

/// What the record tells, joined with the prior, and how they agree.
fn with_prior(
    joint: &Joint,
    weak: &WeakEstimate,
    prior: &Told,
    input: Option<f64>,
) -> Result<(Normal, Option<Agreement>), FitError> {
    let place = joint.kept.iter().position(|&k| weak.columns[k].kind == Kind::Input);
    let joined = prior.join(&joint.told, place.zip(input));
    let (told, chi2, dof) = joined.ok_or(FitError::Solver(SolverFailure::Information))?;
    Ok((told, Some(Agreement { chi2, dof })))
}

/// Refuses a prior and a record that exclude each other.
fn check_agreement(
    prior: &Told,
    Agreement { chi2, dof }: Agreement,
    weak: &WeakEstimate,
) -> Result<(), FitError> {
    if chi2 <= EXCLUDED[dof.clamp(5, 6) - 5] {
        return Ok(());
    }
    let six = |x: &Coordinates| ENTRIES.map(|entry| tensor(x)[entry]);
    Err(FitError::PriorContradicted { prior: six(&prior.x), record: six(&weak.x()), chi2, dof })
}

/// The rates are not constant, and still no tensor explains them.
fn unsettled(
    settings: &Settings,
    stretches: &[Stretch],
    misfit: f64,
    variance: f64,
    rms: f64,
    factor: Option<f64>,
) -> FitError {
    let axes = averages::axes(stretches, variance);
    let (fall, _) = trends(stretches, &(Matrix3::identity() / 3.0), variance * misfit.max(1.0));
    let fall = (settings.torque == TorqueModel::None && fall.rate < 0.0 && fall.significant())
        .then_some(-fall.rate * rms);
    FitError::Unsettled { rounds: ROUNDS, noise: variance.sqrt() * rms, factor, axes, fall }
}

/// Refuses a record that leaves the tensor open, or the torques that were asked for.
fn told_by(
    weak: &WeakEstimate,
    settings: &Settings,
    stretches: &[Stretch],
    variance: f64,
    identifiability: &Identifiability,
) -> Result<(), FitError> {
    let names = untold(weak, stretches, variance, identifiability);
    // of a torque that was not asked for the message could ask for nothing simpler
    if settings.torque != TorqueModel::Auto && !names.is_empty() {
        return Err(FitError::Untold { names, rank: identifiability.rank });
    }
    match identifiability.complete() {
        true => Ok(()),
        false => Err(FitError::Unidentifiable(Box::new(identifiability.clone()))),
    }
}

fn mistaken(misfit: f64, b: &Better) -> FitError {
    FitError::Units {
        factor: b.factor,
        mistakes: b.mistakes.clone(),
        misfit,
        better: b.misfit,
        sphere: b.sphere,
    }
}

fn too_short(record: &Record, settings: &Settings, stretches: &[Stretch], rms: f64) -> FitError {
    let needed = SAMPLES_PER_TEST as usize;
    match settings.radius {
        Some(radius) => {
            let longest = stretches.iter().map(Stretch::duration).fold(0.0, f64::max) / rms;
            FitError::Radius { radius, longest, needed }
        }
        None => FitError::TooFewSamples {
            samples: record.samples(),
            segments: record.segments.len(),
            longest: stretches.iter().map(|s| s.times.len()).max().unwrap_or(0),
            saturated: record.saturated(),
            needed: 2 * needed,
        },
    }
}

/// Standard deviation of a coefficient of torque, in units of the rate, beyond which the record says nothing of it.
const UNTOLD: f64 = 1.0;

/// Coefficients of torque that the record cannot tell: from the tensor, which it would determine without them, or at all.
fn untold(
    weak: &WeakEstimate,
    stretches: &[Stretch],
    variance: f64,
    identifiability: &Identifiability,
) -> Vec<&'static str> {
    let Some(stacked) = &weak.stacked else { return Vec::new() };
    let torques: Vec<usize> = (0..weak.columns.len()).filter(|&k| is_torque(&weak.columns[k])).collect();
    if torques.is_empty() {
        return Vec::new();
    }
    let mut names = Vec::new();
    let mut name = |k: usize| {
        let name = named(weak.columns[k].kind).0;
        if !names.contains(&name) {
            names.push(name);
        }
    };
    if identifiability.complete() {
        let Some(factor) = stacked.joint_factor() else { return Vec::new() };
        let fitted = |k: usize| {
            weak.columns[k].segment.is_none_or(|s| weak.parts.iter().any(|part| part.stretch == s))
        };
        let vague = |k: usize| factor.row(k).norm() * variance.sqrt() > UNTOLD;
        torques.iter().copied().filter(|&k| fitted(k) && vague(k)).for_each(&mut name);
        return names;
    }
    let without = weak.without(&torques, variance.sqrt());
    let known = without.and_then(|root| identify_by(&root, weak, stretches, variance));
    if known.is_some_and(|known| known.complete()) {
        torques.into_iter().for_each(&mut name);
    }
    names
}

fn identify_by(
    root: &Form,
    weak: &WeakEstimate,
    stretches: &[Stretch],
    variance: f64,
) -> Option<Identifiability> {
    let svd = (root / variance.sqrt()).svd(false, true);
    let directions = svd.v_t?.transpose();
    Some(Identifiability::new(&(svd.singular_values, directions), &scatter_of(stretches), &tensor(&weak.x())))
}

fn scatter_of(stretches: &[Stretch]) -> Matrix3<f64> {
    let (mut scatter, mut count) = (Matrix3::zeros(), 0.0);
    for w in stretches.iter().flat_map(|s| &s.rates) {
        scatter += w * w.transpose();
        count += 1.0;
    }
    scatter / count
}

fn identify(weak: &WeakEstimate, stretches: &[Stretch], variance: f64) -> Option<Identifiability> {
    let (singular, directions) = weak.spectrum()?;
    let spectrum = (singular / variance.sqrt(), directions);
    Some(Identifiability::new(&spectrum, &scatter_of(stretches), &tensor(&weak.x())))
}

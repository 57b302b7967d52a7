//! The estimator: from a record to a physical tensor.

use crate::solve::completed::Completed;
use crate::thresholds::noise::{LEAST, MOST};
use crate::verdict::judgement::{Case, Supported, Verdict};
use crate::verdict::prior::{check_agreement, with_prior};
use nalgebra::{DMatrix, DVector, Vector3};
use polhode::record::{Record, Spike};

use crate::columns::column::Column;
use crate::columns::dissipation::dissipation;
use crate::columns::effect::Class;
use crate::columns::input::Input;
use crate::columns::sets::sensor_columns;
use crate::error::FitError;
use crate::likelihood::bend::beyond;
use crate::likelihood::wheels::likeliest as with_wheels;
use crate::models::equations::Equations;
use crate::models::weighed::spread;
use crate::physical::coordinates::{Form, tensor};
use crate::physical::failure::SolverFailure;
use crate::physical::nearest::nearest;
use crate::report::differing::{Differing, differing};
use crate::report::estimate::{Estimate, Method};
use crate::report::facts::Facts;
use crate::report::mirror::reversed;
use crate::report::nuisance::Agreement;
use crate::report::parts::scatter;
use crate::report::segments::{Summary, summaries};
use crate::report::suspect::{ROTOR, Suspect, suspect};
use crate::report::systematic::errors;
use crate::report::warnings::{has_zero_inputs, of_record};
use crate::settings::Settings;
use crate::settings::sensor::SensorPriors;
use crate::settings::torque::{TorqueModel, TorqueNoise};
use crate::signal::noise;
use crate::signal::normalised::{Normalised, normalised};
use crate::signal::stretch::Stretch;
use crate::solve::joint::{Joint, factor};
use crate::solve::ladder::{Demand, climb};
use crate::solve::radius::Failure;
use crate::solve::rounds::Noise;
use crate::solve::weak_estimate::WeakEstimate;
use crate::sparse::{is_sparse, likeliest};
use crate::thresholds::test_functions::SAMPLES_PER_TEST;
use crate::thresholds::warnings::UNCERTAIN;
use crate::units::Motion;
use crate::verdict::axes::check_axes;
use crate::verdict::driven::{check_driven, check_inputs, check_order};
use crate::verdict::told::check_told;
use crate::verdict::units::open_units;

/// Fits one tensor to all segments of a record.
///
/// The estimator solves the weak form of Euler's equation by least squares, weighted with the covariance of its noise.
/// Each round corrects the samples by the noise that the round before estimated, and linearises again. A quadratic
/// program then finds the nearest physically valid tensor within the limits, in the metric of the information.
///
/// Maximum likelihood on the exact motion takes its place in two cases, if the motion explains the rates:
/// - the rates are so sparse that the body turns by a tenth of a turn from one to the next;
/// - only wheels of constant momentum act, and no [`radius`](Settings::radius) is given.
///
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
/// # Ok::<(), polhode::Error>(())
/// ```
///
/// # Errors
/// Too few samples; no rotation; a record that does not determine the tensor, with what it does determine; units that
/// look mistaken; an axis that reads nothing; limits that contradict each other or the physical law; a program without a certified answer.
pub fn fit(record: &Record, settings: &Settings) -> Result<Estimate, FitError> {
    Ok(fitted(record, settings)?.estimate)
}

/// An estimate, and what it was drawn from.
pub(crate) struct Fitted {
    pub(crate) estimate: Estimate,
    /// `None` of a likelihood on the exact motion.
    pub(crate) drawn: Option<Drawn>,
}

/// The equations behind an estimate.
pub(crate) struct Drawn {
    pub(crate) weak: WeakEstimate,
    /// Standard deviation of the noise with what it does not explain.
    pub(crate) deviation: f64,
    /// M of the M Mᵀ that is added to the covariance by the noise, of all columns and the tensor.
    pub(crate) beside: DMatrix<f64>,
    /// Unit of the rates, rad/s.
    pub(crate) rms: f64,
    /// Unit of the column of wheel momenta and torques, kg m².
    pub(crate) input: Option<f64>,
}

/// The estimate of a record with the equations behind it.
pub(crate) fn fitted(record: &Record, settings: &Settings) -> Result<Fitted, FitError> {
    settings.check()?;
    let fitted = |record: &Record, settings: &Settings| match if settings.leave_out_spikes {
        record.without_spikes()
    } else {
        None
    } {
        Some((spikes, rest)) => fit_to(&rest, settings, spikes),
        None => fit_to(record, settings, Vec::new()),
    };
    let found = fitted(record, settings);
    // another body may explain what an axis does not read
    if matches!(found, Ok(_) | Err(FitError::Unsettled { .. } | FitError::Driven { .. })) {
        check_axes(record)?;
    }
    found.map_err(|mut error| {
        let exact = SensorPriors::default();
        let is_untold = matches!(
            error,
            FitError::Unsettled { .. } | FitError::Unidentifiable(_) | FitError::NoRotation { .. }
        );
        if is_untold
            && settings.sensor != exact
            && fitted(record, &settings.clone().with_sensor(exact)).is_ok()
        {
            return FitError::UntoldSensor;
        }
        let is_unsettled = matches!(error, FitError::Unsettled { .. });
        if let FitError::Unsettled { mirror, .. } | FitError::PriorContradicted { mirror, .. } = &mut error {
            let other = reversed(record).and_then(|other| Some(fitted(&other, settings).ok()?.estimate));
            // a tensor that the reversed record hardly tells explains nothing
            let is_sure = |e: &Estimate| e.sigma_principal.iter().all(|sigma| *sigma <= UNCERTAIN);
            *mirror = other.filter(|e| !is_unsettled || is_sure(e)).map(|e| Box::new(e.principal));
        }
        let is_of_motion =
            matches!(error, FitError::Unsettled { .. } | FitError::Driven { .. } | FitError::Units { .. });
        if is_of_motion && has_zero_inputs(record) {
            FitError::ZeroInputs(Some(Box::new(error)))
        } else {
            error
        }
    })
}

/// The same of a record whose spikes were left out.
fn fit_to(record: &Record, settings: &Settings, spikes: Vec<Spike>) -> Result<Fitted, FitError> {
    let Normalised { stretches, rms, input } = normalised(record)?;
    if input.is_some() && settings.known.is_some() {
        return Err(FitError::TwoScales);
    }
    // of samples that are far apart their differences tell no noise
    let (variance, hidden) = match read_variance(settings, record, &stretches, rms) {
        Ok(variance) => (variance, None),
        Err(error) if is_sparse(record) => (MOST / 3.0, Some(error)),
        Err(error) => return Err(error),
    };
    let columns: Vec<Column> = sensor_columns(&settings.sensor, rms)
        .into_iter()
        .chain(input.map(|_| Column::new(Input, None)))
        .collect();
    let errors = errors(&columns, &stretches, rms);
    let demand = Demand {
        radius: settings.radius.map(|r| r * rms),
        torque: settings.torque,
        noise: noise_of(settings, rms, variance),
        columns: &columns,
        errors: &errors,
        rms,
    };
    // wheels and torques of the record are in units of their own
    let motion = if input.is_none() { Motion::new(&stretches, variance) } else { None };
    let open = open_units(record, &stretches, motion.as_ref().filter(|_| settings.check_units), rms)?;
    // a quadrature over samples that are far apart is off by more than their noise
    let sparse = if open.is_none() { likeliest(record, settings) } else { None };
    if let Some(mut estimate) = sparse {
        let left_out = of_record(record, &spikes, estimate.segments);
        estimate.warnings = left_out.into_iter().chain(estimate.warnings).collect();
        estimate.spikes = spikes;
        return Ok(Fitted { estimate, drawn: None });
    }
    if let Some(error) = hidden {
        return Err(error);
    }
    let mut chosen = climb(&stretches, demand, variance)
        .map_err(|failure| without_estimate(failure, record, settings, &stretches, rms))?;
    check_order(&chosen, demand, &stretches, variance)?;
    check_told(&chosen, demand, &stretches, variance, rms)?;
    let case = Case { stretches: &stretches, settings, variance, rms, is_sized: input.is_some() };
    let (supported, completed) = match case.judge(&chosen)? {
        Verdict::Unsettled => {
            let factors = open.iter().flat_map(|others| &others.products).map(|product| product.factor);
            return Err(case.unsettled(&chosen.weak, factors.filter(|f| *f > 1.0).min_by(f64::total_cmp)));
        }
        Verdict::UntoldTorque { names, rank } => return Err(FitError::Untold { names, rank }),
        Verdict::Undetermined(what) => return Err(FitError::Unidentifiable(Box::new(what))),
        Verdict::Completed(supported, by) => {
            let Completed { weak, chi2, .. } = *by;
            chosen.equations = Equations::new(&stretches, &weak, &errors, &columns, variance);
            chosen.weak = weak;
            (supported, Some(Agreement { chi2, dof: 5 }))
        }
        Verdict::Determined(supported) => (supported, None),
    };
    let Supported { identifiability, prior } = *supported;
    let scatter = scatter(&chosen.weak, variance * chosen.weak.misfit(variance).max(1.0));
    let per_segment = summaries(&chosen.weak, &stretches, variance, rms);
    // with wheels alone the exact motion tells more than the weak equations
    let is_exact = input.is_some() && completed.is_none() && scatter.is_none() && settings.radius.is_none();
    let likeliest = if is_exact { with_wheels(&stretches, &chosen.weak, variance) } else { None };
    let likeliest = likeliest.filter(|likeliest| chosen.weak.moved_to(likeliest).is_some());
    let weak = &chosen.weak;
    let misfit = likeliest.as_ref().map_or_else(|| weak.misfit(variance), |likeliest| likeliest.misfit);
    let information = || FitError::Solver(SolverFailure::Information);
    let kept = |column: &Column| matches!(column.class(), Class::Drag | Class::Input);
    let excess = scatter.map_or(1.0, |scatter| scatter.excess());
    let deviation = (variance * misfit.max(1.0) * excess).sqrt();
    let spread = match settings.torque {
        TorqueModel::Auto => spread(&chosen.models, chosen.model),
        _ => Form::zeros(),
    };
    // of a free body alone the exact motion says how far the linear equations hold
    let is_free = weak.columns.is_empty() && !weak.has_torque_noise() && settings.prior.is_none();
    let is_vague = |factor: Form| factor.norm() * deviation > UNCERTAIN;
    let bends = is_free && weak.root.try_inverse().is_some_and(is_vague);
    let spread = if bends { spread + beyond(&stretches, weak.x(), variance) } else { spread };
    let joint = Joint::new(weak, kept, deviation).ok_or_else(information)?;
    let suspected = chosen.equations.as_ref().and_then(|own| suspect(weak, &stretches, own, (variance, rms)));
    if has_zero_inputs(record) && suspected.as_ref().is_some_and(|found| found.what == ROTOR) {
        return Err(FitError::ZeroInputs(None));
    }
    let differing = differing(weak, deviation * deviation);
    let widened = widened(joint, suspected.as_ref(), spread, differing.as_ref());
    let (joint, added) = widened.ok_or_else(information)?;
    let dissipation = dissipation(&weak.columns, &joint.kept);
    let (told, agreed) = match &prior {
        Some(prior) if completed.is_none() => with_prior(&joint, weak, prior, input)?,
        _ => (joint.told.clone(), completed),
    };
    if let Some((prior, agreed)) = prior.as_ref().zip(agreed) {
        check_agreement(prior, agreed, &weak.x())?;
    }
    let answer = nearest(&told, &settings.limits, &dissipation)?;
    let j = tensor(&answer.x);
    let complete = |segment: Summary| segment.complete(&j, deviation * deviation, &added);
    let per_segment = per_segment.into_iter().map(complete).collect();
    let facts = Facts {
        record,
        settings,
        stretches: &stretches,
        rms,
        variance,
        chosen: &chosen,
        misfit,
        scatter,
        differing: differing.as_ref(),
        spikes,
        input,
        joint: &joint,
        told: &told,
        per_segment,
        is_exact: likeliest.is_some(),
        prior: agreed,
        suspect: suspected.as_ref(),
        dissipation: &dissipation,
    };
    let estimate = facts.report(answer, identifiability, motion.as_ref(), open.as_ref())?;
    check_driven(&estimate, motion.as_ref(), &stretches, rms)?;
    // a likelihood on the exact motion leaves no more than noise
    if input.is_some() && estimate.method == Method::WeakForm {
        check_inputs(&chosen.weak, &stretches, variance)?;
    }
    let beside = beside(&chosen.weak, &spread, suspected.as_ref(), differing.as_ref());
    let drawn = Drawn { weak: chosen.weak, deviation, beside, rms, input };
    Ok(Fitted { estimate, drawn: Some(drawn) })
}

/// What is told where the answer may be off by more than noise: by the way to what would explain the record better, by the choice of a torque, and
/// by how far its parts differ. The last two are what the covariance of the tensor is enlarged by.
fn widened(
    joint: Joint,
    suspected: Option<&Suspect>,
    spread: Form,
    differing: Option<&Differing>,
) -> Option<(Joint, Form)> {
    let reached = suspected.and_then(|found| Some(joint.moved(found.reached.as_ref()?)));
    let joint = match reached {
        Some(more) => joint.widened(&more)?,
        None => joint,
    };
    let of_choice = joint.of_tensor(&spread);
    let joint = joint.widened(&of_choice)?;
    let Some(differing) = differing else { return Some((joint, spread)) };
    let more = differing.of(&joint.kept);
    let of_tensor = more.rows(joint.kept.len(), 5);
    let of_parts = of_tensor * of_tensor.transpose();
    let added = spread + Form::from_fn(|i, k| of_parts[(i, k)]);
    Some((joint.widened(&more)?, added))
}

/// By what all columns and the tensor of an estimate may be off beside their noise, side by side, one deviation each: the choice of a torque,
/// what would explain the record better, and how far its parts differ.
fn beside(
    weak: &WeakEstimate,
    spread: &Form,
    suspected: Option<&Suspect>,
    differing: Option<&Differing>,
) -> DMatrix<f64> {
    let count = weak.columns.len();
    let of_choice = factor(spread);
    let choice = (0..5)
        .map(|e| DVector::from_fn(count + 5, |k, _| if k < count { 0.0 } else { of_choice[(k - count, e)] }));
    let reached = suspected.and_then(|found| found.reached.as_ref()).map(|to| {
        let steps = DVector::from_column_slice((to.x - weak.at.x).as_slice());
        DVector::from_fn(count + 5, |k, _| match k.checked_sub(count) {
            None => to.c[k] - weak.at.c[k],
            Some(of_tensor) => steps[of_tensor],
        })
    });
    let parts = differing.into_iter().flat_map(Differing::all).cloned();
    let moves: Vec<DVector<f64>> =
        choice.chain(reached).chain(parts).filter(|m| m.iter().any(|v| *v != 0.0)).collect();
    DMatrix::from_fn(count + 5, moves.len(), |k, e| moves[e][k])
}

/// Why there is no weak estimate, in the words of the record.
fn without_estimate(
    failure: Failure,
    record: &Record,
    settings: &Settings,
    stretches: &[Stretch],
    rms: f64,
) -> FitError {
    let singular = FitError::Solver(SolverFailure::Covariance);
    match failure {
        Failure::Dense => settings.radius.map_or(singular, |radius| FitError::Dense { radius }),
        Failure::TooShort => too_short(record, settings, stretches, rms),
        Failure::Singular => singular,
    }
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
    let variance = variance.max(LEAST);
    // the mean square is 1, of which the noise of three components is 3 σ²: a quarter is too much to fit
    if 3.0 * variance > MOST {
        let stated = settings.noise.filter(|_| {
            let unstated = settings.clone().with_noise(None::<f64>);
            read_variance(&unstated, record, stretches, rms).is_ok()
        });
        let misstated = stated.and_then(|stated| {
            let rounding = rounding(record.quanta());
            let shown = noise::contradicting(stretches, variance, rounding, (0.0, 0))?;
            Some(FitError::StatedNoise { rms, stated, shown: shown.sqrt() * rms })
        });
        return Err(misstated.unwrap_or(FitError::NoRotation { rms, noise: variance.sqrt() * rms }));
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::columns::column::Unknowns;
    use crate::columns::drag::Drag;
    use crate::physical::coordinates::Coordinates;
    use crate::report::next_step::Origin;

    const UNIT: f64 = 2.0;

    /// Rates that change evenly, so that their differences show no noise and no reading comes twice, in steps of 0.1 s.
    fn even() -> (Record, Vec<Stretch>) {
        let times: Vec<f64> = (0..41).map(|k| 0.1 * f64::from(k)).collect();
        let rates = (0..41).map(f64::from).map(|k| Vector3::new(1.0 + 0.01 * k, 2.0 - 0.02 * k, 0.03 * k));
        let rates: Vec<Vector3<f64>> = rates.collect();
        let record = Record::from_samples(&times, &rates).unwrap();
        let (times, rates) = (times.iter().map(|t| t * UNIT), rates.iter().map(|w| w / UNIT));
        (record, vec![Stretch::new(times.collect(), rates.collect())])
    }

    /// A noise of 0.2 rad/s in units of 2 rad/s has the variance 0.01, and rounding to steps of 0.6 rad/s adds 0.36/12/4; without a noise the
    /// larger of both counts. Noise that is less than the quadrature has that of the quadrature, and a twelfth of the mean square is too much.
    #[test]
    fn the_variance_is_that_of_noise_and_rounding() {
        let (record, stretches) = even();
        let of = |settings: &Settings| read_variance(settings, &record, &stretches, UNIT);
        let (plain, stepped) = (Settings::default(), Settings::default().with_quantum(0.6));
        let near = |settings: &Settings, expected: f64| {
            let found = of(settings).unwrap();
            assert!((found / expected - 1.0).abs() < 1e-12, "{found} {expected}");
        };
        near(&plain, LEAST);
        near(&stepped, 0.0075);
        near(&plain.clone().with_noise(0.2), 0.01);
        near(&stepped.clone().with_noise(0.2), 0.0175);
        near(&plain.clone().with_noise(1e-11), LEAST);
        let most = UNIT * (MOST / 3.0).sqrt();
        assert!(of(&plain.clone().with_noise(most * (1.0 - 1e-9))).is_ok());
        let too_much = most * (1.0 + 1e-9);
        match of(&plain.clone().with_noise(too_much)) {
            // of the readings themselves no noise hides the rotation
            Err(FitError::StatedNoise { rms, stated, shown }) => {
                assert!(rms == UNIT && (stated / too_much - 1.0).abs() < 1e-12, "{rms} {stated}");
                assert!(shown < 1e-9, "{shown}");
            }
            found => panic!("{found:?}"),
        }
        for value in [1e-170, 1e170] {
            let found = of(&plain.clone().with_noise(value));
            assert_eq!(found, Err(FitError::Setting { name: "the noise", value }));
        }
    }

    /// A density in (rad/s²)² s is one over the cube of the unit rate, and is told over the variance of the noise.
    #[test]
    fn torque_noise_is_told_in_the_units_of_the_fit() {
        let of = |torque_noise| noise_of(&Settings::default().with_torque_noise(torque_noise), UNIT, 0.01);
        assert_eq!((of(TorqueNoise::None), of(TorqueNoise::Fitted)), (Noise::White, Noise::Fitted));
        let Noise::Given(level) = of(TorqueNoise::Given(0.4)) else { panic!() };
        assert!((level / 5.0 - 1.0).abs() < 1e-14, "{level}");
    }

    /// Why there is no estimate: of a radius that was asked for how long the longest stretch is in seconds, else how many samples there are.
    #[test]
    fn a_record_that_is_too_short_is_told_by_what_was_asked() {
        let (record, stretches) = even();
        let plain = Settings::default();
        let given = plain.clone().with_radius(5.0);
        let of = |failure, settings| without_estimate(failure, &record, settings, &stretches, UNIT);
        let FitError::Radius { radius, longest, needed } = of(Failure::TooShort, &given) else { panic!() };
        assert!((radius, needed) == (5.0, 8) && (longest - 4.0).abs() < 1e-12, "{longest}");
        let few = FitError::TooFewSamples { samples: 41, segments: 1, longest: 41, saturated: 0, needed: 16 };
        assert_eq!(of(Failure::TooShort, &plain), few);
        let singular = FitError::Solver(SolverFailure::Covariance);
        assert_eq!(of(Failure::Dense, &given), FitError::Dense { radius: 5.0 });
        assert_eq!(of(Failure::Dense, &plain), singular);
        assert_eq!(of(Failure::Singular, &given), singular);
        assert_eq!(of(Failure::Singular, &plain), singular);
    }

    /// The displacements beside the noise have the squares of their sum: what the choice spreads the tensor by, and the way to what would
    /// explain the record better.
    #[test]
    fn what_stands_beside_the_noise_adds_its_squares() {
        let at = Unknowns { x: Coordinates::repeat(0.25), c: vec![0.5] };
        let weak = WeakEstimate::plain(vec![Column::new(Drag, None)], at, 20);
        assert_eq!(beside(&weak, &Form::zeros(), None, None).shape(), (6, 0));
        let reached = Some(Unknowns { x: Coordinates::repeat(0.375), c: vec![0.75] });
        let (what, origin) = ("an error of hx", Origin::Wheels);
        let suspect = Suspect { what, origin, size: 0.1, unit: "of it", gain: 90.0, reached };
        let spread = Form::from_fn(|i, k| if i == k { 4.0 } else { 1.0 });
        let found = beside(&weak, &spread, Some(&suspect), None);
        let step = DVector::from_fn(6, |k, _| if k == 0 { 0.25 } else { 0.125 });
        let mut expected = &step * step.transpose();
        let mut of_tensor = expected.view_mut((1, 1), (5, 5));
        of_tensor += spread;
        assert!((&found * found.transpose() - expected).amax() < 1e-12);
    }
}

//! The joint fit.

use nalgebra::{DVector, Matrix3};

use crate::carrier::agreement::contradicts;
use crate::carrier::error::CarrierError;
use crate::carrier::estimate::{CarrierEstimate, MeasuredWheel};
use crate::carrier::law::{bodies, is_held, is_physical};
use crate::carrier::least::least;
use crate::carrier::records::CarrierRecords;
use crate::carrier::report::Report;
use crate::carrier::start::{Alone, Start, start};
use crate::carrier::system::{Part, System};
use crate::carrier::told::Told;
use crate::carrier::warning::{CarrierWarning, contradiction, light};
use crate::carrier::wheels::check_wheels;
use crate::columns::column::Column;
use crate::columns::sets::sensor_columns;
use crate::error::FitError;
use crate::estimator::{Drawn, Fitted, fitted};
use crate::physical::failure::SolverFailure;
use crate::physical::truncated::spread_within;
use crate::report::nuisance::Agreement;
use crate::settings::Settings;
use crate::thresholds::noise::SURE;

/// Fits carrier, object and wheel to all records at once.
///
/// All tensors are in kg m², in the axes of the sensor. Their size comes from wheels of known momentum, from known torques, or from the
/// proof body. Without wheels and torques, the size of the object needs a record of carrier, object and proof body. In `settings` the
/// known quantity, the limits and the prior tensor must be left out. An error of the sensor is one unknown for all records; a torque is one
/// unknown for each.
///
/// ```
/// use nalgebra::{Matrix3, Vector3};
/// use polhode::{inertia::Inertia, num::Random};
/// use polhode_fit::{CarrierRecords, ProofBody, Record, Settings, fit_carrier, simulate};
/// let carrier = Matrix3::from_diagonal(&Vector3::new(0.02, 0.03, 0.04));
/// let proof = Matrix3::from_diagonal(&Vector3::new(0.015, 0.004, 0.016)); // its own, about the same centre of mass
/// let times: Vec<f64> = (0..1000).map(|i| f64::from(i) / 100.0).collect();
/// let mut random = Random::new(1);
/// let mut tumble = |tensor: Matrix3<f64>| {
///     let body = Inertia::from_tensor(tensor)?;
///     let rates = simulate(&body, Vector3::new(1.0, 3.0, 2.0), &times, 1e-3, &mut random)?;
///     Ok::<_, polhode::Error>(Record::from_samples(&times, &rates)?)
/// };
/// let records = CarrierRecords::new(tumble(carrier)?);
/// let records = records.with_proof(tumble(carrier + proof)?, ProofBody::adding(proof)?);
/// let estimate = fit_carrier(&records, &Settings::default())?;
/// let sigma = estimate.carrier.covariance[(0, 0)].sqrt(); // kg m²
/// assert!((estimate.carrier.tensor[(0, 0)] - 0.02).abs() < 4.0 * sigma && sigma < 1e-4);
/// # Ok::<(), polhode::Error>(())
/// ```
///
/// # Errors
/// A record that cannot be fitted, or that is given twice; nothing that gives a size, as a proof body too light for the records; wheels of only some of the
/// records, of different axes, or with a negative moment; records that contradict each other so much that they leave the size open.
pub fn fit_carrier(records: &CarrierRecords, settings: &Settings) -> Result<CarrierEstimate, CarrierError> {
    let beforehand = [
        ("known quantity", settings.known.is_some()),
        ("prior tensor", settings.prior.is_some()),
        ("limits", !settings.limits.is_empty()),
    ];
    if let Some((name, _)) = beforehand.into_iter().find(|(_, given)| *given) {
        return Err(CarrierError::Beforehand { name });
    }
    if let Some((attached, before)) = records.repeated() {
        return Err(CarrierError::Same { attached, before });
    }
    check_wheels(records)?;
    let sensor = sensor_columns(&settings.sensor, 1.0);
    let (mut estimates, mut drawn) = (Vec::new(), Vec::new());
    for tumble in &records.tumbles {
        let attached = tumble.attached;
        let of_record = |error: FitError| CarrierError::Record { attached, error: Box::new(error) };
        let Fitted { mut estimate, drawn: of_this } = fitted(&tumble.record, settings).map_err(of_record)?;
        drawn.push(of_this.ok_or(CarrierError::Sparse { attached })?);
        if records.finds_wheel {
            (estimate.inertia, estimate.inertia_covariance) = (None, None);
        }
        estimates.push((attached, estimate));
    }
    // drag that would give energy is held at zero, as in the fit of one record
    let mut held = vec![Vec::new(); drawn.len()];
    let (start, system, best, normal) = loop {
        let (start, system, z) = system(records, &drawn, &held, &sensor)?;
        let (best, normal) = least(&system, z, None)?;
        let gains = |part: &Part| Some(part.told.gains(&system.readings(part, &best)?));
        let more = system.parts.iter().map(gains).collect::<Option<Vec<_>>>().unwrap_or_default();
        if more.iter().all(Vec::is_empty) {
            break (start, system, best, normal);
        }
        held.iter_mut().zip(more).for_each(|(held, more)| held.extend(more));
    };
    let terms = bodies(&system, records);
    let (answer, pull) = match terms.iter().all(|body| is_physical(body, &best)) {
        true => (best.clone(), 0.0),
        false => {
            let (answer, _) = least(&system, best.clone(), Some(&terms))?;
            let pull = (&normal.root * (&answer - &normal.centre)).norm();
            (answer, pull)
        }
    };
    let chi2 = system.squares(&best).ok_or(SolverFailure::Information)?;
    let agreement = Agreement { chi2, dof: system.dof(best.len()) };
    let excess = if contradicts(agreement) { chi2 / agreement.dof as f64 } else { 1.0 };
    let factor = normal.root.clone().try_inverse().ok_or(SolverFailure::Information)? * excess.sqrt();
    let cut = (pull > 0.0)
        .then(|| {
            let allows = |z: &DVector<f64>| terms.iter().all(|body| is_physical(body, z));
            spread_within(&normal.centre, &factor, &answer, allows)
        })
        .flatten();
    let covariance = cut.unwrap_or_else(|| &factor * factor.transpose());
    let report = Report { system: &system, answer: &answer, covariance: &covariance };
    let carrier = report.body(system.carrier, Matrix3::zeros());
    let (trace, sigma) = carrier.trace();
    if contradicts(agreement) && trace <= SURE * sigma {
        let Agreement { chi2, dof } = agreement;
        return Err(CarrierError::Contradicted { chi2, dof, trace, sigma });
    }
    let wheel = report.wheel();
    let negative = wheel.filter(|wheel| wheel.inertia < -SURE * wheel.sigma);
    if let Some(MeasuredWheel { inertia, sigma }) = negative {
        return Err(CarrierError::WheelSense { inertia, sigma });
    }
    let object = system.object.map(|placed| report.body(placed, Matrix3::zeros()));
    let itself = system.object.zip(records.object_term);
    let held = ["carrier", "object"].into_iter().zip(&terms).filter(|(_, body)| is_held(body, &answer));
    let held = held.filter(|_| pull > 0.0).map(|(name, _)| CarrierWarning::Held { name, pull });
    let warnings = [contradiction(agreement), object.as_ref().and_then(light)];
    Ok(CarrierEstimate {
        carrier,
        object,
        object_itself: itself.map(|(placed, term)| report.body(placed, -term)),
        wheel,
        covariance: report.joint(),
        nuisances: report.nuisances(&sensor),
        sizes: start.sizes,
        agreement,
        pull,
        records: estimates,
        warnings: warnings.into_iter().flatten().chain(held).collect(),
    })
}

/// The equations of all records, the columns `held` of each at zero, with where they start.
fn system(
    records: &CarrierRecords,
    drawn: &[Drawn],
    held: &[Vec<usize>],
    sensor: &[Column],
) -> Result<(Start, System, DVector<f64>), CarrierError> {
    let priors: Vec<f64> = sensor.iter().filter_map(|column| column.prior).collect();
    let (mut parts, mut alone) = (Vec::new(), Vec::new());
    for ((tumble, drawn), held) in records.tumbles.iter().zip(drawn).zip(held) {
        let told = Told::new(drawn, held).ok_or(SolverFailure::Information)?;
        let own = told.alone(&priors).ok_or(SolverFailure::Information)?;
        alone.push(Alone { attached: tumble.attached, proof: tumble.proof, told: own });
        let deviations = tumble.proof.map(|proof| proof.deviations()).transpose()?.flatten();
        parts.push(Part {
            told,
            has_object: tumble.attached.has_object(),
            added: tumble.proof.map_or(Matrix3::zeros(), |proof| proof.added()),
            uncertain: deviations.map(|sigmas| (0, sigmas)),
        });
    }
    let start: Start = start(&alone, records.finds_wheel)?;
    let (system, z) = System::new(parts, priors, &start);
    Ok((start, system, z))
}

//! Carrier, proof body and object as one joint fit.

mod arguments;
mod report;

use std::path::PathBuf;

use nalgebra::Vector3;
use polhode_files::error::{Error, warn};
use polhode_fit::{Attached, CarrierError, CarrierRecords, FitError, Settings, fit_carrier};
use polhode_pages::table::Format;

use super::flights::Spans;
use super::refusal;
use super::report::unused;
use crate::flags::record::RecordArguments;
pub(super) use arguments::CarrierArguments;

/// The answer as text, rows or JSON; `data` are the records of the object, `wheel` the momentum of a wheel per rad/s of its speed and
/// whether its inertia is to be found.
pub(super) fn report(
    arguments: &CarrierArguments,
    data: &[PathBuf],
    reading: &RecordArguments,
    (momentum, finds_wheel): (Option<Vector3<f64>>, bool),
    settings: &Settings,
    format: Format,
) -> Result<String, Error> {
    let files = arguments.files(data);
    let given = files.map(|files| !files.is_empty());
    let [mut alone, mut proof, mut object, mut both] = reading.records(files, momentum)?;
    let each = [
        (&mut alone, Attached::Nothing),
        (&mut proof, Attached::Proof),
        (&mut object, Attached::Object),
        (&mut both, Attached::ObjectAndProof),
    ];
    for ((record, attached), _) in each.into_iter().zip(given).filter(|(_, given)| *given) {
        let names = unused(record);
        if !names.is_empty() {
            warn(&format!("{attached}: columns not used: {}", names.join(", ")));
        }
        if reading.is_whole() {
            let found = Spans::find(record, settings).map_err(|error| {
                refused(arguments, data, CarrierError::Record { attached, error: Box::new(error) })
            })?;
            found.remark().into_iter().for_each(|remark| warn(&format!("{attached}: {remark}")));
        }
    }
    let mut records = CarrierRecords::new(alone);
    if let Some(body) = arguments.proof_body()?.filter(|_| given[1]) {
        records = records.with_proof(proof, body);
    }
    if given[2] {
        records = records.with_object(object);
    }
    if let Some(body) = arguments.proof_body_beside_object()?.filter(|_| given[3]) {
        records = records.with_object_and_proof(both, body);
    }
    if let Some((mass, place, carrier)) = arguments.object_place()? {
        records =
            records.with_object_at(mass, place, carrier).map_err(|error| Error::Input(error.to_string()))?;
    }
    if finds_wheel {
        records = records.with_unknown_wheel();
    }
    let estimate = fit_carrier(&records, settings).map_err(|error| refused(arguments, data, error))?;
    for (attached, of_record) in &estimate.records {
        of_record.warnings.iter().for_each(|warning| warn(&format!("{attached}: {warning}")));
    }
    estimate.warnings.iter().for_each(|warning| warn(&warning.to_string()));
    Ok(report::report(&estimate, format))
}

/// A refusal with the files it is about.
fn refused(arguments: &CarrierArguments, data: &[PathBuf], error: CarrierError) -> Error {
    let [alone, proof, object, both] = arguments.files(data);
    let files = match &error {
        CarrierError::Record { attached: Attached::Nothing, .. } => alone.to_vec(),
        CarrierError::Record { attached: Attached::Proof, .. } => proof.to_vec(),
        CarrierError::Record { attached: Attached::Object, .. } => object.to_vec(),
        CarrierError::Record { .. } => both.to_vec(),
        _ => [alone, proof, object, both].concat(),
    };
    let names: Vec<String> = files.iter().map(|path| path.display().to_string()).collect();
    let names = names.join(", ");
    let failed = match &error {
        CarrierError::Record { error, .. } => refusal::facts(error).1,
        CarrierError::TooLight { .. }
        | CarrierError::Opposite { .. }
        | CarrierError::ObjectSize { .. }
        | CarrierError::Contradicted { .. }
        | CarrierError::Unsettled { .. }
        | CarrierError::Solver(_) => true,
        _ => false,
    };
    let reason = match &error {
        CarrierError::Record { attached, error } => {
            let of: &FitError = error;
            format!("{attached}: {}", refusal::reason(of))
        }
        CarrierError::NoSize { .. } => {
            format!("{error} (--proof, --wheel, columns hx, hy, hz or tx, ty, tz)")
        }
        CarrierError::ObjectSize { .. } => format!("{error} (--object-proof)"),
        _ => error.to_string(),
    };
    let message = format!("{names}: {reason}");
    if failed { Error::Failed(message) } else { Error::Input(message) }
}

//! Carrier, proof body and object as one joint fit.

mod arguments;
mod page;
mod report;

use std::path::PathBuf;

use nalgebra::Vector3;
use polhode_files::error::{Error, warn};
use polhode_fit::{Attached, CarrierError, CarrierRecords, Settings, fit_carrier};
use polhode_pages::document::Form;
use polhode_pages::output::Output;
use polhode_pages::table::Format;

use super::as_read::AsRead;
use super::flights::Spans;
use super::refusal;
use super::report::unused;
use crate::flags::record::RecordArguments;
pub(super) use arguments::CarrierArguments;

/// Where an answer goes.
pub(super) struct Wanted {
    pub(super) output: Output,
    pub(super) format: Format,
    pub(super) page: Option<(Output, Form)>,
}

/// Fits all records, and writes the answer as text, rows or JSON, and as a page; `data` are the records of the object, `wheel` the
/// momentum of a wheel per rad/s of its speed and whether its inertia is to be found.
pub(super) fn run(
    arguments: &CarrierArguments,
    data: &[PathBuf],
    reading: &RecordArguments,
    wheel: (Option<Vector3<f64>>, bool),
    settings: &Settings,
    wanted: Wanted,
) -> Result<(), Error> {
    let Wanted { output, format, page } = wanted;
    let (found, as_read) = records(arguments, data, reading, wheel, settings)?;
    let found = found.and_then(|records| fit_carrier(&records, settings));
    let estimate = match found {
        Ok(estimate) => estimate,
        Err(error) => {
            let (names, reason) = (named(&about(arguments, data, &error)), reason(&error));
            if let Some((file, form)) = page {
                file.write_whole(&page::refused(&reason, (&names, &as_read), form))?;
            }
            let message = format!("{names}: {reason}");
            return Err(if is_failure(&error) { Error::Failed(message) } else { Error::Input(message) });
        }
    };
    estimate.all_warnings().iter().for_each(|warning| warn(warning));
    output.write_whole(&report::report(&estimate, &as_read, format))?;
    match page {
        Some((file, form)) => {
            let names = named(&arguments.files(data).concat());
            file.write_whole(&page::estimated(&estimate, (&names, &as_read), form))
        }
        None => Ok(()),
    }
}

/// The records of all files, with what was attached in each.
fn records(
    arguments: &CarrierArguments,
    data: &[PathBuf],
    reading: &RecordArguments,
    (momentum, finds_wheel): (Option<Vector3<f64>>, bool),
    settings: &Settings,
) -> Result<(Result<CarrierRecords, CarrierError>, AsRead), Error> {
    let files = arguments.files(data);
    let given = files.map(|files| !files.is_empty());
    arguments.check_used(given[2] || given[3])?;
    if !given[1] && !given[3] && arguments.proof_body()?.is_some() {
        let rule = "no record has the proof body";
        let remedy = "give --proof or --object-proof too, or leave it out";
        return Err(Error::input("--proof-body", "", rule, remedy));
    }
    let ([mut alone, mut proof, mut object, mut both], read) = reading.records(files, momentum)?;
    let as_read = AsRead(read);
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
            match Spans::find(record, settings) {
                Ok(found) => {
                    found.remark().into_iter().for_each(|remark| warn(&format!("{attached}: {remark}")));
                }
                Err(error) => {
                    return Ok((Err(CarrierError::Record { attached, error: Box::new(error) }), as_read));
                }
            }
        }
    }
    let mut records = CarrierRecords::new(alone);
    if let Some(body) = arguments.proof_body()?.filter(|_| given[1]) {
        records = records.with_proof(proof, body);
    }
    if given[2] {
        records = records.with_object(object);
    }
    if let Some(body) = arguments.proof_body_beside_object()? {
        records = records.with_object_and_proof(both, body);
    }
    if let Some((mass, place, carrier)) = arguments.object_place()? {
        records =
            records.with_object_at(mass, place, carrier).map_err(|error| Error::Input(error.to_string()))?;
    }
    Ok((Ok(if finds_wheel { records.with_unknown_wheel() } else { records }), as_read))
}

fn named(files: &[PathBuf]) -> String {
    files.iter().map(|path| path.display().to_string()).collect::<Vec<_>>().join(", ")
}

/// The files that a refusal is about.
fn about(arguments: &CarrierArguments, data: &[PathBuf], error: &CarrierError) -> Vec<PathBuf> {
    let [alone, proof, object, both] = arguments.files(data);
    match error {
        CarrierError::Record { attached: Attached::Nothing, .. } => alone.to_vec(),
        CarrierError::Record { attached: Attached::Proof, .. } => proof.to_vec(),
        CarrierError::Record { attached: Attached::Object, .. } => object.to_vec(),
        CarrierError::Record { .. } => both.to_vec(),
        _ => [alone, proof, object, both].concat(),
    }
}

/// Whether the records were tried, and do not tell.
fn is_failure(error: &CarrierError) -> bool {
    match error {
        CarrierError::Record { error, .. } => refusal::facts(error).1,
        CarrierError::TooLight { .. }
        | CarrierError::Opposite { .. }
        | CarrierError::ObjectSize { .. }
        | CarrierError::Contradicted { .. }
        | CarrierError::Unsettled { .. }
        | CarrierError::Solver(_) => true,
        _ => false,
    }
}

/// A refusal in words, with the flags that help.
fn reason(error: &CarrierError) -> String {
    match error {
        CarrierError::Record { attached, error } => format!("{attached}: {}", refusal::reason(error)),
        CarrierError::NoSize { .. } => {
            format!("{error} (--proof, --wheel, columns hx, hy, hz or tx, ty, tz)")
        }
        CarrierError::ObjectSize { .. } => format!("{error} (--object-proof)"),
        _ => error.to_string(),
    }
}

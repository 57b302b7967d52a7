//! The predicted phase error of a method, beside what was measured.

use polhode::body::{Body, Clock, Point};
use polhode::method::{PhaseError, method};
use polhode::num::Dd;
use polhode_files::error::{Error, unexpected};
use polhode_pages::table::{Cell, Column, row};

use super::entries::Entry;

pub(super) fn columns() -> Vec<Column> {
    vec![
        Column::new("predicted_error", "rad", "attitude error at the end by the predicted shift and twist")
            .heading("predicted")
            .digits(2),
        Column::new("shift_rate", "", "predicted growth of the shift in time per second").hidden(),
        Column::new("twist_rate", "rad/s", "predicted growth of the twist about L").hidden(),
        Column::new("prediction", "", "how well the rates are known, or why they are not"),
    ]
}

/// Refuses a span over which forces do not stay weak on what is taken back, before the true motion is worked out in double-double.
pub(super) fn check(
    entry: &Entry,
    body: &Body,
    start: &Point<Dd>,
    [from, span]: [f64; 2],
) -> Result<(), Error> {
    let name = entry.method.name();
    let base = name.strip_suffix("+phase").filter(|_| !body.forces().is_empty());
    let (Some(base), Some(step)) = (base, entry.step) else { return Ok(()) };
    let clock = Clock { start: from, step };
    let drift = method(base).map_err(unexpected)?.phase_by_clock(body, &body.leave(&start.to_f64()), clock);
    let lasting = drift.and_then(|drift| drift.attitude_error(span));
    lasting.map(|_| ()).map_err(|error| Error::Input(format!("--methods: {name}: {error}")))
}

pub(super) fn cells(entry: &Entry, body: &Body, start: &Point<Dd>, [from, span]: [f64; 2]) -> Vec<Cell> {
    let Some(step) = entry.step else {
        return row![None::<f64>, None::<f64>, None::<f64>, "none: the method chooses its steps"].to_vec();
    };
    let clock = Clock { start: from, step };
    match entry.method.phase_by_clock(body, &body.leave(&start.to_f64()), clock) {
        Ok(drift) => {
            let error = drift.attitude_error(span);
            let known = match &error {
                Err(error) => format!("none: {error}"),
                Ok(error) if drift.rounding(span) > *error => "below rounding".to_owned(),
                Ok(_) => format!("rates to {:.1e}", drift.doubt()),
            };
            row![error.ok(), drift.shift(), drift.twist(), known].to_vec()
        }
        Err(error) => {
            let why = match error {
                PhaseError::NotKept { lost, .. } => format!("none: {lost}"),
                PhaseError::TakenBack { .. } => "taken back".into(),
                error => format!("none: {error}"),
            };
            row![None::<f64>, None::<f64>, None::<f64>, why].to_vec()
        }
    }
}

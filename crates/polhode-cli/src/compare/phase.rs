//! The predicted phase error of a method, beside what was measured.

use polhode::body::{Body, Point};
use polhode::method::PhaseError;
use polhode::num::Dd;
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

pub(super) fn cells(entry: &Entry, body: &Body, start: &Point<Dd>, span: f64) -> Vec<Cell> {
    let Some(step) = entry.step else {
        return row![None::<f64>, None::<f64>, None::<f64>, "none: the method chooses its steps"].to_vec();
    };
    match entry.method.phase(body, &body.leave(&start.to_f64()), step) {
        Ok(drift) => {
            let error = drift.attitude_error(span).ok();
            let known = if error.is_none_or(|error| drift.rounding(span) > error) {
                "below rounding".to_owned()
            } else {
                format!("rates to {:.1e}", drift.doubt())
            };
            row![error, drift.shift(), drift.twist(), known].to_vec()
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

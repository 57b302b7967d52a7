//! Units and amounts as Python gives them.

use polhode::units::TimeUnit;
use polhode_files::mesh::length_unit;
use pyo3::prelude::*;
use pyo3::types::PyString;

use crate::error::refused;
use crate::scalars::scalar;

pub(crate) fn positive(name: &'static str, value: f64) -> PyResult<f64> {
    if value.is_finite() && value > 0.0 {
        Ok(value)
    } else {
        Err(refused(format!("{name}: {value:?}; it must be a finite number above 0")))
    }
}

/// A time, s.
pub(crate) fn finite(name: &'static str, value: f64) -> PyResult<f64> {
    if value.is_finite() {
        Ok(value)
    } else {
        Err(refused(format!("{name}: {value} is not a finite number of seconds")))
    }
}

pub(crate) fn share(value: f64) -> PyResult<f64> {
    if (0.0..1.0).contains(&value) {
        Ok(value)
    } else {
        Err(refused(format!(
            "skip_rows: {value:?} is not a fraction of the rows; give a number from 0 to below 1"
        )))
    }
}

pub(crate) fn named_rate(text: &str) -> PyResult<polhode::units::RateUnit> {
    let unknown = || refused(format!("rate_unit: '{text}'; known: rad/s, deg/s, rpm"));
    polhode::units::RateUnit::named(text).ok_or_else(unknown)
}

pub(crate) fn named_time(unit: &Bound<'_, PyAny>) -> PyResult<TimeUnit> {
    match unit.cast::<PyString>() {
        Ok(text) => {
            let text = text.to_string_lossy();
            let unknown = || {
                refused(format!(
                    "time_unit: '{text}'; known: s, ms, us, ns, min, h, d, or a number of seconds"
                ))
            };
            TimeUnit::named(&text).ok_or_else(unknown)
        }
        Err(_) => positive("time_unit", scalar("time_unit", unit)?).map(TimeUnit::Multiple),
    }
}

pub(crate) fn named_length(unit: &Bound<'_, PyAny>) -> PyResult<f64> {
    match unit.cast::<PyString>() {
        Ok(text) => {
            length_unit(&text.to_string_lossy()).map_err(|error| refused(format!("length_unit: {error}")))
        }
        Err(_) => positive("length_unit", scalar("length_unit", unit)?),
    }
}

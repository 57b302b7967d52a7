//! One exception for whatever the library refuses, one kind of warning.

use std::ffi::CString;

use pyo3::exceptions::{PyUserWarning, PyValueError};
use pyo3::prelude::*;
use pyo3::{PyErr, create_exception};

create_exception!(polhode, PolhodeError, PyValueError, "What the library refuses, in its words.");
create_exception!(
    polhode,
    PolhodeWarning,
    PyUserWarning,
    "What limits the use of a result, in the library's words."
);

/// The exception with the words of `error`.
pub(crate) fn refused(error: impl std::fmt::Display) -> PyErr {
    PolhodeError::new_err(error.to_string())
}

/// What went wrong with the argument `name`, with the words of an error.
pub(crate) fn of<E: std::fmt::Display>(name: &'static str) -> impl Fn(E) -> PyErr {
    move |error| refused(format!("{name}: {error}"))
}

/// A Python warning, which filters of the caller may turn into an exception.
pub(crate) fn warn(py: Python<'_>, text: &str) -> PyResult<()> {
    let text = CString::new(text.replace('\0', "\u{fffd}")).unwrap_or_default();
    PyErr::warn(py, &py.get_type::<PolhodeWarning>(), &text, 1)
}

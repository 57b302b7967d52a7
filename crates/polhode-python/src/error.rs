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
    PolhodeError::new_err(keywords(&error.to_string()))
}

/// Words of the command with its flags as the keywords that they are here.
pub(crate) fn keywords(text: &str) -> String {
    let keyword = |word: &str| match word.strip_prefix("--") {
        Some(flag) if flag.starts_with(|c: char| c.is_ascii_lowercase()) => {
            let end = flag.find(|c: char| !c.is_ascii_lowercase() && c != '-').unwrap_or(flag.len());
            flag[..end].replace('-', "_") + &flag[end..]
        }
        _ => word.into(),
    };
    text.split_inclusive(char::is_whitespace).map(keyword).collect()
}

/// What went wrong with the argument `name`, with the words of an error.
pub(crate) fn of<E: std::fmt::Display>(name: &'static str) -> impl Fn(E) -> PyErr {
    move |error| refused(format!("{name}: {error}"))
}

/// A Python warning, which filters of the caller may turn into an exception.
pub(crate) fn warn(py: Python<'_>, text: &str) -> PyResult<()> {
    let text = CString::new(keywords(text).replace('\0', "\u{fffd}")).unwrap_or_default();
    PyErr::warn(py, &py.get_type::<PolhodeWarning>(), &text, 1)
}

//! One exception for whatever the library refuses.

use pyo3::exceptions::PyValueError;
use pyo3::{PyErr, create_exception};

create_exception!(_polhode, PolhodeError, PyValueError, "What the library refuses, in its words.");

/// The exception with the words of `error`.
pub(crate) fn refused(error: impl std::fmt::Display) -> PyErr {
    PolhodeError::new_err(error.to_string())
}

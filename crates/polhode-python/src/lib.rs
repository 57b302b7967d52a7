//! The compiled half of the Python package `polhode`: classes and functions on arrays, each over the library's own.
//!
//! Arrays are taken in any form that `numpy.asarray` makes `float64` of; results are new arrays. The interpreter is free while
//! numbers are computed, and long work ends at Ctrl-C. Errors are `PolhodeError`, a `ValueError` with the library's words.

mod arrays;
mod audits;
mod bodies;
mod error;
mod fits;
mod forces;
mod masses;
mod motions;
mod runs;
mod states;

use pyo3::prelude::*;

#[pymodule]
mod _polhode {
    #[pymodule_export]
    use super::audits::{Verdict, audit};
    #[pymodule_export]
    use super::bodies::{Body, bodies};
    #[pymodule_export]
    use super::error::PolhodeError;
    #[pymodule_export]
    use super::fits::{Estimate, fit};
    #[pymodule_export]
    use super::forces::{
        Force, drag, force, gravity, gravity_gradient, torque_body, torque_space,
    };
    #[pymodule_export]
    use super::masses::{MassProperties, mesh, read, solid};
    #[pymodule_export]
    use super::motions::{FreeMotion, LagrangeTop};
    #[pymodule_export]
    use super::runs::{Samples, advise, methods, run};
    #[pymodule_export]
    use super::states::States;
}

//! The compiled half of the Python package `polhode`: classes and functions on arrays, each over the library's own.
//!
//! Arrays are taken in any form that `numpy.asarray` makes numbers of; results are new arrays. The interpreter is free while
//! numbers are computed, and long work ends at Ctrl-C. Errors are `PolhodeError`, a `ValueError` with the library's words.

mod advice;
mod arrays;
mod attitudes;
mod audits;
mod bodies;
mod calm;
mod carriers;
mod columns;
mod derivatives;
mod ensembles;
mod error;
mod estimates;
mod files;
mod fits;
mod forces;
mod json;
mod links;
mod masses;
mod motions;
mod parts;
mod phases;
mod runs;
mod samples;
mod scalars;
mod shown;
mod states;
mod tables;
mod through;
mod tops;
mod units;
mod wheels;

use pyo3::prelude::*;

#[pymodule]
mod _polhode {
    #[pymodule_export]
    #[allow(non_upper_case_globals, reason = "the name that Python has for it")]
    const __version__: &str = env!("CARGO_PKG_VERSION");
    #[pymodule_export]
    use super::advice::{Advice, advise};
    #[pymodule_export]
    use super::attitudes::{Attitudes, attitude};
    #[pymodule_export]
    use super::audits::{Verdict, verdict_on};
    #[pymodule_export]
    use super::bodies::{Body, catalogue_names, named_body};
    #[pymodule_export]
    use super::carriers::{CarrierEstimate, MeasuredBody, fitted_carrier};
    #[pymodule_export]
    use super::ensembles::Ensemble;
    #[pymodule_export]
    use super::error::{PolhodeError, PolhodeWarning};
    #[pymodule_export]
    use super::estimates::Estimate;
    #[pymodule_export]
    use super::files::read;
    #[pymodule_export]
    use super::fits::fitted;
    #[pymodule_export]
    use super::forces::{
        Force, drag, force, gravity, gravity_gradient, gravity_gradient_on_conic, gravity_gradient_on_table,
        torque_body, torque_space,
    };
    #[pymodule_export]
    use super::links::{Link, Links, diagnose};
    #[pymodule_export]
    use super::masses::{MassProperties, mesh, solid};
    #[pymodule_export]
    use super::motions::FreeMotion;
    #[pymodule_export]
    use super::phases::{PhaseDrift, phase};
    #[pymodule_export]
    use super::runs::{methods, run};
    #[pymodule_export]
    use super::samples::Samples;
    #[pymodule_export]
    use super::states::States;
    #[pymodule_export]
    use super::tables::{Record, Trajectory};
    #[pymodule_export]
    use super::through::{FittedMotion, Interpolation, Passage};
    #[pymodule_export]
    use super::tops::LagrangeTop;
    #[pymodule_export]
    use super::wheels::{GyrostatMotion, SteadySpin, Wheel};
}

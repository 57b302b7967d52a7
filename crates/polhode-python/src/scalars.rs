//! Arguments that are one number, each refused by its name: what a double does not hold, truth values and texts, as in arrays.

use pyo3::prelude::*;
use pyo3::types::{PyBool, PyString};

use crate::arrays::Numbers;
use crate::error::refused;

/// The number of the argument `name`.
pub(crate) fn scalar(name: &'static str, value: &Bound<'_, PyAny>) -> PyResult<f64> {
    if value.is_instance_of::<PyBool>() || value.is_instance_of::<PyString>() {
        return Err(refused(format!("{name}: {}; it must be a number", value.repr()?.to_string_lossy())));
    }
    let numbers = Numbers::of(name, value)?;
    match (numbers.shape.as_slice(), numbers.values.as_slice()) {
        ([], &[number]) => Ok(number),
        _ => Err(numbers.unexpected("(), that of a number")),
    }
}

/// How many threads; 0 for one on each core.
pub(crate) fn threads(value: &Bound<'_, PyAny>) -> PyResult<usize> {
    let count = scalar("threads", value)?;
    if count.fract() == 0.0 && (0.0..=f64::from(u16::MAX)).contains(&count) {
        Ok(count as usize)
    } else {
        let most = u16::MAX;
        Err(refused(format!(
            "threads: {count}; it must be a whole number from 0, one on each core, to {most}"
        )))
    }
}

/// A function for each name, that reads the argument of that name for `pyo3`, whose own errors name none.
macro_rules! reading {
    (maybe $($name:ident)*) => {
        $(pub(crate) fn $name(value: &Bound<'_, PyAny>) -> PyResult<Option<f64>> {
            (!value.is_none()).then(|| scalar(stringify!($name), value)).transpose()
        })*
    };
    ($($name:ident)*) => {
        $(pub(crate) fn $name(value: &Bound<'_, PyAny>) -> PyResult<f64> {
            scalar(stringify!($name), value)
        })*
    };
}

/// Of numbers that are there, if only by default.
pub(crate) mod number {
    use super::{Bound, PyAny, PyResult, scalar};

    reading! {
        attitude_error begin bias eccentricity gm inertia linear mass mean_motion noise periapsis quadratic scale_error speed stamps
        start_time step t time tolerance torque turns until
    }
}

/// Of numbers that may be left out.
pub(crate) mod maybe {
    use super::{Bound, PyAny, PyAnyMethods, PyResult, scalar};

    reading! {
        maybe attitude_noise budget carrier_mass density end energy_error gyro_axis_scales gyro_bias gyro_misalignment gyro_scale
        gyro_skew mass momentum noise object_mass prior_sigma proof_sigma quantum radius sample_rate shell skip_rows step
        tolerance trace twice_energy weld
    }
}

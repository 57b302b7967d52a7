//! Derivatives of motions, at many times.

use nalgebra::SMatrix;
use polhode::flow::TurnAxes;
use pyo3::prelude::*;

use crate::arrays::{Numbers, array};
use crate::calm::Listener;
use crate::error::refused;

/// What a derivative is asked for.
#[derive(Clone, Copy)]
pub(crate) struct Asked {
    pub(crate) axes: TurnAxes,
    /// By the angular velocity, or by the momentum.
    pub(crate) by_omega: bool,
}

impl Asked {
    pub(crate) fn of(by: &str, axes: &str) -> PyResult<Self> {
        let by_omega = match by {
            "omega" => true,
            "momentum" => false,
            _ => return Err(refused(format!("by: '{by}'; it must be 'omega' or 'momentum'"))),
        };
        Ok(Asked { axes: turn_axes(axes)?, by_omega })
    }
}

pub(crate) fn turn_axes(text: &str) -> PyResult<TurnAxes> {
    match text {
        "space" => Ok(TurnAxes::Space),
        "body" => Ok(TurnAxes::Body),
        _ => Err(refused(format!("axes: '{text}'; it must be 'space' or 'body'"))),
    }
}

/// What `each` finds at the times `t`, with their shape.
pub(crate) fn at_each<T: Send>(
    t: &Bound<'_, PyAny>,
    each: impl Fn(f64) -> PyResult<T> + Sync,
) -> PyResult<(Vec<usize>, Vec<T>)> {
    let Numbers { shape, values, .. } = Numbers::of("t", t)?;
    let found = t.py().detach(|| {
        let mut listener = Listener::new();
        let heard = |t: &f64| {
            listener.listen(0.0)?;
            each(*t)
        };
        values.iter().map(heard).collect::<PyResult<Vec<T>>>()
    })?;
    Ok((shape, found))
}

/// The matrices that `each` finds at the times `t`, as an array (..., rows, columns).
pub(crate) fn matrices<'py, const R: usize, const C: usize>(
    t: &Bound<'py, PyAny>,
    each: impl Fn(f64) -> PyResult<SMatrix<f64, R, C>> + Sync,
) -> PyResult<Bound<'py, PyAny>> {
    let (shape, found) = at_each(t, each)?;
    let entries = found.iter().flat_map(|matrix| matrix.transpose().as_slice().to_vec()).collect();
    array(t.py(), entries, &[&shape[..], &[R, C]].concat())
}

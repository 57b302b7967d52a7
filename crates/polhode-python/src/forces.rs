//! Forces by name, and those of a Python function.

use nalgebra::{UnitQuaternion, Vector3};
use polhode::body;
use pyo3::prelude::*;

use crate::arrays::{Numbers, array};
use crate::error::refused;

/// A torque or a potential that acts on a body; all add up.
#[pyclass(frozen, from_py_object)]
#[derive(Clone)]
pub(crate) struct Force(pub(crate) body::Force);

#[pymethods]
impl Force {
    /// The same force, acting only during intervals [from, to), s: an array of shape (n, 2). Steps of a run end there.
    fn during(&self, intervals: &Bound<'_, PyAny>) -> PyResult<Self> {
        let intervals: Vec<[f64; 2]> = Numbers::of("intervals", intervals)?.rows(None)?;
        self.0.clone().during(intervals).map(Force).map_err(refused)
    }

    fn __repr__(&self) -> String {
        format!("Force({:?})", self.0.name())
    }
}

fn vector(name: &'static str, value: &Bound<'_, PyAny>) -> PyResult<Vector3<f64>> {
    Ok(Numbers::of(name, value)?.fixed::<3>()?.into())
}

/// Uniform gravity along -z of space on a body with a fixed point: weight times centre of mass, N m, body axes.
#[pyfunction]
pub(crate) fn gravity(weight_moment: &Bound<'_, PyAny>) -> PyResult<Force> {
    body::Force::gravity(vector("weight_moment", weight_moment)?).map(Force).map_err(refused)
}

/// The gravity gradient on an orbit with the mean motion, rad/s, in the x-y plane of space, perigee on +x at t = 0.
#[pyfunction]
#[pyo3(signature = (mean_motion, eccentricity = 0.0))]
pub(crate) fn gravity_gradient(mean_motion: f64, eccentricity: f64) -> PyResult<Force> {
    body::Force::gravity_gradient(mean_motion, eccentricity).map(Force).map_err(refused)
}

/// A torque constant in body axes, N m.
#[pyfunction]
pub(crate) fn torque_body(torque: &Bound<'_, PyAny>) -> PyResult<Force> {
    body::Force::constant_torque_body(vector("torque", torque)?).map(Force).map_err(refused)
}

/// A torque constant in the axes of space, N m.
#[pyfunction]
pub(crate) fn torque_space(torque: &Bound<'_, PyAny>) -> PyResult<Force> {
    body::Force::constant_torque_space(vector("torque", torque)?).map(Force).map_err(refused)
}

/// Drag: the torque -linear ω - quadratic |ω| ω.
#[pyfunction]
#[pyo3(signature = (linear, quadratic = 0.0))]
pub(crate) fn drag(linear: f64, quadratic: f64) -> PyResult<Force> {
    body::Force::drag(linear, quadratic).map(Force).map_err(refused)
}

/// A torque, N m, body axes, by a function of the time (s), the attitude (w, x, y, z) and the angular velocity (rad/s, body axes).
/// Each evaluation calls Python: slow, and one at a time. An exception in it ends the run.
#[pyfunction]
pub(crate) fn force(name: String, torque: Py<PyAny>) -> Force {
    let law = move |t: f64, q: UnitQuaternion<f64>, omega: Vector3<f64>| {
        Python::attach(|py| -> PyResult<Vector3<f64>> {
            let attitude = array(py, vec![q.w, q.i, q.j, q.k], &[4])?;
            let omega = array(py, omega.as_slice().to_vec(), &[3])?;
            vector("torque", &torque.bind(py).call1((t, attitude, omega))?)
        })
        .unwrap_or_else(|error| {
            // seen by the run as a force that is no number, and by Python when it is back
            Python::attach(|py| error.restore(py));
            Vector3::repeat(f64::NAN)
        })
    };
    Force(body::Force::torque_fn(name, law))
}

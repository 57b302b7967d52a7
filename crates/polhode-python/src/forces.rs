//! Forces by name, and those of a Python function.

use std::sync::{Arc, Mutex, PoisonError};

use nalgebra::{UnitQuaternion, Vector3};
use polhode::body::{self, Orbit};
use pyo3::prelude::*;

use crate::arrays::{Numbers, array};
use crate::calm::called;
use crate::error::{of, refused};
use crate::scalars::number;

/// A torque or a potential that acts on a body. Several forces add up.
#[pyclass(frozen, module = "polhode", from_py_object)]
#[derive(Clone)]
pub(crate) struct Force {
    pub(crate) force: body::Force,
    /// Whether the size of the inertia counts under it; under a gravity gradient it does not.
    pub(crate) is_sized: bool,
    /// Of a Python function.
    pub(crate) raised: Option<Raised>,
}

/// The exception of a Python function that was called between steps.
#[derive(Clone, Default)]
pub(crate) struct Raised(Arc<Mutex<Option<PyErr>>>);

impl Raised {
    fn is_any(&self) -> bool {
        self.0.lock().unwrap_or_else(PoisonError::into_inner).is_some()
    }

    fn keep(&self, error: PyErr) {
        self.0.lock().unwrap_or_else(PoisonError::into_inner).get_or_insert(error);
    }

    pub(crate) fn take(&self) -> Option<PyErr> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner).take()
    }
}

impl From<body::Force> for Force {
    fn from(force: body::Force) -> Self {
        Force { force, is_sized: true, raised: None }
    }
}

#[pymethods]
impl Force {
    /// Its name.
    #[getter]
    fn name(&self) -> &str {
        self.force.name()
    }

    /// The same force, acting only during `intervals`, rows of begin and end, s: shape (n, 2). Steps of a run end there.
    fn during(&self, intervals: &Bound<'_, PyAny>) -> PyResult<Self> {
        let intervals: Vec<[f64; 2]> = Numbers::of("intervals", intervals)?.rows(None)?;
        let force = self.force.clone().during(intervals).map_err(of("intervals"))?;
        Ok(Force { force, ..self.clone() })
    }

    fn __repr__(&self) -> String {
        format!("Force({:?})", self.force.name())
    }
}

/// A gravity gradient, which is in proportion to the inertia.
fn gradient(force: body::Force) -> Force {
    Force { is_sized: false, ..force.into() }
}

fn vector(name: &'static str, value: &Bound<'_, PyAny>) -> PyResult<Vector3<f64>> {
    Numbers::of(name, value)?.vector()
}

/// Uniform gravity along -z of space on a body with a fixed point. `weight_moment` is the weight times the centre of mass, N m, body axes.
///
/// >>> from polhode import Body, gravity
/// >>> Body([1, 1, 0.25], [gravity([0, 0, 2])])
/// Body(principal moments 0.25, 1, 1; forces: gravity)
#[pyfunction]
pub(crate) fn gravity(weight_moment: &Bound<'_, PyAny>) -> PyResult<Force> {
    body::Force::gravity(vector("weight_moment", weight_moment)?).map(Force::from).map_err(refused)
}

/// The gravity gradient on an elliptic orbit in the x-y plane of space: mean motion, rad/s, and eccentricity; perigee on +x at t = 0.
#[pyfunction]
#[pyo3(signature = (mean_motion, eccentricity = 0.0))]
pub(crate) fn gravity_gradient(
    #[pyo3(from_py_with = number::mean_motion)] mean_motion: f64,
    #[pyo3(from_py_with = number::eccentricity)] eccentricity: f64,
) -> PyResult<Force> {
    body::Force::gravity_gradient(mean_motion, eccentricity).map(gradient).map_err(refused)
}

/// The gravity gradient on any conic: an ellipse, a parabola or a hyperbola.
///
/// `gm`: gravitational parameter of the attracting mass, m^3/s^2; `periapsis`: least distance from its centre, m; `time`: when the body is
/// there, s; `plane`: longitude of the node, inclination and argument of the periapsis, rad, by default the x-y plane of space with the
/// periapsis on +x.
///
/// >>> from polhode import Body, gravity_gradient_on_conic
/// >>> flyby = gravity_gradient_on_conic(3.986e14, 3.8e7, 4.2, time=86400, plane=[0.3, 0.8, 1.1])
/// >>> Body([0.61, 0.96, 1], [flyby])
/// Body(principal moments 0.61, 0.96, 1; forces: gravity gradient)
#[pyfunction]
#[pyo3(signature = (gm, periapsis, eccentricity, time = 0.0, plane = None))]
pub(crate) fn gravity_gradient_on_conic(
    #[pyo3(from_py_with = number::gm)] gm: f64,
    #[pyo3(from_py_with = number::periapsis)] periapsis: f64,
    #[pyo3(from_py_with = number::eccentricity)] eccentricity: f64,
    #[pyo3(from_py_with = number::time)] time: f64,
    plane: Option<&Bound<'_, PyAny>>,
) -> PyResult<Force> {
    let angles = plane.map(|angles| vector("plane", angles)).transpose()?;
    let orbit = Orbit::conic(gm, periapsis, eccentricity).and_then(|orbit| orbit.passing_at(time)).and_then(
        |orbit| match angles {
            None => Ok(orbit),
            Some(angles) => orbit.in_plane(angles.into()),
        },
    );
    orbit.map(|orbit| gradient(body::Force::gravity_gradient_on(orbit))).map_err(refused)
}

/// The gravity gradient on an orbit that is a table of positions, interpolated by polynomials through eight rows.
///
/// `gm`: gravitational parameter of the attracting mass, m^3/s^2; `t`: ascending times, s, at least eight; `places` (n, 3): positions, m, in
/// the axes of space. A run that leaves the table is refused.
///
/// >>> import numpy
/// >>> from polhode import Body, gravity_gradient_on_table
/// >>> t = numpy.linspace(0, 600, 21)
/// >>> places = 7e6 * numpy.stack([numpy.cos(1e-3 * t), numpy.sin(1e-3 * t), 0 * t], axis=1)
/// >>> Body([0.61, 0.96, 1], [gravity_gradient_on_table(3.986e14, t, places)])
/// Body(principal moments 0.61, 0.96, 1; forces: gravity gradient)
#[pyfunction]
pub(crate) fn gravity_gradient_on_table(
    #[pyo3(from_py_with = number::gm)] gm: f64,
    t: &Bound<'_, PyAny>,
    places: &Bound<'_, PyAny>,
) -> PyResult<Force> {
    let times = Numbers::of("t", t)?.list()?;
    let places = Numbers::of("places", places)?.rows::<3>(Some(times.len()))?;
    let orbit = Orbit::table(gm, &times, &places);
    orbit.map(|orbit| gradient(body::Force::gravity_gradient_on(orbit))).map_err(refused)
}

/// A torque that is constant in body axes, N m.
#[pyfunction]
pub(crate) fn torque_body(torque: &Bound<'_, PyAny>) -> PyResult<Force> {
    body::Force::constant_torque_body(vector("torque", torque)?).map(Force::from).map_err(refused)
}

/// A torque that is constant in the axes of space, N m.
#[pyfunction]
pub(crate) fn torque_space(torque: &Bound<'_, PyAny>) -> PyResult<Force> {
    body::Force::constant_torque_space(vector("torque", torque)?).map(Force::from).map_err(refused)
}

/// Drag: the torque -linear w - quadratic |w| w, where w is the angular velocity; N m s and N m s^2.
#[pyfunction]
#[pyo3(signature = (linear, quadratic = 0.0))]
pub(crate) fn drag(
    #[pyo3(from_py_with = number::linear)] linear: f64,
    #[pyo3(from_py_with = number::quadratic)] quadratic: f64,
) -> PyResult<Force> {
    body::Force::drag(linear, quadratic).map(Force::from).map_err(refused)
}

fn law_of(value: &Bound<'_, PyAny>) -> PyResult<Py<PyAny>> {
    called("torque", "torque(t, attitude, omega)", value)
}

/// A torque of your own: `torque(t, attitude, omega)` returns it in N m, body axes.
///
/// Its arguments are the time, s, the attitude w, x, y, z, body to space, and the angular velocity, rad/s, body axes. Equal arguments must
/// give equal values. Each evaluation calls Python, which is some thousand times slower than the forces of this package. An exception ends
/// the run and is raised again by it.
///
/// >>> import polhode
/// >>> brake = polhode.force("brake", lambda t, attitude, omega: -0.1 * omega)
/// >>> body = polhode.Body([1, 2, 3], [brake])
/// >>> run = polhode.run("rk4", body, [0.4, 1, -0.3], times=[0, 10], step=0.1)
/// >>> bool(run.energy[1] < run.energy[0])
/// True
#[pyfunction]
pub(crate) fn force(name: String, #[pyo3(from_py_with = law_of)] torque: Py<PyAny>) -> Force {
    let raised = Raised::default();
    let keeper = raised.clone();
    let law = move |t: f64, q: UnitQuaternion<f64>, omega: Vector3<f64>| {
        // after an exception no more Python is called; the run sees a force that is no number, and ends
        if keeper.is_any() {
            return Vector3::repeat(f64::NAN);
        }
        let found = Python::attach(|py| -> PyResult<Vector3<f64>> {
            py.check_signals()?;
            let attitude = array(py, vec![q.w, q.i, q.j, q.k], &[4])?;
            let omega = array(py, omega.as_slice().to_vec(), &[3])?;
            vector("torque", &torque.bind(py).call1((t, attitude, omega))?)
        });
        found.unwrap_or_else(|error| {
            keeper.keep(error);
            Vector3::repeat(f64::NAN)
        })
    };
    Force { raised: Some(raised), ..body::Force::torque_fn(name, law).into() }
}

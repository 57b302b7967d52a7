//! Bodies: inertia, and what acts on them.

use polhode::body::State;
use polhode::inertia::Inertia;
use polhode::{body, catalogue};
use pyo3::prelude::*;

use crate::arrays::{Numbers, Order, array, attitude};
use crate::error::refused;
use crate::forces::Force;
use crate::masses::MassProperties;

/// A rigid body: inertia in body axes, kg m², and the forces that act on it.
///
/// `inertia` is three principal moments, a tensor of shape (3, 3), or mass properties, whose tensor about the centre of mass
/// it takes.
///
/// >>> from polhode import Body
/// >>> Body([1, 2, 3]).moments
/// array([1., 2., 3.])
#[pyclass(frozen, from_py_object)]
#[derive(Clone)]
pub(crate) struct Body {
    pub(crate) body: body::Body,
    /// Of a body of the catalogue.
    start: Option<([f64; 4], [f64; 3])>,
}

fn inertia(value: &Bound<'_, PyAny>) -> PyResult<Inertia> {
    if let Ok(mass) = value.extract::<MassProperties>() {
        return mass.0.inertia().map_err(refused);
    }
    let numbers = Numbers::of("inertia", value)?;
    if numbers.shape.len() == 2 {
        return Inertia::from_tensor(numbers.matrix()?).map_err(refused);
    }
    Inertia::from_moments(numbers.fixed()?).map_err(refused)
}

impl Body {
    /// A body, or what one can be made of.
    pub(crate) fn of(value: &Bound<'_, PyAny>) -> PyResult<Self> {
        match value.extract::<Body>() {
            Ok(body) => Ok(body),
            Err(_) => Ok(Body { body: body::Body::free(inertia(value)?), start: None }),
        }
    }

    /// The state with the attitude and either the angular velocity or the angular momentum that are given, body axes; what is
    /// not given is that of the catalogue.
    pub(crate) fn start(
        &self,
        omega: Option<&Bound<'_, PyAny>>,
        momentum: Option<&Bound<'_, PyAny>>,
        turned: Option<&Bound<'_, PyAny>>,
        order: Order,
    ) -> PyResult<State> {
        let known = self.start;
        let attitude = match (turned, known) {
            (None, Some((attitude, _))) => polhode::rotation::Quat::from_components(attitude),
            _ => attitude(turned, order)?,
        };
        let (omega, momentum) = match (omega, momentum, known) {
            (Some(omega), None, _) => (Some(Numbers::of("omega", omega)?.fixed::<3>()?), None),
            (None, Some(momentum), _) => (None, Some(Numbers::of("momentum", momentum)?.fixed::<3>()?)),
            (None, None, Some((_, omega))) => (Some(omega), None),
            (None, None, None) => return Err(refused("omega: missing; give omega or momentum")),
            (Some(_), Some(_), _) => return Err(refused("omega, momentum: give one of the two")),
        };
        let point = match (omega, momentum) {
            (Some(omega), _) => self.body.enter_omega(attitude, omega.into()),
            (_, momentum) => {
                let momentum_body = polhode::rotation::Vec3(momentum.unwrap_or_default());
                self.body.enter(&State { attitude, momentum_body })
            }
        };
        Ok(self.body.leave(&point.map_err(refused)?))
    }
}

#[pymethods]
impl Body {
    #[new]
    #[pyo3(signature = (inertia, forces = Vec::new()))]
    fn new(inertia: &Bound<'_, PyAny>, forces: Vec<Force>) -> PyResult<Self> {
        let Body { body, start } = Body::of(inertia)?;
        Ok(Body { body: forces.into_iter().fold(body, |body, force| body.with(force.0)), start })
    }

    /// The tensor, body axes, kg m².
    #[getter]
    fn tensor<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        array(py, self.body.inertia().tensor().transpose().as_slice().to_vec(), &[3, 3])
    }

    /// Principal moments, ascending, kg m².
    #[getter]
    fn moments<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        array(py, self.body.inertia().principal_moments().to_vec(), &[3])
    }

    /// Names of the forces that act.
    #[getter]
    fn forces(&self) -> Vec<String> {
        self.body.forces().iter().map(|force| force.name().into()).collect()
    }

    fn __repr__(&self) -> String {
        let [a, b, c] = self.body.inertia().principal_moments();
        match self.forces().as_slice() {
            [] => format!("Body(moments [{a:?}, {b:?}, {c:?}])"),
            forces => format!("Body(moments [{a:?}, {b:?}, {c:?}], forces {})", forces.join(", ")),
        }
    }
}

/// The bodies of the catalogue by name, tops among them, each with its forces and its start.
#[pyfunction]
pub(crate) fn bodies() -> PyResult<Vec<(&'static str, Body)>> {
    let all = catalogue::bodies().into_iter().chain(catalogue::tops());
    let one = |named: catalogue::NamedBody| {
        let body = named.body().map_err(refused)?;
        Ok((named.name, Body { body, start: Some((named.attitude, named.omega_body)) }))
    };
    all.map(one).collect()
}

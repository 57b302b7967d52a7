//! Bodies: inertia, what acts on it, and a start.

use polhode::body::{Point, State, WheelAtStart};
use polhode::inertia::Inertia;
use polhode::num::Dd;
use polhode::rotation::{Quat, Vec3};
use polhode::{body, catalogue};
use polhode_files::bodies;
use polhode_pages::table::to_digits;
use pyo3::prelude::*;
use pyo3::types::PyString;

use crate::arrays::{Numbers, Order, array, attitude, matrix};
use crate::error::{of, refused};
use crate::files::heard;
use crate::forces::{Force, Raised};
use crate::links::Link;
use crate::masses::MassProperties;
use crate::wheels::Wheel;

/// A rigid body: its inertia, the forces that act on it, and the wheels that it carries.
///
/// `inertia` is one of these:
///
/// - three principal moments, kg m^2; the k-th belongs to the k-th body axis
/// - a tensor (3, 3) in body axes, kg m^2, with entries I_xy = -int x y dm
/// - mass properties or a link of a robot model, whose tensor about the centre of mass is taken
/// - a text as `polhode.body` takes it, such as "toutatis" or "robot.urdf:forearm"
///
/// >>> from polhode import Body
/// >>> Body([1, 2, 3]).tensor
/// array([[1., 0., 0.],
///        [0., 2., 0.],
///        [0., 0., 3.]])
/// >>> Body([1, 2, 4])
/// Traceback (most recent call last):
///     ...
/// polhode.PolhodeError: inertia: principal moments 1, 2, 4 violate I1 + I2 >= I3 by 1 (25.000 % of the largest); no mass distribution has them
#[pyclass(frozen, module = "polhode", from_py_object)]
#[derive(Clone)]
pub(crate) struct Body {
    pub(crate) body: body::Body,
    pub(crate) named: Option<Box<catalogue::NamedBody>>,
    /// Of a mesh, why nothing may act on it under which its size counts.
    sizeless: Option<String>,
    raised: Vec<Raised>,
}

/// The inertia of whatever states one.
pub(crate) fn inertia(name: &'static str, value: &Bound<'_, PyAny>) -> PyResult<Inertia> {
    if let Ok(mass) = value.extract::<MassProperties>() {
        return mass.0.inertia().map_err(of(name));
    }
    if let Ok(link) = value.cast::<Link>() {
        return link.get().properties()?.inertia().map_err(of(name));
    }
    let numbers = Numbers::of(name, value)?;
    match numbers.shape.as_slice() {
        [3] => Inertia::from_moments(numbers.fixed()?).map_err(of(name)),
        [3, 3] => Inertia::from_tensor(numbers.matrix()?).map_err(of(name)),
        _ => Err(numbers.unexpected("(3,) or (3, 3)")),
    }
}

impl From<Inertia> for Body {
    fn from(inertia: Inertia) -> Self {
        Body { body: body::Body::free(inertia), named: None, sizeless: None, raised: Vec::new() }
    }
}

impl Body {
    /// A body, or what one can be made of.
    pub(crate) fn of(name: &'static str, value: &Bound<'_, PyAny>) -> PyResult<Self> {
        if let Ok(body) = value.extract::<Body>() {
            return Ok(body);
        }
        match value.cast::<PyString>() {
            Ok(text) => by_name(value.py(), &text.to_string_lossy()),
            Err(_) => inertia(name, value).map(Body::from),
        }
    }

    /// The start in the solver frame with the attitude and either the angular velocity or the angular momentum that are given, body
    /// axes; what is not given is that of the catalogue.
    pub(crate) fn start(&self, given: &Start<'_, '_>) -> PyResult<Point<Dd>> {
        let known = self.named.as_deref();
        let attitude = match (given.attitude, known) {
            (None, Some(known)) => Quat::from_components(known.attitude),
            (turned, _) => attitude(turned, given.order)?,
        };
        match (given.omega, given.momentum) {
            (Some(_), Some(_)) => Err(refused("omega, momentum: give one of the two")),
            (None, Some(momentum)) => {
                let momentum = Vec3(Numbers::of("momentum", momentum)?.fixed()?);
                let momentum_body = momentum - self.body.momentum_of_wheels_at(given.time).into();
                self.body.enter(&State { attitude, momentum_body }).map_err(refused)
            }
            (omega, None) => {
                let omega = match (omega, known) {
                    (Some(omega), _) => Numbers::of("omega", omega)?.fixed()?,
                    (None, Some(known)) => known.omega_body,
                    (None, None) => {
                        return Err(refused(
                            "omega: missing; give omega or momentum; bodies of the catalogue have a start",
                        ));
                    }
                };
                self.body.enter_omega(attitude, Vec3(omega)).map_err(refused)
            }
        }
    }

    /// What was found, unless a Python function that acts on the body raised an exception meanwhile.
    pub(crate) fn settle<T>(&self, found: PyResult<T>) -> PyResult<T> {
        match self.raised.iter().filter_map(Raised::take).next() {
            Some(error) => Err(error),
            None => found,
        }
    }
}

/// A start as it is given.
#[derive(Clone, Copy)]
pub(crate) struct Start<'a, 'py> {
    pub(crate) omega: Option<&'a Bound<'py, PyAny>>,
    pub(crate) attitude: Option<&'a Bound<'py, PyAny>>,
    pub(crate) momentum: Option<&'a Bound<'py, PyAny>>,
    /// When it is, s: a motor changes the momentum of its wheel.
    pub(crate) time: f64,
    pub(crate) order: Order,
}

#[pymethods]
impl Body {
    #[new]
    #[pyo3(signature = (inertia, forces = None, *, wheels = None))]
    fn new(
        inertia: &Bound<'_, PyAny>,
        forces: Option<Vec<Force>>,
        wheels: Option<Vec<Wheel>>,
    ) -> PyResult<Self> {
        let Body { mut body, named, sizeless, mut raised } = Body::of("inertia", inertia)?;
        let (forces, wheels) = (forces.unwrap_or_default(), wheels.unwrap_or_default());
        if !wheels.is_empty() || forces.iter().any(|force| force.is_sized) {
            if let Some(reason) = &sizeless {
                return Err(refused(reason));
            }
            if let Some(name) = named.as_ref().map(|named| named.name) {
                heard(inertia.py(), move || bodies::check_size("inertia", name))?;
            }
        }
        for Wheel(wheel) in wheels {
            body = body.with_wheel(wheel).map_err(of("wheels"))?;
        }
        for Force { force, raised: own, .. } in forces {
            body = body.with(force);
            raised.extend(own);
        }
        Ok(Body { body, named, sizeless, raised })
    }

    /// The inertia tensor in body axes, kg m^2. It includes wheels, as if they were at rest on the body.
    #[getter]
    fn tensor<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        matrix(py, &self.body.locked_inertia().tensor())
    }

    /// Principal moments of that tensor, ascending, kg m^2.
    #[getter]
    fn principal_moments<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        array(py, self.body.locked_inertia().principal_moments().to_vec(), &[3])
    }

    /// The wheels that it carries.
    #[getter]
    fn wheels(&self) -> Vec<Wheel> {
        self.body.wheels().iter().copied().map(Wheel).collect()
    }

    /// Names of the forces that act on it.
    #[getter]
    fn forces(&self) -> Vec<String> {
        self.body.forces().iter().map(|force| force.name().into()).collect()
    }

    /// Its name in the catalogue.
    #[getter]
    fn name(&self) -> Option<&'static str> {
        self.named.as_ref().map(|named| named.name)
    }

    /// For a body of the catalogue: what it is, and where its moments come from.
    #[getter]
    fn source(&self) -> Option<String> {
        self.named.as_ref().map(|named| format!("{}; {}", named.summary, named.source))
    }

    /// For a body of the catalogue: angular velocity at the start of its published motion, body axes, rad/s.
    #[getter]
    fn omega<'py>(&self, py: Python<'py>) -> PyResult<Option<Bound<'py, PyAny>>> {
        self.named.as_ref().map(|named| array(py, named.omega_body.to_vec(), &[3])).transpose()
    }

    /// For a body of the catalogue: attitude at the start of its published motion, w, x, y, z, body to space.
    #[getter]
    fn attitude<'py>(&self, py: Python<'py>) -> PyResult<Option<Bound<'py, PyAny>>> {
        self.named.as_ref().map(|named| array(py, named.attitude.to_vec(), &[4])).transpose()
    }

    /// Frame and date of that attitude, or that it is not known, in words.
    #[getter]
    fn attitude_known(&self) -> Option<String> {
        self.named.as_ref().map(|named| named.attitude_known())
    }

    fn __repr__(&self) -> String {
        let [a, b, c] = self.body.locked_inertia().principal_moments().map(|moment| to_digits(moment, 6));
        let of = self.named.as_ref().map_or(String::new(), |named| format!("{}; ", named.name));
        let forces = match self.forces().as_slice() {
            [] => String::new(),
            forces => format!("; forces: {}", forces.join(", ")),
        };
        let wheels = match self.body.wheels().len() {
            0 => String::new(),
            wheels => format!("; wheels: {wheels}"),
        };
        format!("Body({of}principal moments {a}, {b}, {c}{wheels}{forces})")
    }
}

/// A body of the catalogue by name, with its start and its wheels; or a body of a file, as "FILE" or "FILE:LINK".
///
/// A mesh is taken with 1 kg/m^3, so that only the ratios of its moments are known: wheels and forces are refused, except a gravity gradient,
/// whose effect does not depend on the size of the tensor. A tensor that is valid but suspicious, as with an implausible density, brings a
/// `PolhodeWarning`.
///
/// >>> import polhode
/// >>> polhode.body("toutatis")
/// Body(toutatis; principal moments 1, 3.0836, 3.235)
/// >>> polhode.body("toutatsi")
/// Traceback (most recent call last):
///     ...
/// polhode.PolhodeError: body: 'toutatsi': no such body; did you mean 'toutatis'?
#[pyfunction(name = "body")]
pub(crate) fn named_body(py: Python<'_>, name: &str) -> PyResult<Body> {
    by_name(py, name)
}

fn by_name(py: Python<'_>, text: &str) -> PyResult<Body> {
    if let Some(named) = catalogue::body(text).or_else(|| catalogue::top(text)) {
        let body = named.body().map_err(refused)?;
        return Ok(Body { body, named: Some(Box::new(named)), sizeless: None, raised: Vec::new() });
    }
    let name = text.to_string();
    if let Some((inertia, wheels)) = heard(py, move || bodies::inertia("body", &name))? {
        if !wheels.iter().all(WheelAtStart::is_held) {
            return Err(refused(format!(
                "body: '{text}': the momentum of a wheel that is free or driven depends on the start; give it as Wheel(...).free(omega)"
            )));
        }
        let sizeless = bodies::check_size("body", text).err().map(|error| error.to_string());
        let Body { mut body, named, raised, .. } = Body::from(inertia);
        for wheel in &wheels {
            body = body.with_wheel(wheel.at_speed()).map_err(of("body"))?;
        }
        return Ok(Body { body, named, sizeless, raised });
    }
    if text.contains(['.', '/']) {
        let rule = "no such file, and no such body in the catalogue";
        return Err(refused(polhode_files::Error::input(
            "body",
            text,
            rule,
            "polhode.bodies() lists the catalogue",
        )));
    }
    Err(refused(polhode_files::Error::unknown_name("body", "body", text, names().iter().copied())))
}

fn names() -> Vec<&'static str> {
    catalogue::bodies().iter().chain(&catalogue::tops()).map(|body| body.name).collect()
}

/// The names of the bodies of the catalogue, tops last.
#[pyfunction(name = "bodies")]
pub(crate) fn catalogue_names() -> Vec<&'static str> {
    names()
}

//! Inertia: solids, meshes, what is wrong with a tensor, links of models.

use nalgebra::{Matrix3, Vector3};
use polhode::inertia::{self, Amount, Closing, FLOAT_WELD, Solid, Surface};
use polhode_files::examined::{Examined, Worth};
use polhode_files::given::Given;
use polhode_files::text::short;
use polhode_pages::table::{Cell, Column, Table, row};
use pyo3::exceptions::{PyKeyError, PyTypeError};
use pyo3::prelude::*;
use pyo3::types::{PyIterator, PyList};

use crate::arrays::{Numbers, Order, array, matrix, rotation};
use crate::error::{of, refused};

/// Mass, kg, centre of mass, m, and inertia tensor about it, kg m^2, in the axes of one frame. Points, rods and plates have them too.
///
/// `tensor` is about the centre of mass, with entries I_xy = -int x y dm.
///
/// >>> from polhode import solid
/// >>> bar = solid("cylinder", [0.005, 0.08], density=2700)
/// >>> dumbbell = solid("sphere", [0.02], mass=1).moved([0, 0, 0.05]) + solid("sphere", [0.02], mass=1).moved([0, 0, -0.05]) + bar
/// >>> round(dumbbell.mass, 6)
/// 2.016965
#[pyclass(frozen, module = "polhode", from_py_object)]
#[derive(Clone)]
pub(crate) struct MassProperties(pub(crate) inertia::MassProperties);

#[pymethods]
impl MassProperties {
    #[new]
    #[pyo3(signature = (mass, center_of_mass, tensor, *, about = None))]
    fn new(
        mass: f64,
        center_of_mass: &Bound<'_, PyAny>,
        tensor: &Bound<'_, PyAny>,
        about: Option<&Bound<'_, PyAny>>,
    ) -> PyResult<Self> {
        let center = Numbers::of("center_of_mass", center_of_mass)?.vector()?;
        let tensor = Numbers::of("tensor", tensor)?.matrix()?;
        let found = match about {
            None => inertia::MassProperties::new(mass, center, tensor),
            Some(about) => {
                let about = Numbers::of("about", about)?.vector()?;
                inertia::MassProperties::from_tensor_about(about, mass, center, tensor)
            }
        };
        found.map(MassProperties).map_err(refused)
    }

    /// Mass, kg.
    #[getter]
    fn mass(&self) -> f64 {
        self.0.mass()
    }

    /// Centre of mass, m.
    #[getter]
    fn center_of_mass<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        array(py, self.0.center_of_mass().as_slice().to_vec(), &[3])
    }

    /// Tensor about the centre of mass, kg m^2.
    #[getter]
    fn tensor<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        matrix(py, &self.0.tensor())
    }

    /// Tensor about the point, m, kg m^2.
    fn tensor_about<'py>(&self, point: &Bound<'py, PyAny>) -> PyResult<Bound<'py, PyAny>> {
        let tensor = self.0.tensor_about(Numbers::of("point", point)?.vector()?).map_err(of("point"))?;
        matrix(point.py(), &tensor)
    }

    /// Principal moments about the centre of mass, ascending, kg m^2.
    #[getter]
    fn principal_moments<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        array(py, self.0.principal_moments().to_vec(), &[3])
    }

    /// The rotation from principal axes to those of the frame, w, x, y, z.
    #[getter]
    fn axes<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        let q = self.0.principal_axes();
        array(py, vec![q.w, q.i, q.j, q.k], &[4])
    }

    /// What the moments say of the shape, in one word.
    #[getter]
    fn shape(&self) -> &'static str {
        self.0.class().name()
    }

    /// By how much the sum of the other two principal moments exceeds each, kg m^2.
    #[getter]
    fn triangle_margins<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        array(py, self.0.triangle_margins().to_vec(), &[3])
    }

    /// The same body, shifted by a vector, m.
    fn moved(&self, by: &Bound<'_, PyAny>) -> PyResult<Self> {
        self.0.moved(Numbers::of("by", by)?.vector()?).map(MassProperties).map_err(of("by"))
    }

    /// The same body, turned about the origin by a quaternion or a scipy rotation.
    #[pyo3(signature = (by, *, order = "wxyz"))]
    fn turned(&self, by: &Bound<'_, PyAny>, order: &str) -> PyResult<Self> {
        Ok(MassProperties(self.0.turned(rotation(by, Order::of(order)?)?)))
    }

    fn __add__(&self, other: &Self) -> PyResult<Self> {
        inertia::MassProperties::sum([self.0, other.0]).map(MassProperties).map_err(refused)
    }

    fn __repr__(&self) -> String {
        let [x, y, z] = [0, 1, 2].map(|k| short(self.0.center_of_mass()[k]));
        let [a, b, c] = self.0.principal_moments().map(short);
        format!(
            "MassProperties(mass {} kg; centre of mass {x}, {y}, {z} m; principal moments {a}, {b}, {c} kg m^2; {})",
            short(self.0.mass()),
            self.0.class().name()
        )
    }
}

/// How much matter there is.
pub(crate) fn amount(mass: Option<f64>, density: Option<f64>) -> PyResult<Amount> {
    match (mass, density) {
        (Some(mass), None) => Ok(Amount::Mass(mass)),
        (None, Some(density)) => Ok(Amount::Density(density)),
        (None, None) => Err(refused("mass: missing; give mass, kg, or density, kg/m^3")),
        (Some(_), Some(_)) => Err(refused("mass, density: give one of the two")),
    }
}

/// A homogeneous shape of closed form, m: its symmetry axis is z, a rod lies along z.
///
/// `box` [LX, LY, LZ], `ellipsoid` [A, B, C] (semi-axes), `sphere` [R], `shell` [R], `cylinder` [R, H], `tube` [R1, R2, H], `cone` [R, H],
/// `torus` [R, r], `rod` [L], `disk` [R], `plate` [LX, LY], `hoop` [R], `capsule` [R, L]; a mass, kg, or a density, kg/m^3 of a solid,
/// kg/m^2 of a surface, kg/m of a line.
///
/// >>> from polhode import solid
/// >>> solid("box", [0.1467, 0.0715, 0.0077], mass=0.164).principal_moments * 1e6
/// array([ 70.67771333, 294.92912667, 363.98624667])
#[pyfunction]
#[pyo3(signature = (name, sizes, *, mass = None, density = None))]
pub(crate) fn solid(
    name: &str,
    sizes: &Bound<'_, PyAny>,
    mass: Option<f64>,
    density: Option<f64>,
) -> PyResult<MassProperties> {
    let sizes = Numbers::of("sizes", sizes)?.list()?;
    let solid = Solid::named(name, &sizes).map_err(refused)?;
    solid.with(amount(mass, density)?).map(MassProperties).map_err(refused)
}

/// The ways in which a hole of a mesh is closed, by name.
pub(crate) fn closing(name: Option<&str>) -> PyResult<Option<Closing>> {
    match name {
        None => Ok(None),
        Some("fan") => Ok(Some(Closing::Fan)),
        Some("hull") => Ok(Some(Closing::Hull)),
        Some(other) => Err(refused(format!("close: '{other}'; it must be 'fan' or 'hull'"))),
    }
}

/// What a mesh of triangles encloses: vertices of shape (n, 3), m, and the indices of corners of shape (m, 3), counterclockwise as
/// seen from outside. Files are read by `read`.
///
/// >>> from polhode import mesh
/// >>> corners = [[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]]
/// >>> mesh(corners, [[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]], density=6).mass
/// 1.0
#[pyfunction]
#[pyo3(signature = (vertices, triangles, *, mass = None, density = None, close = None))]
pub(crate) fn mesh(
    vertices: &Bound<'_, PyAny>,
    triangles: &Bound<'_, PyAny>,
    mass: Option<f64>,
    density: Option<f64>,
    close: Option<&str>,
) -> PyResult<MassProperties> {
    let vertices: Vec<[f64; 3]> = Numbers::of("vertices", vertices)?.rows(None)?;
    let corners: Vec<[f64; 3]> = Numbers::of("triangles", triangles)?.rows(None)?;
    let (amount, close) = (amount(mass, density)?, closing(close)?);
    let vertex = |index: f64| -> PyResult<Vector3<f64>> {
        let found = (index.fract() == 0.0 && index >= 0.0).then(|| vertices.get(index as usize)).flatten();
        let missing =
            || refused(format!("triangles: {index} is no index of a vertex; there are {}", vertices.len()));
        found.map(|found| Vector3::from(*found)).ok_or_else(missing)
    };
    let all: Vec<[Vector3<f64>; 3]> = corners
        .into_iter()
        .map(|[a, b, c]| Ok([vertex(a)?, vertex(b)?, vertex(c)?]))
        .collect::<PyResult<_>>()?;
    let found = triangles.py().detach(move || {
        let surface = Surface::new(all)?;
        match close {
            Some(how) => surface.closed(FLOAT_WELD, how),
            None => surface.mended(FLOAT_WELD),
        }
    });
    let (mesh, _) = found.map_err(refused)?;
    mesh.with(amount).map(MassProperties).map_err(refused)
}

/// A body as a file or an array states it, with what the examination of its tensor found.
#[pyclass(frozen, module = "polhode")]
pub(crate) struct Link(pub(crate) Examined);

impl Link {
    /// What a body of it has.
    pub(crate) fn properties(&self) -> PyResult<inertia::MassProperties> {
        self.0.body.ok_or_else(|| refused(self.0.report()))
    }
}

#[pymethods]
impl Link {
    /// Its name; empty of a tensor that was typed.
    #[getter]
    fn name(&self) -> String {
        self.0.name()
    }

    /// `valid`, `suspicious`, `invalid` or `massless`.
    #[getter]
    fn verdict(&self) -> &'static str {
        self.0.worth().name()
    }

    /// Which law is broken and by how much.
    #[getter]
    fn trouble(&self) -> Option<String> {
        self.0.trouble()
    }

    /// The probable cause, or the two between which nothing decides.
    #[getter]
    fn cause(&self) -> Option<String> {
        self.0.cause()
    }

    /// The tensor without the mistake that is the likeliest cause; `None` where there is none.
    #[getter]
    fn corrected<'py>(&self, py: Python<'py>) -> PyResult<Option<Bound<'py, PyAny>>> {
        let first = self.0.diagnosis.as_ref().and_then(|found| found.causes.first());
        first.map(|first| matrix(py, &first.corrected)).transpose()
    }

    /// The nearest valid tensor.
    #[getter]
    fn nearest<'py>(&self, py: Python<'py>) -> PyResult<Option<Bound<'py, PyAny>>> {
        self.0.diagnosis.as_ref().map(|found| matrix(py, &found.nearest)).transpose()
    }

    /// Mass, kg, where it is stated.
    #[getter]
    fn mass(&self) -> Option<f64> {
        self.0.given.mass
    }

    /// Centre of mass in the axes of the frame, m.
    #[getter]
    fn center_of_mass<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        array(py, self.0.given.center_of_mass.as_slice().to_vec(), &[3])
    }

    /// Tensor about the centre of mass, kg m^2, in the axes of the frame; of an invalid one in its own.
    #[getter]
    fn tensor<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        let found: Matrix3<f64> = self.0.body.map_or(self.0.given.tensor, |body| body.tensor());
        matrix(py, &found)
    }

    /// Principal moments, ascending, kg m^2.
    #[getter]
    fn principal_moments<'py>(&self, py: Python<'py>) -> PyResult<Option<Bound<'py, PyAny>>> {
        let found = self.0.diagnosis.as_ref();
        let moments =
            found.map(|found| self.0.body.map_or(found.principal_moments, |body| body.principal_moments()));
        moments.map(|moments| array(py, moments.to_vec(), &[3])).transpose()
    }

    /// What a body of it has; refused of an invalid one.
    #[getter(properties)]
    fn mass_properties(&self) -> PyResult<MassProperties> {
        if self.0.given.mass.is_none() {
            return Err(refused("mass: unknown; the file or the call states none"));
        }
        self.properties().map(MassProperties)
    }

    /// Everything that is to be said of it.
    fn __repr__(&self) -> String {
        match self.0.worth() {
            Worth::Valid => {
                let [a, b, c] = self.0.body.map_or([f64::NAN; 3], |body| body.principal_moments()).map(short);
                let name = self.0.name();
                let of = if name.is_empty() { "the tensor".into() } else { name };
                format!("{of}: valid; principal moments {a}, {b}, {c} kg m^2")
            }
            Worth::Massless => format!("{}: massless", self.0.name()),
            _ => self.0.report(),
        }
    }
}

/// What is wrong with a tensor, and what probably happened: entries I_xy = -int x y dm about the centre of mass, kg m^2.
///
/// All else is optional and narrows the causes down: the mass, kg; the centre of mass as seen from the origin of the frame, m; the
/// edges of the box around the body along the axes of the tensor, m.
///
/// >>> from polhode import diagnose
/// >>> found = diagnose([[0.75, 0.3125, 0.3125], [0.3125, 0.75, 0.3125], [0.3125, 0.3125, 0.75]])
/// >>> found.verdict, found.cause
/// ('invalid', 'the products have the other sign: +int xy dm where I_xy = -int xy dm belongs')
#[pyfunction]
#[pyo3(signature = (tensor, *, mass = None, center_of_mass = None, extents = None))]
pub(crate) fn diagnose(
    tensor: &Bound<'_, PyAny>,
    mass: Option<f64>,
    center_of_mass: Option<&Bound<'_, PyAny>>,
    extents: Option<&Bound<'_, PyAny>>,
) -> PyResult<Link> {
    let tensor = Numbers::of("tensor", tensor)?.matrix()?;
    let center = Numbers::maybe("center_of_mass", center_of_mass)?.map(Numbers::vector).transpose()?;
    let extents = Numbers::maybe("extents", extents)?.map(Numbers::fixed).transpose()?;
    let center_of_mass = center.unwrap_or_default();
    let given = Given { mass, center_of_mass, extents, ..Given::of_tensor(tensor) };
    Examined::of(given, None).map(Link).map_err(refused)
}

/// The links of a robot model, or the bodies of a file, by name and by number.
#[pyclass(frozen, module = "polhode")]
pub(crate) struct Links(pub(crate) Vec<Py<Link>>);

#[pymethods]
impl Links {
    /// Their names, in the order of the file.
    fn keys(&self) -> Vec<String> {
        self.0.iter().map(|link| link.get().name()).collect()
    }

    fn __len__(&self) -> usize {
        self.0.len()
    }

    fn __iter__<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyIterator>> {
        PyList::new(py, &self.0)?.try_iter()
    }

    fn __contains__(&self, key: &str) -> bool {
        self.0.iter().any(|link| link.get().name() == key)
    }

    fn __getitem__(&self, py: Python<'_>, key: &Bound<'_, PyAny>) -> PyResult<Py<Link>> {
        if let Ok(place) = key.extract::<isize>() {
            let place = if place < 0 { place + self.0.len() as isize } else { place };
            let found = usize::try_from(place).ok().and_then(|place| self.0.get(place));
            return found.map(|link| link.clone_ref(py)).ok_or_else(|| {
                pyo3::exceptions::PyIndexError::new_err(format!("there are {} bodies", self.0.len()))
            });
        }
        let Ok(name) = key.extract::<String>() else {
            return Err(PyTypeError::new_err("a link is named by a text or by its number"));
        };
        let mut found = self.0.iter().filter(|link| link.get().name() == name);
        match (found.next(), found.count()) {
            (Some(link), 0) => Ok(link.clone_ref(py)),
            (Some(_), more) => {
                Err(refused(format!("{} links are called '{name}'; name one by its number", more + 1)))
            }
            (None, _) => {
                let keys = self.keys();
                let error = polhode_files::Error::unknown_name(
                    "link",
                    "link",
                    &name,
                    keys.iter().map(String::as_str),
                );
                Err(PyKeyError::new_err(error.to_string()))
            }
        }
    }

    fn __repr__(&self) -> String {
        let columns = vec![
            Column::new("name", "", ""),
            Column::new("mass", "kg", "").digits(5),
            Column::new("I1", "kg m^2", "").digits(5),
            Column::new("I2", "kg m^2", "").digits(5),
            Column::new("I3", "kg m^2", "").digits(5),
            Column::new("verdict", "", ""),
            Column::new("trouble", "", ""),
        ];
        let mut table = Table::new("links", "Links.", columns);
        for link in &self.0 {
            let link = &link.get().0;
            let moments = link.diagnosis.as_ref().map(|found| found.principal_moments);
            let moments = [0, 1, 2].map(|k| Cell::from(moments.map(|moments| moments[k])));
            let [a, b, c] = moments;
            table.push(row![link.name(), link.given.mass, a, b, c, link.worth().name(), link.trouble()]);
        }
        table.terminal().trim_end().into()
    }
}

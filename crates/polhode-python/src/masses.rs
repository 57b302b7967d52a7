//! Inertia: solids and meshes.

use nalgebra::Vector3;
use polhode::inertia::{self, Amount, Closing, FLOAT_WELD, MeshError, Solid, Surface};
use polhode_files::mesh::findings;
use polhode_files::text::short;
use pyo3::prelude::*;

use crate::arrays::{Numbers, Order, array, matrix, rotation};
use crate::calm::aside;
use crate::error::{of, refused, warn};
use crate::scalars::{maybe, number};

/// Mass, kg, centre of mass, m, and inertia tensor about it, kg m^2, in the axes of one frame. Points, rods and plates have them too.
///
/// `tensor` is about the centre of mass unless `about` names another point, m; its entries are I_xy = -int x y dm.
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
        #[pyo3(from_py_with = number::mass)] mass: f64,
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

    /// Tensor about `point`, m, in kg m^2.
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

    /// What the moments say of the shape: `point`, `linear`, `planar`, `asymmetric`, `prolate`, `oblate` or `spherical`.
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
        Ok(MassProperties(self.0.turned(rotation("by", by, Order::of(order)?)?)))
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

/// Mass properties of a homogeneous shape. Sizes are in m; the symmetry axis, and a rod, lie along z.
///
/// Shapes and `sizes`: `box` [LX, LY, LZ], `ellipsoid` [A, B, C] (semi-axes), `sphere` [R], `shell` [R], `cylinder` [R, H], `tube` [R1, R2, H],
/// `cone` [R, H], `torus` [R, r], `rod` [L], `disk` [R], `plate` [LX, LY], `hoop` [R], `capsule` [R, H] (H without the caps). Give `mass`, kg, or
/// `density`: kg/m^3 of a solid, kg/m^2 of a surface, kg/m of a line.
///
/// >>> from polhode import solid
/// >>> solid("box", [0.1467, 0.0715, 0.0077], mass=0.164).principal_moments * 1e6
/// array([ 70.67771333, 294.92912667, 363.98624667])
#[pyfunction]
#[pyo3(signature = (name, sizes, *, mass = None, density = None))]
pub(crate) fn solid(
    name: &str,
    sizes: &Bound<'_, PyAny>,
    #[pyo3(from_py_with = maybe::mass)] mass: Option<f64>,
    #[pyo3(from_py_with = maybe::density)] density: Option<f64>,
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

/// Mass properties of the body that a mesh of triangles encloses.
///
/// `vertices` (n, 3), m, and `triangles` (m, 3), the indices of their corners, counterclockwise as seen from outside; with `mass`, kg, or
/// `density`, kg/m^3. A warning says what was mended, such as triangles that were turned over. An open mesh is refused unless `close` says how
/// to close it: "fan" closes each hole by triangles from its middle, "hull" takes the convex hull. `read` reads files of meshes.
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
    #[pyo3(from_py_with = maybe::mass)] mass: Option<f64>,
    #[pyo3(from_py_with = maybe::density)] density: Option<f64>,
    close: Option<&str>,
) -> PyResult<MassProperties> {
    let vertices: Vec<[f64; 3]> = Numbers::of("vertices", vertices)?.rows(None)?;
    let corners: Vec<[f64; 3]> = Numbers::of("triangles", triangles)?.rows(None)?;
    let (amount, close) = (amount(mass, density)?, closing(close)?);
    let vertex = |index: f64| -> PyResult<Vector3<f64>> {
        let found = (index.fract() == 0.0 && index >= 0.0).then(|| vertices.get(index as usize)).flatten();
        let missing = || {
            refused(format!("triangles: {index} is not the index of a vertex; there are {}", vertices.len()))
        };
        found.map(|found| Vector3::from(*found)).ok_or_else(missing)
    };
    let all: Vec<[Vector3<f64>; 3]> = corners
        .into_iter()
        .map(|[a, b, c]| Ok([vertex(a)?, vertex(b)?, vertex(c)?]))
        .collect::<PyResult<_>>()?;
    let py = triangles.py();
    let found = aside(py, move |_| {
        let surface = Surface::new(all)?;
        let (mesh, repairs) = match close {
            Some(how) => surface.closed(FLOAT_WELD, how),
            None => surface.mended(FLOAT_WELD),
        }?;
        let said = findings(&surface, &mesh, &repairs);
        Ok::<_, MeshError>((mesh, said))
    })?;
    let (mesh, said) = found.map_err(refused)?;
    said.iter().try_for_each(|said| warn(py, &format!("triangles: {said}")))?;
    mesh.with(amount).map(MassProperties).map_err(refused)
}

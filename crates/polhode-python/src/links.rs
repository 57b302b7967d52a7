//! Links of models, and what is wrong with a tensor.

use nalgebra::Matrix3;
use polhode::inertia;
use polhode_files::examined::{Examined, Worth};
use polhode_files::given::Given;
use polhode_files::text::short;
use polhode_pages::table::{Cell, Column, Table, row};
use pyo3::exceptions::{PyKeyError, PyTypeError};
use pyo3::prelude::*;
use pyo3::types::{PyIterator, PyList};

use crate::arrays::{Numbers, array, matrix};
use crate::error::refused;
use crate::masses::MassProperties;
use crate::scalars::maybe;

/// A body as a file or an array states it, with the verdict on its tensor.
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
    /// Its name; empty for a tensor that was given as an array.
    #[getter]
    fn name(&self) -> String {
        self.0.name()
    }

    /// `valid`, `suspicious`, `invalid` or `massless`.
    #[getter]
    fn verdict(&self) -> &'static str {
        self.0.worth().name()
    }

    /// Which law the tensor violates, and by how much; `None` if it is valid.
    #[getter]
    fn trouble(&self) -> Option<String> {
        self.0.trouble()
    }

    /// The probable cause, or two that are equally likely.
    #[getter]
    fn cause(&self) -> Option<String> {
        self.0.cause()
    }

    /// The tensor without its probable mistake; `None` if no cause was found.
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

    /// Tensor about the centre of mass, kg m^2, in the axes of the frame; an invalid tensor is in its own axes.
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

    /// Mass, centre of mass and tensor; refused if the tensor is invalid.
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

/// What is wrong with a tensor, and the probable cause. Entries are I_xy = -int x y dm about the centre of mass, kg m^2.
///
/// All else is optional and helps to find the cause: `mass`, kg; `center_of_mass`, from the origin of the frame, m; `extents`, the edges of the
/// bounding box along the axes of the tensor, m.
///
/// >>> from polhode import diagnose
/// >>> found = diagnose([[0.75, 0.3125, 0.3125], [0.3125, 0.75, 0.3125], [0.3125, 0.3125, 0.75]])
/// >>> found.verdict, found.cause
/// ('invalid', 'the products have the other sign: +int xy dm instead of I_xy = -int xy dm')
#[pyfunction]
#[pyo3(signature = (tensor, *, mass = None, center_of_mass = None, extents = None))]
pub(crate) fn diagnose(
    tensor: &Bound<'_, PyAny>,
    #[pyo3(from_py_with = maybe::mass)] mass: Option<f64>,
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

/// The links of a robot model, or the bodies of a file: by name, as in `links["forearm"]`, or by number.
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

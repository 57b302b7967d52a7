//! Attitudes and angular velocities at many times.

use polhode::rotation::Quat;
use polhode_pages::table::{Cell, Column, Table};
use pyo3::prelude::*;
use pyo3::types::{PyIterator, PyTuple};

use crate::arrays::{Order, array, scipy_rotation};
use crate::shown;

/// Attitudes and angular velocities at one time, or at an array of times.
///
/// It unpacks as the pair `attitude, omega`.
#[pyclass(frozen, module = "polhode")]
pub(crate) struct States {
    held: Held,
    order: Order,
}

enum Held {
    One { t: f64, attitude: [f64; 4], omega: [f64; 3] },
    Many { t: Py<PyAny>, attitude: Py<PyAny>, omega: Py<PyAny> },
}

impl States {
    pub(crate) fn one(t: f64, attitude: Quat<f64>, omega: [f64; 3], order: Order) -> Self {
        States { held: Held::One { t, attitude: order.write(attitude), omega }, order }
    }

    /// At times of the shape `shape`.
    pub(crate) fn many(
        py: Python<'_>,
        shape: &[usize],
        t: Vec<f64>,
        attitude: Vec<f64>,
        omega: Vec<f64>,
        order: Order,
    ) -> PyResult<Self> {
        let of = |last: usize| -> Vec<usize> { shape.iter().copied().chain([last]).collect() };
        let held = Held::Many {
            t: array(py, t, shape)?.unbind(),
            attitude: array(py, attitude, &of(4))?.unbind(),
            omega: array(py, omega, &of(3))?.unbind(),
        };
        Ok(States { held, order })
    }

    /// Times, attitudes and angular velocities, one after the other.
    fn flat(&self, py: Python<'_>) -> PyResult<[Vec<f64>; 3]> {
        match &self.held {
            Held::One { t, attitude, omega } => Ok([vec![*t], attitude.to_vec(), omega.to_vec()]),
            Held::Many { t, attitude, omega } => {
                let flat = |values: &Py<PyAny>| -> PyResult<Vec<f64>> {
                    values.bind(py).call_method0("ravel")?.extract()
                };
                Ok([flat(t)?, flat(attitude)?, flat(omega)?])
            }
        }
    }
}

#[pymethods]
impl States {
    /// Times, s.
    #[getter]
    fn t<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        match &self.held {
            Held::One { t, .. } => Ok(t.into_pyobject(py)?.into_any()),
            Held::Many { t, .. } => Ok(t.bind(py).clone()),
        }
    }

    /// Unit quaternions, body to space, in the order that was asked for: shape (..., 4).
    #[getter]
    fn attitude<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        match &self.held {
            Held::One { attitude, .. } => array(py, attitude.to_vec(), &[4]),
            Held::Many { attitude, .. } => Ok(attitude.bind(py).clone()),
        }
    }

    /// Angular velocities in body axes, rad/s: shape (..., 3).
    #[getter]
    fn omega<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        match &self.held {
            Held::One { omega, .. } => array(py, omega.to_vec(), &[3]),
            Held::Many { omega, .. } => Ok(omega.bind(py).clone()),
        }
    }

    /// The attitudes as a `scipy.spatial.transform.Rotation`.
    #[getter]
    fn rotation<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        scipy_rotation(&self.attitude(py)?, self.order)
    }

    /// Where the scalar of the quaternions stands: `wxyz` or `xyzw`.
    #[getter]
    fn order(&self) -> &'static str {
        match self.order {
            Order::First => "wxyz",
            Order::Last => "xyzw",
        }
    }

    fn __iter__<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyIterator>> {
        PyTuple::new(py, [self.attitude(py)?, self.omega(py)?])?.try_iter()
    }

    fn __len__(&self) -> usize {
        2
    }

    fn __repr__(&self, py: Python<'_>) -> PyResult<String> {
        let [t, attitude, omega] = self.flat(py)?;
        let names = match self.order {
            Order::First => ["q_w", "q_x", "q_y", "q_z"],
            Order::Last => ["q_x", "q_y", "q_z", "q_w"],
        };
        let columns = std::iter::once(("t", "s"))
            .chain(names.map(|name| (name, "")))
            .chain(["omega_x", "omega_y", "omega_z"].map(|name| (name, "rad/s")));
        let columns = columns.map(|(name, unit)| Column::new(name, unit, "").digits(4)).collect();
        let mut table = Table::new("states", "Attitudes and angular velocities.", columns);
        let (attitudes, omegas) = (attitude.as_chunks::<4>().0, omega.as_chunks::<3>().0);
        let all = t.len();
        for k in shown::places(all) {
            let row = [t[k]].into_iter().chain(attitudes[k]).chain(omegas[k]);
            table.push(row.map(Cell::from));
        }
        Ok(shown::text(&table, all))
    }
}

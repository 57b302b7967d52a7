//! From whatever Python calls numbers to numbers, and back.

use nalgebra::{Matrix3, UnitQuaternion};
use numpy::{PyArray1, PyArrayMethods, PyReadonlyArrayDyn};
use polhode::rotation::Quat;
use pyo3::prelude::*;
use pyo3::sync::PyOnceLock;
use pyo3::types::PyDict;

use crate::error::{PolhodeError, refused};

/// `value` as numbers in rows of the last dimension, with its shape.
pub(crate) struct Numbers {
    pub(crate) name: &'static str,
    pub(crate) shape: Vec<usize>,
    pub(crate) values: Vec<f64>,
}

impl Numbers {
    pub(crate) fn of(name: &'static str, value: &Bound<'_, PyAny>) -> PyResult<Self> {
        static ASARRAY: PyOnceLock<Py<PyAny>> = PyOnceLock::new();
        static OPTIONS: PyOnceLock<Py<PyDict>> = PyOnceLock::new();
        let py = value.py();
        let asarray = ASARRAY.get_or_try_init(py, || {
            Ok::<_, PyErr>(py.import("numpy")?.getattr("asarray")?.unbind())
        })?;
        let options = OPTIONS.get_or_try_init(py, || {
            let options = PyDict::new(py);
            options.set_item("dtype", "float64")?;
            Ok::<_, PyErr>(options.unbind())
        })?;
        // an array of complex numbers would lose its imaginary part with a warning
        let is_complex = || -> PyResult<bool> {
            Ok(value.hasattr("dtype")? && value.getattr("dtype")?.getattr("kind")?.extract::<String>()? == "c")
        };
        let array = match is_complex() {
            Ok(false) => asarray.bind(py).call((value,), Some(options.bind(py))),
            _ => Err(refused("complex numbers")),
        };
        let array = array.map_err(|error| refused(format!("{name}: not an array of numbers: {}", error.value(py))))?;
        let array: PyReadonlyArrayDyn<'_, f64> =
            array.extract().map_err(|_| refused(format!("{name}: not an array of numbers")))?;
        let view = array.as_array();
        Ok(Numbers { name, shape: view.shape().to_vec(), values: view.iter().copied().collect() })
    }

    /// Refuses any other shape than `expected`, as a user would write it.
    fn unexpected(&self, expected: &str) -> PyErr {
        PolhodeError::new_err(format!("{}: an array of shape {:?}; it must be {expected}", self.name, self.shape))
    }

    /// `N` numbers.
    pub(crate) fn fixed<const N: usize>(self) -> PyResult<[f64; N]> {
        let found = if self.shape == [N] { self.values.as_slice().try_into().ok() } else { None };
        found.ok_or_else(|| self.unexpected(&format!("({N},)")))
    }

    /// Numbers in one dimension.
    pub(crate) fn list(self) -> PyResult<Vec<f64>> {
        if self.shape.len() == 1 { Ok(self.values) } else { Err(self.unexpected("(n,)")) }
    }

    /// Rows of `N` numbers, of which there are `rows` where that is known.
    pub(crate) fn rows<const N: usize>(self, rows: Option<usize>) -> PyResult<Vec<[f64; N]>> {
        let fits = self.shape.len() == 2 && self.shape[1] == N && rows.is_none_or(|rows| rows == self.shape[0]);
        if !fits {
            let rows = rows.map_or("n".into(), |rows| rows.to_string());
            return Err(self.unexpected(&format!("({rows}, {N})")));
        }
        Ok(self.values.as_chunks::<N>().0.to_vec())
    }

    /// Three by three.
    pub(crate) fn matrix(self) -> PyResult<Matrix3<f64>> {
        if self.shape == [3, 3] { Ok(Matrix3::from_row_slice(&self.values)) } else { Err(self.unexpected("(3, 3)")) }
    }
}

/// Where the scalar of a quaternion stands.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Order {
    First,
    Last,
}

impl Order {
    pub(crate) fn of(text: &str) -> PyResult<Self> {
        match text {
            "wxyz" => Ok(Order::First),
            "xyzw" => Ok(Order::Last),
            _ => Err(refused(format!("order: '{text}'; it must be \"wxyz\" or \"xyzw\""))),
        }
    }

    /// The components w, x, y, z of one that is written in this order.
    pub(crate) fn read(self, q: [f64; 4]) -> [f64; 4] {
        match self {
            Order::First => q,
            Order::Last => [q[3], q[0], q[1], q[2]],
        }
    }

    /// `q` in this order.
    pub(crate) fn write(self, q: Quat<f64>) -> [f64; 4] {
        let [w, x, y, z] = q.components();
        match self {
            Order::First => [w, x, y, z],
            Order::Last => [x, y, z, w],
        }
    }
}

/// An attitude: a quaternion of any norm but zero, or a `scipy` rotation; the identity where none is given.
pub(crate) fn attitude(value: Option<&Bound<'_, PyAny>>, order: Order) -> PyResult<Quat<f64>> {
    let Some(value) = value else { return Ok(Quat::identity()) };
    if value.hasattr("as_quat")? {
        let written = value.call_method0("as_quat")?;
        return Ok(Quat::from_components(Order::Last.read(Numbers::of("attitude", &written)?.fixed()?)));
    }
    Ok(Quat::from_components(order.read(Numbers::of("attitude", value)?.fixed()?)))
}

/// The attitude as a rotation.
pub(crate) fn rotation(q: Quat<f64>) -> UnitQuaternion<f64> {
    q.into()
}

/// A new array of `shape` with `values`.
pub(crate) fn array<'py>(py: Python<'py>, values: Vec<f64>, shape: &[usize]) -> PyResult<Bound<'py, PyAny>> {
    let flat = PyArray1::from_vec(py, values);
    Ok(if shape.len() == 1 { flat.into_any() } else { flat.reshape(shape.to_vec())?.into_any() })
}

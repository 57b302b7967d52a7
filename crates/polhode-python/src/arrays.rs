//! From whatever Python calls numbers to numbers, and back.

use nalgebra::{Matrix3, UnitQuaternion, Vector3};
use numpy::{PyArray1, PyArrayMethods, PyReadonlyArrayDyn, PyUntypedArray, PyUntypedArrayMethods};
use polhode::rotation::Quat;
use pyo3::exceptions::PyMemoryError;
use pyo3::prelude::*;
use pyo3::sync::PyOnceLock;
use pyo3::types::{PyBool, PyBytes, PyDict, PyFloat, PyInt, PyString};

use crate::error::refused;

/// The numbers of an argument in the order of its last index, with its shape.
pub(crate) struct Numbers {
    pub(crate) name: &'static str,
    pub(crate) shape: Vec<usize>,
    pub(crate) values: Vec<f64>,
}

impl Numbers {
    /// Of a number, an array of any layout, or what `numpy.asarray` makes one of.
    pub(crate) fn of(name: &'static str, value: &Bound<'_, PyAny>) -> PyResult<Self> {
        if value.is_exact_instance_of::<PyFloat>() || value.is_exact_instance_of::<PyInt>() {
            let number: f64 =
                value.extract().map_err(|_| refused(format!("{name}: outside the range of a double")))?;
            if value.is_exact_instance_of::<PyInt>() && !value.eq(number)? {
                return Err(no_double(name, value, number));
            }
            return Ok(Numbers { name, shape: Vec::new(), values: vec![number] });
        }
        // of which numpy makes NaN
        if value.is_none() {
            return Err(refused(format!("{name}: None; it must be a number, or an array of numbers")));
        }
        // an array of doubles one after the other needs nothing made of it; between those of a field of a structured array there may be
        // no whole number of doubles
        let given: Option<PyReadonlyArrayDyn<'_, f64>> =
            value.is_exact_instance_of::<PyUntypedArray>().then(|| value.extract().ok()).flatten();
        let array = match given.filter(|array| array.is_c_contiguous() && array.data().is_aligned()) {
            Some(array) => array,
            None => as_floats(name, value)?
                .extract()
                .map_err(|_| refused(format!("{name}: numpy cannot make an array of numbers of it")))?,
        };
        let view = array.as_array();
        let mut values = Vec::new();
        values
            .try_reserve_exact(view.len())
            .map_err(|_| PyMemoryError::new_err(format!("{name}: no memory for {} numbers", view.len())))?;
        match view.as_slice() {
            Some(together) => values.extend_from_slice(together),
            None => values.extend(view.iter()),
        }
        Ok(Numbers { name, shape: view.shape().to_vec(), values })
    }

    /// Of an argument that may be left out.
    pub(crate) fn maybe(name: &'static str, value: Option<&Bound<'_, PyAny>>) -> PyResult<Option<Self>> {
        value.map(|value| Numbers::of(name, value)).transpose()
    }

    /// Refuses any other shape than `expected`, as a user would write it.
    pub(crate) fn unexpected(&self, expected: &str) -> PyErr {
        let shape = match self.shape.as_slice() {
            [n] => format!("({n},)"),
            shape => format!("({})", shape.iter().map(usize::to_string).collect::<Vec<_>>().join(", ")),
        };
        refused(format!("{}: an array of shape {shape}; it must be of shape {expected}", self.name))
    }

    /// `N` numbers.
    pub(crate) fn fixed<const N: usize>(self) -> PyResult<[f64; N]> {
        let found = if self.shape == [N] { self.values.as_slice().try_into().ok() } else { None };
        found.ok_or_else(|| self.unexpected(&format!("({N},)")))
    }

    pub(crate) fn vector(self) -> PyResult<Vector3<f64>> {
        self.fixed::<3>().map(Vector3::from)
    }

    /// Numbers in one dimension.
    pub(crate) fn list(self) -> PyResult<Vec<f64>> {
        if self.shape.len() == 1 { Ok(self.values) } else { Err(self.unexpected("(n,)")) }
    }

    /// Rows of `N` numbers, of which there are `rows` where that is known.
    pub(crate) fn rows<const N: usize>(self, rows: Option<usize>) -> PyResult<Vec<[f64; N]>> {
        let fits =
            self.shape.len() == 2 && self.shape[1] == N && rows.is_none_or(|rows| rows == self.shape[0]);
        if !fits {
            let rows = rows.map_or("n".into(), |rows| rows.to_string());
            return Err(self.unexpected(&format!("({rows}, {N})")));
        }
        Ok(self.values.as_chunks::<N>().0.to_vec())
    }

    /// Three by three.
    pub(crate) fn matrix(self) -> PyResult<Matrix3<f64>> {
        if self.shape == [3, 3] {
            Ok(Matrix3::from_row_slice(&self.values))
        } else {
            Err(self.unexpected("(3, 3)"))
        }
    }
}

/// `value` as an array of doubles one after the other; what numpy would make numbers of by losing something is refused.
fn as_floats<'py>(name: &'static str, value: &Bound<'py, PyAny>) -> PyResult<Bound<'py, PyAny>> {
    static ASARRAY: PyOnceLock<Py<PyAny>> = PyOnceLock::new();
    static REQUIRE: PyOnceLock<Py<PyAny>> = PyOnceLock::new();
    let py = value.py();
    let of_numpy = |name: &str| Ok::<_, PyErr>(py.import("numpy")?.getattr(name)?.unbind());
    let asarray = ASARRAY.get_or_try_init(py, || of_numpy("asarray"))?.bind(py);
    let require = REQUIRE.get_or_try_init(py, || of_numpy("require"))?.bind(py);
    // what Python itself says of a want of memory, or of Ctrl-C, stays what it is
    let not_numbers = |error: PyErr| {
        let is_ours = error.is_instance_of::<pyo3::exceptions::PyException>(py)
            && !error.is_instance_of::<PyMemoryError>(py);
        if is_ours { refused(format!("{name}: not an array of numbers: {}", error.value(py))) } else { error }
    };
    // numpy strips units without a word: those of astropy and unyt, and of pint
    for (of_quantities, unit) in [("to_value", "unit"), ("to_value", "units"), ("magnitude", "units")] {
        let has = |name: &str| value.hasattr(name).map_err(not_numbers);
        if has(of_quantities)? && has(unit)? {
            let unit = value.getattr(unit).and_then(|unit| unit.str()).map_err(not_numbers)?;
            let unit = unit.to_string_lossy();
            if !unit.is_empty() && unit != "dimensionless" {
                return Err(refused(format!(
                    "{name}: a quantity in {unit}, and units of quantities are not read; give its numbers, in the unit that help() says"
                )));
            }
        }
    }
    // masked values have no number, and an array of integers no place for that
    let value = if value.hasattr("filled").map_err(not_numbers)? {
        let is_masked = value.getattr("mask").and_then(|mask| mask.call_method0("any")?.is_truthy());
        match is_masked.map_err(not_numbers)? {
            true => value.call_method1("filled", (f64::NAN,)).map_err(not_numbers)?,
            false => value.call_method0("filled").map_err(not_numbers)?,
        }
    } else {
        value.clone()
    };
    let array = asarray.call1((value,)).map_err(not_numbers)?;
    let kind: String = array.getattr("dtype")?.getattr("kind")?.extract()?;
    match kind.as_str() {
        // contiguous in the order of C, aligned, and no subclass
        "f" | "i" | "u" | "O" => {
            check_exact(name, &array, &kind, require)?;
            require.call1((array, "float64", "CAE")).map_err(not_numbers)
        }
        _ => {
            let kind = array.getattr("dtype")?.str()?;
            Err(refused(format!("{name}: an array of {kind}; it must hold real numbers")))
        }
    }
}

/// Refuses an array in which an integer would change as a double, or which holds texts or truth values among objects.
fn check_exact<'py>(
    name: &'static str,
    array: &Bound<'py, PyAny>,
    kind: &str,
    require: &Bound<'py, PyAny>,
) -> PyResult<()> {
    let is_short = || Ok::<_, PyErr>(array.getattr("dtype")?.getattr("itemsize")?.extract::<usize>()? < 8);
    let unreadable = || refused(format!("{name}: numpy cannot make an array of numbers of it"));
    let outside = || refused(format!("{name}: outside the range of a double"));
    match kind {
        "i" if !is_short()? => {
            let whole = require.call1((array, "int64", "CAE"))?;
            let whole: PyReadonlyArrayDyn<'_, i64> = whole.extract().map_err(|_| unreadable())?;
            let changed = whole.as_array().iter().copied().find(|n| (*n as f64) as i128 != i128::from(*n));
            changed.map_or(Ok(()), |n| Err(no_double(name, n, n as f64)))
        }
        "u" if !is_short()? => {
            let whole = require.call1((array, "uint64", "CAE"))?;
            let whole: PyReadonlyArrayDyn<'_, u64> = whole.extract().map_err(|_| unreadable())?;
            let changed = whole.as_array().iter().copied().find(|n| (*n as f64) as u128 != u128::from(*n));
            changed.map_or(Ok(()), |n| Err(no_double(name, n, n as f64)))
        }
        "O" => {
            for one in array.getattr("flat")?.try_iter()? {
                let one = one?;
                if one.is_instance_of::<PyString>()
                    || one.is_instance_of::<PyBytes>()
                    || one.is_instance_of::<PyBool>()
                {
                    let found = one.get_type().name()?;
                    return Err(refused(format!("{name}: not an array of numbers: it holds a {found}")));
                }
                // also the integers of numpy
                if !one.is_exact_instance_of::<PyFloat>()
                    && one.hasattr("__index__")?
                    && let Ok(whole) = one.call_method0("__index__")
                {
                    let number: f64 = whole.extract().map_err(|_| outside())?;
                    if !whole.eq(number)? {
                        return Err(no_double(name, whole, number));
                    }
                }
            }
            Ok(())
        }
        _ => Ok(()),
    }
}

/// The refusal of an integer that would be another number, the nearest double, as by nanoseconds since 1970.
fn no_double(name: &'static str, integer: impl std::fmt::Display, nearest: f64) -> PyErr {
    refused(format!(
        "{name}: {integer} has too many digits for a double, the nearest is {nearest:.0}; subtract a whole number first, as t - \
         t[0] of counts since 1970, or give floats"
    ))
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
            _ => Err(refused(format!("order: '{text}'; it must be 'wxyz' or 'xyzw'"))),
        }
    }

    /// The components w, x, y, z of one that is written in this order.
    pub(crate) fn read(self, q: [f64; 4]) -> Quat<f64> {
        Quat::from_components(match self {
            Order::First => q,
            Order::Last => [q[3], q[0], q[1], q[2]],
        })
    }

    /// `q` in this order.
    #[inline]
    pub(crate) fn write(self, q: Quat<f64>) -> [f64; 4] {
        let [w, x, y, z] = q.components();
        match self {
            Order::First => [w, x, y, z],
            Order::Last => [x, y, z, w],
        }
    }
}

/// Quaternions as written, and their order: those of a `scipy` rotation are scalar last, whatever is said.
pub(crate) fn quaternions(
    name: &'static str,
    value: &Bound<'_, PyAny>,
    order: Order,
) -> PyResult<(Numbers, Order)> {
    if value.hasattr("as_quat")? {
        return Ok((Numbers::of(name, &value.call_method0("as_quat")?)?, Order::Last));
    }
    Ok((Numbers::of(name, value)?, order))
}

/// An attitude: a quaternion of any norm but zero, or a `scipy` rotation; the identity where none is given.
pub(crate) fn attitude(value: Option<&Bound<'_, PyAny>>, order: Order) -> PyResult<Quat<f64>> {
    let Some(value) = value else { return Ok(Quat::identity()) };
    let (numbers, order) = quaternions("attitude", value, order)?;
    Ok(order.read(numbers.fixed()?))
}

/// A rotation that is given as an attitude is.
pub(crate) fn rotation(
    name: &'static str,
    value: &Bound<'_, PyAny>,
    order: Order,
) -> PyResult<UnitQuaternion<f64>> {
    let (numbers, order) = quaternions(name, value, order)?;
    unit(name, order.read(numbers.fixed()?))
}

/// The rotation of a quaternion of any norm but zero.
pub(crate) fn unit(name: &'static str, q: Quat<f64>) -> PyResult<UnitQuaternion<f64>> {
    let size = q.magnitude();
    if size.is_finite() && size > 0.0 {
        Ok(q.map(|part| part / size).into())
    } else {
        let parts = q.components();
        Err(refused(format!("{name}: {parts:?} is not a rotation; a quaternion must be finite and not zero")))
    }
}

/// A new array of `shape` with `values`.
pub(crate) fn array<'py>(py: Python<'py>, values: Vec<f64>, shape: &[usize]) -> PyResult<Bound<'py, PyAny>> {
    let flat = PyArray1::from_vec(py, values);
    Ok(if shape.len() == 1 { flat.into_any() } else { flat.reshape(shape.to_vec())?.into_any() })
}

/// The tensor `m` as an array.
pub(crate) fn matrix<'py>(py: Python<'py>, m: &Matrix3<f64>) -> PyResult<Bound<'py, PyAny>> {
    array(py, m.transpose().as_slice().to_vec(), &[3, 3])
}

/// Room for `count` numbers, where there is so much memory.
pub(crate) fn room<T>(count: usize) -> PyResult<Vec<T>> {
    let mut rows = Vec::new();
    let found = rows.try_reserve_exact(count);
    found.map_err(|_| PyMemoryError::new_err(format!("no memory for {count} rows")))?;
    Ok(rows)
}

/// `scipy`'s rotations of quaternions in this order.
pub(crate) fn scipy_rotation<'py>(attitude: &Bound<'py, PyAny>, order: Order) -> PyResult<Bound<'py, PyAny>> {
    let py = attitude.py();
    let last = match order {
        Order::Last => attitude.clone(),
        Order::First => {
            let options = PyDict::new(py);
            options.set_item("axis", -1)?;
            py.import("numpy")?.call_method("roll", (attitude, -1), Some(&options))?
        }
    };
    py.import("scipy.spatial.transform")?.getattr("Rotation")?.call_method1("from_quat", (last,))
}

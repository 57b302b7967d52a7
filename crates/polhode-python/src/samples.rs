//! Runs at the times that were asked for.

use polhode::body::{Point, Time};
use polhode::observe::{Errors, Invariants};
use polhode::rotation::Quat;
use polhode_pages::figure::{Curve, Figure, Scale, sheet};
use polhode_pages::table::{Cell, Column, Table};
use pyo3::prelude::*;

use crate::arrays::{Order, array, scipy_rotation};
use crate::bodies::Body;
use crate::shown;

/// A run at the times that were asked for: attitudes, angular velocities, and the largest errors up to each time.
///
/// Errors are relative, except `attitude_error`, the angle to the exact attitude. An error is `None` if the motion does not conserve the
/// quantity or has no closed form, and with `errors=False`.
#[pyclass(frozen, module = "polhode")]
pub(crate) struct Samples {
    pub(crate) method: String,
    pub(crate) rows: Rows,
    pub(crate) order: Order,
}

#[derive(Default)]
pub(crate) struct Rows {
    pub(crate) times: Vec<f64>,
    attitudes: Vec<f64>,
    omegas: Vec<f64>,
    energy: Vec<f64>,
    momentum: Vec<f64>,
    /// Of the energy, |m|, L in space, L_z and Jacobi's constant.
    errors: [Vec<Option<f64>>; 5],
    attitude_error: Vec<Option<f64>>,
    pub(crate) flips: Vec<u64>,
}

/// What a row is made of.
pub(crate) struct Row<'a> {
    pub(crate) t: f64,
    pub(crate) attitude: Quat<f64>,
    pub(crate) omega: [f64; 3],
    pub(crate) point: &'a Point<f64>,
    pub(crate) worst: Option<Errors>,
    pub(crate) attitude_error: Option<f64>,
}

impl Rows {
    pub(crate) fn push(&mut self, body: &Body, order: Order, row: &Row<'_>) {
        let invariants = Invariants::of(&body.body, Time::from_seconds(row.t), row.point);
        self.times.push(row.t);
        self.attitudes.extend(order.write(row.attitude));
        self.omegas.extend(row.omega);
        self.energy.push(invariants.energy.hi() * body.body.scale());
        self.momentum.push(invariants.momentum_norm().hi() * body.body.scale());
        let errors = row.worst.map_or([None; 5], |worst| {
            [worst.energy, worst.momentum_norm, worst.momentum_vector, worst.momentum_z, worst.jacobi]
        });
        self.errors.iter_mut().zip(errors).for_each(|(column, error)| column.push(error));
        self.attitude_error.push(row.attitude_error);
    }
}

/// A column that is empty in every row is none.
fn column<'py>(py: Python<'py>, values: &[Option<f64>]) -> PyResult<Option<Bound<'py, PyAny>>> {
    let found: Option<Vec<f64>> = values.iter().copied().collect();
    found.filter(|found| !found.is_empty()).map(|found| array(py, found, &[values.len()])).transpose()
}

#[pymethods]
impl Samples {
    /// Name of the method.
    #[getter]
    fn method(&self) -> &str {
        &self.method
    }

    /// Times, s.
    #[getter]
    fn t<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        array(py, self.rows.times.clone(), &[self.rows.times.len()])
    }

    /// Quaternions, body to space, in the order that was asked for: shape (n, 4).
    #[getter]
    fn attitude<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        array(py, self.rows.attitudes.clone(), &[self.rows.times.len(), 4])
    }

    /// Angular velocities in body axes, rad/s: shape (n, 3).
    #[getter]
    fn omega<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        array(py, self.rows.omegas.clone(), &[self.rows.times.len(), 3])
    }

    /// The attitudes as a `scipy.spatial.transform.Rotation`.
    #[getter]
    fn rotation<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        scipy_rotation(&self.attitude(py)?, self.order)
    }

    /// Kinetic and potential energy, J.
    #[getter]
    fn energy<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        array(py, self.rows.energy.clone(), &[self.rows.times.len()])
    }

    /// Size of the angular momentum, kg m^2/s.
    #[getter]
    fn momentum<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        array(py, self.rows.momentum.clone(), &[self.rows.times.len()])
    }

    /// Largest relative error of the energy up to each time.
    #[getter]
    fn energy_error<'py>(&self, py: Python<'py>) -> PyResult<Option<Bound<'py, PyAny>>> {
        column(py, &self.rows.errors[0])
    }

    /// Largest relative error of the size of the angular momentum up to each time.
    #[getter]
    fn momentum_error<'py>(&self, py: Python<'py>) -> PyResult<Option<Bound<'py, PyAny>>> {
        column(py, &self.rows.errors[1])
    }

    /// Largest relative error of the angular momentum in space up to each time.
    #[getter]
    fn momentum_vector_error<'py>(&self, py: Python<'py>) -> PyResult<Option<Bound<'py, PyAny>>> {
        column(py, &self.rows.errors[2])
    }

    /// Largest relative error of the angular momentum along z of space up to each time, where its vector is not conserved.
    #[getter]
    fn momentum_z_error<'py>(&self, py: Python<'py>) -> PyResult<Option<Bound<'py, PyAny>>> {
        column(py, &self.rows.errors[3])
    }

    /// Largest relative error of Jacobi's constant up to each time, with a gravity gradient on a circle.
    #[getter]
    fn jacobi_error<'py>(&self, py: Python<'py>) -> PyResult<Option<Bound<'py, PyAny>>> {
        column(py, &self.rows.errors[4])
    }

    /// Angle to the exact attitude at each time, rad; `None` for the method "exact".
    #[getter]
    fn attitude_error<'py>(&self, py: Python<'py>) -> PyResult<Option<Bound<'py, PyAny>>> {
        column(py, &self.rows.attitude_error)
    }

    /// How often the body has turned over up to each time; `None` where steps are not watched: for "exact", with `+phase`, and with `errors=False`.
    #[getter]
    fn flips(&self) -> Option<Vec<u64>> {
        Some(self.rows.flips.clone())
            .filter(|flips| !flips.is_empty() && flips.len() == self.rows.times.len())
    }

    fn __len__(&self) -> usize {
        self.rows.times.len()
    }

    fn __repr__(&self) -> String {
        let Rows { times, errors: [energy, norm, momentum, z, jacobi], attitude_error, .. } = &self.rows;
        let columns = vec![
            Column::new("t", "s", "").digits(7),
            Column::new("E", "J", "").digits(7),
            Column::new("energy", "", "").digits(2),
            Column::new("|m|", "", "").digits(2),
            Column::new("L", "", "").digits(2),
            Column::new("L_z", "", "").digits(2),
            Column::new("Jacobi", "", "").digits(2),
            Column::new("attitude", "rad", "").digits(2),
        ];
        let mut table = Table::new("samples", "A run.", columns);
        for k in shown::places(times.len()) {
            let errors = [&energy[k], &norm[k], &momentum[k], &z[k], &jacobi[k], &attitude_error[k]];
            let errors = errors.map(|error| Cell::from(*error));
            table.push([times[k].into(), self.rows.energy[k].into()].into_iter().chain(errors));
        }
        format!(
            "{}, with the largest errors up to each time\n{}",
            self.method,
            shown::text(&table, times.len())
        )
    }

    /// The rows with a figure of the errors.
    fn _repr_html_(&self) -> String {
        let rows = &self.rows;
        let all = [
            ("Energy", "relative error", &rows.errors[0]),
            ("|m|", "relative error", &rows.errors[1]),
            ("L in space", "relative error", &rows.errors[2]),
            ("Attitude", "angle (rad)", &rows.attitude_error),
        ];
        let panels = all.into_iter().filter(|(.., values)| values.iter().any(Option::is_some));
        let panels: Vec<Figure> = panels
            .map(|(title, unit, values)| {
                let points = rows.times.iter().zip(values).filter_map(|(t, value)| Some((*t, (*value)?)));
                let mut figure = Figure::new("run", title, ("time (s)", Scale::Linear), (unit, Scale::Log));
                figure.series.push(Curve::new(self.method.clone(), points.collect()).plain());
                figure
            })
            .collect();
        let svg = match panels.is_empty() {
            true => String::new(),
            false => sheet("run", &format!("Errors of {}", self.method), 2, &panels).svg,
        };
        shown::page(&self.__repr__(), &svg)
    }
}

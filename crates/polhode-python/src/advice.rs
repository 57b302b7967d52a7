//! Which method, with which step.

use std::sync::{Arc, Mutex, PoisonError};
use std::time::Instant;

use polhode::advise::{Advice as Found, Choice, Demand, Progress, Setting, advise_telling, check_telling};
use polhode::method::method;
use polhode_pages::table::{Column, Table, row};
use pyo3::prelude::*;
use pyo3::types::PyDict;

use crate::arrays::Order;
use crate::bodies::{Body, Start};
use crate::calm::{self, LISTEN, aside};
use crate::error::{of, refused, warn};
use crate::scalars::{maybe, number};
use crate::units::finite;

/// The quickest method that meets a demand, and the others that do.
#[pyclass(frozen, module = "polhode")]
pub(crate) struct Advice {
    found: Found,
    actual_error: Option<f64>,
}

fn step_and_tolerance(choice: &Choice) -> (Option<f64>, Option<f64>) {
    match choice.setting {
        Setting::Step(step) => (Some(step), None),
        Setting::Tolerance { tolerance, step } => (Some(step), Some(tolerance)),
        _ => (None, None),
    }
}

fn dict<'py>(py: Python<'py>, choice: &Choice) -> PyResult<Bound<'py, PyDict>> {
    let (step, tolerance) = step_and_tolerance(choice);
    let found = PyDict::new(py);
    found.set_item("method", &choice.method)?;
    found.set_item("step", step)?;
    found.set_item("tolerance", tolerance)?;
    found.set_item("predicted_error", choice.attitude_error.value)?;
    found.set_item("predicted_error_factor", choice.attitude_error.factor)?;
    found.set_item("predicted_energy_error", choice.energy_error)?;
    found.set_item("predicted_cost", choice.seconds.value)?;
    found.set_item("predicted_cost_factor", choice.seconds.factor)?;
    found.set_item("whole_time", choice.whole_time)?;
    Ok(found)
}

#[pymethods]
impl Advice {
    /// Name of the method, as `run` takes it.
    #[getter]
    fn method(&self) -> &str {
        &self.found.best.method
    }

    /// Its step, s; for a method that chooses its steps, the interval of output; `None` for the closed form.
    #[getter]
    fn step(&self) -> Option<f64> {
        step_and_tolerance(&self.found.best).0
    }

    /// Its tolerance, if it chooses its steps, else `None`.
    #[getter]
    fn tolerance(&self) -> Option<f64> {
        step_and_tolerance(&self.found.best).1
    }

    /// Largest attitude error that is predicted, rad.
    #[getter]
    fn predicted_error(&self) -> f64 {
        self.found.best.attitude_error.value
    }

    /// Largest relative energy error that is predicted; `None` if the energy is not conserved.
    #[getter]
    fn predicted_energy_error(&self) -> Option<f64> {
        self.found.best.energy_error
    }

    /// Predicted processor time on this machine, s.
    #[getter]
    fn predicted_cost(&self) -> f64 {
        self.found.best.seconds.value
    }

    /// Attitude error of the advised method when run to the end, rad, if `check` asked for it.
    #[getter]
    fn actual_error(&self) -> Option<f64> {
        self.actual_error
    }

    /// The next best method.
    #[getter]
    fn runner_up(&self) -> Option<&str> {
        self.found.others.first().map(|choice| choice.method.as_str())
    }

    /// Angle at the end to the motion from a start that differs in its last digits, rad.
    #[getter]
    fn conditioning(&self) -> f64 {
        self.found.conditioning
    }

    /// The other methods that meet the demand, the quickest first, as dicts.
    #[getter]
    fn others<'py>(&self, py: Python<'py>) -> PyResult<Vec<Bound<'py, PyDict>>> {
        self.found.others.iter().map(|choice| dict(py, choice)).collect()
    }

    /// Methods that do not meet it, each with the smallest attitude error that it reached, rad.
    #[getter]
    fn unfit(&self) -> Vec<(String, Option<f64>)> {
        self.found.unfit.clone()
    }

    /// The advice as a dict, with the names of the command's JSON.
    fn to_dict<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let found = dict(py, &self.found.best)?;
        found.set_item("runner_up", self.runner_up())?;
        found.set_item("actual_error", self.actual_error)?;
        found.set_item("conditioning", self.found.conditioning)?;
        found.set_item("others", self.others(py)?)?;
        Ok(found)
    }

    fn __repr__(&self) -> String {
        let columns = vec![
            Column::new("method", "", ""),
            Column::new("step", "s", "").digits(9),
            Column::new("tolerance", "", "").digits(2),
            Column::new("attitude", "rad", "").digits(2),
            Column::new("energy", "", "").digits(2),
            Column::new("time", "s", "").digits(2),
        ];
        let mut table = Table::new("advice", "Methods that meet the demand.", columns);
        for choice in std::iter::once(&self.found.best).chain(&self.found.others).take(8) {
            let (step, tolerance) = step_and_tolerance(choice);
            let (attitude, cost) = (choice.attitude_error.value, choice.seconds.value);
            table.push(row![choice.method.as_str(), step, tolerance, attitude, choice.energy_error, cost]);
        }
        table.terminal().trim_end().into()
    }
}

/// The quickest method that moves `body` to a given accuracy, with its step or tolerance, found by running the methods on the body itself.
///
/// - `omega`, `attitude`, `momentum`: the start, as of `FreeMotion`, at the time `start_time`, s, on which forces may depend.
/// - `until`: end of the motion, s.
/// - `attitude_error`: largest error of the attitude, rad; `energy_error`: largest relative error of the energy; `budget`: largest processor
///   time, s.
/// - `exclude`: names of methods that are not wanted.
/// - `check`: run the advised method to the end, and compare its attitude with the true motion. A warning says if its error is larger than
///   asked for. The energy error is only predicted.
/// - `progress`: called as `progress(stage, done, seconds)` some times a second: what is being done, which part of it is done, and about how
///   long all of it takes.
///
/// >>> import polhode
/// >>> advice = polhode.advise("toutatis", until=30 * 86400, attitude_error=1e-6, exclude=["exact"])
/// >>> advice.predicted_error <= 1e-6
/// True
/// >>> run = polhode.run(advice.method, "toutatis", step=advice.step, tolerance=advice.tolerance, times=[0, 30 * 86400])
#[pyfunction]
#[pyo3(signature = (body, omega = None, attitude = None, *, until, attitude_error, momentum = None, energy_error = None, budget = None,
                    exclude = None, start_time = 0.0, check = false, progress = None, order = "wxyz"))]
#[allow(clippy::too_many_arguments, reason = "they are keywords")]
pub(crate) fn advise(
    py: Python<'_>,
    body: &Bound<'_, PyAny>,
    omega: Option<&Bound<'_, PyAny>>,
    attitude: Option<&Bound<'_, PyAny>>,
    #[pyo3(from_py_with = number::until)] until: f64,
    #[pyo3(from_py_with = number::attitude_error)] attitude_error: f64,
    momentum: Option<&Bound<'_, PyAny>>,
    #[pyo3(from_py_with = maybe::energy_error)] energy_error: Option<f64>,
    #[pyo3(from_py_with = maybe::budget)] budget: Option<f64>,
    exclude: Option<Vec<String>>,
    #[pyo3(from_py_with = number::start_time)] start_time: f64,
    check: bool,
    #[pyo3(from_py_with = calm::progress)] progress: Option<Py<PyAny>>,
    order: &str,
) -> PyResult<Advice> {
    let body = Body::of("body", body)?;
    let (order, time) = (Order::of(order)?, finite("start_time", start_time)?);
    let start = body.start(&Start { omega, attitude, momentum, time, order })?;
    let start = body.body.leave(&start);
    let mut demand = Demand::new(until, attitude_error);
    (demand.energy_error, demand.budget, demand.start_time) = (energy_error, budget, start_time);
    demand.excluded = exclude.unwrap_or_default();
    let groups = ["exact", "dmv", "gauss"];
    for name in demand.excluded.iter().filter(|name| !groups.contains(&name.as_str())) {
        method(name).map_err(of("exclude"))?;
    }
    let raised = Arc::new(Mutex::new(None));
    let keeper = Arc::clone(&raised);
    let moved = body.body.clone();
    let found = aside(py, move |_| {
        let mut told: Option<Instant> = None;
        let heed = &mut |now: &Progress| {
            let Some(tell) = &progress else { return };
            if now.done < 1.0 && told.is_some_and(|told| told.elapsed() < LISTEN) {
                return;
            }
            told = Some(Instant::now());
            let mut raised = keeper.lock().unwrap_or_else(PoisonError::into_inner);
            if raised.is_none() {
                let told =
                    Python::attach(|py| tell.call1(py, (now.stage.to_string(), now.done, now.seconds)));
                *raised = told.err();
            }
        };
        let found = advise_telling(&moved, &start, &demand, heed)?;
        let actual = check.then(|| check_telling(&moved, &start, &demand, &found.best, heed)).transpose()?;
        Ok::<_, polhode::advise::AdviseError>((found, actual))
    })?;
    if let Some(error) = raised.lock().unwrap_or_else(PoisonError::into_inner).take() {
        return Err(error);
    }
    let (found, actual_error) = body.settle(found.map_err(refused))?;
    if let Some(time) = found.jump {
        let first = start_time + time;
        warn(
            py,
            &format!(
                "the torque jumps, first at t = {first} s: steps and tolerances hold only for this start and time"
            ),
        )?;
    }
    match (found.best.whole_time, actual_error, energy_error) {
        (false, None, _) => {
            warn(py, "the error at the end is extrapolated from a shorter run; check=True runs to the end")?;
        }
        (false, Some(_), Some(_)) => {
            warn(
                py,
                "the energy error is extrapolated from a shorter run; check=True measures only the attitude error",
            )?;
        }
        _ => {}
    }
    if let Some(error) = actual_error.filter(|error| *error > attitude_error) {
        let method = &found.best.method;
        warn(
            py,
            &format!(
                "the attitude error of {method} is {error:.1e} rad, and {attitude_error:.1e} rad were asked for"
            ),
        )?;
    }
    Ok(Advice { found, actual_error })
}

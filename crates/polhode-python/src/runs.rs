//! Runs by methods, sampled at times.

use polhode::body::{Clock, Point, Time};
use polhode::flow::ExactMotion;
use polhode::method::{AnyMethod, Claimed, ToleranceError, UnknownMethod, catalogue, method};
use polhode::num::Dd;
use polhode::observe::{Errors, Invariants, Monitor};
use polhode::rotation::{Quat, rotation_angle};
use polhode::run::{Run, Watch};
use polhode_files::Error;
use polhode_pages::figure::{Curve, Figure, Scale, sheet};
use polhode_pages::table::{Cell, Column, Table};
use pyo3::prelude::*;

use crate::arrays::{Numbers, Order, array, scipy_rotation};
use crate::bodies::{Body, Start};
use crate::calm::Listener;
use crate::error::{of, refused};
use crate::shown;

/// Steps between two looks for Ctrl-C.
const PART: u64 = 4096;

/// A run has fewer steps than this: a day or more of the fastest method.
const MOST_STEPS: f64 = 1e12;

/// A run at the times that were asked for: attitudes, angular velocities, and the largest errors of the invariants up to each.
///
/// Errors are relative; `None` where the motion does not conserve the quantity, or where nothing was watched. `attitude_error` is
/// the angle to the exact attitude, rad; `None` where the motion has no closed form.
#[pyclass(frozen, module = "polhode")]
pub(crate) struct Samples {
    method: String,
    rows: Rows,
    order: Order,
}

#[derive(Default)]
struct Rows {
    times: Vec<f64>,
    attitudes: Vec<f64>,
    omegas: Vec<f64>,
    energy: Vec<f64>,
    momentum: Vec<f64>,
    /// Of the energy, |m|, L in space, L_z and Jacobi's constant.
    errors: [Vec<Option<f64>>; 5],
    attitude_error: Vec<Option<f64>>,
    flips: Vec<u64>,
}

/// What a row is made of.
struct Row<'a> {
    t: f64,
    attitude: Quat<f64>,
    omega: [f64; 3],
    point: &'a Point<f64>,
    worst: Option<Errors>,
    attitude_error: Option<f64>,
}

impl Rows {
    fn push(&mut self, body: &Body, order: Order, row: &Row<'_>) {
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

/// The run of `body` by a method, sampled at `times`, s, ascending from `start_time` on.
///
/// `method` is a name of the catalogue, as `rk4`, `dmv:10` or `kick-drift@srkn-6b`, or `exact`, the closed form. `step`, s, is that of
/// the method; methods that choose their steps take a `tolerance` and need no step. The start is that of `FreeMotion`. Without
/// `errors` no step is watched, which is the quicker. `progress` is called as `progress(stage, done, seconds)` some times a second.
///
/// >>> import polhode
/// >>> run = polhode.run("rk4", [1, 2, 3], [0.4, 1, -0.3], times=[0, 500, 1000], step=0.1)
/// >>> run.energy_error.shape, bool(run.energy_error[-1] > run.energy_error[1] > 1e-7)
/// ((3,), True)
/// >>> polhode.run("rk5", [1, 2, 3], [0.4, 1, -0.3], times=[0, 1], step=0.1)
/// Traceback (most recent call last):
///     ...
/// polhode.PolhodeError: method: 'rk5': no such method; did you mean 'rk4'?
#[pyfunction]
#[pyo3(signature = (method, body, omega = None, attitude = None, *, times, step = None, tolerance = None, momentum = None,
                    start_time = 0.0, errors = true, progress = None, order = "wxyz"))]
#[allow(clippy::too_many_arguments, reason = "they are keywords")]
pub(crate) fn run(
    py: Python<'_>,
    method: &str,
    body: &Bound<'_, PyAny>,
    omega: Option<&Bound<'_, PyAny>>,
    attitude: Option<&Bound<'_, PyAny>>,
    times: &Bound<'_, PyAny>,
    step: Option<f64>,
    tolerance: Option<f64>,
    momentum: Option<&Bound<'_, PyAny>>,
    start_time: f64,
    errors: bool,
    progress: Option<Py<PyAny>>,
    order: &str,
) -> PyResult<Samples> {
    let order = Order::of(order)?;
    let body = Body::of("body", body)?;
    let start = body.start(&Start { omega, attitude, momentum, order })?;
    let times = Numbers::of("times", times)?.list()?;
    if !start_time.is_finite() {
        return Err(refused(format!("start_time: {start_time} is no finite number of seconds")));
    }
    let asked = Asked { body: &body, start, times: &times, start_time, errors, order };
    let rows = if method == "exact" {
        if step.is_some() || tolerance.is_some() {
            return Err(refused("step, tolerance: the method exact takes none; leave them out"));
        }
        py.detach(|| asked.exact(Listener::telling(method, progress)))
    } else {
        let found = named(method, tolerance)?;
        py.detach(|| asked.stepped(found.as_ref(), step, Listener::telling(method, progress)))
    };
    Ok(Samples { method: method.into(), rows: body.settle(rows)?, order })
}

/// The method of that name, at a tolerance where one is given.
pub(crate) fn named(name: &str, tolerance: Option<f64>) -> PyResult<Box<dyn AnyMethod>> {
    let found = method(name).map_err(|error| match error {
        UnknownMethod::Name { name } => {
            let known: Vec<String> = catalogue().iter().map(|method| method.name()).collect();
            refused(Error::unknown_name("method", "method", &name, known.iter().map(String::as_str)))
        }
        error => refused(format!("method: {error}")),
    })?;
    match tolerance {
        None => Ok(found),
        Some(_) if name.contains(':') && found.tolerance().is_some() => {
            Err(refused(format!("tolerance: {name} has one already; give one of the two")))
        }
        Some(tolerance) => found
            .with_tolerance(tolerance)
            .map_err(|error: ToleranceError| refused(format!("tolerance: {error}"))),
    }
}

/// What is asked of a run.
struct Asked<'a> {
    body: &'a Body,
    start: Point<Dd>,
    times: &'a [f64],
    start_time: f64,
    errors: bool,
    order: Order,
}

impl Asked<'_> {
    fn exact(&self, mut listener: Listener) -> PyResult<Rows> {
        let (body, start) = (&self.body.body, &self.start);
        let motion = ExactMotion::from_point(body, *start).map_err(of("method"))?;
        let mut monitor = self.errors.then(|| Monitor::new(body, Clock::new(1.0), &start.to_f64()));
        let mut rows = Rows::default();
        for &t in self.times {
            listener.listen(rows.times.len() as f64 / self.times.len() as f64)?;
            motion.check_time(t - self.start_time).map_err(of("times"))?;
            let elapsed = Dd::from(t) - Dd::from(self.start_time);
            let x = motion.point_at(elapsed);
            let finite = monitor.as_mut().map_or(x.is_finite(), |monitor| monitor.observe(&[x]) == 1);
            if !finite {
                return Err(refused(format!(
                    "method: exact: at {t:?} s the state is not finite; use kick-drift@srkn-6b with a step"
                )));
            }
            // the start is what was typed
            let is_start = elapsed == Dd::ZERO;
            let state = if is_start { body.leave(start) } else { body.leave(&x) };
            let omega = if is_start { body.omega_of(start) } else { body.omega_of(&x) };
            rows.push(
                self.body,
                self.order,
                &Row {
                    t,
                    attitude: state.attitude,
                    omega: omega.into(),
                    point: &x,
                    worst: monitor.as_ref().map(Monitor::worst),
                    attitude_error: None,
                },
            );
        }
        Ok(rows)
    }

    fn stepped(&self, method: &dyn AnyMethod, step: Option<f64>, mut listener: Listener) -> PyResult<Rows> {
        let body = &self.body.body;
        let adaptive = method.tolerance().is_some();
        let speed = body.omega_of(&self.start).norm();
        // the errors of a method that chooses its steps are watched at each radian of the turn or more often
        let watched =
            adaptive.then(|| if speed > 0.0 { libm::exp2(-libm::ceil(libm::log2(speed))) } else { 1.0 });
        let name = method.name();
        let Some(h) = step.or(watched) else {
            return Err(refused(format!("step: missing; {name} needs a step in seconds")));
        };
        let clock = Clock { start: self.start_time, step: h };
        let mut run = Run::from_point(method, body, self.start.to_f64(), clock).map_err(refused)?;
        if !self.errors {
            run = run.watching(Watch::Never);
        }
        for t in self.times {
            let steps = (t - self.start_time) / h;
            if steps >= MOST_STEPS {
                return Err(refused(format!(
                    "step: {h:?} s asks for {steps:.0e} steps, and a run has fewer than {MOST_STEPS:e}; take a larger step"
                )));
            }
        }
        let exact = ExactMotion::from_point(body, run.start().to_dd()).ok();
        let (mut rows, mut taken) = (Rows::default(), 0);
        let last = self.times.last().map_or(0.0, |last| (last - self.start_time) / h);
        for &t in self.times {
            // in parts, between which Ctrl-C is heard
            let whole = ((t - self.start_time) / h).floor();
            let whole = if whole > 1.0 { whole as u64 - 1 } else { 0 };
            while taken + PART < whole {
                taken += PART;
                run.advance_to(taken).map_err(refused)?;
                listener.listen(taken as f64 / last)?;
            }
            let sample = run.at(t).map_err(refused)?;
            listener.listen((t - self.start_time) / h / last)?;
            let attitude_error = exact.as_ref().map(|exact| {
                let there = exact.point_at_dd(sample.elapsed);
                rotation_angle(sample.point.to_dd().attitude, there.attitude).hi()
            });
            rows.push(
                self.body,
                self.order,
                &Row {
                    t,
                    attitude: sample.state.attitude,
                    omega: sample.omega_body.into(),
                    point: &sample.point,
                    worst: self.errors.then_some(sample.worst),
                    attitude_error,
                },
            );
            rows.flips.extend(sample.flips);
            if let Some(why) = sample.nonsense() {
                return Err(refused(format!("method: {name}: {why}")));
            }
        }
        Ok(rows)
    }
}

/// A column that is empty in every row is none.
fn column<'py>(py: Python<'py>, values: &[Option<f64>]) -> PyResult<Option<Bound<'py, PyAny>>> {
    let found: Option<Vec<f64>> = values.iter().copied().collect();
    found.filter(|found| !found.is_empty()).map(|found| array(py, found, &[values.len()])).transpose()
}

#[pymethods]
impl Samples {
    /// The method, as it was named.
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

    /// Largest error of the angular momentum about the vertical up to each time.
    #[getter]
    fn momentum_z_error<'py>(&self, py: Python<'py>) -> PyResult<Option<Bound<'py, PyAny>>> {
        column(py, &self.rows.errors[3])
    }

    /// Largest error of Jacobi's constant up to each time.
    #[getter]
    fn jacobi_error<'py>(&self, py: Python<'py>) -> PyResult<Option<Bound<'py, PyAny>>> {
        column(py, &self.rows.errors[4])
    }

    /// Angle to the exact attitude at each time, rad.
    #[getter]
    fn attitude_error<'py>(&self, py: Python<'py>) -> PyResult<Option<Bound<'py, PyAny>>> {
        column(py, &self.rows.attitude_error)
    }

    /// How often the body has flipped up to each time; `None` where steps were not watched.
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
    fn _repr_html_(&self) -> PyResult<String> {
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
            false => sheet("run", &format!("Errors of {}", self.method), 2, &panels).map_err(refused)?.svg,
        };
        Ok(shown::page(&self.__repr__(), &svg))
    }
}

/// The names of the methods, in the order in which tables show them; other arguments and schemes may be put in place of those here.
#[pyfunction]
pub(crate) fn methods() -> Vec<String> {
    catalogue().iter().map(|method| method.name()).collect()
}

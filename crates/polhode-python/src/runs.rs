//! Runs by methods, sampled at times.

use polhode::body::{Clock, Point};
use polhode::flow::ExactMotion;
use polhode::method::{AnyMethod, Claimed, ToleranceError, UnknownMethod, catalogue, method};
use polhode::num::Dd;
use polhode::observe::Monitor;
use polhode::rotation::rotation_angle;
use polhode::run::{Run, Watch};
use polhode_files::Error;
use polhode_files::text::short;
use pyo3::prelude::*;

use crate::arrays::{Numbers, Order};
use crate::bodies::{Body, Start};
use crate::calm::{self, Listener};
use crate::error::{of, refused, warn};
use crate::samples::{Row, Rows, Samples};
use crate::scalars::{maybe, number};
use crate::units::finite;

/// Steps between two looks for Ctrl-C.
const PART: u64 = 4096;

/// A run has fewer steps than this: a day or more of the fastest method.
const MOST_STEPS: f64 = 1e12;

/// Moves `body` by a method to given times.
///
/// - `method`: a name of the catalogue, such as "rk4", "dmv:10" or "kick-drift@srkn-6b" (see `methods`), or "exact", the closed form.
/// - `omega`, `attitude`, `momentum`: the start, as of `FreeMotion`, at the time `start_time`, s. `order` is that of quaternions, given and
///   returned.
/// - `times`: s, ascending from `start_time` on; for "exact" in any order.
/// - `step`: step of the method, s. Methods that choose their steps need none, and take a `tolerance`. A warning says if the body turns by more than
///   1 rad in a step.
/// - `errors`: with False no errors are computed, which is quicker.
/// - `progress`: called as `progress(stage, done, seconds)` some times a second and at the end, such as `polhode.progress.bar`.
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
    #[pyo3(from_py_with = maybe::step)] step: Option<f64>,
    #[pyo3(from_py_with = maybe::tolerance)] tolerance: Option<f64>,
    momentum: Option<&Bound<'_, PyAny>>,
    #[pyo3(from_py_with = number::start_time)] start_time: f64,
    errors: bool,
    #[pyo3(from_py_with = calm::progress)] progress: Option<Py<PyAny>>,
    order: &str,
) -> PyResult<Samples> {
    let order = Order::of(order)?;
    let body = Body::of("body", body)?;
    let time = finite("start_time", start_time)?;
    let start = body.start(&Start { omega, attitude, momentum, time, order })?;
    let times = Numbers::of("times", times)?.list()?;
    let asked = Asked { body: &body, start, times: &times, start_time, errors, order };
    let rows = if method == "exact" {
        if step.is_some() || tolerance.is_some() {
            return Err(refused("step, tolerance: the method exact takes none; leave them out"));
        }
        py.detach(|| asked.exact(Listener::telling(method, progress)))
    } else {
        let found = named(method, tolerance)?;
        if let (Some(step), None) = (step, found.tolerance()) {
            warn_coarse(py, step, asked.body.body.omega_of(&asked.start).norm())?;
        }
        py.detach(|| asked.stepped(found.as_ref(), step, Listener::telling(method, progress)))
    };
    Ok(Samples { method: method.into(), rows: body.settle(rows)?, order })
}

/// Warns of a step, s, in which a body of this speed, rad/s, turns too far for any method.
pub(crate) fn warn_coarse(py: Python<'_>, step: f64, speed: f64) -> PyResult<()> {
    let turn = step * speed;
    if !turn.is_finite() || turn <= 1.0 {
        return Ok(());
    }
    warn(
        py,
        &format!(
            "step: {}: turns the body by {turn:.1} rad per step; above 1 rad no stepping method is accurate; use a smaller step",
            short(step)
        ),
    )
}

/// The method of that name, at a tolerance where one is given.
pub(crate) fn named(name: &str, tolerance: Option<f64>) -> PyResult<Box<dyn AnyMethod>> {
    let found = method(name).map_err(|error| match error {
        UnknownMethod::Name { name } if name == "exact" => refused(
            "method: 'exact': the closed form takes no steps; it is that of Ensemble.at and of FreeMotion",
        ),
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
        listener.end()?;
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
                    "step: {h:?} s asks for {steps:.0e} steps, and a run has fewer than {MOST_STEPS:e}; use a larger step"
                )));
            }
        }
        let exact = self.errors.then(|| ExactMotion::from_point(body, run.start().to_dd()).ok()).flatten();
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
        listener.end()?;
        Ok(rows)
    }
}

/// The names of the methods, in the order of the tables. A name may have another argument or scheme, such as "dmv:12" or "two-turn@suzuki-4".
#[pyfunction]
pub(crate) fn methods() -> Vec<String> {
    catalogue().iter().map(|method| method.name()).collect()
}

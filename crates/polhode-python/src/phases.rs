//! The phase error of a method, predicted before the run.

use polhode::method::PhaseDrift as Drift;
use pyo3::prelude::*;

use crate::arrays::Order;
use crate::bodies::{Body, Start};
use crate::calm::aside;
use crate::error::refused;
use crate::runs::named;
use crate::scalars::number;
use crate::units::finite;

/// How fast the attitude error of a method grows: as a shift in time along the polhode, and as a twist about L.
///
/// >>> import polhode
/// >>> drift = polhode.phase("two-turn", [1, 2, 3], [0.4, 1, -0.3], step=0.01)
/// >>> drift.doubt < 1e-9 and drift.attitude_error(100) > drift.rounding(100)
/// True
#[pyclass(frozen, module = "polhode")]
pub(crate) struct PhaseDrift(Drift);

#[pymethods]
impl PhaseDrift {
    /// Growth of the shift in time, s/s.
    #[getter]
    fn shift(&self) -> f64 {
        self.0.shift()
    }

    /// Growth of the twist about L, rad/s.
    #[getter]
    fn twist(&self) -> f64 {
        self.0.twist()
    }

    /// Relative uncertainty of the growth: the difference between two parts of the short run.
    #[getter]
    fn doubt(&self) -> f64 {
        self.0.doubt()
    }

    /// How the run departs from the exact motion after the time t, s: shift in time, s, twist about L, rad, and tilt off the polhode, rad,
    /// with their oscillations.
    ///
    /// >>> import polhode
    /// >>> drift = polhode.phase("two-turn", [1, 2, 3], [0.4, 1, -0.3], step=0.1)
    /// >>> shift, twist, tilt = drift.departure(1e4)
    /// >>> abs(shift / (1e4 * drift.shift) - 1) < 0.01 and abs(tilt) < 0.01
    /// True
    fn departure(&self, #[pyo3(from_py_with = number::t)] t: f64) -> PyResult<(f64, f64, f64)> {
        let found = self.0.departure(finite("t", t)?);
        Ok((found.shift.hi(), found.twist.hi(), found.tilt.hi()))
    }

    /// The attitude error after the time t, s, without oscillations and rounding, rad.
    fn attitude_error(&self, #[pyo3(from_py_with = number::t)] t: f64) -> PyResult<f64> {
        self.0.attitude_error(t).map_err(refused)
    }

    /// The time up to which the prediction holds, s; infinite for a free body.
    #[getter]
    fn holds_until(&self) -> f64 {
        self.0.holds_until()
    }

    /// Order of magnitude of what rounding adds to the attitude error after the time t, s, rad.
    fn rounding(&self, #[pyo3(from_py_with = number::t)] t: f64) -> PyResult<f64> {
        Ok(self.0.rounding(finite("t", t)?))
    }

    fn __repr__(&self) -> String {
        format!("PhaseDrift(shift {:e}, twist {:e} rad/s)", self.0.shift(), self.0.twist())
    }
}

/// How fast the attitude error of `method` grows, predicted from one short run in steps of `step`, s.
///
/// The method must keep energy and |m| of a free body within bounds. Under weak forces the prediction holds up to a time; strong forces are
/// refused. The start is that of `FreeMotion`. `run(method + "+phase", ...)` corrects this error at output.
///
/// >>> import polhode
/// >>> drift = polhode.phase("rattle", [1, 2, 3], [0.4, 1, -0.3], step=0.01)
/// >>> round(drift.attitude_error(1e4), 4)
/// 0.2372
#[pyfunction]
#[pyo3(signature = (method, body, omega = None, attitude = None, *, step, momentum = None, order = "wxyz"))]
#[allow(clippy::too_many_arguments, reason = "they are keywords")]
pub(crate) fn phase(
    py: Python<'_>,
    method: &str,
    body: &Bound<'_, PyAny>,
    omega: Option<&Bound<'_, PyAny>>,
    attitude: Option<&Bound<'_, PyAny>>,
    #[pyo3(from_py_with = number::step)] step: f64,
    momentum: Option<&Bound<'_, PyAny>>,
    order: &str,
) -> PyResult<PhaseDrift> {
    let body = Body::of("body", body)?;
    let start = body.start(&Start { omega, attitude, momentum, time: 0.0, order: Order::of(order)? })?;
    let (start, moved, found) = (body.body.leave(&start), body.body.clone(), named(method, None)?);
    let drift = aside(py, move |_| found.phase(&moved, &start, step))?;
    Ok(PhaseDrift(body.settle(drift.map_err(refused))?))
}

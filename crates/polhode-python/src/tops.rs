//! Lagrange's top.

use polhode::flow;
use pyo3::prelude::*;

use crate::arrays::{Order, array};
use crate::bodies::{Body, Start};
use crate::derivatives::{Asked, matrices};
use crate::error::of;
use crate::motions::Motion;
use crate::states::States;

/// The motion of Lagrange's top, a symmetric body with a fixed point and its weight on the axis: its exact attitude and angular velocity at
/// any time.
///
/// `body` has the force `gravity`, or is the name of a top of the catalogue. The start is given as for `FreeMotion`.
///
/// >>> from polhode import Body, LagrangeTop, gravity
/// >>> top = LagrangeTop(Body([1.25, 1.25, 0.75], [gravity([0, 0, 2])]), [0, 0, 20], [0.97, 0.24, 0, 0])
/// >>> top.at(1e6).omega.shape
/// (3,)
#[pyclass(frozen, module = "polhode")]
pub(crate) struct LagrangeTop {
    top: flow::LagrangeTop,
    order: Order,
}

#[pymethods]
impl LagrangeTop {
    #[new]
    #[pyo3(signature = (body, omega = None, attitude = None, *, momentum = None, order = "wxyz"))]
    fn new(
        body: &Bound<'_, PyAny>,
        omega: Option<&Bound<'_, PyAny>>,
        attitude: Option<&Bound<'_, PyAny>>,
        momentum: Option<&Bound<'_, PyAny>>,
        order: &str,
    ) -> PyResult<Self> {
        let order = Order::of(order)?;
        let body = Body::of("body", body)?;
        let start = body.start(&Start { omega, attitude, momentum, time: 0.0, order })?;
        let top = match flow::ExactMotion::from_point(&body.body, start).map_err(of("body"))? {
            flow::ExactMotion::Lagrange(top) => *top,
            _ => return Err(of("body")(flow::LagrangeError::Free)),
        };
        Ok(LagrangeTop { top, order })
    }

    /// Attitudes and angular velocities at the time `t`, s, of either sign: a number, or an array of any shape.
    #[pyo3(signature = (t, *, order = None))]
    fn at(&self, t: &Bound<'_, PyAny>, order: Option<&str>) -> PyResult<States> {
        self.top.states(t, order.map_or(Ok(self.order), Order::of)?)
    }

    /// The states at `t`, and their derivatives by the start and by the constants of the top: a pair of states and an array of shape
    /// (..., 6, 9).
    ///
    /// Rows: the rotation vector of the attitude, rad, then the angular velocity (`by="omega"`) or the angular momentum (`by="momentum"`) in
    /// body axes. Columns: the same at t = 0, then the transverse moment, the axial moment, kg m^2, and the weight moment, N m. `axes`,
    /// `space` or `body`, are those of the rotation vectors.
    ///
    /// >>> import polhode
    /// >>> states, derivative = polhode.LagrangeTop("gyroscope").at_with_derivative([0, 100])
    /// >>> derivative.shape
    /// (2, 6, 9)
    #[pyo3(signature = (t, *, by = "omega", axes = "space", order = None))]
    fn at_with_derivative<'py>(
        &self,
        t: &Bound<'py, PyAny>,
        by: &str,
        axes: &str,
        order: Option<&str>,
    ) -> PyResult<(States, Bound<'py, PyAny>)> {
        let Asked { axes, by_omega } = Asked::of(by, axes)?;
        let states = self.at(t, order)?;
        let derivative = matrices(t, |t| {
            let there = self.top.at_with_derivative(t).map_err(of("t"))?;
            Ok(if by_omega { there.by_omega(axes) } else { there.by_momentum(axes) })
        })?;
        Ok((states, derivative))
    }

    /// The largest |t|, s, at which the attitude can still be computed.
    #[getter]
    fn reach(&self) -> f64 {
        self.top.reach()
    }

    /// Smallest and largest tilt of the weight moment from the vertical, rad.
    #[getter]
    fn turning_points<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        array(py, self.top.turning_points().to_vec(), &[2])
    }

    /// Time from one largest tilt to the next, s; `None` if the axis does not come back.
    #[getter]
    fn nutation_period(&self) -> Option<f64> {
        self.top.nutation_period()
    }

    /// Advance of the azimuth over one nutation, rad.
    #[getter]
    fn precession_per_nutation(&self) -> Option<f64> {
        self.top.precession_per_nutation()
    }

    fn __repr__(&self) -> String {
        let [least, most] = self.top.turning_points().map(polhode_files::text::short);
        let period = self.nutation_period().map_or("none".into(), polhode_files::text::short);
        format!("LagrangeTop(tilt {least} to {most} rad, nutation period {period} s)")
    }
}

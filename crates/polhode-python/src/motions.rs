//! Motions in closed form, at any time.

use nalgebra::Vector3;
use polhode::body::{Point, State};
use polhode::flow::{self, TimeError};
use polhode::num::Dd;
use polhode_pages::character::quantities;
use polhode_pages::table::{Cell, Column, Table, row};
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyFloat, PyInt};

use crate::arrays::{Numbers, Order, array, room};
use crate::bodies::{Body, Start};
use crate::calm::Listener;
use crate::error::{of, refused};
use crate::states::States;

/// Times between two looks for Ctrl-C.
const PART: usize = 1 << 12;

/// What both motions answer.
trait Motion: Sync {
    fn each_at(&self, times: &[f64], each: impl FnMut(State, Vector3<f64>)) -> Result<(), TimeError>;
    /// At a time that is within reach.
    fn point_at(&self, t: f64) -> Point<f64>;
    fn reach(&self) -> f64;
    fn body(&self) -> &polhode::Body;

    fn states(&self, t: &Bound<'_, PyAny>, order: Order) -> PyResult<States> {
        let py = t.py();
        if t.is_exact_instance_of::<PyFloat>() || t.is_exact_instance_of::<PyInt>() {
            let t: f64 = t.extract().map_err(|_| refused("t: outside the range of a double"))?;
            if t.abs() <= self.reach() && t.is_finite() {
                let x = self.point_at(t);
                let omega = self.body().omega_of(&x).into();
                return Ok(States::one(t, self.body().leave(&x).attitude, omega, order));
            }
        }
        let Numbers { shape, values: times, .. } = Numbers::of("t", t)?;
        let (mut attitudes, mut omegas) = (room(4 * times.len())?, room(3 * times.len())?);
        py.detach(|| {
            let mut listener = Listener::new();
            for part in times.chunks(PART) {
                let each = |x: State, omega: Vector3<f64>| {
                    attitudes.extend_from_slice(&order.write(x.attitude));
                    omegas.extend_from_slice(omega.as_slice());
                };
                self.each_at(part, each).map_err(of("t"))?;
                listener.listen(0.0)?;
            }
            Ok::<_, PyErr>(())
        })?;
        States::many(py, &shape, times, attitudes, omegas, order)
    }
}

macro_rules! motion {
    ($motion:ty) => {
        impl Motion for $motion {
            fn each_at(&self, times: &[f64], each: impl FnMut(State, Vector3<f64>)) -> Result<(), TimeError> {
                <$motion>::each_at(self, times, each)
            }
            fn point_at(&self, t: f64) -> Point<f64> {
                <$motion>::point_at(self, t)
            }
            fn reach(&self) -> f64 {
                <$motion>::reach(self)
            }
            fn body(&self) -> &polhode::Body {
                <$motion>::body(self)
            }
        }
    };
}

motion!(flow::FreeMotion);
motion!(flow::LagrangeTop);

/// The motion of a free body from one start: its exact attitude and angular velocity at any time.
///
/// `inertia` is three principal moments, a tensor, or anything that `Body` takes; the start is the attitude (default: the
/// identity; a quaternion of any norm, or a scipy rotation) and the angular velocity `omega`, rad/s, or the angular momentum
/// `momentum`, kg m^2/s, body axes. What is not given of a body of the catalogue is that of its published motion. `order` is that of
/// quaternions, given and returned.
///
/// >>> from polhode import FreeMotion
/// >>> motion = FreeMotion([1, 2, 3], [0.4, 1, -0.3])
/// >>> attitude, omega = motion.at([0, 1e4, 1e9])
/// >>> omega.shape, motion.at(1e9).attitude.shape
/// ((3, 3), (4,))
#[pyclass(frozen, module = "polhode")]
pub(crate) struct FreeMotion {
    motion: flow::FreeMotion,
    start: Point<Dd>,
    order: Order,
}

#[pymethods]
impl FreeMotion {
    #[new]
    #[pyo3(signature = (inertia, omega = None, attitude = None, *, momentum = None, order = "wxyz"))]
    fn new(
        inertia: &Bound<'_, PyAny>,
        omega: Option<&Bound<'_, PyAny>>,
        attitude: Option<&Bound<'_, PyAny>>,
        momentum: Option<&Bound<'_, PyAny>>,
        order: &str,
    ) -> PyResult<Self> {
        let order = Order::of(order)?;
        let body = Body::of("inertia", inertia)?;
        if let Some(force) = body.body.forces().first() {
            let name = force.name();
            return Err(refused(format!(
                "inertia: {name} acts on the body; a free motion has no forces; take LagrangeTop, or run"
            )));
        }
        let start = body.start(&Start { omega, attitude, momentum, order })?;
        Ok(FreeMotion { motion: flow::FreeMotion::from_point(body.body.inertia(), start), start, order })
    }

    /// Attitudes and angular velocities at the time `t`, s, of either sign: a number, or an array of any shape.
    #[pyo3(signature = (t, *, order = None))]
    fn at(&self, t: &Bound<'_, PyAny>, order: Option<&str>) -> PyResult<States> {
        self.motion.states(t, order.map_or(Ok(self.order), Order::of)?)
    }

    /// The largest |t| at which the phase still has digits, s.
    #[getter]
    fn reach(&self) -> f64 {
        self.motion.reach()
    }

    /// How often the body flips between the start and the time `t`, s.
    fn flips(&self, t: f64) -> PyResult<u64> {
        self.motion.at(t).map(|_| self.motion.flips(Dd::from(t))).map_err(of("t"))
    }

    /// Mode, periods (s), pole (rad) and stability by their names in `polhode motion`; `None` for what the motion does not have.
    ///
    /// >>> import polhode
    /// >>> character = polhode.FreeMotion("toutatis").character()
    /// >>> character["mode"], round(character["polhode_period"] / 86400, 2)
    /// ('long-axis', 5.38)
    fn character<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let all = PyDict::new(py);
        for (name, _, _, _, value) in
            quantities(self.motion.body(), &self.start, &self.motion).map_err(refused)?
        {
            match value {
                Cell::Number(x) => all.set_item(name, x)?,
                Cell::Integer(n) => all.set_item(name, n)?,
                Cell::Text(text) => all.set_item(name, text)?,
                _ => all.set_item(name, py.None())?,
            }
        }
        Ok(all)
    }

    fn __repr__(&self) -> String {
        let Ok(all) = quantities(self.motion.body(), &self.start, &self.motion) else {
            return "FreeMotion: at rest".into();
        };
        let columns = vec![
            Column::new("quantity", "", ""),
            Column::new("value", "", "").digits(7),
            Column::new("unit", "", ""),
        ];
        let mut table = Table::new("motion", "Character of a free motion.", columns);
        for (name, _, unit, _, value) in all.into_iter().filter(|(.., value)| *value != Cell::Empty) {
            table.push(row![name, value, unit]);
        }
        table.terminal().trim_end().into()
    }
}

/// The motion of Lagrange's top from one start, a symmetric body with its weight on the axis: its exact attitude and angular velocity
/// at any time.
///
/// `body` is one with the force `gravity`, or the name of a top of the catalogue; the start is that of `FreeMotion`.
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
        let start = body.start(&Start { omega, attitude, momentum, order })?;
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

    /// The largest |t| at which the phases still have digits, s.
    #[getter]
    fn reach(&self) -> f64 {
        self.top.reach()
    }

    /// Smallest and largest tilt of the weight moment from the vertical, rad.
    #[getter]
    fn turning_points<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        array(py, self.top.turning_points().to_vec(), &[2])
    }

    /// Time from one largest tilt to the next, s; `None` where the axis does not come back.
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

//! Wheels on a body, and its motion with them.

use nalgebra::Vector3;
use polhode::body;
use polhode::flow;
use polhode::num::Dd;
use polhode_files::text::short;
use pyo3::prelude::*;

use crate::arrays::{Numbers, Order, array};
use crate::bodies::{Body, Start};
use crate::error::{of, refused};
use crate::motions::Motion;
use crate::scalars::{maybe, number};
use crate::states::States;
use crate::units::finite;

/// A wheel that a body carries, as `Body(inertia, wheels=[...])`. The inertia of the body includes its wheels, at rest on it.
///
/// `axis` is in body axes, of any length; `inertia` is about this axis, kg m^2; `speed` is relative to the body, rad/s. The speed is held
/// constant: `free` and `driven` make a wheel that turns freely or is driven by a motor.
///
/// >>> from polhode import Body, Wheel
/// >>> wheel = Wheel([0, 0, 1], 0.05, 300)
/// >>> Body([10, 12, 15], wheels=[wheel])
/// Body(principal moments 10, 12, 15; wheels: 1)
#[pyclass(frozen, module = "polhode", from_py_object)]
#[derive(Clone)]
pub(crate) struct Wheel(pub(crate) body::Wheel);

fn vector(name: &'static str, value: &Bound<'_, PyAny>) -> PyResult<Vector3<f64>> {
    Numbers::of(name, value)?.vector()
}

/// An angular velocity of finite numbers, of which a wheel is made.
fn rate(value: &Bound<'_, PyAny>) -> PyResult<Vector3<f64>> {
    let omega = vector("omega", value)?;
    match omega.iter().find(|part| !part.is_finite()) {
        Some(part) => Err(refused(format!("omega: {part} is not a finite number of rad/s"))),
        None => Ok(omega),
    }
}

#[pymethods]
impl Wheel {
    #[new]
    fn new(
        axis: &Bound<'_, PyAny>,
        #[pyo3(from_py_with = number::inertia)] inertia: f64,
        #[pyo3(from_py_with = number::speed)] speed: f64,
    ) -> PyResult<Self> {
        body::Wheel::new(vector("axis", axis)?, inertia, speed).map(Wheel).map_err(refused)
    }

    /// The same wheel, turning without friction. It has its speed when the body turns at `omega`, rad/s, body axes.
    fn free(&self, omega: &Bound<'_, PyAny>) -> PyResult<Self> {
        Ok(Wheel(self.0.free(rate(omega)?)))
    }

    /// The same wheel with a motor that turns it against the body by `torque`, N m, from `begin` to `end`, s (without end if that is `None`).
    /// Before and after that it turns freely. Before the motor begins it has its speed when the body turns at `omega`, rad/s, body axes.
    #[pyo3(signature = (torque, omega, *, begin = 0.0, end = None))]
    fn driven(
        &self,
        #[pyo3(from_py_with = number::torque)] torque: f64,
        omega: &Bound<'_, PyAny>,
        #[pyo3(from_py_with = number::begin)] begin: f64,
        #[pyo3(from_py_with = maybe::end)] end: Option<f64>,
    ) -> PyResult<Self> {
        let works = [begin, end.unwrap_or(f64::INFINITY)];
        self.0.driven(torque, works, rate(omega)?).map(Wheel).map_err(refused)
    }

    /// Its speed relative to the body at the time `t`, s, when the body turns at `omega`, rad/s, body axes.
    fn speed(&self, #[pyo3(from_py_with = number::t)] t: f64, omega: &Bound<'_, PyAny>) -> PyResult<f64> {
        Ok(self.0.speed(finite("t", t)?, rate(omega)?))
    }

    /// Its axis, of length 1, body axes.
    #[getter]
    fn axis<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        array(py, self.0.axis().as_slice().to_vec(), &[3])
    }

    /// Its moment of inertia about the axis, kg m^2.
    #[getter]
    fn inertia(&self) -> f64 {
        self.0.inertia()
    }

    fn __repr__(&self) -> String {
        let [x, y, z] = [0, 1, 2].map(|k| short(self.0.axis()[k]));
        let how = match self.0.motor() {
            _ if self.0.is_held() => format!("held at {} rad/s", short(self.0.speed(0.0, Vector3::zeros()))),
            Some((torque, _)) => format!("driven by {} N m", short(torque)),
            None => "free".into(),
        };
        format!("Wheel(axis {x}, {y}, {z}, inertia {} kg m^2, {how})", short(self.0.inertia()))
    }
}

/// The motion of a body with wheels that are held or free: its exact attitude and angular velocity at any time.
///
/// The start is given as for `FreeMotion`; `momentum` is that of body and wheels together.
///
/// >>> from polhode import Body, GyrostatMotion, Wheel
/// >>> body = Body([10, 12, 15], wheels=[Wheel([0, 1, 1], 0.01, 300)])
/// >>> motion = GyrostatMotion(body, [0.1, -0.05, 0.2])
/// >>> motion.at([0, 1e6]).omega.shape
/// (2, 3)
/// >>> [spin.stability for spin in motion.steady_spins]
/// ['stable', 'stable']
#[pyclass(frozen, module = "polhode")]
pub(crate) struct GyrostatMotion {
    motion: flow::GyrostatMotion,
    order: Order,
}

#[pymethods]
impl GyrostatMotion {
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
        let motion = flow::GyrostatMotion::from_point(&body.body, start).map_err(of("body"))?;
        Ok(GyrostatMotion { motion, order })
    }

    /// Attitudes and angular velocities at the time `t`, s, of either sign: a number, or an array of any shape.
    #[pyo3(signature = (t, *, order = None))]
    fn at(&self, t: &Bound<'_, PyAny>, order: Option<&str>) -> PyResult<States> {
        self.motion.states(t, order.map_or(Ok(self.order), Order::of)?)
    }

    /// The largest |t|, s, at which the attitude can still be computed.
    #[getter]
    fn reach(&self) -> f64 {
        self.motion.reach()
    }

    /// Period of the angular velocity in body axes, s; `None` if it is constant.
    #[getter]
    fn period(&self) -> Option<f64> {
        self.motion.character().period
    }

    /// Angle by which the body turns about L in one period, rad, without whole turns.
    #[getter]
    fn turn_per_period(&self) -> Option<f64> {
        self.motion.character().turn_per_period
    }

    /// The angular momentum of body and wheels in space, kg m^2/s.
    #[getter]
    fn momentum<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        let start = self.motion.body().leave(&self.motion.point_at_dd(Dd::ZERO));
        array(py, self.motion.body().momentum_space(0.0, &start).as_slice().to_vec(), &[3])
    }

    /// The steady spins with the same |L|, by rising energy.
    #[getter]
    fn steady_spins(&self) -> Vec<SteadySpin> {
        self.motion.steady_spins().into_iter().map(SteadySpin).collect()
    }

    fn __repr__(&self) -> String {
        let period = self.period().map_or("none".into(), short);
        format!("GyrostatMotion(period {period} s)")
    }
}

/// A steady spin of a body with wheels.
#[pyclass(frozen, module = "polhode")]
pub(crate) struct SteadySpin(flow::SteadySpin);

#[pymethods]
impl SteadySpin {
    /// Angular velocity, rad/s, body axes.
    #[getter]
    fn omega<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        array(py, self.0.omega_body.as_slice().to_vec(), &[3])
    }

    /// Angular velocity about L, rad/s; negative if the body turns against L.
    #[getter]
    fn rate(&self) -> f64 {
        self.0.rate
    }

    /// `stable`, `unstable` or `neutral`.
    #[getter]
    fn stability(&self) -> &'static str {
        self.0.stability.name()
    }

    /// Frequency of small nutation in body axes, rad/s; 0 unless the spin is stable.
    #[getter]
    fn frequency(&self) -> f64 {
        self.0.frequency
    }

    /// Rate at which a small deviation grows, 1/s; 0 unless the spin is unstable.
    #[getter]
    fn growth_rate(&self) -> f64 {
        self.0.growth_rate
    }

    /// Energy 1/2 omega . I omega, J.
    #[getter]
    fn energy(&self) -> f64 {
        self.0.energy
    }

    fn __repr__(&self) -> String {
        let rate = short(self.0.rate);
        format!("SteadySpin({}, {rate} rad/s about L)", self.0.stability.name())
    }
}

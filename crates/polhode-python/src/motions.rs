//! Motions in closed form, at any time.

use std::collections::HashMap;

use nalgebra::Vector3;
use polhode::body::{Point, State};
use polhode::flow::{self, TimeError, TumblingElements};
use polhode::num::{Covariance, Dd};
use polhode_pages::character::quantities;
use polhode_pages::table::{Cell, Column, Table, row};
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyFloat, PyInt};

use crate::arrays::{Numbers, Order, array, room};
use crate::bodies::{Body, Start};
use crate::calm::{Listener, aside};
use crate::derivatives::{Asked, at_each, matrices, turn_axes};
use crate::error::{of, refused};
use crate::scalars::{number, scalar};
use crate::states::States;
use crate::through::{self, FittedMotion, Passage};

/// All integers below are doubles.
const WHOLE: f64 = (1_u64 << f64::MANTISSA_DIGITS) as f64;

/// Times between two looks for Ctrl-C.
const PART: usize = 1 << 12;

/// Rows that are reserved beyond those of a large array of attitudes, and not touched.
///
/// An allocator that hands memory back at twice its largest block, as glibc's does, would hand back times, attitudes and angular
/// velocities together after each call, and the system's clearing of new pages would cost as much as the motion.
fn spare(rows: usize) -> usize {
    if rows > PART { rows / 4 + PART } else { 0 }
}

/// What all motions answer.
pub(crate) trait Motion: Sync {
    fn each_at(&self, times: &[f64], each: impl FnMut(State, Vector3<f64>)) -> Result<(), TimeError>;
    /// At a time that is within reach.
    fn point_at(&self, t: f64) -> Point<f64>;
    fn reach(&self) -> f64;
    fn body(&self) -> &polhode::Body;

    fn states(&self, t: &Bound<'_, PyAny>, order: Order) -> PyResult<States> {
        let py = t.py();
        let is_float = t.is_exact_instance_of::<PyFloat>();
        if is_float || t.is_exact_instance_of::<PyInt>() {
            let t: f64 = t.extract().map_err(|_| refused("t: outside the range of a double"))?;
            // a larger integer may be no double
            let is_exact = is_float || t.abs() < WHOLE;
            if is_exact && t.abs() <= self.reach() && t.is_finite() {
                let x = self.point_at(t);
                let omega = self.body().omega_of(&x).into();
                return Ok(States::one(t, self.body().leave(&x).attitude, omega, order));
            }
        }
        let Numbers { shape, values: times, .. } = Numbers::of("t", t)?;
        let (mut attitudes, mut omegas) =
            (room::<[f64; 4]>(times.len() + spare(times.len()))?, room::<[f64; 3]>(times.len())?);
        py.detach(|| {
            let mut listener = Listener::new();
            for part in times.chunks(PART) {
                let each = |x: State, omega: Vector3<f64>| {
                    attitudes.push(order.write(x.attitude));
                    omegas.push(omega.into());
                };
                self.each_at(part, each).map_err(of("t"))?;
                listener.listen(0.0)?;
            }
            Ok::<_, PyErr>(())
        })?;
        States::many(py, &shape, times, attitudes.into_flattened(), omegas.into_flattened(), order)
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
motion!(flow::GyrostatMotion);

/// The motion of a free body from one start: its exact attitude and angular velocity at any time.
///
/// - `inertia`: three principal moments, a tensor, or anything else that `Body` takes.
/// - `omega`, rad/s, or `momentum`, kg m^2/s: angular velocity or angular momentum at t = 0, body axes.
/// - `attitude`: attitude at t = 0, body to space: a quaternion of any norm but zero, or a scipy rotation; by default the identity.
/// - `order`: order of quaternions, given and returned.
///
/// For a body of the catalogue, what is not given is that of its published motion.
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
        through::unforced("inertia", &body)?;
        let start = body.start(&Start { omega, attitude, momentum, time: 0.0, order })?;
        Ok(FreeMotion { motion: flow::FreeMotion::from_point(body.body.inertia(), start), start, order })
    }

    /// Attitudes and angular velocities at the time `t`, s, of either sign: a number, or an array of any shape.
    #[pyo3(signature = (t, *, order = None))]
    fn at(&self, t: &Bound<'_, PyAny>, order: Option<&str>) -> PyResult<States> {
        self.motion.states(t, order.map_or(Ok(self.order), Order::of)?)
    }

    /// The states at `t`, and their derivatives by the start and by the inertia tensor, in closed form: a pair of states and an array of
    /// shape (..., 6, 12).
    ///
    /// Rows: the rotation vector of the attitude, rad, then the angular velocity (`by="omega"`) or the angular momentum (`by="momentum"`) in
    /// body axes. Columns: the same at t = 0, then the entries xx, yy, zz, xy, xz, yz of the tensor. `axes`, `space` or `body`, are those
    /// of the rotation vectors.
    ///
    /// >>> import polhode
    /// >>> motion = polhode.FreeMotion([1, 2, 3], [0.4, 1, -0.3])
    /// >>> states, derivative = motion.at_with_derivative([0, 100])
    /// >>> derivative.shape
    /// (2, 6, 12)
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
            let there = self.motion.at_with_derivative(t).map_err(of("t"))?;
            Ok(if by_omega { there.by_omega(axes) } else { there.by_momentum(axes) })
        })?;
        Ok((states, derivative))
    }

    /// The covariance of the state at `t`, propagated from that of the start by the derivative of the motion.
    ///
    /// Returns a pair: an array (..., 6, 6) for rotation vector and angular velocity, and the nonlinearity (...), an estimate of the share of the
    /// spread that the first order leaves out. If it is small, say below 0.1, the covariance can be used; otherwise use an `Ensemble`.
    ///
    /// `covariance` is that of rotation vector, angular velocity and the entries xx, yy, zz, xy, xz, yz of the tensor at t = 0: (12, 12), or
    /// (6, 6) if the tensor is known. `torque`: (3, 3), spectral density of a white torque in body axes, (N m)^2 s. `axes`, "space" or "body", are
    /// those of the rotation vectors.
    ///
    /// >>> import numpy, polhode
    /// >>> motion = polhode.FreeMotion([1, 2, 3], [0.4, 1, -0.3])
    /// >>> state, nonlinearity = motion.covariance(100, numpy.diag([1e-4] * 3 + [1e-5] * 3) ** 2)
    /// >>> state.shape, bool(nonlinearity < 0.01)
    /// ((6, 6), True)
    #[pyo3(signature = (t, covariance, *, axes = "space", torque = None))]
    fn covariance<'py>(
        &self,
        t: &Bound<'py, PyAny>,
        covariance: &Bound<'py, PyAny>,
        axes: &str,
        torque: Option<&Bound<'py, PyAny>>,
    ) -> PyResult<(Bound<'py, PyAny>, Bound<'py, PyAny>)> {
        let matrix = start_covariance(covariance)?;
        let mut start = flow::StartCovariance::new(matrix, turn_axes(axes)?);
        if let Some(torque) = torque {
            let density: [[f64; 3]; 3] = Numbers::of("torque", torque)?.matrix()?.transpose().into();
            start.torque = Covariance::new(density).map_err(of("torque"))?;
        }
        let (shape, found) = at_each(t, |t| self.motion.covariance(t, &start).map_err(of("t")))?;
        let entries = found.iter().flat_map(|found| found.state.transpose().as_slice().to_vec()).collect();
        let nonlinearity = found.iter().map(|found| found.nonlinearity).collect();
        let state = array(t.py(), entries, &[&shape[..], &[6, 6]].concat())?;
        Ok((state, array(t.py(), nonlinearity, &shape)?))
    }

    /// The motion of a tumbling body in the elements of its light curve: two of its periods, s, by the names `P_phi`, `P_psi` and `P_1`;
    /// `mode`, "lam" or "sam"; `pole`, longitude and latitude of the angular momentum, and `phases`, phi and psi at t = 0, rad;
    /// `is_reversed`: whether the axis of the mode points away from the angular momentum.
    ///
    /// >>> import numpy, polhode
    /// >>> apophis = polhode.FreeMotion.tumbling(
    /// ...     [0.61, 0.965, 1], {"P_phi": 27.38 * 3600, "P_psi": 263 * 3600}, "sam", pole=numpy.radians([250, -75]))
    /// >>> round(apophis.character()["combined_period"] / 3600, 2)
    /// 30.56
    #[staticmethod]
    #[pyo3(signature = (inertia, periods, mode, *, pole = None, phases = None, is_reversed = false, order = "wxyz"))]
    fn tumbling(
        inertia: &Bound<'_, PyAny>,
        periods: HashMap<String, Bound<'_, PyAny>>,
        mode: &str,
        pole: Option<&Bound<'_, PyAny>>,
        phases: Option<&Bound<'_, PyAny>>,
        is_reversed: bool,
        order: &str,
    ) -> PyResult<Self> {
        let (order, inertia) = (Order::of(order)?, through::free("inertia", inertia)?);
        let mode = match mode {
            "lam" => flow::Mode::LongAxis,
            "sam" => flow::Mode::ShortAxis,
            _ => return Err(refused(format!("mode: '{mode}' is unknown; write \"lam\" or \"sam\""))),
        };
        let period = |name: &'static str| periods.get(name).map(|value| scalar(name, value)).transpose();
        let pair = |name, value: Option<&Bound<'_, PyAny>>| {
            Numbers::maybe(name, value)?.map(Numbers::fixed::<2>).transpose()
        };
        let (pole, phases) = (pair("pole", pole)?, pair("phases", phases)?);
        let elements = match (periods.len(), period("P_phi")?, period("P_psi")?, period("P_1")?) {
            (2, Some(precession), Some(rotation), None) => {
                Ok(TumblingElements::new(mode, [precession, rotation]))
            }
            (2, Some(precession), None, Some(combined)) => {
                TumblingElements::from_precession_and_combined(mode, [precession, combined])
            }
            (2, None, Some(rotation), Some(combined)) => {
                TumblingElements::from_combined_and_rotation(mode, [combined, rotation])
            }
            _ => {
                let mut given: Vec<&str> = periods.keys().map(String::as_str).collect();
                given.sort_unstable();
                return Err(refused(format!(
                    "periods: '{}'; give two of P_phi, P_psi and P_1, s",
                    given.join(", ")
                )));
            }
        };
        let elements = elements.map_err(of("periods"))?.with_reversed(is_reversed);
        let elements = pole.map_or(elements, |pole| elements.with_pole(pole));
        let elements = phases.map_or(elements, |phases| elements.with_angles(phases));
        let start = elements.point(&inertia).map_err(of("periods"))?;
        Ok(FreeMotion { motion: flow::FreeMotion::from_point(&inertia, start), start, order })
    }

    /// All free motions through two attitudes `attitude` (2, 4) at two times `t`, s, that turn at most `turns` times between them, in
    /// ascending order of their turns.
    ///
    /// >>> import polhode
    /// >>> t, motion = [10, 12], polhode.FreeMotion([1, 2, 3], [0.4, 1, -0.3])
    /// >>> found = polhode.FreeMotion.through([1, 2, 3], t, motion.at(t).attitude, turns=1)
    /// >>> any(abs(passage.omega - motion.at(10).omega).max() < 1e-12 for passage in found)
    /// True
    #[staticmethod]
    #[pyo3(signature = (inertia, t, attitude, *, turns = 1.0, order = "wxyz"))]
    fn through(
        inertia: &Bound<'_, PyAny>,
        t: &Bound<'_, PyAny>,
        attitude: &Bound<'_, PyAny>,
        #[pyo3(from_py_with = number::turns)] turns: f64,
        order: &str,
    ) -> PyResult<Vec<Passage>> {
        let (order, inertia) = (Order::of(order)?, through::free("inertia", inertia)?);
        let &[first, second] = through::table(t, attitude, order)?.as_slice() else {
            return Err(refused("t: give two times and two attitudes; Interpolation takes more"));
        };
        let found = aside(t.py(), move |_| flow::FreeMotion::through(&inertia, first, second, turns))?;
        let passages = found.map_err(refused)?.list.into_iter();
        Ok(passages.map(|passage| Passage { passage, order }).collect())
    }

    /// The free motion that fits the attitudes `attitude` (n, 4) at the times `t`, s, best, from a `guess` near it whose t = 0 is the first
    /// time. `noise`: standard deviation of each component of the error of an attitude, rad.
    ///
    /// >>> import numpy, polhode
    /// >>> t, motion = numpy.arange(50) * 0.5, polhode.FreeMotion([1, 2, 3], [0.4, 1, -0.3])
    /// >>> guess = polhode.FreeMotion([1, 2, 3], [0.41, 1, -0.3])
    /// >>> fitted = polhode.FreeMotion.fitted([1, 2, 3], t, motion.at(t).attitude, noise=1e-3, guess=guess)
    /// >>> bool(abs(fitted.motion.at(0).omega - [0.4, 1, -0.3]).max() < 1e-12)
    /// True
    #[staticmethod]
    #[pyo3(signature = (inertia, t, attitude, *, noise, guess, order = "wxyz"))]
    fn fitted(
        inertia: &Bound<'_, PyAny>,
        t: &Bound<'_, PyAny>,
        attitude: &Bound<'_, PyAny>,
        #[pyo3(from_py_with = number::noise)] noise: f64,
        guess: &Bound<'_, FreeMotion>,
        order: &str,
    ) -> PyResult<FittedMotion> {
        let (order, inertia) = (Order::of(order)?, through::free("inertia", inertia)?);
        let (table, guess) = (through::table(t, attitude, order)?, guess.get().motion.clone());
        let found = aside(t.py(), move |_| flow::FreeMotion::fitted(&inertia, &table, noise, &guess))?;
        Ok(FittedMotion { found: found.map_err(refused)?, order })
    }

    /// The largest |t|, s, at which the attitude can still be computed.
    #[getter]
    fn reach(&self) -> f64 {
        self.motion.reach()
    }

    /// How often the body turns over between the start and the time `t`, s.
    fn flips(&self, #[pyo3(from_py_with = number::t)] t: f64) -> PyResult<u64> {
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

impl FreeMotion {
    pub(crate) fn of(motion: flow::FreeMotion, order: Order) -> Self {
        FreeMotion { start: motion.point_at_dd(Dd::ZERO), motion, order }
    }
}

/// Of (12, 12), or of (6, 6) and a tensor that is known.
fn start_covariance(value: &Bound<'_, PyAny>) -> PyResult<Covariance<12>> {
    let numbers = Numbers::of("covariance", value)?;
    let n = match numbers.shape.as_slice() {
        [12, 12] => 12,
        [6, 6] => 6,
        _ => return Err(numbers.unexpected("(12, 12) or (6, 6)")),
    };
    let mut matrix = [[0.0; 12]; 12];
    for (row, values) in matrix.iter_mut().zip(numbers.values.chunks(n)) {
        row[..n].copy_from_slice(values);
    }
    Covariance::new(matrix).map_err(of("covariance"))
}

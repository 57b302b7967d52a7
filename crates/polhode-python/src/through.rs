//! Free motions through given attitudes.

use nalgebra::UnitQuaternion;
use polhode::flow;
use polhode::inertia::Inertia;
use pyo3::prelude::*;

use crate::arrays::{Numbers, Order, array, quaternions, room, unit};
use crate::bodies::Body;
use crate::calm::{Listener, aside};
use crate::derivatives::at_each;
use crate::error::{of, refused, warn};
use crate::motions::FreeMotion;
use crate::scalars::number;
use crate::states::States;

/// Jumps of the angular velocity up to this share of it are those of rounding.
const SMOOTH: f64 = 1e-6;

/// One free motion through two attitudes.
#[pyclass(frozen, module = "polhode")]
pub(crate) struct Passage {
    pub(crate) passage: flow::Passage,
    pub(crate) order: Order,
}

#[pymethods]
impl Passage {
    /// The motion, whose t = 0 is the earlier of the two times.
    #[getter]
    fn motion(&self) -> FreeMotion {
        FreeMotion::of(self.passage.motion.clone(), self.order)
    }

    /// Angular velocity at the earlier time, body axes, rad/s.
    #[getter]
    fn omega<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        array(py, self.passage.omega_body.as_slice().to_vec(), &[3])
    }

    /// Number of turns between the attitudes: mean spin times the time between them.
    #[getter]
    fn turns(&self) -> f64 {
        self.passage.turns
    }

    /// Angle between the attitude that it reaches and the one asked for, rad.
    #[getter]
    fn miss(&self) -> f64 {
        self.passage.miss
    }

    /// Whether the search that found it is known to have found all motions.
    #[getter]
    fn complete(&self) -> bool {
        self.passage.complete
    }

    fn __repr__(&self) -> String {
        let [x, y, z] = [0, 1, 2].map(|axis| polhode_files::text::short(self.passage.omega_body[axis]));
        format!("Passage({} turns, omega [{x}, {y}, {z}])", polhode_files::text::short(self.passage.turns))
    }
}

/// The free motion that fits a table of attitudes best.
#[pyclass(frozen, module = "polhode")]
pub(crate) struct FittedMotion {
    pub(crate) found: flow::FittedMotion,
    pub(crate) order: Order,
}

#[pymethods]
impl FittedMotion {
    /// The motion, whose t = 0 is the first time of the table.
    #[getter]
    fn motion(&self) -> FreeMotion {
        FreeMotion::of(self.found.motion.clone(), self.order)
    }

    /// Covariance of its start: of the rotation vector in space, rad, then of the angular momentum in body axes: (6, 6).
    #[getter]
    fn covariance<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        array(py, self.found.covariance.transpose().as_slice().to_vec(), &[6, 6])
    }

    /// Mean square of the residuals over the noise.
    #[getter]
    fn chi2_per_dof(&self) -> f64 {
        self.found.chi2_per_dof
    }

    fn __repr__(&self) -> String {
        format!("FittedMotion(chi2_per_dof {:.3})", self.found.chi2_per_dof)
    }
}

/// The exact free motion through the attitudes of a table. Between two rows, of all motions that turn at most `turns` times, the smoothest is
/// taken.
///
/// `inertia` is what `FreeMotion` takes; the times `t`, s, ascend; `attitude` is (n, 4), or a scipy rotation. A warning says if the attitudes
/// are not those of one free motion.
///
/// >>> import numpy, polhode
/// >>> t = numpy.arange(20.0)
/// >>> motion = polhode.FreeMotion([1, 2, 3], [0.4, 1, -0.3])
/// >>> between = polhode.Interpolation([1, 2, 3], t, motion.at(t).attitude, turns=0.5)
/// >>> attitude, omega = between.at([0.5, 7.25])
/// >>> bool(abs(attitude - motion.at([0.5, 7.25]).attitude).max() < 1e-12), bool(between.largest_jump < 1e-12)
/// (True, True)
#[pyclass(frozen, module = "polhode")]
pub(crate) struct Interpolation {
    found: flow::Interpolation,
    inertia: Inertia,
    order: Order,
}

#[pymethods]
impl Interpolation {
    #[new]
    #[pyo3(signature = (inertia, t, attitude, *, turns = 1.0, order = "wxyz"))]
    fn new(
        inertia: &Bound<'_, PyAny>,
        t: &Bound<'_, PyAny>,
        attitude: &Bound<'_, PyAny>,
        #[pyo3(from_py_with = number::turns)] turns: f64,
        order: &str,
    ) -> PyResult<Self> {
        let (order, inertia) = (Order::of(order)?, free("inertia", inertia)?);
        let table = table(t, attitude, order)?;
        let body = inertia.clone();
        let found =
            aside(t.py(), move |_| flow::Interpolation::new(&body, &table, turns))?.map_err(refused)?;
        let fastest = found.pieces().iter().map(|piece| piece.omega_body.norm()).fold(0.0, f64::max);
        if found.largest_jump() > SMOOTH * fastest {
            warn(
                t.py(),
                &format!(
                    "these are not attitudes of one free motion: the angular velocity jumps by up to {:.1e} rad/s at them",
                    found.largest_jump()
                ),
            )?;
        }
        Ok(Interpolation { found, inertia, order })
    }

    /// Attitudes and angular velocities at the time `t`, s, between the first and the last of the table: an array of any shape.
    #[pyo3(signature = (t, *, order = None))]
    fn at(&self, t: &Bound<'_, PyAny>, order: Option<&str>) -> PyResult<States> {
        let order = order.map_or(Ok(self.order), Order::of)?;
        let Numbers { shape, values: times, .. } = Numbers::of("t", t)?;
        let (mut attitudes, mut omegas) = (room::<[f64; 4]>(times.len())?, room::<[f64; 3]>(times.len())?);
        let body = polhode::Body::free(self.inertia.clone());
        t.py().detach(|| {
            let mut listener = Listener::new();
            times.iter().try_for_each(|&t| {
                listener.listen(0.0)?;
                let (state, _) = self.found.at(t).map_err(of("t"))?;
                attitudes.push(order.write(state.attitude));
                omegas.push(body.omega_body(&state).into());
                Ok::<_, PyErr>(())
            })
        })?;
        States::many(t.py(), &shape, times, attitudes.into_flattened(), omegas.into_flattened(), order)
    }

    /// Angle between the attitude and that of `slerp` between the two neighbours of the table, rad, at the time `t`.
    fn beside_slerp<'py>(&self, t: &Bound<'py, PyAny>) -> PyResult<Bound<'py, PyAny>> {
        let (shape, angles) = at_each(t, |t| self.found.at(t).map(|(_, angle)| angle).map_err(of("t")))?;
        array(t.py(), angles, &shape)
    }

    /// First and last time, s.
    #[getter]
    fn span(&self) -> (f64, f64) {
        let [first, last] = self.found.span();
        (first, last)
    }

    /// Largest jump of the angular velocity at an attitude of the table, rad/s.
    #[getter]
    fn largest_jump(&self) -> f64 {
        self.found.largest_jump()
    }

    fn __repr__(&self) -> String {
        let [first, last] = self.found.span().map(polhode_files::text::short);
        format!("Interpolation({} motions from {first} s to {last} s)", self.found.pieces().len())
    }
}

/// The inertia of a body on which nothing acts.
pub(crate) fn free(name: &'static str, value: &Bound<'_, PyAny>) -> PyResult<Inertia> {
    let body = Body::of(name, value)?;
    unforced(name, &body)?;
    Ok(body.body.inertia().clone())
}

/// Refuses a body that forces act on.
pub(crate) fn unforced(name: &'static str, body: &Body) -> PyResult<()> {
    if !body.body.wheels().is_empty() {
        return Err(refused(format!("{name}: the body carries wheels; use GyrostatMotion, or run")));
    }
    match body.body.forces().first() {
        None => Ok(()),
        Some(force) => Err(refused(format!(
            "{name}: {} acts on the body; a free motion has no forces; use LagrangeTop, or run",
            force.name()
        ))),
    }
}

/// Times with their attitudes.
pub(crate) fn table(
    t: &Bound<'_, PyAny>,
    attitude: &Bound<'_, PyAny>,
    order: Order,
) -> PyResult<Vec<(f64, UnitQuaternion<f64>)>> {
    let times = Numbers::of("t", t)?.list()?;
    let (numbers, order) = quaternions("attitude", attitude, order)?;
    let rows = numbers.rows::<4>(Some(times.len()))?;
    let turns = rows.into_iter().map(|row| unit("attitude", order.read(row)));
    times.into_iter().zip(turns).map(|(t, turn)| Ok((t, turn?))).collect()
}

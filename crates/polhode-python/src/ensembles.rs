//! Many bodies, each from its own start.

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};

use nalgebra::{Matrix3, Quaternion, UnitQuaternion, Vector3};
use polhode::body::{Clock, State, WheelError};
use polhode::inertia::Inertia;
use polhode::rotation::{Quat, Vec3};
use polhode::run::{self, EnsembleError, Rows};
use pyo3::prelude::*;

use crate::arrays::{Numbers, Order, quaternions, room};
use crate::bodies::Body;
use crate::calm::{self, Listener, aside_telling};
use crate::error::{of, refused};
use crate::runs::{named, warn_coarse};
use crate::scalars::{number, threads};
use crate::states::States;

/// Bodies with their starts, propagated together on all cores. Members do not act on each other.
///
/// - `body`: one body for all members, as `Body` takes it, with its forces; or in its place `moments` (n, 3) or `tensors` (n, 3, 3), those of
///   each member.
/// - `omega`, rad/s, or `momentum`, kg m^2/s, in body axes: (n, 3), or (3,) for all members.
/// - `attitude`: (n, 4), or (4,) for all members, or a scipy rotation. Without it members start with the attitude that the catalogue has of
///   `body`, else with the identity.
/// - `threads`: largest number of threads; 0 means one for each core.
///
/// >>> import numpy, polhode
/// >>> omega = [0.4, 1, -0.3] + numpy.random.default_rng(1).normal(0, 0.01, (1000, 3))
/// >>> ensemble = polhode.Ensemble([1, 2, 3], omega)
/// >>> ensemble.at([0, 10, 1000]).attitude.shape
/// (3, 1000, 4)
#[pyclass(frozen, module = "polhode")]
pub(crate) struct Ensemble {
    members: Arc<run::Ensemble>,
    body: Option<Body>,
    order: Order,
    /// Of the first member, rad/s.
    speed: f64,
}

#[pymethods]
impl Ensemble {
    #[new]
    #[pyo3(signature = (body = None, omega = None, attitude = None, *, momentum = None, moments = None, tensors = None, threads = 0,
                        order = "wxyz"))]
    #[allow(clippy::too_many_arguments, reason = "they are keywords")]
    fn new(
        py: Python<'_>,
        body: Option<&Bound<'_, PyAny>>,
        omega: Option<&Bound<'_, PyAny>>,
        attitude: Option<&Bound<'_, PyAny>>,
        momentum: Option<&Bound<'_, PyAny>>,
        moments: Option<&Bound<'_, PyAny>>,
        tensors: Option<&Bound<'_, PyAny>>,
        #[pyo3(from_py_with = threads)] threads: usize,
        order: &str,
    ) -> PyResult<Self> {
        let order = Order::of(order)?;
        let body = body.map(|body| Body::of("body", body)).transpose()?;
        let inertias: Vec<Inertia> = match (&body, moments, tensors) {
            (Some(body), None, None) => vec![body.body.locked_inertia().clone()],
            (None, Some(moments), None) => {
                let rows = Numbers::of("moments", moments)?.rows::<3>(None)?;
                rows.into_iter()
                    .enumerate()
                    .map(|(k, row)| Inertia::from_moments(row).map_err(member("moments", k)))
                    .collect::<PyResult<_>>()?
            }
            (None, None, Some(tensors)) => {
                let numbers = Numbers::of("tensors", tensors)?;
                let &[_, 3, 3] = numbers.shape.as_slice() else {
                    return Err(numbers.unexpected("(n, 3, 3)"));
                };
                py.detach(|| {
                    let mut listener = Listener::new();
                    let rows = numbers.values.as_chunks::<9>().0.iter().enumerate();
                    rows.map(|(k, row)| {
                        listener.listen(0.0)?;
                        Inertia::from_tensor(Matrix3::from_row_slice(row)).map_err(member("tensors", k))
                    })
                    .collect::<PyResult<Vec<_>>>()
                })?
            }
            _ => return Err(refused("body, moments, tensors: give one of them")),
        };
        let (name, rotations, is_omega) = match (omega, momentum) {
            (Some(omega), None) => ("omega", Numbers::of("omega", omega)?, true),
            (None, Some(momentum)) => ("momentum", Numbers::of("momentum", momentum)?, false),
            _ => return Err(refused("omega, momentum: give one of the two")),
        };
        let rotations = one_or_rows::<3>(rotations)?;
        let (attitudes, written) = match attitude {
            None => {
                let known = body.as_ref().and_then(|body| body.named.as_deref());
                (vec![known.map_or([1.0, 0.0, 0.0, 0.0], |known| known.attitude)], Order::First)
            }
            Some(attitude) => {
                let (numbers, order) = quaternions("attitude", attitude, order)?;
                (one_or_rows::<4>(numbers)?, order)
            }
        };
        let n = inertias.len().max(rotations.len()).max(attitudes.len());
        let counts = [inertias.len(), rotations.len(), attitudes.len()];
        if counts.iter().any(|count| *count != 1 && *count != n) {
            let [inertias, rotations, attitudes] = counts;
            return Err(refused(format!(
                "inertia of {inertias} members, {name} of {rotations}, attitude of {attitudes}: each must be of all members, or of 1"
            )));
        }
        let wheels = body.as_ref().map(|body| body.body.wheels()).unwrap_or_default();
        if !wheels.iter().all(polhode::body::Wheel::is_held) {
            return Err(refused(
                "body: the momentum of a wheel that is free or driven depends on the start, which differs from member to member; give wheels \
                 whose speed is held",
            ));
        }
        let of_wheels: Vec3<f64> =
            body.as_ref().map_or(Vec3::zero(), |body| body.body.momentum_of_wheels_at(0.0).into());
        let first = State { attitude: Quat::identity(), momentum_body: Vec3(rotations[0]) - of_wheels };
        let speed = match is_omega {
            true => Vector3::from(rotations[0]).norm(),
            false => polhode::Body::free(inertias[0].clone()).omega_body(&first).norm(),
        };
        let mut members = run::Ensemble::with_capacity(n).threads(threads);
        for k in 0..n {
            let inertia = &inertias[k % inertias.len()];
            let attitude = written.read(attitudes[k % attitudes.len()]);
            let rotation = Vec3(rotations[k % rotations.len()]);
            if is_omega {
                let [w, x, y, z] = attitude.components();
                // of any norm: the library makes it 1, or refuses it
                let attitude = UnitQuaternion::new_unchecked(Quaternion::new(w, x, y, z));
                members.push_omega(inertia, attitude, rotation.0.into());
            } else {
                members.push(inertia, &State { attitude, momentum_body: rotation - of_wheels });
            }
        }
        let acts = |body: &&Body| !(body.body.forces().is_empty() && body.body.wheels().is_empty());
        if let Some(acting) = body.as_ref().filter(acts) {
            let (forces, wheels) = (acting.body.forces().to_vec(), acting.body.wheels().to_vec());
            members = members.acted_on(move |inertia| {
                let free = polhode::Body::free(inertia.clone());
                let carrier = wheels.iter().try_fold(free, |body, wheel| body.with_wheel(*wheel))?;
                Ok::<_, WheelError>(forces.iter().fold(carrier, |body, force| body.with(force.clone())))
            });
        }
        Ok(Ensemble { members: Arc::new(members), body, order, speed })
    }

    /// The exact motion of every member at `times`, s, of either sign: attitudes (times, members, 4) and angular velocities (times,
    /// members, 3). `progress` is called as `progress(stage, done, seconds)` some times a second, and at the end.
    #[pyo3(signature = (times, *, progress = None))]
    fn at(
        &self,
        py: Python<'_>,
        times: &Bound<'_, PyAny>,
        #[pyo3(from_py_with = calm::progress)] progress: Option<Py<PyAny>>,
    ) -> PyResult<States> {
        let times = Numbers::of("times", times)?.list()?;
        let mut rows = Collected::new(times.len(), self.members.len())?;
        let (members, order, instants) = (Arc::clone(&self.members), self.order, times.clone());
        let tell = rows.told(progress.as_ref().map(|progress| progress.bind(py)));
        let work = move |stop: &AtomicBool| {
            let found = members.at(&instants, |part: &Rows| rows.take(part, order, stop));
            found.map(|()| rows)
        };
        let found = aside_telling(py, work, tell)?;
        self.finished(py, found, times)
    }

    /// Every member moved by `method` in steps of `step`, s, to `times`, s, which ascend from `start_time` on by whole numbers of steps.
    #[pyo3(signature = (method, *, times, step, start_time = 0.0, progress = None))]
    fn run(
        &self,
        py: Python<'_>,
        method: &str,
        times: &Bound<'_, PyAny>,
        #[pyo3(from_py_with = number::step)] step: f64,
        #[pyo3(from_py_with = number::start_time)] start_time: f64,
        #[pyo3(from_py_with = calm::progress)] progress: Option<Py<PyAny>>,
    ) -> PyResult<States> {
        let times = Numbers::of("times", times)?.list()?;
        let method = named(method, None)?;
        if method.tolerance().is_none() {
            warn_coarse(py, step, self.speed)?;
        }
        let clock = Clock { start: start_time, step };
        let schedule = run::Schedule::at_times(clock, &times).map_err(of("times"))?;
        let steps: Vec<u64> = schedule.into_iter().collect();
        if steps.len() != times.len() {
            return Err(refused("times: two of them are the same step; give each once"));
        }
        let mut rows = Collected::new(times.len(), self.members.len())?;
        let (members, order) = (Arc::clone(&self.members), self.order);
        let tell = rows.told(progress.as_ref().map(|progress| progress.bind(py)));
        let work = move |stop: &AtomicBool| {
            let each = |part: &Rows| rows.take(part, order, stop);
            let found = members.advance(method.as_ref(), clock, &steps, each);
            found.map(|()| rows)
        };
        let found = aside_telling(py, work, tell)?;
        self.finished(py, found, times)
    }

    fn __len__(&self) -> usize {
        self.members.len()
    }

    fn __repr__(&self) -> String {
        format!("Ensemble({} members)", self.members.len())
    }
}

impl Ensemble {
    fn finished(
        &self,
        py: Python<'_>,
        found: Result<Collected, Stopped>,
        times: Vec<f64>,
    ) -> PyResult<States> {
        let found = found.map_err(|Stopped(error)| refused(error));
        let rows = match &self.body {
            Some(body) => body.settle(found)?,
            None => found?,
        };
        let shape = [times.len(), self.members.len()];
        let all = times.iter().flat_map(|t| std::iter::repeat_n(*t, shape[1])).collect();
        States::many(py, &shape, all, rows.attitudes, rows.omegas, self.order)
    }
}

/// Why an ensemble ended before its end, in words.
struct Stopped(String);

impl From<EnsembleError> for Stopped {
    fn from(error: EnsembleError) -> Self {
        Stopped(error.to_string())
    }
}

/// Rows of all members at all times.
struct Collected {
    members: usize,
    attitudes: Vec<f64>,
    omegas: Vec<f64>,
    /// Rows that are done, of how many.
    done: Arc<AtomicUsize>,
    all: usize,
}

impl Collected {
    fn new(times: usize, members: usize) -> PyResult<Self> {
        let count = times.checked_mul(members).filter(|count| *count < usize::MAX / 4);
        let count = count.ok_or_else(|| refused("times: too many for so many members"))?;
        let (mut attitudes, mut omegas) = (room::<f64>(4 * count)?, room::<f64>(3 * count)?);
        attitudes.resize(4 * count, 0.0);
        omegas.resize(3 * count, 0.0);
        Ok(Collected { members, attitudes, omegas, done: Arc::default(), all: count })
    }

    /// What tells `progress`, if it is given, how much is done.
    fn told<'a>(&self, progress: Option<&'a Bound<'_, PyAny>>) -> impl Fn() -> PyResult<()> + use<'a> {
        let (done, all) = (Arc::clone(&self.done), self.all.max(1) as f64);
        move || {
            let Some(progress) = progress else { return Ok(()) };
            let share = done.load(Ordering::Relaxed) as f64 / all;
            progress.call1(("ensemble", share, progress.py().None())).map(drop)
        }
    }

    fn take(&mut self, part: &Rows, order: Order, stop: &AtomicBool) -> Result<(), Stopped> {
        if stop.load(Ordering::Relaxed) {
            return Err(Stopped("stopped".into()));
        }
        if let Some((k, _, error)) = part.failures().next() {
            return Err(Stopped(format!("member {k}: {error}")));
        }
        for time in 0..part.times() {
            let first = time * self.members + part.first();
            let (q, w) = (&mut self.attitudes[4 * first..], &mut self.omegas[3 * first..]);
            for (to, x) in q.as_chunks_mut::<4>().0.iter_mut().zip(part.states(time)) {
                *to = order.write(x.attitude);
            }
            for (to, omega) in w.as_chunks_mut::<3>().0.iter_mut().zip(part.omegas(time)) {
                *to = (*omega).into();
            }
            self.done.fetch_add(part.states(time).len(), Ordering::Relaxed);
        }
        Ok(())
    }
}

/// Rows of `N` numbers, or one for all.
fn one_or_rows<const N: usize>(numbers: Numbers) -> PyResult<Vec<[f64; N]>> {
    match numbers.shape.as_slice() {
        [_] => numbers.fixed().map(|row| vec![row]),
        [n, columns] if *columns == N && *n > 0 => numbers.rows(None),
        _ => Err(numbers.unexpected(&format!("({N},) or (n, {N})"))),
    }
}

fn member<E: std::fmt::Display>(name: &'static str, k: usize) -> impl Fn(E) -> PyErr {
    move |error| refused(format!("{name}: member {k}: {error}"))
}

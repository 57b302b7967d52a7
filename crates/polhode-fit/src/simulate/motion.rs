//! The motion of a body with drag, torques and a wheel.

use crate::setters::setters;
use crate::thresholds::simulate::{IMPULSES, LAST_TERM, STEPS, TERMS, TERMS_OF_IMPULSES};
use nalgebra::{Matrix3, UnitQuaternion, Vector3};
use polhode::body::{StateError, Wheel};
use polhode::flow::FreeMotion;
use polhode::inertia::Inertia;
use polhode::num::Random;
use polhode::rotation::Quat;

use crate::simulate::{SimulationError, check};

/// What acts on a simulated body, in its own axes; the default is the free body.
///
/// p' = p × ω − k J ω − D ω + τ + white noise, with p = J ω + h and the momentum h(t) of wheels.
#[non_exhaustive]
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Disturbances {
    /// Drag k in proportion to the momentum of the body, 1/s.
    pub relative_drag: f64,
    /// Viscous drag about each body axis, the diagonal of D, N m s.
    pub drag: Vector3<f64>,
    /// Constant torque τ, N m.
    pub torque: Vector3<f64>,
    /// White noise of each component of the torque from time 0 on: standard deviation of the impulse of 1 s, N m √s.
    pub torque_noise: f64,
    /// Momentum of a wheel at time 0, N m s.
    pub wheel: Vector3<f64>,
    /// Its change, N m.
    pub wheel_rate: Vector3<f64>,
    /// Wheels besides; with those that are not held J is [`Body::inertia`](polhode::body::Body::inertia), which is without `J a aᵀ` of each.
    pub wheels: Vec<Wheel>,
}

impl Disturbances {
    setters! {
        options {}
        values {
            relative_drag => with_relative_drag(f64),
            drag => with_drag(Vector3<f64>),
            torque => with_torque(Vector3<f64>),
            torque_noise => with_torque_noise(f64),
            wheel => with_wheel(Vector3<f64>),
            wheel_rate => with_wheel_rate(Vector3<f64>),
            wheels => with_wheels(Vec<Wheel>),
        }
    }

    pub(super) fn check(&self) -> Result<(), SimulationError> {
        check("the relative drag", &[self.relative_drag], false)?;
        check("a drag", self.drag.as_slice(), false)?;
        check("a torque", self.torque.as_slice(), true)?;
        check("the noise of the torque", &[self.torque_noise], false)?;
        check("a momentum of the wheel", self.wheel.as_slice(), true)?;
        check("a change of the wheel's momentum", self.wheel_rate.as_slice(), true)
    }

    /// Momentum h of the wheels at time `t`, N m s.
    #[must_use]
    pub fn wheel_at(&self, t: f64) -> Vector3<f64> {
        // of a wheel that is not held it is that relative to a body at rest
        self.relative_at(t, Vector3::zeros())
    }

    /// Momentum of the wheels at time `t` relative to the body, which turns at `omega` then.
    fn relative_at(&self, t: f64, omega: Vector3<f64>) -> Vector3<f64> {
        let of_wheels =
            self.wheels.iter().map(|wheel| wheel.axis() * (wheel.inertia() * wheel.speed(t, omega)));
        of_wheels.fold(self.wheel + self.wheel_rate * t, |sum, one| sum + one)
    }

    /// Momentum h of the wheels just after time `t`, or just before it, and its change.
    fn wheels_at(&self, t: f64, after: bool) -> [Vector3<f64>; 2] {
        let change = self.wheels.iter().filter_map(|wheel| {
            let (torque, [from, to]) = wheel.motor()?;
            let works = if after { from <= t && t < to } else { from < t && t <= to };
            works.then(|| wheel.axis() * torque)
        });
        [self.wheel_at(t), change.fold(self.wheel_rate, |sum, one| sum + one)]
    }

    /// When motors begin and end.
    fn switchings(&self) -> impl Iterator<Item = f64> {
        let motors = self.wheels.iter().filter_map(Wheel::motor);
        motors.flat_map(|(_, times)| times).filter(|time| time.is_finite())
    }

    /// True rates at `times`, the component k at times + skew_k, and attitudes at `times`, 1 at time 0.
    pub(super) fn motion(
        &self,
        inertia: &Inertia,
        omega: Vector3<f64>,
        times: &[f64],
        skew: Vector3<f64>,
        random: &mut Random,
    ) -> Result<True, SimulationError> {
        let mut reads: Vec<Read> = Vec::with_capacity(times.len());
        for (sample, &time) in times.iter().enumerate() {
            if skew == Vector3::zeros() {
                reads.push(Read { time, sample, of: Of::Everything });
            } else {
                reads.extend((0..3).map(|k| Read { time: time + skew[k], sample, of: Of::Axis(k) }));
                reads.push(Read { time, sample, of: Of::Attitude });
            }
        }
        if let Some(read) = reads.iter().find(|read| !read.time.is_finite()) {
            return Err(StateError::NotFinite { quantity: "time", value: read.time }.into());
        }
        let mut found = True {
            rates: vec![Vector3::zeros(); times.len()],
            attitudes: vec![Quat::identity(); times.len()],
            wheel: vec![Vector3::zeros(); times.len()],
        };
        let mut store = |read: &Read, (rate, attitude): (Vector3<f64>, Quat<f64>)| match read.of {
            Of::Axis(k) => found.rates[read.sample][k] = rate[k],
            Of::Everything | Of::Attitude => {
                if matches!(read.of, Of::Everything) {
                    found.rates[read.sample] = rate;
                }
                found.attitudes[read.sample] = attitude;
                found.wheel[read.sample] = self.relative_at(read.time, rate);
            }
        };
        // also the door where the start is checked
        let free = FreeMotion::from_omega(inertia, UnitQuaternion::identity(), omega)?;
        if *self == Disturbances::default() {
            let frame = inertia.principal_axes();
            let moments = Vector3::from(inertia.principal_moments());
            for read in &reads {
                let state = free
                    .at(read.time)
                    .map_err(|_| StateError::NotFinite { quantity: "time", value: read.time })?;
                let along = frame.inverse() * Vector3::from(state.momentum_body);
                store(read, (frame * along.component_div(&moments), state.attitude));
            }
        } else {
            reads.sort_by(|a, b| a.time.total_cmp(&b.time));
            let split = reads.partition_point(|read| read.time < 0.0);
            let last = reads.last().map_or(0.0, |read| read.time);
            let count = |reads: &[Read]| reads.iter().filter(|read| !matches!(read.of, Of::Attitude)).count();
            let mut path = Path::new(self, inertia, omega, count(&reads[split..]), Some(last), random);
            for read in &reads[split..] {
                store(read, path.at(read.time)?);
            }
            let mut path = Path::new(self, inertia, omega, count(&reads[..split]), None, random);
            for read in reads[..split].iter().rev() {
                store(read, path.at(read.time)?);
            }
        }
        Ok(found)
    }
}

/// What a perfect sensor would read.
pub(super) struct True {
    pub(super) rates: Vec<Vector3<f64>>,
    pub(super) attitudes: Vec<Quat<f64>>,
    /// Momentum of the wheels relative to the body, N m s.
    pub(super) wheel: Vec<Vector3<f64>>,
}

/// What is read of a sample.
#[derive(Clone, Copy)]
enum Of {
    Everything,
    Axis(usize),
    Attitude,
}

/// A part of a sample, and when it is read.
struct Read {
    time: f64,
    sample: usize,
    of: Of,
}

/// A motion followed from time 0, in units in which the trace of the tensor is of order 1.
struct Path<'a> {
    acting: &'a Disturbances,
    scale: f64,
    inverse: Matrix3<f64>,
    /// Whether it is followed to later times.
    forward: bool,
    /// Times and impulses of the torque's noise, the next one last; and zeros where the torque of a motor changes.
    impulses: Vec<(f64, Vector3<f64>)>,
    terms: usize,
    steps: usize,
    most_steps: usize,
    series: Series,
}

/// Power series of p, ω and the attitude about a time.
struct Series {
    time: f64,
    momentum: Vec<Vector3<f64>>,
    rate: Vec<Vector3<f64>>,
    attitude: Vec<Quat<f64>>,
}

impl<'a> Path<'a> {
    /// Up to the time `last`, or to times before 0.
    fn new(
        acting: &'a Disturbances,
        inertia: &Inertia,
        omega: Vector3<f64>,
        reads: usize,
        last: Option<f64>,
        random: &mut Random,
    ) -> Self {
        let scale = libm::scalbn(1.0, libm::ilogb(inertia.tensor().trace()));
        let j = inertia.tensor() / scale;
        let frame = inertia.principal_axes().to_rotation_matrix();
        let reciprocals = Vector3::from(inertia.principal_moments()).map(|moment| scale / moment);
        let inverse = frame.matrix() * Matrix3::from_diagonal(&reciprocals) * frame.matrix().transpose();
        let mut impulses = Vec::new();
        let noisy = acting.torque_noise > 0.0;
        let forward = last.is_some();
        if let Some(last) = last.filter(|last| noisy && *last > 0.0) {
            let count = IMPULSES * reads;
            let width = last / count as f64;
            let size = acting.torque_noise * width.sqrt() / scale;
            impulses =
                (0..count).map(|i| ((i as f64 + 0.5) * width, random.normal_vector() * size)).collect();
        }
        let ahead = |time: &f64| if forward { *time > 0.0 } else { *time < 0.0 };
        impulses.extend(acting.switchings().filter(ahead).map(|time| (time, Vector3::zeros())));
        impulses.sort_by(|a, b| b.0.abs().total_cmp(&a.0.abs()));
        let terms = if noisy { TERMS_OF_IMPULSES } else { TERMS };
        let mut path = Path {
            acting,
            scale,
            inverse,
            forward,
            impulses,
            terms,
            steps: 0,
            most_steps: STEPS * (reads + 1),
            series: Series { time: 0.0, momentum: Vec::new(), rate: Vec::new(), attitude: Vec::new() },
        };
        let [wheel, _] = acting.wheels_at(0.0, forward);
        path.expand(0.0, j * omega + wheel / scale, Quat::identity());
        path
    }

    /// The series about `time`, where the momentum is `p` and the attitude `q`.
    fn expand(&mut self, time: f64, p: Vector3<f64>, q: Quat<f64>) {
        let a = self.acting;
        let wheel = a.wheels_at(time, self.forward).map(|h| h / self.scale);
        let (mut momentum, mut rate) = (vec![p], Vec::with_capacity(self.terms));
        for n in 0..self.terms {
            let own = momentum[n] - wheel.get(n).copied().unwrap_or_default();
            let w = self.inverse * own;
            rate.push(w);
            let mut sum = -own * a.relative_drag - a.drag.component_mul(&w) / self.scale;
            if n == 0 {
                sum += a.torque / self.scale;
            }
            for i in 0..=n {
                sum += momentum[i].cross(&rate[n - i]);
            }
            momentum.push(sum / (n + 1) as f64);
        }
        // q' = q ω/2
        let mut attitude = vec![q];
        for n in 0..self.terms {
            let sum = (0..=n).fold(Quat::zero(), |sum, i| sum + attitude[i].rate(rate[n - i].into()));
            attitude.push(sum * (1.0 / (n + 1) as f64));
        }
        self.series = Series { time, momentum, rate, attitude };
        self.steps += 1;
    }

    /// How far from its centre the series holds, if the motion goes on for `span`.
    fn reach(&self, span: f64) -> f64 {
        let p = &self.series.momentum;
        let wheel = self.acting.wheels_at(self.series.time, self.forward)[1] / self.scale;
        let size = p[0].norm() + (p[1].norm() + wheel.norm()) * span.abs();
        let ends = [self.terms - 1, self.terms].map(|n| {
            let last = p[n].norm();
            if last > 0.0 { libm::pow(LAST_TERM * size / last, 1.0 / n as f64) } else { f64::INFINITY }
        });
        ends[0].min(ends[1])
    }

    /// Moves the centre of the series to `time`.
    fn advance(&mut self, time: f64) -> Result<(), SimulationError> {
        loop {
            let left = time - self.series.time;
            let reach = self.reach(left);
            if left.abs() <= reach {
                return Ok(());
            }
            let next = self.series.time + reach.copysign(left);
            if self.steps >= self.most_steps || next == self.series.time || !reach.is_finite() {
                return Err(SimulationError::TooFast { time: self.series.time, steps: self.steps });
            }
            let p = horner(&self.series.momentum, next - self.series.time);
            let q = self.attitude(next);
            self.expand(next, p, q);
        }
    }

    /// The attitude at `time`, within reach.
    fn attitude(&self, time: f64) -> Quat<f64> {
        let s = time - self.series.time;
        self.series.attitude.iter().rev().fold(Quat::zero(), |sum, c| sum * s + *c).normalized()
    }

    /// Rate and attitude at `time`; times must move away from 0.
    fn at(&mut self, time: f64) -> Result<(Vector3<f64>, Quat<f64>), SimulationError> {
        while let Some((when, impulse)) = self.impulses.pop_if(|(when, _)| when.abs() <= time.abs()) {
            self.advance(when)?;
            let p = horner(&self.series.momentum, when - self.series.time) + impulse;
            let q = self.attitude(when);
            self.expand(when, p, q);
        }
        self.advance(time)?;
        let rate = horner(&self.series.rate, time - self.series.time);
        if rate.iter().all(|w| w.is_finite()) {
            Ok((rate, self.attitude(time)))
        } else {
            Err(SimulationError::TooFast { time, steps: self.steps })
        }
    }
}

/// Σ c_n sⁿ.
fn horner(coefficients: &[Vector3<f64>], s: f64) -> Vector3<f64> {
    coefficients.iter().rev().fold(Vector3::zeros(), |sum, c| sum * s + c)
}

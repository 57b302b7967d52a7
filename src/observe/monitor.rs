//! The largest errors over every step of a run.

use super::Errors;
use super::flips::Flips;
use crate::body::{Body, Clock, Conserved, Forces, Point, Problem, Time};
use crate::num::dd::{two_prod, two_sum};
use crate::num::{Dd, Real};
use crate::rotation::Vec3;

/// Watches the steps of a run: the largest error of each invariant, and how often the body flipped.
///
/// Steps come in blocks. A block of free motion is first looked at in plain `f64`, with a bound on what rounding may have
/// hidden; only where that cannot rule out a new maximum are the errors evaluated with error-free transformations, to
/// about 1e-30. Both loops are branch-free over the block, so that the compiler can vectorise them. With forces
/// every step is evaluated in double-double.
#[derive(Clone, Debug)]
pub struct Monitor {
    field: Forces<Dd>,
    clock: Clock,
    inverse_moments: Vec3<Dd>,
    forced: Option<Forced>,
    energy: Dd,
    momentum_squared: Dd,
    momentum_space: Vec3<Dd>,
    worst: Errors,
    flips: Flips,
    loud: u32, // blocks since the last plain look, while plain looks do not help
}

/// What a motion with forces conserves, and what its errors are measured by.
#[derive(Clone, Copy, Debug)]
struct Forced {
    energy: bool,
    momentum: bool,
    momentum_vector: bool,
    momentum_z: bool,
    /// Rate n of Jacobi's constant.
    jacobi: Option<f64>,
    energy_scale: f64,
    momentum_scale: f64,
    jacobi_scale: f64,
}

impl Forced {
    fn of(body: &Body, at: Time, start: &Point<Dd>, kinetic: Dd) -> Option<Self> {
        if body.problem() == Problem::Free {
            return None;
        }
        let mut energy = kinetic;
        if let Some(gravity) = body.gravity::<Dd>() {
            energy = energy + gravity.weight_moment.norm_of_any_size();
        }
        if !body.forces().is_empty() {
            energy = energy + body.size_of_forces(at, start);
        }
        // a force so large that its size is no double ends the run at its first step
        let energy_scale = if energy.hi().is_finite() { energy.hi() } else { f64::MAX };
        let largest = body.rotor().moments::<f64>().magnitude();
        let conserved = body.conserved();
        let has = |quantity| conserved.contains(&quantity);
        let jacobi = conserved.iter().find_map(|quantity| match quantity {
            Conserved::Jacobi { rate } if !has(Conserved::Energy) => Some(*rate),
            _ => None,
        });
        let turning = (start.momentum_body.norm_of_any_size() * jacobi.unwrap_or(0.0)).magnitude();
        Some(Forced {
            energy: has(Conserved::Energy),
            momentum: has(Conserved::MomentumNorm),
            momentum_vector: has(Conserved::Momentum),
            momentum_z: has(Conserved::MomentumZ) && !has(Conserved::Momentum),
            jacobi,
            energy_scale,
            momentum_scale: (2.0 * largest * energy_scale).sqrt(),
            jacobi_scale: energy_scale + turning,
        })
    }
}

/// What a monitor has seen so far.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Memory {
    pub(crate) worst: Errors,
    pub(crate) flips: u64,
    pub(crate) positive: Option<bool>,
    pub(crate) loud: u32,
}

/// How many steps a run takes between two looks at them.
pub const BLOCK: usize = 32;

/// After a plain look that ruled nothing out, the next is taken this many blocks later.
const LOUD: u32 = 16;

/// Bounds on the rounding error of the plain evaluations of E, |m|² and |L|, in units of roundoff: three, three and
/// some fourteen operations deep, the rounded start included.
const DEPTH: [f64; 3] = [6.0, 5.0, 24.0];

/// E − E₀, |m|² − |m₀|² and |L − L₀| of one state.
type Differences = [f64; 3];

impl Monitor {
    /// Begins at the point `x`, whose time is that of its step by `clock`.
    pub fn new(body: &Body, clock: Clock, x: &Point<f64>) -> Self {
        let rotor = body.rotor();
        let at = clock.at(x.steps());
        let start = x.to_dd();
        let forced = Forced::of(body, at, &start, rotor.kinetic_energy(start.momentum_body));
        let mut flips = Flips::new(rotor.middle_axis());
        flips.observe(x.momentum_body);
        let mut monitor = Monitor {
            field: body.field(),
            clock,
            inverse_moments: rotor.inverse_moments(),
            forced,
            energy: body.scaled_energy(at, &start),
            momentum_squared: start.momentum_body.norm_squared(),
            momentum_space: start.momentum_space(),
            worst: Errors::NONE,
            flips,
            loud: 0,
        };
        monitor.worst = monitor.errors(x);
        monitor
    }

    /// Takes note of consecutive steps, at most [`BLOCK`]; returns how many come before the first point that is
    /// not finite, and counts only those.
    pub fn observe(&mut self, points: &[Point<f64>]) -> usize {
        if self.forced.is_some() {
            return self.observe_forced(points);
        }
        let reference = Reference::of(self);
        if self.loud == 0 && self.is_quiet(&reference, points) {
            return self.count(points);
        }
        self.loud = (self.loud + 1) % LOUD;
        let mut points = points;
        let mut found = largest(points, |x| reference.compensated(x));
        if !found.iter().all(|d| d.is_finite()) {
            let holds = |x: &&Point<f64>| reference.compensated(x).iter().all(|d| d.is_finite());
            points = &points[..points.iter().take_while(holds).count()];
            found = largest(points, |x| reference.compensated(x));
        }
        self.worst = self.worst.max(self.errors_of(found));
        self.count(points)
    }

    fn observe_forced(&mut self, points: &[Point<f64>]) -> usize {
        for (n, x) in points.iter().enumerate() {
            if !x.is_finite() {
                return n;
            }
            let now = self.errors(x);
            if !now.is_finite() {
                return n;
            }
            self.worst = self.worst.max(now);
            self.flips.observe(x.momentum_body);
        }
        points.len()
    }

    /// Whether plain evaluation rules out a new maximum; never with a NaN.
    fn is_quiet(&self, reference: &Reference, points: &[Point<f64>]) -> bool {
        let (plain, slack) = (largest(points, |x| reference.plain(x)), reference.slack());
        self.errors_of([0, 1, 2].map(|k| plain[k] + slack[k])).within(self.worst)
    }

    fn count(&mut self, points: &[Point<f64>]) -> usize {
        for x in points {
            self.flips.observe(x.momentum_body);
        }
        points.len()
    }

    /// Errors of the point `x` itself, in double-double.
    pub fn errors(&self, x: &Point<f64>) -> Errors {
        let Some(forced) = &self.forced else {
            let x = x.to_dd();
            return self.errors_of([
                (self.kinetic(&x) - self.energy).magnitude(),
                (x.momentum_body.norm_squared() - self.momentum_squared).magnitude(),
                (x.momentum_space() - self.momentum_space).norm().magnitude(),
            ]);
        };
        let (at, point) = (self.clock.at(x.steps()), x.to_dd());
        // a start at rest where potential and torque are zero has no scale of its own: that of the point then serves
        let relative = |error: f64, scale: f64, of_point: &dyn Fn() -> f64| match (error, scale) {
            (0.0, _) => 0.0,
            (error, 0.0) => error / of_point(),
            (error, scale) => error / scale,
        };
        let kinetic = || self.kinetic(&point).hi();
        let norm = || point.momentum_body.norm().hi();
        let energy = || self.kinetic(&point) + self.field.energy(at, point.attitude) - self.energy;
        let momentum = || point.momentum_space() - self.momentum_space;
        let size = || self.momentum_squared.sqrt();
        Errors {
            energy: forced.energy.then(|| relative(energy().magnitude(), forced.energy_scale, &kinetic)),
            momentum: forced
                .momentum
                .then(|| relative((point.momentum_body.norm() - size()).magnitude(), size().hi(), &norm)),
            momentum_vector: forced
                .momentum_vector
                .then(|| relative(momentum().norm().magnitude(), size().hi(), &norm)),
            momentum_z: forced
                .momentum_z
                .then(|| relative(momentum()[2].magnitude(), forced.momentum_scale, &norm)),
            jacobi: forced
                .jacobi
                .map(|n| relative((energy() - momentum()[2] * n).magnitude(), forced.jacobi_scale, &kinetic)),
        }
    }

    /// (E − E₀) / E₀ of the point `x`, with its sign; 0 at rest. With forces relative to the scale of [`Errors`].
    pub fn energy_change(&self, x: &Point<f64>) -> f64 {
        let scale = self.forced.map_or(self.energy, |forced| Dd::of(forced.energy_scale));
        if scale.hi() == 0.0 {
            return 0.0;
        }
        let (at, x) = (self.clock.at(x.steps()), x.to_dd());
        let energy = match self.forced {
            Some(_) => self.kinetic(&x) + self.field.energy(at, x.attitude),
            None => self.kinetic(&x),
        };
        ((energy - self.energy) / scale).hi()
    }

    fn kinetic(&self, x: &Point<Dd>) -> Dd {
        kinetic(self.inverse_moments, x.momentum_body)
    }

    /// The largest errors so far.
    pub fn worst(&self) -> Errors {
        self.worst
    }

    /// How often the momentum along the axis of the middle moment has changed sign.
    pub fn flips(&self) -> u64 {
        self.flips.count
    }

    /// What is written down of a monitor: the largest errors, flips, the sign along the middle axis, loudness.
    pub(crate) fn memory(&self) -> Memory {
        let Flips { positive, count, .. } = self.flips;
        Memory { worst: self.worst, flips: count, positive, loud: self.loud }
    }

    /// Goes on from what was written down.
    pub(crate) fn remember(&mut self, memory: Memory) {
        self.worst = memory.worst;
        self.flips.count = memory.flips;
        self.flips.positive = memory.positive;
        self.loud = memory.loud;
    }

    fn errors_of(&self, [e, m2, l]: Differences) -> Errors {
        let squared = self.momentum_squared.hi();
        if squared == 0.0 {
            let zero = Some(0.0); // at rest nothing moves
            return Errors { energy: zero, momentum: zero, momentum_vector: zero, ..Errors::NONE };
        }
        // ||m| − |m₀|| = ||m|² − |m₀|²| / (|m| + |m₀|); the sign of the difference is not known here, and to first
        // order does not matter: the smaller root gives the larger error
        let relative = m2 / squared;
        Errors {
            energy: Some(e / self.energy.hi()),
            momentum: Some(relative / (1.0 + (1.0 - relative.min(1.0)).sqrt())),
            momentum_vector: Some(l / squared.sqrt()),
            ..Errors::NONE
        }
    }
}

/// The invariants of the start, leading and trailing parts side by side.
struct Reference {
    inverse_moments: [Vec3<f64>; 2],
    energy: [f64; 2],
    momentum_squared: [f64; 2],
    momentum_space: [Vec3<f64>; 2],
}

impl Reference {
    fn of(monitor: &Monitor) -> Self {
        let parts = |x: Dd| [x.hi(), x.lo()];
        let vector = |v: Vec3<Dd>| [Vec3(v.0.map(Dd::hi)), Vec3(v.0.map(Dd::lo))];
        Reference {
            inverse_moments: vector(monitor.inverse_moments),
            energy: parts(monitor.energy),
            momentum_squared: parts(monitor.momentum_squared),
            momentum_space: vector(monitor.momentum_space),
        }
    }

    #[inline]
    fn plain(&self, x: &Point<f64>) -> Differences {
        let m = x.momentum_body;
        let l = x.momentum_space() - self.momentum_space[0];
        [
            (kinetic(self.inverse_moments[0], m) - self.energy[0]).abs(),
            (m.norm_squared() - self.momentum_squared[0]).abs(),
            l.norm(),
        ]
    }

    fn slack(&self) -> Differences {
        let size = [self.energy[0], self.momentum_squared[0], self.momentum_squared[0].sqrt()];
        [0, 1, 2].map(|k| DEPTH[k] * f64::ROUNDOFF * size[k])
    }

    #[inline]
    fn compensated(&self, x: &Point<f64>) -> Differences {
        let m = x.momentum_body;
        let [high, low] = self.inverse_moments;
        let mut twice_energy = Sum::minus([2.0 * self.energy[0], 2.0 * self.energy[1]]);
        let mut squared = Sum::minus(self.momentum_squared);
        for k in 0..3 {
            let (p, e) = two_prod(m[k], m[k]);
            squared.add(p, e);
            let (s, f) = two_prod(p, high[k]);
            twice_energy.add(s, f + (e * high[k] + p * low[k]));
        }

        // L = (w² − |v|²) m + 2 (v·m) v + 2 w (v × m), not divided by |q|²
        let (w, v) = (x.attitude.w, x.attitude.v);
        let mut diagonal = Sum::default();
        diagonal.add_product(w, w);
        let mut along = Sum::default();
        for k in 0..3 {
            diagonal.add_product(-v[k], v[k]);
            along.add_product(v[k], m[k]);
        }
        let mut difference = [0.0; 3];
        for (k, difference) in difference.iter_mut().enumerate() {
            let (i, j) = ((k + 1) % 3, (k + 2) % 3);
            let mut cross = Sum::default();
            cross.add_product(v[i], m[j]);
            cross.add_product(-v[j], m[i]);
            let mut l = Sum::minus([self.momentum_space[0][k], self.momentum_space[1][k]]);
            l.add_scaled(diagonal, m[k]);
            l.add_scaled(along, 2.0 * v[k]);
            l.add_scaled(cross, 2.0 * w);
            *difference = l.value();
        }
        [0.5 * twice_energy.value().abs(), squared.value().abs(), Vec3(difference).norm()]
    }
}

/// A sum and what rounding took from it.
#[derive(Clone, Copy, Default)]
struct Sum {
    high: f64,
    low: f64,
}

impl Sum {
    #[inline]
    fn minus([high, low]: [f64; 2]) -> Self {
        Sum { high: -high, low: -low }
    }
    #[inline]
    fn add(&mut self, high: f64, low: f64) {
        let (s, e) = two_sum(self.high, high);
        self.high = s;
        self.low += e + low;
    }
    #[inline]
    fn add_product(&mut self, a: f64, b: f64) {
        let (p, e) = two_prod(a, b);
        self.add(p, e);
    }
    #[inline]
    fn add_scaled(&mut self, other: Sum, factor: f64) {
        let (p, e) = two_prod(other.high, factor);
        self.add(p, e + other.low * factor);
    }
    #[inline]
    fn value(self) -> f64 {
        self.high + self.low
    }
}

/// The largest of each difference over the states; NaN where one is NaN.
#[inline]
fn largest(points: &[Point<f64>], differences: impl Fn(&Point<f64>) -> Differences) -> Differences {
    let mut worst = [0.0; 3];
    for x in points {
        let now = differences(x);
        for k in 0..3 {
            worst[k] = if now[k] <= worst[k] { worst[k] } else { now[k] };
        }
    }
    worst
}

/// ½ m·I⁻¹m.
fn kinetic<S: Real>(inverse_moments: Vec3<S>, m: Vec3<S>) -> S {
    m.times(inverse_moments).dot(m) * S::of(0.5)
}

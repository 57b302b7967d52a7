//! The largest errors over every step of a run.

use super::circle::Circle;
use super::flips::Flips;
use super::forced::Forced;
use super::invariants::with_wheels;
use super::lanes::{Lane, Reference};
use super::{Errors, Invariants};
use crate::body::{Body, Clock, Forces, Point, Time, Wheels, kinetic_energy};
use crate::num::{Dd, Real};
use crate::rotation::Vec3;

/// Watches the steps of a run: the largest error of each invariant, and how often the body flipped.
///
/// Steps come in blocks. Blocks of free motion, of motion in a linear potential and of motion by the gravity gradient on a circle
/// are evaluated with error-free transformations, to about 1e-30 and in vectorised loops; with other forces every step is evaluated
/// in double-double.
#[derive(Clone, Debug)]
pub struct Monitor {
    field: Forces<Dd>,
    clock: Clock,
    inverse_moments: Vec3<Dd>,
    wheels: Option<Wheels>,
    forced: Option<Forced>,
    /// Where the gravity gradient on a circle is all that acts.
    circle: Option<Box<Circle>>,
    start: Invariants,
    pub(super) reference: Reference,
    worst: Errors,
    flips: Flips,
}

/// The state of a monitor, for a checkpoint.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Memory {
    pub(crate) worst: Errors,
    pub(crate) flips: u64,
    pub(crate) positive: Option<bool>,
}

/// What a sample tells of the invariants at a point.
pub(crate) struct Seen {
    /// Energy, and |m| with the momentum of wheels, divided by [`Body::scale`].
    pub(crate) energy: Dd,
    pub(crate) momentum_norm: Dd,
    pub(crate) energy_change: f64,
    pub(crate) errors: Errors,
}

/// How many steps a run takes between two looks at them.
pub(crate) const BLOCK: usize = 32;

impl Monitor {
    /// Begins at the point `x`, whose time is that of its step by `clock`.
    #[must_use]
    pub fn new(body: &Body, clock: Clock, x: &Point<f64>) -> Self {
        let rotor = body.rotor();
        let at = clock.at(x.steps());
        let start = x.to_dd();
        let forced = Forced::of(body, at, &start, rotor.kinetic_energy(start.momentum_body));
        let mut flips = Flips::new(rotor.middle_axis());
        flips.observe(&x.momentum_body);
        let start = Invariants::of(body, at, x);
        let rate = forced.and_then(|forced| forced.jacobi.filter(|_| forced.jacobi_scale > 0.0));
        let circle = body.circular_gradient().zip(rate);
        let circle = circle.and_then(|(gradient, rate)| Circle::new(gradient, rate, clock)).map(Box::new);
        let mut monitor = Monitor {
            field: body.field_without_wheels(),
            clock,
            inverse_moments: rotor.inverse_moments(),
            wheels: body.momentum_of_wheels(),
            forced,
            circle,
            reference: Reference::new(rotor.inverse_moments(), &start, body.linear_potential()),
            start,
            worst: Errors::NONE,
            flips,
        };
        monitor.worst = monitor.errors(x);
        monitor
    }

    /// Evaluates a block of consecutive steps; returns how many come before the first point that is
    /// not finite, and counts only those.
    pub fn observe(&mut self, points: &[Point<f64>]) -> usize {
        points
            .chunks(BLOCK)
            .scan(true, |goes_on, block| {
                let finite = if *goes_on { self.observe_block(block) } else { 0 };
                *goes_on = finite == block.len();
                Some(finite)
            })
            .sum()
    }

    fn observe_block(&mut self, points: &[Point<f64>]) -> usize {
        let finite = match (&self.forced, &mut self.circle) {
            (None, _) => {
                let (found, finite) = largest(&self.reference.free(points), points.len());
                self.worst = self.worst.max(self.errors_of(found));
                finite
            }
            (Some(forced), _) if forced.linear_alone => {
                let ([energy, momentum_z], finite) = largest(&self.reference.heavy(points), points.len());
                let (energy, momentum_z) = (energy / forced.energy_scale, momentum_z / forced.momentum_scale);
                let found = Errors { energy: Some(energy), momentum_z: Some(momentum_z), ..Errors::NONE };
                self.worst = self.worst.max(found);
                finite
            }
            (Some(forced), Some(circle)) => {
                let ([change], finite) = largest(&self.reference.circular(circle, points), points.len());
                let jacobi = Some(change / forced.jacobi_scale);
                self.worst = self.worst.max(Errors { jacobi, ..self.worst });
                finite
            }
            _ => return self.observe_forced(points),
        };
        for x in &points[..finite] {
            self.flips.observe(&x.momentum_body);
        }
        finite
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
            self.flips.observe(&x.momentum_body);
        }
        points.len()
    }

    /// Errors of the point `x` itself, in double-double.
    pub fn errors(&self, x: &Point<f64>) -> Errors {
        let (at, x) = (self.clock.at(x.steps()), x.to_dd());
        self.errors_at(at, &x, || self.energy(at, &x))
    }

    /// All that is told of the point `x` of the time `at`. The energy, which takes the longest where forces act, is worked out once.
    pub(crate) fn seen(&self, at: Time, x: &Point<f64>) -> Seen {
        let x = x.to_dd();
        let energy = self.energy(at, &x);
        Seen {
            energy,
            momentum_norm: with_wheels(self.wheels.as_ref(), at, &x).momentum_body.norm(),
            energy_change: self.change_to(|| energy),
            errors: self.errors_at(at, &x, || energy),
        }
    }

    /// Errors of the point `x` of the time `at`, which has this energy.
    fn errors_at(&self, at: Time, point: &Point<Dd>, energy: impl Fn() -> Dd) -> Errors {
        let Some(forced) = &self.forced else {
            return self.errors_of([
                (energy() - self.start.energy).magnitude(),
                (point.momentum_body.norm_squared() - self.start.momentum_squared).magnitude(),
                (point.momentum_space() - self.start.momentum_space).norm().magnitude(),
            ]);
        };
        // a start at rest where potential and torque are zero has no scale of its own: that of the point then serves
        let relative = |error: f64, scale: f64, of_point: &dyn Fn() -> f64| match (error, scale) {
            (0.0, _) => 0.0,
            (error, 0.0) => error / of_point(),
            (error, scale) => error / scale,
        };
        let whole = with_wheels(self.wheels.as_ref(), at, point);
        let kinetic = || self.kinetic(point).hi();
        let norm = || whole.momentum_body.norm().hi();
        let energy = || energy() - self.start.energy;
        let momentum = || whole.momentum_space() - self.start.momentum_space;
        let size = || self.start.momentum_squared.sqrt();
        Errors {
            energy: forced.energy.then(|| relative(energy().magnitude(), forced.energy_scale, &kinetic)),
            momentum_norm: forced
                .momentum_norm
                .then(|| relative((whole.momentum_body.norm() - size()).magnitude(), size().hi(), &norm)),
            momentum_vector: forced
                .momentum_vector
                .then(|| relative(momentum().norm().magnitude(), size().hi(), &norm)),
            momentum_z: forced
                .momentum_z
                .then(|| relative(momentum()[2].magnitude(), forced.momentum_scale, &norm)),
            jacobi: forced
                .jacobi
                .map(|n| relative((energy() - momentum()[2] * n).magnitude(), forced.jacobi_scale, &kinetic)),
            jacobi_rate: forced.jacobi,
        }
    }

    /// (E − E₀) / E₀ of the point `x`, with its sign; 0 at rest. With forces relative to the scale of [`Errors`].
    #[must_use]
    pub fn energy_change(&self, x: &Point<f64>) -> f64 {
        self.change_to(|| self.energy(self.clock.at(x.steps()), &x.to_dd()))
    }

    fn change_to(&self, energy: impl Fn() -> Dd) -> f64 {
        let scale = self.forced.map_or(self.start.energy, |forced| Dd::of(forced.energy_scale));
        if scale.hi() == 0.0 { 0.0 } else { ((energy() - self.start.energy) / scale).hi() }
    }

    fn energy(&self, at: Time, x: &Point<Dd>) -> Dd {
        let kinetic = self.kinetic(x);
        if self.forced.is_none() { kinetic } else { kinetic + self.field.energy(at, x.attitude) }
    }

    fn kinetic(&self, x: &Point<Dd>) -> Dd {
        kinetic_energy(self.inverse_moments, x.momentum_body)
    }

    /// The largest errors so far.
    pub fn worst(&self) -> Errors {
        self.worst
    }

    /// How often the momentum along the axis of the middle moment has changed sign.
    #[must_use]
    pub fn flips(&self) -> u64 {
        self.flips.count
    }

    /// What a checkpoint holds of a monitor.
    pub(crate) fn memory(&self) -> Memory {
        let Flips { positive, count, .. } = self.flips;
        // the rate of Jacobi's constant is that of the body
        Memory { worst: Errors { jacobi_rate: None, ..self.worst }, flips: count, positive }
    }

    /// Continues from a checkpoint.
    pub(crate) fn remember(&mut self, memory: Memory) {
        self.worst = Errors { jacobi_rate: self.worst.jacobi_rate, ..memory.worst };
        self.flips.count = memory.flips;
        self.flips.positive = memory.positive;
    }

    fn errors_of(&self, [e, m2, l]: [f64; 3]) -> Errors {
        let squared = self.start.momentum_squared.hi();
        if squared == 0.0 {
            let zero = Some(0.0); // at rest nothing moves
            return Errors { energy: zero, momentum_norm: zero, momentum_vector: zero, ..Errors::NONE };
        }
        // ||m| − |m₀|| = ||m|² − |m₀|²| / (|m| + |m₀|); the sign of the difference is not known here, and to first
        // order does not matter: the smaller root gives the larger error; a change beyond |m₀|² is growth
        let relative = m2 / squared;
        let root = if relative > 1.0 { (1.0 + relative).sqrt() } else { (1.0 - relative).sqrt() };
        Errors {
            energy: Some(e / self.start.energy.hi()),
            momentum_norm: Some(relative / (1.0 + root)),
            momentum_vector: Some(l / squared.sqrt()),
            ..Errors::NONE
        }
    }
}

/// The largest of each difference over those of the first `n` points that come before one that is not finite, and their
/// number.
fn largest<const N: usize>(differences: &[Lane; N], n: usize) -> ([f64; N], usize) {
    // no branch as long as all are
    let is_finite = |n: usize| differences.iter().fold(true, |all, lane| all & lane[n].is_finite());
    let all_are = (0..BLOCK).fold(true, |all, n| all & is_finite(n));
    let finite = if all_are { n } else { (0..n).take_while(|n| is_finite(*n)).count() };
    let worst = core::array::from_fn(|k| {
        // several at once: one after the other each would wait for the one before
        let mut worst = [0.0_f64; 8];
        for numbers in differences[k][..finite].chunks(worst.len()) {
            for (worst, d) in worst.iter_mut().zip(numbers) {
                *worst = if *d > *worst { *d } else { *worst };
            }
        }
        worst.into_iter().fold(0.0, f64::max)
    });
    (worst, finite)
}

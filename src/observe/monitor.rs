//! The largest errors over every step of a run.

use super::invariants::energy;
use crate::body::{Body, State};
use crate::num::{Dd, Real};
use crate::rotation::Vec3;

/// Relative errors of the invariants against the start; 0 for a body at rest.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Errors {
    /// |E − E₀| / |E₀|.
    pub energy: f64,
    /// ||m| − |m₀|| / |m₀|.
    pub momentum: f64,
    /// |L − L₀| / |L₀|, L in space.
    pub momentum_vector: f64,
}

/// Watches every step of a run: the largest error of each invariant, and how often the body flipped.
///
/// A step is first looked at in `f64`, with a bound on what rounding may have hidden; only where that cannot rule
/// out a new maximum is the invariant evaluated in double-double. The maxima are therefore those of the
/// double-double invariants at every step, at a fraction of their cost.
#[derive(Clone, Debug)]
pub struct Monitor {
    inverse_moments: Vec3<f64>,
    inverse_moments_dd: Vec3<Dd>,
    energy: Dd,
    momentum_squared: Dd,
    momentum_space: Vec3<Dd>,
    start: [f64; 5], // E, |m|², L of the start, rounded
    slack: [f64; 3],
    worst: Errors,
    flips: Flips,
}

/// Changes of sign of the momentum along the middle axis.
#[derive(Clone, Copy, Debug)]
struct Flips {
    axis: usize,
    positive: Option<bool>,
    count: u64,
}

/// Bounds on the error of the `f64` evaluations, in units of roundoff of E, |m|² and |L|: 3, 3 and 14 rounded
/// operations deep, the start's own rounding included.
const DEPTH: [f64; 3] = [6.0, 5.0, 24.0];

impl Monitor {
    /// Begins at the state `x` as kernels see it.
    pub fn new(body: &Body, x: &State<f64>) -> Self {
        let inverse_moments_dd = body.inverse_moments();
        let dd = State::<Dd>::of(*x);
        let (energy, momentum_squared) =
            (energy(inverse_moments_dd, dd.momentum_body), dd.momentum_body.norm_squared());
        let momentum_space = dd.momentum_space();
        let size = [energy.hi(), momentum_squared.hi(), momentum_squared.hi().sqrt()];
        let mut monitor = Monitor {
            inverse_moments: body.inverse_moments(),
            inverse_moments_dd,
            energy,
            momentum_squared,
            momentum_space,
            start: [
                energy.hi(),
                momentum_squared.hi(),
                momentum_space[0].hi(),
                momentum_space[1].hi(),
                momentum_space[2].hi(),
            ],
            slack: [0, 1, 2].map(|k| DEPTH[k] * f64::EPSILON / 2.0 * size[k]),
            worst: Errors::default(),
            flips: Flips { axis: middle_axis(body.moments()), positive: None, count: 0 },
        };
        monitor.flips.observe(x.momentum_body);
        monitor
    }

    /// Takes note of a step. `false` if the state is not finite: then it is not counted.
    #[inline]
    pub fn observe(&mut self, x: &State<f64>) -> bool {
        let m = x.momentum_body;
        let e = (energy(self.inverse_moments, m) - self.start[0]).abs() + self.slack[0];
        let m2 = (m.norm_squared() - self.start[1]).abs() + self.slack[1];
        let l = x.momentum_space() - Vec3([self.start[2], self.start[3], self.start[4]]);
        let l2 = l.norm() + self.slack[2];
        let quiet = e <= self.worst.energy * self.start[0]
            && m2 <= self.worst.momentum * self.start[1]
            && l2 * l2 <= self.worst.momentum_vector * self.worst.momentum_vector * self.start[1];
        // a NaN is never quiet
        if !quiet && !self.record(x) {
            return false;
        }
        self.flips.observe(m);
        true
    }

    /// Errors of the state `x` itself, in double-double.
    pub fn errors(&self, x: &State<f64>) -> Errors {
        let x = State::<Dd>::of(*x);
        let m = x.momentum_body;
        let ratio = |difference: Dd, reference: Dd| match reference.hi() {
            0.0 => difference.hi().abs(), // at rest, where nothing moves
            _ => (difference / reference).hi().abs(),
        };
        let m2 = m.norm_squared();
        // ||m| − |m₀|| / |m₀| without a difference of roots
        let both = self.momentum_squared + (m2 * self.momentum_squared).sqrt();
        Errors {
            energy: ratio(energy(self.inverse_moments_dd, m) - self.energy, self.energy),
            momentum: ratio(m2 - self.momentum_squared, both),
            momentum_vector: ratio(
                (x.momentum_space() - self.momentum_space).norm(),
                self.momentum_squared.sqrt(),
            ),
        }
    }

    /// The largest errors so far.
    pub fn worst(&self) -> Errors {
        self.worst
    }

    /// How often the momentum along the axis of the middle moment has changed sign.
    pub fn flips(&self) -> u64 {
        self.flips.count
    }

    #[cold]
    fn record(&mut self, x: &State<f64>) -> bool {
        if !x.is_finite() {
            return false;
        }
        let now = self.errors(x);
        if !(now.energy.is_finite() && now.momentum.is_finite() && now.momentum_vector.is_finite()) {
            return false;
        }
        self.worst = Errors {
            energy: self.worst.energy.max(now.energy),
            momentum: self.worst.momentum.max(now.momentum),
            momentum_vector: self.worst.momentum_vector.max(now.momentum_vector),
        };
        true
    }
}

impl Flips {
    #[inline]
    fn observe(&mut self, m: Vec3<f64>) {
        let component = m[self.axis];
        if component == 0.0 {
            return;
        }
        let positive = component > 0.0;
        if self.positive.is_some_and(|before| before != positive) {
            self.count += 1;
        }
        self.positive = Some(positive);
    }
}

fn middle_axis(moments: Vec3<f64>) -> usize {
    let mut order = [0, 1, 2];
    order.sort_by(|&i, &j| moments[i].total_cmp(&moments[j]));
    order[1]
}

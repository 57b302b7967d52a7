//! The largest errors over every step of a run.

use crate::body::{Body, Gravity, State};
use crate::num::dd::{two_prod, two_sum};
use crate::num::{Dd, Real};
use crate::rotation::Vec3;

/// Relative errors of the invariants against the start; 0 for a free body at rest.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Errors {
    /// |E − E₀| / |E₀|; under gravity |E − E₀| / (T₀ + |c|), c the weight moment.
    pub energy: f64,
    /// ||m| − |m₀|| / |m₀|; under gravity |m| is not kept.
    pub momentum: Option<f64>,
    /// |L − L₀| / |L₀|, L in space; under gravity it is not kept.
    pub momentum_vector: Option<f64>,
    /// |L_z − L_z0| / √(2 I (T₀ + |c|)), z of space, I the largest moment; only under gravity.
    pub momentum_z: Option<f64>,
}

impl Errors {
    fn none(heavy: bool) -> Self {
        let (free, heavy) = if heavy { (None, Some(0.0)) } else { (Some(0.0), None) };
        Errors { energy: 0.0, momentum: free, momentum_vector: free, momentum_z: heavy }
    }

    fn max(self, other: Self) -> Self {
        let max = |a: Option<f64>, b: Option<f64>| a.zip(b).map(|(a, b)| a.max(b));
        Errors {
            energy: self.energy.max(other.energy),
            momentum: max(self.momentum, other.momentum),
            momentum_vector: max(self.momentum_vector, other.momentum_vector),
            momentum_z: max(self.momentum_z, other.momentum_z),
        }
    }

    fn is_finite(self) -> bool {
        let finite = |e: Option<f64>| e.is_none_or(f64::is_finite);
        self.energy.is_finite()
            && finite(self.momentum)
            && finite(self.momentum_vector)
            && finite(self.momentum_z)
    }

    /// Whether no error of `self` exceeds that of `other`; not with a NaN.
    fn within(self, other: Self) -> bool {
        let within = |a: Option<f64>, b: Option<f64>| a.zip(b).is_none_or(|(a, b)| a <= b);
        self.energy <= other.energy
            && within(self.momentum, other.momentum)
            && within(self.momentum_vector, other.momentum_vector)
            && within(self.momentum_z, other.momentum_z)
    }
}

/// Watches every step of a run: the largest error of each invariant, and how often the body flipped.
///
/// Steps come in blocks. A block is first looked at in plain `f64`, with a bound on what rounding may have hidden;
/// only where that cannot rule out a new maximum are the errors evaluated with error-free transformations, to
/// about 1e-30. Both loops are branch-free over the block, so that the compiler can vectorise them. Under gravity
/// every step is evaluated in double-double.
#[derive(Clone, Debug)]
pub struct Monitor {
    inverse_moments: Vec3<Dd>,
    heavy: Option<Heavy>,
    energy: Dd,
    momentum_squared: Dd,
    momentum_space: Vec3<Dd>,
    worst: Errors,
    flips: Flips,
    loud: u32, // blocks since the last plain look, while plain looks do not help
}

/// Gravity, and what errors under it are measured by.
#[derive(Clone, Copy, Debug)]
struct Heavy {
    gravity: Gravity<Dd>,
    energy: f64,
    momentum: f64,
}

impl Heavy {
    fn of(body: &Body, kinetic: Dd) -> Option<Self> {
        let gravity = body.gravity::<Dd>()?;
        let energy = (kinetic + gravity.weight_moment.norm_of_any_size()).hi();
        let largest = body.moments::<f64>().magnitude();
        Some(Heavy { gravity, energy, momentum: (2.0 * largest * energy).sqrt() })
    }
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
    /// Begins at the state `x` as kernels see it.
    pub fn new(body: &Body, x: &State<f64>) -> Self {
        let inverse_moments = body.inverse_moments();
        let start = State::<Dd>::of(*x);
        let kinetic = kinetic(inverse_moments, start.momentum_body);
        let heavy = Heavy::of(body, kinetic);
        let mut flips = Flips { axis: middle_axis(body.moments()), positive: None, count: 0 };
        flips.observe(x.momentum_body);
        Monitor {
            inverse_moments,
            heavy,
            energy: body.scaled_energy(&start),
            momentum_squared: start.momentum_body.norm_squared(),
            momentum_space: start.momentum_space(),
            worst: Errors::none(heavy.is_some()),
            flips,
            loud: 0,
        }
    }

    /// Takes note of consecutive steps, at most [`BLOCK`]; returns how many come before the first state that is
    /// not finite, and counts only those.
    pub fn observe(&mut self, states: &[State<f64>]) -> usize {
        if self.heavy.is_some() {
            return self.observe_heavy(states);
        }
        let reference = Reference::of(self);
        if self.loud == 0 && self.is_quiet(&reference, states) {
            return self.count(states);
        }
        self.loud = (self.loud + 1) % LOUD;
        let mut states = states;
        let mut found = largest(states, |x| reference.compensated(x));
        if !found.iter().all(|d| d.is_finite()) {
            let holds = |x: &&State<f64>| reference.compensated(x).iter().all(|d| d.is_finite());
            states = &states[..states.iter().take_while(holds).count()];
            found = largest(states, |x| reference.compensated(x));
        }
        self.worst = self.worst.max(self.errors_of(found));
        self.count(states)
    }

    fn observe_heavy(&mut self, states: &[State<f64>]) -> usize {
        for (n, x) in states.iter().enumerate() {
            let now = self.errors(x);
            if !now.is_finite() {
                return n;
            }
            self.worst = self.worst.max(now);
            self.flips.observe(x.momentum_body);
        }
        states.len()
    }

    /// Whether plain evaluation rules out a new maximum; never with a NaN.
    fn is_quiet(&self, reference: &Reference, states: &[State<f64>]) -> bool {
        let (plain, slack) = (largest(states, |x| reference.plain(x)), reference.slack());
        self.errors_of([0, 1, 2].map(|k| plain[k] + slack[k])).within(self.worst)
    }

    fn count(&mut self, states: &[State<f64>]) -> usize {
        for x in states {
            self.flips.observe(x.momentum_body);
        }
        states.len()
    }

    /// Errors of the state `x` itself, in double-double.
    pub fn errors(&self, x: &State<f64>) -> Errors {
        let x = State::<Dd>::of(*x);
        let e = (self.energy_of(&x) - self.energy).magnitude();
        if let Some(heavy) = self.heavy {
            let z = (x.momentum_space()[2] - self.momentum_space[2]).magnitude();
            let momentum_z = Some(z / heavy.momentum);
            return Errors { energy: e / heavy.energy, momentum_z, ..Errors::none(true) };
        }
        self.errors_of([
            e,
            (x.momentum_body.norm_squared() - self.momentum_squared).magnitude(),
            (x.momentum_space() - self.momentum_space).norm().magnitude(),
        ])
    }

    /// (E − E₀) / E₀ of the state `x`, with its sign; 0 at rest. Under gravity relative to T₀ + |c|.
    pub fn energy_change(&self, x: &State<f64>) -> f64 {
        let scale = self.heavy.map_or(self.energy, |heavy| Dd::of(heavy.energy));
        if scale.hi() == 0.0 {
            return 0.0;
        }
        ((self.energy_of(&State::of(*x)) - self.energy) / scale).hi()
    }

    fn energy_of(&self, x: &State<Dd>) -> Dd {
        let kinetic = kinetic(self.inverse_moments, x.momentum_body);
        self.heavy.map_or(kinetic, |heavy| kinetic + heavy.gravity.potential(x.attitude))
    }

    /// The largest errors so far.
    pub fn worst(&self) -> Errors {
        self.worst
    }

    /// How often the momentum along the axis of the middle moment has changed sign.
    pub fn flips(&self) -> u64 {
        self.flips.count
    }

    fn errors_of(&self, [e, m2, l]: Differences) -> Errors {
        let squared = self.momentum_squared.hi();
        if squared == 0.0 {
            return Errors::none(false); // at rest nothing moves
        }
        // ||m| − |m₀|| = ||m|² − |m₀|²| / (|m| + |m₀|); the sign of the difference is not known here, and to first
        // order does not matter: the smaller root gives the larger error
        let relative = m2 / squared;
        Errors {
            energy: e / self.energy.hi(),
            momentum: Some(relative / (1.0 + (1.0 - relative.min(1.0)).sqrt())),
            momentum_vector: Some(l / squared.sqrt()),
            momentum_z: None,
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
    fn plain(&self, x: &State<f64>) -> Differences {
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
    fn compensated(&self, x: &State<f64>) -> Differences {
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
fn largest(states: &[State<f64>], differences: impl Fn(&State<f64>) -> Differences) -> Differences {
    let mut worst = [0.0; 3];
    for x in states {
        let now = differences(x);
        for k in 0..3 {
            worst[k] = if now[k] <= worst[k] { worst[k] } else { now[k] };
        }
    }
    worst
}

/// Changes of sign of the momentum along the middle axis.
#[derive(Clone, Copy, Debug)]
struct Flips {
    axis: usize,
    positive: Option<bool>,
    count: u64,
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

/// ½ m·I⁻¹m.
fn kinetic<S: Real>(inverse_moments: Vec3<S>, m: Vec3<S>) -> S {
    m.times(inverse_moments).dot(m) * S::of(0.5)
}

fn middle_axis(moments: Vec3<f64>) -> usize {
    let mut order = [0, 1, 2];
    order.sort_by(|&i, &j| moments[i].total_cmp(&moments[j]));
    order[1]
}

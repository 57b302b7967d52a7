//! A double that knows for how many operations it has waited.

use core::cmp::Ordering;
use core::f64::consts::FRAC_PI_4;
use core::ops::{Add, Div, Mul, Neg, Sub};
use std::sync::OnceLock;

use polhode::body::{Clock, Point};
use polhode::method::Map;
use polhode::num::{Dd, Precise, Real, trig};

/// Steps before the count, in which one chain outgrows all others, and those that are counted. The renormalisation of every eighth step
/// is among them. What is done in one step of 64 is not: the closed form of `exact-step`, which waits for no step, and the renormalisation
/// of small turns, for which the momentum of a free body does not wait.
const UNTIL_STEADY: u64 = 16;
const COUNTED: u64 = 32;

/// A double, and the number of operations on the longest chain that leads to it.
///
/// The unit is a sum, a difference or a product, by a power of two too; a quotient and a root count as many times that as they
/// [last](Waiting::let_last). A negation, an absolute value and a comparison count nothing: compilers make negations part of what follows,
/// and processors go on before a branch is decided.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Waiting {
    value: f64,
    /// −∞ of a number that stands in the text of the program.
    depth: f64,
}

/// How many operations a quotient and a root last.
static LAST: OnceLock<[f64; 2]> = OnceLock::new();

impl Waiting {
    /// Says once and for all how many operations a quotient and a root last.
    pub(crate) fn let_last(quotient: f64, root: f64) {
        LAST.get_or_init(|| [quotient, root]);
    }

    fn after(value: f64, waited_for: [Waiting; 2], operations: f64) -> Self {
        let [a, b] = waited_for;
        Waiting { value, depth: a.depth.max(b.depth) + operations }
    }

    /// Whether the compiler leaves out a multiplication by it.
    fn is_known_as_one(self) -> bool {
        self.value == 1.0 && self.depth == f64::NEG_INFINITY
    }

    /// A value of a function whose operations are not counted: no step takes one.
    fn uncounted(value: f64) -> Self {
        Waiting { value, depth: f64::INFINITY }
    }
}

/// A number of the start, known when the program runs.
impl From<f64> for Waiting {
    fn from(value: f64) -> Self {
        Waiting { value, depth: 0.0 }
    }
}

/// Operations of a step of `map` from `x` on that wait for each other: what the longest chain to the state grows a step.
pub(crate) fn per_step(mut map: impl Map<Waiting>, mut x: Point<Waiting>, step: f64) -> f64 {
    let clock = Clock::new(step);
    map.open(clock.at(0), &mut x);
    growth(|steps| {
        map.advance_by(steps, &clock, &mut x);
        x.attitude.components().into_iter().chain(x.momentum_body.0).collect()
    })
}

/// The same where `advance` takes so many steps and gives the numbers of the state.
pub(crate) fn growth(mut advance: impl FnMut(u64) -> Vec<Waiting>) -> f64 {
    let mut longest = |steps| advance(steps).iter().map(|x| x.depth).fold(0.0, f64::max);
    let before = longest(UNTIL_STEADY);
    (longest(COUNTED) - before) / COUNTED as f64
}

impl Add for Waiting {
    type Output = Self;
    fn add(self, b: Self) -> Self {
        Waiting::after(self.value + b.value, [self, b], 1.0)
    }
}
impl Sub for Waiting {
    type Output = Self;
    fn sub(self, b: Self) -> Self {
        Waiting::after(self.value - b.value, [self, b], 1.0)
    }
}
impl Mul for Waiting {
    type Output = Self;
    fn mul(self, b: Self) -> Self {
        match (self.is_known_as_one(), b.is_known_as_one()) {
            (true, _) => b,
            (_, true) => self,
            _ => Waiting::after(self.value * b.value, [self, b], 1.0),
        }
    }
}
impl Div for Waiting {
    type Output = Self;
    fn div(self, b: Self) -> Self {
        Waiting::after(self.value / b.value, [self, b], LAST.get().map_or(f64::INFINITY, |last| last[0]))
    }
}
impl Neg for Waiting {
    type Output = Self;
    fn neg(self) -> Self {
        Waiting { value: -self.value, ..self }
    }
}
impl PartialEq for Waiting {
    fn eq(&self, b: &Self) -> bool {
        self.value == b.value
    }
}
impl PartialOrd for Waiting {
    fn partial_cmp(&self, b: &Self) -> Option<Ordering> {
        self.value.partial_cmp(&b.value)
    }
}

/// Operation by operation as `f64`, but for its branches for large angles, which are not taken here.
impl Real for Waiting {
    const ROUNDOFF: f64 = f64::ROUNDOFF;
    fn of(x: f64) -> Self {
        Waiting { value: x, depth: f64::NEG_INFINITY }
    }
    fn from_dd(x: Dd) -> Self {
        x.hi().into()
    }
    fn sqrt(self) -> Self {
        let root = LAST.get().map_or(f64::INFINITY, |last| last[1]);
        Waiting::after(self.value.sqrt(), [self, self], root)
    }
    fn sin_cos(self) -> (Self, Self) {
        assert!(self.magnitude() <= FRAC_PI_4, "the reduction of {self:?} is not counted");
        trig::sin_cos_moderate(self)
    }
    fn sin_versine(self) -> (Self, Self) {
        assert!(self.magnitude() <= FRAC_PI_4, "the reduction of {self:?} is not counted");
        trig::sin_versine_moderate(self)
    }
    fn sin_versine_moderate(self) -> (Self, Self) {
        trig::sin_versine_moderate(self)
    }
    fn sin_versine_small(self) -> (Self, Self) {
        trig::sin_versine_small(self)
    }
    fn sinc_cos_of_root(self) -> (Self, Self) {
        assert!(self.value <= trig::SMALL * trig::SMALL, "the root of {self:?} is not counted");
        trig::sinc_cos_small(self)
    }
    fn magnitude(self) -> f64 {
        self.value.abs()
    }
    /// As `error_free::two_prod` of the library, which splits a number by its bits: two operations on integers, which count as one.
    fn two_prod(self, b: Self) -> (Self, Self) {
        let split = |x: Self| {
            let bits = x.value.to_bits().wrapping_add(1 << 26) & !((1 << 27) - 1);
            let high = Waiting::after(f64::from_bits(bits), [x, x], 1.0);
            (high, x - high)
        };
        let ((a1, a2), (b1, b2), p) = (split(self), split(b), self * b);
        (p, ((a1 * b1 - p) + a1 * b2 + a2 * b1) + a2 * b2)
    }
}

impl Precise for Waiting {
    fn to_dd(self) -> Dd {
        self.value.to_dd()
    }
    fn to_f64(self) -> f64 {
        self.value
    }
    fn abs(self) -> Self {
        Waiting { value: self.value.abs(), ..self }
    }
    fn round(self) -> Self {
        Waiting::uncounted(self.value.round())
    }
    fn atan2(self, x: Self) -> Self {
        Waiting::uncounted(Precise::atan2(self.value, x.value))
    }
    fn exp(self) -> Self {
        Waiting::uncounted(Precise::exp(self.value))
    }
    fn exp_m1(self) -> Self {
        Waiting::uncounted(Precise::exp_m1(self.value))
    }
    fn ln(self) -> Self {
        Waiting::uncounted(Precise::ln(self.value))
    }
}

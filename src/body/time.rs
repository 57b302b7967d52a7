//! Time without rounding: the start, whole steps, and what has gone by within a step.

use crate::num::trig::nearest;
use crate::num::{Dd, Precise, Real};

/// Up to it, 2⁵¹, the integer next to a double takes two additions.
const COUNTED: f64 = 2_251_799_813_685_248.0;

/// When a run starts and how long its steps are: step n begins at `start + n · step`.
///
/// ```
/// use polhode::body::Clock;
/// let sum: f64 = (0..1000).map(|_| 0.1).sum();
/// assert_eq!(Clock::new(0.1).at(1000).seconds::<f64>(), 100.0);
/// assert_ne!(sum, 100.0); // each addition rounds
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[must_use]
pub struct Clock {
    /// Time of the start, s.
    pub start: f64,
    /// Length of a step, s; negative backwards.
    pub step: f64,
}

impl Clock {
    /// Steps of `step` seconds from the time 0 on.
    pub fn new(step: f64) -> Self {
        Clock { start: 0.0, step }
    }

    /// The beginning of step `steps`.
    #[inline]
    pub fn at(&self, steps: u64) -> Time {
        Time { clock: *self, steps, offset: Dd::ZERO }
    }

    /// Time since the start after `steps` steps, s, exact: a sum `t += h` would lose a second in a long enough run.
    pub fn elapsed(&self, steps: u64) -> Dd {
        // a sum that is zero has the sign +
        self.product(steps) + 0.0
    }

    #[inline(always)]
    fn product(&self, steps: u64) -> Dd {
        let (high, low) = (steps >> 32, steps & 0xffff_ffff);
        let product = Dd::product(low as f64, self.step);
        if high == 0 { product } else { Dd::product(high as f64 * 4_294_967_296.0, self.step) + product }
    }
}

/// A point in time, `start + n · step + offset`, worked out only when a force asks for it.
#[derive(Clone, Copy, Debug, PartialEq)]
#[must_use]
pub struct Time {
    clock: Clock,
    steps: u64,
    offset: Dd,
}

impl Time {
    /// The time `t`, s.
    pub fn from_seconds(t: f64) -> Self {
        Clock { start: t, step: 0.0 }.at(0)
    }

    /// The time `t`, s, to the digits of double-double.
    pub fn from_dd(t: Dd) -> Self {
        Time::from_seconds(t.hi()).later(Dd::of(t.lo()))
    }

    /// The time `duration` (s) after this one.
    #[inline]
    pub fn later(&self, duration: Dd) -> Self {
        Time { offset: self.offset + duration, ..*self }
    }

    /// The time `elapsed` (s) after the start.
    pub(crate) fn at_elapsed(&self, elapsed: Dd) -> Self {
        Time { steps: 0, offset: elapsed, ..*self }
    }

    /// Time since the start, s.
    #[inline(always)]
    pub(crate) fn elapsed(&self) -> Dd {
        self.clock.product(self.steps) + self.offset
    }

    /// In seconds, exact to the digits of double-double.
    #[inline(always)]
    pub fn dd(&self) -> Dd {
        let elapsed = self.elapsed();
        // most runs start at 0, and forces ask at every stage
        if self.clock.start == 0.0 { elapsed } else { Dd::of(self.clock.start) + elapsed }
    }

    /// In seconds, rounded once; as a [series](crate::num::Series) it grows with its variable, as every function of it then
    /// does. A law has to ask for the time in the scalar that it is evaluated in.
    #[must_use]
    pub fn seconds<S: Real>(&self) -> S {
        S::linear(self.dd(), 1.0)
    }

    /// The angle `rate · t` (rate in rad/s), reduced to [−π, π] in double-double, so that many turns cost no digits of a
    /// double; as a series it goes on from there.
    #[must_use]
    #[inline]
    pub fn angle<S: Real>(&self, rate: f64) -> S {
        S::linear(reduced_angle(self.dd(), rate), rate)
    }
}

/// The angle `rate · time`, reduced to [−π, π].
#[inline]
pub(super) fn reduced_angle(time: Dd, rate: f64) -> Dd {
    let angle = time * rate;
    let turns = angle.hi() * (0.5 * core::f64::consts::FRAC_1_PI);
    // next to half a turn either number of turns will do; beyond the integers of a double only that of double-double
    if turns.abs() < COUNTED {
        angle - Dd::TAU * nearest(turns)
    } else {
        angle - Dd::TAU * (angle / Dd::TAU).round()
    }
}

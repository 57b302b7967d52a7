//! Attitudes from readings that come one by one.

use super::error::StrapdownError;
use super::rule::{MOST_SAMPLES, Rule};
use super::turn::Turner;
use super::window::{Sample, Window};
use super::{Kind, checked};
use crate::num::Precise;
use crate::rotation::{Quat, Vec3};

/// An attitude and its time.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct Stamped<S> {
    /// Time of the sample, s.
    pub time: S,
    /// Body to space.
    pub attitude: Quat<S>,
}

/// Attitudes from the readings of a gyroscope that come one by one: constant memory, and each attitude with the
/// [delay](Rule::delay) of the rule.
///
/// `q_{k+1} = q_k ∘ p_k`, p_k the turn of the [rule](Rule) from sample k to the next one. Intervals near the first and the last sample
/// take the polynomial of the nearest complete window, and of fewer samples the polynomial through all of them.
///
/// ```
/// use polhode::rotation::{Quat, Vec3};
/// use polhode::strapdown::{Kind, Rule, Strapdown};
/// // a top that nods: ω in body axes, rad/s, 50 times a second
/// let omega = |t: f64| Vec3([libm::cos(3.0 * t), libm::sin(3.0 * t), 2.0]);
/// let mut strapdown = Strapdown::new(Kind::Rate, Rule::magnus(6, 8)?, Quat::identity())?;
/// let mut last = Quat::identity();
/// for k in 0..=100 {
///     let t = 0.02 * f64::from(k);
///     for known in strapdown.push(t, omega(t))? {
///         last = known.attitude; // three samples behind
///     }
/// }
/// for known in strapdown.finish() {
///     last = known.attitude;
/// }
/// // in axes that turn at −3 rad/s about z the rate is constant: q(t) = exp(½ t (1, 0, 5)) exp(−½ t (0, 0, 3))
/// let exact = Quat::exponential(Vec3([2.0, 0.0, 10.0])) * Quat::exponential(Vec3([0.0, 0.0, -6.0]));
/// assert!((last - exact).magnitude() < 1e-12 || (last + exact).magnitude() < 1e-12);
/// # Ok::<(), polhode::Error>(())
/// ```
#[derive(Clone, Debug)]
pub struct Strapdown<S> {
    kind: Kind,
    rule: Rule,
    window: Window<S>,
    turner: Turner<S>,
    attitude: Quat<S>,
    /// Attitudes that are known.
    known: usize,
    ready: [Stamped<S>; MOST_SAMPLES],
}

impl<S: Precise> Strapdown<S> {
    /// From the attitude `start` at the first sample, of any norm but zero.
    ///
    /// # Errors
    /// A rule that is not for readings of this `kind`; a start that is zero or not finite.
    pub fn new(kind: Kind, rule: Rule, start: Quat<S>) -> Result<Self, StrapdownError> {
        rule.check(kind)?;
        let start = checked::attitude(start)?;
        Ok(Strapdown {
            kind,
            rule,
            window: Window::new(),
            turner: Turner::new(rule, kind),
            attitude: start,
            known: 0,
            ready: [Stamped { time: S::of(0.0), attitude: start }; MOST_SAMPLES],
        })
    }

    /// Takes the `reading` (body axes; rad/s, of increments rad) at the time `time`, s, and gives the attitudes that it makes
    /// known: none, one, or those of the first samples together.
    ///
    /// # Errors
    /// Numbers that are not finite, a time not after the one before, a turn of more than half a turn since then. The sample is
    /// then not taken.
    pub fn push(&mut self, time: S, reading: Vec3<S>) -> Result<&[Stamped<S>], StrapdownError> {
        let sample = Sample { time, reading };
        checked::sample(self.kind, &sample, self.window.last(), self.window.count())?;
        self.window.push(sample);
        Ok(self.advance(false))
    }

    /// Gives the attitudes at the last samples, by the polynomial through these. More samples may follow: their attitudes go on from there.
    pub fn finish(&mut self) -> &[Stamped<S>] {
        self.advance(true)
    }

    /// The last attitude that is known, body to space.
    pub fn attitude(&self) -> Quat<S> {
        self.attitude
    }

    /// Samples that an attitude waits for.
    #[must_use]
    pub fn delay(&self) -> usize {
        self.rule.delay()
    }

    fn advance(&mut self, is_over: bool) -> &[Stamped<S>] {
        let count = self.window.count();
        let mut given = 0;
        if self.known == 0 && count > 0 {
            self.ready[0] = Stamped { time: self.window.get(0..1)[0].time, attitude: self.attitude };
            (self.known, given) = (1, 1);
        }
        while self.known > 0
            && self.known < count
            && given < MOST_SAMPLES
            && (is_over || self.rule.is_ready(self.known - 1, count))
        {
            let k = self.known - 1;
            let range = self.rule.range(k, count);
            let samples = self.window.get(range.clone());
            let turn = self.turner.turn(samples, k - range.start, k == 0).turn;
            self.attitude = turned(self.attitude, turn);
            let time = samples[k + 1 - range.start].time;
            self.ready[given] = Stamped { time, attitude: self.attitude };
            self.known += 1;
            given += 1;
        }
        &self.ready[..given]
    }
}

/// q ∘ p, brought back to norm 1 by one step of Newton.
#[inline]
pub(super) fn turned<S: Precise>(q: Quat<S>, p: Quat<S>) -> Quat<S> {
    let product = q * p;
    product * (S::of(1.5) - S::of(0.5) * product.norm_squared())
}

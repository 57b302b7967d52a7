//! The motions from one attitude to another whose momentum starts in one direction.

use crate::flow::free::circulation::Circulation;
use crate::flow::free::polhode::{Polhode, rounded_separation};
use crate::num::elliptic::incomplete;
use crate::rotation::{Quat, Vec3};

/// Of the longest time, beyond it and before the start.
const MARGIN: f64 = 0.3;

/// A direction of the momentum, from which one of its own length comes to the right place in the body after each whole number of
/// periods; the attitude then is right but for a turn about the momentum.
#[derive(Clone, Debug)]
pub(super) struct Place {
    circulation: Circulation<f64>,
    /// 4K over the rate at |m| = 1: the time of a whole period, of either sign.
    period: f64,
    /// The part of a period between the two places on the polhode.
    pub(super) part: f64,
    /// Time at |m| = 1 after which the most turns are made.
    longest: f64,
    start: Vec3<f64>,
    end: Vec3<f64>,
}

/// Half the angle about the momentum by which the attitude at the end is off, as its cosine and sine.
#[derive(Clone, Copy, Debug)]
pub(super) struct Miss {
    pub(super) cos: f64,
    pub(super) sin: f64,
}

impl Miss {
    /// From `other` to this, in (−π, π].
    pub(super) fn since(self, other: Miss) -> f64 {
        let (sin, cos) =
            (self.sin * other.cos - self.cos * other.sin, self.cos * other.cos + self.sin * other.sin);
        libm::atan2(sin, cos)
    }
}

impl Place {
    /// Of the unit vector `start`; `turn` is the attitude at the end as seen from that at the start. `None` where the two places are
    /// not on one polhode, and where the momentum does not move.
    pub(super) fn of(moments: Vec3<f64>, turn: Quat<f64>, turns: f64, start: Vec3<f64>) -> Option<Place> {
        let start = start * (1.0 / start.norm());
        let end = turn.rotate_back(start);
        let polhode = Polhode::of(moments, start, 1.0, rounded_separation(moments, start))?;
        let [a, b, c] = polhode.axes;
        if end[a] * polhode.sigma <= 0.0 || polhode.is_separatrix() {
            return None;
        }
        let quarter = polhode.quarter_period();
        let [_, amp_b, amp_c] = polhode.amplitude;
        let (x, y) = (end[b] / amp_b, end[c] / amp_c);
        let half_turned = y < 0.0;
        let length = (x * x + y * y).sqrt() * if half_turned { -1.0 } else { 1.0 };
        let to = incomplete(x / length, y / length, polhode.parameter, polhode.complement);
        let halves = f64::from(u8::from(half_turned)) - f64::from(u8::from(polhode.half_turned));
        let part = (to - polhode.phase()) / (4.0 * quarter) + 0.5 * halves;
        let (rate, twice_energy) = (polhode.rate, polhode.twice_energy);
        let found = Place {
            period: 4.0 * quarter / rate,
            part,
            longest: core::f64::consts::TAU * turns / twice_energy,
            start,
            end,
            circulation: Circulation::of(polhode, start).with_period(),
        };
        (found.period.is_finite() && found.part.is_finite()).then_some(found)
    }

    /// The same with the part of a period that is nearest to `part` but for whole periods.
    pub(super) fn near(mut self, part: f64) -> Place {
        self.part += (part - self.part).round();
        self
    }

    /// Time at |m| = 1, which is the momentum for the time 1, after `n` further periods.
    pub(super) fn length(&self, n: i64) -> f64 {
        (self.part + n as f64) * self.period
    }

    /// The momentum for the time 1.
    pub(super) fn momentum(&self, n: i64) -> Vec3<f64> {
        self.start * self.length(n)
    }

    /// Whether the motion goes forward and makes no more than the most turns.
    pub(super) fn is_within(&self, n: i64) -> bool {
        let length = self.length(n);
        length > 0.0 && length <= self.longest
    }

    /// Whether somewhere between this place and `other` the motion of `n` further periods may be within.
    pub(super) fn may_be_within(&self, other: &Place, n: i64) -> bool {
        let (a, b) = (self.length(n) / self.longest, other.length(n) / other.longest);
        a.min(b) < 1.0 + MARGIN && a.max(b) > -MARGIN
    }

    /// The whole periods that may be near.
    pub(super) fn periods(&self) -> core::ops::RangeInclusive<i64> {
        let most = self.longest * (1.0 + MARGIN) / self.period;
        let (low, high) = (most.min(-MARGIN * most) - self.part, most.max(-MARGIN * most) - self.part);
        low.floor() as i64..=high.ceil() as i64
    }

    /// By how much the attitude `turn` is missed after `n` further periods.
    pub(super) fn miss(&self, turn: Quat<f64>, n: i64) -> Miss {
        let (made, _) = self.circulation.at(self.length(n));
        let rest = made.conjugate() * turn;
        let (sin, cos) = (rest.v.dot(self.end), rest.w);
        let norm = (sin * sin + cos * cos).sqrt();
        Miss { cos: cos / norm, sin: sin / norm }
    }
}

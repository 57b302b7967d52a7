//! The motions from one attitude to another whose momentum starts in one direction.

use core::f64::consts::{PI, TAU};

use crate::flow::free::circulation::Circulation;
use crate::flow::free::polhode::{Polhode, rounded_separation};
use crate::num::elliptic::{incomplete, r_d};
use crate::rotation::{Quat, Vec3};

/// Of the longest time, beyond it.
const MARGIN: f64 = 0.3;

/// A number with its derivative along the cone.
#[derive(Clone, Copy, Debug)]
pub(super) struct Moving {
    pub(super) value: f64,
    pub(super) slope: f64,
}

impl Moving {
    fn after(self, n: f64, each: Moving) -> Moving {
        Moving { value: self.value + n * each.value, slope: self.slope + n * each.slope }
    }
}

/// A direction of the momentum, from which one of its own length comes to the right place in the body after each whole number of
/// periods; the attitude then is right but for a turn about the momentum.
///
/// # The derivative of that turn
/// Along the cone, with |m| = 1, it needs no third kind of integral: `dχ = λ dE + 2E dλ`, λ the time and E the energy. This is
/// `δθ·L = t ω·δm` of the derivative of the motion, and the turn about L of the time that is added.
#[derive(Clone, Copy, Debug)]
pub(super) struct Place {
    start: Vec3<f64>,
    twice_energy: f64,
    energy_slope: f64,
    /// Time at |m| = 1, which is the momentum for the time 1, and what each whole period adds to it; of either sign.
    length: Moving,
    period: Moving,
    /// Half the angle about the momentum by which the end is missed, and what each whole period adds to it, rad.
    miss: f64,
    miss_of_period: f64,
    /// Time at |m| = 1 after which the most turns are made.
    longest: f64,
}

/// `angle` less the nearest multiple of π: half angles of one attitude.
pub(super) fn folded(angle: f64) -> f64 {
    angle - PI * (angle / PI).round()
}

/// A place on a polhode: the pair (sn, cn ≥ 0), whether both are turned round, the phase from −K to K and its slope.
struct Phase {
    pair: (f64, f64),
    half_turned: bool,
    phase: Moving,
}

impl Phase {
    /// Of the unit vector `m` with the slope `change`, where the parameter has the slope `by_parameter`.
    fn of(polhode: &Polhode<f64>, m: Vec3<f64>, change: Vec3<f64>, parameter_slope: f64) -> Phase {
        let ([_, b, c], [_, amp_b, amp_c]) = (polhode.axes, polhode.amplitude);
        let (x, y) = (m[b] / amp_b, m[c] / amp_c);
        let half_turned = y < 0.0;
        let length = (x * x + y * y).sqrt() * if half_turned { -1.0 } else { 1.0 };
        let (x, y) = (x / length, y / length);
        let square = polhode.complement + polhode.parameter * y * y;
        // both amplitudes change in proportion
        let angle_slope = (y * change[b] / amp_b - x * change[c] / amp_c) / length;
        let by_parameter = x * x * x * r_d(y * y, 1.0, square) / 6.0;
        let slope = angle_slope / square.sqrt() + by_parameter * parameter_slope;
        let value = incomplete(x, y, polhode.parameter, polhode.complement);
        Phase { pair: (x, y), half_turned, phase: Moving { value, slope } }
    }
}

impl Place {
    /// Of the unit vector `start`, which changes by `change`; `turn` is the attitude at the end as seen from that at the start. `None`
    /// where the two places are not on one polhode, and where the momentum does not move.
    pub(super) fn of(
        moments: Vec3<f64>,
        turn: Quat<f64>,
        turns: f64,
        start: Vec3<f64>,
        change: Vec3<f64>,
    ) -> Option<Place> {
        let start = start * (1.0 / start.norm());
        let (end, end_change) = (turn.rotate_back(start), turn.rotate_back(change));
        let polhode = Polhode::of(moments, start, 1.0, rounded_separation(moments, start))?;
        let a = polhode.axes[0];
        if end[a] * polhode.sigma <= 0.0 || polhode.is_separatrix() {
            return None;
        }
        let energy_slope: f64 = (0..3).map(|k| start[k] * change[k] / moments[k]).sum();
        // of 1 − 2E I_c, which the amplitude along a and the rate follow, and of the parameter
        let ([i_a, i_b, i_c], parameter) = (polhode.moments, polhode.parameter);
        let delta_c = -(polhode.amplitude[0] * polhode.amplitude[0]) * (i_c - i_a) / i_a;
        let per_energy = energy_slope / delta_c;
        let rate_slope = -i_c * per_energy;
        let parameter_slope = 2.0 * per_energy * ((i_c - i_b) / (i_b - i_a) * i_a + parameter * i_c);

        let from = Phase::of(&polhode, start, change, parameter_slope);
        let to = Phase::of(&polhode, end, end_change, parameter_slope);
        let quarter = Moving {
            value: polhode.quarter_period(),
            slope: r_d(0.0, 1.0, polhode.complement) / 6.0 * parameter_slope,
        };
        let halves = f64::from(u8::from(to.half_turned)) - f64::from(u8::from(from.half_turned));
        let timed = |phase: Moving| {
            let value = phase.value / polhode.rate;
            Moving { value, slope: phase.slope / polhode.rate - value * rate_slope }
        };
        let between =
            Moving { value: to.phase.value - from.phase.value, slope: to.phase.slope - from.phase.slope };
        let length = timed(between.after(2.0 * halves, quarter));
        let period = timed(Moving { value: 4.0 * quarter.value, slope: 4.0 * quarter.slope });

        let twice_energy = polhode.twice_energy;
        let circulation = Circulation::of(polhode, start).with_period();
        let [twist, of_period] = circulation.twists(length.value, halves, to.pair, period.value)?;
        let rest = circulation.turn(twist, end).conjugate() * turn;
        let found = Place {
            start,
            twice_energy,
            energy_slope,
            length,
            period,
            miss: libm::atan2(rest.v.dot(end), rest.w),
            miss_of_period: -0.5 * of_period,
            longest: TAU * turns / twice_energy,
        };
        (period.value.is_finite() && length.value.is_finite() && found.miss.is_finite()).then_some(found)
    }

    /// The part of a period between the two places on the polhode.
    pub(super) fn part(&self) -> Moving {
        let value = self.length.value / self.period.value;
        Moving { value, slope: (self.length.slope - value * self.period.slope) / self.period.value }
    }

    /// The same with the part of a period that is nearest to `part` but for whole periods.
    pub(super) fn near(mut self, part: f64) -> Place {
        let n = (part - self.part().value).round();
        self.length = self.length.after(n, self.period);
        self.miss += n * self.miss_of_period;
        self
    }

    /// Time at |m| = 1 after `n` further periods.
    fn length(&self, n: i64) -> f64 {
        self.length.after(n as f64, self.period).value
    }

    /// The momentum for the time 1, if the motion makes no more than the most turns; back in time from this direction is forth
    /// from the opposite one.
    pub(super) fn momentum(&self, n: i64) -> Option<Vec3<f64>> {
        let length = self.length(n);
        (length != 0.0 && length.abs() <= self.longest).then(|| self.start * length)
    }

    /// Whether somewhere between this place and `other` the motion of `n` further periods may make few enough turns.
    pub(super) fn may_be_within(&self, other: &Place, n: i64) -> bool {
        let (a, b) = (self.length(n) / self.longest, other.length(n) / other.longest);
        a.min(b) < 1.0 + MARGIN && a.max(b) > -(1.0 + MARGIN)
    }

    /// The whole periods that may be near.
    pub(super) fn periods(&self) -> [i64; 2] {
        let most = (self.longest * (1.0 + MARGIN) / self.period.value).abs();
        let part = self.part().value;
        [(-most - part).floor() as i64, (most - part).ceil() as i64]
    }

    /// Half the angle by which the end is missed after `n` further periods, rad, but for half turns.
    pub(super) fn miss(&self, n: i64) -> Moving {
        let length = self.length.after(n as f64, self.period);
        let slope = -0.5 * (length.value * self.energy_slope + self.twice_energy * length.slope);
        Moving { value: folded(self.miss + n as f64 * self.miss_of_period), slope }
    }
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use super::*;
    use crate::flow::free::through::cone::{Cone, HALVES};
    use crate::num::trig::sin_cos;

    /// Values and slopes along the cone against central differences, for asymmetric and symmetric bodies of either kind.
    #[test]
    fn slopes_are_those_of_the_values() {
        let turn = Quat::from_components([0.7, 0.3, -0.5, 0.4]).normalized();
        let mut seen = 0;
        for moments in [[1.0, 2.0, 3.0], [3.0, 1.0, 2.5], [0.1, 1.0, 1.0], [1.0, 1.0, 1.8]] {
            let cone = Cone::of(Vec3(moments), turn).unwrap();
            for half in HALVES {
                for phi in [-1.3, -0.7, 0.2, 0.9] {
                    let at = |phi: f64| {
                        let [start, change] = cone.direction(half, sin_cos(phi));
                        Place::of(Vec3(moments), turn, 4.0, start, change)
                    };
                    const H: f64 = 1e-6;
                    let [Some(low), Some(here), Some(high)] = [-H, 0.0, H].map(|h| at(phi + h)) else {
                        continue;
                    };
                    let part = here.part().value;
                    let [low, high] = [low, high].map(|place| place.near(part));
                    for n in -2..3 {
                        let change = folded(high.miss(n).value - low.miss(n).value) / (2.0 * H);
                        let slope = here.miss(n).slope;
                        assert!(
                            (change - slope).abs() < 1e-7 * slope.abs().max(1.0),
                            "{change} {slope}: {here:?}"
                        );
                        seen += 1;
                    }
                }
            }
        }
        assert!(seen > 60, "{seen}");
    }
}

//! Phases counted in turns: products with any time, reduced without a rounded π.

use crate::num::error_free::{two_prod, two_sum};
use crate::num::trig::{nearest, sin_cos_turns};
use crate::num::{Dd, Precise};
use crate::rotation::{Quat, Vec3};

/// A double-double as two plain numbers.
pub(in crate::flow) type Pair = [f64; 2];

pub(in crate::flow) fn pair(x: Dd) -> Pair {
    [x.hi(), x.lo()]
}

/// Turns from which a `f64` product pair serves no longer: up to here its low part stays below 2⁻¹¹, so that the
/// rest after whole quarter turns hardly leaves the range of the kernels, which do not reduce the low part.
pub(in crate::flow) const TOO_FAR: f64 = 8_796_093_022_208.0; // 2^43

/// `rate · t + start`, both in double-double.
#[derive(Clone, Copy, Debug)]
pub(in crate::flow) struct Phase {
    rate: Pair,
    start: Pair,
}

impl Phase {
    pub(in crate::flow) fn new(rate: Dd, start: Dd) -> Self {
        Phase { rate: pair(rate), start: pair(start) }
    }

    /// The value at the time `t`, as a sum of two numbers.
    #[inline(always)]
    pub(in crate::flow) fn at(&self, [t, low]: Pair) -> (f64, f64) {
        let (product, rest) = two_prod(self.rate[0], t);
        let (sum, error) = two_sum(product, self.start[0]);
        (sum, (rest + (self.rate[1] * t + self.rate[0] * low)) + (error + self.start[1]))
    }
}

/// A turn at a constant rate about an axis fixed in the body and in space.
#[derive(Clone, Debug)]
pub(in crate::flow) struct Spin {
    axis: Vec3<Dd>,
    rate: Dd,
    half_angle: Phase, // in turns
}

impl Spin {
    /// About the unit vector `axis` at `rate` rad/s.
    pub(in crate::flow) fn new(axis: Vec3<Dd>, rate: Dd) -> Self {
        Spin { axis, rate, half_angle: Phase::new(rate / (Dd::TAU * 2.0), Dd::ZERO) }
    }

    /// rad/s.
    pub(in crate::flow) fn rate(&self) -> Dd {
        self.rate
    }

    /// The turn since the start; `None` after too many turns for `f64` pairs.
    #[inline]
    pub(in crate::flow) fn quick(&self, t: Pair) -> Option<Quat<f64>> {
        let (turns, low) = self.half_angle.at(t);
        if turns.is_nan() || turns.abs() >= TOO_FAR {
            return None;
        }
        let (sin, cos) = sin_cos_turns(turns - nearest(turns), low);
        Some(Quat::new(cos, Vec3(self.axis.0.map(|e| e.hi() * sin))))
    }

    /// The turn since the start, in double-double.
    pub(in crate::flow) fn precise(&self, t: Dd) -> Quat<Dd> {
        rotation(self.axis, self.rate * t)
    }
}

/// The rotation by `angle` about the unit vector `axis`.
pub(in crate::flow) fn rotation<S: Precise>(axis: Vec3<S>, angle: S) -> Quat<S> {
    let (sin, cos) = (reduce(angle, S::from_dd(Dd::TAU * 2.0)) * S::of(0.5)).sin_cos();
    Quat::new(cos, axis * sin)
}

/// Axis and rate of a turn about a momentum that stays fixed in the body: ω is parallel to m.
pub(in crate::flow) fn steady<S: Precise>(moments: Vec3<S>, m: Vec3<S>, norm: S) -> (Vec3<S>, S) {
    let omega = Vec3([m[0] / moments[0], m[1] / moments[1], m[2] / moments[2]]);
    (m * (S::of(1.0) / norm), m.dot(omega) / norm)
}

/// `x` less the nearest multiple of `period`.
pub(in crate::flow) fn reduce<S: Precise>(x: S, period: S) -> S {
    x - (x / period).round() * period
}

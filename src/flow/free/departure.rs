//! How a state departs from a free motion: a shift in time along the polhode, a twist about the angular momentum, and a tilt off the
//! polhode.

use super::FreeMotion;
use crate::body::Point;
use crate::num::{Dd, Precise, Real};
use crate::rotation::{Quat, Vec3, rotation_angle};

/// How a state departs from a free motion at a time: its momentum in the body is nearest to that of the motion at the time t + τ, whose
/// attitude R becomes that of the state by a turn by θ about ṁ, in the body, by ψ about L, in space, and by the smallest one that takes L
/// to that of the state.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct Departure {
    /// τ, s; zero where the momentum stands still in the body.
    pub shift: Dd,
    /// ψ, rad.
    pub twist: Dd,
    /// θ, rad: off the polhode, to another energy; zero where the momentum stands still in the body.
    pub tilt: Dd,
    /// Angle between both L, rad.
    pub lean: f64,
}

impl Departure {
    /// None.
    pub const NONE: Departure = Departure { shift: Dd::ZERO, twist: Dd::ZERO, tilt: Dd::ZERO, lean: 0.0 };

    /// What it is after the time `t` (s) where shift and twist grow linearly, at these rates in s/s and rad/s.
    #[must_use]
    pub fn grown([shift, twist]: [Dd; 2], t: Dd) -> Departure {
        Departure { shift: shift * t, twist: twist * t, tilt: Dd::ZERO, lean: 0.0 }
    }

    /// This one, of the time `t` (s), as it is at the time `later` where it grows in proportion: a guess for the next look.
    #[must_use]
    pub fn carried_on(self, t: Dd, later: Dd) -> Departure {
        Departure::grown([self.shift / t, self.twist / t], later)
    }
}

/// Rounds of Newton's method, which ends long before where the momentum does not all but stand still.
const ROUNDS: usize = 64;

/// Next to the separatrix it does, and a step of Newton's method would be a leap over periods: at most so far, in radians of the
/// fastest part of the phase.
const LEAP: f64 = 1.0;

/// The shift is found where a further round would move it by less than this share: Newton's method doubles its digits.
const STILL: f64 = 1e-16;

impl FreeMotion {
    /// How `point`, in the solver frame, departs from this motion at the time `t` (s). A period or a turn more would look the same: of
    /// all shifts and twists those next to `near` are taken.
    ///
    /// ```
    /// use polhode::flow::{Departure, FreeMotion};
    /// use polhode::inertia::Inertia;
    /// use polhode::num::{Dd, Precise, Real};
    /// let racket = Inertia::from_moments([1.0, 2.0, 3.0])?;
    /// let motion = FreeMotion::from_omega(&racket, Default::default(), [0.4, 1.0, -0.3].into())?;
    /// let late = motion.point_at_dd(Dd::of(10.001));
    /// let departure = motion.departure(Dd::of(10.0), &late, Departure::NONE);
    /// assert!((departure.shift.hi() - 0.001).abs() < 1e-15 && departure.twist.hi().abs() < 1e-15);
    /// assert!(departure.tilt.hi().abs() < 1e-15);
    /// # Ok::<(), polhode::Error>(())
    /// ```
    #[must_use]
    pub fn departure(&self, t: Dd, point: &Point<Dd>, near: Departure) -> Departure {
        let most = LEAP / self.fastest_rate();
        let mut shift = near.shift;
        let mut exact = self.point_at_dd(t + shift);
        for _ in 0..ROUNDS {
            let speed = self.speed(&exact);
            let squared = speed.norm_squared();
            if squared == Dd::ZERO {
                break;
            }
            let change = (point.momentum_body - exact.momentum_body).dot(speed) / squared;
            let change = if change.abs().hi() > most { Dd::of(most.copysign(change.hi())) } else { change };
            shift = shift + change;
            exact = self.point_at_dd(t + shift);
            if change.abs().hi() <= STILL * shift.abs().hi() {
                break;
            }
        }
        let axis = direction(exact.momentum_space());
        let lean = smallest_turn(axis, direction(point.momentum_space()));
        let turn = lean.conjugate() * point.attitude * exact.attitude.conjugate();
        let turn = if turn.w.hi() < 0.0 { -turn } else { turn };
        // of a turn by the vector v sin(φ/2) and the cosine w: the part about L is 2 atan2(v·L, w)
        let along = turn.v.dot(axis);
        let wrapped = along.atan2(turn.w) * 2.0;
        let turns = ((near.twist - wrapped) / Dd::TAU).round();
        // across L a turn by ψ about L and one by θ about a leave sin(θ/2) (cos(ψ/2) a + sin(ψ/2) L × a)
        let across = direction(exact.attitude.rotate(self.speed(&exact)));
        let (sin, cos) = (wrapped * 0.5).sin_cos();
        let half_sine = turn.v.dot(across * cos + axis.cross(across) * sin);
        let tilt = half_sine.atan2((Dd::ONE - half_sine * half_sine).sqrt()) * 2.0;
        let lean = rotation_angle(Quat::identity(), lean).hi();
        Departure { shift, twist: wrapped + Dd::TAU * turns, tilt, lean }
    }

    /// ṁ of a point of this body.
    fn speed(&self, point: &Point<Dd>) -> Vec3<Dd> {
        let m = point.momentum_body;
        m.cross(m.times(self.body().rotor().inverse_moments()))
    }

    /// The error of an attitude that departs by `departure` at the time `t`, the tilt left out, rad.
    #[must_use]
    pub fn attitude_error_of(&self, t: Dd, departure: Departure) -> f64 {
        let exact = self.point_at_dd(t);
        let shifted = self.point_at_dd(t + departure.shift);
        let (sin, cos) = (departure.twist * 0.5).sin_cos();
        let twist = Quat::new(cos, direction(exact.momentum_space()) * sin);
        rotation_angle(exact.attitude, twist * shifted.attitude).hi()
    }
}

/// The smallest turn that takes the unit vector `from` to `to`, which are less than half a turn apart.
pub(crate) fn smallest_turn<S: Real>(from: Vec3<S>, to: Vec3<S>) -> Quat<S> {
    Quat::new(S::of(1.0) + from.dot(to), from.cross(to)).normalized()
}

/// Of length one; of a body at rest, which has no twist, zero.
pub(crate) fn direction<S: Real + PartialEq>(momentum: Vec3<S>) -> Vec3<S> {
    let norm = momentum.norm();
    if norm == S::of(0.0) { momentum } else { momentum * (S::of(1.0) / norm) }
}

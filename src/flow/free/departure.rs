//! How a state departs from a free motion: a shift in time along the polhode, and a twist about the angular momentum.

use super::FreeMotion;
use crate::body::Point;
use crate::num::{Dd, Precise, Real};
use crate::rotation::{Quat, Vec3, rotation_angle};

/// How a state departs from a free motion at a time: its momentum is nearest to that of the motion at the time t + τ, from whose attitude
/// it is turned by ψ about L, and by the rest about axes across L.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct Departure {
    /// τ, s; zero where the momentum stands still in the body.
    pub shift: Dd,
    /// ψ, rad.
    pub twist: Dd,
    /// The rest, rad.
    pub rest: f64,
}

impl Departure {
    /// None.
    pub const NONE: Departure = Departure { shift: Dd::ZERO, twist: Dd::ZERO, rest: 0.0 };

    /// What it is after the time `t` (s) where shift and twist grow linearly, at these rates in s/s and rad/s.
    #[must_use]
    pub fn grown([shift, twist]: [Dd; 2], t: Dd) -> Departure {
        Departure { shift: shift * t, twist: twist * t, rest: 0.0 }
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
    /// assert!(departure.rest < 1e-15);
    /// # Ok::<(), polhode::Error>(())
    /// ```
    #[must_use]
    pub fn departure(&self, t: Dd, point: &Point<Dd>, near: Departure) -> Departure {
        let inverse: Vec3<Dd> = self.body().rotor().inverse_moments();
        let most = LEAP / self.fastest_rate();
        let mut shift = near.shift;
        let mut exact = self.point_at_dd(t + shift);
        for _ in 0..ROUNDS {
            let speed = exact.momentum_body.cross(exact.momentum_body.times(inverse));
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
        let turn = point.attitude * exact.attitude.conjugate();
        let turn = if turn.w.hi() < 0.0 { -turn } else { turn };
        // of a turn by the vector v sin(φ/2) and the cosine w: the part about L is 2 atan2(v·L, w)
        let along = turn.v.dot(axis);
        let wrapped = along.atan2(turn.w) * 2.0;
        let turns = ((near.twist - wrapped) / Dd::TAU).round();
        let rest = (turn.v - axis * along).norm().hi() * 2.0;
        Departure { shift, twist: wrapped + Dd::TAU * turns, rest }
    }

    /// The error of an attitude that departs by `departure` at the time `t`, the rest left out, rad.
    #[must_use]
    pub fn attitude_error_of(&self, t: Dd, departure: Departure) -> f64 {
        let exact = self.point_at_dd(t);
        let shifted = self.point_at_dd(t + departure.shift);
        let (sin, cos) = (departure.twist * 0.5).sin_cos();
        let twist = Quat::new(cos, direction(exact.momentum_space()) * sin);
        rotation_angle(exact.attitude, twist * shifted.attitude).hi()
    }
}

/// Of length one; of a body at rest, which has no twist, zero.
fn direction(momentum: Vec3<Dd>) -> Vec3<Dd> {
    let norm = momentum.norm();
    if norm == Dd::ZERO { momentum } else { momentum * (Dd::ONE / norm) }
}

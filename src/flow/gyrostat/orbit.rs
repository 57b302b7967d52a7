//! The motion of one gyrostat from one start, in the solver frame.

use super::character::GyrostatCharacter;
use super::error::GyrostatError;
use super::lattice::Lattice;
use super::level::{Course, Level};
use super::quick::Quick;
use super::spinor::Spinor;
use super::steady::steady_spins;
use crate::body::Point;
use crate::flow::free::{Spin, Stability, pair, reduce};
use crate::flow::reach::MOST_RADIANS;
use crate::num::complex::Complex;
use crate::num::{Dd, Real};
use crate::rotation::{Quat, Vec3};

/// Places of a period at which the equation of motion is checked; next to a separatrix most of them lie at the saddle.
const FEW: u32 = 2;
const MANY: u32 = 24;

/// Most by which a rate may miss, of the largest rate.
const LARGEST_DEFECT: f64 = 1e-15;

/// The same next to a separatrix, where errors at the start grow until the motion has left the saddle, some 10⁵ times.
const LARGEST_NEAR: f64 = 1e-21;

/// It is next to a separatrix where (e₁ − e₂)² is less than this share of its terms.
const NEAR: f64 = 1e-4;

/// The ratio y/T of a small oscillation about a stable spin is at least this; next to an unstable one it is below 1.
const LEAST_OF_SMALL: f64 = 3.0;

/// Constants of one motion, worked out once; then any time in O(1).
///
/// In `f64` attitude and momentum are right to 1e-15 (rad, of |m|), next to a separatrix to 3e-15, at any time up to 10⁹ rad of
/// the fastest rate and beyond; in double-double to 1e-20 near the start, but for small oscillations about a steady spin, of which
/// the second order is left out: 1e-15. Where the digits do not suffice [`new`](Self::new) refuses: every motion that moves is
/// compared with the equation of motion before it is answered.
#[derive(Clone, Debug)]
pub(crate) struct GyrostatOrbit {
    moments: Vec3<Dd>,
    wheel: Vec3<Dd>,
    start: Point<Dd>,
    kind: Kind,
    reach: f64,
}

#[derive(Clone, Debug)]
enum Kind {
    /// The momentum stays in the body, which turns about ω: a steady spin, and a body whose momentum is zero.
    Steady(Box<Spin>),
    Moving(Box<Moving>),
}

#[derive(Clone, Debug)]
struct Moving {
    spinor: Spinor,
    quick: Quick,
    frame: [Vec3<Dd>; 3],
    norm: Dd,
    /// τ/t.
    rate: Dd,
    period: Dd,
}

impl GyrostatOrbit {
    /// Of a body with the principal `moments` and the `wheel` momentum h along the principal axes, from `start`, whose momentum
    /// is the total one, at t = 0.
    pub(crate) fn new(moments: Vec3<Dd>, wheel: Vec3<Dd>, start: Point<Dd>) -> Result<Self, GyrostatError> {
        let fastest = {
            let size = start.momentum_body.norm_of_any_size() + wheel.norm_of_any_size();
            (size / moments[moments.ascending()[0]]).hi()
        };
        let reach = if fastest > 0.0 { MOST_RADIANS / fastest } else { f64::INFINITY };
        let level = match Level::of(moments, wheel, start.momentum_body) {
            Course::Empty(omega) | Course::Steady(omega) => {
                let rate = omega.norm_of_any_size();
                let axis = if rate == Dd::ZERO { Vec3::unit(0) } else { omega * (Dd::ONE / rate) };
                let kind = Kind::Steady(Box::new(Spin::new(axis, rate)));
                return Ok(GyrostatOrbit { moments, wheel, start, kind, reach });
            }
            Course::Moving(level) => level,
        };
        let (spinor, apart) = if level.is_elementary() {
            (Spinor::elementary(&level), 1.0)
        } else {
            let lattice = Lattice::new(&level.pencil);
            let ratio = lattice.ratio().hi();
            if Spinor::is_small(&level, &lattice) && ratio < LEAST_OF_SMALL {
                return Err(GyrostatError::Saddle { length: (level.speed * lattice.period).hi() });
            }
            (Spinor::new(&level, lattice), level.pencil.apart)
        };
        let is_near = apart < NEAR;
        let defect = defect(&level, &spinor, if is_near { MANY } else { FEW });
        if defect.is_nan() || defect > if is_near { LARGEST_NEAR } else { LARGEST_DEFECT } {
            return Err(if is_near {
                GyrostatError::Separatrix { apart, defect }
            } else {
                GyrostatError::Digits { defect }
            });
        }
        let norm = start.momentum_body.norm_of_any_size();
        let quick = Quick::new(&level, &spinor, [moments, wheel], &start, norm);
        let moving = Moving {
            quick,
            frame: level.frame,
            norm,
            rate: level.rate,
            period: Dd::TAU / (spinor.rate * level.rate),
            spinor,
        };
        Ok(GyrostatOrbit { moments, wheel, start, kind: Kind::Moving(Box::new(moving)), reach })
    }

    /// The largest |t| (s) at which the phases still have digits.
    pub(crate) fn reach(&self) -> f64 {
        self.reach
    }

    /// |m|, that of body and wheels.
    pub(crate) fn momentum_norm(&self) -> Dd {
        self.start.momentum_body.norm_of_any_size()
    }

    /// Period, energy and separatrices.
    pub(crate) fn character(&self) -> GyrostatCharacter {
        let m = self.start.momentum_body;
        let energy = (0..3).fold(Dd::ZERO, |sum, k| {
            let own = m[k] - self.wheel[k];
            sum + own * own / self.moments[k] * 0.5
        });
        let spins = steady_spins(self.moments, self.wheel, m.norm_of_any_size());
        let saddles = spins.iter().filter(|spin| spin.stability == Stability::Unstable);
        let (period, turn) = match &self.kind {
            Kind::Steady(_) => (None, None),
            Kind::Moving(moving) => {
                let turn = moving.spinor.twist / moving.spinor.rate * Dd::TAU * 2.0;
                (Some(moving.period.hi()), Some(reduce(turn, Dd::TAU).hi()))
            }
        };
        GyrostatCharacter {
            period,
            turn_per_period: turn,
            energy: energy.hi(),
            separatrix_energies: saddles.map(|spin| spin.energy).collect(),
        }
    }

    /// The point at the time `t` (s).
    ///
    /// The quaternion is the continuous lift from the start: it does not jump from `q` to `−q`.
    #[inline]
    pub(crate) fn point_after(&self, t: Dd) -> Point<f64> {
        if t == Dd::ZERO {
            return self.start.to_f64();
        }
        let quick = match &self.kind {
            Kind::Steady(spin) => spin.quick(pair(t)).map(|turn| {
                let start = self.start.to_f64();
                (start.attitude * turn, start.momentum_body)
            }),
            Kind::Moving(moving) => moving.quick.at(pair(t)),
        };
        match quick {
            Some((attitude, momentum_body)) => Point::new(attitude, momentum_body),
            None => self.point_at_dd(t).to_f64(),
        }
    }

    /// The same in double-double.
    pub(crate) fn point_at_dd(&self, t: Dd) -> Point<Dd> {
        if t == Dd::ZERO {
            return self.start;
        }
        match &self.kind {
            Kind::Steady(spin) => Point::new(self.start.attitude * spin.precise(t), self.start.momentum_body),
            Kind::Moving(moving) => {
                let (turn, momentum) = moving.after(t);
                Point::new(self.start.attitude * turn, momentum)
            }
        }
    }
}

impl Moving {
    /// The turn since the start and the momentum.
    fn after(&self, t: Dd) -> (Quat<Dd>, Vec3<Dd>) {
        let tau = self.rate * t;
        let functions = self.spinor.at(self.spinor.rate / Dd::TAU * tau);
        let phase = Complex::phase(reduce(self.spinor.twist * tau, Dd::TAU));
        let Quat { w, v } = Spinor::turn(functions.map(|f| f * phase)).normalized();
        let body = |v: [Dd; 3]| self.frame[0] * v[0] + self.frame[1] * v[1] + self.frame[2] * v[2];
        (Quat::new(w, body(v.0)), body(Spinor::direction(functions)) * self.norm)
    }
}

/// The largest defect of p' = ½ p ω, of the largest rate, at some places of a period.
fn defect(level: &Level, spinor: &Spinor, places: u32) -> f64 {
    let mut largest = 0.0_f64;
    for n in 0..places {
        let value = spinor.with_rates(Dd::of((f64::from(n) + 0.58) / f64::from(places)));
        let [z, w] = value.functions;
        let square = z.norm_squared() + w.norm_squared();
        let growth = {
            let [dz, dw] = value.rates;
            ((z.conjugate() * dz).re + (w.conjugate() * dw).re) / square
        };
        let factor = Complex::new(-growth, spinor.twist);
        let rates = [0, 1].map(|k| value.rates[k] + value.functions[k] * factor);
        let omega = level.omega(Spinor::direction(value.functions));
        let off = Spinor::turn(rates) - Spinor::turn(value.functions).rate(omega);
        let off = off.magnitude() / (square.sqrt().hi() * (1.0 + level.common.hi()));
        // f64::max would drop a NaN
        if off.is_nan() {
            return off;
        }
        largest = largest.max(off);
    }
    largest
}

#[cfg(test)]
mod tests;

//! The motion of one free body from one start, in the solver frame.

use std::sync::OnceLock;

use super::addition::{Addition, Curve};
use super::character::{AtRest, Character};
use super::circulation::Circulation;
use super::derivative::Variation;
use super::phase::{Spin, pair, steady};
use super::polhode::{Polhode, exact_separation};
use super::theta::{Points, Theta};
use crate::body::{Phase, Point};
use crate::num::{Dd, Instructions, LANES, Lane, Precise};
use crate::rotation::{Quat, Vec3};

/// Constants of one motion, worked out once; then any time in O(1).
#[derive(Clone, Debug)]
pub(crate) struct FreeOrbit {
    moments: Vec3<Dd>,
    start: Point<Dd>,
    /// |m|.
    norm: Dd,
    kind: Kind,
}

/// What becomes of the momentum in the body.
#[derive(Clone, Debug)]
enum Kind {
    /// There is none: the attitude stays.
    Rest,
    /// It is fixed, and the body turns about it: a sphere, a pure spin.
    Steady(Box<Spin>),
    /// It moves along its polhode.
    Circulating(Box<Circulating>),
}

/// A polhode with both its forms: theta functions in `f64`, Carlson's integrals in double-double when asked for.
#[derive(Clone, Debug)]
struct Circulating {
    polhode: Polhode<Dd>,
    momentum: Vec3<Dd>,
    quick: Theta,
    precise: OnceLock<Circulation<Dd>>,
}

impl Circulating {
    fn precise(&self) -> &Circulation<Dd> {
        self.precise.get_or_init(|| Circulation::of(self.polhode.clone(), self.momentum).with_period())
    }
}

/// Fewer times than these are taken one by one.
const FEW: usize = 8;

impl FreeOrbit {
    /// Of a body with the principal `moments`, from `start` at t = 0.
    pub(crate) fn new(moments: Vec3<Dd>, start: Point<Dd>) -> Self {
        let momentum = start.momentum_body;
        let norm = momentum.norm();
        let kind = if norm == Dd::ZERO {
            Kind::Rest
        } else if let Some(polhode) =
            Polhode::of(moments, momentum, norm, exact_separation(moments, momentum))
        {
            let quick = Theta::of(&polhode, start.attitude, momentum);
            Kind::Circulating(Box::new(Circulating { polhode, momentum, quick, precise: OnceLock::new() }))
        } else {
            let (axis, rate) = steady(moments, momentum, norm);
            Kind::Steady(Box::new(Spin::new(axis, rate)))
        };
        FreeOrbit { moments, start, norm, kind }
    }

    /// The point at the time `t` (s).
    ///
    /// The quaternion is the continuous lift from the start: it does not jump from `q` to `−q`.
    #[inline]
    pub(crate) fn at(&self, t: Dd) -> Point<f64> {
        if t == Dd::ZERO {
            return self.start.to_f64();
        }
        let quick = match &self.kind {
            Kind::Circulating(orbit) => orbit.quick.at(pair(t)),
            Kind::Steady(spin) => spin.quick(pair(t)).map(|turn| {
                let start = self.start.to_f64();
                (start.attitude * turn, start.momentum_body)
            }),
            Kind::Rest => None,
        };
        match quick {
            Some((attitude, momentum_body)) => Point::new(attitude, momentum_body),
            None => self.at_dd(t).to_f64(),
        }
    }

    /// Gives `each` attitude and momentum at the `times` (s), with their numbers.
    pub(crate) fn at_many(&self, times: &[f64], by: Instructions, mut each: impl FnMut(usize, Phase<f64>)) {
        let mut lanes = Points::new();
        for (block, times) in times.chunks(LANES).enumerate() {
            let together = match &self.kind {
                // what a block takes is as long as a dozen single times
                Kind::Circulating(_) if times.len() < FEW => false,
                Kind::Circulating(orbit) => {
                    let mut t = Lane::ZERO;
                    t[..times.len()].copy_from_slice(times);
                    orbit.quick.at_all(&t, &mut lanes, by)
                }
                Kind::Steady(_) | Kind::Rest => false,
            };
            // one call of `each`, so that it is inlined and no point waits to be read from memory
            let point = lanes.by_lane();
            for (n, &t) in times.iter().enumerate() {
                let x = if !together {
                    self.at(Dd::from(t)).phase()
                } else if t == 0.0 {
                    self.start.to_f64().phase()
                } else {
                    point(n)
                };
                each(block * LANES + n, x);
            }
        }
    }

    /// The same in double-double, by an independent form of the solution.
    pub(crate) fn at_dd(&self, t: Dd) -> Point<Dd> {
        if t == Dd::ZERO {
            return self.start;
        }
        let (turn, momentum_body) = self.turned(t);
        Point::new(self.start.attitude * turn, momentum_body)
    }

    /// The turn since the start, and the momentum at the time `t`.
    fn turned(&self, t: Dd) -> (Quat<Dd>, Vec3<Dd>) {
        match &self.kind {
            Kind::Circulating(orbit) => orbit.precise().at(t),
            Kind::Steady(spin) => (spin.precise(t), self.start.momentum_body),
            Kind::Rest => (Quat::identity(), Vec3::zero()),
        }
    }

    /// The curve of the momentum by its invariants; `None` where the momentum is fixed, and next to the separatrix.
    pub(crate) fn curve<S: Precise>(&self) -> Option<Curve<S>> {
        match &self.kind {
            Kind::Circulating(orbit) => Curve::of(&orbit.polhode),
            Kind::Rest | Kind::Steady(_) => None,
        }
    }

    /// The map of this motion for the time `h`, without functions of a phase; `None` where it has no such
    /// [curve](Self::curve), and where h is too long a time.
    pub(crate) fn addition<S: Precise>(&self, h: Dd) -> Option<Addition<S>> {
        let Kind::Circulating(orbit) = &self.kind else { return None };
        Addition::of(&orbit.polhode, self.moments, h, self.start.momentum_body, || self.turned(h))
    }

    /// The constants of the derivative by the start and the moments.
    pub(super) fn variation(&self) -> Variation {
        let polhode = match &self.kind {
            Kind::Circulating(orbit) => Some(&orbit.polhode),
            Kind::Rest | Kind::Steady(_) => None,
        };
        Variation::new(self.moments, self.start.momentum_body, polhode)
    }

    /// |m|, which stays.
    pub(super) fn momentum_norm(&self) -> Dd {
        self.norm
    }

    /// The point at the start.
    pub(super) fn start(&self) -> Point<Dd> {
        self.start
    }

    /// Periods, mode and distance to the separatrix.
    pub(super) fn character(&self) -> Result<Character, AtRest> {
        match &self.kind {
            Kind::Rest => Err(AtRest),
            Kind::Steady(spin) => {
                let moment = self.norm / spin.rate();
                Ok(Character::steady(spin.rate(), moment, self.moments[self.moments.ascending()[1]]))
            }
            Kind::Circulating(orbit) => Ok(Character::circulating(&orbit.polhode, orbit.precise())),
        }
    }

    /// How often the momentum along the axis of the middle moment changes sign between the start and time `t` (s).
    pub(super) fn flips(&self, t: Dd) -> u64 {
        match &self.kind {
            Kind::Circulating(orbit) => orbit.precise().flips(t),
            Kind::Rest | Kind::Steady(_) => 0,
        }
    }
}

//! Kicks of the potential around the exact motion of the free body.

use super::{Claimed, Claims, Cost, Energy, Kept, KeptHeavy, Method, Step, StepError, usable};
use crate::body::{Body, Carry, State};
use crate::flow::{Flow, FreeBody, Kick, ShortDrift, SymmetricTop};
use crate::num::{Dd, Precise, Real};
use crate::rotation::{Quat, Vec3};

/// Strang splitting of H = T + U into the two flows that are known exactly (methods.md §8).
///
/// Φ_h = K(h/2) F(h) K(h/2), K the [kick](Kick) of the potential and F the motion of the [free body](FreeBody), two
/// turns where it is a [symmetric top](SymmetricTop). Keeps L_z and the
/// bracket, and for exponentially long times the energy within O(h²); a fast top under a weak torque is followed with
/// an error in proportion to the torque. Without torque it is the exact motion.
///
/// Short drifts are increments whose rounding is carried. What rounding takes from the energy and from L in a drift
/// by elliptic functions is measured in double-double and given back: else both would move away slowly, by a few
/// hundredths of a rounding error in each drift.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct KickDrift;

/// A prepared step of [`KickDrift`].
#[derive(Clone, Copy, Debug)]
pub struct KickDriftStep<S> {
    h: S,
    half: S,
    kick: Kick<S>,
    drift: Drift<S>,
    inverse_moments: Vec3<Dd>,
    carry: Carry<S>,
}

impl Claimed for KickDrift {
    fn name(&self) -> String {
        "kick-drift".into()
    }
    fn claims(&self) -> Claims {
        Claims {
            order: 2,
            symmetric: true,
            poisson: true,
            free: Kept { energy: Energy::Exact, momentum: true, momentum_space: true, norm: true },
            exact_when_free: true,
            potential: Some(KeptHeavy { energy: Energy::Bounded, momentum_z: true, norm: true }),
            cost: Cost::Drifts(1),
            source: "Strang, SIAM J. Numer. Anal. 5 (1968) 506; Celledoni, Fasso, Safstrom and Zanna, SIAM J. Sci. Comput. 30 (2008) 2084",
        }
    }
}

impl<S: Precise> Method<S> for KickDrift {
    type Step = KickDriftStep<S>;
    fn prepare(&self, h: f64, body: &Body, _: &State<S>) -> Result<KickDriftStep<S>, StepError> {
        let h = S::of(usable(h)?);
        Ok(KickDriftStep {
            h,
            half: h * S::of(0.5),
            kick: Kick::new(body),
            drift: match SymmetricTop::new(body) {
                Some(flow) => Drift::SymmetricTop(flow),
                None => Drift::FreeBody(ShortDrift::new(body), FreeBody::new(body)),
            },
            inverse_moments: body.inverse_moments(),
            carry: Carry::default(),
        })
    }
}

impl<S: Precise> Step<S> for KickDriftStep<S> {
    fn step(&mut self, x: &mut State<S>) {
        self.kick.carried(self.half, x, &mut self.carry);
        match self.drift {
            Drift::SymmetricTop(flow) => flow.carried(self.h, x, &mut self.carry),
            Drift::FreeBody(short, any) => {
                if !short.carried(self.h, x, &mut self.carry) {
                    let before = self.invariants(x);
                    any.flow(self.h, x);
                    self.restore(before, x);
                }
            }
        }
        self.carry.end_step(x);
        self.kick.carried(self.half, x, &mut self.carry);
    }
}

#[derive(Clone, Copy, Debug)]
enum Drift<S> {
    SymmetricTop(SymmetricTop<S>),
    FreeBody(ShortDrift<S>, FreeBody<S>),
}

/// What a drift keeps: 2T, |m|² and L.
struct Invariants {
    twice_energy: Dd,
    squared: Dd,
    space: Vec3<Dd>,
}

impl<S: Precise> KickDriftStep<S> {
    fn invariants(&self, x: &State<S>) -> Invariants {
        let m = Vec3(x.momentum_body.0.map(S::to_dd));
        let q = Quat::from_components(x.attitude.components().map(S::to_dd));
        Invariants {
            twice_energy: m.times(self.inverse_moments).dot(m),
            squared: m.norm_squared(),
            space: q.rotate(m),
        }
    }

    /// Moves `x` back, to first order, to the invariants from `before` a drift.
    fn restore(&mut self, before: Invariants, x: &mut State<S>) {
        let after = self.invariants(x);
        let m = x.momentum_body;
        let squared = m.norm_squared();
        if squared == S::of(0.0) {
            return;
        }
        let half = |x: Dd| S::from_dd(x * 0.5);
        // the size by a part along m, then the energy by one along ω less its part along m
        let stretch = half(before.squared - after.squared) / squared;
        let omega = m.times(Vec3(self.inverse_moments.0.map(S::from_dd)));
        let twice_energy = m.dot(omega);
        let across = omega - m * (twice_energy / squared);
        let across_squared = across.norm_squared();
        let mut change = m * stretch;
        // next to a principal axis the energy follows from the size; and the lack is measured to the rounding of Dd,
        // which `across` divides: in f64 the change stays far more exact than m, in Dd there is nothing but rounding
        if across_squared > omega.norm_squared() * S::of(Dd::ROUNDOFF / S::ROUNDOFF) {
            let lacking = half(before.twice_energy - after.twice_energy) - stretch * twice_energy;
            change = change + across * (lacking / across_squared);
        }
        self.carry.add_momentum(x, change);
        // the direction of L by a turn in space
        let difference = Vec3((before.space - after.space).0.map(S::from_dd));
        let l = Vec3(after.space.0.map(S::from_dd));
        let turn = Quat::new(S::of(0.0), l.cross(difference) * (S::of(0.5) / squared));
        self.carry.add_attitude(x, turn * x.attitude);
    }
}

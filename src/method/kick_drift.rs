//! Kicks of the potential around the exact motion of the free body.

use super::{Claimed, Claims, Cost, Energy, Kept, KeptHeavy, Method, Step, StepError, usable};
use crate::body::{Body, State};
use crate::flow::{Flow, FreeBody, Kick};
use crate::num::Precise;

/// Strang splitting of H = T + U into the two flows that are known exactly (methods.md §8).
///
/// Φ_h = K(h/2) F(h) K(h/2), K the [kick](Kick) of the potential and F the [free body](FreeBody). Keeps L_z and the
/// bracket, and for exponentially long times the energy within O(h²); a fast top under a weak torque is followed with
/// an error in proportion to the torque. Without torque it is the exact motion.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct KickDrift;

/// A prepared step of [`KickDrift`].
#[derive(Clone, Copy, Debug)]
pub struct KickDriftStep<S> {
    h: S,
    half: S,
    kick: Kick<S>,
    drift: FreeBody<S>,
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
        Ok(KickDriftStep { h, half: h * S::of(0.5), kick: Kick::new(body), drift: FreeBody::new(body) })
    }
}

impl<S: Precise> Step<S> for KickDriftStep<S> {
    fn step(&mut self, x: &mut State<S>) {
        self.kick.flow(self.half, x);
        self.drift.flow(self.h, x);
        self.kick.flow(self.half, x);
    }
}

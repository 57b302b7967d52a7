//! One step of size h as a map: prepared once for a body and a step, then applied many times.

use crate::body::{Clock, Field, Point, Rotor, Time};
use crate::num::{Dd, Real};

/// A family of maps Φ_h, one for each duration, body and field of forces.
///
/// A method of one's own implements this for every scalar and field, and [`Claimed`](super::Claimed).
pub trait Method<S: Real> {
    /// The map for one duration, with everything that does not change from step to step worked out.
    type Map<F: Field<S>>: Map<S>;

    /// The map for the duration `h` (s, may be negative), a body with the constants `rotor` and the field `field`.
    fn map<F: Field<S>>(&self, h: Dd, rotor: &Rotor, field: &F) -> Self::Map<F>;
}

/// One map Φ_h.
pub trait Map<S: Real>: Send + 'static {
    /// x ← Φ_h(x), from the time `at` on. Cannot fail; an implicit map keeps its worst residual instead.
    fn apply(&mut self, at: Time, x: &mut Point<S>);

    /// The worst relative residual at which an implicit solve ended; 0 for explicit maps.
    fn worst_residual(&self) -> f64 {
        0.0
    }
}

/// Whole steps, counted and timed: what the dynamic outside sees of a [`Map`], with one virtual call for many steps.
pub trait Step<S: Real>: Send {
    /// Takes one step.
    fn step(&mut self, x: &mut Point<S>);

    /// Takes `n` steps.
    fn steps(&mut self, x: &mut Point<S>, n: u64);

    /// Takes as many steps as `block` has places, and leaves in each the point after its step.
    fn fill(&mut self, x: &mut Point<S>, block: &mut [Point<S>]);

    /// As [`Map::worst_residual`].
    fn worst_residual(&self) -> f64;
}

/// A map that is applied step by step.
#[derive(Clone, Debug)]
pub(super) struct Stepper<M> {
    map: M,
    clock: Clock,
}

impl<M> Stepper<M> {
    pub(super) fn new(map: M, clock: Clock) -> Self {
        Stepper { map, clock }
    }
}

impl<S: Real, M: Map<S>> Step<S> for Stepper<M> {
    #[inline]
    fn step(&mut self, x: &mut Point<S>) {
        self.map.apply(self.clock.at(x.steps()), x);
        x.count_step();
    }

    fn steps(&mut self, x: &mut Point<S>, n: u64) {
        for _ in 0..n {
            self.step(x);
        }
    }

    fn fill(&mut self, x: &mut Point<S>, block: &mut [Point<S>]) {
        for place in block {
            self.step(x);
            *place = *x;
        }
    }

    fn worst_residual(&self) -> f64 {
        self.map.worst_residual()
    }
}

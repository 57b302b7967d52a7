//! Higher order by composition: one symmetric map, taken with steps of several lengths.

use super::{Claimed, Claims, Cost, Method, Step, StepError, usable};
use crate::body::{Body, State};
use crate::num::{Dd, Real};

/// A symmetric composition Φ_{γ₁h} ∘ … ∘ Φ_{γₛh} of a symmetric map of order 2, γ palindromic with sum 1.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Scheme {
    /// Short name.
    pub name: &'static str,
    /// Order that the composition has.
    pub order: u32,
    /// Where the coefficients come from.
    pub source: &'static str,
    /// γ₁, γ₂, … up to the centre, which is what is left of 1.
    pub half: &'static [Dd],
}

/// Suzuki's fractal of five steps, γ₁ = γ₂ = 1/(4 − ∛4): the smallest Σ|γ| of order 4.
pub const SUZUKI_4: Scheme =
    Scheme { name: "suzuki-4", order: 4, source: "Suzuki, Phys. Lett. A 146 (1990) 319", half: &[SUZUKI; 2] };

const SUZUKI: Dd = Dd::sum(0.4144907717943757, 2.5197374150855977e-17);

/// A method of higher order, composed of steps of `base`.
///
/// ```
/// use polhode::method::{Claimed, Composed, KickDrift, SUZUKI_4};
/// let method = Composed { base: KickDrift, scheme: SUZUKI_4 };
/// assert_eq!(method.claims().order, 4);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Composed<M> {
    /// A symmetric method of order 2.
    pub base: M,
    /// The lengths of its steps.
    pub scheme: Scheme,
}

/// A prepared step of [`Composed`].
#[derive(Clone, Debug)]
pub struct ComposedStep<T> {
    /// The outer steps up to the centre; on the way back they are taken in reverse.
    outer: Vec<T>,
    centre: T,
}

impl<M: Claimed> Claimed for Composed<M> {
    fn name(&self) -> String {
        format!("{}:{}", self.base.name(), self.scheme.order)
    }
    fn claims(&self) -> Claims {
        let base = self.base.claims();
        let stages = 2 * self.scheme.half.len() as u32 + 1;
        let cost = match base.cost {
            Cost::RightSides(n) => Cost::RightSides(n * stages),
            Cost::Turns(n) => Cost::Turns(n * stages),
            Cost::Drifts(n) => Cost::Drifts(n * stages),
            Cost::Solves(n) => Cost::Solves(n * stages),
        };
        Claims { order: self.scheme.order, cost, source: self.scheme.source, ..base }
    }
}

impl<S: Real, M: Method<S>> Method<S> for Composed<M> {
    type Step = ComposedStep<M::Step>;
    fn prepare(&self, h: f64, body: &Body, x: &State<S>) -> Result<Self::Step, StepError> {
        let whole = Dd::of(usable(h)?);
        // the centre takes up what rounding the others has changed, or the clock would be off
        let lengths: Vec<f64> = self.scheme.half.iter().map(|&gamma| (whole * gamma).hi()).collect();
        let centre = lengths.iter().fold(whole, |left, &length| left - Dd::of(2.0 * length)).hi();
        let outer: Result<_, _> = lengths.iter().map(|&length| self.base.prepare(length, body, x)).collect();
        Ok(ComposedStep { outer: outer?, centre: self.base.prepare(centre, body, x)? })
    }
}

impl<S: Real, T: Step<S>> Step<S> for ComposedStep<T> {
    fn step(&mut self, x: &mut State<S>) {
        for step in &mut self.outer {
            step.step(x);
        }
        self.centre.step(x);
        for step in self.outer.iter_mut().rev() {
            step.step(x);
        }
    }

    fn worst_residual(&self) -> f64 {
        self.outer.iter().map(Step::worst_residual).fold(self.centre.worst_residual(), f64::max)
    }
}

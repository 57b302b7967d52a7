//! What an embedded pair of Runge–Kutta methods is to the steps that it takes.

use core::fmt::Debug;

use crate::body::Phase;
use crate::num::{Dd, Real};

/// Coefficients of rates, each with the number of its stage, counted from 0.
pub type Terms = [(usize, Dd)];

/// Node of a stage, and what it takes of the stages before.
pub type Stage = (Dd, &'static Terms);

/// Places for the rates of the stages of any pair.
pub(super) const RATES: usize = 16;

/// A Runge–Kutta method with an error estimate and a dense output.
pub trait Pair: Copy + Debug + PartialEq + Send + Sync + 'static {
    /// Name in the catalogue.
    const NAME: &'static str;
    /// Where it comes from.
    const SOURCE: &'static str;
    /// The tolerance where none is given.
    const USUAL_TOLERANCE: f64;
    /// Order of the result.
    const ORDER: u32;
    /// How steps follow from error estimates.
    const CONTROL: Control;
    /// The stages after the first.
    const STAGES: &'static [Stage];
    /// Weights of the result.
    const WEIGHTS: &'static Terms;
    /// Place of the rate at the end of the step, the first of the next.
    const END: usize;
    /// Whether that rate is part of the estimate.
    const END_IN_ESTIMATE: bool;
    /// Stages behind it that only the dense output needs.
    const DENSE_STAGES: &'static [Stage];

    /// The error estimate divided by the step, `weigh` being the mean square of a rate in units of what is allowed.
    fn estimate<S: Real>(rates: &[Phase<S>], weigh: impl Fn(&Phase<S>) -> f64) -> f64;

    /// Coefficients of the dense output of a step `h` with the result `change`.
    fn dense<S: Real>(rates: &[Phase<S>], change: Phase<S>, h: S) -> [Phase<S>; 7];

    /// The change after the share `theta` of the step.
    fn at<S: Real>(dense: &[Phase<S>; 7], theta: S) -> Phase<S>;
}

/// How the next step follows from the error estimate e of a step, in units of what is allowed, and from that of the step
/// before, e': by the factor `0.9 p(e) i(e')`, within bounds. A step with e > 1 is rejected, and `0.9 p(e)` counts.
#[derive(Clone, Copy, Debug)]
pub struct Control {
    /// p, of the estimate.
    pub proportional: fn(f64) -> f64,
    /// i, of the one before.
    pub integral: fn(f64) -> f64,
    /// The smallest factor.
    pub least: f64,
    /// The largest factor.
    pub most: f64,
    /// Whether the step after one that was first rejected may be longer.
    pub grows_after_rejection: bool,
}

/// The estimate that counts before the first step, and the least that is remembered.
pub(super) const LEAST_ESTIMATE: f64 = 1e-4;

impl Control {
    /// The factor after an accepted step.
    pub(super) fn after(&self, estimate: f64, before: f64, rejected: bool) -> f64 {
        let factor = 0.9 * (self.proportional)(estimate) * (self.integral)(before);
        let most = if rejected && !self.grows_after_rejection { 1.0 } else { self.most };
        factor.clamp(self.least, most)
    }

    /// The factor after a rejected step, whose estimate may be no number.
    pub(super) fn again(&self, estimate: f64) -> f64 {
        let factor = 0.9 * (self.proportional)(estimate);
        if factor > self.least { factor } else { self.least }
    }
}

/// `Σ coefficient · rate`.
#[inline(always)]
pub(in crate::method) fn sum<S: Real>(rates: &[Phase<S>], terms: &Terms) -> Phase<S> {
    let mut total = Phase::zero();
    for &(stage, coefficient) in terms {
        total = total + rates[stage] * S::from_dd(coefficient);
    }
    total
}

//! Higher order by composition: one symmetric map, taken with steps of several lengths.

use super::lengths::lengths;
use super::processor::Processor;
use super::schemes::{Part, Scheme};
use crate::body::{Field, Point, Problem, Rotor, Time};
use crate::method::{Claimed, Claims, Map, Method, SchemeError};
use crate::num::{Dd, Real};

/// A method with Φ_{−h} ∘ Φ_h = 1 of order 2, which compositions raise to higher orders.
pub trait Symmetric: Clone + Send + Sync {}

/// A method of higher order, composed of steps Φ_{γ₁h} ∘ … ∘ Φ_{γₛh} of the symmetric method `base`.
///
/// ```
/// use polhode::body::Problem;
/// use polhode::method::schemes::SUZUKI_4;
/// use polhode::method::{Claimed, Composed, ImplicitMidpoint};
/// let method = Composed::new(ImplicitMidpoint, SUZUKI_4)?;
/// assert_eq!(method.claims(Problem::Free).unwrap().order, Some(4));
/// # Ok::<(), polhode::method::SchemeError>(())
/// ```
///
/// The base has to be symmetric:
/// ```compile_fail
/// # use polhode::method::schemes::SUZUKI_4;
/// # use polhode::method::{Composed, ExplicitEuler};
/// let method = Composed::new(ExplicitEuler, SUZUKI_4);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[must_use]
pub struct Composed<M: Symmetric> {
    base: M,
    scheme: Scheme,
}

impl<M: Symmetric + Claimed> Composed<M> {
    /// `base` composed by `scheme`.
    ///
    /// # Errors
    /// A scheme that alternates two flows.
    pub fn new(base: M, scheme: Scheme) -> Result<Self, SchemeError> {
        match scheme.lengths() {
            Some(_) => Ok(Composed { base, scheme }),
            None => Err(SchemeError::OneMap { scheme: scheme.name, base: base.name() }),
        }
    }
}

impl<M: Symmetric + Claimed> Claimed for Composed<M> {
    fn name(&self) -> String {
        format!("{}@{}", self.base.name(), self.scheme.name)
    }

    fn claims(&self, problem: Problem) -> Option<Claims> {
        let base = self.base.claims(problem)?;
        let stages = self.scheme.lengths().map_or(0, |lengths| lengths.len() as u32);
        let order = base.order.map(|_| self.scheme.order);
        let symmetric = base.symmetric && !self.scheme.is_processed();
        Some(Claims { order, symmetric, cost: base.cost * stages, source: self.scheme.source, ..base })
    }
}

impl<S: Real, M: Method<S> + Symmetric> Method<S> for Composed<M> {
    type Map<F: Field<S>> = ComposedMap<M::Map<F>>;

    fn map<F: Field<S>>(&self, h: Dd, rotor: &Rotor, field: &F) -> Self::Map<F> {
        let mut begun = Dd::ZERO;
        let shares = self.scheme.lengths().unwrap_or_default();
        let base = self.base.maps(rotor, field);
        let stage = |length| {
            let stage = (begun, base(length));
            begun = begun + length;
            stage
        };
        let stages = lengths::<S>(h, &shares).into_iter().map(stage).collect();
        // steps of one map alone
        let processor: Vec<_> = self.scheme.processor_lengths().into_iter().map(|p| (Part::A, p)).collect();
        ComposedMap { h, processor: Processor::new::<S>(h, &processor, &base, &base), stages }
    }
}

/// A prepared [`Composed`]: its steps, each with the time at which it begins, s since the beginning of the whole.
#[derive(Clone, Debug)]
pub struct ComposedMap<T> {
    h: Dd,
    processor: Processor<T, T>,
    stages: Vec<(Dd, T)>,
}

impl<S: Real, T: Map<S>> Map<S> for ComposedMap<T> {
    fn apply(&mut self, at: Time, x: &mut Point<S>) {
        self.processor.apply(at, x);
        self.advance(at, x);
        self.processor.take_back(at.later(self.h), x);
    }

    fn open(&mut self, at: Time, x: &mut Point<S>) {
        self.processor.apply(at, x);
    }

    #[inline]
    fn advance(&mut self, at: Time, x: &mut Point<S>) {
        for (begun, map) in &mut self.stages {
            map.apply(at.later(*begun), x);
        }
    }

    fn close(&mut self, at: Time, x: &mut Point<S>) {
        self.processor.take_back(at, x);
    }

    fn worst_residual(&self) -> f64 {
        let stages = self.stages.iter().map(|stage| stage.1.worst_residual());
        stages.fold(self.processor.worst_residual(), f64::max)
    }
}

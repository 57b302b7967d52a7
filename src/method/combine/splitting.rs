//! Splittings: two maps in turn, by the coefficients of a scheme.

use thiserror::Error;

use super::kicks::KickMap;
use super::processor::{Processor, Timed};
use super::schemes::{Part, STRANG, Scheme, Stages};
use crate::body::{Field, Point, Problem, Rotor, Time};
use crate::method::{Claimed, Claims, Cost, Energy, Kept, Kicks, Map, Method, SideBySide, Symmetric};
use crate::num::{Dd, Real};

/// A splitting of H = A + B: maps of A and of B in turn, for the shares of the step that `scheme` gives.
///
/// Strang's is Φ_h = B(h/2) A(h) B(h/2) (SIAM J. Numer. Anal. 5 (1968) 506). All schemes but processed ones are palindromes, so that
/// the splitting is symmetric where its parts are. Where two steps of a composition meet, their maps of B are merged.
#[derive(Clone, Copy, Debug, PartialEq)]
#[must_use]
pub struct Splitting<A, B> {
    a: A,
    b: B,
    scheme: Scheme,
}

/// The part A of a splitting of kinetic and potential energy: a map of the free body, exact or not.
pub trait FreePart: Symmetric {
    /// Name of the method that alternates it with kicks by Strang's scheme.
    fn name(&self) -> String;
    /// Order of the free motion; `None` where it is exact.
    fn order(&self) -> Option<u32>;
    /// The energy of free motion.
    fn energy(&self) -> Energy;
    /// Whether the map is symplectic: the turn of the body included, of which the bracket of the momenta knows nothing.
    fn symplectic(&self) -> bool {
        true
    }
    /// Work of one map.
    fn cost(&self) -> Cost;
    /// Work of one step of free motion by `scheme` in a sequence of the same, where neighbouring flows merge: as
    /// [`Method::free_map`]. A scheme for two flows then has its order in free motion.
    fn free_cost(&self, _: &Scheme) -> Option<Cost> {
        None
    }
    /// Where it comes from.
    fn source(&self) -> &'static str;
}

/// A scheme does not fit its base.
#[derive(Clone, Debug, PartialEq, Error)]
#[non_exhaustive]
pub enum SchemeError {
    /// The scheme alternates two flows, and the free part of the base has a lower order than the scheme.
    #[error(
        "scheme {scheme:?} alternates kicks with free motion that is exact or at least of its own order, and that of {base} has \
         order {order}; take a composition, such as suzuki-4, or kick-drift@{scheme}"
    )]
    Inexact {
        /// Name of the scheme.
        scheme: &'static str,
        /// Name of the base.
        base: String,
        /// Order of its free part.
        order: u32,
    },
    /// The scheme alternates two flows, and the base is one map.
    #[error(
        "scheme {scheme:?} alternates two flows, and {base} is one map; take a composition, such as suzuki-4"
    )]
    OneMap {
        /// Name of the scheme.
        scheme: &'static str,
        /// Name of the base.
        base: String,
    },
    /// The two lists of a scheme do not alternate.
    #[error(
        "scheme {scheme:?} lists {outer} shares of the flow that is first and {inner} of the other; of the first there are as \
         many or one more"
    )]
    Lengths {
        /// Name of the scheme.
        scheme: &'static str,
        /// Shares listed of the flow that is first and last.
        outer: usize,
        /// Shares listed of the other.
        inner: usize,
    },
    /// A composition needs a base that is symmetric under every force.
    #[error(
        "{base} foretells ω at the end of a step, so that it is symmetric only where the torque does not depend on ω, and scheme \
         {scheme:?} raises the order of methods that are symmetric under every force; take implicit-midpoint, rattle, lie-poisson \
         or kick-drift"
    )]
    Foretells {
        /// Name of the scheme.
        scheme: &'static str,
        /// Name of the base.
        base: String,
    },
    /// A composition is of higher order only over a symmetric base.
    #[error(
        "{base} is not symmetric, and scheme {scheme:?} raises the order of symmetric methods only; take implicit-midpoint, \
         rattle, lie-poisson or kick-drift"
    )]
    NotSymmetric {
        /// Name of the scheme.
        scheme: &'static str,
        /// Name of the base.
        base: String,
    },
}

impl<A, B> Splitting<A, B> {
    /// Strang's splitting of `a` and `b`.
    pub const fn strang(a: A, b: B) -> Self {
        Splitting { a, b, scheme: STRANG }
    }

    /// `a` and `b` by `scheme`, which has its order if both maps are exact; a composition also if they are symmetric and of
    /// order 2.
    pub(in crate::method) const fn with_scheme(a: A, b: B, scheme: Scheme) -> Self {
        Splitting { a, b, scheme }
    }

    /// The coefficients.
    pub fn scheme(&self) -> &Scheme {
        &self.scheme
    }
}

impl<A: FreePart> Splitting<A, Kicks> {
    /// `free` and the kicks of the potential by `scheme`.
    ///
    /// # Errors
    /// A scheme for two exact flows with a free part that is not exact.
    ///
    /// ```
    /// use polhode::body::Problem;
    /// use polhode::method::schemes::{SRKN_6B, SUZUKI_4};
    /// use polhode::method::{Claimed, Dmv, ExactFlow, Splitting};
    /// let method = Splitting::kicked(ExactFlow, SUZUKI_4)?;
    /// assert_eq!(method.name(), "kick-drift@suzuki-4");
    /// let claims = method.claims(Problem::Linear).unwrap();
    /// assert_eq!((claims.order, claims.cost.to_string()), (Some(4), "5 free flows, 5 kicks".into()));
    /// assert!(Splitting::kicked(Dmv, SRKN_6B).is_err());
    /// # Ok::<(), polhode::method::SchemeError>(())
    /// ```
    pub fn kicked(free: A, scheme: Scheme) -> Result<Self, SchemeError> {
        if let Stages::Alternating { first, a, b, .. } | Stages::ForceGradient { first, a, b, .. } =
            scheme.stages
        {
            let (outer, inner) = if first == Part::A { (a.len(), b.len()) } else { (b.len(), a.len()) };
            if outer != inner && outer != inner + 1 {
                return Err(SchemeError::Lengths { scheme: scheme.name, outer, inner });
            }
        }
        match (free.order(), scheme.lengths()) {
            (Some(order), None) if order < scheme.order && free.free_cost(&scheme).is_none() => {
                Err(SchemeError::Inexact { scheme: scheme.name, base: free.name(), order })
            }
            _ => Ok(Splitting { a: free, b: Kicks, scheme }),
        }
    }

    /// Whether the scheme is for two flows and the free part no flow of its order.
    fn is_for_free_motion(&self) -> bool {
        self.scheme.lengths().is_none() && self.a.order().is_some_and(|order| order < self.scheme.order)
    }
}

impl<A: FreePart> Claimed for Splitting<A, Kicks> {
    fn name(&self) -> String {
        if self.scheme == STRANG { self.a.name() } else { format!("{}@{}", self.a.name(), self.scheme.name) }
    }

    fn claims(&self, problem: Problem) -> Option<Claims> {
        let flows = self.scheme.flows();
        // in motion under a force the last flow of a step and the first of the next are one
        let at_both_ends =
            |part| [flows.first(), flows.last()].iter().all(|end| end.is_some_and(|f| f.0 == part));
        let exact = |part| part == Part::B || self.a.order().is_none();
        let merged = |part| u32::from(problem != Problem::Free && at_both_ends(part) && exact(part));
        let count = |part| flows.iter().filter(|flow| flow.0 == part).count() as u32 - merged(part);
        let free = match self.a.free_cost(&self.scheme) {
            Some(cost) if problem == Problem::Free => cost,
            _ => self.a.cost() * count(Part::A),
        };
        let source = if self.scheme == STRANG { self.a.source() } else { self.scheme.source };
        let claims = |order, kept, cost| {
            // of exact flows without kicks nothing is left but the step itself
            let exact = problem == Problem::Free && self.a.order().is_none();
            Claims {
                symmetric: exact || !self.scheme.is_processed(),
                poisson: true,
                symplectic: self.a.symplectic(),
                ..Claims::new(order, kept, cost, source)
            }
        };
        match problem {
            Problem::Free => {
                // a composition keeps the order of its base where that is higher
                let order = self.a.order().map(|order| order.max(self.scheme.order));
                Some(claims(order, Kept::all_of_free_motion(self.a.energy()), free))
            }
            // the kicks would alternate with free motion of a lower order
            Problem::Linear | Problem::Potential if self.is_for_free_motion() => None,
            Problem::Potential if !self.scheme.gradients().is_empty() => None,
            Problem::Linear | Problem::Potential => {
                let kept = Kept { energy: Energy::Bounded, momentum_z: true, norm: true, ..Kept::NOTHING };
                Some(claims(Some(self.scheme.order), kept, free + Cost::kicks(count(Part::B))))
            }
            Problem::Torque => None,
        }
    }
}

impl<S: Real, A: Method<S> + FreePart> Method<S> for Splitting<A, Kicks> {
    type Map<F: Field<S>> = SplittingMap<A::Map<F>, KickMap<S, F>>;

    fn map<F: Field<S>>(&self, h: Dd, rotor: &Rotor, field: &F) -> Self::Map<F> {
        let (a, b) = (|length| self.a.map(length, rotor, field), |length| self.b.map(length, rotor, field));
        if !F::ACTS
            && let Some(map) = self.a.free_map(&self.scheme, h, rotor, field)
        {
            let nothing = Timed { begun: Dd::ZERO, map: b(Dd::ZERO) };
            return SplittingMap {
                h,
                processor: Processor::new::<S>(h, &[], a, b),
                opening: None,
                pairs: vec![(Timed { begun: Dd::ZERO, map }, nothing)],
                closing: None,
                ends: Ends::OfA,
            };
        }
        let flows = self.scheme.flows();
        let lengths = |part| {
            let shares: Vec<Dd> = flows.iter().filter(|flow| flow.0 == part).map(|flow| flow.1).collect();
            lengths::<S>(h, &shares).into_iter()
        };
        let (mut a_lengths, mut b_lengths) = (lengths(Part::A), lengths(Part::B));
        let gradients = self.scheme.gradients();
        let first_gradient = gradients.first().copied().unwrap_or(Dd::ZERO);
        let mut gradients = gradients.into_iter();
        let processor = Processor::new::<S>(h, &self.scheme.processor(), a, b);
        let (mut opening, mut pairs, mut free) = (None, Vec::new(), None);
        let (mut begun, mut first) = (processor.duration, None);
        for (part, _) in &flows {
            match part {
                // the time goes by in A; in B it stands
                Part::A => {
                    let length = a_lengths.next().unwrap_or(Dd::ZERO);
                    first = first.or(Some(length));
                    free = Some(Timed { begun, map: a(length) });
                    begun = begun + length;
                }
                Part::B => {
                    let length = b_lengths.next().unwrap_or(Dd::ZERO);
                    first = first.or(Some(length));
                    let gradient = gradients.next().unwrap_or(Dd::ZERO);
                    let kick = Timed { begun, map: b(length).with_gradient(gradient, h, rotor) };
                    match free.take() {
                        Some(free) => pairs.push((free, kick)),
                        None => opening = Some(kick),
                    }
                }
            }
        }
        let first = first.unwrap_or(Dd::ZERO);
        let ends = match &free {
            // without forces B does nothing
            _ if !F::ACTS => Ends::OfA,
            None if opening.is_none() => Ends::Apart,
            None => Ends::B {
                merged: Timed { begun, map: b(first * 2.0).with_gradient(first_gradient * 2.0, h, rotor) },
                back: b(-first).with_gradient(-first_gradient, h, rotor),
            },
            // two maps of A in turn are one of the whole length only if it is exact
            Some(_) if self.a.order().is_some() => Ends::Apart,
            Some(last) => {
                Ends::A { merged: Timed { begun: last.begun, map: a(first * 2.0) }, back: a(-first) }
            }
        };
        SplittingMap { h, processor, opening, pairs, closing: free, ends }
    }
}

/// A prepared [`Splitting`]: B where it comes first, pairs of A and B, A where it comes last.
#[derive(Clone, Debug)]
pub struct SplittingMap<A, B> {
    h: Dd,
    processor: Processor<A, B>,
    opening: Option<Timed<B>>,
    pairs: Vec<(Timed<A>, Timed<B>)>,
    closing: Option<Timed<A>>,
    ends: Ends<A, B>,
}

/// What becomes of the last flow of a step and the first of the next, which are equal.
#[derive(Clone, Debug)]
enum Ends<A, B> {
    /// Without forces: what A itself merges, if the step is one A.
    OfA,
    /// Nothing: the two flows are of different parts, or not exact.
    Apart,
    /// Two flows of A as one, and the one that takes half of it back.
    A { merged: Timed<A>, back: A },
    /// Two flows of B likewise.
    B { merged: Timed<B>, back: B },
}

impl<A, B> SplittingMap<A, B> {
    /// One step without processor.
    #[inline]
    fn kernel<S: Real>(&mut self, at: Time, x: &mut Point<S>)
    where
        A: Map<S>,
        B: Map<S>,
    {
        if let Some(b) = &mut self.opening {
            b.apply(at, x);
        }
        for (a, b) in &mut self.pairs {
            a.apply(at, x);
            b.apply(at, x);
        }
        if let Some(a) = &mut self.closing {
            a.apply(at, x);
        }
    }
}

impl<S: Real, A: Map<S>, B: Map<S>> Map<S> for SplittingMap<A, B> {
    #[inline]
    fn apply(&mut self, at: Time, x: &mut Point<S>) {
        self.processor.apply(at, x);
        self.kernel(at, x);
        self.processor.take_back(at.later(self.h), x);
    }

    fn open(&mut self, at: Time, x: &mut Point<S>) {
        self.processor.apply(at, x);
        match (&self.ends, &mut self.pairs[..], &mut self.opening) {
            (Ends::OfA, [(a, _)], _) => a.map.open(at, x),
            (Ends::A { .. }, [(a, _), ..], _) => a.map.apply(at, x),
            (Ends::B { .. }, _, Some(b)) => b.map.apply(at, x),
            _ => {}
        }
    }

    #[inline]
    fn advance(&mut self, at: Time, x: &mut Point<S>) {
        match (&mut self.ends, &mut self.pairs[..]) {
            (Ends::OfA, [(a, _)]) => a.map.advance(at, x),
            (Ends::A { merged, .. }, [(_, first), pairs @ ..]) => {
                first.apply(at, x);
                for (a, b) in pairs {
                    a.apply(at, x);
                    b.apply(at, x);
                }
                merged.apply(at, x);
            }
            (Ends::B { merged, .. }, [pairs @ .., (last, _)]) => {
                for (a, b) in pairs {
                    a.apply(at, x);
                    b.apply(at, x);
                }
                last.apply(at, x);
                merged.apply(at, x);
            }
            _ => self.kernel(at, x),
        }
    }

    #[inline]
    fn close(&mut self, at: Time, x: &mut Point<S>) {
        match (&mut self.ends, &mut self.pairs[..]) {
            (Ends::OfA, [(a, _)]) => a.map.close(at, x),
            (Ends::A { back, .. }, _) => back.apply(at, x),
            (Ends::B { back, .. }, _) => back.apply(at, x),
            _ => {}
        }
        self.processor.take_back(at, x);
    }

    fn synchronize(&self, elapsed: Dd, x: &mut Point<S>) {
        if let (Ends::OfA, [(a, _)]) = (&self.ends, &self.pairs[..]) {
            a.map.synchronize(elapsed, x);
        }
    }

    fn side_by_side(&self) -> Option<SideBySide<S>> {
        match (&self.ends, &self.pairs[..]) {
            (Ends::OfA, [(a, _)]) if self.processor.is_empty() => a.map.side_by_side(),
            _ => None,
        }
    }

    fn worst_residual(&self) -> f64 {
        let pairs = self.pairs.iter().map(|(a, b)| a.map.worst_residual().max(b.map.worst_residual()));
        let opening = self.opening.iter().map(|b| b.map.worst_residual());
        let closing = self.closing.iter().map(|a| a.map.worst_residual());
        let merged = match &self.ends {
            Ends::A { merged, .. } => merged.map.worst_residual(),
            _ => 0.0,
        };
        pairs.chain(opening).chain(closing).fold(merged.max(self.processor.worst_residual()), f64::max)
    }
}

/// The `shares` of `h`, rounded to the digits of `S`; what closes the palindrome, or the last without one, takes up what rounding the others has
/// changed, or the clock would be off.
pub(in crate::method) fn lengths<S: Real>(h: Dd, shares: &[Dd]) -> Vec<Dd> {
    let n = shares.len();
    if !shares.iter().eq(shares.iter().rev()) {
        let but_last = shares[..n - 1].iter().map(|&share| S::rounded(h * share)).collect::<Vec<_>>();
        let left = but_last.iter().fold(h, |left, &length| left - length);
        return but_last.into_iter().chain([S::rounded(left)]).collect();
    }
    let outer: Vec<Dd> = shares[..(n - 1) / 2].iter().map(|&share| S::rounded(h * share)).collect();
    let left = outer.iter().fold(h, |left, &length| left - length * 2.0);
    let centre = if n % 2 == 1 { vec![S::rounded(left)] } else { vec![S::rounded(left * 0.5); 2] };
    outer.iter().copied().chain(centre).chain(outer.iter().rev().copied()).collect()
}

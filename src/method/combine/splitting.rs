//! Splittings: two maps in turn, by the coefficients of a scheme.

use super::SchemeError;
use super::kicks::KickMap;
use super::lengths::lengths;
use super::processor::{Processor, Timed};
use super::schemes::{Part, STRANG, Scheme};
use super::splitting_map::{Ends, SplittingMap};
use super::wheels::{WheelMap, WheelSplit};
use crate::body::{Field, Free, Problem, Rotor, Wheels};
use crate::method::{Claimed, Claims, Cost, Energy, Kept, Kicks, Map, Method, Symmetric};
use crate::num::{Dd, Precise, Real};

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
///
/// What it says of itself is what the [claims](Claimed::claims) of the splitting are made of. One that is made of exact flows
/// needs no more than [`KineticSplit`](super::KineticSplit).
pub trait FreePart: Symmetric {
    /// Name of the method that alternates it with kicks by Strang's scheme.
    fn name(&self) -> String;
    /// Order of the free motion; `None` where it is exact.
    fn order(&self) -> Option<u32>;
    /// The energy of free motion.
    fn energy(&self) -> Energy;
    /// What free motion by the map keeps: the energy as [`energy`](Self::energy) says, |m|, L and |q|, unless said otherwise. Under
    /// a potential L_z is kept only if it is here, and the energy stays within bounds only if it does here.
    ///
    /// ```
    /// use polhode::method::{ExactFlow, FreePart};
    /// let kept = ExactFlow.kept();
    /// assert!(kept.momentum_norm && kept.momentum_space && kept.momentum_z && kept.norm);
    /// ```
    fn kept(&self) -> Kept {
        Kept::all_of_free_motion(self.energy())
    }
    /// Whether the map of momenta keeps the Lie–Poisson bracket.
    fn poisson(&self) -> bool {
        true
    }
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
    /// Work of one map of a body with [wheels](crate::body::Wheel), of order 2; `None`, the default, where it takes none.
    fn wheel_cost(&self) -> Option<Cost> {
        None
    }
    /// How it takes wheels.
    fn wheel_split(&self, _: &Rotor) -> WheelSplit {
        WheelSplit::Around
    }
    /// Where it comes from.
    fn source(&self) -> &'static str;
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
        let fewer = self.a.free_cost(&self.scheme).filter(|_| problem == Problem::Free);
        // which nobody counts where there are fewer
        let flows = if fewer.is_some() { Vec::new() } else { self.scheme.flows() };
        // in motion under a force the last flow of a step and the first of the next are one
        let at_both_ends =
            |part| [flows.first(), flows.last()].iter().all(|end| end.is_some_and(|f| f.0 == part));
        let exact = |part| part == Part::B || self.a.order().is_none();
        let merged = |part| u32::from(problem != Problem::Free && at_both_ends(part) && exact(part));
        let count = |part| flows.iter().filter(|flow| flow.0 == part).count() as u32 - merged(part);
        let free = fewer.unwrap_or_else(|| self.a.cost() * count(Part::A));
        let source = if self.scheme == STRANG { self.a.source() } else { self.scheme.source };
        let claims = |order, kept, cost| {
            // of exact flows without kicks nothing is left but the step itself
            let exact = problem == Problem::Free && self.a.order().is_none();
            Claims {
                symmetric: exact || !self.scheme.is_processed(),
                poisson: self.a.poisson(),
                symplectic: self.a.symplectic(),
                ..Claims::new(order, kept, cost, source)
            }
        };
        match problem {
            Problem::Free => {
                // a composition keeps the order of its base where that is higher
                let order = self.a.order().map(|order| order.max(self.scheme.order));
                Some(claims(order, self.a.kept(), free))
            }
            // the kicks would alternate with free motion of a lower order
            Problem::Linear | Problem::Potential if self.is_for_free_motion() => None,
            Problem::Gyrostat | Problem::GyrostatPotential => {
                let (one, lengths) = (self.a.wheel_cost()?, self.scheme.lengths()?);
                let kicks = if problem == Problem::Gyrostat { 0 } else { count(Part::B) };
                let kept = self.a.kept();
                let energy = if kept.energy == Energy::Drifts { Energy::Drifts } else { Energy::Bounded };
                let cost = one * lengths.len() as u32 + Cost::kicks(kicks);
                Some(claims(Some(self.scheme.order), Kept { energy, ..kept }, cost))
            }
            Problem::Potential if !self.scheme.gradients().is_empty() => None,
            Problem::Linear | Problem::Potential => {
                let Kept { energy, momentum_space, momentum_z, norm, .. } = self.a.kept();
                let energy = if energy == Energy::Drifts { energy } else { Energy::Bounded };
                let kept = Kept { energy, momentum_z: momentum_z || momentum_space, norm, ..Kept::NOTHING };
                Some(claims(Some(self.scheme.order), kept, free + Cost::kicks(count(Part::B))))
            }
            Problem::Torque => None,
        }
    }
}

impl<S: Real, A: Method<S> + FreePart> Method<S> for Splitting<A, Kicks> {
    type Map<F: Field<S>> = SplittingMap<A::Map<F>, KickMap<S, F>>;

    fn map<F: Field<S>>(&self, h: Dd, rotor: &Rotor, field: &F) -> Self::Map<F> {
        let (a, b) = (self.a.maps(rotor, field), self.b.maps(rotor, field));
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
        self.by_scheme(h, rotor, a, b, self.a.order().is_none())
    }

    fn wheel_map<F: Field<S>>(
        &self,
        h: Dd,
        rotor: &Rotor,
        field: &F,
        wheels: &Wheels,
    ) -> Option<Box<dyn Map<S>>>
    where
        S: Precise,
    {
        let _ = (self.a.wheel_cost()?, self.scheme.lengths()?);
        let split = self.a.wheel_split(rotor);
        let maps = self.a.maps(rotor, &Free);
        let free = |length| Box::new(maps(length)) as Box<dyn Map<S>>;
        let a = |length| WheelMap::new(length, rotor, wheels, split.clone(), || free(length));
        let b = self.b.maps(rotor, field);
        Some(Box::new(self.by_scheme::<S, F, _>(h, rotor, a, b, false)))
    }
}

impl<A> Splitting<A, Kicks> {
    /// One step of `h`: maps of A and B by the scheme; `exact` says whether two maps of A in turn are one of the whole length.
    fn by_scheme<S: Real, F: Field<S>, M: Map<S>>(
        &self,
        h: Dd,
        rotor: &Rotor,
        a: impl Fn(Dd) -> M,
        b: impl Fn(Dd) -> KickMap<S, F>,
        exact: bool,
    ) -> SplittingMap<M, KickMap<S, F>> {
        let flows = self.scheme.flows();
        let lengths = |part| {
            let shares: Vec<Dd> = flows.iter().filter(|flow| flow.0 == part).map(|flow| flow.1).collect();
            lengths::<S>(h, &shares).into_iter()
        };
        let (mut a_lengths, mut b_lengths) = (lengths(Part::A), lengths(Part::B));
        let mut gradients = self.scheme.gradients().into_iter();
        let processor = Processor::new::<S>(h, &self.scheme.processor(), &a, &b);
        let mut begun = processor.duration;
        let stage = |(part, _): &(Part, Dd)| {
            let at = begun;
            let (length, gradient) = match part {
                Part::A => (a_lengths.next().unwrap_or(Dd::ZERO), Dd::ZERO),
                Part::B => (b_lengths.next().unwrap_or(Dd::ZERO), gradients.next().unwrap_or(Dd::ZERO)),
            };
            // the time goes by in A; in B it stands
            if *part == Part::A {
                begun = begun + length;
            }
            Stage { begun: at, length, gradient }
        };
        let stages: Vec<Stage> = flows.iter().map(stage).collect();
        let free = |stage: &Stage| Timed { begun: stage.begun, map: a(stage.length) };
        let kick = |stage: &Stage| {
            let map = b(stage.length).with_gradient(stage.gradient, h, rotor);
            Timed { begun: stage.begun, map }
        };
        let opens = flows.first().is_some_and(|flow| flow.0 == Part::B);
        let behind = &stages[usize::from(opens)..];
        let (opening, closing) = (stages.first().filter(|_| opens), behind.as_chunks::<2>().1.first());
        let pairs = behind.as_chunks().0.iter().map(|[a, b]| (free(a), kick(b))).collect();
        let ends = match stages.split_first() {
            // without forces B does nothing
            _ if !F::ACTS => Ends::OfA,
            Some((first, others)) if opens && closing.is_none() => Ends::B {
                cycle: merged(first, others).map(|[a, b]| (free(&a), kick(&b))).collect(),
                back: kick(&first.back()),
            },
            Some((first, others)) if !opens && closing.is_some() && exact => Ends::A {
                cycle: merged(first, others).map(|[b, a]| (kick(&b), free(&a))).collect(),
                back: free(&first.back()),
            },
            _ => Ends::Apart,
        };
        SplittingMap { h, processor, opening: opening.map(kick), pairs, closing: closing.map(free), ends }
    }
}

/// A flow of a step: when it begins, s since the beginning of the step, how long it takes, and the share of the gradient.
#[derive(Clone, Copy)]
struct Stage {
    begun: Dd,
    length: Dd,
    gradient: Dd,
}

impl Stage {
    /// What takes it back, at the time that it is told.
    fn back(&self) -> Self {
        Stage { begun: Dd::ZERO, length: -self.length, gradient: -self.gradient }
    }
}

/// The flows behind the first, in pairs, the last of them as long as both ends.
fn merged(first: &Stage, others: &[Stage]) -> impl Iterator<Item = [Stage; 2]> {
    let pairs = others.as_chunks().0;
    pairs.iter().enumerate().map(move |(n, &[one, other])| {
        if n + 1 < pairs.len() {
            return [one, other];
        }
        [one, Stage { length: first.length * 2.0, gradient: first.gradient * 2.0, ..other }]
    })
}

//! What a processed scheme takes before the first step, and takes back at each look.

use super::schemes::Part;
use crate::body::{Point, Time};
use crate::method::{Map, SideBySide};
use crate::num::{Dd, Real};

/// A map and the time at which it begins, s since the beginning of the step.
#[derive(Clone, Debug)]
pub(in crate::method) struct Timed<M> {
    pub(in crate::method) begun: Dd,
    pub(in crate::method) map: M,
}

impl<M> Timed<M> {
    #[inline(never)]
    pub(in crate::method) fn apply<S: Real>(&mut self, at: Time, x: &mut Point<S>)
    where
        M: Map<S>,
    {
        self.apply_inlined(at, x);
    }

    /// The same, compiled into the caller as far as the map is.
    #[inline(always)]
    pub(in crate::method) fn apply_inlined<S: Real>(&mut self, at: Time, x: &mut Point<S>)
    where
        M: Map<S>,
    {
        self.map.apply(at.later(self.begun), x);
    }

    /// As [`Map::part_side_by_side`], with the time at which it begins.
    pub(in crate::method) fn part_side_by_side<S: Real>(&self) -> Option<(Dd, SideBySide<S>)>
    where
        M: Map<S>,
    {
        Some((self.begun, self.map.part_side_by_side()?))
    }
}

/// A processor of maps of A and B, and its inverse; empty for schemes without.
#[derive(Clone, Debug)]
pub(in crate::method) struct Processor<A, B> {
    stages: Vec<Stage<A, B>>,
    inverse: Vec<Stage<A, B>>,
    /// How far the clock has gone after it, s.
    pub(in crate::method) duration: Dd,
}

#[derive(Clone, Debug)]
enum Stage<A, B> {
    A(Timed<A>),
    B(Timed<B>),
}

impl<A, B> Processor<A, B> {
    /// Of `flows`, as shares of `h`: maps of a length are made by `a` and `b`.
    pub(in crate::method) fn new<S: Real>(
        h: Dd,
        flows: &[(Part, Dd)],
        a: impl Fn(Dd) -> A,
        b: impl Fn(Dd) -> B,
    ) -> Self {
        let stage = |part, begun, length| match part {
            Part::A => Stage::A(Timed { begun, map: a(length) }),
            Part::B => Stage::B(Timed { begun, map: b(length) }),
        };
        let (mut stages, mut inverse, mut duration) = (Vec::new(), Vec::new(), Dd::ZERO);
        for &(part, share) in flows {
            let length = S::rounded(h * share);
            stages.push(stage(part, duration, length));
            // the time goes by in A; in B it stands
            if part == Part::A {
                duration = duration + length;
            }
            inverse.push(stage(part, duration, -length));
        }
        inverse.reverse();
        Processor { stages, inverse, duration }
    }

    pub(in crate::method) fn is_empty(&self) -> bool {
        self.stages.is_empty()
    }

    pub(in crate::method) fn apply<S: Real>(&mut self, at: Time, x: &mut Point<S>)
    where
        A: Map<S>,
        B: Map<S>,
    {
        self.stages.iter_mut().for_each(|stage| stage.apply(at, x));
    }

    pub(in crate::method) fn take_back<S: Real>(&mut self, at: Time, x: &mut Point<S>)
    where
        A: Map<S>,
        B: Map<S>,
    {
        self.inverse.iter_mut().for_each(|stage| stage.apply(at, x));
    }

    pub(in crate::method) fn worst_residual<S: Real>(&self) -> f64
    where
        A: Map<S>,
        B: Map<S>,
    {
        let residual = |stage: &Stage<A, B>| match stage {
            Stage::A(a) => a.map.worst_residual(),
            Stage::B(b) => b.map.worst_residual(),
        };
        self.stages.iter().chain(&self.inverse).map(residual).fold(0.0, f64::max)
    }
}

impl<A, B> Stage<A, B> {
    fn apply<S: Real>(&mut self, at: Time, x: &mut Point<S>)
    where
        A: Map<S>,
        B: Map<S>,
    {
        match self {
            Stage::A(a) => a.apply(at, x),
            Stage::B(b) => b.apply(at, x),
        }
    }
}

//! One step of a splitting: its maps in turn, and what is merged where steps meet.

use super::processor::{Processor, Timed};
use crate::body::{Clock, Point, Time};
use crate::method::contract::fill_in_turn;
use crate::method::{Map, SideBySide};
use crate::num::{Dd, Real};

/// A prepared [`Splitting`](super::Splitting): B where it comes first, pairs of A and B, A where it comes last.
#[derive(Clone, Debug)]
pub struct SplittingMap<A, B> {
    pub(super) h: Dd,
    pub(super) processor: Processor<A, B>,
    pub(super) opening: Option<Timed<B>>,
    pub(super) pairs: Vec<(Timed<A>, Timed<B>)>,
    pub(super) closing: Option<Timed<A>>,
    pub(super) ends: Ends<A, B>,
}

/// What becomes of the last flow of a step and the first of the next, which are equal.
#[derive(Clone, Debug)]
pub(super) enum Ends<A, B> {
    /// Without forces: what A itself merges, if the step is one A.
    OfA,
    /// Nothing: the two flows are of different parts, or not exact.
    Apart,
    /// Two flows of A are one: the pairs of a step behind its first flow, and the flow that takes half of the last one back.
    A { cycle: Vec<(Timed<B>, Timed<A>)>, back: Timed<A> },
    /// Two flows of B likewise.
    B { cycle: Vec<(Timed<A>, Timed<B>)>, back: Timed<B> },
}

/// `n` steps of the maps of `cycle` in turn, which are counted. The point is one's own, so that what is inlined keeps it in registers;
/// where each operation is a dozen nothing is, as that would gain nothing.
#[inline]
fn sweep<S: Real, P: Map<S>, Q: Map<S>>(
    cycle: &mut [(Timed<P>, Timed<Q>)],
    n: u64,
    clock: &Clock,
    x: &mut Point<S>,
) {
    let mut moved = *x;
    for _ in 0..n {
        let at = clock.at(moved.steps());
        for (p, q) in &mut *cycle {
            if const { S::ROUNDOFF < f64::ROUNDOFF } {
                p.apply(at, &mut moved);
                q.apply(at, &mut moved);
            } else {
                p.apply_inlined(at, &mut moved);
                q.apply_inlined(at, &mut moved);
            }
        }
        moved.count_steps(1);
    }
    *x = moved;
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
            (Ends::A { .. }, [(a, _), ..], _) => a.apply(at, x),
            (Ends::B { .. }, _, Some(b)) => b.apply(at, x),
            _ => {}
        }
    }

    #[inline]
    fn advance(&mut self, at: Time, x: &mut Point<S>) {
        match (&mut self.ends, &mut self.pairs[..]) {
            (Ends::OfA, [(a, _)]) => a.map.advance(at, x),
            (Ends::A { cycle, .. }, _) => {
                for (b, a) in cycle {
                    b.apply(at, x);
                    a.apply(at, x);
                }
            }
            (Ends::B { cycle, .. }, _) => {
                for (a, b) in cycle {
                    a.apply(at, x);
                    b.apply(at, x);
                }
            }
            _ => self.kernel(at, x),
        }
    }

    #[inline]
    fn advance_by(&mut self, n: u64, clock: &Clock, x: &mut Point<S>) {
        match (&mut self.ends, &mut self.pairs[..]) {
            (Ends::OfA, [(a, _)]) => a.map.advance_by(n, clock, x),
            (Ends::A { cycle, .. }, _) => sweep(cycle, n, clock, x),
            (Ends::B { cycle, .. }, _) => sweep(cycle, n, clock, x),
            _ => {
                for _ in 0..n {
                    self.kernel(clock.at(x.steps()), x);
                    x.count_steps(1);
                }
            }
        }
    }

    #[inline]
    fn fill(&mut self, clock: &Clock, x: &mut Point<S>, block: &mut [Point<S>]) {
        match (&self.ends, &mut self.pairs[..]) {
            (Ends::OfA, [(a, _)]) if self.processor.is_empty() => a.map.fill(clock, x, block),
            _ => fill_in_turn(self, clock, x, block),
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
            (Ends::OfA, _) => None,
            (Ends::A { cycle, .. }, _) => SideBySide::chained(parts_of(cycle)?),
            (Ends::B { cycle, .. }, _) => SideBySide::chained(parts_of(cycle)?),
            (Ends::Apart, pairs) => {
                let pairs = pairs.iter().flat_map(|(a, b)| [a.part_side_by_side(), b.part_side_by_side()]);
                let opening = self.opening.iter().map(Timed::part_side_by_side);
                let parts = opening.chain(pairs).chain(self.closing.iter().map(Timed::part_side_by_side));
                SideBySide::chained(parts.collect::<Option<Vec<_>>>()?)
            }
        }
    }

    fn worst_residual(&self) -> f64 {
        let opening = self.opening.iter().map(|b| b.map.worst_residual());
        let closing = self.closing.iter().map(|a| a.map.worst_residual());
        let merged = match &self.ends {
            Ends::A { cycle, .. } => worst_of(cycle),
            Ends::B { cycle, .. } => worst_of(cycle),
            _ => 0.0,
        };
        let worst = merged.max(worst_of(&self.pairs)).max(self.processor.worst_residual());
        opening.chain(closing).fold(worst, f64::max)
    }
}

fn parts_of<S: Real, P: Map<S>, Q: Map<S>>(
    cycle: &[(Timed<P>, Timed<Q>)],
) -> Option<Vec<(Dd, SideBySide<S>)>> {
    cycle.iter().flat_map(|(p, q)| [p.part_side_by_side(), q.part_side_by_side()]).collect()
}

fn worst_of<S: Real, P: Map<S>, Q: Map<S>>(pairs: &[(Timed<P>, Timed<Q>)]) -> f64 {
    pairs.iter().map(|(p, q)| p.map.worst_residual().max(q.map.worst_residual())).fold(0.0, f64::max)
}

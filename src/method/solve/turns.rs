//! Turns about principal axes, one after another: what splittings of the kinetic energy are made of.

use core::f64::consts::FRAC_PI_4;
use core::slice::IterMut;

use crate::body::{Point, RENORMALIZE_EVERY};
use crate::flow::{turn_a_little_about, turn_about, turn_about_axis, turn_by};
use crate::method::SideBySide;
use crate::method::combine::lengths;
use crate::method::contract::lanes::{LaneFlow, Width};
use crate::method::schemes::{Part, Scheme};
use crate::num::trig::SMALL;
use crate::num::{Dd, Precise, Real};

/// Steps between renormalisations where all turns are small: each changes |q|² by some hundredths of a rounding error of 1 at most.
const RENORMALIZE_SMALL_EVERY: u64 = 64;

/// A step of turns that reads the same from both ends.
///
/// The last turn of a step and the first of the next are about the same axis and merge: [`open`](Self::open) takes the first
/// turn, [`advance`](Self::advance) the others and then both ends at once, [`close`](Self::close) takes the first turn back.
#[derive(Clone, Debug)]
pub(in crate::method) struct Turns<S> {
    axes: Axes,
    /// Half the angle of each turn over the momentum about its axis, from the second to the last.
    whole: Vec<S>,
    /// The same with both ends merged.
    cycle: Vec<S>,
    first: S,
    /// Half of the largest angle of an opened motion at most, rad.
    reach: f64,
    /// Whether that is at most [`SMALL`].
    small: bool,
}

/// Which axes the turns are about, in the order of `cycle`.
#[derive(Clone, Copy, Debug)]
enum Axes {
    /// Inner, outer and so on.
    Two([usize; 2]),
    /// Middle, inner, middle, outer and so on.
    Three([usize; 3]),
}

impl<S: Precise> Turns<S> {
    /// Two flows in turn as `scheme` says, the first of a step about `outer`. `rates` are the rates of turning over the
    /// momentum about outer and inner axis, for the time of a step.
    pub(in crate::method) fn two(axes: [usize; 2], rates: [Dd; 2], scheme: &Scheme) -> Self {
        let flows = scheme.flows();
        let first = flows.first().map_or(Part::B, |flow| flow.0);
        let [outer, inner] = [true, false].map(|outer| {
            let shares: Vec<Dd> =
                flows.iter().filter(|flow| (flow.0 == first) == outer).map(|flow| flow.1).collect();
            lengths::<S>(rates[usize::from(!outer)] * 0.5, &shares)
        });
        let turns = inner.iter().zip(&outer[1..]).flat_map(|(inner, outer)| [*inner, *outer]);
        Turns::new(Axes::Two(axes), outer[0], turns.collect())
    }

    /// Strang's splitting by three axes, composed of steps of the given shares; `axes` and `rates` are those of outer, middle
    /// and inner axis.
    pub(in crate::method) fn three(axes: [usize; 3], rates: [Dd; 3], shares: &[Dd]) -> Self {
        let [outer, middle, inner] = rates.map(|rate| lengths::<S>(rate * 0.5, shares));
        let mut turns = Vec::with_capacity(4 * shares.len());
        for n in 0..shares.len() {
            let halves = [middle[n] * 0.5, inner[n], middle[n] * 0.5];
            turns.extend(halves);
            turns.push((outer[n] + outer.get(n + 1).copied().unwrap_or(Dd::ZERO)) * 0.5);
        }
        Turns::new(Axes::Three(axes), outer[0] * 0.5, turns)
    }

    fn new(axes: Axes, first: Dd, turns: Vec<Dd>) -> Self {
        let whole: Vec<S> = turns.into_iter().map(S::from_dd).collect();
        let first = S::from_dd(first);
        let mut cycle = whole.clone();
        if let Some(last) = cycle.last_mut() {
            *last = *last + first;
        }
        Turns { axes, whole, cycle, first, reach: f64::INFINITY, small: false }
    }

    /// Takes all turns of a step.
    #[inline]
    pub(in crate::method) fn apply(&self, x: &mut Point<S>) {
        turn_about_axis(self.axes.outer(), x, self.first);
        self.axes.in_turn(&self.whole, x);
        x.renormalize_at_times();
    }

    /// Takes the first turn; from here on |m| is that of `x`.
    pub(in crate::method) fn open(&mut self, x: &mut Point<S>) {
        let largest = self.cycle.iter().map(|rate| rate.magnitude()).fold(0.0, f64::max);
        // |m| walks by rounding
        self.reach = 1.01 * largest * x.momentum_body.norm().magnitude();
        self.small = self.reach <= SMALL;
        turn_about_axis(self.axes.outer(), x, self.first);
    }

    pub(in crate::method) fn advance(&self, x: &mut Point<S>) {
        self.axes.turn(&self.cycle, self.small, 1, x);
        x.renormalize_every(self.renormalize_every());
    }

    /// `n` steps, which are counted.
    pub(in crate::method) fn advance_by(&self, n: u64, x: &mut Point<S>) {
        let (every, end) = (self.renormalize_every(), x.steps() + n);
        while x.steps() < end {
            let steps = (end - x.steps()).min(every - x.steps() % every);
            self.axes.turn(&self.cycle, self.small, steps, x);
            x.count_steps(steps - 1);
            x.renormalize_every(every);
            x.count_steps(1);
        }
    }

    /// As [`Map::fill`](crate::method::Map::fill); where the turns are small the point stays in registers from step to step.
    pub(in crate::method) fn fill(&self, x: &mut Point<S>, block: &mut [Point<S>]) {
        if const { S::ROUNDOFF >= f64::ROUNDOFF } && self.small {
            let n = block.len() as u64;
            let each = Filling { places: block.iter_mut(), back: -self.first };
            return self.axes.turn_apart::<true, S>(&self.cycle, n, x, each);
        }
        for place in block {
            self.advance_by(1, x);
            *place = *x;
            self.close(place);
        }
    }

    fn renormalize_every(&self) -> u64 {
        if self.small { RENORMALIZE_SMALL_EVERY } else { RENORMALIZE_EVERY }
    }

    #[inline]
    pub(in crate::method) fn close(&self, x: &mut Point<S>) {
        turn_about_axis(self.axes.outer(), x, -self.first);
    }

    /// The steps of an opened motion side by side with others; `None` where a turn goes so far that its angle is reduced.
    pub(in crate::method) fn side_by_side(&self) -> Option<SideBySide<S>> {
        let width = if self.small {
            Width::Small
        } else if self.reach <= FRAC_PI_4 {
            Width::Moderate
        } else {
            return None;
        };
        Some(SideBySide::flows(self.turns_and_rest(width, &self.cycle, self.renormalize_every())))
    }

    /// What [`apply`](Self::apply) takes, for bodies side by side.
    pub(in crate::method) fn flows(&self) -> impl Iterator<Item = (LaneFlow, S)> {
        let first = (LaneFlow::Turn(self.axes.outer(), Width::Any), self.first);
        [first].into_iter().chain(self.turns_and_rest(Width::Any, &self.whole, RENORMALIZE_EVERY))
    }

    /// The turns `turns`, and what follows them.
    fn turns_and_rest(&self, width: Width, turns: &[S], every: u64) -> impl Iterator<Item = (LaneFlow, S)> {
        let turns = self.axes.order().iter().cycle().zip(turns);
        let turns = turns.map(move |(axis, rate)| (LaneFlow::Turn(*axis, width), *rate));
        turns.chain([(LaneFlow::Renormalize(every), S::of(0.0))])
    }
}

impl Axes {
    fn outer(&self) -> usize {
        match self {
            Axes::Two([outer, _]) | Axes::Three([outer, ..]) => *outer,
        }
    }

    /// Of the turns of a step, the first of all excepted, over and over again.
    fn order(&self) -> &'static [usize] {
        match self {
            Axes::Two([0, 1]) => &[1, 0],
            Axes::Two([0, _]) => &[2, 0],
            Axes::Two([1, 0]) => &[0, 1],
            Axes::Two([1, _]) => &[2, 1],
            Axes::Two([_, 0]) => &[0, 2],
            Axes::Two(_) => &[1, 2],
            Axes::Three([0, 1, _]) => &[1, 2, 1, 0],
            Axes::Three([0, ..]) => &[2, 1, 2, 0],
            Axes::Three([1, 0, _]) => &[0, 2, 0, 1],
            Axes::Three([1, ..]) => &[2, 0, 2, 1],
            Axes::Three([_, 0, _]) => &[0, 1, 0, 2],
            Axes::Three(_) => &[1, 0, 1, 2],
        }
    }

    /// Takes all of `turns`.
    #[inline]
    fn in_turn<S: Real>(&self, turns: &[S], x: &mut Point<S>) {
        for (axis, turn) in self.order().iter().cycle().zip(turns) {
            turn_about_axis(*axis, x, *turn);
        }
    }

    /// Takes all of `turns`, `n` times, `small` or not.
    fn turn<S: Real>(&self, turns: &[S], small: bool, n: u64, x: &mut Point<S>) {
        // many times the code would gain nothing where each operation is a dozen
        if const { S::ROUNDOFF < f64::ROUNDOFF } {
            (0..n).for_each(|_| self.in_turn(turns, x));
        } else if small {
            self.turn_apart::<true, S>(turns, n, x, ());
        } else {
            self.turn_apart::<false, S>(turns, n, x, ());
        }
    }

    /// The same, for each order of the axes apart: they are constants inside, and the point is one's own, so that it stays in registers.
    #[inline]
    fn turn_apart<const SMALL: bool, S: Real>(
        &self,
        turns: &[S],
        n: u64,
        x: &mut Point<S>,
        each: impl Each<S>,
    ) {
        match self {
            Axes::Two([0, 1]) => two::<0, 1, SMALL, S>(turns, n, x, each),
            Axes::Two([0, _]) => two::<0, 2, SMALL, S>(turns, n, x, each),
            Axes::Two([1, 0]) => two::<1, 0, SMALL, S>(turns, n, x, each),
            Axes::Two([1, _]) => two::<1, 2, SMALL, S>(turns, n, x, each),
            Axes::Two([_, 0]) => two::<2, 0, SMALL, S>(turns, n, x, each),
            Axes::Two(_) => two::<2, 1, SMALL, S>(turns, n, x, each),
            Axes::Three([0, 1, _]) => three::<0, 1, 2, SMALL, S>(turns, n, x, each),
            Axes::Three([0, ..]) => three::<0, 2, 1, SMALL, S>(turns, n, x, each),
            Axes::Three([1, 0, _]) => three::<1, 0, 2, SMALL, S>(turns, n, x, each),
            Axes::Three([1, ..]) => three::<1, 2, 0, SMALL, S>(turns, n, x, each),
            Axes::Three([_, 0, _]) => three::<2, 0, 1, SMALL, S>(turns, n, x, each),
            Axes::Three(_) => three::<2, 1, 0, SMALL, S>(turns, n, x, each),
        }
    }
}

/// What follows the turns of a step.
trait Each<S> {
    fn step<const OUTER: usize>(&mut self, x: &mut Point<S>);
}

impl<S> Each<S> for () {
    #[inline(always)]
    fn step<const OUTER: usize>(&mut self, _: &mut Point<S>) {}
}

/// Ends a step of small turns, and leaves it in the next place without the first turn of the step after it.
struct Filling<'a, S> {
    places: IterMut<'a, Point<S>>,
    back: S,
}

impl<S: Real> Each<S> for Filling<'_, S> {
    #[inline(always)]
    fn step<const OUTER: usize>(&mut self, x: &mut Point<S>) {
        x.renormalize_every(RENORMALIZE_SMALL_EVERY);
        x.count_steps(1);
        if let Some(place) = self.places.next() {
            // one's own: a copy of what has just been written has to wait for it
            let mut closed = *x;
            let half = closed.momentum_body[OUTER] * self.back;
            turn_by::<OUTER, S>(&mut closed, half.sin_versine_moderate());
            *place = closed;
        }
    }
}

fn two<const OUTER: usize, const INNER: usize, const SMALL: bool, S: Real>(
    turns: &[S],
    n: u64,
    x: &mut Point<S>,
    mut each: impl Each<S>,
) {
    let mut moved = *x;
    for _ in 0..n {
        for &[inner, outer] in turns.as_chunks().0 {
            turn::<INNER, SMALL, S>(&mut moved, inner);
            turn::<OUTER, SMALL, S>(&mut moved, outer);
        }
        each.step::<OUTER>(&mut moved);
    }
    *x = moved;
}

fn three<const OUTER: usize, const MIDDLE: usize, const INNER: usize, const SMALL: bool, S: Real>(
    turns: &[S],
    n: u64,
    x: &mut Point<S>,
    mut each: impl Each<S>,
) {
    let mut moved = *x;
    for _ in 0..n {
        for &[before, inner, behind, outer] in turns.as_chunks().0 {
            turn::<MIDDLE, SMALL, S>(&mut moved, before);
            turn::<INNER, SMALL, S>(&mut moved, inner);
            turn::<MIDDLE, SMALL, S>(&mut moved, behind);
            turn::<OUTER, SMALL, S>(&mut moved, outer);
        }
        each.step::<OUTER>(&mut moved);
    }
    *x = moved;
}

#[inline(always)]
fn turn<const AXIS: usize, const SMALL: bool, S: Real>(x: &mut Point<S>, half_rate: S) {
    if SMALL { turn_a_little_about::<AXIS, S>(x, half_rate) } else { turn_about::<AXIS, S>(x, half_rate) }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::method::schemes::STRANG;
    use crate::rotation::{Quat, Vec3};

    /// The places of a block have the bits of steps that are taken one at a time and closed, of turns that are small and of others.
    #[test]
    fn a_block_holds_the_steps_taken_one_at_a_time() {
        let orders = [[0, 1, 2], [0, 2, 1], [1, 0, 2], [1, 2, 0], [2, 0, 1], [2, 1, 0]];
        for (h, small) in [(0.01, true), (-0.02, true), (0.5, false)] {
            let rates = [-0.7, 0.4, 1.1].map(|rate| Dd::of(rate * h));
            for order in orders {
                let [a, b, _] = order;
                let two = Turns::<f64>::two([a, b], [rates[0], rates[1]], &STRANG);
                for mut turns in [two, Turns::three(order, rates, &[Dd::ONE])] {
                    let mut x = Point::new(Quat::identity(), Vec3([0.4, 2.0, -0.9]));
                    turns.open(&mut x);
                    assert_eq!(turns.small, small);
                    let (mut alone, mut block) = (x, [x; 100]);
                    turns.fill(&mut x, &mut block);
                    for place in block {
                        turns.advance_by(1, &mut alone);
                        let mut closed = alone;
                        turns.close(&mut closed);
                        assert_eq!(place, closed);
                    }
                    assert_eq!(x, alone);
                }
            }
        }
    }
}

//! Turns about principal axes, one after another: what splittings of the kinetic energy are made of.

use core::f64::consts::FRAC_PI_4;

use crate::body::{Point, RENORMALIZE_EVERY};
use crate::flow::{turn_a_little_about, turn_about, turn_about_axis};
use crate::method::SideBySide;
use crate::method::combine::lengths;
use crate::method::contract::lanes::{Kernel, Width};
use crate::method::schemes::{Part, Scheme};
use crate::num::trig::SMALL;
use crate::num::{Dd, Precise, Real};

/// Steps between renormalisations where all turns are small: each changes |q|² by some hundredths of a rounding error of 1 at most.
pub(in crate::method) const RENORMALIZE_SMALL_EVERY: u64 = 64;

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
        let axes = self.axes.order().iter().copied().cycle().take(self.cycle.len()).collect();
        Some(SideBySide { kernel: Kernel::Turns(axes, width), constants: self.cycle.clone() })
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
            self.turn_apart::<true, S>(turns, n, x);
        } else {
            self.turn_apart::<false, S>(turns, n, x);
        }
    }

    /// The same, for each order of the axes apart: they are constants inside, and the point is one's own, so that it stays in registers.
    #[inline]
    fn turn_apart<const SMALL: bool, S: Real>(&self, turns: &[S], n: u64, x: &mut Point<S>) {
        match self {
            Axes::Two([0, 1]) => two::<0, 1, SMALL, S>(turns, n, x),
            Axes::Two([0, _]) => two::<0, 2, SMALL, S>(turns, n, x),
            Axes::Two([1, 0]) => two::<1, 0, SMALL, S>(turns, n, x),
            Axes::Two([1, _]) => two::<1, 2, SMALL, S>(turns, n, x),
            Axes::Two([_, 0]) => two::<2, 0, SMALL, S>(turns, n, x),
            Axes::Two(_) => two::<2, 1, SMALL, S>(turns, n, x),
            Axes::Three([0, 1, _]) => three::<0, 1, 2, SMALL, S>(turns, n, x),
            Axes::Three([0, ..]) => three::<0, 2, 1, SMALL, S>(turns, n, x),
            Axes::Three([1, 0, _]) => three::<1, 0, 2, SMALL, S>(turns, n, x),
            Axes::Three([1, ..]) => three::<1, 2, 0, SMALL, S>(turns, n, x),
            Axes::Three([_, 0, _]) => three::<2, 0, 1, SMALL, S>(turns, n, x),
            Axes::Three(_) => three::<2, 1, 0, SMALL, S>(turns, n, x),
        }
    }
}

fn two<const OUTER: usize, const INNER: usize, const SMALL: bool, S: Real>(
    turns: &[S],
    n: u64,
    x: &mut Point<S>,
) {
    let mut moved = *x;
    for _ in 0..n {
        for &[inner, outer] in turns.as_chunks().0 {
            turn::<INNER, SMALL, S>(&mut moved, inner);
            turn::<OUTER, SMALL, S>(&mut moved, outer);
        }
    }
    *x = moved;
}

fn three<const OUTER: usize, const MIDDLE: usize, const INNER: usize, const SMALL: bool, S: Real>(
    turns: &[S],
    n: u64,
    x: &mut Point<S>,
) {
    let mut moved = *x;
    for _ in 0..n {
        for &[before, inner, behind, outer] in turns.as_chunks().0 {
            turn::<MIDDLE, SMALL, S>(&mut moved, before);
            turn::<INNER, SMALL, S>(&mut moved, inner);
            turn::<MIDDLE, SMALL, S>(&mut moved, behind);
            turn::<OUTER, SMALL, S>(&mut moved, outer);
        }
    }
    *x = moved;
}

#[inline(always)]
fn turn<const AXIS: usize, const SMALL: bool, S: Real>(x: &mut Point<S>, half_rate: S) {
    if SMALL { turn_a_little_about::<AXIS, S>(x, half_rate) } else { turn_about::<AXIS, S>(x, half_rate) }
}

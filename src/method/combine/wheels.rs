//! Wheels in splittings: the kinetic energy ½ (m − h)·I⁻¹(m − h) with the momentum h of the wheels, m that of body and wheels.
//!
//! # Notation
//! | letter | meaning |
//! |---|---|
//! | m, h | angular momentum of body and wheels, and of the wheels, solver frame |
//! | a | I⁻¹h, rad/s |
//!
//! ½ (m_k − h_k)²/I_k turns the body about axis k at the constant rate (m_k − h_k)/I_k: a splitting by axes takes wheels as it is. What is
//! linear in m, −a·m, turns the body at the constant rate −a: with it before and behind, any map of the free body takes wheels. Both are
//! flows of functions of m, so that |m|, L and the bracket are kept as they are without wheels. The momentum h is that of the middle of
//! the map, where motors change it.

use crate::body::{Point, Rotor, Time, Wheels};
use crate::flow::{Casimir, Flow};
use crate::method::Map;
use crate::num::{Dd, Precise, Real};
use crate::rotation::{Quat, Vec3};

/// How a free part takes wheels: the maps of a step, of which the first ones are taken for half of it before and behind the last.
#[derive(Clone, Debug)]
pub enum WheelSplit {
    /// Turns about axes, the outermost first: each with the reciprocal moment κ of its energy ½ κ m_k².
    Turns {
        /// Axis and κ.
        axes: [(usize, Dd); 3],
        /// The reciprocal moment of a [turn about L](Casimir), if one is left.
        ball: Option<Dd>,
    },
    /// The constant turn of the wheels about the map of the free body.
    Around,
}

/// A map with wheels of a part of a step.
pub(super) struct WheelMap<S> {
    length: Dd,
    inverse_moments: Vec3<Dd>,
    wheels: Wheels,
    split: WheelSplit,
    /// Of the free body, between its turns by the wheels.
    middle: Option<Box<dyn Map<S>>>,
    turns: Turns<S>,
    /// L when the motion was opened.
    momentum_space: Vec3<Dd>,
}

/// The turns for one momentum of the wheels.
struct Turns<S> {
    halves: Vec<Turn<S>>,
    middle: Option<Turn<S>>,
    /// The first of a step with the last of the one before, and what takes the last back.
    merged: Turn<S>,
    back: Turn<S>,
}

#[derive(Clone)]
enum Turn<S> {
    /// About an axis by twice `rate` m_k − `shift`.
    Axis {
        axis: usize,
        rate: S,
        shift: S,
    },
    Constant(Box<ConstantTurn<S>>),
}

impl<S: Precise> WheelMap<S> {
    /// Of the length `length`; `middle` makes the map of the free body.
    pub(super) fn new(
        length: Dd,
        rotor: &Rotor,
        wheels: &Wheels,
        split: WheelSplit,
        middle: impl FnOnce() -> Box<dyn Map<S>>,
    ) -> Self {
        let inverse_moments = rotor.inverse_moments();
        let middle = matches!(split, WheelSplit::Around).then(middle);
        let h = wheels.at(Time::from_seconds(0.0));
        let turns = Turns::new(&split, length, inverse_moments, h);
        let (wheels, momentum_space) = (wheels.clone(), Vec3::zero());
        WheelMap { length, inverse_moments, wheels, split, middle, turns, momentum_space }
    }

    /// The turns for the momentum that the wheels have in the middle of the map that begins at `at`.
    fn prepare(&mut self, at: Time) {
        if !self.wheels.is_constant() {
            let h = self.wheels.at(at.later(self.length * 0.5));
            self.turns = Turns::new(&self.split, self.length, self.inverse_moments, h);
        }
    }

    /// From behind the first half of the outermost turn to before the last.
    fn inner(&mut self, at: Time, x: &mut Point<S>) {
        let inner = &self.turns.halves[1..];
        inner.iter().for_each(|turn| turn.apply(x));
        if let Some(map) = &mut self.middle {
            let mut moved = x.without_carried();
            map.apply(at, &mut moved);
            x.follow(&moved);
        }
        self.turns.middle.iter().chain(inner.iter().rev()).for_each(|turn| turn.apply(x));
    }

    fn ball(&self) -> Option<Dd> {
        match self.split {
            WheelSplit::Turns { ball, .. } => ball,
            WheelSplit::Around => None,
        }
    }
}

impl<S: Precise> Map<S> for WheelMap<S> {
    fn apply(&mut self, at: Time, x: &mut Point<S>) {
        self.prepare(at);
        if let Some(inverse) = self.ball() {
            Casimir::new(S::from_dd(inverse)).flow(at, S::from_dd(self.length), x);
        }
        self.turns.halves[0].apply(x);
        self.inner(at, x);
        self.turns.halves[0].apply(x);
        x.renormalize_at_times();
    }

    fn open(&mut self, _: Time, x: &mut Point<S>) {
        self.momentum_space = x.attitude.map(S::to_dd).rotate(x.momentum_body.map(S::to_dd));
        if self.wheels.is_constant() {
            self.turns.halves[0].apply(x);
        }
    }

    fn advance(&mut self, at: Time, x: &mut Point<S>) {
        if self.wheels.is_constant() {
            self.inner(at, x);
            self.turns.merged.apply(x);
        } else {
            self.prepare(at);
            self.turns.halves[0].apply(x);
            self.inner(at, x);
            self.turns.halves[0].apply(x);
        }
        x.renormalize_at_times();
    }

    fn close(&mut self, _: Time, x: &mut Point<S>) {
        if self.wheels.is_constant() {
            self.turns.back.apply(x);
        }
    }

    /// The turn about L, which commutes with all others.
    fn synchronize(&self, elapsed: Dd, x: &mut Point<S>) {
        let l = self.momentum_space;
        let (size, Some(inverse)) = (l.norm(), self.ball()) else { return };
        if size.magnitude() == 0.0 {
            return;
        }
        let (s, c) = (size * elapsed * inverse * 0.5).sin_cos();
        let turned = Quat::new(c, l * (s / size)) * x.attitude.map(S::to_dd);
        let mut phase = x.phase();
        phase.attitude = turned.map(S::from_dd);
        x.set_phase(phase);
    }

    fn worst_residual(&self) -> f64 {
        self.middle.as_ref().map_or(0.0, |map| map.worst_residual())
    }
}

impl<S: Precise> Turns<S> {
    fn new(split: &WheelSplit, length: Dd, inverse_moments: Vec3<Dd>, h: Vec3<Dd>) -> Self {
        let rates = h.times(inverse_moments);
        let constant = |rate: Vec3<Dd>, t: Dd| Turn::Constant(Box::new(ConstantTurn::new(rate * -t)));
        let turn = |(axis, kappa): (usize, Dd), t: Dd| {
            if kappa == Dd::ZERO {
                return constant(Vec3::unit(axis) * rates[axis], t);
            }
            let half = t * 0.5;
            Turn::Axis { axis, rate: S::from_dd(kappa * half), shift: S::from_dd(rates[axis] * half) }
        };
        let of = |t: Dd| match split {
            WheelSplit::Around => vec![constant(rates, t)],
            WheelSplit::Turns { axes: [first, second, third], .. } => {
                // without a part of h along it there is nothing to turn; two are left in any case
                let turns = first.1 != Dd::ZERO || h[first.0] != Dd::ZERO;
                turns.then_some(first).into_iter().chain([second, third]).map(|&one| turn(one, t)).collect()
            }
        };
        let (mut halves, mut whole) = (of(length * 0.5), of(length));
        let middle = if matches!(split, WheelSplit::Around) {
            None
        } else {
            halves.pop();
            whole.pop()
        };
        let merged = whole.swap_remove(0);
        let back = of(-(length * 0.5)).swap_remove(0);
        Turns { halves, middle, merged, back }
    }
}

impl<S: Precise> Turn<S> {
    #[inline]
    fn apply(&self, x: &mut Point<S>) {
        match self {
            Turn::Axis { axis, rate, shift } => {
                let half_angle = (x.momentum_body[*axis] * *rate - *shift).sin_cos();
                turn_about(*axis, half_angle, x);
            }
            Turn::Constant(turn) => turn.apply(x),
        }
    }
}

/// The turn about `axis` by sine and cosine of half the angle. Of an angle that hardly changes from step to step Kahan's sum lets |m| and L
/// drift, by some 1e-20 a step: these sums are in two parts.
fn turn_about<S: Precise>(axis: usize, (s, c): (S, S), x: &mut Point<S>) {
    let (j, k) = ((axis + 1) % 3, (axis + 2) % 3);
    let (q, m) = (x.attitude, x.momentum_body);
    let twice = s + s;
    let (v, w) = (twice * s, twice * c);
    let mut momentum = Vec3::zero();
    momentum[j] = w * m[k] - v * m[j];
    momentum[k] = -(w * m[j] + v * m[k]);
    let mut turn = Quat::new(-(s * s) / (S::of(1.0) + c), Vec3::zero());
    turn.v[axis] = s;
    x.add_in_parts([q * turn, Quat::zero()], [momentum, Vec3::zero()]);
}

/// The turn of a body by a constant rotation vector, and of m back by it.
///
/// The constants have the digits of two doubles: the same rounding in each step would make |m| and L drift.
#[derive(Clone, Debug)]
struct ConstantTurn<S> {
    /// The quaternion less 1.
    attitude: [Quat<S>; 2],
    /// The rows of the matrix that turns m, less 1.
    momentum: [[Vec3<S>; 3]; 2],
}

impl<S: Precise> ConstantTurn<S> {
    fn new(vector: Vec3<Dd>) -> Self {
        let angle = vector.norm();
        let (s, c) = (angle * 0.25).sin_cos();
        // 1 − cos of the half angle without cancellation
        let sine = if angle == Dd::ZERO { Dd::ZERO } else { s * c * 2.0 / angle };
        let less_one = Quat::new(-(s * s * 2.0), vector * sine);
        let turn = Quat::new(less_one.w + 1.0, less_one.v);
        let rows = [0, 1, 2].map(|k| {
            // row k of R⁻¹ − 1 is R e_k − e_k = 2 v × (v × e_k) + 2 w v × e_k
            let across = turn.v.cross(Vec3::unit(k));
            (turn.v.cross(across) + across * turn.w) * Dd::of(2.0)
        });
        let low = |x: Dd| S::from_dd(x - S::from_dd(x).to_dd());
        ConstantTurn {
            attitude: [less_one.map(S::from_dd), less_one.map(low)],
            momentum: [rows.map(|row| row.map(S::from_dd)), rows.map(|row| row.map(low))],
        }
    }

    fn apply(&self, x: &mut Point<S>) {
        let (q, m) = (x.attitude, x.momentum_body);
        let momentum = self.momentum.map(|rows| Vec3(rows.map(|row| row.dot(m))));
        x.add_in_parts(self.attitude.map(|part| q * part), momentum);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// With Kahan's sum in place of that in two parts, and with constants of one double, L is off by up to 8e-13.
    #[test]
    fn a_constant_turn_lets_the_momentum_walk_and_not_drift() {
        for k in 0..6 {
            let f = f64::from(k);
            let vector = Vec3([0.003 + 0.002 * f, 0.01 - 0.004 * f, 0.007 * (f * 1.3).fract()]).map(Dd::of);
            let turn = ConstantTurn::<f64>::new(vector);
            let mut x = Point::new(Quat::new(0.5, Vec3([0.5, -0.5, 0.5])), Vec3([0.3, 0.9, -0.7]));
            let start = x.to_dd();
            for _ in 0..1_000_000 {
                turn.apply(&mut x);
                x.count_steps(1);
                x.renormalize_at_times();
            }
            let end = x.to_dd();
            let longer = end.momentum_body.norm() - start.momentum_body.norm();
            let turned = (end.momentum_space() - start.momentum_space()).norm();
            assert!(longer.magnitude() < 2e-15, "{vector:?}: |m| {longer:e}");
            assert!(turned.magnitude() < 1e-14, "{vector:?}: L {turned:e}");
            // and it has turned: back by a million times the vector
            let back = ConstantTurn::<Dd>::new(vector * Dd::of(-1e6));
            let mut there = end;
            back.apply(&mut there);
            assert!((there.momentum_body - start.momentum_body).magnitude() < 1e-12);
            assert!((there.momentum_space() - start.momentum_space()).magnitude() < 1e-14);
        }
    }
}

//! Steps of a map that moves the momentum of body and wheels together, for points with that of the carrier alone.

use super::map::{Map, Step, Stepper};
use crate::body::{Clock, Point, Time, Wheels};
use crate::num::{Dd, Precise};

/// The momentum of the wheels is added when the motion is opened, and taken away at each reading.
pub(super) struct WithWheels<S> {
    together: Stepper<Box<dyn Map<S>>>,
    wheels: Wheels,
    clock: Clock,
    /// Of one map, s.
    length: Dd,
}

impl<S: Precise> WithWheels<S> {
    pub(super) fn new(map: Box<dyn Map<S>>, wheels: Wheels, clock: Clock, length: Dd) -> Self {
        WithWheels { together: Stepper::new(map, clock), wheels, clock, length }
    }

    fn add(&self, at: Time, x: &mut Point<S>) {
        x.add_momentum(self.wheels.at(at).map(S::from_dd));
    }

    fn take_away(&self, at: Time, x: &mut Point<S>) {
        x.add_momentum(-self.wheels.at(at).map(S::from_dd));
    }
}

impl<S: Precise> Step<S> for WithWheels<S> {
    fn open(&mut self, x: &mut Point<S>) {
        self.open_at(self.clock.at(x.steps()), x);
    }

    fn open_at(&mut self, at: Time, x: &mut Point<S>) {
        self.add(at, x);
        self.together.open_at(at, x);
    }

    fn advance(&mut self, x: &mut Point<S>, n: u64) {
        self.together.advance(x, n);
    }

    fn reading(&mut self, x: &Point<S>) -> Point<S> {
        let mut x = self.together.reading(x);
        self.take_away(self.clock.at(x.steps()), &mut x);
        x
    }

    fn fill(&mut self, x: &mut Point<S>, block: &mut [Point<S>]) {
        self.together.fill(x, block);
        for place in block {
            self.take_away(self.clock.at(place.steps()), place);
        }
    }

    fn memory(&self) -> Vec<f64> {
        self.together.memory()
    }

    fn remember(&mut self, memory: &[f64]) {
        self.together.remember(memory);
    }

    fn apply(&mut self, at: Time, x: &mut Point<S>) {
        self.add(at, x);
        self.together.apply(at, x);
        self.take_away(at.later(self.length), x);
    }

    fn base(&self) -> Option<Dd> {
        self.together.base()
    }

    fn dense(&mut self, until: Time, x: &mut Point<S>) -> Point<S> {
        self.together.dense(until, x)
    }

    fn side_by_side(&self) -> Option<super::SideBySide<S>> {
        None
    }

    fn worst_residual(&self) -> f64 {
        self.together.worst_residual()
    }

    fn work(&self) -> Option<super::Work> {
        self.together.work()
    }

    fn stuck(&self) -> Option<super::Stuck> {
        self.together.stuck()
    }
}

//! Steps of an embedded pair's own, and the states between them by its dense output.

use core::marker::PhantomData;

use super::equations::Equations;
use super::pair::{LEAST_ESTIMATE, Pair, RATES, Stage, sum};
use crate::body::{Field, Phase, Point, Rotor, Time};
use crate::method::contract::OwnSteps;
use crate::method::solve::length::length;
use crate::method::{Map, Stuck, Work};
use crate::num::{Dd, Real};
use crate::rotation::{Quat, Vec3};

/// The first step of a body at rest, s, as in Hairer's code: it grows at once where nothing happens.
const FROM_REST: f64 = 1e-6;

/// A prepared [`Embedded`](super::Embedded). Between outputs the point is that from which the current step goes.
#[derive(Clone, Debug)]
pub struct EmbeddedMap<S, F, P> {
    h: Dd,
    tolerance: f64,
    equations: Equations<S, F>,
    /// The time of the point, s since the start.
    base: Dd,
    next: Next,
    /// The rates of the stages of the current step; the first is known where `begun`.
    rates: [Phase<S>; RATES],
    begun: bool,
    current: Option<Current<S>>,
    stuck: Option<Stuck>,
    work: Work,
    pair: PhantomData<P>,
}

/// What the step from the point starts with.
#[derive(Clone, Copy, Debug)]
struct Next {
    /// The length to try, s; 0 where none is known.
    step: f64,
    /// The last error estimate.
    estimate: f64,
}

/// An accepted step.
#[derive(Clone, Copy, Debug)]
struct Current<S> {
    /// Its length, s, negative backwards.
    h: f64,
    change: Phase<S>,
    /// What the one behind it starts with.
    next: Next,
    /// Coefficients of the dense output, once an output needs them.
    dense: Option<[Phase<S>; 7]>,
}

/// The reciprocals of the errors that are allowed.
#[derive(Clone, Copy, Debug)]
struct Allowed {
    momentum: f64,
    attitude: f64,
}

impl<S: Real, F: Field<S>, P: Pair> EmbeddedMap<S, F, P> {
    pub(super) fn new(h: Dd, tolerance: f64, rotor: &Rotor, field: &F) -> Self {
        EmbeddedMap {
            h,
            tolerance,
            equations: Equations::new(rotor, field),
            base: Dd::ZERO,
            next: Next::FIRST,
            rates: [Phase::zero(); RATES],
            begun: false,
            current: None,
            stuck: None,
            work: Work::default(),
            pair: PhantomData,
        }
    }

    /// The point is of the time `base` now.
    fn restart(&mut self, base: Dd, next: Next) {
        (self.base, self.next) = (base, next);
        (self.begun, self.current, self.stuck) = (false, None, None);
    }

    fn rate(&mut self, at: Time, later: Dd, x: &Phase<S>) -> Phase<S> {
        self.work.evaluations += 1;
        self.equations.rate(at.at_elapsed(self.base + later), x)
    }

    /// The rates of `stages` of a step of `h`, from the place `from` on.
    fn evaluate(&mut self, at: Time, h: f64, x: &Phase<S>, stages: &[Stage], from: usize) {
        for (n, (node, terms)) in stages.iter().enumerate() {
            let stage = *x + sum(&self.rates, terms) * S::of(h);
            self.rates[from + n] = self.rate(at, *node * h, &stage);
        }
    }

    /// The first step to try, s: II.4 of Hairer, Norsett and Wanner.
    fn first(&mut self, at: Time, x: &Phase<S>) -> f64 {
        let allowed = Allowed::of(self.tolerance, x, x);
        let rate = self.rates[0];
        let time = (allowed.mean_square(x) / allowed.mean_square(&rate)).sqrt();
        if !(time.is_normal() && time < f64::MAX / 100.0) {
            return FROM_REST;
        }
        let unit = libm::scalbn(1.0, libm::ilogb(time));
        let euler = if self.h.hi() < 0.0 { -0.01 * time } else { 0.01 * time };
        let after = self.rate(at, Dd::of(euler), &(*x + rate * S::of(euler)));
        let bend = after + rate * S::of(-1.0);
        // sums over seven numbers, as in the code of the authors
        let norm = |x: &Phase<S>| (7.0 * allowed.mean_square(x)).sqrt() * unit;
        let largest = norm(&rate).max(norm(&bend) / euler.abs() * unit);
        let guess = unit * libm::pow(0.01 / largest, 1.0 / f64::from(P::ORDER));
        guess.min(100.0 * euler.abs())
    }

    /// The accepted step from the point `x`; `None` where none can be taken.
    fn accepted(&mut self, at: Time, point: &Point<S>) -> Option<Current<S>> {
        if self.current.is_some() || self.stuck.is_some() {
            return self.current;
        }
        // from the point and what is remembered alone, so that a run taken up again has the same bits
        let x = point.phase();
        if !self.begun {
            self.rates[0] = self.rate(at, Dd::ZERO, &x);
            self.begun = true;
        }
        let mut size = if self.next.step == 0.0 { self.first(at, &x) } else { self.next.step };
        let mut rejected = false;
        let mut estimate = f64::NAN;
        loop {
            size = rounded_down(size);
            if !(size.is_normal() && 0.1 * size > self.base.hi().abs() * f64::ROUNDOFF) {
                let time = at.at_elapsed(self.base).seconds();
                let estimate = Some(estimate).filter(|estimate| estimate.is_finite());
                self.stuck = Some(Stuck { time, step: size, estimate, needed: None });
                return None;
            }
            let h = if self.h.hi() < 0.0 { -size } else { size };
            self.evaluate(at, h, &x, P::STAGES, 1);
            let change = sum(&self.rates, P::WEIGHTS) * S::of(h);
            let mut end = *point;
            end.add_momentum(change.momentum_body);
            end.add_attitude(change.attitude);
            let end = end.phase();
            if P::END_IN_ESTIMATE {
                self.rates[P::END] = self.rate(at, Dd::of(h), &end);
            }
            let allowed = Allowed::of(self.tolerance, &x, &end);
            estimate = size * P::estimate(&self.rates, |rate| allowed.mean_square(rate));
            if estimate <= 1.0 {
                self.work.accepted += 1;
                if !P::END_IN_ESTIMATE {
                    self.rates[P::END] = self.rate(at, Dd::of(h), &end);
                }
                let factor = P::CONTROL.after(estimate, self.next.estimate, rejected);
                let step = (size * factor).min(f64::MAX / 16.0);
                let next = Next { step, estimate: estimate.max(LEAST_ESTIMATE) };
                self.current = Some(Current { h, change, next, dense: None });
                return self.current;
            }
            self.work.rejected += 1;
            rejected = true;
            size *= P::CONTROL.again(estimate);
        }
    }

    /// Takes the steps that end by `end`, s since the start.
    fn advance_to(&mut self, at: Time, end: Dd, x: &mut Point<S>) {
        let begun = self.base;
        let mut own = OwnSteps::default();
        loop {
            let Some(Current { h, change, next, .. }) = self.accepted(at, x) else {
                x.add_momentum(Vec3([S::of(f64::NAN); 3]));
                return;
            };
            let behind = self.base + h;
            if (end - behind).hi() * h.signum() < 0.0 {
                return;
            }
            x.add_momentum(change.momentum_body);
            x.add_attitude(change.attitude);
            if let Some(needed) = own.needed((behind - begun).hi(), (end - begun).hi()) {
                let time = at.at_elapsed(behind).seconds();
                self.stuck = Some(Stuck { time, step: h.abs(), estimate: None, needed: Some(needed) });
                self.current = None;
                x.add_momentum(Vec3([S::of(f64::NAN); 3]));
                return;
            }
            let rate = self.rates[P::END];
            self.restart(behind, next);
            (self.rates[0], self.begun) = (rate, true);
        }
    }

    /// Moves `x` on to the time `elapsed` after its own, within the current step.
    fn move_within(&mut self, at: Time, elapsed: Dd, x: &mut Point<S>) {
        let Some(mut current) = self.accepted(at, x) else {
            x.add_momentum(Vec3([S::of(f64::NAN); 3]));
            return;
        };
        let dense = match current.dense {
            Some(dense) => dense,
            None => {
                self.evaluate(at, current.h, &x.phase(), P::DENSE_STAGES, P::END + 1);
                P::dense(&self.rates, current.change, S::of(current.h))
            }
        };
        current.dense = Some(dense);
        self.current = Some(current);
        let change = P::at(&dense, S::from_dd(elapsed / current.h));
        x.add_momentum(change.momentum_body);
        x.add_attitude(change.attitude);
    }
}

impl<S: Real, F: Field<S>, P: Pair> Map<S> for EmbeddedMap<S, F, P> {
    fn apply(&mut self, at: Time, x: &mut Point<S>) {
        self.open(at, x);
        self.advance(at, x);
        self.close(at.later(self.h), x);
    }

    fn open(&mut self, at: Time, _: &mut Point<S>) {
        self.restart(at.elapsed(), Next::FIRST);
    }

    fn advance(&mut self, at: Time, x: &mut Point<S>) {
        self.advance_to(at, at.elapsed() + self.h, x);
    }

    fn close(&mut self, at: Time, x: &mut Point<S>) {
        let elapsed = at.elapsed() - self.base;
        if elapsed != Dd::ZERO {
            self.move_within(at, elapsed, x);
        }
    }

    fn base(&self) -> Option<Dd> {
        Some(self.base)
    }

    fn dense(&mut self, until: Time, x: &mut Point<S>) -> Point<S> {
        self.advance_to(until, until.elapsed(), x);
        let mut there = *x;
        self.close(until, &mut there);
        there
    }

    fn memory(&self) -> Vec<f64> {
        vec![self.base.hi(), self.base.lo(), self.next.step, self.next.estimate]
    }

    fn remember(&mut self, memory: &[f64]) {
        if let &[high, low, step, estimate] = memory {
            self.restart(Dd::sum(high, low), Next { step, estimate });
        }
    }

    fn work(&self) -> Option<Work> {
        Some(self.work)
    }

    fn stuck(&self) -> Option<Stuck> {
        self.stuck
    }
}

impl Next {
    const FIRST: Next = Next { step: 0.0, estimate: LEAST_ESTIMATE };
}

impl Allowed {
    /// In a step from `x` to `y`. A momentum of zero at both allows any error: there is none. Of one next to zero at least the least
    /// normal double is allowed, below which doubles have fewer digits.
    fn of<S: Real>(tolerance: f64, x: &Phase<S>, y: &Phase<S>) -> Self {
        let sizes = [x, y].map(|x| (length(x.momentum_body.0), length(x.attitude.components())));
        let inverse =
            |size: f64| if size == 0.0 { 0.0 } else { 1.0 / (tolerance * size).max(f64::MIN_POSITIVE) };
        // f64::max would drop a NaN, and with a NaN in y the estimate is none either
        let largest = |a: f64, b: f64| if a > b { a } else { b };
        Allowed {
            momentum: inverse(largest(sizes[0].0, sizes[1].0)),
            attitude: inverse(largest(sizes[0].1, sizes[1].1)),
        }
    }

    /// Mean of the squares of seven numbers in units of what is allowed.
    fn mean_square<S: Real>(&self, x: &Phase<S>) -> f64 {
        let Vec3(m) = x.momentum_body;
        let square = |x: S, factor: f64| {
            let x = x.magnitude() * factor;
            x * x
        };
        let Quat { w, v: Vec3(v) } = x.attitude;
        let momentum =
            square(m[0], self.momentum) + square(m[1], self.momentum) + square(m[2], self.momentum);
        let vector = square(v[0], self.attitude) + square(v[1], self.attitude) + square(v[2], self.attitude);
        (momentum + square(w, self.attitude) + vector) * (1.0 / 7.0)
    }
}

/// The first 24 bits of `x`: rounding, which depends on the axes of space, does not reach them.
fn rounded_down(x: f64) -> f64 {
    f64::from_bits(x.to_bits() & !((1 << 29) - 1))
}

//! A method, one of its claims and the case that they are measured on.

use super::case::Case;
use crate::body::{Clock, Point, Problem, Time};
use crate::method::{AnyMethod, Claims, StepError};
use crate::num::{Dd, Real};
use crate::rotation::Vec3;

/// What every law is measured of.
#[derive(Clone, Copy)]
pub(super) struct Subject<'a> {
    pub(super) method: &'a dyn AnyMethod,
    pub(super) claims: Claims,
    pub(super) case: &'a Case,
}

impl Subject<'_> {
    pub(super) fn problem(&self) -> Problem {
        self.case.problem()
    }

    /// The momentum of the wheels, which no case has with a motor; zero without wheels.
    pub(super) fn momentum_of_wheels(&self) -> Vec3<Dd> {
        let wheels = self.case.body.momentum_of_wheels();
        wheels.map_or(Vec3::zero(), |wheels| wheels.at(Time::from_seconds(0.0)))
    }

    /// A step at which what a method loses shows: `usual`, more for one of high order, and for one that takes steps of its own.
    pub(super) fn telling_step(&self, usual: f64) -> f64 {
        match self.claims.order {
            _ if self.method.tolerance().is_some() => 1.0,
            Some(8) => 4.0 * usual,
            _ => usual,
        }
    }

    /// Whether the tolerance of a method is the rounding of the scalar: what it does not keep it loses by rounding only.
    pub(super) fn is_to_rounding(&self) -> bool {
        self.method.tolerance() == Some(f64::ROUNDOFF)
    }

    /// The words of a claim that something is kept.
    pub(super) fn kept(&self, claimed: bool) -> &'static str {
        match claimed {
            true => "kept",
            false if self.is_to_rounding() => "to rounding",
            false => "no",
        }
    }

    /// `points` points, each `every` steps of `h` after the last, in double-double.
    pub(super) fn integrate(&self, h: f64, points: u64, every: u64) -> Result<Vec<Point<Dd>>, StepError> {
        let mut x = self.case.start;
        let mut step = self.method.prepare_dd(Clock::new(h), &self.case.body)?;
        step.open(&mut x);
        let next = |_| {
            step.advance(&mut x, every);
            step.reading(&x)
        };
        Ok((0..points).map(next).collect())
    }

    /// One step of `h` from `start`, in double-double.
    pub(super) fn one_step(&self, start: Point<Dd>, h: f64) -> Result<Point<Dd>, StepError> {
        let mut x = start;
        self.method.prepare_dd(Clock::new(h), &self.case.body)?.steps(&mut x, 1);
        Ok(x)
    }

    /// How far `x` is from the start: of the momentum relative to it.
    pub(super) fn away(&self, x: &Point<Dd>) -> f64 {
        let start = &self.case.start;
        let momentum = (x.momentum_body - start.momentum_body).magnitude() / start.momentum_body.magnitude();
        largest([momentum, (x.attitude - start.attitude).magnitude()])
    }
}

/// The largest of some numbers that are not negative; NaN if one is NaN.
pub(super) fn largest(numbers: impl IntoIterator<Item = f64>) -> f64 {
    numbers.into_iter().fold(0.0, |most: f64, x| if most.is_nan() || most >= x { most } else { x })
}

//! Taylor's method with steps of its own.

use super::motion_series::MotionSeries;
use super::{SOURCE, add_change, unit};
use crate::body::{Field, Point, Problem, Rotor, Time};
use crate::method::contract::OwnSteps;
use crate::method::{AnyMethod, Claimed, Claims, Cost, Kept, Map, Method, Stuck, ToleranceError, Work};
use crate::num::{Dd, Real};
use crate::rotation::Vec3;

/// The largest tolerance.
const LOOSEST: f64 = 1e-3;

/// By how much the order is above that of the least K² for a turn, and up to where: more terms than these lengthen the steps
/// until the rounding of each biases the energy.
const MORE: f64 = 6.0;
const ENOUGH: f64 = 20.0;

/// From the rounding of a double to the largest, in words.
const RANGE: &str = "from 1.2e-16, as the rounding of a double is 1.1e-16, to 1e-3";

/// Taylor's method with order and steps by a tolerance, in a step relative to the state: by default the rounding of the scalar.
///
/// With `n = ⌈1 − ln(tolerance)/2⌉` the order is n + 6, but at most 20, or n where that is more: n terms are the fewest
/// operations where a step costs n² (§3.2 of Jorba and Zou, Experimental Math. 14 (2005) 99), but a step has costs of its own, too.
/// A step ends where the terms of the two highest orders have grown to the
/// tolerance over e² (ibid.); with n terms that is near the radius of convergence over e², in which a free
/// body turns by about half a radian. Its error of discretisation is below the tolerance. The step h of a run is only the
/// interval of output: states there are values of the series that the time falls into, and the steps do not depend on h. The
/// cost that is claimed is that of a step of its own, in `f64`, not of h.
///
/// A force has to be analytic along the motion, as with [`Taylor`](super::Taylor). A thruster that is switched is not, as no
/// series shows the switch.
///
/// Nothing is kept by construction; with the default tolerance what is lost is of the size of rounding.
///
/// ```
/// use nalgebra::{UnitQuaternion, Vector3};
/// use polhode::method::AdaptiveTaylor;
/// use polhode::{Body, FreeMotion, Inertia, Run};
/// let body = Body::free(Inertia::from_moments([1.0, 2.0, 3.0])?);
/// let start = body.state(UnitQuaternion::identity(), Vector3::new(0.4, 1.0, -0.3))?;
/// let end = Run::new(&AdaptiveTaylor::to_rounding(), &body, &start, 100.0)?.advance_to(1)?;
/// let exact = FreeMotion::from_state(body.inertia(), &start)?.at(100.0)?;
/// assert!(end.state.rotation().angle_to(&exact.rotation()) < 1e-13);
/// # Ok::<(), polhode::Error>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct AdaptiveTaylor {
    tolerance: Option<f64>,
}

impl AdaptiveTaylor {
    /// With the rounding of the scalar as tolerance.
    #[must_use]
    pub const fn to_rounding() -> Self {
        AdaptiveTaylor { tolerance: None }
    }

    /// With the tolerance `tolerance`, relative to the state.
    ///
    /// # Errors
    /// A tolerance below the rounding of a double, 1.1e-16, or above 1e-3.
    pub fn of_tolerance(tolerance: f64) -> Result<Self, ToleranceError> {
        if (f64::ROUNDOFF..=LOOSEST).contains(&tolerance) {
            Ok(AdaptiveTaylor { tolerance: Some(tolerance) })
        } else {
            Err(ToleranceError::OutOfRange { method: "taylor", tolerance, range: RANGE })
        }
    }

    /// The order that a tolerance asks for: Jorba and Zou's is the best where a step costs K² and nothing else.
    fn order(tolerance: f64) -> u32 {
        let least = libm::ceil(1.0 - 0.5 * libm::log(tolerance));
        least.max((least + MORE).min(ENOUGH)).clamp(8.0, 40.0) as u32
    }
}

impl Claimed for AdaptiveTaylor {
    fn name(&self) -> String {
        self.tolerance.map_or("taylor".into(), |tolerance| format!("taylor:{tolerance:e}"))
    }
    fn claims(&self, _: Problem) -> Option<Claims> {
        let tolerance = self.tolerance.unwrap_or(f64::ROUNDOFF);
        let cost = Cost::right_sides(AdaptiveTaylor::order(tolerance));
        Some(Claims::new(None, Kept::NOTHING, cost, SOURCE))
    }
    fn tolerance(&self) -> Option<f64> {
        Some(self.tolerance.unwrap_or(f64::ROUNDOFF))
    }
    fn with_tolerance(&self, tolerance: f64) -> Result<Box<dyn AnyMethod>, ToleranceError> {
        Ok(Box::new(Self::of_tolerance(tolerance)?))
    }
    fn needs_series(&self) -> bool {
        true
    }
}

impl<S: Real> Method<S> for AdaptiveTaylor {
    type Map<F: Field<S>> = AdaptiveTaylorMap<S, F>;
    fn map<F: Field<S>>(&self, h: Dd, rotor: &Rotor, field: &F) -> AdaptiveTaylorMap<S, F> {
        let tolerance = self.tolerance.unwrap_or(S::ROUNDOFF);
        AdaptiveTaylorMap {
            h,
            tolerance: tolerance * libm::exp(-2.0),
            series: MotionSeries::new(AdaptiveTaylor::order(tolerance), rotor, field),
            base: Dd::ZERO,
            current: None,
            stuck: None,
            work: Work::default(),
        }
    }
}

/// A prepared [`AdaptiveTaylor`]. Between outputs the point is that about which the current series is.
#[derive(Clone, Debug)]
pub struct AdaptiveTaylorMap<S, F> {
    h: Dd,
    /// What the last terms may grow to.
    tolerance: f64,
    series: MotionSeries<S, F>,
    /// The time of the point, s since the start.
    base: Dd,
    /// The series, once it is worked out.
    current: Option<Current>,
    stuck: Option<Stuck>,
    work: Work,
}

/// The unit that the current series counts, s, with the sign of h, and for how many units it is used.
#[derive(Clone, Copy, Debug)]
struct Current {
    unit: f64,
    reach: f64,
}

impl<S: Real, F: Field<S>> AdaptiveTaylorMap<S, F> {
    /// The point is of the time `base` now.
    fn restart(&mut self, base: Dd) {
        (self.base, self.current, self.stuck) = (base, None, None);
    }

    /// The series about the point `x` at the time of the base.
    fn expanded(&mut self, at: Time, x: &Point<S>) -> Current {
        if let Some(current) = self.current {
            return current;
        }
        // from the base alone, so that a run taken up again has the same bits
        let at = at.at_elapsed(self.base);
        self.series.record(at, x);
        let torque = self.series.torque(at, 0);
        let (turns, slows) = (self.series.rate(x, torque), self.series.damping(x, torque));
        let mut current = self.expanded_at(at, turns, x);
        // drag stops a slow body long before it turns: in a unit of that time high terms leave the range of doubles
        if (current.reach == 0.0 || current.reach.is_nan()) && slows > turns && slows.is_finite() {
            self.series.record(at, x);
            current = self.expanded_at(at, slows, x);
        }
        self.current = Some(current);
        self.work.evaluations += self.series.order() as u64;
        current
    }

    /// The series about `x`, which counts in the time that the rate, 1/s, tells.
    fn expanded_at(&mut self, at: Time, rate: f64, x: &Point<S>) -> Current {
        let unit = unit(if self.h.hi() < 0.0 { -1.0 / rate } else { 1.0 / rate });
        self.series.expand(at, unit, x);
        Current { unit, reach: self.series.reach(self.tolerance) }
    }

    /// Takes the steps that end by `end`, s since the start.
    fn advance_to(&mut self, at: Time, end: Dd, x: &mut Point<S>) {
        let begun = self.base;
        let mut own = OwnSteps::default();
        while self.stuck.is_none() {
            let Current { unit, reach } = self.expanded(at, x);
            let next = self.base + Dd::product(reach, unit);
            if reach.is_infinite() || (end - next).hi() * unit < 0.0 {
                return;
            }
            if !(next != self.base && next.hi().is_finite()) {
                // a series that is not finite has no state behind it
                x.add_momentum(Vec3([S::of(f64::NAN); 3]));
                return;
            }
            add_change(&self.series, S::of(reach), x);
            x.renormalize();
            self.restart(next);
            self.work.accepted += 1;
            let needed = own.needed((next - begun).hi(), (end - begun).hi());
            self.stuck = needed.map(|needed| {
                let (time, step) = (at.at_elapsed(next).seconds(), (reach * unit).abs());
                Stuck { time, step, estimate: None, needed: Some(needed) }
            });
        }
        x.add_momentum(Vec3([S::of(f64::NAN); 3]));
    }
}

impl<S: Real, F: Field<S>> Map<S> for AdaptiveTaylorMap<S, F> {
    fn apply(&mut self, at: Time, x: &mut Point<S>) {
        self.open(at, x);
        self.advance(at, x);
        self.close(at.later(self.h), x);
    }

    fn open(&mut self, at: Time, _: &mut Point<S>) {
        self.restart(at.elapsed());
    }

    fn advance(&mut self, at: Time, x: &mut Point<S>) {
        self.advance_to(at, at.elapsed() + self.h, x);
    }

    fn close(&mut self, at: Time, x: &mut Point<S>) {
        let elapsed = at.elapsed() - self.base;
        if elapsed != Dd::ZERO {
            let unit = self.expanded(at, x).unit;
            add_change(&self.series, S::from_dd(elapsed * (1.0 / unit)), x);
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

    /// A series of the order K counts as K evaluations; no step is rejected.
    fn work(&self) -> Option<Work> {
        Some(self.work)
    }

    fn stuck(&self) -> Option<Stuck> {
        self.stuck
    }

    fn memory(&self) -> Vec<f64> {
        vec![self.base.hi(), self.base.lo()]
    }

    fn remember(&mut self, memory: &[f64]) {
        if let &[high, low] = memory {
            self.restart(Dd::sum(high, low));
        }
    }
}

//! `taylor`: Taylor's method: the power series of the motion in time, with steps as given or of its own.

mod adaptive;
mod gradient_series;
mod motion_series;
mod turned;

pub use adaptive::AdaptiveTaylor;

use thiserror::Error;

use self::motion_series::MotionSeries;
use super::{Claimed, Claims, Cost, Kept, Map, Method};
use crate::body::{Field, Point, Problem, Rotor, Time};
use crate::num::{Dd, Real};

/// The orders that there are.
const ORDERS: core::ops::RangeInclusive<u32> = 8..=40;

const SOURCE: &str = "Jorba and Zou, Experimental Math. 14 (2005) 99";

/// Taylor's method of a fixed order K, from 8 to 40.
///
/// Φ_h: `m + Σ h^n m_n`, `q + Σ h^n q_n`, n from 1 to K, the coefficients by recurrences (Jorba and Zou, Experimental Math. 14
/// (2005) 99). Free motion, linear potentials and the gravity gradient on a conic have recurrences of their own. The law of any other force is evaluated on
/// [series](crate::num::Series) once a step and recorded; each of its products then takes K²/2 multiplications. It has to be
/// analytic along the motion, and a closure in `f64` cannot be taken. Keeps nothing; |q| is brought back to 1 in every eighth step.
///
/// ```
/// use nalgebra::{UnitQuaternion, Vector3};
/// use polhode::method::Taylor;
/// use polhode::{Body, FreeMotion, Inertia, Run};
/// let body = Body::free(Inertia::from_moments([1.0, 2.0, 3.0])?);
/// let start = body.state(UnitQuaternion::identity(), Vector3::new(0.4, 1.0, -0.3))?;
/// let end = Run::new(&Taylor::of_order(20)?, &body, &start, 0.5)?.advance_to(200)?;
/// let exact = FreeMotion::from_state(body.inertia(), &start)?.at(100.0)?;
/// assert!(end.state.rotation().angle_to(&exact.rotation()) < 1e-12);
/// # Ok::<(), polhode::Error>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Taylor {
    order: u32,
}

/// There is no such order.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Error)]
#[error("there is no Taylor method of order {order}; there are the orders from {} to {}", ORDERS.start(), ORDERS.end())]
#[non_exhaustive]
pub struct TaylorOrderError {
    /// What was asked for.
    pub order: u32,
}

impl Taylor {
    /// The method of order `order`.
    ///
    /// # Errors
    /// An order that is not from 8 to 40.
    pub fn of_order(order: u32) -> Result<Self, TaylorOrderError> {
        if ORDERS.contains(&order) { Ok(Taylor { order }) } else { Err(TaylorOrderError { order }) }
    }
}

impl Claimed for Taylor {
    fn name(&self) -> String {
        format!("taylor:{}", self.order)
    }
    fn claims(&self, _: Problem) -> Option<Claims> {
        Some(Claims::new(Some(self.order), Kept::NOTHING, Cost::right_sides(self.order), SOURCE))
    }
    fn needs_series(&self) -> bool {
        true
    }
}

impl<S: Real> Method<S> for Taylor {
    type Map<F: Field<S>> = TaylorMap<S, F>;
    fn map<F: Field<S>>(&self, h: Dd, rotor: &Rotor, field: &F) -> TaylorMap<S, F> {
        let unit = unit(h.hi());
        let share = S::from_dd(h * (1.0 / unit));
        TaylorMap { series: MotionSeries::new(self.order, rotor, field), unit, share }
    }
}

/// A prepared [`Taylor`].
#[derive(Clone, Debug)]
pub struct TaylorMap<S, F> {
    series: MotionSeries<S, F>,
    /// What the series count, s.
    unit: f64,
    /// The step in units.
    share: S,
}

impl<S: Real, F: Field<S>> Map<S> for TaylorMap<S, F> {
    fn apply(&mut self, at: Time, x: &mut Point<S>) {
        self.series.record(at, x);
        self.series.expand(at, self.unit, x);
        add_change(&self.series, self.share, x);
        x.renormalize_at_times();
    }
}

/// Moves `x` on by `s` units of the series about it.
fn add_change<S: Real, F: Field<S>>(series: &MotionSeries<S, F>, s: S, x: &mut Point<S>) {
    let change = series.change(s);
    x.add_momentum(change.momentum_body);
    x.add_attitude(change.attitude);
}

/// The power of two next to |t|, with the sign of t; 1 for 0 and what is not finite, within the range of normal doubles.
fn unit(t: f64) -> f64 {
    if t == 0.0 || !t.is_finite() {
        return 1.0;
    }
    let power = libm::scalbn(1.0, libm::ilogb(t).clamp(-1000, 1000));
    if t < 0.0 { -power } else { power }
}

//! Embedded Runge–Kutta pairs with steps of their own. The state is (m, q) as seven numbers, and nothing is kept.

use core::marker::PhantomData;

use super::adaptive::EmbeddedMap;
use super::pair::Pair;
use crate::body::{Field, Problem, Rotor};
use crate::method::{AnyMethod, Claimed, Claims, Cost, Kept, Method, ToleranceError};
use crate::num::{Dd, Real};

/// The smallest tolerance: some roundings of a double. Below it error estimates are rounding alone.
const TIGHTEST: f64 = 1e-15;

/// The largest tolerance.
const LOOSEST: f64 = 1e-3;

/// The two in words.
const RANGE: &str = "from 1e-15, some roundings of a double, to 1e-3";

/// An embedded Runge–Kutta pair with steps of its own by a tolerance: [`Dop853`](crate::method::Dop853) and
/// [`Tsit5`](crate::method::Tsit5).
///
/// Φ_h: as many steps of the pair as it takes, the last of them by its dense output. A step is accepted where its error
/// estimate is below 1 in the norm `|δ|² = (|δm|²/|m|² + |δq|²/|q|²)/(7 tolerance²)`, |m| and |q| the larger ones of its two
/// ends: the mean square of seven numbers, each in units of what a mixed tolerance allows, so that no unit and no choice of
/// axes counts. Steps are rounded down to 24 bits for the same reason. The first step is that of Hairer, Norsett and Wanner,
/// Solving ODEs I, II.4, in the time in which the state changes by itself as unit; from rest without torque it is a
/// microsecond, and a torque that begins and ends within a step of a body at rest goes unseen.
///
/// The step h of a run is only the interval of output: the steps of the pair do not depend on it. Sums are
/// compensated. Nothing is kept, |q| neither. The cost that is claimed is that of an accepted step;
/// [`Run::work`](crate::run::Run::work) counts what a run took.
///
/// In double-double it takes the steps that the tolerance asks for, with rounding out of the way.
///
/// ```
/// use nalgebra::{UnitQuaternion, Vector3};
/// use polhode::method::{Dop853, Tsit5};
/// use polhode::{Body, FreeMotion, Inertia, Run};
/// let body = Body::free(Inertia::from_moments([1.0, 2.0, 3.0])?);
/// let start = body.state(UnitQuaternion::identity(), Vector3::new(0.4, 1.0, -0.3))?;
/// let exact = FreeMotion::from_state(body.inertia(), &start)?.at(10.0)?;
/// let mut run = Run::new(&Dop853::of_tolerance(1e-12)?, &body, &start, 10.0)?;
/// assert!(run.advance_to(1)?.state.rotation().angle_to(&exact.rotation()) < 1e-11);
/// assert!(run.work().is_some_and(|work| work.evaluations < 700));
/// let end = Run::new(&Tsit5::of_tolerance(1e-6)?, &body, &start, 10.0)?.advance_to(1)?;
/// assert!(end.state.rotation().angle_to(&exact.rotation()) < 1e-5);
/// # Ok::<(), polhode::Error>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Embedded<P> {
    tolerance: f64,
    pair: PhantomData<P>,
}

impl<P: Pair> Embedded<P> {
    /// With the tolerance `tolerance`, relative to the state.
    ///
    /// # Errors
    /// A tolerance below 1e-15 or above 1e-3.
    pub fn of_tolerance(tolerance: f64) -> Result<Self, ToleranceError> {
        if (TIGHTEST..=LOOSEST).contains(&tolerance) {
            Ok(Embedded { tolerance, pair: PhantomData })
        } else {
            Err(ToleranceError::OutOfRange { method: P::NAME, tolerance, range: RANGE })
        }
    }
}

impl<P: Pair> Default for Embedded<P> {
    fn default() -> Self {
        Embedded { tolerance: P::USUAL_TOLERANCE, pair: PhantomData }
    }
}

impl<P: Pair> Claimed for Embedded<P> {
    fn name(&self) -> String {
        if *self == Embedded::default() {
            P::NAME.into()
        } else {
            format!("{}:{:e}", P::NAME, self.tolerance)
        }
    }
    fn claims(&self, _: Problem) -> Option<Claims> {
        let cost = Cost::right_sides(P::STAGES.len() as u32 + 1);
        Some(Claims::new(None, Kept::NOTHING, cost, P::SOURCE))
    }
    fn tolerance(&self) -> Option<f64> {
        Some(self.tolerance)
    }
    fn with_tolerance(&self, tolerance: f64) -> Result<Box<dyn AnyMethod>, ToleranceError> {
        Ok(Box::new(Self::of_tolerance(tolerance)?))
    }
}

impl<S: Real, P: Pair> Method<S> for Embedded<P> {
    type Map<F: Field<S>> = EmbeddedMap<S, F, P>;
    fn map<F: Field<S>>(&self, h: Dd, rotor: &Rotor, field: &F) -> EmbeddedMap<S, F, P> {
        EmbeddedMap::new(h, self.tolerance, rotor, field)
    }
}

//! `dmv`: the discrete Moser–Veselov map of any even order: plain steps of a body with slightly other moments and clock.

mod flows;
mod series;

use std::sync::Arc;

use thiserror::Error;

use self::series::{LARGEST_ORDER, RoundedSeries, Series};
use super::rattle::DmvMap;
use super::{Cost, Dmv, Energy, FreePart, Map, Method, SideBySide, Symmetric};
use crate::body::{Field, Point, RENORMALIZE_EVERY, Rotor, Time};
use crate::method::contract::lanes::LaneFlow;
use crate::num::{Dd, Precise};

/// The discrete Moser–Veselov map of an even order from 4 to 20.
///
/// The plain map follows the exact motion of a body with slightly other moments and clock. Here it steps a body whose
/// reciprocal moments are `s/I_i + d`, with s and d such that this motion is that of the given body up to O(h^(order + 1)):
/// order 2n of Hairer and Vilmart, J. Phys. A 39 (2006) 13225, who give s and d to order 10; the power series of any order are
/// made for each body when a step is prepared. Keeps energy, |m|, L and the Lie–Poisson bracket like the plain map, at its
/// cost per step: in free motion s and d are constants of the orbit, elsewhere two polynomials of the momentum. As they differ
/// from orbit to orbit, attitude and momentum together are symplectic up to O(h^(order + 1)) only.
///
/// ```
/// use nalgebra::{UnitQuaternion, Vector3};
/// use polhode::method::{Kicks, PreprocessedDmv, Splitting};
/// use polhode::{Body, FreeMotion, Inertia, Run};
/// let body = Body::free(Inertia::from_moments([1.0, 2.0, 3.0])?);
/// let start = body.state(UnitQuaternion::identity(), Vector3::new(0.4, 1.0, -0.3))?;
/// let method = Splitting::strang(PreprocessedDmv::of_order(10)?, Kicks);
/// let end = Run::new(&method, &body, &start, 0.1)?.advance_to(1000)?;
/// let exact = FreeMotion::from_state(body.inertia(), &start)?.at(100.0)?;
/// assert!(end.state.rotation().angle_to(&exact.rotation()) < 1e-9);
/// # Ok::<(), polhode::Error>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct PreprocessedDmv {
    order: u32,
}

/// There is no such order.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Error)]
#[error(
    "there is no discrete Moser-Veselov map of order {order}; there are the even orders from 4 to {LARGEST_ORDER}, and rattle of order 2"
)]
#[non_exhaustive]
pub struct DmvOrderError {
    /// What was asked for.
    pub order: u32,
}

impl PreprocessedDmv {
    /// The highest order that was published.
    pub const ORDER_10: PreprocessedDmv = PreprocessedDmv { order: 10 };

    /// The map of order `order`.
    ///
    /// # Errors
    /// An order that is not even or not from 4 to 20.
    pub const fn of_order(order: u32) -> Result<Self, DmvOrderError> {
        if order.is_multiple_of(2) && 4 <= order && order <= LARGEST_ORDER {
            Ok(PreprocessedDmv { order })
        } else {
            Err(DmvOrderError { order })
        }
    }
}

impl Symmetric for PreprocessedDmv {}

impl FreePart for PreprocessedDmv {
    fn name(&self) -> String {
        format!("dmv:{}", self.order)
    }
    fn order(&self) -> Option<u32> {
        Some(self.order)
    }
    fn energy(&self) -> Energy {
        Energy::Exact
    }
    fn symplectic(&self) -> bool {
        false
    }
    fn cost(&self) -> Cost {
        Cost::solves(1)
    }
    fn source(&self) -> &'static str {
        "Hairer and Vilmart, J. Phys. A 39 (2006) 13225, to order 10; series per body beyond"
    }
}

impl<S: Precise> Method<S> for PreprocessedDmv {
    type Map<F: Field<S>> = PreprocessedDmvMap<S>;
    fn map<F: Field<S>>(&self, h: Dd, rotor: &Rotor, field: &F) -> PreprocessedDmvMap<S> {
        Method::<S>::maps(self, rotor, field)(h)
    }

    fn maps<F: Field<S>>(&self, rotor: &Rotor, field: &F) -> impl Fn(Dd) -> PreprocessedDmvMap<S> {
        let series = Arc::new(Series::new(rotor, self.order));
        let coefficients = series.coefficients::<S>();
        move |h| {
            let plain = Dmv.map(h, rotor, field);
            PreprocessedDmvMap {
                rotor: *rotor,
                h,
                rounded: series.rounded(h, &coefficients),
                series: Arc::clone(&series),
                plain,
                modified: plain,
                fixed: false,
            }
        }
    }
}

/// A prepared [`PreprocessedDmv`].
#[derive(Clone, Debug)]
pub struct PreprocessedDmvMap<S> {
    rotor: Rotor,
    h: Dd,
    series: Arc<Series>,
    rounded: RoundedSeries<S>,
    plain: DmvMap<S>,
    /// Of the modified moments.
    modified: DmvMap<S>,
    /// Whether they are those of the orbit, which does not change.
    fixed: bool,
}

impl<S: Precise> Map<S> for PreprocessedDmvMap<S> {
    #[inline]
    fn apply(&mut self, at: Time, x: &mut Point<S>) {
        let [s, d] = self.rounded.values(x.momentum_body);
        self.modified.modify(&self.plain, s, d * S::from_dd(self.h * 0.5));
        self.fixed = false;
        self.modified.apply(at, x);
    }

    /// The constants of the orbit are rounded once from double-double: so rounding is no systematic force.
    fn open(&mut self, _: Time, x: &mut Point<S>) {
        let [s, d] = self.series.values(x.momentum_body.map(S::to_dd), self.h);
        self.modified.set(&self.rotor, self.h * 0.5, s, d);
        self.fixed = true;
    }

    #[inline]
    fn advance(&mut self, at: Time, x: &mut Point<S>) {
        if self.fixed { self.modified.apply(at, x) } else { self.apply(at, x) }
    }

    fn part_side_by_side(&self) -> Option<SideBySide<S>> {
        let flows = vec![LaneFlow::Dmv(self.rounded.degree()), LaneFlow::Renormalize(RENORMALIZE_EVERY)];
        let polynomials = self.rounded.constants(S::from_dd(self.h * 0.5));
        let constants = self.plain.constants().into_iter().chain(polynomials).chain([S::of(0.0)]);
        Some(SideBySide::reading(flows, constants.collect()))
    }

    fn worst_residual(&self) -> f64 {
        self.modified.worst_residual()
    }
}

//! The free flow of any body in steps of any length, with what rounding takes given back.

use super::short_flow::ShortFlow;
use super::symmetric_top::Spun;
use super::{FreeBody, SymmetricTop};
use crate::body::{Point, Rotor, Time};
use crate::flow::Flow;
use crate::num::{Dd, Precise, Real};
use crate::rotation::{Quat, Vec3};

/// The exact flow of the free body, made for being taken many times: two turns of a [symmetric top](SymmetricTop), else
/// a power series over short times and [elliptic functions](FreeBody) over long ones.
///
/// Over a short time the motion is an increment whose rounding is carried. What rounding takes from the energy and from L
/// in a flow by elliptic functions is measured in double-double and given back: else both would move away slowly, by
/// a few hundredths of a rounding error each time.
/// t in seconds, moments and m in the units of the [solver frame](crate::body::Rotor).
///
/// ```
/// use nalgebra::{UnitQuaternion, Vector3};
/// use polhode::body::{Body, Time};
/// use polhode::flow::{Flow, FreeFlow, FreeMotion};
/// use polhode::inertia::Inertia;
/// let body = Body::free(Inertia::from_moments([1.0, 2.0, 3.0])?);
/// let start = body.state(UnitQuaternion::identity(), Vector3::new(0.4, 1.0, -0.3))?;
/// let mut x = body.enter(&start)?.to_f64();
/// FreeFlow::new(&body.rotor()).flow(Time::from_seconds(0.0), 0.5, &mut x);
/// let exact = FreeMotion::from_state(body.inertia(), &start)?.at(0.5)?;
/// assert!(body.leave(&x).rotation().angle_to(&exact.rotation()) < 1e-13);
/// # Ok::<(), polhode::Error>(())
/// ```
#[derive(Clone, Copy, Debug)]
pub struct FreeFlow<S>(Kind<S>);

/// What a flow keeps for the next of the same length.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Last<S>(Option<Spun<S>>);

impl<S> Last<S> {
    /// Nothing, before the first.
    pub(crate) const NOTHING: Self = Last(None);
}

#[derive(Clone, Copy, Debug)]
enum Kind<S> {
    Symmetric(SymmetricTop<S>),
    Asymmetric { short: ShortFlow<S>, any: FreeBody<S>, inverse_moments: Vec3<Dd> },
}

impl<S: Precise> FreeFlow<S> {
    /// The free flow of a body with the constants `rotor`.
    #[must_use]
    pub fn new(rotor: &Rotor) -> Self {
        FreeFlow(match SymmetricTop::new(rotor) {
            Some(flow) => Kind::Symmetric(flow),
            None => Kind::Asymmetric {
                short: ShortFlow::new(rotor),
                any: FreeBody::new(rotor),
                inverse_moments: rotor.inverse_moments(),
            },
        })
    }

    /// The series over short times; of a symmetric top there is none.
    pub(super) fn short(&self) -> Option<&ShortFlow<S>> {
        match &self.0 {
            Kind::Symmetric(_) => None,
            Kind::Asymmetric { short, .. } => Some(short),
        }
    }

    /// Whether many bodies can be moved side by side.
    pub(crate) fn goes_side_by_side(&self) -> bool {
        self.short().is_some()
    }
}

/// What `moves` does to `x`, by way of a copy: a point that is lent to a function is not kept in registers.
#[inline(always)]
pub(crate) fn apart<S: Real>(x: &mut Point<S>, moves: impl FnOnce(&mut Point<S>)) {
    let mut moved = *x;
    moves(&mut moved);
    *x = moved;
}

impl<S: Precise> FreeFlow<S> {
    /// The flow, sooner where the one before was of the same length: the same bits.
    #[inline(always)]
    pub(crate) fn flow_again(&self, at: Time, t: S, last: &mut Last<S>, x: &mut Point<S>) {
        match &self.0 {
            Kind::Symmetric(flow) => flow.flow_again(t, &mut last.0, x),
            Kind::Asymmetric { .. } => apart(x, |x| self.flow(at, t, x)),
        }
    }
}

impl<S: Precise> Flow<S> for FreeFlow<S> {
    #[inline]
    fn flow(&self, at: Time, t: S, x: &mut Point<S>) {
        match &self.0 {
            Kind::Symmetric(flow) => flow.flow(at, t, x),
            Kind::Asymmetric { short, any, inverse_moments } => {
                if !short.try_flow(t, x) {
                    let before = Invariants::of(x, *inverse_moments);
                    any.flow(at, t, x);
                    before.restore(x, *inverse_moments);
                }
            }
        }
    }
}

/// What free motion keeps: 2T, |m|² and L.
struct Invariants {
    twice_energy: Dd,
    squared: Dd,
    space: Vec3<Dd>,
}

impl Invariants {
    fn of<S: Precise>(x: &Point<S>, inverse_moments: Vec3<Dd>) -> Self {
        let m = x.momentum_body.map(S::to_dd);
        let q = x.attitude.map(S::to_dd);
        Invariants {
            twice_energy: m.times(inverse_moments).dot(m),
            squared: m.norm_squared(),
            space: q.rotate(m),
        }
    }

    /// Moves `x` back, to first order, to these invariants.
    fn restore<S: Precise>(&self, x: &mut Point<S>, inverse_moments: Vec3<Dd>) {
        let after = Invariants::of(x, inverse_moments);
        let m = x.momentum_body;
        let squared = m.norm_squared();
        if squared == S::of(0.0) {
            return;
        }
        let half = |x: Dd| S::from_dd(x * 0.5);
        // the size by a part along m, then the energy by one along ω less its part along m
        let stretch = half(self.squared - after.squared) / squared;
        let omega = m.times(inverse_moments.map(S::from_dd));
        let twice_energy = m.dot(omega);
        let across = omega - m * (twice_energy / squared);
        let across_squared = across.norm_squared();
        let mut change = m * stretch;
        // next to a principal axis the energy follows from the size; and the lack is measured to the rounding of Dd,
        // which `across` divides: in f64 the change stays far more exact than m, in Dd there is nothing but rounding
        if across_squared > omega.norm_squared() * S::of(Dd::ROUNDOFF / S::ROUNDOFF) {
            let lacking = half(self.twice_energy - after.twice_energy) - stretch * twice_energy;
            change = change + across * (lacking / across_squared);
        }
        x.add_momentum(change);
        // the direction of L by a turn in space
        let difference = (self.space - after.space).map(S::from_dd);
        let l = after.space.map(S::from_dd);
        let turn = Quat::new(S::of(0.0), l.cross(difference) * (S::of(0.5) / squared));
        x.add_attitude(turn * x.attitude);
    }
}

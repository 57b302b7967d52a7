//! The flow of the free rigid body, by elliptic functions.

use super::circulation::Circulation;
use super::phase::{rotation, steady};
use super::polhode::{Polhode, rounded_separation};
use crate::body::{Phase, Point, Rotor, Time};
use crate::flow::Flow;
use crate::num::Precise;
use crate::rotation::Vec3;

/// The exact flow of the free body, set up anew from the state at each call, in the state's own scalar.
///
/// Only products and differences of `S` go into it: in `f64` a turn of
/// one radian is good to 4e-14 rad; next to the unstable axis, where the phase is as long as the logarithm of the distance,
/// to 2e-13 rad.
/// t in seconds, moments and m in the units of the [solver frame](crate::body::Rotor).
///
/// ```
/// use nalgebra::{UnitQuaternion, Vector3};
/// use polhode::body::{Body, Time};
/// use polhode::flow::{Flow, FreeBody, FreeMotion};
/// use polhode::inertia::Inertia;
/// let body = Body::free(Inertia::from_moments([1.0, 2.0, 3.0])?);
/// let start = body.state(UnitQuaternion::identity(), Vector3::new(0.4, 1.0, -0.3))?;
/// let mut x = body.enter(&start)?.to_f64();
/// FreeBody::new(&body.rotor()).flow(Time::from_seconds(0.0), 0.5, &mut x);
/// let exact = FreeMotion::from_state(body.inertia(), &start)?.at(0.5)?;
/// assert!(body.leave(&x).rotation().angle_to(&exact.rotation()) < 1e-13);
/// # Ok::<(), polhode::Error>(())
/// ```
#[derive(Clone, Copy, Debug)]
pub struct FreeBody<S> {
    moments: Vec3<S>,
}

impl<S: Precise> FreeBody<S> {
    /// The free flow of a body with the constants `rotor`.
    #[must_use]
    pub fn new(rotor: &Rotor) -> Self {
        FreeBody { moments: rotor.moments() }
    }
}

impl<S: Precise> Flow<S> for FreeBody<S> {
    fn flow(&self, _: Time, t: S, x: &mut Point<S>) {
        let (i, m) = (self.moments, x.momentum_body);
        let norm = m.norm();
        if norm == S::of(0.0) {
            return;
        }
        if !norm.magnitude().is_finite() {
            // no motion can be told: a run sees it diverge
            x.set_phase(Phase { attitude: x.attitude * S::of(f64::NAN), momentum_body: m });
            return;
        }
        let (turn, momentum_body) = match Polhode::of(i, m, norm, rounded_separation(i, m)) {
            Some(polhode) => {
                let circulation = Circulation::of(polhode, m);
                let near = circulation.is_near(t);
                if near { circulation.at(t) } else { circulation.with_period().at(t) }
            }
            None => {
                let (axis, rate) = steady(i, m, norm);
                (rotation(axis, rate * t), m)
            }
        };
        x.set_phase(Phase { attitude: x.attitude * turn, momentum_body });
    }
}

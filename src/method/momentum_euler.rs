//! `momentum-euler`: the step of game engines that keeps |m|.

use super::{Claimed, Claims, Cost, Kept, Map, Method};
use crate::body::{Field, Point, Problem, Rotor, Time};
use crate::num::{Dd, Real};
use crate::rotation::{Quat, Vec3};

/// Euler's step of the momentum, brought back to its length, and a turn by the new angular velocity.
///
/// Φ_h: `m₁ = (m + h m × I⁻¹m) |m|/|m + h m × I⁻¹m|`, `m' = m₁ + h τ`, `q' = q ∘ exp(h I⁻¹m')`: the gyroscopic force of Jolt
/// Physics (MotionProperties::ApplyGyroscopicForceInternal), which Avian takes too, before torque and turn. Keeps |m| of free
/// motion. Each step leaves the curve of constant energy on the sphere |m| outwards, away from the axes of the smallest and of
/// the largest moment, so that every motion ends next to the separatrix, with the energy |m|²/(2 I₂).
///
/// ```
/// use nalgebra::{UnitQuaternion, Vector3};
/// use polhode::body::Conserved;
/// use polhode::method::MomentumEuler;
/// use polhode::{Body, Inertia, Run};
/// let body = Body::free(Inertia::from_moments([1.0, 2.0, 3.0])?);
/// let start = body.state(UnitQuaternion::identity(), Vector3::new(1.5, 0.2, -0.1))?;
/// let end = Run::new(&MomentumEuler, &body, &start, 1.0 / 60.0)?.advance_to(60_000)?;
/// assert!(end.worst.of(Conserved::MomentumNorm).is_some_and(|error| error < 1e-12));
/// let separatrix = start.momentum().norm_squared() / (2.0 * 2.0);
/// assert!((end.energy / separatrix - 1.0).abs() < 0.05);
/// # Ok::<(), polhode::Error>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct MomentumEuler;

/// A prepared [`MomentumEuler`].
#[derive(Clone, Debug)]
pub struct MomentumEulerMap<S, F> {
    h: S,
    inverse_moments: Vec3<S>,
    field: F,
}

impl Claimed for MomentumEuler {
    fn name(&self) -> String {
        "momentum-euler".into()
    }
    fn claims(&self, problem: Problem) -> Option<Claims> {
        let kept = Kept { momentum_norm: problem == Problem::Free, norm: true, ..Kept::NOTHING };
        let cost = Cost::right_sides(1) + Cost::turns(1);
        Some(Claims::new(Some(1), kept, cost, "Jolt Physics, MotionProperties::ApplyGyroscopicForceInternal"))
    }
}

impl<S: Real> Method<S> for MomentumEuler {
    type Map<F: Field<S>> = MomentumEulerMap<S, F>;
    fn map<F: Field<S>>(&self, h: Dd, rotor: &Rotor, field: &F) -> MomentumEulerMap<S, F> {
        MomentumEulerMap { h: S::from_dd(h), inverse_moments: rotor.inverse_moments(), field: field.clone() }
    }
}

impl<S: Real, F: Field<S>> Map<S> for MomentumEulerMap<S, F> {
    fn apply(&mut self, at: Time, x: &mut Point<S>) {
        let m = x.momentum_body;
        let omega = m.times(self.inverse_moments);
        let straight = m + m.cross(omega) * self.h;
        let length = straight.norm();
        let mut new = if length.magnitude() == 0.0 { straight } else { straight * (m.norm() / length) };
        if F::ACTS {
            new = new + self.field.torque(at, x.attitude, omega) * self.h;
        }
        x.momentum_body = new;
        let turn = Quat::exponential(new.times(self.inverse_moments) * self.h);
        x.attitude = (x.attitude * turn).normalized();
    }
}

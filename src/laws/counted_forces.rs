//! Forces that count how often their torque is asked for.

use core::sync::atomic::{AtomicU64, Ordering};
use std::sync::Arc;

use super::counted::{Counted, count_torque};
use crate::body::{Conserved, Field, LinearPotential, Potential, Time, Torque};
use crate::num::Real;
use crate::rotation::{Quat, Vec3};

/// Gravity that counts how often its torque is asked for.
#[derive(Clone, Copy, Debug)]
pub(super) struct CountedGravity(pub(super) LinearPotential<Counted>);

impl Field<Counted> for CountedGravity {
    const HAS_REMAINDER: bool = false;
    fn linear_part(&self) -> Option<&LinearPotential<Counted>> {
        Some(&self.0)
    }
    fn remainder(&self, _: Time, _: Quat<Counted>, _: Vec3<Counted>) -> Vec3<Counted> {
        Vec3::zero()
    }
    fn torque(&self, _: Time, attitude: Quat<Counted>, _: Vec3<Counted>) -> Vec3<Counted> {
        count_torque();
        self.0.torque(attitude)
    }
}

/// A law that counts how often its torque is asked for, of a method whose type is not known.
pub(super) struct CountedLaw<L> {
    pub(super) law: L,
    pub(super) torques: Arc<AtomicU64>,
}

impl<S: Real, P: Potential<S>> Potential<S> for CountedLaw<P> {
    fn energy(&self, at: Time, attitude: Quat<S>) -> S {
        self.law.energy(at, attitude)
    }
    fn torque(&self, at: Time, attitude: Quat<S>) -> Vec3<S> {
        self.torques.fetch_add(1, Ordering::Relaxed);
        self.law.torque(at, attitude)
    }
    fn conserved(&self) -> Vec<Conserved> {
        self.law.conserved()
    }
}

impl<S: Real, T: Torque<S>> Torque<S> for CountedLaw<T> {
    fn torque(&self, at: Time, attitude: Quat<S>, omega_body: Vec3<S>) -> Vec3<S> {
        self.torques.fetch_add(1, Ordering::Relaxed);
        self.law.torque(at, attitude, omega_body)
    }
}

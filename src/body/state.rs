//! The state of rotation.

use core::ops::{Add, Mul};

use nalgebra::{UnitQuaternion, Vector3};

use crate::num::Real;
use crate::rotation::{Quat, Vec3};

/// Attitude and angular momentum.
///
/// The momentum, not the angular velocity, is the variable: |m| is the Casimir of the Lie–Poisson bracket, kicks
/// add to it, and the momentum in space is one product, `L = q m q*`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct State<S> {
    /// Unit quaternion, scalar first, active, body → space.
    pub attitude: Quat<S>,
    /// Angular momentum `m = I ω` in body axes.
    pub momentum_body: Vec3<S>,
}

impl<S: Real> State<S> {
    /// The same numbers in another scalar.
    pub fn of(x: State<f64>) -> Self {
        State { attitude: Quat::of(x.attitude), momentum_body: Vec3::of(x.momentum_body) }
    }

    /// Angular momentum in space, `L = q m q*`.
    #[inline]
    pub fn momentum_space(&self) -> Vec3<S> {
        self.attitude.rotate(self.momentum_body)
    }

    /// The zero increment.
    #[inline]
    pub fn zero() -> Self {
        State { attitude: Quat::zero(), momentum_body: Vec3::zero() }
    }

    /// The largest |component| as `f64`; NaN if one is NaN.
    pub fn magnitude(&self) -> f64 {
        let (q, m) = (self.attitude.magnitude(), self.momentum_body.magnitude());
        if q.is_nan() || m.is_nan() { f64::NAN } else { q.max(m) }
    }
}

impl<S: Real> Add for State<S> {
    type Output = Self;
    #[inline]
    fn add(self, b: Self) -> Self {
        State { attitude: self.attitude + b.attitude, momentum_body: self.momentum_body + b.momentum_body }
    }
}
impl<S: Real> Mul<S> for State<S> {
    type Output = Self;
    #[inline]
    fn mul(self, k: S) -> Self {
        State { attitude: self.attitude * k, momentum_body: self.momentum_body * k }
    }
}

impl State<f64> {
    /// The attitude as a nalgebra rotation, normalised.
    pub fn rotation(&self) -> UnitQuaternion<f64> {
        self.attitude.into()
    }

    /// Angular momentum in body axes as a nalgebra vector.
    pub fn momentum(&self) -> Vector3<f64> {
        self.momentum_body.into()
    }

    /// Whether every component is a finite number.
    pub fn is_finite(&self) -> bool {
        self.magnitude().is_finite()
    }
}

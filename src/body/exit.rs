//! Readings of a point in the axes and units of a body.

use nalgebra::Vector3;

use super::{Body, Phase, State};
use crate::num::Precise;
use crate::rotation::{Quat, Vec3};

/// What takes points of the solver frame back to body axes and SI units, each constant rounded once.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Exit<S> {
    /// Takes coordinates along the principal axes to body axes, where those differ.
    frame: Option<Quat<S>>,
    scale: f64,
}

impl<S: Precise> Exit<S> {
    pub(crate) fn of(body: &Body) -> Self {
        let inertia = body.inertia();
        let frame = (!inertia.is_along_principal_axes()).then(|| inertia.frame().map(S::from_dd));
        Exit { frame, scale: inertia.scale() }
    }

    /// The point `x` as a state.
    #[inline(always)]
    pub(crate) fn state(&self, x: Phase<S>) -> State {
        let Phase { mut attitude, momentum_body: mut momentum } = x;
        if let Some(frame) = self.frame {
            attitude = attitude * frame.conjugate();
            momentum = frame.rotate(momentum);
        }
        State { attitude: attitude.map(S::to_f64), momentum_body: momentum.map(|m| m.to_f64() * self.scale) }
    }

    /// The angular velocity of the momentum `m`, rad/s.
    #[inline(always)]
    pub(crate) fn omega(&self, inverse_moments: Vec3<S>, m: Vec3<S>) -> Vector3<f64> {
        let mut omega = m.times(inverse_moments);
        if let Some(frame) = self.frame {
            omega = frame.rotate(omega);
        }
        omega.map(S::to_f64).into()
    }
}

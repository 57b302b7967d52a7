//! Drag: a torque against the angular velocity.

use super::force::finite;
use super::{Force, ForceError, Time, Torque};
use crate::num::Real;
use crate::rotation::{Quat, Vec3};

/// τ = −c₁ ω − c₂ |ω| ω.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Drag {
    pub(crate) linear: f64,
    pub(crate) quadratic: f64,
}

impl Force {
    /// Drag of a body in a fluid at rest, τ = −c₁ ω − c₂ |ω| ω, with c₁ = `linear`, N m s, and c₂ = `quadratic`, N m s².
    ///
    /// # Errors
    /// Coefficients that are negative or not finite.
    pub fn drag(linear: f64, quadratic: f64) -> Result<Self, ForceError> {
        const NAME: &str = "drag";
        for (quantity, value) in [("c1", linear), ("c2", quadratic)] {
            if finite(NAME, quantity, value)? < 0.0 {
                return Err(ForceError::Negative { force: NAME, quantity, value });
            }
        }
        let drag = Drag { linear, quadratic };
        Ok(Force { drag: Some(drag), ..Force::torque(NAME, drag) })
    }
}

impl<S: Real> Torque<S> for Drag {
    fn torque(&self, _: Time, _: Quat<S>, omega_body: Vec3<S>) -> Vec3<S> {
        if self.quadratic == 0.0 { self.of::<false, S>(omega_body) } else { self.of::<true, S>(omega_body) }
    }
}

impl Drag {
    /// The torque, where it is known whether c₂ is zero.
    #[inline(always)]
    pub(crate) fn of<const QUADRATIC: bool, S: Real>(&self, omega_body: Vec3<S>) -> Vec3<S> {
        let mut coefficient = S::of(self.linear);
        if QUADRATIC {
            coefficient = coefficient + S::of(self.quadratic) * omega_body.norm();
        }
        -(omega_body * coefficient)
    }
}

//! Uniform gravity on a body with a fixed point.

use crate::num::Real;
use crate::rotation::{Quat, Vec3};

/// The vertical in body axes, Γ = Qᵀ e_z, upwards; as long as |q|².
#[inline]
pub fn vertical<S: Real>(attitude: Quat<S>) -> Vec3<S> {
    let (w, Vec3([x, y, z])) = (attitude.w, attitude.v);
    let two = S::of(2.0);
    Vec3([two * (x * z - w * y), two * (y * z + w * x), (w * w + z * z) - (x * x + y * y)])
}

/// Uniform gravity along −Z of space, on a body whose origin is fixed.
///
/// The weight moment c is the weight M g times the centre of mass, in the axes of the attitude: for
/// [`Body::gravity`](super::Body::gravity) the principal axes, and in N m divided by the scale.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Gravity<S> {
    /// Weight moment c in body axes.
    pub weight_moment: Vec3<S>,
}

impl<S: Real> Gravity<S> {
    /// Potential energy U = c·Γ.
    #[inline]
    pub fn potential(&self, attitude: Quat<S>) -> S {
        self.weight_moment.dot(vertical(attitude))
    }

    /// Torque Γ × c in body axes: it has no part along the vertical.
    #[inline]
    pub fn torque(&self, attitude: Quat<S>) -> Vec3<S> {
        vertical(attitude).cross(self.weight_moment)
    }

    /// What a turn of the body changes in τᵀI⁻¹τ, τ the torque: its derivative with respect to the angle about each body axis,
    /// `2 (c × I⁻¹τ) × Γ`; moments as of the weight moment.
    #[inline]
    pub(crate) fn gradient_of_squared_torque(&self, inverse_moments: Vec3<S>, attitude: Quat<S>) -> Vec3<S> {
        let up = vertical(attitude);
        let rate = up.cross(self.weight_moment).times(inverse_moments);
        self.weight_moment.cross(rate).cross(up) * S::of(2.0)
    }
}

//! Potentials that are linear in the vertical, as that of uniform gravity.

use crate::num::Real;
use crate::rotation::{Quat, Vec3};

/// The vertical in body axes, Γ = Qᵀ e_z, upwards; as long as |q|².
///
/// ```
/// use polhode::body::vertical;
/// use polhode::rotation::{Quat, Vec3};
/// let quarter = Quat::exponential(Vec3([core::f64::consts::FRAC_PI_2, 0.0, 0.0])); // about x: y points upwards
/// assert!((vertical(quarter) - Vec3::unit(1)).norm() < 1e-15);
/// ```
#[inline]
pub fn vertical<S: Real>(attitude: Quat<S>) -> Vec3<S> {
    let (w, Vec3([x, y, z])) = (attitude.w, attitude.v);
    // twice the numbers and not the sums, which are waited for: the bits are the same
    let (twice_w, twice_z) = (w + w, z + z);
    Vec3([x * twice_z - twice_w * y, y * twice_z + twice_w * x, (w * w + z * z) - (x * x + y * y)])
}

/// A potential U = c·Γ that is linear in the vertical Γ = Qᵀ e_z, with a constant moment c in body axes.
///
/// For uniform gravity along −Z of space c is the weight M g times the centre of mass. The moment is in the axes of the
/// attitude: of [`Body::linear_potential`](super::Body::linear_potential) the principal axes, and in N m divided by the scale.
/// As Γ is quadratic in q and turns with the body, methods have closed forms for it that they lack for other forces.
///
/// ```
/// use polhode::body::LinearPotential;
/// use polhode::rotation::{Quat, Vec3};
/// let top = LinearPotential { moment: Vec3([0.0, 0.0, 2.0]) };
/// let lying = Quat::exponential(Vec3([core::f64::consts::FRAC_PI_2, 0.0, 0.0])); // a quarter turn about x
/// assert_eq!(top.energy(Quat::identity()), 2.0);
/// assert!(top.energy(lying).abs() < 1e-14);
/// assert!((top.torque(lying) - Vec3([2.0, 0.0, 0.0])).norm() < 1e-14); // it falls further
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LinearPotential<S> {
    /// Moment c in body axes.
    pub moment: Vec3<S>,
}

impl<S: Real> LinearPotential<S> {
    /// Potential energy U = c·Γ.
    #[inline]
    pub fn energy(&self, attitude: Quat<S>) -> S {
        self.moment.dot(vertical(attitude))
    }

    /// Torque Γ × c in body axes: it has no part along the vertical.
    #[inline]
    pub fn torque(&self, attitude: Quat<S>) -> Vec3<S> {
        vertical(attitude).cross(self.moment)
    }

    /// What a turn of the body changes in τᵀI⁻¹τ, τ the torque: its derivative with respect to the angle about each body axis,
    /// `2 (c × I⁻¹τ) × Γ`; moments as of c.
    #[inline]
    pub(crate) fn gradient_of_squared_torque(&self, inverse_moments: Vec3<S>, attitude: Quat<S>) -> Vec3<S> {
        let up = vertical(attitude);
        let rate = up.cross(self.moment).times(inverse_moments);
        self.moment.cross(rate).cross(up) * S::of(2.0)
    }
}

//! Uniform gravity on a body with a fixed point.

use nalgebra::Vector3;

use super::force::{Role, finite};
use super::{Conserved, Force, ForceError, Potential, Time};
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

impl Force {
    /// Uniform gravity along −Z of space on a body with a fixed point, the origin.
    ///
    /// `weight_moment` is the weight M g times the centre of mass, N m, in body axes; the inertia of the body is then about the
    /// fixed point. U = c·Γ and τ = Γ × c, Γ = Qᵀ e_z. Energy and L_z are conserved. [`Body::heavy`](super::Body::heavy) is the
    /// short form.
    ///
    /// # Errors
    /// Components that are not finite.
    ///
    /// ```
    /// use nalgebra::{UnitQuaternion, Vector3};
    /// use polhode::body::{Body, Force, Problem};
    /// use polhode::inertia::Inertia;
    /// let weight = Force::gravity(Vector3::new(0.0, 0.0, 2.0))?;
    /// let top = Body::free(Inertia::from_moments([1.0, 1.0, 0.25])?).with(weight);
    /// let start = top.state(UnitQuaternion::identity(), Vector3::new(0.0, 0.0, 4.0))?;
    /// assert_eq!((top.problem(), top.energy(&start)), (Problem::Gravity, 4.0)); // 2 J of spin, 2 J of height
    /// # Ok::<(), polhode::Error>(())
    /// ```
    pub fn gravity(weight_moment: Vector3<f64>) -> Result<Self, ForceError> {
        const NAME: &str = "uniform gravity";
        for component in weight_moment.iter() {
            finite(NAME, "a component of the weight moment", *component)?;
        }
        let weight_moment = Vec3::from(weight_moment);
        Ok(Force::potential(NAME, Uniform(weight_moment)).taking(Role::Gravity(weight_moment)))
    }
}

/// Uniform gravity in SI units and body axes, by the weight moment.
struct Uniform(Vec3<f64>);

impl<S: Real> Potential<S> for Uniform {
    fn energy(&self, _: Time, attitude: Quat<S>) -> S {
        Gravity { weight_moment: Vec3::of(self.0) }.potential(attitude)
    }
    fn torque(&self, _: Time, attitude: Quat<S>) -> Vec3<S> {
        Gravity { weight_moment: Vec3::of(self.0) }.torque(attitude)
    }
    fn conserved(&self) -> Vec<Conserved> {
        vec![Conserved::Energy, Conserved::MomentumZ]
    }
}

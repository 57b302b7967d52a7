//! Uniform gravity on a body with a fixed point.

use nalgebra::Vector3;

use super::force::finite;
use super::{Conserved, Force, ForceError, LinearPotential, Potential, Time};
use crate::num::Real;
use crate::rotation::{Quat, Vec3};

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
    /// assert_eq!((top.problem(), top.energy(&start)), (Problem::Linear, 4.0)); // 2 J of spin, 2 J of height
    /// # Ok::<(), polhode::Error>(())
    /// ```
    pub fn gravity(weight_moment: Vector3<f64>) -> Result<Self, ForceError> {
        for component in weight_moment.iter() {
            finite("uniform gravity", "a component of the weight moment", *component)?;
        }
        Ok(Force::potential("gravity", Gravity { weight_moment: Vec3::from(weight_moment) }))
    }
}

/// Uniform gravity in SI units and body axes.
struct Gravity {
    weight_moment: Vec3<f64>,
}

impl<S: Real> Potential<S> for Gravity {
    fn energy(&self, _: Time, attitude: Quat<S>) -> S {
        LinearPotential { moment: Vec3::of(self.weight_moment) }.energy(attitude)
    }
    fn torque(&self, _: Time, attitude: Quat<S>) -> Vec3<S> {
        LinearPotential { moment: Vec3::of(self.weight_moment) }.torque(attitude)
    }
    fn conserved(&self) -> Vec<Conserved> {
        vec![Conserved::Energy, Conserved::MomentumZ]
    }
    fn linear_moment(&self) -> Option<Vec3<f64>> {
        Some(self.weight_moment)
    }
}

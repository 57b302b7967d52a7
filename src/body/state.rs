//! The state of rotation that users hold.

use nalgebra::{UnitQuaternion, Vector3};

use crate::rotation::{Quat, Vec3};

/// Attitude and angular momentum in SI units, or any consistent ones, and in the body axes that the inertia was given in.
///
/// A [`Body`](super::Body) makes one from an angular velocity and reads energy and angular velocity off it.
///
/// ```
/// use nalgebra::{UnitQuaternion, Vector3};
/// use polhode::body::Body;
/// use polhode::inertia::Inertia;
/// let body = Body::free(Inertia::from_moments([10.0, 20.0, 30.0])?);
/// let start = body.state(UnitQuaternion::identity(), Vector3::new(0.5, 1.0, -0.25))?;
/// assert_eq!(start.momentum(), Vector3::new(5.0, 20.0, -7.5));
/// assert_eq!(body.omega_body(&start), Vector3::new(0.5, 1.0, -0.25));
/// assert_eq!(body.energy(&start), 12.1875);
/// # Ok::<(), polhode::Error>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[must_use]
pub struct State {
    /// Unit quaternion, scalar first, active, body → space.
    pub attitude: Quat<f64>,
    /// Angular momentum `m = I ω` in body axes, kg m²/s, without that of [wheels](super::Wheel).
    pub momentum_body: Vec3<f64>,
}

impl State {
    /// The attitude as a nalgebra rotation, normalised.
    #[must_use]
    pub fn rotation(&self) -> UnitQuaternion<f64> {
        self.attitude.into()
    }

    /// Angular momentum in body axes as a nalgebra vector, kg m²/s.
    #[must_use]
    pub fn momentum(&self) -> Vector3<f64> {
        self.momentum_body.into()
    }

    /// Angular momentum in space, `L = q m q*` with q of norm 1, kg m²/s; [`Body::momentum_space`](super::Body::momentum_space) adds that of
    /// wheels.
    #[must_use]
    pub fn momentum_space(&self) -> Vector3<f64> {
        self.rotation() * self.momentum()
    }

    /// Whether every component is a finite number.
    pub fn is_finite(&self) -> bool {
        let mut components = self.attitude.components().into_iter().chain(self.momentum_body.0);
        components.all(f64::is_finite)
    }
}

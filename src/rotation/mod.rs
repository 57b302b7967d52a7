//! Rotations: vectors and quaternions that kernels are written over, and distances between attitudes.
//!
//! Attitudes are unit quaternions, **scalar first, active, body → space**: `v_space = q v_body q*`.
//! Increments multiply on the right: `q ← q ∘ p`.

mod celestial;
mod directions;
mod dispersion;
mod distance;
mod euler;
mod quaternion;
mod vec3;

pub use celestial::CelestialFrame;
pub use directions::Directions;
pub use dispersion::Dispersion;
pub use distance::rotation_angle;
pub use euler::{EulerAngles, EulerSequence, EulerSequenceError};
pub use quaternion::Quat;
pub(crate) use vec3::AXES;
pub use vec3::Vec3;

//! What gives the absolute size.

use nalgebra::Vector3;

/// A quantity that is known besides the motion, in SI units: it gives the tensor its scale.
///
/// ```
/// use nalgebra::Vector3;
/// use polhode_fit::{Known, Settings};
/// // from a pendulum: the moment about the z axis, kg m²
/// let known = Known::Moment { axis: Vector3::z(), value: 2.4e-3 };
/// let settings = Settings::default().with_known(known);
/// assert_eq!(settings.known, Some(known));
/// ```
#[non_exhaustive]
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Known {
    /// The magnitude |L| of the angular momentum of every segment, at its start where torques act at random, kg m²/s.
    Momentum(f64),
    /// Twice the kinetic energy of every segment, at its start where torques act at random, kg m²/s².
    TwiceEnergy(f64),
    /// The moment about an axis (any non-zero vector in sensor axes), kg m².
    Moment {
        /// Any non-zero vector along the axis, sensor axes.
        axis: Vector3<f64>,
        /// The moment, kg m².
        value: f64,
    },
    /// The trace of the tensor, kg m².
    Trace(f64),
}

impl Known {
    /// The given value.
    pub(crate) fn value(self) -> f64 {
        match self {
            Known::Momentum(v) | Known::TwiceEnergy(v) | Known::Trace(v) | Known::Moment { value: v, .. } => {
                v
            }
        }
    }
}

//! The mean of many directions and how far they are spread about it.

use super::Vec3;
use crate::num::Precise;

/// Mean and spread of many directions, such as that to an observer in the axes of many bodies.
///
/// The mean is the direction of the sum of unit vectors. The same directions in the same order give the same bits.
///
/// ```
/// use polhode::rotation::{Directions, Vec3};
/// let about_z: Vec<_> = [-0.002, 0.0, 0.002].map(|tilt| Vec3([tilt, 0.0, 1.0])).into();
/// let spread = Directions::of(&about_z).ok_or("no direction")?;
/// assert_eq!(spread.mean(), Vec3([0.0, 0.0, 1.0]));
/// assert!((spread.quantile(1.0) - 0.002).abs() < 1e-8);
/// # Ok::<(), &str>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
#[must_use]
pub struct Directions {
    mean: Vec3<f64>,
    /// Ascending.
    angles: Vec<f64>,
}

impl Directions {
    /// Of vectors of any lengths from 1e-130 to 1e130, beyond which squares leave the range of a double; `None` where there is none, or
    /// where their directions add up to zero.
    #[must_use]
    pub fn of(vectors: &[Vec3<f64>]) -> Option<Self> {
        let unit = |vector: &Vec3<f64>| *vector * (1.0 / vector.norm());
        let sum = vectors.iter().fold(Vec3([0.0; 3]), |sum, vector| sum + unit(vector));
        let length = sum.norm();
        // what rounding leaves of directions that cancel is no direction, and NaN is none either
        if length.is_nan() || length <= 1e-15 * vectors.len() as f64 {
            return None;
        }
        let mean = sum * (1.0 / length);
        let angle = |vector: &Vec3<f64>| Precise::atan2(mean.cross(*vector).norm(), mean.dot(*vector));
        let mut angles: Vec<f64> = vectors.iter().map(angle).collect();
        angles.sort_unstable_by(f64::total_cmp);
        Some(Directions { mean, angles })
    }

    /// The mean direction, of length 1.
    pub fn mean(&self) -> Vec3<f64> {
        self.mean
    }

    /// The smallest of the angles to the mean, rad, that at least the share `p` of them does not exceed.
    #[must_use]
    pub fn quantile(&self, p: f64) -> f64 {
        let rank = libm::ceil(p * self.angles.len() as f64) as usize;
        self.angles[rank.clamp(1, self.angles.len()) - 1]
    }
}

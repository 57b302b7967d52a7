//! The mean of many attitudes and how far they are spread about it.

use super::{Quat, Vec3, rotation_angle};
use crate::num::eigen::eigen;

/// Terms of one partial sum; of many numbers the sum of partial sums rounds less.
const CHUNK: usize = 1024;

/// Mean and spread of many attitudes.
///
/// The mean is the chordal one: it minimises Σ ‖R(q) − R(q_k)‖², and is the eigenvector with the largest eigenvalue of
/// Σ q_k q_kᵀ, whatever the signs of the quaternions are. Angles and rotation vectors are from it to each attitude. The same
/// attitudes in the same order give the same bits.
///
/// ```
/// use polhode::rotation::{Dispersion, Quat};
/// let turned = |angle: f64| Quat::from_components([1.0, 0.0, 0.0, 0.5 * angle]).normalized();
/// let about_z: Vec<_> = [-0.002, -0.001, 0.001, 0.002].map(turned).into();
/// let spread = Dispersion::of(&about_z).ok_or("no attitudes")?;
/// assert!((spread.quantile(0.5) - 0.001).abs() < 1e-9 && (spread.largest() - 0.002).abs() < 1e-9);
/// assert_eq!(spread.axes()[0].0[2].abs(), 1.0); // all of it about the third axis
/// # Ok::<(), &str>(())
/// ```
///
/// Source: F. L. Markley, Y. Cheng, J. L. Crassidis and Y. Oshman, Averaging quaternions, Journal of Guidance, Control, and
/// Dynamics 30 (2007) 1193–1197, eqs. (12) and (13).
#[derive(Clone, Debug, PartialEq)]
#[must_use]
pub struct Dispersion {
    mean: Quat<f64>,
    /// Ascending.
    angles: Vec<f64>,
    root_mean_square: f64,
    deviations: [f64; 3],
    axes: [Vec3<f64>; 3],
}

impl Dispersion {
    /// Of attitudes of norm 1; `None` where there is none.
    #[must_use]
    pub fn of(attitudes: &[Quat<f64>]) -> Option<Self> {
        let count = attitudes.len() as f64;
        if attitudes.is_empty() {
            return None;
        }
        let products = sum(attitudes, |q| {
            let c = q.components();
            [[0, 0], [0, 1], [0, 2], [0, 3], [1, 1], [1, 2], [1, 3], [2, 2], [2, 3], [3, 3]]
                .map(|[i, j]| c[i] * c[j])
        });
        let [a, b, c, d, e, f, g, h, i, j] = products.map(|sum| sum / count);
        let (_, vectors) = eigen([[a, b, c, d], [b, e, f, g], [c, f, h, i], [d, g, i, j]]);
        let first = Quat::from_components(vectors[3]).normalized();
        let mean = if first.w < 0.0 { -first } else { first };

        let mut angles: Vec<f64> = attitudes.iter().map(|q| rotation_angle(mean, *q)).collect();
        let [squares] = sum(&angles, |angle| [angle * angle]);
        angles.sort_unstable_by(f64::total_cmp);

        let moments = sum(attitudes, |q| {
            let Vec3([x, y, z]) = (*q * mean.conjugate()).logarithm();
            [x * x, x * y, x * z, y * y, y * z, z * z]
        });
        // the mean is that of the attitudes themselves, and takes one of them; one alone has no spread
        let [xx, xy, xz, yy, yz, zz] = moments.map(|sum| sum / (count - 1.0).max(1.0));
        let (variances, axes) = eigen([[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]]);
        let ordered = [2, 1, 0];
        Some(Dispersion {
            mean,
            angles,
            root_mean_square: (squares / count).sqrt(),
            deviations: ordered.map(|k| variances[k].max(0.0).sqrt()),
            axes: ordered.map(|k| pointed(Vec3(axes[k]))),
        })
    }

    /// The mean attitude, of norm 1 and with w ≥ 0.
    pub fn mean(&self) -> Quat<f64> {
        self.mean
    }

    /// How many attitudes there are.
    #[must_use]
    pub fn count(&self) -> usize {
        self.angles.len()
    }

    /// Root mean square of the angles to the mean, rad.
    #[must_use]
    pub fn root_mean_square(&self) -> f64 {
        self.root_mean_square
    }

    /// The smallest of the angles, rad, that at least the share `p` of them does not exceed.
    #[must_use]
    pub fn quantile(&self, p: f64) -> f64 {
        let rank = libm::ceil(p * self.angles.len() as f64) as usize;
        self.angles[rank.clamp(1, self.angles.len()) - 1]
    }

    /// The largest angle, rad.
    #[must_use]
    pub fn largest(&self) -> f64 {
        self.quantile(1.0)
    }

    /// Standard deviations about the [axes](Self::axes), rad, descending, as of a sample: square roots of the eigenvalues of
    /// Σ v vᵀ/(n − 1), v the rotation vectors from the mean. The variances carry the rounding of the largest.
    #[must_use]
    pub fn deviations(&self) -> [f64; 3] {
        self.deviations
    }

    /// The principal directions of the rotation vectors, unit vectors in the axes of space; of each the largest component is
    /// positive.
    pub fn axes(&self) -> [Vec3<f64>; 3] {
        self.axes
    }
}

/// Sums of the terms of each item, in a fixed order.
fn sum<T, const N: usize>(items: &[T], terms: impl Fn(&T) -> [f64; N]) -> [f64; N] {
    let add = |mut sum: [f64; N], terms: [f64; N]| {
        sum.iter_mut().zip(terms).for_each(|(sum, term)| *sum += term);
        sum
    };
    let partial = items.chunks(CHUNK).map(|chunk| chunk.iter().map(&terms).fold([0.0; N], add));
    partial.fold([0.0; N], add)
}

/// The vector or its opposite, whichever has its largest component positive.
fn pointed(v: Vec3<f64>) -> Vec3<f64> {
    let largest = v.0.into_iter().fold(0.0_f64, |most, x| if x.abs() > most.abs() { x } else { most });
    if largest < 0.0 { v * -1.0 } else { v }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The attitude `mean`, turned by a rotation vector in the axes of space.
    fn about(mean: Quat<f64>, vector: [f64; 3]) -> Quat<f64> {
        let half = Vec3(vector) * 0.5;
        let angle = half.norm();
        let (sin, cos) = (libm::sin(angle), libm::cos(angle));
        Quat::new(cos, if angle == 0.0 { half } else { half * (sin / angle) }) * mean
    }

    fn mean() -> Quat<f64> {
        Quat::from_components([0.3, -0.5, 0.7, 0.2]).normalized()
    }

    #[test]
    fn a_symmetric_cross_has_its_centre_as_mean_and_its_arms_as_axes() {
        // three pairs of opposite rotation vectors along orthogonal directions (1,4,8)/9, (4,7,−4)/9, (8,−4,1)/9
        let arms = [[1.0, 4.0, 8.0], [4.0, 7.0, -4.0], [8.0, -4.0, 1.0]];
        let lengths = [0.3, 0.02, 1e-5];
        let mut attitudes = Vec::new();
        for (arm, length) in arms.iter().zip(lengths) {
            for sign in [1.0, -1.0] {
                let q = about(mean(), arm.map(|x| x / 9.0 * length * sign));
                attitudes.push(if sign > 0.0 { q } else { -q }); // q and −q are one attitude
            }
        }
        let spread = Dispersion::of(&attitudes).unwrap();
        assert!(rotation_angle(spread.mean(), mean()) < 1e-15);
        for (k, length) in lengths.into_iter().enumerate() {
            // two of six vectors have this component, of which the mean takes one
            let expected = length * 0.4_f64.sqrt();
            // variances carry the rounding of the largest
            let rounding = f64::EPSILON * (lengths[0] / length) * (lengths[0] / length) + 1e-14;
            let error = (spread.deviations()[k] / expected - 1.0).abs();
            assert!(error < rounding, "{k}: {error:e}, {:?}", spread.deviations());
            let along = spread.axes()[k].dot(Vec3(arms[k].map(|x| x / 9.0)));
            assert!((along - 1.0).abs() < 1e-9, "{k}: {along}");
        }
        let rms = ((0.09 + 0.0004 + 1e-10) / 3.0_f64).sqrt();
        assert!((spread.root_mean_square() - rms).abs() < 1e-14);
        for (p, angle) in
            [(0.0, 1e-5), (1.0 / 3.0, 1e-5), (0.34, 0.02), (2.0 / 3.0, 0.02), (0.67, 0.3), (1.0, 0.3)]
        {
            assert!((spread.quantile(p) - angle).abs() < 1e-14, "{p}");
        }
    }

    #[test]
    fn two_attitudes_have_the_turn_of_half_the_angle_as_mean() {
        // up to nearly half a turn apart, where the mean is still unique
        for angle in [1e-12, 1e-3, 1.0, 3.0] {
            let both = [about(mean(), [0.0, 0.0, 0.0]), about(mean(), [0.0, angle, 0.0])];
            let spread = Dispersion::of(&both).unwrap();
            assert!(rotation_angle(spread.mean(), about(mean(), [0.0, 0.5 * angle, 0.0])) < 2e-15, "{angle}");
            assert!((spread.largest() - 0.5 * angle).abs() < 1e-15 + 1e-15 * angle, "{angle}");
        }
        let one = Dispersion::of(&[mean()]).unwrap();
        assert!(one.largest() < 1e-15 && one.count() == 1 && one.deviations()[0] < 1e-15);
        assert_eq!(Dispersion::of(&[]), None);
    }
}

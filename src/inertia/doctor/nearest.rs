//! The nearest physically valid tensor.

use nalgebra::Matrix3;

use crate::inertia::symmetric::Spectrum;
use crate::num::{Dd, Real};
use crate::rotation::Vec3;

/// The projection of a finite matrix onto the cone ½ tr(I)·1 − I ⪰ 0 of symmetric tensors, and the distance to it,
/// both in Frobenius norm.
///
/// The antisymmetric part is orthogonal to every symmetric tensor, and the norm and the cone are invariant under
/// rotations, so the axes stay and the moments are projected onto the cone of the triangle inequalities.
pub(super) fn nearest_valid(matrix: &Matrix3<f64>) -> (Matrix3<f64>, f64) {
    let spectrum = Spectrum::of_finite(matrix);
    let projected = project(spectrum.moments);
    let shifts = [0, 1, 2].map(|k| projected[k] - spectrum.moments[k]);
    let scaled = matrix / spectrum.scale;
    let entry = |i: usize, j: usize| {
        // what is valid keeps its digits: only the shifts of the moments are added
        let mut sum = Dd::sum(0.5 * scaled[(i, j)], 0.5 * scaled[(j, i)]);
        for (shift, axis) in shifts.iter().zip(spectrum.axes) {
            sum = sum + *shift * axis[i] * axis[j];
        }
        sum.hi()
    };
    let is_tip = projected[2] == Dd::ZERO;
    let nearest = if is_tip { Matrix3::zeros() } else { Matrix3::from_fn(|i, j| entry(i.min(j), i.max(j))) };
    let skew = (scaled - scaled.transpose()) * 0.5;
    let distance = (skew.norm_squared() + Vec3(shifts).norm_squared().hi()).sqrt();
    (nearest * spectrum.scale, distance * spectrum.scale)
}

/// Ascending moments onto the cone of the triangle inequalities.
///
/// The cone is symmetric in its axes, so the order is kept, and of ascending moments only I₁ + I₂ ≥ I₃ can fail: the
/// foot is on that face, or on the ray (0, t, t) where it meets the next one (a rod), or at the tip (a point).
fn project([a, b, c]: [Dd; 3]) -> [Dd; 3] {
    let lack = c - a - b;
    if lack <= Dd::ZERO {
        return [a, b, c];
    }
    let third = lack / Dd::of(3.0);
    let face = [a + third, b + third, c - third];
    if face[0] >= Dd::ZERO {
        return face;
    }
    let half = (b + c) * Dd::of(0.5);
    let length = if half > Dd::ZERO { half } else { Dd::ZERO };
    [Dd::ZERO, length, length]
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The nearest of many points of the cone, spanned by its three rays with non-negative weights.
    fn search(moments: [f64; 3]) -> f64 {
        let distance = |w: [f64; 3]| {
            let point = [w[1] + w[2], w[0] + w[2], w[0] + w[1]];
            (0..3).map(|k| (point[k] - moments[k]) * (point[k] - moments[k])).sum::<f64>()
        };
        let mut w = [1.0; 3];
        // exact minimisation along one weight at a time converges, as the problem is convex and the bounds separate
        for _ in 0..200 {
            for k in 0..3 {
                let (i, j) = ((k + 1) % 3, (k + 2) % 3);
                let best = 0.5 * ((moments[i] - w[j]) + (moments[j] - w[i]));
                w[k] = best.max(0.0);
            }
        }
        distance(w).sqrt()
    }

    #[test]
    fn the_projection_is_the_nearest_point_of_the_cone() {
        let sides = [-2.0, -0.7, -0.1, 0.0, 0.3, 1.0, 2.5];
        for a in sides {
            for b in sides {
                for c in sides {
                    let mut moments = [a, b, c];
                    moments.sort_by(f64::total_cmp);
                    let matrix = Matrix3::from_diagonal(&moments.into());
                    let (nearest, distance) = nearest_valid(&matrix);
                    let expected = search(moments);
                    assert!((distance - expected).abs() < 1e-12, "{moments:?}: {distance} {expected}");
                    assert!(((nearest - matrix).norm() - distance).abs() < 1e-14);
                    let [x, y, z] = [0, 1, 2].map(|k| nearest[(k, k)]);
                    assert!((x + y - z).min(x + z - y).min(y + z - x) > -1e-14);
                }
            }
        }
    }

    #[test]
    fn the_antisymmetric_part_counts_as_distance() {
        let matrix = Matrix3::new(2.0, 0.3, 0.0, 0.1, 3.0, 0.0, 0.0, 0.0, 4.0);
        let (nearest, distance) = nearest_valid(&matrix);
        assert_eq!((nearest[(0, 1)], nearest[(1, 0)]), (0.2, 0.2));
        assert!((distance - 0.1 * 2.0_f64.sqrt()).abs() < 1e-15);
    }
}

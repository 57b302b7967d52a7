//! Principal axes of a symmetric tensor: eigenvectors with deterministic signs, right-handed.

use crate::num::Precise;
use crate::num::eigen::eigen;
use crate::rotation::{Quat, Vec3};

/// Eigenvalues, ascending, and eigenvectors, right-handed, of the symmetric matrix `a`.
///
/// Of the first two vectors the component of largest size is positive; the third closes the right-handed frame.
pub(super) fn principal_axes<S: Precise>(a: [[S; 3]; 3]) -> ([S; 3], [Vec3<S>; 3]) {
    let (moments, [first, second, _]) = eigen(a);
    let (first, second) = (positive(Vec3(first)), positive(Vec3(second)));
    (moments, [first, second, first.cross(second)])
}

/// `v` or `−v`, whichever has its largest component positive.
fn positive<S: Precise>(v: Vec3<S>) -> Vec3<S> {
    let mut largest = v[0];
    for k in [1, 2] {
        if v[k].abs() > largest.abs() {
            largest = v[k];
        }
    }
    if largest < S::of(0.0) { -v } else { v }
}

/// The unit quaternion that takes coordinates along the right-handed `columns` to the axes they are given in.
pub(super) fn frame_quaternion<S: Precise>(columns: [Vec3<S>; 3]) -> Quat<S> {
    let r = |i: usize, j: usize| columns[j][i];
    let one = S::of(1.0);
    // four times the squared components; the largest is at least 1, so its root loses nothing
    let squares = [
        one + r(0, 0) + r(1, 1) + r(2, 2),
        one + r(0, 0) - r(1, 1) - r(2, 2),
        one - r(0, 0) + r(1, 1) - r(2, 2),
        one - r(0, 0) - r(1, 1) + r(2, 2),
    ];
    let mut largest = 0;
    for k in 1..4 {
        if squares[k] > squares[largest] {
            largest = k;
        }
    }
    let d = squares[largest];
    let (yz, zx, xy) = (r(2, 1) - r(1, 2), r(0, 2) - r(2, 0), r(1, 0) - r(0, 1));
    let (syz, szx, sxy) = (r(2, 1) + r(1, 2), r(0, 2) + r(2, 0), r(1, 0) + r(0, 1));
    let q = match largest {
        0 => [d, yz, zx, xy],
        1 => [yz, d, sxy, szx],
        2 => [zx, sxy, d, syz],
        _ => [xy, szx, syz, d],
    };
    let q = Quat::from_components(q).normalized();
    if q.w < S::of(0.0) { -q } else { q }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::num::{Dd, Real};

    /// Largest entry of `A V − V Λ` and of `VᵀV − 1`, relative to the trace.
    fn defect(a: [[f64; 3]; 3]) -> f64 {
        let dd = a.map(|row| row.map(Dd::of));
        let (lambda, v) = principal_axes(dd);
        let mut worst = 0.0_f64;
        for k in 0..3 {
            let av = Vec3([Vec3(dd[0]).dot(v[k]), Vec3(dd[1]).dot(v[k]), Vec3(dd[2]).dot(v[k])]);
            worst = worst.max((av - v[k] * lambda[k]).magnitude() / (a[0][0] + a[1][1] + a[2][2]));
            for j in 0..3 {
                let expected = Dd::of(if j == k { 1.0 } else { 0.0 });
                worst = worst.max((v[j].dot(v[k]) - expected).magnitude());
            }
        }
        worst
    }

    #[test]
    fn eigenvectors_of_a_full_tensor_are_right_to_106_bits() {
        assert!(defect([[3.0, 0.5, -0.25], [0.5, 4.0, 1.0], [-0.25, 1.0, 5.0]]) < 2e-31);
        assert!(defect([[3.0, 1e-9, 0.0], [1e-9, 3.0, 1e-12], [0.0, 1e-12, 5.0]]) < 2e-31);
    }

    #[test]
    fn a_diagonal_tensor_is_only_sorted() {
        let diagonal = [[3.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 2.0]];
        let (moments, axes) = principal_axes(diagonal);
        assert_eq!(moments, [1.0, 2.0, 3.0]);
        assert_eq!(axes, [Vec3::unit(1), Vec3::unit(2), Vec3::unit(0)]);
        let q = frame_quaternion(axes);
        assert_eq!(q.components(), [0.5, 0.5, 0.5, 0.5]);
    }
}

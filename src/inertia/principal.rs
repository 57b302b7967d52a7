//! Principal axes of a symmetric tensor, by Jacobi's rotations.

use crate::num::Precise;
use crate::rotation::{Quat, Vec3};

/// Eigenvalues, ascending, and eigenvectors, right-handed, of the symmetric matrix `a`.
///
/// Cyclic Jacobi (Golub and Van Loan, §8.5): each rotation annihilates one pair of off-diagonal entries, to full
/// relative accuracy of the small ones where the matrix allows it. Of the first two vectors the component of
/// largest size is positive; the third closes the right-handed frame.
pub(super) fn principal_axes<S: Precise>(mut a: [[S; 3]; 3]) -> ([S; 3], [Vec3<S>; 3]) {
    let zero = S::of(0.0);
    let mut v = [Vec3::unit(0), Vec3::unit(1), Vec3::unit(2)]; // v[k] is the k-th column of the rotation
    // quadratic convergence: 106 bits take at most 6 sweeps, the rest is margin
    for _ in 0..12 {
        for (p, q) in [(0, 1), (0, 2), (1, 2)] {
            let negligible = S::of(S::ROUNDOFF * 0.25) * (a[p][p].abs() * a[q][q].abs()).sqrt();
            if a[p][q].abs() <= negligible {
                continue;
            }
            let theta = (a[q][q] - a[p][p]) / (S::of(2.0) * a[p][q]);
            let root = theta.abs() + (theta * theta + S::of(1.0)).sqrt();
            let t = if theta < zero { -S::of(1.0) / root } else { S::of(1.0) / root };
            let c = S::of(1.0) / (t * t + S::of(1.0)).sqrt();
            let s = t * c;
            let apq = a[p][q];
            a[p][p] = a[p][p] - t * apq;
            a[q][q] = a[q][q] + t * apq;
            a[p][q] = zero;
            a[q][p] = zero;
            let r = 3 - p - q;
            let (arp, arq) = (a[r][p], a[r][q]);
            a[r][p] = c * arp - s * arq;
            a[r][q] = s * arp + c * arq;
            a[p][r] = a[r][p];
            a[q][r] = a[r][q];
            let (vp, vq) = (v[p], v[q]);
            v[p] = vp * c - vq * s;
            v[q] = vp * s + vq * c;
        }
    }
    let mut order = [0, 1, 2];
    order.sort_by(|&i, &j| a[i][i].partial_cmp(&a[j][j]).unwrap_or(core::cmp::Ordering::Equal));
    let [l, u, _] = order;
    let (first, second) = (positive(v[l]), positive(v[u]));
    (order.map(|k| a[k][k]), [first, second, first.cross(second)])
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

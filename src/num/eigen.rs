//! Eigenvalues and eigenvectors of small symmetric matrices, by Jacobi's rotations.

use super::Precise;

/// Eigenvalues, ascending, and as many orthonormal eigenvectors of the symmetric matrix `a`.
///
/// Cyclic Jacobi (Golub and Van Loan, §8.5): each rotation annihilates one pair of off-diagonal entries, to full
/// relative accuracy of the small ones where the matrix allows it. The signs of the vectors are arbitrary.
pub fn eigen<S: Precise, const N: usize>(mut a: [[S; N]; N]) -> ([S; N], [[S; N]; N]) {
    let (zero, one) = (S::of(0.0), S::of(1.0));
    // v[k] is the k-th column of the product of all rotations
    let mut v: [[S; N]; N] =
        core::array::from_fn(|k| core::array::from_fn(|i| if i == k { one } else { zero }));
    // quadratic convergence: 106 bits take at most 6 or 7 sweeps, the rest is margin
    for _ in 0..12 {
        for p in 0..N {
            for q in p + 1..N {
                let negligible = S::of(S::ROUNDOFF * 0.25) * (a[p][p].abs() * a[q][q].abs()).sqrt();
                if a[p][q].abs() > negligible {
                    rotate(&mut a, &mut v, p, q);
                }
            }
        }
    }
    // by insertion, which needs no total order
    let mut order: [usize; N] = core::array::from_fn(|k| k);
    for end in 1..N {
        for k in (1..=end).rev() {
            if a[order[k]][order[k]] < a[order[k - 1]][order[k - 1]] {
                order.swap(k, k - 1);
            }
        }
    }
    (order.map(|k| a[k][k]), order.map(|k| v[k]))
}

/// The rotation in the plane of axes p and q that annihilates the entry (p, q) of `a`.
fn rotate<S: Precise, const N: usize>(a: &mut [[S; N]; N], v: &mut [[S; N]; N], p: usize, q: usize) {
    let (zero, one) = (S::of(0.0), S::of(1.0));
    let theta = (a[q][q] - a[p][p]) / (S::of(2.0) * a[p][q]);
    let root = theta.abs() + (theta * theta + one).sqrt();
    let t = if theta < zero { -one / root } else { one / root };
    let c = one / (t * t + one).sqrt();
    let s = t * c;
    let apq = a[p][q];
    a[p][p] = a[p][p] - t * apq;
    a[q][q] = a[q][q] + t * apq;
    a[p][q] = zero;
    a[q][p] = zero;
    for r in (0..N).filter(|&r| r != p && r != q) {
        let (arp, arq) = (a[r][p], a[r][q]);
        a[r][p] = c * arp - s * arq;
        a[r][q] = s * arp + c * arq;
        a[p][r] = a[r][p];
        a[q][r] = a[r][q];
    }
    let (before, from_q) = v.split_at_mut(q);
    for (x, y) in before[p].iter_mut().zip(&mut from_q[0]) {
        (*x, *y) = (*x * c - *y * s, *x * s + *y * c);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::num::{Dd, Real};

    /// Largest entry of `A V − V Λ` and of `VᵀV − 1`, the former relative to the largest entry of A.
    fn defect<const N: usize>(a: [[f64; N]; N]) -> f64 {
        let dd = a.map(|row| row.map(Dd::of));
        let (lambda, v) = eigen(dd);
        assert!(lambda.windows(2).all(|pair| pair[0] <= pair[1]));
        let largest = a.as_flattened().iter().fold(0.0, |m: f64, x| m.max(x.abs()));
        let dot = |x: &[Dd; N], y: &[Dd; N]| x.iter().zip(y).fold(Dd::of(0.0), |s, (x, y)| s + *x * *y);
        let mut worst = 0.0_f64;
        for k in 0..N {
            for i in 0..N {
                worst = worst.max((dot(&dd[i], &v[k]) - v[k][i] * lambda[k]).magnitude() / largest);
                let expected = Dd::of(if i == k { 1.0 } else { 0.0 });
                worst = worst.max((dot(&v[i], &v[k]) - expected).magnitude());
            }
        }
        worst
    }

    #[test]
    fn eigenvectors_are_right_to_106_bits_also_where_eigenvalues_agree() {
        assert!(defect([[3.0, 0.5, -0.25], [0.5, 4.0, 1.0], [-0.25, 1.0, 5.0]]) < 2e-31);
        assert!(defect([[3.0, 1e-9, 0.0], [1e-9, 3.0, 1e-12], [0.0, 1e-12, 5.0]]) < 2e-31);
        assert!(defect([[1.0, 1.0, 1.0], [1.0, 1.0, 1.0], [1.0, 1.0, 1.0]]) < 2e-31);
        // 1/(i + j + 1): Hilbert's matrix, of condition 5e5
        let hilbert: [[f64; 5]; 5] =
            core::array::from_fn(|i| core::array::from_fn(|j| 1.0 / (i + j + 1) as f64));
        assert!(defect(hilbert) < 5e-31);
        // det = 1/266716800000
        let (values, _) = eigen(hilbert);
        let determinant: f64 = values.iter().product();
        assert!((determinant * 266_716_800_000.0 - 1.0).abs() < 1e-9, "{determinant:e}");
    }

    #[test]
    fn no_order_is_made_of_what_is_no_number() {
        let (values, _) = eigen([[f64::NAN, 0.0, 0.0], [0.0, 2.0, 0.0], [0.0, 0.0, 1.0]]);
        assert_eq!(values.iter().filter(|v| v.is_nan()).count(), 1);
    }
}

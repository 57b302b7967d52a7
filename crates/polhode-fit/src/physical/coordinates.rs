//! Coordinates of a tensor of trace 1, and its eigenvectors.
//!
//! J = 1/3 + Σ x_k B_k with B_1 … B_5 an orthonormal basis (Frobenius) of the symmetric matrices of trace 0:
//! the scale is eliminated, and a rotation of the sensor is an orthogonal map of x.

use nalgebra::{Matrix3, SMatrix, SVector, Vector3};
use polhode::num;

/// The five numbers that free motion can tell.
pub(crate) type Coordinates = SVector<f64, 5>;
/// A quadratic form of them.
pub(crate) type Form = SMatrix<f64, 5, 5>;

const HALF_ROOT: f64 = core::f64::consts::FRAC_1_SQRT_2;
const SIXTH_ROOT: f64 = 0.408_248_290_463_863; // 1/√6

/// The rows and columns of the order xx, yy, zz, xy, xz, yz.
pub(crate) const ENTRIES: [(usize, usize); 6] = [(0, 0), (1, 1), (2, 2), (0, 1), (0, 2), (1, 2)];

/// e_i e_jᵀ + e_j e_iᵀ of entry `k` in the order xx, yy, zz, xy, xz, yz; e_i e_iᵀ on the diagonal.
pub(crate) fn symmetric(k: usize) -> Matrix3<f64> {
    let (i, j) = ENTRIES[k];
    let mut m = Matrix3::zeros();
    m[(i, j)] = 1.0;
    m[(j, i)] = 1.0;
    m
}

/// B_k.
pub(crate) fn basis(k: usize) -> Matrix3<f64> {
    match k {
        0 => Matrix3::from_diagonal(&Vector3::new(HALF_ROOT, -HALF_ROOT, 0.0)),
        1 => Matrix3::from_diagonal(&Vector3::new(SIXTH_ROOT, SIXTH_ROOT, -2.0 * SIXTH_ROOT)),
        _ => {
            let (i, j) = ENTRIES[k + 1];
            let mut b = Matrix3::zeros();
            b[(i, j)] = HALF_ROOT;
            b[(j, i)] = HALF_ROOT;
            b
        }
    }
}

/// Σ x_k B_k.
pub(crate) fn trace_free(x: &Coordinates) -> Matrix3<f64> {
    (0..5).fold(Matrix3::zeros(), |sum, k| sum + basis(k) * x[k])
}

/// 1/3 + Σ x_k B_k.
pub(crate) fn tensor(x: &Coordinates) -> Matrix3<f64> {
    Matrix3::identity() / 3.0 + trace_free(x)
}

/// The coordinates of a symmetric tensor, its trace put aside.
pub(crate) fn coordinates(tensor: &Matrix3<f64>) -> Coordinates {
    Coordinates::from_fn(|k, _| basis(k).dot(tensor))
}

/// vᵀ B_k w for each k.
pub(crate) fn pair(v: &Vector3<f64>, w: &Vector3<f64>) -> Coordinates {
    Coordinates::from_fn(|k, _| v.dot(&(basis(k) * w)))
}

/// Eigenvalues, ascending, and eigenvectors (columns) of a symmetric matrix.
pub(crate) fn eigen<const N: usize>(a: SMatrix<f64, N, N>) -> (SVector<f64, N>, SMatrix<f64, N, N>) {
    let (values, vectors) = num::eigen::eigen::<f64, N>(a.transpose().into());
    (values.into(), SMatrix::from(vectors))
}

/// The matrix that takes coordinates to the entries xx, yy, zz, xy, xz, yz.
pub(crate) fn entries_of_coordinates() -> SMatrix<f64, 6, 5> {
    SMatrix::from_fn(|row, k| basis(k)[ENTRIES[row]])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn basis_is_orthonormal_and_free_of_trace() {
        for k in 0..5 {
            assert_eq!(basis(k).trace(), 0.0);
            for l in 0..5 {
                let expected = if k == l { 1.0 } else { 0.0 };
                assert!((basis(k).dot(&basis(l)) - expected).abs() < 1e-15, "{k} {l}");
            }
        }
    }

    #[test]
    fn eigenvectors_solve_their_equation_also_where_moments_agree() {
        let turned = Matrix3::new(2.0, 0.5, -0.25, 0.5, 3.0, 1.0, -0.25, 1.0, 5.0);
        for a in [
            turned,
            Matrix3::identity(),
            Matrix3::from_diagonal(&Vector3::new(3.0, 1.0, 3.0)),
            turned * 1e-200,
        ] {
            let (values, vectors) = eigen(a);
            assert!(values[0] <= values[1] && values[1] <= values[2]);
            assert!((a * vectors - vectors * Matrix3::from_diagonal(&values)).amax() < 2e-15 * a.amax());
            assert!((vectors.transpose() * vectors - Matrix3::identity()).amax() < 1e-15);
        }
    }

    /// Coordinates, pairs and entries are three readings of one tensor of trace 1.
    #[test]
    fn a_tensor_has_its_coordinates_back() {
        let j = Matrix3::new(0.2, 0.01, -0.02, 0.01, 0.35, 0.03, -0.02, 0.03, 0.45);
        let x = coordinates(&j);
        assert!((tensor(&x) - j).amax() < 1e-15);
        assert!((coordinates(&(j + Matrix3::identity())) - x).amax() < 1e-15);
        let (v, w) = (Vector3::new(0.3, -0.5, 0.7), Vector3::new(-0.2, 0.4, 0.9));
        assert!((pair(&v, &w).dot(&x) - v.dot(&(trace_free(&x) * w))).abs() < 1e-15);
        let entries = entries_of_coordinates() * x;
        let sum = (0..6).fold(Matrix3::zeros(), |sum, k| sum + symmetric(k) * entries[k]);
        assert!((sum - trace_free(&x)).amax() < 1e-15);
    }
}

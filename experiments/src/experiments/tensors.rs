//! Tensors along random axes, and how far an estimate of one is off.

use nalgebra::{Matrix3, Quaternion, Rotation3, SMatrix, UnitQuaternion, Vector3};
use polhode::num::Random;

pub(super) fn random_rotation(random: &mut Random) -> Rotation3<f64> {
    let (w, v) = (random.normal(), random.normal_vector());
    UnitQuaternion::from_quaternion(Quaternion::new(w, v.x, v.y, v.z)).to_rotation_matrix()
}

/// With these moments about axes that `turn` has turned.
pub(super) fn tensor_along(turn: &Rotation3<f64>, moments: Vector3<f64>) -> Matrix3<f64> {
    let j = turn.matrix() * Matrix3::from_diagonal(&moments) * turn.matrix().transpose();
    (j + j.transpose()) / 2.0
}

/// With the trace 1, and moments in these ratios.
pub(super) fn random_tensor(moments: [f64; 3], random: &mut Random) -> Matrix3<f64> {
    let turn = random_rotation(random);
    let j = turn.matrix() * Matrix3::from_diagonal(&Vector3::from(moments)) * turn.matrix().transpose();
    (j + j.transpose()) / (2.0 * j.trace())
}

/// The 95 % point of χ² with five degrees of freedom.
pub(super) const ELLIPSOID: f64 = 11.070_497_693_516_35;

/// xx, yy, zz, xy, xz, yz.
pub(super) type Entries = SMatrix<f64, 6, 1>;

pub(super) fn entries(j: &Matrix3<f64>) -> Entries {
    SMatrix::from([[j[(0, 0)], j[(1, 1)], j[(2, 2)], j[(0, 1)], j[(0, 2)], j[(1, 2)]]])
}

/// eᵀ C⁻¹ e; with `shape`, C is singular along the trace alone.
pub(super) fn square(e: &Entries, c: &SMatrix<f64, 6, 6>, shape: bool) -> Option<f64> {
    let trace = SMatrix::<f64, 6, 1>::from([[1.0, 1.0, 1.0, 0.0, 0.0, 0.0]]);
    let regular = if shape { c + trace * trace.transpose() * c.trace() } else { *c };
    Some(e.dot(&regular.cholesky()?.solve(e)))
}

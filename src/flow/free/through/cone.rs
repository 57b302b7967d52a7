//! The directions in which a momentum may point so that it has the same energy at both attitudes.

use nalgebra::Matrix3;

use crate::num::eigen::eigen;
use crate::rotation::{Quat, Vec3};

/// The cone `m·(R I⁻¹ Rᵀ − I⁻¹) m = 0` on the sphere of directions, R the attitude at the end as seen from that at the start.
///
/// The matrix has no trace, so that unless it is zero two of its eigenvalues s₁ < s₂ < s₃ differ in sign, and the cone is never a point.
#[derive(Clone, Debug)]
pub(super) struct Cone {
    /// The eigenvector of the eigenvalue that has a sign of its own, and the others.
    axes: [Vec3<f64>; 3],
    /// Half axes of the ellipse that the cone cuts out, along the last two.
    half_axes: [f64; 2],
}

/// A quarter of the cone: from one corner of the ellipse to the next, on one side of it.
#[derive(Clone, Copy, Debug)]
pub(super) struct Quarter {
    side: f64,
    turned: f64,
}

impl Cone {
    /// `None` where any direction will do: the end is the start turned by a symmetry of the ellipsoid of inertia.
    pub(super) fn of(moments: Vec3<f64>, turn: Quat<f64>) -> Option<Cone> {
        let inverse = Matrix3::from_diagonal(&moments.map(|i| 1.0 / i).into());
        // R = 1 + X, where X keeps its digits for small turns
        let v = nalgebra::Vector3::from(turn.v).cross_matrix();
        let x = v * (2.0 * turn.w) + v * v * 2.0;
        let s = x * inverse + inverse * x.transpose() + x * inverse * x.transpose();
        let largest = s.amax();
        if largest <= 1e-14 * x.amax().min(1.0) * inverse.amax() {
            return None;
        }
        let s = (s + s.transpose()) / (2.0 * largest);
        let (values, vectors) = eigen([0, 1, 2].map(|k| [s[(k, 0)], s[(k, 1)], s[(k, 2)]]));
        // the one that differs in sign from the middle one
        let order = if values[1] >= 0.0 { [0, 1, 2] } else { [2, 1, 0] };
        let [lone, middle, other] = order.map(|k| values[k].abs());
        let half = |share: f64| (lone / (lone + share)).sqrt();
        Some(Cone { axes: order.map(|k| Vec3(vectors[k])), half_axes: [half(middle), half(other)] })
    }

    /// The quarters: together they are the cone.
    pub(super) fn quarters() -> [Quarter; 4] {
        [(1.0, 1.0), (1.0, -1.0), (-1.0, 1.0), (-1.0, -1.0)].map(|(side, turned)| Quarter { side, turned })
    }

    /// The unit vector at the place φ ∈ (−π/2, π/2) of a quarter.
    pub(super) fn direction(&self, quarter: Quarter, sin: f64, cos: f64) -> Vec3<f64> {
        let [y, z] = self.half_axes;
        let (u, v) = (y * sin, z * cos * quarter.turned);
        // 1 − u² − v², as a sum
        let x = ((1.0 - y * y) * sin * sin + (1.0 - z * z) * cos * cos).sqrt() * quarter.side;
        self.axes[0] * x + self.axes[1] * u + self.axes[2] * v
    }
}

//! The directions in which a momentum may point so that it has the same energy at both attitudes.

use nalgebra::Matrix3;

use crate::num::eigen::eigen;
use crate::rotation::{Quat, Vec3};

/// Of the change of the inertia tensor by the turn, below which it is rounding.
const ROUNDING: f64 = 1e-14;

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

/// A half of the ellipse on one side of the cone, from one of its corners to the other; the other side has the opposite directions.
#[derive(Clone, Copy, Debug)]
pub(super) struct Half {
    turned: f64,
}

/// The halves: together they are one side of the cone.
pub(super) const HALVES: [Half; 2] = [Half { turned: 1.0 }, Half { turned: -1.0 }];

impl Cone {
    /// `None` where any direction will do: the end is the start turned by a symmetry of the ellipsoid of inertia.
    pub(super) fn of(moments: Vec3<f64>, turn: Quat<f64>) -> Option<Cone> {
        let inverse = Matrix3::from_diagonal(&moments.map(|i| 1.0 / i).into());
        // R = 1 + X, where X keeps its digits for small turns
        let v = nalgebra::Vector3::from(turn.v).cross_matrix();
        let x = v * (2.0 * turn.w) + v * v * 2.0;
        let s = x * inverse + inverse * x.transpose() + x * inverse * x.transpose();
        let largest = s.amax();
        if largest <= ROUNDING * x.amax().min(1.0) * inverse.amax() {
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

    /// The unit vector at the place φ ∈ [−π/2, π/2] of a half, and its derivative by φ.
    pub(super) fn direction(&self, half: Half, (sin, cos): (f64, f64)) -> [Vec3<f64>; 2] {
        let [y, z] = self.half_axes;
        // 1 − u² − v², as a sum
        let x = ((1.0 - y * y) * sin * sin + (1.0 - z * z) * cos * cos).sqrt();
        let x_slope = if x == 0.0 { 0.0 } else { (z - y) * (z + y) * sin * cos / x };
        let z = z * half.turned;
        let along = |x: f64, u: f64, v: f64| self.axes[0] * x + self.axes[1] * u + self.axes[2] * v;
        [along(x, y * sin, z * cos), along(x_slope, y * cos, -z * sin)]
    }

    /// The places φ of a half on the planes of the separatrix, m_h √(I_l (I_h − I_μ)) = ± m_l √(I_h (I_μ − I_l)): between them a motion
    /// does not change its kind.
    pub(super) fn cuts(&self, half: Half, moments: Vec3<f64>) -> Vec<f64> {
        let [l, mu, h] = moments.ascending();
        let i = moments;
        let (high, low) = ((i[l] * (i[h] - i[mu])).sqrt(), (i[h] * (i[mu] - i[l])).sqrt());
        let [y, z] = self.half_axes;
        let mut cuts = Vec::new();
        for low in [low, -low] {
            let normal = Vec3::unit(h) * high + Vec3::unit(l) * low;
            let [w0, w1, w2] = self.axes.map(|axis| axis.dot(normal));
            // (w₀x)² = (w₁u + w₂v)² is A sin² + 2B sin cos + D cos² = 0
            let a = w0 * w0 * (1.0 - y * y) - w1 * w1 * y * y;
            let b = -w1 * w2 * y * z;
            let d = w0 * w0 * (1.0 - z * z) - w2 * w2 * z * z;
            let square = b * b - a * d;
            if square < 0.0 {
                continue;
            }
            let sum = -(b + square.sqrt().copysign(b));
            for (sin, cos) in [(sum, a), (d, sum)] {
                // the one direction of the line that is in this half
                let sign = if cos * half.turned < 0.0 { -1.0 } else { 1.0 };
                let length = (sin * sin + cos * cos).sqrt() * sign;
                let (sin, cos) = (sin / length, cos / length);
                // squares hide which side of the cone it is on
                let this_side = w0 * (w1 * y * sin + w2 * z * cos) <= 0.0;
                if length != 0.0 && this_side {
                    cuts.push(libm::atan2(sin, cos.abs()));
                }
            }
        }
        cuts
    }
}

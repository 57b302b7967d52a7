//! The Magnus series: the rotation vector of one interval from rates at its Gauss points.

use crate::num::Real;
use crate::rotation::Vec3;

/// Rotation vector of an interval from `v_s = h ω(t_s)` at the Gauss points of order 2, 4 or 6.
///
/// | order | Ω |
/// |---|---|
/// | 2 | v₁ |
/// | 4 | ½ (v₁ + v₂) + (√3/12) v₁ × v₂ |
/// | 6 | A₁ + A₃/12 + [−20 A₁ − A₃ + C₁, A₂ + C₂]/240 |
///
/// with A₁ = v₂, A₂ = (√15/3)(v₃ − v₁), A₃ = (10/3)(v₃ − 2 v₂ + v₁), C₁ = [A₁, A₂], C₂ = −[A₁, 2 A₃ + C₁]/60. Body rates multiply
/// on the right, `q̇ = ½ q ω`, so that the bracket is [u, v] = −u × v where the source has the commutator.
///
/// Source: Blanes, Casas, Ros, BIT 40 (2000) 434, equations 3.7 and 3.9.
#[inline]
pub(super) fn rotation_vector<S: Real>(order: u32, v: &[Vec3<S>; 3]) -> Vec3<S> {
    let of = S::of;
    match order {
        2 => v[0],
        4 => (v[0] + v[1]) * of(0.5) + v[0].cross(v[1]) * (of(3.0).sqrt() / of(12.0)),
        _ => {
            let a1 = v[1];
            let a2 = (v[2] - v[0]) * (of(15.0).sqrt() / of(3.0));
            let a3 = (v[2] - v[1] * of(2.0) + v[0]) * (of(10.0) / of(3.0));
            let c1 = -a1.cross(a2);
            let c2 = a1.cross(a3 * of(2.0) + c1) * (of(1.0) / of(60.0));
            let bracket = (a1 * of(20.0) + a3 - c1).cross(a2 + c2);
            a1 + a3 * (of(1.0) / of(12.0)) + bracket * (of(1.0) / of(240.0))
        }
    }
}

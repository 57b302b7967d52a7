//! The exact motion of a tensor of trace 1, with its derivatives, in the axes of the tensor.

use nalgebra::{Matrix3, SMatrix, UnitQuaternion, Vector3};
use polhode::flow::{FreeMotion, TurnAxes};
use polhode::inertia::Inertia;
use polhode::rotation::Quat;

use crate::physical::coordinates::{Coordinates, ENTRIES, basis, eigen, tensor};

/// Where a motion is at time 0: attitude (axes of the tensor → space) and rate, axes of the tensor.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Start {
    pub(crate) attitude: Quat<f64>,
    pub(crate) rate: Vector3<f64>,
}

/// Where it is at another time, with the derivative of rotation vector and rate by those at the start and by the coordinates.
pub(crate) struct Moved {
    pub(crate) attitude: Quat<f64>,
    pub(crate) rate: Vector3<f64>,
    pub(crate) by: SMatrix<f64, 6, 11>,
}

/// A motion. It is that of the principal axes, along which moments that no body has are moments as well: an estimate may lie outside
/// of the physical law.
pub(crate) struct Motion {
    motion: FreeMotion,
    /// Takes coordinates along the principal axes to those of the tensor.
    axes: Quat<f64>,
    matrix: Matrix3<f64>,
    /// The entries along the principal axes by the coordinates.
    entries: SMatrix<f64, 6, 5>,
}

impl Motion {
    /// `None` where a moment is not positive, or a number not finite.
    pub(crate) fn new(x: &Coordinates, start: &Start) -> Option<Motion> {
        let (moments, mut matrix) = eigen(tensor(x));
        if matrix.determinant() < 0.0 {
            matrix.column_mut(2).neg_mut();
        }
        let inertia = Inertia::from_positive_moments(moments.into()).ok()?;
        let axes: Quat<f64> = UnitQuaternion::from_matrix(&matrix).into();
        let attitude = (start.attitude * axes).normalized();
        let motion =
            FreeMotion::from_omega(&inertia, attitude.into(), matrix.transpose() * start.rate).ok()?;
        let entries = SMatrix::from_fn(|row, k| {
            let (i, j) = ENTRIES[row];
            matrix.column(i).dot(&(basis(k) * matrix.column(j)))
        });
        Some(Motion { motion, axes, matrix, entries })
    }

    /// `None` out of reach.
    pub(crate) fn at(&self, t: f64) -> Option<Moved> {
        let found = self.motion.at_with_derivative(t).ok()?;
        let (own, r) = (found.by_omega(TurnAxes::Body), &self.matrix);
        let mut by = SMatrix::<f64, 6, 11>::zeros();
        for row in [0, 3] {
            for column in [0, 3] {
                let block = r * own.fixed_view::<3, 3>(row, column) * r.transpose();
                by.fixed_view_mut::<3, 3>(row, column).copy_from(&block);
            }
            let of_tensor = r * own.fixed_view::<3, 6>(row, 6) * self.entries;
            by.fixed_view_mut::<3, 5>(row, 6).copy_from(&of_tensor);
        }
        let attitude = found.state().attitude * self.axes.conjugate();
        Some(Moved { attitude, rate: r * found.omega_body(), by })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::physical::coordinates::coordinates;
    use polhode::num::Random;
    use polhode::rotation::Vec3;

    /// Against differences of the motion itself, also of tensors outside of the law and of a sphere.
    #[test]
    fn derivatives_are_those_of_differences() {
        let mut random = Random::new(3);
        for moments in [[1.0, 2.0, 2.6], [1.0, 2.0, 3.4], [1.0, 1.0, 1.0], [1.0, 1.0, 1.6]] {
            let turn: UnitQuaternion<f64> = Quat::exponential(Vec3::from(random.normal_vector())).into();
            let turn = turn.to_rotation_matrix();
            let j =
                turn.matrix() * Matrix3::from_diagonal(&Vector3::from(moments)) * turn.matrix().transpose();
            let x = coordinates(&(j / j.trace()));
            let start = Start {
                attitude: Quat::exponential(Vec3::from(random.normal_vector())),
                rate: random.normal_vector(),
            };
            let t = 3.0;
            let here = Motion::new(&x, &start).unwrap().at(t).unwrap();
            let h = 1e-5;
            for k in 0..11 {
                let moved = |h: f64| {
                    let (mut x, mut start) = (x, start);
                    match k {
                        0..3 => {
                            let turn = Vec3::from(Vector3::ith(k, h));
                            start.attitude = start.attitude * Quat::exponential(turn);
                        }
                        3..6 => start.rate[k - 3] += h,
                        _ => x[k - 6] += h,
                    }
                    Motion::new(&x, &start).unwrap().at(t).unwrap()
                };
                let (above, below) = (moved(h), moved(-h));
                let turn: Vector3<f64> = (below.attitude.conjugate() * above.attitude).logarithm().into();
                let change = (above.rate - below.rate) / (2.0 * h);
                let near = 1e-6 * (1.0 + here.by.column(k).norm());
                for row in 0..3 {
                    assert!(
                        (turn[row] / (2.0 * h) - here.by[(row, k)]).abs() < near,
                        "{moments:?} {k} {row}"
                    );
                    assert!((change[row] - here.by[(3 + row, k)]).abs() < near, "{moments:?} {k} {row}");
                }
            }
        }
    }
}

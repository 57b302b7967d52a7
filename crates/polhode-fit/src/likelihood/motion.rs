//! The exact motion of a tensor of trace 1, with its derivatives, in the axes of the tensor; also under drag in proportion to the momentum.
//!
//! With −k J ω the momentum shrinks by exp(−kt), and the body goes through the attitudes of its free motion on a clock that slows down,
//! s = (1 − exp(−kt))/k: Q(t) = Q₀(s), ω(t) = exp(−kt) ω₀(s).

use nalgebra::{Matrix3, SMatrix, SVector, UnitQuaternion, Vector3};
use polhode::flow::{FreeMotion, TurnAxes};
use polhode::inertia::Inertia;
use polhode::rotation::Quat;

use crate::physical::coordinates::{Coordinates, ENTRIES, basis, eigen, tensor};
use crate::thresholds::likelihood::SMALL;

/// Where a motion is at time 0: attitude (axes of the tensor → space) and rate, axes of the tensor.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Start {
    pub(crate) attitude: Quat<f64>,
    pub(crate) rate: Vector3<f64>,
}

/// Where it is at another time, with the derivative of rotation vector and rate by those at the start, by the coordinates and by the drag.
pub(crate) struct Moved {
    pub(crate) attitude: Quat<f64>,
    pub(crate) rate: Vector3<f64>,
    pub(crate) by: SMatrix<f64, 6, 11>,
    pub(crate) by_drag: SVector<f64, 6>,
}

/// A motion. It is that of the principal axes, along which moments that no body has are moments as well: an estimate may lie outside
/// of the physical law.
pub(crate) struct Motion {
    motion: FreeMotion,
    /// k.
    drag: f64,
    inertia: Matrix3<f64>,
    inverse: Matrix3<f64>,
    /// Takes coordinates along the principal axes to those of the tensor.
    axes: Quat<f64>,
    matrix: Matrix3<f64>,
    /// The entries along the principal axes by the coordinates.
    entries: SMatrix<f64, 6, 5>,
}

impl Motion {
    /// `None` where a moment is not positive, or a number not finite.
    pub(crate) fn new(x: &Coordinates, start: &Start, drag: f64) -> Option<Motion> {
        let inertia = tensor(x);
        let (moments, mut matrix) = eigen(inertia);
        if matrix.determinant() < 0.0 {
            matrix.column_mut(2).neg_mut();
        }
        let body = Inertia::from_positive_moments(moments.into()).ok()?;
        let axes: Quat<f64> = UnitQuaternion::from_matrix(&matrix).into();
        let attitude = (start.attitude * axes).normalized();
        let motion = FreeMotion::from_omega(&body, attitude.into(), matrix.transpose() * start.rate).ok()?;
        let entries = SMatrix::from_fn(|row, k| {
            let (i, j) = ENTRIES[row];
            matrix.column(i).dot(&(basis(k) * matrix.column(j)))
        });
        Some(Motion { motion, drag, inertia, inverse: inertia.try_inverse()?, axes, matrix, entries })
    }

    /// `None` out of reach.
    pub(crate) fn at(&self, t: f64) -> Option<Moved> {
        let (clock, slowed, by_k) = clock(self.drag, t);
        let found = self.motion.at_with_derivative(clock).ok()?;
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
        let mut rates = by.fixed_rows_mut::<3>(3);
        rates *= slowed;
        let attitude = found.state().attitude * self.axes.conjugate();
        let free = r * found.omega_body();
        let acceleration = self.inverse * (self.inertia * free).cross(&free);
        let mut by_drag = SVector::<f64, 6>::zeros();
        by_drag.fixed_rows_mut::<3>(0).copy_from(&(free * by_k));
        by_drag.fixed_rows_mut::<3>(3).copy_from(&((acceleration * by_k - free * t) * slowed));
        Some(Moved { attitude, rate: free * slowed, by, by_drag })
    }
}

/// s, exp(−kt), and ds/dk.
fn clock(k: f64, t: f64) -> (f64, f64, f64) {
    let lost = k * t;
    let slowed = libm::exp(-lost);
    // what the closed forms leave of nearly equal numbers, to the fourth order
    if lost.abs() < SMALL {
        let s = t * (1.0 - lost * (0.5 - lost * (1.0 / 6.0 - lost / 24.0)));
        return (s, slowed, -t * t * (0.5 - lost * (1.0 / 3.0 - lost * (0.125 - lost / 30.0))));
    }
    let s = -libm::expm1(-lost) / k;
    (s, slowed, (t * slowed - s) / k)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::physical::coordinates::coordinates;
    use polhode::num::Random;
    use polhode::rotation::Vec3;

    /// The series meets the closed form where they take turns, and the motion is that of the equation with drag.
    #[test]
    fn drag_slows_the_clock() {
        for k in [0.999e-3, 1.001e-3, -1.001e-3] {
            let (s, slowed, by_k) = clock(k, 1.0);
            let h = 1e-4;
            let difference = (-libm::expm1(-(k + h)) / (k + h) + libm::expm1(-(k - h)) / (k - h)) / (2.0 * h);
            assert!((s + libm::expm1(-k) / k).abs() < 1e-13 && (by_k - difference).abs() < 1e-8, "{k}");
            assert!((slowed - libm::exp(-k)).abs() < 1e-15);
        }
        let start = Start { attitude: Quat::identity(), rate: Vector3::new(0.3, 1.0, -0.4) };
        let x = Coordinates::from_column_slice(&[0.05, 0.02, 0.01, -0.03, 0.02]);
        let (k, t, h) = (0.1, 2.0, 1e-4);
        let motion = Motion::new(&x, &start, k).unwrap();
        let [before, here, after] = [t - h, t, t + h].map(|t| motion.at(t).unwrap());
        let j = tensor(&x);
        let change = (after.rate - before.rate) / (2.0 * h);
        let expected = (j * here.rate).cross(&here.rate) - j * here.rate * k;
        assert!((j * change - expected).norm() < 1e-7);
        let turn: Vector3<f64> = (before.attitude.conjugate() * after.attitude).logarithm().into();
        assert!((turn / (2.0 * h) - here.rate).norm() < 1e-6);
    }

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
            let (t, drag) = (3.0, 0.05);
            let here = Motion::new(&x, &start, drag).unwrap().at(t).unwrap();
            let h = 1e-5;
            for k in 0..12 {
                let moved = |h: f64| {
                    let (mut x, mut start, mut drag) = (x, start, drag);
                    match k {
                        0..3 => {
                            let turn = Vec3::from(Vector3::ith(k, h));
                            start.attitude = start.attitude * Quat::exponential(turn);
                        }
                        3..6 => start.rate[k - 3] += h,
                        6..11 => x[k - 6] += h,
                        _ => drag += h,
                    }
                    Motion::new(&x, &start, drag).unwrap().at(t).unwrap()
                };
                let (above, below) = (moved(h), moved(-h));
                let turn: Vector3<f64> = (below.attitude.conjugate() * above.attitude).logarithm().into();
                let change = (above.rate - below.rate) / (2.0 * h);
                let by = if k < 11 { here.by.column(k).into_owned() } else { here.by_drag };
                let near = 1e-6 * (1.0 + by.norm());
                for row in 0..3 {
                    assert!((turn[row] / (2.0 * h) - by[row]).abs() < near, "{moments:?} {k} {row}");
                    assert!((change[row] - by[3 + row]).abs() < near, "{moments:?} {k} {row}");
                }
            }
        }
    }

    /// Without drag the clock is that of time, and falls behind by half of its square times the drag.
    #[test]
    fn the_clock_without_drag_is_that_of_time() {
        assert_eq!(clock(0.0, 3.0), (3.0, 1.0, -4.5));
        assert_eq!(clock(0.0, -3.0), (-3.0, 1.0, -4.5));
        // 1 − exp(−2) over a half at 4, and (4 exp(−2) − that)/0.5
        let (s, slowed, by_k) = clock(0.5, 4.0);
        let left = libm::exp(-2.0);
        assert!((s - 2.0 * (1.0 - left)).abs() < 1e-15 && (slowed - left).abs() < 1e-16);
        assert!((by_k - (8.0 * left - 4.0 * (1.0 - left))).abs() < 1e-14);
    }
}

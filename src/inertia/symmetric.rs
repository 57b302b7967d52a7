//! Symmetric tensors in double-double, in which mass properties are moved, turned and summed before one rounding.

use core::ops::{Add, Sub};

use nalgebra::Matrix3;

use super::InertiaError;
use super::checks::check_finite;
use super::principal::principal_axes;
use crate::num::Dd;
use crate::rotation::{Quat, Vec3};

/// The entries [j][k]; both triangles are kept.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Tensor(pub(super) [[Dd; 3]; 3]);

impl Tensor {
    pub(super) fn zero() -> Self {
        Tensor([[Dd::ZERO; 3]; 3])
    }

    /// The symmetric part of a matrix.
    pub(super) fn symmetric_part(matrix: &Matrix3<f64>) -> Self {
        let half = |j, k| Dd::sum(0.5 * matrix[(j, k)], 0.5 * matrix[(k, j)]);
        Tensor([0, 1, 2].map(|j| [0, 1, 2].map(|k| half(j, k))))
    }

    /// m (d² δ_jk − d_j d_k): a point of mass m at d. This is also the parallel-axis term.
    pub(super) fn of_point(mass: Dd, d: Vec3<Dd>) -> Self {
        let entry = |j: usize, k: usize| {
            if j == k {
                let (a, b) = (d[(j + 1) % 3], d[(j + 2) % 3]);
                mass * (a * a + b * b)
            } else {
                -(mass * (d[j] * d[k]))
            }
        };
        Tensor([0, 1, 2].map(|j| [0, 1, 2].map(|k| entry(j, k))))
    }

    /// R I Rᵀ for the rotation v ↦ q v q*.
    pub(super) fn turned(self, q: Quat<Dd>) -> Self {
        let rotated = self.0.map(|row| q.rotate(Vec3(row))); // (I Rᵀ) by rows, as I is symmetric
        let columns = [0, 1, 2].map(|k| q.rotate(Vec3([rotated[0][k], rotated[1][k], rotated[2][k]])));
        let entry = |j: usize, k: usize| columns[j.max(k)][j.min(k)];
        Tensor([0, 1, 2].map(|j| [0, 1, 2].map(|k| entry(j, k))))
    }

    pub(super) fn rounded(&self) -> Matrix3<f64> {
        Matrix3::from_fn(|j, k| self.0[j][k].hi())
    }
}

impl Add for Tensor {
    type Output = Self;
    fn add(self, b: Self) -> Self {
        Tensor([0, 1, 2].map(|j| [0, 1, 2].map(|k| self.0[j][k] + b.0[j][k])))
    }
}

impl Sub for Tensor {
    type Output = Self;
    fn sub(self, b: Self) -> Self {
        Tensor([0, 1, 2].map(|j| [0, 1, 2].map(|k| self.0[j][k] - b.0[j][k])))
    }
}

/// The symmetric matrix with the entries xx, yy, zz, xy, xz, yz.
pub(crate) fn from_entries([xx, yy, zz, xy, xz, yz]: [f64; 6]) -> Matrix3<f64> {
    Matrix3::new(xx, xy, xz, xy, yy, yz, xz, yz, zz)
}

/// tr(J) 1 − J of the second moments J = ∫ x xᵀ dm, given in the same order.
pub(super) fn from_second_moments([xx, yy, zz, xy, xz, yz]: [f64; 6]) -> Matrix3<f64> {
    from_entries([yy + zz, xx + zz, xx + yy, -xy, -xz, -yz])
}

/// 2⁻⁹⁸, above the rounding that double-double rotations leave of a zero beside entries of one.
const ROTATED: f64 = 3.155_443_620_884_047e-30;

/// Eigenvalues and eigenvectors of a symmetric tensor, whatever their signs.
#[derive(Clone, Copy, Debug)]
pub(super) struct Spectrum {
    /// A power of two, near the largest entry: the moments are divided by it.
    pub(super) scale: f64,
    /// Ascending.
    pub(super) moments: [Dd; 3],
    /// Right-handed, in the order of the moments.
    pub(super) axes: [Vec3<Dd>; 3],
}

impl Spectrum {
    /// Of the symmetric part of `matrix`.
    ///
    /// # Errors
    /// Entries that are not finite.
    pub(super) fn of(matrix: &Matrix3<f64>) -> Result<Self, InertiaError> {
        check_finite(matrix.as_slice())?;
        Ok(Self::of_finite(matrix))
    }

    /// Of the symmetric part of a matrix of finite entries.
    pub(super) fn of_finite(matrix: &Matrix3<f64>) -> Self {
        let largest = matrix.amax();
        let scale = if largest == 0.0 { 1.0 } else { power_of_two_below(largest) };
        Self::of_scaled(scale, &Tensor::symmetric_part(&(matrix / scale)))
    }

    /// Of `scale` times a tensor.
    pub(super) fn of_scaled(scale: f64, tensor: &Tensor) -> Self {
        let (moments, axes) = principal_axes(tensor.0);
        // what a rotation leaves of a zero is no moment; without one the moments are the entries
        let is_diagonal = (0..3).all(|j| (0..3).all(|k| j == k || tensor.0[j][k].hi() == 0.0));
        let kept = |moment: Dd| if is_diagonal || moment.hi().abs() > ROTATED { moment } else { Dd::ZERO };
        Spectrum { scale, moments: moments.map(kept), axes }
    }

    pub(super) fn trace(&self) -> f64 {
        (self.moments[0] + self.moments[1] + self.moments[2]).hi()
    }
}

/// The largest power of two not above `x`, of a positive finite number; exact, also for subnormal `x`.
pub(super) fn power_of_two_below(x: f64) -> f64 {
    let bits = x.to_bits();
    match bits >> 52 {
        0 => f64::from_bits(1 << (63 - bits.leading_zeros())),
        exponent => f64::from_bits(exponent << 52),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::num::Real;

    #[test]
    fn power_of_two_is_exact_over_the_whole_range() {
        for (x, power) in [
            (1.0, 1.0),
            (1.999, 1.0),
            (0.75, 0.5),
            (3e-310, f64::from_bits(1 << 45)),
            (1e308, f64::from_bits(2046 << 52)),
        ] {
            assert_eq!(power_of_two_below(x), power);
        }
    }

    #[test]
    fn a_quarter_turn_about_z_swaps_x_and_y() {
        let tensor = Tensor::symmetric_part(&Matrix3::new(1.0, 4.0, 5.0, 4.0, 2.0, 6.0, 5.0, 6.0, 3.0));
        let half = Dd::of(0.5).sqrt();
        let turned = tensor.turned(Quat::new(half, Vec3([Dd::ZERO, Dd::ZERO, half])));
        let expected = Matrix3::new(2.0, -4.0, -6.0, -4.0, 1.0, 5.0, -6.0, 5.0, 3.0);
        assert!((turned.rounded() - expected).amax() < 1e-30);
    }
}

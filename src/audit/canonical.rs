//! The columns in this library's convention, by a reading.

use super::{Attitudes, Direction, Frame, Reading, Trajectory, Turns};
use crate::num::trig::sin_cos;
use crate::rotation::{Quat, Vec3};

impl Reading {
    /// The attitude of row `row`, body → space, scalar first, normalised; `None` where the record has none.
    ///
    /// ```
    /// use polhode::audit::{Attitudes, Direction, QuaternionOrder, Reading, Trajectory};
    /// let mut reading = Reading::default();
    /// reading.quaternion = Some(QuaternionOrder::ScalarLast);
    /// reading.attitude = Some(Direction::SpaceToBody);
    /// let record = Trajectory::new(vec![0.0]).with_attitude(Attitudes::Quaternions(vec![[0.6, 0.0, 0.0, 0.8]]));
    /// assert_eq!(reading.attitude(&record, 0).unwrap().components(), [0.8, -0.6, 0.0, 0.0]);
    /// ```
    #[must_use]
    pub fn attitude(&self, record: &Trajectory, row: usize) -> Option<Quat<f64>> {
        let direct = match record.attitude.as_ref()? {
            Attitudes::Quaternions(rows) => {
                let [a, b, c, d] = *rows.get(row)?;
                let last = self.quaternion == Some(super::QuaternionOrder::ScalarLast);
                Quat::from_components(if last { [d, a, b, c] } else { [a, b, c, d] })
            }
            Attitudes::Matrices(rows) => of_matrix(rows.get(row)?),
            Attitudes::Rodrigues(rows) => {
                let sigma = Vec3(*rows.get(row)?);
                Quat::new(1.0 - sigma.norm_squared(), sigma * 2.0)
            }
            Attitudes::Angles(rows) => {
                let angles = self.angles?;
                let angle = *rows.get(row)?;
                let [first, second, third] = [0, 1, 2].map(|n| {
                    let (sin, cos) = sin_cos(0.5 * angle[n] * angles.unit.radians());
                    Quat::new(cos, Vec3::unit(angles.sequence.axes()[n]) * sin)
                });
                match angles.turns {
                    Turns::Intrinsic => first * second * third,
                    Turns::Extrinsic => third * second * first,
                }
            }
        };
        let unit = normalized(direct);
        Some(if self.attitude == Some(Direction::SpaceToBody) { unit.conjugate() } else { unit })
    }

    /// The angular velocity of row `row` in body axes, rad/s; `None` where the record has none, or has it in space axes
    /// without attitude.
    #[must_use]
    pub fn omega_body(&self, record: &Trajectory, row: usize) -> Option<Vec3<f64>> {
        let omega = Vec3(*record.rates.as_ref()?.get(row)?) * self.unit_of_rates();
        self.in_body(self.omega_frame, record, row, omega)
    }

    /// The angular momentum of row `row` in body axes, in its own unit; `None` as of the angular velocity.
    #[must_use]
    pub fn momentum_body(&self, record: &Trajectory, row: usize) -> Option<Vec3<f64>> {
        let momentum = Vec3(*record.momentum.as_ref()?.get(row)?);
        self.in_body(self.momentum_frame, record, row, momentum)
    }

    /// What an angular velocity of 1 is by its numbers, rad/s.
    pub(super) fn unit_of_rates(&self) -> f64 {
        self.rate_unit.map_or(1.0, |unit| unit.radians_per_second(1.0))
    }

    fn in_body(
        &self,
        frame: Option<Frame>,
        record: &Trajectory,
        row: usize,
        v: Vec3<f64>,
    ) -> Option<Vec3<f64>> {
        match frame {
            Some(Frame::Space) => self.attitude(record, row).map(|q| q.rotate_back(v)),
            _ => Some(v),
        }
    }
}

/// The quaternion of norm 1 along `q`, whose square a double need not hold: a quaternion of zeros would agree with every attitude.
fn normalized(q: Quat<f64>) -> Quat<f64> {
    let square = q.norm_squared();
    if square.is_normal() {
        return q * (1.0 / square.sqrt());
    }
    let largest = q.components().iter().fold(0.0_f64, |most, x| most.max(x.abs()));
    let scaled = q.map(|x| x / largest);
    scaled * (1.0 / scaled.norm_squared().sqrt())
}

/// The rotation nearest to a matrix, row by row, to first order in its distance from one; of any norm.
fn of_matrix(m: &[f64; 9]) -> Quat<f64> {
    let r = |i: usize, j: usize| m[3 * i + j];
    let scale = (m.iter().map(|x| x * x).sum::<f64>() / 3.0).sqrt();
    // four times the squared components; the largest is at least 1, so its root loses nothing
    let squares = [
        scale + r(0, 0) + r(1, 1) + r(2, 2),
        scale + r(0, 0) - r(1, 1) - r(2, 2),
        scale - r(0, 0) + r(1, 1) - r(2, 2),
        scale - r(0, 0) - r(1, 1) + r(2, 2),
    ];
    let largest = (1..4).fold(0, |best, k| if squares[k] > squares[best] { k } else { best });
    let d = squares[largest];
    let (yz, zx, xy) = (r(2, 1) - r(1, 2), r(0, 2) - r(2, 0), r(1, 0) - r(0, 1));
    let (syz, szx, sxy) = (r(2, 1) + r(1, 2), r(0, 2) + r(2, 0), r(1, 0) + r(0, 1));
    Quat::from_components(match largest {
        0 => [d, yz, zx, xy],
        1 => [yz, d, sxy, szx],
        2 => [zx, sxy, d, syz],
        _ => [xy, szx, syz, d],
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::rotation::rotation_angle;

    /// Also where the square of its norm is below the doubles or above them.
    #[test]
    fn an_attitude_of_any_size_has_norm_one() {
        let attitude = |attitudes: Attitudes| {
            let record = Trajectory::new(vec![0.0]).with_attitude(attitudes);
            Reading::default().attitude(&record, 0).unwrap().components()
        };
        for size in [1e-300, 1e-160, 1.0, 1e160, 1e300] {
            let found = attitude(Attitudes::Quaternions(vec![[0.6 * size, 0.0, 0.8 * size, 0.0]]));
            let off = found.iter().zip([0.6_f64, 0.0, 0.8, 0.0]).map(|(x, right)| (x - right).abs());
            assert!(off.fold(0.0, f64::max) < 1e-15, "{size:e}: {found:?}");
        }
        // tan(φ/4) of nearly a whole turn
        assert_eq!(attitude(Attitudes::Rodrigues(vec![[1e100, 0.0, 0.0]]))[0], -1.0);
    }

    #[test]
    fn a_matrix_and_its_quaternion_rotate_alike() {
        for components in
            [[0.9, -0.2, 0.3, 0.1], [0.1, 0.8, -0.2, 0.4], [0.0, 0.2, 0.9, 0.1], [0.1, 0.1, 0.2, -0.7]]
        {
            let q = Quat::from_components(components).normalized();
            let columns = [0, 1, 2].map(|k| q.rotate(Vec3::unit(k)));
            let matrix = core::array::from_fn(|n| columns[n % 3][n / 3]);
            assert!(rotation_angle(of_matrix(&matrix), q) < 1e-15);
        }
    }
}

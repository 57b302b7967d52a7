//! Orientations and places as models write them.

use nalgebra::{Quaternion, UnitQuaternion, Vector3};
use polhode::num::trig::sin_cos;

use crate::numbers::turn;

/// A place and an orientation in the frame around it.
#[derive(Clone, Copy, Debug)]
pub(super) struct Pose {
    pub(super) at: Vector3<f64>,
    pub(super) turn: UnitQuaternion<f64>,
}

impl Pose {
    pub(super) fn identity() -> Self {
        Pose { at: Vector3::zeros(), turn: UnitQuaternion::identity() }
    }

    /// The frame `inner`, given in this one, as seen from outside.
    pub(super) fn around(&self, inner: &Pose) -> Pose {
        Pose { at: self.at + self.turn * inner.at, turn: product(self.turn, inner.turn) }
    }
}

fn product(a: UnitQuaternion<f64>, b: UnitQuaternion<f64>) -> UnitQuaternion<f64> {
    UnitQuaternion::new_normalize(a.into_inner() * b.into_inner())
}

/// The turn by `angle` about the unit vector `axis`.
pub(super) fn about(axis: Vector3<f64>, angle: f64) -> UnitQuaternion<f64> {
    let (sin, cos) = sin_cos(0.5 * angle);
    UnitQuaternion::new_normalize(Quaternion::from_parts(cos, axis * sin))
}

/// The turn by `roll` about x, then `pitch` about y, then `yaw` about z, all fixed axes.
pub(super) fn roll_pitch_yaw([roll, pitch, yaw]: [f64; 3]) -> UnitQuaternion<f64> {
    let [x, y, z] = [Vector3::x(), Vector3::y(), Vector3::z()];
    product(about(z, yaw), product(about(y, pitch), about(x, roll)))
}

/// That angles in radians go beyond a full turn, as angles in degrees would, in words; 2 π may be typed with three digits.
pub(super) fn beyond_a_turn(angles: &[f64]) -> Option<String> {
    let largest = angles.iter().fold(0.0, |most: f64, angle| most.max(angle.abs()));
    (largest > 1.01 * core::f64::consts::TAU).then(|| {
        format!("its axes turn by an angle of {largest} rad, more than a full turn: is it in degrees? the file says radians")
    })
}

/// A turn by angles x, y, z in the order of `sequence`: axes of the turned frame in small letters, fixed ones in capitals.
///
/// `None` of letters that are no axes.
pub(super) fn euler(angles: [f64; 3], sequence: &str) -> Option<UnitQuaternion<f64>> {
    let mut turn = UnitQuaternion::identity();
    let mut letters = 0;
    for (angle, letter) in angles.into_iter().zip(sequence.chars()) {
        let axis = match letter.to_ascii_lowercase() {
            'x' => Vector3::x(),
            'y' => Vector3::y(),
            'z' => Vector3::z(),
            _ => return None,
        };
        let next = about(axis, angle);
        turn = if letter.is_ascii_lowercase() { product(turn, next) } else { product(next, turn) };
        letters += 1;
    }
    (letters == 3 && sequence.chars().count() == 3).then_some(turn)
}

/// The least turn that takes z to `direction`; `None` of zeros.
pub(super) fn z_to(direction: Vector3<f64>) -> Option<UnitQuaternion<f64>> {
    let unit = unit(direction)?;
    // half of the angle between: cos = sqrt((1 + z)/2), and the axis is z x direction
    if unit.z < 0.0 && unit.x == 0.0 && unit.y == 0.0 {
        return turn([0.0, 1.0, 0.0, 0.0]);
    }
    // (1 + z, z x u) without cancellation next to −z
    let w = if unit.z > 0.0 { 1.0 + unit.z } else { (unit.x * unit.x + unit.y * unit.y) / (1.0 - unit.z) };
    turn([w, -unit.y, unit.x, 0.0])
}

/// The axes x and y of a frame, of which y is made orthogonal to x; `None` where they have no plane.
pub(super) fn x_and_y(x: Vector3<f64>, y: Vector3<f64>) -> Option<UnitQuaternion<f64>> {
    let x = unit(x)?;
    let y = unit(y)?;
    let y = unit(y - x * x.dot(&y))?;
    let z = x.cross(&y);
    let matrix = nalgebra::Matrix3::from_columns(&[x, y, z]);
    Some(UnitQuaternion::from_rotation_matrix(&nalgebra::Rotation3::from_matrix_unchecked(matrix)))
}

/// The unit vector along `v`, whatever its size; `None` of zeros.
pub(super) fn unit(v: Vector3<f64>) -> Option<Vector3<f64>> {
    let largest = v.amax();
    (largest > 0.0 && largest.is_finite()).then(|| (v / largest).normalize())
}

/// Turns by multiples of a right angle within 1e-11 are exactly that: π is typed with so many digits or fewer.
pub(super) fn quarter_turns_exact(q: UnitQuaternion<f64>) -> UnitQuaternion<f64> {
    let half = 0.5_f64;
    let root = half.sqrt();
    let near = |x: f64| {
        let snapped = [0.0, half, root, 1.0].into_iter().find(|known| (x.abs() - known).abs() < 1e-11)?;
        Some(snapped.copysign(x))
    };
    let components = [q.w, q.i, q.j, q.k];
    match components.map(near) {
        [Some(w), Some(x), Some(y), Some(z)] => turn([w, x + 0.0, y + 0.0, z + 0.0]).unwrap_or(q),
        _ => q,
    }
}

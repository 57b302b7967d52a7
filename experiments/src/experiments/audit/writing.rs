//! Rows in a random convention, as a program would write them.

use nalgebra::UnitQuaternion;
use polhode::audit::{
    AngleUnit, Angles, Attitudes, Direction, Frame, QuaternionOrder, RateUnit, Reading, Trajectory, Turns,
};
use polhode::num::Random;
use polhode::rotation::EulerSequence;

use super::motion::Row;

/// What the attitude is written as.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Form {
    Quaternion,
    Matrix,
    Angles,
    Rodrigues,
}

/// How numbers are written.
#[derive(Clone, Copy, Debug)]
pub(super) struct Writing {
    pub(super) single: bool,
    pub(super) digits: usize,
    /// Of each number, relative to the size of its column.
    pub(super) noise: f64,
}

impl Writing {
    pub(super) const WHOLE: Writing = Writing { single: false, digits: 17, noise: 0.0 };

    pub(super) fn random(random: &mut Random) -> Self {
        let noise = if random.below(2) == 0 { 0.0 } else { libm::exp10(random.between(-9.0, -3.0)) };
        Writing { single: random.below(4) == 0, digits: 6 + random.below(12) as usize, noise }
    }

    /// The relative error that it causes, about.
    pub(super) fn resolution(self) -> f64 {
        let single = if self.single { 6e-8 } else { 0.0 };
        (0.5 * libm::exp10(1.0 - self.digits as f64)).max(single).max(self.noise)
    }

    /// What limits the numbers.
    pub(super) fn limit(self) -> &'static str {
        match self {
            Writing { noise, .. } if noise > 0.0 => "noise",
            Writing { single: true, .. } => "float32",
            Writing { digits: 6..12, .. } => "6 to 11 digits",
            _ => "12 to 17 digits",
        }
    }

    pub(super) fn number(self, random: &mut Random, x: f64, size: f64) -> f64 {
        let noisy = if self.noise > 0.0 { x + self.noise * size * random.normal() } else { x };
        let kept = if self.single { f64::from(noisy as f32) } else { noisy };
        // seventeen digits are every double
        if self.digits >= 17 { kept } else { format!("{kept:.*e}", self.digits - 1).parse().unwrap_or(kept) }
    }
}

/// A convention for the form; the order of the moments is another matter.
pub(super) fn convention(random: &mut Random, form: Form) -> Reading {
    let mut reading = Reading::default();
    reading.attitude = Some(one_of(random, [Direction::BodyToSpace, Direction::SpaceToBody]));
    reading.omega_frame = Some(one_of(random, [Frame::Body, Frame::Space]));
    reading.rate_unit = Some(one_of(random, RateUnit::ALL));
    match form {
        Form::Quaternion => {
            let orders = [QuaternionOrder::ScalarFirst, QuaternionOrder::ScalarLast];
            reading.quaternion = Some(one_of(random, orders));
        }
        Form::Angles => {
            reading.angles = Some(Angles {
                sequence: one_of(random, EulerSequence::ALL),
                turns: one_of(random, [Turns::Intrinsic, Turns::Extrinsic]),
                unit: one_of(random, [AngleUnit::Radians, AngleUnit::Degrees]),
            });
        }
        Form::Matrix | Form::Rodrigues => {}
    }
    reading
}

pub(super) fn one_of<T: Copy, const N: usize>(random: &mut Random, items: [T; N]) -> T {
    items[random.below(N as u64) as usize]
}

/// `rows` as `reading` has them.
pub(super) fn written(
    random: &mut Random,
    rows: &[Row],
    reading: &Reading,
    form: Form,
    how: Writing,
) -> Trajectory {
    let unit = reading.rate_unit.map_or(1.0, |unit| unit.radians_per_second(1.0));
    let squares = rows.iter().map(|row| row.omega.norm_squared()).sum::<f64>();
    let size = (squares / rows.len() as f64).sqrt() / unit;
    let mut quaternions = Vec::new();
    let mut matrices = Vec::new();
    let mut triples = Vec::new();
    let mut rates = Vec::new();
    for row in rows {
        let turn: UnitQuaternion<f64> = row.attitude.normalized().into();
        let turn = if reading.attitude == Some(Direction::SpaceToBody) { turn.inverse() } else { turn };
        match form {
            Form::Quaternion => {
                let mut q = [turn.w, turn.i, turn.j, turn.k];
                if reading.quaternion == Some(QuaternionOrder::ScalarLast) {
                    q.rotate_left(1);
                }
                quaternions.push(q.map(|x| how.number(random, x, 1.0)));
            }
            Form::Matrix => {
                let m = turn.to_rotation_matrix();
                let entries: [f64; 9] = std::array::from_fn(|n| m[(n / 3, n % 3)]);
                matrices.push(entries.map(|x| how.number(random, x, 1.0)));
            }
            Form::Rodrigues => {
                let sign = if turn.w < 0.0 { -1.0 } else { 1.0 };
                let sigma = [turn.i, turn.j, turn.k].map(|x| sign * x / (1.0 + sign * turn.w));
                triples.push(sigma.map(|x| how.number(random, x, 1.0)));
            }
            Form::Angles => {
                let unit = reading.angles.map_or(1.0, |angles| angles.unit.radians());
                triples.push(angles(reading, turn).map(|x| how.number(random, x / unit, 1.0 / unit)));
            }
        }
        let omega = match reading.omega_frame {
            Some(Frame::Space) => row.attitude.normalized().rotate(row.omega),
            _ => row.omega,
        };
        rates.push(omega.0.map(|x| how.number(random, x / unit, size)));
    }
    let attitude = match form {
        Form::Quaternion => Attitudes::Quaternions(quaternions),
        Form::Matrix => Attitudes::Matrices(matrices),
        Form::Angles => Attitudes::Angles(triples),
        Form::Rodrigues => Attitudes::Rodrigues(triples),
    };
    Trajectory::new(rows.iter().map(|row| row.t).collect()).with_attitude(attitude).with_rates(rates)
}

/// Euler angles of a turn, rad.
fn angles(reading: &Reading, turn: UnitQuaternion<f64>) -> [f64; 3] {
    let Some(Angles { sequence, turns, .. }) = reading.angles else { return [0.0; 3] };
    if turns == Turns::Intrinsic {
        return sequence.angles(turn).angles;
    }
    // about fixed axes: the same turns about turned axes in the other order
    let reversed: Vec<usize> = sequence.axes().into_iter().rev().collect();
    let other = EulerSequence::ALL.into_iter().find(|other| other.axes()[..] == reversed[..]);
    let [a, b, c] = other.unwrap_or(sequence).angles(turn).angles;
    [c, b, a]
}

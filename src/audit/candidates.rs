//! All readings of the columns that a record has.

use super::{
    AngleUnit, Angles, Attitudes, Convention, Direction, Frame, QuaternionOrder, RateUnit, Reading,
    Trajectory, Turns,
};
use crate::rotation::EulerSequence;

/// The orders of three moments.
pub(super) const ORDERS: [[usize; 3]; 6] = [[0, 1, 2], [0, 2, 1], [1, 0, 2], [1, 2, 0], [2, 0, 1], [2, 1, 0]];

/// Readings of the attitude alone, each in both directions.
pub(super) fn attitudes(record: &Trajectory, claims: &Convention) -> Vec<Reading> {
    let plain = Reading::default();
    let numbers: Vec<Reading> = match &record.attitude {
        None => return vec![plain],
        Some(Attitudes::Quaternions(_)) => [QuaternionOrder::ScalarFirst, QuaternionOrder::ScalarLast]
            .map(|order| Reading { quaternion: Some(order), ..plain })
            .into(),
        Some(Attitudes::Matrices(_) | Attitudes::Rodrigues(_)) => vec![plain],
        Some(Attitudes::Angles(_)) => EulerSequence::ALL
            .into_iter()
            .flat_map(|sequence| {
                [Turns::Intrinsic, Turns::Extrinsic].into_iter().flat_map(move |turns| {
                    [AngleUnit::Radians, AngleUnit::Degrees]
                        .map(|unit| Reading { angles: Some(Angles { sequence, turns, unit }), ..plain })
                })
            })
            .collect(),
    };
    numbers
        .into_iter()
        .filter(|reading| claims.admit(reading))
        .flat_map(|reading| {
            [Direction::BodyToSpace, Direction::SpaceToBody]
                .map(|direction| Reading { attitude: Some(direction), ..reading })
        })
        .collect()
}

/// Readings of the angular velocity, or else of the angular momentum, beside the attitude that `attitude` reads.
pub(super) fn rates(record: &Trajectory, attitude: &Reading) -> Vec<Reading> {
    // without attitude, components in space tell nothing of the body
    let frames: &[Frame] =
        if attitude.attitude.is_some() { &[Frame::Body, Frame::Space] } else { &[Frame::Body] };
    let of_momentum = |reading: Reading| -> Vec<Reading> {
        if record.momentum.is_none() {
            return vec![reading];
        }
        frames.iter().map(|&frame| Reading { momentum_frame: Some(frame), ..reading }).collect()
    };
    if record.rates.is_none() {
        return of_momentum(*attitude);
    }
    frames
        .iter()
        .flat_map(|&frame| {
            RateUnit::ALL.map(|unit| Reading { omega_frame: Some(frame), rate_unit: Some(unit), ..*attitude })
        })
        .collect()
}

//! The readings by which the numbers of an exact motion are an exact motion: those that nobody can tell apart.

use polhode::audit::{
    AngleUnit, Angles, Direction, Frame, QuaternionOrder, RateUnit, Reading, Trajectory, Turns,
};
use polhode::flow::FreeMotion;
use polhode::inertia::Inertia;
use polhode::rotation::{EulerSequence, rotation_angle};

/// Orders of three moments.
pub(super) const ORDERS: [[usize; 3]; 6] = [[0, 1, 2], [0, 2, 1], [1, 0, 2], [1, 2, 0], [2, 0, 1], [2, 1, 0]];

/// An exact motion goes on from row to row within this, rad and relative; the others are off by about a turn.
const SAME: f64 = 1e-9;

/// All of them for the numbers of `record`, an exact motion with all its digits in the convention `truth`, of the body with the
/// moments `given`.
pub(super) fn alike(record: &Trajectory, truth: &Reading, given: [f64; 3]) -> Vec<Reading> {
    readings(truth).into_iter().filter(|reading| moves_exactly(record, reading, given)).collect()
}

/// Every convention of the columns that `truth` has.
fn readings(truth: &Reading) -> Vec<Reading> {
    let mut found = Vec::new();
    let mut attitudes = Vec::new();
    match (truth.quaternion, truth.angles) {
        (Some(_), _) => {
            for order in [QuaternionOrder::ScalarFirst, QuaternionOrder::ScalarLast] {
                let mut reading = *truth;
                reading.quaternion = Some(order);
                attitudes.push(reading);
            }
        }
        (None, Some(_)) => {
            for sequence in EulerSequence::ALL {
                for turns in [Turns::Intrinsic, Turns::Extrinsic] {
                    for unit in [AngleUnit::Radians, AngleUnit::Degrees] {
                        let mut reading = *truth;
                        reading.angles = Some(Angles { sequence, turns, unit });
                        attitudes.push(reading);
                    }
                }
            }
        }
        (None, None) => attitudes.push(*truth),
    }
    for attitude in attitudes {
        for direction in [Direction::BodyToSpace, Direction::SpaceToBody] {
            for frame in [Frame::Body, Frame::Space] {
                for unit in RateUnit::ALL {
                    for moments in ORDERS {
                        let mut reading = attitude;
                        reading.attitude = Some(direction);
                        reading.omega_frame = Some(frame);
                        reading.rate_unit = Some(unit);
                        reading.moments = moments;
                        found.push(reading);
                    }
                }
            }
        }
    }
    found
}

fn moves_exactly(record: &Trajectory, reading: &Reading, given: [f64; 3]) -> bool {
    let Ok(inertia) = Inertia::from_moments(reading.moments.map(|k| given[k])) else { return false };
    let last = record.times.len() - 2;
    [0, last / 3, last / 2, last].into_iter().all(|row| {
        let read = |row: usize| Some((reading.attitude(record, row)?, reading.omega_body(record, row)?));
        let (Some((attitude, omega)), Some((next, rate))) = (read(row), read(row + 1)) else { return false };
        let Ok(motion) = FreeMotion::from_omega(&inertia, attitude.into(), omega.into()) else {
            return false;
        };
        let interval = record.times[row + 1] - record.times[row];
        let Ok(state) = motion.at(interval) else { return false };
        let reached = polhode::Body::free(inertia.clone()).omega_body(&state);
        rotation_angle(state.attitude, next) < SAME
            && (reached - nalgebra::Vector3::from(rate)).norm() < SAME * rate.norm()
    })
}

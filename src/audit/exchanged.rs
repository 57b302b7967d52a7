//! Records whose rows are all exchanged with a neighbour.

use super::bodies::Told;
use super::columns::angle_between;
use super::deviation::{Allowances, deviation};
use super::{Attitudes, Fault, Judgement, Misplaced, Reading, Trajectory};
use crate::body::Body;
use crate::rotation::Vec3;

/// Rows that are looked at first.
const LOOKS: usize = 256;

/// The share of them at which the state goes back and forth.
const SHARE: f64 = 0.8;

/// The fault of a record that is right once each two neighbours change places; `None` of any other.
pub(super) fn exchanged(
    record: &Trajectory,
    reading: &Reading,
    body: &Body,
    told: Option<&Told>,
    allowed: &Allowances,
) -> Option<Fault> {
    let rows = record.times.len();
    if !goes_back_and_forth(record, reading) {
        return None;
    }
    [0, 1].into_iter().find_map(|first| {
        let mut swapped = record.clone();
        let pairs = (first..rows - 1).step_by(2);
        for row in pairs.clone() {
            swap(&mut swapped, row);
        }
        let found = deviation(&swapped, reading, body, told, false, allowed)?;
        let largest = pairs.clone().map(|row| change(record, reading, row, row + 1)).fold(0.0, f64::max);
        let fault =
            Fault::Misplaced { what: Misplaced::Exchanged, row: first, count: 2 * pairs.len(), largest };
        (found.judgement == Judgement::Right).then_some(fault)
    })
}

/// Whether a state is nearer to the one but next than the neighbours between them are to each other.
fn goes_back_and_forth(record: &Trajectory, reading: &Reading) -> bool {
    let last = record.times.len() - 3;
    let some: Vec<usize> = (0..=last).step_by(last.div_ceil(LOOKS).max(1)).collect();
    let back = some.iter().filter(|&&row| {
        let beside = change(record, reading, row, row + 1).max(change(record, reading, row + 1, row + 2));
        change(record, reading, row, row + 2) < beside
    });
    back.count() as f64 > SHARE * some.len() as f64
}

/// From one row to another, rad, or relative where the record has no attitude.
fn change(record: &Trajectory, reading: &Reading, from: usize, to: usize) -> f64 {
    let attitudes = reading.attitude(record, from).zip(reading.attitude(record, to));
    if let Some((p, q)) = attitudes {
        return angle_between(p, q);
    }
    let vectors = record.rates.as_ref().or(record.momentum.as_ref());
    vectors.map_or(0.0, |vectors| {
        let [a, b] = [from, to].map(|row| Vec3(vectors[row]));
        (a - b).norm() / a.norm().max(f64::MIN_POSITIVE)
    })
}

/// Exchanges what the rows `row` and `row + 1` hold, but for their times.
fn swap(record: &mut Trajectory, row: usize) {
    match &mut record.attitude {
        Some(Attitudes::Quaternions(rows)) => rows.swap(row, row + 1),
        Some(Attitudes::Matrices(rows)) => rows.swap(row, row + 1),
        Some(Attitudes::Angles(rows) | Attitudes::Rodrigues(rows)) => rows.swap(row, row + 1),
        None => {}
    }
    for vectors in [&mut record.rates, &mut record.momentum].into_iter().flatten() {
        vectors.swap(row, row + 1);
    }
}

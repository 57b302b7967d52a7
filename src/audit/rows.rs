//! Rows that are looked at: windows over which the body turns by part of a radian, spread over the record.

use super::{AngleUnit, Attitudes, Trajectory};
use crate::record::median;
use crate::rotation::Vec3;

/// The turn of a window, rad, where rows are close enough.
const TURN: f64 = 0.7;

/// Most windows.
const MOST: usize = 96;

/// Windows of which a row turns by less than this, rad, are never left out.
const CALM: f64 = 0.1;

/// Nor are those that turn by less than this many times what the slowest tenth does.
const STEADY: f64 = 3.0;

/// Fewest that are kept.
const FEWEST: usize = 10;

/// Most rows between the ends of a window that the kinematics are integrated over.
const NODES: usize = 8;

/// The windows of a record.
#[derive(Clone, Debug)]
pub(super) struct Windows {
    /// First rows.
    pub(super) starts: Vec<usize>,
    /// Rows of a window.
    pub(super) stride: usize,
    /// Rows between the nodes of a window: a divisor of the stride.
    pub(super) node: usize,
}

impl Windows {
    /// `pieces`: how many windows in a row are looked at together.
    pub(super) fn of(record: &Trajectory, pieces: usize) -> Self {
        let rows = record.times.len();
        let turn = typical_turn(record);
        let longest = ((rows - 1) / (4 * pieces)).max(1);
        let wanted = if turn > 0.0 { (TURN / turn).min(longest as f64) } else { longest as f64 };
        let stride = (wanted as usize).clamp(1, longest);
        let node = stride.div_ceil(NODES);
        let stride = (stride / node).max(1) * node;
        let last = rows - 1 - pieces * stride;
        let count = MOST.min(last + 1);
        let spread = |count: usize, k: usize| if count > 1 { k * last / (count - 1) } else { 0 };
        // where a program has run away, the body turns too fast for its rows to tell
        let wide = (4 * MOST).min(last + 1);
        let of_window =
            |row: usize| (row..row + 3.min(stride)).map(|row| turn_between(record, row)).fold(0.0, f64::max);
        let mut turns: Vec<(f64, usize)> =
            (0..wide).map(|k| spread(wide, k)).map(|row| (of_window(row), row)).collect();
        turns.sort_by(|a, b| a.0.total_cmp(&b.0));
        let calm = CALM.max(STEADY * turns[turns.len() / 10].0);
        let calm = turns.partition_point(|(turn, _)| *turn <= calm).max(FEWEST.min(turns.len()));
        let mut kept: Vec<usize> = turns[..calm].iter().map(|(_, row)| *row).collect();
        kept.sort_unstable();
        let count = count.min(kept.len());
        let starts = (0..count).map(|k| kept[k * kept.len() / count]).collect();
        Windows { starts, stride, node }
    }
}

/// How far the body turns between neighbouring rows, typically, rad: the same by every reading of a column but that of
/// Euler angles, of which it is the middle of the changes.
pub(super) fn typical_turn(record: &Trajectory) -> f64 {
    let rows = record.times.len();
    let count = 256.min(rows - 1);
    let mut turns: Vec<f64> = (0..count).map(|k| turn_between(record, k * (rows - 1) / count)).collect();
    median(&mut turns).unwrap_or(0.0)
}

/// How far the body turns between the rows `row` and `row + 1`, rad, or its angular velocity turns, whichever is more: a wrong
/// unit parts the two.
fn turn_between(record: &Trajectory, row: usize) -> f64 {
    let by_rates = record.rates.as_ref().or(record.momentum.as_ref()).map_or(0.0, |rates| {
        let (a, b) = (Vec3(rates[row]), Vec3(rates[row + 1]));
        libm::atan2(a.cross(b).norm(), a.dot(b))
    });
    record.attitude.as_ref().map_or(0.0, |attitude| attitude.turn(row)).max(by_rates)
}

impl Attitudes {
    /// The angle between the rows `row` and `row + 1`, rad.
    pub(super) fn turn(&self, row: usize) -> f64 {
        let (a, b) = (self.row(row), self.row(row + 1));
        let dot = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
        let apart =
            |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| (a - b) * (a - b)).sum::<f64>().sqrt();
        match self {
            Attitudes::Quaternions(_) => {
                let norm = dot(a, a).sqrt();
                // of q and −q the nearer; the chord keeps the digits of a small angle
                let chord =
                    apart(a, b).min(a.iter().zip(b).map(|(a, b)| (a + b) * (a + b)).sum::<f64>().sqrt());
                4.0 * libm::asin((0.5 * chord / norm).min(1.0))
            }
            Attitudes::Matrices(_) => {
                let norm = (dot(a, a) / 3.0).sqrt();
                2.0 * libm::asin((apart(a, b) / norm / 8_f64.sqrt()).min(1.0))
            }
            Attitudes::Rodrigues(_) => {
                let lift = |s: &[f64]| {
                    let square = dot(s, s);
                    [1.0 - square, 2.0 * s[0], 2.0 * s[1], 2.0 * s[2]].map(|x| x / (1.0 + square))
                };
                Attitudes::Quaternions(vec![lift(a), lift(b)]).turn(0)
            }
            Attitudes::Angles(rows) => {
                // angles in rad stay below a turn and a half; those above are in degrees
                let some = rows.iter().step_by(rows.len().div_ceil(64)).flatten();
                let degrees = some.clone().any(|x| x.abs() > 10.0);
                apart(a, b) * if degrees { AngleUnit::Degrees.radians() } else { 1.0 }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn windows_over_a_slow_body_take_a_quarter_of_the_record() {
        let record =
            Trajectory::new((0..401).map(f64::from).collect()).with_rates(vec![[0.0, 0.0, 1e-6]; 401]);
        for pieces in [1, 2, 3] {
            let windows = Windows::of(&record, pieces);
            let rows = pieces * windows.stride;
            assert!(rows <= 100 && rows > 85, "{pieces} of {}", windows.stride);
            assert_eq!(windows.stride % windows.node, 0);
            assert!(windows.starts.iter().all(|first| first + rows <= 400) && windows.starts.len() > 50);
        }
    }
}

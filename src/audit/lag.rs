//! Angular velocities of another scale, or of other times, than those of the attitudes beside them.

use super::bodies::Told;
use super::deviation::{Allowances, GROUPS};
use super::motion::motion;
use super::resolution::triples;
use super::start::{Start, Weights, distances, fitted};
use super::states::states;
use super::{Fault, Reading, Trajectory};
use crate::body::Body;
use crate::rotation::Vec3;

/// What the angular velocity of the first row may be off, relative.
const OFF: f64 = 0.03;

/// A step that derivatives are taken by, rad.
const STEP: f64 = 1e-4;

const ITERATIONS: usize = 4;

/// The part of the deviations that is left where a factor or a lag explains them.
const LEFT: f64 = 0.1;

/// The fault of a record whose attitudes are a motion of the body, and whose angular velocities are those of that motion times one
/// factor, or at times that are earlier or later by one lag, such as half a step; `None` of any other.
pub(super) fn lag(
    record: &Trajectory,
    reading: &Reading,
    body: &Body,
    told: Option<&Told>,
    allowed: &Allowances,
) -> Option<Fault> {
    record.attitude.as_ref().zip(record.rates.as_ref())?;
    let rows = states(record, reading, body, &triples(record.times.len(), GROUPS));
    let squares = rows.iter().map(|row| row.omega.norm_squared()).sum::<f64>();
    let size = (squares / rows.len() as f64).sqrt();
    let first = Start { row: *rows.first()?, body: body.clone() };
    let weights = Weights { attitude: allowed.attitude.rounding.max(1e-15), rates: OFF, size };
    // to the attitudes alone
    let start = fitted(&first, told, &rows, weights, false, false)?;
    let most = allowed.attitude.largest(record.times.len());
    if distances(&start, &rows, true)?.iter().any(|(turn, _)| turn.norm() > most) {
        return None;
    }
    let rates_at = |lag: f64| {
        let exact = motion(&start.body, &start.row, rows.iter().map(|row| row.time + lag), false)?;
        Some(exact.into_iter().map(|(_, omega)| omega).collect::<Vec<Vec3<f64>>>())
    };
    let step = STEP / size;
    let (mut lag, mut exact) = (0.0, rates_at(0.0)?);
    let left = |exact: &[Vec3<f64>]| {
        rows.iter().zip(exact).map(|(row, omega)| (row.omega - *omega).norm_squared()).sum::<f64>()
    };
    let is_explained = |exact: &[Vec3<f64>], before: f64| left(exact) < LEFT * LEFT * before;
    let before = left(&exact);
    let sums = rows.iter().zip(&exact).fold((0.0, 0.0), |(along, square), (row, omega)| {
        (along + row.omega.dot(*omega), square + omega.norm_squared())
    });
    let factor = sums.0 / sums.1;
    let scaled: Vec<Vec3<f64>> = exact.iter().map(|omega| *omega * factor).collect();
    if is_explained(&scaled, before) {
        return Some(Fault::ScaledRates { factor });
    }
    for _ in 0..ITERATIONS {
        let later = rates_at(lag + step)?;
        let (mut along, mut square) = (0.0, 0.0);
        for ((row, omega), later) in rows.iter().zip(&exact).zip(&later) {
            let change = (*later - *omega) * (1.0 / step);
            along += (row.omega - *omega).dot(change);
            square += change.norm_squared();
        }
        lag += along / square;
        // beyond a part of a turn the search leads anywhere
        if lag.is_nan() || lag.abs() * size > 1.0 {
            return None;
        }
        exact = rates_at(lag)?;
    }
    is_explained(&exact, before).then_some(Fault::ShiftedRates { lag })
}

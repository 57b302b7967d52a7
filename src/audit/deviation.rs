//! How far a record is from the motion that starts like it, and what of that its noise explains.

use super::resolution::{noise, triples};
use super::start::{Start, Weights, distances, fitted};
use super::states::{Row, states};
use super::{AttitudeError, Judgement, Reading, Trajectory};
use crate::body::Body;
use crate::rotation::Vec3;

/// Groups of three rows that are compared.
const GROUPS: usize = 128;

/// Residuals whose root mean square is at most this many times the noise between neighbours are noise.
const IS_NOISE: f64 = 1.25;

/// Those above are not.
const IS_NONE: f64 = 1.6;

/// Distances from the motion that are small, rad or relative; larger ones are no noise.
const SMALL: f64 = 0.3;

/// The turn between rows, rad, above which an error that swings with the motion looks like noise.
const COARSE: f64 = 0.8;

/// Distances from one motion.
#[derive(Clone, Debug)]
struct Distance {
    start: Start,
    /// In space, rad.
    turns: Vec<Vec3<f64>>,
    /// Relative.
    rates: Vec<Vec3<f64>>,
}

/// What is known of the distance of a record from the exact motion.
pub(super) struct Deviation {
    pub(super) judgement: Judgement,
    /// `None` without attitude.
    pub(super) error: Option<AttitudeError>,
    /// Noise of a component, rad.
    pub(super) attitude_noise: f64,
    /// Noise of a component, relative.
    pub(super) rates_noise: f64,
    /// The start of the motion that it is measured from.
    pub(super) start: Start,
}

impl Distance {
    fn of(start: &Start, rows: &[Row], size: f64) -> Option<Self> {
        let (turns, rates) = distances(start, rows, true)?
            .into_iter()
            .map(|(turn, omega)| (turn, omega * (1.0 / size)))
            .unzip();
        Some(Distance { start: start.clone(), turns, rates })
    }

    fn largest(vectors: &[Vec3<f64>]) -> (f64, usize) {
        let all = vectors.iter().map(|v| v.norm()).enumerate();
        all.fold((0.0, 0), |most, (row, size)| if size > most.0 { (size, row) } else { most })
    }

    /// Root mean square of a component.
    fn spread(vectors: &[Vec3<f64>]) -> f64 {
        (vectors.iter().map(|v| v.norm_squared()).sum::<f64>() / (3 * vectors.len().max(1)) as f64).sqrt()
    }
}

/// Noise of a component of `vectors` at `rows`, of which only the small are looked at: a rotation vector of half a turn jumps.
fn noise_of(rows: &[usize], vectors: &[Vec3<f64>]) -> f64 {
    let (rows, vectors): (Vec<usize>, Vec<Vec3<f64>>) =
        rows.iter().zip(vectors).filter(|(_, v)| v.norm() < SMALL).unzip();
    let squares = [0, 1, 2].map(|axis| {
        let values: Vec<f64> = vectors.iter().map(|v| v[axis]).collect();
        let of_axis = noise(&rows, &values);
        of_axis * of_axis
    });
    (squares.iter().sum::<f64>() / 3.0).sqrt()
}

/// Compares `record` by `reading` with the motion of `body`; `shape`: whose tensor may be fitted. `rounding` of the attitude, rad,
/// and of the numbers, relative.
pub(super) fn deviation(
    record: &Trajectory,
    reading: &Reading,
    body: &Body,
    shape: bool,
    tolerance: f64,
    [angle_rounding, rounding]: [f64; 2],
) -> Option<Deviation> {
    let rows = states(record, reading, body, &triples(record.times.len(), GROUPS));
    let measured_rates = record.rates.is_some() || record.momentum.is_some();
    let has_attitude = record.attitude.is_some();
    let numbers: Vec<usize> = rows.iter().map(|row| row.row).collect();
    let mean_square = rows.iter().map(|row| row.omega.norm_squared()).sum::<f64>() / rows.len().max(1) as f64;
    let size = mean_square.sqrt();
    let first = Start { row: *rows.first()?, body: body.clone() };
    if size.partial_cmp(&0.0) != Some(core::cmp::Ordering::Greater) {
        return None;
    }
    let judge = |distance: &Distance| {
        let part = |vectors: &[Vec3<f64>], rounding: f64| {
            let noise = noise_of(&numbers, vectors).max(0.4 * rounding);
            let (largest, spread) = (Distance::largest(vectors).0, Distance::spread(vectors));
            let judgement = if largest <= tolerance.max(1.5 * rounding) {
                Judgement::Right
            } else if largest > 1.0 {
                Judgement::Wrong
            } else if spread <= IS_NOISE * noise {
                let coarse = rows.windows(2).any(|pair| {
                    pair[1].row == pair[0].row + 1 && (pair[1].time - pair[0].time) * size > COARSE
                });
                if coarse && spread > rounding { Judgement::Undecided } else { Judgement::Right }
            } else if spread <= IS_NONE * noise {
                Judgement::Undecided
            } else {
                Judgement::Wrong
            };
            (judgement, noise)
        };
        let attitude =
            if has_attitude { part(&distance.turns, angle_rounding) } else { (Judgement::Right, 0.0) };
        let rates = if measured_rates { part(&distance.rates, rounding) } else { (Judgement::Right, 0.0) };
        (worse(attitude.0, rates.0), attitude.1, rates.1)
    };
    let from_first = Distance::of(&first, &rows, size)?;
    let (mut judgement, mut attitude_noise, mut rates_noise) = judge(&from_first);
    let mut chosen = from_first.clone();
    let mut fitted_start = false;
    if judgement != Judgement::Right {
        let weigh = |noise: f64, rounding: f64| noise.max(rounding).max(1e-15);
        let weights = Weights {
            attitude: weigh(attitude_noise, angle_rounding),
            rates: weigh(rates_noise, rounding).max(if measured_rates { 0.0 } else { 1e-3 }),
            size,
        };
        let best = fitted(&first, &rows, weights, measured_rates, shape)
            .and_then(|start| Distance::of(&start, &rows, size));
        if let Some(best) = best {
            let (by_fit, attitude, rates) = judge(&best);
            if by_fit != Judgement::Wrong {
                (judgement, attitude_noise, rates_noise) = (by_fit, attitude, rates);
                (chosen, fitted_start) = (best, true);
            } else {
                judgement = Judgement::Wrong;
            }
        }
    }
    let (largest, at) = Distance::largest(&chosen.turns);
    let end = rows.len() - 1;
    let omega = rows[end].attitude.map_or(Vec3::zero(), |q| q.rotate(rows[end].omega));
    let along = if omega.norm() > 0.0 { chosen.turns[end].dot(omega) / omega.norm() } else { 0.0 };
    let across = (chosen.turns[end].norm_squared() - along * along).max(0.0).sqrt();
    let error = has_attitude.then(|| AttitudeError {
        largest,
        at: rows[at].time,
        phase: along,
        drift: across,
        fitted_start,
        from_first_row: Distance::largest(&from_first.turns).0,
    });
    Some(Deviation { judgement, error, attitude_noise, rates_noise, start: chosen.start })
}

/// The worse of two judgements.
fn worse(a: Judgement, b: Judgement) -> Judgement {
    let rank = |judgement| match judgement {
        Judgement::Right => 0,
        Judgement::Undecided => 1,
        Judgement::Wrong => 2,
    };
    if rank(a) >= rank(b) { a } else { b }
}

/// The attitude errors at `times` of a record, signed by their part along the motion.
pub(super) fn trace(record: &Trajectory, reading: &Reading, start: &Start, times: &[f64]) -> Vec<f64> {
    let at = |time: f64| record.times.partition_point(|t| *t < time).min(record.times.len() - 1);
    let numbers: Vec<usize> = times.iter().map(|&time| at(time)).collect();
    let rows = states(record, reading, &start.body, &numbers);
    let Some(all) = distances(start, &rows, false) else { return Vec::new() };
    let signed = rows.iter().zip(all).map(|(row, (turn, _))| {
        let omega = row.attitude.map_or(Vec3::zero(), |q| q.rotate(row.omega));
        if turn.dot(omega) < 0.0 { -turn.norm() } else { turn.norm() }
    });
    signed.collect()
}

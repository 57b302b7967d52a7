//! How far a record is from the motion that starts like it, and what of that its noise explains.

use super::bodies::Told;
use super::program::Dynamics;
use super::question::MOST;
use super::resolution::{noise, triples};
use super::signature::Flips;
use super::start::{Start, Weights, distances, fitted};
use super::states::{Row, states};
use super::sweep::{Allowance, Sweep, Tally};
use super::{AttitudeError, Judgement, Reading, Trajectory};
use crate::body::Body;
use crate::record::median;
use crate::rotation::Vec3;

/// Groups of three rows that are compared.
pub(super) const GROUPS: usize = 128;

/// Residuals whose root mean square is at most this many times the noise between neighbours are noise.
const IS_NOISE: f64 = 1.25;

/// Those above are not.
const IS_NONE: f64 = 1.6;

/// Distances from the motion that are small, rad or relative; larger ones are no noise.
const SMALL: f64 = 0.3;

/// The turn between rows, rad, above which an error that swings with the motion looks like noise.
const COARSE: f64 = 0.8;

/// The least noise of a column beside that of the other that a fit reckons with: its square, and what the rates of a motion grow
/// by, stay above what a fit leaves alone.
const APART: f64 = 1e-4;

/// A row that is this many times the spread of all rows away is none of noise.
const OUTLIER: f64 = 10.0;

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
    /// Whether some row is beyond what tolerance, digits and declared noise allow.
    pub(super) is_noisy: bool,
    /// Root mean square of ω at the rows that were looked at first, rad/s.
    pub(super) size: f64,
    /// Momenta of the record over those of the solver frame.
    pub(super) scale: f64,
    /// Rows further from the motion than is allowed in any column, ascending.
    pub(super) beyond: Vec<usize>,
    /// Changes of sign of the momentum along the middle axis in the record and in the motion, at the same rows; the same number
    /// where what the rows may be off makes the difference.
    pub(super) flips: [u64; 2],
}

/// What each column leaves open.
#[derive(Clone, Copy, Debug)]
pub(super) struct Allowances {
    /// What is asked of every column, rad and relative.
    pub(super) tolerance: f64,
    pub(super) attitude: Allowance,
    pub(super) rates: Allowance,
    pub(super) momentum: Allowance,
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

    /// The middle length.
    fn middle(vectors: &[Vec3<f64>]) -> f64 {
        let mut sizes: Vec<f64> = vectors.iter().map(|v| v.norm()).collect();
        median(&mut sizes).unwrap_or(0.0)
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

/// Compares `record` by `reading` with the motion of `body`, which has the wheels that are `told`; `shape`: whose tensor may be fitted. A start is looked for at some
/// rows; every row is judged.
pub(super) fn deviation(
    record: &Trajectory,
    reading: &Reading,
    body: &Body,
    told: Option<&Told>,
    shape: bool,
    allowed: &Allowances,
) -> Option<Deviation> {
    let rows = states(record, reading, body, &triples(record.times.len(), GROUPS));
    let measured_rates = record.rates.is_some() || record.momentum.is_some();
    let numbers: Vec<usize> = rows.iter().map(|row| row.row).collect();
    let mean_square = rows.iter().map(|row| row.omega.norm_squared()).sum::<f64>() / rows.len().max(1) as f64;
    let size = mean_square.sqrt();
    let first = Start { row: *rows.first()?, body: body.clone() };
    if size.partial_cmp(&0.0) != Some(core::cmp::Ordering::Greater) {
        return None;
    }
    let noise_at = |distance: &Distance| {
        let of = |vectors: &[Vec3<f64>], rounding: f64| noise_of(&numbers, vectors).max(0.4 * rounding);
        (of(&distance.turns, allowed.attitude.rounding), of(&distance.rates, allowed.rates.rounding))
    };
    let of_rates = if record.rates.is_some() { allowed.rates } else { allowed.momentum };
    let is_near = |distance: &Distance| {
        // without rates the first ω is read off attitudes: what that leaves open grows behind the rows that are compared here
        let part = if measured_rates { 1.0 } else { 0.5 };
        Distance::largest(&distance.turns).0 <= part * allowed.attitude.exact
            && (!measured_rates || Distance::largest(&distance.rates).0 <= of_rates.exact)
    };
    let from_first = Distance::of(&first, &rows, size)?;
    let noise = noise_at(&from_first);
    let mut chosen = from_first.clone();
    let mut fitted_start = false;
    if !is_near(&from_first) {
        let weigh = |noise: f64, rounding: f64| noise.max(rounding).max(1e-15);
        let attitude = weigh(noise.0, allowed.attitude.rounding);
        let rates = weigh(noise.1, of_rates.rounding).max(if measured_rates { 0.0 } else { 1e-3 });
        // beside a column that is far more exact the other would leave the start as it is
        let weights =
            Weights { attitude: attitude.max(APART * rates), rates: rates.max(APART * attitude), size };
        let best = fitted(&first, told, &rows, weights, measured_rates, shape)
            .and_then(|start| Distance::of(&start, &rows, size));
        // by the middle row: a few bad rows drag a fit, and leave the first row where it is
        let total = |distance: &Distance| {
            let of_rates =
                if measured_rates { Distance::middle(&distance.rates) / weights.rates } else { 0.0 };
            Distance::middle(&distance.turns) / weights.attitude + of_rates
        };
        if let Some(best) = best.filter(|best| total(best) < total(&from_first)) {
            (chosen, fitted_start) = (best, true);
        }
    }
    let noise = noise_at(&chosen);
    let scale = if shape {
        momentum_scale(record, reading, &chosen.start.body, &rows)
    } else {
        chosen.start.body.scale()
    };
    let sweep = Sweep { record, reading, start: &chosen.start, size, scale };
    let found = every_row(&sweep, allowed, &of_rates, noise)?;
    let judge = |tally: Option<&Tally>, allowance: &Allowance, noise: f64| {
        tally.map_or(Judgement::Right, |tally| of_column(tally, allowance, noise, size, record))
    };
    let judgement = worse(
        worse(
            judge(found.attitude.as_ref(), &allowed.attitude, noise.0),
            judge(found.rates.as_ref(), &of_rates, noise.1),
        ),
        judge(found.momentum.as_ref(), &allowed.momentum, 0.0),
    );
    let (along, across) = found.last.unwrap_or_default();
    let error = found.attitude.as_ref().map(|tally| AttitudeError {
        largest: tally.largest,
        at: record.times[tally.at],
        phase: along,
        drift: across,
        fitted_start,
        from_first_row: if fitted_start { Distance::largest(&from_first.turns).0 } else { tally.largest },
    });
    let tallies = [&found.attitude, &found.rates, &found.momentum];
    Some(Deviation {
        judgement,
        error,
        attitude_noise: noise.0,
        rates_noise: noise.1,
        beyond: found.beyond,
        is_noisy: tallies.iter().filter_map(|tally| tally.as_ref()).any(|tally| !tally.is_exact()),
        flips: found.flips,
        start: chosen.start,
        size,
        scale,
    })
}

/// What momenta of a body that was fitted, of whose size the motion tells nothing, are in units of the record.
fn momentum_scale(record: &Trajectory, reading: &Reading, body: &Body, rows: &[Row]) -> f64 {
    let dynamics = Dynamics::new(body);
    let sums = rows.iter().fold((0.0, 0.0), |(along, square), row| {
        let expected = dynamics.momentum(row.omega);
        let written = reading.momentum_body(record, row.row).unwrap_or(Vec3::zero());
        (along + written.dot(expected), square + expected.norm_squared())
    });
    // of momenta against the motion nothing is right
    (sums.0 / sums.1).max(f64::MIN_POSITIVE)
}

/// What a pass over all rows finds.
struct Every {
    attitude: Option<Tally>,
    /// Of what ω is read from, rates or momenta.
    rates: Option<Tally>,
    /// Of momenta beside rates.
    momentum: Option<Tally>,
    /// Of the last attitude: the error along the motion and across, rad.
    last: Option<(f64, f64)>,
    /// Rows beyond what is allowed in any column.
    beyond: Vec<usize>,
    flips: [u64; 2],
}

fn every_row(
    sweep: &Sweep<'_>,
    allowed: &Allowances,
    of_rates: &Allowance,
    noise: (f64, f64),
) -> Option<Every> {
    let record = sweep.record;
    let rows = record.times.len();
    let tally = |is_there: bool, allowance: Allowance| is_there.then(|| Tally::new(rows, allowance));
    let has_rates = record.rates.is_some() || record.momentum.is_some();
    let span = record.times.last().zip(record.times.first()).map_or(0.0, |(last, first)| last - first);
    let change = sweep.size * span / rows.max(2) as f64;
    let mut found = Every {
        attitude: tally(record.attitude.is_some(), allowed.attitude)
            .map(|tally| tally.moving(change, allowed.tolerance)),
        rates: tally(has_rates, *of_rates),
        momentum: tally(record.rates.is_some() && record.momentum.is_some(), allowed.momentum),
        last: None,
        beyond: Vec::new(),
        flips: [0, 0],
    };
    // a record that is off by at most `off` flips at least as often as the motion does beyond a threshold that is larger by it,
    // and at most as often as beyond one that is smaller by it
    let off = sweep.size * of_rates.largest(rows);
    let threshold = sweep.size * (6.0 * noise.1).max(2.0 * of_rates.largest(rows)).min(0.1);
    let mut flips = [threshold, threshold, threshold + off, (threshold - off).max(0.0)]
        .map(|threshold| Flips::new(&sweep.start.body, threshold));
    sweep.every(&mut |seen| {
        let add = |tally: &mut Option<Tally>, deviation: Option<Vec3<f64>>| {
            // a column without a number at this row is no column that was found right
            let nowhere = Vec3([f64::NAN; 3]);
            tally.as_mut().is_some_and(|tally| tally.add(seen.row, deviation.unwrap_or(nowhere)))
        };
        let beyond = [
            add(&mut found.attitude, seen.turn),
            add(&mut found.rates, seen.rates),
            add(&mut found.momentum, seen.momentum),
        ];
        if beyond.contains(&true) {
            found.beyond.push(seen.row);
        }
        if let Some(omega) = seen.omega {
            flips[0].see(omega);
            flips[1..].iter_mut().for_each(|flips| flips.see(seen.exact.1));
        }
        if let Some(turn) = seen.turn.filter(|_| seen.row + 1 == rows) {
            let omega = seen.exact.0.rotate(seen.exact.1);
            let along = if omega.norm() > 0.0 { turn.dot(omega) / omega.norm() } else { 0.0 };
            found.last = Some((along, (turn.norm_squared() - along * along).max(0.0).sqrt()));
        }
    })?;
    let [measured, exact, fewest, most] = flips.map(|flips| flips.count);
    let within = (fewest..=most).contains(&measured);
    found.flips = [measured, if within { measured } else { exact }];
    let seen = [&found.attitude, &found.rates].into_iter().flatten().all(|tally| tally.rows_seen() == rows);
    seen.then_some(found)
}

/// The judgement of one column. `noise`: root mean square of a component between neighbours.
fn of_column(tally: &Tally, allowance: &Allowance, noise: f64, size: f64, record: &Trajectory) -> Judgement {
    if tally.is_exact() || tally.is_declared_noise() {
        // digits or a noise that leave a tenth of a radian open, or of ω, decide nothing
        let decides = 1.5 * allowance.rounding <= MOST && allowance.noise <= MOST;
        return if decides { Judgement::Right } else { Judgement::Undecided };
    }
    let spread = tally.spread();
    let swings = record.times.windows(2).any(|pair| (pair[1] - pair[0]) * size > COARSE);
    let is_like_noise = tally.largest <= SMALL
        && spread <= if swings { IS_NONE } else { IS_NOISE } * noise
        && tally.largest <= OUTLIER * spread.max(allowance.rounding);
    if is_like_noise { Judgement::Undecided } else { Judgement::Wrong }
}

/// The worse of two judgements.
fn worse(a: Judgement, b: Judgement) -> Judgement {
    if b.is_better_than(a) { a } else { b }
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

#[cfg(test)]
mod tests {
    use super::*;

    /// Residuals of 1.4 times the noise between neighbours: an error that swings hides in it where rows are far apart.
    #[test]
    fn more_than_the_noise_between_neighbours_is_no_noise_unless_rows_are_far_apart() {
        let allowance = Allowance::of(1e-9, 1e-16, 0.0);
        let mut tally = Tally::new(200, allowance);
        for row in 0..200 {
            tally.add(row, Vec3([1e-3, 1e-3, if row % 2 == 0 { 1e-3 } else { -1e-3 }]));
        }
        let judged = |spread: f64, interval: f64| {
            let record = Trajectory::new((0..200).map(|k| interval * f64::from(k)).collect());
            of_column(&tally, &allowance, 1e-3 / spread, 1.0, &record)
        };
        assert_eq!([0.1, 1.0].map(|interval| judged(1.2, interval)), [Judgement::Undecided; 2]);
        assert_eq!(
            [0.1, 1.0].map(|interval| judged(1.4, interval)),
            [Judgement::Wrong, Judgement::Undecided]
        );
        assert_eq!([0.1, 1.0].map(|interval| judged(1.7, interval)), [Judgement::Wrong; 2]);
    }
}

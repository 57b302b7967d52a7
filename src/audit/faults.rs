//! What is odd about the sampling and the writing of a record.

use core::f64::consts::PI;

use super::resolution::Writing;
use super::{Attitudes, Fault, Reading, Trajectory};
use crate::record::median;
use crate::rotation::Vec3;

/// An interval this many times the usual one is a jump.
const JUMP: f64 = 1.5;

/// Rows with the same component of the angular velocity that make a plateau.
const PLATEAU: usize = 5;

/// Fewer digits than this are worth a word.
const FEW_DIGITS: u32 = 10;

/// A change of state this many times what nearly all rows show is a discontinuity.
const DISCONTINUITY: f64 = 25.0;

/// What is odd about the sampling and the writing of `record`, read by `reading`.
pub(super) fn faults(
    record: &Trajectory,
    reading: &Reading,
    writing: &Writing,
    tolerance: f64,
) -> Vec<Fault> {
    let mut found = Vec::new();
    let usual = usual_interval(record);
    let intervals = record.times.windows(2).map(|pair| pair[1] - pair[0]);
    let jumps: Vec<(usize, f64)> = intervals
        .enumerate()
        .filter(|(_, interval)| *interval > JUMP * usual)
        .map(|(k, dt)| (k + 1, dt))
        .collect();
    // of a record whose intervals differ anyhow, no one is a jump
    if let Some(&(row, interval)) = jumps.first().filter(|_| 20 * jumps.len() < record.times.len()) {
        found.push(Fault::TimeJump { row, interval, usual, count: jumps.len() });
    }
    found.extend(unit_of_times(record).map(|unit| Fault::RoundedTimes { unit }));
    found.extend(too_coarse(record, reading, usual));
    if let Some(Attitudes::Quaternions(rows)) = &record.attitude {
        let flips: Vec<usize> = rows
            .windows(2)
            .enumerate()
            .filter(|(_, pair)| pair[0].iter().zip(&pair[1]).map(|(a, b)| a * b).sum::<f64>() < 0.0)
            .map(|(k, _)| k + 1)
            .collect();
        if let Some(&row) = flips.first() {
            found.push(Fault::SignFlips { row, count: flips.len() });
        }
    }
    found.extend(not_normalized(record, tolerance.max(20.0 * writing.rounding())));
    found.extend(plateau(record));
    if writing.single_precision {
        found.push(Fault::SinglePrecision);
    } else if writing.digits < FEW_DIGITS {
        found.push(Fault::FewDigits { digits: writing.digits });
    }
    found
}

/// The middle interval.
fn usual_interval(record: &Trajectory) -> f64 {
    let mut intervals: Vec<f64> = record.times.windows(2).map(|pair| pair[1] - pair[0]).collect();
    median(&mut intervals).unwrap_or(0.0)
}

/// The part of a unit to which that is one is known.
const WHOLE: f64 = 1e-3;

/// The unit, s, to which the times of rows were rounded that follow each other evenly; `None` of any other times.
///
/// Between rounded times there are two intervals alone, one unit apart; a lost row makes two as well, one twice the other.
pub(super) fn unit_of_times(record: &Trajectory) -> Option<f64> {
    let times = &record.times;
    // the later rows, where the units of numbers of some digits are largest
    let intervals = times.windows(2).skip(times.len() / 2).map(|pair| pair[1] - pair[0]);
    let least = intervals.clone().fold(f64::INFINITY, f64::min);
    let most = intervals.clone().fold(0.0, f64::max);
    let unit = most - least;
    let is_power = |base: f64| {
        let power = (libm::log2(unit) / libm::log2(base)).round();
        (unit / libm::pow(base, power) - 1.0).abs() < WHOLE
    };
    let is_one_of_two = |interval: f64| (interval - least).min(most - interval) < WHOLE * unit;
    // between doubles that count from long ago the unit is a power of two
    let is_unit = unit > 1e-9 * least && (2.0 - WHOLE) * unit < least && (is_power(10.0) || is_power(2.0));
    if !is_unit || !intervals.clone().all(is_one_of_two) {
        return None;
    }
    let rows = || times.iter().enumerate().map(|(row, t)| (row as f64, t - times[0]));
    let count = times.len() as f64;
    let (middle, mean) = (0.5 * (count - 1.0), rows().map(|(_, t)| t).sum::<f64>() / count);
    let usual =
        rows().map(|(row, t)| (row - middle) * t).sum::<f64>() * 12.0 / (count * (count * count - 1.0));
    let is_even = rows().all(|(row, t)| (t - mean - usual * (row - middle)).abs() <= 0.75 * unit);
    is_even.then_some(unit)
}

fn too_coarse(record: &Trajectory, reading: &Reading, usual: f64) -> Option<Fault> {
    let rates = record.rates.as_ref()?;
    let squares = rates.iter().map(|w| Vec3(*w).norm_squared()).sum::<f64>() / rates.len() as f64;
    let angle = squares.sqrt() * reading.unit_of_rates() * usual;
    (angle > PI).then_some(Fault::TooCoarse { angle })
}

/// Attitudes whose norm is known, and the square of that by rows.
fn squares(record: &Trajectory) -> Option<(&Attitudes, impl Fn(usize) -> f64)> {
    let attitude = record.attitude.as_ref()?;
    let of_one = match attitude {
        Attitudes::Quaternions(_) => 1.0,
        Attitudes::Matrices(_) => 3.0,
        _ => return None,
    };
    Some((attitude, move |row| attitude.row(row).iter().map(|x| x * x).sum::<f64>() / of_one))
}

fn not_normalized(record: &Trajectory, threshold: f64) -> Option<Fault> {
    let (attitude, square) = squares(record)?;
    let errors = (0..attitude.len()).map(|row| (row, (square(row).sqrt() - 1.0).abs()));
    let (row, error) = errors.fold((0, 0.0), |most, next| if next.1 > most.1 { next } else { most });
    (error > threshold).then_some(Fault::NotNormalized { error, row })
}

/// Rows whose quaternion has another norm than most have, or whose matrix is no multiple of a rotation, by more than `allowed`:
/// the attitude that is nearest to them may be right, and what was written is not.
pub(super) fn no_rotation(record: &Trajectory, allowed: f64) -> Option<Fault> {
    let (attitude, square) = squares(record)?;
    let rows = attitude.len();
    let mut some: Vec<f64> = (0..rows).step_by(rows.div_ceil(MOST)).map(&square).collect();
    let usual = median(&mut some)?;
    let defect = |row: usize| match attitude {
        Attitudes::Matrices(matrices) => {
            let [a, b, c] = [0, 3, 6].map(|n| Vec3([0, 1, 2].map(|k| matrices[row][n + k])));
            let lengths = [a, b, c].map(|v| ((v.norm_squared() / usual).sqrt() - 1.0).abs());
            let angles = [a.dot(b), b.dot(c), c.dot(a)].map(|product| 0.5 * product.abs() / usual);
            let mirrored = if a.cross(b).dot(c) > 0.0 { 0.0 } else { 2.0 };
            lengths.into_iter().chain(angles).fold(mirrored, f64::max)
        }
        _ => ((square(row) / usual).sqrt() - 1.0).abs(),
    };
    let (mut largest, mut count) = ((0, 0.0), 0);
    for row in 0..rows {
        let error = defect(row);
        // a norm that is not finite is none
        if error.is_nan() || error > allowed {
            count += 1;
            if error.is_nan() || error > largest.1 {
                largest = (row, if error.is_nan() { f64::INFINITY } else { error });
            }
        }
    }
    (count > 0).then_some(Fault::NoRotation { row: largest.0, error: largest.1, count })
}

/// The longest run of rows in which a component of the angular velocity stays the same although it changes elsewhere. Rounded
/// peaks stay the same too, but are entered and left by small changes.
fn plateau(record: &Trajectory) -> Option<Fault> {
    let rates = record.rates.as_ref()?;
    let mut longest = (0, 0);
    for axis in 0..3 {
        let change = |row: usize| (rates[row][axis] - rates[row - 1][axis]).abs();
        let mut changes: Vec<f64> = (1..rates.len()).map(change).filter(|change| *change > 0.0).collect();
        let Some(usual) = median(&mut changes).filter(|_| changes.len() >= PLATEAU) else { continue };
        let mut from = 0;
        for row in 1..=rates.len() {
            if row < rates.len() && rates[row][axis] == rates[from][axis] {
                continue;
            }
            let entered = from > 0 && change(from) > 0.3 * usual;
            let left = row < rates.len() && change(row) > 0.3 * usual;
            if (entered || left) && row - from > longest.0 {
                longest = (row - from, from);
            }
            from = row;
        }
    }
    let (rows, row) = longest;
    (rows >= PLATEAU).then_some(Fault::Plateau { row, rows })
}

/// Most changes that the usual one is read off.
const MOST: usize = 4096;

/// Where attitude or angular velocity change by far more than between other rows. `rounding`: of the numbers, relative.
pub(super) fn discontinuity(record: &Trajectory, reading: &Reading, rounding: f64) -> Option<Fault> {
    let rows = record.times.len();
    let usual = usual_interval(record);
    let at = |row: usize| (reading.attitude(record, row), reading.omega_body(record, row));
    let some = rows.div_ceil(MOST);
    let rates = (0..rows).step_by(some).filter_map(|row| at(row).1.map(|omega| omega.norm()));
    let size = rates.fold(0.0_f64, f64::max);
    let relative = if size > 0.0 { 1.0 / size } else { 0.0 };
    // of a row from the one before, where the interval is a usual one
    let change = |row: usize| -> Option<f64> {
        let dt = record.times[row] - record.times[row - 1];
        if dt > JUMP * usual {
            return None;
        }
        let (before, now) = (at(row - 1), at(row));
        let turn = before.0.zip(now.0).map(|(p, q)| (p.conjugate() * q).logarithm());
        Some(match (before.1, now.1) {
            (Some(a), Some(b)) => {
                let turned = turn.map_or(0.0, |turn| (turn - (a + b) * (0.5 * dt)).norm());
                turned.max((b - a).norm() * relative)
            }
            _ => turn?.norm(),
        })
    };
    let mut sorted: Vec<f64> = (1..rows).step_by(some).filter_map(change).collect();
    if sorted.len() < 20 {
        return None;
    }
    let at = sorted.len() * 95 / 100;
    let common = *sorted.select_nth_unstable_by(at, f64::total_cmp).1;
    let threshold = DISCONTINUITY * common.max(rounding);
    let (mut largest, mut count) = ((0, 0.0), 0);
    for row in 1..rows {
        let Some(size) = change(row).filter(|size| *size > threshold) else { continue };
        count += 1;
        if size > largest.1 {
            largest = (row, size);
        }
    }
    (count > 0).then_some(Fault::Discontinuity { row: largest.0, size: largest.1, count })
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Of 240 rows a second: to ms, cut to ms, and counted in doubles from 1970 on; not of whole times, uneven ones or lost rows.
    #[test]
    fn the_unit_of_rounded_times_is_told_from_an_even_clock() {
        let unit = |of: &dyn Fn(f64) -> f64| {
            let times = (0..2400).map(|row| of(f64::from(row))).collect();
            unit_of_times(&Trajectory::new(times))
        };
        let is_near = |found: Option<f64>, unit: f64| found.is_some_and(|x| (x / unit - 1.0).abs() < 1e-3);
        assert!(is_near(unit(&|row| (row / 0.24).round() / 1e3), 1e-3));
        assert!(is_near(unit(&|row| (row / 0.24).floor() * 1e-3), 1e-3));
        assert!(is_near(unit(&|row| 1.7e9 + row / 240.0), libm::scalbn(1.0, -22)));
        let others: [(&str, &dyn Fn(f64) -> f64); 5] = [
            ("whole", &|row| 0.05 * row),
            ("of all digits", &|row| row / 240.0),
            ("with a lost row", &|row| 0.1 * if row < 2000.0 { row } else { row + 1.0 }),
            ("twice as long", &|row| 0.1 * if row < 2000.0 { row } else { 2.0 * row - 2000.0 }),
            ("drifting", &|row| 0.05 * row + 1e-7 * row * row),
        ];
        for (what, of) in others {
            assert_eq!(unit(of), None, "{what}");
        }
    }
}

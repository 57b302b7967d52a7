//! From rows to segments: rows of one time are merged, repeated readings and flat tops left out, and gaps split.

use nalgebra::Vector3;

use super::error::RecordError;
use super::held::{Repeats, repeats};
use super::rows::RawRows;
use super::segment::Segment;

/// What was found among the rows.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Finding {
    Merged,
    /// The reading before, again; new ones come every `interval` s in the mean.
    Repeated {
        interval: f64,
    },
    /// The reading before, again, of a sensor that otherwise reads each time.
    Stale,
    Saturated,
    Gap,
}

/// A gap is an interval longer than this many median intervals.
const GAP: f64 = 8.0;
/// Equal extreme samples in a row that count as the end of the range.
const FLAT_TOP: usize = 4;
/// Steps of the rounding that a column must span before its ends can be those of a sensor's range.
const QUIET: f64 = 16.0;

/// Segments, and what was found among their rows, with its time in s.
pub(super) struct Cleaned {
    pub(super) segments: Vec<Segment>,
    pub(super) findings: Vec<(f64, Finding)>,
}

/// The segments that `rows` hold.
pub(super) fn cleaned(file: &str, rows: RawRows) -> Result<Cleaned, RecordError> {
    let RawRows { rows, names, columns, rate_unit, .. } = rows;
    let mut segments: Vec<Segment> = Vec::new();
    let mut findings = Vec::new();
    let mut merged: Vec<([f64; 4], f64, usize)> = Vec::with_capacity(rows.len());
    for (line, row) in rows {
        if let Some(k) = row.iter().position(|v| !v.is_finite()) {
            return Err(RecordError::Value {
                file: file.into(),
                line,
                column: columns[k],
                name: names[k].clone(),
                value: row[k].to_string(),
            });
        }
        match merged.last_mut() {
            Some((last, ..)) if row[0] < last[0] => {
                return Err(RecordError::Order { file: file.into(), line, time: row[0], before: last[0] });
            }
            Some((last, count, _)) if row[0] == last[0] => {
                *count += 1.0;
                for k in 1..4 {
                    let change = row[k] - last[k];
                    // the difference of two large numbers may overflow where their mean does not
                    let finite = change.is_finite();
                    last[k] += if finite { change / *count } else { row[k] / *count - last[k] / *count };
                }
                findings.push((row[0], Finding::Merged));
            }
            _ => merged.push((row, 1.0, line)),
        }
    }
    if merged.is_empty() {
        return Err(RecordError::Empty { file: file.into(), window: None, span: (0.0, 0.0) });
    }
    let all: Vec<[f64; 4]> = merged.iter().map(|(row, ..)| *row).collect();
    let Repeats { samples: repeated, evenly } = repeats(&all);
    let new = |i: &usize| !repeated[*i];
    let lines: Vec<usize> = (0..all.len()).filter(new).map(|i| merged[i].2).collect();
    let samples: Vec<[f64; 4]> = (0..all.len()).filter(new).map(|i| all[i]).collect();
    let flat = flat_tops(&samples);
    let mut intervals: Vec<f64> = samples.windows(2).map(|w| w[1][0] - w[0][0]).collect();
    intervals.sort_by(f64::total_cmp);
    let median = intervals.get(intervals.len() / 2).copied().unwrap_or(0.0);
    let repeated = all.iter().zip(&repeated).filter(|(_, repeated)| **repeated);
    let interval = mean(intervals.iter().copied().take_while(|interval| *interval <= GAP * median));
    let finding = if evenly { Finding::Repeated { interval } } else { Finding::Stale };
    findings.extend(repeated.map(|(row, _)| (row[0], finding)));
    let mut last: Option<f64> = None;
    for ((row, flat), line) in samples.iter().zip(flat).zip(lines) {
        if flat {
            findings.push((row[0], Finding::Saturated));
            last = None;
            continue;
        }
        let gap = last.is_some_and(|t| row[0] - t > GAP * median);
        if gap {
            findings.push((row[0], Finding::Gap));
        }
        if gap || last.is_none() {
            segments.push(Segment {
                source: file.into(),
                times: Vec::new(),
                rates: Vec::new(),
                lines: Vec::new(),
                inputs: None,
                rate_unit,
            });
        }
        if let Some(segment) = segments.last_mut() {
            segment.times.push(row[0]);
            segment.lines.push(line);
            segment.rates.push(Vector3::new(row[1], row[2], row[3]));
        }
        last = Some(row[0]);
    }
    Ok(Cleaned { segments, findings })
}

fn mean(values: impl Iterator<Item = f64>) -> f64 {
    let (sum, count) = values.fold((0.0, 0.0), |(sum, count), value| (sum + value, count + 1.0));
    sum / count
}

/// Samples where a component stays at its largest or smallest value, and longer than a rounded peak would.
///
/// Rounded readings are flat at a peak too, for as long as they take to fall by a few steps of the rounding; a clipped
/// peak is flat for longer.
fn flat_tops(samples: &[[f64; 4]]) -> Vec<bool> {
    let mut flat = vec![false; samples.len()];
    for k in 1..4 {
        let column = || samples.iter().map(|row| row[k]);
        let (low, high) =
            (column().fold(f64::INFINITY, f64::min), column().fold(f64::NEG_INFINITY, f64::max));
        let steps = samples.windows(2).map(|w| (w[1][k] - w[0][k]).abs()).filter(|step| *step > 0.0);
        let step = steps.fold(f64::INFINITY, f64::min);
        // a column of a few values, or of one, is a quiet axis
        if high - low < QUIET * step {
            continue;
        }
        for end in [low, high] {
            let away = |row: &[f64; 4]| (row[k] - end).abs() >= 2.5 * step;
            let mut i = 0;
            while i < samples.len() {
                let run = samples[i..].iter().take_while(|row| row[k] == end).count();
                if run >= FLAT_TOP {
                    // look at most a third of the run aside; beyond the ends of the record there is no evidence
                    let most = run / 3;
                    let before = samples[..i].iter().rev().take(most).position(away);
                    let after = samples[i + run..].iter().take(most).position(away);
                    let edge = (i < most, samples.len() - (i + run) < most);
                    if (before.is_some() || edge.0) && (after.is_some() || edge.1) {
                        flat[i..i + run].iter_mut().for_each(|f| *f = true);
                    }
                }
                i += run.max(1);
            }
        }
    }
    flat
}

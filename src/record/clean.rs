//! From rows to segments: rows of one time are merged, repeated readings and flat tops left out, and gaps split.

use core::ops::Range;

use nalgebra::Vector3;

use super::error::RecordError;
use super::held::{Repeats, repeats};
use super::median::median;
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
    let mut findings = Vec::new();
    let rate_unit = rows.rate_unit;
    let mut samples = merged(file, rows, &mut findings)?;
    if samples.is_empty() {
        return Err(RecordError::Empty { file: file.into(), window: None, span: (0.0, 0.0) });
    }
    let Repeats { samples: repeated, evenly } = repeats(&samples);
    let again = samples.iter().zip(&repeated).filter(|(_, repeated)| **repeated);
    let again: Vec<f64> = again.map(|((_, row), _)| row[0]).collect();
    let mut is_repeated = repeated.iter();
    samples.retain(|_| is_repeated.next() != Some(&true));
    let flat = flat_tops(&samples);
    let mut intervals: Vec<f64> = samples.windows(2).map(|w| w[1].1[0] - w[0].1[0]).collect();
    let median = median(&mut intervals).unwrap_or(0.0);
    let finding = if evenly {
        intervals.sort_by(f64::total_cmp);
        Finding::Repeated { interval: mean(intervals.into_iter().take_while(|i| *i <= GAP * median)) }
    } else {
        Finding::Stale
    };
    findings.extend(again.into_iter().map(|time| (time, finding)));
    let mut ranges: Vec<Range<usize>> = Vec::new();
    let mut last: Option<f64> = None;
    for (i, (&(_, row), flat)) in samples.iter().zip(flat).enumerate() {
        if flat {
            findings.push((row[0], Finding::Saturated));
            last = None;
            continue;
        }
        let gap = last.is_some_and(|t| row[0] - t > GAP * median);
        if gap {
            findings.push((row[0], Finding::Gap));
        }
        match ranges.last_mut().filter(|_| last.is_some() && !gap) {
            Some(range) => range.end = i + 1,
            None => ranges.push(i..i + 1),
        }
        last = Some(row[0]);
    }
    let segments = ranges.into_iter().map(|range| {
        let own = &samples[range];
        Segment {
            source: file.into(),
            times: own.iter().map(|(_, row)| row[0]).collect(),
            rates: own.iter().map(|(_, row)| Vector3::new(row[1], row[2], row[3])).collect(),
            lines: own.iter().map(|(line, _)| *line).collect(),
            inputs: None,
            rate_unit,
            breaks: Vec::new(),
        }
    });
    Ok(Cleaned { segments: segments.collect(), findings })
}

/// The rows, those of one time as their mean.
fn merged(
    file: &str,
    rows: RawRows,
    findings: &mut Vec<(f64, Finding)>,
) -> Result<Vec<(usize, [f64; 4])>, RecordError> {
    let RawRows { mut rows, names, columns, .. } = rows;
    let (mut kept, mut count) = (0, 1.0);
    for i in 0..rows.len() {
        let (line, row) = rows[i];
        if let Some(k) = row.iter().position(|v| !v.is_finite()) {
            return Err(RecordError::Value {
                file: file.into(),
                line,
                column: columns[k],
                name: names[k].clone(),
                value: row[k].to_string(),
            });
        }
        match rows[..kept].last_mut() {
            Some((_, last)) if row[0] < last[0] => {
                return Err(RecordError::Order { file: file.into(), line, time: row[0], before: last[0] });
            }
            Some((_, last)) if row[0] == last[0] => {
                count += 1.0;
                for k in 1..4 {
                    let change = row[k] - last[k];
                    // the difference of two large numbers may overflow where their mean does not
                    let finite = change.is_finite();
                    last[k] += if finite { change / count } else { row[k] / count - last[k] / count };
                }
                findings.push((row[0], Finding::Merged));
            }
            _ => {
                rows[kept] = (line, row);
                (kept, count) = (kept + 1, 1.0);
            }
        }
    }
    rows.truncate(kept);
    Ok(rows)
}

fn mean(values: impl Iterator<Item = f64>) -> f64 {
    let (sum, count) = values.fold((0.0, 0.0), |(sum, count), value| (sum + value, count + 1.0));
    sum / count
}

/// Samples where a component stays at its largest or smallest value, and longer than a rounded peak would.
///
/// Rounded readings are flat at a peak too, for as long as they take to fall by a few steps of the rounding; a clipped
/// peak is flat for longer.
fn flat_tops(samples: &[(usize, [f64; 4])]) -> Vec<bool> {
    let mut flat = vec![false; samples.len()];
    for k in 1..4 {
        let column = || samples.iter().map(|(_, row)| row[k]);
        let (low, high) =
            (column().fold(f64::INFINITY, f64::min), column().fold(f64::NEG_INFINITY, f64::max));
        let steps = samples.windows(2).map(|w| (w[1].1[k] - w[0].1[k]).abs()).filter(|step| *step > 0.0);
        let step = steps.fold(f64::INFINITY, f64::min);
        // a column of a few values, or of one, is a quiet axis
        if high - low < QUIET * step {
            continue;
        }
        for end in [low, high] {
            let away = |(_, row): &(usize, [f64; 4])| (row[k] - end).abs() >= 2.5 * step;
            let mut i = 0;
            while i < samples.len() {
                let run = samples[i..].iter().take_while(|(_, row)| row[k] == end).count();
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

//! Rows of numbers from a text with a header.

use super::columns::{cells, find_columns, find_header, may_part_thousands, uncommented, unit};
use super::error::RecordError;
use super::units::{RateUnit, TimeUnit};

/// How a text is read.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Reading {
    /// Unit of time where the header names none; seconds without it.
    pub time_unit: Option<TimeUnit>,
    /// Unit of the rates where the header names none; rad/s without it.
    pub rate_unit: Option<RateUnit>,
}
/// The rows of a text: line and values of each, in s and rad/s, with the names and numbers of their columns.
pub(super) struct Rows {
    pub(super) rows: Vec<(usize, [f64; 4])>,
    pub(super) names: [String; 4],
    pub(super) columns: [usize; 4],
}

/// The rows of `text`; `file` names it in messages.
pub(super) fn rows(text: &str, file: &str, reading: Reading) -> Result<Rows, RecordError> {
    let text = text.trim_start_matches('\u{feff}');
    // a carriage return alone ends a line too; a tab in front is an empty cell
    let lines = text.split('\n').flat_map(|l| l.strip_suffix('\r').unwrap_or(l).split('\r'));
    let lines = lines.map(|l| l.trim_end().trim_start_matches(|c: char| c.is_whitespace() && c != '\t'));
    let lines: Vec<(usize, &str)> =
        lines.enumerate().map(|(k, l)| (k + 1, l)).filter(|(_, l)| !l.is_empty()).collect();
    let (first, names) = find_header(&lines);
    let columns = find_columns(&names).map_err(|missing| RecordError::Column {
        file: file.into(),
        missing,
        found: names.clone(),
    })?;
    let time_unit =
        unit(&names[columns[0]], file, reading.time_unit, TimeUnit::named)?.unwrap_or(TimeUnit::Seconds);
    let mut rate_units = [RateUnit::RadiansPerSecond; 3];
    for (axis, rate_unit) in rate_units.iter_mut().enumerate() {
        *rate_unit =
            unit(&names[columns[axis + 1]], file, reading.rate_unit, RateUnit::named)?.unwrap_or(*rate_unit);
    }
    let mut rows = Vec::new();
    for &(line, content) in lines[first..].iter().filter(|(_, l)| uncommented(l).is_none()) {
        let mut row = cells(content);
        // a separator at the end of every row makes one empty cell more
        if row.len() == names.len() + 1 && row.last().is_some_and(String::is_empty) {
            row.pop();
        }
        if row.len() > names.len() || columns.iter().any(|&c| c >= row.len()) {
            return Err(RecordError::Cells {
                file: file.into(),
                line,
                cells: row.len(),
                columns: names.len(),
            });
        }
        let mut values = [0.0; 4];
        for (value, &column) in values.iter_mut().zip(&columns) {
            *value = row[column].parse::<f64>().ok().filter(|v| v.is_finite()).ok_or_else(|| {
                let (file, name, value) = (file.into(), names[column].clone(), row[column].clone());
                let column = column + 1;
                match may_part_thousands(&value) {
                    true => RecordError::Comma { file, line, column, name, value },
                    false => RecordError::Value { file, line, column, name, value },
                }
            })?;
        }
        values[0] = time_unit.seconds(values[0]);
        for axis in 0..3 {
            values[axis + 1] = rate_units[axis].radians_per_second(values[axis + 1]);
        }
        rows.push((line, values));
    }
    Ok(Rows { rows, names: columns.map(|c| names[c].clone()), columns: columns.map(|c| c + 1) })
}

//! How the files of a record are read, and which windows of them.

use std::path::{Path, PathBuf};

use clap::Args;
use polhode_files::error::{Error, warn};
use polhode_files::numbers::{number, numbers, positive};
use polhode_files::read;
use polhode_files::record::{self, Reading};
use polhode_fit::{RateUnit, Record, RecordError, TimeUnit};

use super::inputs::WheelArguments;

/// Columns, units and windows.
#[derive(Args, Clone, Debug)]
pub(super) struct ReadingArguments {
    /// Columns of the time and of the rates, by name or number, where they are not found: t=NAME,x=NAME,y=NAME,z=NAME
    #[arg(long, value_name = "t=...,x=...,y=...,z=...", value_parser = columns)]
    columns: Option<ColumnNames>,
    /// Fraction of the rows that may be left out because they cannot be read [default: 0.02]
    #[arg(long, value_name = "FRACTION", value_parser = share, allow_hyphen_values = true)]
    skip_rows: Option<f64>,
    /// Unit of time where the header names none: s, ms, us, ns, or a number of seconds [default: s]
    #[arg(long, value_name = "UNIT", value_parser = time_unit)]
    time_unit: Option<TimeUnit>,
    /// Unit of the rates where the header names none: rad/s, deg/s, rpm [default: rad/s]
    #[arg(long, value_name = "UNIT", value_parser = rate_unit)]
    rate_unit: Option<RateUnit>,
    /// Use only samples from t0 to t1, s; repeatable. With N: of the N-th file only [default: all samples if the body
    /// rotates freely from the first to the last, else the flights, which are found and listed]
    #[arg(long, value_name = "[N:]t0,t1", value_parser = window, allow_hyphen_values = true)]
    window: Vec<Window>,
}

/// A window of one file, counted from 1, or of every file.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Window {
    file: Option<usize>,
    span: (f64, f64),
}

fn window(text: &str) -> Result<Window, String> {
    let (file, span) = match text.split_once(':') {
        Some((file, span)) => {
            let number = file.trim().parse::<usize>().ok().filter(|n| *n > 0);
            (Some(number.ok_or(format!("'{file}' is not the number of a file; count from 1"))?), span)
        }
        None => (None, text),
    };
    let [start, end] = numbers::<2>(span)?;
    if start >= end {
        return Err(format!("{start:?} is not before {end:?}; give the start, then the end"));
    }
    Ok(Window { file, span: (start, end) })
}

fn time_unit(text: &str) -> Result<TimeUnit, String> {
    let number = || positive(text).ok().map(TimeUnit::Multiple);
    TimeUnit::named(text).or_else(number).ok_or_else(|| {
        format!("'{text}' is no unit of time here; known: s, ms, us, ns, or a number of seconds")
    })
}

/// Names or numbers of the columns of time and rates.
#[derive(Clone, Debug)]
struct ColumnNames([String; 4]);

fn columns(text: &str) -> Result<ColumnNames, String> {
    let mut found: [Option<String>; 4] = Default::default();
    // a name may hold a comma: it goes on up to the next key
    let mut last: Option<usize> = None;
    for part in text.split(',') {
        let keyed = part.split_once('=').and_then(|(key, name)| {
            let place = ["t", "x", "y", "z"].iter().position(|known| *known == key.trim())?;
            Some((place, name.trim()))
        });
        match (keyed, last) {
            (Some((place, name)), _) => {
                found[place] = Some(name.to_string());
                last = Some(place);
            }
            (None, Some(place)) => {
                if let Some(name) = &mut found[place] {
                    *name += &format!(",{part}");
                }
            }
            (None, None) => return Err(format!("'{part}' has no key; write t=NAME,x=NAME,y=NAME,z=NAME")),
        }
    }
    let missing = found.iter().position(|name| name.as_ref().is_none_or(String::is_empty));
    match (missing, found) {
        (None, [Some(t), Some(x), Some(y), Some(z)]) => Ok(ColumnNames([t, x, y, z])),
        (missing, _) => {
            let key = ["t", "x", "y", "z"][missing.unwrap_or(0)];
            Err(format!("{key}= is missing; write t=NAME,x=NAME,y=NAME,z=NAME, or numbers from 1"))
        }
    }
}

fn share(text: &str) -> Result<f64, String> {
    match number(text)? {
        share if (0.0..1.0).contains(&share) => Ok(share),
        share => Err(format!("{share:?} is no fraction of the rows; give a number from 0 to below 1")),
    }
}

fn rate_unit(text: &str) -> Result<RateUnit, String> {
    RateUnit::named(text)
        .ok_or_else(|| format!("'{text}' is no unit of rates here; known: rad/s, deg/s, rpm"))
}

impl ReadingArguments {
    /// Whether no window is cut out.
    pub(super) fn is_whole(&self) -> bool {
        self.window.is_empty()
    }

    /// All files and windows as one record.
    pub(super) fn record(&self, data: &[PathBuf], wheel: &WheelArguments) -> Result<Record, Error> {
        if let Some((n, w)) =
            self.window.iter().find_map(|w| w.file.filter(|n| *n > data.len()).map(|n| (n, w)))
        {
            let value = format!("{n}:{:?},{:?}", w.span.0, w.span.1);
            let rule = format!("there are {} files", data.len());
            return Err(Error::input("--window", &value, &rule, "count them from 1"));
        }
        let mut all = Record::default();
        for (k, path) in data.iter().enumerate() {
            let record = self.read(path, wheel)?;
            let own: Vec<(f64, f64)> =
                self.window.iter().filter(|w| w.file.is_none_or(|n| n == k + 1)).map(|w| w.span).collect();
            let cut = match (self.window.is_empty(), own.is_empty()) {
                (true, _) => record,
                (false, true) => continue,
                (false, false) => record.windows(&own).map_err(|error| Error::Input(error.to_string()))?,
            };
            all = all.join(cut);
        }
        Ok(all)
    }

    fn read(&self, path: &Path, wheel: &WheelArguments) -> Result<Record, Error> {
        let text = read(path, "name a text file with a header and columns")?;
        let reading = Reading {
            time_unit: self.time_unit,
            rate_unit: self.rate_unit,
            columns: self.columns.clone().map(|ColumnNames(names)| names),
            most_skipped: self.skip_rows,
        };
        let record = record::read(&text, &path.display().to_string(), reading).map_err(|error| {
            Error::Input(match &error {
                RecordError::Column { .. } => {
                    format!("{error}, or say which they are: --columns t=NAME,x=NAME,y=NAME,z=NAME")
                }
                RecordError::Value { .. } | RecordError::Cells { .. } | RecordError::Order { .. } => {
                    format!("{error}, or allow for more such rows by --skip-rows FRACTION")
                }
                _ => error.to_string(),
            })
        })?;
        if let Some(first) = record.skipped().first() {
            let rows = match record.skipped().len() {
                1 => "1 row is".to_string(),
                count => format!("{count} rows are"),
            };
            warn(&format!("{rows} left out beside {} that are read; the first: {first}", record.samples()));
        }
        wheel.complete(record, &text, &path.display().to_string())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn windows_are_spans_of_one_file_or_of_all() {
        assert_eq!(window("1,2.5"), Ok(Window { file: None, span: (1.0, 2.5) }));
        assert_eq!(window("2:-1,0"), Ok(Window { file: Some(2), span: (-1.0, 0.0) }));
        assert!(window("0:1,2").unwrap_err().contains("count from 1"));
        assert!(window("2,1").unwrap_err().contains("not before"));
        assert!(window("2").unwrap_err().contains("1 given, 2 needed"));
    }
}

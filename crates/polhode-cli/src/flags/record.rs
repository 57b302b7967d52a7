//! How the files of a record are read, and which windows of them: `fit` and `attitude`.

use std::path::{Path, PathBuf};

use clap::Args;
use nalgebra::Vector3;
use polhode::record::Record;
use polhode::units::RateUnit;
use polhode_files::error::{Error, TableError, warn};
use polhode_files::numbers::{number, numbers};
use polhode_files::record::{self, FoundRecord, Parts};
use polhode_files::{ReadAs, ReadOptions, SignedAxes};

use super::table::{TableArguments, rate_unit};

/// Columns, units and windows.
#[derive(Args, Clone, Debug)]
pub(crate) struct RecordArguments {
    #[command(flatten)]
    table: TableArguments,
    /// Largest fraction of the rows of rates that may be left out as unreadable [default: 0.02]
    #[arg(long, value_name = "FRACTION", value_parser = share, allow_hyphen_values = true, help_heading = "Reading")]
    skip_rows: Option<f64>,
    /// Unit of the rates where the header names none: rad/s, deg/s, rpm [default: rad/s]
    #[arg(long, value_name = "UNIT", value_parser = rate_unit, help_heading = "Reading")]
    rate_unit: Option<RateUnit>,
    /// Which columns of the rates are x, y and z of right-handed sensor axes; a minus sign reverses a column, so that x,-y,z undoes a
    /// mirrored y axis. Applied before everything else [default: x,y,z]
    #[arg(long, value_name = "x,-y,z", value_parser = SignedAxes::parse, allow_hyphen_values = true, help_heading = "Reading")]
    axes: Option<SignedAxes>,
    /// Use only the samples from t0 to t1, s; repeatable. N: applies it to the N-th file alone, and then every file needs a window. Where windows touch, attitude continues from one to the
    /// next [default: all samples; but fit uses the flights, which it finds and lists, if the body does not rotate freely throughout]
    #[arg(long, value_name = "[N:]t0,t1", value_parser = window, allow_hyphen_values = true, help_heading = "Reading")]
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

fn share(text: &str) -> Result<f64, String> {
    match number(text)? {
        share if (0.0..1.0).contains(&share) => Ok(share),
        share => Err(format!("{share:?} is not a fraction of the rows; give a number from 0 to below 1")),
    }
}

impl RecordArguments {
    /// Whether no window is cut out.
    pub(crate) fn is_whole(&self) -> bool {
        self.window.is_empty()
    }

    /// How tables are read.
    pub(crate) fn table(&self) -> ReadOptions {
        self.table.reading(self.rate_unit)
    }

    /// The unit of the rates that is stated.
    pub(crate) fn rate_unit(&self) -> Option<RateUnit> {
        self.rate_unit
    }

    /// The share of the rows that may be left out, where it is stated.
    pub(crate) fn skipped_share(&self) -> Option<f64> {
        self.skip_rows
    }

    /// Which columns are the rates about x, y and z.
    pub(crate) fn axes(&self) -> Option<SignedAxes> {
        self.axes
    }

    /// The windows of the file with number `k`, from 0; none where no file has any.
    pub(crate) fn windows(&self, k: usize) -> Vec<(f64, f64)> {
        self.window.iter().filter(|w| w.file.is_none_or(|n| n == k + 1)).map(|w| w.span).collect()
    }

    /// All files and windows as one record; `wheel` is the momentum of a wheel per rad/s of its speed.
    pub(crate) fn record(
        &self,
        data: &[PathBuf],
        wheel: Option<Vector3<f64>>,
    ) -> Result<(Record, Vec<ReadAs>), Error> {
        let ([all], read_as) = self.records([data], wheel)?;
        Ok((all, read_as))
    }

    /// The same of several records, their files counted through, and how each file was read.
    pub(crate) fn records<const N: usize>(
        &self,
        data: [&[PathBuf]; N],
        wheel: Option<Vector3<f64>>,
    ) -> Result<([Record; N], Vec<ReadAs>), Error> {
        self.check_windows(data.iter().map(|files| files.len()).sum())?;
        self.tell_axes();
        let mut all: [Record; N] = core::array::from_fn(|_| Record::default());
        let mut read_as = Vec::new();
        let each = data.iter().enumerate().flat_map(|(of, files)| files.iter().map(move |path| (of, path)));
        for (k, (of, path)) in each.enumerate() {
            let found = self.read(path, wheel)?;
            let record = self.cut(found.record, k)?;
            let shared = all.iter().map(|before| before.shared(&record)).max().unwrap_or(0);
            tell_shared(&found.read_as.file, (shared, record.samples()));
            all[of] = core::mem::take(&mut all[of]).join(record);
            read_as.push(found.read_as);
        }
        Ok((all, read_as))
    }

    /// One file and its windows, part by part.
    pub(crate) fn parts(&self, path: &Path) -> Result<Parts, Error> {
        self.check_windows(1)?;
        self.tell_axes();
        Parts::open(path, &self.options(true), &self.windows(0))
    }

    /// Refuses a unit of time or a rate of samples where the times of a file are not numbers of one unit.
    pub(crate) fn check_times(&self, read_as: &ReadAs) -> Result<(), Error> {
        self.table.check_times(read_as)
    }

    pub(crate) fn check_windows(&self, files: usize) -> Result<(), Error> {
        if let Some((n, w)) = self.window.iter().find_map(|w| w.file.filter(|n| *n > files).map(|n| (n, w))) {
            let value = format!("{n}:{:?},{:?}", w.span.0, w.span.1);
            let rule = if files == 1 { "there is 1 file".into() } else { format!("there are {files} files") };
            return Err(Error::input("--window", &value, &rule, "count them from 1"));
        }
        let without = (0..files).find(|k| !self.window.is_empty() && self.windows(*k).is_empty());
        without.map_or(Ok(()), |k| {
            let rule = format!("file {} has none, and others have", k + 1);
            Err(Error::input(
                "--window",
                "",
                &rule,
                &format!("give --window {}:t0,t1 too, or leave the file out", k + 1),
            ))
        })
    }

    pub(crate) fn tell_axes(&self) {
        if let Some(axes) = self.axes {
            let kind = if axes.is_mirror() {
                "a mirror: left-handed columns become right-handed axes"
            } else {
                "a turn of the axes"
            };
            warn(&format!("the rates about x, y, z are those of the columns {axes} ({kind})"));
        }
    }

    /// The windows of the file with number `k`, or all of it.
    fn cut(&self, record: Record, k: usize) -> Result<Record, Error> {
        let own = self.windows(k);
        if own.is_empty() {
            return Ok(record);
        }
        record.windows(&own).map_err(|error| Error::Input(error.to_string()))
    }

    fn options(&self, increments: bool) -> ReadOptions {
        let reading = self.table().with_most_skipped(self.skip_rows);
        reading.with_axes(self.axes).with_increments(increments)
    }

    fn read(&self, path: &Path, wheel: Option<Vector3<f64>>) -> Result<FoundRecord, Error> {
        let found = record::open(path, &self.options(false), wheel).map_err(of_a_row)?;
        self.check_times(&found.read_as)?;
        tell_skipped((found.skipped.len(), found.skipped.first()), found.record.samples());
        found.remarks.iter().for_each(|remark| warn(remark));
        Ok(found)
    }
}

/// A refusal of a row, with the flag that allows for more such rows.
pub(crate) fn of_a_row(error: Error) -> Error {
    match error {
        Error::Table(error) if error.is_of_a_row() => {
            let remedy = format!("{}, or allow for more such rows by --skip-rows FRACTION", error.remedy);
            Error::from(error.with_remedy(&remedy))
        }
        other => other,
    }
}

/// Says how many of its samples a file shares with others, where it does.
pub(crate) fn tell_shared(file: &str, (shared, samples): (usize, usize)) {
    if shared > 0 {
        warn(&format!(
            "{file}: {shared} of its {samples} samples are also in a file before it, and readings that count twice make the \
             standard deviations too small: leave them out of one (--window)"
        ));
    }
}

/// Says how many rows were left out beside so many `samples`.
pub(crate) fn tell_skipped((count, first): (usize, Option<&TableError>), samples: usize) {
    let Some(first) = first else { return };
    let rows = if count == 1 { "1 row is".to_string() } else { format!("{count} rows are") };
    warn(&format!("{rows} left out beside {samples} that are read; the first: {first}"));
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

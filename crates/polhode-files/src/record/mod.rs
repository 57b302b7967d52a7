//! Records of angular velocity from the logs of phones, loggers and flight controllers.

mod inputs;
mod parts;
mod rows;

use std::path::Path;

use nalgebra::Vector3;
use polhode::record::Record;

use crate::error::{Error, TableError};
use crate::read_as::ReadAs;
pub use crate::table::ReadOptions;
use crate::table::Table;
use inputs::Inputs;
pub use parts::{Part, Parts};
use rows::Rows;

/// A record, and what was not read of its file.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct FoundRecord {
    /// The samples.
    pub record: Record,
    /// Why rows were left out, one by one.
    pub skipped: Vec<TableError>,
    /// What else a user should know.
    pub remarks: Vec<String>,
    /// Whether the columns are angles by their unit, which [`ReadOptions::increments`] allows: increments since the row before, rad.
    pub are_increments: bool,
    /// In which units they were read.
    pub read_as: ReadAs,
}

/// A record from a text of rows, which messages call `file`.
///
/// Cells are separated by comma, semicolon or tab, or by blanks, with decimal commas where semicolons or tabs separate them,
/// or within quotes. Lines before the header and lines that begin with `#`, `%` or `//` may hold anything, and so may columns
/// that are not needed. Columns are found by the names that phones, loggers, flight controllers and ROS give them, or as
/// [`ReadOptions::columns`] says; four columns of numbers need no header. Of several times the one whose name has a unit is read;
/// dates, and counts since 1970, are taken from the first row on. Columns `hx, hy, hz` (N m s) are the momentum of wheels,
/// `tx (N m), ty (N m), tz (N m)` a torque.
///
/// Rows that cannot be read are [left out](FoundRecord::skipped), up to a [share](ReadOptions::most_skipped).
///
/// ```
/// use polhode_files::ColumnNames;
/// use polhode_files::record::{ReadOptions, read};
/// let text = "when;p_gyro;q_gyro;r_gyro\n22-Nov-2025 10:00:00.00;1;2;3\n22-Nov-2025 10:00:00.01;1;2;3\n";
/// let columns = ColumnNames::parse("t=when,x=p_gyro,y=q_gyro,z=r_gyro").unwrap();
/// let record = read(text, "flight.csv", &ReadOptions::default().with_columns(columns))?.record;
/// assert_eq!(record.segments[0].times(), [0.0, 0.01]);
///
/// let text = "t (ms), wx (deg/s), wy (deg/s), wz (deg/s)\n0, 0, 90, 180\n10, 1, 90, 180\n10, 3, 90, 180\n";
/// let record = read(text, "toss.csv", &ReadOptions::default())?.record;
/// assert_eq!((record.samples(), record.merged()), (2, 1)); // rows of the same time are averaged
/// assert_eq!(record.segments[0].rates()[1].z, core::f64::consts::PI);
///
/// let broken = read("t,wx,wy,wz\n0,1,2,3\n1,1,nan,3\n", "toss.csv", &ReadOptions::default());
/// assert!(broken.unwrap_err().to_string().starts_with("toss.csv, line 3, column 3 (wy): 'nan'"));
///
/// let text = "t,wx,wy,wz,temperature\n0,1,2,3,20\n0.1,1,2,3,20\n";
/// let record = read(text, "toss.csv", &ReadOptions::default())?.record;
/// assert_eq!(record.unused_columns(), [("toss.csv".to_string(), "temperature".to_string())]);
/// # Ok::<(), polhode_files::Error>(())
/// ```
///
/// # Errors
/// Missing columns, unknown units, more bad rows than may be left out: the first of them.
pub fn read(text: &str, file: &str, reading: &ReadOptions) -> Result<FoundRecord, Error> {
    Ok(found(Table::of_text(text, file, reading)?, reading, None)?)
}

/// The same of the file at `path`, or of standard input where that is `-`. `wheel`: the momentum, kg m², of a wheel per rad/s
/// of its speed, which is the column `wheel`, with its unit.
///
/// # Errors
/// As [`read`], and a column `wheel` that is missing or without unit.
pub fn open(path: &Path, reading: &ReadOptions, wheel: Option<Vector3<f64>>) -> Result<FoundRecord, Error> {
    Ok(found(Table::open(path, reading)?, reading, wheel)?)
}

fn found(
    table: Table,
    reading: &ReadOptions,
    wheel: Option<Vector3<f64>>,
) -> Result<FoundRecord, TableError> {
    let mut remarks = Vec::new();
    let mut rows = Rows::new(table, reading)?;
    rows.inputs = Inputs::of(&rows.table, wheel, &mut remarks)?;
    let (mut all, mut skipped) = (Vec::new(), Vec::new());
    rows.read(usize::MAX, &mut all, &mut skipped)?;
    if !rows.may_skip(skipped.len()) {
        return Err(skipped.swap_remove(0));
    }
    let are_increments = rows.table.are_increments;
    let record = rows.record(all)?;
    let steps = record.segments.iter().flat_map(|s| s.times().windows(2)).map(|pair| pair[1] - pair[0]);
    let read_as = ReadAs { axes: reading.axes, ..rows.table.read_as(steps.collect()) };
    Ok(FoundRecord { record, skipped, remarks, are_increments, read_as })
}

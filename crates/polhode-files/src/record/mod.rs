//! Records of angular velocity from the logs of phones, loggers and flight controllers.

mod clock;
mod columns;
mod echo;
mod names;
mod read;

use polhode::record::{Record, RecordError};

pub use read::Reading;

/// A record from a text of rows: cells apart by comma, semicolon or tab, or by two spaces or more, with decimal commas where
/// semicolons or tabs part them, or within quotes. Lines before the header and lines that begin with `#`, `%` or `//` may
/// hold anything, and so may columns that are not needed. Columns are found by the names that phones, loggers, flight
/// controllers and ROS give them, or as [`Reading::columns`] says; four columns of numbers need no header. Of several times
/// the one whose name has a unit is read; dates, and counts since 1970, are taken from the first row on.
///
/// Rows that cannot be read are [left out](Record::skipped), up to a [share](Reading::most_skipped), and so is a last row
/// in the middle of which the file ends.
///
/// ```
/// use polhode_files::record::{Reading, read};
/// let text = "when;p_gyro;q_gyro;r_gyro\n22-Nov-2025 10:00:00.00;1;2;3\n22-Nov-2025 10:00:00.01;1;2;3\n";
/// let columns = ["when", "p_gyro", "q_gyro", "r_gyro"].map(String::from);
/// let record = read(text, "flight.csv", Reading { columns: Some(columns), ..Reading::default() })?;
/// assert_eq!(record.segments[0].times(), [0.0, 0.01]);
///
/// let text = "t (ms), wx (deg/s), wy (deg/s), wz (deg/s)\n0, 0, 90, 180\n10, 1, 90, 180\n10, 3, 90, 180\n";
/// let record = read(text, "toss.csv", Reading::default())?;
/// assert_eq!((record.samples(), record.merged()), (2, 1)); // rows of the same time are averaged
/// assert_eq!(record.segments[0].times(), [0.0, 0.01]);
/// assert_eq!(record.segments[0].rates()[1].z, core::f64::consts::PI);
///
/// let broken = read("t,wx,wy,wz\n0,1,2,3\n1,1,nan,3\n", "toss.csv", Reading::default());
/// assert!(broken.unwrap_err().to_string().starts_with("toss.csv, line 3, column 3 (wy): \"nan\""));
///
/// let text = "t,wx,wy,wz,temperature\n0,1,2,3,20\n0.1,1,2,3,20\n";
/// let record = read(text, "toss.csv", Reading::default())?;
/// assert_eq!(record.unused_columns(), [("toss.csv".to_string(), "temperature".to_string())]);
/// # Ok::<(), polhode::record::RecordError>(())
/// ```
///
/// # Errors
/// Missing columns, unknown units, more bad rows than may be left out: the first of them.
pub fn read(text: &str, file: &str, reading: Reading) -> Result<Record, RecordError> {
    Record::cleaned(file, read::rows(text, file, &reading)?)
}

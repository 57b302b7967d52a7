//! Why a record cannot be used.

use thiserror::Error;

use crate::num::Shown;

/// Why a record cannot be used. Lines and columns count from 1, the header included.
#[non_exhaustive]
#[derive(Clone, Debug, PartialEq, Error)]
pub enum RecordError {
    /// No header names the columns that are needed.
    #[error(
        "{file}: no column for {missing}; the header has {}. Name the columns t, wx, wy, wz (or \"Time (s)\", \
         \"Gyroscope x (rad/s)\", …)",
        listed(found)
    )]
    Column {
        /// Name of the file.
        file: String,
        /// What is missing.
        missing: String,
        /// The names that were found.
        found: Vec<String>,
    },
    /// A cell is not a finite number.
    #[error(
        "{file}, line {line}, column {column} ({name}): {} is not a finite number; remove the row, or leave a gap",
        shown(value)
    )]
    Value {
        /// Name of the file.
        file: String,
        /// Its line.
        line: usize,
        /// The column.
        column: usize,
        /// Name of the column.
        name: String,
        /// What stands there.
        value: String,
    },
    /// A comma that would make a number of either size.
    #[error(
        "{file}, line {line}, column {column} ({name}): {} has a comma that may separate thousands or decimals; write a \
         decimal point and no other mark",
        shown(value)
    )]
    Comma {
        /// Name of the file.
        file: String,
        /// Its line.
        line: usize,
        /// The column.
        column: usize,
        /// Name of the column.
        name: String,
        /// What stands there.
        value: String,
    },
    /// A row that ends before the last column that is needed, or has more cells than its header.
    #[error(
        "{file}, line {line}: {cells} cells where the header has {columns}; every row must have as many, with decimal \
         points where commas separate the cells"
    )]
    Cells {
        /// Name of the file.
        file: String,
        /// Its line.
        line: usize,
        /// Cells of the row.
        cells: usize,
        /// Columns of the header.
        columns: usize,
    },
    /// A last row that ends before its last column, and the file with it.
    #[error("{file}, line {line}: the file ends in the middle of this row")]
    Torn {
        /// Name of the file.
        file: String,
        /// Its line.
        line: usize,
    },
    /// Time runs backwards.
    #[error(
        "{file}, line {line}: time {} s comes after {} s; times must not decrease. Sort the rows, or give the files apart",
        Shown(*time),
        Shown(*before)
    )]
    Order {
        /// Name of the file.
        file: String,
        /// Its line.
        line: usize,
        /// The time, s.
        time: f64,
        /// The time before it, s.
        before: f64,
    },
    /// A unit that is not known.
    #[error(
        "{file}: column {} is in {}; known are s, ms, us, ns for time and rad/s, deg/s, rpm for rates",
        shown(name),
        shown(unit)
    )]
    Unit {
        /// Name of the file.
        file: String,
        /// The column.
        name: String,
        /// Its unit.
        unit: String,
    },
    /// The header and a flag name different units.
    #[error("{file}: column {} says {header}, the setting says {setting}; drop one of the two", shown(name))]
    UnitClash {
        /// Name of the file.
        file: String,
        /// The column.
        name: String,
        /// Unit of the header.
        header: String,
        /// Unit of the setting.
        setting: String,
    },
    /// No rows, or none in the windows.
    #[error("{file}: no samples{}", match window { Some((a, b)) => format!(" between {} s and {} s; the record runs from {} s to {} s", Shown(*a), Shown(*b), Shown(span.0), Shown(span.1)), None => String::new() })]
    Empty {
        /// Name of the file.
        file: String,
        /// The window that has none, s.
        window: Option<(f64, f64)>,
        /// First and last time, s.
        span: (f64, f64),
    },
    /// A window that ends before it begins.
    #[error("window {},{}: a window is a start and a later end, in seconds", Shown(*start), Shown(*end))]
    Window {
        /// Its start, s.
        start: f64,
        /// Its end, s.
        end: f64,
    },
    /// As many times as rates are needed.
    #[error("{times} times but {rates} rates; every sample needs both")]
    Lengths {
        /// Times.
        times: usize,
        /// Rates.
        rates: usize,
    },
}

impl RecordError {
    /// Whether a text stands where a number is needed: not an empty cell, and not a reading that is not finite.
    #[doc(hidden)]
    pub fn is_text(&self) -> bool {
        match self {
            Self::Value { value, .. } => !value.is_empty() && value.parse::<f64>().is_err(),
            Self::Comma { .. } => true,
            _ => false,
        }
    }
}

/// Names of columns that a message lists, and their characters in all.
const LISTED: (usize, usize) = (60, 1500);

/// All names of a header; of a file of another kind, which has none, its beginning.
fn listed(names: &[String]) -> String {
    let length: usize = names.iter().map(String::len).sum();
    let is_header = names.len() <= LISTED.0 && length <= LISTED.1;
    if is_header && !names.iter().any(|name| name.contains(char::is_control)) {
        format!("{names:?}")
    } else {
        shown(&names)
    }
}

/// Characters of a file that a message shows; a file of another kind may be a single line.
const SHOWN: usize = 60;

fn shown(what: &impl core::fmt::Debug) -> String {
    let whole = format!("{what:?}");
    match whole.char_indices().nth(SHOWN) {
        Some((end, _)) => format!("{}…", &whole[..end]),
        None => whole,
    }
}

//! Why a record cannot be used.

use thiserror::Error;

use crate::num::Shown;

/// Why a record cannot be used. Lines and columns count from 1, the header included.
#[non_exhaustive]
#[derive(Clone, Debug, PartialEq, Error)]
pub enum RecordError {
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

/// Characters of a file that a message shows; a file of another kind may be a single line.
const SHOWN: usize = 60;

fn shown(what: &impl core::fmt::Debug) -> String {
    let whole = format!("{what:?}");
    match whole.char_indices().nth(SHOWN) {
        Some((end, _)) => format!("{}…", &whole[..end]),
        None => whole,
    }
}

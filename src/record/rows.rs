//! Rows of a file before they are a record.

use crate::units::RateUnit;

/// The rows of a text: line and values of each, in s and rad/s, with the names and numbers of their columns.
#[derive(Clone, Debug)]
pub struct RawRows {
    /// Line, and time and rates.
    pub rows: Vec<(usize, [f64; 4])>,
    /// Names of the columns.
    pub names: [String; 4],
    /// Their numbers from 1.
    pub columns: [usize; 4],
    /// The unit of the rates, where the text or a setting names one.
    pub rate_unit: Option<RateUnit>,
    /// Names of the columns that are not read.
    pub unused: Vec<String>,
}

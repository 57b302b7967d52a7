//! In which units a table was read, and what named them.

use core::fmt;

use polhode::num::Shown;
use polhode::record::median;
use polhode::units::{Date, RateUnit};

use crate::table::SignedAxes;

/// What names a unit.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum NamedBy {
    /// The name of the column, or a row of units below it.
    Header,
    /// A setting of the user.
    Setting,
    /// The layout of a program or a device that writes such files.
    Layout,
    /// The values, as those of dates.
    Values,
    /// Nothing: the unit was taken.
    Nothing,
}

impl NamedBy {
    /// This, where it names a unit, or else `other`.
    pub(crate) fn or(self, other: Self) -> Self {
        if self == Self::Nothing { other } else { self }
    }

    /// In one word, for programs.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Header => "header",
            Self::Setting => "setting",
            Self::Layout => "layout",
            Self::Values => "values",
            Self::Nothing => "none",
        }
    }
}

impl fmt::Display for NamedBy {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Header => "header",
            Self::Setting => "as stated",
            Self::Layout => "layout of the file",
            Self::Values => "by the values",
            Self::Nothing => "no unit in the header",
        })
    }
}

/// In which units a table was read. Its `Display` is a list of them in words.
///
/// ```
/// use polhode_files::{ReadOptions, record};
/// let text = "t,wx (deg/s),wy (deg/s),wz (deg/s)\n0,0,90,1\n0.01,0,90,2\n0.02,0,90,3\n";
/// let found = record::read(text, "toss.csv", &ReadOptions::default())?;
/// let words = "rates in deg/s (header), times taken as s (no unit in the header), 100 Hz";
/// assert_eq!(found.read_as.to_string(), words);
/// # Ok::<(), polhode_files::Error>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct ReadAs {
    /// As messages name the table.
    pub file: String,
    /// The unit of the rates about x, where the table has rates, and what named it.
    pub rates: Option<(RateUnit, NamedBy)>,
    /// What the times are, such as `ms` or `dates`, and what named it.
    pub times: (String, NamedBy),
    /// The first time as it is written, where the others count from it: dates, counts since 1970, whole seconds beside nanoseconds.
    pub since: Option<String>,
    /// The moment of that time; whole seconds beside nanoseconds are taken to count from 1970.
    pub begins: Option<Date>,
    /// Samples a second, by the median time between two of them; `None` of a single sample.
    pub sample_rate: Option<f64>,
    /// Which columns were taken as the rates about x, y and z, where a setting says so.
    pub axes: Option<SignedAxes>,
}

impl ReadAs {
    /// The units in words, without the samples a second.
    #[must_use]
    pub fn units(&self) -> String {
        let (times, told) = &self.times;
        let verb = |by: NamedBy| if by == NamedBy::Nothing { "taken as" } else { "in" };
        match self.rates {
            Some((unit, by)) if by == *told => {
                let again = if by == NamedBy::Nothing { "as" } else { "in" };
                format!("rates {} {unit} and times {again} {times} ({by})", verb(by))
            }
            Some((unit, by)) => {
                format!("rates {} {unit} ({by}), times {} {times} ({told})", verb(by), verb(*told))
            }
            None => format!("times {} {times} ({told})", verb(*told)),
        }
    }
}

impl fmt::Display for ReadAs {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.units())?;
        match self.sample_rate {
            Some(rate) => write!(f, ", {} Hz", Shown(format!("{rate:.3e}").parse().unwrap_or(rate))),
            None => Ok(()),
        }
    }
}

/// Samples a second, by the median of these times between two of them.
pub(crate) fn sample_rate(mut steps: Vec<f64>) -> Option<f64> {
    steps.retain(|step| *step > 0.0);
    median(&mut steps).map(|step| 1.0 / step)
}

//! Errors of a record that may explain it in the place of a torque.

use core::fmt;

use crate::columns::column::Column;
use crate::columns::offset::Offset;
use crate::columns::sets::{axis_scales, misalignments, told_components};
use crate::columns::skew::Skew;
use crate::columns::wheel_axis::WheelAxis;
use crate::signal::stretch::Stretch;
use crate::thresholds::errors::{LARGEST, LARGEST_OFFSET};
use polhode::num::Shown;

/// An error of the sensor, or of the momentum of wheels as it is told, that may explain a record in the place of a torque.
#[non_exhaustive]
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ReadingError {
    /// Axes of the sensor that are not at right angles.
    Misalignment,
    /// A relative error of scale of each axis of the sensor.
    AxisScales,
    /// Constant offsets of the sensor.
    Offsets,
    /// Delays of the axes of the sensor against the first.
    Delays,
    /// A relative error of the component of the momentum of wheels along this axis: 0, 1 or 2.
    Wheel(usize),
}

/// What turns its unknowns into its size.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Units {
    /// Unit of the rates, rad/s.
    pub(crate) rms: f64,
    /// Factor of wheel momenta and known torques.
    pub(crate) input: f64,
}

impl ReadingError {
    /// All that these stretches may have.
    pub(crate) fn all(stretches: &[Stretch]) -> Vec<ReadingError> {
        let sensor = [
            ReadingError::Misalignment,
            ReadingError::AxisScales,
            ReadingError::Offsets,
            ReadingError::Delays,
        ];
        sensor.into_iter().chain(told_components(stretches).into_iter().map(ReadingError::Wheel)).collect()
    }

    /// Its columns with the deviations that are plausible for them.
    pub(crate) fn columns(self, stretches: &[Stretch], units: Units) -> Vec<Column> {
        let (columns, size) = match self {
            ReadingError::Misalignment => (misalignments(), LARGEST),
            ReadingError::AxisScales => (axis_scales(), LARGEST),
            ReadingError::Offsets => {
                ((0..3).map(|k| Column::new(Offset(k), None)).collect(), LARGEST_OFFSET / units.rms)
            }
            ReadingError::Delays => {
                ([1, 2].map(|k| Column::new(Skew(k), None)).to_vec(), interval(stretches))
            }
            ReadingError::Wheel(axis) => (vec![Column::new(WheelAxis(axis), None)], units.input.abs()),
        };
        columns.into_iter().map(|column| column.with_prior(Some(size))).collect()
    }

    /// How many columns it has.
    pub(crate) fn count(self) -> usize {
        match self {
            ReadingError::Misalignment | ReadingError::AxisScales | ReadingError::Offsets => 3,
            ReadingError::Delays => 2,
            ReadingError::Wheel(_) => 1,
        }
    }

    /// The factor of its size from the units of the fit: to rad, a ratio, rad/s, s.
    pub(crate) fn factor(self, units: Units) -> f64 {
        match self {
            ReadingError::Misalignment | ReadingError::AxisScales => 1.0,
            ReadingError::Offsets => units.rms,
            ReadingError::Delays => 1.0 / units.rms,
            ReadingError::Wheel(_) => 1.0 / units.input.abs(),
        }
    }

    /// A size of it in the unit of a data sheet.
    pub(crate) fn of_size(self, size: f64) -> String {
        match self {
            ReadingError::Misalignment => format!("{} deg", two_digits(size.to_degrees())),
            ReadingError::AxisScales | ReadingError::Wheel(_) => format!("{} %", two_digits(100.0 * size)),
            ReadingError::Offsets => format!("{} deg/s", two_digits(size.to_degrees())),
            ReadingError::Delays => format!("{} ms", two_digits(1e3 * size)),
        }
    }

    /// It in words that go on with its size.
    pub(crate) fn in_words(self) -> &'static str {
        match self {
            ReadingError::Misalignment => "a misalignment of the axes of the sensor",
            ReadingError::AxisScales => "relative errors of scale of the axes of the sensor",
            ReadingError::Offsets => "offsets of the sensor",
            ReadingError::Delays => "delays of the axes of the sensor",
            ReadingError::Wheel(0) => "an error of hx, the momentum of the wheels as the record tells it",
            ReadingError::Wheel(1) => "an error of hy, the momentum of the wheels as the record tells it",
            ReadingError::Wheel(_) => "an error of hz, the momentum of the wheels as the record tells it",
        }
    }
}

impl fmt::Display for ReadingError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            ReadingError::Misalignment => "misalignment",
            ReadingError::AxisScales => "axis-scales",
            ReadingError::Offsets => "offsets",
            ReadingError::Delays => "delays",
            ReadingError::Wheel(0) => "wheel-x",
            ReadingError::Wheel(1) => "wheel-y",
            ReadingError::Wheel(_) => "wheel-z",
        })
    }
}

/// `x` to two digits.
pub(crate) fn two_digits(x: f64) -> Shown {
    Shown(format!("{x:.1e}").parse().unwrap_or(x))
}

/// The median interval of the samples.
fn interval(stretches: &[Stretch]) -> f64 {
    let each = stretches.iter().flat_map(|stretch| stretch.times.windows(2).map(|pair| pair[1] - pair[0]));
    let mut each: Vec<f64> = each.collect();
    let middle = each.len() / 2;
    if each.is_empty() { 0.0 } else { *each.select_nth_unstable_by(middle, f64::total_cmp).1 }
}

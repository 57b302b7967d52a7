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
use polhode::record::median;

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
            ReadingError::AxisScales => "scale errors of the axes of the sensor",
            ReadingError::Offsets => "offsets of the sensor",
            ReadingError::Delays => "delays of the axes of the sensor",
            ReadingError::Wheel(0) => "an error of hx, the momentum of the wheels in the record",
            ReadingError::Wheel(1) => "an error of hy, the momentum of the wheels in the record",
            ReadingError::Wheel(_) => "an error of hz, the momentum of the wheels in the record",
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
    median(&mut each).unwrap_or(0.0)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::signal::stretch::KnownInputs;
    use nalgebra::Vector3;

    /// Steps of 3, 1 and 2, and of another stretch of 5; wheels about x and z.
    fn stretches() -> [Stretch; 2] {
        let of = |times: Vec<f64>| {
            let count = times.len();
            let wheel = vec![Vector3::new(2.0, 0.0, -1.0); count];
            let inputs = Some(KnownInputs { wheel, torque: vec![Vector3::zeros(); count] });
            Stretch { inputs, ..Stretch::new(times, vec![Vector3::x(); count]) }
        };
        [of(vec![0.0, 3.0, 4.0, 6.0]), of(vec![0.0, 5.0])]
    }

    /// Each error has its columns with the deviation that is plausible for it, and the factor to SI that goes with their units: of rates the
    /// unit rate of 4 rad/s, of times its inverse, of wheels one over the size of their factor.
    #[test]
    fn errors_have_plausible_sizes_in_the_units_of_the_fit() {
        let (stretches, units) = (stretches(), Units { rms: 4.0, input: -0.5 });
        let expected = [
            (ReadingError::Misalignment, 3, LARGEST, 1.0),
            (ReadingError::AxisScales, 3, LARGEST, 1.0),
            (ReadingError::Offsets, 3, LARGEST_OFFSET / 4.0, 4.0),
            // of the steps 1, 2, 3 and 5 the upper one in the middle
            (ReadingError::Delays, 2, 3.0, 0.25),
            (ReadingError::Wheel(0), 1, 0.5, 2.0),
            (ReadingError::Wheel(2), 1, 0.5, 2.0),
        ];
        assert_eq!(ReadingError::all(&stretches), expected.map(|(error, ..)| error));
        for (error, count, size, factor) in expected {
            let columns = error.columns(&stretches, units);
            assert_eq!((columns.len(), error.count()), (count, count), "{error}");
            assert!(columns.iter().all(|column| column.prior == Some(size)), "{error}: {columns:?}");
            assert_eq!(error.factor(units), factor, "{error}");
            // no column twice, and each of them is known by its name
            let names: Vec<&str> = columns.iter().map(|column| column.label().name).collect();
            let begins = match error {
                ReadingError::Misalignment => "misalignment_",
                ReadingError::AxisScales => "scale_",
                ReadingError::Offsets => "offset_",
                ReadingError::Delays => "skew_",
                ReadingError::Wheel(_) => "told_",
            };
            assert!(names.iter().all(|name| name.starts_with(begins)), "{names:?}");
            assert!((1..count).all(|k| !names[..k].contains(&names[k])), "{names:?}");
        }
        // of no samples no delay is plausible
        assert!(ReadingError::Delays.columns(&[], units).iter().all(|column| column.prior == Some(0.0)));
    }

    /// Wheels are called by their axis, and sizes are told in the units of data sheets.
    #[test]
    fn errors_are_told_by_their_axes_and_units() {
        for (axis, name) in ["x", "y", "z"].into_iter().enumerate() {
            let error = ReadingError::Wheel(axis);
            assert_eq!(error.to_string(), format!("wheel-{name}"));
            let words = format!("an error of h{name}, the momentum of the wheels in the record");
            assert_eq!(error.in_words(), words);
        }
        for (error, name, size, text) in [
            (ReadingError::Misalignment, "misalignment", 1.0_f64.to_radians(), "1 deg"),
            (ReadingError::AxisScales, "axis-scales", 0.25, "25 %"),
            (ReadingError::Offsets, "offsets", 2.0_f64.to_radians(), "2 deg/s"),
            (ReadingError::Delays, "delays", 0.0078, "7.8 ms"),
            (ReadingError::Wheel(1), "wheel-y", 0.012, "1.2 %"),
        ] {
            assert_eq!((error.to_string().as_str(), error.of_size(size).as_str()), (name, text));
        }
    }
}

//! Columns of a record beside the rates: momentum of wheels, known torques, and what is not used.

use clap::Args;
use nalgebra::Vector3;
use polhode_files::error::{Error, warn};
use polhode_files::numbers::numbers;
use polhode_fit::{RateUnit, Record, Segment};

/// A wheel whose speed is a column.
#[derive(Args, Clone, Debug)]
pub(super) struct WheelArguments {
    /// Axis of a wheel in sensor axes and its moment of inertia about it, kg m^2: its speed relative to the body is the
    /// column `wheel`, with its unit in the header, as `wheel (rpm)`
    #[arg(long, value_name = "nx,ny,nz,I", value_parser = wheel, allow_hyphen_values = true)]
    wheel: Option<Wheel>,
    /// Find the moment of inertia of a wheel with this axis instead, sensor axes: the body is that of --body, in sensor
    /// axes, with the wheel at rest; the speed of the wheel relative to it is the column `wheel`, with its unit
    #[arg(long, value_name = "nx,ny,nz", value_parser = axis, conflicts_with = "wheel", requires = "body", allow_hyphen_values = true)]
    calibrate_wheel: Option<Vector3<f64>>,
}

fn axis(text: &str) -> Result<Vector3<f64>, String> {
    let axis = Vector3::from(numbers::<3>(text)?);
    let size = axis.norm();
    if size > 0.0 && size.is_finite() {
        Ok(axis / size)
    } else {
        Err("the axis has no direction; give a vector that is not zero".into())
    }
}

/// Momentum per speed, kg m².
#[derive(Clone, Copy, Debug, PartialEq)]
struct Wheel(Vector3<f64>);

fn wheel(text: &str) -> Result<Wheel, String> {
    let [x, y, z, inertia] = numbers::<4>(text)?;
    let axis = axis(&format!("{x},{y},{z}"))?;
    if inertia > 0.0 {
        Ok(Wheel(axis * inertia))
    } else {
        Err(format!("the moment of inertia is {inertia:?}; it must be positive"))
    }
}

/// What a column beside the rates holds.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Kind {
    Momentum(usize),
    Torque(usize),
    Speed,
}

impl Kind {
    fn of(name: &str) -> Option<Kind> {
        let axis = |letter: &str| ["x", "y", "z"].iter().position(|axis| *axis == letter);
        let name = name.replace('_', "").to_lowercase();
        match name.split_at_checked(1) {
            Some(("h", rest)) => axis(rest).map(Kind::Momentum),
            Some(("t", rest)) => axis(rest).map(Kind::Torque),
            _ => (name == "wheel").then_some(Kind::Speed),
        }
    }
}

/// A column that was found in a header.
struct Found {
    kind: Kind,
    place: usize,
    name: String,
    unit: Option<String>,
}

/// A text of rows, as the library counts its lines.
struct Sheet<'t> {
    file: &'t str,
    lines: Vec<&'t str>,
    separator: char,
    header: usize,
    columns: Vec<Found>,
}

impl<'t> Sheet<'t> {
    /// The header is the last line before the rows that names such a column.
    fn new(text: &'t str, file: &'t str, first_row: usize) -> Option<Self> {
        let text = text.trim_start_matches('\u{feff}');
        let lines: Vec<&str> =
            text.split('\n').flat_map(|l| l.strip_suffix('\r').unwrap_or(l).split('\r')).collect();
        let before = lines.iter().enumerate().take(first_row.saturating_sub(1)).rev();
        let mut found = before.filter_map(|(header, line)| {
            let line = line.trim_start_matches(['#', '%', '/', ' ']);
            let separator = [';', '\t'].into_iter().find(|s| line.contains(*s)).unwrap_or(',');
            let columns: Vec<Found> = line
                .split(separator)
                .enumerate()
                .filter_map(|(place, cell)| {
                    let cell = cell.trim().trim_matches('"');
                    let (name, unit) = match cell.split_once(['(', '[']) {
                        Some((name, unit)) => (name.trim(), Some(unit.trim_end_matches([')', ']']).trim())),
                        None => (cell, None),
                    };
                    let kind = Kind::of(name)?;
                    Some(Found { kind, place, name: name.into(), unit: unit.map(String::from) })
                })
                .collect();
            (!columns.is_empty()).then_some((header, separator, columns))
        });
        let (header, separator, columns) = found.next()?;
        Some(Sheet { file, lines, separator, header, columns })
    }

    fn column(&self, kind: Kind) -> Option<&Found> {
        self.columns.iter().find(|column| column.kind == kind)
    }

    /// Where a name stands.
    fn place(&self, name: &str) -> String {
        format!("{}, line {} ({name})", self.file, self.header + 1)
    }

    /// Three columns of one kind, or none; two of them are a mistake. `unit` is one of `units` as messages write it, and
    /// that of names without one where that is `assumed`.
    fn triple(
        &self,
        kind: fn(usize) -> Kind,
        units: &[&str],
        unit: &str,
        assumed: bool,
    ) -> Result<Option<[&Found; 3]>, Error> {
        let all = [0, 1, 2].map(|axis| self.column(kind(axis)));
        if let [Some(x), Some(y), Some(z)] = all {
            for column in [x, y, z] {
                let place = self.place(&column.name);
                let Some(named) = column.unit.as_deref().or(assumed.then_some(unit)) else {
                    let remedy = format!("write {} ({unit}) in the header", column.name);
                    return Err(Error::input(&place, "", "the column has no unit", &remedy));
                };
                let plain: String = named.chars().filter(|c| !" .*·".contains(*c)).collect();
                if !units.contains(&plain.as_str()) {
                    let rule = format!("the unit here is {unit}");
                    return Err(Error::input(&place, named, &rule, "convert the column"));
                }
            }
            return Ok(Some([x, y, z]));
        }
        let one = all.iter().flatten().next();
        one.map_or(Ok(None), |one| {
            let rule = "it needs two columns more, one for each axis";
            Err(Error::input(&self.place(&one.name), "", rule, "add them, or rename this one"))
        })
    }

    /// The value of a column in a line, from 1.
    fn value(&self, line: usize, column: &Found) -> Result<f64, Error> {
        let text = self.lines.get(line - 1).copied().unwrap_or_default();
        let cell = text.split(self.separator).nth(column.place).unwrap_or_default().trim().trim_matches('"');
        let pointed = if self.separator == ',' { cell.to_string() } else { cell.replace(',', ".") };
        pointed.parse::<f64>().ok().filter(|v| v.is_finite()).ok_or_else(|| {
            let place = format!("{}, line {line}, column {} ({})", self.file, column.place + 1, column.name);
            Error::input(&place, cell, "it is not a finite number", "mend the row, or leave it out")
        })
    }

    fn vectors(&self, segment: &Segment, columns: [&Found; 3]) -> Result<Vec<Vector3<f64>>, Error> {
        let row = |line: &usize| {
            let [x, y, z] = columns.map(|column| self.value(*line, column));
            Ok(Vector3::new(x?, y?, z?))
        };
        segment.lines().iter().map(row).collect()
    }

    /// Radians per second of one unit of the speed.
    fn speed_unit(&self, column: &Found) -> Result<f64, Error> {
        let known = [("rad/s", RateUnit::RadiansPerSecond), ("deg/s", RateUnit::DegreesPerSecond)];
        let unit = column.unit.as_deref().and_then(RateUnit::named);
        let Some(unit) = unit else {
            let rule = "the speed of the wheel has no unit that is known";
            let remedy = "write wheel (rad/s), wheel (deg/s) or wheel (rpm) in the header";
            let named = column.unit.as_deref().unwrap_or_default();
            return Err(Error::input(&self.place(&column.name), named, rule, remedy));
        };
        Ok(match known.iter().find(|(_, k)| *k == unit) {
            Some(("rad/s", _)) => 1.0,
            Some(_) => core::f64::consts::PI / 180.0,
            None => core::f64::consts::PI / 30.0,
        })
    }
}

fn no_speed(flag: &str, file: &str) -> Error {
    let rule = format!("{file} has no column of its speed");
    Error::input(flag, "", &rule, "name the column wheel, with its unit")
}

impl WheelArguments {
    /// The axis of the wheel whose inertia is to be found.
    pub(super) fn calibrated(&self) -> Option<Vector3<f64>> {
        self.calibrate_wheel
    }

    /// The wheel whose speed is read, with the flag that asks for it; one to be calibrated has 1 kg m² so far.
    fn asked(&self) -> Option<(Wheel, &'static str)> {
        let calibrated = self.calibrate_wheel.map(|axis| (Wheel(axis), "--calibrate-wheel"));
        self.wheel.map(|wheel| (wheel, "--wheel")).or(calibrated)
    }

    /// The record with the wheel momenta and torques that its text holds.
    pub(super) fn complete(&self, record: Record, text: &str, file: &str) -> Result<Record, Error> {
        let first = record.segments.iter().filter_map(|s| s.lines().first()).min().copied().unwrap_or(1);
        let Some(sheet) = Sheet::new(text, file, first) else {
            return self.asked().map_or(Ok(record), |(_, flag)| Err(no_speed(flag, file)));
        };
        let momenta =
            sheet.triple(Kind::Momentum, &["Nms", "kgm^2/s", "kgm²/s", "kgm2/s"], "N m s", false)?;
        let torques = sheet.triple(Kind::Torque, &["Nm"], "N m", true)?;
        let speed = match (self.asked(), sheet.column(Kind::Speed)) {
            (Some((wheel, _)), Some(column)) => Some((wheel.0 * sheet.speed_unit(column)?, column)),
            (Some((_, flag)), None) => return Err(no_speed(flag, file)),
            (None, Some(column)) => {
                warn(&format!(
                    "{}: the column is not used; --wheel nx,ny,nz,I says which momentum the speed stands for",
                    sheet.place(&column.name)
                ));
                None
            }
            (None, None) => None,
        };
        if let (Some(_), Some([x, ..])) = (speed, momenta) {
            let rule = "the momentum of the wheels is given twice";
            return Err(Error::input(&sheet.place(&x.name), "", rule, "leave out --wheel, or these columns"));
        }
        let broken = |error: polhode_fit::RecordError| Error::Input(error.to_string());
        let mut record = record;
        for segment in &mut record.segments {
            let mut own = segment.clone();
            if let Some(columns) = momenta {
                own = own.with_wheel(sheet.vectors(segment, columns)?).map_err(broken)?;
            }
            if let Some((per_speed, column)) = speed {
                let row = |line: &usize| Ok(per_speed * sheet.value(*line, column)?);
                let momenta: Result<Vec<_>, Error> = segment.lines().iter().map(row).collect();
                own = own.with_wheel(momenta?).map_err(broken)?;
            }
            if let Some(columns) = torques {
                own = own.with_torque(sheet.vectors(segment, columns)?).map_err(broken)?;
            }
            *segment = own;
        }
        // a wheel whose speed is not used was named above
        Ok(record.with_used(|name| {
            let name = name.split(['(', '[']).next().unwrap_or_default().trim();
            Kind::of(name).is_some()
        }))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_of_inputs_are_told_from_others() {
        assert_eq!(Kind::of("hx"), Some(Kind::Momentum(0)));
        assert_eq!(Kind::of("T_z"), Some(Kind::Torque(2)));
        assert_eq!(Kind::of("wheel"), Some(Kind::Speed));
        assert!(["t", "h", "wx", "time", "thrust", ""].iter().all(|name| Kind::of(name).is_none()));
    }

    #[test]
    fn a_wheel_has_an_axis_and_a_moment() {
        assert_eq!(wheel("0,0,2,3e-6"), Ok(Wheel(Vector3::new(0.0, 0.0, 3e-6))));
        assert!(wheel("0,0,0,1").unwrap_err().contains("no direction"));
        assert!(wheel("0,0,1,-1").unwrap_err().contains("must be positive"));
        assert!(wheel("0,0,1").unwrap_err().contains("3 given, 4 needed"));
    }
}

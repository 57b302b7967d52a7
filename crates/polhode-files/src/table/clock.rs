//! Times of rows: numbers in a unit, counts since 1970, dates; and what lines before the header say of the columns.

use polhode::units::{Date, RateUnit, TimeUnit};

use super::cells::may_part_thousands;
use super::lines::Line;
use super::name::Name;
use crate::read_as::NamedBy;

/// Reads the times of one text.
pub(crate) struct Clock {
    unit: Option<TimeUnit>,
    /// Known with the first time.
    kind: Option<Kind>,
    /// The first time, where the others count from it.
    since: Option<String>,
}

enum Kind {
    Numbers(TimeUnit),
    /// From this whole number on: what stands for now in nanoseconds since 1970 has more digits than a double.
    Counts(TimeUnit, i128),
    /// Seconds and nanoseconds apart, from these seconds on.
    Stamps(i128),
    /// From this date on.
    Dates(Date),
}

/// A count since 1970 in each unit lies between these, from 2001 on.
const COUNTS: [(TimeUnit, f64); 3] =
    [(TimeUnit::Nanoseconds, 1e18), (TimeUnit::Microseconds, 1e15), (TimeUnit::Milliseconds, 1e12)];
const LATEST: f64 = 4.0;

/// Nanoseconds in a second.
const BILLION: i128 = 1_000_000_000;

impl Clock {
    /// With the unit that is known of numbers.
    pub(crate) fn new(unit: Option<TimeUnit>) -> Self {
        Clock { unit, kind: None, since: None }
    }

    /// The time of a cell, s; with `nanoseconds` it holds whole seconds.
    pub(crate) fn seconds(&mut self, cell: &str, nanoseconds: Option<&str>) -> Option<f64> {
        if self.kind.is_none() {
            let kind = self.kind_of(cell, nanoseconds.is_some())?;
            self.since = (!matches!(kind, Kind::Numbers(_))).then(|| cell.into());
            self.kind = Some(kind);
        }
        let number = || cell.parse::<f64>().ok();
        let time = match self.kind.as_ref()? {
            Kind::Numbers(unit) => unit.seconds(number()?),
            Kind::Counts(unit, first) => match cell.parse::<i128>() {
                Ok(count) => unit.seconds((count - first) as f64),
                Err(_) => unit.seconds(number()? - *first as f64),
            },
            Kind::Stamps(first) => {
                (cell.parse::<i128>().ok()? - first) as f64 + nanoseconds?.parse::<f64>().ok()? / 1e9
            }
            Kind::Dates(first) => cell.parse::<Date>().ok()?.seconds_since(first).ok()?,
        };
        time.is_finite().then_some(time)
    }

    /// The first time as it is written, where the others count from it.
    pub(crate) fn since(&self) -> Option<&str> {
        self.since.as_deref()
    }

    /// The moment of the first time, where the others count from it.
    pub(crate) fn begins(&self) -> Option<Date> {
        Some(match self.kind.as_ref()? {
            Kind::Numbers(_) => return None,
            Kind::Counts(unit, first) => {
                let nanoseconds = match unit {
                    TimeUnit::Nanoseconds => 1,
                    TimeUnit::Microseconds => 1_000,
                    _ => 1_000_000,
                };
                let first = first * nanoseconds;
                Date::of_unix(first.div_euclid(BILLION) as i64, first.rem_euclid(BILLION) as u32)
            }
            Kind::Stamps(first) => Date::of_unix(*first as i64, 0),
            Kind::Dates(first) => *first,
        })
    }

    /// What the times are where they are no numbers of a unit, once one was read.
    pub(crate) fn words(&self) -> Option<(String, NamedBy)> {
        match self.kind.as_ref()? {
            Kind::Numbers(_) => None,
            Kind::Counts(unit, _) if self.unit == Some(*unit) => None,
            Kind::Counts(unit, _) => Some((format!("{unit} since 1970"), NamedBy::Values)),
            Kind::Stamps(_) => Some(("s and ns".into(), NamedBy::Header)),
            Kind::Dates(_) => Some(("dates".into(), NamedBy::Values)),
        }
    }

    fn kind_of(&self, cell: &str, has_nanoseconds: bool) -> Option<Kind> {
        if has_nanoseconds {
            return cell.parse().ok().map(Kind::Stamps);
        }
        let Ok(value) = cell.parse::<f64>() else { return cell.parse().ok().map(Kind::Dates) };
        let counted = COUNTS.iter().find(|(_, least)| (*least..LATEST * least).contains(&value));
        if let Some((unit, _)) = counted
            && self.unit.is_none_or(|known| known == *unit)
        {
            return Some(Kind::Counts(*unit, cell.parse().unwrap_or(value as i128)));
        }
        Some(Kind::Numbers(self.unit.unwrap_or(TimeUnit::Seconds)))
    }
}

/// What the lines before the header say.
#[derive(Default)]
pub(crate) struct Preamble {
    /// Of a gyroscope in the units of its converter, deg/s.
    gyro_scale: Option<f64>,
    /// Samples a second; `None` also where lines tell two.
    rate: Option<f64>,
    /// An Xsens DOT, whose clock counts microseconds and whose rates are in deg/s.
    is_dot: bool,
}

impl Preamble {
    pub(crate) fn of(lines: &[Line]) -> Self {
        let mut found = Preamble::default();
        let mut rates: Vec<Option<f64>> = Vec::new();
        for line in lines {
            let lower = line.text.to_lowercase();
            let value = || lower.rsplit([':', ',', '=']).next().unwrap_or_default().trim_matches(['"', ' ']);
            if lower.contains("gyro_scale") || lower.contains("gyroscale") {
                found.gyro_scale = scale(value());
            } else if lower.contains("sample rate") || lower.contains("update rate") {
                if !is_of_another_sensor(&lower) {
                    rates.push(rate(&lower));
                }
            } else if lower.contains("devicetag") {
                found.is_dot = true;
            }
        }
        let first = rates.first().copied().flatten();
        found.rate = first.filter(|first| rates.iter().all(|other| *other == Some(*first)));
        found
    }

    /// The unit of a time column that counts in its own way.
    pub(crate) fn time_unit(&self, name: &Name) -> Option<TimeUnit> {
        match name.letters.as_str() {
            "sampletimefine" if self.is_dot => Some(TimeUnit::Microseconds),
            // ticks of 10 kHz
            "sampletimefine" => Some(TimeUnit::Multiple(1e-4)),
            _ if name.is_counter() => self.rate.map(|rate| TimeUnit::Multiple(1.0 / rate)),
            _ => None,
        }
    }

    /// The unit of the rates of the device.
    pub(crate) fn rate_unit(&self) -> Option<RateUnit> {
        self.is_dot.then_some(RateUnit::DegreesPerSecond)
    }

    /// What a number of the column `name` is in the unit of the column.
    pub(crate) fn scale(&self, name: &str) -> f64 {
        let is_raw = |_: &f64| name.to_lowercase().starts_with("gyroadc[") && !name.contains('(');
        self.gyro_scale.filter(is_raw).unwrap_or(1.0)
    }
}

/// Whether a line in lower case is of a sensor beside the gyroscope.
fn is_of_another_sensor(line: &str) -> bool {
    let names = |word: &str| {
        ["accel", "magn", "baro", "gps", "gnss"].iter().any(|stem| word.starts_with(stem))
            || ["acc", "mag"].contains(&word)
    };
    !line.contains("gyr") && line.split(|c: char| !c.is_alphanumeric()).any(names)
}

/// Samples a second behind the last colon or equals sign of a line in lower case, or else behind its first comma; a comma within
/// the number is a decimal one.
fn rate(line: &str) -> Option<f64> {
    let marks = ['"', ' ', ','];
    let told = line.rsplit_once([':', '=']).or_else(|| line.split_once(','));
    let value = told.map_or(line, |(_, value)| value);
    let value = value.trim_matches(marks).trim_end_matches("hz").trim_matches(marks);
    let rate = if may_part_thousands(value) { None } else { value.replace(',', ".").parse::<f64>().ok() };
    rate.filter(|rate| *rate > 0.0)
}

/// Betaflight's scale in deg/s: the bits of a float, or a number; what is tiny is in rad/µs.
fn scale(text: &str) -> Option<f64> {
    let value = match text.strip_prefix("0x") {
        Some(bits) => f64::from(f32::from_bits(u32::from_str_radix(bits, 16).ok()?)),
        None => text.parse().ok()?,
    };
    let degrees = if value < 1e-5 { value * 1e6 * (180.0 / core::f64::consts::PI) } else { value };
    (degrees.is_finite() && degrees > 0.0).then_some(degrees)
}

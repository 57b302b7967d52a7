//! An instant or a time span as it is written: a number of seconds, a number with a unit, or a date.

use polhode::units::{Date, TimeScale, TimeUnit};

use crate::numbers::number;

/// All integers below are doubles.
const WHOLE: f64 = (1_u64 << f64::MANTISSA_DIGITS) as f64;

/// The seconds in the unit of time `name`.
#[must_use]
pub fn seconds_in(name: &str) -> Option<f64> {
    TimeUnit::named(name).map(|unit| unit.seconds(1.0))
}

/// A number and the name of a unit behind it.
fn with_unit(text: &str) -> Option<(&str, &str)> {
    let digits = text.trim_end_matches(|c: char| c.is_ascii_alphabetic());
    let is_number = || digits.trim_end().parse::<f64>().is_ok();
    (digits.len() < text.len() && is_number()).then(|| (digits.trim_end(), &text[digits.len()..]))
}

/// Whether `text` is an integer and the double nearest to it, `value`, another one, as with nanoseconds since 1970.
pub(crate) fn is_other_integer(text: &str, value: f64) -> bool {
    let digits = text.strip_prefix(['+', '-']).unwrap_or(text).trim_start_matches('0');
    let is_whole = digits.bytes().all(|digit| digit.is_ascii_digit());
    is_whole && value.abs() >= WHOLE && format!("{:.0}", value.abs()) != digits
}

/// A number; an integer that is no double would be another one.
fn count(text: &str) -> Result<f64, String> {
    let value = number(text)?;
    if is_other_integer(text, value) {
        return Err(format!(
            "'{text}' has too many digits for a double, the nearest is {value:e}; count from a later time"
        ));
    }
    Ok(value)
}

/// A time span: a number of seconds, or with a unit, as 12h.
pub fn duration(text: &str) -> Result<f64, String> {
    span(text, count)
}

/// The same, whose numbers are read by `number`.
fn span(text: &str, number: fn(&str) -> Result<f64, String>) -> Result<f64, String> {
    let text = text.trim();
    let Some((digits, name)) = with_unit(text) else { return number(text) };
    let value = number(digits)?;
    let unit = TimeUnit::named(name)
        .ok_or_else(|| format!("unknown unit of time '{name}'; write ns, us, ms, s, min, h or d"))?;
    let seconds = unit.seconds(value);
    if seconds.is_finite() { Ok(seconds) } else { Err(format!("'{text}' is too long a time for a double")) }
}

/// The same, above zero.
pub fn positive_duration(text: &str) -> Result<f64, String> {
    match duration(text)? {
        value if value > 0.0 => Ok(value),
        value => Err(format!("{value:?} is not positive; give a time above zero")),
    }
}

/// The date of t = 0.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Epoch {
    /// The date.
    pub date: Date,
    /// The time scale of this date and of others that are written without one.
    pub scale: Option<TimeScale>,
}

impl Epoch {
    /// A date, and the scale of dates without one.
    #[must_use]
    pub fn new(date: Date, scale: Option<TimeScale>) -> Self {
        Epoch { date: scale.map_or(date, |scale| date.or_in(scale)), scale }
    }
}

/// A date by itself.
pub fn date(text: &str) -> Result<Date, String> {
    text.parse::<Date>().map_err(|error| error.to_string())
}

/// The time scale of that name.
pub fn time_scale(text: &str) -> Result<TimeScale, String> {
    TimeScale::named(text).ok_or_else(|| format!("unknown time scale '{text}'; write UTC, TAI, TT or TDB"))
}

/// The time `text` in seconds, from `epoch` on where there is one.
pub fn seconds(text: &str, epoch: Option<Epoch>) -> Result<f64, String> {
    let text = text.trim();
    if with_unit(text).is_some_and(|(_, name)| TimeUnit::named(name).is_some()) {
        return duration(text);
    }
    match epoch {
        Some(Epoch { date: epoch, scale }) => {
            let date = Epoch::new(date(text)?, scale).date;
            date.seconds_since(&epoch).map_err(|error| format!("'{text}': {error}"))
        }
        None => duration(text).map_err(|error| match text.parse::<Date>() {
            Ok(_) if number(text).is_err() => {
                format!("'{text}' is a date; give the date of t = 0 by --epoch")
            }
            _ => error,
        }),
    }
}

/// Whether `text` is a time of one of the three kinds.
pub fn is_moment(text: &str) -> Result<(), String> {
    span(text, number).map(|_| ()).or_else(|error| {
        let is_date = number(text).is_err() && text.parse::<Date>().is_ok();
        if is_date { Ok(()) } else { Err(error) }
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn durations_are_seconds_or_have_a_unit() {
        for (text, expected) in [
            ("0.1", 0.1),
            ("-1e3", -1e3),
            ("30d", 2_592_000.0),
            ("12h", 43_200.0),
            ("90min", 5400.0),
            ("90 min", 5400.0),
            ("5s", 5.0),
            ("-250ms", -0.25),
            ("3us", 3e-6),
            ("7ns", 7e-9),
            ("1e3h", 3.6e6),
        ] {
            assert_eq!(duration(text), Ok(expected), "{text}");
        }
        assert_eq!(duration("5e").unwrap_err(), "unknown unit of time 'e'; write ns, us, ms, s, min, h or d");
        assert!(duration("3 weeks").unwrap_err().contains("unknown unit of time 'weeks'"));
        assert!(duration("1e308d").unwrap_err().contains("too long a time"));
        assert!(duration("h").unwrap_err().contains("'h' is not a number"));
        assert!(duration("inf").unwrap_err().contains("not a finite number"));
        assert!(positive_duration("0h").unwrap_err().contains("not positive"));
    }

    /// 2^53 + 1 is no double, its neighbours are; digits behind a point or before an exponent may be rounded.
    #[test]
    fn integers_that_are_no_double_are_refused() {
        for text in
            ["9007199254740993", "-9007199254740993", "+0009007199254740993ns", "1700000000000000001 ns"]
        {
            let error = duration(text).unwrap_err();
            assert!(error.contains("has too many digits for a double, the nearest is "), "{text}: {error}");
        }
        assert!(duration("9007199254740993").unwrap_err().contains("9.007199254740992e15"));
        for (text, expected) in [
            ("9007199254740992", 9_007_199_254_740_992.0),
            ("-9007199254740994", -9_007_199_254_740_994.0),
            ("10000000000000000000000", 1e22),
            ("9007199254740993.0", 9_007_199_254_740_992.0),
            ("1e30", 1e30),
        ] {
            assert_eq!(duration(text), Ok(expected), "{text}");
        }
    }

    #[test]
    fn dates_count_from_the_epoch() {
        let epoch = |text: &str, scale| Some(Epoch::new(date(text).unwrap(), scale));
        let noon = epoch("2000-01-01T12:00", None);
        for (text, expected) in [
            ("2451545", 0.0),
            ("2451545.1", 8640.0),
            ("2451546.000011574074074074", 86_401.0),
            ("2000-01-01", -43_200.0),
            ("3h", 10_800.0),
        ] {
            let found = seconds(text, noon).unwrap();
            approx::assert_relative_eq!(found, expected, max_relative = 1e-15);
        }
        assert!(seconds("2000-01-01", None).unwrap_err().contains("--epoch"));
        assert!(seconds("2451545 TDB", None).unwrap_err().contains("--epoch"));
        assert!(seconds("2451545 TDB", noon).unwrap_err().contains("differ by a minute"));
        assert!(seconds("2000-01-32", noon).unwrap_err().contains("no such day"));
        for utc in [epoch("2000-01-01T12:00 UTC", None), epoch("2000-01-01T12:00", Some(TimeScale::Utc))] {
            let found = seconds("2451545 TT", utc).unwrap();
            assert!((found + 64.184).abs() < 1e-9, "{found}");
        }
        let found = seconds("2451545.1", epoch("2451545", Some(TimeScale::Tdb))).unwrap();
        assert!((found - 8640.0).abs() < 1e-9, "{found}");
        assert!(is_moment("2000-01-01").is_ok() && is_moment("12h").is_ok() && is_moment("2e").is_err());
    }
}

//! Dates: the civil calendar and Julian dates, in days of 86 400 s.

use core::str::FromStr;

use thiserror::Error;

use crate::num::{Dd, Precise, Real};

/// Julian date of 1970-01-01, midnight.
const EPOCH_1970: f64 = 2_440_587.5;
const DAY: f64 = 86_400.0;
const MONTHS: [&str; 12] =
    ["jan", "feb", "mar", "apr", "may", "jun", "jul", "aug", "sep", "oct", "nov", "dec"];

/// A date to the digits of double-double, for differences that are exact to the last digit of a time in seconds.
///
/// Read from a Julian date (`2448936.2415`), from ISO 8601 (`1992-11-09T17:49:47.5Z`, with a blank or `T`, and an offset such
/// as `+01:00`), or from a date with the name of its month (`09-Nov-1992 17:49:47`). Days have 86 400 s, as in the time scales
/// TT and TDB; leap seconds are not counted.
///
/// ```
/// use polhode::units::Date;
/// let epoch: Date = "1992-11-09T12:00".parse()?;
/// let later: Date = "2448937.25".parse()?; // six hours after the noon of the next day
/// assert_eq!(later.seconds_since(&epoch), 108_000.0);
/// # Ok::<(), polhode::units::DateError>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[must_use]
pub struct Date {
    julian: Dd,
}

/// The text is no date.
#[derive(Clone, Debug, PartialEq, Eq, Error)]
#[error("'{text}' is not a date: {rule}; write it like 2025-11-22T10:20:30 or as a Julian date")]
#[non_exhaustive]
pub struct DateError {
    /// What was given.
    pub text: String,
    /// What is wrong with it.
    pub rule: &'static str,
}

impl Date {
    /// The time from `other` to this date, s.
    #[must_use]
    pub fn seconds_since(&self, other: &Date) -> f64 {
        ((self.julian - other.julian) * DAY).to_f64()
    }

    /// The date `seconds` s later.
    pub fn later(&self, seconds: f64) -> Date {
        Date { julian: self.julian + Dd::of(seconds) / Dd::of(DAY) }
    }

    /// Julian date, d.
    #[must_use]
    pub fn julian(&self) -> f64 {
        self.julian.to_f64()
    }
}

impl FromStr for Date {
    type Err = DateError;
    fn from_str(text: &str) -> Result<Date, DateError> {
        let text = text.trim();
        let refused = |rule| DateError { text: text.into(), rule };
        if let Ok(julian) = text.parse::<Dd>() {
            let is_in_range = julian.to_f64().abs() < 1e12;
            return if is_in_range { Ok(Date { julian }) } else { Err(refused("no such Julian date")) };
        }
        let (day, rest) = day(text).ok_or(refused("there is no day in it"))?.map_err(refused)?;
        let seconds = time_of_day(rest).map_err(refused)?;
        Ok(Date { julian: Dd::of(EPOCH_1970 + day as f64) + seconds / Dd::of(DAY) })
    }
}

/// Days since 1970-01-01, and what follows; `None` of a text that does not begin like a date.
fn day(text: &str) -> Option<Result<(i64, &str), &'static str>> {
    let end = text.find([' ', 'T']).unwrap_or(text.len());
    let (date, rest) = text.split_at(end);
    let mut parts = date.split(['-', '/']);
    let (first, second, third) = (parts.next()?, parts.next()?, parts.next()?);
    if parts.next().is_some() {
        return None;
    }
    let number = |digits: &str| -> Option<i64> {
        (digits.len() <= 4 && digits.bytes().all(|b| b.is_ascii_digit())).then(|| digits.parse().ok())?
    };
    let (year, month, day) = match MONTHS.iter().position(|name| second.eq_ignore_ascii_case(name)) {
        Some(month) => (number(third)?, month as i64 + 1, number(first)?),
        None if first.len() == 4 => (number(first)?, number(second)?, number(third)?),
        None => return None,
    };
    if !(1..=12).contains(&month) {
        return Some(Err("months run from 1 to 12"));
    }
    let since_1970 = days_since_1970(year, month, day);
    let (next_year, next_month) = if month == 12 { (year + 1, 1) } else { (year, month + 1) };
    if day < 1 || since_1970 >= days_since_1970(next_year, next_month, 1) {
        return Some(Err("the month has no such day"));
    }
    Some(Ok((since_1970, rest)))
}

/// Of the Gregorian calendar, also before 1582: whole years from March on, so that the leap day is the last of a year.
fn days_since_1970(year: i64, month: i64, day: i64) -> i64 {
    let (year, month) = if month > 2 { (year, month - 3) } else { (year - 1, month + 9) };
    let leap_days = year.div_euclid(4) - year.div_euclid(100) + year.div_euclid(400);
    // months from March on have 31, 30, 31, 30, 31 days, twice, and then two more
    365 * year + leap_days + (153 * month + 2) / 5 + day - 719_469
}

/// Seconds since midnight, Greenwich where an offset is given.
fn time_of_day(text: &str) -> Result<Dd, &'static str> {
    let text = text.trim_start_matches(['T', ' ']).trim_end_matches('Z').trim_end();
    if text.is_empty() {
        return Ok(Dd::ZERO);
    }
    let (clock, offset) = match text.rfind(['+', '-']) {
        Some(sign) => (text[..sign].trim_end(), offset(&text[sign..])?),
        None => (text, 0),
    };
    let mut parts = clock.splitn(3, ':');
    let count = |digits: Option<&str>, most: i64| {
        digits
            .filter(|digits| (1..=2).contains(&digits.len()) && digits.bytes().all(|b| b.is_ascii_digit()))
            .and_then(|digits| digits.parse::<i64>().ok())
            .filter(|count| *count <= most)
    };
    let hours = count(parts.next(), 23).ok_or("hours run from 0 to 23")?;
    let minutes = count(parts.next(), 59).ok_or("minutes run from 0 to 59")?;
    let seconds = match parts.next() {
        None => Dd::ZERO,
        Some(text) => {
            let plain = text.bytes().all(|b| b.is_ascii_digit() || b == b'.');
            let seconds = text.parse::<Dd>().ok().filter(|s| plain && s.hi() < 60.0);
            seconds.ok_or("seconds are below 60, and leap seconds are not counted")?
        }
    };
    Ok(seconds + (60 * (60 * hours + minutes) - offset) as f64)
}

/// `+01:00`, `-0530` or `+02` in seconds.
fn offset(text: &str) -> Result<i64, &'static str> {
    let (sign, digits) = text.split_at(1);
    let digits = digits.replace(':', "");
    let number = digits.bytes().all(|b| b.is_ascii_digit()).then(|| digits.parse::<i64>().ok()).flatten();
    let minutes = match (number, digits.len()) {
        (Some(hours), 1 | 2) => 60 * hours,
        (Some(both), 4) => 60 * (both / 100) + both % 100,
        _ => return Err("an offset is written +hh:mm"),
    };
    Ok(if sign == "-" { -60 * minutes } else { 60 * minutes })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn since_1970(text: &str) -> f64 {
        text.parse::<Date>().unwrap().seconds_since(&"1970-01-01".parse().unwrap())
    }

    #[test]
    fn dates_are_those_of_the_almanac() {
        // Meeus, Astronomical Algorithms, table 7.a
        for (text, julian) in [
            ("2000-01-01T12:00", 2_451_545.0),
            ("1999-01-01", 2_451_179.5),
            ("1987-01-27", 2_446_822.5),
            ("1988-06-19 12:00:00", 2_447_332.0),
            ("1600-01-01", 2_305_447.5),
            ("1957-10-04T19:26:24", 2_436_116.31),
        ] {
            assert_eq!(text.parse::<Date>().unwrap().julian(), julian, "{text}");
        }
    }

    #[test]
    fn every_spelling_is_the_same_instant() {
        for text in [
            "2025-11-22T10:20:30.125Z",
            "2025-11-22 10:20:30.125",
            "2025/11/22 10:20:30.125",
            "22-Nov-2025 10:20:30.125",
            "2025-11-22T11:20:30.125+01:00",
            "2025-11-22 04:50:30.125 -0530",
        ] {
            assert_eq!(since_1970(text), 1_763_806_830.125, "{text}");
        }
        assert_eq!(since_1970("2024-02-29T23:59:59.999999"), 1_709_251_199.999_999);
        assert_eq!(since_1970("2440588.1"), 51_840.0);
    }

    #[test]
    fn what_is_no_date_is_refused_by_its_rule() {
        for (text, rule) in [
            ("2025-13-01", "months run"),
            ("2025-02-29", "no such day"),
            ("2025-04-31", "no such day"),
            ("2025-04-00", "no such day"),
            ("2025-04-01T24:00", "hours run"),
            ("2025-04-01T10", "minutes run"),
            ("2025-04-01T10:60", "minutes run"),
            ("2016-12-31T23:59:60", "leap seconds"),
            ("2025-04-01T10:00+1:2:3x", "offset"),
            ("yesterday", "no day"),
            ("1-2-3-4", "no day"),
            ("1e300", "no such Julian date"),
        ] {
            let error = text.parse::<Date>().unwrap_err().to_string();
            assert!(
                error.starts_with(&format!("'{text}' is not a date: ")) && error.contains(rule),
                "{error}"
            );
        }
    }
}

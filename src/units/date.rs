//! Dates: the civil calendar and Julian dates.

use core::ops::RangeInclusive;
use core::str::FromStr;

use thiserror::Error;

use super::time_scale::{TimeScale, ends_in_a_leap_second, has_leap_seconds};
use crate::num::{Dd, Precise, Real};

/// Julian date of 1970-01-01, midnight.
const EPOCH_1970: f64 = 2_440_587.5;
pub(super) const DAY: f64 = 86_400.0;
const MONTHS: [&str; 12] =
    ["jan", "feb", "mar", "apr", "may", "jun", "jul", "aug", "sep", "oct", "nov", "dec"];

/// A date to the digits of double-double, for differences that are exact to the last digit of a time in seconds.
///
/// Read from a Julian date (`2448936.2415`), from ISO 8601 (`1992-11-09T17:49:47.5Z`, with a blank or `T`, and an offset such
/// as `+01:00`), or from a date with the name of its month (`09-Nov-1992 17:49:47`), each with the [time scale](TimeScale) behind
/// it: `2462240.407 TDB`. `Z` and an offset mean UTC.
///
/// Without a scale days have 86 400 s, and such dates go with each other alone: beside a date with a scale they could be a minute off.
///
/// ```
/// use polhode::units::Date;
/// let epoch: Date = "1992-11-09T12:00".parse()?;
/// let later: Date = "2448937.25".parse()?; // six hours after the noon of the next day
/// assert_eq!(later.seconds_since(&epoch)?, 108_000.0);
///
/// let observed: Date = "2016-12-31T23:59:59 UTC".parse()?;
/// let tabulated: Date = "2017-01-01T00:01:08.184 TT".parse()?; // two seconds later, of which one is a leap second
/// assert!((tabulated.seconds_since(&observed)? - 1.0).abs() < 1e-9);
/// assert!(later.seconds_since(&observed).is_err());
/// # Ok::<(), polhode::Error>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[must_use]
pub struct Date {
    /// Julian date of TAI, or of days of 86 400 s where no scale is known.
    instant: Dd,
    scale: Option<TimeScale>,
}

/// The text is no date.
#[derive(Clone, Debug, PartialEq, Eq, Error)]
#[error("'{text}' is not a date: {rule}; write it like 2025-11-22T10:20:30 UTC or as a Julian date")]
#[non_exhaustive]
pub struct DateError {
    /// What was given.
    pub text: String,
    /// What is wrong with it.
    pub rule: &'static str,
}

/// Two dates whose time scales do not go together.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Error)]
#[non_exhaustive]
pub enum ScaleError {
    /// One has no scale.
    #[error(
        "one date is in {} and the other has no time scale, so that they may differ by a minute; write UTC, TAI, TT or TDB after both or after neither",
        .scale.name()
    )]
    Missing {
        /// That of the one that has one.
        scale: TimeScale,
    },
    /// UTC before its leap seconds.
    #[error("UTC before 1972 had no whole leap seconds, and its difference from {} is not in the table here; write both dates in {0}", .scale.name())]
    BeforeLeapSeconds {
        /// That of the other date.
        scale: TimeScale,
    },
}

impl Date {
    /// The time from `other` to this date, s.
    ///
    /// # Errors
    /// One of both has no time scale, or is one of UTC before 1972 beside another scale.
    pub fn seconds_since(&self, other: &Date) -> Result<f64, ScaleError> {
        match (self.scale, other.scale) {
            (Some(scale), None) | (None, Some(scale)) => return Err(ScaleError::Missing { scale }),
            (Some(one), Some(another)) if one != another => {
                for (date, scale) in [(self, another), (other, one)] {
                    if date.scale == Some(TimeScale::Utc) && !has_leap_seconds(date.instant) {
                        return Err(ScaleError::BeforeLeapSeconds { scale });
                    }
                }
            }
            _ => {}
        }
        // seconds of TDB where both are of it, whose length swings by 3e-10 with the year
        let reading = |date: &Date| match (self.scale, other.scale) {
            (Some(TimeScale::Tdb), Some(TimeScale::Tdb)) => TimeScale::Tdb.of_tai(date.instant),
            _ => date.instant,
        };
        Ok(((reading(self) - reading(other)) * DAY).to_f64())
    }

    /// The moment of a Unix time, which counts from 1970 without leap seconds, in UTC.
    ///
    /// ```
    /// use polhode::units::Date;
    /// let moment = Date::of_unix(1_700_000_000, 250_000_000);
    /// assert_eq!(moment.seconds_since(&"2023-11-14T22:13:20Z".parse()?)?, 0.25);
    /// # Ok::<(), polhode::Error>(())
    /// ```
    pub fn of_unix(seconds: i64, nanoseconds: u32) -> Date {
        let seconds = Dd::of(seconds as f64) + Dd::of(f64::from(nanoseconds)) / Dd::of(1e9);
        let instant = Dd::of(EPOCH_1970) + seconds / Dd::of(DAY);
        Date { instant, scale: None }.in_scale(Some(TimeScale::Utc))
    }

    /// The time scale that was written behind it.
    #[must_use]
    pub fn scale(&self) -> Option<TimeScale> {
        self.scale
    }

    /// The same date in `scale` where it has none.
    pub fn or_in(self, scale: TimeScale) -> Date {
        self.in_scale(self.scale.is_none().then_some(scale))
    }

    /// A date without a scale, in this one.
    fn in_scale(self, scale: Option<TimeScale>) -> Date {
        let found = scale.map(|scale| Date { instant: scale.to_tai(self.instant), scale: Some(scale) });
        found.unwrap_or(self)
    }

    /// The date `seconds` s later, in the same scale.
    pub fn later(&self, seconds: f64) -> Date {
        Date { instant: self.instant + Dd::of(seconds) / Dd::of(DAY), scale: self.scale }
    }

    /// Julian date in its own scale, d.
    #[must_use]
    pub fn julian(&self) -> f64 {
        self.scale.map_or(self.instant, |scale| scale.of_tai(self.instant)).to_f64()
    }
}

impl FromStr for Date {
    type Err = DateError;
    fn from_str(text: &str) -> Result<Date, DateError> {
        let refused = |rule| DateError { text: text.trim().into(), rule };
        let (text, written) = scale(text.trim()).map_err(refused)?;
        let number = text.strip_prefix("JD").map_or(text, str::trim_start);
        if let Ok(julian) = number.parse::<Dd>() {
            let date = Date { instant: julian, scale: None };
            let is_in_range = julian.to_f64().abs() < 1e12;
            return if is_in_range {
                Ok(date.in_scale(written))
            } else {
                Err(refused("no such Julian date"))
            };
        }
        let (day, rest) = day(text).ok_or(refused("the day is missing"))?.map_err(refused)?;
        let clock = time_of_day(rest).map_err(refused)?;
        let scale = match (clock.is_utc, written) {
            (true, Some(other)) if other != TimeScale::Utc => {
                return Err(refused("Z and offsets mean UTC, but another time scale follows"));
            }
            (true, _) => Some(TimeScale::Utc),
            (false, written) => written,
        };
        let julian = |seconds: Dd| Dd::of(julian_of_day(day)) + seconds / Dd::of(DAY);
        if !clock.is_leap {
            return Ok(Date { instant: julian(clock.seconds), scale: None }.in_scale(scale));
        }
        // the second before it is one of any day
        let before = clock.seconds - Dd::ONE;
        let days = libm::floor(before.to_f64() / DAY);
        let is_last = before.to_f64() - days * DAY >= DAY - 1.0;
        if !(is_last && scale == Some(TimeScale::Utc) && ends_in_a_leap_second(day + days as i64)) {
            return Err(refused("second 60 exists only in a leap second of UTC"));
        }
        Ok(Date { instant: julian(before), scale: None }.in_scale(scale).later(1.0))
    }
}

/// The text without the time scale behind it, and the scale.
fn scale(text: &str) -> Result<(&str, Option<TimeScale>), &'static str> {
    let rest = text.trim_end_matches(|c: char| c.is_ascii_alphabetic());
    let name = &text[rest.len()..];
    // Z belongs to the time of day, and what has no digit before it is no scale
    let is_behind = rest.trim_end().ends_with(|c: char| c.is_ascii_digit() || c == '.' || c == 'Z');
    match TimeScale::named(name) {
        Some(scale) if is_behind => Ok((rest.trim_end(), Some(scale))),
        None if is_behind && name.len() > 1 => Err("its time scale must be UTC, TAI, TT or TDB"),
        _ => Ok((text, None)),
    }
}

/// Julian date of the midnight that begins a day.
pub(super) fn julian_of_day(since_1970: i64) -> f64 {
    EPOCH_1970 + since_1970 as f64
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
    let number = |text: &str| whole(text, 1..=4);
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

/// A number that is written in so many digits and nothing else.
fn whole(text: &str, digits: RangeInclusive<usize>) -> Option<i64> {
    let is_whole = digits.contains(&text.len()) && text.bytes().all(|b| b.is_ascii_digit());
    text.parse().ok().filter(|_| is_whole)
}

/// Of the Gregorian calendar, also before 1582: whole years from March on, so that the leap day is the last of a year.
pub(super) fn days_since_1970(year: i64, month: i64, day: i64) -> i64 {
    let (year, month) = if month > 2 { (year, month - 3) } else { (year - 1, month + 9) };
    let leap_days = year.div_euclid(4) - year.div_euclid(100) + year.div_euclid(400);
    // months from March on have 31, 30, 31, 30, 31 days, twice, and then two more
    365 * year + leap_days + (153 * month + 2) / 5 + day - 719_469
}

/// A time of day.
struct Clock {
    /// Since midnight, of Greenwich where an offset is given.
    seconds: Dd,
    /// Whether Z or an offset says so.
    is_utc: bool,
    /// Whether its last minute has more than 60 s.
    is_leap: bool,
}

fn time_of_day(text: &str) -> Result<Clock, &'static str> {
    let text = text.trim_start_matches(['T', ' ']);
    let (text, is_zulu) = text.strip_suffix('Z').map_or((text, false), |text| (text.trim_end(), true));
    if text.is_empty() {
        return Ok(Clock { seconds: Dd::ZERO, is_utc: is_zulu, is_leap: false });
    }
    let (clock, offset) = match text.rfind(['+', '-']) {
        Some(sign) => (text[..sign].trim_end(), Some(offset(&text[sign..])?)),
        None => (text, None),
    };
    let mut parts = clock.splitn(3, ':');
    let count = |text: Option<&str>, most: i64| whole(text?, 1..=2).filter(|count| *count <= most);
    let hours = count(parts.next(), 23).ok_or("hours run from 0 to 23")?;
    let minutes = count(parts.next(), 59).ok_or("minutes run from 0 to 59")?;
    let seconds = match parts.next() {
        None => Dd::ZERO,
        Some(text) => {
            let plain = text.bytes().all(|b| b.is_ascii_digit() || b == b'.');
            let seconds = text.parse::<Dd>().ok().filter(|s| plain && s.hi() < 61.0);
            seconds.ok_or("seconds are below 60, or below 61 in a leap second")?
        }
    };
    let minutes = 60 * (60 * hours + minutes) - offset.unwrap_or(0);
    let is_leap = seconds.hi() >= 60.0;
    Ok(Clock { seconds: seconds + minutes as f64, is_utc: is_zulu || offset.is_some(), is_leap })
}

/// `+01:00`, `-0530` or `+02` in seconds.
fn offset(text: &str) -> Result<i64, &'static str> {
    let (sign, digits) = text.split_at(1);
    let (hours, minutes) = match digits.split_once(':') {
        Some(both) => both,
        None if digits.len() == 4 && digits.is_ascii() => digits.split_at(2),
        None => (digits, "00"),
    };
    // of fewer digits it would be open which of them are hours
    let (Some(hours), Some(minutes)) = (whole(hours, 2..=2), whole(minutes, 2..=2)) else {
        return Err("an offset is written +hh:mm, +hhmm or +hh");
    };
    if hours > 23 || minutes > 59 {
        return Err("the hours of an offset run to 23 and its minutes to 59");
    }
    let seconds = 60 * (60 * hours + minutes);
    Ok(if sign == "-" { -seconds } else { seconds })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn date(text: &str) -> Date {
        text.parse().unwrap()
    }

    fn since_1970(text: &str) -> f64 {
        let date = date(text);
        let begin = if date.scale().is_some() { "1970-01-01 UTC" } else { "1970-01-01" };
        date.seconds_since(&begin.parse().unwrap()).unwrap()
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
            "2025-11-22T12:20:30.125+02",
        ] {
            // leap seconds from 1972 on, with the first 10
            let leaps = if date(text).scale().is_some() { 27.0 } else { 0.0 };
            assert_eq!(since_1970(text), 1_763_806_830.125 + leaps, "{text}");
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
            ("2016-12-31T23:59:60", "leap second"),
            ("2016-12-31T23:59:60 TT", "leap second"),
            ("2016-12-30T23:59:60Z", "leap second"),
            ("2016-12-31T22:59:60Z", "leap second"),
            ("2016-12-31T23:59:61Z", "leap second"),
            ("2016-12-31T23:59:59 GMT", "time scale"),
            ("2016-12-31T23:59:59Z TDB", "Z and offsets"),
            ("2025-04-01T10:00+1:2:3x", "offset is written"),
            ("2025-04-01T10:00+1:2", "offset is written"),
            ("2025-04-01T10:00+1:02", "offset is written"),
            ("2025-04-01T10:00+01:2", "offset is written"),
            ("2025-04-01T10:00+1", "offset is written"),
            ("2025-04-01T10:00-530", "offset is written"),
            ("2025-04-01T10:00+01:0:0", "offset is written"),
            ("2025-04-01T10:00+0é0", "offset is written"),
            ("2025-04-01T10:00+99:99", "hours of an offset"),
            ("2025-04-01T10:00-24", "hours of an offset"),
            ("2025-04-01T10:00+0160", "hours of an offset"),
            ("yesterday", "the day is missing"),
            ("1-2-3-4", "the day is missing"),
            ("1e300", "no such Julian date"),
        ] {
            let error = text.parse::<Date>().unwrap_err().to_string();
            assert!(
                error.starts_with(&format!("'{text}' is not a date: ")) && error.contains(rule),
                "{error}"
            );
        }
    }

    #[test]
    fn scales_differ_as_the_almanacs_say() {
        let apart = |a: &str, b: &str| date(a).seconds_since(&date(b)).unwrap();
        // Explanatory Supplement: TT − UTC at the beginning of 1972 and 2017
        for (utc, expected) in [("1972-01-01", 42.184), ("2016-12-31", 68.184), ("2017-01-01", 69.184)] {
            assert!((apart(&format!("{utc} UTC"), &format!("{utc} TT")) - expected).abs() < 1e-9, "{utc}");
        }
        assert_eq!(apart("2017-01-01 UTC", "2016-12-31 UTC"), 86_401.0);
        assert_eq!(apart("2016-12-31T23:59:60Z", "2016-12-31T23:59:59Z"), 1.0);
        assert_eq!(apart("2017-01-01T01:59:60.5+02:00", "2017-01-01 UTC"), -0.5);
        assert_eq!(apart("2457754.5 UTC", "2017-01-01T00:00Z"), 0.0);
        // a quarter of a year after the perihelion of the Earth, and three
        for (day, expected) in [("2012-04-04", 1.658e-3), ("2012-10-05", -1.658e-3)] {
            let swing = apart(&format!("{day} TT"), &format!("{day} TDB"));
            assert!((swing - expected).abs() < 1e-5, "{day}: {swing}");
        }
        for scale in TimeScale::ALL {
            let text = format!("2456284.676388 {}", scale.name());
            assert_eq!(date(&text).julian(), 2_456_284.676_388, "{text}");
            assert_eq!(date("2456284.676388").or_in(scale), date(&text), "{text}");
        }
    }

    #[test]
    fn dates_that_could_be_a_minute_off_are_not_compared() {
        let differ = |a: &str, b: &str| date(a).seconds_since(&date(b)).map_err(|error| error.to_string());
        assert!(differ("2451545", "2451545 TDB").unwrap_err().contains("write UTC, TAI, TT or TDB"));
        assert!(differ("1971-12-31 UTC", "2451545 TT").unwrap_err().contains("before 1972"));
        assert_eq!(differ("1971-12-31 UTC", "1971-12-30 UTC"), Ok(86_400.0));
    }
}

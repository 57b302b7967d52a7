//! Time scales: UTC with its leap seconds, TAI, TT and TDB.

use super::date::{DAY, days_since_1970, julian_of_day};
use crate::num::{Dd, Precise, Real};

/// What a date counts in.
///
/// Sources: International Earth Rotation and Reference Systems Service, Bulletin C (leap seconds); P. K. Seidelmann (ed.),
/// Explanatory Supplement to the Astronomical Almanac (1992), §2.2 (TT = TAI + 32.184 s, TDB − TT).
#[non_exhaustive]
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum TimeScale {
    /// Civil time, with leap seconds; those from 2017 on are the last that are known, and none is taken to follow.
    Utc,
    /// International atomic time.
    Tai,
    /// Terrestrial time, 32.184 s ahead of TAI.
    Tt,
    /// Barycentric dynamical time, which swings about TT by 1.7 ms with the year; taken to 50 us.
    Tdb,
}

/// Year and month on whose first day TAI − UTC became one second more, from 10 s in January 1972 on.
const LEAPS: [(i64, i64); 28] = [
    (1972, 1),
    (1972, 7),
    (1973, 1),
    (1974, 1),
    (1975, 1),
    (1976, 1),
    (1977, 1),
    (1978, 1),
    (1979, 1),
    (1980, 1),
    (1981, 7),
    (1982, 7),
    (1983, 7),
    (1985, 7),
    (1988, 1),
    (1990, 1),
    (1991, 1),
    (1992, 7),
    (1993, 7),
    (1994, 7),
    (1996, 1),
    (1997, 7),
    (1999, 1),
    (2006, 1),
    (2009, 1),
    (2012, 7),
    (2015, 7),
    (2017, 1),
];

/// TAI − UTC in s on the first of `LEAPS`.
const FIRST: f64 = 10.0;

/// TT − TAI, s.
const TERRESTRIAL: f64 = 32.184;

impl TimeScale {
    /// All of them.
    pub const ALL: [TimeScale; 4] = [TimeScale::Utc, TimeScale::Tai, TimeScale::Tt, TimeScale::Tdb];

    /// Its short name.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            TimeScale::Utc => "UTC",
            TimeScale::Tai => "TAI",
            TimeScale::Tt => "TT",
            TimeScale::Tdb => "TDB",
        }
    }

    /// The one of that name, in letters of either case.
    #[must_use]
    pub fn named(name: &str) -> Option<TimeScale> {
        TimeScale::ALL.into_iter().find(|scale| scale.name().eq_ignore_ascii_case(name))
    }

    /// From a Julian date in this scale to one of TAI.
    pub(super) fn to_tai(self, julian: Dd) -> Dd {
        match self {
            TimeScale::Utc => julian + days(leap_seconds(julian, 0.0)),
            TimeScale::Tai => julian,
            TimeScale::Tt => julian - days(TERRESTRIAL),
            TimeScale::Tdb => julian - days(TERRESTRIAL) - days(ahead_of_tt(julian)),
        }
    }

    /// From a Julian date of TAI to one in this scale.
    pub(super) fn of_tai(self, julian: Dd) -> Dd {
        match self {
            TimeScale::Utc => julian - days(leap_seconds(julian, 1.0)),
            TimeScale::Tai => julian,
            TimeScale::Tt => julian + days(TERRESTRIAL),
            // the swing changes by 3e-10 of the time by which both scales differ
            TimeScale::Tdb => julian + days(TERRESTRIAL) + days(ahead_of_tt(julian + days(TERRESTRIAL))),
        }
    }
}

/// Whether the day that begins so many days after 1970 is followed by a leap second.
pub(super) fn ends_in_a_leap_second(day: i64) -> bool {
    LEAPS[1..].iter().any(|&(year, month)| days_since_1970(year, month, 1) == day + 1)
}

/// Whether UTC has whole leap seconds at this Julian date: before 1972 it had another rate.
pub(super) fn has_leap_seconds(julian: Dd) -> bool {
    julian.hi() >= begin(LEAPS[0])
}

fn begin((year, month): (i64, i64)) -> f64 {
    julian_of_day(days_since_1970(year, month, 1))
}

/// TAI − UTC, s, at a Julian date that is one of UTC, or of TAI where `ahead` is 1; before 1972 as then.
fn leap_seconds(julian: Dd, ahead: f64) -> f64 {
    let mut counted = LEAPS.iter().enumerate().rev().map(|(k, first)| (FIRST + k as f64, begin(*first)));
    let has_begun = |(count, first): &(f64, f64)| (julian - Dd::of(*first)) * DAY >= Dd::of(ahead * count);
    counted.find(has_begun).map_or(FIRST, |(count, _)| count)
}

/// TDB − TT, s.
fn ahead_of_tt(julian: Dd) -> f64 {
    let (sin, cos) = Real::sin_cos((357.53 + 0.985_600_3 * (julian.to_f64() - 2_451_545.0)).to_radians());
    0.001_658 * sin + 0.000_014 * (2.0 * sin * cos)
}

fn days(seconds: f64) -> Dd {
    Dd::of(seconds) / Dd::of(DAY)
}

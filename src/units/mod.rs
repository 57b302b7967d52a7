//! Units of times and rates, by the names that files use, and dates.

mod date;

pub use date::{Date, DateError};

use crate::num::Shown;

/// Unit of a time column.
#[non_exhaustive]
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum TimeUnit {
    /// s
    Seconds,
    /// 1e-3 s
    Milliseconds,
    /// 1e-6 s
    Microseconds,
    /// 1e-9 s
    Nanoseconds,
    /// This many seconds, such as the time between two counts.
    Multiple(f64),
}

/// Unit of a column of rates.
#[non_exhaustive]
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum RateUnit {
    /// rad/s
    #[default]
    RadiansPerSecond,
    /// deg/s
    DegreesPerSecond,
    /// Revolutions per minute.
    RevolutionsPerMinute,
}

impl core::fmt::Display for TimeUnit {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        match self {
            Self::Seconds => f.write_str("s"),
            Self::Milliseconds => f.write_str("ms"),
            Self::Microseconds => f.write_str("us"),
            Self::Nanoseconds => f.write_str("ns"),
            Self::Multiple(seconds) => write!(f, "{} s", Shown(*seconds)),
        }
    }
}

impl core::fmt::Display for RateUnit {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        f.write_str(match self {
            Self::RadiansPerSecond => "rad/s",
            Self::DegreesPerSecond => "deg/s",
            Self::RevolutionsPerMinute => "rpm",
        })
    }
}

impl TimeUnit {
    /// The unit of that name: s, ms, us (µs), ns.
    pub fn named(name: &str) -> Option<Self> {
        match plain(name).as_str() {
            "s" | "sec" | "second" | "seconds" | "с" | "сек" => Some(Self::Seconds),
            "ms" | "msec" | "milliseconds" => Some(Self::Milliseconds),
            "us" | "µs" | "μs" | "microseconds" => Some(Self::Microseconds),
            "ns" | "nanoseconds" => Some(Self::Nanoseconds),
            _ => None,
        }
    }

    /// Its name in the plural.
    pub fn words(self) -> &'static str {
        match self {
            Self::Seconds => "seconds",
            Self::Milliseconds => "milliseconds",
            Self::Microseconds => "microseconds",
            Self::Nanoseconds => "nanoseconds",
            Self::Multiple(_) => "multiples of a time",
        }
    }

    /// In seconds, by a division where the factor is not a binary number.
    pub fn seconds(self, value: f64) -> f64 {
        match self {
            Self::Seconds => value,
            Self::Milliseconds => value / 1e3,
            Self::Microseconds => value / 1e6,
            Self::Nanoseconds => value / 1e9,
            Self::Multiple(seconds) => value * seconds,
        }
    }
}

impl RateUnit {
    /// The unit of that name: rad/s, deg/s (°/s, dps), rpm.
    pub fn named(name: &str) -> Option<Self> {
        match plain(name).as_str() {
            "rad/s" | "рад/с" | "rads" | "rad/sec" | "rads-1" | "rps" | "radians/s" => {
                Some(Self::RadiansPerSecond)
            }
            "deg/s" | "°/s" | "°/с" | "dps" | "degs" | "deg/sec" | "degrees/s" => {
                Some(Self::DegreesPerSecond)
            }
            "rpm" | "1/min" | "rev/min" => Some(Self::RevolutionsPerMinute),
            _ => None,
        }
    }

    /// Its name in the plural.
    pub fn words(self) -> &'static str {
        match self {
            Self::RadiansPerSecond => "radians per second",
            Self::DegreesPerSecond => "degrees per second",
            Self::RevolutionsPerMinute => "revolutions per minute",
        }
    }

    /// In rad/s.
    pub fn radians_per_second(self, value: f64) -> f64 {
        match self {
            Self::RadiansPerSecond => value,
            Self::DegreesPerSecond => value * (core::f64::consts::PI / 180.0),
            Self::RevolutionsPerMinute => value * (core::f64::consts::PI / 30.0),
        }
    }
}

/// Lower case without blanks.
fn plain(text: &str) -> String {
    text.trim().to_lowercase().split_whitespace().collect()
}

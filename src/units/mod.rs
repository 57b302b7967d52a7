//! Units of times, rates, angles, momenta and torques, by the names that files use, and dates.

mod date;
mod time_scale;

pub use date::{Date, DateError, ScaleError};
pub use time_scale::TimeScale;

use crate::num::Shown;

/// Unit of a time column.
///
/// ```
/// use polhode::units::TimeUnit;
/// assert_eq!(TimeUnit::named("ms").map(|unit| unit.seconds(250.0)), Some(0.25));
/// ```
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
    /// 60 s
    Minutes,
    /// 3600 s
    Hours,
    /// 86 400 s
    Days,
    /// This many seconds, such as the time between two counts.
    Multiple(f64),
}

/// Unit of an angular velocity.
///
/// ```
/// use polhode::units::RateUnit;
/// let rpm = RateUnit::named("rpm").ok_or("no unit")?;
/// assert!((rpm.radians_per_second(30.0) - core::f64::consts::PI).abs() < 1e-14);
/// # Ok::<(), &str>(())
/// ```
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

/// Unit of an angle.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum AngleUnit {
    /// Radians.
    Radians,
    /// Degrees.
    Degrees,
}

/// Unit of an angular momentum.
#[non_exhaustive]
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum MomentumUnit {
    /// N m s = kg m²/s
    NewtonMetreSeconds,
}

/// Unit of a torque.
#[non_exhaustive]
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum TorqueUnit {
    /// N m
    NewtonMetres,
}

impl core::fmt::Display for TimeUnit {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        match self {
            Self::Seconds => f.write_str("s"),
            Self::Milliseconds => f.write_str("ms"),
            Self::Microseconds => f.write_str("us"),
            Self::Nanoseconds => f.write_str("ns"),
            Self::Minutes => f.write_str("min"),
            Self::Hours => f.write_str("h"),
            Self::Days => f.write_str("d"),
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
    /// The unit of that name: s, ms, us (µs), ns, min, h, d.
    pub fn named(name: &str) -> Option<Self> {
        match plain(name).as_str() {
            "s" | "sec" | "second" | "seconds" | "с" | "сек" => Some(Self::Seconds),
            "ms" | "msec" | "milliseconds" => Some(Self::Milliseconds),
            "us" | "µs" | "μs" | "microseconds" => Some(Self::Microseconds),
            "ns" | "nanos" | "nanoseconds" => Some(Self::Nanoseconds),
            "min" | "minutes" => Some(Self::Minutes),
            "h" | "hr" | "hours" => Some(Self::Hours),
            "d" | "day" | "days" => Some(Self::Days),
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
            Self::Minutes => "minutes",
            Self::Hours => "hours",
            Self::Days => "days",
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
            Self::Minutes => value * 60.0,
            Self::Hours => value * 3600.0,
            Self::Days => value * 86_400.0,
            Self::Multiple(seconds) => value * seconds,
        }
    }
}

impl RateUnit {
    /// All three.
    pub const ALL: [RateUnit; 3] =
        [RateUnit::RadiansPerSecond, RateUnit::DegreesPerSecond, RateUnit::RevolutionsPerMinute];

    /// The unit of that name: rad/s, deg/s (°/s, dps), rpm.
    pub fn named(name: &str) -> Option<Self> {
        match plain(name).as_str() {
            "rad/s" | "рад/с" | "rads" | "rad/sec" | "rads-1" | "rads^-1" | "rad·s⁻¹" | "radians/s" => {
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

impl AngleUnit {
    /// The unit of that name: rad, deg (°).
    pub fn named(name: &str) -> Option<Self> {
        match plain(name).as_str() {
            "rad" | "radians" => Some(Self::Radians),
            "deg" | "°" | "degrees" => Some(Self::Degrees),
            _ => None,
        }
    }

    /// One of it, rad.
    #[must_use]
    pub fn radians(self) -> f64 {
        match self {
            Self::Radians => 1.0,
            Self::Degrees => core::f64::consts::PI / 180.0,
        }
    }
}

impl core::fmt::Display for AngleUnit {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        f.write_str(match self {
            Self::Radians => "rad",
            Self::Degrees => "deg",
        })
    }
}

impl MomentumUnit {
    /// The unit of that name: N m s, J s, kg m^2/s.
    pub fn named(name: &str) -> Option<Self> {
        matches!(product(name).as_str(), "Nms" | "Js" | "kgm^2/s" | "kgm²/s" | "kgm2/s")
            .then_some(Self::NewtonMetreSeconds)
    }
}

impl TorqueUnit {
    /// The unit of that name: N m.
    pub fn named(name: &str) -> Option<Self> {
        (product(name) == "Nm").then_some(Self::NewtonMetres)
    }
}

/// Without blanks and signs of multiplication; mN is not MN.
fn product(text: &str) -> String {
    text.chars().filter(|c| !" .*·".contains(*c)).collect()
}

/// Lower case without blanks.
fn plain(text: &str) -> String {
    text.trim().to_lowercase().split_whitespace().collect()
}

//! Products of common units of rate and time: all that a free body tells of its units.

use core::f64::consts::PI;
use core::fmt;

use polhode::units::RateUnit;

use crate::thresholds::units::{APART, SAME};

/// A pair of units in which a record may be: free motion tells their product alone.
///
/// `Display` names both, as "rates in deg/s read as rad/s, and times in ms read as s".
#[non_exhaustive]
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct UnitProduct {
    /// Unit in which the rates seem to be, and the one in which they were read.
    pub rates: [&'static str; 2],
    /// The same of the times.
    pub times: [&'static str; 2],
    /// Rate × time in these units over rate × time as read.
    pub factor: f64,
}

const DEGREE: f64 = PI / 180.0;

/// Units of rate, with their size in rad/s.
const RATES: [(&str, f64); 9] = [
    ("rad/s", 1.0),
    ("deg/s", DEGREE),
    ("rpm", PI / 30.0),
    ("rev/s", 2.0 * PI),
    ("mdeg/s", 1e-3 * DEGREE),
    ("counts of 1/16.4 deg/s", DEGREE / 16.4),
    ("counts of 1/32.8 deg/s", DEGREE / 32.8),
    ("counts of 1/65.5 deg/s", DEGREE / 65.5),
    ("counts of 1/131 deg/s", DEGREE / 131.0),
];

/// Units of time taken for others, with the factor.
const TIMES: [([&str; 2], f64); 8] = [
    (["s", "s"], 1.0),
    (["ms", "s"], 1e-3),
    (["us", "s"], 1e-6),
    (["ns", "s"], 1e-9),
    (["s", "ms"], 1e3),
    (["s", "us"], 1e6),
    (["s", "ns"], 1e9),
    (["ticks of 1/32768 s", "s"], 1.0 / 32768.0),
];

/// Units of rate taken for others, with the factor: of the unit that a record names, or where that is rad/s, which may be a
/// guess or the work of a program, of any that files name.
fn mistaken_rates(read: RateUnit) -> Vec<([&'static str; 2], f64)> {
    let taken = match read {
        RateUnit::DegreesPerSecond => 1..2,
        RateUnit::RevolutionsPerMinute => 2..3,
        _ => 0..3,
    };
    let of = |k: usize| {
        // of other programs only what files name
        let meant = if k > 0 && taken.len() > 1 { &RATES[..3] } else { &RATES[..] };
        let taken = RATES[k];
        meant.iter().map(move |(name, size)| ([*name, taken.0], size / taken.1)).collect::<Vec<_>>()
    };
    taken.clone().flat_map(of).collect()
}

impl UnitProduct {
    /// Common products in which a record may be that is read in `read` and s, but for factors near 1: one of each factor, that of
    /// the fewest mistakes.
    ///
    /// ```
    /// use polhode_fit::{RateUnit, UnitProduct};
    /// let products = UnitProduct::common(RateUnit::RadiansPerSecond);
    /// let degrees = products.iter().find(|product| product.to_string() == "rates in deg/s read as rad/s");
    /// assert_eq!(degrees.map(|product| product.factor), Some(1f64.to_radians()));
    /// ```
    #[must_use]
    pub fn common(read: RateUnit) -> Vec<UnitProduct> {
        let rates = mistaken_rates(read);
        let mut all: Vec<UnitProduct> = rates
            .iter()
            .flat_map(|&(rates, rate)| {
                TIMES.map(|(times, time)| UnitProduct { rates, times, factor: rate * time })
            })
            .collect();
        all.sort_by_key(UnitProduct::mistakes);
        let mut kept: Vec<UnitProduct> = Vec::new();
        for product in all {
            let is_new = |other: &UnitProduct| (product.factor / other.factor - 1.0).abs() > SAME;
            let is_apart = !(1.0 / APART..APART).contains(&product.factor);
            if is_apart && kept.iter().all(is_new) {
                kept.push(product);
            }
        }
        kept
    }

    /// Times that number the samples.
    pub(crate) fn numbered(factor: f64) -> UnitProduct {
        UnitProduct { rates: ["rad/s", "rad/s"], times: ["numbers of samples", "s"], factor }
    }

    fn mistakes(&self) -> usize {
        usize::from(self.rates[0] != self.rates[1]) + usize::from(self.times[0] != self.times[1])
    }
}

impl fmt::Display for UnitProduct {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { rates: [rate, rate_read], times: [time, time_read], .. } = self;
        match (rate != rate_read, time != time_read) {
            (true, true) => {
                write!(f, "rates in {rate} read as {rate_read}, and times in {time} read as {time_read}")
            }
            (false, true) => write!(f, "times in {time} read as {time_read}"),
            _ => write!(f, "rates in {rate} read as {rate_read}"),
        }
    }
}

/// Several in one sentence.
pub(crate) fn alternatives(products: &[UnitProduct]) -> String {
    products.iter().map(UnitProduct::to_string).collect::<Vec<_>>().join(", or ")
}

#[cfg(test)]
mod tests {
    use super::*;

    fn named(read: RateUnit, name: &str) -> Option<f64> {
        UnitProduct::common(read).iter().find(|product| product.to_string() == name).map(|p| p.factor)
    }

    /// Both mistakes are named, or the one that is made.
    #[test]
    fn products_name_their_mistakes() {
        let of = |rates, times| UnitProduct { rates, times, factor: 1.0 };
        let (rate, time) = (["rpm", "deg/s"], ["ms", "s"]);
        let both = of(rate, time);
        assert_eq!(both.to_string(), "rates in rpm read as deg/s, and times in ms read as s");
        assert_eq!(of(["rpm", "rpm"], time).to_string(), "times in ms read as s");
        assert_eq!(of(rate, ["s", "s"]).to_string(), "rates in rpm read as deg/s");
        assert_eq!((both.mistakes(), of(rate, ["s", "s"]).mistakes()), (2, 1));
        assert_eq!((of(["a", "a"], time).mistakes(), of(["a", "a"], ["s", "s"]).mistakes()), (1, 0));
        let numbered = UnitProduct::numbered(0.01);
        assert!(numbered.factor == 0.01 && numbered.mistakes() == 1);
        assert_eq!(
            alternatives(&[numbered, of(rate, ["s", "s"])]),
            "times in numbers of samples read as s, or rates in rpm read as deg/s"
        );
    }

    /// Each factor is there once, by the fewest mistakes, and none is next to 1.
    #[test]
    fn common_products_differ_in_their_factors() {
        for read in [RateUnit::RadiansPerSecond, RateUnit::DegreesPerSecond, RateUnit::RevolutionsPerMinute] {
            let products = UnitProduct::common(read);
            for (k, product) in products.iter().enumerate() {
                assert!(!(0.5..2.0).contains(&product.factor), "{product}");
                let mut others = products[..k].iter();
                assert!(others.all(|other| (product.factor / other.factor - 1.0).abs() > 1e-3), "{product}");
                assert!(k == 0 || products[k - 1].mistakes() <= product.mistakes(), "{product}");
            }
        }
        // as millidegrees, which is one mistake, and not as degrees in ms
        let of = |name: &str| named(RateUnit::RadiansPerSecond, name);
        let one = of("rates in mdeg/s read as rad/s").unwrap();
        assert!((one * 1e3 / DEGREE - 1.0).abs() < 1e-12);
        assert_eq!(of("rates in deg/s read as rad/s, and times in ms read as s"), None);
    }

    /// The factor is rate × time as it seems to be over what was read: of a unit that is named only against others, of rad/s, which may be
    /// a guess, also in the place of a unit that files name.
    #[test]
    fn factors_are_ratios_of_units() {
        let (radians, degrees, rpm) =
            (RateUnit::RadiansPerSecond, RateUnit::DegreesPerSecond, RateUnit::RevolutionsPerMinute);
        for (read, name, factor) in [
            (radians, "rates in rpm read as rad/s", PI / 30.0),
            (radians, "rates in rev/s read as rad/s", 2.0 * PI),
            (radians, "rates in rad/s read as deg/s", 180.0 / PI),
            (radians, "times in s read as ms", 1e3),
            (radians, "times in us read as s", 1e-6),
            (radians, "times in ticks of 1/32768 s read as s", 1.0 / 32768.0),
            (radians, "rates in counts of 1/131 deg/s read as rad/s", PI / 180.0 / 131.0),
            (degrees, "rates in rev/s read as deg/s", 360.0),
            (degrees, "rates in rpm read as deg/s", 6.0),
            (degrees, "rates in counts of 1/65.5 deg/s read as deg/s", 1.0 / 65.5),
            (rpm, "rates in deg/s read as rpm", 1.0 / 6.0),
            (rpm, "rates in rev/s read as rpm", 60.0),
        ] {
            let found = named(read, name).unwrap_or(f64::NAN);
            assert!((found / factor - 1.0).abs() < 1e-12, "{name}: {found}");
        }
        assert_eq!(named(radians, "rates in rev/s read as deg/s"), None);
        for (read, unit) in [(degrees, "deg/s"), (rpm, "rpm")] {
            assert!(UnitProduct::common(read).iter().all(|product| product.rates[1] == unit));
        }
    }
}

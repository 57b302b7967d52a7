//! How a number stands in a message.

use core::fmt;

/// A number with all its digits: written out where that is short, with a power of ten elsewhere.
#[derive(Clone, Copy, Debug)]
pub struct Shown(pub f64);

impl fmt::Display for Shown {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let short = self.0 == 0.0 || !self.0.is_finite() || (1e-5..1e15).contains(&self.0.abs());
        if short { write!(f, "{}", self.0) } else { write!(f, "{:e}", self.0) }
    }
}

/// A number that was computed, without the noise of its last digits: 0.3 of 0.30000000000000004.
#[derive(Clone, Copy, Debug)]
pub struct Computed(pub f64);

impl fmt::Display for Computed {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let near = format!("{:.14e}", self.0).parse().unwrap_or(self.0);
        let [exact, near] = [Shown(self.0 + 0.0), Shown(near)].map(|x| x.to_string());
        f.write_str(if near.len() + 2 < exact.len() { &near } else { &exact })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_keep_their_digits_and_are_short() {
        for (x, expected) in [(5e-324, "5e-324"), (1e300, "1e300"), (0.25, "0.25"), (3.0, "3"), (-0.0, "-0")]
        {
            assert_eq!(Shown(x).to_string(), expected);
        }
    }

    #[test]
    fn computed_numbers_lose_their_noise_and_no_digit_else() {
        for (x, expected) in [
            (0.1 + 0.2, "0.3"),
            (1.009_000_000_000_000_1, "1.009"),
            (1.0 / 3.0, "0.3333333333333333"),
            (-0.0, "0"),
            (2.000_000_000_000_000_3e-6, "2e-6"),
            (f64::INFINITY, "inf"),
        ] {
            assert_eq!(Computed(x).to_string(), expected);
        }
    }
}

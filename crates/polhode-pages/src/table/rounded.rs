//! A number rounded to significant digits, in the shorter of its two spellings.

/// ± `mantissa` × 10^`exponent`; without an exponent the mantissa is the whole number.
#[derive(Debug, PartialEq)]
pub(super) struct Rounded {
    pub(super) mantissa: String,
    pub(super) exponent: Option<i32>,
}

/// `x`, finite, to `digits` significant digits, as tables print it.
///
/// ```
/// assert_eq!(polhode_pages::table::to_digits(1.0 / 3000.0, 2), "3.3e-4");
/// ```
#[must_use]
pub fn to_digits(x: f64, digits: usize) -> String {
    rounded(x, digits).plain()
}

/// `x`, finite, to `digits` significant digits; zeros at the end are dropped where no more than the rounding of a sum or product
/// was cut off.
pub(super) fn rounded(x: f64, digits: usize) -> Rounded {
    let decimals = digits.saturating_sub(1);
    let text = format!("{x:.decimals$e}");
    let (mantissa, exponent) = text.split_once('e').unwrap_or((&text, "0"));
    let exponent: i32 = exponent.parse().unwrap_or(0);
    let short: f64 = text.parse().unwrap_or(x);
    let is_exact = (short - x).abs() <= 4.0 * f64::EPSILON * x.abs();
    if x != 0.0 && !(-3..6).contains(&exponent) {
        let mantissa = if is_exact { trimmed(mantissa) } else { mantissa.to_string() };
        return Rounded { mantissa, exponent: Some(exponent) };
    }
    // Rounded first and printed then, or 99999.9 to three digits would keep five nines.
    let decimals = usize::try_from(decimals as i32 - exponent).unwrap_or(0);
    let value = format!("{short:.decimals$}");
    Rounded { mantissa: if is_exact { trimmed(&value) } else { value }, exponent: None }
}

fn trimmed(decimal: &str) -> String {
    if decimal.contains('.') {
        decimal.trim_end_matches('0').trim_end_matches('.').to_string()
    } else {
        decimal.to_string()
    }
}

impl Rounded {
    /// 4.3e-10
    pub(super) fn plain(&self) -> String {
        match self.exponent {
            Some(exponent) => format!("{}e{exponent}", self.mantissa),
            None => self.mantissa.clone(),
        }
    }

    /// $4.3\times10^{-10}$
    pub(super) fn latex(&self) -> String {
        match self.exponent {
            Some(exponent) if self.mantissa == "1" => format!("$10^{{{exponent}}}$"),
            Some(exponent) => format!(r"${}\times10^{{{exponent}}}$", self.mantissa),
            None => format!("${}$", self.mantissa),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rounds_and_chooses_the_spelling() {
        let cases = [
            (4.3123e-10, 2, "4.3e-10"),
            (0.01, 3, "0.01"),
            (1.0 / 3.0, 3, "0.333"),
            (9.996, 3, "10.0"),
            (10.0, 3, "10"),
            (0.1 + 0.2, 3, "0.3"),
            (99_999.9, 3, "100000"),
            (999_999.9, 3, "1.00e6"),
            (2.0004e-4, 2, "2.0e-4"),
            (2e-4, 2, "2e-4"),
            (-12_345.0, 3, "-12300"),
            (0.000_999_96, 4, "0.001000"),
            (0.0, 3, "0"),
            (1e-47, 3, "1e-47"),
            (-2.5e33, 1, "-2e33"), // half to even, as the decimal expansion is exact
        ];
        for (x, digits, expected) in cases {
            assert_eq!(rounded(x, digits).plain(), expected, "{x} to {digits}");
        }
    }

    #[test]
    fn latex_writes_powers_of_ten() {
        assert_eq!(rounded(4.3e-10, 3).latex(), r"$4.3\times10^{-10}$");
        assert_eq!(rounded(1e9, 3).latex(), "$10^{9}$");
        assert_eq!(rounded(-0.5, 3).latex(), "$-0.5$");
    }
}

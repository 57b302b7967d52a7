//! Double-double numbers as decimal text, both ways correctly rounded.
//!
//! A binary number has a finite decimal expansion, and the standard library prints it in full for an `f64`.
//! The two parts are therefore added in decimal, digit by digit.

use core::fmt;
use core::str::FromStr;

use super::Dd;

/// Significant digits printed unless a precision asks for others.
const DIGITS: i32 = 32;

/// An integer of decimal digits, most significant first, divided by ten to the power of `decimals`.
struct Decimal {
    digits: Vec<i32>,
    decimals: i32,
}

impl Decimal {
    /// |x|, exactly.
    fn of(x: f64) -> Decimal {
        let exponent = ((x.to_bits() >> 52) & 0x7ff).max(1) as i32 - 1075;
        let decimals = usize::try_from(-exponent).unwrap_or(0);
        Decimal::read(&format!("{:.decimals$}", x.abs()), 0)
    }

    /// The digits of a text times ten to the power of `exponent`.
    fn read(text: &str, exponent: i32) -> Decimal {
        let fraction = text.find('.').map_or(0, |point| text.len() - 1 - point);
        let digits = text.bytes().filter(u8::is_ascii_digit).map(|digit| i32::from(digit - b'0'));
        let mut value = Decimal { digits: digits.collect(), decimals: fraction as i32 - exponent };
        value.extend(0);
        value
    }

    /// Appends zeros until there are at least `decimals` decimals.
    fn extend(&mut self, decimals: i32) {
        let zeros = (decimals - self.decimals).max(0);
        self.digits.resize(self.digits.len() + zeros as usize, 0);
        self.decimals += zeros;
    }

    /// `self + sign · other` as its size and whether it is negative.
    fn plus(mut self, sign: i32, mut other: Decimal) -> (Decimal, bool) {
        self.extend(other.decimals);
        other.extend(self.decimals);
        let missing = other.digits.len().saturating_sub(self.digits.len());
        self.digits.splice(0..0, core::iter::repeat_n(0, missing + 1));
        for (digit, term) in self.digits.iter_mut().rev().zip(other.digits.iter().rev()) {
            *digit += sign * term;
        }
        let negative = self.digits.iter().find(|&&digit| digit != 0).is_some_and(|&digit| digit < 0);
        if negative {
            self.digits.iter_mut().for_each(|digit| *digit = -*digit);
        }
        self.carry();
        (self, negative)
    }

    /// Brings every digit but the first into 0..10.
    fn carry(&mut self) {
        for k in (1..self.digits.len()).rev() {
            self.digits[k - 1] += self.digits[k].div_euclid(10);
            self.digits[k] = self.digits[k].rem_euclid(10);
        }
    }

    /// Power of ten of the first digit that is not zero.
    fn exponent(&self) -> i32 {
        let zeros = self.digits.iter().take_while(|&&digit| digit == 0).count();
        (self.digits.len() - zeros) as i32 - 1 - self.decimals
    }

    /// Rounds to `decimals` decimals, ties upwards; a negative number of them rounds to tens and above.
    fn rounded(mut self, decimals: i32) -> Decimal {
        let dropped = (self.decimals - decimals).max(0) as usize;
        let missing = (dropped + 1).saturating_sub(self.digits.len());
        self.digits.splice(0..0, core::iter::repeat_n(0, missing + 1));
        let kept = self.digits.len() - dropped;
        let up = self.digits.get(kept).is_some_and(|&digit| digit >= 5);
        self.digits.truncate(kept);
        self.decimals -= dropped as i32;
        self.digits[kept - 1] += i32::from(up);
        self.carry();
        self.extend(decimals.max(0));
        self
    }

    /// Digits with a point, `decimals` of them after it.
    fn positional(&self) -> String {
        let text: String = self.digits.iter().map(|digit| char::from(b'0' + *digit as u8)).collect();
        let (whole, fraction) = text.split_at(text.len() - self.decimals as usize);
        let whole = whole.trim_start_matches('0');
        let whole = if whole.is_empty() { "0" } else { whole };
        if fraction.is_empty() { whole.to_owned() } else { format!("{whole}.{fraction}") }
    }
}

fn decimal(x: Dd) -> Decimal {
    let sign = if (x.lo < 0.0) == (x.hi < 0.0) { 1 } else { -1 };
    Decimal::of(x.hi).plus(sign, Decimal::of(x.lo)).0
}

/// Precision counts decimals. Without one, 32 significant digits without trailing zeros, in exponent form below
/// 10⁻⁵ and from 10³² on.
impl fmt::Display for Dd {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if self.hi == 0.0 || !self.hi.is_finite() {
            return fmt::Display::fmt(&self.hi, f);
        }
        let value = decimal(*self);
        let exponent = value.exponent();
        let text = match f.precision() {
            Some(decimals) => value.rounded(decimals as i32).positional(),
            None if (-5..DIGITS).contains(&exponent) => {
                let text = value.rounded(DIGITS - 1 - exponent).positional();
                let trimmed = text.trim_end_matches('0').trim_end_matches('.');
                if text.contains('.') { trimmed.to_owned() } else { text }
            }
            None => return fmt::LowerExp::fmt(self, f),
        };
        f.pad_integral(self.hi > 0.0, "", &text)
    }
}

/// Precision counts digits after the point, 31 unless given.
impl fmt::LowerExp for Dd {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if self.hi == 0.0 || !self.hi.is_finite() {
            return fmt::LowerExp::fmt(&self.hi, f);
        }
        let digits = f.precision().map_or(DIGITS - 1, |precision| precision as i32);
        let value = decimal(*self);
        let first = value.exponent();
        let mut value = value.rounded(digits - first);
        let exponent = value.exponent();
        value.decimals += exponent;
        f.pad_integral(self.hi > 0.0, "", &format!("{}e{exponent}", value.rounded(digits).positional()))
    }
}

/// A text that is not a decimal number.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("`{0}` is not a decimal number such as -1.25e-3")]
pub struct ParseDdError(String);

/// Reads what `f64` reads, and rounds it to the nearest double-double number.
impl FromStr for Dd {
    type Err = ParseDdError;
    fn from_str(text: &str) -> Result<Dd, ParseDdError> {
        let hi: f64 = text.parse().map_err(|_| ParseDdError(text.to_owned()))?;
        if hi == 0.0 || !hi.is_finite() {
            return Ok(Dd::exact(hi));
        }
        let (mantissa, exponent) = text.split_once(['e', 'E']).unwrap_or((text, "0"));
        let exponent = exponent.parse().map_err(|_| ParseDdError(text.to_owned()))?;
        let (rest, negative) = Decimal::read(mantissa, exponent).plus(-1, Decimal::of(hi));
        let digits: String = rest.digits.iter().map(|digit| char::from(b'0' + *digit as u8)).collect();
        let size: f64 =
            format!("{digits}e-{}", rest.decimals).parse().map_err(|_| ParseDdError(text.to_owned()))?;
        Ok(Dd::sum(hi, if negative == (hi < 0.0) { size } else { -size }))
    }
}

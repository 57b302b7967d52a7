//! How a number stands in a message.

use core::fmt;

/// A number with all its digits: written out where that is short, with a power of ten elsewhere.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Shown(pub(crate) f64);

impl fmt::Display for Shown {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let short = self.0 == 0.0 || !self.0.is_finite() || (1e-5..1e15).contains(&self.0.abs());
        if short { write!(f, "{}", self.0) } else { write!(f, "{:e}", self.0) }
    }
}

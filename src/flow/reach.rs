//! How far in time a motion can be followed.

use thiserror::Error;

/// Why there is no state at a time.
#[derive(Clone, Copy, Debug, PartialEq, Error)]
#[non_exhaustive]
pub enum TimeError {
    /// The time is not a number.
    #[error("time {t} s is not a finite number")]
    NotFinite {
        /// The time, s.
        t: f64,
    },
    /// The phase has lost its digits.
    #[error(
        "after {t:e} s the phase has too few digits left: it is known to 106 bits, and the body has turned by more than 2^96 \
         rad; the latest time with an answer is {reach:e} s"
    )]
    OutOfReach {
        /// The time, s.
        t: f64,
        /// The largest time that has an answer, s.
        reach: f64,
    },
}

/// Of the 106 bits of a phase in rad, ten are to be left after the whole turns.
pub(super) const MOST_RADIANS: f64 = 79_228_162_514_264_337_593_543_950_336.0; // 2⁹⁶

impl TimeError {
    /// Whether `t` is a time within `reach`, s.
    pub(super) fn check(t: f64, reach: f64) -> Result<(), TimeError> {
        if !t.is_finite() {
            Err(TimeError::NotFinite { t })
        } else if t.abs() > reach {
            Err(TimeError::OutOfReach { t, reach })
        } else {
            Ok(())
        }
    }
}

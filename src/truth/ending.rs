//! What becomes of a run.

use core::fmt;

use crate::num::Shown;
use crate::run::RunError;

/// An attitude that is further off than this, rad, is lost: what follows is no error but chance.
pub const LOST: f64 = 1.0;

/// What becomes of a run; times in s.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub enum Ending {
    /// It comes to its end, its attitude within [`LOST`] of the true one.
    Held,
    /// The attitude is first seen further off than [`LOST`] at this time.
    Lost(f64),
    /// After this time the numbers are no longer finite, or no longer those of a rotation.
    Diverged(f64),
    /// After this time an implicit step could not be solved.
    Unsolved(f64),
    /// After this time no step that the method can choose is within its tolerance.
    Stuck(f64),
}

impl Ending {
    /// Of a run in steps of `step` s that failed with `error`, with the time since its start; `None` where the error is no end of a
    /// run: a force that is not finite, or a step or a start that is not usable.
    #[must_use]
    pub fn of(error: &RunError, step: f64) -> Option<Self> {
        let elapsed = error.last().map_or(0.0, |last| last.elapsed.hi());
        match error {
            RunError::Diverged { .. } => Some(Ending::Diverged(elapsed)),
            RunError::OutOfRange { steps, .. } => Some(Ending::Diverged(step * *steps as f64)),
            RunError::Unsolved { .. } => Some(Ending::Unsolved(elapsed)),
            RunError::Stuck { .. } => Some(Ending::Stuck(elapsed)),
            _ => None,
        }
    }

    /// When, s; `None` of a run that was held.
    #[must_use]
    pub fn time(self) -> Option<f64> {
        match self {
            Ending::Held => None,
            Ending::Lost(t) | Ending::Diverged(t) | Ending::Unsolved(t) | Ending::Stuck(t) => Some(t),
        }
    }

    /// In a word or two: `ok`, `lost`, `diverged`, `unsolved`, `no step`.
    #[must_use]
    pub fn word(self) -> &'static str {
        match self {
            Ending::Held => "ok",
            Ending::Lost(_) => "lost",
            Ending::Diverged(_) => "diverged",
            Ending::Unsolved(_) => "unsolved",
            Ending::Stuck(_) => "no step",
        }
    }

    /// By a clock that showed `start_time` s at the start.
    #[must_use]
    pub fn by_clock(mut self, start_time: f64) -> Self {
        match &mut self {
            Ending::Held => {}
            Ending::Lost(t) | Ending::Diverged(t) | Ending::Unsolved(t) | Ending::Stuck(t) => {
                *t += start_time
            }
        }
        self
    }
}

/// As `ok` or `lost at t = 12.5`, the time to four digits.
impl fmt::Display for Ending {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.word())?;
        self.time().map_or(Ok(()), |t| {
            let four = format!("{t:.3e}").parse().unwrap_or(t);
            write!(f, " at t = {}", Shown(four))
        })
    }
}

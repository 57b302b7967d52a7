//! A run followed to its end, wherever that is.

use polhode::run::{Run, RunError, Sample, Schedule};

use crate::error::{Error, unexpected};

/// Looks at the energy for its secular slope.
const LOOKS: u64 = 512;

/// What was seen of a run.
pub(super) struct Followed {
    /// The last finite sample.
    pub(super) last: Sample,
    /// `ok`, `diverged` or `unsolved`.
    pub(super) status: &'static str,
    /// Times of the looks, s.
    pub(super) times: Vec<f64>,
    /// Relative changes of the energy at these times.
    pub(super) energy_changes: Vec<f64>,
}

/// Follows `run` for `steps` steps or until it fails.
pub(super) fn follow(run: &mut Run, steps: u64) -> Result<Followed, Error> {
    let mut seen =
        Followed { last: run.sample(), status: "ok", times: Vec::new(), energy_changes: Vec::new() };
    for sample in run.samples(Schedule::every((steps / LOOKS).max(1), steps)).skip(1) {
        (seen.last, seen.status) = match sample {
            Ok(sample) => (sample, "ok"),
            Err(RunError::Diverged { last }) => (*last, "diverged"),
            Err(RunError::Unsolved { last, .. }) => (*last, "unsolved"),
            Err(error) => return Err(unexpected(error)),
        };
        seen.times.push(seen.last.elapsed.hi());
        seen.energy_changes.push(seen.last.energy_change);
    }
    Ok(seen)
}

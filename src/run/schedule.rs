//! The steps at which a run is sampled.

use thiserror::Error;

use crate::body::Clock;
use crate::num::{Dd, Precise, Shown};

/// Ascending numbers of steps. [`every`](Self::every) and [`logarithmic`](Self::logarithmic) begin at step 0, the start;
/// [`at`](Self::at) and [`at_times`](Self::at_times) hold only what is given.
#[derive(Clone, Debug, PartialEq, Eq)]
#[must_use]
pub struct Schedule {
    /// Multiples of an interval, below the end.
    interval: u64,
    /// How far they go.
    end: u64,
    /// What comes after them.
    rest: Vec<u64>,
}

/// Where a time lies among the steps of a clock.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Place {
    /// After so many whole steps, to within four units in the last place of the largest of |t|, |start| and the step.
    At(u64),
    /// By `later` s behind so many steps; the nearest time that steps reach is `nearest`.
    Behind { steps: u64, later: Dd, nearest: f64 },
}

impl Place {
    /// Of the time `t`, s, from the start of `clock` on, in the direction of its steps.
    pub(super) fn of(clock: Clock, t: f64) -> Result<Self, ScheduleError> {
        let Clock { start, step } = clock;
        let steps = ((t - start) / step).round();
        if !t.is_finite() {
            return Err(ScheduleError::NotFinite { t });
        }
        if steps.is_nan() || steps >= 9_007_199_254_740_992.0 {
            return Err(ScheduleError::TooMany { t, step: step.abs(), steps });
        }
        if steps < 0.0 {
            return Err(ScheduleError::NotAscending { t, before: start });
        }
        let nearest = (Dd::from(start) + Dd::product(steps, step)).to_f64();
        let largest = t.abs().max(start.abs()).max(step.abs());
        if (nearest - t).abs() <= 4.0 * (largest.next_up() - largest) {
            return Ok(Place::At(steps as u64));
        }
        let elapsed = Dd::from(t) - Dd::from(start);
        let behind = |steps: u64| elapsed - clock.elapsed(steps);
        let rounded = steps as u64;
        let before = if behind(rounded).hi() * step < 0.0 { rounded.checked_sub(1) } else { Some(rounded) };
        match before {
            Some(steps) => Ok(Place::Behind { steps, later: behind(steps), nearest }),
            None => Err(ScheduleError::NotAscending { t, before: start }),
        }
    }

    /// The whole steps, and how long after the last of them, s.
    pub(super) fn parts(self) -> (u64, Dd) {
        match self {
            Place::At(steps) => (steps, Dd::ZERO),
            Place::Behind { steps, later, .. } => (steps, later),
        }
    }
}

/// Why times cannot be reached by steps.
#[derive(Clone, Copy, Debug, PartialEq, Error)]
#[non_exhaustive]
pub enum ScheduleError {
    /// The step is not positive.
    #[error("step {} s: it must be positive for ascending times", Shown(*step))]
    NotAStep {
        /// The step, s.
        step: f64,
    },
    /// The time is not a number.
    #[error("time {t} s is not a finite number")]
    NotFinite {
        /// The time, s.
        t: f64,
    },
    /// A time lies before the one that precedes it, or before the start.
    #[error(
        "no steps lead from {} s to {} s; times must follow each other in the direction of the steps, from the start on",
        Shown(*before), Shown(*t)
    )]
    NotAscending {
        /// The time, s.
        t: f64,
        /// The time before it, s.
        before: f64,
    },
    /// More steps than can be counted exactly.
    #[error(
        "{steps:e} steps of {} s lead to t = {} s, and at most 2^53 can be counted; use a larger step", Shown(*step), Shown(*t)
    )]
    TooMany {
        /// The time, s.
        t: f64,
        /// The step, s.
        step: f64,
        /// How many there would be.
        steps: f64,
    },
    /// No whole number of steps leads there.
    #[error(
        "steps of {} s do not reach t = {} s; the nearest time that they reach is {} s", Shown(*step), Shown(*t), Shown(*nearest)
    )]
    NotReached {
        /// The time, s.
        t: f64,
        /// The step, s.
        step: f64,
        /// The nearest time, s.
        nearest: f64,
    },
}

impl Schedule {
    /// The start, every `interval` steps (at least 1) up to `total`, and `total`.
    ///
    /// ```
    /// use polhode::run::Schedule;
    /// let steps: Vec<u64> = Schedule::every(400, 1000).into_iter().collect();
    /// assert_eq!(steps, [0, 400, 800, 1000]);
    /// ```
    pub fn every(interval: u64, total: u64) -> Self {
        Schedule { interval: interval.max(1), end: total, rest: vec![total] }
    }

    /// The start, `per_decade` points (at most 1000) in each decade of steps from 1 to `total`, and `total` itself.
    ///
    /// ```
    /// use polhode::run::Schedule;
    /// let steps: Vec<u64> = Schedule::logarithmic(1000, 3).into_iter().collect();
    /// assert_eq!(steps, [0, 1, 2, 5, 10, 22, 46, 100, 215, 464, 1000]);
    /// ```
    pub fn logarithmic(total: u64, per_decade: u32) -> Self {
        let mut steps = vec![0];
        for k in 0.. {
            let step = libm::round(libm::pow(10.0, f64::from(k) / f64::from(per_decade.clamp(1, 1000))));
            if step >= total as f64 {
                break;
            }
            if steps.last() != Some(&(step as u64)) {
                steps.push(step as u64);
            }
        }
        if steps.last() != Some(&total) {
            steps.push(total);
        }
        Schedule::at(steps)
    }

    /// At these numbers of steps, sorted.
    pub fn at(mut steps: Vec<u64>) -> Self {
        steps.sort_unstable();
        Schedule { interval: 1, end: 0, rest: steps }
    }

    /// At these times, s, ascending from the start of `clock` on. A whole number of steps has to lead to each, to within
    /// four units in the last place of the largest of |t|, |start| and the step.
    ///
    /// # Errors
    /// A step that is not positive, times that are not finite or not ascending, or that no whole number of steps reaches.
    ///
    /// ```
    /// use polhode::body::Clock;
    /// use polhode::run::Schedule;
    /// let clock = Clock { start: 10.0, step: 0.1 };
    /// let steps: Vec<u64> = Schedule::at_times(clock, &[10.0, 10.3, 20.0])?.into_iter().collect();
    /// assert_eq!(steps, [0, 3, 100]);
    /// assert!(Schedule::at_times(clock, &[10.25]).is_err());
    /// # Ok::<(), polhode::run::ScheduleError>(())
    /// ```
    pub fn at_times(clock: Clock, times: &[f64]) -> Result<Self, ScheduleError> {
        let Clock { start, step } = clock;
        if !(step.is_finite() && step > 0.0) {
            return Err(ScheduleError::NotAStep { step });
        }
        let mut counts = Vec::with_capacity(times.len());
        let mut before = start;
        for &t in times {
            if !t.is_finite() {
                return Err(ScheduleError::NotFinite { t });
            }
            if t < before {
                return Err(ScheduleError::NotAscending { t, before });
            }
            before = t;
            match Place::of(clock, t)? {
                Place::At(steps) => counts.push(steps),
                Place::Behind { nearest, .. } => return Err(ScheduleError::NotReached { t, step, nearest }),
            }
        }
        Ok(Schedule::at(counts))
    }
}

impl IntoIterator for Schedule {
    type Item = u64;
    type IntoIter = core::iter::Chain<Multiples, std::vec::IntoIter<u64>>;
    fn into_iter(self) -> Self::IntoIter {
        let multiples = Multiples { next: Some(0), interval: self.interval, end: self.end };
        multiples.chain(self.rest)
    }
}

/// The multiples of an interval below an end.
#[derive(Clone, Debug)]
pub struct Multiples {
    next: Option<u64>,
    interval: u64,
    end: u64,
}

impl Iterator for Multiples {
    type Item = u64;
    fn next(&mut self) -> Option<u64> {
        let now = self.next.filter(|&now| now < self.end)?;
        self.next = now.checked_add(self.interval);
        Some(now)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn times_that_no_steps_lead_to_are_refused_by_their_law() {
        let at =
            |step: f64, times: &[f64]| Schedule::at_times(Clock { start: 1.0, step }, times).unwrap_err();
        for step in [0.0, -0.5, f64::NAN, f64::INFINITY] {
            assert!(matches!(at(step, &[1.0]), ScheduleError::NotAStep { .. }), "{step}");
        }
        assert!(matches!(at(0.5, &[f64::NAN]), ScheduleError::NotFinite { .. }));
        assert!(matches!(at(0.5, &[0.5]), ScheduleError::NotAscending { before: 1.0, .. }));
        let backwards = at(0.5, &[-1.0]).to_string();
        assert!(backwards.starts_with("no steps lead from 1 s to -1 s; "), "{backwards}");
        assert!(matches!(at(0.5, &[2.0, 1.5]), ScheduleError::NotAscending { before: 2.0, .. }));
        assert_eq!(at(0.5, &[2.2]), ScheduleError::NotReached { t: 2.2, step: 0.5, nearest: 2.0 });
        assert!(matches!(at(1e-17, &[2.0]), ScheduleError::TooMany { .. }));
    }
}

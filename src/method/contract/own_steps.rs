//! A bound on the steps that an adaptive method takes within one step of a run.

/// An adaptive method takes at most this many steps of its own within one step of a run: a day or more of the fastest.
const MOST: f64 = 1e10;

/// So many of them show how many it would take. A first step that is too careful has grown long before.
const SEEN: u64 = 1 << 12;

/// Counts the steps that a method chooses within one step of a run.
#[derive(Clone, Copy, Debug, Default)]
pub(in crate::method) struct OwnSteps {
    taken: u64,
}

impl OwnSteps {
    /// One more is taken, and all so far have covered `done` s of the `whole` ones. How many the whole would take, where these
    /// are too many.
    pub(in crate::method) fn needed(&mut self, done: f64, whole: f64) -> Option<f64> {
        self.taken += 1;
        if self.taken < SEEN {
            return None;
        }
        let taken = self.taken as f64;
        let ratio = (whole / done).abs();
        let needed = if ratio < 1.0 { taken } else { taken * ratio };
        // with NaN or nothing done it never ends
        (needed.is_nan() || needed > MOST || taken >= MOST).then_some(needed)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_slow_beginning_is_forgiven_and_a_slow_advance_is_not() {
        let mut steps = OwnSteps::default();
        assert!((1..SEEN).all(|n| steps.needed(1e-300 * n as f64, 1.0).is_none()));
        assert_eq!(steps.needed(0.5, 1.0), None);
        let needed = steps.needed(1e-9, 1.0);
        assert!(needed.is_some_and(|needed| (needed / 4.1e12 - 1.0).abs() < 0.01), "{needed:?}");
        assert!(steps.needed(0.0, 1.0).is_some() && steps.needed(f64::NAN, 1.0).is_some());
    }
}

//! Readings that a log repeats, because it is written faster than its sensor reads (sample and hold).

/// Readings between the first and the last of a log, at least.
const READINGS: usize = 16;

/// The part of the readings that are repeated, at least.
const REPEATED: f64 = 0.2;

/// The part of the readings that last as many rows as the middle one, or a row more or less: a sensor reads evenly.
const EVEN: f64 = 0.9;

/// Steps of the rounding by which the middle one of the new readings differs from the one before, at least: slow rates that are
/// rounded stay equal for a while too, but change by one step.
const APART: f64 = 2.5;

/// Which of the `samples`, times and rates, repeat the reading before, where the sensor reads less often than the log is written.
pub(super) fn repeats(samples: &[[f64; 4]]) -> Vec<bool> {
    let none = vec![false; samples.len()];
    let repeats: Vec<bool> =
        (0..samples.len()).map(|i| i > 0 && samples[i][1..] == samples[i - 1][1..]).collect();
    // the first and the last reading may be cut off
    let begins: Vec<usize> = (1..samples.len()).filter(|i| !repeats[*i]).collect();
    if begins.len() <= READINGS {
        return none;
    }
    let lengths: Vec<usize> = begins.windows(2).map(|pair| pair[1] - pair[0]).collect();
    let part = |of: &dyn Fn(usize) -> bool| {
        lengths.iter().filter(|length| of(**length)).count() as f64 / lengths.len() as f64
    };
    let typical = middle(lengths.clone(), usize::cmp);
    if part(&|length| length > 1) < REPEATED || part(&|length| length.abs_diff(typical) <= 1) < EVEN {
        return none;
    }
    let change = |i: usize, k: usize| (samples[i][k] - samples[i - 1][k]).abs();
    let step = |k: usize| {
        let changes = begins.iter().map(|i| change(*i, k)).filter(|change| *change > 0.0);
        changes.fold(f64::INFINITY, f64::min)
    };
    let steps = [1, 2, 3].map(|k| (k, step(k)));
    let largest = |i: &usize| steps.iter().map(|(k, step)| change(*i, *k) / step).fold(0.0, f64::max);
    let apart = middle(begins.iter().map(largest).collect(), f64::total_cmp);
    if apart < APART { none } else { repeats }
}

/// The middle one of `values`, of which there is at least one.
fn middle<T: Copy>(mut values: Vec<T>, order: impl Fn(&T, &T) -> core::cmp::Ordering) -> T {
    let half = values.len() / 2;
    *values.select_nth_unstable_by(half, order).1
}

//! Readings that a log repeats, because it is written faster than its sensor reads (sample and hold), or because the sensor
//! stood still for a while.

/// Readings between the first and the last of a log, at least.
const READINGS: usize = 16;

/// The part of the readings that are repeated, at least.
const REPEATED: f64 = 0.2;

/// The part of the readings that last as many rows as the middle one, or a row more or less: a sensor reads evenly.
const EVEN: f64 = 0.9;

/// Steps of the rounding by which the middle one of the new readings differs from the one before, at least: slow rates that are
/// rounded stay equal for a while too, but change by one step.
const APART: f64 = 2.5;

/// Runs of equal readings that chance may bring to a whole log: fewer than this are expected.
const BY_CHANCE: f64 = 1e-3;

/// Which samples repeat the reading before.
#[derive(Debug, PartialEq)]
pub(super) struct Repeats {
    pub(super) samples: Vec<bool>,
    /// Whether all of the log is written faster than its sensor reads.
    pub(super) evenly: bool,
}

/// Which of the `samples`, lines with times and rates, repeat the reading before, where rounding does not explain it.
pub(super) fn repeats(samples: &[(usize, [f64; 4])]) -> Repeats {
    let none = || Repeats { samples: vec![false; samples.len()], evenly: false };
    let repeats: Vec<bool> =
        (0..samples.len()).map(|i| i > 0 && samples[i].1[1..] == samples[i - 1].1[1..]).collect();
    // the first and the last reading may be cut off
    let begins: Vec<usize> = (1..samples.len()).filter(|i| !repeats[*i]).collect();
    if begins.len() <= READINGS {
        return none();
    }
    let change = |i: usize, k: usize| (samples[i].1[k] - samples[i - 1].1[k]).abs();
    let step = |k: usize| {
        let changes = begins.iter().map(|i| change(*i, k)).filter(|change| *change > 0.0);
        changes.fold(f64::INFINITY, f64::min)
    };
    let steps = [1, 2, 3].map(|k| (k, step(k)));
    let lengths: Vec<usize> = begins.windows(2).map(|pair| pair[1] - pair[0]).collect();
    let part = |of: &dyn Fn(usize) -> bool| {
        lengths.iter().filter(|length| of(**length)).count() as f64 / lengths.len() as f64
    };
    let typical = middle(lengths.clone(), usize::cmp);
    if part(&|length| length > 1) >= REPEATED && part(&|length| length.abs_diff(typical) <= 1) >= EVEN {
        let largest = |i: &usize| steps.iter().map(|(k, step)| change(*i, *k) / step).fold(0.0, f64::max);
        let apart = middle(begins.iter().map(largest).collect(), f64::total_cmp);
        return if apart < APART { none() } else { Repeats { samples: repeats, evenly: true } };
    }
    // new readings differ by so many steps in the middle, and are equal by chance once in so many
    let apart =
        steps.map(|(k, step)| middle(begins.iter().map(|i| change(*i, k) / step).collect(), f64::total_cmp));
    let equal: f64 = apart.into_iter().filter(|apart| *apart > 1.0).map(f64::recip).product();
    let mut stale = none();
    let ends = [1, 2, 3].map(|k| {
        let column = || samples.iter().map(|(_, row)| row[k]);
        (k, column().fold(f64::INFINITY, f64::min), column().fold(f64::NEG_INFINITY, f64::max))
    });
    // at the end of its range a sensor repeats itself too
    let is_inside = |i: usize| {
        ends.iter().all(|(k, low, high)| *low < samples[i].1[*k] && samples[i].1[*k] < *high || low == high)
    };
    let stands_out = |i: usize| steps.iter().any(|(k, step)| change(i, *k) / step >= APART);
    for pair in begins.windows(2) {
        let (first, next) = (pair[0], pair[1]);
        let run = i32::try_from(next - first - 1).unwrap_or(i32::MAX);
        // a sensor at rest reads the same for long, but comes to it and leaves it by a step of its rounding
        if samples.len() as f64 * libm::pow(equal, f64::from(run)) < BY_CHANCE
            && is_inside(first)
            && stands_out(first)
            && stands_out(next)
        {
            stale.samples[first + 1..next].fill(true);
        }
    }
    stale
}

/// The middle one of `values`, of which there is at least one.
fn middle<T: Copy>(mut values: Vec<T>, order: impl Fn(&T, &T) -> core::cmp::Ordering) -> T {
    let half = values.len() / 2;
    *values.select_nth_unstable_by(half, order).1
}

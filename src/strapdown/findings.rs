//! What is found among the readings that become attitudes, in the words of the command and of the Python package.

use super::noise::changing_noise;
use super::{Kind, NOISE_SAMPLES, Rule};
use crate::num::Shown;
use crate::record::{Record, Spike, median};

/// An interval in which a reading may be missing, in median intervals.
const LONG: f64 = 1.5;

/// Rates jump where they change so many times as much as before, behind and usually.
const JUMP: f64 = 10.0;

/// What was left out of the readings of a record, part by part, and what the budgets of their attitudes do not hold.
#[doc(hidden)]
#[derive(Clone, Debug, Default)]
pub struct Findings {
    samples: usize,
    merged: usize,
    /// s.
    first_merged: Option<f64>,
    repeated: usize,
    saturated: usize,
    new_readings_rate: Option<f64>,
    spikes: usize,
    in_bursts: usize,
    first_spike: Option<Spike>,
    /// Intervals in which a reading may be missing, and the end of the first, s.
    long: usize,
    first_long: Option<f64>,
    /// Jumps of the rates, the row behind the first, s, and the variance of the turn that they leave open, rad².
    jumps: usize,
    first_jump: Option<f64>,
    left_open: f64,
}

impl Findings {
    /// Adds those of a part of a record, of which the `spikes` are left out.
    pub fn add(&mut self, record: &Record, spikes: &[Spike]) {
        self.samples += record.samples();
        self.merged += record.merged();
        self.first_merged = self.first_merged.or(record.first_merged());
        self.repeated += record.repeated() + record.stale();
        self.saturated += record.saturated();
        self.new_readings_rate = self.new_readings_rate.or(record.new_readings_rate());
        self.spikes += spikes.len();
        self.in_bursts += Spike::bursts(spikes).0;
        self.first_spike = self.first_spike.or(spikes.first().copied());
    }

    /// Counts long intervals, also that which begins `before` the part, s.
    pub fn add_intervals(&mut self, record: &Record, before: Option<f64>) {
        let pairs = record.segments.iter().flat_map(|segment| segment.times().windows(2));
        let mut intervals: Vec<(f64, f64)> = pairs.map(|pair| (pair[1] - pair[0], pair[1])).collect();
        let first = record.segments.first().and_then(|segment| segment.times().first());
        intervals.extend(before.zip(first).map(|(before, first)| (first - before, *first)));
        let mut lengths: Vec<f64> = intervals.iter().map(|(length, _)| *length).collect();
        let Some(usual) = median(&mut lengths) else { return };
        let long = || intervals.iter().filter(|(length, _)| *length > LONG * usual);
        self.long += long().count();
        let first = long().map(|(_, end)| *end).reduce(f64::min);
        self.first_long = self.first_long.or(first);
    }

    /// Counts rates that jump between two rows, as of a body that is struck: when they do within the interval is not known, and the turn
    /// in it is anything between those by the two rates.
    pub fn add_jumps(&mut self, record: &Record) {
        for segment in &record.segments {
            let steps: Vec<f64> = segment.rates().windows(2).map(|pair| (pair[1] - pair[0]).norm()).collect();
            // readings that mostly stay change by steps of their sensor
            let Some(usual) = median(&mut steps.clone()).filter(|usual| *usual > 0.0) else { continue };
            for (step, times) in steps.windows(3).zip(segment.times().windows(4)) {
                let [before, own, behind] = [0, 1, 2].map(|k| times[k + 1] - times[k]);
                // a longer interval has a larger step
                let smooth = (step[0] * (own / before).max(1.0)).max(step[2] * (own / behind).max(1.0));
                if step[1] > JUMP * usual.max(smooth) {
                    let open = step[1] * own;
                    self.jumps += 1;
                    self.first_jump = self.first_jump.or(Some(times[2]));
                    self.left_open += open * open / 12.0;
                }
            }
        }
    }

    /// Number of samples that are left.
    pub fn samples(&self) -> usize {
        self.samples
    }

    /// Number of samples at the end of the sensor's range.
    pub fn saturated(&self) -> usize {
        self.saturated
    }

    /// Why readings of this kind, of which `unread` rows cannot be read, tell no attitude: of all but rates each one counts.
    pub fn lost(&self, kind: Kind, unread: usize) -> Option<String> {
        let (count, what) = match (unread, self.merged, self.repeated) {
            _ if kind == Kind::Rate => return None,
            (0, 0, 0) => return None,
            (0, 0, count) => (count, "rows repeat the reading before"),
            (0, count, _) => (count, "rows have the time of the row before"),
            (count, ..) => (count, "rows cannot be read"),
        };
        Some(format!("{count} {what}; with {kind}s none may be missing or repeated"))
    }

    /// What was left out or changed, or may be missing; a `row` is a line of a file, or a row of an array.
    pub fn warnings(&self, row: &str) -> Vec<String> {
        let mut warnings = Vec::new();
        if self.merged > 0 {
            let first = self.first_merged.map_or(String::new(), |t| format!(", the first at {} s", Shown(t)));
            let merged = self.merged;
            warnings.push(format!(
                "{merged} rows have the time of the row before{first}: their rates are averaged"
            ));
        }
        if self.repeated > 0 {
            let new = |hz: f64| format!(", {hz:.4} new ones a second");
            let (repeated, rate) = (self.repeated, self.new_readings_rate.map_or(String::new(), new));
            warnings.push(format!("{repeated} rows repeat the reading before and are left out{rate}"));
        }
        if let Some(Spike { line, time, .. }) = self.first_spike {
            let bursts = match self.in_bursts {
                0 => String::new(),
                count => format!(", {count} of them in bursts"),
            };
            let (spikes, time) = (self.spikes, Shown(time));
            warnings
                .push(format!("{spikes} spikes are left out{bursts}, the first at {row} {line} ({time} s)"));
        }
        if let Some(first) = self.first_long {
            let (long, first) = (self.long, Shown(first));
            warnings.push(format!(
                "{long} intervals are longer than {LONG} usual ones, the first ends at {first} s: if a row is missing there, \
                 its turn is missing in the attitude"
            ));
        }
        if let Some(first) = self.first_jump {
            let (jumps, first, open) = (self.jumps, Shown(first), self.left_open.sqrt());
            warnings.push(format!(
                "{jumps} jumps of the rates, the first before {first} s: when they come between two rows is not known, which leaves {open:.1e} \
                 rad open that is not in the budget"
            ));
        }
        if self.saturated > 0 {
            let saturated = self.saturated;
            warnings.push(format!("{saturated} samples at the end of the sensor's range are left out"));
        }
        warnings
    }

    /// White noise of a reading by the longest segment, its mean square where it changes, of digital readings with that of their steps; and
    /// whether there are enough samples to tell it.
    pub fn noise(record: &Record) -> (f64, bool) {
        let longest = record.segments.iter().max_by_key(|segment| segment.times().len());
        let found = longest.map_or(0.0, |segment| changing_noise(segment.times(), segment.rates()));
        let rounding = record.rounding(&record.quanta()).sqrt();
        (found.max(rounding), longest.is_some_and(|segment| segment.times().len() >= NOISE_SAMPLES))
    }

    /// Of too few samples to tell their noise: which deviation is without it, and what states it.
    pub fn without_noise(sigma: &str, noise: &str) -> String {
        format!(
            "fewer than {NOISE_SAMPLES} samples, too few to find their noise: {sigma} does not include it; give {noise}"
        )
    }

    /// Of readings that rest on a few values: what they are off within a step of the sensor stays, and is not in the deviation `sigma`;
    /// `bias` states it.
    pub fn resting(record: &Record, sigma: &str, bias: &str) -> Option<String> {
        record.rests().then(|| {
            format!(
                "the readings rest on so few values that their noise is not known, nor what they are off within a step of the sensor: \
                 {sigma} does not include it; give {bias}, about 0.3 of a step"
            )
        })
    }

    /// Of so few samples that one polynomial of the `rule` goes through all of them.
    pub fn without_truncation(rule: Rule, samples: usize) -> Option<String> {
        let through = if let Rule::Magnus(magnus) = rule { magnus.samples() } else { 2 };
        (2..=through).contains(&samples).then(|| {
            format!(
                "one polynomial goes through all {samples} samples: its error between them is not known and not included in the \
                 truncation"
            )
        })
    }
}

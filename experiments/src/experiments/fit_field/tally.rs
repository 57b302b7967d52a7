//! What the fits of one row amount to, and what is demanded of them.

use super::cases::{Case, Model};
use super::trial::{Trial, Verdict};
use crate::experiments::tensors::ELLIPSOID;
use crate::statistics::Interval;

/// The 95 % points of χ² with five and six degrees of freedom, and the 99.9 % points.
pub(super) const ELLIPSOIDS: [(f64, f64); 2] =
    [(ELLIPSOID, 20.515_005_652_432_87), (12.591_587_243_743_98, 22.457_744_484_825_326)];

/// Counts of one row or several.
#[derive(Default)]
pub(in crate::experiments) struct Tally {
    numbers: u64,
    /// Squared errors over the bound, where there is one.
    squares: Vec<f64>,
    answered: u64,
    covered: u64,
    stated: u64,
    pub(in crate::experiments) warned: u64,
    /// Answers whose own 99.9 % ellipsoid does not hold the truth.
    pub(in crate::experiments) outside: u64,
    /// Of these, without a warning, those that lines of systematic errors cover.
    pub(in crate::experiments) by_lines: u64,
    /// Of these, those with neither.
    pub(in crate::experiments) silent: u64,
    pub(in crate::experiments) units: u64,
    pub(in crate::experiments) refused: u64,
    /// Answers that say that the record cannot tell its units.
    pub(super) open: u64,
    seconds: Vec<f64>,
}

/// Records of which a share of 95 % is asked.
const MANY: u64 = 50;

impl Tally {
    /// Of tensors with `numbers` unknowns, five or six.
    pub(in crate::experiments) fn new(trials: &[Trial], numbers: u64) -> Self {
        let mut t = Tally { numbers, ..Tally::default() };
        let (inside, outside) = ELLIPSOIDS[usize::from(numbers == 6)];
        for trial in trials {
            t.seconds.push(trial.seconds);
            match &trial.verdict {
                Verdict::Units => t.units += 1,
                Verdict::Refused => t.refused += 1,
                Verdict::Answered(answer) => {
                    t.answered += 1;
                    t.squares.extend(answer.over_bound);
                    t.warned += u64::from(answer.warned);
                    t.open += u64::from(answer.open);
                    t.stated += u64::from(answer.own.is_some());
                    t.covered += u64::from(answer.own.is_some_and(|square| square < inside));
                    let wrong = answer.own.is_none_or(|square| square > outside);
                    t.outside += u64::from(wrong);
                    t.by_lines += u64::from(wrong && !answer.warned && answer.lines_cover);
                    t.silent += u64::from(wrong && !answer.warned && !answer.lines_cover);
                }
            }
        }
        t
    }

    pub(in crate::experiments) fn add(&mut self, other: Tally) {
        self.squares.extend(other.squares);
        self.seconds.extend(other.seconds);
        self.answered += other.answered;
        self.covered += other.covered;
        self.stated += other.stated;
        self.warned += other.warned;
        self.outside += other.outside;
        self.by_lines += other.by_lines;
        self.silent += other.silent;
        self.units += other.units;
        self.refused += other.refused;
        self.open += other.open;
    }

    pub(in crate::experiments) fn answered(&self) -> u64 {
        self.answered
    }

    pub(in crate::experiments) fn covered(&self) -> u64 {
        self.covered
    }

    pub(super) fn records(&self) -> u64 {
        self.answered + self.units + self.refused
    }

    pub(in crate::experiments) fn coverage(&self) -> Option<Interval> {
        Interval::new(self.covered, self.stated)
    }

    /// Root of the mean square error over the bound.
    pub(super) fn over_bound(&self) -> Option<f64> {
        let sum: f64 = self.squares.iter().sum();
        let count = self.numbers * self.squares.len() as u64;
        (count > 0).then(|| (sum / count as f64).sqrt())
    }

    pub(super) fn median(&self) -> Option<f64> {
        middle(&self.squares, 0.5).map(|square| (square / self.numbers as f64).sqrt())
    }

    /// The time that a share of the fits do not exceed.
    pub(super) fn seconds(&self, share: f64) -> Option<f64> {
        middle(&self.seconds, share)
    }

    /// What this row should show and does not, by more than chance; a share of mistakes that are caught is asked of many records.
    pub(super) fn demands(&self, case: &Case, noise: f64) -> Vec<String> {
        let records = self.records();
        let mut failed = Vec::new();
        let mut say = |what: String| failed.push(format!("{}, noise {noise}: {what}", case.name));
        // five standard deviations of chance
        let surely = |count: u64, of: u64| Interval::wide(count, of, 5.0);
        if case.model == Model::WrongUnit {
            if records >= MANY && surely(self.units, records).is_some_and(|i| i.high < 0.95) {
                say(format!("{} of {records} mistaken units caught", self.units));
            }
            if self.answered > self.open {
                say(format!("{} of {records} mistaken units answered silently", self.answered - self.open));
            }
            return failed;
        }
        if self.units > 0 {
            say(format!("{} of {records} right units taken for mistaken", self.units));
        }
        if self.silent > 0 {
            say(format!("{} of {} silently wrong", self.silent, self.answered));
        }
        if case.model == Model::Missing {
            return failed;
        }
        if surely(self.refused, records).is_some_and(|i| i.low > 0.02) {
            say(format!("{} of {records} refused", self.refused));
        }
        let scatter = (2.0 / (self.numbers.max(1) * self.squares.len().max(1) as u64) as f64).sqrt() / 2.0;
        if let Some(over) = self.over_bound().filter(|over| *over > 1.1 + 5.0 * scatter) {
            say(format!("{over:.3} of the bound"));
        }
        if surely(self.covered, self.stated).is_some_and(|i| i.high < 0.91 || i.low > 0.985) {
            say(format!("{} of {} covered", self.covered, self.stated));
        }
        if case.name == "ideal" && surely(self.warned, self.answered).is_some_and(|i| i.low > 0.05) {
            say(format!("{} of {} warned of", self.warned, self.answered));
        }
        failed
    }
}

/// The value that a share of the values do not exceed.
fn middle(values: &[f64], share: f64) -> Option<f64> {
    let mut sorted = values.to_vec();
    sorted.sort_by(f64::total_cmp);
    let last = sorted.len().checked_sub(1)?;
    Some(sorted[(share * last as f64).round() as usize])
}

#[cfg(test)]
mod tests {
    use super::super::trial::Answer;
    use super::*;

    #[test]
    fn a_tally_counts_each_verdict_once() {
        let answer = |own, warned, lines_cover| {
            let open = warned;
            Verdict::Answered(Answer { over_bound: Some(own), own: Some(own), warned, open, lines_cover })
        };
        let verdicts = [
            answer(5.0, false, true),
            answer(30.0, true, false),
            answer(30.0, false, true),
            answer(30.0, false, false),
            Verdict::Units,
            Verdict::Refused,
        ];
        let trials = verdicts.map(|verdict| Trial { verdict, seconds: 0.1 });
        let t = Tally::new(&trials, 5);
        assert_eq!((t.answered(), t.covered(), t.warned, t.silent), (4, 1, 1, 1));
        assert_eq!((t.outside, t.by_lines, t.open), (3, 1, 1));
        assert_eq!((t.units, t.refused, t.records()), (1, 1, 6));
        assert_eq!(t.over_bound(), Some((95.0_f64 / 20.0).sqrt()));
    }
}

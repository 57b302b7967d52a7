//! The verdict on one body of a record, in the quantities that every form of the answer shows.

use polhode::advise::Choice;
use polhode::audit::{Fault, Judgement, Missing, Suspect, Verdict};
use polhode::body::Conserved;

use super::against::Difference;

/// A verdict with what it is about.
pub(super) struct Outcome {
    /// Name of the body, where the file has several.
    pub(super) body: Option<String>,
    pub(super) rows: usize,
    /// What the attitude is written as.
    pub(super) form: Option<&'static str>,
    /// What to switch to.
    pub(super) advice: Option<Choice>,
    pub(super) verdict: Verdict,
    /// Beside a golden trajectory, where one was given.
    pub(super) against: Option<Difference>,
    /// Remarks of the reading of the file.
    pub(super) notes: Vec<String>,
}

impl Outcome {
    pub(super) fn is_right(&self) -> bool {
        self.verdict.judgement == Judgement::Right && self.against.as_ref().is_none_or(Difference::is_within)
    }

    /// `right`, `wrong` or `undecided`.
    pub(super) fn judgement(&self) -> String {
        match (&self.against, self.verdict.judgement) {
            (Some(difference), Judgement::Right) if !difference.is_within() => Judgement::Wrong.to_string(),
            (_, judgement) => judgement.to_string(),
        }
    }

    pub(super) fn suspect(&self) -> String {
        self.verdict.suspect.to_string()
    }

    /// Whether there is a suspect.
    pub(super) fn is_suspected(&self) -> bool {
        self.verdict.suspect != Suspect::None
    }

    /// The largest relative error of a conserved quantity.
    pub(super) fn error(&self, which: fn(&Conserved) -> bool) -> Option<f64> {
        self.verdict.conservation.iter().find(|line| which(&line.quantity)).map(|line| line.error)
    }

    /// The angle from the golden trajectory, else from the motion that the verdict compares with, rad.
    pub(super) fn attitude_error(&self) -> Option<f64> {
        match &self.against {
            Some(difference) => Some(difference.largest),
            None => self.verdict.attitude_error.map(|error| error.largest),
        }
    }

    /// The convention that the record is written in, in words.
    pub(super) fn reading(&self) -> String {
        let reading = self.verdict.reading;
        // quaternions and Euler angles are named with their order
        match self.form.filter(|_| reading.quaternion.is_none() && reading.angles.is_none()) {
            Some(form) => format!("{form}; {reading}"),
            None => reading.to_string(),
        }
    }

    /// Everything that a reader should know besides the numbers, a sentence each.
    pub(super) fn warnings(&self) -> Vec<String> {
        let verdict = &self.verdict;
        let mut all = self.notes.clone();
        all.extend(verdict.missing.iter().map(Missing::to_string));
        all.extend(verdict.faults.iter().map(Fault::to_string));
        if let Some(tie) = &verdict.tie {
            all.push(format!("{} readings fit alike: {}", tie.readings.len(), tie.reason));
        }
        all
    }
}

/// A quantity by its name in rows and in words.
pub(super) fn named(quantity: &Conserved) -> (&'static str, &'static str) {
    match quantity {
        Conserved::Energy => ("energy_error", "energy"),
        Conserved::MomentumNorm => ("momentum_error", "|m|"),
        Conserved::Momentum => ("momentum_vector_error", "L in space"),
        Conserved::MomentumZ => ("momentum_z_error", "L_z"),
        _ => ("jacobi_error", "Jacobi's constant"),
    }
}

/// A sentence that starts a line has a capital.
pub(super) fn sentence(text: &str) -> String {
    let mut letters = text.chars();
    let first = letters.next().map(|c| c.to_uppercase().collect::<String>()).unwrap_or_default();
    first + letters.as_str() + "."
}

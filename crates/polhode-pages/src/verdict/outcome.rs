//! The verdict on one body of a record, in the quantities that every form of the answer shows.

use polhode::advise::Choice;
use polhode::audit::{Fault, Judgement, Missing, Suspect, Verdict};
use polhode::body::Conserved;

/// A verdict with what it is about.
pub struct Outcome {
    /// Name of the body, where the file has several.
    pub body: Option<String>,
    /// How many rows it has.
    pub rows: usize,
    /// What the attitude is written as.
    pub form: Option<&'static str>,
    /// What to switch to.
    pub advice: Option<Choice>,
    /// The verdict.
    pub verdict: Verdict,
    /// Beside a golden trajectory, where one was given.
    pub against: Option<Difference>,
    /// Remarks of the reading of the file.
    pub notes: Vec<String>,
}

/// How far a record is from a golden trajectory.
pub struct Difference {
    /// File of the golden trajectory.
    pub name: String,
    /// Rows at the same times.
    pub rows: usize,
    /// Rows of the golden trajectory.
    pub of: usize,
    /// Whether every row of one of the two is at a time of the other.
    pub is_whole: bool,
    /// Largest angle between the attitudes, rad.
    pub largest: f64,
    /// When, s.
    pub at: f64,
    /// What is allowed, rad.
    pub tolerance: f64,
}

impl Difference {
    /// Whether it is no more than is allowed.
    #[must_use]
    pub fn is_within(&self) -> bool {
        self.largest <= self.tolerance
    }
}

impl Outcome {
    /// The judgement, beside a golden trajectory too: a comparison of some rows decides nothing of the others.
    pub(super) fn judged(&self) -> Judgement {
        match (&self.against, self.verdict.judgement) {
            (Some(difference), Judgement::Right) if !difference.is_within() => Judgement::Wrong,
            (Some(difference), Judgement::Right) if !difference.is_whole => Judgement::Undecided,
            (_, judgement) => judgement,
        }
    }

    /// Whether it is right, beside a golden trajectory too.
    #[must_use]
    pub fn is_right(&self) -> bool {
        self.judged() == Judgement::Right
    }

    /// `right`, `wrong` or `undecided`.
    #[must_use]
    pub fn judgement(&self) -> String {
        self.judged().to_string()
    }

    /// What is wrong, in one word.
    #[must_use]
    pub fn suspect(&self) -> String {
        self.verdict.suspect.to_string()
    }

    /// Whether there is a suspect.
    #[must_use]
    pub fn is_suspected(&self) -> bool {
        self.verdict.suspect != Suspect::None
    }

    /// The largest relative error of a conserved quantity.
    #[must_use]
    pub fn error(&self, which: fn(&Conserved) -> bool) -> Option<f64> {
        self.verdict.conservation.iter().find(|line| which(&line.quantity)).map(|line| line.error)
    }

    /// The angle from the golden trajectory, else from the motion that the verdict compares with, rad.
    #[must_use]
    pub fn attitude_error(&self) -> Option<f64> {
        match &self.against {
            Some(difference) => Some(difference.largest),
            None => self.verdict.attitude_error.map(|error| error.largest),
        }
    }

    /// The convention that the record is written in, in words.
    #[must_use]
    pub fn reading(&self) -> String {
        let reading = self.verdict.reading;
        // quaternions and Euler angles are named with their order
        match self.form.filter(|_| reading.quaternion.is_none() && reading.angles.is_none()) {
            Some(form) => format!("{form}; {reading}"),
            None => reading.to_string(),
        }
    }

    /// Everything that a reader should know besides the numbers, a sentence each.
    #[must_use]
    pub fn warnings(&self) -> Vec<String> {
        let verdict = &self.verdict;
        let mut all = self.notes.clone();
        all.extend(verdict.missing.iter().map(Missing::to_string));
        all.extend(verdict.faults.iter().map(Fault::to_string));
        if verdict.suspect == Suspect::AnglesOrder {
            all.push(
                "columns roll, pitch and yaw are turns about x, y and z, and the rows turn about other axes; if other angles \
                 are meant, name the columns by --columns e1=NAME,e2=NAME,e3=NAME"
                    .into(),
            );
        }
        if let Some(tie) = &verdict.tie {
            all.push(format!("{} readings fit equally well: {}", tie.readings.len(), tie.reason));
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

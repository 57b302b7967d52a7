//! What was found, as a table.

use core::fmt;

use super::finding::{Finding, one_line, short};
use super::words::{Verdict, word_of};

/// Every law that was measured of a method, a force or a scheme.
///
/// Its `Display` is a table of 80 columns with the false claims in words below; [`text`](Self::text) holds every digit, and
/// `FromStr` reads that back.
#[derive(Clone, Debug, PartialEq)]
#[must_use]
#[non_exhaustive]
pub struct Report {
    /// The name of what was measured.
    pub name: String,
    /// What was found, by kind of motion and law.
    pub findings: Vec<Finding>,
}

impl Report {
    pub(super) fn new(name: impl AsRef<str>) -> Self {
        Report { name: one_line(name.as_ref()), findings: Vec::new() }
    }

    /// The claims that do not hold.
    pub fn false_claims(&self) -> impl Iterator<Item = &Finding> {
        self.with(Verdict::False)
    }

    /// What holds though it is not claimed.
    pub fn unclaimed(&self) -> impl Iterator<Item = &Finding> {
        self.with(Verdict::Unclaimed)
    }

    /// What the measurements do not decide.
    pub fn undecided(&self) -> impl Iterator<Item = &Finding> {
        self.with(Verdict::Undecided)
    }

    /// The findings with the verdict `verdict`.
    pub fn with(&self, verdict: Verdict) -> impl Iterator<Item = &Finding> {
        self.findings.iter().filter(move |finding| finding.verdict == verdict)
    }
}

impl fmt::Display for Report {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        writeln!(f, "{}", self.name)?;
        writeln!(
            f,
            "{:<9} {:<13} {:<9} {:<11} {:>9} {:>14} verdict",
            "motion", "law", "of", "claimed", "measured", "± or slope"
        )?;
        for finding in &self.findings {
            let motion = word_of(finding.problem);
            let (law, quantity, claim) = (finding.law, finding.quantity, &finding.claim);
            let measured = finding.measured.map(short).unwrap_or_default();
            let interval = interval(finding);
            let verdict = finding.verdict;
            writeln!(
                f,
                "{motion:<9} {law:<13} {quantity:<9} {claim:<11} {measured:>9} {interval:>14} {verdict}"
            )?;
        }
        for verdict in [Verdict::False, Verdict::Unclaimed, Verdict::Undecided] {
            for finding in self.with(verdict) {
                for (n, line) in wrapped(&finding.sentence(), 66).iter().enumerate() {
                    let head = if n == 0 { format!("{verdict}:") } else { String::new() };
                    writeln!(f, "{head:<11} {line}")?;
                }
            }
        }
        Ok(())
    }
}

/// The interval of the number, or the slope of the error with its own.
fn interval(finding: &Finding) -> String {
    match (finding.half_width, finding.drift) {
        (Some(half_width), _) => format!("±{}", short(half_width)),
        (None, Some(drift)) => format!("{:.0e}±{:.0e}", drift.slope, drift.half_width),
        (None, None) => String::new(),
    }
}

/// `text` in lines of at most `width` characters, broken between words.
fn wrapped(text: &str, width: usize) -> Vec<String> {
    let mut lines: Vec<String> = Vec::new();
    for word in text.split(' ') {
        match lines.last_mut() {
            Some(line) if line.chars().count() + 1 + word.chars().count() <= width => {
                line.push(' ');
                line.push_str(word);
            }
            _ => lines.push(word.into()),
        }
    }
    lines
}

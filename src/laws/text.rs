//! The stable text of a report: a head, the name, and a line a finding, its fields between tabs.

use core::fmt::Write as _;
use core::str::FromStr;

use thiserror::Error;

use super::Report;
use super::finding::{Finding, one_line};
use super::words::{problem_of, word_of};
use crate::observe::Drift;

/// First line of the text; the number is that of the format.
const HEAD: &str = "polhode laws 1";

/// What a line of the text holds.
const RULE: &str = "it should hold motion, law, quantity, claim, measured number, half of its interval, limit, slope, half of \
                    its interval, verdict and reason, separated by tabs, with - for a missing number";

/// A text that is not that of a report.
#[derive(Clone, Debug, PartialEq, Eq, Error)]
#[error("line {line} of the report is {found:?}; {rule}")]
#[non_exhaustive]
pub struct ReportError {
    /// Line, counted from 1.
    pub line: usize,
    /// What it says.
    pub found: String,
    /// What it should be.
    pub rule: &'static str,
}

impl Report {
    /// The report as text: every double exactly, the same on every machine.
    ///
    /// ```
    /// use polhode::laws::{Report, check_scheme};
    /// use polhode::method::schemes::STRANG;
    /// let report = check_scheme(&STRANG)?;
    /// assert_eq!(report.text().parse::<Report>()?, report);
    /// # Ok::<(), polhode::Error>(())
    /// ```
    #[must_use]
    pub fn text(&self) -> String {
        let number = |x: Option<f64>| x.map_or("-".into(), |x| format!("{x:?}"));
        let mut text = format!("{HEAD}\n{}\n", one_line(&self.name));
        for finding in &self.findings {
            let Finding { law, quantity, verdict, .. } = finding;
            let drift = [finding.drift.map(|drift| drift.slope), finding.drift.map(|drift| drift.half_width)];
            let fields = [
                word_of(finding.problem).into(),
                law.to_string(),
                quantity.to_string(),
                one_line(&finding.claim),
                number(finding.measured),
                number(finding.half_width),
                number(finding.limit),
                number(drift[0]),
                number(drift[1]),
                verdict.to_string(),
                one_line(&finding.why),
            ];
            // writing to a string does not fail
            let _ = writeln!(text, "{}", fields.join("\t"));
        }
        text
    }
}

impl FromStr for Report {
    type Err = ReportError;

    fn from_str(text: &str) -> Result<Self, ReportError> {
        let mut lines = text.lines().enumerate();
        let mut next = |rule| match lines.next() {
            Some((_, line)) => Ok(line),
            None => Err(ReportError { line: text.lines().count() + 1, found: String::new(), rule }),
        };
        let rule = "it should be the head of a report, polhode laws 1";
        let head = next(rule)?;
        if head != HEAD {
            return Err(ReportError { line: 1, found: head.into(), rule });
        }
        let mut report = Report::new(next("it should be a name")?);
        for (n, line) in lines {
            let finding =
                finding(line).ok_or_else(|| ReportError { line: n + 1, found: line.into(), rule: RULE })?;
            report.findings.push(finding);
        }
        Ok(report)
    }
}

fn finding(line: &str) -> Option<Finding> {
    let fields: [&str; 11] = line.split('\t').collect::<Vec<_>>().try_into().ok()?;
    let [problem, law, quantity, claim, measured, half_width, limit, slope, of_slope, verdict, why] = fields;
    let number = |field: &str| match field {
        "-" => Some(None),
        field => field.parse().ok().map(Some),
    };
    let drift = number(slope)?.zip(number(of_slope)?).map(|(slope, half_width)| Drift { slope, half_width });
    Some(Finding {
        measured: number(measured)?,
        half_width: number(half_width)?,
        limit: number(limit)?,
        drift,
        verdict: verdict.parse().ok()?,
        why: why.into(),
        ..Finding::new(problem_of(problem).ok()?, law.parse().ok()?, quantity.parse().ok()?, claim)
    })
}

//! `polhode methods --check`: the laws of a method, measured.

use clap::{Args, ValueEnum};
use polhode::body::Problem;
use polhode::laws::{Law, Report, check_only};
use polhode_files::error::Error;
use polhode_pages::table::{Column, Format, Table, row};

use super::named;

/// Which claims are measured.
#[derive(Args, Clone, Debug)]
pub(super) struct Check {
    /// Measure every claim of this method, also that it does not keep what it does not claim to keep; takes some seconds. Exit code 1: a claim is false
    #[arg(long, value_name = "NAME", conflicts_with = "schemes")]
    check: Option<String>,
    /// Only in these kinds of motion [default: all for which the method is made]
    #[arg(long, value_name = "KIND,...", value_enum, value_delimiter = ',', requires = "check")]
    motion: Vec<Motion>,
    /// Measure the time of a step too
    #[arg(long, requires = "check")]
    time: bool,
}

/// Kinds of motion.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
enum Motion {
    /// No torque
    Free,
    /// Uniform gravity about a fixed point
    Gravity,
    /// Another potential
    Potential,
    /// Any torque
    Torque,
    /// Wheels on the body, and no torque
    Wheels,
    /// Wheels, and a potential
    WheelsPotential,
}

impl From<Motion> for Problem {
    fn from(motion: Motion) -> Self {
        match motion {
            Motion::Free => Self::Free,
            Motion::Gravity => Self::Linear,
            Motion::Potential => Self::Potential,
            Motion::Torque => Self::Torque,
            Motion::Wheels => Self::Gyrostat,
            Motion::WheelsPotential => Self::GyrostatPotential,
        }
    }
}

impl Check {
    /// What was found; `None` where no method is to be checked.
    pub(super) fn report(&self) -> Result<Option<Report>, Error> {
        let Some(name) = &self.check else { return Ok(None) };
        let method = named("--check", name)?;
        let asked = if self.motion.is_empty() { Motion::value_variants() } else { &self.motion };
        let problems: Vec<Problem> = asked.iter().map(|motion| (*motion).into()).collect();
        let laws: Vec<Law> = Law::ALL.iter().copied().filter(|law| self.time || *law != Law::Time).collect();
        let report = check_only(method.as_ref(), &problems, &laws);
        report.map(Some).map_err(|error| Error::Failed(format!("--check {name}: {error}")))
    }
}

/// The report as a page of text, or its rows.
pub(super) fn written(report: &Report, format: Format) -> String {
    match format {
        Format::Table => report.to_string(),
        Format::Csv | Format::Json => format.write(&table(report)),
    }
}

/// A row a finding.
fn table(report: &Report) -> Table {
    let columns = vec![
        Column::new("method", "", "name of the method"),
        Column::new("motion", "", "free, gravity, potential, torque, wheels or wheels+U"),
        Column::new("law", "", "what is measured"),
        Column::new("quantity", "", "of what"),
        Column::new("claim", "", "what the method claims"),
        Column::new(
            "measured",
            "",
            "an order, a relative error or defect, a slope in 1/s, a count or a time in s",
        ),
        Column::new("half_width", "", "half of the interval of that number"),
        Column::new("limit", "", "what the number is compared with"),
        Column::new("slope", "1/s", "secular slope of the error of a conserved quantity"),
        Column::new("slope_half_width", "1/s", "half of its interval of 95 %"),
        Column::new("verdict", "", "holds, false, unclaimed, undecided or measured"),
        Column::new("why", "", "why nothing is decided, or what else there is to say"),
    ];
    let mut table = Table::new("laws", "What a method claims, and what was measured.", columns);
    for finding in &report.findings {
        table.push(row![
            report.name.as_str(),
            finding.motion(),
            finding.law.word(),
            finding.quantity.word(),
            finding.claim.as_str(),
            finding.measured,
            finding.half_width,
            finding.limit,
            finding.drift.map(|drift| drift.slope),
            finding.drift.map(|drift| drift.half_width),
            finding.verdict.word(),
            finding.why.as_str(),
        ]);
    }
    table
}

/// An error where a claim is false.
pub(super) fn judged(report: &Report) -> Result<(), Error> {
    let wrong: Vec<String> = report.false_claims().map(|finding| finding.sentence()).collect();
    if wrong.is_empty() {
        return Ok(());
    }
    Err(Error::Failed(format!("{}: what it claims does not hold: {}", report.name, wrong.join("; "))))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_false_claim_is_told_and_ends_with_1() {
        let rest = "attitude\t4\t2.0\t0.001\t0.08\t-\t-";
        let text = |verdict: &str| format!("polhode laws 1\nmine\nfree\torder\t{rest}\t{verdict}\t\n");
        let report = |verdict: &str| text(verdict).parse::<Report>().unwrap();
        assert!(judged(&report("holds")).is_ok());
        let error = judged(&report("false")).unwrap_err();
        assert_eq!(error.exit_code(), 1);
        assert_eq!(
            error.to_string(),
            "mine: what it claims does not hold: free, order, attitude: claimed 4, measured 2 ± 1.0e-3, limit 0.080"
        );
    }
}

//! All laws of a method.

use core::ops::Range;

use super::case::cases;
use super::subject::Subject;
use super::words::{Law, Quantity, Verdict};
use super::{
    Finding, LawsError, Report, conserved, cost, drift, order, poisson, reversibility, rounding, symmetry,
    symplectic, takes, time,
};
use crate::body::Problem;
use crate::method::AnyMethod;
use crate::run::HalvingError;

/// Every law of `method` but its processor time, in each kind of motion that it takes.
///
/// A second or two of one core; [`check_only`] measures some of the laws.
///
/// # Errors
/// None of a method: what it refuses is a finding.
///
/// ```no_run
/// use polhode::{laws::check, method};
/// let report = check(&method("rk4")?)?;
/// assert_eq!(report.false_claims().count(), 0, "{report}");
/// # Ok::<(), polhode::Error>(())
/// ```
pub fn check(method: &dyn AnyMethod) -> Result<Report, LawsError> {
    let all: Vec<Law> = Law::ALL.iter().copied().filter(|law| *law != Law::Time).collect();
    check_only(method, Problem::ALL, &all)
}

/// Some laws of `method`, in some kinds of motion. A motion that the method claims to take and does not is named, whatever the
/// laws.
///
/// # Errors
/// As [`check`].
///
/// ```
/// use polhode::body::Problem;
/// use polhode::laws::{Law, check_only};
/// use polhode::method;
/// let report = check_only(&method("rattle")?, &[Problem::Linear], &[Law::Symplectic, Law::Symmetry])?;
/// assert_eq!(report.false_claims().count(), 0, "{report}");
/// # Ok::<(), polhode::Error>(())
/// ```
pub fn check_only(method: &dyn AnyMethod, problems: &[Problem], laws: &[Law]) -> Result<Report, LawsError> {
    let mut report = Report::new(method.name());
    for case in cases()?.iter().filter(|case| problems.contains(&case.problem())) {
        let taken = takes::measure(method, case);
        let is_taken = taken.verdict == Verdict::Holds;
        if laws.contains(&Law::Takes) || !is_taken {
            report.findings.push(taken);
        }
        let Some(claims) = method.claims(case.problem()).filter(|_| is_taken) else { continue };
        let subject = Subject { method, claims, case };
        for law in Law::ALL.iter().filter(|law| laws.contains(law)) {
            report.findings.extend(answered(&subject, *law)?);
        }
    }
    Ok(report)
}

/// What was found of `law`; of a method that refuses a step of the measurement, that nothing is decided, and why.
fn answered(subject: &Subject<'_>, law: Law) -> Result<Vec<Finding>, LawsError> {
    match measure(subject, law) {
        Err(LawsError::Step(error) | LawsError::Halving(HalvingError::Step(error))) => {
            let finding = Finding::new(subject.problem(), law, Quantity::Method, "-");
            Ok(vec![finding.because(error.to_string())])
        }
        found => found,
    }
}

fn measure(subject: &Subject<'_>, law: Law) -> Result<Vec<Finding>, LawsError> {
    match law {
        Law::Order => order::measure(subject),
        Law::Symmetry => symmetry::measure(subject),
        Law::Reversibility => reversibility::measure(subject),
        Law::Poisson => poisson::measure(subject),
        Law::Symplectic => symplectic::measure(subject),
        Law::Conserved => conserved::measure(subject),
        Law::Drift => drift::measure(subject),
        Law::Cost => cost::measure(subject),
        Law::Rounding => rounding::measure(subject),
        Law::Time => time::measure(subject),
        // of the method as a whole, or of forces
        Law::Takes | Law::Gradient | Law::Finite => Ok(Vec::new()),
    }
}

/// The order of `method` in one kind of motion, in steps of 2^−k of the [span](super::Case::span), k in `exponents`: for
/// methods whose order shows in other steps than those of [`check`]. Nothing where the method claims no order.
///
/// # Errors
/// A method that does not take the motion, or more than 53 halvings.
///
/// ```
/// use polhode::body::Problem;
/// use polhode::{laws::check_order, method};
/// let report = check_order(&method("two-turn@kahan-li-8")?, Problem::Free, 4..7)?;
/// assert_eq!(report.false_claims().count(), 0, "{report}");
/// # Ok::<(), polhode::Error>(())
/// ```
pub fn check_order(
    method: &dyn AnyMethod,
    problem: Problem,
    exponents: Range<u32>,
) -> Result<Report, LawsError> {
    let mut report = Report::new(method.name());
    for case in cases()?.iter().filter(|case| case.problem() == problem) {
        if let Some(claims) = method.claims(problem)
            && let Some(order) = claims.order
        {
            let subject = Subject { method, claims, case };
            report.findings.extend(order::against(&subject, order, exponents.clone())?);
        }
    }
    Ok(report)
}

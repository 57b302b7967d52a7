//! The order of a scheme.

use core::ops::Range;

use super::case::{Case, cases};
use super::order::against;
use super::subject::Subject;
use super::{LawsError, Report};
use crate::method::schemes::Scheme;
use crate::method::{Claimed, ExactFlow, Splitting};

/// The order of `scheme`, measured over the exact free flow and kicks: in a potential, with force gradients under gravity.
///
/// # Errors
/// A scheme that fits no two flows.
///
/// ```
/// use polhode::laws::{Verdict, check_scheme};
/// use polhode::method::schemes::{SABA_2, Scheme};
/// assert_eq!(check_scheme(&SABA_2)?.false_claims().count(), 0);
/// let report = check_scheme(&Scheme { order: 4, ..SABA_2 })?; // it has order 2
/// let wrong = report.false_claims().next().ok_or("no claim is false")?;
/// assert!(wrong.measured.is_some_and(|order| (order - 2.0).abs() < 0.05), "{report}");
/// # Ok::<(), polhode::Error>(())
/// ```
pub fn check_scheme(scheme: &Scheme) -> Result<Report, LawsError> {
    let [_, heavy, potential, _] = cases()?;
    let method = Splitting::kicked(ExactFlow, *scheme)?;
    let case: &Case = if scheme.gradients().is_empty() { potential } else { heavy };
    let mut report = Report::new(scheme.name);
    if let Some(claims) = method.claims(case.problem()) {
        let subject = Subject { method: &method, claims, case };
        report.findings = against(&subject, scheme.order, exponents_of(scheme.order))?;
    }
    Ok(report)
}

/// For [`check_order`](super::check_order): how often the span is halved until the errors of a scheme of the order `order` are
/// small, and still above the floor that the digits of its coefficients set.
#[must_use]
pub fn exponents_of(order: u32) -> Range<u32> {
    match order {
        ..=4 => 6..10,
        6 => 6..9,
        8 => 5..8,
        _ => 4..7,
    }
}

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
/// use polhode::method::schemes::{SUZUKI_4, Scheme};
/// let report = check_scheme(&SUZUKI_4)?;
/// assert_eq!((report.with(Verdict::Holds).count(), report.false_claims().count()), (2, 0), "{report}");
/// // coefficients of a lower order make no scheme
/// assert!(Scheme::new("mine", 6, SUZUKI_4.stages(), "nobody").is_err());
/// # Ok::<(), polhode::Error>(())
/// ```
pub fn check_scheme(scheme: &Scheme) -> Result<Report, LawsError> {
    let [_, heavy, potential, ..] = cases()?;
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::laws::{Law, Quantity};
    use crate::method::schemes::{self, Stages};
    use crate::num::{Dd, Real};

    // no scheme from outside is as wrong: `Scheme::new` refuses it
    #[test]
    fn coefficients_that_are_not_of_their_order_are_named() {
        let Stages::Composition([first, second]) = schemes::SUZUKI_4.stages else { panic!("two lengths") };
        // a wrong digit in the third place
        let wrong: &[Dd] = Box::leak(Box::new([*first + Dd::of(1e-3), *second]));
        let wrong = Scheme { stages: Stages::Composition(wrong), ..schemes::SUZUKI_4 };
        let report = check_scheme(&wrong).unwrap();
        let found: Vec<_> = report.false_claims().map(|finding| (finding.law, finding.quantity)).collect();
        assert_eq!(found, [(Law::Order, Quantity::Attitude), (Law::Order, Quantity::Momentum)]);
        assert!(report.to_string().lines().all(|line| line.chars().count() <= 80), "{report}");
        for order in [0, 1, 3, u32::MAX] {
            let report = check_scheme(&Scheme { order, ..schemes::STRANG }).unwrap();
            assert_eq!(report.false_claims().count(), 2, "{report}");
        }
    }
}

//! Whether a method takes the motions that it has claims for, and refuses the others.

use super::case::Case;
use super::finding::{Finding, yes};
use super::words::{Law, Quantity, Verdict};
use crate::body::Clock;
use crate::method::AnyMethod;

/// Prepares a step in both precisions.
pub(super) fn measure(method: &dyn AnyMethod, case: &Case) -> Finding {
    let clock = Clock::new(0.125);
    let in_doubles = method.prepare_f64(clock, &case.body);
    let prepared = in_doubles.and_then(|_| method.prepare_dd(clock, &case.body).map(|_| ()));
    let claimed = method.claims(case.problem()).is_some();
    let finding = Finding::new(case.problem(), Law::Takes, Quantity::Method, yes(claimed));
    match (claimed, prepared) {
        (true, Ok(())) | (false, Err(_)) => finding.verdict(Verdict::Holds),
        (true, Err(error)) => finding.verdict(Verdict::False).because(error.to_string()),
        (false, Ok(())) => finding.verdict(Verdict::Unclaimed),
    }
}

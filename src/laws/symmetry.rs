//! Symmetry, Φ_{−h} ∘ Φ_h = 1: steps there and back by a clock that runs backwards.

use super::LawsError;
use super::case::EXACT;
use super::finding::{Finding, yes};
use super::subject::Subject;
use super::words::{Law, Quantity};
use crate::body::{Clock, Point};

/// Where 25 steps there and 25 back lead.
pub(super) fn measure(subject: &Subject<'_>) -> Result<Vec<Finding>, LawsError> {
    let mut x = subject.case.start;
    let h = subject.telling_step(0.125);
    for clock in [Clock::new(h), Clock { start: 25.0 * h, step: -h }] {
        x = Point::new(x.attitude, x.momentum_body);
        subject.method.prepare_dd(clock, &subject.case.body)?.steps(&mut x, 25);
    }
    Ok(vec![returned(subject, Law::Symmetry, &x)])
}

/// Whether the end `x` of a way there and back is the start.
pub(super) fn returned(subject: &Subject<'_>, law: Law, x: &Point<crate::num::Dd>) -> Finding {
    let claimed = subject.claims.symmetric || subject.is_to_rounding();
    let finding = Finding::new(subject.problem(), law, Quantity::State, yes(claimed));
    finding.judged(claimed, subject.away(x), 10.0 * EXACT, 1e6 * EXACT)
}

//! Order: the slope of log error against log h, in double-double, at steps where neither rounding nor the next power shows.

use core::ops::Range;

use super::LawsError;
use super::case::EXACT;
use super::finding::{Finding, short};
use super::subject::{Subject, largest};
use super::words::{Law, Quantity, Verdict};
use crate::body::{Clock, Problem};
use crate::num::Real;
use crate::run::{Halving, halvings_against, observed_order};

/// Of doubles: a quaternion whose parts are rounded is off by an angle of two roundings at most.
const OF_DOUBLES: f64 = 2.0 * f64::ROUNDOFF;

/// The order in all halvings, or how far the error is below the tolerance.
pub(super) fn measure(subject: &Subject<'_>) -> Result<Vec<Finding>, LawsError> {
    match subject.claims.order {
        Some(order) => against(subject, order, exponents(subject, order)),
        None => within_tolerance(subject),
    }
}

fn exponents(subject: &Subject<'_>, order: u32) -> Range<u32> {
    match (subject.problem(), order) {
        (_, 2..=4) if subject.claims.cost.right_sides > 0 => 8..11,
        (Problem::Linear, 1) => 8..11,
        (Problem::Linear, _) => 6..9,
        (_, 1) => 8..11,
        (Problem::GyrostatPotential, 8..) => 7..10,
        (_, 8..) => 5..8,
        (Problem::Torque, 6..) => 6..9,
        (Problem::Torque, _) => 8..11,
        _ => 6..9,
    }
}

fn halvings(subject: &Subject<'_>, exponents: Range<u32>) -> Result<Vec<Halving>, LawsError> {
    let case = subject.case;
    let (end, method) = (case.end()?, subject.method);
    Ok(halvings_against(&end, method, &case.body, &case.start, case.span, exponents)?)
}

/// The order of attitude and momentum between any two neighbours of the halvings.
pub(super) fn against(
    subject: &Subject<'_>,
    order: u32,
    exponents: Range<u32>,
) -> Result<Vec<Finding>, LawsError> {
    let errors = halvings(subject, exponents)?;
    Ok(vec![
        slopes(subject.problem(), Quantity::Attitude, order, &errors, |error| error.attitude_error),
        slopes(subject.problem(), Quantity::Momentum, order, &errors, |error| error.momentum_error),
    ])
}

fn slopes(
    problem: Problem,
    quantity: Quantity,
    order: u32,
    errors: &[Halving],
    pick: fn(&Halving) -> f64,
) -> Finding {
    let claimed = f64::from(order);
    let limit = 0.02 * claimed.max(2.0);
    let series: Vec<(f64, f64)> = errors.iter().map(|error| (error.h, pick(error))).collect();
    let finding = Finding::new(problem, Law::Order, quantity, order.to_string());
    let slopes: Option<Vec<f64>> = series.windows(2).map(observed_order).collect();
    let (Some(slopes), Some(&(_, last))) = (slopes.filter(|slopes| !slopes.is_empty()), series.last()) else {
        let some_finite = series.iter().all(|(_, error)| error.is_finite());
        let why =
            if some_finite { "there is no error of discretisation" } else { super::finding::NOT_FINITE };
        return finding.verdict(Verdict::False).because(why);
    };
    // the slope that is furthest from the claim stands for all
    let off = |slope: &f64| (slope - claimed).abs();
    let furthest = slopes.iter().fold(slopes[0], |a, b| if off(&a) >= off(b) { a } else { *b });
    let spread = largest(slopes.iter().map(|slope| (slope - furthest).abs()));
    let finding =
        Finding { measured: Some(furthest), half_width: Some(spread), limit: Some(limit), ..finding };
    // so near to rounding a slope that fits says little, and one that does not tells of a claim that is too modest
    let small = last <= 1e3 * EXACT;
    let fits = slopes.iter().all(|slope| off(slope) < limit);
    let finding = finding.verdict(match (fits, small) {
        (true, false) => Verdict::Holds,
        (true, true) => Verdict::Undecided,
        (false, _) => Verdict::False,
    });
    if small { finding.because(format!("the error is {} only", short(last))) } else { finding }
}

/// The error of a method without order, in one step of its own: below its tolerance, and no millionth of that.
fn within_tolerance(subject: &Subject<'_>) -> Result<Vec<Finding>, LawsError> {
    let case = subject.case;
    let errors = halvings(subject, 6..7)?;
    let tolerance = subject.method.tolerance().filter(|_| !subject.is_to_rounding());
    let (most, claim) = match tolerance {
        None if subject.claims.to_doubles => (OF_DOUBLES, format!("to {}", short(OF_DOUBLES))),
        None => (EXACT, "exact".into()),
        Some(tolerance) => {
            let mut step = subject.method.prepare_dd(Clock::new(case.span / 64.0), &case.body)?;
            step.steps(&mut case.start.clone(), 64);
            let most = tolerance * step.work().map_or(1.0, |work| work.accepted as f64);
            (most, format!("to {tolerance:e}"))
        }
    };
    let error = largest(errors.iter().flat_map(|error| [error.attitude_error, error.momentum_error]));
    let finding = Finding::new(subject.problem(), Law::Order, Quantity::State, claim);
    let finding = finding.judged(true, error, most, most);
    let needlessly = tolerance.is_some() && error <= 1e-6 * most;
    Ok(vec![if needlessly {
        finding
            .verdict(Verdict::Undecided)
            .because("the error is less than a millionth of what the tolerance allows")
    } else {
        finding
    }])
}

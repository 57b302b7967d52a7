//! The law of round-off: in double precision what is kept walks, some hundredths of a unit in the last place in a step, and
//! does not move always in one direction.

use super::case::EXACT;
use super::finding::{Finding, number};
use super::subject::Subject;
use super::words::{Law, Quantity, Verdict};
use super::{LawsError, conserved};
use crate::body::{Body, Clock, Point, Problem};
use crate::inertia::Inertia;
use crate::method::{AnyMethod, Energy};
use crate::rotation::{Quat, Vec3};
use crate::run::{Run, RunError};

/// So many steps tell a walk from a bias.
const STEPS: u64 = 1_000_000;

/// A bias of less than a thousandth of a rounding, from constants or products that are rounded apart, makes 4e-14 in so many.
const WALK: f64 = 2e-14;

/// What the residual of a projection adds up to in them.
const RESIDUALS: f64 = 1e-11;

/// Energy and |m| of free motion, as far as they are kept.
pub(super) fn measure(subject: &Subject<'_>) -> Result<Vec<Finding>, LawsError> {
    let kept = subject.claims.kept;
    let [energy, momentum] =
        [kept.energy == Energy::Exact, kept.momentum_norm].map(|kept| kept || subject.is_to_rounding());
    if subject.problem() != Problem::Free || !(energy || momentum) {
        return Ok(Vec::new());
    }
    let exact = conserved::measure(subject)?;
    let is_kept = |quantity| {
        exact.iter().any(|finding| finding.quantity == quantity && finding.verdict == Verdict::Holds)
    };
    let mut findings = Vec::new();
    let long = if energy { Some(worst(subject)?) } else { None };
    for (n, quantity) in [Quantity::Energy, Quantity::MomentumNorm].into_iter().enumerate() {
        if ![energy, momentum][n] {
            continue;
        }
        let finding = Finding::new(Problem::Free, Law::Rounding, quantity, "walks");
        findings.push(match &long {
            // what is lost in exact arithmetic is lost by no rounding
            _ if !is_kept(quantity) => {
                finding.because(format!("not conserved to {EXACT:e} in exact arithmetic"))
            }
            Some(Ok(errors)) => {
                let limit = if subject.claims.to_residual { RESIDUALS } else { WALK };
                finding.judged(true, errors[n], limit, limit)
            }
            Some(Err(error)) => finding.verdict(Verdict::False).because(error.to_string()),
            None => ensemble(subject.method, finding)?,
        });
    }
    Ok(findings)
}

/// Largest relative errors of energy and |m| over the steps.
fn worst(subject: &Subject<'_>) -> Result<Result<[f64; 2], RunError>, LawsError> {
    let body = Body::free(Inertia::from_moments([1.0, 2.0, 3.0])?);
    let start = body.state(Default::default(), [0.4, 1.0, -0.3].into())?;
    let run = || {
        let end = Run::new(subject.method, &body, &start, 0.1)?.advance_to(STEPS)?;
        let error = |error: Option<f64>| error.unwrap_or(f64::NAN);
        Ok([error(end.worst.energy), error(end.worst.momentum_norm)])
    };
    Ok(run())
}

/// Asymmetric bodies whose mean is compared with their scatter.
const MEMBERS: u32 = 64;

/// Their mean is that of a walk up to this part of their root mean square: 3.2 standard deviations of such a mean.
const MEAN: f64 = 0.4;

/// What rounding makes of |m| over an ensemble of bodies, of methods whose energy moves: some walk by whole roundings a step,
/// which in one run looks like a bias.
fn ensemble(method: &dyn AnyMethod, finding: Finding) -> Result<Finding, LawsError> {
    let errors: Vec<f64> = (0..MEMBERS).map(|member| of_member(method, member)).collect::<Result<_, _>>()?;
    let average = |f: fn(f64) -> f64| errors.iter().map(|e| f(*e)).sum::<f64>() / f64::from(MEMBERS);
    let (mean, rms) = (average(|e| e), average(|e| e * e).sqrt());
    let finding = Finding { measured: number(mean), limit: number(MEAN * rms), ..finding };
    Ok(match () {
        _ if mean.abs() <= MEAN * rms => finding.verdict(Verdict::Holds),
        _ => finding.verdict(Verdict::False),
    })
}

/// The relative change of |m| of one body of the ensemble.
fn of_member(method: &dyn AnyMethod, member: u32) -> Result<f64, LawsError> {
    // multiples of the golden section modulo 1: bodies of every shape, momenta of every direction
    let number = |k: u32| (f64::from(7 * member + k) * 0.618_033_988_749_894_9).fract();
    let second = [1, 2, 3].map(|k| 0.1 + number(k));
    let moments = [second[1] + second[2], second[2] + second[0], second[0] + second[1]];
    let body = Body::free(Inertia::from_moments(moments)?);
    let start = Point::new(Quat::identity(), Vec3([4, 5, 6].map(|k| 2.0 * number(k) - 1.0)));
    let mut x = start;
    method.prepare_f64(Clock::new(0.015_625), &body)?.steps(&mut x, 20_000);
    let [before, after] = [start, x].map(|x| x.to_dd().momentum_body.norm());
    Ok(((after - before) / before).hi())
}

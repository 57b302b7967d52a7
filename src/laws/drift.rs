//! The energy error over a long time: bounded by a power of the step, or drifting.

use super::LawsError;
use super::conserved::worst_energy;
use super::finding::{Finding, number};
use super::subject::Subject;
use super::words::{Law, Quantity, Verdict};
use crate::body::{Clock, Conserved, Point, Problem};
use crate::method::Energy;
use crate::num::{Dd, Real};
use crate::observe::{Drift, secular_drift};
use crate::rotation::Quat;

/// For how long a bounded error is watched, s.
const LONG: f64 = 250.0;

/// Of motions that conserve the energy, and of methods that do not keep it to the last digit.
pub(super) fn measure(subject: &Subject<'_>) -> Result<Vec<Finding>, LawsError> {
    if !subject.case.body.conserved().contains(&Conserved::Energy) {
        return Ok(Vec::new());
    }
    match (subject.claims.kept.energy, subject.claims.order) {
        (Energy::Bounded, Some(order)) => bounded(subject, order),
        (Energy::Drifts, _) if !subject.is_to_rounding() => drifting(subject),
        _ => Ok(Vec::new()),
    }
}

fn bounded(subject: &Subject<'_>, order: u32) -> Result<Vec<Finding>, LawsError> {
    let problem = subject.problem();
    let h = match (problem, order) {
        (_, ..6) => 0.0625,
        (Problem::Free, _) => 0.125,
        _ => 0.03125,
    };
    let (span, tolerance) = if problem == Problem::Free { (100.0, 0.05) } else { (50.0, 0.2) };
    let amplitude = |h: f64| worst_energy(subject, h, (span / h) as u64);
    let (coarse, fine) = (amplitude(h)?, amplitude(h / 2.0)?);
    let slope = libm::log2(coarse / fine);
    let holds = (slope - f64::from(order)).abs() < tolerance;
    let amplitude = Finding {
        measured: number(slope),
        limit: Some(tolerance),
        verdict: if holds { Verdict::Holds } else { Verdict::False },
        ..Finding::new(problem, Law::Drift, Quantity::Amplitude, format!("h^{order}"))
    };
    let [drift, half_width] = mean_drift(subject, h)?;
    let (verdict, why) = match () {
        // NaN does not hold
        _ if drift.abs() < half_width && half_width * LONG < 0.2 * coarse => (Verdict::Holds, ""),
        _ if drift.abs() < half_width => {
            (Verdict::Undecided, "the interval is wider than a fifth of the amplitude in the time watched")
        }
        _ => (Verdict::False, ""),
    };
    let secular = Finding {
        measured: number(drift),
        half_width: number(half_width),
        verdict,
        ..Finding::new(problem, Law::Drift, Quantity::Energy, "bounded")
    };
    Ok(vec![amplitude, secular.because(why)])
}

/// The mean slope of the relative energy error over [`LONG`] from some starts, and half of the interval that holds it
/// with 99.9 %, so that one method of a thousand is found to drift by chance. The motion in the potential is not periodic: a
/// bounded error wanders with it for as long as the span, and only more starts tell that from a drift.
fn mean_drift(subject: &Subject<'_>, h: f64) -> Result<[f64; 2], LawsError> {
    // and Student's quantile for one less
    let (starts, student) = if subject.problem() == Problem::Potential { (36, 3.591) } else { (12, 4.437) };
    let slope = |n: usize| {
        let (sin, cos) = Real::sin_cos(0.7 * n as f64);
        let turn = Quat::<Dd>::of(Quat::from_components([1.0, sin, cos, sin * cos])).normalized();
        let Point { attitude, momentum_body, .. } = subject.case.start;
        let start = Point::new(turn * attitude, turn.rotate(momentum_body));
        Ok(secular(subject, start, h, (LONG / h) as u64)?.slope)
    };
    let slopes: Vec<f64> = (0..starts).map(slope).collect::<Result<_, LawsError>>()?;
    let mean = slopes.iter().sum::<f64>() / starts as f64;
    let squares: f64 = slopes.iter().map(|slope| (slope - mean) * (slope - mean)).sum();
    let deviation = (squares / (starts * (starts - 1)) as f64).sqrt();
    Ok([mean, student * deviation])
}

fn drifting(subject: &Subject<'_>) -> Result<Vec<Finding>, LawsError> {
    // small steps for first-order methods: at larger ones the error soon is no longer small
    let (h, steps) = match subject.claims.order {
        Some(1) => (0.000_976_562_5, 64_000),
        _ => (subject.telling_step(0.0625), 16_000),
    };
    let drift = secular(subject, subject.case.start, h, steps)?;
    let finding = Finding {
        measured: number(drift.slope),
        half_width: number(drift.half_width),
        ..Finding::new(subject.problem(), Law::Drift, Quantity::Energy, "drifts")
    };
    Ok(vec![if drift.is_secular() {
        finding.verdict(Verdict::Holds)
    } else {
        finding.because(format!("no drift is seen in {steps} steps of {h} s"))
    }])
}

/// Secular drift of the relative energy error over `steps` steps in double precision.
fn secular(subject: &Subject<'_>, start: Point<Dd>, h: f64, steps: u64) -> Result<Drift, LawsError> {
    let case = subject.case;
    let mut x = start.to_f64();
    let before = case.energy(&x.to_dd());
    let mut step = subject.method.prepare_f64(Clock::new(h), &case.body)?;
    step.open(&mut x);
    let error = |_| {
        step.advance(&mut x, 1);
        (case.energy(&step.reading(&x).to_dd()) / before - Dd::ONE).hi()
    };
    let series: Vec<f64> = (0..steps).map(error).collect();
    let times: Vec<f64> = (0..steps).map(|n| n as f64 * h).collect();
    let unknown = Drift { slope: f64::NAN, half_width: f64::NAN };
    Ok(secular_drift(&times, &series).unwrap_or(unknown))
}

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

/// The energy is read after every fourth step: to read it takes as long as some steps. What comes back in so many steps is not seen.
const EVERY: u64 = 4;

/// From so many starts the slope of the energy error is averaged, from the second number where the interval of the first is too wide:
/// a motion that is not periodic lets a bounded error wander for as long as the span, and only more starts tell that from a
/// drift. Beside it Student's quantile for one less, so that the interval holds the mean with 99.9 %.
const STARTS: [(usize, f64); 2] = [(12, 4.437), (36, 3.591)];

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

/// A thousandth of a rounding: what a step of a method may lose for good by rounding, relative to the energy.
const BIAS: f64 = 1e-3 * f64::ROUNDOFF;

fn bounded(subject: &Subject<'_>, order: u32) -> Result<Vec<Finding>, LawsError> {
    let problem = subject.problem();
    let h = match (problem, order) {
        (_, ..6) => 0.0625,
        (Problem::Free, _) => 0.125,
        _ => 0.03125,
    };
    let (span, tolerance) = if problem == Problem::Free { (100.0, 0.05) } else { (50.0, 0.2) };
    // read at the same times
    let amplitude = |h: f64, every: u64| worst_energy(subject, h, (span / h) as u64 / every, every);
    let (coarse, fine) = (amplitude(h, 2)?, amplitude(h / 2.0, 4)?);
    let slope = libm::log2(coarse / fine);
    let holds = (slope - f64::from(order)).abs() < tolerance;
    let amplitude = Finding {
        measured: number(slope),
        limit: Some(tolerance),
        verdict: if holds { Verdict::Holds } else { Verdict::False },
        ..Finding::new(problem, Law::Drift, Quantity::Amplitude, format!("h^{order}"))
    };
    // there starts scatter by more than a fifth of the amplitude in the time watched
    if problem == Problem::GyrostatPotential {
        return Ok(vec![amplitude]);
    }
    let mut slopes = Vec::new();
    let ([drift, half_width], is_narrow) = loop {
        let (starts, student) = STARTS[usize::from(!slopes.is_empty())];
        while slopes.len() < starts {
            slopes.push(slope_from(subject, slopes.len(), h)?);
        }
        let mean = mean_with_interval(&slopes, student);
        let is_narrow = mean[1] * LONG < 0.2 * coarse;
        if is_narrow || starts == STARTS[1].0 {
            break (mean, is_narrow);
        }
    };
    let (verdict, why) = match () {
        // NaN does not hold
        _ if drift.abs() < half_width && is_narrow => (Verdict::Holds, ""),
        // the runs are in doubles
        _ if (drift.abs() + half_width) * h < BIAS => (Verdict::Holds, ""),
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

/// The slope of the relative energy error over [`LONG`] from the start with this number.
fn slope_from(subject: &Subject<'_>, number: usize, h: f64) -> Result<f64, LawsError> {
    let (sin, cos) = Real::sin_cos(0.7 * number as f64);
    let turn = Quat::<Dd>::of(Quat::from_components([1.0, sin, cos, sin * cos])).normalized();
    let Point { attitude, momentum_body, .. } = subject.case.start;
    let start = Point::new(turn * attitude, turn.rotate(momentum_body));
    Ok(secular(subject, start, h, (LONG / h) as u64)?.slope)
}

/// The mean and `student` times its deviation.
fn mean_with_interval(slopes: &[f64], student: f64) -> [f64; 2] {
    let n = slopes.len() as f64;
    let mean = slopes.iter().sum::<f64>() / n;
    let squares: f64 = slopes.iter().map(|slope| (slope - mean) * (slope - mean)).sum();
    [mean, student * (squares / (n * (n - 1.0))).sqrt()]
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

/// Secular drift of the relative energy error over `steps` steps in double precision, of every fourth.
fn secular(subject: &Subject<'_>, start: Point<Dd>, h: f64, steps: u64) -> Result<Drift, LawsError> {
    let case = subject.case;
    let mut x = start.to_f64();
    let before = case.energy(&x.to_dd());
    let mut step = subject.method.prepare_f64(Clock::new(h), &case.body)?;
    step.open(&mut x);
    let error = |_| {
        step.advance(&mut x, EVERY);
        (case.energy(&step.reading(&x).to_dd()) / before - Dd::ONE).hi()
    };
    let series: Vec<f64> = (0..steps / EVERY).map(error).collect();
    let times: Vec<f64> = (0..steps / EVERY).map(|n| (n * EVERY) as f64 * h).collect();
    let unknown = Drift { slope: f64::NAN, half_width: f64::NAN };
    Ok(secular_drift(&times, &series).unwrap_or(unknown))
}

//! From a reading to a verdict.

use super::columns::{Columns, Source};
use super::conservation::conservation;
use super::detective::Finding;
use super::deviation::{deviation, trace};
use super::faults::faults;
use super::resolution::Writing;
use super::signature::{flips, signature as signature_of};
use super::states::{Quantities, states};
use super::{
    AuditError, Fault, Frame, Judgement, Missing, Question, Reading, Resolution, Suspect, Tie, TieReason,
    Trajectory, Verdict,
};
use crate::body::{Body, Problem};
use crate::flow::FreeMotion;
use crate::inertia::Symmetry;
use crate::num::Dd;
use crate::rotation::{Quat, Vec3};

/// The verdict on `record`, of which `finding` is known.
pub(super) fn judge(
    record: &Trajectory,
    question: &Question,
    finding: Finding,
) -> Result<Verdict, AuditError> {
    let first = finding.right.first().ok_or(AuditError::NoReading)?;
    let (mut reading, body) = (first.reading, first.body.clone());
    let writing = Writing::of(record);
    let rounding = writing.rounding();
    let angle_rounding = record.attitude.as_ref().map_or(0.0, |attitude| attitude.rounding_angle(rounding));
    let tolerance = question.tolerance;
    let fits = question.body.is_none();
    let deviation = deviation(record, &reading, &body, fits, tolerance, [angle_rounding, rounding]);
    let noise = deviation.as_ref().map_or(rounding, |found| found.attitude_noise.max(found.rates_noise));
    let free = body.problem() == Problem::Free;
    // the tensor of a record that is right comes from all of its rows
    let fitted_body = deviation.as_ref().filter(|found| fits && found.judgement == Judgement::Right);
    let body = fitted_body.map_or(body, |found| found.start.body.clone());
    let numbers: Vec<usize> = (0..record.times.len()).collect();
    let has_omega = Columns::new(record).source != Source::Attitude;
    let every = if free && has_omega { states(record, &reading, &body, &numbers) } else { Vec::new() };
    let (conservation, mut traces) = conservation(record, &reading, &body, tolerance, rounding, &every);
    let faults = faults(record, &reading, &writing, tolerance, rounding);
    let by_motion = deviation.as_ref().map_or(Judgement::Undecided, |found| found.judgement);
    let claim = broken_claim(&reading, &finding, question);
    let mut signature = None;
    let suspect = match (&finding.mistake, claim) {
        (Some(mistake), _) if by_motion != Judgement::Right => mistake.suspect.clone(),
        (_, Some(claim)) => claim,
        _ if by_motion != Judgement::Wrong => Suspect::None,
        _ if faults.iter().any(|fault| matches!(fault, Fault::Discontinuity { .. })) => {
            Suspect::Discontinuity
        }
        _ => {
            signature = signature_of(record, &reading, &body, noise);
            signature.as_ref().map_or(Suspect::None, |found| Suspect::Integrator(found.method.clone()))
        }
    };
    let judgement = if suspect == Suspect::None { by_motion } else { Judgement::Wrong };
    let counted = deviation.as_ref().filter(|_| free && has_omega);
    let flips = counted.map(|found| flips(&every, &body, found.rates_noise));
    let end = record.times[record.times.len() - 1] - record.times[0];
    let flips_exact = counted.and_then(|found| {
        let start = &found.start;
        let inside =
            start.body.enter_omega(start.row.attitude.unwrap_or(Quat::identity()), start.row.omega).ok()?;
        Some(FreeMotion::from_point(start.body.inertia(), inside).flips(Dd::from(end)))
    });
    if let Some(found) = deviation.as_ref().filter(|_| record.attitude.is_some()) {
        traces.attitude = trace(record, &reading, &found.start, &traces.times);
    }
    let tie = (finding.tied > 1).then(|| Tie {
        readings: finding.right[..finding.tied].iter().map(|found| found.reading).collect(),
        reason: tie_reason(record, &finding, &body),
    });
    let resolution = Resolution {
        attitude: record.attitude.as_ref().map(|_| {
            deviation.as_ref().map_or(angle_rounding, |found| found.attitude_noise.max(angle_rounding))
        }),
        rates: record
            .rates
            .as_ref()
            .map(|_| deviation.as_ref().map_or(rounding, |found| found.rates_noise.max(rounding))),
        digits: writing.digits,
        single_precision: writing.single_precision,
    };
    if record.rates.is_some() && record.momentum.is_some() {
        reading.momentum_frame = momentum_frame(record, &reading, &body);
    }
    let missing = [
        (record.attitude.is_none(), Missing::Attitude),
        (record.rates.is_none() && record.momentum.is_none(), Missing::Rates),
        (question.body.is_none(), Missing::Body),
    ];
    Ok(Verdict {
        judgement,
        suspect,
        reading,
        ranking: finding.ranking,
        tie,
        body,
        resolution,
        conservation,
        attitude_error: deviation.and_then(|found| found.error),
        flips,
        flips_exact,
        signature,
        faults,
        missing: missing.into_iter().filter(|(lacks, _)| *lacks).map(|(_, what)| what).collect(),
        traces,
    })
}

/// Why the first readings fit alike.
fn tie_reason(record: &Trajectory, finding: &Finding, body: &Body) -> TieReason {
    let tied = &finding.right[..finding.tied];
    let first = tied[0].reading;
    let by_moments = tied.iter().all(|found| Reading { moments: first.moments, ..found.reading } == first);
    if by_moments && body.inertia().symmetry() != Symmetry::Asymmetric {
        return TieReason::SymmetricBody;
    }
    let every: Vec<usize> = (0..record.times.len()).step_by(record.times.len().div_ceil(100)).collect();
    let rows = states(record, &first, body, &every);
    let start = rows.first().map_or(Vec3::zero(), |row| row.omega);
    let turned = rows.iter().fold(0.0_f64, |most, row| {
        most.max(row.omega.cross(start).norm() / (row.omega.norm() * start.norm()).max(f64::MIN_POSITIVE))
    });
    if turned < 0.05 {
        TieReason::PureSpin
    } else if record.attitude.is_none() || (record.rates.is_none() && record.momentum.is_none()) {
        TieReason::MissingColumns
    } else {
        TieReason::Noise
    }
}

/// The frame in which the momenta agree better with I ω.
fn momentum_frame(record: &Trajectory, reading: &Reading, body: &Body) -> Option<Frame> {
    let count = record.times.len();
    let quantities = Quantities::new(body);
    let every: Vec<usize> = (0..count).step_by(count.div_ceil(200)).collect();
    let rows = states(record, reading, body, &every);
    let off = |frame: Frame| -> f64 {
        let read = Reading { momentum_frame: Some(frame), ..*reading };
        let sines = rows.iter().filter_map(|row| {
            let measured = read.momentum_body(record, row.row)?;
            let expected = quantities.momentum(row);
            Some(measured.cross(expected).norm() / (measured.norm() * expected.norm()).max(f64::MIN_POSITIVE))
        });
        sines.sum()
    };
    if record.attitude.is_none() || off(Frame::Body) < off(Frame::Space) {
        Some(Frame::Body)
    } else {
        Some(Frame::Space)
    }
}

/// The claim of the question that the reading contradicts.
fn broken_claim(reading: &Reading, finding: &Finding, question: &Question) -> Option<Suspect> {
    let claims = &question.claims;
    let moments_hold =
        |claimed| finding.right[..finding.tied].iter().any(|found| found.reading.moments == claimed);
    let differs = |claimed: bool, same: bool| claimed && !same;
    if differs(claims.attitude.is_some(), claims.attitude == reading.attitude) && reading.attitude.is_some() {
        return Some(Suspect::Transposed);
    }
    let frames = [(claims.omega_frame, reading.omega_frame), (claims.momentum_frame, reading.momentum_frame)];
    if frames.iter().any(|(claimed, read)| claimed.is_some() && read.is_some() && claimed != read) {
        return Some(Suspect::OmegaFrame);
    }
    if claims.rate_unit.is_some() && reading.rate_unit.is_some() && claims.rate_unit != reading.rate_unit {
        return Some(Suspect::Degrees);
    }
    if question.body.is_some() && claims.moments.is_some_and(|claimed| !moments_hold(claimed)) {
        return Some(Suspect::MomentsOrder);
    }
    None
}

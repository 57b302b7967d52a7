//! From a reading to a verdict.

use super::conservation::conservation;
use super::detective::Finding;
use super::resolution::Writing;
use super::{
    AuditError, Judgement, Missing, Question, Reading, Resolution, Suspect, Tie, TieReason, Trajectory,
    Verdict,
};

/// The verdict on `record`, of which `finding` is known.
pub(super) fn judge(
    record: &Trajectory,
    question: &Question,
    finding: Finding,
) -> Result<Verdict, AuditError> {
    let first = finding.right.first().ok_or(AuditError::NoReading)?;
    let (reading, body) = (first.reading, first.body.clone());
    let writing = Writing::of(record);
    let rounding = writing.rounding();
    let tolerance = question.tolerance;
    let (conservation, traces) = conservation(record, &reading, &body, tolerance, rounding);
    let conserved = conservation.iter().all(|kept| kept.conserved);
    let claim = broken_claim(&reading, question);
    let suspect = match (&finding.mistake, claim) {
        (Some(mistake), _) => mistake.suspect.clone(),
        (None, Some(claim)) => claim,
        (None, None) => Suspect::None,
    };
    let judgement = if suspect == Suspect::None && conserved { Judgement::Right } else { Judgement::Wrong };
    let tie = (finding.tied > 1).then(|| Tie {
        readings: finding.right[..finding.tied].iter().map(|found| found.reading).collect(),
        reason: TieReason::Noise,
    });
    let resolution = Resolution {
        attitude: record.attitude.as_ref().map(|attitude| attitude.rounding_angle(rounding)),
        rates: record.rates.as_ref().map(|_| rounding),
        digits: writing.digits,
        single_precision: writing.single_precision,
    };
    let mut missing = Vec::new();
    if record.attitude.is_none() {
        missing.push(Missing::Attitude);
    }
    if record.rates.is_none() && record.momentum.is_none() {
        missing.push(Missing::Rates);
    }
    if question.body.is_none() {
        missing.push(Missing::Body);
    }
    Ok(Verdict {
        judgement,
        suspect,
        reading,
        ranking: finding.ranking,
        tie,
        body,
        resolution,
        conservation,
        attitude_error: None,
        flips: None,
        flips_exact: None,
        signature: None,
        faults: Vec::new(),
        missing,
        traces,
    })
}

/// The claim of the question that the reading contradicts.
fn broken_claim(reading: &Reading, question: &Question) -> Option<Suspect> {
    let claims = &question.claims;
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
    if question.body.is_some() && claims.moments.is_some_and(|claimed| claimed != reading.moments) {
        return Some(Suspect::MomentsOrder);
    }
    None
}

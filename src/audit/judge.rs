//! From a reading to a verdict.

use core::f64::consts::FRAC_PI_2;

use super::as_written::off_in_space;
use super::bodies::Told;
use super::columns::{Columns, Source, angle_between};
use super::conservation::conservation;
use super::detective::Finding;
use super::deviation::{Allowances, deviation, trace};
use super::exchanged::exchanged;
use super::faults::{discontinuity, faults, no_rotation, unit_of_times};
use super::lag::lag;
use super::misplaced::misplaced;
use super::other_body::other_body as other_body_of;
use super::other_torque::other_torque as other_torque_of;
use super::other_wheel::other_wheel as other_wheel_of;
use super::question::{MOST, contradicts};
use super::resolution::{Writing, Writings, rounding_turn, triples};
use super::rows::typical_turn;
use super::signature::signature as signature_of;
use super::states::{Quantities, states};
use super::sweep::Allowance;
use super::{
    AuditError, Fault, Frame, Judgement, Missing, Noise, OtherBody, OtherTorque, OtherWheel, Question,
    Reading, Resolution, Signature, Suspect, Tie, TieReason, Trajectory, Verdict,
};
use crate::body::{Body, Problem};
use crate::inertia::Symmetry;
use crate::record::median;
use crate::rotation::Vec3;

/// An angular velocity between two attitudes, relative, is off by at most so many times what one of them is, over the turn.
const DERIVED: f64 = 3.0;

/// Groups of three rows that the size of ω is read off.
const LOOKS: usize = 128;

/// The part of their unit that rounded times are off: half of it, and a tenth for the start that is fitted to them.
const ROUNDED: f64 = 0.6;

/// The verdict on `record`, of which `finding` is known.
///
/// Of readings that cannot be told apart the one counts whose motion stays nearest: of a pure spin the moments can be read in any
/// order, and in some of them it is unstable, so that the noise of the start grows.
pub(super) fn judge(
    record: &Trajectory,
    question: &Question,
    mut finding: Finding,
) -> Result<Verdict, AuditError> {
    let mut best = judge_first(record, question, &finding)?;
    let mut tried = vec![finding.right[0].reading.moments];
    for k in 1..finding.tied {
        let moments = finding.right[k].reading.moments;
        if best.judgement == Judgement::Right || tried.contains(&moments) {
            continue;
        }
        tried.push(moments);
        finding.right.swap(0, k);
        let other = judge_first(record, question, &finding)?;
        finding.right.swap(0, k);
        if other.judgement.is_better_than(best.judgement) {
            best = other;
        }
    }
    Ok(best)
}

/// The verdict by the first reading.
fn judge_first(record: &Trajectory, question: &Question, finding: &Finding) -> Result<Verdict, AuditError> {
    let first = finding.right.first().ok_or(AuditError::NoReading)?;
    let (mut reading, body) = (first.reading, first.body.clone());
    if record.rates.is_some() && record.momentum.is_some() {
        reading.momentum_frame = momentum_frame(record, &reading, &body);
    }
    let writings = Writings::of(record);
    let rounding = writings.rates.rounding().max(writings.momentum.rounding());
    let angle_rounding = rounding_turn(record, &reading, writings.attitude);
    let tolerance = question.tolerance;
    let fits = question.body.is_none();
    let mut allowances = allowances(record, &reading, &body, question, &writings, angle_rounding);
    let told = question.told();
    let mut if_rounded = None;
    if is_one_vector(record) {
        if_rounded = deviation(record, &reading, &body, told.as_ref(), fits, &allowances);
        for allowance in [&mut allowances.rates, &mut allowances.momentum] {
            *allowance = Allowance::of(tolerance, 0.5 * f64::EPSILON, allowance.noise);
        }
    }
    let deviation = deviation(record, &reading, &body, told.as_ref(), fits, &allowances);
    let noise = deviation.as_ref().map_or(rounding, |found| found.attitude_noise.max(found.rates_noise));
    let free = body.problem() == Problem::Free;
    // of a record that is right the tensor, and the momenta of wheels, come from all of its rows
    let follows = fits || told.is_some();
    let fitted_body = deviation.as_ref().filter(|found| follows && found.judgement == Judgement::Right);
    let body = fitted_body.map_or(body, |found| found.start.body.clone());
    let has_omega = Columns::new(record).source != Source::Attitude;
    let rows = record.times.len();
    let of_rates = if record.rates.is_some() { allowances.rates } else { allowances.momentum };
    let off = [allowances.attitude.largest(rows), of_rates.largest(rows)];
    // angular velocities that attitudes are divided into are off by what both ends of a window are, over its turn
    let off =
        if has_omega { off } else { [off[0], off[1].max(DERIVED * off[0] / window_turn(record, &reading))] };
    let (conservation, mut traces) = conservation(record, &reading, &body, off);
    let by_motion = deviation.as_ref().map_or(Judgement::Undecided, |found| found.judgement);
    // a record every row of which is that of the motion keeps what the motion keeps, flips as often, and does not jump
    let contradicted = conservation.iter().any(|kept| !kept.conserved)
        || deviation.as_ref().is_some_and(|found| has_omega && found.flips[0] != found.flips[1]);
    // noise of the entries of a matrix changes its lengths by half as much again as it turns it
    let no_rotation = no_rotation(record, 2.0 * allowances.attitude.largest(rows));
    let off_as_written = || {
        let found = deviation.as_ref().filter(|_| by_motion == Judgement::Right);
        found
            .is_some_and(|found| off_in_space(record, &reading, found, told.as_ref(), &writings, &allowances))
    };
    let contradicted = contradicted || no_rotation.is_some() || off_as_written();
    let mut by_motion =
        if by_motion == Judgement::Right && contradicted { Judgement::Undecided } else { by_motion };
    if by_motion == Judgement::Wrong && if_rounded.is_some_and(|found| found.judgement != Judgement::Wrong) {
        by_motion = Judgement::Undecided;
    }
    let mut faults = faults(record, &reading, &writings.coarsest(), tolerance);
    faults.extend(no_rotation);
    if deviation.is_none() && !free {
        faults.push(Fault::NotFollowed);
    }
    if by_motion == Judgement::Right
        && !has_omega
        && let Some(fault) = too_little(record, &reading, &allowances.attitude)
    {
        by_motion = Judgement::Undecided;
        faults.push(fault);
    }
    // of attitudes alone nobody knows which way they turn from row to row, nor how often
    let angle = finding.way.unwrap_or_else(|| if has_omega { 0.0 } else { typical_turn(record) });
    if by_motion == Judgement::Wrong && angle > FRAC_PI_2 {
        by_motion = Judgement::Undecided;
        faults.retain(|fault| !matches!(fault, Fault::TooCoarse { .. }));
        faults.push(Fault::TooCoarse { angle });
    }
    // rates alone lead a search for the body astray now and then
    if by_motion == Judgement::Wrong && fits && record.attitude.is_none() {
        by_motion = Judgement::Undecided;
        faults.push(Fault::NoBodyFound);
    }
    if by_motion != Judgement::Right {
        faults.extend(discontinuity(record, &reading, rounding));
        if let Some(found) = &deviation {
            match exchanged(record, &reading, &body, told.as_ref(), &allowances) {
                Some(fault) => {
                    // each row is another's, whatever noise would hide
                    by_motion = Judgement::Wrong;
                    faults.push(fault);
                }
                None => faults.extend(misplaced(record, &reading, found, &allowances)),
            }
        }
    }
    let claim = broken_claim(&reading, finding, question).filter(|_| finding.way.is_none());
    let mut explained = Explained::default();
    let suspect = match (&finding.mistake, claim) {
        // what noise explains needs no mistake
        (Some(mistake), _) if by_motion == Judgement::Wrong => mistake.suspect.clone(),
        (_, Some(claim)) => claim,
        _ if by_motion != Judgement::Wrong => Suspect::None,
        _ if faults.iter().any(|fault| matches!(fault, Fault::Discontinuity { .. })) => {
            Suspect::Discontinuity
        }
        _ => {
            let limits = (off[0] + off[1], noise);
            explained = explanation(record, &reading, &body, question, told.as_ref(), &allowances, limits);
            explained.suspect()
        }
    };
    if by_motion == Judgement::Wrong && suspect == Suspect::None {
        faults.extend(lag(record, &reading, &body, told.as_ref(), &allowances));
    }
    let judgement = if suspect == Suspect::None { by_motion } else { Judgement::Wrong };
    let counted = deviation.as_ref().filter(|_| free && has_omega);
    let flips = counted.map(|found| found.flips[0]);
    let flips_exact = counted.map(|found| found.flips[1]);
    if let Some(found) = deviation.as_ref().filter(|_| record.attitude.is_some()) {
        traces.attitude = trace(record, &reading, &found.start, &traces.times);
    }
    let tie = (finding.tied > 1).then(|| Tie {
        readings: finding.right[..finding.tied].iter().map(|found| found.reading).collect(),
        reason: match tie_reason(record, finding, &body) {
            TieReason::Noise if by_motion == Judgement::Wrong => TieReason::Misfit,
            reason => reason,
        },
    });
    let resolution = Resolution {
        attitude: record.attitude.as_ref().map(|_| {
            let rounding = allowances.attitude.rounding;
            deviation.as_ref().map_or(rounding, |found| found.attitude_noise.max(rounding))
        }),
        rates: record
            .rates
            .as_ref()
            .map(|_| deviation.as_ref().map_or(rounding, |found| found.rates_noise.max(rounding))),
        digits: writings.coarsest().digits,
        single_precision: writings.coarsest().single_precision,
    };
    let noise =
        deviation.as_ref().filter(|found| judgement == Judgement::Undecided && found.is_noisy).map(|found| {
            Noise {
                attitude: if record.attitude.is_some() { found.attitude_noise } else { 0.0 },
                // attitudes alone have none of an angular velocity
                rates: if has_omega { found.rates_noise * found.size } else { 0.0 },
            }
        });
    let missing = [
        (record.attitude.is_none(), Missing::Attitude),
        (record.rates.is_none() && record.momentum.is_none(), Missing::Rates),
        (question.body.is_none(), Missing::Body),
    ];
    let Explained { signature, other_body, other_torque, other_wheel } = explained;
    Ok(Verdict {
        judgement,
        suspect,
        reading,
        ranking: finding.ranking.clone(),
        tie,
        body,
        resolution,
        noise,
        conservation,
        attitude_error: deviation.and_then(|found| found.error),
        flips,
        flips_exact,
        signature,
        other_body,
        other_torque,
        other_wheel,
        faults,
        missing: missing.into_iter().filter(|(lacks, _)| *lacks).map(|(_, what)| what).collect(),
        traces,
    })
}

/// What explains a record that is wrong beside mistakes in it: one at most.
#[derive(Default)]
struct Explained {
    signature: Option<Signature>,
    other_body: Option<OtherBody>,
    other_torque: Option<OtherTorque>,
    other_wheel: Option<OtherWheel>,
}

impl Explained {
    fn suspect(&self) -> Suspect {
        match self {
            Explained { signature: Some(found), .. } => Suspect::Integrator(found.method.clone()),
            Explained { other_body: Some(_), .. } => Suspect::OtherBody,
            Explained { other_torque: Some(_), .. } => Suspect::OtherTorque,
            Explained { other_wheel: Some(_), .. } => Suspect::OtherWheel,
            _ => Suspect::None,
        }
    }
}

/// The first of them that explains the record; attitude and angular velocity together may be `off`, and have this `noise`.
fn explanation(
    record: &Trajectory,
    reading: &Reading,
    body: &Body,
    question: &Question,
    told: Option<&Told>,
    allowances: &Allowances,
    (off, noise): (f64, f64),
) -> Explained {
    let other_wheel = told.and_then(|told| other_wheel_of(record, reading, told, allowances));
    let mut found = Explained { other_wheel, ..Explained::default() };
    if found.other_wheel.is_none() {
        found.signature = signature_of(record, reading, body, noise);
    }
    if found.suspect() == Suspect::None {
        found.other_body = other_body_of(record, question, allowances);
    }
    if found.suspect() == Suspect::None {
        found.other_torque = other_torque_of(record, reading, body, off, noise);
    }
    found
}

/// How far the body turns over a window of a record of attitudes alone, typically, rad.
fn window_turn(record: &Trajectory, reading: &Reading) -> f64 {
    let windows = Columns::new(record).windows();
    let turn = |&start: &usize| {
        let ends = reading.attitude(record, start).zip(reading.attitude(record, start + windows.stride));
        ends.map_or(0.0, |(p, q)| angle_between(p, q))
    };
    let mut turns: Vec<f64> = windows.starts.iter().map(turn).collect();
    median(&mut turns).unwrap_or(0.0).max(f64::MIN_POSITIVE)
}

/// Whether angular velocities or momenta alone are the same in all rows: whether they are rounded is not to be seen.
fn is_one_vector(record: &Trajectory) -> bool {
    let stays = |vectors: &Option<Vec<[f64; 3]>>| {
        vectors.as_ref().is_none_or(|vectors| vectors.windows(2).all(|pair| pair[0] == pair[1]))
    };
    record.attitude.is_none() && stays(&record.rates) && stays(&record.momentum)
}

/// The fault of attitudes alone that hardly turn: what they may be off leaves more than a tenth of the angular velocity open.
fn too_little(record: &Trajectory, reading: &Reading, allowance: &Allowance) -> Option<Fault> {
    let first = reading.attitude(record, 0)?;
    let angle =
        |row| reading.attitude(record, row).map_or(0.0, |q| (first.conjugate() * q).logarithm().norm());
    let turn = (1..record.times.len()).map(angle).fold(0.0, f64::max);
    let open = allowance.exact.max(allowance.noise);
    (open > MOST * turn).then_some(Fault::TooLittle { turn, open })
}

/// What each column may be off.
fn allowances(
    record: &Trajectory,
    reading: &Reading,
    body: &Body,
    question: &Question,
    writings: &Writings,
    angle_rounding: f64,
) -> Allowances {
    let rows = states(record, reading, body, &triples(record.times.len(), LOOKS));
    let squares = rows.iter().map(|row| row.omega.norm_squared()).sum::<f64>() / rows.len().max(1) as f64;
    let size = squares.sqrt();
    let relative = if size > 0.0 { question.noise.rates / size } else { 0.0 };
    let of = |rounding: f64, noise: f64| Allowance::of(question.tolerance, rounding, noise);
    // what is in space is turned into the body by attitudes that are rounded as well
    let turned = |frame: Option<Frame>, rounding: f64| {
        if frame == Some(Frame::Space) { rounding + angle_rounding } else { rounding }
    };
    let rounding = |vectors: &Option<Vec<[f64; 3]>>, writing: &Writing| {
        vectors.as_ref().map_or(writing.rounding(), |vectors| writing.rounding_of(vectors))
    };
    let rates = rounding(&record.rates, &writings.rates);
    let momentum = rounding(&record.momentum, &writings.momentum);
    // a free body changes its angular velocity by no more of itself than it turns
    let fastest = rows.iter().map(|row| row.omega.norm()).fold(0.0, f64::max);
    let clock = unit_of_times(record).map_or(0.0, |unit| ROUNDED * unit * fastest);
    Allowances {
        tolerance: question.tolerance,
        attitude: of(angle_rounding + clock, question.noise.attitude),
        rates: of(turned(reading.omega_frame, rates) + clock, relative),
        momentum: of(turned(reading.momentum_frame, momentum) + clock, relative),
    }
}

/// Why the first readings fit alike.
fn tie_reason(record: &Trajectory, finding: &Finding, body: &Body) -> TieReason {
    let tied = &finding.right[..finding.tied];
    let first = tied[0].reading;
    let by_moments = tied.iter().all(|found| Reading { moments: first.moments, ..found.reading } == first);
    let symmetry = body.inertia().symmetry();
    // a sphere spins about one axis whatever is recorded
    if by_moments && symmetry != Symmetry::Asymmetric || symmetry == Symmetry::Spherical {
        return TieReason::SymmetricBody;
    }
    let every: Vec<usize> = (0..record.times.len()).step_by(record.times.len().div_ceil(100)).collect();
    let rows = states(record, &first, body, &every);
    // attitudes that turn beside rates that are zero
    if !rows.is_empty() && rows.iter().all(|row| row.omega.norm_squared() == 0.0) {
        return TieReason::Misfit;
    }
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
    let tied = &finding.right[..finding.tied];
    let moments_hold = |claimed| tied.iter().any(|found| found.reading.moments == claimed);
    // the axes and the moments have to be those that are claimed in one and the same reading
    let moments = claims.moments.filter(|_| question.body.is_some());
    let axes_hold = |claimed| {
        let both = |read: &Reading| {
            read.angle_axes() == Some(claimed) && moments.is_none_or(|moments| moments == read.moments)
        };
        tied.iter().any(|found| both(&found.reading))
    };
    if contradicts(claims.attitude, reading.attitude) {
        return Some(Suspect::Transposed);
    }
    let frames = [(claims.omega_frame, reading.omega_frame), (claims.momentum_frame, reading.momentum_frame)];
    if frames.iter().any(|(claimed, read)| contradicts(*claimed, *read)) {
        return Some(Suspect::OmegaFrame);
    }
    if contradicts(claims.rate_unit, reading.rate_unit) {
        return Some(Suspect::Degrees);
    }
    if moments.is_some_and(|claimed| !moments_hold(claimed)) {
        return Some(Suspect::MomentsOrder);
    }
    if reading.angles.is_some() && claims.angle_axes.is_some_and(|claimed| !axes_hold(claimed)) {
        return Some(Suspect::AnglesOrder);
    }
    None
}

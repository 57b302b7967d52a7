//! Evaluations of one step, against the cost that is claimed.
//!
//! Torques are counted of any method. Turns, flows and solutions are counted by the sines and roots that they take, on a scalar
//! that counts: of a method whose type is known.

use core::sync::atomic::{AtomicU64, Ordering};
use std::sync::Arc;

use super::case::{inertia, of_the_vertical, pushed};
use super::counted::{Counted, counts};
use super::counted_forces::{CountedGravity, CountedLaw};
use super::finding::Finding;
use super::subject::Subject;
use super::words::{Law, Quantity};
use super::{LawsError, Report};
use crate::body::{Body, Clock, Force, Free, LinearPotential, Point, Problem, Time};
use crate::inertia::Inertia;
use crate::method::{Claimed, Cost, Map, Method};
use crate::num::{Dd, Real};
use crate::rotation::{Quat, Vec3};

/// Torques of one step of a method whose type is not known.
pub(super) fn measure(subject: &Subject<'_>) -> Result<Vec<Finding>, LawsError> {
    let cost = subject.claims.cost;
    let claimed = torques_claimed(cost);
    let problem = subject.problem();
    let finding = |quantity, claimed: u32| Finding::new(problem, Law::Cost, quantity, claimed.to_string());
    let unseen = "counted of a method whose type is known: laws::check_cost";
    let mut findings = Vec::new();
    for (quantity, claimed) in [
        (Quantity::Turns, cost.turns),
        (Quantity::FreeFlows, cost.free_flows),
        (Quantity::Additions, cost.additions),
        (Quantity::Solves, cost.solves),
    ] {
        if claimed > 0 {
            findings.push(finding(quantity, claimed).because(unseen));
        }
    }
    let torques = finding(Quantity::Torques, claimed);
    let in_potential = problem != Problem::Linear || subject.method.claims(Problem::Potential).is_some();
    let undecided = match problem {
        Problem::Free | Problem::Gyrostat if claimed == 0 => return Ok(findings),
        Problem::Free | Problem::Gyrostat => Some(unseen),
        _ if !in_potential => Some(unseen),
        _ if subject.method.needs_series() => {
            Some("torques of a series are evaluated once for all its terms")
        }
        _ if subject.method.tolerance().is_some() => Some("the method chooses its steps"),
        _ if cost.solves > 0 && claimed == 0 => Some("an iteration asks for the torque as often as it needs"),
        _ => None,
    };
    findings.push(match undecided {
        Some(why) => torques.because(why),
        None => torques.counted(claimed, torques_of(subject)?),
    });
    Ok(findings)
}

/// Evaluations of the torque: with kicks the right-hand sides are those of free motion.
fn torques_claimed(cost: Cost) -> u32 {
    if cost.kicks > 0 { cost.kicks } else { cost.right_sides }
}

/// Evaluations of the torque in one step of the run; gravity acts as any potential does, whose torques can be counted.
fn torques_of(subject: &Subject<'_>) -> Result<u64, LawsError> {
    let torques = Arc::new(AtomicU64::new(0));
    let counting = torques.clone();
    let force = match subject.problem() {
        Problem::Torque => Force::torque("push", CountedLaw { law: pushed(), torques: counting }),
        _ => Force::potential("vertical", CountedLaw { law: of_the_vertical(), torques: counting }),
    };
    let body = Body::free(inertia()?).with(force);
    let mut x = subject.case.start.to_f64();
    let mut step = subject.method.prepare_f64(Clock::new(0.125), &body)?;
    step.open(&mut x);
    torques.store(0, Ordering::Relaxed);
    step.advance(&mut x, 1);
    Ok(torques.load(Ordering::Relaxed))
}

/// The evaluations of one step against the claimed ones, by kind, of a method whose type is known: free and under gravity.
///
/// A turn takes one sine, a solution of three equations one square root, for its Cayley map, a free flow of a symmetric body
/// two sines, an addition two square roots; a kick takes one torque, and so does a right-hand side of a method without kicks.
///
/// # Errors
/// None: the bodies are constants.
///
/// ```
/// use polhode::laws::check_cost;
/// use polhode::method::{Kicks, Splitting, TwoTurn};
/// let report = check_cost(&Splitting::strang(TwoTurn { axes: None }, Kicks))?;
/// assert_eq!(report.false_claims().count(), 0, "{report}");
/// # Ok::<(), polhode::Error>(())
/// ```
pub fn check_cost<M: Method<Counted> + Claimed>(method: &M) -> Result<Report, LawsError> {
    let mut report = Report::new(method.name());
    for problem in [Problem::Free, Problem::Linear] {
        if let Some(claims) = method.claims(problem) {
            report.findings.extend(of_kind(method, problem, claims.cost)?);
        }
    }
    Ok(report)
}

fn of_kind<M: Method<Counted>>(method: &M, problem: Problem, cost: Cost) -> Result<Vec<Finding>, LawsError> {
    let [sines, roots, torques] = evaluations(method, problem, [0.625, 0.75, 1.0])?;
    let finding = |quantity, claimed: u32, counted: u32| {
        Finding::new(problem, Law::Cost, quantity, claimed.to_string()).counted(claimed, counted.into())
    };
    let mut findings = Vec::new();
    if cost.free_flows > 0 {
        // of an asymmetric body their sines are those of elliptic functions
        let [sines, ..] = evaluations(method, problem, [0.75, 0.75, 1.0])?;
        let flow = finding(Quantity::FreeFlows, cost.free_flows, sines.div_ceil(2));
        findings.push(flow);
    } else {
        findings.push(finding(Quantity::Turns, cost.turns, sines));
        if cost.solves > 0 {
            findings.push(finding(Quantity::Solves, cost.solves, roots));
        }
        if cost.additions > 0 {
            findings.push(finding(Quantity::Additions, cost.additions, roots.div_ceil(2)));
        }
    }
    if problem == Problem::Linear {
        findings.push(finding(Quantity::Torques, torques_claimed(cost), torques));
    }
    Ok(findings)
}

/// Sines, square roots and torques of one step.
fn evaluations<M: Method<Counted>>(
    method: &M,
    problem: Problem,
    moments: [f64; 3],
) -> Result<[u32; 3], LawsError> {
    let rotor = Body::free(Inertia::from_moments(moments)?).rotor();
    let mut x = Point::new(Quat::identity(), Vec3([1.0, 0.5, -0.75].map(Counted)));
    let (h, at) = (Dd::of(0.125), Time::from_seconds(0.0));
    Ok(if problem == Problem::Free {
        let mut map = method.map(h, &rotor, &Free);
        map.open(at, &mut x);
        counts(|| map.advance(at, &mut x))
    } else {
        let gravity = LinearPotential { moment: Vec3([0.1, -0.2, 0.4].map(Counted)) };
        let mut map = method.map(h, &rotor, &CountedGravity(gravity));
        map.open(at, &mut x);
        counts(|| map.advance(at, &mut x))
    })
}

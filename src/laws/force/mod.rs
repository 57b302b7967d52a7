//! A force: whether its torque is the gradient of its potential, what it conserves, and whether its numbers are finite.

mod gradient;
mod invariants;

use super::finding::Finding;
use super::subject::largest;
use super::words::{Law, Quantity, Verdict};
use super::{LawsError, Report};
use crate::body::{Body, Force, Point, Problem, Time};
use crate::inertia::Inertia;
use crate::num::Dd;
use crate::rotation::{Quat, Vec3};

/// Attitudes at which a force is looked at.
const LOOKS: u32 = 8;

/// Limits of a law that is written for every scalar, and of closures, which are evaluated in double precision.
struct Limits {
    /// Differences are taken of turns by this angle, rad.
    turn: f64,
    /// Largest relative difference of torque and gradient.
    gradient: f64,
    /// Largest relative error of what is conserved.
    kept: f64,
    /// What is not conserved is lost by more.
    lost: f64,
}

const OF_A_TYPE: Limits = Limits { turn: 1.0 / 4096.0, gradient: 1e-16, kept: 1e-22, lost: 1e-10 };
const OF_CLOSURES: Limits = Limits { turn: 1.0 / 64.0, gradient: 1e-6, kept: 1e-8, lost: 1e-6 };

/// What `force` claims, measured as it acts on a body with the inertia `inertia`: its torque is −∂U/∂θ of its potential, by
/// central differences of order 6; what it says is conserved is constant along a motion, by Taylor series of order 40 in
/// double-double, of closures by a Runge–Kutta method of order 8; energy and torque are finite.
///
/// The motion turns as fast as the force can make the body turn, by some radians.
///
/// # Errors
/// A torque that is out of range beside the inertia.
///
/// ```
/// use nalgebra::Vector3;
/// use polhode::body::Force;
/// use polhode::inertia::Inertia;
/// use polhode::laws::{Law, check_force};
/// let inertia = Inertia::from_moments([1.0, 2.0, 2.5])?;
/// // a spring whose torque has the wrong sign
/// let spring = Force::potential_fn(
///     "spring",
///     |q| 0.5 * (1.0 - (q * Vector3::z()).z),
///     |q| -0.5 * Vector3::z().cross(&(q.inverse() * Vector3::z())),
/// );
/// let report = check_force(&spring, &inertia)?;
/// assert!(report.false_claims().any(|finding| finding.law == Law::Gradient), "{report}");
/// # Ok::<(), polhode::Error>(())
/// ```
pub fn check_force(force: &Force, inertia: &Inertia) -> Result<Report, LawsError> {
    let body = Body::free(inertia.clone()).with(force.clone());
    let mut report = Report::new(force.name());
    if body.problem() == Problem::Free {
        return Ok(report);
    }
    let limits = if force.series.is_some() { OF_A_TYPE } else { OF_CLOSURES };
    let points = looks(&body);
    let finite = finite(&body, &points);
    let is_finite = finite.iter().all(|finding| finding.verdict == Verdict::Holds);
    report.findings = finite;
    if is_finite && force.has_potential() {
        report.findings.push(gradient::measure(&body, &points, &limits));
        report.findings.extend(invariants::measure(&body, &points[0], force.series.is_some(), &limits)?);
    }
    Ok(report)
}

/// Points with attitudes in many directions, turning as fast as the torque makes the body turn.
fn looks(body: &Body) -> Vec<Point<Dd>> {
    let still = |n: u32| {
        // multiples of the golden section modulo 1
        let number = |k: u32| (f64::from(4 * n + k) * 0.618_033_988_749_894_9).fract() - 0.5;
        Point::new(Quat::of(Quat::from_components([1, 2, 3, 4].map(number))).normalized(), Vec3::zero())
    };
    let points: Vec<Point<Dd>> = (1..=LOOKS).map(still).collect();
    let torque = largest(points.iter().map(|x| body.torque_of(time(0), x).magnitude()));
    let moments = body.rotor().moments::<Dd>();
    let rate = if torque > 0.0 && torque.is_finite() { (torque / moments.magnitude()).sqrt() } else { 1.0 };
    let omega = Vec3([1.0, 0.5, -0.75]) * rate;
    let momentum = Vec3::of(omega).times(moments);
    points.into_iter().map(|x| Point::new(x.attitude, momentum)).collect()
}

/// When a force is looked at.
fn time(n: usize) -> Time {
    Time::from_seconds(0.7 * (n + 1) as f64)
}

fn finite(body: &Body, points: &[Point<Dd>]) -> Vec<Finding> {
    let bad = |is_bad: &dyn Fn(Time, &Point<Dd>) -> bool| {
        points.iter().enumerate().filter(|(n, x)| is_bad(time(*n), x)).count() as u64
    };
    let torques = bad(&|at, x| !body.torque_of(at, x).magnitude().is_finite());
    let energies = bad(&|at, x| !body.energy_of(at, x).hi().is_finite());
    let finding = |quantity, bad: u64| {
        let finding = Finding::new(body.problem(), Law::Finite, quantity, "finite").counted(0, bad);
        let why = format!("at {bad} of {LOOKS} attitudes it is not");
        if bad == 0 { finding } else { finding.because(why) }
    };
    vec![finding(Quantity::Torque, torques), finding(Quantity::Energy, energies)]
}

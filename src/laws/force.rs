//! A force: whether its torque is the gradient of its potential, what it conserves, and whether its numbers are finite.

use super::finding::Finding;
use super::subject::largest;
use super::words::{Law, Quantity, Verdict};
use super::{LawsError, Report};
use crate::body::{Body, Clock, Conserved, Force, Point, Problem, Time};
use crate::inertia::Inertia;
use crate::method::{AnyMethod, Rk8, Taylor};
use crate::num::{Dd, Real};
use crate::observe::secular_drift;
use crate::rotation::{Quat, Vec3};

/// Attitudes at which a force is looked at.
const LOOKS: u32 = 8;

/// Steps of the motion along which invariants are measured.
const STEPS: u64 = 64;

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

/// What `force` claims, measured as it acts on a body with the inertia `inertia`: its torque is −∂U/∂θ of its potential, by central
/// differences of order 6; what it says is conserved is constant along a motion, by Taylor series of order 40 in double-double, of
/// closures by a Runge–Kutta method of order 8; energy and torque are finite.
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
        report.findings.push(gradient(&body, &points, &limits));
        report.findings.extend(conserved(&body, &points[0], force.series.is_some(), &limits)?);
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

/// τ·e = −dU/dε of a turn by ε about e, relative to the largest torque.
fn gradient(body: &Body, points: &[Point<Dd>], limits: &Limits) -> Finding {
    let torque = |n: usize, x: &Point<Dd>| body.torque_of(time(n), x);
    let size = largest(points.iter().enumerate().map(|(n, x)| torque(n, x).magnitude()));
    let off = |n: usize, x: &Point<Dd>| {
        let found = minus_gradient(body, time(n), x, limits.turn);
        (found - torque(n, x)).magnitude() / size
    };
    let worst = largest(points.iter().enumerate().map(|(n, x)| off(n, x)));
    let finding = Finding::new(body.problem(), Law::Gradient, Quantity::Torque, "-dU/dθ");
    finding.judged(true, worst, limits.gradient, limits.gradient)
}

/// −∂U/∂θ of a turn θ about the principal axes, in the solver frame, by central differences of order 6 of turns by `d` rad.
fn minus_gradient(body: &Body, at: Time, x: &Point<Dd>, d: f64) -> Vec3<Dd> {
    Vec3(core::array::from_fn(|axis| {
        let energy = |k: f64| {
            let turn = Quat::cayley(Vec3::unit(axis) * (Dd::of(0.5 * k * d)));
            // tan of half the angle: the angle of `turn` is 2 atan(kd/2)
            let angle = crate::num::Precise::atan2(Dd::of(0.5 * k * d), Dd::ONE) * 2.0;
            (angle, body.energy_of(at, &Point::new(x.attitude * turn, x.momentum_body)))
        };
        let slope = |k: f64| {
            let ((a, above), (b, below)) = (energy(k), energy(-k));
            (above - below) / (a - b)
        };
        // by the angle, whose error is of even order: Richardson's extrapolation
        let twice = |k: f64| (slope(k) * 4.0 - slope(2.0 * k)) / Dd::of(3.0);
        let fourth = (twice(1.0) * 16.0 - twice(2.0)) / Dd::of(15.0);
        -fourth / Dd::from(body.scale())
    }))
}

/// What the force says that the motion conserves, and what it does not say.
fn conserved(
    body: &Body,
    start: &Point<Dd>,
    has_series: bool,
    limits: &Limits,
) -> Result<Vec<Finding>, LawsError> {
    let method: &dyn AnyMethod = if has_series { &Taylor::of_order(40)? } else { &Rk8 };
    let omega = start.momentum_body.times(body.rotor().inverse_moments()).norm().hi();
    // some radians
    let clock = Clock::new(4.0 / (omega * STEPS as f64));
    let mut x = *start;
    let mut step = method.prepare_dd(clock, body)?;
    step.open(&mut x);
    let next = |n| {
        step.advance(&mut x, 1);
        (clock.at(n + 1), step.reading(&x))
    };
    let motion: Vec<(Time, Point<Dd>)> = (0..STEPS).map(next).collect();
    let times: Vec<f64> = (1..=STEPS).map(|n| n as f64 * clock.step).collect();

    let claimed = body.conserved();
    let jacobi = claimed.iter().find(|quantity| matches!(quantity, Conserved::Jacobi { .. }));
    let of_all = [Conserved::Energy, Conserved::MomentumZ];
    let finding = |quantity: &Conserved| {
        let (what, size) = match quantity {
            Conserved::MomentumZ => (Quantity::MomentumZ, start.momentum_body.norm()),
            Conserved::Jacobi { .. } => (Quantity::Jacobi, size_of_energy(body, start)),
            _ => (Quantity::Energy, size_of_energy(body, start)),
        };
        let reading = |at: Time, x: &Point<Dd>| match quantity {
            Conserved::MomentumZ => x.momentum_space()[2],
            Conserved::Jacobi { rate } => body.scaled_energy(at, x) - x.momentum_space()[2] * *rate,
            _ => body.scaled_energy(at, x),
        };
        let before = reading(clock.at(0), start);
        let errors: Vec<f64> =
            motion.iter().map(|(at, x)| ((reading(*at, x) - before) / size).hi()).collect();
        let is_claimed = claimed.contains(quantity);
        let worst = largest(errors.iter().map(|error| error.abs()));
        let claim = if is_claimed { "kept" } else { "no" };
        let finding = Finding::new(body.problem(), Law::Conserved, what, claim);
        let finding = finding.judged(is_claimed, worst, limits.kept, limits.lost);
        Finding { drift: secular_drift(&times, &errors), ..finding }
    };
    Ok(of_all.iter().chain(jacobi).map(finding).collect())
}

/// Kinetic energy and torque, of which energies of any zero are judged.
fn size_of_energy(body: &Body, x: &Point<Dd>) -> Dd {
    body.rotor().kinetic_energy(x.momentum_body) + body.torque_of(time(0), x).norm()
}

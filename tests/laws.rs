//! Every claim of every method, executed; also the claims that say no.
//!
//! The bodies are tri-axial, without torque, under gravity, in a potential and under a torque, the starts generic, no scale
//! is 1, and everything is measured in double-double, so that an exact law shows as 1e-28 and a broken one cannot hide
//! behind rounding.

#![allow(clippy::unwrap_used, clippy::panic)]

mod fixtures;

use std::cell::Cell;
use std::ops::{Add, Div, Mul, Neg, Sub};

use polhode::body::{
    Body, Clock, Conserved, Field, Force, Free, LinearPotential, Point, Potential, Problem, State, Time,
    Torque,
};
use polhode::flow::FreeMotion;
use polhode::inertia::Inertia;
use polhode::method::schemes::{self, Pairs, Scheme, Stages};
use polhode::method::{
    AnyMethod, AxisOrder, AxisSplit, Buss, Claimed, Claims, Composed, Cost, Dmv, Energy, ExactFlow,
    ExactStep, ExplicitEuler, Gauss, ImplicitMidpoint, Kicks, LieGroup, Map, Method, MomentumEuler,
    MujocoRk4, Rk4, Rk8, SemiImplicitEuler, Splitting, StepError, TwoTurn, VariationalCayley, catalogue,
    method,
};
use polhode::num::{Dd, Precise, Real};
use polhode::observe::{Drift, Invariants, secular_drift};
use polhode::rotation::{Quat, Vec3, rotation_angle};
use polhode::run::{Run, RunError, Schedule, halvings, halvings_against, observed_order};

use fixtures::FreeCase;

/// Invariants that hold in exact arithmetic hold to this in double-double after some hundred steps.
const EXACT: f64 = 1e-28;

/// Moments, momenta and torques are this many times those of the problems in the literature: a factor whose power of two
/// is not 1 and which is not a power of two itself.
const SIZE: f64 = 24.0;

/// A body, where it starts, and where it then is after a time.
struct Case {
    body: Body,
    start: Point<Dd>,
    span: f64,
    exact: Point<Dd>,
}

fn inertia() -> Inertia {
    Inertia::from_moments([0.625, 0.75, 1.0].map(|i| i * SIZE)).unwrap()
}

fn body() -> Body {
    Body::free(inertia())
}

fn start_of(body: &Body) -> Point<Dd> {
    let attitude = Quat::from_components([0.5, -0.25, 0.75, 0.375]);
    let start =
        body.enter(&State { attitude, momentum_body: Vec3([1.0, 0.5, -0.75].map(|m| m * SIZE)) }).unwrap();
    assert_ne!(body.scale(), 1.0);
    start
}

fn free() -> Case {
    let (body, span) = (body(), 2.0);
    let start = start_of(&body);
    let exact = FreeMotion::from_point(body.inertia(), start).point_at_dd(Dd::from(span));
    Case { body, start, span, exact }
}

/// The asymmetric heavy body of Hairer, Lubich and Wanner, Geometric Numerical Integration, figure VII.5.3.
fn heavy() -> Case {
    let case =
        fixtures::tops("reference.csv").into_iter().find(|c| c.free.scenario == "E3-asymmetric").unwrap();
    let FreeCase { moments, start, attitude, t, momentum, result, .. } = case.free;
    let inertia = Inertia::from_moments(moments.map(|i| i * SIZE)).unwrap();
    let body = Body::heavy(inertia, case.weight_moment.map(|c| c * SIZE).into()).unwrap();
    let state =
        State { attitude: Quat::from_components(attitude), momentum_body: Vec3(start.map(|m| m * SIZE)) };
    let start = body.enter(&state).unwrap();
    let exact = end_of(&body, start, t);
    // the fixture has the digits of a double
    let apart = rotation_angle(exact.attitude, Quat::from_components(result)).hi();
    let momentum = Vec3(momentum) * (Dd::from(SIZE) / Dd::from(body.scale()));
    assert!(apart < 2e-16 && (exact.momentum_body - momentum).magnitude() < 2e-16, "{apart:.1e}");
    Case { body, start, span: t, exact }
}

/// Linear and quadratic in the vertical, like gravity and a gradient: U = a·Γ + ½ Γ·BΓ, B diagonal. Keeps E and L_z.
struct OfTheVertical {
    linear: [f64; 3],
    quadratic: [f64; 3],
}

impl<S: Real> Potential<S> for OfTheVertical {
    fn energy(&self, _: Time, attitude: Quat<S>) -> S {
        let up = attitude.rotate_back(Vec3::unit(2));
        up.dot(Vec3::of(Vec3(self.linear))) + up.times(Vec3::of(Vec3(self.quadratic))).dot(up) * S::of(0.5)
    }
    fn torque(&self, _: Time, attitude: Quat<S>) -> Vec3<S> {
        let up = attitude.rotate_back(Vec3::unit(2));
        up.cross(Vec3::of(Vec3(self.linear)) + up.times(Vec3::of(Vec3(self.quadratic))))
    }
    fn conserved(&self) -> Vec<Conserved> {
        vec![Conserved::Energy, Conserved::MomentumZ]
    }
}

/// A torque of time, attitude and angular velocity, along no axis and smooth.
struct Pushed;

impl<S: Real> Torque<S> for Pushed {
    fn torque(&self, at: Time, attitude: Quat<S>, omega_body: Vec3<S>) -> Vec3<S> {
        let (sin, cos) = (at.seconds::<S>() * S::of(1.5)).sin_cos();
        let push = attitude.rotate_back(Vec3([cos, sin, S::of(0.5)]));
        (push - omega_body * S::of(0.25)) * S::of(0.5 * SIZE)
    }
}

/// The end of a motion without closed form: by Taylor series of order 40 in double-double, with which twice their step agrees.
fn end_of(body: &Body, start: Point<Dd>, span: f64) -> Point<Dd> {
    let [half, exact] = [16, 32].map(|steps| {
        let mut x = start;
        method("taylor:40")
            .unwrap()
            .prepare_dd(Clock::new(span / steps as f64), body)
            .unwrap()
            .steps(&mut x, steps);
        x
    });
    let apart = rotation_angle(half.attitude, exact.attitude).hi();
    assert!(apart < 0.1 * EXACT, "{apart:.1e}");
    exact
}

/// A motion without closed form; a composition of high order agrees with its end as far as its error lets it.
fn followed(body: Body, composition: &str, agreement: f64) -> Case {
    let (start, span) = (start_of(&body), 2.0);
    let exact = end_of(&body, start, span);
    let mut x = start;
    method(composition).unwrap().prepare_dd(Clock::new(span / 256.0), &body).unwrap().steps(&mut x, 256);
    let apart = rotation_angle(x.attitude, exact.attitude).hi();
    assert!(apart < agreement, "{composition}: {apart:.1e}");
    Case { body, start, span, exact }
}

fn potential() -> Case {
    let field = OfTheVertical {
        linear: [0.1, -0.2, 0.4].map(|a| a * SIZE),
        quadratic: [0.5, -0.25, 0.125].map(|a| a * SIZE),
    };
    followed(
        Body::free(inertia()).with(Force::potential("vertical", field)),
        "kick-drift@sofroniou-spaletta-10",
        1e-24,
    )
}

fn pushed() -> Case {
    let body = Body::free(inertia()).with(Force::torque("push", Pushed));
    followed(body, "implicit-midpoint@kahan-li-8", 1e-13)
}

/// All problems, each with its kind.
fn cases() -> [(Problem, Case); 4] {
    [
        (Problem::Free, free()),
        (Problem::Linear, heavy()),
        (Problem::Potential, potential()),
        (Problem::Torque, pushed()),
    ]
}

#[test]
fn the_cases_are_of_the_kinds_that_they_stand_for() {
    for (problem, case) in cases() {
        assert_eq!(case.body.problem(), problem);
        assert_ne!(case.body.scale(), 1.0);
    }
}

fn methods() -> Vec<Box<dyn AnyMethod>> {
    let mut methods = catalogue();
    for order in AxisOrder::ALL {
        methods.push(Box::new(Splitting::strang(AxisSplit { axes: Some(order) }, Kicks)));
    }
    for name in [
        "dmv:4",
        "lie-poisson@suzuki-4",
        "rattle@yoshida-4",
        "implicit-midpoint@mclachlan-4",
        "kick-drift@srkn-6b",
        "two-turn@blanes-moan-s6",
        "two-turn@kahan-li-6",
        "taylor:8",
        "taylor:1e-4",
        "kick-drift@blanes-casas-murua-6-11",
        "implicit-midpoint@blanes-casas-murua-6-13",
        "kick-drift@processed-6-4",
        "kick-drift@chin-4a",
        "dmv:4@omelyan-mryglod-folk-4",
        "dop853:1e-7",
        "gauss:2",
        "gauss:4",
        "gauss:6",
        "gauss:8",
        "rkmk4",
        "commutator-free-4",
        "crouch-grossman-3",
        "momentum-euler",
        "buss-2",
        "mujoco-rk4",
        "richardson",
        "lie-newmark",
        "rk4-projected",
        "lie-poisson-projected",
        "lie-poisson-projected@suzuki-4",
    ] {
        methods.push(method(name).unwrap());
    }
    methods
}

fn takes_gravity(method: &dyn AnyMethod) -> bool {
    method.claims(Problem::Linear).is_some()
}

fn name(method: &dyn AnyMethod, problem: Problem) -> String {
    format!("{} ({problem:?})", method.name())
}

/// The points after `steps` steps of `h`, in double-double.
fn integrate(case: &Case, method: &dyn AnyMethod, h: f64, steps: u64) -> Vec<Point<Dd>> {
    let mut x = case.start;
    let mut points = vec![x; steps as usize];
    let mut step = method.prepare_dd(Clock::new(h), &case.body).unwrap();
    step.open(&mut x);
    for point in &mut points {
        step.advance(&mut x, 1);
        *point = step.reading(&x);
    }
    points
}

/// Errors of energy, |m|, L, L_z and |q|², relative but for the last.
#[derive(Clone, Copy, Debug, Default)]
struct Worst {
    energy: f64,
    momentum: f64,
    space: f64,
    vertical: f64,
    norm: f64,
}

fn energy(case: &Case, x: &Point<Dd>) -> Dd {
    case.body.energy_of(Time::from_seconds(0.0), x)
}

fn worst(case: &Case, points: &[Point<Dd>]) -> Worst {
    let relative = |a: Dd, b: Dd| (a / b - Dd::ONE).magnitude();
    let x0 = &case.start;
    let (e0, squared, l0) = (energy(case, x0), x0.momentum_body.norm_squared(), x0.momentum_space());
    points.iter().fold(Worst::default(), |w, x| {
        let l = x.momentum_space() - l0;
        Worst {
            energy: w.energy.max(relative(energy(case, x), e0)),
            momentum: w.momentum.max(relative(x.momentum_body.norm_squared(), squared)),
            space: w.space.max((l.norm() / l0.norm()).hi()),
            vertical: w.vertical.max((l[2] / l0.norm()).magnitude()),
            norm: w.norm.max((x.attitude.norm_squared() - Dd::ONE).magnitude()),
        }
    })
}

/// Asserts the order of attitude and momentum between any two neighbours of the halvings.
fn assert_order(case: &Case, method: &dyn AnyMethod, claimed: u32, exponents: core::ops::Range<u32>) {
    let Case { body, start, span, exact } = case;
    let claimed = f64::from(claimed);
    let name = name(method, body.problem());
    let errors = halvings_against(exact, method, body, start, *span, exponents).unwrap();
    assert!(errors.len() > 2);
    for (what, pick) in [
        ("attitude", (|e| e.attitude_error) as fn(&polhode::run::Halving) -> f64),
        ("momentum", |e| e.momentum_error),
    ] {
        let series: Vec<_> = errors.iter().map(|e| (e.h, pick(e))).collect();
        for pair in series.windows(2) {
            let order = observed_order(pair).unwrap();
            assert!(
                (order - claimed).abs() < 0.02 * claimed.max(2.0),
                "{name}: {what} converges with order {order:.3}, claimed {claimed}, {series:?}"
            );
        }
        assert!(series[series.len() - 1].1 > 1e3 * EXACT, "{name}: {what} error absurdly small");
    }
}

#[test]
fn each_method_converges_with_its_order_and_no_better() {
    for (problem, case) in cases() {
        for method in methods() {
            let Some(claims) = method.claims(problem) else { continue };
            let Some(order) = claims.order else {
                let Case { body, start, span, exact } = &case;
                let errors = halvings_against(exact, &method, body, start, *span, 6..7).unwrap();
                // in each step of the method's own
                let most =
                    method.tolerance().filter(|_| !is_to_rounding(&method)).map_or(EXACT, |tolerance| {
                        let mut step = method.prepare_dd(Clock::new(span / 64.0), body).unwrap();
                        step.steps(&mut start.clone(), 64);
                        tolerance * step.work().map_or(1.0, |work| work.accepted as f64)
                    });
                let error = errors[0].attitude_error.max(errors[0].momentum_error);
                assert!(error < most, "{}: {errors:?}", name(&method, problem));
                assert!(most == EXACT || error > 1e-6 * most, "{errors:?}");
                continue;
            };
            let exponents = match (problem, order) {
                (_, 2..=4) if claims.cost.right_sides > 0 => 8..11,
                (Problem::Linear, 1) => 8..11,
                (Problem::Linear, _) => 6..9,
                (_, 1) => 8..11,
                (_, 8..) => 5..8,
                (Problem::Torque, 6..) => 6..9,
                (Problem::Torque, _) => 8..11,
                _ => 6..9,
            };
            assert_order(&case, &method, order, exponents);
        }
    }
}

/// Every scheme over the exact free flow, and every composition over free maps of order 2, in the steps at which its order shows.
#[test]
fn each_scheme_has_its_order_over_the_bases_that_it_fits() {
    let (potential, heavy, free) = (potential(), heavy(), free());
    for scheme in schemes::ALL {
        let exact = Splitting::kicked(ExactFlow, *scheme).unwrap();
        let case = if scheme.gradients().is_empty() { &potential } else { &heavy };
        assert_scheme_order(case, &exact, scheme);
        let two = Splitting::kicked(TwoTurn { axes: None }, *scheme);
        let for_two_turns = matches!(
            scheme.stages(),
            Stages::Composition(_)
                | Stages::Processed { .. }
                | Stages::Alternating { pairs: Pairs::Any | Pairs::NearIntegrable(_), .. }
        );
        assert_eq!(two.is_ok(), for_two_turns, "{} over two turns", scheme.name());
        if let Ok(two) = two {
            // the most exact of the free splittings
            match scheme.order() {
                10 => assert_order(&free, &two, 10, 3..6),
                _ => assert_scheme_order(&free, &two, scheme),
            }
        }
        let split = Splitting::kicked(AxisSplit { axes: None }, *scheme);
        match scheme.stages() {
            Stages::Composition(_) | Stages::Processed { .. } => {
                assert_scheme_order(&free, &split.unwrap(), scheme)
            }
            Stages::Alternating { .. }
            | Stages::ForceGradient { .. }
            | Stages::ProcessedAlternating { .. } => {
                assert_eq!(split.is_err(), scheme.order() > 2, "{} over a free map of order 2", scheme.name())
            }
        }
    }
}

/// The order of `scheme` over `method`, in steps whose errors are small, and above the floor that the digits of the scheme set.
fn assert_scheme_order(case: &Case, method: &dyn AnyMethod, scheme: &Scheme) {
    let exponents = match scheme.order() {
        ..=4 => 6..10,
        6 => 6..9,
        8 => 5..8,
        _ => 4..7,
    };
    assert_order(case, method, scheme.order(), exponents);
}

/// A step at which what a method loses shows: `usual`, more for one of high order, and for one that takes steps of its own.
fn telling_step(method: &dyn AnyMethod, claims: &Claims, usual: f64) -> f64 {
    match claims.order {
        _ if method.tolerance().is_some() => 1.0,
        Some(8) => 4.0 * usual,
        _ => usual,
    }
}

/// Whether the tolerance of a method is the rounding of the scalar: what it does not keep it loses by rounding only.
fn is_to_rounding(method: &dyn AnyMethod) -> bool {
    method.tolerance() == Some(f64::ROUNDOFF)
}

fn assert_kept(name: &str, what: &str, claimed: bool, error: f64) {
    if claimed {
        assert!(error < EXACT, "{name} claims to keep {what} and loses {error:.1e}");
    } else {
        assert!(error > 1e14 * EXACT, "{name} does not claim to keep {what}, yet its error is {error:.1e}");
    }
}

#[test]
fn each_method_keeps_what_it_claims_and_loses_what_it_does_not() {
    for (problem, case) in cases() {
        let conserved = case.body.conserved();
        for method in methods() {
            let Some(claims) = method.claims(problem) else { continue };
            let (kept, name) = (claims.kept, name(&method, problem));
            let worst = worst(&case, &integrate(&case, &method, telling_step(&method, &claims, 0.125), 240));
            for (quantity, what, claimed, error) in [
                (Conserved::Energy, "energy", kept.energy == Energy::Exact, worst.energy),
                (Conserved::MomentumNorm, "|m|", kept.momentum_norm, worst.momentum),
                (Conserved::Momentum, "L", kept.momentum_space, worst.space),
                (Conserved::MomentumZ, "L_z", kept.momentum_z, worst.vertical),
            ] {
                if conserved.contains(&quantity) {
                    assert_kept(&name, what, claimed || is_to_rounding(&method), error);
                }
            }
            assert_kept(&name, "|q|", kept.norm || is_to_rounding(&method), worst.norm);
        }
    }
}

/// Secular drift of the relative energy error over `steps` steps in double precision.
fn energy_drift(case: &Case, method: &dyn AnyMethod, h: f64, steps: u64) -> Drift {
    let mut x = case.start.to_f64();
    let start = energy(case, &x.to_dd());
    let mut step = method.prepare_f64(Clock::new(h), &case.body).unwrap();
    step.open(&mut x);
    let error = |_| {
        step.advance(&mut x, 1);
        (energy(case, &step.reading(&x).to_dd()) / start - Dd::ONE).hi()
    };
    let series: Vec<f64> = (0..steps).map(error).collect();
    let times: Vec<f64> = (0..steps).map(|n| n as f64 * h).collect();
    secular_drift(&times, &series).unwrap()
}

/// The mean slope of the relative energy error over `span` seconds from some starts, and half of the interval that holds it
/// with 99.9 %, so that one method of a thousand is found to drift by chance. The motion in the potential is not periodic: a
/// bounded error wanders with it for as long as the span, and only more starts tell that from a drift.
fn mean_energy_drift(case: &Case, method: &dyn AnyMethod, h: f64, span: f64) -> [f64; 2] {
    // and Student's quantile for one less
    let (starts, student) = if case.body.problem() == Problem::Potential { (36, 3.591) } else { (12, 4.437) };
    let slope = |n: usize| {
        let (sin, cos) = Real::sin_cos(0.7 * n as f64);
        let turn = Quat::<Dd>::of(Quat::from_components([1.0, sin, cos, sin * cos])).normalized();
        let Point { attitude, momentum_body, .. } = case.start;
        let start = Point::new(turn * attitude, turn.rotate(momentum_body));
        energy_drift(&Case { body: case.body.clone(), start, ..*case }, method, h, (span / h) as u64).slope
    };
    let slopes: Vec<f64> = (0..starts).map(slope).collect();
    let mean = slopes.iter().sum::<f64>() / starts as f64;
    let squares: f64 = slopes.iter().map(|slope| (slope - mean) * (slope - mean)).sum();
    let deviation = (squares / (starts * (starts - 1)) as f64).sqrt();
    [mean, student * deviation]
}

#[test]
fn bounded_energy_stays_bounded_and_scales_with_the_order() {
    for (problem, case) in cases() {
        for method in methods() {
            let Some(claims) = method.claims(problem) else { continue };
            let (Energy::Bounded, Some(order)) = (claims.kept.energy, claims.order) else { continue };
            let name = name(&method, problem);
            let h = match (problem, order) {
                (_, ..6) => 0.0625,
                (Problem::Free, _) => 0.125,
                _ => 0.03125,
            };
            let long = 250.0;
            let (span, tolerance) = if problem == Problem::Free { (100.0, 0.05) } else { (50.0, 0.2) };
            let amplitude = |h: f64| worst(&case, &integrate(&case, &method, h, (span / h) as u64)).energy;
            let (coarse, fine) = (amplitude(h), amplitude(h / 2.0));
            let slope = libm::log2(coarse / fine);
            assert!(
                (slope - f64::from(order)).abs() < tolerance,
                "{name}: energy amplitude of order {slope:.3}"
            );
            let [drift, half_width] = mean_energy_drift(&case, &method, h, long);
            assert!(
                drift.abs() < half_width && half_width * long < 0.2 * coarse,
                "{name}: energy drifts by {drift:.1e} ± {half_width:.1e} of itself per s, amplitude {coarse:.1e}"
            );
        }
    }
}

#[test]
fn drifting_energy_is_seen_to_drift() {
    for (problem, case) in cases() {
        if !case.body.conserved().contains(&Conserved::Energy) {
            continue;
        }
        for method in methods() {
            let Some(claims) = method.claims(problem) else { continue };
            if claims.kept.energy == Energy::Drifts && !is_to_rounding(&method) {
                // small steps for first-order methods: at larger ones the error soon is no longer small
                let (h, steps) = match claims.order {
                    Some(1) => (0.000_976_562_5, 64_000),
                    _ => (telling_step(&method, &claims, 0.0625), 16_000),
                };
                let drift = energy_drift(&case, &method, h, steps);
                assert!(drift.is_secular(), "{}: no drift in {drift:?}", name(&method, problem));
            }
        }
    }
}

/// Whether it is a method projected onto its invariants, step by step.
fn is_projected(method: &(impl Claimed + ?Sized)) -> bool {
    method.name().ends_with("-projected")
}

fn free_claims(method: &(impl Claimed + ?Sized)) -> Claims {
    method.claims(Problem::Free).unwrap()
}

/// In double precision: rounding may walk, some hundredths of a unit in the last place in a step, but not always in one
/// direction. A bias of less than a thousandth, from constants or products that are rounded apart, makes 4e-14 here.
#[test]
fn rounding_does_not_bias_an_energy_that_is_kept() {
    let body = Body::free(Inertia::from_moments([1.0, 2.0, 3.0]).unwrap());
    let start = body.state(Default::default(), [0.4, 1.0, -0.3].into()).unwrap();
    let keeps = |m: &dyn AnyMethod| free_claims(m).kept.energy == Energy::Exact || is_to_rounding(m);
    for method in catalogue().iter().filter(|m| keeps(m.as_ref())) {
        let mut run = Run::new(method, &body, &start, 0.1).unwrap();
        let end = run.samples(Schedule::every(1_000_000, 1_000_000)).last().unwrap().unwrap();
        let energy = end.worst.energy.unwrap();
        // a projection ends at a residual of its own, which adds up over the steps
        let limit = if is_projected(method) { 1e-11 } else { 2e-14 };
        assert!(energy < limit, "{}: {energy:e}", method.name());
        assert!(end.worst.momentum_norm.unwrap() < limit, "{}: {:?}", method.name(), end.worst.momentum_norm);
    }
}

/// Largest difference of `steps` steps of kick-drift, in double-double and in `f64`, from the free motion; of the
/// momentum relative to it.
fn errors_of_kick_drift(moments: [f64; 3], omega: [f64; 3], h: f64, steps: u64) -> [f64; 2] {
    let body = Body::free(Inertia::from_moments(moments).unwrap());
    let start = body.enter_omega(Quat::identity(), Vec3(omega)).unwrap();
    let rounded = start.to_f64();
    let off = |x: Point<Dd>, start: Point<Dd>| {
        let exact = FreeMotion::from_point(body.inertia(), start).point_at_dd(Dd::of(h) * Dd::from(steps));
        let momentum = (x.momentum_body - exact.momentum_body).magnitude() / exact.momentum_body.magnitude();
        (x.attitude - exact.attitude).magnitude().max(momentum)
    };
    let (mut precise, mut quick) = (start, rounded);
    let kick_drift = method("kick-drift").unwrap();
    kick_drift.prepare_dd(Clock::new(h), &body).unwrap().steps(&mut precise, steps);
    kick_drift.prepare_f64(Clock::new(h), &body).unwrap().steps(&mut quick, steps);
    [off(precise, start), off(quick.to_dd(), rounded.to_dd())]
}

/// What a free flow gives back to the energy is divided by how far ω is from m; in double-double it is rounding alone.
#[test]
fn kick_drift_is_exact_next_to_a_steady_turn() {
    for exponent in (-32..=0).map(|half| 0.5 * f64::from(half)) {
        let e = libm::exp10(exponent);
        for (moments, omega) in [
            ([1.0, 2.0, 2.5], [0.3 * e, 0.2 * e, 1.0]),
            ([1.0, 2.0, 2.5], [1.0, 0.3 * e, 0.2 * e]),
            ([1.0, 1.0 + e, 1.0 + 1.5 * e], [0.3, 0.2, 1.0]),
        ] {
            let [precise, quick] = errors_of_kick_drift(moments, omega, 0.25, 10);
            assert!(precise < 1e-30, "{moments:?} {omega:?}: {precise:.1e} in double-double");
            assert!(quick < 1e-14, "{moments:?} {omega:?}: {quick:.1e}");
        }
    }
}

/// Along a rod the momentum is small, and the moment that divides its rounding too.
#[test]
fn kick_drift_is_exact_for_rods() {
    for exponent in (-24..=0).map(|half| 0.5 * f64::from(half)) {
        let r = libm::exp10(exponent);
        for h in [0.007_812_5, 0.0625, 0.25] {
            let [precise, quick] = errors_of_kick_drift([0.7, 0.7 + 0.5 * r, r], [1.4, 0.4, 0.6], h, 1000);
            assert!(precise < 1e-26, "{r:.1e}, {h}: {precise:.1e} in double-double");
            assert!(quick < 1e-12, "{r:.1e}, {h}: {quick:.1e}");
        }
    }
}

/// The iteration of an implicit step must not take a small change for the last one. Of this nearly symmetric body the
/// midpoint rule's first change happens to be smaller than its second in some steps.
#[test]
fn a_small_first_change_does_not_end_an_implicit_step() {
    let body = Body::free(Inertia::from_moments([11.764_035, 11.604_729, 0.190_837]).unwrap());
    let start = body.state(Default::default(), [0.776, -0.689, -0.36].into()).unwrap();
    // a projection is no implicit step: where its iteration does not end, it says so
    let is_implicit = |m: &dyn AnyMethod| free_claims(m).kept.energy == Energy::Exact && !is_projected(m);
    for method in catalogue().iter().filter(|m| is_implicit(m.as_ref())) {
        for h in [0.02, 0.03, 0.05, 0.07, 0.1] {
            let mut run = Run::new(method, &body, &start, h).unwrap();
            let end = run.advance_to(10_000).unwrap();
            let energy = end.worst.energy.unwrap();
            assert!(energy < 1e-14, "{} at {h}: {energy:e}", method.name());
        }
    }
}

/// Next to an equilibrium nothing but rounding is left to iterate, of terms far larger than momentum and torque.
#[test]
fn a_body_that_hangs_almost_still_is_no_unsolved_step() {
    let tensor = nalgebra::Matrix3::new(1.0, 0.1, 0.2, 0.1, 2.0, 0.3, 0.2, 0.3, 2.5);
    let body = Body::heavy(Inertia::from_tensor(tensor).unwrap(), [0.0, 0.0, -1.0].into()).unwrap();
    for push in [0.0, 1e-12, 1e-8, 1e-5, 1e-3] {
        let start = body.state(Default::default(), [push, -0.5 * push, 0.25 * push].into()).unwrap();
        let solves =
            |m: &dyn AnyMethod| m.claims(Problem::Linear).is_some_and(|claims| claims.cost.solves > 0);
        for method in catalogue().iter().filter(|m| solves(m.as_ref())) {
            let end = Run::new(method, &body, &start, 0.1).unwrap().advance_to(10_000).unwrap();
            let energy = end.worst.energy.unwrap();
            assert!(energy < 1e-8, "{} {push}: {energy:e}", method.name());
        }
    }
}

#[test]
fn a_symmetric_method_returns_and_the_others_do_not() {
    for (problem, case) in cases() {
        for method in methods() {
            let Some(claims) = method.claims(problem) else { continue };
            let mut x = case.start;
            let h = telling_step(&method, &claims, 0.125);
            for clock in [Clock::new(h), Clock { start: 25.0 * h, step: -h }] {
                x = Point::new(x.attitude, x.momentum_body);
                method.prepare_dd(clock, &case.body).unwrap().steps(&mut x, 25);
            }
            let away = ((x.momentum_body - case.start.momentum_body).magnitude()
                / case.start.momentum_body.magnitude())
            .max((x.attitude - case.start.attitude).magnitude());
            let name = name(&method, problem);
            if claims.symmetric || is_to_rounding(&method) {
                assert!(away < 10.0 * EXACT, "{name} claims to be symmetric and returns {away:.1e} off");
            } else {
                assert!(
                    away > 1e6 * EXACT,
                    "{name} does not claim to be symmetric, yet returns to {away:.1e}"
                );
            }
        }
    }
}

/// Largest entry of `D B(m) Dᵀ − B(m')` over |m'|, D the derivative of one step, B(m) the Lie–Poisson tensor.
fn poisson_defect(method: &dyn AnyMethod, h: f64) -> f64 {
    let map = |m: Vec3<Dd>| {
        let mut x = Point::new(Quat::identity(), m);
        method.prepare_dd(Clock::new(h), &body()).unwrap().steps(&mut x, 1);
        x.momentum_body
    };
    let m = start_of(&body()).momentum_body;
    // fourth-order central differences: truncation 1e-24, rounding 1e-26
    let d = 2.0_f64.recip() / f64::from(1_u32 << 18);
    let derivative = |axis: usize| {
        let at = |k: f64| map(m + Vec3::unit(axis) * Dd::of(k * d));
        ((at(1.0) - at(-1.0)) * Dd::of(8.0) - (at(2.0) - at(-2.0))) * (Dd::ONE / Dd::of(12.0 * d))
    };
    let columns = [derivative(0), derivative(1), derivative(2)];
    // B(m) v = v × m up to sign, so D B Dᵀ has the entries (row_i × row_j)·m
    let row = |i: usize| Vec3([columns[0][i], columns[1][i], columns[2][i]]);
    let image = map(m);
    [(0, 1, 2), (1, 2, 0), (2, 0, 1)]
        .map(|(i, j, k)| (row(i).cross(row(j)).dot(m) - image[k]).magnitude())
        .into_iter()
        .fold(0.0, f64::max)
}

#[test]
fn a_poisson_map_keeps_the_bracket_and_the_others_do_not() {
    for method in methods() {
        let claims = free_claims(&method);
        // what a method of order 8 loses shows in a larger step
        let defect =
            poisson_defect(&method, telling_step(&method, &claims, if claims.poisson { 0.25 } else { 0.5 }));
        if claims.poisson || is_to_rounding(&method) {
            assert!(defect < 1e-20, "{} claims to be Poisson with a defect of {defect:.1e}", method.name());
        } else {
            assert!(
                defect > 1e-14,
                "{} does not claim to be Poisson, yet its defect is {defect:.1e}",
                method.name()
            );
        }
    }
}

/// The derivative of one step at the start of `case`, left-trivialised: columns for turns of the body by ξ about its own
/// axes and for changes of its momentum, rows for those that they lead to. Also the momentum after the step.
fn derivative(case: &Case, method: &dyn AnyMethod, h: f64) -> ([[Dd; 6]; 6], Vec3<Dd>) {
    let map = |turn: Vec3<Dd>, push: Vec3<Dd>| {
        let Point { attitude, momentum_body, .. } = case.start;
        let mut x = Point::new(attitude * Quat::cayley(turn * Dd::of(0.5)), momentum_body + push);
        method.prepare_dd(Clock::new(h), &case.body).unwrap().steps(&mut x, 1);
        x
    };
    let image = map(Vec3::zero(), Vec3::zero());
    let moved = |turn, push| {
        let x = map(turn, push);
        let turned = image.attitude.conjugate() * x.attitude;
        let turned = turned.v * (Dd::of(2.0) / turned.w);
        let pushed = x.momentum_body - image.momentum_body;
        [turned[0], turned[1], turned[2], pushed[0], pushed[1], pushed[2]]
    };
    // fourth-order central differences: truncation 1e-24, rounding 1e-26
    let d = 2.0_f64.recip() / f64::from(1_u32 << 18);
    let columns: [[Dd; 6]; 6] = core::array::from_fn(|axis| {
        let at = |k: f64| {
            let by = Vec3::unit(axis % 3) * Dd::of(k * d);
            if axis < 3 { moved(by, Vec3::zero()) } else { moved(Vec3::zero(), by) }
        };
        let (near, back, far, far_back) = (at(1.0), at(-1.0), at(2.0), at(-2.0));
        core::array::from_fn(|row| {
            let slope = (near[row] - back[row]) * Dd::of(8.0) - (far[row] - far_back[row]);
            slope * (Dd::ONE / Dd::of(12.0 * d))
        })
    });
    (columns, image.momentum_body)
}

/// Largest difference that one step makes to the symplectic form of two of the six unit variations.
fn symplectic_defect(case: &Case, method: &dyn AnyMethod, h: f64) -> f64 {
    let form = |m: Vec3<Dd>, a: &[Dd; 6], b: &[Dd; 6]| {
        let part = |v: &[Dd; 6], k: usize| Vec3([v[k], v[k + 1], v[k + 2]]);
        let turns = m.dot(part(a, 0).cross(part(b, 0)));
        part(a, 0).dot(part(b, 3)) - part(b, 0).dot(part(a, 3)) + turns
    };
    let (columns, image) = derivative(case, method, h);
    let unit = |axis: usize| core::array::from_fn(|k| if k == axis { Dd::ONE } else { Dd::ZERO });
    let pairs = (0..6).flat_map(|i| (0..i).map(move |j| (i, j)));
    pairs
        .map(|(i, j)| {
            let before = form(case.start.momentum_body, &unit(i), &unit(j));
            (form(image, &columns[i], &columns[j]) - before).magnitude()
        })
        .fold(0.0, f64::max)
}

#[test]
fn a_symplectic_map_keeps_the_form_and_the_others_do_not() {
    for (problem, case) in cases() {
        for method in methods() {
            let Some(claims) = method.claims(problem) else { continue };
            let (defect, name) = (symplectic_defect(&case, &method, 0.25), name(&method, problem));
            // the motion under a torque is none of a Hamiltonian
            let to_rounding = is_to_rounding(&method) && problem != Problem::Torque;
            if claims.symplectic || to_rounding {
                assert!(defect < 1e-22, "{name} claims to be symplectic with a defect of {defect:.1e}");
            } else {
                assert!(
                    defect > 1e-13,
                    "{name} does not claim to be symplectic, yet its defect is {defect:.1e}"
                );
            }
        }
    }
}

thread_local! {
    static SINES: Cell<u32> = const { Cell::new(0) };
    static ROOTS: Cell<u32> = const { Cell::new(0) };
    static TORQUES: Cell<u32> = const { Cell::new(0) };
}

/// A double that counts how often a sine and cosine and a square root are taken.
#[derive(Clone, Copy, Debug, PartialEq, PartialOrd)]
struct Counted(f64);

impl Add for Counted {
    type Output = Self;
    fn add(self, b: Self) -> Self {
        Counted(self.0 + b.0)
    }
}
impl Sub for Counted {
    type Output = Self;
    fn sub(self, b: Self) -> Self {
        Counted(self.0 - b.0)
    }
}
impl Mul for Counted {
    type Output = Self;
    fn mul(self, b: Self) -> Self {
        Counted(self.0 * b.0)
    }
}
impl Div for Counted {
    type Output = Self;
    fn div(self, b: Self) -> Self {
        Counted(self.0 / b.0)
    }
}
impl Neg for Counted {
    type Output = Self;
    fn neg(self) -> Self {
        Counted(-self.0)
    }
}
impl Real for Counted {
    const ROUNDOFF: f64 = f64::ROUNDOFF;
    fn of(x: f64) -> Self {
        Counted(x)
    }
    fn sqrt(self) -> Self {
        ROOTS.set(ROOTS.get() + 1);
        Counted(self.0.sqrt())
    }
    fn sin_cos(self) -> (Self, Self) {
        SINES.set(SINES.get() + 1);
        let (s, c) = Real::sin_cos(self.0);
        (Counted(s), Counted(c))
    }
    fn magnitude(self) -> f64 {
        self.0.abs()
    }
}

impl Precise for Counted {
    fn to_dd(self) -> Dd {
        self.0.to_dd()
    }
    fn to_f64(self) -> f64 {
        self.0
    }
    fn abs(self) -> Self {
        Counted(self.0.abs())
    }
    fn round(self) -> Self {
        Counted(self.0.round())
    }
    fn atan2(self, x: Self) -> Self {
        Counted(Precise::atan2(self.0, x.0))
    }
    fn exp(self) -> Self {
        Counted(Precise::exp(self.0))
    }
    fn exp_m1(self) -> Self {
        Counted(Precise::exp_m1(self.0))
    }
    fn ln(self) -> Self {
        Counted(Precise::ln(self.0))
    }
}

/// Gravity that counts how often its torque is asked for.
#[derive(Clone, Copy, Debug)]
struct CountedGravity(LinearPotential<Counted>);

impl Field<Counted> for CountedGravity {
    const HAS_REMAINDER: bool = false;
    fn linear_part(&self) -> Option<&LinearPotential<Counted>> {
        Some(&self.0)
    }
    fn remainder(&self, _: Time, _: Quat<Counted>, _: Vec3<Counted>) -> Vec3<Counted> {
        Vec3::zero()
    }
    fn torque(&self, _: Time, attitude: Quat<Counted>, _: Vec3<Counted>) -> Vec3<Counted> {
        TORQUES.set(TORQUES.get() + 1);
        self.0.torque(attitude)
    }
}

/// Sines, square roots and torques of one step, next to the cost that is claimed.
fn counted<M: Method<Counted> + Claimed>(
    method: &M,
    problem: Problem,
    moments: [f64; 3],
) -> ([u32; 3], Cost) {
    let rotor = Body::free(Inertia::from_moments(moments).unwrap()).rotor();
    let mut x = Point::new(Quat::identity(), Vec3([1.0, 0.5, -0.75].map(Counted)));
    let (h, at) = (Dd::of(0.125), Time::from_seconds(0.0));
    let begin = || {
        SINES.set(0);
        ROOTS.set(0);
        TORQUES.set(0);
    };
    if problem == Problem::Free {
        let mut map = method.map(h, &rotor, &Free);
        map.open(at, &mut x);
        begin();
        map.advance(at, &mut x);
    } else {
        let gravity = CountedGravity(LinearPotential { moment: Vec3([0.1, -0.2, 0.4].map(Counted)) });
        let mut map = method.map(h, &rotor, &gravity);
        map.open(at, &mut x);
        begin();
        map.advance(at, &mut x);
    }
    ([SINES.get(), ROOTS.get(), TORQUES.get()], method.claims(problem).unwrap().cost)
}

const ASYMMETRIC: [f64; 3] = [0.625, 0.75, 1.0];
const SYMMETRIC: [f64; 3] = [0.75, 0.75, 1.0];

/// A turn takes one sine, a solved equation one square root, for its Cayley map, a free flow of a symmetric body two
/// sines; a kick and a right-hand side take one torque.
#[test]
fn each_method_costs_what_it_claims() {
    fn assert_cost<M: Method<Counted> + Claimed>(method: &M, implicit: bool) {
        for problem in [Problem::Free, Problem::Linear] {
            let name = name(problem, method);
            let ([sines, roots, torques], cost) = counted(method, problem, ASYMMETRIC);
            if cost.free_flows == 0 {
                assert_eq!(sines, cost.turns, "{name}: turns");
                assert!(implicit || cost.solves == 0, "{name}");
                assert!(!implicit || roots == cost.solves, "{name}: {roots} roots, {cost:?}");
            } else {
                let ([sines, ..], _) = counted(method, problem, SYMMETRIC);
                assert_eq!(sines, 2 * cost.free_flows, "{name}: free flows");
            }
            if problem == Problem::Linear {
                assert_eq!(torques, cost.kicks + cost.right_sides, "{name}: torques");
            }
        }
        fn name(problem: Problem, method: &impl Claimed) -> String {
            format!("{} ({problem:?})", method.name())
        }
    }
    let ([sines, roots, _], cost) = counted(&ExactStep, Problem::Free, ASYMMETRIC);
    assert_eq!((sines, roots, cost), (0, 2, Cost::additions(1)), "an addition takes two roots");
    assert_cost(&ExplicitEuler, false);
    assert_cost(&SemiImplicitEuler, false);
    assert_cost(&Rk4 { normalized: false }, false);
    assert_cost(&Rk4 { normalized: true }, false);
    assert_cost(&Rk8, false);
    assert_cost(&LieGroup::RKMK_4, false);
    assert_cost(&LieGroup::COMMUTATOR_FREE_4, false);
    assert_cost(&LieGroup::CROUCH_GROSSMAN_3, false);
    assert_cost(&MomentumEuler, false);
    assert_cost(&MujocoRk4, false);
    assert_cost(&Buss { augmented: false }, false);
    assert_cost(&Buss { augmented: true }, false);
    assert_cost(&Splitting::strang(VariationalCayley, Kicks), true);
    assert_cost(&ImplicitMidpoint, true);
    assert_cost(&Composed::new(ImplicitMidpoint, schemes::SUZUKI_4).unwrap(), true);
    for scheme in schemes::ALL {
        if scheme.lengths().is_some() {
            assert_cost(&Splitting::kicked(AxisSplit { axes: None }, *scheme).unwrap(), false);
            assert_cost(&Splitting::kicked(Dmv, *scheme).unwrap(), true);
            assert_cost(&Splitting::kicked(TwoTurn { axes: None }, *scheme).unwrap(), false);
        }
        assert_cost(&Splitting::kicked(ExactFlow, *scheme).unwrap(), false);
    }
}

#[test]
fn costs_add_and_multiply_by_kind() {
    let sum = Cost::right_sides(1)
        + Cost::turns(2)
        + Cost::free_flows(3)
        + Cost::additions(4)
        + Cost::solves(5)
        + Cost::kicks(6);
    let twice = (sum + sum, sum * 2);
    assert_eq!(twice.0, twice.1);
    let Cost { right_sides, turns, free_flows, additions, solves, kicks, .. } = twice.0;
    assert_eq!([right_sides, turns, free_flows, additions, solves, kicks], [2, 4, 6, 8, 10, 12]);
}

#[test]
fn neighbouring_kicks_of_a_composition_are_merged() {
    let claims = method("kick-drift@suzuki-4").unwrap().claims(Problem::Linear).unwrap();
    assert_eq!((claims.cost.free_flows, claims.cost.kicks), (5, 5));
    let claims = method("rattle@kahan-li-8").unwrap().claims(Problem::Potential).unwrap();
    assert_eq!((claims.cost.solves, claims.cost.kicks), (17, 17));
}

#[test]
fn scaling_the_mass_by_a_power_of_two_changes_no_bit() {
    let tiny = 1.0 / (1_u64 << 40) as f64;
    let trajectory = |scale: f64, weight: f64, method: &dyn AnyMethod| {
        let inertia = Inertia::from_moments([1.0, 2.0, 3.0].map(|i| i * scale)).unwrap();
        let body = Body::heavy(inertia, [0.3, -0.1, 0.8].map(|c| c * weight * scale).into()).unwrap();
        let start = body.state(Default::default(), [0.4, 1.0, -0.3].into()).unwrap();
        let mut run = Run::new(method, &body, &start, 0.1).unwrap();
        let sample = run.advance_to(1000).unwrap();
        (
            sample.state.attitude,
            sample.state.momentum_body * (1.0 / scale),
            sample.worst,
            sample.energy / scale,
        )
    };
    for method in methods().iter().filter(|method| free_claims(*method).order != Some(1)) {
        let weights = if takes_gravity(method) { vec![0.0, 1.0] } else { vec![0.0] };
        for weight in weights {
            assert_eq!(
                trajectory(1.0, weight, method),
                trajectory(tiny, weight, method),
                "{}",
                method.name()
            );
        }
    }
}

#[test]
fn a_turn_about_a_principal_axis_is_steady_for_every_method() {
    for method in catalogue() {
        for axis in 0..3 {
            let body = body();
            let start = State { attitude: Quat::identity(), momentum_body: Vec3::unit(axis) };
            let mut run = Run::new(&method, &body, &start, 0.125).unwrap();
            let sample = run.advance_to(200).unwrap();
            assert_eq!(sample.state.momentum_body, start.momentum_body, "{}", method.name());
        }
    }
}

#[test]
fn a_run_is_taken_up_only_by_its_method_and_body() {
    let with = |c1: f64| body().with(Force::drag(c1, 0.0).unwrap());
    let start = body().leave(&start_of(&body()));
    let mut run = Run::new(&method("rk4").unwrap(), &with(0.1), &start, 0.01).unwrap();
    run.advance_to(10).unwrap();
    let text = run.checkpoint().to_string();
    let resumed = |name: &str, body: &Body| {
        let run = Run::resume(&method(name).unwrap(), body, &text.parse().unwrap());
        run.map(|_| ()).map_err(|error| error.to_string())
    };
    assert_eq!(resumed("rk4", &with(0.1)), Ok(()));
    assert!(
        resumed("rk4-normalized", &with(0.1))
            .unwrap_err()
            .contains("is of a run by rk4, and the method given")
    );
    assert!(resumed("rk4", &with(0.2)).unwrap_err().contains("is of a body with"));
    assert!(resumed("rk4", &body()).is_err());
    for (broken, line) in [
        (text.replace("checkpoint 3", "checkpoint 1"), 1),
        (text.lines().take(4).collect::<Vec<_>>().join("\n"), 5),
        (text.replace("residual", "rest"), text.lines().count()),
        (format!("{text}more\n"), text.lines().count() + 1),
        (text.replace("worst -", "worst NaN"), text.lines().count() - 2),
    ] {
        let error = broken.parse::<polhode::run::Checkpoint>().unwrap_err().to_string();
        assert!(error.starts_with(&format!("line {line} of the checkpoint is")), "{error}");
    }
}

#[test]
fn an_unsolved_step_is_told_again_and_again() {
    let body = body();
    let start = body.leave(&start_of(&body));
    let mut run = Run::new(&method("rattle").unwrap(), &body, &start, 4.0).unwrap();
    let error = run.advance_to(10).unwrap_err();
    let RunError::Unsolved { last, .. } = error else { panic!("{error}") };
    assert!(matches!(run.advance_to(last.steps), Err(RunError::Unsolved { .. })));
}

#[test]
fn a_scheme_whose_lists_do_not_alternate_is_refused() {
    const TWO: &[Dd] = &[Dd::sum(0.125, 0.0), Dd::sum(0.25, 0.0)];
    let stages = Stages::Alternating { first: schemes::Part::B, a: &[], b: TWO, pairs: Pairs::Any };
    assert_eq!(
        Scheme::new("mine", 2, stages, "").unwrap_err().to_string(),
        "scheme \"mine\" lists 2 shares of the flow that is first and 0 of the other; of the first there are as many or one more"
    );
}

/// A state is in the axes and units of the user, whatever the solver frame is.
#[test]
fn readings_of_a_state_are_in_the_units_of_the_user() {
    let body = Body::free(Inertia::from_moments([10.0, 20.0, 30.0]).unwrap());
    assert_eq!(body.scale(), 16.0);
    let omega = nalgebra::Vector3::new(0.4, 1.0, -0.3);
    let start = body.state(Default::default(), omega).unwrap();
    assert_eq!(body.energy(&start), 12.15);
    assert!((body.omega_body(&start) - omega).norm() < 1e-15);
    let by_state = FreeMotion::from_state(body.inertia(), &start).unwrap().at(1.0).unwrap();
    let by_point = FreeMotion::from_point(body.inertia(), body.enter(&start).unwrap()).at(1.0).unwrap();
    assert_eq!(by_state, by_point);
    // no closed form drops gravity
    let heavy = heavy();
    let error = halvings(&method("rk4").unwrap(), &heavy.body, &heavy.start, 1.0, 4..6).unwrap_err();
    assert!(error.to_string().contains("a Lagrange top is symmetric"), "{error}");
}

#[test]
fn a_run_goes_forwards_and_ends_where_its_numbers_leave_the_range() {
    let body = body();
    let start = body.leave(&start_of(&body));
    let mut run = Run::new(&method("rk4").unwrap(), &body, &start, 0.01).unwrap();
    run.advance_to(100).unwrap();
    let error = run.advance_to(50).unwrap_err().to_string();
    assert_eq!(error, "50 steps were asked for, and the run has taken 100; it goes forwards only");
    assert_eq!(run.advance_to(100).unwrap().steps, 100);
    assert_eq!(Schedule::every(1, u64::MAX).into_iter().nth(3), Some(3));
    assert_eq!(Schedule::every(7, 20).into_iter().collect::<Vec<_>>(), [0, 7, 14, 20]);
    assert_eq!(Schedule::every(0, 2).into_iter().collect::<Vec<_>>(), [0, 1, 2]);
    assert_eq!(Schedule::every(5, 0).into_iter().collect::<Vec<_>>(), [0]);

    // a torque that lets the energy grow: in units of 1e200 kg m² it is no double long before it is none in the solver frame
    let torque = Force::constant_torque_body([0.0, 0.0, 1e306].into()).unwrap();
    let large = Body::free(Inertia::from_moments([1e200; 3]).unwrap()).with(torque);
    let start = large.state(Default::default(), Default::default()).unwrap();
    let mut run = Run::new(&method("rk4").unwrap(), &large, &start, 1e-55).unwrap();
    assert!(run.advance_to(10).unwrap().energy > 1e300);
    let error = run.advance_to(10_000).unwrap_err();
    assert!(matches!(error, RunError::OutOfRange { .. }), "{error}");
}

#[test]
fn invariants_of_a_point_are_those_of_its_formula() {
    let x = Point::new(Quat::from_components([0.5, 0.5, 0.5, 0.5]), Vec3([1.0, 2.0, 4.0]));
    let body = Body::free(Inertia::from_moments([1.0, 1.0, 1.0]).unwrap());
    let invariants = Invariants::of(&body, Time::from_seconds(0.0), &x);
    assert_eq!(invariants.energy.hi(), 10.5);
    assert_eq!(invariants.momentum_squared.hi(), 21.0);
    // a third of a turn about (1, 1, 1) moves each axis to the next
    assert_eq!(invariants.momentum_space.0.map(Dd::hi), [4.0, 1.0, 2.0]);
}

#[test]
fn a_method_refuses_by_name_what_it_cannot_do() {
    #[derive(Clone)]
    struct FreeOnly;
    impl Claimed for FreeOnly {
        fn name(&self) -> String {
            "free-only".into()
        }
        fn claims(&self, problem: Problem) -> Option<Claims> {
            (problem == Problem::Free).then(|| free_claims(&method("rattle").unwrap()))
        }
    }
    impl<S: Real> Method<S> for FreeOnly {
        type Map<F: Field<S>> = <Dmv as Method<S>>::Map<F>;
        fn map<F: Field<S>>(&self, h: Dd, rotor: &polhode::body::Rotor, field: &F) -> Self::Map<F> {
            Dmv.map(h, rotor, field)
        }
    }
    let refused = |method: &dyn AnyMethod, body: &Body| {
        method.prepare_dd(Clock::new(0.1), body).map(|_| ()).unwrap_err()
    };
    assert!(FreeOnly.prepare_dd(Clock::new(0.1), &free().body).is_ok());
    let error = refused(&FreeOnly, &heavy().body);
    let expected =
        StepError::Refused { method: "free-only".into(), force: "gravity".into(), problem: Problem::Linear };
    assert_eq!(error, expected);
    assert_eq!(
        error.to_string(),
        "method \"free-only\" cannot take gravity, a potential: it is for free motion; take kick-drift, for one"
    );
    for (problem, case) in cases() {
        assert_eq!(ExactStep.prepare_dd(Clock::new(0.1), &case.body).is_ok(), problem == Problem::Free);
    }
    let error = refused(&method("kick-drift@chin-4a").unwrap(), &potential().body);
    assert_eq!(
        error.to_string(),
        "method \"kick-drift@chin-4a\" takes the derivative of the torque, which is known of uniform gravity alone, and vertical \
         acts; take kick-drift@srkn-6b, for one"
    );
    let error = refused(&method("lie-poisson").unwrap(), &pushed().body);
    assert_eq!(
        error.to_string(),
        "method \"lie-poisson\" cannot take push, a torque without potential: it is for free motion and potentials; \
         take rk4 or implicit-midpoint"
    );
}

/// Turning space turns the motion: about every axis without gravity, about the vertical with it.
#[test]
fn every_method_is_equivariant_under_rotations_of_space() {
    for (problem, case) in cases() {
        let turn = match problem {
            Problem::Free => Quat::from_components([0.5, 0.1, -0.7, 0.3]),
            _ => Quat::from_components([0.6, 0.0, 0.0, -0.9]),
        };
        if problem == Problem::Torque {
            continue; // it singles out directions of space
        }
        let turn = Quat::<Dd>::of(turn).normalized();
        for method in methods() {
            if method.claims(problem).is_none() {
                continue;
            }
            let turned = Point::new(turn * case.start.attitude, case.start.momentum_body);
            let end = |start: Point<Dd>| {
                let mut x = start;
                method.prepare_dd(Clock::new(0.0625), &case.body).unwrap().steps(&mut x, 50);
                x
            };
            let (straight, turned) = (end(case.start), end(turned));
            let off = (turn * straight.attitude - turned.attitude).magnitude()
                + (straight.momentum_body - turned.momentum_body).magnitude();
            assert!(off < 10.0 * EXACT, "{}: {off:.1e}", name(&method, problem));
        }
    }
}

/// Calling the first axis the second and so on calls the components of the motion so.
#[test]
fn every_method_is_equivariant_under_relabelled_axes() {
    let next = |v: [f64; 3]| [v[2], v[0], v[1]];
    let (moments, weight, m, q) =
        ([15.0, 18.0, 24.0], [2.4, -4.8, 9.6], [24.0, 12.0, -18.0], [0.5, -0.25, 0.75, 0.375]);
    // the new axes in the old ones: q goes over into q ∘ p, p the third of a turn that takes each new axis to its old one
    let third = Quat::from_components([0.5, -0.5, -0.5, -0.5].map(Dd::of));
    let fixed = |name: &str| name.contains("lie-poisson:");
    for weight in [[0.0; 3], weight] {
        let fits = |method: &dyn AnyMethod| weight == [0.0; 3] || takes_gravity(method);
        for method in methods().iter().filter(|method| fits(*method) && !fixed(&method.name())) {
            let end = |moments: [f64; 3], weight: [f64; 3], m: [f64; 3], turn: Quat<Dd>| {
                let body = Body::heavy(Inertia::from_moments(moments).unwrap(), weight.into()).unwrap();
                let state = State { attitude: Quat::from_components(q), momentum_body: Vec3(m) };
                let start = body.enter(&state).unwrap();
                let mut x = Point::new(start.attitude * turn, start.momentum_body);
                method.prepare_dd(Clock::new(0.0625), &body).unwrap().steps(&mut x, 50);
                x
            };
            let plain = end(moments, weight, m, Quat::identity());
            let renamed = end(next(moments), next(weight), next(m), third);
            let momentum = Vec3([plain.momentum_body[2], plain.momentum_body[0], plain.momentum_body[1]]);
            let off = (renamed.momentum_body - momentum).magnitude()
                + (plain.attitude * third - renamed.attitude).magnitude();
            assert!(off < 10.0 * EXACT, "{} {weight:?}: {off:.1e}", method.name());
        }
    }
}

/// τ·e = −dU/dε of a turn by ε about e, by central differences of order 6 in double-double.
#[test]
fn torques_are_gradients_of_their_potentials() {
    let gradient = |e| Force::gravity_gradient(0.8, e).unwrap();
    let free = Body::free(inertia());
    let vertical = potential().body;
    for body in [heavy().body, vertical, free.clone().with(gradient(0.0)), free.with(gradient(0.3))] {
        let x = start_of(&body);
        let at = Time::from_seconds(0.7);
        let torque = body.torque_of(at, &x);
        let d = 1.0 / 4096.0;
        for axis in 0..3 {
            let energy = |k: f64| {
                let turn = Quat::cayley(Vec3::unit(axis) * (Dd::of(0.5 * k * d)));
                // tan of half the angle: the angle of `turn` is 2 atan(kd/2)
                let angle = Dd::of(0.5 * k * d).atan2(Dd::ONE) * 2.0;
                (angle, body.energy_of(at, &Point::new(x.attitude * turn, x.momentum_body)))
            };
            let slope = |k: f64| {
                let ((a, above), (b, below)) = (energy(k), energy(-k));
                (above - below) / (a - b)
            };
            // by the angle, whose error is of even order: Richardson's extrapolation
            let twice = |k: f64| (slope(k) * 4.0 - slope(2.0 * k)) / Dd::of(3.0);
            let fourth = (twice(1.0) * 16.0 - twice(2.0)) / Dd::of(15.0);
            let found = -fourth / Dd::from(body.scale());
            let off = (found - torque[axis]).magnitude() / torque.magnitude();
            assert!(off < 1e-16, "{:?}, axis {axis}: {off:.1e}", body.forces());
        }
    }
}

#[test]
fn a_run_taken_up_again_is_the_run_that_was_not_interrupted() {
    for (problem, case) in cases() {
        let start = case.body.leave(&case.start);
        let clock = Clock { start: 0.3, step: 0.01 };
        for method in methods() {
            if method.claims(problem).is_none() {
                continue;
            }
            let mut straight = Run::by_clock(&method, &case.body, &start, clock).unwrap();
            straight.advance_to(1003).unwrap();
            let text = straight.checkpoint().to_string();
            let checkpoint = text.parse().unwrap();
            assert_eq!(straight.checkpoint(), checkpoint);
            let mut resumed = Run::resume(&method, &case.body, &checkpoint).unwrap();
            let (a, b) = (straight.advance_to(2000).unwrap(), resumed.advance_to(2000).unwrap());
            let name = name(&method, problem);
            assert_eq!((a.point, a.worst, a.flips), (b.point, b.worst, b.flips), "{name}");
            let mut once = Run::by_clock(&method, &case.body, &start, clock).unwrap();
            assert_eq!(once.advance_to(2000).unwrap().point, a.point, "{name}");
            let unwatched = Run::by_clock(&method, &case.body, &start, clock).unwrap();
            let mut unwatched = unwatched.watching(polhode::run::Watch::Never);
            let sample = unwatched.advance_to(2000).unwrap();
            assert_eq!((sample.point, sample.flips, sample.worst.energy), (a.point, None, None), "{name}");
        }
    }
}

#[test]
fn the_monitor_of_a_heavy_body_measures_energy_and_vertical_momentum() {
    let case = heavy();
    let start = case.body.state(Default::default(), [0.4, 1.0, -0.3].into()).unwrap();
    let mut run = Run::new(&method("rk4").unwrap(), &case.body, &start, 0.1).unwrap();
    let sample = run.advance_to(100).unwrap();
    assert_eq!((sample.worst.momentum_norm, sample.worst.momentum_vector), (None, None));
    assert!(sample.worst.momentum_z.unwrap() > 1e-9 && sample.worst.energy.unwrap() > 1e-9);
    // T(0) + |c| is 0.5 (0.08 + 0.85 + 0.09) + 1, times the size
    let kinetic = 0.5 * (0.5 * 0.16 + 0.85 + 0.09);
    let change = (sample.energy / SIZE - (kinetic + 1.0)) / (kinetic + 1.0);
    approx::assert_relative_eq!(sample.energy_change, change, epsilon = 1e-15);
}

#[test]
fn a_name_that_is_no_method_is_refused_with_its_reason() {
    let error = |name: &str| method(name).err().unwrap().to_string();
    for name in ["rk5", "rk5:3", "rk5@suzuki-4", "kickdrift", "", ":2"] {
        assert_eq!(error(name), format!("there is no method {name:?}"));
    }
    for name in ["rk4:4", "rattle:1", "implicit-midpoint:2"] {
        assert!(error(name).ends_with("allowed: none: this method takes no argument"), "{}", error(name));
    }
    assert!(error("lie-poisson:322").ends_with("allowed: a permutation of 123, such as lie-poisson:321"));
    assert!(error("kick-drift:6").ends_with("allowed: 2 or 4, its order"));
    assert!(error("kick-drift:4@srkn-6b").ends_with("allowed: none beside a scheme"));
    assert!(error("exact-step@suzuki-4").ends_with("allowed: none, and no scheme: its steps are exact"));
    for name in ["gauss", "gauss:5", "gauss:10", "gauss:x", "gauss:4@suzuki-4"] {
        assert!(
            error(name).ends_with("allowed: an order 2, 4, 6 or 8, such as gauss:6, and no scheme"),
            "{}",
            error(name)
        );
    }
    assert_eq!(
        Gauss::of_order(5).unwrap_err().to_string(),
        "there is no Gauss-Legendre collocation of order 5 here; there are the orders 2, 4, 6 and 8"
    );
    for name in [
        "rkmk4",
        "momentum-euler",
        "richardson",
        "mujoco-rk4",
        "lie-newmark",
        "rk4-projected",
        "buss-2-augmented",
    ] {
        assert_eq!(method(name).unwrap().name(), name);
        assert!(error(&format!("{name}:2")).ends_with("allowed: none: this method takes no argument"));
        let reason = if name == "lie-newmark" { "foretells ω" } else { "is not symmetric" };
        assert!(error(&format!("{name}@suzuki-4")).contains(reason));
    }
    assert!(error("rattle@suzuki").contains("there is no scheme"));
    for known in catalogue() {
        assert_eq!(method(&known.name()).unwrap().name(), known.name());
    }
}

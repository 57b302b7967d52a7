//! Every claim of every method, executed; also the claims that say no.
//!
//! The bodies are tri-axial, without torque, under gravity, in a potential and under a torque, the starts generic, no scale
//! is 1, and everything is measured in double-double, so that an exact law shows as 1e-28 and a broken one cannot hide
//! behind rounding.

use std::path::Path;

use polhode::body::{Body, Clock, Field, Force, Point, Problem, State, Time};
use polhode::flow::FreeMotion;
use polhode::inertia::Inertia;
use polhode::laws::{
    Case, Counted, Law, Verdict, cases, check_cost, check_force, check_only, check_order, check_scheme,
    exponents_of,
};
use polhode::method::schemes::{self, Pairs, Scheme, Stages};
use polhode::method::{
    AnyMethod, AxisOrder, AxisSplit, Buss, Claimed, Claims, Composed, Cost, Dmv, Energy, ExactFlow,
    ExactStep, ExplicitEuler, Gauss, ImplicitMidpoint, Kicks, LieGroup, Listing, Method, MomentumEuler,
    MujocoRk4, Rk4, Rk8, SemiImplicitEuler, Splitting, StepError, TwoTurn, VariationalCayley, catalogue,
    listing, method,
};
use polhode::num::{Dd, Real};
use polhode::observe::Invariants;
use polhode::rotation::{Quat, Vec3, rotation_angle};
use polhode::run::{Run, RunError, Schedule, halvings};

use crate::fixtures::FreeCase;

/// Invariants that hold in exact arithmetic hold to this in double-double after some hundred steps.
const EXACT: f64 = 1e-28;

/// Moments, momenta and torques of the cases are this many times those of the problems in the literature.
const SIZE: f64 = 24.0;

fn case(problem: Problem) -> &'static Case {
    cases().unwrap().iter().find(|case| case.problem() == problem).unwrap()
}

fn body() -> Body {
    case(Problem::Free).body.clone()
}

fn start() -> Point<Dd> {
    case(Problem::Free).start
}

#[test]
fn the_cases_are_of_the_kinds_that_they_stand_for() {
    for (case, problem) in cases().unwrap().iter().zip(Problem::ALL) {
        assert_eq!(case.problem(), *problem);
        assert_ne!(case.body.scale(), 1.0);
    }
}

/// Half as many steps of the same series, and a composition of high order as far as its error lets it.
#[test]
fn the_ends_of_the_cases_are_those_of_other_methods() {
    for (problem, composition, agreement) in [
        (Problem::Linear, "kick-drift@sofroniou-spaletta-10", 1e-24),
        (Problem::Potential, "kick-drift@sofroniou-spaletta-10", 1e-24),
        (Problem::Torque, "implicit-midpoint@kahan-li-8", 1e-13),
    ] {
        let case = case(problem);
        let apart = |name: &str, steps: u64| {
            let mut x = case.start;
            let clock = Clock::new(case.span / steps as f64);
            method(name).unwrap().prepare_dd(clock, &case.body).unwrap().steps(&mut x, steps);
            rotation_angle(x.attitude, case.end().unwrap().attitude).hi()
        };
        let (half, other) = (apart("taylor:40", 16), apart(composition, 256));
        assert!(half < 0.1 * EXACT, "{problem:?}: {half:.1e}");
        assert!(other < agreement, "{problem:?}: {composition} {other:.1e}");
    }
    // the fixture has the digits of a double
    let top = crate::fixtures::tops("reference.csv")
        .into_iter()
        .find(|c| c.free.scenario == "E3-asymmetric")
        .unwrap();
    let FreeCase { moments, start, attitude, t, momentum, result, .. } = top.free;
    let case = case(Problem::Linear);
    let inertia = Inertia::from_moments(moments.map(|i| i * SIZE)).unwrap();
    let body = Body::heavy(inertia, top.weight_moment.map(|c| c * SIZE).into()).unwrap();
    let state =
        State { attitude: Quat::from_components(attitude), momentum_body: Vec3(start.map(|m| m * SIZE)) };
    assert_eq!((body.enter(&state).unwrap(), t), (case.start, case.span));
    assert_eq!(body.linear_potential::<Dd>(), case.body.linear_potential());
    assert_eq!(body.rotor(), case.body.rotor());
    let end = case.end().unwrap();
    let apart = rotation_angle(end.attitude, Quat::from_components(result)).hi();
    let momentum = Vec3(momentum) * (Dd::from(SIZE) / Dd::from(body.scale()));
    assert!(apart < 2e-16 && (end.momentum_body - momentum).magnitude() < 2e-16, "{apart:.1e}");
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
        "taylor:1e-3", // coarse enough to show that it is not symplectic
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

/// Every law of `laws` is decided for every method, each claim holds, and what is not claimed is seen not to hold.
fn assert_laws(laws: &[Law]) {
    for method in methods() {
        let report = check_only(&method, Problem::ALL, laws).unwrap();
        assert!(report.findings.iter().all(|finding| finding.verdict == Verdict::Holds), "{report}");
    }
}

#[test]
fn each_method_takes_what_it_has_claims_for_and_refuses_the_rest() {
    assert_laws(&[Law::Takes]);
}

#[test]
fn each_method_converges_with_its_order_and_no_better() {
    assert_laws(&[Law::Order]);
}

#[test]
fn each_method_keeps_what_it_claims_and_loses_what_it_does_not() {
    assert_laws(&[Law::Conserved]);
}

/// A bounded energy error scales with the order.
#[test]
fn bounded_energy_stays_bounded_and_other_energy_is_seen_to_drift() {
    assert_laws(&[Law::Drift]);
}

#[test]
fn a_symmetric_method_returns_and_the_others_do_not() {
    assert_laws(&[Law::Symmetry, Law::Reversibility]);
}

#[test]
fn a_poisson_map_keeps_the_bracket_and_the_others_do_not() {
    assert_laws(&[Law::Poisson]);
}

#[test]
fn a_symplectic_map_keeps_the_form_and_the_others_do_not() {
    assert_laws(&[Law::Symplectic]);
}

/// In double precision: rounding may walk, some hundredths of a unit in the last place in a step, but not always in one
/// direction.
#[test]
#[ignore = "a million steps: takes seconds, `.ci/run` does it"]
fn rounding_does_not_bias_what_is_kept() {
    for method in catalogue() {
        let report = check_only(&method, &[Problem::Free], &[Law::Rounding]).unwrap();
        assert!(report.findings.iter().all(|finding| finding.verdict == Verdict::Holds), "{report}");
    }
}

/// Every scheme over the exact free flow, and every composition over free maps of order 2, in the steps at which its order shows.
#[test]
fn each_scheme_has_its_order_over_the_bases_that_it_fits() {
    for scheme in schemes::ALL {
        let report = check_scheme(scheme).unwrap();
        assert_eq!(report.with(Verdict::Holds).count(), 2, "{report}");
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
                10 => assert_order(&two, scheme, 3..6),
                order => assert_order(&two, scheme, exponents_of(order)),
            }
        }
        let split = Splitting::kicked(AxisSplit { axes: None }, *scheme);
        match scheme.stages() {
            Stages::Composition(_) | Stages::Processed { .. } => {
                assert_order(&split.unwrap(), scheme, exponents_of(scheme.order()))
            }
            Stages::Alternating { .. }
            | Stages::ForceGradient { .. }
            | Stages::ProcessedAlternating { .. } => {
                assert_eq!(split.is_err(), scheme.order() > 2, "{} over a free map of order 2", scheme.name())
            }
        }
    }
}

/// Its errors come within a few powers of ten of the rounding of double-double.
#[test]
fn an_order_that_is_measured_near_rounding_is_not_called_false() {
    let method = method("two-turn@sofroniou-spaletta-10").unwrap();
    let report = check_only(method.as_ref(), &[Problem::Free], &[Law::Order]).unwrap();
    assert_eq!((report.findings.len(), report.false_claims().count()), (2, 0), "{report}");
}

fn assert_order(method: &dyn AnyMethod, scheme: &Scheme, exponents: core::ops::Range<u32>) {
    assert_eq!(free_claims(method).order, Some(scheme.order()));
    let report = check_order(method, Problem::Free, exponents).unwrap();
    assert_eq!(report.with(Verdict::Holds).count(), 2, "{report}");
}

fn free_claims(method: &(impl Claimed + ?Sized)) -> Claims {
    method.claims(Problem::Free).unwrap()
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
    let is_implicit =
        |m: &dyn AnyMethod| free_claims(m).kept.energy == Energy::Exact && !free_claims(m).to_residual;
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

/// A turn takes one sine, a solved equation one square root, for its Cayley map, a free flow of a symmetric body two
/// sines; a kick and a right-hand side take one torque.
#[test]
fn each_method_costs_what_it_claims() {
    fn assert_cost<M: Method<Counted> + Claimed>(method: &M, implicit: bool) {
        let report = check_cost(method).unwrap();
        assert!(report.findings.iter().all(|finding| finding.verdict == Verdict::Holds), "{report}");
        let solves = |problem| method.claims(problem).map_or(0, |claims| claims.cost.solves);
        for problem in [Problem::Free, Problem::Linear] {
            assert!(implicit || solves(problem) == 0, "{report}");
        }
    }
    let report = check_cost(&ExactStep).unwrap();
    assert_eq!(free_claims(&ExactStep).cost, Cost::additions(1));
    assert!(report.findings.iter().all(|finding| finding.verdict == Verdict::Holds), "{report}");
    for method in methods() {
        let report = check_only(&method, Problem::ALL, &[Law::Cost]).unwrap();
        assert_eq!(report.false_claims().count(), 0, "{report}");
    }
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
    let start = body().leave(&start());
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
        (text.replace("steps 10", "steps 18446744073709551615"), text.lines().count() - 5),
        (text.replace("flips ", "flips 9007199254740993"), text.lines().count() - 1),
        (text.replace("residual 0.0", "residual NaN"), text.lines().count()),
    ] {
        let error = broken.parse::<polhode::run::Checkpoint>().unwrap_err().to_string();
        assert!(error.starts_with(&format!("line {line} of the checkpoint is")), "{error}");
    }
}

#[test]
fn an_unsolved_step_is_told_again_and_again() {
    let body = body();
    let start = body.leave(&start());
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
        "scheme \"mine\" lists 2 shares of the first flow and 0 of the other; the first must have as many, or one more"
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
    let heavy = case(Problem::Linear);
    let error = halvings(&method("rk4").unwrap(), &heavy.body, &heavy.start, 1.0, 4..6).unwrap_err();
    assert!(error.to_string().contains("a Lagrange top has two equal ones"), "{error}");
}

#[test]
fn a_run_goes_forwards_and_ends_where_its_numbers_leave_the_range() {
    let body = body();
    let start = body.leave(&start());
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
    assert!(matches!(error, RunError::OutOfRange { time, .. } if time > 1e-54), "{error}");
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
    assert!(FreeOnly.prepare_dd(Clock::new(0.1), &body()).is_ok());
    let error = refused(&FreeOnly, &case(Problem::Linear).body);
    let expected =
        StepError::Refused { method: "free-only".into(), force: "gravity".into(), problem: Problem::Linear };
    assert_eq!(error, expected);
    assert_eq!(
        error.to_string(),
        "method \"free-only\" cannot take gravity, as it is for free motion only; use kick-drift, for example"
    );
    for case in cases().unwrap() {
        let problem = case.problem();
        assert_eq!(ExactStep.prepare_dd(Clock::new(0.1), &case.body).is_ok(), problem == Problem::Free);
    }
    let error = refused(&method("kick-drift@chin-4a").unwrap(), &case(Problem::Potential).body);
    assert_eq!(
        error.to_string(),
        "method \"kick-drift@chin-4a\" needs the derivative of the torque, which is known only for uniform gravity, and \
         vertical acts; use kick-drift@srkn-6b, for example"
    );
    let error = refused(&method("lie-poisson").unwrap(), &case(Problem::Torque).body);
    assert_eq!(
        error.to_string(),
        "method \"lie-poisson\" cannot take push, a torque without potential; use rk4 or implicit-midpoint"
    );
}

/// Turning space turns the motion: about every axis without gravity, about the vertical with it.
#[test]
fn every_method_is_equivariant_under_rotations_of_space() {
    for case in cases().unwrap() {
        let problem = case.problem();
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

#[test]
fn torques_are_gradients_of_their_potentials_and_keep_what_they_say() {
    let gradient = |e| Force::gravity_gradient(0.8, e).unwrap();
    let of_case = |problem| case(problem).body.forces()[0].clone();
    let free = body();
    for (inertia, force) in [
        (case(Problem::Linear).body.inertia(), of_case(Problem::Linear)),
        (free.inertia(), of_case(Problem::Potential)),
        (free.inertia(), gradient(0.0)),
        (free.inertia(), gradient(0.3)),
    ] {
        let report = check_force(&force, inertia).unwrap();
        assert!(report.findings.len() > 4, "{report}");
        assert!(report.findings.iter().all(|finding| finding.verdict == Verdict::Holds), "{report}");
    }
}

#[test]
fn a_run_taken_up_again_is_the_run_that_was_not_interrupted() {
    for case in cases().unwrap() {
        let problem = case.problem();
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
    let case = case(Problem::Linear);
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
        "there is no Gauss-Legendre method of order 5 here; the orders are 2, 4, 6 and 8"
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
        let reason = if name == "lie-newmark" { "predicts ω" } else { "is not symmetric" };
        assert!(error(&format!("{name}@suzuki-4")).contains(reason));
    }
    assert!(error("rattle@suzuki").contains("there is no scheme"));
    for known in catalogue() {
        assert_eq!(method(&known.name()).unwrap().name(), known.name());
    }
}

/// Every name leads to a file that is called so; a variant stands in the file of the method that it varies.
#[test]
fn each_method_is_found_by_its_name_among_the_files() {
    for method in catalogue() {
        let name = method.name();
        let base = name.split([':', '@']).next().unwrap();
        let Listing { file, formula, .. } = listing(&name).unwrap_or_else(|| panic!("{name} is not listed"));
        let stem = file.strip_prefix("src/method/").unwrap().trim_end_matches(".rs").trim_end_matches("/mod");
        let variant = base.rsplit_once('-').map_or(base, |(plain, _)| plain);
        assert!([base, variant].contains(&&*stem.replace('_', "-")), "{name} in {file}");
        let text =
            std::fs::read_to_string(Path::new(env!("CARGO_MANIFEST_DIR")).join("..").join(file)).unwrap();
        assert!(
            text.contains(&format!("\"{base}")) || text.contains(&format!("`{base}`")),
            "{name} in {file}"
        );
        assert!(!formula.is_empty() && !formula.contains('|'), "{name}: {formula}");
    }
}

//! Every claim of every method, executed; also the claims that say no.
//!
//! The bodies are tri-axial, one free and one under gravity, the starts generic, and everything is measured in
//! double-double, so that an exact law shows as 1e-28 and a broken one cannot hide behind rounding.

#![allow(clippy::unwrap_used, clippy::panic)]

mod fixtures;

use std::cell::Cell;
use std::ops::{Add, Div, Mul, Neg, Sub};

use polhode::body::{Body, Inertia, State};
use polhode::flow::FreeMotion;
use polhode::method::{
    AnyMethod, AxisOrder, Claimed, Claims, Composed, Cost, Energy, KickDrift, LiePoisson, Method, Rattle,
    Rk4, SUZUKI_4, Step, StepError, catalogue, method,
};
use polhode::num::{Dd, Real};
use polhode::observe::{Drift, Invariants, secular_drift};
use polhode::rotation::{Quat, Vec3};
use polhode::run::{Run, Schedule, halvings_against, observed_order};

use fixtures::FreeCase;

/// Invariants that hold in exact arithmetic hold to this in double-double after some hundred steps.
const EXACT: f64 = 1e-28;

/// A body, where it starts, and where it then is after a time.
struct Problem {
    body: Body,
    start: State<Dd>,
    span: f64,
    exact: State<Dd>,
}

fn body() -> Body {
    Body::free(Inertia::from_moments([0.625, 0.75, 1.0]).unwrap())
}

fn start() -> State<Dd> {
    let q = Quat::from_components([0.5, -0.25, 0.75, 0.375].map(Dd::of)).normalized();
    State { attitude: q, momentum_body: Vec3([1.0, 0.5, -0.75].map(Dd::of)) }
}

fn free() -> Problem {
    let exact = FreeMotion::new(&body(), start()).inside_at_dd(Dd::from(2.0));
    Problem { body: body(), start: start(), span: 2.0, exact }
}

/// The asymmetric heavy body of Hairer, Lubich and Wanner, Geometric Numerical Integration, figure VII.5.3.
fn heavy() -> Problem {
    let case =
        fixtures::tops("reference.csv").into_iter().find(|c| c.free.scenario == "E3-asymmetric").unwrap();
    let FreeCase { moments, start, attitude, t, momentum, result, .. } = case.free;
    let body = Body::heavy(Inertia::from_moments(moments).unwrap(), case.weight_moment.into()).unwrap();
    let state = |q, m| State { attitude: Quat::from_components(q), momentum_body: Vec3(m) };
    let mut start = state(attitude.map(Dd::of), start.map(Dd::of));
    start.attitude = start.attitude.normalized();
    assert_eq!(body.scale(), 1.0);
    Problem { body, start, span: t, exact: state(result, momentum) }
}

fn methods() -> Vec<Box<dyn AnyMethod>> {
    let mut methods = catalogue();
    for order in AxisOrder::ALL {
        methods.push(Box::new(LiePoisson { axes: Some(order) }));
    }
    methods.push(Box::new(Composed { base: LiePoisson { axes: None }, scheme: SUZUKI_4 }));
    methods
}

/// The states after `steps` steps of `h`, in double-double.
fn integrate(problem: &Problem, method: &dyn AnyMethod, h: f64, steps: u64) -> Vec<State<Dd>> {
    let mut x = problem.start;
    let mut step = method.prepare_dd(h, &problem.body, &x).unwrap();
    (0..steps)
        .map(|_| {
            step.step(&mut x);
            x
        })
        .collect()
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

fn energy(problem: &Problem, x: &State<Dd>) -> Dd {
    let m = x.momentum_body;
    let kinetic = m.dot(m.times(problem.body.inverse_moments())) * Dd::of(0.5);
    let height = x.attitude.rotate_back(Vec3::unit(2));
    problem.body.gravity().map_or(kinetic, |g| kinetic + g.weight_moment.dot(height))
}

fn worst(problem: &Problem, states: &[State<Dd>]) -> Worst {
    let relative = |a: Dd, b: Dd| (a / b - Dd::ONE).magnitude();
    let x0 = &problem.start;
    let (e0, squared, l0) = (energy(problem, x0), x0.momentum_body.norm_squared(), x0.momentum_space());
    states.iter().fold(Worst::default(), |w, x| {
        let l = x.momentum_space() - l0;
        Worst {
            energy: w.energy.max(relative(energy(problem, x), e0)),
            momentum: w.momentum.max(relative(x.momentum_body.norm_squared(), squared)),
            space: w.space.max((l.norm() / l0.norm()).hi()),
            vertical: w.vertical.max((l[2] / l0.norm()).magnitude()),
            norm: w.norm.max((x.attitude.norm_squared() - Dd::ONE).magnitude()),
        }
    })
}

/// Asserts the order of attitude and momentum over the last of the halvings.
fn assert_order(problem: &Problem, method: &dyn AnyMethod, exponents: core::ops::Range<u32>) {
    let Problem { body, start, span, exact } = problem;
    let claimed = f64::from(method.claims().order);
    let errors = halvings_against(exact, method, body, start, *span, exponents).unwrap();
    for (what, pick) in [
        ("attitude", (|e| e.attitude_error) as fn(&polhode::run::Halving) -> f64),
        ("momentum", |e| e.momentum_error),
    ] {
        let series: Vec<_> = errors.iter().map(|e| (e.h, pick(e))).collect();
        let order = observed_order(&series).unwrap();
        assert!(
            (order - claimed).abs() < 0.02 * claimed.max(2.0),
            "{}: {what} converges with order {order:.3}, claimed {claimed}",
            method.name()
        );
        assert!(series[0].1 > 1e-12, "{}: {what} error absurdly small", method.name());
    }
}

#[test]
fn each_method_converges_with_its_order_and_no_better() {
    let problem = free();
    for method in methods() {
        if method.claims().exact_when_free {
            let Problem { body, start, span, exact } = &problem;
            let errors = halvings_against(exact, method.as_ref(), body, start, *span, 6..7).unwrap();
            assert!(errors[0].attitude_error < EXACT, "{}: {errors:?}", method.name());
        } else {
            assert_order(&problem, method.as_ref(), 6..9);
        }
    }
}

#[test]
fn under_gravity_each_method_converges_with_its_order_and_no_better() {
    let problem = heavy();
    for method in methods() {
        let exponents = if method.claims().order == 1 { 8..11 } else { 6..8 };
        assert_order(&problem, method.as_ref(), exponents);
    }
}

fn assert_kept(method: &dyn AnyMethod, what: &str, claimed: bool, error: f64) {
    let name = method.name();
    if claimed {
        assert!(error < EXACT, "{name} claims to keep {what} and loses {error:.1e}");
    } else {
        assert!(error > 1e-9, "{name} does not claim to keep {what}, yet its error is {error:.1e}");
    }
}

#[test]
fn each_method_keeps_what_it_claims_and_loses_what_it_does_not() {
    let problem = free();
    for method in methods() {
        let kept = method.claims().free;
        let worst = worst(&problem, &integrate(&problem, method.as_ref(), 0.125, 400));
        assert_kept(method.as_ref(), "energy", kept.energy == Energy::Exact, worst.energy);
        assert_kept(method.as_ref(), "|m|", kept.momentum, worst.momentum);
        assert_kept(method.as_ref(), "L", kept.momentum_space, worst.space);
        assert_kept(method.as_ref(), "|q|", kept.norm, worst.norm);
    }
}

#[test]
fn under_gravity_each_method_keeps_what_it_claims_and_loses_what_it_does_not() {
    let problem = heavy();
    for method in methods() {
        let kept = method.claims().potential.unwrap();
        let worst = worst(&problem, &integrate(&problem, method.as_ref(), 0.125, 240));
        assert_kept(method.as_ref(), "energy", kept.energy == Energy::Exact, worst.energy);
        assert_kept(method.as_ref(), "L_z", kept.momentum_z, worst.vertical);
        assert_kept(method.as_ref(), "|q|", kept.norm, worst.norm);
    }
}

/// Secular drift of the relative energy error over `steps` steps.
fn energy_drift(problem: &Problem, method: &dyn AnyMethod, h: f64, steps: u64) -> Drift {
    let states = integrate(problem, method, h, steps);
    let times: Vec<f64> = (0..states.len()).map(|n| n as f64 * h).collect();
    let start = energy(problem, &problem.start);
    let series: Vec<f64> = states.iter().map(|x| (energy(problem, x) / start - Dd::ONE).hi()).collect();
    secular_drift(&times, &series).unwrap()
}

fn assert_bounded(problem: &Problem, method: &dyn AnyMethod, [h, span, long]: [f64; 3], tolerance: f64) {
    let amplitude = |h: f64| worst(problem, &integrate(problem, method, h, (span / h) as u64)).energy;
    let (coarse, fine) = (amplitude(h), amplitude(h / 2.0));
    let order = libm::log2(coarse / fine);
    let claimed = f64::from(method.claims().order);
    assert!((order - claimed).abs() < tolerance, "{}: energy amplitude of order {order:.3}", method.name());

    let drift = energy_drift(problem, method, h, (long / h) as u64);
    let travelled = drift.slope.abs() * long;
    assert!(
        !drift.is_secular() && travelled < 0.02 * coarse,
        "{}: energy drifts by {travelled:.1e} in {long} s, amplitude {coarse:.1e}, {drift:?}",
        method.name()
    );
}

#[test]
fn bounded_energy_stays_bounded_and_scales_with_the_order() {
    let problem = free();
    for method in methods().iter().filter(|m| m.claims().free.energy == Energy::Bounded) {
        assert_bounded(&problem, method.as_ref(), [0.0625, 100.0, 1000.0], 0.05);
    }
}

#[test]
fn under_gravity_bounded_energy_stays_bounded_and_scales_with_the_order() {
    let problem = heavy();
    let bounded = |m: &dyn AnyMethod| m.claims().potential.is_some_and(|kept| kept.energy == Energy::Bounded);
    for method in methods().iter().filter(|m| bounded(m.as_ref())) {
        assert_bounded(&problem, method.as_ref(), [0.0625, 50.0, 1000.0], 0.2);
    }
}

#[test]
fn drifting_energy_is_seen_to_drift() {
    let (free, heavy) = (free(), heavy());
    for method in methods() {
        let claims = method.claims();
        // small steps for first-order methods: at larger ones the error soon is no longer small
        let h = if claims.order > 1 { 0.0625 } else { 0.000_976_562_5 };
        let heavy_energy = claims.potential.map(|kept| kept.energy);
        for (problem, kept) in [(&free, Some(claims.free.energy)), (&heavy, heavy_energy)] {
            if kept == Some(Energy::Drifts) {
                let drift = energy_drift(problem, method.as_ref(), h, 16_000);
                assert!(drift.is_secular(), "{}: no drift in {drift:?}", method.name());
            }
        }
    }
}

/// In double precision: rounding may walk, some hundredths of a unit in the last place in a step, but not always in one
/// direction. A bias of less than a thousandth, from constants or products that are rounded apart, makes 4e-14 here.
#[test]
fn rounding_does_not_bias_an_energy_that_is_kept() {
    let body = Body::free(Inertia::from_moments([1.0, 2.0, 3.0]).unwrap());
    let start = body.state(Default::default(), [0.4, 1.0, -0.3].into()).unwrap();
    for method in catalogue().iter().filter(|m| m.claims().free.energy == Energy::Exact) {
        let mut run = Run::new(method.as_ref(), &body, &start, 0.1).unwrap();
        let end = run.samples(Schedule::every(1_000_000, 1_000_000)).last().unwrap().unwrap();
        assert!(end.worst.energy < 2e-14, "{}: {:e}", method.name(), end.worst.energy);
        assert!(end.worst.momentum.unwrap() < 2e-14, "{}: {:?}", method.name(), end.worst.momentum);
    }
}

/// Largest difference of `steps` steps of kick-drift, in double-double and in `f64`, from the free motion; of the
/// momentum relative to it.
fn errors_of_kick_drift(moments: [f64; 3], omega: [f64; 3], h: f64, steps: u64) -> [f64; 2] {
    let body = Body::free(Inertia::from_moments(moments).unwrap());
    let start = body.enter_omega(Quat::identity(), Vec3(omega)).unwrap();
    let rounded =
        State { attitude: Quat::identity(), momentum_body: Vec3(start.momentum_body.0.map(Dd::hi)) };
    let off = |x: State<Dd>, start: State<Dd>| {
        let exact = FreeMotion::new(&body, start).inside_at_dd(Dd::of(h) * Dd::from(steps));
        let momentum = (x.momentum_body - exact.momentum_body).magnitude() / exact.momentum_body.magnitude();
        (x.attitude - exact.attitude).magnitude().max(momentum)
    };
    let problem = Problem { body: body.clone(), start, span: h, exact: start };
    let precise = *integrate(&problem, &KickDrift, h, steps).last().unwrap();
    let mut quick = rounded;
    KickDrift.prepare_f64(h, &body, &rounded).unwrap().advance_unseen(&mut quick, steps);
    [off(precise, start), off(State::of(quick), State::of(rounded))]
}

/// What a drift gives back to the energy is divided by how far ω is from m; in double-double it is rounding alone.
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
    for method in catalogue().iter().filter(|m| m.claims().free.energy == Energy::Exact) {
        for h in [0.02, 0.03, 0.05, 0.07, 0.1] {
            let mut run = Run::new(method.as_ref(), &body, &start, h).unwrap();
            let end = run.advance_to(10_000).unwrap();
            assert!(end.worst.energy < 1e-14, "{} at {h}: {:e}", method.name(), end.worst.energy);
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
        for method in catalogue().iter().filter(|m| matches!(m.claims().cost, Cost::Solves(_))) {
            let end = Run::new(method.as_ref(), &body, &start, 0.1).unwrap().advance_to(10_000).unwrap();
            assert!(end.worst.energy < 1e-8, "{} {push}: {:e}", method.name(), end.worst.energy);
        }
    }
}

#[test]
fn a_symmetric_method_returns_and_the_others_do_not() {
    for problem in [free(), heavy()] {
        for method in methods() {
            let mut x = problem.start;
            for h in [0.0625, -0.0625] {
                let mut step = method.prepare_dd(h, &problem.body, &x).unwrap();
                for _ in 0..50 {
                    step.step(&mut x);
                }
            }
            let away = (x.momentum_body - problem.start.momentum_body).magnitude()
                + (x.attitude - problem.start.attitude).magnitude();
            let name = method.name();
            if method.claims().symmetric {
                assert!(away < 10.0 * EXACT, "{name} claims to be symmetric and returns {away:.1e} off");
            } else {
                assert!(away > 1e-9, "{name} does not claim to be symmetric, yet returns to {away:.1e}");
            }
        }
    }
}

/// Largest entry of `D B(m) Dᵀ − B(m')` over |m'|, D the derivative of one step, B(m) the Lie–Poisson tensor.
fn poisson_defect(method: &dyn AnyMethod, h: f64) -> f64 {
    let map = |m: Vec3<Dd>| {
        let mut x = State { attitude: Quat::identity(), momentum_body: m };
        method.prepare_dd(h, &body(), &x).unwrap().step(&mut x);
        x.momentum_body
    };
    let m = start().momentum_body;
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
        let defect = poisson_defect(method.as_ref(), 0.25);
        if method.claims().poisson {
            assert!(defect < 1e-20, "{} claims to be Poisson with a defect of {defect:.1e}", method.name());
        } else {
            assert!(
                defect > 1e-7,
                "{} does not claim to be Poisson, yet its defect is {defect:.1e}",
                method.name()
            );
        }
    }
}

thread_local!(static SINES: Cell<u32> = const { Cell::new(0) });

/// A double that counts how often a sine and cosine are taken.
#[derive(Clone, Copy, Debug)]
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

fn sines_of_a_step<M: Method<Counted>>(method: M) -> (u32, Cost) {
    let mut x = State { attitude: Quat::identity(), momentum_body: Vec3([1.0, 0.5, -0.75].map(Counted)) };
    let mut step = method.prepare(0.125, &body(), &x).unwrap();
    SINES.set(0);
    step.step(&mut x);
    (SINES.get(), method.claims().cost)
}

#[test]
fn the_advertised_number_of_turns_is_the_number_of_sines() {
    assert_eq!(sines_of_a_step(LiePoisson { axes: None }), (5, Cost::Turns(5)));
    assert_eq!(sines_of_a_step(Rattle), (0, Cost::Solves(1)));
    let composed = Composed { base: LiePoisson { axes: None }, scheme: SUZUKI_4 };
    assert_eq!(sines_of_a_step(composed), (25, Cost::Turns(25)));
    assert_eq!(sines_of_a_step(Rk4 { normalized: true }), (0, Cost::RightSides(4)));
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
    for method in methods().iter().filter(|method| method.claims().order > 1) {
        for weight in [0.0, 1.0] {
            let (method, name) = (method.as_ref(), method.name());
            assert_eq!(trajectory(1.0, weight, method), trajectory(tiny, weight, method), "{name}");
        }
    }
}

#[test]
fn a_turn_about_a_principal_axis_is_steady_for_every_method() {
    for method in catalogue() {
        for axis in 0..3 {
            let body = body();
            let start = State { attitude: Quat::identity(), momentum_body: Vec3::unit(axis) };
            let mut run = Run::new(method.as_ref(), &body, &start, 0.125).unwrap();
            let sample = run.advance_to(200).unwrap();
            assert_eq!(sample.state.momentum_body, start.momentum_body, "{}", method.name());
        }
    }
}

#[test]
fn invariants_of_a_state_are_those_of_its_formula() {
    let x =
        State { attitude: Quat::from_components([0.5, 0.5, 0.5, 0.5]), momentum_body: Vec3([1.0, 2.0, 4.0]) };
    let body = Body::free(Inertia::from_moments([1.0, 1.0, 1.0]).unwrap());
    let invariants = Invariants::of(&body, &x);
    assert_eq!(invariants.energy.hi(), 10.5);
    assert_eq!(invariants.momentum_squared.hi(), 21.0);
    // a third of a turn about (1, 1, 1) moves each axis to the next
    assert_eq!(invariants.momentum_space.0.map(Dd::hi), [4.0, 1.0, 2.0]);
}

#[test]
fn a_method_without_torque_refuses_a_heavy_body_by_name() {
    struct Free;
    impl Claimed for Free {
        fn name(&self) -> String {
            "free-only".into()
        }
        fn claims(&self) -> Claims {
            Claims { potential: None, ..Rattle.claims() }
        }
    }
    impl<S: Real> Method<S> for Free {
        type Step = <Rattle as Method<S>>::Step;
        fn prepare(&self, h: f64, body: &Body, x: &State<S>) -> Result<Self::Step, StepError> {
            Rattle.prepare(h, body, x)
        }
    }
    let (free, heavy) = (free(), heavy());
    assert!(Free.prepare_dd(0.1, &free.body, &free.start).is_ok());
    let refused = Free.prepare_dd(0.1, &heavy.body, &heavy.start).map(|_| ()).unwrap_err();
    assert_eq!(refused, StepError::Torque { method: "free-only".into() });
    assert!(refused.to_string().contains("weight moment"));
}

#[test]
fn the_monitor_of_a_heavy_body_measures_energy_and_vertical_momentum() {
    let problem = heavy();
    let start = problem.body.state(Default::default(), [0.4, 1.0, -0.3].into()).unwrap();
    let mut run = Run::new(method("rk4").unwrap().as_ref(), &problem.body, &start, 0.1).unwrap();
    let sample = run.advance_to(100).unwrap();
    assert_eq!((sample.worst.momentum, sample.worst.momentum_vector), (None, None));
    assert!(sample.worst.momentum_z.unwrap() > 1e-9 && sample.worst.energy > 1e-9);
    // T(0) + |c| is 0.5 (0.08 + 0.85 + 0.09) + 1
    let kinetic = 0.5 * (0.5 * 0.16 + 0.85 + 0.09);
    let change = (sample.energy - (kinetic + 1.0)) / (kinetic + 1.0);
    approx::assert_relative_eq!(sample.energy_change, change, epsilon = 1e-15);
}

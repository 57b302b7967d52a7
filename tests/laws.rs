//! Every claim of every method, executed; also the claims that say no.
//!
//! The body is tri-axial, the start generic, and everything is measured in double-double, so that an exact law shows
//! as 1e-28 and a broken one cannot hide behind rounding.

#![allow(clippy::unwrap_used, clippy::panic)]

use std::cell::Cell;
use std::ops::{Add, Div, Mul, Neg, Sub};

use polhode::body::{Body, Inertia, State};
use polhode::method::{
    AnyMethod, AxisOrder, Cost, Energy, LiePoisson, Method, Rattle, Rk4, Step, catalogue, method,
};
use polhode::num::{Dd, Real};
use polhode::observe::{Drift, Invariants, secular_drift};
use polhode::rotation::{Quat, Vec3};
use polhode::run::{Run, halvings, observed_order};

/// Invariants that hold in exact arithmetic hold to this in double-double after some hundred steps.
const EXACT: f64 = 1e-28;

fn body() -> Body {
    Body::free(Inertia::from_moments([0.625, 0.75, 1.0]).unwrap())
}

fn start() -> State<Dd> {
    let q = Quat::from_components([0.5, -0.25, 0.75, 0.375].map(Dd::of)).normalized();
    State { attitude: q, momentum_body: Vec3([1.0, 0.5, -0.75].map(Dd::of)) }
}

fn methods() -> Vec<Box<dyn AnyMethod>> {
    let mut methods = catalogue();
    for order in AxisOrder::ALL {
        methods.push(Box::new(LiePoisson { axes: Some(order) }));
    }
    methods
}

/// The states after `steps` steps of `h`, in double-double.
fn integrate(method: &dyn AnyMethod, h: f64, steps: u64) -> Vec<State<Dd>> {
    let mut x = start();
    let mut step = method.prepare_dd(h, &body(), &x).unwrap();
    (0..steps)
        .map(|_| {
            step.step(&mut x);
            x
        })
        .collect()
}

fn energy(x: &State<Dd>) -> Dd {
    let m = x.momentum_body;
    m.dot(m.times(body().inverse_moments())) * Dd::of(0.5)
}

/// |E/E₀ − 1|, ||m|²/|m₀|² − 1|, |L − L₀|/|L₀|, ||q|² − 1|.
fn errors(x: &State<Dd>) -> [f64; 4] {
    let x0 = start();
    let relative = |a: Dd, b: Dd| (a / b - Dd::ONE).magnitude();
    let l = x.momentum_space() - x0.momentum_space();
    [
        relative(energy(x), energy(&x0)),
        relative(x.momentum_body.norm_squared(), x0.momentum_body.norm_squared()),
        (l.norm() / x0.momentum_body.norm()).hi(),
        (x.attitude.norm_squared() - Dd::ONE).magnitude(),
    ]
}

fn worst(states: &[State<Dd>]) -> [f64; 4] {
    states.iter().map(errors).fold([0.0; 4], |w, e| [0, 1, 2, 3].map(|k| f64::max(w[k], e[k])))
}

#[test]
fn each_method_converges_with_its_order_and_no_better() {
    let x = start();
    for method in methods() {
        let claimed = f64::from(method.claims().order);
        let errors = halvings(method.as_ref(), &body(), &x, 2.0, 6..9).unwrap();
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
}

#[test]
fn each_method_keeps_what_it_claims_and_loses_what_it_does_not() {
    for method in methods() {
        let kept = method.claims().free;
        let states = integrate(method.as_ref(), 0.125, 400);
        let [energy, momentum, space, norm] = worst(&states);
        let name = method.name();
        for (what, claimed, error) in [
            ("energy", kept.energy == Energy::Exact, energy),
            ("|m|", kept.momentum, momentum),
            ("L", kept.momentum_space, space),
            ("|q|", kept.norm, norm),
        ] {
            if claimed {
                assert!(error < EXACT, "{name} claims to keep {what} and loses {error:.1e}");
            } else {
                assert!(error > 1e-9, "{name} does not claim to keep {what}, yet its error is {error:.1e}");
            }
        }
    }
}

/// Secular drift of the relative energy error over `steps` steps.
fn energy_drift(method: &dyn AnyMethod, h: f64, steps: u64) -> Drift {
    let states = integrate(method, h, steps);
    let times: Vec<f64> = (0..states.len()).map(|n| n as f64 * h).collect();
    let series: Vec<f64> = states.iter().map(|x| (energy(x) / energy(&start()) - Dd::ONE).hi()).collect();
    secular_drift(&times, &series).unwrap()
}

#[test]
fn bounded_energy_stays_bounded_and_scales_with_the_order() {
    for method in methods().iter().filter(|m| m.claims().free.energy == Energy::Bounded) {
        let amplitude = |h: f64, steps| worst(&integrate(method.as_ref(), h, steps))[0];
        let (coarse, fine) = (amplitude(0.0625, 1600), amplitude(0.03125, 3200));
        let order = libm::log2(coarse / fine);
        let claimed = f64::from(method.claims().order);
        assert!((order - claimed).abs() < 0.05, "{}: energy amplitude of order {order:.3}", method.name());

        let drift = energy_drift(method.as_ref(), 0.0625, 16_000);
        let travelled = drift.slope.abs() * 1000.0;
        assert!(
            !drift.is_secular() && travelled < 0.02 * coarse,
            "{}: energy drifts by {travelled:.1e} in 1000 s, amplitude {coarse:.1e}",
            method.name()
        );
    }
}

#[test]
fn drifting_energy_is_seen_to_drift() {
    for method in methods().iter().filter(|m| m.claims().free.energy == Energy::Drifts) {
        // small steps for first-order methods: at larger ones the error soon is no longer small
        let h = if method.claims().order > 1 { 0.0625 } else { 0.000_976_562_5 };
        let drift = energy_drift(method.as_ref(), h, 16_000);
        assert!(drift.is_secular(), "{}: no drift in {drift:?}", method.name());
    }
}

#[test]
fn a_symmetric_method_returns_and_the_others_do_not() {
    for method in methods() {
        let mut x = start();
        for h in [0.125, -0.125] {
            let mut step = method.prepare_dd(h, &body(), &x).unwrap();
            for _ in 0..50 {
                step.step(&mut x);
            }
        }
        let away = (x.momentum_body - start().momentum_body).magnitude()
            + (x.attitude - start().attitude).magnitude();
        if method.claims().symmetric {
            assert!(away < EXACT, "{} claims to be symmetric and returns {away:.1e} off", method.name());
        } else {
            assert!(
                away > 1e-9,
                "{} does not claim to be symmetric, yet returns to {away:.1e}",
                method.name()
            );
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
    assert_eq!(sines_of_a_step(Rattle), (0, Cost::Solve));
    assert_eq!(sines_of_a_step(Rk4 { normalized: true }), (0, Cost::RightSides(4)));
}

#[test]
fn scaling_the_mass_by_a_power_of_two_changes_no_bit() {
    let tiny = 1.0 / (1_u64 << 40) as f64;
    let trajectory = |scale: f64, name: &str| {
        let body = Body::free(Inertia::from_moments([1.0, 2.0, 3.0].map(|i| i * scale)).unwrap());
        let start = body.state(Default::default(), [0.4, 1.0, -0.3].into()).unwrap();
        let mut run = Run::new(method(name).unwrap().as_ref(), &body, &start, 0.1).unwrap();
        let sample = run.advance_to(1000).unwrap();
        (
            sample.state.attitude,
            sample.state.momentum_body * (1.0 / scale),
            sample.worst,
            sample.energy / scale,
        )
    };
    for method in methods().iter().filter(|method| method.claims().order > 1) {
        assert_eq!(trajectory(1.0, &method.name()), trajectory(tiny, &method.name()), "{}", method.name());
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

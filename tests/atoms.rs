//! The exact flows that splittings are made of, used from outside, and what a free part of one's own may claim.

use polhode::body::{Body, Conserved, Field, Point, Problem, Rotor, Time};
use polhode::flow::{Casimir, Flow, FreeBody, FreeFlow, FreeMotion, SymmetricTop, Turn};
use polhode::inertia::{Inertia, InertiaError};
use polhode::method::schemes::{STRANG, SUZUKI_4, Scheme};
use polhode::method::{
    AnyMethod, AxisSplit, Claimed, Claims, Cost, Energy, FreePart, InTurn, Kept, Kicks, KineticSplit, Method,
    Splitting, Symmetric, schemes,
};
use polhode::num::{Dd, Precise, Real};
use polhode::rotation::{Quat, Vec3};
use polhode::run::Run;

const MOMENTS: [f64; 3] = [1.0, 1.25, 1.75];

fn now() -> Time {
    Time::from_seconds(0.0)
}

fn start<S: Real>() -> Point<S> {
    Point::new(Quat::identity(), Vec3([0.4, 1.0, -0.3].map(S::of)))
}

/// The largest difference of a component.
fn apart<S: Precise>(x: &Point<S>, y: &Point<S>) -> f64 {
    (x.attitude - y.attitude).magnitude().max((x.momentum_body - y.momentum_body).magnitude())
}

#[test]
fn each_flow_is_a_flow_and_keeps_momentum_in_space() {
    let rotor = Rotor::new(MOMENTS).unwrap();
    let [turn, ..] = Turn::<Dd>::of(&rotor);
    let [ball, ..] = Casimir::<Dd>::of(&rotor);
    let top = SymmetricTop::<Dd>::about::<1>(Dd::of(0.7), Dd::of(3.0));
    let flows: [&dyn Flow<Dd>; 5] = [&turn, &ball, &top, &FreeFlow::new(&rotor), &FreeBody::new(&rotor)];
    for (n, flow) in flows.into_iter().enumerate() {
        let (mut once, mut twice) = (start(), start());
        flow.flow(now(), Dd::of(2.0), &mut once);
        flow.flow(now(), Dd::of(-0.5), &mut twice);
        flow.flow(now(), Dd::of(2.5), &mut twice);
        assert!(apart(&once, &twice) < 1e-29, "flow {n}");
        let turned = once.momentum_space() - start::<Dd>().momentum_space();
        assert!(turned.magnitude() < 1e-29, "flow {n}: L turned by {turned:?}");
        assert!(apart(&once, &start()) > 0.1, "flow {n} does nothing");
    }
}

#[test]
fn a_symmetric_top_is_a_ball_and_a_turn() {
    let (c, a) = (Dd::of(0.7), Dd::of(3.0));
    let (mut whole, mut parts) = (start::<Dd>(), start::<Dd>());
    SymmetricTop::about::<1>(c, a).flow(now(), Dd::of(1.5), &mut whole);
    Turn::about::<1>(Dd::ONE / c - Dd::ONE / a).flow(now(), Dd::of(1.5), &mut parts);
    Casimir::new(Dd::ONE / a).flow(now(), Dd::of(1.5), &mut parts);
    assert!(apart(&whole, &parts) < 1e-30);
    // and that of a body with two equal moments is its free motion
    let rotor = Rotor::new([3.0, 0.7, 3.0]).unwrap();
    let mut free = start::<Dd>();
    SymmetricTop::new(&rotor).unwrap().flow(now(), Dd::of(1.5), &mut free);
    SymmetricTop::about::<1>(Dd::of(0.7), a).flow(now(), Dd::of(-1.5), &mut free);
    assert!(apart(&free, &start()) < 1e-30);
}

#[test]
fn a_million_turns_leave_the_size_of_the_momentum_to_rounding() {
    let [x_turn, y_turn, _] = Turn::<f64>::of(&Rotor::new(MOMENTS).unwrap());
    let mut x = start::<f64>();
    for _ in 0..500_000 {
        x_turn.flow(now(), 0.01, &mut x);
        y_turn.flow(now(), 0.01, &mut x);
        x.renormalize_at_times();
    }
    let error = x.momentum_body.norm() / start::<f64>().momentum_body.norm() - 1.0;
    assert!(error.abs() < 1e-15, "{error:e}");
}

/// Turns about the three axes, as `lie-poisson:123` takes them.
#[derive(Clone)]
struct ThreeTurns;

impl KineticSplit for ThreeTurns {
    type Flows<S: Precise> = [Turn<S>; 3];
    fn name(&self) -> String {
        "three-turns".into()
    }
    fn flows<S: Precise>(&self, rotor: &Rotor) -> [Turn<S>; 3] {
        Turn::of(rotor)
    }
}

/// A symmetric top, and a turn for what the body lacks of one.
#[derive(Clone)]
struct TurnAndTop;

impl KineticSplit for TurnAndTop {
    type Flows<S: Precise> = (Turn<S>, SymmetricTop<S>);
    fn name(&self) -> String {
        "turn-and-top".into()
    }
    fn flows<S: Precise>(&self, rotor: &Rotor) -> Self::Flows<S> {
        let [i1, i2, i3] = rotor.moments::<Dd>().0;
        (Turn::about::<0>((i2 - i1) / (i1 * i2)), SymmetricTop::about::<2>(i3, i2))
    }
}

fn body() -> Body {
    Body::free(Inertia::from_moments(MOMENTS).unwrap())
}

/// The distance of the attitude from the exact one after 20 s, rad.
fn error(method: &dyn AnyMethod, h: f64) -> f64 {
    let body = body();
    let start = body.state(Default::default(), [0.4, 1.0, -0.3].into()).unwrap();
    let end = Run::new(method, &body, &start, h).unwrap().advance_to((20.0 / h) as u64).unwrap();
    let exact = FreeMotion::from_state(body.inertia(), &start).unwrap().at(20.0).unwrap();
    end.state.rotation().angle_to(&exact.rotation())
}

#[test]
fn turns_of_a_user_are_those_of_lie_poisson() {
    let mine = Splitting::of_flows(ThreeTurns, STRANG).unwrap();
    let axes = Some("123".parse().unwrap());
    let known = Splitting::strang(AxisSplit { axes }, Kicks);
    let (mine, known) = (error(&mine, 0.125), error(&known, 0.125));
    assert!(known > 1e-3 && (mine - known).abs() < 1e-12, "{mine} {known}");
}

#[test]
fn a_splitting_of_flows_has_order_2_and_that_of_its_scheme() {
    for (scheme, order) in [(STRANG, 2), (SUZUKI_4, 4)] {
        let method = Splitting::of_flows(TurnAndTop, scheme).unwrap();
        let claims = method.claims(Problem::Free).unwrap();
        assert!(claims.order == Some(order) && claims.symmetric && claims.poisson && claims.symplectic);
        let ratio = error(&method, 0.125) / error(&method, 0.0625);
        let expected = f64::from(1 << order);
        assert!((ratio / expected - 1.0).abs() < 0.1, "{}: {ratio}", method.name());
    }
    assert_eq!(<(Turn<f64>, SymmetricTop<f64>) as InTurn<f64>>::COUNT, 2);
    assert!(Splitting::of_flows(TurnAndTop, schemes::SRKN_6B).is_err());
}

/// The turns with claims of one's own.
#[derive(Clone)]
struct Modest;

impl Symmetric for Modest {}

impl FreePart for Modest {
    fn name(&self) -> String {
        "modest".into()
    }
    fn order(&self) -> Option<u32> {
        Some(2)
    }
    fn energy(&self) -> Energy {
        Energy::Drifts
    }
    fn kept(&self) -> Kept {
        let mut kept = Kept::NOTHING;
        kept.norm = true;
        kept.momentum_norm = true;
        kept
    }
    fn poisson(&self) -> bool {
        false
    }
    fn symplectic(&self) -> bool {
        false
    }
    fn cost(&self) -> Cost {
        Cost::turns(1)
    }
    fn source(&self) -> &'static str {
        "a test"
    }
}

impl<S: Precise> Method<S> for Modest {
    type Map<F: Field<S>> = <AxisSplit as Method<S>>::Map<F>;
    fn map<F: Field<S>>(&self, h: Dd, rotor: &Rotor, field: &F) -> Self::Map<F> {
        AxisSplit { axes: None }.map(h, rotor, field)
    }
}

#[test]
fn a_free_part_that_says_what_it_does_not_keep_is_believed() {
    let claims = |scheme: Scheme, problem| -> Claims {
        Splitting::kicked(Modest, scheme).unwrap().claims(problem).unwrap()
    };
    for scheme in [STRANG, SUZUKI_4] {
        let free = claims(scheme, Problem::Free);
        assert!(!free.poisson && !free.symplectic && free.kept == Modest.kept());
        for problem in [Problem::Linear, Problem::Potential] {
            let kept = claims(scheme, problem).kept;
            assert!(!kept.momentum_z && !kept.momentum_norm && kept.norm && kept.energy == Energy::Drifts);
            assert!(!claims(scheme, problem).poisson);
        }
    }
    let kept = Splitting::of_flows(ThreeTurns, STRANG).unwrap().claims(Problem::Linear).unwrap().kept;
    assert!(kept.momentum_z && !kept.momentum_space && kept.energy == Energy::Bounded);
}

#[test]
fn a_rotor_is_in_the_units_that_it_is_given_in() {
    let body = Body::free(Inertia::from_moments([10.0, 20.0, 30.0]).unwrap());
    let rotor = Rotor::new([10.0, 20.0, 30.0]).unwrap();
    assert_eq!(rotor.moments::<f64>().0, [10.0, 20.0, 30.0]);
    assert_eq!((body.rotor().moments::<f64>() * body.scale()).0, [10.0, 20.0, 30.0]);
    let mut mine = Point::new(Quat::identity(), Vec3([4.0, 20.0, -9.0].map(Dd::of)));
    FreeFlow::new(&rotor).flow(now(), Dd::of(1.0), &mut mine);
    let begin = body.state(Default::default(), [0.4, 1.0, -0.3].into()).unwrap();
    let mut inside = body.enter(&begin).unwrap();
    FreeFlow::new(&body.rotor()).flow(now(), Dd::of(1.0), &mut inside);
    assert!((inside.momentum_body * Dd::of(body.scale()) - mine.momentum_body).magnitude() < 1e-29);
}

#[test]
fn moments_that_no_rotor_has_are_refused() {
    assert!(matches!(Rotor::new([1.0, 2.0, 4.0]), Err(InertiaError::Triangle { .. })));
    assert!(matches!(Rotor::new([1.0, 0.0, 1.0]), Err(InertiaError::NotPositive { .. })));
    assert!(matches!(Rotor::new([1.0, f64::NAN, 1.0]), Err(InertiaError::NotFinite { .. })));
    for size in [1e-47, 1e33] {
        assert!(matches!(Rotor::new([size; 3]), Err(InertiaError::FarFromOne { .. })));
        assert!(Inertia::from_moments([size; 3]).is_ok());
    }
    let error = Rotor::new([1e33, 1e33, 1.5e33]).unwrap_err().to_string();
    assert!(error.contains("1.5e33") && error.contains("2^40"), "{error}");
}

#[test]
fn jacobis_constant_is_answered_at_the_rate_of_the_orbit_alone() {
    let gradient = polhode::body::Force::gravity_gradient(0.1, 0.0).unwrap();
    let body = body().with(gradient);
    let start = body.state(Default::default(), [0.1, 0.1, 0.3].into()).unwrap();
    let method = Splitting::of_flows(TurnAndTop, STRANG).unwrap();
    let worst = Run::new(&method, &body, &start, 0.01).unwrap().advance_to(1000).unwrap().worst;
    assert!(worst.of(Conserved::Jacobi { rate: 0.1 }).is_some_and(|error| error < 1e-4));
    assert_eq!(worst.of(Conserved::Jacobi { rate: 123.0 }), None);
}

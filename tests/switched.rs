//! Steps end where forces are switched: methods keep their orders there, and the bits of a run their rules.

use crate::motions::{free, run};
use nalgebra::Vector3;
use polhode::body::{Body, Clock, Force, ForceError, Problem, State};
use polhode::events::Event;
use polhode::inertia::Inertia;
use polhode::method::{AnyMethod, Claimed, catalogue, method};
use polhode::run::{Run, RunError, Watch};

/// On from 0.3 to 1.17 s and from 2 to 2.71 s, and another for ever from 1.17 s on.
const BURNS: [[f64; 2]; 2] = [[0.3, 1.17], [2.0, 2.71]];

fn torque() -> Force {
    Force::constant_torque_body(Vector3::new(0.2, -0.3, 0.5)).unwrap()
}

fn burning() -> (Body, State) {
    let (body, start) = free();
    let drag = Force::drag(0.1, 0.0).unwrap().during([[1.17, f64::INFINITY]]).unwrap();
    (body.with(torque().during(BURNS).unwrap()).with(drag), start)
}

fn for_torques() -> impl Iterator<Item = Box<dyn AnyMethod>> {
    catalogue().into_iter().filter(|method| method.claims(Problem::Torque).is_some())
}

/// By a run of each phase alone, with the forces that act then and no others.
fn reference(end: f64) -> State {
    let (body, mut state) = burning();
    let mut bounds = vec![0.0, 0.3, 1.17, 2.0, 2.71];
    bounds.retain(|t| *t < end);
    bounds.push(end);
    for pair in bounds.windows(2) {
        let mut acting = Body::free(body.inertia().clone());
        if BURNS.iter().any(|burn| burn[0] == pair[0]) {
            acting = acting.with(torque());
        }
        if pair[0] >= 1.17 {
            acting = acting.with(Force::drag(0.1, 0.0).unwrap());
        }
        let clock = Clock { start: pair[0], step: (pair[1] - pair[0]) / 64.0 };
        state = Run::by_clock(&method("gauss:8").unwrap(), &acting, &state, clock)
            .unwrap()
            .at(pair[1])
            .unwrap()
            .state;
    }
    state
}

fn distance(a: &State, b: &State) -> f64 {
    let turn = (a.attitude.conjugate() * b.attitude).v.norm();
    (a.momentum_body - b.momentum_body).norm().max(2.0 * turn)
}

/// Halving the step divides the error by 2^order, although no switch lies on a step.
#[test]
fn every_method_keeps_its_order_across_switches() {
    let exact = reference(3.5);
    assert!(for_torques().count() > 8);
    for method in for_torques().filter(|method| method.tolerance().is_none()) {
        let error = |h: f64| {
            let (body, start) = burning();
            let end = Run::new(&method, &body, &start, h).unwrap().at(3.5).unwrap();
            distance(&end.state, &exact)
        };
        let order = f64::from(method.claims(Problem::Torque).unwrap().order.unwrap());
        let h = if order > 5.0 { 0.25 } else { 0.0625 };
        let errors = [error(h), error(0.5 * h), error(0.25 * h)];
        let measured = libm::log2(errors[0] / errors[2]) / 2.0;
        assert!(
            measured > order - 0.5 || errors[2] < 1e-12,
            "{}: order {measured:.2} for {order}: {errors:?}",
            method.name()
        );
    }
}

#[test]
fn methods_that_choose_their_steps_reach_their_tolerance_across_switches() {
    let exact = reference(3.5);
    for name in ["dop853:1e-12", "tsit5:1e-12", "taylor:1e-15"] {
        let end = run(name, &burning(), 0.7).at(3.5).unwrap();
        assert!(distance(&end.state, &exact) < 1e-10, "{name}: {:e}", distance(&end.state, &exact));
    }
}

/// A spin about one axis: ω grows by the torque times the time that it acts, whatever the step.
#[test]
fn the_impulse_is_that_of_the_intervals() {
    let push = Force::constant_torque_body(Vector3::new(0.0, 0.0, 0.5)).unwrap();
    let body = Body::free(Inertia::from_moments([1.0, 1.0, 2.0]).unwrap());
    let body = body.with(push.during([[0.1, 1.3], [1.3, 2.0], [2.25, 2.5]]).unwrap());
    assert_eq!(body.switching_times(), [0.1, 1.3, 2.0, 2.25, 2.5]);
    let start = body.state(Default::default(), Vector3::zeros()).unwrap();
    for method in for_torques() {
        for h in [4.0, 0.5, 0.3, 0.01] {
            let end = Run::new(&method, &body, &start, h).unwrap().at(4.0).unwrap();
            let expected = 0.25 * (1.2 + 0.7 + 0.25);
            assert!(
                (end.omega_body.z - expected).abs() < 1e-13,
                "{} {h}: {}",
                method.name(),
                end.omega_body.z
            );
        }
    }
}

/// Of each method, at a step that ends at a switch, next to one that is divided, and elsewhere.
#[test]
fn a_run_is_taken_up_anywhere_among_switches() {
    for method in for_torques() {
        for h in [0.39, 0.1, 1.5] {
            let (body, start) = burning();
            let mut straight = Run::new(&method, &body, &start, h).unwrap();
            let last = (4.0_f64 / h) as u64;
            for steps in 0..last {
                straight.advance_to(steps).unwrap();
                let text = straight.checkpoint().to_string();
                let mut resumed = Run::resume(&method, &body, &text.parse().unwrap()).unwrap();
                let end = resumed.advance_to(last).unwrap();
                let expected = Run::new(&method, &body, &start, h).unwrap().advance_to(last).unwrap();
                assert_eq!(
                    (end.point, end.worst),
                    (expected.point, expected.worst),
                    "{} {h} {steps}",
                    method.name()
                );
            }
        }
    }
}

#[test]
fn looking_among_switches_changes_no_bit() {
    for method in for_torques() {
        let (body, start) = burning();
        let new = || Run::new(&method, &body, &start, 0.39).unwrap();
        let plain = new().advance_to(10).unwrap();
        let mut looked = new();
        for k in 0..100 {
            looked.at(0.039 * f64::from(k)).unwrap();
        }
        let end = looked.advance_to(10).unwrap();
        assert_eq!((end.point, end.worst), (plain.point, plain.worst), "{}", method.name());
    }
}

#[test]
fn methods_that_choose_their_steps_do_not_depend_on_the_output() {
    for method in for_torques().filter(|method| method.tolerance().is_some()) {
        let (body, start) = burning();
        let at = |h: f64| Run::new(&method, &body, &start, h).unwrap().at(3.5).unwrap().state;
        assert_eq!(at(3.5), at(0.109_375), "{}", method.name());
    }
}

#[test]
fn a_run_comes_back_through_its_switches() {
    let (body, start) = burning();
    let rk8 = method("rk8").unwrap();
    let end = Run::new(&rk8, &body, &start, 0.01).unwrap().advance_to(350).unwrap();
    let back = Clock { start: 3.5, step: -0.01 };
    let again = Run::by_clock(&rk8, &body, &end.state, back).unwrap().advance_to(350).unwrap();
    assert!(distance(&again.state, &start) < 1e-13, "{:e}", distance(&again.state, &start));
}

#[test]
fn events_are_found_across_switches() {
    let spun =
        Force::constant_torque_body(Vector3::new(0.0, 0.0, 0.5)).unwrap().during([[0.1, 1.3]]).unwrap();
    let body = Body::free(Inertia::from_moments([1.0, 1.0, 2.0]).unwrap()).with(spun);
    let start = body.state(Default::default(), Vector3::new(0.0, 0.0, 0.1)).unwrap();
    for name in ["rk4", "dop853", "taylor", "gauss:4"] {
        for h in [1.0, 0.3] {
            let mut run = Run::new(&method(name).unwrap(), &body, &start, h).unwrap();
            let fast = Event::rate_above(&body, 0.3).unwrap();
            let found = run.until(&fast, 10.0).unwrap().unwrap();
            assert!((found.time.hi() - 0.9).abs() < 1e-13, "{name} {h}: {}", found.time.hi());
            // one that never happens leaves the run at the last step
            assert_eq!(run.until(&Event::rate_above(&body, 0.5).unwrap(), 9.0).unwrap(), None);
            assert_eq!(run.sample().steps, (9.0 / h) as u64);
        }
    }
}

#[test]
fn every_watch_sees_the_same_motion() {
    let (body, start) = burning();
    let at = |watch| {
        let run = Run::new(&method("rk4").unwrap(), &body, &start, 0.39).unwrap();
        run.watching(watch).advance_to(10).unwrap().point
    };
    assert_eq!(at(Watch::EveryStep), at(Watch::Never));
    assert_eq!(at(Watch::EveryStep), at(Watch::AtSamples));
}

#[test]
fn what_cannot_be_switched_is_refused() {
    let nan = f64::NAN;
    for intervals in [
        [[1.0, 1.0], [2.0, 3.0]],
        [[1.0, 2.0], [1.5, 3.0]],
        [[nan, 1.0], [2.0, 3.0]],
        [[0.0, nan], [2.0, 3.0]],
    ] {
        let error = torque().during(intervals).unwrap_err();
        assert!(matches!(error, ForceError::Interval { .. }), "{error}");
    }
    // a method that is not for the torques is refused before the first step, although it begins without them
    let (body, start) = burning();
    let error = Run::new(&method("rattle").unwrap(), &body, &start, 0.1).map(|_| ()).unwrap_err();
    assert!(matches!(error, RunError::Step(_)), "{error}");
}

/// A switched potential is a torque; the inertia of a gravity gradient is still that of the body.
#[test]
fn potentials_and_gradients_can_be_switched() {
    let inertia = Inertia::from_moments([10.0, 25.0, 30.0]).unwrap();
    let gradient = || Force::gravity_gradient(0.5, 0.0).unwrap();
    let always = Body::free(inertia.clone()).with(gradient());
    let switched = Body::free(inertia.clone()).with(gradient().during([[0.0, 2.0]]).unwrap());
    assert_eq!((switched.problem(), switched.conserved().len()), (Problem::Torque, 0));
    let start = always.state(Default::default(), Vector3::new(0.1, 0.2, 0.3)).unwrap();
    let at = |body: &Body, name: &str, n| {
        Run::new(&method(name).unwrap(), body, &start, 0.25).unwrap().advance_to(n).unwrap()
    };
    assert_eq!(at(&always, "rk4", 8).point, at(&switched, "rk4", 8).point);
    let coasting = at(&switched, "rk4", 40);
    let free = Body::free(inertia);
    let by_hand = Run::from_point(
        &method("rk4").unwrap(),
        &free,
        at(&switched, "rk4", 8).point,
        Clock { start: 2.0, step: 0.25 },
    );
    assert_eq!(coasting.state, by_hand.unwrap().advance_to(32).unwrap().state);
}

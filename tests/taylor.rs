//! Taylor's method against closed forms and other methods: its tolerance, its steps, its refusals.

use std::sync::Arc;
use std::sync::atomic::{AtomicU32, Ordering};

use crate::motions::{Magnet, free, magnet, run, satellite, started, top};
use nalgebra::{Matrix3, UnitQuaternion, Vector3};
use polhode::body::{Body, Clock, Force, Orbit, Point, State, Time, Torque};
use polhode::flow::ExactMotion;
use polhode::inertia::Inertia;
use polhode::method::method;
use polhode::num::{Dd, Real};
use polhode::rotation::{Quat, Vec3, rotation_angle};
use polhode::run::{Run, RunError, Watch};

/// Attitude error after the time `t`, output in one step, and the worst error of the energy at the end.
fn errors(name: &str, case: &(Body, State), t: f64) -> [f64; 2] {
    let mut run = run(name, case, t);
    let exact = ExactMotion::from_point(&case.0, run.start().to_dd()).unwrap().point_at_dd(Dd::of(t));
    let end = run.advance_to(1).unwrap();
    [rotation_angle(end.point.to_dd().attitude, exact.attitude).hi(), end.worst.energy.unwrap()]
}

#[test]
fn errors_follow_the_tolerance_down_to_rounding() {
    for (what, case, spin) in [("free", free(), 1.1), ("top", top(), 5.0)] {
        for tolerance in [1e-6, 1e-9, 1e-12] {
            let [attitude, energy] = errors(&format!("taylor:{tolerance:e}"), &case, 100.0);
            println!("{what} {tolerance:e}: attitude {attitude:.1e}, energy {energy:.1e}");
            // some hundred steps, and what is lost of the momentum turns the attitude from then on
            assert!(attitude < 100.0 * tolerance && attitude > 1e-3 * tolerance, "{attitude:e}");
            assert!(energy < 10.0 * tolerance && energy > 1e-4 * tolerance, "{energy:e}");
        }
        let [attitude, energy] = errors("taylor", &case, 1000.0);
        println!("{what} to rounding, at 1000 s: attitude {attitude:.1e}, energy {energy:.1e}");
        assert!(attitude < 1e-15 * spin * 1000.0 && energy < 5e-15, "{attitude:e}, {energy:e}");
    }
}

/// Axes that are not principal, a circle that is run through clockwise, which has recurrences of its own, and a hyperbola, whose law is
/// taken on series beside it.
fn pulled_from_two_sides() -> (Body, State) {
    let tensor = Matrix3::new(10.0, 1.0, -2.0, 1.0, 25.0, 3.0, -2.0, 3.0, 30.0);
    let hyperbola = Orbit::conic(4e-6, 2.0, 1.7).unwrap().passing_at(3000.0).unwrap();
    let body = Body::free(Inertia::from_tensor(tensor).unwrap())
        .with(Force::gravity_gradient(-0.001, 0.0).unwrap())
        .with(Force::gravity_gradient_on(hyperbola.in_plane([0.3, 0.8, 1.1]).unwrap()));
    started(body, [2e-4, -3e-4, 1.2e-3])
}

/// Two methods of different kinds in double-double: laws on series, times and orbits on series, axes that are not principal.
#[test]
fn forces_on_series_are_those_of_a_composition_in_double_double() {
    for (what, (body, start), t, most) in [
        ("magnet", magnet(), 4.0, 1e-22),
        ("satellite", satellite(), 4000.0, 1e-22),
        (
            "satellite on a tensor",
            {
                let (body, start) = satellite();
                (body.with(Force::potential("m", Magnet(1e-5))), start)
            },
            4000.0,
            1e-22,
        ),
        ("satellite pulled from two sides", pulled_from_two_sides(), 4000.0, 1e-22),
    ] {
        let end = |name: &str, steps: u64| {
            let mut x = body.enter(&start).unwrap();
            let clock = Clock { start: 0.25 * t, step: t / steps as f64 };
            method(name).unwrap().prepare_dd(clock, &body).unwrap().steps(&mut x, steps);
            x
        };
        let expected = end("kick-drift@sofroniou-spaletta-10", 256);
        for (name, steps) in [("taylor", 4), ("taylor:30", 64)] {
            let found = end(name, steps);
            let off = rotation_angle(found.attitude, expected.attitude).hi();
            println!("{what}, {name}: {off:.1e}");
            assert!(off < most, "{what}, {name}: {off:.1e}");
        }
    }
}

#[test]
fn a_checkpoint_whose_memory_is_broken_is_refused() {
    let case = free();
    let mut run = run("taylor", &case, 0.01);
    run.advance_to(777).unwrap();
    let text = run.checkpoint().to_string();
    for broken in [text.replace("memory ", "memory x"), text.replace("memory ", "memories ")] {
        let error = broken.parse::<polhode::run::Checkpoint>().unwrap_err().to_string();
        assert!(error.ends_with("it must hold numbers, or - where there are none"), "{error}");
    }
    let line = text.lines().find(|line| line.starts_with("memory ")).unwrap();
    let short: polhode::run::Checkpoint = text.replace(line, "memory 0.0").parse().unwrap();
    let error = Run::resume(&method("taylor").unwrap(), &case.0, &short).err().unwrap().to_string();
    let expected = "the checkpoint holds 1 numbers that the method remembers, and the method needs 2";
    assert_eq!(error, expected);
}

#[test]
fn a_steady_spin_keeps_its_momentum_to_the_last_bit() {
    for axis in 0..3 {
        let mut omega = [0.0; 3];
        omega[axis] = 1.5;
        let (body, start) = started(free().0, omega);
        let mut run = run("taylor", &(body.clone(), start), 1000.0);
        let exact = ExactMotion::from_point(&body, run.start().to_dd()).unwrap().point_at_dd(Dd::of(1000.0));
        let end = run.advance_to(1).unwrap();
        assert_eq!(end.point.momentum_body, run.start().momentum_body);
        let off = rotation_angle(end.point.to_dd().attitude, exact.attitude).hi();
        println!("axis {axis}: {off:.1e}");
        assert!(off < 2e-13, "{off:e}");
    }
}

/// A series of order 20 for each step, and the one that the end falls into; whatever the interval of output.
#[test]
fn work_is_that_of_the_steps_that_are_chosen() {
    let works = [0.25, 2.0, 64.0].map(|h| {
        let mut run = run("taylor", &top(), h).watching(Watch::Never);
        run.advance_to((64.0 / h) as u64).unwrap();
        run.work().unwrap()
    });
    let [work, ..] = works;
    assert_eq!((work.evaluations, work.rejected), (20 * (work.accepted + 1), 0));
    assert!(work.accepted > 64 && works == [work; 3], "{works:?}");
    assert_eq!(run("taylor:20", &top(), 0.25).work(), None);
}

#[test]
fn a_body_at_rest_stays_falls_and_is_pushed() {
    // nothing acts: one series for all times
    let case = started(free().0, [0.0; 3]);
    assert_eq!(run("taylor", &case, 1e9).advance_to(5).unwrap().state, case.1);
    // hanging: the torque is zero, and the weight is not
    let inertia = Inertia::from_moments([1.0, 2.0, 2.5]).unwrap();
    let hanging = Body::heavy(inertia.clone(), [0.0, 0.0, -1.0].into()).unwrap();
    let start = hanging.state(UnitQuaternion::identity(), Vector3::zeros()).unwrap();
    assert_eq!(run("taylor", &(hanging.clone(), start), 100.0).advance_to(3).unwrap().state, start);
    // released: its energy is kept
    let mut falling = run("taylor", &started(hanging, [0.0; 3]), 0.1);
    let end = falling.advance_to(10_000).unwrap();
    assert!(end.worst.energy.unwrap() < 2e-14 && end.momentum_norm > 1e-3, "{:?}", end.worst);
    // pushed along an axis: ω = τ t/I and half of that times t
    let push = Force::constant_torque_body([0.0, 0.0, 0.5].into()).unwrap();
    let pushed = Body::free(inertia).with(push);
    let start = pushed.state(UnitQuaternion::identity(), Vector3::zeros()).unwrap();
    for t in [0.5, 8.0, 64.0] {
        let end = run("taylor", &(pushed.clone(), start), t).advance_to(1).unwrap();
        let angle = 0.5 * 0.2 * t * t;
        let expected = UnitQuaternion::from_axis_angle(&Vector3::z_axis(), angle);
        assert!((end.omega_body.z - 0.2 * t).abs() < 1e-14 * t, "{t}: {}", end.omega_body.z - 0.2 * t);
        let off = end.state.rotation().angle_to(&expected);
        assert!(off < 1e-15 * angle.max(10.0), "{t}: {off:e}");
    }
}

#[test]
fn backwards_is_where_it_came_from() {
    // the magnet tumbles, and what rounding takes grows with it
    for ((body, start), steps) in [(free(), 400), (top(), 400), (magnet(), 100)] {
        for name in ["taylor", "taylor:20"] {
            let first = body.enter(&start).unwrap().to_f64();
            let mut x = first;
            for clock in [Clock::new(0.25), Clock { start: 0.25 * steps as f64, step: -0.25 }] {
                x = Point::new(x.attitude, x.momentum_body);
                method(name).unwrap().prepare_f64(clock, &body).unwrap().steps(&mut x, steps);
            }
            let off = rotation_angle(x.attitude, first.attitude);
            println!("{name}: {off:.1e}");
            assert!(off < 1e-12, "{name}: {off:e}");
        }
    }
}

#[test]
fn orders_and_tolerances_that_there_are_not_are_refused() {
    for name in [
        "taylor:7",
        "taylor:41",
        "taylor:0",
        "taylor:1e-17",
        "taylor:0.5",
        "taylor:x",
        "taylor:NaN",
        "taylor:-1e-9",
    ] {
        let error = method(name).err().unwrap().to_string();
        assert_eq!(
            error,
            format!(
                "method {name:?} cannot take this argument; allowed: an order from 8 to 40, such as taylor:20, or a \
                 tolerance from 1.2e-16, as the rounding of a double is 1.1e-16, to 1e-3, such as taylor:1e-12"
            )
        );
    }
    assert_eq!(
        polhode::method::Taylor::of_order(7).unwrap_err().to_string(),
        "there is no Taylor method of order 7; there are the orders from 8 to 40"
    );
    assert_eq!(
        polhode::method::AdaptiveTaylor::of_tolerance(1e-20).unwrap_err().to_string(),
        "the tolerance 1e-20 of taylor must be from 1.2e-16, as the rounding of a double is 1.1e-16, to 1e-3"
    );
    for name in ["taylor", "taylor:8", "taylor:40", "taylor:1e-12", "taylor:1e-3", "taylor:1.2e-16"] {
        assert_eq!(method(name).unwrap().name(), name);
    }
    assert!(method("taylor@suzuki-4").err().unwrap().to_string().contains("is not symmetric"));
}

#[test]
fn closures_are_refused_and_singular_laws_end_a_run() {
    let closure = Force::torque_fn("thruster", |_, _, _| Vector3::new(0.0, 0.0, 0.5));
    let (body, start) = free();
    for name in ["taylor", "taylor:20"] {
        let error =
            Run::new(&method(name).unwrap(), &body.clone().with(closure.clone()), &start, 0.1).err().unwrap();
        assert_eq!(
            error.to_string(),
            format!(
                "method {name:?} cannot take thruster, a closure in f64: it evaluates laws on power series; write the law for \
                 every Real, or use rk4 or, for a potential, kick-drift"
            )
        );
    }
    // √(5 − t) has no series at t = 5, and is no number beyond, where a step may end whose last terms it does not change
    struct Fading;
    impl<S: Real> Torque<S> for Fading {
        fn torque(&self, at: Time, _: Quat<S>, _: Vec3<S>) -> Vec3<S> {
            Vec3::unit(2) * (S::of(5.0) - at.seconds::<S>()).sqrt()
        }
    }
    let fading = (body.clone().with(Force::torque("fading", Fading)), start);
    for watch in [Watch::EveryStep, Watch::AtSamples, Watch::Never] {
        let error = run("taylor", &fading, 0.5).watching(watch).advance_to(100).unwrap_err();
        let RunError::Force { force, time, .. } = error else { panic!("{error}") };
        assert!(force == "fading" && (time - 5.0).abs() < 1e-3, "{force}, {time}");
    }
    // |ω| has none where a body begins to turn
    let drag = body.with(Force::drag(0.0, 0.1).unwrap());
    let drag = drag.with(Force::constant_torque_body([0.0, 0.0, 1.0].into()).unwrap());
    let error = run("taylor", &started(drag, [0.0; 3]), 0.5).advance_to(100).unwrap_err();
    let RunError::Force { force, time, .. } = error else { panic!("{error}") };
    assert_eq!((force.as_str(), time), ("drag", 0.0));
}

/// A law that counts how often it is evaluated on series.
struct Counted(Arc<AtomicU32>);

impl<S: Real> Torque<S> for Counted {
    fn torque(&self, _: Time, _: Quat<S>, omega_body: Vec3<S>) -> Vec3<S> {
        self.0.fetch_add(1, Ordering::Relaxed);
        omega_body * S::of(-0.1)
    }
}

#[test]
fn a_step_evaluates_a_law_once() {
    let count = Arc::new(AtomicU32::new(0));
    let (body, start) = free();
    let body = body.with(Force::torque("counted", Counted(count.clone())));
    for name in ["taylor:12", "taylor:30", "taylor"] {
        let method = method(name).unwrap();
        let mut x = body.enter(&start).unwrap().to_f64();
        let mut step = method.prepare_f64(Clock::new(0.01), &body).unwrap();
        count.store(0, Ordering::Relaxed);
        step.steps(&mut x, 1);
        assert_eq!(count.load(Ordering::Relaxed), 1, "{name}");
    }
}

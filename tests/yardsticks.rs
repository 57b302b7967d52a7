//! The general-purpose methods against closed forms: tolerances, dense output, steps of their own, checkpoints, refusals.

use crate::motions::{free, run, started, thruster, top};
use nalgebra::{UnitQuaternion, Vector3};
use polhode::body::{Body, Clock, Force, Point, State, Time, Torque};
use polhode::flow::ExactMotion;
use polhode::inertia::Inertia;
use polhode::method::{Dop853, Tsit5, method};
use polhode::num::{Dd, Real};
use polhode::rotation::{Quat, Vec3, rotation_angle};
use polhode::run::{RunError, Watch};

const ADAPTIVE: [&str; 4] = ["dop853", "dop853:1e-12", "tsit5", "tsit5:1e-9"];

/// Attitude error after the time `t`, with `steps` outputs on the way.
fn attitude_error(name: &str, case: &(Body, State), t: f64, steps: u64) -> f64 {
    let mut run = run(name, case, t / steps as f64).watching(Watch::Never);
    let exact = ExactMotion::from_point(&case.0, run.start().to_dd()).unwrap().point_at_dd(Dd::of(t));
    let end = run.advance_to(steps).unwrap();
    rotation_angle(end.point.to_dd().attitude, exact.attitude).hi()
}

#[test]
fn errors_follow_the_tolerance() {
    for (what, case) in [("free", free()), ("top", top())] {
        for (name, tolerances) in
            [("dop853", [1e-6, 1e-8, 1e-10, 1e-12]), ("tsit5", [1e-4, 1e-6, 1e-8, 1e-10])]
        {
            for tolerance in tolerances {
                let error = attitude_error(&format!("{name}:{tolerance:e}"), &case, 100.0, 1);
                println!("{what} {name} {tolerance:e}: {error:.1e}");
                // some hundred steps, and what is lost of the momentum turns the attitude from then on
                assert!(
                    error < 2000.0 * tolerance && error > tolerance,
                    "{what} {name} {tolerance:e}: {error:e}"
                );
            }
        }
    }
}

/// Within one step whose length is set by what a map remembers, against the exact motion, in double-double: the local error is
/// of one order more than the dense output.
#[test]
fn dense_output_is_of_the_order_that_it_has() {
    for (name, order) in [("dop853:1e-3", 7.0), ("tsit5:1e-3", 4.0)] {
        let error = |halvings: i32| {
            let body = Body::free(Inertia::from_moments([0.625, 0.75, 1.0]).unwrap());
            let start = Point::new(Quat::identity(), Vec3([1.0, 0.5, -0.75].map(Dd::of)));
            let method = method(name).unwrap();
            let length = libm::scalbn(0.25, -halvings);
            let mut step = method.prepare_dd(Clock::new(length * 0.3), &body).unwrap();
            let mut x = start;
            step.open(&mut x);
            step.remember(&[0.0, 0.0, length, 1e-4]);
            step.advance(&mut x, 1);
            let found = step.reading(&x);
            assert_eq!(step.work().unwrap().accepted, 1);
            let exact = ExactMotion::from_point(&body, start).unwrap().point_at_dd(Dd::of(length * 0.3));
            let attitude = rotation_angle(found.attitude, exact.attitude).hi();
            let momentum = (found.momentum_body - exact.momentum_body).magnitude();
            [attitude, momentum]
        };
        for k in 1..5 {
            let (coarse, fine) = (error(k), error(k + 1));
            for (coarse, fine) in coarse.into_iter().zip(fine) {
                let slope = libm::log2(coarse / fine);
                println!("{name}: {coarse:.1e} {fine:.1e}, local order {slope:.3}");
                if k > 2 {
                    assert!((slope - order - 1.0).abs() < 0.02 * (order + 1.0), "{name}: {slope}");
                }
            }
        }
    }
}

/// The floor of rounding: in steps as small as these nothing else is left after 1e4 s.
#[test]
fn fixed_steps_of_order_8_lose_little_to_rounding() {
    for h in [0.02, 0.0125, 0.00625] {
        let error = attitude_error("rk8", &level(), 1e4, (1e4 / h) as u64);
        println!("rk8, h = {h}: {error:.1e} rad after 1e4 s");
        assert!(error < 6e-11, "{h}: {error:e}");
    }
}

fn level() -> (Body, State) {
    let (body, _) = free();
    let start = body.state(UnitQuaternion::identity(), Vector3::new(0.4, 1.0, -0.3)).unwrap();
    (body, start)
}

#[test]
fn a_steady_spin_keeps_its_momentum_to_the_last_bit() {
    for name in ["rk8", "dop853", "tsit5"] {
        for axis in 0..3 {
            let mut omega = [0.0; 3];
            omega[axis] = 1.5;
            let mut run = run(name, &started(free().0, omega), 0.125);
            let end = run.advance_to(800).unwrap();
            assert_eq!(end.point.momentum_body, run.start().momentum_body);
        }
    }
}

#[test]
fn a_body_at_rest_stays_falls_and_is_pushed() {
    for name in ADAPTIVE {
        let case = started(free().0, [0.0; 3]);
        assert_eq!(run(name, &case, 1e9).advance_to(5).unwrap().state, case.1);
        // hanging: the torque is zero, and the weight is not
        let inertia = Inertia::from_moments([1.0, 2.0, 2.5]).unwrap();
        let hanging = Body::heavy(inertia.clone(), [0.0, 0.0, -1.0].into()).unwrap();
        let start = hanging.state(UnitQuaternion::identity(), Vector3::zeros()).unwrap();
        assert_eq!(run(name, &(hanging.clone(), start), 100.0).advance_to(3).unwrap().state, start);
        // released: its energy is kept within the tolerance of a few hundred steps
        let mut falling = run(name, &started(hanging, [0.0; 3]), 0.1);
        let end = falling.advance_to(1000).unwrap();
        println!("{name}: {:?}", end.worst.energy);
        assert!(end.worst.energy.unwrap() < 1e-3 && end.momentum_norm > 1e-3, "{:?}", end.worst);
        // pushed along an axis: ω = τ t/I
        let push = Force::constant_torque_body([0.0, 0.0, 0.5].into()).unwrap();
        let pushed = Body::free(inertia).with(push);
        let start = pushed.state(UnitQuaternion::identity(), Vector3::zeros()).unwrap();
        for t in [0.5, 8.0] {
            let end = run(name, &(pushed.clone(), start), t).advance_to(1).unwrap();
            let expected = UnitQuaternion::from_axis_angle(&Vector3::z_axis(), 0.1 * t * t);
            assert!(
                (end.omega_body.z - 0.2 * t).abs() < 1e-12 * t,
                "{name} {t}: {}",
                end.omega_body.z - 0.2 * t
            );
            let off = end.state.rotation().angle_to(&expected);
            assert!(off < 1e-4, "{name} {t}: {off:e}");
        }
    }
}

#[test]
fn backwards_is_where_it_came_from_within_the_tolerance() {
    for (name, most) in [("dop853:1e-12", 1e-9), ("tsit5:1e-9", 1e-5), ("rk8", 1e-7)] {
        for (body, start) in [free(), top()] {
            let first = body.enter(&start).unwrap().to_f64();
            let mut x = first;
            for clock in [Clock::new(0.125), Clock { start: 12.5, step: -0.125 }] {
                x = Point::new(x.attitude, x.momentum_body);
                method(name).unwrap().prepare_f64(clock, &body).unwrap().steps(&mut x, 100);
            }
            let off = rotation_angle(x.attitude, first.attitude);
            println!("{name}: {off:.1e}");
            assert!(off < most && off > 1e-16, "{name}: {off:e}");
        }
    }
}

/// A torque that has no value from t = 5 on.
struct Fading;

impl<S: Real> Torque<S> for Fading {
    fn torque(&self, at: Time, _: Quat<S>, _: Vec3<S>) -> Vec3<S> {
        Vec3::unit(2) * (S::of(5.0) - at.seconds::<S>()).sqrt()
    }
}

/// τ = |ω|² ω: the motion is infinite at a finite time.
struct Exploding;

impl<S: Real> Torque<S> for Exploding {
    fn torque(&self, _: Time, _: Quat<S>, omega_body: Vec3<S>) -> Vec3<S> {
        omega_body * omega_body.norm_squared()
    }
}

#[test]
fn a_run_that_cannot_go_on_ends_with_time_state_and_estimate() {
    let (body, start) = free();
    for name in ["dop853", "tsit5"] {
        for watch in [Watch::EveryStep, Watch::AtSamples, Watch::Never] {
            let fading = (body.clone().with(Force::torque("fading", Fading)), start);
            let error = run(name, &fading, 0.5).watching(watch).advance_to(100).unwrap_err();
            let RunError::Force { force, time, last } = error else { panic!("{error}") };
            assert!(
                force == "fading" && time > 5.0 && last.steps == 9,
                "{name}: {force}, {time}, {}",
                last.steps
            );
            let exploding = (body.clone().with(Force::torque("exploding", Exploding)), start);
            let error = run(name, &exploding, 0.125).watching(watch).advance_to(1000).unwrap_err();
            println!("{name}, {watch}: {error}");
            let RunError::Stuck { stuck, last } = error else { panic!("{error}") };
            assert!(stuck.time >= last.time.hi() && stuck.time < last.time.hi() + 0.125, "{stuck:?}");
            assert!(
                stuck.step < 1e-15 && last.state.momentum_body.0.iter().all(|m| m.is_finite()),
                "{stuck:?}"
            );
        }
    }
}

/// A torque of 1e100 N m turns the body by a radian in 1e-50 s.
#[test]
fn a_step_that_would_take_more_steps_than_anybody_waits_for_is_refused() {
    let (body, start) = free();
    for name in ["dop853", "tsit5", "taylor"] {
        for torque in [1e30, 1e100] {
            let torque = Force::constant_torque_body(Vector3::new(0.0, torque, 0.0)).unwrap();
            let error = run(name, &(body.clone().with(torque), start), 1.0).advance_to(1).unwrap_err();
            println!("{name}: {error}");
            let RunError::Stuck { stuck, last } = &error else { panic!("{name}: {error}") };
            assert!(stuck.needed.is_some_and(|needed| needed > 1e10), "{name}: {stuck:?}");
            assert!(last.steps == 0 && stuck.step < 1e-10 && stuck.time < 1e-6, "{name}: {stuck:?}");
            let told = error.to_string();
            assert!(told.contains("within one step of the run (at most 1e10 are allowed)"), "{name}: {told}");
        }
    }
}

#[test]
fn tolerances_that_there_are_not_are_refused() {
    for name in ["dop853:1e-16", "dop853:0.1", "tsit5:x", "tsit5:NaN", "dop853:-1e-9", "tsit5:0"] {
        assert_eq!(
            method(name).err().unwrap().to_string(),
            format!(
                "method {name:?} cannot take this argument; allowed: a tolerance from 1e-15, some roundings of a \
                 double, to 1e-3, such as dop853:1e-12"
            )
        );
    }
    assert_eq!(
        Dop853::of_tolerance(1e-20).unwrap_err().to_string(),
        "the tolerance 1e-20 of dop853 must be from 1e-15, some roundings of a double, to 1e-3"
    );
    assert!(Tsit5::of_tolerance(f64::NAN).is_err());
    for name in ["dop853", "dop853:1e-15", "tsit5", "tsit5:1e-3", "rk8"] {
        assert_eq!(method(name).unwrap().name(), name);
    }
    assert!(method("dop853@suzuki-4").err().unwrap().to_string().contains("is not symmetric"));
    assert!(method("rk8:8").err().unwrap().to_string().contains("takes no argument"));
}

/// Steps of DOP853 cost eleven evaluations and one more once accepted, those of Tsit5 six; two begin a run.
#[test]
fn work_is_counted() {
    for (name, stages, at_end) in [("dop853:1e-6", 11, 1), ("tsit5:1e-6", 6, 0)] {
        let mut run = run(name, &thruster(), 0.01).watching(Watch::Never);
        run.advance_to(1).unwrap();
        let first = run.work().unwrap();
        run.advance_to(1000).unwrap();
        let work = run.work().unwrap();
        println!("{name}: {work:?}");
        assert!(work.rejected > 0 && work.accepted > 10, "{name}: {work:?}");
        let steps = stages * (work.accepted + work.rejected) + at_end * work.accepted;
        let dense = work.evaluations - steps - 2;
        assert!(dense <= 6, "{name}: {first:?} {work:?}");
    }
    assert_eq!(run("rk4", &free(), 0.01).work(), None);
}

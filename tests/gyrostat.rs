//! Bodies with wheels: every way to follow them against Taylor series in double-double, and what body and wheels keep together.

use nalgebra::{Matrix3, UnitQuaternion, Vector3};
use polhode::body::{Body, Clock, Conserved, Force, Problem, State, Wheel, WheelAtStart, WheelError};
use polhode::flow::{ExactMotion, FreeMotion, GyrostatMotion, NoClosedForm, TimeError};
use polhode::inertia::Inertia;
use polhode::method::{Claimed, StepError, catalogue, method};
use polhode::num::Dd;
use polhode::rotation::Quat;
use polhode::run::{Ensemble, EnsembleError, Rows, Run};

fn tensor() -> Matrix3<f64> {
    Matrix3::new(10.0, -0.5, 0.25, -0.5, 12.0, 0.75, 0.25, 0.75, 15.0)
}

fn wheel(axis: [f64; 3], inertia: f64, speed: f64) -> Wheel {
    Wheel::new(axis.into(), inertia, speed).unwrap()
}

const OMEGA: Vector3<f64> = Vector3::new(0.3, -0.2, 0.5);

fn body(wheels: &[Wheel]) -> Body {
    let bare = Body::free(Inertia::from_tensor(tensor()).unwrap());
    wheels.iter().fold(bare, |body, wheel| body.with_wheel(*wheel).unwrap())
}

fn start(body: &Body) -> State {
    let attitude = UnitQuaternion::from_euler_angles(0.3, -0.8, 1.9);
    body.state(attitude, OMEGA).unwrap()
}

fn held() -> Body {
    body(&[wheel([1.0, 2.0, -2.0], 0.05, 60.0), wheel([0.0, 0.0, 1.0], 0.1, -25.0)])
}

/// The motion by the equations of Hughes, Spacecraft Attitude Dynamics, §3.5, written anew: the classical Runge-Kutta method on ω, q and
/// the axial momenta of wheels.
fn by_hand(wheels: &[(Vector3<f64>, f64, f64, Option<f64>)], t: f64, steps: u32) -> ([f64; 4], Vector3<f64>) {
    // the state: ω, the rate Ω of each wheel against the body, the quaternion
    let rate = |omega: Vector3<f64>, speeds: &[f64], q: [f64; 4]| {
        // I ω' + Σ J a Ω' = −ω × (I ω + Σ J a Ω), J (Ω' + a·ω') = T of a wheel that is free, Ω' = 0 of one that is held
        let mut momentum = tensor() * omega;
        let (mut left, mut motors) = (tensor(), Vector3::zeros());
        for ((axis, inertia, _, drive), speed) in wheels.iter().zip(speeds) {
            momentum += axis * (inertia * speed);
            if let Some(torque) = drive {
                left -= axis * axis.transpose() * *inertia;
                motors += axis * *torque;
            }
        }
        let acceleration = left.try_inverse().unwrap() * (-omega.cross(&momentum) - motors);
        let spin_up: Vec<f64> = wheels
            .iter()
            .map(|(axis, inertia, _, drive)| {
                drive.map_or(0.0, |torque| torque / inertia - axis.dot(&acceleration))
            })
            .collect();
        let [w, x, y, z] = q;
        let [a, b, c] = [omega.x, omega.y, omega.z];
        let turn =
            [-x * a - y * b - z * c, w * a + y * c - z * b, w * b + z * a - x * c, w * c + x * b - y * a];
        (acceleration, spin_up, turn.map(|v| 0.5 * v))
    };
    let q0 = UnitQuaternion::from_euler_angles(0.3, -0.8, 1.9);
    let mut state = (OMEGA, wheels.iter().map(|wheel| wheel.2).collect::<Vec<_>>(), [q0.w, q0.i, q0.j, q0.k]);
    let h = t / f64::from(steps);
    type Rate = (Vector3<f64>, Vec<f64>, [f64; 4]);
    let moved = |x: &Rate, k: &Rate, h: f64| -> Rate {
        let speeds = x.1.iter().zip(&k.1).map(|(a, b)| a + h * b).collect();
        (x.0 + k.0 * h, speeds, [0, 1, 2, 3].map(|n| x.2[n] + h * k.2[n]))
    };
    for _ in 0..steps {
        let of = |x: &Rate| rate(x.0, &x.1, x.2);
        let k1 = of(&state);
        let k2 = of(&moved(&state, &k1, 0.5 * h));
        let k3 = of(&moved(&state, &k2, 0.5 * h));
        let k4 = of(&moved(&state, &k3, h));
        for (k, weight) in [(k1, 1.0), (k2, 2.0), (k3, 2.0), (k4, 1.0)] {
            state = moved(&state, &k, weight * h / 6.0);
        }
    }
    (state.2, state.0)
}

fn distance(end: &State, q: [f64; 4]) -> f64 {
    let [w, i, j, k] = q;
    end.rotation().angle_to(&UnitQuaternion::from_quaternion(nalgebra::Quaternion::new(w, i, j, k)))
}

#[test]
fn wheels_held_free_and_driven_move_the_body_as_the_equations_of_body_and_wheels_say() {
    let axes = [Vector3::new(1.0, 2.0, -2.0) / 3.0, Vector3::z()];
    let of = |drives: [Option<f64>; 2]| {
        let wheels = [(axes[0], 0.05, 60.0, drives[0]), (axes[1], 0.1, -25.0, drives[1])];
        let built = wheels.map(|(axis, inertia, speed, drive)| {
            let wheel = Wheel::new(axis, inertia, speed).unwrap();
            match drive {
                None => wheel,
                Some(0.0) => wheel.free(OMEGA),
                Some(torque) => wheel.driven(torque, [0.0, f64::INFINITY], OMEGA).unwrap(),
            }
        });
        (wheels, body(&built))
    };
    for drives in
        [[None, None], [Some(0.0), None], [Some(0.0), Some(0.0)], [Some(0.3), None], [Some(-0.2), Some(0.1)]]
    {
        let (wheels, body) = of(drives);
        let end =
            Run::new(&method("taylor").unwrap(), &body, &start(&body), 0.5).unwrap().advance_to(40).unwrap();
        let (q, omega) = by_hand(&wheels, 20.0, 40_000);
        assert!(distance(&end.state, q) < 1e-11, "{drives:?}: {:e}", distance(&end.state, q));
        assert!((end.omega_body - omega).norm() < 1e-11, "{drives:?}");
        // the hand's own error is 1e-13: another sign of h or of a motor would be off by radians
        let momentum = body.momentum_space(20.0, &end.state);
        assert!((momentum - body.momentum_space(0.0, &start(&body))).norm() < 1e-12 * momentum.norm());
    }
}

/// Every method that takes wheels converges to the motion by Taylor series in double-double, in f64 and with its scheme.
#[test]
fn methods_agree_on_bodies_with_wheels_or_refuse_them_by_name() {
    let (body, mut refused) = (held(), Vec::new());
    let end_of = |name: &str, h: f64, steps: u64| {
        Run::new(&method(name).unwrap(), &body, &start(&body), h).unwrap().advance_to(steps).unwrap()
    };
    let truth = end_of("taylor", 0.5, 8);
    for method in catalogue() {
        let order = method.claims(Problem::Gyrostat).map(|claims| claims.order);
        let run = Run::new(&method, &body, &start(&body), 1.0 / 512.0);
        match (order, run) {
            (None, Err(error)) => {
                assert!(error.to_string().contains("cannot take wheels"), "{error}");
                refused.push(method.name());
            }
            (Some(order), Ok(mut run)) => {
                let end = run.advance_to(2048).unwrap();
                let error = end.state.rotation().angle_to(&truth.state.rotation());
                let limit = if order == Some(1) { 0.1 } else { 1e-4 };
                assert!(error < limit, "{}: {error:e}", method.name());
                assert!((end.omega_body - truth.omega_body).norm() < limit, "{}", method.name());
            }
            (order, run) => panic!("{}: claims {order:?}, taken {}", method.name(), run.is_ok()),
        }
    }
    refused.sort();
    assert_eq!(
        refused,
        ["dmv:10", "exact-step", "lie-poisson-projected", "richardson", "rk4-projected"],
        "what takes no wheels"
    );
    for name in ["lie-poisson@suzuki-4", "two-turn@yoshida-6", "kick-drift@suzuki-4", "rattle@suzuki-4"] {
        let end = end_of(name, 1.0 / 128.0, 512);
        assert!(end.state.rotation().angle_to(&truth.state.rotation()) < 1e-7, "{name}");
    }
    // the flow of a body with wheels is none of the two that this scheme is for
    let error = Run::new(&method("kick-drift@srkn-6b").unwrap(), &body, &start(&body), 0.1).err().unwrap();
    assert!(matches!(error, polhode::run::RunError::Step(StepError::Refused { .. })), "{error}");
}

#[test]
fn splittings_keep_the_momentum_of_body_and_wheels() {
    let free = body(&[wheel([1.0, 2.0, -2.0], 0.05, 60.0).free(OMEGA), wheel([3.0, 0.0, 1.0], 0.1, -25.0)]);
    for body in [held(), free] {
        for name in ["lie-poisson", "two-turn", "kick-drift", "rattle", "two-turn@suzuki-4"] {
            let method = method(name).unwrap();
            let end = Run::new(&method, &body, &start(&body), 0.05).unwrap().advance_to(40_000).unwrap();
            let of = |quantity| end.worst.of(quantity).unwrap();
            assert!(of(Conserved::Momentum) < 4e-15, "{name}: L {:e}", of(Conserved::Momentum));
            assert!(of(Conserved::MomentumNorm) < 2e-15, "{name}");
            assert!(of(Conserved::Energy) < 2e-3, "{name}: E {:e}", of(Conserved::Energy));
        }
    }
}

/// A motor moves momentum from the wheel to the body: L stays, and between its working and after it all is as with a free wheel.
#[test]
fn a_motor_exchanges_momentum_and_its_steps_end_where_it_is_switched() {
    let driven = wheel([0.0, 0.0, 1.0], 0.1, 5.0).driven(0.4, [1.3, 4.7], OMEGA).unwrap();
    let body = body(&[driven, wheel([1.0, 0.0, 0.0], 0.05, 20.0)]);
    assert_eq!(body.switching_times(), [1.3, 4.7]);
    assert_eq!(body.conserved(), [Conserved::MomentumNorm, Conserved::Momentum, Conserved::MomentumZ]);
    let l = body.momentum_space(0.0, &start(&body));
    let run = |name: &str, h: f64, steps| {
        Run::new(&method(name).unwrap(), &body, &start(&body), h).unwrap().advance_to(steps).unwrap()
    };
    let truth = run("taylor", 2.0, 4);
    let speed = driven.speed(8.0, truth.omega_body);
    let momentum = 0.1 * (speed + truth.omega_body.z);
    assert!((momentum - 0.1 * (5.0 + OMEGA.z) - 0.4 * 3.4).abs() < 1e-14);
    for (name, limit) in [
        ("rk4", 1e-7),
        ("rk8", 1e-11),
        ("gauss:4", 1e-8),
        ("dop853", 1e-6),
        ("lie-poisson@suzuki-4", 1e-7),
        ("two-turn@suzuki-4", 1e-7),
        ("kick-drift@suzuki-4", 1e-7),
    ] {
        let end = run(name, 1.0 / 64.0, 512);
        let error = end.state.rotation().angle_to(&truth.state.rotation());
        assert!(error < limit, "{name}: {error:e}");
        let now = body.momentum_space(8.0, &end.state);
        assert!((now - l).norm() < limit * l.norm() + 1e-13, "{name}");
        if name.contains("suzuki") {
            assert!(end.worst.of(Conserved::Momentum).is_some_and(|error| error < 1e-14), "{name}");
        }
    }
}

/// On an orbit, with the tensor of body and wheels in the gradient: energy less n L_z of body and wheels is constant.
#[test]
fn wheels_and_gravity_gradient_keep_jacobis_constant() {
    let gradient = Force::gravity_gradient(0.05, 0.0).unwrap();
    let wheels = [wheel([1.0, 2.0, -2.0], 0.05, 60.0).free(OMEGA), wheel([0.0, 0.0, 1.0], 0.1, -25.0)];
    let body = wheels
        .iter()
        .fold(Body::free(Inertia::from_tensor(tensor()).unwrap()).with(gradient), |body, wheel| {
            body.with_wheel(*wheel).unwrap()
        });
    assert_eq!(body.problem(), Problem::GyrostatPotential);
    assert_eq!(body.conserved(), [Conserved::Jacobi { rate: 0.05 }]);
    let run = |name: &str| {
        Run::new(&method(name).unwrap(), &body, &start(&body), 0.02).unwrap().advance_to(5_000).unwrap()
    };
    let truth = run("taylor");
    assert!(truth.worst.of(Conserved::Jacobi { rate: 0.05 }).is_some_and(|error| error < 1e-13));
    for name in ["lie-poisson@suzuki-4", "two-turn@suzuki-4", "kick-drift@suzuki-4", "gauss:4"] {
        let end = run(name);
        assert!(end.state.rotation().angle_to(&truth.state.rotation()) < 1e-5, "{name}");
        assert!(end.worst.of(Conserved::Jacobi { rate: 0.05 }).is_some_and(|error| error < 1e-6), "{name}");
    }
}

#[test]
fn wheels_that_no_body_can_carry_are_refused_with_the_law() {
    let moments = Body::free(Inertia::from_moments([1.0, 2.0, 2.5]).unwrap());
    let refused = moments.clone().with_wheel(wheel([1.0, 0.0, 0.0], 0.6, 1.0)).unwrap_err();
    assert_eq!(
        refused.to_string(),
        "the wheel's inertia of 0.6 kg m^2 is too large for that of body and wheels together, 1 kg m^2 about its axis; \
         without the wheel: principal moments 0.4, 2, 2.5 violate I1 + I2 >= I3 by 0.1 (4.000 % of the largest); no mass distribution has them"
    );
    assert!(matches!(refused, WheelError::TooLarge { .. }));
    // two that fit alone do not fit together
    let once = moments.with_wheel(wheel([1.0, 0.0, 0.0], 0.3, 1.0)).unwrap();
    assert!(once.with_wheel(wheel([1.0, 0.0, 0.0], 0.3, 1.0)).is_err());
    let new =
        |axis: [f64; 3], inertia, speed| Wheel::new(axis.into(), inertia, speed).unwrap_err().to_string();
    assert_eq!(new([0.0; 3], 1.0, 1.0), "the axis of the wheel is 0, 0, 0, which has no direction");
    assert_eq!(
        new([1.0, 0.0, 0.0], 0.0, 1.0),
        "the inertia of the wheel about its axis is 0; it must be positive"
    );
    assert_eq!(
        new([1.0, 0.0, 0.0], 1.0, f64::NAN),
        "the speed of the wheel is NaN; it must be a finite number"
    );
    let wheel = wheel([1.0, 0.0, 0.0], 0.1, 1.0);
    assert!(
        wheel.driven(0.1, [2.0, 2.0], OMEGA).is_err()
            && wheel.driven(f64::INFINITY, [0.0, 1.0], OMEGA).is_err()
    );
}

/// Balls, symmetric bodies, wheels that stand still or lie along an axis: turns with nothing to turn.
#[test]
fn bodies_with_equal_moments_take_wheels_too() {
    for moments in [[2.0, 2.0, 2.0], [1.0, 1.0, 1.5], [1.5, 1.0, 1.0], [1.0, 1.5, 1.0]] {
        for (axis, speed) in
            [([1.0, 0.0, 0.0], 0.0), ([1.0, 0.0, 0.0], 5.0), ([0.0, 0.0, 1.0], -4.0), ([1.0, 1.0, 0.0], 3.0)]
        {
            let body = Body::free(Inertia::from_moments(moments).unwrap());
            let body = body.with_wheel(wheel(axis, 0.1, speed)).unwrap();
            let truth = GyrostatMotion::new(&body, &start(&body)).unwrap().at(4.0).unwrap();
            for name in ["lie-poisson", "two-turn", "two-turn@suzuki-4", "kick-drift", "rattle", "taylor"] {
                let run = Run::new(&method(name).unwrap(), &body, &start(&body), 1.0 / 256.0)
                    .unwrap()
                    .advance_to(1024);
                let off = run.unwrap().state.rotation().angle_to(&truth.rotation());
                assert!(off < 1e-4, "{name}: {moments:?}, {axis:?} at {speed}: {off:e}");
            }
        }
    }
}

/// A run that is written down and resumed has the bits of one that was not, and is refused with another wheel.
#[test]
fn a_run_with_wheels_is_resumed_with_the_same_bits() {
    let (body, other) =
        (held(), body(&[wheel([1.0, 2.0, -2.0], 0.05, 61.0), wheel([0.0, 0.0, 1.0], 0.1, -25.0)]));
    for name in ["rk4", "lie-poisson", "two-turn", "kick-drift", "rattle", "two-turn@suzuki-4", "taylor"] {
        let method = method(name).unwrap();
        let new = || Run::new(&method, &body, &start(&body), 0.1).unwrap();
        let whole = new().advance_to(400).unwrap().state;
        let mut half = new();
        half.advance_to(170).unwrap();
        let text = half.checkpoint().to_string();
        let mut resumed = Run::resume(&method, &body, &text.parse().unwrap()).unwrap();
        assert_eq!(resumed.advance_to(400).unwrap().state, whole, "{name}");
        assert!(Run::resume(&method, &other, &text.parse().unwrap()).is_err(), "{name}");
    }
}

/// Each member has the wheels of its own start, at any time of it, by angular velocity and by momentum.
#[test]
fn members_of_an_ensemble_have_the_bits_of_runs_with_wheels_of_their_own() {
    let told = [
        WheelAtStart::free(wheel([1.0, 2.0, -2.0], 0.05, 60.0)),
        WheelAtStart::driven(wheel([0.0, 0.0, 1.0], 0.1, -25.0), 0.3, [1.5, 4.25]).unwrap(),
        WheelAtStart::held(wheel([1.0, 0.0, 0.0], 0.1, 5.0)),
    ];
    let inertia = |k: u32| Inertia::from_tensor(tensor() * (1.0 + 0.01 * f64::from(k))).unwrap();
    let omega = |k: u32| OMEGA * (1.0 + 0.1 * f64::from(k));
    let of = |wheels: &[WheelAtStart], k, t| {
        Body::free(inertia(k)).with_wheels_at_start(wheels, t, omega(k)).unwrap()
    };
    let clock = Clock { start: 2.0, step: 0.125 };
    for name in ["taylor", "kick-drift@suzuki-4", "two-turn:31@suzuki-4", "lie-poisson", "rk4"] {
        let method = method(name).unwrap();
        let mut ensemble = Ensemble::new().carrying(told.to_vec());
        for k in 0..3 {
            ensemble.push_omega(&inertia(k), UnitQuaternion::identity(), omega(k));
        }
        let mut ends = Vec::new();
        let read = |rows: &Rows| {
            ends.extend_from_slice(rows.states(0));
            Ok::<(), EnsembleError>(())
        };
        ensemble.advance(&method, clock, &[80], read).unwrap();
        for (k, end) in (0..3).zip(&ends) {
            let body = of(&told, k, clock.start);
            let start = body.enter_omega(Quat::identity(), omega(k).into()).unwrap();
            // the speed is that of the start, where the motor works already
            assert!((body.wheels()[1].speed(2.0, omega(k)) + 25.0).abs() < 1e-13);
            let mut run = Run::from_point(&method, &body, start.to_f64(), clock).unwrap();
            assert_eq!(*end, run.advance_to(80).unwrap().state, "{name}, member {k}");
        }
    }
    let free = &told[..1];
    let mut ensemble = Ensemble::new().carrying(free.to_vec());
    for k in 0..3 {
        let body = of(free, k, 0.0);
        ensemble.push(&inertia(k), &body.state(UnitQuaternion::identity(), omega(k)).unwrap());
        let of_member = ensemble.body(k as usize).unwrap();
        let l = |body: &Body| body.momentum_of_wheels_at(0.0);
        assert!((l(&of_member) - l(&body)).norm() < 1e-15 * l(&body).norm());
    }
    let mut failures = 0;
    let mut motor = Ensemble::new().carrying(told.to_vec());
    motor.push_omega(&inertia(0), UnitQuaternion::identity(), OMEGA);
    let read = |rows: &Rows| {
        let refused = rows.failures().all(|(_, _, error)| error.to_string().contains("while no motor acts"));
        failures += usize::from(refused && rows.failures().count() == 1);
        Ok::<(), EnsembleError>(())
    };
    motor.at(&[1.0], read).unwrap();
    assert_eq!(failures, 1);
}

/// Moments and wheels times a power of two: the same bits.
#[test]
fn a_power_of_two_of_the_mass_changes_no_bit() {
    let end = |factor: f64| {
        let inertia = Inertia::from_tensor(tensor() * factor).unwrap();
        let wheel = |axis: [f64; 3], inertia: f64, speed| wheel(axis, inertia * factor, speed);
        let body = Body::free(inertia).with_wheel(wheel([1.0, 2.0, -2.0], 0.05, 60.0).free(OMEGA)).unwrap();
        let body = body.with_wheel(wheel([0.0, 0.0, 1.0], 0.1, -25.0)).unwrap();
        ["rk4", "taylor", "two-turn", "kick-drift"].map(|name| {
            let run =
                Run::new(&method(name).unwrap(), &body, &start(&body), 0.1).unwrap().advance_to(100).unwrap();
            run.state.attitude.components().map(f64::to_bits)
        })
    };
    assert_eq!(end(1.0), end(libm::scalbn(1.0, -40)));
}

/// The closed form beside Taylor series of another formulation, wheels as a torque on the carrier: held, free, both, and none.
#[test]
fn the_closed_form_is_the_motion_that_taylor_series_follow() {
    let spun = wheel([1.0, 2.0, -2.0], 0.05, 60.0);
    let still = wheel([0.0, 0.0, 1.0], 0.1, -25.0);
    for wheels in [
        vec![spun],
        vec![spun, still],
        vec![spun.free(OMEGA), still],
        vec![spun.free(OMEGA), still.free(OMEGA)],
    ] {
        let body = body(&wheels);
        let motion = GyrostatMotion::new(&body, &start(&body)).unwrap();
        let mut run = Run::new(&method("taylor").unwrap(), &body, &start(&body), 5.0).unwrap();
        for steps in [1, 20, 200] {
            let (there, t) = (run.advance_to(steps).unwrap(), 5.0 * steps as f64);
            let here = motion.at(t).unwrap();
            // the run walks by rounding
            assert!(here.rotation().angle_to(&there.state.rotation()) < 1e-15 * (20.0 + t), "{t}");
            assert!((body.omega_body(&here) - there.omega_body).norm() < 1e-15 * (20.0 + t), "{t}");
        }
        // and after a period the angular velocity is what it was
        let character = motion.character();
        let period = character.period.unwrap();
        let later = motion.at(period).unwrap();
        assert!((body.omega_body(&later) - OMEGA).norm() < 1e-14);
        let (turned, l) =
            (later.rotation() * start(&body).rotation().inverse(), body.momentum_space(0.0, &start(&body)));
        let about_l = turned.axis_angle().map_or(0.0, |(axis, angle)| angle * axis.dot(&l).signum());
        let off = (about_l - character.turn_per_period.unwrap()) / std::f64::consts::TAU;
        assert!((off - off.round()).abs() < 1e-14);
        assert!((character.energy - body.energy(&start(&body))).abs() < 1e-14);
    }
}

/// Of a free body, a top and a body with wheels, in any axes.
#[test]
fn each_time_of_an_exact_motion_has_the_bits_of_that_time_alone() {
    let weight = Vector3::new(0.0, 0.0, 2.0);
    let turn = UnitQuaternion::from_euler_angles(0.4, 0.2, -1.1).to_rotation_matrix();
    let symmetric = turn * Matrix3::from_diagonal(&Vector3::new(1.25, 1.25, 0.75)) * turn.inverse();
    let symmetric = Inertia::from_tensor((symmetric + symmetric.transpose()) * 0.5).unwrap();
    let times: Vec<f64> = (-70..70).map(|n| 0.7 * f64::from(n)).chain([1e8, -3e12]).collect();
    for body in [body(&[]), Body::heavy(symmetric, turn * weight).unwrap(), held()] {
        let motion = ExactMotion::new(&body, &start(&body)).unwrap();
        let mut seen = Vec::new();
        motion.each_at(&times, |state, omega| seen.push((state, omega))).unwrap();
        let alone = |t: &f64| (motion.at(*t).unwrap(), body.omega_of(&motion.point_at(Dd::from(*t))));
        assert_eq!(seen, times.iter().map(alone).collect::<Vec<_>>());
        let refused = motion.each_at(&[0.0, f64::NAN], |_, _| panic!("before all times are looked at"));
        assert!(matches!(refused, Err(TimeError::NotFinite { .. })));
    }
}

#[test]
fn without_momentum_of_wheels_the_closed_form_is_that_of_the_free_body() {
    let bare = body(&[]);
    let free = FreeMotion::from_state(bare.inertia(), &start(&bare)).unwrap();
    for speed in [1e-3, 1e-8, 1e-13] {
        let body = body(&[wheel([1.0, 2.0, -2.0], 1.0, speed)]);
        let motion = GyrostatMotion::new(&body, &start(&body)).unwrap();
        for t in [0.3, 20.0, 400.0] {
            let off = motion.at(t).unwrap().rotation().angle_to(&free.at(t).unwrap().rotation());
            assert!(off < speed * (1.0 + t) + 2e-15, "{speed:e} at {t}: {off:e}");
        }
    }
}

/// Each spin stays one under the method that knows nothing of it, and an unstable one is left at its rate.
#[test]
fn steady_spins_are_steady_and_unstable_ones_are_left_at_their_rate() {
    let body = body(&[wheel([1.0, 0.3, -0.2], 0.05, 8.0)]);
    let spins = GyrostatMotion::new(&body, &start(&body)).unwrap().steady_spins();
    assert_eq!(spins.len(), 6);
    let l = body.momentum_space(0.0, &start(&body)).norm();
    for spin in &spins {
        let from = |omega| body.state(UnitQuaternion::identity(), omega).unwrap();
        let state = from(spin.omega_body);
        let momentum = body.momentum_space(0.0, &state);
        assert!((momentum.norm() - l).abs() < 1e-13 * l);
        assert!((spin.omega_body - momentum / l * spin.rate).norm() < 1e-14);
        assert!((body.energy(&state) - spin.energy).abs() < 1e-13);
        let after = |start: &State, t: f64| {
            Run::new(&method("taylor").unwrap(), &body, start, t).unwrap().advance_to(1).unwrap().omega_body
        };
        let nudged = from(spin.omega_body + spin.omega_body.cross(&Vector3::new(0.3, 0.5, -0.7)) * 1e-7);
        let off = |t: f64| (after(&nudged, t) - spin.omega_body).norm();
        if spin.growth_rate > 0.0 {
            let (early, late) = (6.0 / spin.growth_rate, 8.0 / spin.growth_rate);
            let growth = libm::log(off(late) / off(early)) / (late - early);
            assert!((growth / spin.growth_rate - 1.0).abs() < 1e-3, "{growth} for {}", spin.growth_rate);
        } else {
            let period = std::f64::consts::TAU / spin.frequency;
            assert!(
                (after(&nudged, period) - after(&nudged, 0.001 * period)).norm()
                    < 1e-2 * off(0.5 * period) + 1e-12
            );
            assert!(off(20.3 * period) < 1e-6);
        }
    }
    assert_eq!(spins.iter().filter(|spin| spin.growth_rate > 0.0).count(), 2);
}

#[test]
fn what_has_no_closed_form_with_wheels_says_why() {
    let refused = |body: &Body| GyrostatMotion::new(body, &start(body)).unwrap_err();
    let driven = body(&[wheel([0.0, 0.0, 1.0], 0.1, 5.0).driven(0.4, [0.0, f64::INFINITY], OMEGA).unwrap()]);
    assert!(matches!(refused(&driven), NoClosedForm::Motor { torque: 0.4, .. }));
    let dragged = held().with(Force::drag(0.1, 0.0).unwrap());
    assert!(refused(&dragged).to_string().starts_with("drag acts on the body; closed forms are available"));
    assert!(matches!(refused(&body(&[])), NoClosedForm::Forced { .. }));
}

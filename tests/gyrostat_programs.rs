//! A spacecraft with two wheels beside scipy and Basilisk, which follow it by equations of their own: tests/data/gyrostat/programs.py.

use nalgebra::{Matrix3, Quaternion, UnitQuaternion, Vector3};
use polhode::body::{Body, Wheel};
use polhode::flow::GyrostatMotion;
use polhode::inertia::Inertia;
use polhode::method::method;
use polhode::run::Run;

const OMEGA: Vector3<f64> = Vector3::new(0.3, -0.2, 0.5);

/// What no program here may be off by.
const BOUND: f64 = 1e-10;

/// Of a run of ours over a minute: its rounding, rad and rad/s.
const OURS: f64 = 1e-13;

struct Row {
    program: &'static str,
    case: &'static str,
    error: f64,
    t: f64,
    attitude: UnitQuaternion<f64>,
    omega: Vector3<f64>,
}

fn rows() -> Vec<Row> {
    let lines = include_str!("data/gyrostat/programs.csv").lines();
    let of = |line: &'static str| {
        let fields: Vec<&str> = line.split(',').collect();
        let number = |k: usize| -> f64 { fields[k].parse().unwrap() };
        let [w, x, y, z] = [4, 5, 6, 7].map(number);
        Row {
            program: fields[0],
            case: fields[1],
            error: number(2),
            t: number(3),
            attitude: UnitQuaternion::from_quaternion(Quaternion::new(w, x, y, z)),
            omega: Vector3::new(number(8), number(9), number(10)),
        }
    };
    lines.skip(2).map(of).collect()
}

/// The same cases as in the script.
fn body(case: &str) -> Body {
    let tensor = Matrix3::new(10.0, -0.5, 0.25, -0.5, 12.0, 0.75, 0.25, 0.75, 15.0);
    let skew = Wheel::new([1.0, 2.0, -2.0].into(), 0.05, 60.0).unwrap();
    let along = Wheel::new([0.0, 0.0, 1.0].into(), 0.1, -25.0).unwrap();
    let always = [0.0, f64::INFINITY];
    let wheels = match case {
        "held" => [skew, along],
        "free" => [skew.free(OMEGA), along.free(OMEGA)],
        "driven" => [skew.driven(0.3, always, OMEGA).unwrap(), along.driven(-0.05, always, OMEGA).unwrap()],
        "switched" => [skew.free(OMEGA).driven(0.3, [12.5, 30.0], OMEGA).unwrap(), along],
        _ => panic!("no case {case}"),
    };
    let bare = Body::free(Inertia::from_tensor(tensor).unwrap());
    wheels.into_iter().fold(bare, |body, wheel| body.with_wheel(wheel).unwrap())
}

#[test]
fn other_programs_follow_bodies_with_wheels_alike_to_their_own_error() {
    let rows = rows();
    let mut seen = Vec::new();
    for row in &rows {
        let body = body(row.case);
        let attitude = UnitQuaternion::from_quaternion(Quaternion::new(0.5, 0.5, -0.5, 0.5));
        let start = body.state(attitude, OMEGA).unwrap();
        let steps = (row.t / 2.5) as u64;
        let end =
            Run::new(&method("taylor").unwrap(), &body, &start, 2.5).unwrap().advance_to(steps).unwrap();
        let what = format!("{} {} at {}", row.program, row.case, row.t);
        // the column is the largest of the components: four of the quaternion, which is half the angle
        let limit = (4.0 * row.error + OURS).min(BOUND);
        let turned = end.state.rotation().angle_to(&row.attitude);
        let rate = (end.omega_body - row.omega).norm();
        assert!(turned < limit, "{what}: {turned:e} rad, its own error {:e}", row.error);
        assert!(rate < limit, "{what}: {rate:e} rad/s, its own error {:e}", row.error);
        if let Ok(motion) = GyrostatMotion::new(&body, &start) {
            let there = motion.at(row.t).unwrap();
            let turned = there.rotation().angle_to(&row.attitude);
            assert!(turned < limit, "{what}: {turned:e} rad from the closed form");
        }
        seen.push((row.program, row.case));
    }
    seen.dedup();
    let expected = ["held", "free", "driven", "switched"].map(|case| ("scipy", case));
    assert!(expected.iter().all(|one| seen.contains(one)), "{seen:?}");
    assert!([("Basilisk", "free"), ("Basilisk", "driven")].iter().all(|one| seen.contains(one)), "{seen:?}");
}

/// The comparison sees a wheel that is free in place of held, and a sign of the motor.
#[test]
fn the_comparison_with_other_programs_tells_the_kinds_of_wheels_apart() {
    for (case, other) in [("held", "free"), ("free", "driven"), ("switched", "held")] {
        let rows = rows();
        let row = rows.iter().rfind(|row| row.case == case).unwrap();
        let body = body(other);
        let attitude = UnitQuaternion::from_quaternion(Quaternion::new(0.5, 0.5, -0.5, 0.5));
        let start = body.state(attitude, OMEGA).unwrap();
        let run = Run::new(&method("taylor").unwrap(), &body, &start, row.t);
        let end = run.unwrap().advance_to(1).unwrap();
        assert!(end.state.rotation().angle_to(&row.attitude) > 1e-3, "{case} beside {other}");
    }
}

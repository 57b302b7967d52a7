//! A spacecraft with two wheels beside scipy and Basilisk, which follow it by equations of their own: tests/data/gyrostat/programs.py.

use nalgebra::{Matrix3, Quaternion, UnitQuaternion, Vector3};
use polhode::audit::{
    Attitudes, AuditError, Frame, Judgement, Noise, Question, RateUnit, Suspect, Trajectory, Verdict, audit,
};
use polhode::body::{Body, Wheel, WheelAtStart, WheelError};
use polhode::flow::GyrostatMotion;
use polhode::inertia::Inertia;
use polhode::method::method;
use polhode::num::Random;
use polhode::rotation::{Quat, Vec3};
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
fn told(case: &str) -> (Body, [WheelAtStart; 2]) {
    let tensor = Matrix3::new(10.0, -0.5, 0.25, -0.5, 12.0, 0.75, 0.25, 0.75, 15.0);
    let skew = Wheel::new([1.0, 2.0, -2.0].into(), 0.05, 60.0).unwrap();
    let along = Wheel::new([0.0, 0.0, 1.0].into(), 0.1, -25.0).unwrap();
    let driven = |wheel, torque, times| WheelAtStart::driven(wheel, torque, times).unwrap();
    let always = [0.0, f64::INFINITY];
    let wheels = match case {
        "held" => [skew, along].map(WheelAtStart::held),
        "free" => [skew, along].map(WheelAtStart::free),
        "driven" => [driven(skew, 0.3, always), driven(along, -0.05, always)],
        "switched" => [driven(skew, 0.3, [12.5, 30.0]), WheelAtStart::held(along)],
        _ => panic!("no case {case}"),
    };
    (Body::free(Inertia::from_tensor(tensor).unwrap()), wheels)
}

fn body(case: &str) -> Body {
    let (bare, wheels) = told(case);
    bare.with_wheels_at_start(&wheels, 0.0, OMEGA).unwrap()
}

/// The record of a case as scipy follows it, tests/data/gyrostat/records.py, with so many digits.
fn record(case: &str, digits: usize) -> Trajectory {
    let (mut times, mut attitudes, mut rates) = (Vec::new(), Vec::new(), Vec::new());
    let rounded = |x: f64| -> f64 { format!("{x:.*e}", digits - 1).parse().unwrap() };
    for line in include_str!("data/gyrostat/records.csv").lines().filter(|line| line.starts_with(case)) {
        let numbers: Vec<f64> = line.split(',').skip(1).map(|field| field.parse().unwrap()).collect();
        times.push(numbers[0]);
        attitudes.push([1, 2, 3, 4].map(|k| rounded(numbers[k])));
        rates.push([5, 6, 7].map(|k| rounded(numbers[k])));
    }
    assert_eq!(times.len(), 41);
    Trajectory::new(times).with_attitude(Attitudes::Quaternions(attitudes)).with_rates(rates)
}

fn verdict(record: &Trajectory, (bare, wheels): (Body, [WheelAtStart; 2])) -> Verdict {
    let mut question = Question::new(Some(bare));
    question.wheels = wheels.into();
    audit(record, &question).unwrap()
}

const CASES: [&str; 4] = ["held", "free", "driven", "switched"];

/// With fewer digits the momentum of a wheel that follows from the first row is known less well, which is no fault of the record.
#[test]
fn a_record_of_another_program_is_right_to_its_digits_with_wheels_of_every_kind() {
    for case in CASES {
        for digits in [17, 8, 6, 4] {
            let found = verdict(&record(case, digits), told(case));
            // the angular velocity of the driven one grows, and with it what four digits leave open
            let coarse = (case, digits) == ("driven", 4);
            let expected = if coarse { Judgement::Undecided } else { Judgement::Right };
            assert_eq!(found.judgement, expected, "{case}, {digits} digits: {found:?}");
            let off = found.attitude_error.unwrap().largest;
            assert!(
                off < 20.0 * libm::exp10(-(digits as f64)).max(1e-14),
                "{case}, {digits} digits: {off:e}"
            );
        }
    }
}

/// Noise that is declared is in the first row too, and in the momentum that follows from it.
#[test]
fn a_noisy_record_with_wheels_is_right_within_the_noise_that_is_declared() {
    for case in CASES {
        let mut noisy = record(case, 17);
        let mut random = Random::new(11);
        let noise = Noise { attitude: 1e-4, rates: 1e-4 };
        let attitudes = noisy.attitude.take();
        let Some(Attitudes::Quaternions(mut attitudes)) = attitudes else { panic!("no quaternions") };
        for q in &mut attitudes {
            let off = Quat::exponential(Vec3::from(random.normal_vector() * noise.attitude));
            *q = (Quat::from_components(*q) * off).components();
        }
        for omega in noisy.rates.iter_mut().flatten() {
            *omega = (Vector3::from(*omega) + random.normal_vector() * noise.rates).into();
        }
        let noisy = noisy.with_attitude(Attitudes::Quaternions(attitudes));
        let (bare, wheels) = told(case);
        let mut question = Question::new(Some(bare));
        (question.wheels, question.noise) = (wheels.into(), noise);
        let found = audit(&noisy, &question).unwrap();
        assert_eq!(found.judgement, Judgement::Right, "{case}: {found:?}");
    }
}

/// In degrees a second, in axes of space, without attitudes and without rates.
#[test]
fn the_momentum_of_a_wheel_follows_from_the_first_row_in_any_convention() {
    for case in CASES {
        let full = record(case, 17);
        let rates = full.rates.clone().unwrap();
        let judged = |record: &Trajectory| verdict(record, told(case));
        let degrees = rates.iter().map(|w| w.map(f64::to_degrees)).collect();
        let found = judged(&full.clone().with_rates(degrees));
        assert_eq!(
            (found.judgement, found.reading.rate_unit),
            (Judgement::Right, Some(RateUnit::DegreesPerSecond))
        );
        let reading = judged(&full).reading;
        let turned =
            (0..rates.len()).map(|k| reading.attitude(&full, k).unwrap().rotate(Vec3(rates[k])).0).collect();
        let found = judged(&full.clone().with_rates(turned));
        assert_eq!(
            (found.judgement, found.reading.omega_frame),
            (Judgement::Right, Some(Frame::Space)),
            "{case}"
        );
        let alone = Trajectory::new(full.times.clone()).with_rates(rates);
        assert_eq!(judged(&alone).judgement, Judgement::Right, "{case}");
        let mut alone = full.clone();
        alone.rates = None;
        let found = judged(&alone);
        assert_eq!(found.judgement, Judgement::Right, "{case}: {found:?}");
    }
}

/// Another speed of a wheel and another sign are found, by its number and its speed.
fn finds_other_speeds(case: &str) {
    let speed = |wheel: WheelAtStart, factor: f64| {
        wheel.with_speed(factor * wheel.at_speed().speed(0.0, Vector3::zeros())).unwrap()
    };
    let (bare, [skew, along]) = told(case);
    let full = record(case, 17);
    for factor in [1.0 + 2e-5, -1.0] {
        let found = verdict(&full, (bare.clone(), [speed(skew, factor), along]));
        assert_eq!((&found.judgement, &found.suspect), (&Judgement::Wrong, &Suspect::OtherWheel), "{case}");
        let other = found.other_wheel.unwrap();
        assert_eq!((other.number, other.is_held), (1, case == "held"), "{case}");
        assert!((other.speed - 60.0).abs() < 1e-7, "{case}: {}", other.speed);
    }
    // the digits that are left tell it too
    let found = verdict(&record(case, 8), (bare.clone(), [skew, speed(along, 1.0 + 2e-5)]));
    assert_eq!(found.judgement, Judgement::Wrong, "{case}");
}

#[test]
fn an_audit_finds_wheels_that_are_not_as_they_were_told() {
    type Change = fn(WheelAtStart) -> WheelAtStart;
    ["held", "free"].into_iter().for_each(finds_other_speeds);
    let kinds: [(&str, Change); 2] = [
        ("held", |wheel| WheelAtStart::free(wheel.at_speed())),
        ("free", |wheel| WheelAtStart::held(wheel.at_speed())),
    ];
    for (case, other) in kinds {
        let (bare, [skew, along]) = told(case);
        let found = verdict(&record(case, 17), (bare, [skew, other(along)]));
        assert_eq!((&found.judgement, &found.suspect), (&Judgement::Wrong, &Suspect::OtherWheel), "{case}");
        let wheel = found.other_wheel.unwrap();
        assert_eq!((wheel.number, wheel.is_held), (2, case == "held"));
        assert!((wheel.speed + 25.0).abs() < 1e-7, "{case}: {}", wheel.speed);
    }
}

#[test]
#[ignore = "takes seconds, `.ci/run` does it"]
fn an_audit_finds_motors_that_are_not_as_they_were_told() {
    ["driven", "switched"].into_iter().for_each(finds_other_speeds);
    for (torque, times) in
        [(0.3001, [12.5, 30.0]), (-0.3, [12.5, 30.0]), (0.3, [12.51, 30.01]), (0.3, [12.5, 30.01])]
    {
        let (bare, [skew, along]) = told("switched");
        let driven = WheelAtStart::driven(skew.at_speed(), torque, times).unwrap();
        let found = verdict(&record("switched", 17), (bare, [driven, along]));
        assert_eq!(found.judgement, Judgement::Wrong, "{torque} {times:?}");
    }
}

#[test]
fn what_an_audit_of_wheels_cannot_tell_is_refused_by_name() {
    let (bare, wheels) = told("free");
    let full = record("free", 17);
    let mut question = Question::new(Some(bare));
    question.wheels = wheels.into();
    let momentum = full.clone().with_momentum(vec![[1.0; 3]; full.times.len()]);
    assert_eq!(audit(&momentum, &question).unwrap_err(), AuditError::MomentumOfWheels);
    question.body = None;
    assert_eq!(audit(&full, &question).unwrap_err(), AuditError::WheelsNeedBody);
    question.body = Some(Body::free(Inertia::from_moments([0.05, 1.0, 1.0]).unwrap()));
    assert!(matches!(audit(&full, &question).unwrap_err(), AuditError::Wheel(WheelError::TooLarge { .. })));
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

//! Faults that hide in what is declared, beside other columns, or in what a record leaves open.

use nalgebra::{UnitQuaternion, Vector3};
use polhode::audit::{Attitudes, Fault, Frame, Judgement, Noise, Question, Trajectory, audit};
use polhode::body::{Body, Force};
use polhode::inertia::Inertia;
use polhode::rotation::{Quat, Vec3};

use super::records::{Seeded, Written, plain, tumbling};
use super::ties::states;

const MOMENTS: [f64; 3] = [1.0, 2.0, 2.5];

fn body() -> Body {
    Body::free(Inertia::from_moments(MOMENTS).unwrap())
}

/// Every 0.05 s, in this library's convention.
fn motion(rows: usize) -> Vec<Written> {
    let body = body();
    let start =
        body.state(UnitQuaternion::from_euler_angles(0.3, -0.8, 1.9), Vector3::new(0.4, 1.0, -0.3)).unwrap();
    states(&body, &start, 0.05, rows)
}

fn judged(record: &Trajectory, body: Option<Body>) -> Judgement {
    audit(record, &Question::new(body)).unwrap().judgement
}

/// What is smooth from row to row is no noise, however much of it is declared.
#[test]
fn no_error_that_lasts_hides_in_noise_that_is_not_there() {
    let with = |turn: &dyn Fn(usize) -> f64, noise: f64| {
        let turned = |(row, &(t, q, omega)): (usize, &Written)| {
            (t, Quat::cayley(Vec3([0.5 * turn(row), 0.0, 0.0])) * q, omega)
        };
        let rows: Vec<Written> = motion(800).iter().enumerate().map(turned).collect();
        let mut question = Question::new(Some(body()));
        question.noise = Noise { attitude: noise, rates: noise };
        audit(&plain(&rows), &question).unwrap().judgement
    };
    assert_eq!(with(&|_| 0.0, 1e-2), Judgement::Right, "declared, and not there");
    assert_ne!(with(&|row| 2.5e-7 * row as f64, 1e-3), Judgement::Right, "a drift of 2e-4");
    assert_ne!(with(&|row| if row == 300 { 3e-2 } else { 0.0 }, 1e-2), Judgement::Right, "one row");
    let mut random = Seeded(5);
    let noise: Vec<f64> = (0..800).map(|_| 1e-3 * random.normal()).collect();
    assert_eq!(with(&|row| noise[row], 1e-3), Judgement::Right, "noise that is there");
}

#[test]
fn a_noise_of_more_than_a_tenth_of_the_rates_decides_nothing() {
    let mut rates = plain(&motion(400));
    rates.attitude = None;
    let mut question = Question::new(Some(body()));
    question.noise.rates = 10.0;
    assert_eq!(audit(&rates, &question).unwrap().judgement, Judgement::Undecided);
}

/// Momenta beside rates: in body axes or in space, and of a body whose size nobody tells in any unit, but not reversed.
#[test]
fn momenta_beside_rates_are_judged_in_their_axes() {
    let rows = motion(400);
    let of = |frame: Frame, factor: f64, bad: Option<usize>| {
        let mut both = plain(&rows);
        let momentum = |(k, (_, q, w)): (usize, &Written)| {
            let m = w.times(Vec3(MOMENTS)) * factor;
            let Vec3(mut m) = if frame == Frame::Space { q.rotate(m) } else { m };
            m[1] += if bad == Some(k) { 1e-4 } else { 0.0 };
            m
        };
        both.momentum = Some(rows.iter().enumerate().map(momentum).collect());
        both
    };
    for frame in [Frame::Body, Frame::Space] {
        assert_eq!(judged(&of(frame, 1.0, None), Some(body())), Judgement::Right, "{frame}");
        assert_eq!(judged(&of(frame, 1.0, Some(123)), Some(body())), Judgement::Wrong, "{frame}");
        assert_eq!(judged(&of(frame, 1.000_01, None), Some(body())), Judgement::Wrong, "{frame}");
        assert_eq!(judged(&of(frame, 7.0, None), None), Judgement::Right, "{frame}");
        assert_ne!(judged(&of(frame, 7.0, Some(123)), None), Judgement::Right, "{frame}");
        assert_ne!(judged(&of(frame, -7.0, None), None), Judgement::Right, "{frame}");
    }
}

/// Momenta in space have their own digits, whatever those of the attitudes are and whatever unit they are in.
#[test]
fn momenta_in_space_are_held_to_their_own_digits() {
    let rows = motion(400);
    let of = |factor: f64, off: f64| {
        let mut both = plain(&rows);
        let momentum = |(_, q, w): &Written| q.rotate(w.times(Vec3(MOMENTS)) * factor).0;
        both.momentum = Some(rows.iter().map(momentum).collect());
        both.momentum.as_mut().unwrap()[123][1] += off * factor;
        let Some(Attitudes::Quaternions(rounded)) = &mut both.attitude else { panic!() };
        rounded.iter_mut().flatten().for_each(|x| *x = (*x * 1e4).round() / 1e4);
        judged(&both, None)
    };
    for factor in [1e-3, 1.0, 1e3] {
        assert_eq!(of(factor, 0.0), Judgement::Right, "{factor}");
        // less than attitudes of four decimals can tell
        assert_ne!(of(factor, 2e-4), Judgement::Right, "{factor}");
    }
}

/// Without a body its moments come from the record, of a lamina too, whose tensor is at the bound of what a body can have.
#[test]
fn exact_records_without_a_body_are_not_wrong() {
    let mut random = Seeded(41);
    for trial in 0..6 {
        let (mut body, mut start, spin) = tumbling(&mut random);
        if trial == 0 {
            body = Body::free(Inertia::from_moments([1.0, 2.0, 3.0]).unwrap());
            start = body.state(random.attitude(), Vector3::new(0.4, 1.0, -0.3) * spin).unwrap();
        }
        let rows = states(&body, &start, 0.05 / spin, 801);
        let whole = plain(&rows);
        let (mut attitude, mut rates) = (whole.clone(), whole.clone());
        (attitude.rates, rates.attitude) = (None, None);
        for (columns, record) in [("both", &whole), ("attitude", &attitude), ("rates", &rates)] {
            let judgement = judged(record, None);
            // what is derived from one column alone may leave it open, but contradicts no motion
            let open = columns != "both" && judgement == Judgement::Undecided;
            assert!(judgement == Judgement::Right || open, "{trial}: {columns}: {judgement}");
        }
    }
}

/// Attitudes that turn by more than half a turn from row to row do not tell which way.
#[test]
fn attitudes_alone_that_are_too_far_apart_are_undecided() {
    let body = body();
    let start = body.state(UnitQuaternion::identity(), Vector3::new(0.4, 1.5, -0.3)).unwrap();
    let mut record = plain(&states(&body, &start, 2.5, 100));
    assert_eq!(judged(&record, Some(body.clone())), Judgement::Right, "with rates");
    record.rates = None;
    let verdict = audit(&record, &Question::new(Some(body))).unwrap();
    assert_eq!(verdict.judgement, Judgement::Undecided);
    assert!(verdict.faults.iter().any(|fault| matches!(fault, Fault::TooCoarse { .. })));
}

/// One digit of a vector that is the same in all rows is no rounding: a program without ω × Iω keeps what it was given.
#[test]
fn a_vector_that_stays_hides_nothing_in_its_few_digits() {
    let times: Vec<f64> = (0..51).map(|k| 0.2 * f64::from(k)).collect();
    let of = |omega: [f64; 3]| {
        judged(&Trajectory::new(times.clone()).with_rates(vec![omega; times.len()]), Some(body()))
    };
    assert_ne!(of([0.4, 1.0, -0.3]), Judgement::Right);
    assert_eq!(of([0.0, 0.0, 0.3]), Judgement::Right, "about a principal axis");
}

/// Attitudes alone that turn by less than ten times the tolerance are those of nearly any motion.
#[test]
fn attitudes_alone_that_hardly_turn_are_undecided() {
    let slow = |factor: f64, order: &dyn Fn(usize) -> usize| {
        let body = body();
        let start = body.state(UnitQuaternion::identity(), Vector3::new(0.4, 1.0, -0.3) * factor).unwrap();
        let mut record = plain(&states(&body, &start, 0.05, 401));
        record.rates = None;
        let Some(Attitudes::Quaternions(rows)) = &mut record.attitude else { panic!() };
        *rows = (0..401).map(|row| rows[order(row)]).collect();
        let verdict = audit(&record, &Question::new(Some(body))).unwrap();
        let is_named = verdict.faults.iter().any(|fault| matches!(fault, Fault::TooLittle { .. }));
        (verdict.judgement, is_named)
    };
    // by about 2e-4 rad and by 2e-8 rad, at a tolerance of 1e-6 rad
    assert_eq!(slow(1e-5, &|row| row), (Judgement::Right, false));
    assert_eq!(slow(1e-9, &|row| row), (Judgement::Undecided, true));
    assert_ne!(slow(1e-9, &|row| row * row % 401).0, Judgement::Right, "rows in another order");
}

/// Times in ms that are read as s: under a torque the body would turn by 5e5 rad.
#[test]
fn a_forced_motion_that_turns_without_end_is_undecided() {
    let force = Force::constant_torque_body(Vector3::new(1e-3, 2e-3, 0.0)).unwrap();
    let forced = body().with(force);
    let slow = |(t, q, omega): &Written| (1e3 * t, *q, *omega * 1e-3);
    let rows: Vec<Written> = motion(801).iter().map(slow).collect();
    let verdict = audit(&plain(&rows), &Question::new(Some(forced))).unwrap();
    assert_eq!(verdict.judgement, Judgement::Undecided);
    assert!(verdict.faults.contains(&Fault::NotFollowed), "{:?}", verdict.faults);
}

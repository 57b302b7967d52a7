//! "Right" speaks of every row and every column: whatever is wrong with one of them is seen, wherever it stands.

use nalgebra::{UnitQuaternion, Vector3};
use polhode::audit::{
    Attitudes, Digits, Fault, Frame, Judgement, Misplaced, Noise, Question, RateUnit, Reading, Suspect,
    Trajectory, audit,
};
use polhode::body::Body;
use polhode::inertia::Inertia;

use super::records::{Form, Seeded, Writing, Written, plain, reading, record};
use super::ties::states;

fn body() -> Body {
    Body::free(Inertia::from_moments([1.0, 2.0, 3.0]).unwrap())
}

/// Every 0.05 s, in this library's convention.
fn motion(rows: usize) -> Vec<Written> {
    let body = body();
    let start =
        body.state(UnitQuaternion::from_euler_angles(0.3, -0.8, 1.9), Vector3::new(0.4, 1.0, -0.3)).unwrap();
    states(&body, &start, 0.05, rows)
}

fn judged(record: &Trajectory) -> Judgement {
    audit(record, &Question::new(Some(body()))).unwrap().judgement
}

fn quaternions(record: &mut Trajectory) -> &mut Vec<[f64; 4]> {
    match &mut record.attitude {
        Some(Attitudes::Quaternions(rows)) => rows,
        other => panic!("{other:?}"),
    }
}

#[test]
fn one_bad_row_of_many_is_wrong_wherever_it_stands() {
    let good = plain(&motion(5_000));
    assert_eq!(judged(&good), Judgement::Right);
    for row in [1, 2_345, 4_999] {
        let mut bad = good.clone();
        quaternions(&mut bad)[row] = [0.0, 0.0, 0.0, 1.0];
        let verdict = audit(&bad, &Question::new(Some(body()))).unwrap();
        assert_eq!(verdict.judgement, Judgement::Wrong, "attitude of row {row}");
        let named = |fault: &Fault| matches!(fault, Fault::Misplaced { row: r, count: 1, .. } if *r == row);
        assert!(verdict.faults.iter().any(named), "row {row}: {:?}", verdict.faults);
        let mut bad = good.clone();
        bad.rates.as_mut().unwrap()[row][1] += 3e-6;
        assert_eq!(judged(&bad), Judgement::Wrong, "rates of row {row}");
        // two tolerances beside it, and the same within one
        let mut near = good.clone();
        near.rates.as_mut().unwrap()[row][1] += 3e-7;
        assert_eq!(judged(&near), Judgement::Right, "rates of row {row}");
    }
    let mut reset = good.clone();
    for row in 3_000..3_033 {
        quaternions(&mut reset)[row] = [1.0, 0.0, 0.0, 0.0];
        reset.rates.as_mut().unwrap()[row] = [0.0; 3];
    }
    assert_eq!(judged(&reset), Judgement::Wrong);
}

#[test]
fn each_kind_of_column_alone_is_judged_to_its_last_row() {
    let motion = motion(400);
    let mut random = Seeded(11);
    for form in [Form::Quaternion, Form::Matrix, Form::Angles, Form::Rodrigues] {
        let convention = reading(&mut random, form);
        let mut alone = record(&mut random, &motion, &convention, form, Writing::EXACT);
        alone.rates = None;
        assert_eq!(judged(&alone), Judgement::Right, "{form:?}");
        match alone.attitude.as_mut().unwrap() {
            Attitudes::Quaternions(rows) => rows[399] = rows[380],
            Attitudes::Matrices(rows) => rows[399] = rows[380],
            Attitudes::Angles(rows) | Attitudes::Rodrigues(rows) => rows[399] = rows[380],
            other => panic!("{other:?}"),
        }
        assert_ne!(judged(&alone), Judgement::Right, "{form:?}: the last row is another");
    }
    let mut rates = plain(&motion);
    rates.attitude = None;
    assert_eq!(judged(&rates), Judgement::Right);
    rates.rates.as_mut().unwrap()[399][2] += 1e-4;
    assert_ne!(judged(&rates), Judgement::Right);
    let mut momenta = plain(&motion);
    momenta.attitude = None;
    let of = |w: &[f64; 3]| [w[0], 2.0 * w[1], 3.0 * w[2]];
    momenta.momentum = momenta.rates.take().map(|rates| rates.iter().map(of).collect());
    assert_eq!(judged(&momenta), Judgement::Right);
    momenta.momentum.as_mut().unwrap()[399][2] += 1e-4;
    assert_ne!(judged(&momenta), Judgement::Right);
}

/// The attitude nearest to it may be right; what was written is not.
#[test]
fn a_row_that_is_no_rotation_is_not_right() {
    let motion = motion(400);
    let good = plain(&motion);
    let mut scaled = good.clone();
    quaternions(&mut scaled).iter_mut().flatten().for_each(|x| *x *= 3.0);
    assert_eq!(judged(&scaled), Judgement::Right, "one norm for all rows is a habit of the program");
    let mut bad = good.clone();
    quaternions(&mut bad)[200] = good_row(&good, 200).map(|x| 3.0 * x);
    let verdict = audit(&bad, &Question::new(Some(body()))).unwrap();
    assert_eq!(verdict.judgement, Judgement::Undecided);
    assert!(verdict.faults.iter().any(|fault| matches!(fault, Fault::NoRotation { row: 200, count: 1, .. })));
    let mut random = Seeded(21);
    let convention = reading(&mut random, Form::Matrix);
    let mut sheared = record(&mut random, &motion, &convention, Form::Matrix, Writing::EXACT);
    assert_eq!(judged(&sheared), Judgement::Right);
    // a symmetric change leaves the nearest rotation where it is
    let Some(Attitudes::Matrices(rows)) = &mut sheared.attitude else { panic!() };
    let m = rows[77];
    rows[77] = std::array::from_fn(|n| m[n] * if n / 3 == 0 { 1.01 } else { 1.0 });
    assert_ne!(judged(&sheared), Judgement::Right);
}

fn good_row(record: &Trajectory, row: usize) -> [f64; 4] {
    quaternions(&mut record.clone())[row]
}

#[test]
fn momenta_beside_rates_are_read_too() {
    let mut both = plain(&motion(400));
    let of = |w: &[f64; 3]| [w[0], 2.0 * w[1], 3.0 * w[2]];
    both.momentum = both.rates.as_ref().map(|rates| rates.iter().map(of).collect());
    assert_eq!(judged(&both), Judgement::Right);
    both.momentum.as_mut().unwrap()[123][0] += 1e-4;
    assert_eq!(judged(&both), Judgement::Wrong);
}

#[test]
fn frames_that_are_frozen_exchanged_interpolated_or_shifted_are_named() {
    let good = plain(&motion(400));
    let name = |change: &dyn Fn(&mut Trajectory)| {
        let mut bad = good.clone();
        change(&mut bad);
        let verdict = audit(&bad, &Question::new(Some(body()))).unwrap();
        assert_ne!(verdict.judgement, Judgement::Right);
        let kinds = verdict.faults.into_iter().filter_map(|fault| match fault {
            Fault::Misplaced { what, .. } => Some(what),
            _ => None,
        });
        kinds.collect::<Vec<Misplaced>>()
    };
    let copy = |record: &mut Trajectory, to: usize, from: usize| {
        let q = quaternions(record)[from];
        quaternions(record)[to] = q;
        let rates = record.rates.as_mut().unwrap();
        rates[to] = rates[from];
    };
    let frozen = name(&|record| (1..400).step_by(2).for_each(|row| copy(record, row, row - 1)));
    assert!(frozen.contains(&Misplaced::Repeated), "{frozen:?}");
    let exchanged = name(&|record| {
        let rates = record.rates.as_mut().unwrap();
        rates.swap(200, 201);
        quaternions(record).swap(200, 201);
    });
    assert_eq!(exchanged, [Misplaced::Exchanged]);
    let shifted = name(&|record| (300..399).for_each(|row| copy(record, row, row + 1)));
    assert!(shifted.contains(&Misplaced::Shifted), "{shifted:?}");
    let interpolated = name(&|record| {
        for row in (1..399).step_by(8) {
            let [a, b] = [row - 1, row + 1].map(|k| quaternions(record)[k]);
            let sign = if a.iter().zip(&b).map(|(x, y)| x * y).sum::<f64>() < 0.0 { -1.0 } else { 1.0 };
            quaternions(record)[row] = std::array::from_fn(|n| 0.5 * (a[n] + sign * b[n]));
            let rates = record.rates.as_mut().unwrap();
            rates[row] = std::array::from_fn(|n| 0.5 * (rates[row - 1][n] + rates[row + 1][n]));
        }
    });
    assert!(interpolated.contains(&Misplaced::Interpolated), "{interpolated:?}");
}

#[test]
fn noise_counts_where_it_is_declared() {
    let mut random = Seeded(77);
    let noisy = |states: &[Written], random: &mut Seeded| {
        let mut convention = Reading::default();
        convention.rate_unit = Some(RateUnit::RadiansPerSecond);
        let writing = Writing { noise: 1e-3, ..Writing::EXACT };
        record(random, states, &convention, Form::Quaternion, writing)
    };
    let states = motion(2000);
    let record = noisy(&states, &mut random);
    let mut question = Question::new(Some(body()));
    assert_eq!(audit(&record, &question).unwrap().judgement, Judgement::Undecided);
    // a component of a quaternion that is off by 1e-3 turns by 2e-3 rad
    question.noise = Noise { attitude: 2e-3, rates: 1.1e-3 };
    assert_eq!(audit(&record, &question).unwrap().judgement, Judgement::Right);
    question.noise.attitude = 1e-3;
    assert_ne!(audit(&record, &question).unwrap().judgement, Judgement::Right, "twice what is declared");
    // a body that is slightly another hides in no noise that is stated
    let other = Body::free(Inertia::from_moments([1.0, 2.0, 2.97]).unwrap());
    question = Question::new(Some(other));
    question.noise = Noise { attitude: 2e-3, rates: 1.1e-3 };
    assert_ne!(audit(&record, &question).unwrap().judgement, Judgement::Right);
    for attitude in [-1e-3, 0.2, f64::NAN] {
        question.noise = Noise { attitude, rates: 0.0 };
        assert!(
            audit(&record, &question).unwrap_err().to_string().starts_with("the noise of the attitude is")
        );
    }
}

/// A constant vector of one digit says nothing of the digits of the attitudes beside it.
#[test]
fn digits_are_those_of_each_column() {
    let body = Body::free(Inertia::from_moments([2.0, 2.0, 2.0]).unwrap());
    let start = body.state(UnitQuaternion::identity(), Vector3::new(0.5, 1.0, -0.25)).unwrap();
    let mut record = plain(&states(&body, &start, 0.05, 400));
    record.rates = Some(vec![[0.5, 1.0, -0.25]; 400]);
    record.digits = Digits { attitude: Some(17), rates: Some(1), momentum: None };
    let question = Question::new(Some(body));
    let verdict = audit(&record, &question).unwrap();
    assert_eq!(verdict.judgement, Judgement::Right);
    assert!(verdict.resolution.attitude.is_some_and(|resolution| resolution < 1e-12));
    quaternions(&mut record).iter_mut().skip(200).for_each(|q| *q = [q[0], q[1], q[3], -q[2]]);
    assert_eq!(audit(&record, &question).unwrap().judgement, Judgement::Wrong);
    // attitudes of one digit decide nothing
    let mut coarse = plain(&motion(400));
    quaternions(&mut coarse).iter_mut().flatten().for_each(|x| *x = (10.0 * *x).round() / 10.0);
    coarse.rates = None;
    coarse.digits = Digits { attitude: Some(1), ..Digits::default() };
    assert_ne!(judged(&coarse), Judgement::Right);
}

/// Half a unit of the last decimal in each of three components is √3 times as much as in one.
#[test]
fn an_exact_record_of_any_number_of_decimals_is_right() {
    let good = plain(&motion(400));
    for (decimals, unit) in [(2, 1e2), (3, 1e3), (4, 1e4), (5, 1e5), (8, 1e8)] {
        let rounded = |x: &mut f64| *x = (*x * unit).round() / unit;
        let mut record = good.clone();
        quaternions(&mut record).iter_mut().flatten().for_each(rounded);
        record.rates.as_mut().unwrap().iter_mut().flatten().for_each(rounded);
        assert_eq!(judged(&record), Judgement::Right, "{decimals}");
        record.rates.as_mut().unwrap()[200][1] += (4.0 / unit).max(4e-6);
        assert_ne!(judged(&record), Judgement::Right, "{decimals}, and one number off by more");
    }
}

/// Over the 90 rad between rows no reading is told by its equations, and that of this library is taken.
#[test]
fn rows_that_are_many_turns_apart_are_not_wrong() {
    let start = body().state(UnitQuaternion::identity(), Vector3::new(0.4, 1.0, -0.3)).unwrap();
    let record = plain(&states(&body(), &start, 80.0, 60));
    assert_eq!(judged(&record), Judgement::Right);
    let other = Body::free(Inertia::from_moments([1.0, 2.0, 2.9]).unwrap());
    let verdict = audit(&record, &Question::new(Some(other))).unwrap();
    assert_eq!((verdict.judgement, verdict.suspect), (Judgement::Undecided, Suspect::None));
    assert!(verdict.faults.iter().any(|fault| matches!(fault, Fault::TooCoarse { angle } if *angle > 80.0)));
}

/// At up to 1.3 rad/s half a millisecond is 6e-4 of a turn and of the angular velocity.
#[test]
fn times_of_an_even_clock_may_be_rounded_and_hide_no_more_than_that() {
    let start = body().state(UnitQuaternion::identity(), Vector3::new(0.4, 1.0, -0.3)).unwrap();
    let good = plain(&states(&body(), &start, 1.0 / 240.0, 1200));
    let of = |change: &dyn Fn(&mut Trajectory)| {
        let mut record = good.clone();
        record.times.iter_mut().for_each(|t| *t = (*t * 1e3).round() / 1e3);
        change(&mut record);
        let verdict = audit(&record, &Question::new(Some(body()))).unwrap();
        let is_named = verdict.faults.iter().any(|fault| matches!(fault, Fault::RoundedTimes { .. }));
        assert!(is_named, "{:?}", verdict.faults);
        verdict.judgement
    };
    assert_eq!(of(&|_| {}), Judgement::Right);
    assert_eq!(of(&|record| record.rates = None), Judgement::Right);
    assert_eq!(of(&|record| record.attitude = None), Judgement::Right);
    assert_ne!(of(&|record| record.rates.as_mut().unwrap()[900][1] += 2e-3), Judgement::Right);
    assert_ne!(of(&|record| quaternions(record)[900][1] += 2e-3), Judgement::Right);
}

/// Of few digits, attitudes leave open what they turn into the body, and not what was written in space.
#[test]
fn attitudes_of_few_digits_hide_no_fault_of_an_angular_velocity_in_space() {
    let rows = motion(400);
    let mut convention = Reading::default();
    convention.rate_unit = Some(RateUnit::RadiansPerSecond);
    convention.omega_frame = Some(Frame::Space);
    for faster in [1.0, 30.0] {
        let rows: Vec<Written> = rows.iter().map(|(t, q, w)| (t / faster, *q, *w * faster)).collect();
        let of = |digits| {
            let writing = Writing { digits, ..Writing::EXACT };
            record(&mut Seeded(3), &rows, &convention, Form::Quaternion, writing)
        };
        let mut written = of(5);
        written.rates = of(7).rates;
        assert_eq!(judged(&written), Judgement::Right);
        for row in [1, 200, 399] {
            let mut bad = written.clone();
            bad.rates.as_mut().unwrap()[row][1] += 1.2e-5 * faster;
            assert_ne!(judged(&bad), Judgement::Right, "row {row}, {faster} times faster");
        }
    }
}

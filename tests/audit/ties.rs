//! Readings that no record can tell apart, and records that lack columns.

use nalgebra::{UnitQuaternion, Vector3};
use polhode::audit::{
    AngleUnit, Attitudes, AuditError, Direction, Fault, Frame, Judgement, Missing, Noise, Question, Suspect,
    TieReason, Trajectory, audit,
};
use polhode::body::{Body, State};
use polhode::flow::{ExactMotion, FreeMotion};
use polhode::inertia::Inertia;
use polhode::rotation::Vec3;

use super::records::{Form, Seeded, Writing, Written, reading, record};

pub(crate) fn states(body: &Body, start: &State, dt: f64, rows: usize) -> Vec<Written> {
    let motion = ExactMotion::new(body, start).unwrap();
    let at = |k: usize| {
        let state = motion.at(k as f64 * dt).unwrap();
        (k as f64 * dt, state.attitude, Vec3::from(body.omega_body(&state)))
    };
    (0..rows).map(at).collect()
}

/// A record in this library's convention, and the body.
fn plain(
    moments: [f64; 3],
    attitude: UnitQuaternion<f64>,
    omega: [f64; 3],
    form: Form,
) -> (Trajectory, Body) {
    let body = Body::free(Inertia::from_moments(moments).unwrap());
    let start = body.state(attitude, Vector3::from(omega)).unwrap();
    let mut random = Seeded(5);
    let mut convention = reading(&mut random, form);
    convention.quaternion = convention.quaternion.map(|_| polhode::audit::QuaternionOrder::ScalarFirst);
    convention.attitude = Some(Direction::BodyToSpace);
    convention.omega_frame = Some(Frame::Body);
    convention.rate_unit = Some(polhode::audit::RateUnit::RadiansPerSecond);
    let written = states(&body, &start, 0.05, 400);
    (record(&mut random, &written, &convention, form, Writing::EXACT), body)
}

fn tilted() -> UnitQuaternion<f64> {
    UnitQuaternion::from_euler_angles(0.3, -0.8, 1.9)
}

#[test]
fn equal_moments_tie_and_nothing_else_does() {
    let (file, body) = plain([1.0, 1.0, 1.5], tilted(), [0.4, 1.0, -0.3], Form::Quaternion);
    let mut question = Question::new(Some(body));
    question.claims.moments = None;
    let verdict = audit(&file, &question).unwrap();
    let tie = verdict.tie.unwrap();
    let mut orders: Vec<_> = tie.readings.iter().map(|reading| reading.moments).collect();
    orders.sort_unstable();
    assert_eq!((orders, tie.reason), (vec![[0, 1, 2], [1, 0, 2]], TieReason::SymmetricBody));
    assert_eq!((verdict.judgement, verdict.suspect), (Judgement::Right, Suspect::None));
}

/// No other attitude at the start would make a sphere tumble.
#[test]
fn a_sphere_ties_by_its_moments() {
    let (file, body) = plain([2.0, 2.0, 2.0], tilted(), [0.4, 1.0, -0.3], Form::Quaternion);
    let verdict = audit(&file, &Question::new(Some(body))).unwrap();
    assert_eq!(verdict.tie.map(|tie| tie.reason), Some(TieReason::SymmetricBody));
    assert_eq!(verdict.judgement, Judgement::Right);
}

/// About z of both frames: axes of ω are the same, and no moment is felt.
#[test]
fn a_steady_spin_tells_neither_frame_nor_moments() {
    let (file, body) = plain([1.0, 2.0, 2.5], UnitQuaternion::identity(), [0.0, 0.0, 1.3], Form::Quaternion);
    let mut question = Question::new(Some(body));
    question.claims.moments = None;
    let verdict = audit(&file, &question).unwrap();
    let tie = verdict.tie.unwrap();
    assert_eq!((tie.readings.len(), tie.reason), (12, TieReason::PureSpin));
    assert!(tie.readings.iter().all(|read| read.attitude == Some(Direction::BodyToSpace)), "{tie:?}");
    assert_eq!(verdict.judgement, Judgement::Right);
}

#[test]
fn without_a_body_its_shape_is_found() {
    for form in [Form::Quaternion, Form::Angles] {
        let (file, _) = plain([1.0, 2.0, 2.5], tilted(), [0.4, 1.0, -0.3], form);
        let verdict = audit(&file, &Question::new(None)).unwrap();
        assert_eq!(verdict.judgement, Judgement::Right, "{verdict:?}");
        assert!(verdict.missing.contains(&Missing::Body) && verdict.tie.is_none(), "{:?}", verdict.tie);
        let tensor = verdict.body.inertia().tensor();
        for (axis, moment) in [1.0, 2.0, 2.5].into_iter().enumerate() {
            assert!((tensor[(axis, axis)] - moment / 5.5).abs() < 1e-6, "{tensor}");
        }
    }
}

#[test]
fn attitudes_alone_are_enough() {
    let (mut file, body) = plain([1.0, 2.0, 2.5], tilted(), [0.4, 1.0, -0.3], Form::Matrix);
    file.rates = None;
    let verdict = audit(&file, &Question::new(Some(body))).unwrap();
    assert_eq!(verdict.judgement, Judgement::Right, "{verdict:?}");
    assert_eq!(verdict.missing, [Missing::Rates]);
    assert_eq!((verdict.reading.attitude, verdict.tie), (Some(Direction::BodyToSpace), None));
}

/// Flat bodies turn their angular velocity as fast as they turn: what it is between two attitudes has to be found to the last digit.
#[test]
fn exact_attitudes_of_flat_bodies_are_right() {
    for moments in [[0.014, 0.015, 0.027], [1.0, 1.2, 2.2], [1.0, 3.0, 3.9]] {
        let (mut file, body) = plain(moments, tilted(), [0.3, -0.2, 1.0], Form::Quaternion);
        file.rates = None;
        let verdict = audit(&file, &Question::new(Some(body))).unwrap();
        assert_eq!(verdict.judgement, Judgement::Right, "{moments:?}: {:?}", verdict.conservation);
    }
}

#[test]
fn angular_velocities_alone_get_the_verdict_that_they_allow() {
    let (mut file, body) = plain([1.0, 2.0, 2.5], tilted(), [0.4, 1.0, -0.3], Form::Matrix);
    file.attitude = None;
    let verdict = audit(&file, &Question::new(Some(body.clone()))).unwrap();
    assert_eq!((verdict.judgement, &verdict.missing[..]), (Judgement::Right, &[Missing::Attitude][..]));
    assert!(verdict.attitude_error.is_none() && verdict.flips == verdict.flips_exact, "{verdict:?}");
    let rates = file.rates.as_mut().unwrap();
    for rate in rates.iter_mut() {
        *rate = rate.map(|x| x * 180.0 / std::f64::consts::PI);
    }
    let mut question = Question::new(Some(body));
    question.claims.rate_unit = Some(polhode::audit::RateUnit::RadiansPerSecond);
    let verdict = audit(&file, &question).unwrap();
    assert_eq!((verdict.judgement, verdict.suspect), (Judgement::Wrong, Suspect::Degrees));
}

#[test]
fn momenta_in_space_stand_for_angular_velocities() {
    let (mut file, body) = plain([1.0, 2.0, 2.5], tilted(), [0.4, 1.0, -0.3], Form::Quaternion);
    let start = body.state(tilted(), Vector3::new(0.4, 1.0, -0.3)).unwrap();
    file.rates = None;
    file.momentum = Some(vec![start.momentum_space().into(); 400]);
    let verdict = audit(&file, &Question::new(Some(body))).unwrap();
    assert_eq!(verdict.reading.momentum_frame, Some(Frame::Space));
    assert_eq!((verdict.judgement, verdict.tie), (Judgement::Right, None));
}

/// Gravity acts on the record of a top; without it the record is wrong.
#[test]
fn a_top_is_right_with_its_weight_only() {
    let inertia = Inertia::from_moments([1.25, 1.25, 0.75]).unwrap();
    let top = Body::heavy(inertia.clone(), Vector3::new(0.0, 0.0, 2.0)).unwrap();
    let start = top.state(tilted(), Vector3::new(0.2, 0.1, 9.0)).unwrap();
    let mut random = Seeded(8);
    for (form, noise) in [(Form::Quaternion, 0.0), (Form::Matrix, 1e-5)] {
        let convention = reading(&mut random, form);
        let written = states(&top, &start, 0.02, 500);
        let file = record(&mut random, &written, &convention, form, Writing { noise, ..Writing::EXACT });
        let mut question = Question::new(Some(top.clone()));
        let verdict = audit(&file, &question).unwrap();
        // noise that nobody declares decides nothing
        let expected = if noise > 0.0 { Judgement::Undecided } else { Judgement::Right };
        assert_eq!((verdict.judgement, verdict.suspect), (expected, Suspect::None));
        question.noise = Noise { attitude: 1.2 * noise, rates: 9.0 * 1.2 * noise };
        let verdict = audit(&file, &question).unwrap();
        assert_eq!((verdict.judgement, verdict.suspect), (Judgement::Right, Suspect::None));
        assert_eq!(verdict.reading, convention);
        let verdict = audit(&file, &Question::new(Some(Body::free(inertia.clone())))).unwrap();
        assert_eq!(verdict.judgement, Judgement::Wrong);
    }
}

/// One step of the state, a gap in the times, a quaternion that changes its sign, a clamped rate.
#[test]
fn faults_of_sampling_are_seen() {
    let (clean, body) = plain([1.0, 2.0, 2.5], tilted(), [0.4, 1.0, -0.3], Form::Quaternion);
    let found = |file: &Trajectory| audit(file, &Question::new(Some(body.clone()))).unwrap();
    assert_eq!(found(&clean).faults, []);
    let quaternions = |file: &mut Trajectory, change: &dyn Fn(usize, [f64; 4]) -> [f64; 4]| {
        let Some(Attitudes::Quaternions(rows)) = &mut file.attitude else { panic!() };
        for (row, q) in rows.iter_mut().enumerate() {
            *q = change(row, *q);
        }
    };
    let mut file = clean.clone();
    quaternions(&mut file, &|row, q| if row >= 200 { q.map(|x| -x) } else { q });
    let verdict = found(&file);
    assert_eq!(verdict.faults, [Fault::SignFlips { row: 200, count: 1 }]);
    assert_eq!(verdict.judgement, Judgement::Right);
    let mut file = clean.clone();
    quaternions(&mut file, &|_, q| q.map(|x| 1.01 * x));
    assert!(
        matches!(found(&file).faults[..], [Fault::NotNormalized { error, .. }] if (error - 0.01).abs() < 1e-9)
    );
    let mut file = clean.clone();
    quaternions(&mut file, &|row, q| if row >= 150 { [-q[1], q[0], -q[3], q[2]] } else { q });
    let verdict = found(&file);
    assert!(
        verdict.faults.iter().any(|fault| matches!(fault, Fault::Discontinuity { row: 150, .. })),
        "{verdict:?}"
    );
    assert_eq!((verdict.judgement, verdict.suspect), (Judgement::Wrong, Suspect::Discontinuity));
    let mut file = clean.clone();
    let most = file.rates.iter().flatten().fold(0.0_f64, |most, rate| most.max(rate[0]));
    file.rates.iter_mut().flatten().for_each(|rate| rate[0] = rate[0].min(0.8 * most));
    let verdict = found(&file);
    assert!(
        verdict.faults.iter().any(|fault| matches!(fault, Fault::Plateau { rows, .. } if *rows > 5)),
        "{verdict:?}"
    );
    assert_eq!(verdict.judgement, Judgement::Wrong);
    // with one row of so many left out; where intervals differ often, none of them is a jump
    for (every, jumps) in [(100, 4), (10, 0)] {
        let Some(Attitudes::Quaternions(rows)) = &clean.attitude else { panic!() };
        let rates = clean.rates.as_ref().unwrap();
        let kept = || (0..400).filter(|row| row % every != 5);
        let file = Trajectory::new(kept().map(|row| clean.times[row]).collect())
            .with_attitude(Attitudes::Quaternions(kept().map(|row| rows[row]).collect()))
            .with_rates(kept().map(|row| rates[row]).collect());
        let verdict = found(&file);
        let counts: Vec<usize> = (verdict.faults.iter())
            .map(|fault| if let Fault::TimeJump { count, .. } = fault { *count } else { panic!("{fault}") })
            .collect();
        assert_eq!(counts.iter().sum::<usize>(), jumps);
        assert_eq!(verdict.judgement, Judgement::Right);
    }
    let mut file = clean;
    file.times.iter_mut().skip(100).for_each(|t| *t += 3.0);
    let faults = found(&file).faults;
    assert!(matches!(faults[0], Fault::TimeJump { row: 100, count: 1, .. }), "{faults:?}");
}

#[test]
fn what_cannot_be_audited_is_refused_with_the_numbers() {
    let (file, body) = plain([1.0, 2.0, 2.5], tilted(), [0.4, 1.0, -0.3], Form::Quaternion);
    let refused = |file: &Trajectory| audit(file, &Question::new(Some(body.clone()))).unwrap_err();
    assert_eq!(refused(&Trajectory::new(vec![0.0, 1.0])), AuditError::TooFewRows { rows: 2, needed: 10 });
    let mut turned = file.clone();
    turned.times.swap(3, 4);
    let error = refused(&turned);
    assert!(matches!(error, AuditError::TimesNotAscending { row: 4, .. }), "{error}");
    assert_eq!(
        error.to_string(),
        "row 4: the time 0.15000000000000002 s does not come after 0.2 s; times must ascend"
    );
    let mut still = file.clone();
    still.rates = Some(vec![[0.0; 3]; 400]);
    still.attitude = Some(Attitudes::Quaternions(vec![[1.0, 0.0, 0.0, 0.0]; 400]));
    assert_eq!(refused(&still), AuditError::AtRest);
    let mut short = file.clone();
    short.rates.as_mut().unwrap().pop();
    assert!(matches!(refused(&short), AuditError::Lengths { found: 399, rows: 400, .. }));
    let mut blank = file.clone();
    blank.digits.rates = Some(0);
    assert_eq!(refused(&blank), AuditError::NoDigits { column: "angular velocity" });
    let mut nowhere = file.clone();
    let Some(Attitudes::Quaternions(rows)) = &mut nowhere.attitude else { panic!() };
    rows[7] = [0.0; 4];
    assert_eq!(refused(&nowhere), AuditError::NoAttitude { row: 7 });
    // three angles of zero are an attitude
    nowhere.attitude = Some(Attitudes::Angles(vec![[0.0; 3]; 400]));
    assert_eq!(nowhere.check(), Ok(()));
    let mut question = Question::new(None);
    // within half a radian nearly any attitude is right
    for value in [-1.0, 0.5, f64::INFINITY] {
        question.tolerance = value;
        assert_eq!(audit(&file, &question).unwrap_err(), AuditError::Tolerance { value, most: 0.1 });
    }
    // nor is noise declared of a column that is not there
    let (mut rates, mut attitudes) = (file.clone(), file.clone());
    (rates.attitude, attitudes.rates) = (None, None);
    for (record, noise, quantity, value) in [
        (rates, Noise { attitude: 1e-3, rates: 0.01 }, "attitude", 1e-3),
        (attitudes, Noise { attitude: 1e-3, rates: 0.01 }, "angular velocity", 0.01),
    ] {
        let mut question = Question::new(Some(body.clone()));
        question.noise = noise;
        let error = audit(&record, &question).unwrap_err();
        assert_eq!(error, AuditError::NoiseOfNothing { quantity, value });
        let says = format!("declared to be {value}, and the record has no {quantity}; declare 0");
        assert!(error.to_string().ends_with(&says), "{error}");
    }
}

/// What an exact motion does with the flips of the record, and what a run leaves: the integrator by its name and step.
#[test]
fn an_integrator_is_named_with_its_step_and_its_error() {
    let body = Body::free(Inertia::from_moments([1.0, 2.0, 2.5]).unwrap());
    let start = body.state(tilted(), Vector3::new(0.4, 1.0, -0.3)).unwrap();
    let motion = FreeMotion::from_state(body.inertia(), &start).unwrap();
    for (name, steps) in [("explicit-euler", 1), ("rk4", 2), ("semi-implicit-euler", 5), ("lie-poisson", 1)] {
        let h = 0.1 / f64::from(steps);
        let method = polhode::method(name).unwrap();
        let mut run = polhode::Run::new(&method, &body, &start, h).unwrap();
        let written: Vec<Written> = (0..200_u32)
            .map(|k| {
                let sample = run.advance_to(u64::from(k * steps)).unwrap();
                (0.1 * f64::from(k), sample.state.attitude, Vec3::from(sample.omega_body))
            })
            .collect();
        let mut random = Seeded(3);
        let convention = reading(&mut random, Form::Matrix);
        let file = record(&mut random, &written, &convention, Form::Matrix, Writing::EXACT);
        let mut question = Question::new(Some(body.clone()));
        question.tolerance = 1e-10;
        let verdict = audit(&file, &question).unwrap();
        assert_eq!(verdict.suspect.to_string(), format!("integrator:{name}"), "{}", verdict.reading);
        let signature = verdict.signature.unwrap();
        assert_eq!((signature.method.as_str(), signature.steps_per_row), (name, u64::from(steps)));
        let row = (signature.at / 0.1).round() as usize;
        let exact = motion.at(signature.at).unwrap().attitude;
        let error = polhode::rotation::rotation_angle(written[row].1, exact);
        assert!((signature.measured_attitude_error / error - 1.0).abs() < 1e-6, "{error:e} {signature:?}");
        assert!((signature.predicted_attitude_error / error - 1.0).abs() < 1e-3, "{error:e} {signature:?}");
    }
}

/// Columns of any numbers: a verdict or a refusal, never a panic, and never right. Two of each kind: what befalls fewer than one
/// in some ten such files is not seen here.
#[test]
fn numbers_of_any_size_are_survived() {
    let body = Body::free(Inertia::from_moments([1.0, 2.0, 2.5]).unwrap());
    for seed in 0..8 {
        let mut random = Seeded(900 + seed);
        let size = 10_f64.powf(random.between(-300.0, 300.0));
        let rows = 10 + random.below(60);
        let mut draw = |size: f64| size * random.normal();
        let times = (0..rows).map(|k| 0.1 * k as f64).collect();
        let rates = (0..rows).map(|_| [0; 3].map(|_| draw(size))).collect();
        let attitude = match seed % 4 {
            0 => Attitudes::Quaternions((0..rows).map(|_| [0; 4].map(|_| draw(1.0))).collect()),
            1 => Attitudes::Matrices((0..rows).map(|_| [0; 9].map(|_| draw(size))).collect()),
            2 => Attitudes::Angles((0..rows).map(|_| [0; 3].map(|_| draw(3.0))).collect()),
            _ => Attitudes::Rodrigues((0..rows).map(|_| [0; 3].map(|_| draw(size))).collect()),
        };
        let file = Trajectory::new(times).with_attitude(attitude).with_rates(rates);
        for asked in [Some(body.clone()), None] {
            let Ok(verdict) = audit(&file, &Question::new(asked)) else { continue };
            assert_ne!(verdict.judgement, Judgement::Right, "{seed}");
            for kept in &verdict.conservation {
                assert!(kept.error.is_finite(), "{seed} {kept:?}");
            }
            let error = verdict.attitude_error.map_or(0.0, |error| error.largest + error.phase + error.drift);
            assert!(error.is_finite(), "{seed} {:?}", verdict.attitude_error);
        }
    }
}

/// The moments of a pure spin can be read in any order. Where the middle one is put on its axis, the noise of the first row grows.
#[test]
fn an_unstable_reading_of_a_stable_spin_does_not_make_it_wrong() {
    for (moments, noise) in [([0.886, 0.668, 1.028], 3e-7), ([0.6, 0.9, 1.1], 1e-6), ([1.1, 0.9, 0.6], 1e-5)]
    {
        let body = Body::free(Inertia::from_moments(moments).unwrap());
        let start = body.state(tilted(), Vector3::new(0.0, 0.0, 0.9)).unwrap();
        let mut random = Seeded(11);
        let mut convention = reading(&mut random, Form::Quaternion);
        convention.omega_frame = Some(Frame::Body);
        convention.moments = [0, 1, 2];
        let writing = Writing { noise, ..Writing::EXACT };
        let file =
            record(&mut random, &states(&body, &start, 0.2, 300), &convention, Form::Quaternion, writing);
        // the same moments in an order in which the spin is about the middle one
        let mut question = Question::new(Some(Body::free(
            Inertia::from_moments([moments[0], moments[2], moments[1]]).unwrap(),
        )));
        question.claims.moments = None;
        let verdict = audit(&file, &question).unwrap();
        assert_eq!(verdict.judgement, Judgement::Undecided, "{moments:?}");
        question.noise = Noise { attitude: 2.0 * noise, rates: 2.0 * noise };
        assert_eq!(audit(&file, &question).unwrap().judgement, Judgement::Right, "{moments:?}");
    }
}

/// A spin about the last of the angles looks alike in rad and in degrees, but for the rows at which the angle begins anew.
#[test]
fn an_angle_that_begins_anew_after_a_turn_tells_its_unit() {
    let times: Vec<f64> = (0..800).map(|k| 0.05 * f64::from(k)).collect();
    for (turn, unit) in [(std::f64::consts::TAU, AngleUnit::Radians), (360.0, AngleUnit::Degrees)] {
        for part in [0.0014, 0.05, 0.21] {
            let angle = |k: u32| {
                let turns = part * f64::from(k);
                (1e6 * turn * (turns - (turns + 0.5).floor())).round() / 1e6
            };
            let angles = (0..800).map(|k| [0.0, 0.0, angle(k)]).collect();
            let record = Trajectory::new(times.clone())
                .with_attitude(Attitudes::Angles(angles))
                .with_rates(vec![[0.0, 0.0, part * turn / 0.05]; 800]);
            let body = Body::free(Inertia::from_moments([1.0, 2.0, 3.0]).unwrap());
            let verdict = audit(&record, &Question::new(Some(body))).unwrap();
            assert_eq!(verdict.judgement, Judgement::Right, "{unit}, {part}");
            assert_eq!(verdict.reading.angles.map(|angles| angles.unit), Some(unit), "{part}");
        }
    }
}

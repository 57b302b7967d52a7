//! The convention in which a record was written is the one that is found, and what is right is called right.

use polhode::audit::{Judgement, Question, audit};
use polhode::body::{Body, State};
use polhode::flow::FreeMotion;
use polhode::inertia::Inertia;
use polhode::method::{Claimed, without_projections};
use polhode::rotation::{Vec3, rotation_angle};
use polhode::run::Run;

use super::records::{Form, Seeded, Writing, Written, number, reading, record, tumbling};

const ORDERS: [[usize; 3]; 6] = [[0, 1, 2], [0, 2, 1], [1, 0, 2], [1, 2, 0], [2, 0, 1], [2, 1, 0]];

/// Rows of the exact motion.
fn exact(body: &Body, start: &State, dt: f64, rows: usize) -> Vec<Written> {
    let motion = FreeMotion::from_state(body.inertia(), start).unwrap();
    let at = |k: usize| {
        let state = motion.at(k as f64 * dt).unwrap();
        (k as f64 * dt, state.attitude, Vec3::from(body.omega_body(&state)))
    };
    (0..rows).map(at).collect()
}

/// Distance of two series of states: attitude in rad, or ω relative to the spin, whichever is larger.
fn apart(a: &[Written], b: &[Written], spin: f64) -> f64 {
    let pairs = a.iter().zip(b);
    pairs.fold(0.0, |most, (a, b)| most.max(rotation_angle(a.1, b.1)).max((a.2 - b.2).norm() / spin))
}

#[test]
fn the_convention_of_a_record_is_found_and_no_record_is_misjudged() {
    let number = number(16);
    let (mut missed, mut false_right, mut false_wrong, mut undecided, mut named, mut integrated) =
        (0, 0, 0, 0, 0, 0);
    for seed in 0..number {
        let mut random = Seeded(1000 + seed);
        let (body, start, spin) = tumbling(&mut random);
        let rows = 100 + random.below(900);
        let dt = 10_f64.powf(random.between(-2.3, -0.5)) / spin;
        let methods = without_projections();
        let chosen = random.below(2 * methods.len());
        let truth_states = exact(&body, &start, dt, rows);
        let (name, states): (String, Vec<Written>) = match methods.get(chosen) {
            Some(method) => {
                let mut run = Run::new(method, &body, &start, dt).unwrap();
                let states = (0..rows as u64).map_while(|k| {
                    let sample = run.advance_to(k).ok()?;
                    Some((k as f64 * dt, sample.state.attitude, Vec3::from(sample.omega_body)))
                });
                (method.name(), states.collect())
            }
            None => ("exact".into(), truth_states.clone()),
        };
        if states.len() < 40 {
            continue; // it has diverged
        }
        let form = random.one_of(&[Form::Quaternion, Form::Matrix, Form::Angles, Form::Rodrigues]);
        let mut truth = reading(&mut random, form);
        let writing = Writing {
            single: random.below(4) == 0,
            digits: 6 + random.below(12),
            noise: random.one_of(&[0.0, 0.0, 0.0, 1e-9, 1e-6, 1e-4, 1e-3]),
        };
        let file = record(&mut random, &states, &truth, form, writing);
        truth.moments = random.one_of(&ORDERS);
        let moments = body.inertia().tensor().diagonal();
        let mut typed = [0.0; 3];
        for (axis, &given) in truth.moments.iter().enumerate() {
            typed[given] = moments[axis];
        }
        let mut question = Question::new(Some(Body::free(Inertia::from_moments(typed).unwrap())));
        question.claims.moments = None;
        let verdict = audit(&file, &question).unwrap();
        let error = apart(&states, &truth_states, spin);
        let open = writing.noise.max(0.1_f64.powi(writing.digits as i32 - 1)).max(if writing.single {
            1e-7
        } else {
            0.0
        });
        let wrong_indeed = error > 5e-6 && error > 30.0 * open;
        let right_indeed = error < 5e-7 || error < 0.2 * open;
        let line =
            format!("{seed} {name} {form:?} {writing:?} rows {rows}: error {error:.1e}, {}", verdict.suspect);
        if verdict.reading != truth || verdict.tie.is_some() {
            missed += 1;
            let tied = verdict.tie.map_or(0, |tie| tie.readings.len());
            println!("MISSED {line}, {tied} tied\n  truth {truth}\n  found {}", verdict.reading);
        } else if verdict.judgement == Judgement::Right && wrong_indeed {
            false_right += 1;
            println!("FALSE RIGHT {line} {:?}", verdict.attitude_error);
        } else if verdict.judgement == Judgement::Wrong && right_indeed {
            false_wrong += 1;
            println!("FALSE WRONG {line} {:?} {:?}", verdict.attitude_error, verdict.resolution);
        }
        undecided += u64::from(verdict.judgement == Judgement::Undecided);
        if wrong_indeed {
            integrated += 1;
            let told = verdict.signature.as_ref().is_some_and(|found| found.method == name);
            named += u64::from(told);
            if !told {
                println!(
                    "not named {line} {:?}",
                    verdict.signature.map(|found| (found.method, found.mismatch))
                );
            }
        }
    }
    println!(
        "{number}: {missed} missed, {false_right} false right, {false_wrong} false wrong, {undecided} undecided; \
         {named} of {integrated} integrators named"
    );
    assert!(100 * missed <= number, "{missed} of {number}");
    assert_eq!((false_right, false_wrong), (0, 0));
}

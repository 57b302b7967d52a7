//! Ensembles against their members alone, bit for bit: in lanes of every width, in parts, on threads.

#[cfg(feature = "parallel")]
use std::collections::HashSet;
#[cfg(feature = "parallel")]
use std::sync::{Arc, Mutex};

use nalgebra::{Matrix3, UnitQuaternion, Vector3};
use polhode::body::{Body, Clock, Conserved, Force, Orbit, State, StateError};
use polhode::events::Event;
use polhode::flow::{FreeMotion, LagrangeTop};
use polhode::inertia::Inertia;
use polhode::method::method;
use polhode::num::Instructions;
use polhode::run::{
    Ensemble, EnsembleError, MemberError, Observed, Rows, Run, RunError, Spread, Tally, Watch,
};

/// Numbers in [0, 1) that are evenly spread, the same in every run.
fn part(k: usize, ratio: f64) -> f64 {
    ((k + 1) as f64 * ratio).fract()
}

fn inertia(k: usize) -> Inertia {
    let (a, b) = (part(k, 0.618_033_988_749_895), part(k, 0.754_877_666_246_693));
    // the moments stand in any order
    let moments = [1.0, 1.6 + 0.4 * a, 2.2 + 0.4 * b];
    Inertia::from_moments([moments[k % 3], moments[(k + 1) % 3], moments[(k + 2) % 3]]).unwrap()
}

fn attitude(k: usize) -> UnitQuaternion<f64> {
    UnitQuaternion::from_euler_angles(part(k, 0.27), 6.0 * part(k, 0.31), -part(k, 0.83))
}

/// Of sizes for all widths of turns at a step of 0.01 s: small ones, up to a radian, and many turns a step.
fn omega(k: usize) -> Vector3<f64> {
    let size = [1.0, 0.3, 30.0, 1.0, 200.0, 3.0][k % 6];
    Vector3::new(0.4 + part(k, 0.29), 1.0, -0.3 - part(k, 0.57)) * size
}

fn members(numbers: impl Iterator<Item = usize>) -> Ensemble {
    let mut ensemble = Ensemble::new();
    for k in numbers {
        ensemble.push_omega(&inertia(k), attitude(k), omega(k));
    }
    ensemble
}

/// All states in the order of the members, time by time.
fn collected(work: impl FnOnce(&mut dyn FnMut(&Rows))) -> Vec<Vec<State>> {
    let mut all: Vec<Vec<State>> = Vec::new();
    work(&mut |rows| {
        let failures: Vec<_> = rows.failures().collect();
        assert!(failures.is_empty(), "{failures:?}");
        all.resize(rows.times(), Vec::new());
        for (time, states) in all.iter_mut().enumerate() {
            assert_eq!(states.len(), rows.first());
            states.extend_from_slice(rows.states(time));
        }
    });
    all
}

fn advanced(ensemble: &Ensemble, name: &str, clock: Clock, steps: &[u64]) -> Vec<Vec<State>> {
    collected(|each| {
        let done = ensemble.advance(&method(name).unwrap(), clock, steps, |rows| {
            each(rows);
            Ok::<(), EnsembleError>(())
        });
        done.unwrap();
    })
}

fn moved(ensemble: &Ensemble, times: &[f64]) -> Vec<Vec<State>> {
    collected(|each| {
        let done = ensemble.at(times, |rows| {
            each(rows);
            Ok::<(), EnsembleError>(())
        });
        done.unwrap();
    })
}

/// Every bit, also the sign of a zero.
fn bits(states: &[Vec<State>]) -> Vec<u64> {
    let numbers = states.iter().flatten().flat_map(|x| {
        let (q, m) = (x.attitude.components(), x.momentum_body.0);
        q.into_iter().chain(m)
    });
    numbers.map(f64::to_bits).collect()
}

/// The run of a member by itself.
fn alone(body: &Body, k: usize, name: &str, clock: Clock) -> Run {
    let start = body.enter_omega(attitude(k).into(), omega(k).into()).unwrap();
    let run = Run::from_point(&method(name).unwrap(), body, start.to_f64(), clock).unwrap();
    run.watching(Watch::Never)
}

/// What was `found` of a member at the times after so many steps has the bits of its run by itself.
fn assert_bits_of(mut run: Run, steps: &[u64], found: impl Fn(usize) -> State, what: &str) {
    for (time, &steps) in steps.iter().enumerate() {
        let alone = run.advance_to(steps).unwrap().state;
        assert_eq!(bits(&[vec![alone]]), bits(&[vec![found(time)]]), "{what}, {steps} steps");
    }
}

/// Methods that move bodies under forces in lanes.
const UNDER_FORCES: [&str; 18] = [
    "rk4",
    "rk4-normalized",
    "two-turn",
    "two-turn:31@suzuki-4",
    "lie-poisson",
    "lie-poisson@suzuki-4",
    "kick-drift",
    "kick-drift@suzuki-4",
    "kick-drift@srkn-6b",
    "kick-drift@srkn-11b",
    "kick-drift@srkn-14a",
    "kick-drift@chin-4a",
    "kick-drift@processed-6-4",
    "rattle",
    "rattle@suzuki-4",
    "dmv:4",
    "dmv:10",
    "dmv:12@srkn-11b",
];

const SETS: [Instructions; 3] = [Instructions::Widest, Instructions::Avx2, Instructions::Baseline];

#[test]
fn a_member_has_the_bits_of_its_own_run() {
    const COUNT: usize = 150;
    let (clock, steps) = (Clock { start: 5.0, step: 0.01 }, [0, 7, 8, 100, 100, 257]);
    let names = [
        "two-turn",
        "two-turn:31",
        "two-turn@blanes-moan-s10",
        "lie-poisson",
        "lie-poisson:213@suzuki-4",
        "rk4",
        "rk4-normalized",
        "explicit-euler",
        "implicit-midpoint",
    ];
    for name in names {
        // steps of many turns have no solution, or diverge
        let wild: &[usize] = match name {
            "implicit-midpoint" | "explicit-euler" => &[2, 4],
            "rk4" | "rk4-normalized" => &[4],
            _ => &[],
        };
        let numbers: Vec<usize> = (0..COUNT).filter(|k| !wild.contains(&(k % 6))).collect();
        let ensemble = members(numbers.iter().copied());
        let found = advanced(&ensemble, name, clock, &steps);
        for (place, &k) in numbers.iter().enumerate() {
            let run = alone(&Body::free(inertia(k)), k, name, clock);
            assert_bits_of(run, &steps, |time| found[time][place], &format!("{name}, member {k}"));
        }
    }
}

/// Everything that may act in lanes, alone and together, on an orbit that all share.
fn forces() -> Vec<(&'static str, Vec<Force>)> {
    let gravity = || Force::gravity(Vector3::new(0.3, -0.2, 2.0)).unwrap();
    let circle = || Force::gravity_gradient(0.8, 0.0).unwrap();
    let hyperbola = Orbit::conic(2.0, 1.2, 1.7).unwrap().passing_at(6.0).unwrap();
    let flyby = Force::gravity_gradient_on(hyperbola.in_plane([0.3, 0.8, 1.1]).unwrap());
    let drag = |quadratic| Force::drag(0.05, quadratic).unwrap();
    vec![
        ("gravity", vec![gravity()]),
        ("circle", vec![circle()]),
        ("ellipse", vec![Force::gravity_gradient(0.8, 0.3).unwrap()]),
        ("flyby", vec![flyby, gravity()]),
        ("drag", vec![drag(0.0)]),
        ("drag that grows", vec![drag(0.02), gravity()]),
        ("all", vec![drag(0.02), gravity(), circle()]),
    ]
}

fn acted_on(forces: &[Force], number: usize, framed: bool) -> (Ensemble, Vec<Inertia>) {
    let forces = forces.to_vec();
    let mut ensemble = Ensemble::new().acted_on(move |inertia| {
        Ok::<_, StateError>(forces.iter().cloned().fold(Body::free(inertia), Body::with))
    });
    let mut inertias = Vec::new();
    for k in 0..number {
        // tensors along the body axes and across them in turn
        let tensor = inertia(k).tensor() + Matrix3::new(0.0, 0.1, 0.0, 0.1, 0.0, -0.05, 0.0, -0.05, 0.0);
        let inertia = if framed && k % 2 == 0 { Inertia::from_tensor(tensor).unwrap() } else { inertia(k) };
        ensemble.push_omega(&inertia, attitude(k), omega(k));
        inertias.push(inertia);
    }
    (ensemble, inertias)
}

#[test]
fn a_member_under_forces_has_the_bits_of_its_own_run() {
    const COUNT: usize = 66;
    let steps = [0, 7, 8, 100];
    for name in UNDER_FORCES {
        // steps of many turns have no solution where there is an equation
        let solves = name.starts_with("rattle") || name.starts_with("dmv");
        let clock = Clock { start: 5.0, step: if solves { 0.001 } else { 0.005 } };
        for (what, forces) in forces() {
            let body =
                |inertia: &Inertia| forces.iter().cloned().fold(Body::free(inertia.clone()), Body::with);
            if method(name).unwrap().prepare_f64(clock, &body(&inertia(0))).is_err() {
                // gradients of squared torques are those of gravity
                let refused = what.contains("drag") || what == "all" || name.ends_with("chin-4a");
                assert!(refused, "{name}, {what}");
                continue;
            }
            let (ensemble, inertias) = acted_on(&forces, COUNT, true);
            let all = SETS.map(|set| {
                let (ensemble, _) = acted_on(&forces, COUNT, true);
                bits(&advanced(&ensemble.by(set), name, clock, &steps))
            });
            assert!(all[0] == all[1] && all[0] == all[2], "{name}, {what}");
            let found = advanced(&ensemble, name, clock, &steps);
            for (k, inertia) in inertias.iter().enumerate() {
                let run = alone(&body(inertia), k, name, clock);
                assert_bits_of(run, &steps, |time| found[time][k], &format!("{name}, {what}, member {k}"));
            }
        }
    }
}

/// Bodies of all blocks, more of them than go side by side, are at one place of their orbit at a time, over more steps than places are held for.
#[test]
fn blocks_on_one_orbit_have_the_bits_of_each_member_alone() {
    let (clock, steps) = (Clock { start: 5.0, step: 0.001 }, [1, 258, 600]);
    let forces = [Force::gravity_gradient(0.8, 0.3).unwrap()];
    let (ensemble, inertias) = acted_on(&forces, 600, false);
    for name in ["rk4", "two-turn", "lie-poisson@suzuki-4"] {
        let found = advanced(&ensemble, name, clock, &steps);
        for k in [0, 64, 200, 511, 512, 599] {
            let body = forces.iter().cloned().fold(Body::free(inertias[k].clone()), Body::with);
            let run = alone(&body, k, name, clock);
            assert_bits_of(run, &steps, |time| found[time][k], &format!("{name}, member {k}"));
        }
    }
}

/// Of steps of up to seven radians some have no solution.
#[test]
fn a_member_whose_step_has_no_solution_fails_as_alone() {
    const COUNT: usize = 40;
    let (clock, steps) = (Clock::new(0.03), [1, 60, 100]);
    let forces = [Force::gravity(Vector3::new(0.3, -0.2, 2.0)).unwrap()];
    for name in ["rattle", "dmv:4"] {
        let (ensemble, inertias) = acted_on(&forces, COUNT, true);
        let mut found = Vec::new();
        let done = ensemble.advance(&method(name).unwrap(), clock, &steps, |rows| {
            found.extend(rows.failures().map(|(member, time, error)| (member, time, error.to_string())));
            Ok::<(), EnsembleError>(())
        });
        done.unwrap();
        let mut by_themselves = Vec::new();
        for (k, inertia) in inertias.iter().enumerate() {
            let body = forces.iter().cloned().fold(Body::free(inertia.clone()), Body::with);
            let mut run = alone(&body, k, name, clock);
            let mut outcomes = steps.iter().map(|&steps| run.advance_to(steps));
            if let Some((time, Err(error))) =
                outcomes.by_ref().enumerate().find(|(_, outcome)| outcome.is_err())
            {
                by_themselves.push((k, time, error.to_string()));
            }
        }
        let count = by_themselves.len();
        assert!((1..COUNT).contains(&count), "{name}: {count}");
        assert_eq!(found, by_themselves, "{name}");
    }
}

/// As the documentation of [`Ensemble::advance`] says.
#[test]
fn splittings_by_turns_and_rk4_move_bodies_in_lanes() {
    let in_lanes = |name: &str, body: &Body| {
        let mut step = method(name).unwrap().prepare_f64(Clock::new(0.01), body).unwrap();
        step.open(&mut body.enter_omega(attitude(0).into(), omega(0).into()).unwrap().to_f64());
        step.side_by_side().is_some()
    };
    let (free, heavy) =
        (Body::free(inertia(0)), Body::heavy(inertia(0), Vector3::new(0.0, 0.0, 1.0)).unwrap());
    for name in ["two-turn", "two-turn:31", "two-turn@suzuki-4", "lie-poisson", "lie-poisson@suzuki-4", "rk4"]
    {
        assert!(in_lanes(name, &free), "{name}");
    }
    for name in UNDER_FORCES {
        assert!(in_lanes(name, &heavy), "{name}");
    }
    for name in ["implicit-midpoint", "kick-drift", "dop853"] {
        assert!(!in_lanes(name, &free), "{name}");
    }
}

#[test]
fn every_set_of_instructions_gives_the_same_bits() {
    let clock = Clock::new(0.02);
    for name in ["two-turn", "lie-poisson", "rk4"] {
        let numbers = || (0..300).filter(|k| name != "rk4" || k % 6 != 4);
        let all = SETS.map(|set| bits(&advanced(&members(numbers()).by(set), name, clock, &[30, 100])));
        assert!(all[0] == all[1] && all[0] == all[2], "{name}");
    }
    let times: Vec<f64> = (-90..90).map(|n| 1.37 * f64::from(n)).collect();
    let all = SETS.map(|set| bits(&moved(&members(0..100).by(set), &times)));
    assert!(all[0] == all[1] && all[0] == all[2]);
}

#[test]
fn exact_motion_has_the_bits_of_each_member_alone() {
    let times: Vec<f64> = (0..131).map(|n| 0.1 * f64::from(n * n) - 3.0).chain([0.0, 1e15, 1e25]).collect();
    let found = moved(&members(0..60), &times);
    let motion = |k| FreeMotion::from_omega(&inertia(k), attitude(k), omega(k)).unwrap();
    let motions: Vec<FreeMotion> = (0..60).map(motion).collect();
    for (time, &t) in times.iter().enumerate() {
        for (k, state) in found[time].iter().enumerate() {
            let alone = motions[k].at(t).unwrap();
            assert_eq!(bits(&[vec![alone]]), bits(&[vec![*state]]), "member {k} at {t} s");
        }
    }
    // whichever are prepared together
    for size in [1, 7, 16, 17] {
        let mut together = vec![Vec::new(); times.len()];
        for first in (0..60).step_by(size) {
            let some = moved(&members(first..60.min(first + size)), &times);
            together.iter_mut().zip(some).for_each(|(all, some)| all.extend(some));
        }
        assert_eq!(bits(&found), bits(&together), "{size} together");
    }
}

#[test]
fn parts_of_an_ensemble_have_the_bits_of_the_whole() {
    let clock = Clock::new(0.005);
    for (what, forces) in [("nothing", Vec::new())].into_iter().chain(forces()) {
        let name = if what.contains("drag") || what == "all" { "rk4" } else { "two-turn" };
        let some = |numbers: &mut dyn Iterator<Item = usize>| {
            let forces = forces.clone();
            let acted_on = members(numbers).acted_on(move |inertia| {
                Ok::<_, StateError>(forces.iter().cloned().fold(Body::free(inertia), Body::with))
            });
            advanced(&acted_on, name, clock, &[50])
        };
        let whole = some(&mut (0..100));
        for shards in [2, 16] {
            let mut together = vec![Vec::new()];
            for shard in 0..shards {
                together[0].extend(some(&mut (0..100).filter(|k| k * shards / 100 == shard)).remove(0));
            }
            assert_eq!(bits(&whole), bits(&together), "{what}, {shards} shards");
        }
    }
}

#[cfg(feature = "parallel")]
#[test]
fn any_number_of_threads_gives_the_same_rows() {
    // six parts and three
    let times: Vec<f64> = (0..128).map(|n| 12.0 * f64::from(n)).collect();
    let steps: Vec<u64> = (0..1024).map(|n| n / 4).collect();
    let rows = |threads| {
        let ensemble = members(0..700).threads(threads);
        let observed = members(0..700)
            .threads(threads)
            .observing(Observed::default().with_invariants(true).with_attitude(true));
        let mut tally = Tally::new();
        let done = observed.advance(&method("two-turn").unwrap(), Clock::new(0.01), &[20], |rows| {
            tally.add(rows);
            Ok::<(), EnsembleError>(())
        });
        done.unwrap();
        let spread = tally.errors(0, Conserved::Energy).unwrap();
        let energy = [spread.largest(), spread.root_mean_square(), spread.quantile(0.3)].map(f64::to_bits);
        let stepped = advanced(&ensemble, "two-turn", Clock::new(0.01), &steps);
        (bits(&moved(&ensemble, &times)), bits(&stepped), energy)
    };
    let one = rows(1);
    for threads in [2, 5] {
        assert!(rows(threads) == one, "{threads} threads");
    }
}

/// The thread that asks reads what others have done; on one thread it does all.
#[cfg(feature = "parallel")]
#[test]
fn threads_that_are_asked_for_do_the_work() {
    let here = std::thread::current().id();
    for threads in [1, 2] {
        let seen = Arc::new(Mutex::new(HashSet::new()));
        let noted = Arc::clone(&seen);
        let mut ensemble = Ensemble::new().threads(threads).acted_on(move |inertia| {
            noted.lock().unwrap().insert(std::thread::current().id());
            Ok::<_, StateError>(Body::free(inertia))
        });
        (0..130).for_each(|k| ensemble.push_omega(&inertia(k), attitude(k), omega(k)));
        // several parts
        moved(&ensemble, &[1.0; 512]);
        let seen = seen.lock().unwrap();
        assert_eq!(seen.contains(&here), threads == 1);
        assert!((1..=threads).contains(&seen.len()));
    }
}

#[test]
fn forces_act_on_every_member() {
    let symmetric = |k: usize| Inertia::from_moments([1.0, 1.0, 0.3 + 0.01 * k as f64]).unwrap();
    let fill = |ensemble: &mut Ensemble| {
        for k in 0..20 {
            ensemble.push_omega(&symmetric(k), attitude(k), Vector3::new(0.0, 0.1, 9.0));
        }
    };
    let weight = Vector3::new(0.0, 0.0, 1.0);
    let mut tops = Ensemble::new().acted_on(move |inertia| Body::heavy(inertia, weight));
    fill(&mut tops);
    let found = moved(&tops, &[2.5]);
    for (k, state) in found[0].iter().enumerate() {
        let body = Body::heavy(symmetric(k), weight).unwrap();
        let start = body.enter_omega(attitude(k).into(), Vector3::new(0.0, 0.1, 9.0).into()).unwrap();
        assert_eq!(*state, LagrangeTop::from_point(&body, start).unwrap().at(2.5).unwrap());
    }
    let drag = Force::drag(0.5, 0.0).unwrap();
    let mut slowed =
        Ensemble::new().acted_on(move |inertia| Ok::<_, StateError>(Body::free(inertia).with(drag.clone())));
    fill(&mut slowed);
    let slower = advanced(&slowed, "rk4", Clock::new(0.01), &[0, 100]);
    for (before, after) in slower[0].iter().zip(&slower[1]) {
        assert!(after.momentum().norm() < 0.99 * before.momentum().norm());
    }
    // a drag leaves no closed form, and that is the failure of each
    let mut failures = 0;
    let done = slowed.at(&[1.0], |rows| {
        failures +=
            rows.failures().filter(|(_, _, error)| matches!(error, MemberError::NoClosedForm(_))).count();
        Ok::<(), EnsembleError>(())
    });
    done.unwrap();
    assert_eq!(failures, 20);
}

#[test]
fn the_failure_of_one_is_a_row_of_its_own() {
    let mut ensemble = members(0..10);
    ensemble.push_failed(Inertia::from_moments([1.0, 2.0, 4.0]).unwrap_err());
    ensemble.push_omega(&inertia(0), attitude(0), Vector3::new(f64::NAN, 0.0, 0.0));
    // twenty turns a step: rk4 diverges
    ensemble.push_omega(&inertia(0), attitude(0), Vector3::new(40.0, 3000.0, 50.0));
    ensemble.push_omega(&inertia(1), attitude(1), Vector3::new(1.0, 2.0, 3.0));
    let ensemble = ensemble.observing(Observed::default().with_invariants(true).with_attitude(true));
    let body = Body::free(inertia(0));
    let start = body.enter_omega(attitude(0).into(), Vector3::new(40.0, 3000.0, 50.0).into()).unwrap();
    let run = Run::from_point(&method("rk4").unwrap(), &body, start.to_f64(), Clock::new(0.01)).unwrap();
    let alone = run.watching(Watch::Never).advance_to(100).unwrap_err();
    assert!(matches!(alone, RunError::OutOfRange { .. } | RunError::Diverged { .. }));
    let numbers = (0..10).filter(|k| k % 6 != 4 && k % 6 != 2);
    let mut tally = Tally::new();
    let done = ensemble.advance(&method("rk4").unwrap(), Clock::new(0.01), &[0, 100, 1000], |rows| {
        tally.add(rows);
        let found: Vec<_> = rows.failures().filter(|failure| failure.0 >= 10).collect();
        assert!(matches!(found[0], (10, 0, MemberError::Inertia(_))));
        assert!(matches!(found[1], (11, 0, MemberError::State(_))));
        assert_eq!((found[2].0, found[2].1, found[2].2.to_string()), (12, 1, alone.to_string()));
        assert_eq!(found.len(), 3);
        assert_eq!(
            found[1].2.to_string(),
            "angular velocity has the component NaN; every component must be a finite number"
        );
        assert!(rows.has(12, 0) && !rows.has(12, 1) && !rows.has(12, 2) && rows.has(13, 2));
        for (time, step) in [0, 100, 1000].into_iter().enumerate() {
            assert!(rows.states(time).iter().all(State::is_finite), "after {step} steps");
        }
        // of times that there are not
        for time in [3, usize::MAX / 2, usize::MAX] {
            assert!(rows.states(time).is_empty() && rows.omegas(time).is_empty());
            assert!(rows.errors(time).is_none() && rows.attitude_errors(time).is_none());
        }
        Ok::<(), EnsembleError>(())
    });
    done.unwrap();
    assert!(tally.errors(2, Conserved::Energy).unwrap().members() > numbers.count());
    assert_eq!(tally.errors(0, Conserved::Energy).unwrap().largest(), 0.0);
}

#[test]
fn a_failure_has_the_number_of_its_member_in_every_part() {
    let mut ensemble = members(0..70);
    ensemble.push_failed(Inertia::from_moments([1.0, 2.0, 4.0]).unwrap_err());
    ensemble.push_omega(&inertia(0), attitude(0), omega(0));
    let (mut failed, mut parts) = (Vec::new(), 0);
    let done = ensemble.at(&[1.0; 512], |rows| {
        parts += 1;
        failed.extend(rows.failures().map(|(member, time, _)| (member, time)));
        let mut numbers = rows.first()..rows.first() + rows.members();
        assert!(numbers.all(|member| rows.has(member, 0) == (member != 70)));
        Ok::<(), EnsembleError>(())
    });
    done.unwrap();
    assert!(parts > 1);
    assert_eq!(failed, [(70, 0)]);
}

#[test]
fn what_is_wrong_for_all_is_refused_at_once() {
    let ensemble = members(0..3);
    let none = |_: &Rows| Ok::<(), EnsembleError>(());
    let rk4 = method("rk4").unwrap();
    let refused = |error: EnsembleError| error.to_string();
    let advance =
        |clock, steps: &[u64]| ensemble.advance(&rk4, clock, steps, none).map_err(refused).unwrap_err();
    assert_eq!(
        advance(Clock::new(0.1), &[5, 4]),
        "4 steps follow 5; give numbers of steps in ascending order"
    );
    assert_eq!(
        advance(Clock::new(0.0), &[5]),
        "step 0 is not usable; it must be a finite number of seconds other than 0"
    );
    assert_eq!(
        ensemble.at(&[1.0, f64::NAN], none).map_err(refused).unwrap_err(),
        "time NaN s is not a finite number"
    );
}

#[test]
fn an_error_of_the_reader_ends_the_work() {
    let mut parts = 0;
    let done = members(0..300).at(&[1.0; 512], |_| {
        parts += 1;
        Err(EnsembleError::Time { t: 0.0 })
    });
    assert!(done.is_err());
    assert_eq!(parts, 1);
}

#[test]
fn tensors_in_any_axes_keep_their_frames() {
    let tilted = Matrix3::new(2.0, -0.1, 0.0, -0.1, 3.0, 0.2, 0.0, 0.2, 4.0);
    let tensors = [inertia(0), Inertia::from_tensor(tilted).unwrap(), inertia(2)];
    let mut ensemble = Ensemble::new();
    for k in 0..9 {
        ensemble
            .push(&tensors[k / 3], &Body::free(tensors[k / 3].clone()).state(attitude(k), omega(0)).unwrap());
    }
    let found = advanced(&ensemble, "two-turn", Clock::new(0.01), &[40]);
    for k in 0..9 {
        let body = Body::free(tensors[k / 3].clone());
        let start = body.state(attitude(k), omega(0)).unwrap();
        let alone =
            Run::new(&method("two-turn").unwrap(), &body, &start, 0.01).unwrap().advance_to(40).unwrap();
        assert_eq!(found[0][k], alone.state, "member {k}");
        let exact = FreeMotion::from_state(body.inertia(), &start).unwrap().at(0.4).unwrap();
        assert!((exact.momentum_space() - alone.state.momentum_space()).norm() < 1e-14);
        assert_eq!(ensemble.body(k).as_ref().map(Body::inertia), Some(&tensors[k / 3]));
    }
}

#[test]
fn spreads_are_those_of_the_definition() {
    assert!(Spread::of([]).is_none() && Spread::of([1.0, f64::INFINITY]).is_none());
    let spread = Spread::of([4.0, 0.0, 1.0, 3.0, 2.0]).unwrap();
    assert_eq!([0.0, 0.25, 0.6, 1.0].map(|share| spread.quantile(share)), [0.0, 1.0, 2.4, 4.0]);
    assert_eq!((spread.members(), spread.root_mean_square()), (5, 6.0_f64.sqrt()));
}

#[test]
fn many_times_of_one_motion_have_the_bits_of_each() {
    let inertia = Inertia::from_moments([1.0, 2.0, 3.0]).unwrap();
    // tumbling about either axis, near the separatrix on both sides, next to it, on it, a pure spin, and at rest
    let near = [[0.02, 1.0, -0.01], [-0.01, -1.0, 0.02], [1e-9, 1.0, 3e-9], [3e-90, -1.0, 1e-90]];
    let far = [[0.4, 1.0, -0.3], [-1.0, 0.4, 0.3], [0.2, 0.1, -1.0], [0.0, 1.0, 0.0], [0.0; 3]];
    let times: Vec<f64> = (-150..150).map(|n| 0.7 * f64::from(n)).chain([1e8, -3e12, 1e15, 1e24]).collect();
    for omega in near.into_iter().chain(far) {
        let motion = FreeMotion::from_omega(&inertia, attitude(3), omega.into()).unwrap();
        let alone: Vec<State> = times.iter().map(|&t| motion.at(t).unwrap()).collect();
        let many = motion.at_many(&times).unwrap();
        for ((many, alone), t) in many.into_iter().zip(alone).zip(&times) {
            assert_eq!(bits(&[vec![many]]), bits(&[vec![alone]]), "{omega:?} at {t} s");
        }
    }
    let motion = FreeMotion::from_omega(&inertia, attitude(3), near[0].into()).unwrap();
    assert_eq!(motion.at_many(&[0.0, 1e40, f64::NAN]), Err(motion.at(1e40).unwrap_err()));
}

/// Each member has the first event of its own motion or run; one without a motion keeps its place.
#[test]
fn first_passages_are_those_of_each_member_alone() {
    let inertia = Inertia::from_moments([1.0, 2.0, 3.0]).unwrap();
    let body = Body::free(inertia.clone());
    let omegas: Vec<Vector3<f64>> = (0..200).map(|k| Vector3::new(0.002 * f64::from(k), 1.0, 1e-3)).collect();
    let mut ensemble = Ensemble::new();
    for (k, omega) in omegas.iter().enumerate() {
        if k == 77 {
            ensemble.push_failed(StateError::NoAttitude);
        } else {
            ensemble.push_omega(&inertia, UnitQuaternion::identity(), *omega);
        }
    }
    let exact = ensemble.first(|body| Ok(Event::flip(body)), 6.0, 0.5);
    let (rk4, clock) = (method("rk4").unwrap(), Clock::new(0.05));
    let stepped = ensemble.first_by(&rk4, clock, |body| Ok(Event::flip(body)), 6.0, 0.05);
    assert_eq!((exact.len(), stepped.len()), (200, 200));
    let mut happened = 0;
    for (k, omega) in omegas.iter().enumerate() {
        if k == 77 {
            assert!(exact[k].is_err() && stepped[k].is_err());
            continue;
        }
        let motion = FreeMotion::from_omega(&inertia, UnitQuaternion::identity(), *omega).unwrap();
        let alone = motion.events(&[Event::flip(&body)], 0.0, 6.0, 0.5).unwrap().found;
        let first = exact[k].as_ref().unwrap();
        assert_eq!(first.as_ref(), alone.first(), "{k}");
        let start = body.state(UnitQuaternion::identity(), *omega).unwrap();
        let run = Run::new(&rk4, &body, &start, 0.05).unwrap().until(&Event::flip(&body), 6.0).unwrap();
        assert_eq!(stepped[k].as_ref().unwrap(), &run, "{k}");
        if let (Some(first), Some(run)) = (first, run) {
            assert!((first.time - run.time).hi().abs() < 1e-4, "{k}");
            happened += 1;
        }
    }
    assert!((50..190).contains(&happened), "{happened}");
    #[cfg(feature = "parallel")]
    {
        let times = |all: Vec<Result<Option<polhode::events::Occurrence>, _>>| -> Vec<_> {
            all.into_iter().map(|one| one.ok().flatten()).collect()
        };
        ensemble = ensemble.threads(2);
        assert_eq!(times(ensemble.first(|body| Ok(Event::flip(body)), 6.0, 0.5)), times(exact));
    }
    // what is wrong with the search is wrong for each
    let refused = ensemble.first(|body| Ok(Event::flip(body)), -1.0, 0.5);
    assert!(refused.iter().all(|one| matches!(one, Err(MemberError::Event(_) | MemberError::State(_)))));
}

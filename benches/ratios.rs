//! Time per step of the main methods over that of an RK4 written by hand, bursts in turn in one run, and beside it how many operations of
//! a step wait for each other. The RK4 is compiled the same way whatever the library is, so each of these has a column of the table:
//!
//! ```text
//! cargo bench -p polhode-benches --bench ratios
//! CARGO_PROFILE_BENCH_OPT_LEVEL=2 cargo bench -p polhode-benches --bench ratios
//! RUSTFLAGS="-C target-cpu=native" cargo bench -p polhode-benches --bench ratios
//! ```
//!
//! Ends with 1 if a ratio is beyond 1.15 times what it was when it was last looked at. To be run before a release, on a machine that does
//! nothing else; processors differ in what operations take, and the table is that of one.

#![allow(clippy::expect_used)]

use std::hint::black_box;
use std::process::ExitCode;
use std::time::Instant;

use nalgebra::{UnitQuaternion, Vector3};
use polhode::body::{Body, Clock, Force, Point, State};
use polhode::flow::LagrangeTop;
use polhode::inertia::Inertia;
use polhode::method::{Step, method};
use polhode::run::{Run, Watch};

const STEP: f64 = 0.01;
const STEPS: u64 = 1000;
const BURSTS: usize = 200;

/// Beyond this many times what it was, a method is slow.
const SLOW: f64 = 1.15;

/// Operations of a step that wait for each other, counted by hand: the longest chain from one state to the next.
type Chain = Option<u32>;

/// A ratio that has not been measured yet, and is not judged.
const NEW: f64 = f64::NAN;

/// Ratios at opt-level 3 and at 2, and at 3 for this processor (target-cpu=native), measured on a server of 2023 (Sapphire Rapids).
const ROWS: [(Case, &str, Chain, [f64; 3]); 20] = [
    (Case::Free, "rk4", Some(20), [0.84, 0.85, NEW]),
    (Case::Free, "lie-poisson", Some(48), [1.70, 1.76, NEW]),
    (Case::Free, "two-turn", Some(24), [0.92, 0.91, NEW]),
    (Case::Free, "exact-step", None, [0.69, 0.65, NEW]),
    (Case::Free, "implicit-midpoint", Some(27), [1.59, 1.34, NEW]),
    (Case::Free, "rattle", Some(41), [2.08, 1.84, NEW]),
    (Case::Free, "dmv:10", Some(41), [2.07, 1.84, NEW]),
    (Case::Free, "kick-drift", None, [0.68, 0.65, NEW]),
    (Case::Free, "two-turn@blanes-moan-s10", Some(240), [9.09, 9.02, NEW]),
    (Case::Free, "taylor:20", None, [18.05, 24.89, NEW]),
    (Case::Heavy, "rk4", None, [1.50, 1.23, NEW]),
    (Case::Heavy, "kick-drift", None, [2.55, 2.23, NEW]),
    (Case::Heavy, "kick-drift@suzuki-4", None, [12.68, 11.09, NEW]),
    (Case::Heavy, "taylor:20", None, [27.12, 38.06, NEW]),
    (Case::Gradient, "rk4", None, [9.14, 6.67, NEW]),
    (Case::Gradient, "kick-drift", None, [8.63, 6.72, NEW]),
    (Case::WatchedFree, "two-turn", None, [1.84, 2.21, NEW]),
    (Case::WatchedFree, "rk4", None, [1.72, 1.42, NEW]),
    (Case::WatchedHeavy, "kick-drift", None, [3.07, 2.87, NEW]),
    (Case::At, "LagrangeTop::at", None, [2.53, 2.41, NEW]),
];

/// Operations of the RK4 by hand that wait for each other.
const CHAIN_BY_HAND: u32 = 25;

/// The column of the table, and what it is of; `None` where the library is compiled in a way that the table does not have.
fn compiled() -> Option<(usize, &'static str)> {
    match (env!("POLHODE_OPT_LEVEL"), cfg!(target_feature = "avx2")) {
        ("3", false) => Some((0, "opt-level 3")),
        ("2", false) => Some((1, "opt-level 2")),
        ("3", true) => Some((2, "opt-level 3, for this processor")),
        _ => None,
    }
}

#[derive(Clone, Copy, Debug, PartialEq)]
enum Case {
    /// The body 1:2:3 without torque.
    Free,
    /// A symmetric top.
    Heavy,
    /// A satellite under the gravity gradient, on a circle.
    Gradient,
    /// The first two, each step watched by a run.
    WatchedFree,
    WatchedHeavy,
    /// The closed form of the top at one time after another.
    At,
}

/// Something that takes a thousand steps at a call.
type Job = Box<dyn FnMut()>;

fn by_hand() -> Job {
    let mut state = [1.0, 0.0, 0.0, 0.0, 0.4, 1.0, -0.3];
    Box::new(move || polhode_yardstick::rk4(black_box(&mut state), black_box(STEP), STEPS))
}

/// As many additions and multiplications, one after the other, as steps.
fn chain() -> Job {
    let mut x = 1.0;
    Box::new(move || x = polhode_yardstick::chain(black_box(x), STEPS))
}

fn free() -> (Body, State) {
    let body = Body::free(Inertia::from_moments([1.0, 2.0, 3.0]).expect("valid moments"));
    let start = body.state(UnitQuaternion::identity(), Vector3::new(0.4, 1.0, -0.3));
    (body.clone(), start.expect("a valid start"))
}

fn heavy() -> (Body, State) {
    let inertia = Inertia::from_moments([1.0, 1.0, 0.5]).expect("valid moments");
    let body = Body::heavy(inertia, Vector3::new(0.0, 0.0, 1.0)).expect("a valid weight moment");
    let tilted = UnitQuaternion::from_axis_angle(&Vector3::x_axis(), 0.5);
    let start = body.state(tilted, Vector3::new(0.0, 0.0, 5.0)).expect("a valid start");
    (body, start)
}

fn gradient() -> (Body, State) {
    let inertia = Inertia::from_moments([1.0, 2.0, 2.6]).expect("valid moments");
    let body = Body::free(inertia).with(Force::gravity_gradient(1.1e-3, 0.0).expect("a circle"));
    let start = body.state(UnitQuaternion::identity(), Vector3::new(0.1, 0.03, -0.02));
    (body.clone(), start.expect("a valid start"))
}

fn job(case: Case, name: &str) -> Job {
    let (body, start) = match case {
        Case::Free | Case::WatchedFree => free(),
        Case::Gradient => gradient(),
        Case::Heavy | Case::WatchedHeavy | Case::At => heavy(),
    };
    match case {
        Case::Free | Case::Heavy | Case::Gradient => {
            let method = method(name).expect("a method");
            let mut step: Box<dyn Step<f64>> =
                method.prepare_f64(Clock::new(STEP), &body).expect("a valid step");
            let mut x: Point<f64> = body.enter(&start).expect("a valid start").to_f64();
            step.open(&mut x);
            Box::new(move || step.advance(black_box(&mut x), STEPS))
        }
        Case::WatchedFree | Case::WatchedHeavy => {
            let run = Run::new(&method(name).expect("a method"), &body, &start, STEP);
            let (mut run, mut taken) = (run.expect("a valid run").watching(Watch::EveryStep), 0);
            Box::new(move || {
                taken += STEPS;
                black_box(run.advance_to(taken).expect("a finite run"));
            })
        }
        Case::At => {
            let top = LagrangeTop::from_state(&body, &start).expect("a symmetric top");
            let mut t = 0.0;
            Box::new(move || {
                for _ in 0..STEPS {
                    t += 0.37;
                    let _ = black_box(top.at(black_box(t)).expect("a finite time"));
                }
            })
        }
    }
}

fn main() -> ExitCode {
    let mut jobs: Vec<Job> = vec![by_hand(), chain()];
    jobs.extend(ROWS.iter().map(|(case, name, ..)| job(*case, name)));
    let mut least = vec![f64::INFINITY; jobs.len()];
    for _ in 0..BURSTS {
        for (job, least) in jobs.iter_mut().zip(&mut least) {
            let begun = Instant::now();
            job();
            *least = least.min(begun.elapsed().as_secs_f64() * 1e9 / STEPS as f64);
        }
    }
    let (by_hand, operation) = (least[0], 0.5 * least[1]);
    let column = compiled();
    println!("compiled with {}", column.map_or("what the table has no column for", |(_, text)| text));
    println!("{:14}{:28}{:>11}{:>8}{:>8}{:>17}", "", "", "ns/step", "ratio", "was", "chain, ns");
    let waits = |chain: u32| format!("{chain:>8}{:>9.1}", f64::from(chain) * operation);
    println!("{:14}{:28}{by_hand:>11.1}{:>8.2}{:>8}{}", "", "RK4 by hand", 1.0, "", waits(CHAIN_BY_HAND));
    let mut lost = false;
    for ((case, name, chain, known), ns) in ROWS.iter().zip(&least[2..]) {
        let ratio = ns / by_hand;
        let known = column.map(|(column, _)| known[column]).filter(|known| !known.is_nan());
        let slow = known.is_some_and(|known| ratio > SLOW * known);
        lost |= slow;
        let verdict = if slow { "  slower than it was" } else { "" };
        let (known, chain) = (known.map_or("-".into(), |known| format!("{known:.2}")), chain.map(waits));
        println!(
            "{:14}{name:28}{ns:>11.1}{ratio:>8.2}{known:>8}{:>17}{verdict}",
            format!("{case:?}"),
            chain.unwrap_or_default()
        );
    }
    if lost { ExitCode::FAILURE } else { ExitCode::SUCCESS }
}

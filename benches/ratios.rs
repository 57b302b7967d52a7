//! Time per step of the main methods over that of an RK4 written by hand, bursts in turn in one run: `cargo bench -p
//! polhode-benches --bench ratios`. Ends with 1 if one is more than twice what it was when it was last looked at, as
//! where inlining is lost.

#![allow(clippy::expect_used)]

use std::hint::black_box;
use std::process::ExitCode;
use std::time::Instant;

use nalgebra::{UnitQuaternion, Vector3};
use polhode::body::{Body, Clock, Point, State};
use polhode::flow::LagrangeTop;
use polhode::inertia::Inertia;
use polhode::method::{Step, method};
use polhode::run::{Run, Watch};

const STEP: f64 = 0.01;
const STEPS: u64 = 1000;
const BURSTS: usize = 200;

/// What was measured on a server of 2024 (Zen 5, portable build), over the RK4 by hand.
const ROWS: [(Case, &str, f64); 17] = [
    (Case::Free, "rk4", 0.97),
    (Case::Free, "lie-poisson", 1.74),
    (Case::Free, "two-turn", 0.95),
    (Case::Free, "exact-step", 0.61),
    (Case::Free, "implicit-midpoint", 1.78),
    (Case::Free, "rattle", 2.18),
    (Case::Free, "dmv:10", 2.19),
    (Case::Free, "kick-drift", 0.64),
    (Case::Free, "two-turn@blanes-moan-s10", 8.24),
    (Case::Free, "taylor:20", 16.4),
    (Case::Heavy, "rk4", 1.33),
    (Case::Heavy, "kick-drift", 2.29),
    (Case::Heavy, "kick-drift@suzuki-4", 11.5),
    (Case::Heavy, "taylor:20", 24.5),
    (Case::WatchedFree, "two-turn", 1.88),
    (Case::WatchedHeavy, "kick-drift", 3.0),
    (Case::At, "LagrangeTop::at", 2.26),
];

#[derive(Clone, Copy, Debug, PartialEq)]
enum Case {
    /// The body 1:2:3 without torque.
    Free,
    /// A symmetric top.
    Heavy,
    /// The same, each step watched by a run.
    WatchedFree,
    WatchedHeavy,
    /// The closed form of the top at one time after another.
    At,
}

/// Something that takes a thousand steps at a call.
type Job = Box<dyn FnMut()>;

/// The textbook's RK4 on quaternion and angular velocity.
fn by_hand() -> Job {
    let mut state = [1.0, 0.0, 0.0, 0.0, 0.4, 1.0, -0.3];
    Box::new(move || {
        let (h, moments) = (black_box(STEP), black_box([1.0, 2.0, 3.0]));
        let inverse = moments.map(|i| 1.0 / i);
        let rate = |y: &[f64; 7]| {
            let [w, x, y, z, a, b, c] = *y;
            [
                -0.5 * (x * a + y * b + z * c),
                0.5 * (w * a + y * c - z * b),
                0.5 * (w * b + z * a - x * c),
                0.5 * (w * c + x * b - y * a),
                (moments[1] - moments[2]) * b * c * inverse[0],
                (moments[2] - moments[0]) * c * a * inverse[1],
                (moments[0] - moments[1]) * a * b * inverse[2],
            ]
        };
        let moved = |y: &[f64; 7], k: &[f64; 7], t: f64| core::array::from_fn(|n| y[n] + t * k[n]);
        for _ in 0..STEPS {
            let k1 = rate(&state);
            let k2 = rate(&moved(&state, &k1, 0.5 * h));
            let k3 = rate(&moved(&state, &k2, 0.5 * h));
            let k4 = rate(&moved(&state, &k3, h));
            for n in 0..7 {
                state[n] += h / 6.0 * (k1[n] + 2.0 * k2[n] + 2.0 * k3[n] + k4[n]);
            }
        }
        black_box(&state);
    })
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

fn job(case: Case, name: &str) -> Job {
    let (body, start) = if matches!(case, Case::Free | Case::WatchedFree) { free() } else { heavy() };
    match case {
        Case::Free | Case::Heavy => {
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
    let mut jobs: Vec<Job> = vec![by_hand()];
    jobs.extend(ROWS.iter().map(|(case, name, _)| job(*case, name)));
    let mut least = vec![f64::INFINITY; jobs.len()];
    for _ in 0..BURSTS {
        for (job, least) in jobs.iter_mut().zip(&mut least) {
            let begun = Instant::now();
            job();
            *least = least.min(begun.elapsed().as_secs_f64() * 1e9 / STEPS as f64);
        }
    }
    println!("{:14}{:28}{:>8.1} ns", "", "RK4 by hand", least[0]);
    let mut lost = false;
    for ((case, name, known), ns) in ROWS.iter().zip(&least[1..]) {
        let ratio = ns / least[0];
        let verdict = if ratio > 2.0 * known { "  more than twice what it was" } else { "" };
        lost |= ratio > 2.0 * known;
        println!("{:14}{name:28}{ns:>8.1} ns{ratio:>8.2}{verdict}", format!("{case:?}"));
    }
    if lost { ExitCode::FAILURE } else { ExitCode::SUCCESS }
}

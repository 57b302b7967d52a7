//! Milliseconds that methods take to follow heavy tops to an attitude error: `cargo bench -p polhode-benches --bench
//! tops`. Each method is run over many steps or tolerances, unwatched; the time between two runs is interpolated.
//! References are Taylor series in double-double.

#![allow(clippy::expect_used)]

use std::time::Instant;

use polhode::body::{Body, Clock, Point, State};
use polhode::inertia::Inertia;
use polhode::method::method;
use polhode::num::Dd;
use polhode::rotation::{Quat, Vec3, rotation_angle};

/// A heavy body, its start, and how far it is followed.
struct Top {
    name: &'static str,
    moments: [f64; 3],
    weight_moment: [f64; 3],
    momentum: [f64; 3],
    attitude: [f64; 4],
    time: f64,
    /// The largest step, s.
    step: f64,
}

/// Hairer, Lubich and Wanner, Geometric Numerical Integration, figure VII.5.3, asymmetric and symmetric; Kovalevskaya's.
const TOPS: [Top; 3] = [
    Top {
        name: "asymmetric",
        moments: [0.5, 0.85, 1.0],
        weight_moment: [0.0, 0.0, 1.0],
        momentum: [0.2, 1.0, 0.4],
        attitude: [0.4, 0.2, 0.4, 0.8],
        time: 512.0,
        step: 2.0,
    },
    Top {
        name: "symmetric",
        moments: [0.5, 0.5, 1.0],
        weight_moment: [0.0, 0.0, 1.0],
        momentum: [0.2, 1.0, 0.4],
        attitude: [0.4, 0.2, 0.4, 0.8],
        time: 1000.0,
        step: 2.0,
    },
    Top {
        name: "Kovalevskaya",
        moments: [2.0, 2.0, 1.0],
        weight_moment: [1.3, 0.0, 0.0],
        momentum: [0.7, -0.4, 0.9],
        attitude: [0.9, 0.2, -0.3, 0.4],
        time: 1000.0,
        step: 4.0,
    },
];

const METHODS: [&str; 9] = [
    "taylor",
    "rk4",
    "kick-drift@srkn-6b",
    "kick-drift@srkn-14a",
    "kick-drift@bce-22",
    "dmv:8@srkn-14a",
    "dmv:10@bce-22",
    "two-turn@sofroniou-spaletta-8",
    "dmv:8@blanes-casas-murua-8-13",
];

const ERRORS: [f64; 4] = [1e-3, 1e-6, 1e-9, 1e-11];

/// Attitude error of a run and its seconds, the least of three.
fn follow(name: &str, h: f64, top: &Top, body: &Body, start: Point<Dd>, exact: Point<Dd>) -> [f64; 2] {
    let steps = (top.time / h).ceil();
    let mut step = method(name)
        .expect("a method")
        .prepare_f64(Clock::new(top.time / steps), body)
        .expect("a valid step");
    let (mut x, mut seconds) = (start.to_f64(), f64::INFINITY);
    for _ in 0..3 {
        x = start.to_f64();
        let begun = Instant::now();
        step.steps(&mut x, steps as u64);
        seconds = seconds.min(begun.elapsed().as_secs_f64());
    }
    [rotation_angle(x.to_dd().attitude, exact.attitude).hi(), seconds]
}

/// The least time to `error` along runs of falling error, s; none if it is not reached.
fn least(runs: &[[f64; 2]], error: f64) -> Option<f64> {
    let between = |pair: &[[f64; 2]]| {
        let [[coarse, quick], [fine, slow]] = [pair[0], pair[1]];
        let share = libm::log(coarse / error) / libm::log(coarse / fine);
        // an error of a radian is no error of this method any more
        let crossed = fine <= error && error < coarse && coarse < 0.5;
        if crossed { Some(quick * libm::pow(slow / quick, share)) } else { (fine <= error).then_some(slow) }
    };
    runs.windows(2).filter_map(between).min_by(f64::total_cmp)
}

fn main() {
    for top in &TOPS {
        let inertia = Inertia::from_moments(top.moments).expect("valid moments");
        let body = Body::heavy(inertia, top.weight_moment.into()).expect("a valid weight moment");
        let state =
            State { attitude: Quat::from_components(top.attitude), momentum_body: Vec3(top.momentum) };
        let start = body.enter(&state).expect("a valid start");
        let mut exact = start;
        let reference = method("taylor").expect("a method").prepare_dd(Clock::new(top.time), &body);
        reference.expect("a valid step").steps(&mut exact, 1);
        println!("{} top, {} s, ms to an attitude error of", top.name, top.time);
        println!("{:32}{}", "", ERRORS.map(|error| format!("{error:>9.0e}")).concat());
        for name in METHODS {
            let runs: Vec<[f64; 2]> = if name == "taylor" {
                let tolerances = (6..16).map(|n| format!("taylor:1e-{n}"));
                tolerances.map(|name| follow(&name, top.time, top, &body, start, exact)).collect()
            } else {
                let halves = (0..20).map(|n| top.step / libm::exp2(0.5 * f64::from(n)));
                halves.map(|h| follow(name, h, top, &body, start, exact)).collect()
            };
            let times = ERRORS.map(|error| {
                least(&runs, error).map_or(format!("{:>9}", "-"), |seconds| format!("{:>9.2}", 1e3 * seconds))
            });
            println!("{name:32}{}", times.concat());
        }
        println!();
    }
}

//! Bodies side by side against an RK4 by hand for one, under forces against the steps of the same method for one body, bursts in
//! turn in one run: `cargo bench -p polhode-benches --bench ensemble --features parallel`. Ends with 1 if a ratio is less than half
//! of what it was on this processor when it was last looked at, and with 2 on a processor that the tables have no column of. What the
//! processor has no instructions for is not measured.

#![allow(clippy::expect_used)]

mod processor;

use std::hint::black_box;
use std::process::ExitCode;
use std::time::Instant;

use nalgebra::{UnitQuaternion, Vector3};
use polhode::body::{Body, Clock, Force, Point};
use polhode::flow::FreeMotion;
use polhode::inertia::Inertia;
use polhode::method::{Step, method};
use polhode::num::Instructions;
use polhode::run::{Ensemble, EnsembleError, MemberError};

const STEP: f64 = 0.01;
const BURSTS: usize = 60;
/// Of a burst. It is short, so that some run without another program between.
const MEMBERS: u64 = 64;
const FEW: u64 = 250;
const MANY: u64 = 1500;
/// Steps of a burst of the RK4 by hand.
const REFERENCE: u64 = 10_000;
/// Members that are prepared.
const SET_UP: u64 = 128;

/// What a processor has no instructions for.
const NONE: f64 = f64::NAN;

/// Instructions, method, and how many times as fast as the RK4 by hand it was on each processor that has a column, on the first beside
/// other programs. That one takes two operations of 512 bits at a time, or three of 256. A step of two turns is 128 additions and
/// multiplications, one of three turns 254, one of rk4 173: with the widest sets nine tenths of its rate and more are used.
const ROWS: [(Instructions, &str, [f64; 2]); 9] = [
    (Instructions::Widest, "two-turn:31", [13.0, NONE]),
    (Instructions::Widest, "lie-poisson:321", [6.5, NONE]),
    (Instructions::Widest, "rk4", [9.4, NONE]),
    (Instructions::Avx2, "two-turn:31", [8.7, 6.7]),
    (Instructions::Avx2, "lie-poisson:321", [4.4, 3.6]),
    (Instructions::Avx2, "rk4", [5.7, 5.2]),
    (Instructions::Baseline, "two-turn:31", [4.8, 3.6]),
    (Instructions::Baseline, "lie-poisson:321", [2.4, 1.9]),
    (Instructions::Baseline, "rk4", [2.9, 2.6]),
];

/// The same under forces, against the scalar step of the method under them.
const UNDER_FORCES: [(Instructions, &str, Forces, [f64; 2]); 33] = {
    use Forces::{Drag, Gradient, Gravity};
    use Instructions::{Avx2, Baseline, Widest};
    [
        (Widest, "rk4", Gravity, [8.4, NONE]),
        (Widest, "rk4", Gradient, [15.0, NONE]),
        (Widest, "rk4", Drag, [18.0, NONE]),
        (Widest, "two-turn:31", Gravity, [9.5, NONE]),
        (Widest, "two-turn:31", Gradient, [15.0, NONE]),
        (Widest, "lie-poisson:321", Gradient, [15.0, NONE]),
        (Widest, "kick-drift", Gradient, [7.0, NONE]),
        (Widest, "kick-drift@srkn-11b", Gradient, [11.0, NONE]),
        (Widest, "rattle", Gradient, [7.7, NONE]),
        (Widest, "dmv:10", Gradient, [7.7, NONE]),
        (Widest, "dmv:12@srkn-11b", Gradient, [9.0, NONE]),
        (Avx2, "rk4", Gravity, [5.8, 5.5]),
        (Avx2, "rk4", Gradient, [12.0, 22.1]),
        (Avx2, "rk4", Drag, [13.8, 15.2]),
        (Avx2, "two-turn:31", Gravity, [6.5, 5.6]),
        (Avx2, "two-turn:31", Gradient, [12.0, 13.3]),
        (Avx2, "lie-poisson:321", Gradient, [12.0, 13.0]),
        (Avx2, "kick-drift", Gradient, [4.5, 6.2]),
        (Avx2, "kick-drift@srkn-11b", Gradient, [6.3, 6.9]),
        (Avx2, "rattle", Gradient, [7.6, 6.9]),
        (Avx2, "dmv:10", Gradient, [6.0, 6.4]),
        (Avx2, "dmv:12@srkn-11b", Gradient, [6.0, 6.1]),
        (Baseline, "rk4", Gravity, [3.1, 2.6]),
        (Baseline, "rk4", Gradient, [7.0, 11.5]),
        (Baseline, "rk4", Drag, [8.1, 7.1]),
        (Baseline, "two-turn:31", Gravity, [3.8, 3.5]),
        (Baseline, "two-turn:31", Gradient, [7.0, 8.5]),
        (Baseline, "lie-poisson:321", Gradient, [7.0, 8.6]),
        (Baseline, "kick-drift", Gradient, [2.9, 3.4]),
        (Baseline, "kick-drift@srkn-11b", Gradient, [4.3, 4.0]),
        (Baseline, "rattle", Gradient, [5.5, 5.3]),
        (Baseline, "dmv:10", Gradient, [5.2, 4.7]),
        (Baseline, "dmv:12@srkn-11b", Gradient, [4.9, 4.4]),
    ]
};

/// How many thousands of bodies are prepared and read while the RK4 by hand takes a million steps.
const SET_UPS: [(&str, [f64; 2]); 4] = [
    ("rk4", [53.0, 24.9]),
    ("two-turn:31", [18.0, 13.5]),
    ("two-turn", [11.0, 8.8]),
    ("lie-poisson", [9.0, 10.3]),
];

/// What acts on all members.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Forces {
    Gravity,
    /// A gravity gradient on an ellipse.
    Gradient,
    Drag,
}

impl Forces {
    fn on(self, inertia: Inertia) -> Body {
        let force = match self {
            Forces::Gravity => Force::gravity(Vector3::new(0.1, 0.0, 0.5)),
            Forces::Gradient => Force::gravity_gradient(0.05, 0.1),
            Forces::Drag => Force::drag(1e-3, 1e-4),
        };
        Body::free(inertia).with(force.expect("a valid force"))
    }
}

/// The set that a row is measured with, and whether the processor has it: the widest of another one would be another set.
fn measured(instructions: Instructions) -> (&'static str, bool) {
    #[cfg(target_arch = "x86_64")]
    let (avx512, avx2) = (
        std::is_x86_feature_detected!("avx512f")
            && std::is_x86_feature_detected!("avx512dq")
            && std::is_x86_feature_detected!("avx512vl"),
        std::is_x86_feature_detected!("avx2"),
    );
    #[cfg(not(target_arch = "x86_64"))]
    let (avx512, avx2) = (false, false);
    match instructions {
        Instructions::Widest => ("avx512", avx512),
        Instructions::Avx2 => ("avx2", avx2),
        _ => ("baseline", true),
    }
}

/// Steps of one body alone.
fn alone(name: &str, body: &Body) -> impl FnMut(u64) + use<> {
    let start = body.state(UnitQuaternion::identity(), Vector3::new(0.4, 1.0, -0.3)).expect("a valid start");
    let mut step: Box<dyn Step<f64>> =
        method(name).expect("a method").prepare_f64(Clock::new(STEP), body).expect("a valid step");
    let mut x: Point<f64> = body.enter(&start).expect("a valid start").to_f64();
    step.open(&mut x);
    move |n| step.advance(black_box(&mut x), n)
}

/// Different bodies and starts.
fn members(count: u64) -> Ensemble {
    let mut ensemble = Ensemble::with_capacity(count as usize);
    for k in 0..count {
        let part = |ratio: f64| (k as f64 * ratio).fract();
        let (a, b) = (part(0.618_033_988_749_895), part(0.754_877_666_246_693));
        let inertia = Inertia::from_moments([1.0, 1.6 + 0.4 * a, 2.2 + 0.4 * b]).expect("valid moments");
        let omega = Vector3::new(0.4 + 0.2 * b, 1.0, -0.3 - 0.2 * a);
        ensemble.push_omega(&inertia, UnitQuaternion::identity(), omega);
    }
    ensemble
}

fn advance(ensemble: &Ensemble, name: &str, steps: u64) {
    let method = method(name).expect("a method");
    let done = ensemble.advance(&method, Clock::new(STEP), &[steps], |rows| {
        black_box(rows.states(0));
        Ok::<(), EnsembleError>(())
    });
    done.expect("a step that is usable");
}

/// The exact motion at one time.
fn moved(ensemble: &Ensemble) {
    let done = ensemble.at(&[1.0], |rows| {
        black_box(rows.states(0));
        Ok::<(), EnsembleError>(())
    });
    done.expect("a finite time");
}

/// Least time of `job`, s, over some bursts that take turns with those of the others.
fn least<const N: usize>(mut jobs: [&mut dyn FnMut(); N], bursts: usize) -> [f64; N] {
    let mut least = [f64::INFINITY; N];
    for _ in 0..bursts {
        for (job, least) in jobs.iter_mut().zip(&mut least) {
            let begun = Instant::now();
            job();
            *least = least.min(begun.elapsed().as_secs_f64());
        }
    }
    least
}

/// How long `job` takes, and how much of that time the processors worked for it, of all threads: beside other programs that is
/// the figure that counts.
fn timed(job: impl FnOnce()) -> String {
    let (begun, before) = (Instant::now(), worked());
    job();
    let (wall, after) = (begun.elapsed().as_secs_f64(), worked());
    match before.zip(after) {
        Some((before, after)) => format!("{wall:.2} s, {:.2} s of the processors", after - before),
        None => format!("{wall:.2} s"),
    }
}

/// Time of the processors that this program has used, s, where the system tells it (Linux, a hundred ticks a second).
fn worked() -> Option<f64> {
    let text = std::fs::read_to_string("/proc/self/stat").ok()?;
    let (_, behind) = text.rsplit_once(')')?;
    let ticks: Vec<f64> = behind.split_whitespace().skip(11).take(2).filter_map(|n| n.parse().ok()).collect();
    Some(ticks.iter().sum::<f64>() / 100.0)
}

fn main() -> ExitCode {
    let (mut lost, column) = (false, processor::column());
    let mut judge = |ratio: f64, known: [f64; 2]| {
        let known = column.map_or(NONE, |(column, _)| known[column]);
        lost |= ratio < 0.5 * known;
        if ratio < 0.5 * known { "  less than half of what it was" } else { "" }
    };

    let inertia = || Inertia::from_moments([1.0, 2.0, 3.0]).expect("valid moments");
    let mut x = [1.0, 0.0, 0.0, 0.0, 0.4, 1.0, -0.3];
    let mut by_hand = || polhode_yardstick::rk4(black_box(&mut x), black_box(STEP), REFERENCE);

    println!("{:10} {:16} {:>14} {:>12} {:>8}", "", "", "ns/body-step", "million/s", "ratio");
    let mut scalar = f64::INFINITY;
    for (instructions, name, known) in ROWS {
        let (set, available) = measured(instructions);
        if !available {
            println!("{set:10} {name:16} {:>14}", "not measured");
            continue;
        }
        let ensemble = members(MEMBERS).by(instructions);
        let [reference, few, many] = least(
            [&mut by_hand, &mut || advance(&ensemble, name, FEW), &mut || advance(&ensemble, name, MANY)],
            BURSTS,
        );
        let reference = reference / REFERENCE as f64;
        scalar = scalar.min(reference);
        // what preparing the members takes is no part of a step
        let each = (many - few) / ((MANY - FEW) * MEMBERS) as f64;
        let ratio = reference / each;
        println!(
            "{set:10} {name:16} {:14.2} {:12.0} {ratio:8.1}{}",
            1e9 * each,
            1e-6 / each,
            judge(ratio, known)
        );
    }
    println!("{:10} {:16} {:14.2} {:12.0} {:8.1}", "by hand", "rk4", 1e9 * scalar, 1e-6 / scalar, 1.0);

    println!("under forces, and the same step of one body alone:");
    println!(
        "{:10} {:20} {:10} {:>14} {:>12} {:>14} {:>8}",
        "", "", "", "ns/body-step", "million/s", "alone, ns", "ratio"
    );
    for (instructions, name, forces, known) in UNDER_FORCES {
        let (set, available) = measured(instructions);
        let what = format!("{forces:?}").to_lowercase();
        if !available {
            println!("{set:10} {name:20} {what:10} {:>14}", "not measured");
            continue;
        }
        let ensemble = members(MEMBERS).by(instructions);
        let ensemble = ensemble.acted_on(move |inertia| Ok::<_, MemberError>(forces.on(inertia)));
        let mut steps = alone(name, &forces.on(inertia()));
        let [reference, few, many] = least(
            [&mut || steps(REFERENCE / 4), &mut || advance(&ensemble, name, FEW), &mut || {
                advance(&ensemble, name, MANY)
            }],
            BURSTS,
        );
        let reference = 4.0 * reference / REFERENCE as f64;
        let each = (many - few) / ((MANY - FEW) * MEMBERS) as f64;
        let ratio = reference / each;
        println!(
            "{set:10} {name:20} {what:10} {:14.2} {:12.0} {:14.1} {ratio:8.1}{}",
            1e9 * each,
            1e-6 / each,
            1e9 * reference,
            judge(ratio, known)
        );
    }

    println!("to prepare a body and to read it once, us:");
    let some = members(SET_UP);
    let acted = members(SET_UP).acted_on(|inertia| Ok::<_, MemberError>(Forces::Gradient.on(inertia)));
    for (name, known) in SET_UPS {
        let [free, under] =
            least([&mut || advance(&some, name, 1), &mut || advance(&acted, name, 1)], 10 * BURSTS);
        let each = |total: f64| 1e6 * total / SET_UP as f64;
        let steps = 1e6 * scalar / each(free);
        println!(
            "{name:16} free {:.2}, under a gravity gradient {:.2}{}",
            each(free),
            each(under),
            judge(steps * 1e3, known)
        );
    }
    // what is not the widest is prepared one by one
    let single = members(SET_UP).by(Instructions::Avx2);
    let [together, alone] = least([&mut || moved(&some), &mut || moved(&single)], 10 * BURSTS);
    let each = |total: f64| 1e6 * total / SET_UP as f64;
    println!("exact motion     {:.2}, one by one {:.2}", each(together), each(alone));

    let inertia = Inertia::from_moments([1.0, 2.0, 3.0]).expect("valid moments");
    for (what, omega) in
        [("tumbling", Vector3::new(0.4, 1.0, -0.3)), ("near the separatrix", Vector3::new(0.02, 1.0, -0.01))]
    {
        let motion = FreeMotion::from_omega(&inertia, UnitQuaternion::identity(), omega).expect("a start");
        let times: Vec<f64> = (0..4096).map(|n| 0.37 * f64::from(n)).collect();
        let mut states = Vec::new();
        let [one, many] = least(
            [
                &mut || {
                    states.clear();
                    states.extend(times.iter().map(|&t| motion.at(black_box(t)).expect("a finite time")));
                    black_box(&states);
                },
                &mut || drop(black_box(motion.at_many(black_box(&times)).expect("finite times"))),
            ],
            200,
        );
        let each = |total: f64| 1e9 * total / times.len() as f64;
        let ratio = one / many;
        println!(
            "at_many over at, {what}: {:.1} / {:.1} ns = {:.2}{}",
            each(many),
            each(one),
            many / one,
            judge(ratio, [4.0; 2])
        );
    }

    let some = members(64);
    let times: Vec<f64> = (0..500).map(|n| 7.0 * f64::from(n + 1)).collect();
    let at = |ensemble: &Ensemble, times: &[f64]| {
        let done = ensemble.at(times, |rows| {
            black_box(rows.states(0));
            Ok::<(), EnsembleError>(())
        });
        done.expect("finite times");
    };
    let [once, all] = least([&mut || at(&some, &times[..1]), &mut || at(&some, &times)], BURSTS);
    println!(
        "exact motion: {:.2} us a body to prepare, {:.1} ns a time; 100,000 bodies at 500 times so {:.2} s",
        1e6 * once / 64.0,
        1e9 * (all - once) / (64.0 * 499.0),
        100_000.0 * all / 64.0
    );
    println!("all of them in one go: {}", timed(|| at(&members(100_000), &times)));

    #[cfg(feature = "parallel")]
    {
        let (one, two) = (members(16 * 8192), members(16 * 8192).threads(2));
        let [alone, shared] =
            least([&mut || advance(&one, "two-turn:31", 500), &mut || advance(&two, "two-turn:31", 500)], 7);
        println!("two threads over one: {:.2}", alone / shared);
        println!("the same once on one: {}", timed(|| advance(&one, "two-turn:31", 500)));
        println!("the same once on two: {}", timed(|| advance(&two, "two-turn:31", 500)));
        drop((one, two));
        let million = || advance(&members(1_000_000).threads(2), "two-turn:31", 1000);
        println!("1,000,000 bodies, 1000 two-turn steps on two threads: {}", timed(million));
    }
    if column.is_none() {
        println!("{}", processor::UNKNOWN);
        return ExitCode::from(2);
    }
    if lost { ExitCode::FAILURE } else { ExitCode::SUCCESS }
}

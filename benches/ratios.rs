//! Time per step of the main methods over that of an RK4 written by hand, bursts in turn in one run, and beside it how many operations of
//! a step wait for each other, counted on a scalar that knows for how many it has waited. A step lasts at least about as long as its
//! chain, and one that lasts twice as long is held back by something else. The RK4 is compiled the same way whatever the library is, so
//! each of these has a column of the table:
//!
//! ```text
//! cargo bench -p polhode-benches --bench ratios
//! cargo bench --config profile.bench.opt-level=2 --config profile.bench.package.polhode.opt-level=2 -p polhode-benches --bench ratios
//! RUSTFLAGS="-C target-cpu=native" cargo bench -p polhode-benches --bench ratios
//! ```
//!
//! Ends with 1 if a ratio is beyond 1.15 times what it was on this processor when it was last looked at, and with 2 on a processor that the
//! table has no column of. To be run before a release, on a machine that does nothing else.

#![allow(clippy::expect_used)]

mod processor;
mod waiting;

use std::hint::black_box;
use std::process::ExitCode;
use std::time::Instant;

use nalgebra::{UnitQuaternion, Vector3};
use polhode::body::{Body, Clock, Field, Force, Free, LinearPotential, Point, State, Time};
use polhode::flow::LagrangeTop;
use polhode::inertia::Inertia;
use polhode::method::schemes::{BLANES_MOAN_S10, SUZUKI_4};
use polhode::method::{
    AxisSplit, Claimed, Dmv, ExactFlow, ExactStep, ImplicitMidpoint, Kicks, Method, PreprocessedDmv, Rk4,
    Splitting, Step, Taylor, TwoTurn, method,
};
use polhode::num::{Dd, Real};
use polhode::rotation::{Quat, Vec3};
use polhode::run::{Run, Watch};

use waiting::Waiting;

const STEP: f64 = 0.01;
const STEPS: u64 = 1000;
const BURSTS: usize = 200;

/// Beyond this many times what it was, a method is slow.
const SLOW: f64 = 1.15;

/// A ratio that has not been measured yet, and is not judged.
const NEW: f64 = f64::NAN;

/// Of each processor that has a column the ratios at opt-level 3 and at 2, and at 3 for that processor (target-cpu=native).
const ROWS: [(Case, &str, [[f64; 3]; 2]); 20] = [
    (Case::Free, "rk4", [[0.84, 0.85, NEW], [1.13, 0.84, 0.93]]),
    (Case::Free, "lie-poisson", [[1.70, 1.76, NEW], [1.67, 1.76, 1.68]]),
    (Case::Free, "two-turn", [[0.92, 0.91, NEW], [0.99, 0.98, 0.80]]),
    (Case::Free, "exact-step", [[0.69, 0.65, NEW], [0.97, 0.92, 0.97]]),
    (Case::Free, "implicit-midpoint", [[1.59, 1.34, NEW], [1.78, 1.46, 2.27]]),
    (Case::Free, "rattle", [[2.08, 1.84, NEW], [2.37, 1.99, 2.20]]),
    (Case::Free, "dmv:10", [[2.07, 1.84, NEW], [2.38, 1.99, 2.20]]),
    (Case::Free, "kick-drift", [[0.68, 0.65, NEW], [1.00, 0.92, 0.98]]),
    (Case::Free, "two-turn@blanes-moan-s10", [[9.09, 9.02, NEW], [9.75, 9.64, 7.87]]),
    (Case::Free, "taylor:20", [[18.05, 24.89, NEW], [23.24, 30.21, 17.06]]),
    (Case::Heavy, "rk4", [[1.50, 1.23, NEW], [1.66, 1.33, 1.38]]),
    (Case::Heavy, "kick-drift", [[2.55, 2.23, NEW], [1.71, 1.59, 1.81]]),
    (Case::Heavy, "kick-drift@suzuki-4", [[12.68, 11.09, NEW], [8.55, 7.97, 9.02]]),
    (Case::Heavy, "taylor:20", [[27.12, 38.06, NEW], [34.84, 45.04, 29.97]]),
    (Case::Gradient, "rk4", [[9.14, 6.67, NEW], [5.68, 5.04, 4.85]]),
    (Case::Gradient, "kick-drift", [[8.63, 6.72, NEW], [7.11, 7.62, 7.22]]),
    (Case::WatchedFree, "two-turn", [[1.84, 2.21, NEW], [1.90, 1.93, 1.93]]),
    (Case::WatchedFree, "rk4", [[1.72, 1.42, NEW], [2.14, 1.56, 1.75]]),
    (Case::WatchedHeavy, "kick-drift", [[3.07, 2.87, NEW], [2.55, 2.85, 2.52]]),
    (Case::At, "LagrangeTop::at", [[2.53, 2.41, NEW], [3.61, 3.23, 3.10]]),
];

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

/// As many quotients.
fn quotients() -> Job {
    let mut x = 1.3;
    Box::new(move || {
        let dividend = black_box(1.7);
        for _ in 0..STEPS {
            x = dividend / x;
        }
        black_box(x);
    })
}

/// As many additions and roots.
fn roots() -> Job {
    let mut x = 1.3;
    Box::new(move || {
        let sum = black_box(1.7);
        for _ in 0..STEPS {
            x = (x + sum).sqrt();
        }
        black_box(x);
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

const MEAN_MOTION: f64 = 1.1e-3;

fn gradient() -> (Body, State) {
    let inertia = Inertia::from_moments([1.0, 2.0, 2.6]).expect("valid moments");
    let body = Body::free(inertia).with(Force::gravity_gradient(MEAN_MOTION, 0.0).expect("a circle"));
    let start = body.state(UnitQuaternion::identity(), Vector3::new(0.1, 0.03, -0.02));
    (body.clone(), start.expect("a valid start"))
}

fn start(case: Case) -> (Body, State) {
    match case {
        Case::Free | Case::WatchedFree => free(),
        Case::Gradient => gradient(),
        Case::Heavy | Case::WatchedHeavy | Case::At => heavy(),
    }
}

fn job(case: Case, name: &str) -> Job {
    let (body, start) = start(case);
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

/// Operations of a step that wait for each other. Those of a watched step are the same: watching waits for the steps, and they do not wait
/// for it. Closed forms at one time after another do not wait for each other.
fn waits(case: Case, name: &str) -> Option<f64> {
    let (body, start) = start(case);
    let x = body.enter(&start).expect("a valid start").to_f64();
    let x = Point::new(x.attitude.map(Waiting::from), x.momentum_body.map(Waiting::from));
    let count = Count { name, body: &body, x };
    match case {
        Case::Free | Case::WatchedFree => count.with(&Free),
        Case::Heavy | Case::WatchedHeavy => {
            count.with(&body.linear_potential::<Waiting>().expect("a body with a weight"))
        }
        Case::Gradient => {
            let tensor = body.inertia().tensor();
            let tensor = [0, 1, 2].map(|k| Vec3([0, 1, 2].map(|j| Waiting::from(tensor[(k, j)]))));
            count.with(&Gradient { tensor, scale: body.scale() })
        }
        Case::At => None,
    }
}

/// The gravity gradient of [`gradient`], operation by operation as `Forces::torque_at` of the library evaluates one that acts alone, along
/// principal axes: that is for the scalars of the library.
#[derive(Clone, Copy)]
struct Gradient {
    tensor: [Vec3<Waiting>; 3],
    scale: f64,
}

impl Field<Waiting> for Gradient {
    fn linear_part(&self) -> Option<&LinearPotential<Waiting>> {
        None
    }
    fn remainder(&self, at: Time, attitude: Quat<Waiting>, _: Vec3<Waiting>) -> Vec3<Waiting> {
        let (sin, cos) = Real::sin_cos(at.angle::<f64>(MEAN_MOTION));
        let r = attitude.rotate_back(Vec3([cos, sin, 0.0].map(Waiting::from)));
        let strength = Waiting::from(3.0 * MEAN_MOTION * MEAN_MOTION);
        let torque = Vec3::zero() + r.cross(Vec3(self.tensor.map(|row| row.dot(r)))) * strength;
        torque * Waiting::from(1.0 / self.scale)
    }
}

/// A method's name, a body and where it starts.
struct Count<'a> {
    name: &'a str,
    body: &'a Body,
    x: Point<Waiting>,
}

impl Count<'_> {
    /// By the type of the method, as a method by its name is for the scalars of the library; `None` if it is not in this list.
    fn with<F: Field<Waiting>>(&self, field: &F) -> Option<f64> {
        match self.name {
            "rk4" => self.of(&Rk4 { normalized: false }, field),
            "lie-poisson" => self.of(&Splitting::strang(AxisSplit { axes: None }, Kicks), field),
            "two-turn" => self.of(&Splitting::strang(TwoTurn { axes: None }, Kicks), field),
            "two-turn@blanes-moan-s10" => {
                self.of(&Splitting::kicked(TwoTurn { axes: None }, BLANES_MOAN_S10).ok()?, field)
            }
            "exact-step" => self.of(&ExactStep, field),
            "implicit-midpoint" => self.of(&ImplicitMidpoint, field),
            "rattle" => self.of(&Splitting::strang(Dmv, Kicks), field),
            "dmv:10" => self.of(&Splitting::strang(PreprocessedDmv::ORDER_10, Kicks), field),
            "kick-drift" => self.of(&Splitting::strang(ExactFlow, Kicks), field),
            "kick-drift@suzuki-4" => self.of(&Splitting::kicked(ExactFlow, SUZUKI_4).ok()?, field),
            "taylor:20" => self.of(&Taylor::of_order(20).ok()?, field),
            _ => None,
        }
    }

    fn of<M: Method<Waiting> + Claimed, F: Field<Waiting>>(&self, method: &M, field: &F) -> Option<f64> {
        assert_eq!(method.name(), self.name);
        let map = method.map(Dd::of(STEP), &self.body.rotor(), field);
        Some(waiting::per_step(map, self.x, STEP))
    }
}

fn main() -> ExitCode {
    let mut jobs: Vec<Job> = vec![by_hand(), chain(), quotients(), roots()];
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
    let (quotient, root) = (least[2] / operation, least[3] / operation - 1.0);
    Waiting::let_last(quotient, root);
    let mut state = [1.0, 0.0, 0.0, 0.0, 0.4, 1.0, -0.3].map(Waiting::from);
    let of_hand = waiting::growth(|steps| {
        polhode_yardstick::rk4_of(&mut state, STEP.into(), steps);
        state.to_vec()
    });
    let (compiled, processor) = (compiled(), processor::column());
    let column = processor.zip(compiled).map(|((processor, _), (compiled, _))| [processor, compiled]);
    println!(
        "compiled with {}, on {}",
        compiled.map_or("what the table has no column for", |(_, text)| text),
        processor.map_or("another processor than those of the table", |(_, name)| name)
    );
    println!(
        "chain: sums and products that wait for each other, quotients as {quotient:.1}, roots as {root:.1}"
    );
    println!("{:13}{:25}{:>9}{:>7}{:>7}{:>8}{:>11}", "", "", "ns/step", "ratio", "was", "chain", "chain, ns");
    let line = |case: &str, name: &str, ns: f64, known: &str, chain: Option<f64>, verdict: &str| {
        let chain = chain.map(|chain| format!("{chain:>8.0}{:>11.1}", chain * operation));
        let (chain, ratio) = (chain.unwrap_or(format!("{:>8}", "-")), ns / by_hand);
        println!("{case:13}{name:25}{ns:>9.1}{ratio:>7.2}{known:>7}{chain:19}{verdict}");
    };
    line("", "RK4 by hand", by_hand, "", Some(of_hand), "");
    let mut lost = false;
    for ((case, name, known), ns) in ROWS.iter().zip(&least[4..]) {
        let known = column.map(|[processor, compiled]| known[processor][compiled]);
        let known = known.filter(|known| !known.is_nan());
        let slow = known.is_some_and(|known| ns / by_hand > SLOW * known);
        lost |= slow;
        let known = known.map_or("-".into(), |known| format!("{known:.2}"));
        let verdict = if slow { "  slower than it was" } else { "" };
        line(&format!("{case:?}"), name, *ns, &known, waits(*case, name), verdict);
    }
    if column.is_none() {
        println!("{}", processor::UNKNOWN);
        return ExitCode::from(2);
    }
    if lost { ExitCode::FAILURE } else { ExitCode::SUCCESS }
}

//! Time per step of every method, free and under gravity, beside an RK4 written by hand; what counts are the ratios
//! within one run. And the time to prepare a step of the methods of which that takes longest.

#![allow(clippy::expect_used)]

use std::hint::black_box;

use criterion::measurement::WallTime;
use criterion::{BenchmarkGroup, Criterion, Throughput, criterion_group, criterion_main};
use polhode::body::{Body, Clock, State};
use polhode::catalogue;
use polhode::method::{AnyMethod, catalogue, method};
use polhode::run::{Run, Watch};

const STEPS: u64 = 1000;

/// Attitude and momentum as plain numbers.
type Numbers = [f64; 7];

/// The textbook's RK4 for a body along its principal axes, with the weight moment `c`.
fn rk4_by_hand(x: &mut Numbers, inverse: [f64; 3], c: [f64; 3], h: f64, steps: u64) {
    let rate = |[w, x, y, z, m1, m2, m3]: Numbers| {
        let [o1, o2, o3] = [m1 * inverse[0], m2 * inverse[1], m3 * inverse[2]];
        let up = [2.0 * (x * z - w * y), 2.0 * (y * z + w * x), w * w - x * x - y * y + z * z];
        [
            -0.5 * (x * o1 + y * o2 + z * o3),
            0.5 * (w * o1 + y * o3 - z * o2),
            0.5 * (w * o2 + z * o1 - x * o3),
            0.5 * (w * o3 + x * o2 - y * o1),
            m2 * o3 - m3 * o2 + up[1] * c[2] - up[2] * c[1],
            m3 * o1 - m1 * o3 + up[2] * c[0] - up[0] * c[2],
            m1 * o2 - m2 * o1 + up[0] * c[1] - up[1] * c[0],
        ]
    };
    let moved = |x: &Numbers, k: &Numbers, t: f64| {
        let mut y = *x;
        for (y, k) in y.iter_mut().zip(k) {
            *y += t * k;
        }
        y
    };
    for _ in 0..steps {
        let k1 = rate(*x);
        let k2 = rate(moved(x, &k1, 0.5 * h));
        let k3 = rate(moved(x, &k2, 0.5 * h));
        let k4 = rate(moved(x, &k3, h));
        for (n, x) in x.iter_mut().enumerate() {
            *x += h / 6.0 * (k1[n] + 2.0 * (k2[n] + k3[n]) + k4[n]);
        }
    }
}

fn step(criterion: &mut Criterion) {
    let textbook = catalogue::body("textbook").expect("in the catalogue");
    let free = Body::free(textbook.inertia.clone());
    let heavy = Body::heavy(textbook.inertia, [0.1, -0.2, 0.4].into()).expect("a valid weight");
    for (kind, body, weight) in [("free", free, [0.0; 3]), ("heavy", heavy, [0.1, -0.2, 0.4])] {
        let start = body.state(Default::default(), textbook.omega_body.into()).expect("a valid start");
        let mut group = criterion.benchmark_group(kind);
        group.throughput(Throughput::Elements(STEPS));
        let inverse = body.inertia().principal_moments().map(f64::recip);
        let m = start.momentum_body;
        let mut x = [1.0, 0.0, 0.0, 0.0, m[0], m[1], m[2]];
        group.bench_function("rk4 by hand", |b| {
            b.iter(|| rk4_by_hand(black_box(&mut x), inverse, weight, 0.01, STEPS));
        });
        for method in catalogue().into_iter().filter(|method| method.claims(body.problem()).is_some()) {
            of_method(&mut group, &body, &start, &method);
        }
        for name in ["rk4", "lie-poisson", "kick-drift"] {
            for watch in [Watch::EveryStep, Watch::Never] {
                let run = Run::new(&method(name).expect("in the catalogue"), &body, &start, 0.01);
                let mut run = run.expect("a valid run").watching(watch);
                let mut steps = 0;
                group.bench_function(format!("{name}, run watched {watch}"), |b| {
                    b.iter(|| {
                        steps += STEPS;
                        run.advance_to(steps).map(|sample| sample.steps)
                    });
                });
            }
        }
        group.finish();
    }
}

/// Steps that nobody watches.
fn of_method(group: &mut BenchmarkGroup<WallTime>, body: &Body, start: &State, method: &dyn AnyMethod) {
    let order = method.claims(body.problem()).and_then(|claims| claims.order);
    // first-order methods spiral out of range at larger steps
    let h = if order == Some(1) { 1e-7 } else { 0.01 };
    let mut step = method.prepare_f64(Clock::new(h), body).expect("a valid step");
    let mut x = body.enter(start).expect("a valid start").to_f64();
    group.bench_function(method.name(), |b| b.iter(|| step.steps(black_box(&mut x), STEPS)));
}

/// What is worked out before the first step.
fn set_up(criterion: &mut Criterion) {
    let textbook = catalogue::body("textbook").expect("in the catalogue");
    let heavy = Body::heavy(textbook.inertia, [0.1, -0.2, 0.4].into()).expect("a valid weight");
    let mut group = criterion.benchmark_group("set-up");
    for name in
        ["rattle", "lie-poisson@suzuki-4", "dmv:10", "dmv:10@suzuki-4", "dmv:12", "dmv:12@srkn-11b", "dmv:20"]
    {
        let method = method(name).expect("a method");
        group.bench_function(name, |b| {
            b.iter(|| method.prepare_f64(Clock::new(black_box(0.01)), &heavy).is_ok());
        });
    }
    group.finish();
}

criterion_group!(benches, step, set_up);
criterion_main!(benches);

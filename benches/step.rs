//! Time per step of every method; what counts are the ratios within one run.

#![allow(clippy::expect_used)]

use std::hint::black_box;

use criterion::{Criterion, Throughput, criterion_group, criterion_main};
use polhode::body::{Body, Clock, Problem};
use polhode::catalog;
use polhode::method::catalogue;
use polhode::run::Run;

const STEPS: u64 = 1000;

fn step(criterion: &mut Criterion) {
    let textbook = catalog::body("textbook").expect("in the catalogue");
    let body = Body::free(textbook.inertia);
    let start = body.state(Default::default(), textbook.omega_body.into()).expect("a valid start");
    let mut group = criterion.benchmark_group("step");
    group.throughput(Throughput::Elements(STEPS));
    for method in catalogue() {
        // first-order methods spiral out of range at larger steps
        let order = method.claims(Problem::Free).and_then(|claims| claims.order);
        let h = if order == Some(1) { 1e-7 } else { 0.01 };
        let mut prepared = method.prepare_f64(Clock::new(h), &body).expect("a valid step");
        let mut x = body.enter(&start).expect("a valid start").to_f64();
        group.bench_function(method.name(), |b| b.iter(|| prepared.steps(black_box(&mut x), STEPS)));
    }
    // the same with the largest errors over every step
    for name in ["rk4", "lie-poisson"] {
        let method = polhode::method::method(name).expect("in the catalogue");
        let mut run = Run::new(method.as_ref(), &body, &start, 0.01).expect("a valid run");
        let mut steps = 0;
        group.bench_function(format!("{name}, monitored"), |b| {
            b.iter(|| {
                steps += STEPS;
                run.advance_to(steps).map(|sample| sample.worst)
            });
        });
    }
    group.finish();
}

criterion_group!(benches, step);
criterion_main!(benches);

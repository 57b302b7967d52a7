//! Cost of the exact motion: set-up, and one evaluation at any time.

#![allow(clippy::expect_used)]

use std::hint::black_box;

use criterion::{Criterion, criterion_group, criterion_main};
use polhode::catalogue;
use polhode::flow::FreeMotion;

fn exact(criterion: &mut Criterion) {
    let mut group = criterion.benchmark_group("exact");
    // from far off the separatrix to close beside it
    for name in ["spacecraft", "textbook", "racket"] {
        let body = catalogue::body(name).expect("in the catalogue");
        let set_up = || FreeMotion::from_omega(&body.inertia, Default::default(), body.omega_body.into());
        let motion = set_up().expect("a valid start");
        group.bench_function(format!("set-up, {name}"), |b| b.iter(|| black_box(set_up())));
        let mut t = 0.0;
        group.bench_function(format!("at(t), {name}"), |b| {
            b.iter(|| {
                t += 1234.567;
                motion.at(black_box(t))
            });
        });
    }
    let body = catalogue::body("textbook").expect("in the catalogue");
    let motion = FreeMotion::from_omega(&body.inertia, Default::default(), body.omega_body.into());
    let motion = motion.expect("a valid start");
    let times: Vec<f64> = (0..100_000).map(|n| 12.345 * f64::from(n)).collect();
    group.sample_size(20);
    group.bench_function("at_many, 1e5 epochs", |b| b.iter(|| motion.at_many(black_box(&times))));
    group.finish();
}

criterion_group!(benches, exact);
criterion_main!(benches);

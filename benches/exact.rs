//! Cost of the exact motion: set-up, and one evaluation at any time.

#![allow(clippy::expect_used)]

use std::hint::black_box;

use criterion::{Criterion, criterion_group, criterion_main};
use polhode::body::Body;
use polhode::catalogue;
use polhode::flow::{FreeMotion, LagrangeTop};
use polhode::inertia::Inertia;

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
    let weight = [0.0, 0.0, 2.0].into();
    let heavy = Inertia::from_moments([1.25, 1.25, 0.75]).map(|inertia| Body::heavy(inertia, weight));
    let heavy = heavy.expect("a valid body").expect("a valid weight");
    let tilted = nalgebra::UnitQuaternion::from_axis_angle(&nalgebra::Vector3::x_axis(), 0.5);
    let top = LagrangeTop::from_omega(&heavy, tilted, [0.1, 0.3, 20.0].into()).expect("a valid top");
    let mut t = 0.0;
    group.bench_function("at(t), Lagrange top", |b| {
        b.iter(|| {
            t += 1234.567;
            top.at(black_box(t))
        });
    });
    group.finish();
}

criterion_group!(benches, exact);
criterion_main!(benches);

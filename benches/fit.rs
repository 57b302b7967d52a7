//! Time of a whole fit, by number of samples: 6,000 in at most 0.2 s, a million in at most 20 s.

use criterion::{BenchmarkId, Criterion, criterion_group, criterion_main};
use nalgebra::Vector3;
use polhode::inertia::Inertia;
use polhode::num::Random;
use polhode_fit::{Record, Settings, fit, simulate};

fn record(samples: u32) -> Option<Record> {
    let body = Inertia::from_moments([1.0, 2.0, 2.6]).ok()?;
    let times: Vec<f64> = (0..samples).map(|i| f64::from(i) / 100.0).collect();
    let rates = simulate(&body, Vector3::new(0.3, 0.8, 0.5), &times, 1e-2, &mut Random::new(1)).ok()?;
    Record::from_samples(&times, &rates).ok()
}

fn fits(c: &mut Criterion) {
    let mut group = c.benchmark_group("fit");
    group.sample_size(10);
    for samples in [6_000, 60_000, 1_000_000] {
        let Some(record) = record(samples) else { continue };
        group.bench_with_input(BenchmarkId::from_parameter(samples), &record, |b, record| {
            b.iter(|| fit(record, &Settings::default()));
        });
    }
    group.finish();
}

criterion_group!(benches, fits);
criterion_main!(benches);

//! Time of a fit over that of another in the same run: `cargo bench -p polhode-benches --bench fit_ratios`. Ends with
//! 1 if one is more than twice what it was when it was last looked at, as where the time grows faster than the
//! record.

use std::hint::black_box;
use std::process::ExitCode;
use std::time::{Duration, Instant};

use nalgebra::Vector3;
use polhode::inertia::Inertia;
use polhode::num::Random;
use polhode_fit::{Disturbances, Gyroscope, Record, Settings, fit, simulate_with};

const BURSTS: usize = 5;

/// Name, samples, relative drag in 1/s, and the time per sample over that of the first row.
const ROWS: [(&str, u32, f64, f64); 3] = [
    ("6000 samples", 6_000, 0.0, 1.0),
    ("60000 samples", 60_000, 0.0, 1.0),
    ("6000 samples with drag", 6_000, 0.01, 11.0),
];

fn record(samples: u32, drag: f64) -> Option<Record> {
    let body = Inertia::from_moments([1.0, 2.0, 2.6]).ok()?;
    let times: Vec<f64> = (0..samples).map(|i| f64::from(i) / 100.0).collect();
    let disturbances = Disturbances::default().with_relative_drag(drag);
    let gyroscope = Gyroscope::default().with_noise(1e-2);
    let start = Vector3::new(0.3, 0.8, 0.5);
    let rates = simulate_with(&body, start, &times, &disturbances, &gyroscope, &mut Random::new(1)).ok()?;
    Record::from_samples(&times, &rates).ok()
}

/// The shortest of some bursts, the rows in turn.
fn times(records: &[Record]) -> Vec<Duration> {
    let mut best = vec![Duration::MAX; records.len()];
    for _ in 0..BURSTS {
        for (record, best) in records.iter().zip(&mut best) {
            let start = Instant::now();
            let _ = black_box(fit(black_box(record), &Settings::default()));
            *best = start.elapsed().min(*best);
        }
    }
    best
}

fn main() -> ExitCode {
    let records = ROWS.iter().map(|&(_, samples, drag, _)| record(samples, drag));
    let Some(records) = records.collect::<Option<Vec<Record>>>() else { return ExitCode::FAILURE };
    let times = times(&records);
    let per_sample = |k: usize| times[k].as_secs_f64() / f64::from(ROWS[k].1);
    let mut slow = false;
    println!("{:<24}{:>9}{:>8}{:>8}", "record", "µs/sample", "ratio", "before");
    for (k, (name, _, _, before)) in ROWS.iter().enumerate() {
        let ratio = per_sample(k) / per_sample(0);
        slow |= ratio > 2.0 * before;
        println!("{name:<24}{:>9.2}{ratio:>8.2}{before:>8.2}", 1e6 * per_sample(k));
    }
    if slow { ExitCode::FAILURE } else { ExitCode::SUCCESS }
}

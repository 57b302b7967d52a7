//! Error growth against the number of steps: largest errors of the invariants, and attitude error against the exact
//! motion of the same start. Prints CSV; `cargo bench -p polhode-benches --bench drift -- 1000000000` takes as many steps.

#![allow(clippy::expect_used)]

use polhode::body::Body;
use polhode::catalogue;
use polhode::flow::FreeMotion;
use polhode::method::without_projections;
use polhode::rotation::rotation_angle;
use polhode::run::{Run, RunError, Schedule};

fn main() {
    let total = std::env::args().skip(1).find_map(|argument| argument.parse().ok()).unwrap_or(1_000_000);
    let dyadic = catalogue::body("dyadic").expect("in the catalogue");
    let body = Body::free(dyadic.inertia);
    let start = body.state(Default::default(), dyadic.omega_body.into()).expect("a valid start");
    println!("method,steps,energy_error,momentum_error,momentum_vector_error,attitude_error,status");
    for method in without_projections() {
        let mut run = Run::new(&method, &body, &start, 1.0 / 64.0).expect("a valid run");
        let exact = FreeMotion::from_point(body.inertia(), run.start().to_dd());
        for sample in run.samples(Schedule::logarithmic(total, 1)) {
            let (sample, status) = match sample {
                Ok(sample) => (sample, "ok"),
                Err(RunError::Diverged { last } | RunError::Unsolved { last, .. }) => (*last, "diverged"),
                Err(error) => unreachable!("the run was valid: {error}"),
            };
            let attitude = sample.point.to_dd().attitude;
            let error = rotation_angle(attitude, exact.point_at_dd(sample.elapsed).attitude).hi();
            let worst = sample.worst;
            println!(
                "{},{},{:e},{:e},{:e},{error:e},{status}",
                method.name(),
                sample.steps,
                worst.energy.unwrap_or_default(),
                worst.momentum_norm.unwrap_or_default(),
                worst.momentum_vector.unwrap_or_default()
            );
        }
    }
}

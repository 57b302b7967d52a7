//! A tumbling wing nut moved by `two-turn`, with its flips and its largest errors so far: cargo run --release --example propagate

use polhode::body::Conserved;
use polhode::{Body, Inertia, Run, Schedule, method};

fn main() -> Result<(), polhode::Error> {
    // moments in kg m², angular velocity in rad/s along the body axes: a spin about the unstable axis
    let body = Body::free(Inertia::from_moments([0.4e-4, 1.1e-4, 1.3e-4])?);
    let start = body.state(Default::default(), [1e-3, 20.0, 1e-3].into())?;
    let mut run = Run::new(&method("two-turn")?, &body, &start, 1e-3)?;
    println!("t [s]  flips  |dE/E|  |dL/L|");
    for sample in run.samples(Schedule::every(2_000, 20_000)) {
        let sample = sample?;
        let worst = |quantity| sample.worst.of(quantity).unwrap_or(f64::NAN);
        let (energy, momentum) = (worst(Conserved::Energy), worst(Conserved::Momentum));
        println!("{:5}  {:5}  {energy:.1e}  {momentum:.1e}", sample.time.hi(), sample.flips.unwrap_or(0));
    }
    Ok(())
}

#[test]
fn it_runs() -> Result<(), polhode::Error> {
    main()
}

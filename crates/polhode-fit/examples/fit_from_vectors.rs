//! An inertia tensor from angular velocities that a program holds in two vectors:
//! cargo run --release -p polhode-fit --example fit_from_vectors

use polhode::Inertia;
use polhode::num::Random;
use polhode_fit::{Known, Record, Settings, fit, simulate};

fn main() -> Result<(), polhode::Error> {
    // one minute of a gyroscope at 100 Hz, s and rad/s along the axes of the sensor: in place of yours
    let times: Vec<f64> = (0..6000).map(|k| f64::from(k) / 100.0).collect();
    let truth = Inertia::from_moments([1.0, 2.0, 2.6])?;
    let rates = simulate(&truth, [0.3, 1.0, 0.4].into(), &times, 1e-3, &mut Random::new(7))?;
    // free motion gives the tensor up to a factor; one known number gives it in kg m²
    let settings = Settings::default().with_known(Known::Trace(5.6));
    let found = fit(&Record::from_samples(&times, &rates)?, &settings)?;
    println!("{:?} +- {:?} of the trace", found.principal, found.sigma_principal);
    Ok(())
}

#[test]
fn it_runs() -> Result<(), polhode::Error> {
    main()
}

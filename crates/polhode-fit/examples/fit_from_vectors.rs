//! An inertia tensor from angular velocities that a program holds in two vectors:
//! cargo run --release -p polhode-fit --example fit_from_vectors

use polhode::Inertia;
use polhode::nalgebra::Vector3;
use polhode::num::Random;
use polhode_fit::{Known, Record, Settings, fit, simulate};

fn main() -> Result<(), Box<dyn std::error::Error>> {
    // in place of a gyroscope: one minute at 100 Hz, rad/s along the axes of the sensor, with noise
    let truth = Inertia::from_moments([1.0, 2.0, 2.6])?;
    let times: Vec<f64> = (0..6000).map(|k| f64::from(k) / 100.0).collect();
    let rates = simulate(&truth, Vector3::new(0.3, 1.0, 0.4), &times, 1e-3, &mut Random::new(7))?;

    let record = Record::from_samples(&times, &rates)?;
    // free motion gives the tensor up to a factor; one known number gives it in kg m²
    let settings = Settings::default().with_known(Known::Trace(5.6));
    let estimate = fit(&record, &settings)?;
    println!("share of the trace  standard deviation");
    for (moment, sigma) in estimate.principal.iter().zip(&estimate.sigma_principal) {
        println!("{moment:.6}            {sigma:.1e}");
    }
    if let Some(inertia) = estimate.inertia {
        println!("kg m²: {}", inertia.tensor());
    }
    for warning in &estimate.warnings {
        println!("warning: {warning}");
    }
    Ok(())
}

#[test]
fn it_runs() -> Result<(), Box<dyn std::error::Error>> {
    main()
}

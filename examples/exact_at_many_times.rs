//! The exact motion of a free body at many times, none of which depends on another:
//! cargo run --release --example exact_at_many_times

use polhode::nalgebra::{UnitQuaternion, Vector3};
use polhode::{FreeMotion, Inertia};

fn main() -> Result<(), polhode::Error> {
    // Toutatis: moments up to scale, rotation in degrees a day (Takahashi, Busch and Scheeres 2013)
    let inertia = Inertia::from_moments([1.0, 3.0836, 3.235])?;
    let omega_body = Vector3::new(-98.5_f64, 14.5, 33.7).map(f64::to_radians);
    let motion = FreeMotion::from_omega(&inertia, UnitQuaternion::identity(), omega_body)?;
    // a year of days, and a day a million years later
    let mut times: Vec<f64> = (0..=365).map(f64::from).collect();
    times.push(365.25e6);
    for (t, state) in times.iter().zip(motion.at_many(&times)?) {
        let [w, x, y, z] = state.attitude.components();
        println!("{t}, {w}, {x}, {y}, {z}");
    }
    Ok(())
}

#[test]
fn it_runs() -> Result<(), polhode::Error> {
    main()
}

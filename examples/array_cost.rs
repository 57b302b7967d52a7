//! What a state of the exact motion costs when attitudes and angular velocities go into lists of their own. Prints the number of states
//! and the seconds that one takes: cargo run --release --example array_cost

use std::hint::black_box;
use std::time::Instant;

use polhode::nalgebra::{UnitQuaternion, Vector3};
use polhode::{FreeMotion, Inertia};

fn main() -> Result<(), polhode::Error> {
    let inertia = Inertia::from_moments([1.0, 2.0, 3.0])?;
    let motion = FreeMotion::from_omega(&inertia, UnitQuaternion::identity(), Vector3::new(0.4, 1.0, -0.3))?;
    for (count, trials) in [(1_000_u32, 1000), (10_000, 300), (100_000, 50)] {
        let times: Vec<f64> = (0..count).map(|k| 0.01 * f64::from(k)).collect();
        let mut least = f64::INFINITY;
        for _ in 0..trials {
            let clock = Instant::now();
            let mut attitudes = Vec::with_capacity(times.len());
            let mut omegas = Vec::with_capacity(times.len());
            motion.each_at(&times, |state, omega| {
                attitudes.push(state.attitude.components());
                omegas.push(<[f64; 3]>::from(omega));
            })?;
            black_box((attitudes, omegas));
            least = least.min(clock.elapsed().as_secs_f64() / f64::from(count));
        }
        println!("{count} {least:e}");
    }
    Ok(())
}

//! Noisy records of known bodies, to plan a measurement before it is made.

use nalgebra::{UnitQuaternion, Vector3};

use crate::body::StateError;
use crate::flow::FreeMotion;
use crate::inertia::Inertia;
use crate::num::Random;

/// Angular velocities (body axes, rad/s) of the free body at `times` (s), from `omega_body` at time 0, each component
/// with normal noise of standard deviation `sigma`.
///
/// ```
/// use nalgebra::Vector3;
/// use polhode::{fit::simulate, inertia::Inertia, num::Random};
/// let body = Inertia::from_moments([1.0, 2.0, 2.6])?;
/// let times: Vec<f64> = (0..500).map(|i| f64::from(i) / 100.0).collect();
/// let exact = simulate(&body, Vector3::new(0.1, 1.0, 0.2), &times, 0.0, &mut Random::new(1))?;
/// assert!((exact[0] - Vector3::new(0.1, 1.0, 0.2)).norm() < 1e-15);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Errors
/// An angular velocity or a time that is not finite.
pub fn simulate(
    inertia: &Inertia,
    omega_body: Vector3<f64>,
    times: &[f64],
    sigma: f64,
    random: &mut Random,
) -> Result<Vec<Vector3<f64>>, StateError> {
    let motion = FreeMotion::from_omega(inertia, UnitQuaternion::identity(), omega_body)?;
    let frame = inertia.principal_axes();
    let moments = Vector3::from(inertia.principal_moments());
    let mut rates = Vec::with_capacity(times.len());
    for &t in times {
        let state = motion.at(t).map_err(|_| StateError::NotFinite { quantity: "time", value: t })?;
        let along = frame.inverse() * Vector3::from(state.momentum_body);
        rates.push(frame * along.component_div(&moments) + random.normal_vector() * sigma);
    }
    Ok(rates)
}

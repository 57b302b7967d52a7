//! Noisy records of known bodies, to rehearse an experiment before it is made.

use nalgebra::{UnitQuaternion, Vector3};

use crate::body::StateError;
use crate::flow::FreeMotion;
use crate::inertia::Inertia;
use crate::num::Real;

/// Random numbers, the same from the same seed on every machine.
///
/// Source: splitmix64 (Steele, Lea, Flood 2014); normal deviates by Box and Muller.
#[derive(Clone, Debug)]
pub struct Random {
    state: u64,
    spare: Option<f64>,
}

impl Random {
    /// From a seed.
    pub fn new(seed: u64) -> Self {
        Random { state: seed, spare: None }
    }

    /// Uniform on (0, 1).
    pub fn uniform(&mut self) -> f64 {
        self.state = self.state.wrapping_add(0x9E37_79B9_7F4A_7C15);
        let mut z = self.state;
        z = (z ^ (z >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
        z ^= z >> 31;
        ((z >> 12) as f64 + 0.5) / (1_u64 << 52) as f64
    }

    /// Normal with mean 0 and variance 1.
    pub fn normal(&mut self) -> f64 {
        if let Some(spare) = self.spare.take() {
            return spare;
        }
        let radius = (-2.0 * libm::log(self.uniform())).sqrt();
        let (sin, cos) = Real::sin_cos(core::f64::consts::TAU * self.uniform());
        self.spare = Some(radius * sin);
        radius * cos
    }

    /// A vector of three normal deviates.
    pub fn normal_vector(&mut self) -> Vector3<f64> {
        let (x, y, z) = (self.normal(), self.normal(), self.normal());
        Vector3::new(x, y, z)
    }
}

/// Angular velocities (body axes, rad/s) of the free body at `times` (s), from `omega_body` at time 0, each component
/// with normal noise of standard deviation `sigma`.
///
/// ```
/// use nalgebra::Vector3;
/// use polhode::{inertia::Inertia, fit::{Random, rehearse}};
/// let body = Inertia::from_moments([1.0, 2.0, 2.6])?;
/// let times: Vec<f64> = (0..500).map(|i| f64::from(i) / 100.0).collect();
/// let exact = rehearse(&body, Vector3::new(0.1, 1.0, 0.2), &times, 0.0, &mut Random::new(1))?;
/// assert!((exact[0] - Vector3::new(0.1, 1.0, 0.2)).norm() < 1e-15);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Errors
/// An angular velocity or a time that is not finite.
pub fn rehearse(
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

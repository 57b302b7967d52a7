//! Noisy records of known bodies, to plan a measurement before it is made.

mod gyroscope;
mod motion;

use nalgebra::{UnitQuaternion, Vector3};
use polhode::body::StateError;
use polhode::inertia::Inertia;
use polhode::num::Random;
use polhode::rotation::{Quat, Vec3};

pub use gyroscope::Gyroscope;
pub use motion::Disturbances;

impl From<SimulationError> for polhode::Error {
    fn from(error: SimulationError) -> Self {
        polhode::Error::new(error)
    }
}

/// Why a record cannot be simulated.
#[non_exhaustive]
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum SimulationError {
    /// The start of the motion, or a time.
    #[error(transparent)]
    State(#[from] StateError),
    /// A quantity of [`Disturbances`] or [`Gyroscope`].
    #[error("{name} is {value:?}; {rule}")]
    Setting {
        /// Which.
        name: &'static str,
        /// Its value, or that of the component.
        value: f64,
        /// What it must be.
        rule: &'static str,
    },
    /// The motion has become too fast to be followed.
    #[error(
        "the motion cannot be followed beyond {time:e} s in {steps} steps; weaken the torques or end the record earlier"
    )]
    TooFast {
        /// Where the computation ended, s.
        time: f64,
        /// Steps that were taken.
        steps: usize,
    },
}

/// Angular velocities (body axes, rad/s) of the free body at `times` (s), from `omega_body` at time 0, each component
/// with normal noise of standard deviation `sigma`.
///
/// ```
/// use nalgebra::Vector3;
/// use polhode::{inertia::Inertia, num::Random};
/// use polhode_fit::simulate;
/// let body = Inertia::from_moments([1.0, 2.0, 2.6])?;
/// let times: Vec<f64> = (0..500).map(|i| f64::from(i) / 100.0).collect();
/// let exact = simulate(&body, Vector3::new(0.1, 1.0, 0.2), &times, 0.0, &mut Random::new(1))?;
/// assert!((exact[0] - Vector3::new(0.1, 1.0, 0.2)).norm() < 1e-15);
/// # Ok::<(), polhode::Error>(())
/// ```
///
/// # Errors
/// An angular velocity or a time that is not finite, a `sigma` that is negative or not finite.
pub fn simulate(
    inertia: &Inertia,
    omega_body: Vector3<f64>,
    times: &[f64],
    sigma: f64,
    random: &mut Random,
) -> Result<Vec<Vector3<f64>>, SimulationError> {
    let gyroscope = Gyroscope::default().with_noise(sigma);
    simulate_with(inertia, omega_body, times, &Disturbances::default(), &gyroscope, random)
}

/// What `gyroscope` reads (sensor axes = body axes, rad/s) at `times` (s) of a body that `disturbances` act on, from
/// `omega_body` at time 0.
///
/// The random numbers are drawn in the order noise, offset walk, spikes, torque: the noise of the readings is the same
/// whatever else is asked for.
///
/// ```
/// use nalgebra::Vector3;
/// use polhode_fit::{Disturbances, Gyroscope, simulate_with};
/// use polhode::{inertia::Inertia, num::Random};
/// let body = Inertia::from_moments([1.0, 2.0, 2.6])?;
/// let omega = Vector3::new(0.1, 1.0, 0.2);
/// let drag = Disturbances::default().with_relative_drag(0.1);
/// let offset = Gyroscope::default().with_offset(Vector3::new(0.0, 0.0, 0.5));
/// let rates = simulate_with(&body, omega, &[0.0, 10.0], &drag, &offset, &mut Random::new(1))?;
///
/// // |J ω| falls by the factor exp(−k t)
/// let momentum = |w: Vector3<f64>| (body.tensor() * (w - offset.offset)).norm();
/// assert!((momentum(rates[1]) / momentum(rates[0]) - (-1.0_f64).exp()).abs() < 1e-12);
/// # Ok::<(), polhode::Error>(())
/// ```
///
/// # Errors
/// Values that are not finite; negative deviations, drags and quanta; a motion that torques make too fast.
pub fn simulate_with(
    inertia: &Inertia,
    omega_body: Vector3<f64>,
    times: &[f64],
    disturbances: &Disturbances,
    gyroscope: &Gyroscope,
    random: &mut Random,
) -> Result<Vec<Vector3<f64>>, SimulationError> {
    Ok(read(inertia, omega_body, times, disturbances, gyroscope, random)?.rates)
}

/// What a gyroscope and a sensor of attitudes read at the same times.
#[non_exhaustive]
#[derive(Clone, Debug, PartialEq)]
pub struct SimulatedPoses {
    /// Angular velocities, sensor axes, rad/s.
    pub rates: Vec<Vector3<f64>>,
    /// Attitudes, body axes → space.
    pub attitudes: Vec<UnitQuaternion<f64>>,
    /// Momentum of the wheels relative to the body, body axes, N m s, without noise: what [`Segment::with_wheel`](crate::Segment::with_wheel) takes.
    pub wheel: Vec<Vector3<f64>>,
}

/// The same with what a sensor of attitudes reads at `times`: the attitudes, body axes → space and 1 at time 0, each turned by a rotation
/// vector in body axes whose components have the standard deviation `attitude_noise` (rad). That noise is drawn last.
///
/// ```
/// use nalgebra::Vector3;
/// use polhode::{inertia::Inertia, num::Random};
/// use polhode_fit::{Disturbances, Gyroscope, simulate_poses};
/// let body = Inertia::from_moments([1.0, 2.0, 2.6])?;
/// let (omega, drag) = (Vector3::new(0.1, 1.0, 0.2), Disturbances::default().with_relative_drag(0.1));
/// let times: Vec<f64> = (0..100).map(|i| 0.1 * f64::from(i)).collect();
/// let gyroscope = Gyroscope::default();
/// let read = simulate_poses(&body, omega, &times, &drag, &gyroscope, 0.0, &mut Random::new(1))?;
/// // drag along the momentum leaves its direction in space
/// let momentum = |k: usize| read.attitudes[k] * body.momentum(read.rates[k]);
/// assert!(momentum(0).normalize().cross(&momentum(99).normalize()).norm() < 1e-12);
/// # Ok::<(), polhode::Error>(())
/// ```
///
/// # Errors
/// As [`simulate_with`], and a noise that is negative or not finite.
pub fn simulate_poses(
    inertia: &Inertia,
    omega_body: Vector3<f64>,
    times: &[f64],
    disturbances: &Disturbances,
    gyroscope: &Gyroscope,
    attitude_noise: f64,
    random: &mut Random,
) -> Result<SimulatedPoses, SimulationError> {
    check("the noise of the attitudes", &[attitude_noise], false)?;
    let Read { rates, exact, wheel } =
        self::read(inertia, omega_body, times, disturbances, gyroscope, random)?;
    let mut read = |q: &Quat<f64>| {
        if attitude_noise == 0.0 {
            return UnitQuaternion::from(*q);
        }
        let off = Vec3::from(random.normal_vector() * attitude_noise);
        UnitQuaternion::from(*q * Quat::exponential(off))
    };
    Ok(SimulatedPoses { rates, attitudes: exact.iter().map(&mut read).collect(), wheel })
}

/// What the gyroscope reads, and the true attitudes.
struct Read {
    rates: Vec<Vector3<f64>>,
    exact: Vec<Quat<f64>>,
    wheel: Vec<Vector3<f64>>,
}

fn read(
    inertia: &Inertia,
    omega_body: Vector3<f64>,
    times: &[f64],
    disturbances: &Disturbances,
    gyroscope: &Gyroscope,
    random: &mut Random,
) -> Result<Read, SimulationError> {
    disturbances.check()?;
    gyroscope.check()?;
    let errors = gyroscope.errors(times, random);
    let found = disturbances.motion(inertia, omega_body, times, gyroscope.skew, random)?;
    let rates = found.rates.iter().zip(&errors).map(|(w, error)| gyroscope.reading(w, error));
    Ok(Read { rates: rates.collect(), exact: found.attitudes, wheel: found.wheel })
}

/// Refuses a value that is not finite, or less than zero where it may not be `negative`.
fn check(name: &'static str, values: &[f64], negative: bool) -> Result<(), SimulationError> {
    let wrong = values.iter().find(|v| !v.is_finite() || (!negative && **v < 0.0));
    let rule = if negative { "give a finite number" } else { "give a finite number of at least 0" };
    wrong.map_or(Ok(()), |&value| Err(SimulationError::Setting { name, value, rule }))
}

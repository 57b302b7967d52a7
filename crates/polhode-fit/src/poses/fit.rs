//! The fit of a tensor to measured attitudes.

use crate::error::FitError;
use crate::physical::coordinates::{eigen, tensor};
use crate::poses::fault::PoseFault;
use crate::poses::free::Free;
use crate::poses::record::Poses;
use crate::report::estimate::Estimate;
use crate::report::exact::{Told, report};
use crate::settings::Settings;
use crate::settings::torque::{TorqueModel, TorqueNoise};
use crate::thresholds::poses::OPEN;

/// Fits one tensor to all segments of measured attitudes, and to the angular velocities beside them where there are any.
///
/// The motion of a free body is known in closed form, and so is its derivative: the tensor is that of the largest likelihood, each
/// segment with a start of its own. Drag in proportion to the momentum is part of the closed form, a small constant torque is reckoned with to
/// first order; where neither explains what the free motion leaves, there is no answer. The tensor is in the body axes of the attitudes, or in those of the rates where there are rates.
/// Attitudes of a body that moves alone do not tell the size of the tensor, as rates do not.
///
/// ```
/// use nalgebra::{UnitQuaternion, Vector3};
/// use polhode::{FreeMotion, inertia::Inertia, num::Random, rotation::{Quat, Vec3}};
/// use polhode_fit::{Poses, Settings, fit_poses};
/// let body = Inertia::from_moments([1.0, 2.0, 2.6])?;
/// let motion = FreeMotion::from_omega(&body, UnitQuaternion::identity(), Vector3::new(0.3, 1.0, 0.4))?;
/// let times: Vec<f64> = (0..600).map(|i| f64::from(i) / 20.0).collect();
/// let mut random = Random::new(7);
/// let mut measured = Vec::new();
/// for &t in &times {
///     let off = Quat::exponential(Vec3::from(random.normal_vector() * 0.01)); // 0.6 degrees
///     measured.push((motion.at(t)?.attitude * off).into());
/// }
/// let estimate = fit_poses(&Poses::new("markers", &times, &measured)?, &Settings::default())?;
/// for (k, truth) in [1.0 / 5.6, 2.0 / 5.6, 2.6 / 5.6].into_iter().enumerate() {
///     assert!((estimate.principal[k] - truth).abs() < 4.0 * estimate.sigma_principal[k]);
///     assert!(estimate.sigma_principal[k] < 2e-4);
/// }
/// let attitudes = estimate.attitudes.ok_or("they were fitted")?;
/// assert!((attitudes.noise_sigma / 0.01 - 1.0).abs() < 0.1);
/// # Ok::<(), polhode::Error>(())
/// ```
///
/// # Errors
/// Too few attitudes; half a turn from one to the next; no rotation; attitudes that no free motion follows, or that follow one the other way
/// round; a direction that the motion does not tell; rates beside them of another size or hand; what [`fit`](crate::fit) refuses of a tensor
/// that is not determined, of limits and of priors.
pub fn fit_poses(poses: &Poses, settings: &Settings) -> Result<Estimate, FitError> {
    settings.check()?;
    only_of_rates(settings)?;
    let as_read = Free::new(poses, settings);
    if poses.direction_is_open() {
        return told_by_motion(poses, settings, as_read);
    }
    // a contradiction may come from the direction
    let is_explained = as_read.as_ref().is_ok_and(|free| free.is_explained(settings));
    if !is_explained
        && !matches!(as_read, Err(FitError::TooFewSamples { .. }))
        && let Ok(other) = Free::new(&poses.inverse(), settings)
    {
        let gain = as_read.as_ref().map_or(f64::INFINITY, |free| gain(&other, free));
        if gain > OPEN && other.is_explained(settings) && !is_steady(&other) {
            return Err(PoseFault::Inverted { inverse: moments(&other), gain }.into());
        }
    }
    finished(poses, settings, &as_read?, Told { is_inverse: false, gain: None })
}

/// The direction that the motion tells.
fn told_by_motion(
    poses: &Poses,
    settings: &Settings,
    as_read: Result<Free, FitError>,
) -> Result<Estimate, FitError> {
    let inverse = Free::new(&poses.inverse(), settings);
    match (as_read, inverse) {
        (Ok(free), Ok(other)) => {
            let gain = gain(&free, &other);
            if gain.abs() <= OPEN && !is_steady(&free) {
                let (as_read, inverse) = (moments(&free), moments(&other));
                return Err(PoseFault::Direction { as_read, inverse, gain }.into());
            }
            let is_inverse = gain < 0.0;
            let told = Told { is_inverse, gain: Some(gain.abs()) };
            finished(poses, settings, if is_inverse { &other } else { &free }, told)
        }
        (Ok(free), Err(_)) => {
            finished(poses, settings, &free, Told { is_inverse: false, gain: Some(f64::INFINITY) })
        }
        (Err(_), Ok(other)) => {
            finished(poses, settings, &other, Told { is_inverse: true, gain: Some(f64::INFINITY) })
        }
        (Err(error), Err(_)) => Err(error),
    }
}

/// Log-likelihood of one model less that of another.
fn gain(one: &Free, other: &Free) -> f64 {
    0.5 * (other.followed.cost() - one.followed.cost())
}

fn moments(free: &Free) -> [f64; 3] {
    eigen(tensor(&free.followed.model.x)).0.into()
}

/// Whether a steady spin does as well, of which both directions say the same.
fn is_steady(free: &Free) -> bool {
    free.steady.is_some()
}

/// The report on a motion that is free, or that is said to be.
fn finished(poses: &Poses, settings: &Settings, free: &Free, told: Told) -> Result<Estimate, FitError> {
    if !free.is_explained(settings) && settings.torque == TorqueModel::Auto {
        let noise = settings.attitude_noise.or(free.local_noise);
        let (residual, turn) = (free.followed.levels.attitude, free.largest_turn);
        return Err(PoseFault::NotFree { residual, noise, turn }.into());
    }
    report(poses.repeated(), settings, free, told)
}

/// Refuses settings that have no meaning here.
fn only_of_rates(settings: &Settings) -> Result<(), FitError> {
    let sensor = settings.sensor.named().into_iter();
    let others =
        [("the radius of test functions", settings.radius), ("the quantum of the rates", settings.quantum)];
    let is_other = matches!(settings.torque, TorqueModel::Drag3 | TorqueModel::Quadratic);
    if is_other || matches!(settings.torque_noise, TorqueNoise::Given(_)) {
        return Err(PoseFault::Torque.into());
    }
    let given = others.into_iter().chain(sensor).find(|(_, value)| value.is_some());
    given.map_or(Ok(()), |(name, _)| Err(PoseFault::OnlyRates { name }.into()))
}

//! The fit of a tensor to measured attitudes.

use crate::columns::column::Unknowns;
use crate::columns::sets::torque_columns;
use crate::error::FitError;
use crate::likelihood::choice::Acting;
use crate::likelihood::growth::Followed;
use crate::likelihood::motion::Start;
use crate::likelihood::track::Track;
use crate::physical::coordinates::{eigen, tensor};
use crate::poses::fault::PoseFault;
use crate::poses::free::{Begun, Free, Read};
use crate::poses::record::Poses;
use crate::report::estimate::Estimate;
use crate::report::exact::report;
use crate::report::likelihood::Told;
use crate::report::smoothed::report as smoothed_report;
use crate::report::warnings::short_segments;
use crate::settings::Settings;
use crate::settings::torque::{TorqueModel, TorqueNoise};
use crate::smoothed::choice::choose;
use crate::smoothed::search::{self as smoothed, Found, Noise};
use crate::thresholds::judgement::DRIVEN;
use crate::thresholds::poses::OPEN;
use crate::thresholds::smoothed::WALKS;
use crate::verdict::axes::check_axes;

/// Fits one tensor to all segments of measured attitudes, and to the angular velocities beside them where there are any.
///
/// The motion of a free body is known in closed form, and so is its derivative: the tensor is that of the largest likelihood, each
/// segment with a start of its own. Drag in proportion to the momentum is part of the closed form; a small constant torque is fitted to
/// first order. If none of these explains the attitudes, or another torque or torque noise is asked for, a Kalman filter and smoother
/// about the motion under the torque is used, with torque noise for the rest. It does not take rates beside the attitudes.
///
/// The tensor is in the body axes of the attitudes, or in those of the rates if there are any. Like rates, the attitudes of a free body do
/// not determine the size of the tensor.
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
/// Too few attitudes; half a turn from one to the next; no rotation; attitudes that no motion follows, or that follow one the other way
/// round; a direction that the motion does not tell; rates beside them of another size or hand, or of an axis that reads nothing; what [`fit`](crate::fit) refuses of a tensor
/// that is not determined, of limits and of priors.
pub fn fit_poses(poses: &Poses, settings: &Settings) -> Result<Estimate, FitError> {
    settings.check()?;
    only_of_rates(poses, settings)?;
    let found = fitted(poses, settings);
    let is_of_motion = match &found {
        Ok(_) => true,
        Err(FitError::Poses(fault)) => matches!(
            fault,
            PoseFault::Unsettled | PoseFault::NotFree { .. } | PoseFault::Mirrored | PoseFault::Scale { .. }
        ),
        Err(_) => false,
    };
    if poses.has_rates() && is_of_motion {
        check_axes(&poses.rates())?;
    }
    let mut estimate = found?;
    let short = short_segments(estimate.segments, poses.segments().len());
    estimate.warnings = short.into_iter().chain(estimate.warnings).collect();
    Ok(estimate)
}

/// The fit by the exact motion, or by filter and smoother.
fn fitted(poses: &Poses, settings: &Settings) -> Result<Estimate, FitError> {
    if needs_smoother(settings) {
        return under_torques(poses, settings);
    }
    match by_exact_motion(poses, settings) {
        Err(FitError::Poses(fault @ PoseFault::NotFree { .. })) if !poses.has_rates() => {
            under_torques(poses, settings).map_err(|error| match error {
                FitError::Poses(PoseFault::NotFree { .. }) => fault.into(),
                other => other,
            })
        }
        other => other,
    }
}

/// The fit by the closed form of the motion.
fn by_exact_motion(poses: &Poses, settings: &Settings) -> Result<Estimate, FitError> {
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
    let is_free = |poses: &Poses| {
        Free::new(&poses.without_rates(), settings).is_ok_and(|free| free.is_explained(settings))
    };
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
        // rates that turn the other way are the cause where the attitudes alone move freely
        (Err(error @ FitError::Poses(PoseFault::Mirrored)), Ok(other))
            if !other.is_explained(settings) && is_free(poses) =>
        {
            Err(error)
        }
        (Ok(free), Err(error @ FitError::Poses(PoseFault::Mirrored)))
            if !free.is_explained(settings) && is_free(&poses.inverse()) =>
        {
            Err(error)
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

/// The report on a motion that is free, or that drag or a small constant torque changes.
fn finished(poses: &Poses, settings: &Settings, free: &Free, told: Told) -> Result<Estimate, FitError> {
    let may_be_driven = !poses.has_rates() || settings.torque == TorqueModel::Auto;
    let is_alone = !poses.has_rates() && settings.torque_noise == TorqueNoise::Fitted;
    let is_explained = free.is_explained(settings) && !(is_alone && walks(settings, free));
    if !is_explained && may_be_driven {
        let noise = settings.attitude_noise.or(free.read.local_noise);
        let (residual, turn) = (free.followed.levels.attitude, free.read.largest_turn);
        return Err(PoseFault::NotFree { residual, noise, turn }.into());
    }
    report(poses.repeated(), settings, free, told)
}

/// Whether a torque is asked for of which there is no closed form.
fn needs_smoother(settings: &Settings) -> bool {
    let is_other = matches!(settings.torque, TorqueModel::Drag3 | TorqueModel::Quadratic);
    is_other || matches!(settings.torque_noise, TorqueNoise::Given(_))
}

/// What is known of the noise, in this unit of the rates.
fn noise_of(settings: &Settings, unit: f64) -> Noise {
    let torque = match settings.torque_noise {
        TorqueNoise::Given(density) => TorqueNoise::Given(density / (unit * unit * unit)),
        other => other,
    };
    Noise { attitude: settings.attitude_noise, torque }
}

/// Whether torque noise about a motion explains the attitudes better. Where it is small it is left among their noise, and the tensor is off.
fn walks(settings: &Settings, free: &Free) -> bool {
    let Followed { model, tracks, .. } = &free.followed;
    let path = |(track, start): (&Track, &Start)| {
        let motion = model.motion(start)?;
        let at = |t: &f64| motion.at(*t).map(|at| Start { attitude: at.attitude, rate: at.rate });
        track.times.iter().map(at).collect::<Option<Vec<Start>>>()
    };
    let (columns, values) = match (model.drag, &free.alternatives) {
        (Some(drag), _) => (torque_columns(TorqueModel::Drag), vec![drag]),
        (None, Some(found)) if free.torque == Acting::Constant => {
            (torque_columns(TorqueModel::Constant), found.constant.values.clone())
        }
        _ => (Vec::new(), Vec::new()),
    };
    let at = Unknowns { x: model.x, c: values };
    let paths = tracks.iter().zip(&model.starts).map(path).collect::<Option<Vec<_>>>();
    let gain = paths.and_then(|paths| {
        smoothed::gain_of_noise(tracks, at, &columns, paths, noise_of(settings, free.read.unit))
    });
    gain.is_some_and(|gain| gain > WALKS)
}

/// The fit by filter and smoother, of the direction that is more likely.
fn under_torques(poses: &Poses, settings: &Settings) -> Result<Estimate, FitError> {
    let follow = |poses: &Poses| {
        let Begun { tracks, first, read, .. } = Begun::new(poses, settings)?;
        let not_followed = PoseFault::NotFree { residual: 1.0, noise: None, turn: read.largest_turn };
        let noise = noise_of(settings, read.unit);
        let found = smoothed::first(&tracks, first, &[], noise).ok_or(not_followed)?;
        Ok::<(Found, Read), FitError>((found, read))
    };
    let follows = |found: &Found| found.is_still && found.unexplained() <= DRIVEN;
    // also where the direction is stated: torque noise may make up for a wrong one
    let (as_read, inverse) = (follow(poses), follow(&poses.inverse()));
    let likelihood = |found: &Result<(Found, Read), FitError>| {
        found.as_ref().map_or(f64::NEG_INFINITY, |(found, _)| found.likelihood)
    };
    let gain = likelihood(&as_read) - likelihood(&inverse);
    let moments = |found: &Result<(Found, Read), FitError>| {
        found.as_ref().map_or([0.0; 3], |(found, _)| eigen(tensor(&found.at.x)).0.into())
    };
    let told = match (poses.direction_is_open(), gain) {
        (true, gain) if gain.abs() <= OPEN => {
            return Err(PoseFault::Direction {
                as_read: moments(&as_read),
                inverse: moments(&inverse),
                gain,
            }
            .into());
        }
        (true, gain) => Told { is_inverse: gain < 0.0, gain: Some(gain.abs()) },
        (false, gain) if gain < -OPEN && inverse.as_ref().is_ok_and(|(found, _)| follows(found)) => {
            return Err(PoseFault::Inverted { inverse: moments(&inverse), gain: -gain }.into());
        }
        (false, _) => Told { is_inverse: false, gain: None },
    };
    let (none, read) = if told.is_inverse { inverse? } else { as_read? };
    let not_free = |found: &Found| PoseFault::NotFree {
        residual: found.variance.sqrt(),
        noise: settings.attitude_noise.or(read.local_noise),
        turn: read.largest_turn,
    };
    let residual = not_free(&none);
    let chosen = choose(none, settings.torque, noise_of(settings, read.unit)).ok_or(residual)?;
    if !follows(&chosen.found) {
        return Err(not_free(&chosen.found).into());
    }
    smoothed_report(poses.repeated(), settings, &read, &chosen, told)
}

/// Refuses settings that have no meaning here.
fn only_of_rates(poses: &Poses, settings: &Settings) -> Result<(), FitError> {
    let sensor = settings.sensor.named().into_iter();
    let others = [
        ("the radius of test functions", settings.radius),
        ("the quantum of the rates", settings.quantum),
        ("the noise of the rates", settings.noise.filter(|_| !poses.has_rates())),
    ];
    if needs_smoother(settings) && poses.has_rates() {
        return Err(PoseFault::Torque.into());
    }
    let given = others.into_iter().chain(sensor).find(|(_, value)| value.is_some());
    given.map_or(Ok(()), |(name, _)| Err(PoseFault::OnlyRates { name }.into()))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::likelihood::descent::Levels;
    use crate::likelihood::track::Model;
    use crate::physical::coordinates::coordinates;
    use crate::settings::sensor::SensorPriors;
    use crate::simulate::{Disturbances, Gyroscope, simulate_poses};
    use nalgebra::{Matrix3, UnitQuaternion, Vector3};
    use polhode::inertia::Inertia;
    use polhode::num::Random;
    use polhode::rotation::Quat;

    /// A density (rad/s²)² s is over the third power of the unit of the rates; the noise of attitudes is an angle.
    #[test]
    fn torque_noise_goes_with_the_third_power_of_the_rate() {
        let given = Settings::default().with_torque_noise(TorqueNoise::Given(8e-6)).with_attitude_noise(0.25);
        let Noise { attitude, torque: TorqueNoise::Given(density) } = noise_of(&given, 2.0) else { panic!() };
        assert!(attitude == Some(0.25) && (density / 1e-6 - 1.0).abs() < 1e-15);
        assert_eq!(noise_of(&Settings::default(), 2.0).torque, TorqueNoise::Fitted);
    }

    /// Torques without a closed form, and torque noise of a level, need filter and smoother, which take no rates; settings of test functions
    /// have no meaning, nor has noise of rates that are not there.
    #[test]
    fn what_attitudes_have_no_use_for_is_named() {
        let times: Vec<f64> = (0..4).map(f64::from).collect();
        let turned = |t: &f64| UnitQuaternion::from_scaled_axis(Vector3::z() * *t);
        let attitudes: Vec<UnitQuaternion<f64>> = times.iter().map(turned).collect();
        let bare = Poses::new("a", &times, &attitudes).unwrap();
        let both = Poses::with_rates("a", &times, &attitudes, &[Vector3::z(); 4]).unwrap();
        let plain = Settings::default;
        for (torque, needs) in [
            (TorqueModel::None, false),
            (TorqueModel::Auto, false),
            (TorqueModel::Drag, false),
            (TorqueModel::Constant, false),
            (TorqueModel::Drag3, true),
            (TorqueModel::Quadratic, true),
        ] {
            let settings = plain().with_torque(torque);
            assert_eq!(needs_smoother(&settings), needs, "{torque}");
            assert_eq!(only_of_rates(&bare, &settings), Ok(()), "{torque}");
            let expected = if needs { Err(FitError::Poses(PoseFault::Torque)) } else { Ok(()) };
            assert_eq!(only_of_rates(&both, &settings), expected, "{torque}");
        }
        assert!(needs_smoother(&plain().with_torque_noise(TorqueNoise::Given(1e-6))));
        assert!(!needs_smoother(&plain().with_torque_noise(TorqueNoise::None)));
        let named = |poses: &Poses, settings: &Settings| match only_of_rates(poses, settings) {
            Err(FitError::Poses(PoseFault::OnlyRates { name })) => name,
            other => panic!("{other:?}"),
        };
        let skew = SensorPriors::default().with_skew(1e-3);
        for (settings, name) in [
            (plain().with_radius(1.0), "the radius of test functions"),
            (plain().with_quantum(0.1), "the quantum of the rates"),
            (plain().with_sensor(skew), "the deviation of the skew"),
        ] {
            assert_eq!((named(&bare, &settings), named(&both, &settings)), (name, name));
        }
        assert_eq!(named(&bare, &plain().with_noise(0.1)), "the noise of the rates");
        assert_eq!(only_of_rates(&both, &plain().with_noise(0.1)), Ok(()));
    }

    /// A motion of the moments 0.25, 0.35 and 0.4 that leaves so much of ten numbers.
    fn left(level: f64) -> Free {
        let x = coordinates(&Matrix3::from_diagonal(&Vector3::new(0.4, 0.25, 0.35)));
        let (alignment, attitudes) = (Quat::identity(), vec![Quat::identity()]);
        let track = Track { times: vec![0.0], attitudes, rates: Vec::new(), used: vec![true] };
        let model = Model { x, alignment, is_aligned: false, drag: None, starts: Vec::new() };
        let levels = Levels { attitude: level, rate: 0.0 };
        let followed = Followed { tracks: vec![track], ..Followed::at(model, levels, [10.0, 0.0]) };
        Free::of(followed, Read { local_noise: Some(0.5), largest_turn: 0.75, ..Read::nothing() })
    }

    /// Attitudes that were stated the wrong way round follow no free motion; the closed form finds that of the other direction, with its tensor, before
    /// any filter is asked.
    #[test]
    fn the_closed_form_tells_a_direction_that_is_wrong() {
        let body = Inertia::from_moments([1.0, 2.0, 2.6]).unwrap();
        let times: Vec<f64> = (0..200).map(|k| 0.1 * f64::from(k)).collect();
        let (none, perfect, start) =
            (Disturbances::default(), Gyroscope::default(), Vector3::new(0.5, 0.8, -0.4));
        let made = simulate_poses(&body, start, &times, &none, &perfect, 5e-3, &mut Random::new(9)).unwrap();
        let poses = Poses::new("a", &times, &made.attitudes).unwrap();
        let settings = Settings::default().with_torque(TorqueModel::None);
        let settings = settings.with_torque_noise(TorqueNoise::None);
        let right = by_exact_motion(&poses, &settings).unwrap();
        match by_exact_motion(&poses.inverse(), &settings) {
            Err(FitError::Poses(PoseFault::Inverted { inverse, gain })) => {
                let apart = inverse.iter().zip(right.principal).map(|(a, b)| (a - b).abs());
                assert!(apart.fold(0.0, f64::max) < 1e-9 && gain > 100.0, "{inverse:?} {gain}");
            }
            other => panic!("{:?}", other.err()),
        }
    }

    /// One of ten numbers that leaves e times as much is less likely by ten. What the noise does not explain, which is given or told by
    /// neighbours, is no free motion, and is told with all three numbers.
    #[test]
    fn motions_are_compared_by_what_they_leave() {
        let more = core::f64::consts::E;
        assert!((gain(&left(0.1), &left(0.1 * more)) - 10.0).abs() < 1e-12);
        assert!((gain(&left(0.1 * more), &left(0.1)) + 10.0).abs() < 1e-12);
        for (found, expected) in moments(&left(1.0)).into_iter().zip([0.25, 0.35, 0.4]) {
            assert!((found - expected).abs() < 1e-12);
        }
        assert!(!is_steady(&left(1.0)));
        let times: Vec<f64> = (0..4).map(f64::from).collect();
        let turned = |t: &f64| UnitQuaternion::from_scaled_axis(Vector3::z() * *t);
        let attitudes: Vec<UnitQuaternion<f64>> = times.iter().map(turned).collect();
        let poses = Poses::new("a", &times, &attitudes).unwrap();
        let plain = Settings::default();
        for (settings, noise) in [(plain.clone(), 0.5), (plain.with_attitude_noise(0.25), 0.25)] {
            // ten numbers scatter up to six times their mean square
            let residual = 1.001 * noise * f64::sqrt(6.0);
            let told = Told { is_inverse: false, gain: None };
            let found = finished(&poses, &settings, &left(residual), told).err();
            let expected = PoseFault::NotFree { residual, noise: Some(noise), turn: 0.75 };
            assert_eq!(found, Some(FitError::Poses(expected)));
        }
    }
}

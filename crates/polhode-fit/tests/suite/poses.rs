//! Attitudes in, tensor out.

use nalgebra::{Quaternion, UnitQuaternion, Vector3};
use polhode::flow::FreeMotion;
use polhode::inertia::Inertia;
use polhode::num::Random;
use polhode::rotation::{Quat, Vec3};
use polhode_fit::{
    Disturbances, Estimate, FitError, Gyroscope, Known, Method, PoseFault, Poses, PosesError, Settings,
    TorqueModel, Warning, fit_poses, foreseen_attitude_bound, simulate_poses,
};

use crate::measured::{distance, entries, random_rotation, turned};

fn body(moments: [f64; 3], random: &mut Random) -> Inertia {
    let j = turned(moments, &random_rotation(random));
    Inertia::from_tensor(j / j.trace()).unwrap()
}

fn attitudes(
    motion: &FreeMotion,
    times: &[f64],
    noise: f64,
    random: &mut Random,
) -> Vec<UnitQuaternion<f64>> {
    let middle = 0.5 * (times[0] + times[times.len() - 1]);
    let one = |t: &f64, random: &mut Random| {
        let off = Quat::exponential(Vec3::from(random.normal_vector() * noise));
        (motion.at(t - middle).unwrap().attitude * off).into()
    };
    times.iter().map(|t| one(t, random)).collect()
}

const ASYMMETRIC: [f64; 3] = [1.0, 2.0, 2.6];

/// A body with random axes, its motion, and noisy attitudes of it, each from one stream of random numbers.
struct Toss {
    body: Inertia,
    motion: FreeMotion,
    omega: Vector3<f64>,
    times: Vec<f64>,
    measured: Vec<UnitQuaternion<f64>>,
}

fn toss(moments: [f64; 3], rate: f64, seconds: f64, noise: f64, stream: u64) -> Toss {
    let mut random = Random::new(77).stream(stream);
    let body = body(moments, &mut random);
    let omega = random.normal_vector().normalize();
    let times: Vec<f64> = (0..=(rate * seconds) as usize).map(|i| i as f64 / rate).collect();
    let motion = FreeMotion::from_omega(&body, UnitQuaternion::identity(), omega).unwrap();
    let measured = attitudes(&motion, &times, noise, &mut random);
    Toss { body, motion, omega, times, measured }
}

impl Toss {
    fn poses(&self) -> Poses {
        Poses::new("toss", &self.times, &self.measured).unwrap()
    }

    /// Rates of the motion at the times, along axes to which `turn` takes coordinates of the body.
    fn rates(&self, turn: impl Fn(f64) -> UnitQuaternion<f64>, noise: f64) -> Vec<Vector3<f64>> {
        let (mut random, middle) = (Random::new(5), 0.5 * self.times[self.times.len() - 1]);
        let rate = |t: &f64| self.motion.omega_at(t - middle).unwrap();
        self.times.iter().map(|t| turn(*t) * rate(t) + random.normal_vector() * noise).collect()
    }
}

fn refused(poses: &Poses) -> PoseFault {
    match fit_poses(poses, &Settings::default()) {
        Err(FitError::Poses(fault)) => fault,
        Err(other) => panic!("{other}"),
        Ok(estimate) => panic!("{:?} {:?}", estimate.principal, estimate.attitudes),
    }
}

/// Over several bodies, noises from 0.05 to 2 degrees and sampling rates: the error is that of the bound, and the stated covariance holds it.
#[test]
#[ignore = "an ensemble: takes seconds, `.ci/run` does it"]
fn errors_are_those_of_the_bound() {
    let (mut squares, mut own, mut count) = (0.0, 0.0, 0.0);
    for (k, noise) in [0.05_f64, 0.5, 2.0].into_iter().enumerate() {
        for (n, moments) in
            [ASYMMETRIC, [1.0, 2.0, 2.1], [1.0, 2.0, 3.0], [1.0, 3.0, 3.3]].into_iter().enumerate()
        {
            for trial in 0..3 {
                let noise = noise.to_radians();
                let rate = if trial == 0 { 24.0 } else { 6.0 };
                let toss = toss(moments, rate, 30.0, noise, (100 * k + 10 * n + trial) as u64);
                let bound = foreseen_attitude_bound(&toss.body, toss.omega, &toss.times, noise).unwrap();
                let estimate = match fit_poses(&toss.poses(), &Settings::default()) {
                    Ok(estimate) => estimate,
                    // an estimate of the bound stands where the bound itself is near the limit
                    Err(FitError::Unidentifiable(_)) if bound.trace() > 2.5e-3 => continue,
                    Err(error) => panic!("{moments:?} {noise} {trial}: {error}"),
                };
                let off = entries(&(estimate.shape.tensor() - toss.body.tensor()));
                squares += distance(&off, &bound);
                own += distance(&off, &estimate.free_covariance);
                count += 5.0;
                assert_eq!(estimate.method, Method::ExactMotion);
                let found = estimate.attitudes.unwrap();
                assert!((found.noise_sigma / noise - 1.0).abs() < 0.2, "{found:?}");
            }
        }
    }
    // 180 numbers: the root scatters by 0.05
    for over in [f64::sqrt(squares / count), f64::sqrt(own / count)] {
        assert!((0.8..1.2).contains(&over), "{over}");
    }
}

#[test]
fn signs_of_quaternions_mean_nothing_and_bad_frames_are_left_out() {
    let toss = toss(ASYMMETRIC, 20.0, 30.0, 1e-2, 1);
    let plain = fit_poses(&toss.poses(), &Settings::default()).unwrap();
    let mut flipped = toss.measured.clone();
    flipped.iter_mut().step_by(3).for_each(|q| *q = UnitQuaternion::new_unchecked(-q.into_inner()));
    let same = fit_poses(&Poses::new("toss", &toss.times, &flipped).unwrap(), &Settings::default()).unwrap();
    assert!((plain.shape.tensor() - same.shape.tensor()).amax() < 1e-12);
    let mut bad = toss.measured.clone();
    for k in [50, 200, 201, 420] {
        bad[k] *= UnitQuaternion::from_scaled_axis(Vector3::new(0.9, -0.7, 0.4));
    }
    let estimate = fit_poses(&Poses::new("toss", &toss.times, &bad).unwrap(), &Settings::default()).unwrap();
    assert_eq!(estimate.attitudes.as_ref().unwrap().left_out, 4);
    let distance = (plain.shape.tensor() - estimate.shape.tensor()).norm();
    assert!(distance < plain.free_covariance.trace().sqrt(), "{distance:e}");
}

#[test]
fn the_direction_is_told_by_the_motion_and_an_axisymmetric_body_leaves_it_open() {
    let toss = toss(ASYMMETRIC, 10.0, 30.0, 1e-2, 2);
    let expected = fit_poses(&toss.poses(), &Settings::default()).unwrap();
    // claimed and wrong
    let PoseFault::Inverted { inverse, gain } = refused(&toss.poses().inverse()) else { panic!() };
    assert!((inverse[0] - expected.principal[0]).abs() < 1e-9 && gain > 100.0);
    // open
    for (poses, is_inverse) in [(toss.poses(), false), (toss.poses().inverse(), true)] {
        let estimate = fit_poses(&poses.with_open_direction(), &Settings::default()).unwrap();
        let found = estimate.attitudes.unwrap();
        assert_eq!(found.is_inverse, is_inverse);
        assert!(found.direction_gain.unwrap() > 100.0);
        assert!((estimate.shape.tensor() - expected.shape.tensor()).amax() < 1e-9);
    }
    // the inverse motion of an elongated top is that of another one
    let top = self::toss([1.0, 1.6, 1.6], 10.0, 30.0, 1e-2, 3);
    assert!(fit_poses(&top.poses(), &Settings::default()).is_ok());
    let PoseFault::Direction { as_read, inverse, .. } = refused(&top.poses().with_open_direction()) else {
        panic!()
    };
    assert!((as_read[0] - 1.0 / 4.2).abs() < 1e-3, "{as_read:?}");
    assert!((inverse[0] - as_read[0]).abs() > 1e-2, "{inverse:?}");
}

#[test]
fn rates_beside_attitudes_are_aligned_and_both_tell() {
    let toss = toss(ASYMMETRIC, 20.0, 30.0, 1e-2, 4);
    let turn = UnitQuaternion::from_scaled_axis(Vector3::new(0.4, -1.2, 0.7));
    let rates = toss.rates(|_| turn, 0.02);
    let both = Poses::with_rates("toss", &toss.times, &toss.measured, &rates).unwrap();
    let estimate = fit_poses(&both, &Settings::default()).unwrap();
    let found = estimate.attitudes.as_ref().unwrap().alignment.unwrap();
    let off = (turn.inverse() * found.turn).scaled_axis();
    for k in 0..3 {
        assert!(off[k].abs() < 4.0 * found.sigma[k] && found.sigma[k] < 3e-3, "{off} {found:?}");
    }
    assert!((estimate.noise_sigma / 0.02 - 1.0).abs() < 0.1);
    // the tensor is in the axes of the rates
    let r = turn.to_rotation_matrix();
    let expected = r.matrix() * toss.body.tensor() * r.matrix().transpose();
    assert!(distance(&entries(&(estimate.shape.tensor() - expected)), &estimate.free_covariance) < 20.5);
    assert!(found.moving_gain < 12.0 && estimate.warnings.is_empty(), "{:?}", estimate.warnings);
    let alone = fit_poses(&both.without_rates(), &Settings::default()).unwrap();
    assert!(estimate.sigma_principal[0] < alone.sigma_principal[0]);

    let moving =
        toss.rates(|t| turn * UnitQuaternion::from_scaled_axis(Vector3::y() * (0.05 * t / 30.0)), 0.02);
    let moving = Poses::with_rates("toss", &toss.times, &toss.measured, &moving).unwrap();
    let warnings = fit_poses(&moving, &Settings::default()).unwrap().warnings;
    let size = warnings
        .iter()
        .find_map(|w| if let Warning::MovingAxes { turn, .. } = w { Some(*turn) } else { None });
    assert!((size.unwrap() - 0.05).abs() < 0.01, "{size:?}");

    let mirrored: Vec<Vector3<f64>> = rates.iter().map(|w| Vector3::new(-w.x, w.y, w.z)).collect();
    let mirrored = Poses::with_rates("toss", &toss.times, &toss.measured, &mirrored).unwrap();
    assert_eq!(refused(&mirrored), PoseFault::Mirrored);
    assert_eq!(refused(&mirrored.with_open_direction()), PoseFault::Mirrored);
    let broken: Vec<Vector3<f64>> = rates.iter().map(|w| Vector3::new(w.x, w.y, 0.0)).collect();
    let broken = Poses::with_rates("toss", &toss.times, &toss.measured, &broken).unwrap();
    let error = fit_poses(&broken, &Settings::default()).unwrap_err();
    assert!(matches!(error, FitError::HeldAxis { axis: 'z', value: 0.0, .. }), "{error}");
    let degrees: Vec<Vector3<f64>> = rates.iter().map(|w| w.map(f64::to_degrees)).collect();
    let degrees = Poses::with_rates("toss", &toss.times, &toss.measured, &degrees).unwrap();
    let PoseFault::Scale { scale } = refused(&degrees) else { panic!() };
    assert!((scale / 1_f64.to_degrees() - 1.0).abs() < 0.05, "{scale}");
}

/// Two sensors whose axes turn against each other, whichever of them moves: the answer is that of the axes of the rates in the middle, and covered.
#[test]
fn axes_that_turn_against_each_other_are_fitted() {
    let (mut squares, mut count) = (0.0, 0.0);
    for (case, size) in [0.03, 0.1, 0.03, 0.1].into_iter().enumerate() {
        for stream in 40..43 {
            let toss = toss(ASYMMETRIC, 20.0, 30.0, 1e-2, stream + 10 * case as u64);
            let fixed = UnitQuaternion::from_scaled_axis(Vector3::new(0.4, -1.2, 0.7));
            let turned = |t: f64| {
                UnitQuaternion::from_scaled_axis(Vector3::new(0.6, 0.0, 0.8) * (size * (t / 30.0 - 0.5)))
            };
            let is_of_rates = case < 2;
            let rates = toss.rates(|t| if is_of_rates { turned(t) * fixed } else { fixed }, 0.02);
            let measured: Vec<UnitQuaternion<f64>> = toss
                .times
                .iter()
                .zip(&toss.measured)
                .map(|(t, q)| if is_of_rates { *q } else { q * turned(*t) })
                .collect();
            let both = Poses::with_rates("toss", &toss.times, &measured, &rates).unwrap();
            let estimate = fit_poses(&both, &Settings::default()).unwrap();
            let named = estimate.warnings.iter().find_map(|w| match w {
                Warning::MovingAxes { turn, .. } => Some(*turn),
                _ => None,
            });
            let r = fixed.to_rotation_matrix();
            let expected = r.matrix() * toss.body.tensor() * r.matrix().transpose();
            let chi2 = distance(&entries(&(estimate.shape.tensor() - expected)), &estimate.free_covariance);
            println!(
                "{size} {is_of_rates} {stream}: {named:?} chi2 {chi2:.1} {:?}",
                estimate.sigma_principal
            );
            // at 0.03 rad the noise hardly tells which of the two moves
            assert!((0.6..1.5).contains(&(named.unwrap() / size)), "{size}: {named:?}");
            squares += chi2 / 5.0;
            count += 1.0;
            assert!(chi2 < 25.0, "{size} {is_of_rates} {stream}: {chi2}");
        }
    }
    // the mean of twelve chi squared of 5, over 5, scatters by 0.18
    assert!((0.4..1.8).contains(&(squares / count)), "{}", squares / count);
}

/// An offset of rates beside attitudes, or an error of their scale, is named with its size and taken out; neither a torque nor axes that
/// move are named in its place, and the tensor is covered.
#[test]
fn errors_of_rates_beside_attitudes_are_named_and_taken_out() {
    let toss = toss(ASYMMETRIC, 20.0, 30.0, 1e-2, 4);
    let turn = UnitQuaternion::from_scaled_axis(Vector3::new(0.4, -1.2, 0.7));
    let r = turn.to_rotation_matrix();
    let expected = r.matrix() * toss.body.tensor() * r.matrix().transpose();
    let cases: [(f64, f64); 4] = [(0.0, 0.0), (0.02, 0.0), (0.0, 0.05), (0.0, -0.05)];
    for (offset, scale) in cases {
        let constant = Vector3::new(0.6, -0.8, 0.0) * offset;
        let rates: Vec<Vector3<f64>> =
            toss.rates(|_| turn, 0.02).iter().map(|w| w * (1.0 + scale) + constant).collect();
        let both = Poses::with_rates("toss", &toss.times, &toss.measured, &rates).unwrap();
        let e = fit_poses(&both, &Settings::default()).unwrap();
        let is_cause = |w: &&Warning| {
            matches!(
                w,
                Warning::RateOffset { .. }
                    | Warning::RateScale { .. }
                    | Warning::RateResiduals { .. }
                    | Warning::MovingAxes { .. }
                    | Warning::ConstantTorque { .. }
                    | Warning::Torque(_)
            )
        };
        let named: Vec<&Warning> = e.warnings.iter().filter(is_cause).collect();
        match named.as_slice() {
            [] => assert!(offset == 0.0 && scale == 0.0),
            [Warning::RateOffset { size, is_fitted: true, .. }] => {
                // 0.02/sqrt(600) = 8e-4 of each component
                assert!(scale == 0.0 && (size - offset).abs() < 4e-3, "{size}");
            }
            [Warning::RateScale { scale: found, is_fitted: true, .. }] => {
                assert!(offset == 0.0 && (found - scale).abs() < 4e-3, "{found}");
            }
            other => panic!("{offset} {scale}: {other:?}"),
        }
        assert_eq!(e.torque.model, TorqueModel::None);
        let chi2 = distance(&entries(&(e.shape.tensor() - expected)), &e.free_covariance);
        // where the 99.99 % ellipsoid ends
        assert!(chi2 < 25.75, "{offset} {scale}: {chi2}");
    }
}

/// What the motion leaves of rates beside attitudes is compared with the noise that neighbouring rates tell.
#[test]
fn rates_that_the_motion_does_not_explain_are_told() {
    let toss = toss(ASYMMETRIC, 20.0, 30.0, 1e-2, 4);
    let clean = toss.rates(|_| UnitQuaternion::identity(), 0.02);
    // slower than the noise and faster than the body
    let wave = |t: &f64| Vector3::x() * (0.05 * libm::sin(3.0 * t));
    let waved: Vec<Vector3<f64>> = toss.times.iter().zip(&clean).map(|(t, w)| w + wave(t)).collect();
    let told = |rates: &[Vector3<f64>]| {
        let both = Poses::with_rates("toss", &toss.times, &toss.measured, rates).unwrap();
        let e = fit_poses(&both, &Settings::default().with_torque(TorqueModel::None)).unwrap();
        e.warnings.iter().find_map(|w| match w {
            Warning::RateResiduals { times, noise } => Some((*times, *noise)),
            _ => None,
        })
    };
    assert_eq!(told(&clean), None);
    let (times, noise) = told(&waved).unwrap();
    assert!((noise / 0.02 - 1.0).abs() < 0.15, "{noise}");
    // the root of 1 + 0.05^2/6/0.02^2 is 1.43
    assert!((1.25..1.6).contains(&times), "{times}");
}

/// A noise of rates beside attitudes that is stated more than twice as large as theirs is named with theirs, and one that is not is not.
#[test]
fn a_stated_noise_that_rates_beside_attitudes_do_not_have_is_named() {
    let toss = toss(ASYMMETRIC, 20.0, 30.0, 1e-2, 4);
    let rates = toss.rates(|_| UnitQuaternion::identity(), 0.02);
    let both = Poses::with_rates("toss", &toss.times, &toss.measured, &rates).unwrap();
    for (given, is_named) in [(0.02, false), (0.035, false), (0.1, true)] {
        let e = fit_poses(&both, &Settings::default().with_noise(given)).unwrap();
        let found = e.warnings.iter().find_map(|warning| match warning {
            Warning::StatedNoise { stated, shown } => Some((*stated, *shown)),
            _ => None,
        });
        assert_eq!(found.is_some(), is_named, "{given}: {:?}", e.warnings);
        let is_right = |(stated, shown): (f64, f64)| stated == given && (shown / 0.02 - 1.0).abs() < 0.1;
        assert!(found.is_none_or(is_right), "{found:?}");
    }
}

#[test]
fn what_attitudes_do_not_tell_is_refused_with_its_numbers() {
    // half a turn between samples
    let fast: Vec<f64> = (0..40).map(f64::from).collect();
    let spin = |t: &f64| UnitQuaternion::from_scaled_axis(Vector3::z() * 3.0 * *t);
    let measured: Vec<UnitQuaternion<f64>> = fast.iter().map(spin).collect();
    let fault = refused(&Poses::new("spin.csv", &fast, &measured).unwrap());
    let text = fault.to_string();
    assert!(matches!(fault, PoseFault::HalfTurn { sample: 1, step: 1.0, .. }), "{text}");
    assert!(text.contains("3.000 rad"), "{text}");
    assert!(text.contains("3.283 rad"), "{text}");
    // a quaternion of norm zero, as a tracker writes one that sees nothing: normalised it is not finite
    for nothing in [
        UnitQuaternion::from_quaternion(Quaternion::new(0.0, 0.0, 0.0, 0.0)),
        UnitQuaternion::new_unchecked(Quaternion::new(0.0, 0.0, 0.0, 0.0)),
    ] {
        for k in [0, 4] {
            let mut blind = measured.clone();
            blind[k] = nothing;
            let error = Poses::new("spin.csv", &fast, &blind).unwrap_err();
            let PosesError::NoAttitude { sample, .. } = error else { panic!("{error}") };
            assert_eq!(sample, k + 1);
        }
    }
    // no turn at all
    let mut random = Random::new(1);
    let still: Vec<UnitQuaternion<f64>> =
        fast.iter().map(|_| Quat::exponential(Vec3::from(random.normal_vector() * 1e-2)).into()).collect();
    assert!(matches!(refused(&Poses::new("still", &fast, &still).unwrap()), PoseFault::NoTurn { .. }));
    // a steady spin tells its axis, whatever the noise makes of it
    for noise in [0.0, 1e-9, 1e-4, 1e-2] {
        let motion = FreeMotion::from_omega(
            &Inertia::from_moments(ASYMMETRIC).unwrap(),
            UnitQuaternion::identity(),
            Vector3::new(0.0, 0.0, 1.0),
        );
        let times: Vec<f64> = (0..600).map(|i| 0.05 * f64::from(i)).collect();
        let measured = attitudes(&motion.unwrap(), &times, noise, &mut random);
        let poses = Poses::new("spin", &times, &measured).unwrap();
        for poses in [poses.clone(), poses.with_open_direction()] {
            let refused = fit_poses(&poses, &Settings::default());
            let is_right = matches!(&refused, Err(FitError::Unidentifiable(what)) if what.rank == 2);
            assert!(is_right, "{noise}: {:?}", refused.err().map(|error| error.to_string()));
        }
    }
    // too few
    let toss = toss(ASYMMETRIC, 1.0, 5.0, 1e-3, 5);
    let error = fit_poses(&toss.poses(), &Settings::default()).unwrap_err();
    let FitError::TooFewSamples { needed, .. } = error else { panic!("{error}") };
    // and just enough
    let motion = FreeMotion::from_omega(&toss.body, UnitQuaternion::identity(), Vector3::new(0.3, 1.0, 0.4));
    let times: Vec<f64> = (0..needed).map(|i| i as f64).collect();
    let measured = attitudes(&motion.unwrap(), &times, 1e-6, &mut random);
    fit_poses(&Poses::new("few", &times, &measured).unwrap(), &Settings::default()).unwrap();
}

/// Attitudes five times a second of a telephone that turns by 9 rad/s look like noise to their neighbours, and are not said to stand still;
/// where their noise is stated they tell the tensor.
#[test]
fn attitudes_that_are_far_apart_are_no_body_at_rest() {
    let body = Inertia::from_moments([0.97, 4.05, 5.0]).unwrap();
    let motion =
        FreeMotion::from_omega(&body, UnitQuaternion::identity(), Vector3::new(1.0, 9.0, 2.0)).unwrap();
    let times: Vec<f64> = (0..=10).map(|k| 0.2 * f64::from(k)).collect();
    let measured = attitudes(&motion, &times, 5e-3, &mut Random::new(3));
    let poses = Poses::new("phone", &times, &measured).unwrap();
    let fault = refused(&poses);
    let PoseFault::FarApart { turn, all } = fault else { panic!("{fault}") };
    assert!((1.8..2.3).contains(&turn) && all > 1.8, "{turn} {all}");
    let e = fit_poses(&poses, &Settings::default().with_attitude_noise(5e-3)).unwrap();
    assert!((e.ratios[0] - 0.97 / 5.0).abs() < 5.0 * e.sigma_ratios[0] && e.sigma_ratios[0] < 0.01);
}

/// What attitudes at given times tell of a motion does not depend on when the clock was started.
#[test]
fn the_bound_knows_no_origin_of_time() {
    let body = Inertia::from_moments(ASYMMETRIC).unwrap();
    let bound = |start: f64| {
        let times: Vec<f64> = (0..200).map(|i| start + 0.1 * f64::from(i)).collect();
        foreseen_attitude_bound(&body, Vector3::new(0.3, 1.0, 0.4), &times, 0.01).unwrap()
    };
    let (one, other) = (bound(0.0), bound(7.0));
    assert!((one - other).norm() < 1e-9 * one.norm(), "{one}{other}");
}

#[test]
fn several_segments_share_the_tensor_and_the_noise_may_be_given() {
    let tosses: Vec<Toss> = (0..3)
        .map(|k| {
            let mut one = toss(ASYMMETRIC, 50.0, 4.0, 5e-3, 60);
            let mut random = Random::new(90 + k);
            let omega = random.normal_vector() * 3.0;
            one.motion = FreeMotion::from_omega(&one.body, UnitQuaternion::identity(), omega).unwrap();
            one.measured = attitudes(&one.motion, &one.times, 5e-3, &mut random);
            one
        })
        .collect();
    let all = tosses.iter().map(Toss::poses).reduce(Poses::join).unwrap();
    let estimate = fit_poses(&all, &Settings::default()).unwrap();
    assert_eq!((estimate.segments, estimate.per_segment.len()), (3, 3));
    assert!((estimate.per_segment.iter().map(|s| s.weight).sum::<f64>() - 1.0).abs() < 1e-12);
    assert!(
        estimate.per_segment.iter().all(|s| s.without.is_some_and(|w| w.shift > 0.0 && w.shift < 20.0)),
        "{:?}",
        estimate.per_segment
    );
    let off = entries(&(estimate.shape.tensor() - tosses[0].body.tensor()));
    assert!(distance(&off, &estimate.free_covariance) < 20.5);
    // twice the noise that there is: twice the deviations
    let given = fit_poses(&all, &Settings::default().with_attitude_noise(1e-2)).unwrap();
    assert!((given.sigma_principal[0] / estimate.sigma_principal[0] - 2.0).abs() < 0.1);
    assert!((given.chi2_per_dof - 0.25).abs() < 0.03, "{}", given.chi2_per_dof);
    // a momentum that they do not share gives no size
    let known = Settings::default().with_known(Known::Momentum(2.0));
    let momentum = |t: &Toss| t.body.momentum(t.motion.omega_at(0.0).unwrap()).norm();
    let momenta: Vec<f64> = tosses.iter().map(momentum).collect();
    match fit_poses(&all, &known) {
        Err(FitError::SizeDiffers { factor, largest, smallest, .. }) => {
            let expected = momenta[largest] / momenta[smallest];
            assert!((factor / expected - 1.0).abs() < 0.02, "{factor} {expected}");
        }
        other => panic!("{:?}", other.map(|estimate| estimate.principal)),
    }
    // one that they share does
    let share = |(k, toss): (usize, &Toss)| {
        let omega = toss.motion.omega_at(0.0).unwrap() * (1.6 / momenta[k]);
        let motion = FreeMotion::from_omega(&toss.body, UnitQuaternion::identity(), omega).unwrap();
        let measured = attitudes(&motion, &toss.times, 5e-3, &mut Random::new(95 + k as u64));
        Poses::new("toss", &toss.times, &measured).unwrap()
    };
    let shared = tosses.iter().enumerate().map(share).reduce(Poses::join).unwrap();
    let trace = fit_poses(&shared, &known).unwrap().inertia.unwrap().tensor().trace();
    assert!((trace / (2.0 / 1.6) - 1.0).abs() < 1e-2, "{trace}");
}

/// Torques of a body that also has a free motion: what the fit makes of each.
#[test]
fn torques_are_reckoned_with_in_closed_form_where_there_is_one() {
    let body = Inertia::from_moments([0.2, 0.35, 0.45]).unwrap();
    let times: Vec<f64> = (0..300).map(|i| f64::from(i) / 10.0).collect();
    let poses = |acting: Disturbances, stream: u64| {
        let (omega, mut random) = (Vector3::new(0.3, 1.0, 0.4), Random::new(8).stream(stream));
        let gyroscope = Gyroscope::default();
        let read = simulate_poses(&body, omega, &times, &acting, &gyroscope, 3.5e-3, &mut random).unwrap();
        Poses::new("torque", &times, &read.attitudes).unwrap()
    };
    let distance = |e: &Estimate| distance(&entries(&(e.shape.tensor() - body.tensor())), &e.free_covariance);
    let settings = Settings::default();
    for (k, drag) in [1e-4, 1e-2, 5e-2].into_iter().enumerate() {
        let slowed = poses(Disturbances::default().with_relative_drag(drag), k as u64);
        let e = fit_poses(&slowed, &settings).unwrap();
        assert_eq!(e.torque.model, TorqueModel::Drag, "{drag}");
        let found = &e.torque.coefficients[0];
        assert!((found.value - drag).abs() < 4.0 * found.sigma && found.sigma < 5e-5, "{found:?}");
        assert!(distance(&e) < 20.5 && e.warnings.iter().any(|w| matches!(w, Warning::Torque(_))));
        let named: Vec<TorqueModel> = e.models.iter().map(|one| one.model).collect();
        assert!(named.starts_with(&[TorqueModel::None, TorqueModel::Drag]), "{named:?}");
        assert!((e.models.iter().map(|one| one.share).sum::<f64>() - 1.0).abs() < 1e-12);
        let [none, own] = [&e.models[0], &e.models[1]];
        assert!(none.gain == 0.0 && own.gain > 5.0 && own.share > none.share, "{drag}: {own:?}");
        // the direction is told with drag too
        if drag == 5e-2 {
            let PoseFault::Inverted { .. } = refused(&slowed.inverse()) else { panic!() };
        }
    }
    let torque = Vector3::new(3e-5, -2e-5, 1e-5);
    let e = fit_poses(&poses(Disturbances::default().with_torque(torque), 5), &settings).unwrap();
    assert_eq!(e.torque.model, TorqueModel::Constant);
    for (k, found) in e.torque.coefficients.iter().enumerate() {
        assert!((found.value - torque[k]).abs() < 4.0 * found.sigma, "{found:?}");
    }
    assert!(distance(&e) < 20.5, "{}", distance(&e));
    // too large for the first order, and torques at random: by filter and smoother
    let large = fit_poses(&poses(Disturbances::default().with_torque(torque * 300.0), 6), &settings).unwrap();
    assert_eq!((large.method, large.torque.model), (Method::Smoother, TorqueModel::Constant));
    for (k, found) in large.torque.coefficients.iter().enumerate() {
        assert!((found.value - 300.0 * torque[k]).abs() < 4.0 * found.sigma, "{found:?}");
    }
    assert!(distance(&large) < 20.5, "{}", distance(&large));
    let noisy = fit_poses(&poses(Disturbances::default().with_torque_noise(3e-3), 6), &settings).unwrap();
    assert!(distance(&noisy) < 20.5, "{}", distance(&noisy));
    assert!(noisy.warnings.iter().any(|w| matches!(w, Warning::TorqueNoise { .. })), "{:?}", noisy.warnings);
    let free = poses(Disturbances::default(), 7);
    // a model that was asked for leaves the others out of its deviations
    let chosen = fit_poses(&free, &settings).unwrap();
    let asked = fit_poses(&free, &settings.clone().with_torque(TorqueModel::None)).unwrap();
    assert_eq!((chosen.models.len(), &chosen.models), (3, &asked.models));
    let wider = chosen.free_covariance.trace() / asked.free_covariance.trace();
    assert!(wider > 1.0 && wider < 2.0, "{wider}");
    let other = fit_poses(&free, &settings.with_torque(TorqueModel::Drag3)).unwrap();
    assert_eq!((other.method, other.torque.coefficients.len()), (Method::Smoother, 3));
    assert!(distance(&other) < 20.5, "{}", distance(&other));
}

/// A body with random axes that spins nearly about one of its own, and noisy attitudes of it: the bound, and by how much an answer
/// errs over its stated ellipsoid.
fn spin(
    moments: [f64; 3],
    (axis, tilt): (usize, f64),
    noise: f64,
    stream: u64,
) -> (f64, Result<f64, FitError>) {
    let mut random = Random::new(78).stream(stream);
    let body = body(moments, &mut random);
    let axes = body.principal_axes().to_rotation_matrix();
    let across = axes * Vector3::ith((axis + 1) % 3, 1.0);
    let omega = axes * Vector3::ith(axis, libm::cos(tilt)) + across * libm::sin(tilt);
    let times: Vec<f64> = (0..=72).map(|i| f64::from(i) / 6.0).collect();
    let motion = FreeMotion::from_omega(&body, UnitQuaternion::identity(), omega).unwrap();
    let measured = attitudes(&motion, &times, noise, &mut random);
    let bound =
        foreseen_attitude_bound(&body, omega, &times, noise).map_or(f64::INFINITY, |b| b.trace().sqrt());
    let found = fit_poses(&Poses::new("spin", &times, &measured).unwrap(), &Settings::default());
    (bound, found.map(|e| distance(&entries(&(e.shape.tensor() - body.tensor())), &e.free_covariance)))
}

/// Two turns of a body that spins nearly about its first or third axis: its likelihood has valleys that bend, and maxima that are not the
/// highest.
#[test]
#[ignore = "an ensemble: takes seconds, `.ci/run` does it"]
fn near_steady_spins_are_answered_rightly_or_refused() {
    let bodies = [ASYMMETRIC, [1.0, 2.0, 2.1], [1.0, 2.0, 3.0], [1.0, 3.0, 3.3], [1.0, 1.1, 2.0]];
    let (mut answered, mut known) = (0, 0);
    for k in (0..100).step_by(2) {
        let moments = bodies[k % 5];
        let axis = [0, 2][k / 5 % 2];
        let tilt = [2.0_f64, 4.0, 8.0, 16.0, 6.0][k / 10 % 5].to_radians();
        let noise = [0.5_f64, 2.0][k / 50].to_radians();
        let (bound, found) = spin(moments, (axis, tilt), noise, k as u64);
        known += usize::from(bound < 0.02);
        match found {
            Ok(square) => {
                // where the 99.9 % ellipsoid ends
                assert!(square < 20.5, "{k}: {square}");
                answered += 1;
            }
            Err(error) => {
                assert!(bound > 0.02, "{k}: {bound} {error}");
                assert!(
                    matches!(error, FitError::Unidentifiable(_) | FitError::Poses(PoseFault::Unsettled)),
                    "{k}: {error}"
                );
            }
        }
    }
    assert!(answered >= known && known > 15, "{answered} {known}");
    // a record on which a search of forty steps stopped short of the maximum, at 0.046 for a moment of 0.196
    let mut random = Random::new(401_600).stream(17 << 32 | 2);
    let body = body([1.0, 2.0, 2.1], &mut random);
    let omega = random.normal_vector().normalize();
    let times: Vec<f64> = (0..=2400).map(|i| f64::from(i) / 200.0).collect();
    let motion = FreeMotion::from_omega(&body, UnitQuaternion::identity(), omega).unwrap();
    let measured = attitudes(&motion, &times, 2.0_f64.to_radians(), &mut random);
    let e = fit_poses(&Poses::new("spin", &times, &measured).unwrap(), &Settings::default()).unwrap();
    let off = distance(&entries(&(e.shape.tensor() - body.tensor())), &e.free_covariance);
    assert!(off < 20.5 && e.sigma_principal[0] < 0.01, "{off} {:?}", e.principal);
}

/// A constant torque that the first order does not reach, and that is not large enough to refuse the record.
#[test]
fn a_constant_torque_that_is_left_out_is_named() {
    let body = Inertia::from_moments([0.2, 0.35, 0.45]).unwrap();
    let times: Vec<f64> = (0..90).map(|i| f64::from(i) / 3.0).collect();
    let poses = |torque: Vector3<f64>, stream: u64| {
        let (omega, mut random) = (Vector3::new(0.3, 1.0, 0.4), Random::new(9).stream(stream));
        let acting = Disturbances::default().with_torque(torque);
        let read = simulate_poses(&body, omega, &times, &acting, &Gyroscope::default(), 0.1, &mut random);
        Poses::new("torque", &times, &read.unwrap().attitudes).unwrap()
    };
    let named = |e: &Estimate| e.warnings.iter().any(|w| matches!(w, Warning::ConstantTorque { .. }));
    // of gains about the threshold, and once of a torque that is told to be none
    let torque = |k: u64| Vector3::new(3e-4, -2e-4, 1e-4) * (1.0 + 0.25 * k as f64);
    let answer = |k: u64| fit_poses(&poses(torque(k), k), &Settings::default()).unwrap();
    let left_out: Vec<Estimate> =
        (4..10).map(answer).filter(|e| e.torque.model == TorqueModel::None).collect();
    // a third of these is fitted by filter and smoother
    assert_eq!(left_out.iter().filter(|e| named(e)).count(), 2);
    let e = fit_poses(&poses(torque(8), 8), &Settings::default().with_torque(TorqueModel::None)).unwrap();
    // filter and smoother, which take over where a record is not that of a free body, tell it as torque noise
    assert!(e.warnings.iter().any(|w| matches!(w, Warning::TorqueNoise { .. })), "{:?}", e.warnings);
}

/// A segment of few attitudes has no motion of its own: it is left out, and the report says so.
#[test]
fn a_segment_of_few_attitudes_is_told() {
    let poses = toss(ASYMMETRIC, 10.0, 30.0, 0.005, 1).poses();
    let cut = poses.windows(&[(0.0, 25.0), (26.0, 26.5)]).unwrap();
    assert_eq!(cut.segments()[1].times().len(), 6);
    let e = fit_poses(&cut, &Settings::default()).unwrap();
    let short = Warning::ShortSegments { short: 1, segments: 2 };
    assert!(e.segments == 1 && e.warnings.contains(&short), "{:?}", e.warnings);
    let whole = fit_poses(&poses, &Settings::default()).unwrap();
    assert!(!whole.warnings.iter().any(|warning| matches!(warning, Warning::ShortSegments { .. })));
}

/// A noise that is stated more than twice as large as what the motion leaves and neighbouring attitudes show is named with it; one that
/// would hide the turn is refused with it.
#[test]
fn a_stated_noise_that_the_attitudes_do_not_have_is_named() {
    let poses = toss(ASYMMETRIC, 10.0, 30.0, 0.005, 1).poses();
    let of = |stated: f64| fit_poses(&poses, &Settings::default().with_attitude_noise(stated));
    for (given, is_named) in [(0.005, false), (0.008, false), (0.02, true)] {
        let e = of(given).unwrap();
        let found = e.warnings.iter().find_map(|warning| match warning {
            Warning::StatedAttitudeNoise { stated, shown } => Some((*stated, *shown)),
            _ => None,
        });
        assert_eq!(found.is_some(), is_named, "{given}: {:?}", e.warnings);
        let is_right = |(stated, shown): (f64, f64)| stated == given && (shown / 0.005 - 1.0).abs() < 0.1;
        assert!(found.is_none_or(is_right), "{found:?}");
    }
    let refused = of(2.0).unwrap_err();
    let FitError::Poses(PoseFault::StatedNoise { stated, shown }) = refused else { panic!("{refused}") };
    assert!(stated == 2.0 && (shown / 0.005 - 1.0).abs() < 0.2, "{shown}");
}

/// Noise of rates has no meaning where there are none.
#[test]
fn noise_of_rates_that_are_not_there_is_refused() {
    let toss = toss(ASYMMETRIC, 10.0, 30.0, 0.005, 1);
    let settings = Settings::default().with_noise(0.02);
    let refused = fit_poses(&toss.poses(), &settings);
    let named = |fault: &PoseFault| matches!(fault, PoseFault::OnlyRates { name } if name.contains("noise"));
    assert!(matches!(&refused, Err(FitError::Poses(fault)) if named(fault)), "{refused:?}");
    let rates = toss.rates(|_| UnitQuaternion::identity(), 0.02);
    let both = Poses::with_rates("both", &toss.times, &toss.measured, &rates).unwrap();
    assert!(fit_poses(&both, &settings).is_ok());
}

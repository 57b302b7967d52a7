//! Motions nearest to samples and their sensitivities, beside simulated motions and plain sums.

use nalgebra::{Matrix3, SMatrix, Vector3};
use polhode::inertia::Inertia;
use polhode::num::Random;
use polhode::rotation::{Quat, Vec3};

use crate::bound::attitudes::foreseen_attitude_bound;
use crate::bound::motions::{Motions, foreseen_bound};
use crate::bound::nearest_motion::nearest_motion;
use crate::bound::planned::foreseen_bound_with;
use crate::bound::sensitivity::{Euler, Sensitivity, Start, of_tensor};
use crate::likelihood::motion::{self, Motion};
use crate::physical::coordinates::{coordinates, entries_of_coordinates, tensor};
use crate::physical::prior::Prior;
use crate::settings::Settings;
use crate::settings::torque::TorqueModel;
use crate::signal::stretch::Stretch;
use crate::simulate::simulate;

fn body() -> Matrix3<f64> {
    Matrix3::new(0.2, 0.01, -0.02, 0.01, 0.35, 0.03, -0.02, 0.03, 0.45)
}

fn start() -> Vector3<f64> {
    Vector3::new(0.5, 0.8, -0.4)
}

fn samples(times: Vec<f64>, sigma: f64) -> Stretch {
    let rates = simulate(&Inertia::from_tensor(body()).unwrap(), start(), &times, sigma, &mut Random::new(2));
    Stretch::new(times, rates.unwrap())
}

/// The nearest motion leaves the noise and starts where the samples do, also with a third of the rate as noise; no motion of another
/// body is taken for one of these.
#[test]
fn the_nearest_motion_is_the_one_that_was_simulated() {
    let euler = Euler::new(body()).unwrap();
    for (step, sigma) in [(0.02, 1e-3), (0.1, 1e-3), (0.02, 0.3)] {
        let times: Vec<f64> = (0..1500).map(|k| step * f64::from(k)).collect();
        let s = samples(times, sigma);
        let (found, left) = nearest_motion(&euler, &s, sigma * sigma).unwrap();
        // 4497 components beyond the start: to √(2/4497) = 0.02
        assert!((left / (4497.0 * sigma * sigma) - 1.0).abs() < 0.1, "{step} {sigma}: {left:e}");
        let exact = simulate(
            &Inertia::from_tensor(body()).unwrap(),
            start(),
            &[found.time],
            0.0,
            &mut Random::new(1),
        );
        let apart = (found.rate - exact.unwrap()[0]).norm();
        assert!(apart < 5.0 * sigma * (3.0 / 1500.0_f64).sqrt() * 3.0, "{step} {sigma}: {apart:e}");
        let motions =
            Motions::nearest(core::slice::from_ref(&s), &coordinates(&body()), sigma * sigma).unwrap();
        assert!((motions.left.0 - left / 4497.0 / (sigma * sigma)).abs() < 1e-9 && motions.left.1 == 4497.0);
    }
    let times: Vec<f64> = (0..1500).map(|k| 0.05 * f64::from(k)).collect();
    let other = tensor(
        &(coordinates(&body()) + coordinates(&Matrix3::from_diagonal(&Vector3::new(0.09, -0.09, 0.0)))),
    );
    assert!(nearest_motion(&Euler::new(other).unwrap(), &samples(times, 1e-3), 1e-6).is_none());
}

/// A motion may leave a twentieth of how the samples vary, whatever noise is stated: noise of 3 % of it is left, noise of 8 % is not.
#[test]
fn a_motion_may_leave_a_twentieth_of_the_variation() {
    let euler = Euler::new(body()).unwrap();
    let times: Vec<f64> = (0..1500).map(|k| 0.02 * f64::from(k)).collect();
    let exact = samples(times.clone(), 0.0).rates;
    let mean = exact.iter().sum::<Vector3<f64>>() / 1500.0;
    let variation: f64 = exact.iter().map(|w| (w - mean).norm_squared()).sum();
    let mut random = Random::new(7);
    for (share, is_left) in [(0.03, true), (0.08, false)] {
        // of 4500 components: the share itself scatters by √(2/4500) of it
        let sigma = (share / (1.0 - share) * variation / 4500.0).sqrt();
        let rates = exact.iter().map(|w| w + random.normal_vector() * sigma).collect();
        let s = Stretch::new(times.clone(), rates);
        assert_eq!(nearest_motion(&euler, &s, 1e-12).is_some(), is_left, "{share}");
    }
}

/// Of a steady spin nothing varies but the noise, of which five deviations of the sum of its squares may be left, and a twentieth of what
/// is beyond: with 4500 components a ninth of them.
#[test]
fn a_steady_spin_may_leave_five_deviations_of_the_noise() {
    let euler = Euler::new(Matrix3::from_diagonal(&Vector3::new(0.2, 0.35, 0.45))).unwrap();
    let times: Vec<f64> = (0..1500).map(|k| 0.02 * f64::from(k)).collect();
    for (beyond, is_left) in [(0.09, true), (0.13, false)] {
        // to and fro, so that no motion follows it
        let size = 1e-2 * f64::sqrt(1.0 + beyond);
        let off = |k: usize| Vector3::repeat(if k.is_multiple_of(2) { size } else { -size });
        let s = Stretch::new(times.clone(), (0..1500).map(|k| Vector3::z() + off(k)).collect());
        assert_eq!(nearest_motion(&euler, &s, 1e-4).is_some(), is_left, "{beyond}");
    }
}

/// Dense samples within a step of the integrator count by their cubics as by themselves, before the start and after it.
#[test]
fn the_information_of_dense_samples_is_the_sum_over_them() {
    let euler = Euler::new(body()).unwrap();
    let mut random = Random::new(6);
    let mut times = vec![0.0];
    for k in 0..800 {
        times.push(times[k] + random.between(0.002, 0.02));
    }
    for place in [0, 300, 800] {
        let start = Start { time: times[place], rate: start() };
        let mut expected = SMatrix::<f64, 8, 8>::zeros();
        let mut seen = vec![0; times.len()];
        euler.sweep(&times, &start, |k, _, s: &Sensitivity<8>| {
            expected += s.transpose() * s;
            seen[k] += 1;
        });
        assert!(seen.iter().all(|count| *count == 1));
        let found = euler.information(&times, &start);
        assert!(
            (found - expected).amax() < 1e-4 * expected.amax(),
            "{place}: {:e}",
            (found - expected).amax() / expected.amax()
        );
        // the start is taken out as the inverse of the block of the inverse
        let covariance = expected.try_inverse().unwrap().fixed_view::<5, 5>(0, 0).into_owned();
        let own = of_tensor(&expected).unwrap();
        assert!((own * covariance - SMatrix::<f64, 5, 5>::identity()).amax() < 1e-6);
    }
}

/// Sensitivities are differences of motions, after the start and before it.
#[test]
fn sensitivities_are_those_of_differences() {
    let times = [-4.0, -1.0, 0.5, 3.0];
    let here = Start { time: 0.0, rate: start() };
    let rates = |j: Matrix3<f64>, rate: Vector3<f64>| {
        simulate(&Inertia::from_tensor(j).unwrap(), rate, &times, 0.0, &mut Random::new(1)).unwrap()
    };
    let h = 1e-5;
    Euler::new(body()).unwrap().sweep(&times, &here, |i, w, s: &Sensitivity<8>| {
        assert!((w - rates(body(), start())[i]).norm() < 1e-6);
        for k in 0..8 {
            let moved = |by: f64| {
                let (mut x, mut rate) = (coordinates(&body()), start());
                if k < 5 {
                    x[k] += by
                } else {
                    rate[k - 5] += by
                }
                rates(tensor(&x), rate)[i]
            };
            let slope = (moved(h) - moved(-h)) / (2.0 * h);
            assert!((slope - s.column(k)).amax() < 1e-5 * (1.0 + slope.amax()), "{i} {k}");
        }
    });
}

/// Two stretches tell twice as much as one, of a noise of twice the deviation a quarter; what has fewer than five samples is not asked.
#[test]
fn the_information_of_motions_adds_up() {
    let times: Vec<f64> = (0..300).map(|k| 0.05 * f64::from(k)).collect();
    let s = samples(times, 1e-3);
    let x = coordinates(&body());
    let one = Motions::nearest(core::slice::from_ref(&s), &x, 1e-6).unwrap();
    let bound = one.bound(1e-6).unwrap();
    assert!((one.bound(4e-6).unwrap() - bound * 4.0).amax() < 1e-9 * bound.amax());
    let jumps = vec![Vector3::x(), Vector3::z(), Vector3::y(), Vector3::x()];
    let few = Stretch::new(vec![0.0, 1.0, 2.0, 3.0], jumps);
    let three = [s.clone(), few, s.clone()];
    let both = Motions::nearest(&three, &x, 1e-6).unwrap();
    assert!((both.bound(1e-6).unwrap() * 2.0 - bound).amax() < 1e-9 * bound.amax());
    assert!(both.left.1 == 2.0 * one.left.1 && one.left.1 == 3.0 * 299.0);
    assert!((both.left.0 / one.left.0 - 1.0).abs() < 1e-9);
    let five = [samples((0..5).map(|k| 0.1 * f64::from(k)).collect(), 1e-3)];
    assert_eq!(Motions::nearest(&five, &x, 1e-6).unwrap().left.1, 12.0);
}

/// What a sum over the motion shares with the coordinates, their starts taken out, times the covariance of these, is the part of the
/// coordinates in the step that the sum makes of all eight.
#[test]
fn what_is_shared_is_the_part_of_the_coordinates() {
    let times: Vec<f64> = (0..300).map(|k| 0.05 * f64::from(k)).collect();
    let s = samples(times, 1e-3);
    let x = coordinates(&body());
    let euler = Euler::new(tensor(&x)).unwrap();
    let (start, _) = nearest_motion(&euler, &s, 1e-6).unwrap();
    let m = body() * body();
    let (mut information, mut sum) = (SMatrix::<f64, 8, 8>::zeros(), SMatrix::<f64, 8, 1>::zeros());
    euler.sweep(&s.times, &start, |_, w, s: &Sensitivity<8>| {
        information += s.transpose() * s;
        sum += s.transpose() * (m * w) * 2.0;
    });
    let inverse = information.try_inverse().unwrap();
    let expected = (inverse * sum).fixed_rows::<5>(0).into_owned();
    let motions = Motions::nearest(core::slice::from_ref(&s), &x, 1e-6).unwrap();
    let shared = motions.shared(&m).unwrap();
    let found = inverse.fixed_view::<5, 5>(0, 0) * shared;
    assert!((found - expected).amax() < 1e-7 * expected.amax(), "{found} {expected}");
    let two = [s.clone(), s.clone()];
    let both = Motions::nearest(&two, &x, 1e-6).unwrap().shared(&m).unwrap();
    assert!((both - shared * 2.0).amax() < 1e-9 * shared.amax());
}

/// What a planned record tells depends on no unit of time, on no zero of it, on no size of the body, and on the noise by its square.
#[test]
fn plans_have_no_units() {
    let body = Inertia::from_tensor(body()).unwrap();
    let large = Inertia::from_tensor(body.tensor() * 8.0).unwrap();
    let times: Vec<f64> = (0..200).map(|k| 0.1 * f64::from(k)).collect();
    let (late, fast): (Vec<f64>, Vec<f64>) = times.iter().map(|t| (t + 7.0, 0.5 * t)).unzip();
    let settings = Settings::default().with_torque(TorqueModel::Drag);
    type Plan<'a> = &'a dyn Fn(&Inertia, f64, &[f64], f64) -> SMatrix<f64, 6, 6>;
    // twice as fast with twice the drag; the noise of attitudes is an angle
    let plain = |body: &Inertia, speed: f64, times: &[f64], sigma: f64| {
        foreseen_bound(body, start() * speed, times, sigma * speed).unwrap()
    };
    let with_drag = |body: &Inertia, speed: f64, times: &[f64], sigma: f64| {
        let drag = [0.02 * speed];
        foreseen_bound_with(body, start() * speed, times, sigma * speed, &settings, &drag).unwrap()
    };
    let of_attitudes = |body: &Inertia, speed: f64, times: &[f64], sigma: f64| {
        foreseen_attitude_bound(body, start() * speed, times, sigma).unwrap()
    };
    let plans: [Plan<'_>; 3] = [&plain, &with_drag, &of_attitudes];
    for (k, plan) in plans.into_iter().enumerate() {
        let bound = plan(&body, 1.0, &times, 1e-3);
        for (name, other) in [
            ("zero", plan(&body, 1.0, &late, 1e-3)),
            ("time", plan(&body, 2.0, &fast, 1e-3)),
            ("size", plan(&large, 1.0, &times, 1e-3)),
            ("noise", plan(&body, 1.0, &times, 2e-3) * 0.25),
        ] {
            let apart = (other - bound).amax() / bound.amax();
            assert!(apart < 1e-6, "{k} {name}: {apart:e}");
        }
        // the trace is 1 and known
        assert!(bound.fixed_view::<3, 3>(0, 0).sum().abs() < 1e-9 * bound.amax(), "{k}");
    }
}

/// What attitudes tell is that of differences of motions through one attitude and rate in the middle of them.
#[test]
fn the_bound_of_attitudes_is_that_of_differences() {
    let (rate, sigma, h) = (start() * 1.5, 0.02, 1e-5);
    let times: Vec<f64> = (0..60).map(|k| 3.0 + 0.2 * f64::from(k)).collect();
    let middle = 0.5 * (times[0] + times[59]);
    let moved = |k: usize, by: f64| {
        let (mut x, mut turn, mut rate) = (coordinates(&body()), Vector3::<f64>::zeros(), rate);
        match k {
            0..5 => x[k] += by,
            5..8 => turn[k - 5] += by,
            _ => rate[k - 8] += by,
        }
        let attitude = Quat::exponential(Vec3::from(turn));
        Motion::new(&x, &motion::Start { attitude, rate }, 0.0).unwrap()
    };
    let pairs: [(Motion, Motion); 11] = core::array::from_fn(|k| (moved(k, h), moved(k, -h)));
    let mut information = SMatrix::<f64, 11, 11>::zeros();
    for t in &times {
        let at = |motion: &Motion| motion.at(t - middle).unwrap().attitude;
        let slopes = pairs.each_ref().map(|(above, below)| {
            let turn: Vector3<f64> = (at(below).conjugate() * at(above)).logarithm().into();
            turn / (2.0 * h)
        });
        let rows = SMatrix::<f64, 3, 11>::from_columns(&slopes);
        information += rows.tr_mul(&rows) / (sigma * sigma);
    }
    let bound = information.try_inverse().unwrap().fixed_view::<5, 5>(0, 0).into_owned();
    let expected = entries_of_coordinates() * bound * entries_of_coordinates().transpose();
    let inertia = Inertia::from_tensor(body() * 3.0).unwrap();
    let found = foreseen_attitude_bound(&inertia, rate, &times, sigma).unwrap();
    let apart = (found - expected).amax() / expected.amax();
    assert!(apart < 1e-3, "{apart:e}");
}

/// With a drag of zero among the unknowns no number of the tensor is known better; with a close prior they are known as by that.
#[test]
fn more_unknowns_tell_less_and_a_prior_more() {
    let body = Inertia::from_tensor(body()).unwrap();
    let times: Vec<f64> = (0..200).map(|k| 0.1 * f64::from(k)).collect();
    let of = |settings: &Settings, coefficients: &[f64]| {
        foreseen_bound_with(&body, start(), &times, 1e-3, settings, coefficients)
    };
    let plain = of(&Settings::default(), &[]).unwrap();
    let drag = Settings::default().with_torque(TorqueModel::Drag);
    let with_drag = of(&drag, &[0.0]).unwrap();
    assert!(with_drag.trace() > plain.trace());
    for k in 0..6 {
        assert!(with_drag[(k, k)] >= plain[(k, k)] * (1.0 - 1e-9), "{k}");
    }
    // a prior that knows a thousand times as much is all that is known
    let sigma = 1e-3 * plain.diagonal().min().sqrt();
    let prior = Prior::new(body.tensor(), SMatrix::identity() * (sigma * sigma));
    let held = of(&drag.clone().with_prior(prior.shape_only()), &[0.0]).unwrap();
    // of the trace, which varies too, the entries off the diagonal are hardly a part
    for k in 3..6 {
        assert!((held[(k, k)] / (sigma * sigma) - 1.0).abs() < 0.2, "{k}: {}", held[(k, k)]);
    }
    assert!(of(&drag, &[]).is_none() && of(&Settings::default(), &[0.0]).is_none());
}

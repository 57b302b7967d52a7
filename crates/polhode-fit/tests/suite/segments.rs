//! What the segments of a record say, each left out in turn: beside a fit of the others by themselves.

use nalgebra::{UnitQuaternion, Vector3};
use polhode::FreeMotion;
use polhode::inertia::Inertia;
use polhode::num::Random;
use polhode_fit::{Estimate, Poses, Record, Settings, TorqueModel, TorqueNoise, fit, fit_poses, simulate};

const MOMENTS: [f64; 3] = [1.0, 2.0, 2.6];

/// The answer without a segment is that of the others, as far as their noise and the rounds of both fits are alike.
fn agrees(all: &Estimate, k: usize, others: &Estimate) {
    let without = all.per_segment[k].without.unwrap();
    for i in 0..2 {
        let (sigma, of_others) = (without.sigma_ratios[i], others.sigma_ratios[i]);
        let apart = (without.ratios[i] - others.ratios[i]).abs();
        assert!(apart < 0.1 * of_others, "{k}: {without:?} {:?} +- {:?}", others.ratios, others.sigma_ratios);
        assert!((sigma / of_others - 1.0).abs() < 0.1, "{k}: {without:?} {:?}", others.sigma_ratios);
        // the others alone know less than all together
        assert!(sigma > all.sigma_ratios[i], "{k}");
    }
    assert!(without.shift > 0.0 && without.shift < 20.0, "{without:?}");
}

fn starts() -> Vec<Vector3<f64>> {
    let mut random = Random::new(17);
    (0..4).map(|_| random.normal_vector().normalize() * 8.0).collect()
}

#[test]
fn rates_without_a_segment_are_those_of_the_others() {
    let body = Inertia::from_moments(MOMENTS).unwrap();
    let times: Vec<f64> = (0..200).map(|i| f64::from(i) / 100.0).collect();
    let mut random = Random::new(18);
    let toss = |omega| {
        let rates = simulate(&body, omega, &times, 0.05, &mut random).unwrap();
        Record::from_samples(&times, &rates).unwrap()
    };
    let tosses: Vec<Record> = starts().into_iter().map(toss).collect();
    let joined = |left_out: Option<usize>| {
        let each = tosses.iter().enumerate().filter(|(k, _)| Some(*k) != left_out);
        each.map(|(_, toss)| toss.clone()).reduce(Record::join).unwrap()
    };
    let all = joined(None);
    // one width of the test functions and one model for both
    let radius = fit(&all, &Settings::default()).unwrap().radius;
    let settings = Settings::default().with_radius(radius).with_noise(0.05).with_torque(TorqueModel::None);
    let settings = settings.with_torque_noise(TorqueNoise::None);
    let whole = fit(&all, &settings).unwrap();
    for k in 0..4 {
        agrees(&whole, k, &fit(&joined(Some(k)), &settings).unwrap());
    }
    assert!(fit(&tosses[0], &settings).unwrap().per_segment[0].without.is_none());
}

fn attitudes(noise: f64) -> Vec<Poses> {
    let body = Inertia::from_moments(MOMENTS).unwrap();
    let times: Vec<f64> = (0..100).map(|i| f64::from(i) / 50.0).collect();
    let mut random = Random::new(19);
    let toss = |omega| {
        let motion = FreeMotion::from_omega(&body, UnitQuaternion::identity(), omega).unwrap();
        let measured: Vec<UnitQuaternion<f64>> = times
            .iter()
            .map(|t| {
                let off = UnitQuaternion::from_scaled_axis(random.normal_vector() * noise);
                UnitQuaternion::from(motion.at(*t).unwrap().attitude) * off
            })
            .collect();
        Poses::new("toss", &times, &measured).unwrap()
    };
    starts().into_iter().map(toss).collect()
}

/// By the exact motion, and by filter and smoother.
#[test]
fn attitudes_without_a_segment_are_those_of_the_others() {
    let tosses = attitudes(0.01);
    let joined = |left_out: Option<usize>| {
        let each = tosses.iter().enumerate().filter(|(k, _)| Some(*k) != left_out);
        each.map(|(_, toss)| toss.clone()).reduce(Poses::join).unwrap()
    };
    let settings = Settings::default().with_torque(TorqueModel::None).with_attitude_noise(0.01);
    for noise in [TorqueNoise::None, TorqueNoise::Given(1e-3)] {
        let settings = settings.clone().with_torque_noise(noise);
        let whole = fit_poses(&joined(None), &settings).unwrap();
        for k in 0..4 {
            agrees(&whole, k, &fit_poses(&joined(Some(k)), &settings).unwrap());
        }
        assert!(fit_poses(&tosses[0], &settings).unwrap().per_segment[0].without.is_none());
    }
}

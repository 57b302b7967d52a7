//! What records leave out: spikes and bursts, and of readings without them nothing, however fast the motion is for the sampling.

use core::f64::consts::TAU;

use nalgebra::{UnitQuaternion, Vector3};
use polhode::flow::FreeMotion;
use polhode::inertia::Inertia;
use polhode::num::Random;
use polhode::record::{Record, Spike};

const BODIES: [[f64; 3]; 6] = [
    [1.0, 2.0, 2.6],
    [1.0, 1.02, 1.05],
    [0.05, 1.0, 1.02],
    [1.0, 1.6, 2.6],
    [1.0, 2.0, 2.0],
    [0.3, 0.8, 1.0],
];

/// Starts of 1 rad/s: far from every axis, and 0.1 to 1e-4 from each.
fn starts() -> Vec<Vector3<f64>> {
    let far = [[0.3, 1.0, 0.4], [1.0, 0.5, 0.2], [0.2, 0.5, 1.0]];
    let near = [0.1, 0.01, 1e-4].into_iter().flat_map(|e| [[e, 1.0, e], [1.0, e, e], [e, e, 1.0]]);
    far.into_iter().chain(near).map(|w| Vector3::from(w).normalize()).collect()
}

/// Times and exact rates of a free body, `a_turn` samples in 2π s.
fn free(moments: [f64; 3], start: Vector3<f64>, a_turn: f64, count: u32) -> (Vec<f64>, Vec<Vector3<f64>>) {
    let inertia = Inertia::from_moments(moments).unwrap();
    let motion = FreeMotion::from_omega(&inertia, UnitQuaternion::identity(), start).unwrap();
    let times: Vec<f64> = (0..count).map(|i| f64::from(i) * TAU / a_turn).collect();
    let rates = times.iter().map(|t| motion.omega_at(*t).unwrap()).collect();
    (times, rates)
}

fn noisy(rates: &[Vector3<f64>], noise: f64, random: &mut Random) -> Vec<Vector3<f64>> {
    rates.iter().map(|w| w + random.normal_vector() * noise).collect()
}

fn left_out(times: &[f64], rates: &[Vector3<f64>]) -> Vec<Spike> {
    let record = Record::from_samples(times, rates).unwrap();
    record.without_spikes().map_or(Vec::new(), |(spikes, _)| spikes)
}

#[test]
fn no_sample_of_a_free_motion_is_left_out() {
    let mut random = Random::new(11);
    let (mut out, mut all) = (0, 0);
    for moments in BODIES {
        for start in starts() {
            for a_turn in [6.0, 10.0, 15.0, 30.0, 60.0] {
                let (times, rates) = free(moments, start, a_turn, 400);
                for noise in [1e-6, 1e-4, 1e-3] {
                    let spikes = left_out(&times, &noisy(&rates, noise, &mut random));
                    assert!(spikes.len() < 2, "{moments:?} {start:?} {a_turn} {noise}: {spikes:?}");
                    (out, all) = (out + spikes.len(), all + times.len());
                }
            }
        }
    }
    println!("{out} of {all}");
    assert!(10_000 * out <= all, "{out} of {all}");
}

/// Bursts of 3 to 6 samples that are off together, and as many of samples that are each off by its own error, 50 deviations; one sample
/// in a hundred is off alone.
#[test]
fn bursts_and_spikes_are_left_out_and_little_else() {
    let mut random = Random::new(12);
    for together in [true, false] {
        let (mut put, mut found, mut wrong, mut in_bursts, mut all) = (0, 0, 0, 0, 0);
        for k in 0..24 {
            let start = random.normal_vector().normalize();
            let a_turn = [628.0, 100.0, 50.0][k % 3];
            let (times, rates) = free(BODIES[k % 6], start, a_turn, 2000);
            let noise = 1e-3;
            let mut rates = noisy(&rates, noise, &mut random);
            let mut off = vec![false; rates.len()];
            // 20 samples at either end have no burst, as a side must be left
            for n in 0..10 {
                let begin = 200 * n + 20 + random.below(150) as usize;
                let length = 3 + random.below(4) as usize;
                let mut one = random.normal_vector().normalize() * (50.0 * noise);
                for sample in begin..begin + length {
                    if !together {
                        one = random.normal_vector().normalize() * (50.0 * noise);
                    }
                    rates[sample] += one;
                    off[sample] = true;
                }
            }
            for sample in 0..rates.len() {
                if random.uniform() < 0.01 && !off[sample] {
                    rates[sample] += random.normal_vector().normalize() * (50.0 * noise);
                    off[sample] = true;
                }
            }
            let spikes = left_out(&times, &rates);
            put += off.iter().filter(|off| **off).count();
            found += spikes.iter().filter(|spike| off[spike.sample]).count();
            wrong += spikes.iter().filter(|spike| !off[spike.sample]).count();
            let (samples, bursts) = Spike::bursts(&spikes);
            assert!(samples >= bursts);
            in_bursts += bursts;
            all += rates.len();
        }
        println!("together {together}: {found} of {put} found, {wrong} of {all} wrongly, {in_bursts} bursts");
        assert!(100 * found >= 96 * put, "{found} of {put}");
        assert!(1000 * wrong <= all, "{wrong} of {all}");
        assert!((200..=260).contains(&in_bursts), "{in_bursts} of 240");
    }
}

#[test]
fn lost_rows_held_and_stale_readings_clipped_tops_blows_and_bends_are_no_bursts() {
    let mut random = Random::new(13);
    for (k, a_turn, noise) in [(0, 628.0, 1e-2), (1, 60.0, 1e-2), (2, 60.0, 1e-4), (3, 30.0, 1e-3)] {
        for n in 0..12 {
            let start = random.normal_vector().normalize();
            let (times, rates) = free(BODIES[(k + n) % 6], start, a_turn, 1000);
            let read = noisy(&rates, noise, &mut random);
            let kept: Vec<usize> = (0..read.len()).filter(|_| random.uniform() > 0.2).collect();
            let lost = |of: &[usize]| -> (Vec<f64>, Vec<Vector3<f64>>) {
                of.iter().map(|&i| (times[i], read[i])).unzip()
            };
            let held: Vec<_> = (0..read.len()).map(|i| read[i - i % 4]).collect();
            let end = 0.9 * read.iter().map(|w| w.amax()).fold(0.0, f64::max);
            let clipped: Vec<_> = read.iter().map(|w| w.map(|x| x.clamp(-end, end))).collect();
            let blow = random.normal_vector();
            let jumped: Vec<_> =
                read.iter().enumerate().map(|(i, w)| if i < 500 { *w } else { w + blow }).collect();
            let bent: Vec<_> = read
                .iter()
                .enumerate()
                .map(|(i, w)| w + blow * (i.saturating_sub(500) as f64 / 50.0))
                .collect();
            let (few_times, few) = lost(&kept);
            let kinds = [
                ("lost", &few_times, &few),
                ("held", &times, &held),
                ("clipped", &times, &clipped),
                ("jumped", &times, &jumped),
                ("bent", &times, &bent),
            ];
            for (name, times, rates) in kinds {
                let spikes = left_out(times, rates);
                // of a top that is too short to be seen as flat
                let is_off = |spike: &Spike| name == "clipped" && rates[spike.line - 1].amax() == end;
                let wrong: Vec<_> = spikes.iter().filter(|s| s.burst.is_some() && !is_off(s)).collect();
                assert!(wrong.is_empty(), "{name} {a_turn} {noise}: {wrong:?}");
                assert!(name == "clipped" || spikes.len() < 4, "{name} {a_turn} {noise}: {spikes:?}");
            }
        }
    }
}

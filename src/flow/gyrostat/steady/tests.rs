//! Steady spins against their definition, a scan of all λ, and the motion next to them.

use super::*;
use crate::body::Point;
use crate::flow::gyrostat::GyrostatOrbit;
use crate::rotation::Quat;

fn random(seed: &mut u64) -> f64 {
    *seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
    (*seed >> 11) as f64 / 4_503_599_627_370_496.0 - 1.0
}

fn drawn(seed: &mut u64, wheel: f64) -> (Vec3<Dd>, Vec3<Dd>, Dd) {
    let moments = Vec3([0, 1, 2].map(|_| Dd::of(1.5 + 0.5 * random(seed))));
    let h = Vec3([0, 1, 2].map(|_| Dd::of(wheel * random(seed))));
    (moments, h, Dd::of(0.1 + 1.9 * random(seed).abs()))
}

fn check(moments: Vec3<Dd>, wheel: Vec3<Dd>, norm: Dd, spin: &SteadySpin) {
    let m = spin.momentum.map(Dd::of);
    let omega = Vec3([0, 1, 2].map(|k| (m[k] - wheel[k]) / moments[k]));
    let fastest = (norm + wheel.norm()).hi() / 0.9;
    assert!((m.norm() - norm).magnitude() < 1e-15 * norm.hi());
    assert!(m.cross(omega).norm().hi() < 4e-15 * norm.hi() * fastest, "{spin:?}");
    assert!((omega - m * Dd::of(spin.lambda)).norm().hi() < 4e-15 * fastest, "{spin:?}");
    let energy = 0.5 * (omega.times(moments).dot(omega)).hi();
    assert!((spin.energy - energy).abs() < 1e-14 * (energy + norm.hi() * fastest), "{spin:?} {energy}");
}

#[test]
fn every_spin_is_steady_and_a_scan_finds_no_other() {
    let mut seed = 7;
    let mut counts = [0; 7];
    for case in 0..300 {
        let (moments, wheel, norm) = drawn(&mut seed, [0.02, 0.2, 1.0][case % 3]);
        let spins = steady_spins(moments, wheel, norm);
        spins.iter().for_each(|spin| check(moments, wheel, norm, spin));
        counts[spins.len()] += 1;
        // changes of sign of F − G², poles apart; λ = tan x covers the line
        let excess = |lambda: f64| {
            let part = |k: usize| {
                let x = wheel[k].hi() / (1.0 - lambda * moments[k].hi());
                x * x
            };
            part(0) + part(1) + part(2) - norm.hi() * norm.hi()
        };
        let mut edges: Vec<f64> = moments.0.iter().map(|i| 1.0 / i.hi()).collect();
        edges.sort_by(f64::total_cmp);
        let mut found = 0;
        for (low, high) in [(-1e4, edges[0]), (edges[0], edges[1]), (edges[1], edges[2]), (edges[2], 1e4)] {
            let at = |n: i32| {
                let x = f64::from(n) / 40_000.0;
                // dense at both ends, where a weak wheel leaves the roots
                low + (high - low) * x * x * x * (10.0 - 15.0 * x + 6.0 * x * x)
            };
            let mut before = f64::INFINITY;
            for n in 1..40_000 {
                let now = excess(at(n));
                // outside F falls to zero at the far end
                if n > 1 && (now > 0.0) != (before > 0.0) {
                    found += 1;
                }
                before = now;
            }
        }
        assert!(found <= spins.len(), "{found} by the scan, {spins:?}");
        // two roots that the scan steps over are as near as its mesh
        if found < spins.len() {
            let nearest = spins.iter().flat_map(|a| spins.iter().map(move |b| (a.lambda - b.lambda).abs()));
            let nearest = nearest.filter(|x| *x > 0.0).fold(f64::INFINITY, f64::min);
            assert!(nearest < 1e-4, "{found} by the scan, {spins:?}");
        }
        let stable = spins.iter().filter(|spin| spin.stability == Stability::Stable).count();
        let unstable = spins.iter().filter(|spin| spin.stability == Stability::Unstable).count();
        assert_eq!(stable, unstable + 2, "{spins:?}"); // Poincaré and Hopf, on the sphere
    }
    assert!(counts[2] > 20 && counts[4] > 20 && counts[6] > 20, "{counts:?}");
    assert_eq!(counts[2] + counts[4] + counts[6], 300);
}

#[test]
fn spins_of_the_free_body_and_of_symmetric_ones() {
    let moments = Vec3([2.0, 1.0, 3.0].map(Dd::of));
    let spins = steady_spins(moments, Vec3::zero(), Dd::of(3.0));
    assert_eq!(spins.len(), 6);
    for spin in &spins {
        check(moments, Vec3::zero(), Dd::of(3.0), spin);
        let middle = spin.momentum[0] != 0.0;
        assert_eq!(spin.stability, if middle { Stability::Unstable } else { Stability::Stable });
        if middle {
            // ω √((I_k − I_a)(I_b − I_k)/(I_a I_b)), Landau and Lifshitz §37
            assert!((spin.growth_rate - 1.5 / 3.0_f64.sqrt()).abs() < 1e-15);
        }
    }
    let carrier = Vec3([2.0, 2.0, 3.0].map(Dd::of));
    let wheel = Vec3([0.0, 0.0, 0.25].map(Dd::of));
    let spins = steady_spins(carrier, wheel, Dd::of(1.0));
    assert_eq!(spins.len(), 3);
    assert_eq!(spins.iter().filter(|spin| spin.is_circle).count(), 1);
    spins.iter().for_each(|spin| check(carrier, wheel, Dd::of(1.0), spin));
    // a strong wheel leaves the two about its axis
    let strong = Vec3([0.0, 0.0, 2.0].map(Dd::of));
    assert_eq!(steady_spins(carrier, strong, Dd::of(1.0)).len(), 2);
    let ball = Vec3([Dd::of(2.0); 3]);
    assert_eq!(steady_spins(ball, strong, Dd::of(1.0)).len(), 2);
    assert_eq!(steady_spins(ball, Vec3::zero(), Dd::of(1.0)).len(), 1);
    assert!(steady_spins(ball, strong, Dd::ZERO).is_empty());
    // at rest the wheel alone carries the momentum
    let generic = Vec3([0.3, -0.2, 0.5].map(Dd::of));
    let spins = steady_spins(moments, generic, generic.norm());
    assert!(spins.iter().any(|spin| spin.lambda.abs() < 1e-30 && spin.energy < 1e-50), "{spins:?}");
}

#[test]
fn weak_wheels_and_all_scales() {
    for size in [1e-200, 1e-30, 1e-9] {
        let moments = Vec3([1.0, 2.0, 2.5].map(Dd::of));
        let wheel = Vec3([1.0, -2.0, 0.5].map(Dd::of)) * Dd::of(size);
        let spins = steady_spins(moments, wheel, Dd::ONE);
        assert_eq!(spins.len(), 6, "{size:e}");
        spins.iter().for_each(|spin| check(moments, wheel, Dd::ONE, spin));
    }
    let (moments, wheel) = (Vec3([1.0, 2.0, 2.5].map(Dd::of)), Vec3([0.2, 0.1, -0.05].map(Dd::of)));
    let spins = steady_spins(moments, wheel, Dd::ONE);
    let small =
        steady_spins(moments.map(|x| x.scaled(-150)), wheel.map(|x| x.scaled(-100)), Dd::ONE.scaled(-100));
    for (a, b) in spins.iter().zip(&small) {
        assert_eq!(a.frequency, libm::scalbn(b.frequency, -50));
        assert_eq!(a.energy, libm::scalbn(b.energy, 50));
    }
}

#[test]
fn the_motion_next_to_a_stable_spin_has_its_frequency() {
    let mut seed = 3;
    let mut compared = 0;
    for _ in 0..40 {
        let (moments, wheel, norm) = drawn(&mut seed, 0.3);
        for spin in steady_spins(moments, wheel, norm) {
            if spin.stability != Stability::Stable || spin.frequency < 1e-2 {
                continue;
            }
            let off =
                Vec3([random(&mut seed), random(&mut seed), random(&mut seed)].map(|x| Dd::of(1e-6 * x)));
            let start = Point::new(Quat::identity(), spin.momentum.map(Dd::of) + off);
            let orbit = GyrostatOrbit::new(moments, wheel, start).unwrap();
            let period = orbit.character().period.unwrap();
            assert!(
                (period * spin.frequency / core::f64::consts::TAU - 1.0).abs() < 1e-4,
                "{spin:?} {period}"
            );
            compared += 1;
        }
    }
    assert!(compared > 80, "{compared}");
}

//! The exact free motion against fixtures of 36 digits (tests/data/free_body, mpmath) in every regime.

use crate::fixtures::{BRINK, BY_REGIME, FreeCase, PUBLISHED, WorstCase, free_body, worst_of_the_grid};
use polhode::body::{Body, Point, State, Time};
use polhode::flow::{AtRest, Flow, FreeBody, FreeMotion, Mode, TimeError};
use polhode::inertia::Inertia;
use polhode::num::{Dd, Precise, Real};
use polhode::rotation::{Quat, Vec3, rotation_angle};

const FILES: [&str; 3] = [BY_REGIME, PUBLISHED, BRINK];

fn motion(case: &FreeCase) -> FreeMotion {
    // some published problems have moments that no body has
    let inertia = Inertia::from_positive_moments(case.moments).unwrap();
    let body = Body::free(inertia);
    let q0 = Quat::from_components(case.attitude);
    let start = if case.from_omega {
        body.enter_omega(q0, Vec3(case.start))
    } else {
        body.enter(&State { attitude: q0, momentum_body: Vec3(case.start) })
    };
    FreeMotion::from_point(body.inertia(), start.unwrap())
}

/// Largest attitude error (rad) and momentum error (of |m|) over the cases of `file`, with the worst case's name.
fn worst<S: Precise>(file: &str, at: impl Fn(&FreeMotion, f64) -> Point<S>) -> [(f64, String); 2] {
    let mut worst = [(0.0, String::new()), (0.0, String::new())];
    for case in free_body(file) {
        let motion = motion(&case);
        let x = at(&motion, case.t);
        let scale = Dd::of(motion.body().scale());
        let q = Quat::from_components(x.attitude.components().map(S::to_dd));
        let m = Vec3(x.momentum_body.0.map(|m| m.to_dd() * scale));
        let exact = Vec3(case.momentum);
        let errors = [
            rotation_angle(q, Quat::from_components(case.result)).hi(),
            if exact.norm().hi() == 0.0 { m.norm().hi() } else { ((m - exact).norm() / exact.norm()).hi() },
        ];
        // the lift is continuous: the sign of q is part of the answer
        let same_sign = (q - Quat::from_components(case.result)).magnitude() < 1.0;
        assert!(same_sign, "{} at t = {}: −q for q: {x:?} {:?}", case.scenario, case.t, case.result);
        for (worst, error) in worst.iter_mut().zip(errors) {
            if error > worst.0 || error.is_nan() {
                *worst = (error, format!("{} ({}) at t = {}", case.scenario, case.regime, case.t));
            }
        }
    }
    worst
}

/// The states of every file are off by less than `most`, rad and relative.
fn assert_exact_to<S: Precise>(most: f64, at: impl Fn(&FreeMotion, f64) -> Point<S>) {
    for file in FILES {
        let [attitude, momentum] = worst(file, &at);
        println!(
            "{file}: attitude {:.2e} rad, {}; momentum {:.2e}, {}",
            attitude.0, attitude.1, momentum.0, momentum.1
        );
        assert!(attitude.0 < most, "attitude error {:.2e} rad: {}", attitude.0, attitude.1);
        assert!(momentum.0 < most, "momentum error {:.2e}: {}", momentum.0, momentum.1);
    }
}

#[test]
fn f64_states_are_exact_to_2e_15_in_every_regime_at_any_time() {
    assert_exact_to(2e-15, |motion, t| motion.point_at(t));
}

#[test]
fn double_double_states_are_exact_to_conditioning() {
    assert_exact_to(1e-20, |motion, t| motion.point_at_dd(Dd::from(t)));
}

#[test]
fn f64_states_agree_with_double_double_up_to_the_reach_of_a_double() {
    let mut worst = 0.0_f64;
    for (moments, omega) in [
        ([1.0, 1.0, 1.0], [0.0, 0.0, 1.0]),
        ([1.0, 1.0, 0.5], [0.3, 0.4, 1.25]),
        ([1.0, 2.0, 2.5], [0.4, -0.2, 1.0]),
        ([1.0, 2.0, 3.0], [1e-3, 1.0, 2e-3]), // beside the separatrix
    ] {
        let inertia = Inertia::from_moments(moments).unwrap();
        let motion = FreeMotion::from_omega(&inertia, Default::default(), omega.into()).unwrap();
        for n in 0..3000 {
            let t = libm::exp10(10.0 + 6.3 * f64::from(n) / 3000.0);
            let (rough, exact) = (motion.point_at(t), motion.point_at_dd(Dd::from(t)));
            let error = rotation_angle(rough.to_dd().attitude, exact.attitude).hi();
            assert!(error < 2e-15, "{moments:?} at {t:e} s: {error:.1e} rad");
            worst = worst.max(error);
        }
    }
    println!("{worst:.1e} rad");
}

#[test]
fn flips_are_counted_as_the_momentum_changes_sign() {
    let inertia = Inertia::from_moments([1.0, 2.0, 3.0]).unwrap();
    for omega in [[0.4, 1.0, -0.3], [-0.4, -1.0, 0.3], [0.01, 1.0, 0.02], [1.0, 0.5, 0.1]] {
        let motion = FreeMotion::from_omega(&inertia, Default::default(), omega.into()).unwrap();
        for direction in [1.0, -1.0] {
            let (mut before, mut count) = (omega[1] > 0.0, 0);
            for n in 1..=4000 {
                let t = direction * 0.05 * f64::from(n);
                let now = motion.at(t).unwrap().momentum_body[1] > 0.0;
                count += u64::from(now != before);
                before = now;
                assert_eq!(motion.flips(Dd::from(t)), count, "omega {omega:?}, t = {t}");
            }
            assert!(count > 10);
        }
    }
}

#[test]
fn a_symmetric_top_precesses_at_l_over_i() {
    // the lecture's 17.5, prolate and oblate: the axis goes round L at L/I
    for (moments, mode) in [([1.0, 1.0, 0.25], Mode::LongAxis), ([1.0, 1.0, 1.75], Mode::ShortAxis)] {
        let inertia = Inertia::from_moments(moments).unwrap();
        let omega = [0.3, 0.4, 1.25];
        let character =
            FreeMotion::from_omega(&inertia, Default::default(), omega.into()).unwrap().character().unwrap();
        let l = nalgebra::Vector3::new(0.3, 0.4, 1.25 * moments[2]).norm();
        assert_eq!(character.mode, mode);
        approx::assert_relative_eq!(character.precession_rate.unwrap(), l, max_relative = 1e-15);
        let body_cone = (1.0 - moments[2]).abs() * 1.25;
        approx::assert_relative_eq!(
            character.polhode_period.unwrap(),
            std::f64::consts::TAU / body_cone,
            max_relative = 1e-15
        );
    }
}

#[test]
fn after_a_period_the_momentum_is_back_and_the_axis_has_precessed() {
    let inertia = Inertia::from_moments([1.0, 2.0, 2.5]).unwrap();
    for (omega, axis) in [([1.0, 0.2, 0.1], 0), ([0.1, -0.3, -0.9], 2), ([0.1, 1.0, 0.15], 2)] {
        let motion = FreeMotion::from_omega(&inertia, Default::default(), omega.into()).unwrap();
        let character = motion.character().unwrap();
        let period = character.polhode_period.unwrap();
        let (before, after) = (motion.at(0.25).unwrap(), motion.at(0.25 + period).unwrap());
        approx::assert_relative_eq!(before.momentum(), after.momentum(), max_relative = 1e-13);
        let l = before.rotation() * before.momentum();
        let e = nalgebra::Vector3::ith(axis, 1.0);
        let across = |x: &State| {
            let a = x.rotation() * e;
            a - l * (a.dot(&l) / l.norm_squared())
        };
        let (a, b) = (across(&before), across(&after));
        let angle = libm::atan2(a.cross(&b).dot(&l.normalize()), a.dot(&b));
        let turns = (character.precession_rate.unwrap() * period - angle) / std::f64::consts::TAU;
        assert!((turns - turns.round()).abs() < 1e-13, "{turns}");
        assert_eq!(character.mode == Mode::LongAxis, axis == 0);
        assert_eq!(character.separatrix_distance < 0.0, axis == 0);
    }
}

#[test]
fn rest_and_steady_turns_have_no_periods() {
    let inertia = Inertia::from_moments([1.0, 2.0, 2.5]).unwrap();
    let of = |omega: [f64; 3]| FreeMotion::from_omega(&inertia, Default::default(), omega.into()).unwrap();
    assert_eq!(of([0.0; 3]).character(), Err(AtRest));
    assert_eq!(of([0.0; 3]).at(1e300).unwrap(), of([0.0; 3]).at(0.0).unwrap());
    let steady = of([0.0, -0.5, 0.0]).character().unwrap();
    assert_eq!((steady.mode, steady.spin, steady.separatrix_distance), (Mode::Steady, 0.5, 0.0));
    assert_eq!(steady.polhode_period, None);
    assert!(matches!(of([1.0, 2.0, 3.0]).at(f64::NAN), Err(TimeError::NotFinite { .. })));
    assert!(matches!(of([1.0, 2.0, 3.0]).at(1e29), Err(TimeError::OutOfReach { .. })));
    let far = of([1.0, 2.0, 3.0]);
    assert!(far.at(0.99 * far.reach()).unwrap().is_finite());
    assert!(of([1.0, 2.0, 3.0]).at_many(&[0.0, f64::INFINITY]).is_err());
}

#[test]
fn the_flow_of_a_splitting_agrees_with_the_motion() {
    for case in FILES.into_iter().flat_map(free_body).filter(|case| case.t.abs() <= 1.0) {
        let exact = motion(&case);
        let mut x = exact.point_at(0.0);
        let mut precise = exact.point_at_dd(Dd::ZERO);
        let (rotor, now) = (exact.body().rotor(), Time::from_seconds(0.0));
        FreeBody::<f64>::new(&rotor).flow(now, case.t, &mut x);
        FreeBody::<Dd>::new(&rotor).flow(now, Dd::from(case.t), &mut precise);
        let there = exact.point_at_dd(Dd::from(case.t));
        let angle = rotation_angle(x.to_dd().attitude, there.attitude).hi();
        let turned = exact.character().map_or(0.0, |c| c.spin * case.t.abs());
        // the phase of a start next to the unstable axis is the logarithm of its distance
        let long = if case.regime == "brink" { 20.0 } else { 1.0 };
        assert!(angle < long * 1e-14 * (1.0 + turned), "{}: {angle:e} after {turned} rad", case.scenario);
        let angle = rotation_angle(precise.attitude, there.attitude).hi();
        assert!(angle < long * 1e-29 * (1.0 + turned), "{}: {angle:e} after {turned} rad", case.scenario);
    }
}

#[test]
fn small_deviations_grow_with_all_their_digits() {
    let mut checked = 0;
    for case in free_body(BRINK) {
        let motion = motion(&case);
        let found = motion.point_at_dd(Dd::from(case.t)).momentum_body;
        let scale = Dd::of(motion.body().scale());
        for (found, exact) in found.0.into_iter().zip(case.momentum) {
            // below, parts of a double-double are subnormal
            if exact.magnitude() > 1e-270 {
                let off = ((found * scale - exact) / exact).magnitude();
                assert!(off < 1e-20, "{} at t = {}: {off:e} of {exact}", case.scenario, case.t);
                checked += usize::from(exact.magnitude() < 1e-30);
            }
        }
    }
    assert!(checked > 50, "{checked}");
}

#[test]
fn a_tensor_as_a_rotation_leaves_it_spins_on() {
    let (x, y) = (1.0000000000000004, 1.0000000000000007);
    let off = -3.944304526105059e-31;
    let tensor = nalgebra::Matrix3::new(x, off, 0.0, off, y, 0.0, 0.0, 0.0, y);
    let inertia = Inertia::from_tensor(tensor).unwrap();
    let spin = -2.990015465709188;
    let motion = FreeMotion::from_omega(&inertia, Default::default(), [0.0, 0.0, spin].into()).unwrap();
    let found = motion.at(0.32).unwrap();
    let (sin, cos) = polhode::num::trig::sin_cos(0.5 * 0.32 * spin);
    let expected = [cos, 0.0, 0.0, sin];
    for (found, expected) in found.attitude.components().into_iter().zip(expected) {
        assert!((found - expected).abs() < 1e-15, "{found} {expected}");
    }
}

#[test]
fn the_worst_points_of_the_grid_are_no_worse() {
    // the worst of the grid at standard scale, beside those at paper scale
    let of_standard = WorstCase {
        quantity: "attitude".into(),
        error: 9.423339961475728,
        moments: [0.9999983374527797, 1.0, 2.079367061378367e-6],
        omega: [0.9861542601508156, 0.1658403112596736, -0.1482901175670908],
        t: 12.18860004244707,
    };
    for case in worst_of_the_grid().into_iter().chain([of_standard]) {
        let inertia = Inertia::from_moments(case.moments).unwrap();
        let motion = FreeMotion::from_omega(&inertia, Default::default(), case.omega.into()).unwrap();
        let exact = motion.point_at_dd(Dd::from(case.t));
        let error = match case.quantity.as_str() {
            "attitude" => rotation_angle(motion.point_at(case.t).to_dd().attitude, exact.attitude).hi(),
            "omega" => {
                let inverse = Vec3(case.moments.map(|moment| Dd::from(motion.body().scale()) / moment));
                let exact = exact.momentum_body.times(inverse);
                let found = Vec3::of(Vec3::from(motion.omega_at(case.t).unwrap()));
                ((found - exact).norm() / exact.norm()).hi()
            }
            other => panic!("an error of {other}"),
        };
        let units = error / (f64::EPSILON / 2.0);
        assert!(units <= case.error * 1.001, "{case:?}: {units} u");
    }
}

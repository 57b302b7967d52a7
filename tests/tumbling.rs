//! The elements of tumbling bodies: to a start and back, and against published asteroids.

use core::f64::consts::{PI, TAU};

use nalgebra::{UnitQuaternion, Vector3};
use polhode::catalogue;
use polhode::flow::{FreeMotion, Mode, Stability, TumblingElements, TumblingError};
use polhode::inertia::Inertia;
use polhode::num::{Dd, Real};

const DAY: f64 = 86_400.0;

fn motion(inertia: &Inertia, omega: [f64; 3], attitude: UnitQuaternion<f64>) -> FreeMotion {
    FreeMotion::from_omega(inertia, attitude, omega.into()).unwrap()
}

/// Largest relative deviation of the angular velocities and the attitudes of two starts.
fn deviation(one: &FreeMotion, two: &FreeMotion) -> f64 {
    let (a, b) = (one.at(0.0).unwrap(), two.at(0.0).unwrap());
    let momenta = (a.momentum() - b.momentum()).norm() / a.momentum().norm();
    momenta.max(a.rotation().angle_to(&b.rotation()))
}

#[test]
fn toutatis_and_apophis_go_to_omega_and_back() {
    let toutatis = catalogue::body("toutatis").unwrap();
    let attitude = UnitQuaternion::from_euler_angles(0.3, -1.2, 2.5);
    let spun = motion(&toutatis.inertia, toutatis.omega_body, attitude);
    let elements = spun.tumbling().unwrap();
    let back = FreeMotion::from_point(&toutatis.inertia, elements.point(&toutatis.inertia).unwrap());
    assert!(deviation(&spun, &back) < 1e-12);
    // Takahashi, Busch and Scheeres (2013), and Ostro et al., Science 270 (1995) 80: 5.41 and 7.35 days, to their digits
    assert_eq!(elements.mode, Mode::LongAxis);
    assert!((elements.rotation_period / DAY - 5.38).abs() < 0.01, "{}", elements.rotation_period / DAY);
    assert!((elements.precession_period / DAY - 7.40).abs() < 0.01, "{}", elements.precession_period / DAY);

    // Pravec et al., Icarus 233 (2014) 48: moments, periods and pole of Apophis, and what they found for 2E I_3/L²
    let apophis = Inertia::from_moments([0.61, 0.965, 1.0]).unwrap();
    let published = TumblingElements::new(Mode::ShortAxis, [27.38, 263.0].map(|hours| hours * 3600.0))
        .with_pole([250.0, -75.0].map(|degrees| degrees * PI / 180.0))
        .with_angles([152.0, 14.0].map(|degrees| degrees * PI / 180.0));
    let start = FreeMotion::from_point(&apophis, published.point(&apophis).unwrap());
    let found = start.tumbling().unwrap();
    assert_eq!((found.mode, found.is_reversed), (Mode::ShortAxis, false));
    for (found, given) in [
        (found.precession_period, published.precession_period),
        (found.rotation_period, published.rotation_period),
        (found.pole[0] + TAU, published.pole[0]),
        (found.pole[1], published.pole[1]),
        (found.angles[0], published.angles[0]),
        (found.angles[1], published.angles[1]),
    ] {
        assert!((found / given - 1.0).abs() < 1e-12, "{found} of {given}");
    }
    let state = start.at(0.0).unwrap();
    let energy_ratio = start.character().unwrap().spin / state.momentum().norm();
    assert!((energy_ratio - 1.024).abs() < 0.013, "{energy_ratio}");
}

/// Harbison, Thomas and Nicholson, Celest. Mech. Dyn. Astr. 110 (2011) 1: Lyapunov's time is on the order of 100 days.
#[test]
fn neighbours_of_hyperion_part_in_the_time_that_is_published() {
    let hyperion = catalogue::body("hyperion").unwrap();
    let (body, days) = (hyperion.body().unwrap(), 1200.0);
    let [w, x, y, z] = hyperion.attitude;
    let attitude = UnitQuaternion::new_unchecked(nalgebra::Quaternion::new(w, x, y, z));
    let apart = 1e-11;
    let [one, other] = [0.0, apart].map(|angle| {
        let turn = UnitQuaternion::from_axis_angle(&Vector3::y_axis(), angle);
        let start = body.state(attitude * turn, hyperion.omega_body.into()).unwrap();
        let mut run = crate::motions::run("taylor", &(body.clone(), start), days * DAY);
        run.advance_to(1).unwrap().point.to_dd().attitude
    });
    let parted = polhode::rotation::rotation_angle(one, other).hi();
    let time = days / libm::log(parted / apart);
    assert!(time > 50.0 && time < 200.0, "{time} d, {parted} rad");
}

#[test]
fn the_elements_of_any_motion_are_its_own() {
    let mut seed = 11_u64;
    for _ in 0..40 {
        // Knuth's linear congruence
        let mut uniform = |low: f64, high: f64| {
            seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            low + (high - low) * (seed >> 11) as f64 / 9_007_199_254_740_992.0
        };
        let (a, b) = (uniform(0.1, 1.0), uniform(0.1, 1.0));
        // a moment is at most the sum of the other two
        let moments = [a, b, uniform((a - b).abs().max(0.05) * 1.01, (a + b) * 0.99)];
        let inertia = Inertia::from_moments(moments).unwrap();
        let omega = [0.0; 3].map(|_| uniform(-1.0, 1.0));
        let attitude =
            UnitQuaternion::from_euler_angles(uniform(-3.0, 3.0), uniform(-1.5, 1.5), uniform(-3.0, 3.0));
        let spun = motion(&inertia, omega, attitude);
        let elements = spun.tumbling().unwrap();
        let back = FreeMotion::from_point(&inertia, elements.point(&inertia).unwrap());
        // a motion next to a steady spin loses half of its digits in the periods
        let [low, high] = spun.tilt_range().unwrap();
        let lean = low.min(PI - high);
        let allowed = 1e-13 + 1e-15 / (lean * lean);
        assert!(deviation(&spun, &back) < allowed, "{moments:?} {omega:?}");

        // after P_psi the momentum is back in the body, and z' has gone round L by the share P_psi/P_phi
        let later = spun.point_at_dd(Dd::of(elements.rotation_period));
        let later = FreeMotion::from_point(&inertia, later).tumbling().unwrap();
        let turned = later.angles[0] - elements.angles[0];
        let expected = TAU * elements.rotation_period / elements.precession_period;
        let rest = |angle: f64| (angle / TAU - (angle / TAU).round()).abs() * TAU;
        assert!(rest(later.angles[1] - elements.angles[1]) < 1e-10, "{moments:?} {omega:?}");
        assert!(rest(turned - expected) < 1e-10, "{moments:?} {omega:?}");

        // theta at any time lies between its limits, and comes near both
        let (mut least, mut most) = (PI, 0.0_f64);
        let ascending = inertia.principal_moments();
        let rank = if elements.mode == Mode::LongAxis { 0 } else { 2 };
        let axis = moments.iter().position(|moment| *moment == ascending[rank]).unwrap();
        for k in 0..400 {
            let m = spun.at(elements.rotation_period * f64::from(k) / 400.0).unwrap().momentum();
            let theta = Vector3::ith(axis, 1.0).angle(&m);
            (least, most) = (least.min(theta), most.max(theta));
        }
        assert!(least > low - 1e-9 && most < high + 1e-9, "{low} {least} {most} {high}");
        assert!(least - low < 1e-3 && high - most < 1e-3, "{low} {least} {most} {high}");
    }
}

#[test]
fn the_ratio_of_the_periods_grows_with_the_lean() {
    // the search for the motion with given periods rests on it
    for moments in
        [[1.0, 3.0836, 3.235], [0.61, 0.965, 1.0], [1.0, 2.0, 3.0], [0.9, 1.0, 1.05], [0.02, 1.0, 1.01]]
    {
        let inertia = Inertia::from_moments(moments).unwrap();
        for axis in [0, 2] {
            let mut before = 0.0;
            for k in 1..200 {
                let lean = 0.5 * PI * f64::from(k) / 200.0;
                let (sin, cos) = libm::sincos(lean);
                let mut omega = [0.0; 3];
                omega[axis] = cos / moments[axis];
                omega[1] = sin / moments[1];
                let found = motion(&inertia, omega, UnitQuaternion::identity()).tumbling().unwrap();
                let ratio = found.rotation_period / found.precession_period;
                assert!(ratio > before, "{moments:?} axis {axis} at {lean}: {ratio} after {before}");
                before = ratio;
            }
        }
    }
}

#[test]
fn elements_without_a_motion_are_refused() {
    let apophis = Inertia::from_moments([0.61, 0.965, 1.0]).unwrap();
    let elements = |mode, precession_period, rotation_period| {
        TumblingElements::new(mode, [precession_period, rotation_period]).with_pole([0.0; 2])
    };
    let refused = elements(Mode::ShortAxis, 1.0, 5.0).point(&apophis).unwrap_err();
    let TumblingError::Ratio { least, .. } = refused else { panic!("{refused}") };
    // a small circulation: 1 + sqrt(I_1 I_2 / ((I_3 - I_1)(I_3 - I_2)))
    assert!((least - (1.0 + (0.61 * 0.965 / (0.39 * 0.035_f64)).sqrt())).abs() < 1e-12);
    assert!(refused.to_string().contains("P_psi/P_phi = 5.0"), "{refused}");
    let oblate = Inertia::from_moments([1.0, 1.0, 2.0]).unwrap();
    let refused = elements(Mode::LongAxis, 1.0, 5.0).point(&oblate).unwrap_err();
    assert!(refused.to_string().contains("no long-axis motion with the moments 1, 1, 2"), "{refused}");
    let falling = Inertia::from_moments([3.0, 2.0, 2.0]).unwrap();
    let refused = elements(Mode::LongAxis, 10.0, 20.0).point(&falling).unwrap_err();
    assert!(refused.to_string().contains("no long-axis motion with the moments 3, 2, 2"), "{refused}");
    for bad in [elements(Mode::ShortAxis, 0.0, 5.0), elements(Mode::ShortAxis, 1.0, f64::NAN)] {
        assert!(matches!(bad.point(&apophis), Err(TumblingError::Value { .. })));
    }
}

#[test]
fn periods_next_to_those_of_a_spin_have_a_motion_or_are_refused() {
    let apophis = Inertia::from_moments([0.61, 0.965, 1.0]).unwrap();
    for mode in [Mode::LongAxis, Mode::ShortAxis] {
        let point = |ratio| TumblingElements::new(mode, [1.0, ratio]).point(&apophis);
        let Err(TumblingError::Ratio { least, .. }) = point(1e-3) else { panic!("{mode:?}") };
        let mut ratio = least;
        for _ in 0..8 {
            ratio = ratio.next_up();
            if let Ok(point) = point(ratio) {
                let start = FreeMotion::from_point(&apophis, point).at(0.0).unwrap();
                assert!(start.momentum().norm() > 0.0, "{mode:?} at {ratio:?}");
            }
        }
    }
}

#[test]
fn a_steady_spin_has_an_axis_and_a_rate() {
    let spin = |moments: [f64; 3], omega: [f64; 3]| {
        let inertia = Inertia::from_moments(moments).unwrap();
        motion(&inertia, omega, UnitQuaternion::identity()).pure_spin()
    };
    // exp(λt) about the middle axis: λ = ω sqrt((I_2 − I_1)(I_3 − I_2)/(I_1 I_3)), measured on the motion of a small deviation
    let moments = [0.7, 1.0, 1.6];
    let unstable = spin(moments, [0.0, 2.0, 0.0]).unwrap();
    assert_eq!((unstable.rank, unstable.stability, unstable.circulation_rate), (1, Stability::Unstable, 0.0));
    let inertia = Inertia::from_moments(moments).unwrap();
    let near = motion(&inertia, [1e-9, 2.0, 1e-9], UnitQuaternion::identity());
    let grown = |t: f64| near.omega_at(t).unwrap().x.abs();
    let measured = libm::log(grown(12.0) / grown(8.0)) / 4.0;
    assert!((measured / unstable.growth_rate - 1.0).abs() < 1e-3, "{measured} {}", unstable.growth_rate);
    let stable = spin(moments, [0.0, 0.0, -2.0]).unwrap();
    assert_eq!((stable.rank, stable.stability, stable.growth_rate), (2, Stability::Stable, 0.0));
    assert_eq!(stable.axis, Vector3::new(0.0, 0.0, -1.0));
    let near = motion(&inertia, [1e-9, 0.0, -2.0], UnitQuaternion::identity());
    let period = near.character().unwrap().polhode_period.unwrap();
    assert!((TAU / period / stable.circulation_rate - 1.0).abs() < 1e-9);
    assert_eq!(spin([1.0, 1.0, 2.0], [0.6, 0.8, 0.0]).unwrap().stability, Stability::Neutral);
    assert_eq!(spin([1.0; 3], [0.6, 0.8, 0.1]).unwrap().stability, Stability::Neutral);
    assert_eq!(spin([1.0, 2.0, 3.0], [0.0; 3]), None);
    assert_eq!(spin([1.0, 2.0, 3.0], [0.1, 1.0, 0.0]), None);
}

#[test]
fn two_of_three_periods_are_enough() {
    let apophis = TumblingElements::new(Mode::ShortAxis, [27.38, 263.0]);
    let combined = apophis.combined_period();
    // Pravec et al. (2014): the strongest frequency of the light curve is twice that of 30.56 h
    assert!((combined - 30.56).abs() < 0.01, "{combined}");
    let toutatis = TumblingElements::new(Mode::LongAxis, [7.38, 5.38]);
    for elements in [apophis, toutatis] {
        let (mode, precession, rotation) =
            (elements.mode, elements.precession_period, elements.rotation_period);
        let combined = elements.combined_period();
        for found in [
            TumblingElements::from_combined_and_rotation(mode, [combined, rotation]).unwrap(),
            TumblingElements::from_precession_and_combined(mode, [precession, combined]).unwrap(),
        ] {
            assert!((found.precession_period / precession - 1.0).abs() < 1e-14);
            assert!((found.rotation_period / rotation - 1.0).abs() < 1e-14);
        }
    }
    // the long axis is slower than the short one in short-axis mode, and faster than both together in long-axis mode
    for (mode, periods) in [(Mode::ShortAxis, [30.0, 20.0]), (Mode::LongAxis, [20.0, 30.0])] {
        let refused = TumblingElements::from_precession_and_combined(mode, periods).unwrap_err().to_string();
        assert!(refused.contains("1/P_1 = 1/P_phi"), "{refused}");
    }
    assert!(TumblingElements::from_combined_and_rotation(Mode::LongAxis, [30.0, 20.0]).is_err());
    assert!(TumblingElements::from_combined_and_rotation(Mode::ShortAxis, [f64::NAN, 20.0]).is_err());
}

#[cfg(feature = "random")]
#[test]
fn members_of_solutions_have_their_elements() {
    use polhode::flow::{NoTumbler, TumblingPopulation, TumblingSolution};
    use polhode::num::Covariance;

    let inertia = Inertia::from_moments([0.61, 0.965, 1.0]).unwrap();
    let solution = |rotation: f64, deviations: [f64; 8]| {
        let elements = TumblingElements::new(Mode::ShortAxis, [27.38, rotation]).with_pole([1.0, 0.5]);
        TumblingSolution::new(inertia.clone(), elements, Covariance::independent(deviations).unwrap())
    };
    let deviations = [0.07, 6.0, 0.1, 0.05, 0.2, 0.1, 0.08, 0.008];
    let both =
        TumblingPopulation::new(vec![(3.0, solution(263.0, deviations)), (1.0, solution(300.0, [0.0; 8]))]);
    let both = both.unwrap();
    let (mut second, mut draws) = (0, 0);
    for k in 0..800 {
        let member = both.member(7, k).unwrap();
        assert_eq!(member, both.member(7, k).unwrap());
        let motion =
            FreeMotion::from_omega(&member.inertia, member.attitude.into(), member.omega_body.into())
                .unwrap();
        let found = motion.tumbling().unwrap();
        assert_eq!(found.mode, Mode::ShortAxis);
        if both.solution_of(7, k) == 1 {
            second += 1;
            assert!((found.rotation_period - 300.0).abs() < 1e-8 && (found.pole[0] - 1.0).abs() < 1e-12);
        }
        let [small, middle, large] = member.inertia.principal_moments();
        assert!(large == 1.0 && middle <= large && small <= middle);
        draws += member.draws;
    }
    // binomial, five standard deviations
    assert!((f64::from(second) - 200.0).abs() < 5.0 * 12.25, "{second}");
    assert!(draws > 800, "no draw was cut off");

    let refused = |weighted| TumblingPopulation::new(weighted).unwrap_err();
    assert!(matches!(refused(vec![]), NoTumbler::Weight { .. }));
    assert!(matches!(refused(vec![(f64::NAN, solution(263.0, deviations))]), NoTumbler::Weight { .. }));
    assert!(matches!(refused(vec![(1.0, solution(150.0, deviations))]), NoTumbler::Drawn { draws: 0, .. }));
}

/// Where deviations are small, attitude and sub-observer point of the members spread as the derivative of the motion by the elements says, here by
/// differences; of Apophis with a hundredth of what is published. 100 000 members agree to 0.3 %.
#[test]
fn narrow_bands_are_those_of_the_first_order() {
    use polhode::flow::{TumblingPopulation, TumblingSolution};
    use polhode::num::Covariance;

    const MEMBERS: u32 = 200;
    let degrees = |angles: [f64; 2]| angles.map(|angle| angle * PI / 180.0);
    let state = |x: [f64; 8]| {
        let inertia = Inertia::from_moments([x[6], x[7], 1.0]).unwrap();
        let elements = TumblingElements::new(Mode::ShortAxis, [x[0], x[1]])
            .with_pole(degrees([x[2], x[3]]))
            .with_angles(degrees([x[4], x[5]]));
        (inertia, elements)
    };
    let nominal = [27.38 * 3600.0, 263.0 * 3600.0, 250.0, -75.0, 152.0, 14.0, 0.61, 0.965];
    let deviations = [0.8, 72.0, 0.35, 0.047, 0.4, 0.09, 3e-4, 4e-5];
    let observer = Vector3::new(-0.86, -0.5, 0.09).normalize();
    let (inertia, elements) = state(nominal);
    let mut in_rad = deviations;
    in_rad[2..6].iter_mut().for_each(|angle| *angle *= PI / 180.0);
    let covariance = Covariance::independent(in_rad).unwrap();
    let population =
        TumblingPopulation::new(vec![(1.0, TumblingSolution::new(inertia, elements, covariance))]);
    let population = population.unwrap();
    let members: Vec<FreeMotion> = (0..MEMBERS)
        .map(|k| {
            let member = population.member(11, k.into()).unwrap();
            let omega = member.omega_body.into();
            FreeMotion::from_omega(&member.inertia, member.attitude.into(), omega).unwrap()
        })
        .collect();
    for days in [0.0, 39.8, 100.0] {
        let at = |motion: &FreeMotion| motion.at(days * DAY).unwrap().rotation();
        let of = |x: [f64; 8]| {
            let (inertia, elements) = state(x);
            at(&FreeMotion::from_point(&inertia, elements.point(&inertia).unwrap()))
        };
        let middle = of(nominal);
        // squares of the turn from the nominal attitude, in space, and of that of the observer in the sky of the body
        let squares = |turn: Vector3<f64>| [turn.norm_squared(), turn.cross(&observer).norm_squared()];
        let mut first_order = [0.0; 2];
        for k in 0..8 {
            let [low, high] = [-0.5, 0.5].map(|half| {
                let mut x = nominal;
                x[k] += half * deviations[k];
                of(x)
            });
            let parts = squares((high / low).scaled_axis());
            first_order = [0, 1].map(|q| first_order[q] + parts[q]);
        }
        let mut spread = [0.0; 2];
        for motion in &members {
            let parts = squares((at(motion) / middle).scaled_axis());
            spread = [0, 1].map(|q| spread[q] + parts[q] / f64::from(MEMBERS));
        }
        for q in 0..2 {
            let ratio = (spread[q] / first_order[q]).sqrt();
            // 200 members know a standard deviation to 5 %
            assert!((ratio - 1.0).abs() < 0.2, "{days} d, {q}: {spread:?} {first_order:?}");
        }
    }
}

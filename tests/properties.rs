//! Laws over random valid bodies and starts.

use polhode::body::{Body, Point, State, StateError, Time};
use polhode::flow::FreeMotion;
use polhode::inertia::Inertia;
use polhode::method::method;
use polhode::num::{Dd, Real};
use polhode::observe::Invariants;
use polhode::rotation::{Quat, Vec3, rotation_angle};
use polhode::run::Run;
use proptest::prelude::*;

/// Moments of a random ellipsoid: every valid ratio, sorted in no order, over fifteen decades of size.
fn any_moments() -> impl Strategy<Value = [f64; 3]> {
    ([0.001..1.0_f64, 0.001..1.0, 0.001..1.0], -25..25_i32).prop_map(|([a, b, c], exponent)| {
        let scale = libm::pow(2.0, f64::from(exponent));
        [b + c, a + c, a + b].map(|i| i * scale)
    })
}

fn any_vector() -> impl Strategy<Value = [f64; 3]> {
    [-1.0..1.0_f64, -1.0..1.0, -1.0..1.0].prop_filter("not at rest", |v| v.iter().any(|x| x.abs() > 1e-3))
}

fn any_attitude() -> impl Strategy<Value = [f64; 4]> {
    [-1.0..1.0_f64, -1.0..1.0, -1.0..1.0, -1.0..1.0]
        .prop_filter("a direction", |q| q.iter().map(|x| x * x).sum::<f64>() > 0.01)
}

fn start(moments: [f64; 3], q: [f64; 4], omega: [f64; 3]) -> (Body, Point<Dd>) {
    let body = Body::free(Inertia::from_moments(moments).unwrap());
    let start = body.enter_omega(Quat::from_components(q), Vec3(omega)).unwrap();
    (body, start)
}

fn apart(a: &Point<Dd>, b: &Point<Dd>) -> f64 {
    let m = (a.momentum_body - b.momentum_body).norm() / a.momentum_body.norm();
    m.magnitude() + rotation_angle(a.attitude, b.attitude).magnitude()
}

/// Sign and size, the size log-uniform over `decades` below one, down to the smallest double.
fn any_size(decades: f64) -> impl Strategy<Value = f64> {
    (-decades..0.0, any::<bool>()).prop_map(|(exponent, negative)| {
        let size = libm::exp10(exponent).max(f64::from_bits(1));
        if negative { -size } else { size }
    })
}

/// What `at` must tell at any time: finite numbers, a unit quaternion, L in space, the energy, and Euler's equations
/// by a central difference.
fn check_motion(inertia: &Inertia, omega: nalgebra::Vector3<f64>, t: f64) -> Result<(), TestCaseError> {
    let motion = FreeMotion::from_omega(inertia, Default::default(), omega).unwrap();
    let start = motion.at(0.0).unwrap();
    let (l, twice_energy) = (start.momentum(), start.momentum().dot(&omega));
    let d = 1.0 / f64::from(1_u32 << 13);
    let [before, now, after] = [-d, 0.0, d].map(|d| motion.at(t + d).unwrap());
    let spin = motion.omega_at(t).unwrap();
    prop_assert!(now.is_finite() && spin.iter().all(|w| w.is_finite()), "{now:?}");
    let norm = now.attitude.norm_squared();
    prop_assert!((norm - 1.0).abs() < 1e-14, "|q|^2 = {norm}");
    let turned = (now.rotation() * now.momentum() - l).norm() / l.norm();
    prop_assert!(turned < 1e-14, "L in space is off by {turned:e}");
    let lost = (now.momentum().dot(&spin) - twice_energy).abs() / twice_energy;
    prop_assert!(lost < 1e-14, "the energy is off by {lost:e}");
    let momentum_rate = (after.momentum() - before.momentum()) / (2.0 * d);
    let residual = (momentum_rate - now.momentum().cross(&spin)).norm() / l.norm();
    prop_assert!(residual < 1e-7, "m' is off by {residual:e}");
    let attitude_rate = (after.attitude - before.attitude) * (0.5 / d);
    let residual = (attitude_rate - now.attitude.rate(spin.into())).magnitude();
    prop_assert!(residual < 1e-7, "q' is off by {residual:e}");
    Ok(())
}

proptest! {
    #![proptest_config(crate::cases::usual(2000))]

    #[test]
    fn a_turn_about_the_middle_axis_is_exact_at_any_deviation(
        [a, b, c] in [0.01..1.0_f64, 0.01..1.0, 0.01..1.0], near in any_size(16.0),
        low in any_size(324.0), high in any_size(324.0), both in any::<u8>(), middle in any_size(1.0),
        t in any_size(8.0),
    ) {
        // one of the moments may agree with the middle one to any digit
        let mut moments = [b + c, a + c, a + b];
        moments.sort_by(f64::total_cmp);
        if both & 1 == 1 {
            moments[0] = moments[1] * (1.0 - 0.99 * near.abs());
        } else if both & 2 == 2 {
            moments[2] = moments[1] * (1.0 + near.abs());
        }
        moments[2] = moments[2].min(moments[0] + moments[1]);
        moments.rotate_left(usize::from(both) % 3);
        let mut order = [0, 1, 2];
        order.sort_by(|&j, &k| moments[j].total_cmp(&moments[k]));
        let mut omega = [0.0; 3];
        omega[order[0]] = if both & 12 == 12 { 0.0 } else { low };
        omega[order[1]] = middle;
        omega[order[2]] = if both & 12 == 8 { 0.0 } else { high };
        check_motion(&Inertia::from_moments(moments).unwrap(), omega.into(), 1e5 * t)?;
    }

    #[test]
    fn a_near_sphere_is_exact_as_arithmetic_leaves_it(
        ulps in [0..9_u8, 0..9, 0..9], frame in any_attitude(), omega in any_vector(), axis in 0..4_usize,
        off in any_size(40.0).prop_map(|x| 1e-15 * x), t in any_size(8.0),
    ) {
        let turn: nalgebra::UnitQuaternion<f64> = Quat::from_components(frame).into();
        let r = turn.to_rotation_matrix();
        let moments = ulps.map(|n| 1.0 + f64::from(n) * f64::EPSILON);
        let tensor = r.matrix() * nalgebra::Matrix3::from_diagonal(&moments.into()) * r.matrix().transpose();
        let tensor = match ulps[0] {
            0 => nalgebra::Matrix3::from_diagonal(&tensor.diagonal()),
            1 => tensor.map(|entry| if entry.abs() < 0.5 { off } else { entry }),
            _ => tensor,
        };
        let inertia = Inertia::from_tensor((tensor + tensor.transpose()) * 0.5).unwrap();
        let mut omega = nalgebra::Vector3::from(omega);
        if let Some(component) = omega.iter().copied().nth(axis) {
            omega = nalgebra::Vector3::ith(axis, component + 0.1 * component.signum());
        }
        check_motion(&inertia, omega, 1e5 * t)?;
    }
}

proptest! {
    #![proptest_config(crate::cases::usual(200))]

    #[test]
    fn exact_motion_keeps_energy_and_momentum_in_space(
        moments in any_moments(), q in any_attitude(), omega in any_vector(), t in -1e6..1e6_f64,
    ) {
        let (body, start) = start(moments, q, omega);
        let x = FreeMotion::from_point(body.inertia(), start).point_at_dd(Dd::from(t));
        let l = x.momentum_space() - start.momentum_space();
        prop_assert!(l.norm().magnitude() < 1e-26 * start.momentum_body.norm().magnitude());
        let energy = |x: &Point<Dd>| x.momentum_body.dot(x.momentum_body.times(body.rotor().inverse_moments()));
        prop_assert!((energy(&x) / energy(&start) - Dd::ONE).magnitude() < 1e-26);
    }

    #[test]
    fn exact_motion_is_a_flow(
        moments in any_moments(), q in any_attitude(), omega in any_vector(), s in -100.0..100.0_f64, t in -100.0..100.0_f64,
    ) {
        let (body, start) = start(moments, q, omega);
        let motion = FreeMotion::from_point(body.inertia(), start);
        let there = motion.point_at_dd(Dd::from(s));
        let in_two = FreeMotion::from_point(body.inertia(), there).point_at_dd(Dd::from(t));
        let at_once = motion.point_at_dd(Dd::from(s) + Dd::from(t));
        // a start rounded at 1e-32 moves away at most exponentially near the unstable axis; the worst of these cases
        // is 4e-30 away
        prop_assert!(apart(&in_two, &at_once) < 1e-27, "{:e}", apart(&in_two, &at_once));
        let back = FreeMotion::from_point(body.inertia(), there).point_at_dd(-Dd::from(s));
        prop_assert!(apart(&back, &start) < 1e-27, "{:e}", apart(&back, &start));
    }

    #[test]
    fn exact_motion_solves_the_equations_of_motion(
        moments in any_moments(), q in any_attitude(), omega in any_vector(), t in -100.0..100.0_f64,
    ) {
        let (body, start) = start(moments, q, omega);
        let motion = FreeMotion::from_point(body.inertia(), start);
        // sixth-order central differences, truncation and rounding both below 1e-20
        let d = 1.0 / f64::from(1_u32 << 14);
        let at = |k: f64| motion.point_at_dd(Dd::from(t) + Dd::from(k * d)).phase();
        let difference = |k: f64| at(k) + at(-k) * Dd::of(-1.0);
        let rate = difference(1.0) * (Dd::of(45.0) / Dd::of(60.0 * d))
            + difference(2.0) * (Dd::of(-9.0) / Dd::of(60.0 * d))
            + difference(3.0) * (Dd::ONE / Dd::of(60.0 * d));
        let x = at(0.0);
        let omega = x.momentum_body.times(body.rotor().inverse_moments());
        let speed = omega.norm().magnitude();
        let m_residual = rate.momentum_body - x.momentum_body.cross(omega);
        let q_residual = rate.attitude - x.attitude.rate(omega);
        let scale = 1.0 + libm::pow(speed, 7.0);
        prop_assert!(m_residual.magnitude() < 1e-19 * scale * x.momentum_body.magnitude(), "{:e}", m_residual.magnitude());
        prop_assert!(q_residual.magnitude() < 1e-19 * scale, "{:e}", q_residual.magnitude());
    }

    #[test]
    fn conservative_methods_keep_their_invariants_to_rounding(
        moments in any_moments(), q in any_attitude(), omega in any_vector(),
    ) {
        let (body, inside) = start(moments, q, omega);
        let start = body.leave(&inside);
        let speed = body.omega_of(&inside).amax();
        for name in ["lie-poisson", "rattle", "implicit-midpoint"] {
            let mut run = Run::new(&method(name).unwrap(), &body, &start, 0.05 / speed).unwrap();
            let sample = run.advance_to(1000).unwrap();
            prop_assert!(sample.worst.momentum_norm.unwrap() < 5e-15, "{name}: |m| {:e}", sample.worst.momentum_norm.unwrap());
            prop_assert!(sample.worst.momentum_vector.unwrap() < 1e-14, "{name}: L {:e}", sample.worst.momentum_vector.unwrap());
            prop_assert!(name == "lie-poisson" || sample.worst.energy.unwrap() < 1e-14, "{name}: E {:e}", sample.worst.energy.unwrap());
        }
    }

    #[test]
    fn a_typed_tensor_moves_as_its_principal_moments_do(
        moments in any_moments(), frame in any_attitude(), omega in any_vector(), t in -100.0..100.0_f64,
    ) {
        let (plain, start) = start(moments, [1.0, 0.0, 0.0, 0.0], omega);
        let turn: nalgebra::UnitQuaternion<f64> = Quat::from_components(frame).into();
        let r = turn.to_rotation_matrix();
        let tensor = r.matrix() * nalgebra::Matrix3::from_diagonal(&moments.into()) * r.matrix().transpose();
        let inertia = Inertia::from_tensor((tensor + tensor.transpose()) * 0.5).unwrap();
        let turned = FreeMotion::from_omega(&inertia, turn.inverse(), turn * nalgebra::Vector3::from(omega)).unwrap();
        let straight = FreeMotion::from_point(plain.inertia(), start).at(t).unwrap();
        let momentum = turn.inverse() * turned.at(t).unwrap().momentum();
        // the rotated tensor is rounded at 1e-16, which moves the phase by as much per radian, and more near the separatrix
        let error = (momentum - straight.momentum()).norm() / straight.momentum().norm();
        prop_assert!(error < 1e-11, "{error:e}"); // the worst of these cases: 7e-14
    }
}

#[test]
fn invariants_do_not_depend_on_the_frame_of_the_input() {
    let tensor = nalgebra::Matrix3::new(2.0, -0.25, 0.0, -0.25, 3.0, 0.5, 0.0, 0.5, 4.0);
    let body = Body::free(Inertia::from_tensor(tensor).unwrap());
    let omega = nalgebra::Vector3::new(0.5, 1.0, -0.25);
    let start = body.state(Default::default(), omega).unwrap();
    let inside = body.enter(&start).unwrap();
    let energy = Invariants::of(&body, Time::from_seconds(0.0), &inside.to_f64()).energy.hi() * body.scale();
    approx::assert_relative_eq!(energy, 0.5 * omega.dot(&(tensor * omega)), max_relative = 1e-15);
    approx::assert_relative_eq!(start.momentum(), tensor * omega, max_relative = 1e-15);
}

/// The same up to the rounding of the quaternion that was multiplied.
fn assert_same_start(a: &Point<Dd>, b: &Point<Dd>) {
    assert!(apart(a, b) < 1e-15, "{a:?} {b:?}");
}

#[test]
fn an_attitude_may_have_any_norm_but_zero() {
    let body = Body::free(Inertia::from_moments([2.0, 3.0, 4.0]).unwrap());
    let enter = |q: [f64; 4]| body.enter_omega(Quat::from_components(q), Vec3([0.5, 1.0, -0.25]));
    let usual = enter([0.5, 0.25, -0.75, 1.0]).unwrap();
    for exponent in [-1070, -600, 600, 1020] {
        assert_eq!(
            enter([0.5, 0.25, -0.75, 1.0].map(|x| libm::scalbn(x, exponent))),
            Ok(usual),
            "2^{exponent}"
        );
    }
    assert_eq!(enter([0.0, -0.0, 0.0, 0.0]), Err(StateError::NoAttitude));
    // the other doors: a state of any norm moves as that of norm 1
    let momentum_body = Vec3([1.0, 3.0, -1.0]);
    let state = |size: f64| State {
        attitude: Quat::from_components([0.5, 0.25, -0.75, 1.0].map(|x| x * size)),
        momentum_body,
    };
    let unit = body.enter(&state(1.0)).unwrap();
    for size in [1.0 + 1e-7, 1.001, 3.0, 1e-200, 1e200] {
        let entered = body.enter(&state(size)).unwrap();
        assert_same_start(&entered, &unit);
        let mut run = Run::new(&method("rattle").unwrap(), &body, &state(size), 0.01).unwrap();
        let worst = run.advance_to(1000).unwrap().worst;
        assert!(worst.momentum_vector.unwrap() < 1e-14, "|q| times {size:e}: {worst:?}");
        let exact = FreeMotion::from_state(body.inertia(), &state(size)).unwrap().at(1.0).unwrap();
        assert!((exact.attitude.norm_squared() - 1.0).abs() < 1e-15, "|q| times {size:e}");
    }
    let rounded = State { attitude: Quat::zero(), momentum_body: Vec3([1.0, 3.0, -1.0]) };
    assert_eq!(body.enter(&rounded), Err(StateError::NoAttitude));
}

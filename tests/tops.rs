//! Heavy tops against fixtures of 32 digits (tests/data/tops, mpmath).

use core::f64::consts::PI;

use crate::fixtures::{TopCase, tops};
use polhode::body::{Body, Clock, Point, State, Time};
use polhode::flow::{Casimir, Flow, FreeFlow, FreeMotion, LagrangeError, LagrangeTop, SymmetricTop};
use polhode::inertia::Inertia;
use polhode::method::method;
use polhode::num::{Dd, Precise, Real};
use polhode::observe::secular_drift;
use polhode::rotation::{Quat, Vec3, rotation_angle};
use polhode::run::{Run, Schedule};

/// The body and its start in the solver frame.
fn problem(case: &TopCase) -> (Body, Point<Dd>) {
    let inertia = Inertia::from_positive_moments(case.free.moments).unwrap();
    let body = Body::heavy(inertia, case.weight_moment.into()).unwrap();
    let attitude = Quat::from_components(case.free.attitude);
    let start = if case.free.from_omega {
        body.enter_omega(attitude, Vec3(case.free.start))
    } else {
        body.enter(&State { attitude, momentum_body: Vec3(case.free.start) })
    };
    let start = start.unwrap();
    (body, start)
}

/// Attitude error in rad and momentum error over |m| of a point of the solver frame.
fn errors<S: Precise>(case: &TopCase, body: &Body, x: &Point<S>) -> [f64; 2] {
    let scale = Dd::of(body.scale());
    let q = Quat::from_components(x.attitude.components().map(S::to_dd));
    let m = Vec3(x.momentum_body.0.map(|m| m.to_dd() * scale));
    let exact = Quat::from_components(case.free.result);
    let momentum = Vec3(case.free.momentum);
    // the lift is continuous: the sign of q is part of the answer
    let same_sheet = (q - exact).magnitude() < 1.0;
    let attitude = if same_sheet { rotation_angle(q, exact).hi() } else { 2.0 * PI };
    [attitude, ((m - momentum).norm() / momentum.norm()).hi()]
}

fn is_symmetric(case: &TopCase) -> bool {
    let (body, start) = problem(case);
    LagrangeTop::from_point(&body, start).is_ok()
}

/// The scalars in which the closed form is evaluated.
trait Evaluated: Precise {
    fn state(top: &LagrangeTop, t: f64) -> Point<Self>;
}
impl Evaluated for f64 {
    fn state(top: &LagrangeTop, t: f64) -> Point<f64> {
        top.point_at(t)
    }
}
impl Evaluated for Dd {
    fn state(top: &LagrangeTop, t: f64) -> Point<Dd> {
        top.point_at_dd(Dd::from(t))
    }
}

fn closed_form<S: Evaluated>() -> f64 {
    let mut worst = 0.0_f64;
    for case in tops("reference.csv").iter().filter(|case| is_symmetric(case)) {
        let (body, start) = problem(case);
        let top = LagrangeTop::from_point(&body, start).unwrap();
        let [attitude, momentum] = errors(case, &body, &S::state(&top, case.free.t));
        println!("{:22} t = {:6}: {attitude:.1e} rad, {momentum:.1e}", case.free.scenario, case.free.t);
        worst = worst.max(attitude).max(momentum);
        assert!(attitude.is_finite() && momentum.is_finite(), "{}", case.free.scenario);
    }
    worst
}

#[test]
fn the_closed_form_is_exact_in_every_regime() {
    let worst = closed_form::<f64>();
    assert!(worst < 1e-14, "{worst:.1e}");
}

#[test]
fn the_closed_form_in_double_double_is_exact_to_conditioning() {
    // steady precession is a double zero of the cubic: its turning points have half the digits
    let worst = closed_form::<Dd>();
    assert!(worst < 2e-16, "{worst:.1e}");
}

/// Largest violation of Euler's equations and of q' = ½ q ω along the motion at `t`, relative to the fastest rate,
/// by central differences of order 6 in double-double.
fn residual(top: &LagrangeTop, t: f64, rate: f64) -> f64 {
    let body = top.body();
    let h = libm::exp2(libm::round(libm::log2(0.000_1 / rate)));
    let at = |k: f64| top.point_at_dd(Dd::from(t) + Dd::of(k * h)).phase();
    let difference = |k: f64| at(k) + at(-k) * Dd::of(-1.0);
    let slope = (difference(1.0) * Dd::of(45.0) + difference(2.0) * Dd::of(-9.0) + difference(3.0))
        * (Dd::ONE / Dd::of(60.0 * h));
    let x = at(0.0);
    let omega = x.momentum_body.times(body.rotor().inverse_moments());
    let torque = body.linear_potential::<Dd>().unwrap().torque(x.attitude);
    let momentum = slope.momentum_body - x.momentum_body.cross(omega) - torque;
    let attitude = slope.attitude - x.attitude.rate(omega);
    let size = x.momentum_body.magnitude().max(rate);
    ((momentum.magnitude() / size).max(attitude.magnitude())) / rate
}

#[test]
fn the_closed_form_solves_the_equations_of_motion_at_every_scale() {
    let mut worst = (0.0_f64, String::new());
    let mut count = 0;
    for weight in [1e-12, 1e-4, 0.3, 2.0, 1e4] {
        let inertia = Inertia::from_moments([1.25, 1.25, 0.75]).unwrap();
        let body = Body::heavy(inertia, [0.0, 0.0, weight].into()).unwrap();
        let falling = libm::sqrt(weight);
        for tilt in [0.0, 1e-12, 1e-8, 1e-4, 0.1, 1.0, 2.0, 3.0, 3.13, PI] {
            for spin in [0.0, 1e-3, 0.7, -2.0, 3.0, 40.0, 1e6] {
                for (across, along) in
                    [(0.0, 0.0), (1e-9, 0.0), (0.3, 0.0), (0.0, -0.6), (1.0, 2.0), (-1e6, 1e3)]
                {
                    let omega = [across, along, spin].map(|w| w * falling);
                    let (sin, cos) = libm::sincos(tilt / 2.0);
                    let start =
                        body.enter_omega(Quat::from_components([cos, sin, 0.0, 0.0]), Vec3(omega)).unwrap();
                    let top = LagrangeTop::from_point(&body, start).unwrap();
                    let rate = falling * (1.0 + spin.abs() + f64::abs(across) + f64::abs(along));
                    for t in [0.0, 1.3, -70.0] {
                        let found = residual(&top, t / rate, rate);
                        count += 1;
                        assert!(found.is_finite());
                        if found > worst.0 {
                            worst = (found, format!("c {weight:e}, tilt {tilt:e}, omega {omega:?}, t {t}"));
                        }
                    }
                    let back = top.point_at_dd(Dd::ZERO);
                    let off = (back.attitude - start.attitude.normalized()).magnitude();
                    assert!(
                        off < 1e-15,
                        "start off by {off:.1e}: c {weight:e}, tilt {tilt:e}, omega {omega:?}"
                    );
                }
            }
        }
    }
    println!("{count} residuals, the largest {:.1e}: {}", worst.0, worst.1);
    assert!(worst.0 < 1e-20, "{:.1e}: {}", worst.0, worst.1);
}

#[test]
fn a_ball_may_carry_its_weight_in_any_direction() {
    let inertia = Inertia::from_moments([1.0; 3]).unwrap();
    let attitude = Quat::from_components([0.9, 0.3, 0.2, 0.1]);
    for (across, along) in
        [(0.0, 0.0), (1e-300, 0.0), (1e-24, -2e-20), (1e-16, 3e-17), (-1e-9, 1e-8), (0.4, 2.0)]
    {
        for height in [2.27, 0.0, -2.27] {
            let weight = [across, along, height];
            if weight == [0.0; 3] || Vec3(weight).magnitude() < 1e-200 {
                continue;
            }
            let body = Body::heavy(inertia.clone(), weight.into()).unwrap();
            let start = body.enter_omega(attitude, Vec3([0.4, -0.2, 1.0])).unwrap();
            let top = LagrangeTop::from_point(&body, start).unwrap();
            for t in [0.0, 1.0, 5.0] {
                let found = residual(&top, t, 3.0);
                assert!(found < 1e-20, "c {weight:?}, t {t}: {found:.1e}");
            }
            let off = (top.point_at_dd(Dd::ZERO).attitude - start.attitude).magnitude();
            assert!(off < 1e-29, "c {weight:?}: start off by {off:.1e}");
        }
    }
}

/// `weight` 2²ⁿ and ω 2ⁿ times as large: the same motion 2ⁿ times as fast.
fn sped_up(moments: [f64; 3], weight: [f64; 3], omega: [f64; 3], n: i32) -> (Body, Point<Dd>) {
    let scaled = |v: [f64; 3], n| v.map(|x| libm::scalbn(x, n));
    let inertia = Inertia::from_moments(moments).unwrap();
    let body = Body::heavy(inertia, scaled(weight, 2 * n).into()).unwrap();
    let attitude = Quat::from_components([0.9, 0.3, 0.2, 0.1]);
    let start = body.enter_omega(attitude, Vec3(scaled(omega, n))).unwrap();
    (body, start)
}

#[test]
fn errors_are_those_of_the_same_motion_in_another_unit_of_time() {
    let worst = |n: i32| {
        let (body, start) = sped_up([1.0, 2.0, 2.5], [0.3, 0.1, 1.0], [0.5, 0.1, 1.0], n);
        let method = method("kick-drift:2").unwrap();
        let mut run = Run::new(&method, &body, &body.leave(&start), libm::scalbn(0.01, -n)).unwrap();
        run.advance_to(300).unwrap().worst
    };
    let ordinary = worst(0);
    assert!(ordinary.energy.unwrap() > 1e-9 && ordinary.momentum_z.unwrap() > 1e-18, "{ordinary:?}");
    for n in [-380, -260, -10, 10, 260, 380] {
        assert_eq!(worst(n), ordinary, "2^{n}");
    }
}

#[test]
fn the_closed_form_has_the_same_bits_in_any_unit_of_time() {
    for (moments, weight) in [([1.25, 1.25, 0.75], [0.0, 0.0, 2.0]), ([1.5; 3], [0.3, -0.7, 0.1])] {
        for omega in [[0.0; 3], [0.4, -0.2, 1.0], [1e-30, 0.0, 0.0], [0.0, 1e-9, 40.0], [1e20, 0.0, 1e20]] {
            let fast = omega.into_iter().fold(1.0, f64::max);
            let at = |n: i32| {
                let (body, start) = sped_up(moments, weight, omega, n);
                let top = LagrangeTop::from_point(&body, start).unwrap();
                let t = libm::scalbn(1.7 / fast, -n);
                assert!(top.reach() > t && top.reach().is_finite());
                let x = top.point_at(t);
                let period = top.nutation_period().map(|period| libm::scalbn(period, n));
                (x.attitude, x.momentum_body.0.map(|m| libm::scalbn(m, -n)), period)
            };
            let ordinary = at(0);
            assert!(ordinary.0.magnitude() <= 1.0);
            // as far as the energy is a double
            let range = if fast > 1e10 { -300..=300 } else { -380..=380 };
            for n in [-380, -300, -255, -100, 1, 7, 101, 256, 300, 380] {
                if range.contains(&n) && (Vec3(omega).magnitude() > 1e-20 || n > -300) {
                    assert_eq!(at(n), ordinary, "c {weight:?}, omega {omega:?}, 2^{n}");
                }
            }
        }
    }
}

#[test]
fn a_weight_that_no_double_tells_from_none_is_refused() {
    let refusal = |weight: f64, attitude: [f64; 4], omega: [f64; 3]| {
        let inertia = Inertia::from_moments([1.0, 1.0, 1.5]).unwrap();
        let body = Body::heavy(inertia, [0.0, 0.0, weight].into()).unwrap();
        let start = body.enter_omega(Quat::from_components(attitude), Vec3(omega)).unwrap();
        LagrangeTop::from_point(&body, start).err()
    };
    let tilted = [0.9, 0.3, 0.2, 0.1];
    assert_eq!(refusal(1e-70, tilted, [0.0, 0.1, 1.0]), None);
    let weak = refusal(1e-200, tilted, [0.0, 0.1, 1.0]);
    assert!(matches!(weak, Some(LagrangeError::Weak { ratio }) if ratio < 1e-199), "{weak:?}");
    assert_eq!(refusal(1.0, [1.0, 1e-69, 0.0, 0.0], [0.0; 3]), None);
    let upright = refusal(1.0, [1.0, 1e-160, 0.0, 0.0], [0.0; 3]);
    assert!(matches!(upright, Some(LagrangeError::Upright { tilt }) if tilt < 1e-159), "{upright:?}");
}

#[test]
fn next_to_the_separatrix_of_the_sleeping_top_no_digits_are_lost() {
    let inertia = Inertia::from_moments([1.0, 1.0, 0.5]).unwrap();
    let body = Body::heavy(inertia, [0.0, 0.0, 1.0].into()).unwrap();
    let mut worst = 0.0_f64;
    for tilt in [1e-14, 1e-12, 1e-9, 1e-6, 1e-4, 1e-2, 0.1] {
        for delta in [0.0, 1e-14, -1e-14, 1e-10, -1e-10, 1e-6, -1e-6, 1e-3, -1e-3, 0.03, -0.03] {
            let (sin, cos) = libm::sincos(tilt / 2.0);
            let attitude = Quat::from_components([cos, sin, 0.0, 0.0]);
            let start = body.enter_omega(attitude, Vec3([0.0, 0.0, 4.0 * (1.0 + delta)])).unwrap();
            let top = LagrangeTop::from_point(&body, start).unwrap();
            for t in [0.3, -2.0, 17.0, 1e3, 1e5, 1e7, 1e12] {
                let (rough, exact) = (top.point_at(t), top.point_at_dd(Dd::from(t)));
                let error = rotation_angle(rough.to_dd().attitude, exact.attitude).hi();
                assert!(error < 1e-14, "tilt {tilt:e}, spin off by {delta:e}, t {t:e}: {error:.1e} rad");
                worst = worst.max(error);
            }
        }
    }
    println!("{worst:.1e} rad");
}

/// By theta functions in `f64`, by Carlson's integrals in double-double: steady precession, cusps and loops, passages through
/// the vertical, plane pendulums, slow tops and fast ones, weights on either side, after up to 1e14 rad.
#[test]
fn the_quick_form_agrees_with_double_double_at_any_time() {
    let mut worst = 0.0_f64;
    for (moments, axis) in [([1.25, 1.25, 0.75], 2), ([1.5, 1.0, 1.0], 0), ([1.0; 3], 1)] {
        for weight in [1e-50, 1e-9, 0.3, -2.0, 40.0] {
            let mut weight_moment = [0.0; 3];
            weight_moment[axis] = weight;
            let body = Body::heavy(Inertia::from_moments(moments).unwrap(), weight_moment.into()).unwrap();
            for tilt in [0.3, 1.0, 2.0, 2.9] {
                for [along, across, off] in
                    [[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [-2.0, 0.1, 0.4], [7.0, 1.0, 1e-9]]
                {
                    let (mut omega, mut q) = (Vec3([off; 3]), Vec3::zero());
                    (omega[axis], omega[(axis + 1) % 3]) = (along, across);
                    let (sin, cos) = libm::sincos(tilt / 2.0);
                    // the axis of the weight first to the vertical, then tilted
                    let upright = Quat::new(1.0, Vec3::unit(axis).cross(Vec3::unit(2))).normalized();
                    let upright = if axis == 2 { Quat::identity() } else { upright };
                    q[0] = sin;
                    let start = body.enter_omega(Quat::new(cos, q) * upright, omega).unwrap();
                    let top = LagrangeTop::from_point(&body, start).unwrap();
                    let rate = libm::sqrt(f64::abs(weight)) + omega.norm();
                    let times = [0.1, -1.3, 7.7, 70.0, 1e4, 1e9, 1e14].map(|angle| angle / rate);
                    for t in times {
                        let (rough, exact) = (top.point_at(t).to_dd(), top.point_at_dd(Dd::from(t)));
                        let attitude = (rough.attitude - exact.attitude).magnitude();
                        let size = rate * 1.5;
                        let momentum = (rough.momentum_body - exact.momentum_body).magnitude() / size;
                        assert!(
                            attitude < 3e-15 && momentum < 3e-15,
                            "{moments:?}, c {weight:e}, tilt {tilt}, {omega:?}, t {t:e}: {attitude:.1e}, {momentum:.1e}"
                        );
                        worst = worst.max(attitude).max(momentum);
                    }
                    let many = top.at_many(&times).unwrap();
                    assert!(times.iter().zip(many).all(|(&t, state)| top.at(t).unwrap() == state));
                }
            }
        }
    }
    println!("{worst:.1e}");
}

/// Tops that fall from ever nearer to the vertical: from both forms of the theta functions to the separatrix, where neither is
/// taken.
#[test]
fn a_top_that_falls_from_next_to_the_vertical_keeps_its_digits() {
    let mut worst = 0.0_f64;
    for (moments, weight) in [([1.0, 1.0, 0.5], 1.0), ([1.0, 1.0, 1.5], 1.0), ([1.0, 1.0, 0.5], -1.0)] {
        let body = Body::heavy(Inertia::from_moments(moments).unwrap(), [0.0, 0.0, weight].into()).unwrap();
        for half_decades in 0..138 {
            let tilt = libm::exp10(-0.5 * f64::from(half_decades));
            let (sin, cos) = libm::sincos(tilt / 2.0);
            let attitude = if weight > 0.0 { [cos, sin, 0.0, 0.0] } else { [sin, cos, 0.0, 0.0] };
            for (spin, across) in [(0.0, 0.0), (0.7, 0.0), (-0.4, 0.3 * tilt), (0.2, -1.7 * tilt)] {
                let start = body.enter_omega(Quat::from_components(attitude), Vec3([across, 0.0, spin]));
                let top = LagrangeTop::from_point(&body, start.unwrap()).unwrap();
                for t in [0.4, -3.0, 11.0, 40.0, 130.0, 1e5, 1e9] {
                    let (rough, exact) = (top.point_at(t).to_dd(), top.point_at_dd(Dd::from(t)));
                    let attitude = (rough.attitude - exact.attitude).magnitude();
                    let momentum = (rough.momentum_body - exact.momentum_body).magnitude();
                    assert!(
                        attitude < 5e-15 && momentum < 5e-15,
                        "{moments:?}, c {weight}, tilt {tilt:e}, spin {spin}, t {t}: {attitude:.1e}, {momentum:.1e}"
                    );
                    worst = worst.max(attitude).max(momentum);
                }
            }
        }
    }
    println!("falling: {worst:.1e}");
}

fn top(name: &str) -> LagrangeTop {
    let case = tops("reference.csv").into_iter().find(|case| case.free.scenario == name).unwrap();
    let (body, start) = problem(&case);
    LagrangeTop::from_point(&body, start).unwrap()
}

#[test]
fn readings_are_those_of_the_integrals() {
    // mpmath 1.3, 30 digits: zeros of the cubic by polyroots, period and advance of φ by quad over u = u₁ + (u₂ − u₁) sin²s
    for (name, upper, lower, period, advance) in [
        (
            "generic",
            0.281_250_944_725_356_84,
            1.744_758_611_782_057,
            4.246_493_898_974_807,
            2.738_270_332_894_198_6,
        ),
        (
            "loops",
            0.927_295_218_001_612_2,
            1.909_926_538_506_683,
            1.581_008_026_640_709_2,
            0.555_137_690_136_276,
        ),
        (
            "spherical-pendulum",
            0.854_905_800_490_770_3,
            2.890_514_453_280_401,
            3.331_518_470_103_636_4,
            4.823_327_910_741_519,
        ),
        (
            "generic-flat",
            0.374_073_105_125_423_6,
            0.913_091_044_513_088_4,
            2.605_690_916_454_430_8,
            2.003_150_655_323_626,
        ),
    ] {
        let top = top(name);
        let [highest, lowest] = top.turning_points();
        let close = |a: f64, b: f64| assert!((a / b - 1.0).abs() < 1e-15, "{name}: {a} for {b}");
        close(highest, upper);
        close(lowest, lower);
        close(top.nutation_period().unwrap(), period);
        close(top.precession_per_nutation().unwrap(), advance);
        // at a turning point all energy is potential
        let energy = top.body().energy_of(Time::from_seconds(0.0), &top.point_at_dd(Dd::ZERO)).hi();
        for tilt in [highest, lowest] {
            assert!((top.effective_potential(tilt) / energy - 1.0).abs() < 1e-13, "{name}");
        }
    }
    assert_eq!(top("sleeping").nutation_period(), None);
    assert_eq!(top("sleeping").turning_points(), [0.0; 2]);
    assert_eq!(top("hanging-spin").turning_points(), [PI; 2]);
}

#[test]
fn a_body_that_is_no_lagrange_top_is_refused_with_the_condition_and_its_size() {
    let refusal = |moments: [f64; 3], weight: [f64; 3]| {
        let body = Body::heavy(Inertia::from_moments(moments).unwrap(), weight.into()).unwrap();
        LagrangeTop::from_omega(&body, Default::default(), [1.0, 2.0, 3.0].into()).unwrap_err()
    };
    assert_eq!(refusal([1.0, 1.0, 0.5], [0.0; 3]), LagrangeError::Free);
    assert_eq!(
        refusal([1.0, 1.5, 2.0], [0.0, 0.0, 1.0]).to_string(),
        "principal moments 1, 1.5, 2: a Lagrange top has two equal ones; here the closest differ by 1.111e-1 of their sum (at \
         most 1e-12 is allowed)"
    );
    assert_eq!(
        refusal([1.0, 1.0, 0.5], [0.0, 1e-3, 1.0]).to_string(),
        "the weight moment is 1.000e-3 rad away from the symmetry axis (at most 1e-12 is allowed); that of a Lagrange top lies on the axis"
    );
    let body = Body::heavy(Inertia::from_moments([1.0, 1.0, 1.5]).unwrap(), [0.0, 0.0, 1.0].into()).unwrap();
    let top = LagrangeTop::from_omega(&body, Default::default(), [1.0, 2.0, 3.0].into()).unwrap();
    assert!(top.at(f64::NAN).is_err());
}

/// The state of the fixture after steps of about `h`, by `name`.
fn stepped(case: &TopCase, name: &str, h: f64) -> [f64; 2] {
    let (body, start) = problem(case);
    let steps = libm::ceil(case.free.t / h);
    let mut x = start.to_f64();
    let clock = Clock::new(case.free.t / steps);
    method(name).unwrap().prepare_f64(clock, &body).unwrap().steps(&mut x, steps as u64);
    errors(case, &body, &x)
}

#[test]
fn published_problems_are_met_by_stepping() {
    let steps =
        [("E3-asymmetric", 0.002), ("E3-symmetric", 0.002), ("E8", 0.001), ("E9", 0.0002), ("E10", 0.002)];
    for case in tops("reference.csv") {
        if let Some((name, h)) = steps.iter().find(|(name, _)| case.free.scenario == *name) {
            let [attitude, momentum] = stepped(&case, "kick-drift:4", *h);
            println!("{name} t = {}: {attitude:.1e} rad, {momentum:.1e}", case.free.t);
            assert!(attitude < 1e-9 && momentum < 1e-9, "{name}: {attitude:.1e} rad, {momentum:.1e}");
        }
    }
}

#[test]
#[ignore = "a million steps: takes seconds, `.ci/run` does it"]
fn composed_kick_drift_has_no_secular_energy_and_keeps_vertical_momentum_to_round_off() {
    for name in ["E3-asymmetric", "E3-symmetric", "E10"] {
        let case = tops("reference.csv").into_iter().find(|case| case.free.scenario == name).unwrap();
        let (body, start) = problem(&case);
        let start = body.leave(&start);
        let mut run = Run::new(&method("kick-drift:4").unwrap(), &body, &start, 0.01).unwrap();
        let (mut times, mut changes) = (Vec::new(), Vec::new());
        let mut last = None;
        for sample in run.samples(Schedule::every(50, 1_000_000)) {
            let sample = sample.unwrap();
            times.push(sample.elapsed.hi());
            changes.push(sample.energy_change);
            last = Some(sample.worst);
        }
        let (drift, worst) = (secular_drift(&times, &changes).unwrap(), last.unwrap());
        println!("{name}: {drift:?}, {worst:?}");
        assert!(!drift.is_secular(), "{name}: {drift:?}");
        assert!(worst.energy.unwrap() < 1e-8, "{name}: {worst:?}");
        assert!(worst.momentum_z.unwrap() < 1e-14, "{name}: {worst:?}");
    }
}

/// ω and Γ along a run of `kick-drift:4`.
fn along(moments: [f64; 3], weight: f64, q: [f64; 4], m: [f64; 3], h: f64) -> Vec<(Vec3<f64>, Vec3<f64>)> {
    let body = Body::heavy(Inertia::from_moments(moments).unwrap(), [weight, 0.0, 0.0].into()).unwrap();
    let attitude = Quat::from_components(q).normalized();
    let start = State { attitude, momentum_body: Vec3(m) };
    let mut run = Run::new(&method("kick-drift:4").unwrap(), &body, &start, h).unwrap();
    run.samples(Schedule::every(40, 8000))
        .map(|sample| {
            let sample = sample.unwrap();
            (sample.omega_body.into(), sample.state.attitude.rotate_back(Vec3::unit(2)))
        })
        .collect()
}

fn spread(values: impl Iterator<Item = f64> + Clone) -> f64 {
    values.clone().fold(f64::MIN, f64::max) - values.fold(f64::MAX, f64::min)
}

#[test]
fn kovalevskayas_and_goryachev_chaplygins_constants_stand() {
    let weight = 1.3;
    let q = [0.9, 0.2, -0.3, 0.4];
    let kovalevskaya = |(w, up): &(Vec3<f64>, Vec3<f64>)| {
        let re = w[0] * w[0] - w[1] * w[1] - weight * up[0];
        let im = 2.0 * w[0] * w[1] - weight * up[1];
        re * re + im * im
    };
    let constants = |h| {
        let states = along([2.0, 2.0, 1.0], weight, q, [0.7, -0.4, 0.9], h);
        spread(states.iter().map(kovalevskaya))
    };
    let (coarse, fine) = (constants(0.02), constants(0.01));
    println!("Kovalevskaya {coarse:.1e} {fine:.1e}");
    assert!(fine < 1e-8 && libm::log2(coarse / fine) > 3.8, "{coarse:.1e}, {fine:.1e}");

    // m·Γ = 0: no moment about the vertical
    let up = Quat::from_components(q).normalized().rotate_back(Vec3::unit(2));
    let m = Vec3([0.5, -0.3, 0.2]).cross(up) * 2.0;
    let chaplygin =
        |(w, up): &(Vec3<f64>, Vec3<f64>)| w[2] * (w[0] * w[0] + w[1] * w[1]) - weight * w[0] * up[2];
    let constants = |h| spread(along([4.0, 4.0, 1.0], weight, q, m.0, h).iter().map(chaplygin));
    let (coarse, fine) = (constants(0.02), constants(0.01));
    println!("Goryachev and Chaplygin {coarse:.1e} {fine:.1e}");
    assert!(fine < 1e-8 && libm::log2(coarse / fine) > 3.8, "{coarse:.1e}, {fine:.1e}");
}

#[test]
fn every_top_of_the_catalogue_is_a_lagrange_top_that_nutates() {
    for named in polhode::catalogue::tops() {
        let [w, x, y, z] = named.attitude;
        let attitude = nalgebra::UnitQuaternion::from_quaternion(nalgebra::Quaternion::new(w, x, y, z));
        let body = named.body().unwrap();
        let top = LagrangeTop::from_omega(&body, attitude, named.omega_body.into()).unwrap();
        let [upper, lower] = top.turning_points();
        assert!(lower > upper, "{}", named.name);
        // fast tops nutate near |L|/A
        if named.name != "bruls-cardona" {
            let start = body.state(attitude, named.omega_body.into()).unwrap();
            let l = start.momentum().norm();
            let across = body.inertia().tensor()[(0, 0)];
            let expected = (2.0 * PI) * across / l;
            let found = top.nutation_period().unwrap();
            assert!((found / expected - 1.0).abs() < 0.12, "{}: {found} s, {expected} s", named.name);
        }
    }
}

#[test]
fn two_turns_move_a_symmetric_body_as_its_free_motion_does() {
    for moments in [[1.0, 1.0, 0.25], [1.25, 0.75, 0.75], [1.0, 1.75, 1.0], [1.5, 1.5, 1.5]] {
        let body = Body::free(Inertia::from_moments(moments).unwrap());
        let start =
            body.enter_omega(Quat::from_components([0.9, 0.3, -0.2, 0.4]), Vec3([0.4, -0.7, 1.1])).unwrap();
        let flow = SymmetricTop::<Dd>::new(&body.rotor()).unwrap();
        let motion = FreeMotion::from_point(body.inertia(), start);
        for t in [0.0, 1e-9, 0.5, -3.0, 20.0] {
            let mut x = start;
            flow.flow(Time::from_seconds(0.0), Dd::of(t), &mut x);
            let exact = motion.point_at_dd(Dd::of(t));
            let off = (x.attitude - exact.attitude).magnitude()
                + (x.momentum_body - exact.momentum_body).magnitude();
            assert!(off < 1e-28, "{moments:?}, t = {t}: {off:.1e}");
        }
    }
    let asymmetric = Body::free(Inertia::from_moments([1.0, 1.5, 2.0]).unwrap());
    assert!(SymmetricTop::<f64>::new(&asymmetric.rotor()).is_none());
}

#[test]
fn a_ball_turns_about_its_momentum() {
    let body = Body::free(Inertia::from_moments([0.75; 3]).unwrap());
    let start = body.enter_omega(Quat::identity(), Vec3([0.3, 0.6, -0.6])).unwrap();
    let mut x = start;
    let now = Time::from_seconds(0.0);
    Casimir::new(body.rotor().inverse_moments::<Dd>()[0]).flow(now, Dd::of(2.0), &mut x);
    // |ω| = 0.9: an angle of 1.8 rad about ω
    let angle = (rotation_angle(start.attitude, x.attitude) - Dd::of(1.8)).magnitude();
    assert!(angle < 1e-15 && x.momentum_body == start.momentum_body, "{angle:.1e}");
    let mut rest = Point::new(start.attitude, Vec3::zero());
    Casimir::new(Dd::ONE).flow(now, Dd::of(2.0), &mut rest);
    assert_eq!(rest.attitude, start.attitude);
}

#[test]
fn the_sleeping_top_wakes_below_its_threshold_only() {
    // ω₃² = 4 A c/C² = 17.78
    let inertia = Inertia::from_moments([1.25, 1.25, 0.75]).unwrap();
    let body = Body::heavy(inertia, [0.0, 0.0, 1.0].into()).unwrap();
    let threshold = libm::sqrt(4.0 * 1.25) / 0.75;
    let (sin, cos) = libm::sincos(0.5e-3);
    let attitude = nalgebra::UnitQuaternion::from_quaternion(nalgebra::Quaternion::new(cos, sin, 0.0, 0.0));
    let largest_tilt = |factor: f64| {
        let start = body.state(attitude, [0.0, 0.0, threshold * factor].into()).unwrap();
        let exact = LagrangeTop::from_state(&body, &start).unwrap().turning_points()[1];
        let mut run = Run::new(&method("kick-drift:4").unwrap(), &body, &start, 0.02).unwrap();
        let stepped = run.samples(Schedule::every(1, 20_000)).fold(0.0_f64, |tilt, sample| {
            let up = sample.unwrap().state.attitude.rotate_back(Vec3::unit(2));
            tilt.max(libm::atan2(libm::hypot(up[0], up[1]), up[2]))
        });
        assert!((stepped / exact - 1.0).abs() < 1e-3, "{factor}: {stepped} by steps, {exact} exactly");
        exact
    };
    assert!(largest_tilt(1.01) < 0.01);
    assert!(largest_tilt(0.99) > 0.1);
}

#[test]
fn the_free_flow_is_the_free_motion_over_short_times_and_long_ones() {
    let body = Body::free(Inertia::from_moments([1.0, 1.75, 2.0]).unwrap());
    let start =
        body.enter_omega(Quat::from_components([0.9, 0.3, -0.2, 0.4]), Vec3([0.4, -0.7, 1.1])).unwrap();
    let motion = FreeMotion::from_point(body.inertia(), start);
    let flow = FreeFlow::<Dd>::new(&body.rotor());
    for t in [1e-9, 1e-3, -0.01, 0.02, 0.5, -3.0] {
        let mut x = start;
        flow.flow(Time::from_seconds(0.0), Dd::of(t), &mut x);
        let exact = motion.point_at_dd(Dd::of(t));
        let off =
            (x.attitude - exact.attitude).magnitude() + (x.momentum_body - exact.momentum_body).magnitude();
        assert!(off < 1e-29, "t = {t}: {off:.1e}");
    }
}

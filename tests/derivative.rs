//! The derivative of the free motion: against fixtures of mpmath (tests/data/derivative), and the laws that it obeys.

use nalgebra::{Matrix3, SMatrix, UnitQuaternion, Vector3};

use crate::fixtures::{DerivativeCase, derivatives};
use polhode::body::{Body, State};
use polhode::flow::{DerivativeError, FreeMotion, StateDerivative, TurnAxes};
use polhode::inertia::Inertia;
use polhode::rotation::{Quat, Vec3};

pub(crate) type Six = SMatrix<f64, 6, 6>;

fn motion(case: &DerivativeCase) -> FreeMotion {
    let body = Body::free(Inertia::from_moments(case.moments).unwrap());
    let q0 = Quat::from_components(case.attitude);
    let start = if case.from_omega {
        body.enter_omega(q0, Vec3(case.start))
    } else {
        body.enter(&State { attitude: q0, momentum_body: Vec3(case.start) })
    };
    FreeMotion::from_point(body.inertia(), start.unwrap())
}

#[test]
fn derivatives_agree_with_mpmath_in_every_regime() {
    let mut worst = std::collections::BTreeMap::<String, (f64, String)>::new();
    for case in derivatives() {
        let motion = motion(&case);
        let found = motion.at_with_derivative(case.t).unwrap();
        let columns = found.by_momentum(TurnAxes::Space).fixed_columns::<9>(3).into_owned();
        // in units of |m| and of the largest moment
        let largest_moment = case.moments.iter().fold(0.0, |a: f64, &b| a.max(b));
        let norm = found.state().momentum().norm();
        let unit = |row: usize, column: usize| {
            let row = if row < 3 { 1.0 } else { 1.0 / norm };
            row * if column < 3 { norm } else { largest_moment }
        };
        let (mut error, mut largest) = (0.0_f64, 0.0_f64);
        for column in 0..9 {
            for row in 0..6 {
                let exact = case.columns[column][row];
                error = error.max((columns[(row, column)] - exact).abs() * unit(row, column));
                largest = largest.max(exact.abs() * unit(row, column));
            }
        }
        let entry = worst.entry(case.regime.clone()).or_default();
        if error / largest > entry.0 {
            *entry = (error / largest, format!("{} at {}", case.scenario, case.t));
        }
    }
    for (regime, (error, case)) in &worst {
        println!("{regime}: {error:.1e} {case}");
        assert!(*error < 2e-14, "{regime}: {error:.1e} {case}");
    }
    let all = worst.values().fold(0.0, |a: f64, (error, _)| a.max(*error));
    assert!(worst.len() > 10 && all > 1e-17, "{} regimes, {all:.1e}", worst.len());
}

fn racket() -> FreeMotion {
    started([1.0, 2.0, 3.0], [0.4, 1.0, -0.3])
}

fn started(moments: [f64; 3], omega: [f64; 3]) -> FreeMotion {
    let tilt = UnitQuaternion::from_euler_angles(0.4, -1.1, 2.0);
    FreeMotion::from_omega(&Inertia::from_moments(moments).unwrap(), tilt, omega.into()).unwrap()
}

/// Bodies of every kind, with starts near and far from steady spins.
fn several() -> Vec<FreeMotion> {
    let bodies =
        [[1.0, 2.0, 3.0 - 1e-9], [2.0, 1.0, 2.0], [1.0, 1.0, 1.0], [0.9, 1.7, 0.9 + 1e-9], [2.5, 1.5, 1.25]];
    let starts = [[0.4, 1.0, -0.3], [0.0, 1.0, 0.0], [1e-7, 2e-9, -0.7], [0.2, 1e-6, 3e-6]];
    bodies.iter().flat_map(|i| starts.iter().map(|w| started(*i, *w))).collect()
}

/// The canonical form on attitudes and momenta, in body axes: `δm₁·θ₂ − θ₁·δm₂ − m·(θ₁ × θ₂)`.
pub(crate) fn form(m: Vector3<f64>) -> Six {
    let mut form = Six::zeros();
    form.fixed_view_mut::<3, 3>(0, 0).copy_from(&m.cross_matrix());
    form.fixed_view_mut::<3, 3>(0, 3).copy_from(&-Matrix3::identity());
    form.fixed_view_mut::<3, 3>(3, 0).copy_from(&Matrix3::identity());
    form
}

#[test]
fn the_derivative_by_the_state_is_symplectic_at_any_time() {
    for motion in several() {
        for t in [0.3, -70.0, 1e6, 1e12] {
            let found = match motion.at_with_derivative(t) {
                Ok(found) => found,
                Err(DerivativeError::OutOfRange { .. }) => continue,
                Err(error) => panic!("{error}"),
            };
            let d = found.by_momentum(TurnAxes::Body).fixed_columns::<6>(0).into_owned();
            let (before, after) = (motion.at(0.0).unwrap().momentum(), found.state().momentum());
            let defect = (d.transpose() * form(after) * d - form(before)).amax();
            let size = d.amax().max(1.0);
            assert!(defect <= 2e-14 * size * size, "t = {t}: {defect:.1e} beside {size:.1e}: {motion:?}");
        }
    }
}

#[test]
fn derivatives_over_two_times_follow_one_another() {
    for motion in several() {
        for (first, then) in [(0.7, 2.0), (300.0, -20.0), (-1e5, 3e5)] {
            let inside = motion.point_at_dd(first.into());
            let second = FreeMotion::from_point(motion.body().inertia(), inside);
            let all = [
                motion.at_with_derivative(first),
                second.at_with_derivative(then),
                motion.at_with_derivative(first + then),
            ];
            let [Ok(a), Ok(b), Ok(whole)] = all else { continue };
            for read in [StateDerivative::by_momentum, StateDerivative::by_omega] {
                for axes in [TurnAxes::Space, TurnAxes::Body] {
                    let [a, b, whole] = [&a, &b, &whole].map(|d| read(d, axes));
                    let by_state = b.fixed_columns::<6>(0);
                    let mut both = by_state * a;
                    let mut tensor = both.fixed_columns_mut::<6>(6);
                    tensor += b.fixed_columns::<6>(6);
                    let error = (both - whole).amax();
                    // both parts may be larger than what they add up to
                    let size = (by_state.abs() * a.abs()).amax().max(b.amax());
                    assert!(
                        error <= 1e-13 * size,
                        "{first} s, {then} s: {error:.1e} beside {size:.1e}: {motion:?}"
                    );
                }
            }
        }
    }
}

#[test]
fn derivatives_are_continuous_where_two_moments_meet() {
    let by = |split: f64, omega: [f64; 3], t: f64| {
        let motion = started([1.0, 1.0 + split, 1.6], omega);
        motion.at_with_derivative(t).unwrap().by_momentum(TurnAxes::Space)
    };
    for (omega, t) in [([0.6, -0.5, 0.7], 20.0), ([0.6, -0.5, 0.7], -3e3), ([0.5, 0.8, 0.0], 50.0)] {
        let symmetric = by(0.0, omega, t);
        for power in 2..=16 {
            let split = libm::exp10(f64::from(-power));
            let change = (by(split, omega, t) - symmetric).amax() / symmetric.amax();
            let allowed = 10.0 * split * t * t + 1e-14;
            assert!(change <= allowed, "1e-{power} at {t}: {change:.1e} beyond {allowed:.1e}");
        }
        // and it does change
        assert!((by(1e-2, omega, t) - symmetric).amax() > 1e-3 * symmetric.amax());
    }
    // in proportion to the difference of the moments, from where rounding ends to where squares begin
    for omega in [[0.6, -0.5, 0.7], [0.5, 0.8, 0.0], [0.1, -0.2, -0.9]] {
        let symmetric = by(0.0, omega, 2.0);
        let per_split = |power: i32| {
            let split = libm::exp10(f64::from(-power));
            (by(split, omega, 2.0) - symmetric) / split
        };
        let rate = per_split(6);
        for power in [2, 3, 4, 5, 7, 8, 9, 10, 11] {
            let off = (per_split(power) - rate).amax() / rate.amax();
            let split = libm::exp10(f64::from(-power));
            let allowed = 10.0 * (split + 1e-6) + 4e-14 / split;
            assert!(off < allowed, "1e-{power}: {off:.1e} beyond {allowed:.1e}");
        }
    }
}

/// Central differences of the motion of the body with this tensor, rotation vectors in space.
fn differences(
    tensor: Matrix3<f64>,
    q0: UnitQuaternion<f64>,
    omega: Vector3<f64>,
    t: f64,
) -> SMatrix<f64, 6, 12> {
    const ENTRIES: [(usize, usize); 6] = [(0, 0), (1, 1), (2, 2), (0, 1), (0, 2), (1, 2)];
    let h = libm::exp2(-17.0);
    let end = |column: usize, e: f64| {
        let (mut tensor, mut q0, mut omega) = (tensor, q0, omega);
        match column {
            0..3 => q0 = UnitQuaternion::from_scaled_axis(Vector3::ith(column, e)) * q0,
            3..6 => omega[column - 3] += e,
            _ => {
                let (i, j) = ENTRIES[column - 6];
                tensor[(i, j)] += e;
                tensor[(j, i)] = tensor[(i, j)];
            }
        }
        let motion = FreeMotion::from_omega(&Inertia::from_tensor(tensor).unwrap(), q0, omega).unwrap();
        (motion.at(t).unwrap().rotation(), motion.omega_at(t).unwrap())
    };
    let mut whole = SMatrix::<f64, 6, 12>::zeros();
    for column in 0..12 {
        let ((q1, w1), (q2, w2)) = (end(column, h), end(column, -h));
        let turn = (q1 * q2.inverse()).scaled_axis() / (2.0 * h);
        whole.fixed_view_mut::<3, 1>(0, column).copy_from(&turn);
        whole.fixed_view_mut::<3, 1>(3, column).copy_from(&((w1 - w2) / (2.0 * h)));
    }
    whole
}

#[test]
fn derivatives_of_tilted_tensors_agree_with_differences() {
    let generic = Matrix3::new(1.5, 0.2, -0.3, 0.2, 2.0, 0.1, -0.3, 0.1, 2.5);
    let tilt = UnitQuaternion::from_euler_angles(0.3, 0.2, -0.9).to_rotation_matrix();
    let symmetric = tilt * Matrix3::from_diagonal(&[1.0, 1.0, 1.5].into()) * tilt.transpose();
    for tensor in [generic, symmetric, Matrix3::identity() * 1.25] {
        let tensor = (tensor + tensor.transpose()) * 0.5;
        for (omega, t) in [([0.5, -0.4, 0.6], 0.25), ([0.5, -0.4, 0.6], -12.0), ([1.5, 0.3, -0.8], 5.0)] {
            let (omega, q0) = (Vector3::from(omega), UnitQuaternion::from_euler_angles(0.4, -1.1, 2.0));
            let motion = FreeMotion::from_omega(&Inertia::from_tensor(tensor).unwrap(), q0, omega).unwrap();
            let found = motion.at_with_derivative(t).unwrap();
            assert_eq!(found.omega_body(), motion.omega_at(t).unwrap());
            let exact = differences(tensor, q0, omega, t);
            let space = found.by_omega(TurnAxes::Space);
            assert!((space - exact).amax() < 1e-6 * exact.amax(), "t = {t}: {space:.6} {exact:.6}");
            // δθ in the body is Qᵀδθ in space, at both times
            let (from, to) = (q0.to_rotation_matrix(), found.state().rotation().to_rotation_matrix());
            let mut body = exact;
            let rows = to.transpose() * exact.fixed_rows::<3>(0);
            body.fixed_rows_mut::<3>(0).copy_from(&rows);
            let columns = body.fixed_columns::<3>(0) * from.matrix();
            body.fixed_columns_mut::<3>(0).copy_from(&columns);
            assert!((found.by_omega(TurnAxes::Body) - body).amax() < 1e-6 * exact.amax(), "t = {t}");
        }
    }
}

#[test]
fn a_body_at_rest_is_turned_by_what_it_is_given() {
    let tensor = Matrix3::new(1.5, 0.2, -0.3, 0.2, 2.0, 0.1, -0.3, 0.1, 2.5);
    let motion = FreeMotion::from_omega(
        &Inertia::from_tensor(tensor).unwrap(),
        UnitQuaternion::identity(),
        Vector3::zeros(),
    )
    .unwrap();
    let mut exact = SMatrix::<f64, 6, 12>::zeros();
    exact.fixed_view_mut::<6, 6>(0, 0).fill_with_identity();
    exact.fixed_view_mut::<3, 3>(0, 3).fill_diagonal(8.0);
    let found = motion.at_with_derivative(8.0).unwrap();
    assert!((found.by_omega(TurnAxes::Space) - exact).amax() < 1e-14);
}

#[test]
fn where_it_grows_beyond_a_double_the_derivative_is_refused() {
    let motion = started([1.0, 2.0, 3.0], [0.0, 1.0, 0.0]);
    let growth = motion.pure_spin().unwrap().growth_rate;
    let grown = motion.at_with_derivative(100.0 / growth).unwrap().by_momentum(TurnAxes::Space).amax();
    let e_folds = libm::log(grown);
    assert!((e_folds - 100.0).abs() < 2.0, "{grown:e}");
    let error = motion.at_with_derivative(1e6).unwrap_err();
    assert_eq!(error, DerivativeError::OutOfRange { t: 1e6 });
    assert!(error.to_string().contains("unstable axis"));
    assert!(matches!(racket().at_with_derivative(f64::NAN), Err(DerivativeError::Time(_))));
    assert!(matches!(racket().at_with_derivative(1e300), Err(DerivativeError::Time(_))));
}

#[test]
fn where_it_grows_beyond_a_double_the_scaled_derivative_has_a_power_of_two_beside_it() {
    let spin = |omega: f64| started([1.0, 2.0, 3.0], [0.0, omega, 0.0]);
    let scaled = |motion: &FreeMotion, t: f64| {
        let found = motion.at_with_scaled_derivative(t).unwrap();
        (
            found.exponent(),
            [TurnAxes::Space, TurnAxes::Body].map(|axes| [found.by_momentum(axes), found.by_omega(axes)]),
        )
    };
    // where both exist, and where the powers are two and three
    for (omega, t) in [(1.0, 300.0), (-1.0, 600.0), (1.0, -600.0), (3.0, 0.1)] {
        let motion = spin(omega);
        let plain = motion.at_with_derivative(t).unwrap();
        let (exponent, found) = scaled(&motion, t);
        for (found, axes) in found.iter().zip([TurnAxes::Space, TurnAxes::Body]) {
            for (found, plain) in found.iter().zip([plain.by_momentum(axes), plain.by_omega(axes)]) {
                let found = found * libm::scalbn(1.0, exponent);
                assert!((found - plain).amax() < 1e-12 * plain.amax(), "{omega} rad/s, {t} s");
            }
        }
    }
    // it composes: D(2t) = D(t) D(t) in axes of the body, of which the steady spin has always the same
    let (motion, t) = (spin(1.0), 2e4);
    let (once, twice) = (scaled(&motion, t), scaled(&motion, 2.0 * t));
    let d = once.1[1][0];
    let square = d.fixed_columns::<6>(0) * d;
    let e = 2 * once.0 - twice.0;
    let square = square * libm::scalbn(1.0, e);
    assert!((square - twice.1[1][0]).amax() < 1e-10 * square.amax(), "2^{e}");
    let folds = f64::from(twice.0) * core::f64::consts::LN_2 + libm::log(twice.1[1][0].amax());
    let growth = motion.pure_spin().unwrap().growth_rate;
    assert!((folds / (growth * 2.0 * t) - 1.0).abs() < 1e-3, "{folds}");
    // elsewhere there is none
    let racket = racket();
    let (found, plain) =
        (racket.at_with_scaled_derivative(1e6).unwrap(), racket.at_with_derivative(1e6).unwrap());
    assert_eq!(found.exponent(), 0);
    assert_eq!(found.by_omega(TurnAxes::Space), plain.by_omega(TurnAxes::Space));
    let far = spin(1.0).at_with_scaled_derivative(1e10);
    assert_eq!(far.unwrap_err(), DerivativeError::OutOfRange { t: 1e10 });
}

#[test]
fn on_the_separatrix_the_scaled_derivative_follows_the_motion_to_its_final_spin() {
    // I₁ (I₂ − I₁) ω₁² = I₃ (I₃ − I₂) ω₃² in doubles
    let motion = started([1.0, 2.0, 2.25], [0.75, 0.5, 1.0]);
    assert!(
        motion.character().unwrap().polhode_period.is_none_or(f64::is_infinite),
        "{:?}",
        motion.character()
    );
    let short = motion.at_with_derivative(200.0).unwrap().by_momentum(TurnAxes::Body);
    let long = motion.at_with_scaled_derivative(2000.0).unwrap();
    let back = motion.at_with_scaled_derivative(-2000.0).unwrap();
    assert!(long.exponent() > 500 && back.exponent() > 500);
    // one direction of the start is all that grows: the rows of both span it
    let unstable = |d: &SMatrix<f64, 6, 12>| {
        let row = (3..6).max_by(|&a, &b| d.row(a).amax().total_cmp(&d.row(b).amax())).unwrap();
        let row = d.row(row).into_owned();
        row / row.amax()
    };
    let (a, b) = (unstable(&short), unstable(&long.by_momentum(TurnAxes::Body)));
    let off = (a - b).amax().min((a + b).amax());
    assert!(off < 1e-12, "{off:.1e}");
}

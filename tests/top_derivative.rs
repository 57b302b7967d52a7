//! The derivative of the motion of Lagrange's top against fixtures (tests/data/tops/derivative.py) and differences in double-double, and
//! the laws that it obeys.

use core::array::from_fn;
use std::collections::BTreeMap;

use nalgebra::{SMatrix, Vector3};

use crate::derivative::form;
use crate::fixtures::{TopDerivativeCase, top_derivatives};
use polhode::body::{Body, Point, State};
use polhode::flow::{DerivativeError, LagrangeTop, TopDerivative, TurnAxes};
use polhode::inertia::Inertia;
use polhode::num::{Dd, Real};
use polhode::rotation::{Quat, Vec3};

pub(crate) type Columns = SMatrix<f64, 6, 9>;

/// What is promised of the derivative relative to its largest entry, beside four times the condition.
pub(crate) const PROMISE: f64 = 1e-13;

/// A top with its axis along the third, from momenta.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Case {
    pub(crate) transverse: f64,
    pub(crate) axial: f64,
    pub(crate) weight: f64,
    pub(crate) momentum: [f64; 3],
    pub(crate) attitude: [f64; 4],
    pub(crate) t: f64,
}

impl Case {
    pub(crate) fn top(&self) -> LagrangeTop {
        self.changed(None)
    }

    pub(crate) fn body(&self) -> Body {
        let moments = [self.transverse, self.transverse, self.axial];
        Body::heavy(Inertia::from_positive_moments(moments).unwrap(), [0.0, 0.0, self.weight].into()).unwrap()
    }

    /// The column `n` of the start changed by `e`.
    pub(crate) fn changed(&self, change: Option<(usize, Dd)>) -> LagrangeTop {
        let body = self.body();
        let attitude = Quat::from_components(self.attitude.map(Dd::of)).normalized();
        let mut start = Point::new(attitude, Vec3(self.momentum.map(|m| Dd::of(m / body.scale()))));
        match change {
            Some((n @ 0..3, e)) => start.attitude = Quat::exponential(Vec3::unit(n) * e) * start.attitude,
            Some((n, e)) => start.momentum_body[n - 3] = start.momentum_body[n - 3] + e / body.scale(),
            None => {}
        }
        LagrangeTop::from_point(&body, start).unwrap()
    }

    /// Units in which the entries are of one size: rows and columns.
    pub(crate) fn units(&self) -> ([f64; 6], [f64; 9]) {
        units(self.transverse, self.axial, self.weight, &self.momentum)
    }
}

fn units(transverse: f64, axial: f64, weight: f64, momentum: &[f64; 3]) -> ([f64; 6], [f64; 9]) {
    let size = Vec3(*momentum).norm().max(libm::sqrt(weight * transverse));
    // a power of two, so that the weight can be changed by parts of it without rounding
    let heavy = libm::scalbn(1.0, libm::ilogb(weight.max(size * size / transverse)));
    let rows = from_fn(|row| if row < 3 { 1.0 } else { 1.0 / size });
    (rows, [1.0, 1.0, 1.0, size, size, size, transverse, axial, heavy])
}

pub(crate) fn in_units(columns: &Columns, (rows, units): &([f64; 6], [f64; 9])) -> Columns {
    Columns::from_fn(|row, column| columns[(row, column)] * rows[row] * units[column])
}

fn by_momentum(top: &LagrangeTop, t: f64) -> Columns {
    top.at_with_derivative(t).unwrap().by_momentum(TurnAxes::Space)
}

/// The top of a fixture, with one of its inputs changed by a unit of rounding.
fn fixture(case: &TopDerivativeCase, nudged: Option<usize>) -> (LagrangeTop, [f64; 3]) {
    let (mut moments, mut weight, mut start, mut attitude) =
        (case.moments, case.weight_moment, case.start, case.attitude);
    let axis = (0..3).find(|&k| weight[k] != 0.0).unwrap();
    let more = 1.0 + f64::EPSILON;
    match nudged {
        Some(0) => (0..3).filter(|&k| k != axis).for_each(|k| moments[k] *= more),
        Some(1) => moments[axis] *= more,
        Some(2) => weight[axis] *= more,
        Some(n @ 3..6) => start[n - 3] *= more,
        Some(n) => attitude[n - 6] *= more,
        None => {}
    }
    let body = Body::heavy(Inertia::from_positive_moments(moments).unwrap(), weight.into()).unwrap();
    let attitude = Quat::from_components(attitude);
    let point = if case.from_omega {
        body.enter_omega(attitude, Vec3(start))
    } else {
        body.enter(&State { attitude, momentum_body: Vec3(start) })
    };
    let momentum = from_fn(|k| if case.from_omega { moments[k] * start[k] } else { start[k] });
    (LagrangeTop::from_point(&body, point.unwrap()).unwrap(), momentum)
}

#[test]
fn derivatives_of_tops_agree_with_mpmath_in_every_regime() {
    let mut worst = BTreeMap::<String, (f64, f64, String)>::new();
    for case in top_derivatives() {
        let (top, momentum) = fixture(&case, None);
        let axis = (0..3).find(|&k| case.weight_moment[k] != 0.0).unwrap();
        let transverse = case.moments[(axis + 1) % 3];
        let units = units(transverse, case.moments[axis], case.weight_moment[axis].abs(), &momentum);
        let found = in_units(&by_momentum(&top, case.t), &units);
        let exact = in_units(&Columns::from_fn(|row, column| case.columns[column][row]), &units);
        let largest = exact.amax();
        let error = (found - exact).amax() / largest;
        let condition = (0..10)
            .map(|n| {
                0.5 * (in_units(&by_momentum(&fixture(&case, Some(n)).0, case.t), &units) - found).amax()
            })
            .fold(0.0, f64::max)
            / largest;
        println!(
            "{:20} {:6} {error:.1e} condition {condition:.1e} largest {largest:.1e}",
            case.scenario, case.t
        );
        assert!(
            error <= PROMISE + 4.0 * condition,
            "{} at {}: {error:.1e}, condition {condition:.1e}",
            case.scenario,
            case.t
        );
        let entry = worst.entry(case.regime.clone()).or_default();
        if error > entry.0 {
            *entry = (error, condition, format!("{} at {}", case.scenario, case.t));
        }
    }
    for (regime, (error, condition, case)) in &worst {
        println!("{regime}: {error:.1e} condition {condition:.1e} {case}");
    }
    let all = worst.values().fold(0.0, |a: f64, (error, ..)| a.max(*error));
    assert!(worst.len() > 10 && all > 1e-17, "{} regimes, {all:.1e}", worst.len());
}

/// Tops of every kind: what they weigh, and their starts.
fn several() -> Vec<Case> {
    let half = [2.0, 1.0, 0.0, 0.0];
    let starts = [
        ([0.4, 1.0, -0.3], half),
        ([0.0, 1.0, 2.75], half), // steady
        ([0.0, 1.0, 2.75 + 1e-9], half),
        ([0.0, 2.0, 4.000_000_000_1], half), // next to the separatrix
        ([0.0, 0.0, 8.0], [1.0, 0.0, 0.0, 0.0]),
        ([1e-9, 0.0, 8.0], [1.0, 0.0, 0.0, 0.0]),
        ([0.0, 0.0, 3.0], [0.0, 1.0, 0.0, 0.0]),
        ([0.5, -0.25, 3.0], [0.0, 1.0, 0.0, 0.0]),
        ([2.5, 0.0, 0.0], half), // a pendulum in a plane
        ([0.1, 0.2, 60.0], half),
        // the sleeping top of critical spin of the first body, and next to it: the axis nods slowly beside the spin
        ([0.0, 0.0, libm::sqrt(10.0)], [1.0, 1e-3, 0.0, 0.0]),
        ([0.0, 0.0, libm::sqrt(10.0)], [1.0, 1e-5, 0.0, 0.0]),
    ];
    let bodies = [(1.25, 0.5, 2.0), (2.5, 1.5, 2.0), (1.0, 1.0, 1e-12), (0.8, 1.5, 0.7)];
    let of = |&(transverse, axial, weight): &(f64, f64, f64)| {
        starts.map(|(momentum, attitude)| Case { transverse, axial, weight, momentum, attitude, t: 0.0 })
    };
    bodies.iter().flat_map(of).collect()
}

#[test]
fn the_derivative_of_a_top_by_its_state_is_symplectic_at_any_time() {
    let mut answered = 0;
    for case in several() {
        let top = case.top();
        for t in [0.0, 0.3, -70.0, 1e6, 1e12] {
            let found = match top.at_with_derivative(t) {
                Ok(found) => found,
                Err(DerivativeError::OutOfRange { .. }) => continue,
                Err(error) => panic!("{error}"),
            };
            answered += 1;
            let d = found.by_momentum(TurnAxes::Body).fixed_columns::<6>(0).into_owned();
            let (before, after) = (top.at(0.0).unwrap().momentum(), found.state().momentum());
            let defect = (d.transpose() * form(after) * d - form(before)).amax();
            let size = d.amax().max(1.0);
            // products of entries of the size of m
            let unit = before.amax().max(after.amax()).max(1.0);
            assert!(
                defect <= 2e-14 * size * size * unit,
                "t = {t}: {defect:.1e} beside {size:.1e}: {case:?}"
            );
        }
    }
    assert!(answered > 150, "{answered}");
}

#[test]
fn derivatives_of_tops_over_two_times_follow_one_another() {
    let mut compared = 0;
    for case in several() {
        let top = case.top();
        let nudged: Vec<LagrangeTop> = (0..3)
            .map(|k| {
                let mut other = case;
                other.momentum[k] *= 1.0 + f64::EPSILON;
                other.top()
            })
            .collect();
        for (first, then) in [(0.7, 2.0), (300.0, -20.0), (-1e5, 3e5)] {
            let second = LagrangeTop::from_point(top.body(), top.point_at_dd(first.into()));
            let Ok(second) = second else { continue };
            let all = [
                top.at_with_derivative(first),
                second.at_with_derivative(then),
                top.at_with_derivative(first + then),
            ];
            let [Ok(a), Ok(b), Ok(whole)] = all else { continue };
            let others: Vec<TopDerivative> =
                nudged.iter().filter_map(|other| other.at_with_derivative(first + then).ok()).collect();
            for read in [TopDerivative::by_momentum, TopDerivative::by_omega] {
                for axes in [TurnAxes::Space, TurnAxes::Body] {
                    let [a, b, whole] = [&a, &b, &whole].map(|d| read(d, axes));
                    let by_state = b.fixed_columns::<6>(0);
                    let mut both = by_state * a;
                    let mut constants = both.fixed_columns_mut::<3>(6);
                    constants += b.fixed_columns::<3>(6);
                    let error = (both - whole).amax();
                    let condition = others.iter().map(|other| 0.5 * (read(other, axes) - whole).amax());
                    let condition = condition.fold(0.0, f64::max) / whole.amax();
                    // both parts may be larger than what they add up to
                    let size = (by_state.abs() * a.abs()).amax().max(b.amax());
                    // and small entries have the rounding of the large ones
                    let rounding = 4.0 * f64::EPSILON * by_state.amax() * a.amax();
                    compared += 1;
                    assert!(
                        error <= (PROMISE + 4.0 * condition) * size + rounding,
                        "{first} s, {then} s: {error:.1e} beside {size:.1e}, condition {condition:.1e}: {case:?}"
                    );
                }
            }
        }
    }
    assert!(compared > 300, "{compared}");
}

#[test]
fn without_weight_it_is_the_derivative_of_the_free_body() {
    let free = polhode::flow::FreeMotion::from_omega(
        &Inertia::from_moments([1.25, 1.25, 0.75]).unwrap(),
        Quat::from_components([0.9, 0.3, -0.2, 0.4]).normalized().into(),
        Vector3::new(0.5, -0.25, 2.0),
    )
    .unwrap();
    let body = Body::heavy(free.body().inertia().clone(), [0.0, 0.0, 1e-70].into()).unwrap();
    let top = LagrangeTop::from_point(&body, free.point_at_dd(Dd::ZERO)).unwrap();
    for t in [0.5, -30.0, 1e4] {
        let free = free.at_with_derivative(t).unwrap();
        let top = top.at_with_derivative(t).unwrap();
        for axes in [TurnAxes::Space, TurnAxes::Body] {
            for (free, top) in
                [(free.by_momentum(axes), top.by_momentum(axes)), (free.by_omega(axes), top.by_omega(axes))]
            {
                let state = free.fixed_columns::<6>(0) - top.fixed_columns::<6>(0);
                let transverse = free.column(6) + free.column(7) - top.column(6);
                let axial = free.column(8) - top.column(7);
                let off = state.amax().max(transverse.amax()).max(axial.amax());
                assert!(
                    off < 1e-14 * (1.0 + t.abs()) * free.amax(),
                    "t = {t}: {off:.1e} beside {:.1e}",
                    free.amax()
                );
            }
        }
    }
}

#[test]
fn a_tilted_body_has_the_derivative_of_the_upright_one_in_its_own_axes() {
    // the same top with its axis along the first and the second typed axis, and with its weight below
    let of = |axis: usize, sign: f64| {
        let mut moments = [1.25; 3];
        moments[axis] = 0.75;
        let mut weight = [0.0; 3];
        weight[axis] = 2.0 * sign;
        let body = Body::heavy(Inertia::from_moments(moments).unwrap(), weight.into()).unwrap();
        let q0 = Quat::from_components([0.9, 0.3, -0.2, 0.4]).normalized();
        LagrangeTop::from_omega(&body, q0.into(), Vector3::new(0.75, -0.5, 3.0)).unwrap()
    };
    for (axis, sign) in [(0, 1.0), (1, -1.0), (2, -1.0)] {
        let top = of(axis, sign);
        let found = top.at_with_derivative(7.0).unwrap().by_omega(TurnAxes::Space);
        let start = top.at(0.0).unwrap();
        let omega = top.body().omega_body(&start);
        let h = libm::exp2(-17.0);
        for column in 0..6 {
            let end = |e: f64| {
                let (mut q0, mut w) = (start.rotation(), omega);
                if column < 3 {
                    q0 = nalgebra::UnitQuaternion::from_scaled_axis(Vector3::ith(column, e)) * q0;
                } else {
                    w[column - 3] += e;
                }
                let top = LagrangeTop::from_omega(top.body(), q0, w).unwrap();
                let x = top.at(7.0).unwrap();
                (x.rotation(), top.body().omega_body(&x))
            };
            let ((q1, w1), (q2, w2)) = (end(h), end(-h));
            let turn = (q1 * q2.inverse()).scaled_axis() / (2.0 * h) - found.fixed_view::<3, 1>(0, column);
            let rate = (w1 - w2) / (2.0 * h) - found.fixed_view::<3, 1>(3, column);
            assert!(turn.amax().max(rate.amax()) < 1e-6 * found.amax(), "axis {axis}, column {column}");
        }
    }
}

#[test]
fn derivatives_of_tops_that_cannot_be_had_are_refused() {
    let upright = |spin: f64, tilt: f64| Case {
        transverse: 1.0,
        axial: 0.5,
        weight: 1.0,
        momentum: [0.0, 0.0, spin],
        attitude: [1.0, 0.5 * tilt, 0.0, 0.0],
        t: 0.0,
    };
    // √(g − ω₃²/4) is the rate at which the sleeping top falls
    let falls = upright(1.0, 0.0).top();
    let grown = falls.at_with_derivative(100.0).unwrap().by_momentum(TurnAxes::Space).amax();
    assert!((libm::log(grown) - 100.0 * libm::sqrt(0.75)).abs() < 2.0, "{grown:e}");
    assert_eq!(falls.at_with_derivative(1e6).unwrap_err(), DerivativeError::OutOfRange { t: 1e6 });
    assert!(matches!(falls.at_with_derivative(f64::NAN), Err(DerivativeError::Time(_))));
}

#[test]
fn a_scaled_derivative_of_a_top_goes_on_where_the_range_of_a_double_ends() {
    let (transverse, axial, weight) = (2.5, 1.5, 2.0);
    let rate = 0.4; // √(c/A − (m₃/2A)²)
    let asleep = ([0.0, 0.0, 4.0], [1.0, 0.0, 0.0, 0.0]);
    let homoclinic = ([0.0, 2.0, 4.0], [2.0, 1.0, 0.0, 0.0]);
    for (momentum, attitude) in [asleep, homoclinic] {
        let top = Case { transverse, axial, weight, momentum, attitude, t: 0.0 }.top();
        for e_folds in [100.0, -600.0] {
            let t = e_folds / rate;
            let (plain, scaled) =
                (top.at_with_derivative(t).unwrap(), top.at_with_scaled_derivative(t).unwrap());
            for axes in [TurnAxes::Space, TurnAxes::Body] {
                for read in [TopDerivative::by_momentum, TopDerivative::by_omega] {
                    let exact = read(&plain, axes);
                    let found = read(&scaled, axes).map(|x| libm::scalbn(x, scaled.exponent()));
                    let off = (found - exact).map(|x| x / exact.amax()).amax();
                    assert!(off < 1e-12, "{e_folds} e-folds: {off:.1e}");
                }
            }
        }
        for t in [1e6, -1e8] {
            assert_eq!(top.at_with_derivative(t).unwrap_err(), DerivativeError::OutOfRange { t });
            let found = top.at_with_scaled_derivative(t).unwrap();
            let largest = libm::log(found.by_momentum(TurnAxes::Space).amax());
            let e_folds = f64::from(found.exponent()) * core::f64::consts::LN_2 + largest;
            assert!((e_folds - rate * f64::abs(t)).abs() < 4.0, "{t} s: {e_folds}");
        }
    }
}

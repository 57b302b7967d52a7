//! The discrete Moser–Veselov map of every even order: convergence, what it keeps, and its limits.

use nalgebra::{UnitQuaternion, Vector3};
use polhode::body::{Body, Clock, Conserved, Point, State, Time};
use polhode::flow::FreeMotion;
use polhode::inertia::Inertia;
use polhode::method::{Claimed, PreprocessedDmv, method};
use polhode::num::{Dd, Precise};
use polhode::rotation::{Quat, Vec3, rotation_angle};
use polhode::run::{Halving, Run, halvings, observed_order};

/// Hairer, Vilmart: the driver of their program, with the moments and the start in dyadic numbers.
fn dyadic() -> (Body, State) {
    let body = Body::free(Inertia::from_moments([0.625, 0.75, 1.0]).unwrap());
    (body, State { attitude: Quat::identity(), momentum_body: Vec3([1.75, 0.375, -0.875]) })
}

#[test]
fn every_even_order_converges_with_its_order() {
    let (body, start) = dyadic();
    let start = body.enter(&start).unwrap();
    for order in (4..=20).step_by(2) {
        let name = format!("dmv:{order}");
        // steps of 5 to 40 degrees, where the error is neither coarse nor rounding of double-double
        let finest = match order {
            4..=8 => 7,
            10..=12 => 6,
            14..=16 => 5,
            _ => 4,
        };
        let errors = halvings(&method(&name).unwrap(), &body, &start, 2.0, finest - 1..finest + 1).unwrap();
        let slope = |pick: fn(&Halving) -> f64| {
            observed_order(&errors.iter().map(|error| (error.h, pick(error))).collect::<Vec<_>>()).unwrap()
        };
        let (attitude, momentum) = (slope(|error| error.attitude_error), slope(|error| error.momentum_error));
        println!("{name}: {attitude:.3} {momentum:.3}");
        for measured in [attitude, momentum] {
            assert!((measured / f64::from(order) - 1.0).abs() < 0.02, "{name}: {measured}");
        }
    }
}

#[test]
fn invariants_of_free_motion_are_kept_at_every_order() {
    let (body, start) = dyadic();
    let start = body.enter(&start).unwrap();
    let clock = Clock::new(0.25);
    let invariants = |x: &Point<Dd>| {
        let energy = body.energy_of(Time::from_seconds(0.0), x);
        (energy, x.momentum_body.norm_squared(), x.momentum_space())
    };
    let before = invariants(&start);
    for order in (4..=20).step_by(2) {
        let mut x = start;
        method(&format!("dmv:{order}")).unwrap().prepare_dd(clock, &body).unwrap().steps(&mut x, 200);
        let after = invariants(&x);
        let relative = |a: Dd, b: Dd| ((a - b) / b).hi().abs();
        assert!(relative(after.0, before.0) < 1e-28, "{order}");
        assert!(relative(after.1, before.1) < 1e-28, "{order}");
        assert!((after.2 - before.2).norm().to_f64() < 1e-28, "{order}");
    }
}

#[test]
fn high_orders_reach_rounding_at_large_steps() {
    // 21 degrees a step, 80 000 steps; rounding walks, so that one start says little
    let (body, middle) = dyadic();
    let starts: Vec<State> = (0..16)
        .map(|k| {
            let shift = |j: i32| 0.25 * (f64::from(3 * k + j + 1) * 0.618_033_988_749_894_9).fract() - 0.125;
            let momentum_body = middle.momentum_body + Vec3([shift(0), shift(1), shift(2)]);
            State { attitude: middle.attitude, momentum_body }
        })
        .collect();
    for (name, attitude, energy) in
        [("dmv:6", 2e-2, 1e-14), ("dmv:10", 5e-8, 1e-14), ("dmv:16", 1e-11, 1e-14)]
    {
        let mut squares = 0.0;
        for start in &starts {
            let exact = FreeMotion::from_state(body.inertia(), start).unwrap().at(1e4).unwrap();
            let end =
                Run::new(&method(name).unwrap(), &body, start, 0.125).unwrap().advance_to(80_000).unwrap();
            let error = rotation_angle(end.state.attitude, exact.attitude);
            squares += error * error;
            let worst = end.worst.of(Conserved::Energy).unwrap();
            assert!(worst < energy, "{name}: {worst:e}");
        }
        let error = (squares / starts.len() as f64).sqrt();
        assert!(error < attitude, "{name}: {error:e}");
    }
}

#[test]
fn orders_that_do_not_exist_are_refused() {
    for order in [0, 1, 2, 3, 5, 22, 100] {
        let error = PreprocessedDmv::of_order(order).unwrap_err();
        assert_eq!(error.order, order);
        assert!(error.to_string().contains("the even orders from 4 to 20"), "{error}");
        let error = method(&format!("dmv:{order}")).map(|method| method.name()).unwrap_err();
        assert!(error.to_string().contains("an even order from 4 to 20"), "{error}");
    }
    assert!(method("dmv").is_err());
}

#[test]
fn degenerate_bodies_have_finite_constants() {
    for moments in [[2.0; 3], [1.0, 1.0, 2.0], [2.0, 2.0, 1.0], [1.0, 1.0, 1e-9], [1.0, 1.0 + 1e-14, 1.5]] {
        let body = Body::free(Inertia::from_moments(moments).unwrap());
        for omega in [Vector3::new(0.4, 1.0, -0.3), Vector3::zeros(), Vector3::new(0.0, 1.0, 0.0)] {
            let omega = if moments[2] < 1e-3 { omega * 1e-10 } else { omega };
            let start = body.state(UnitQuaternion::identity(), omega).unwrap();
            let end =
                Run::new(&method("dmv:20").unwrap(), &body, &start, 0.1).unwrap().advance_to(1000).unwrap();
            let exact = FreeMotion::from_state(body.inertia(), &start).unwrap().at(100.0).unwrap();
            let error = rotation_angle(end.state.attitude, exact.attitude);
            assert!(error < 1e-11, "{moments:?}, {omega:?}: {error:e}");
        }
    }
}

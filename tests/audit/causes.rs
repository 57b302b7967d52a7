//! What makes a record wrong is named: another body, another torque, an integrator of another program.

use nalgebra::{UnitQuaternion, Vector3};
use polhode::audit::{Attitudes, Fault, Frame, Judgement, Misplaced, Question, Suspect, Trajectory, audit};
use polhode::body::{Body, Force};
use polhode::inertia::Inertia;
use polhode::method::{AxisOrder, method};
use polhode::rotation::{Quat, Vec3};
use polhode::run::Run;

use super::records::{Written, plain};
use super::ties::states;

fn free(moments: [f64; 3]) -> Body {
    Body::free(Inertia::from_moments(moments).unwrap())
}

/// Every 0.05 s.
fn free_motion(moments: [f64; 3]) -> Trajectory {
    let body = free(moments);
    let attitude = UnitQuaternion::from_euler_angles(0.3, -0.8, 1.9);
    plain(&states(&body, &body.state(attitude, Vector3::new(0.4, 1.0, -0.3)).unwrap(), 0.05, 400))
}

/// By rk8 in short steps.
fn forced_motion(body: &Body) -> Trajectory {
    motion_by("rk8", body)
}

/// In steps of 0.0125 s, every 0.05 s.
fn motion_by(name: &str, body: &Body) -> Trajectory {
    let start =
        body.state(UnitQuaternion::from_euler_angles(0.3, -0.8, 1.9), Vector3::new(0.4, 1.0, -0.3)).unwrap();
    let mut run = Run::new(&method(name).unwrap(), body, &start, 0.0125).unwrap();
    let rows: Vec<Written> = (0..400)
        .map(|k| {
            let sample = run.advance_to(4 * k).unwrap();
            (0.05 * k as f64, sample.state.attitude, Vec3::from(sample.omega_body))
        })
        .collect();
    plain(&rows)
}

#[test]
fn a_body_with_other_moments_is_named_with_them() {
    let record = free_motion([1.0, 2.0, 2.97]);
    let verdict = audit(&record, &Question::new(Some(free([1.0, 2.0, 3.0])))).unwrap();
    assert_eq!((verdict.judgement, verdict.suspect), (Judgement::Wrong, Suspect::OtherBody));
    let found = verdict.other_body.unwrap();
    assert!(!found.principal);
    // of the trace of the given moments
    for (found, truth) in found.moments.iter().zip([1.0, 2.0, 2.97].map(|x| x * 6.0 / 5.97)) {
        assert!((found - truth).abs() < 1e-6, "{found} {truth}");
    }
}

/// As a leapfrog writes them, of half a step later; not those that are off by a factor.
#[test]
fn angular_velocities_of_other_times_are_named_with_their_lag() {
    let moments = [1.0, 2.0, 3.0];
    let body = free(moments);
    let attitude = UnitQuaternion::from_euler_angles(0.3, -0.8, 1.9);
    let start = body.state(attitude, Vector3::new(0.4, 1.0, -0.3)).unwrap();
    let rates = plain(&states(&body, &start, 0.025, 801)).rates.unwrap();
    let found = |later: usize, factor: f64| {
        let mut record = free_motion(moments);
        let of = |row: usize| rates[2 * row + later].map(|x| x * factor);
        record.rates = Some((0..400).map(of).collect());
        let verdict = audit(&record, &Question::new(Some(free(moments)))).unwrap();
        assert_eq!(verdict.judgement, Judgement::Wrong);
        verdict.faults.iter().find_map(|fault| match fault {
            Fault::ShiftedRates { lag } => Some(*lag),
            _ => None,
        })
    };
    assert!(found(1, 1.0).is_some_and(|lag| (lag / 0.025 - 1.0).abs() < 1e-3), "{:?}", found(1, 1.0));
    assert_eq!(found(0, 1.01), None);
}

#[test]
fn a_torque_that_is_not_told_is_named_with_its_size() {
    let torque = Vector3::new(2e-3, -1e-3, 3e-3);
    let forces = [
        (Frame::Body, Force::constant_torque_body(torque)),
        (Frame::Space, Force::constant_torque_space(torque)),
    ];
    for (frame, force) in forces {
        let record = forced_motion(&free([1.0, 2.0, 3.0]).with(force.unwrap()));
        let verdict = audit(&record, &Question::new(Some(free([1.0, 2.0, 3.0])))).unwrap();
        assert_eq!((verdict.judgement, verdict.suspect), (Judgement::Wrong, Suspect::OtherTorque));
        let found = verdict.other_torque.unwrap();
        assert!((found.size / torque.norm() - 1.0).abs() < 0.05, "{found:?}");
        let (axes, components) = found.constant.unwrap();
        assert_eq!(axes, frame);
        assert!((Vector3::from(components) - torque).norm() < 0.05 * torque.norm(), "{found:?}");
    }
}

#[test]
fn a_torque_with_the_wrong_sign_and_one_that_does_not_act_are_named() {
    let moments = [1.0, 2.0, 2.5];
    let given = |c: f64| {
        Body::heavy(Inertia::from_moments(moments).unwrap(), Vector3::new(0.01, 0.02, 0.05) * c).unwrap()
    };
    let record = forced_motion(&given(1.0));
    for (told, factor) in [(-1.0, -1.0), (0.5, 2.0)] {
        let verdict = audit(&record, &Question::new(Some(given(told)))).unwrap();
        assert_eq!((verdict.judgement, verdict.suspect), (Judgement::Wrong, Suspect::OtherTorque));
        let found = verdict.other_torque.unwrap().factor.unwrap();
        assert!((found - factor).abs() < 0.02, "{found} {factor}");
    }
    let free_of_torque = free_motion(moments);
    let verdict = audit(&free_of_torque, &Question::new(Some(given(1.0)))).unwrap();
    assert_eq!((verdict.judgement, verdict.suspect), (Judgement::Wrong, Suspect::OtherTorque));
    assert!(verdict.other_torque.unwrap().factor.unwrap().abs() < 0.02);
    assert!(verdict.other_torque.unwrap().to_string().contains("does not act"));
}

#[test]
fn rows_that_are_all_exchanged_with_a_neighbour_are_named() {
    for first in [0, 1] {
        let mut record = free_motion([1.0, 2.0, 3.0]);
        let Some(Attitudes::Quaternions(attitude)) = &mut record.attitude else { panic!() };
        let rates = record.rates.as_mut().unwrap();
        for row in (first..399).step_by(2) {
            attitude.swap(row, row + 1);
            rates.swap(row, row + 1);
        }
        let verdict = audit(&record, &Question::new(Some(free([1.0, 2.0, 3.0])))).unwrap();
        assert_eq!(verdict.judgement, Judgement::Wrong);
        let named = |fault: &Fault| {
            matches!(fault, Fault::Misplaced { what: Misplaced::Exchanged, row, count, .. }
                if *row == first && *count >= 398)
        };
        assert!(verdict.faults.iter().any(named), "{:?}", verdict.faults);
    }
}

/// Of a body two of whose moments agree, two orders of the turns are as good, and the last digit of the start chooses.
#[test]
fn a_splitting_that_chooses_its_axes_is_named_whichever_of_two_orders_it_took() {
    let moments = [1.4, 1.0, 1.0];
    let order = AxisOrder::best_for_orbit(Vec3([1.4 * 0.4, 1.0, -0.3]), Vec3(moments)).to_string();
    let swap = |c: char| match c {
        '2' => '3',
        '3' => '2',
        other => other,
    };
    let other: String = order.chars().map(swap).collect();
    for axes in [order, other] {
        let record = motion_by(&format!("lie-poisson:{axes}"), &free(moments));
        let verdict = audit(&record, &Question::new(Some(free(moments)))).unwrap();
        assert_eq!(verdict.suspect, Suspect::Integrator("lie-poisson".into()), "{axes}");
    }
}

#[test]
fn the_implicit_step_of_mujoco_is_named() {
    let body = free([1.0, 2.0, 2.5]);
    let start = body.state(UnitQuaternion::identity(), Vector3::new(0.8, 2.0, -0.6)).unwrap();
    let mut run = Run::new(&method("linearly-implicit-euler").unwrap(), &body, &start, 0.01).unwrap();
    let rows: Vec<Written> = (0..200)
        .map(|k| {
            let sample = run.advance_to(2 * k).unwrap();
            (0.02 * k as f64, sample.state.attitude, Vec3::from(sample.omega_body))
        })
        .collect();
    let verdict = audit(&plain(&rows), &Question::new(Some(body))).unwrap();
    assert_eq!(verdict.suspect, Suspect::Integrator("linearly-implicit-euler".into()));
    let found = verdict.signature.unwrap();
    assert!((found.step - 0.01).abs() < 1e-12 && found.mismatch < 1e-6, "{found:?}");
}

/// Programs turn their attitudes by the same angular velocities in other ways.
#[test]
fn a_method_that_explains_the_rates_is_named_although_attitudes_are_a_little_off() {
    let body = free([1.0, 2.0, 2.5]);
    let start = body.state(UnitQuaternion::identity(), Vector3::new(0.4, 1.0, -0.3)).unwrap();
    let exact = states(&body, &start, 0.05, 60);
    let named = |of_turns: f64, of_rates: f64| {
        let mut run = Run::new(&method("explicit-euler").unwrap(), &body, &start, 0.025).unwrap();
        let rows = exact.iter().enumerate().map(|(row, (time, q, omega))| {
            let sample = run.advance_to(2 * row as u64).unwrap();
            let off = q.conjugate() * sample.state.attitude.normalized();
            let off = UnitQuaternion::from(off).scaled_axis();
            let attitude = *q * Quat::from(UnitQuaternion::from_scaled_axis(off * of_turns));
            (*time, attitude, *omega + (Vec3::from(sample.omega_body) - *omega) * of_rates)
        });
        let rows: Vec<Written> = rows.collect();
        let verdict = audit(&plain(&rows), &Question::new(Some(body.clone()))).unwrap();
        verdict.signature.map(|found| (found.method, found.steps_per_row))
    };
    let explicit = Some(("explicit-euler".to_owned(), 2));
    assert_eq!(named(1.0, 1.0), explicit);
    assert_eq!(named(1.05, 1.0), explicit);
    assert_eq!(named(1.3, 1.0), None, "attitudes are far off");
    assert_eq!(named(1.05, 1.05), None, "neither is explained");
}

#[test]
fn no_integrator_is_named_from_attitudes_alone() {
    let body = free([1.0, 2.0, 2.5]);
    for name in ["richardson", "lie-poisson:321", "implicit-midpoint", "buss-2", "rk4"] {
        let mut record = motion_by(name, &body);
        let named = audit(&record, &Question::new(Some(body.clone()))).unwrap();
        // an error of rk4 this small is within the tolerance
        if named.judgement == Judgement::Wrong {
            assert_eq!(named.suspect, Suspect::Integrator(name.into()));
        } else {
            assert_eq!(name, "rk4");
        }
        record.rates = None;
        let verdict = audit(&record, &Question::new(Some(body.clone()))).unwrap();
        assert!(verdict.signature.is_none(), "{name}: {:?}", verdict.signature);
    }
}

/// Of a sphere a method errs as a clock does. The factor by which the clock is off is told.
#[test]
fn a_clock_that_is_off_is_no_integrator() {
    for (moments, factor) in [
        ([2.0, 2.0, 2.0], 1.0 + 1e-5),
        ([2.0, 2.0, 2.0], 1.0 + 1.0 / 480.0),
        ([1.0, 1.0, 2.0], 1.0 - 1e-4),
        ([1.0, 2.0, 3.0], 1.0 + 1.0 / 480.0),
    ] {
        let mut record = free_motion(moments);
        record.times.iter_mut().for_each(|t| *t *= factor);
        let verdict = audit(&record, &Question::new(Some(free(moments)))).unwrap();
        assert_eq!(verdict.judgement, Judgement::Wrong);
        assert!(verdict.signature.is_none(), "{moments:?} {factor}: {:?}", verdict.signature);
        // the same rates beside attitudes that turn more slowly
        let is_told = |fault: &Fault| matches!(fault, Fault::ScaledRates { factor: found } if (found / factor - 1.0).abs() < 1e-7);
        assert!(verdict.faults.iter().any(is_told), "{moments:?} {factor}: {:?}", verdict.faults);
    }
}

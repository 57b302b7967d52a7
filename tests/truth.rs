//! The true motion is the closed form, or known as far as two runs agree; a run that is watched against it ends as it should.
//!
//! That a system refuses a thread cannot be brought about here: the two runs are then taken one after the other on the calling
//! thread (`ulimit -u 1` on the command line shows it).

use nalgebra::{UnitQuaternion, Vector3};
use polhode::body::{Body, Force, State};
use polhode::flow::{ExactMotion, FreeMotion};
use polhode::inertia::Inertia;
use polhode::method::method;
use polhode::num::Dd;
use polhode::run::{Run, RunError};
use polhode::truth::{AGREEMENT, Care, Ending, LOST, Truth, TruthError, attitude_error, evenly};

fn textbook() -> (Body, State) {
    let body = Body::free(Inertia::from_moments([1.0, 2.0, 3.0]).unwrap());
    let start = body.state(UnitQuaternion::identity(), Vector3::new(0.4, 1.0, -0.3)).unwrap();
    (body, start)
}

/// Next to upright: a chaotic orbit of the top of Hairer, Lubich and Wanner, fig. VII.5.3.
fn chaotic_top() -> (Body, State) {
    let inertia = Inertia::from_moments([0.5, 0.85, 1.0]).unwrap();
    let body = Body::heavy(inertia, Vector3::new(0.0, 0.0, 1.0)).unwrap();
    let tilted = UnitQuaternion::from_scaled_axis(Vector3::new(0.1, 0.04, 0.0));
    let start = body.state(tilted, Vector3::new(0.2, 0.235, 0.5)).unwrap();
    (body, start)
}

/// A symmetric top, and the same with a torque of nothing, which hides that it has a closed form.
fn top_and_its_double() -> (Body, Body, State) {
    let inertia = Inertia::from_moments([1.0, 1.0, 0.5]).unwrap();
    let top = Body::heavy(inertia, Vector3::new(0.0, 0.0, 2.0)).unwrap();
    let double = top.clone().with(Force::constant_torque_body(Vector3::new(0.0, 0.0, 1e-300)).unwrap());
    let tilted = UnitQuaternion::from_axis_angle(&Vector3::x_axis(), 0.5);
    let start = top.state(tilted, Vector3::new(0.3, -0.2, 9.0)).unwrap();
    (top, double, start)
}

#[test]
fn a_free_body_is_known_at_any_time_and_flips_as_its_closed_form_does() {
    let (body, start) = textbook();
    let truth = Truth::new(&body, &start, &evenly(1e6, 4)).unwrap();
    let exact = FreeMotion::from_state(body.inertia(), &start).unwrap();
    assert_eq!(truth.known_until(), 1e6);
    for t in [0.0, 0.3, 2.5e5, 1e6, 1e12] {
        assert!(truth.at(t).unwrap().rotation().angle_to(&exact.at(t).unwrap().rotation()) < 1e-15, "{t}");
        assert_eq!(truth.flips(t), Some(exact.flips(Dd::from(t))));
    }
}

/// Two independent ways to one motion: Jacobi's functions, and series in double-double.
#[test]
fn two_runs_agree_with_the_closed_form_to_thirty_digits() {
    let (top, double, start) = top_and_its_double();
    let times = evenly(16.0, 8);
    let truth = Truth::new(&double, &start, &times).unwrap();
    assert!(truth.closed_form().is_none() && truth.known_until() == 16.0);
    let point = top.enter(&start).unwrap().to_f64().to_dd();
    let exact = ExactMotion::from_point(&top, point).unwrap();
    // between the looks, too
    for t in times.iter().flat_map(|t| [t - 0.7, *t]) {
        let apart =
            attitude_error(truth.point_at(t.into()).unwrap().attitude, exact.point_at_dd(t.into()).attitude);
        assert!(apart < 1e-27, "{t}: {apart:e}");
    }
    assert!(matches!(truth.at(17.0), Err(TruthError::Unknown { .. })));
}

#[test]
fn a_chaotic_motion_is_known_only_so_far_and_less_far_to_more_digits() {
    let (body, start) = chaotic_top();
    let point = body.enter(&start).unwrap().to_f64();
    let times = evenly(600.0, 300);
    let truths = [1e-25, AGREEMENT, 1e-7].map(|a| Truth::from_point(&body, point, 0.0, &times, a).unwrap());
    let [strict, usual, loose] = truths.each_ref().map(Truth::known_until);
    assert!(20.0 < strict && strict < usual && usual < loose && loose < 600.0, "{strict} {usual} {loose}");
    // beyond, the run goes on and is not judged
    let truth = &truths[1];
    let run = truth.judge(&method("kick-drift@srkn-11b").unwrap(), 1.0 / 64.0, Care::default()).unwrap();
    assert_eq!(run.last.elapsed.hi(), 600.0);
    assert!(run.looks.last().unwrap().elapsed <= truth.known_until());
}

#[test]
fn a_run_is_held_lost_diverged_or_unsolved() {
    let (body, start) = textbook();
    let truth = Truth::new(&body, &start, &evenly(512.0, 64)).unwrap();
    let judged = |name: &str, h: f64, care| truth.judge(&method(name).unwrap(), h, care).unwrap();
    let held = judged("two-turn@blanes-moan-s10", 0.125, Care::default());
    assert_eq!((held.ending, held.ending.to_string().as_str()), (Ending::Held, "ok"));
    assert!(held.attitude_error().unwrap() <= held.largest_attitude_error(512.0).unwrap());
    // what is seen is the error of the run itself
    let exact = FreeMotion::from_state(body.inertia(), &start).unwrap().at(512.0).unwrap();
    let end = Run::new(&method("two-turn@blanes-moan-s10").unwrap(), &body, &start, 0.125).unwrap();
    let error = { end }.advance_to(4096).unwrap().state.rotation().angle_to(&exact.rotation());
    assert!((held.attitude_error().unwrap() / error - 1.0).abs() < 1e-3, "{held:?}, {error:e}");

    let lost = judged("rattle", 0.25, Care::default());
    let Ending::Lost(time) = lost.ending else { panic!("{lost:?}") };
    let first = lost.looks.iter().find(|look| look.attitude_error > LOST).unwrap();
    assert_eq!((time, lost.last.elapsed.hi(), lost.attitude_error()), (first.elapsed, 512.0, None));
    let mut care = Care::default();
    care.until_lost = true;
    assert_eq!(judged("rattle", 0.25, care).last.elapsed.hi(), time);

    let short = Truth::new(&body, &start, &[64.0]).unwrap();
    let ending = |name: &str, h| short.judge(&method(name).unwrap(), h, Care::default()).unwrap().ending;
    assert!(
        matches!(ending("explicit-euler", 1.0), Ending::Diverged(_)),
        "{}",
        ending("explicit-euler", 1.0)
    );
    assert!(matches!(ending("rattle", 8.0), Ending::Unsolved(_)), "{}", ending("rattle", 8.0));
    assert_eq!(Ending::Lost(12.3456).by_clock(100.0).to_string(), "lost at t = 112.3");
}

/// A law on series is followed by series, a closure in `f64` by short steps, to the rounding of a double.
#[test]
fn a_closure_is_followed_as_its_law_is() {
    let (body, start) = textbook();
    let push = Vector3::new(0.0, 0.1, 0.2);
    let law = Force::constant_torque_body(push).unwrap();
    let closure = Force::torque_fn("push", move |_, _, _| push);
    let [law, closure] =
        [law, closure].map(|force| Truth::new(&body.clone().with(force), &start, &[1.0, 4.0]).unwrap());
    assert_eq!((law.known_until(), closure.known_until()), (4.0, 4.0));
    let apart = attitude_error(
        closure.point_at(4.0.into()).unwrap().attitude,
        law.point_at(4.0.into()).unwrap().attitude,
    );
    assert!(apart > 0.0 && apart < AGREEMENT, "{apart:e}");
    let never = Truth::from_point(law.body(), law.start(), f64::NAN, &[1.0], AGREEMENT);
    assert!(matches!(never, Err(TruthError::NotFollowed(_))));
}

/// The count of the steps is known before the first of them: these would take 1e24 and 1e154.
#[test]
fn a_motion_of_too_many_steps_is_refused_at_once_with_their_count() {
    let water = Inertia::from_moments([1e-47, 1.9e-47, 2.9e-47]).unwrap();
    let water = Body::heavy(water, Vector3::new(10.0, 0.3, 0.1)).unwrap();
    let (free, _) = textbook();
    let pushed = free.with(Force::constant_torque_body(Vector3::new(1e308, 0.0, 0.0)).unwrap());
    for body in [water, pushed] {
        let start = body.state(UnitQuaternion::identity(), Vector3::new(1.0, 10.0, 10.0)).unwrap();
        match Truth::new(&body, &start, &evenly(1.0, 64)) {
            Err(error @ TruthError::TooLong { steps, most, reach, .. }) => {
                assert!(steps > 1e20 && most < 1_000_000 && reach < 1e-10, "{error}");
                assert!(error.to_string().contains("ask for at most"), "{error}");
                assert!(Truth::new(&body, &start, &[reach / most as f64]).is_ok());
            }
            other => panic!("{other:?}"),
        }
    }
}

#[test]
fn what_cannot_be_known_is_refused_with_the_law() {
    let (body, start) = textbook();
    let refused = |times: &[f64]| Truth::new(&body, &start, times).unwrap_err();
    assert_eq!(refused(&[1.0, 1.0]), TruthError::Order { time: 1.0, before: 1.0 });
    assert!(refused(&[-1.0]).to_string().starts_with("the time -1 s does not come after 0 s"));
    assert!(matches!(refused(&[f64::INFINITY]), TruthError::Order { .. }));
    assert!(matches!(refused(&[1e40]), TruthError::Time(_)));
    let truth = Truth::new(&body, &start, &[1.0]).unwrap();
    let error = truth.judge(&method("rk4").unwrap(), f64::NAN, Care::default()).unwrap_err();
    assert!(matches!(error, RunError::Step(_)) && Ending::of(&error, 1.0).is_none());
}

//! What is advised does what it says, and what cannot be met is refused with the law.

use nalgebra::{UnitQuaternion, Vector3};
use polhode::advise::{
    AdviseError, Choice, Demand, Setting, Stage, advise, advise_telling, check, check_telling,
};
use polhode::body::{Body, Force, State};
use polhode::flow::FreeMotion;
use polhode::inertia::Inertia;
use polhode::run::Run;

fn textbook() -> (Body, State) {
    let body = Body::free(Inertia::from_moments([1.0, 2.0, 3.0]).unwrap());
    let start = body.state(UnitQuaternion::identity(), Vector3::new(0.4, 1.0, -0.3)).unwrap();
    (body, start)
}

/// The heavy body of Hairer, Lubich and Wanner, fig. VII.5.3: no closed form.
fn asymmetric_top() -> (Body, State) {
    let inertia = Inertia::from_moments([0.5, 0.85, 1.0]).unwrap();
    let body = Body::heavy(inertia, Vector3::new(0.0, 0.0, 1.0)).unwrap();
    let tilted = UnitQuaternion::from_axis_angle(&Vector3::x_axis(), 0.5);
    let start = body.state(tilted, Vector3::new(0.5, 0.2, 5.0)).unwrap();
    (body, start)
}

fn without_closed_form(until: f64, attitude_error: f64) -> Demand {
    let mut demand = Demand::new(until, attitude_error);
    demand.excluded = vec!["exact".into()];
    demand
}

#[test]
fn the_advice_meets_the_demand() {
    for (body, start) in [textbook(), asymmetric_top()] {
        for (until, wanted) in [(20.0, 1e-3), (100.0, 1e-6), (100.0, 1e-10)] {
            let demand = without_closed_form(until, wanted);
            let advice = advise(&body, &start, &demand).unwrap();
            let Choice { method, attitude_error, .. } = &advice.best;
            let actual = check(&body, &start, &demand, &advice.best).unwrap();
            assert!(actual <= wanted, "{method}: {actual:e} for {wanted:e}");
            assert!(
                actual <= attitude_error.value * attitude_error.factor,
                "{method}: {actual:e}, {attitude_error:?}"
            );
            assert!(
                advice
                    .others
                    .iter()
                    .all(|other| other.seconds.value >= advice.best.seconds.value || !other.whole_time),
                "{advice:?}"
            );
            let meets = |other: &Choice| other.attitude_error.value <= wanted;
            assert!(advice.others.iter().all(meets), "{advice:?}");
        }
    }
}

/// The closed form is the quickest where there is one, and takes no step.
#[test]
fn a_free_body_needs_no_step() {
    let (body, start) = textbook();
    let advice = advise(&body, &start, &Demand::new(1e5, 1e-8)).unwrap();
    assert_eq!((advice.best.method.as_str(), advice.best.setting), ("exact", Setting::Nothing));
    assert!(check(&body, &start, &Demand::new(1e5, 1e-8), &advice.best).unwrap() < 1e-14);
}

/// A choice is what `Run` takes: the error at the end is that of its steps.
#[test]
fn method_and_step_stand_for_a_run() {
    let (body, start) = textbook();
    let mut demand = without_closed_form(100.0, 1e-5);
    demand.excluded.extend(["taylor", "dop853", "tsit5"].map(String::from));
    let best = advise(&body, &start, &demand).unwrap().best;
    let (Setting::Step(h), Some(steps)) = (best.setting, best.steps) else { panic!("{best:?}") };
    let method = polhode::method(&best.method).unwrap();
    let end = Run::new(&method, &body, &start, h).unwrap().advance_to(steps).unwrap();
    assert!((end.elapsed.hi() - 100.0).abs() < 1e-12);
    let exact = FreeMotion::from_state(body.inertia(), &start).unwrap().at(100.0).unwrap();
    let error = end.state.rotation().angle_to(&exact.rotation());
    assert!(error < 1e-5 && error < 1.3 * best.attitude_error.value, "{error:e}, {best:?}");
    // the largest error that a check finds is not below that at the end, which it looks at
    let mut done = Vec::new();
    let mut heed = |progress: &polhode::advise::Progress| {
        if progress.stage == Stage::Check(best.method.clone()) {
            done.push(progress.done);
        }
    };
    let checked = check_telling(&body, &start, &demand, &best, &mut heed).unwrap();
    assert!(checked > 0.99 * error && checked < 1e-5, "{checked:e} for {error:e}");
    assert_eq!(check(&body, &start, &demand, &best).unwrap(), checked);
    assert!(done.windows(2).all(|pair| pair[0] < pair[1]) && done.last() == Some(&1.0), "{done:?}");
}

#[test]
fn progress_grows_from_method_to_method() {
    let (body, start) = textbook();
    let mut done = Vec::new();
    let mut heed = |progress: &polhode::advise::Progress| {
        if progress.stage == Stage::Methods {
            done.push(progress.done);
        }
    };
    advise_telling(&body, &start, &without_closed_form(20.0, 1e-3), &mut heed).unwrap();
    assert!(done.len() > 10 && done[0] == 0.0, "{done:?}");
    assert!(done.windows(2).all(|pair| pair[0] < pair[1] && pair[1] < 1.0), "{done:?}");
}

#[test]
fn a_demand_on_the_energy_is_met_too() {
    let (body, start) = textbook();
    let mut demand = without_closed_form(100.0, 1e-2);
    demand.energy_error = Some(1e-12);
    let best = advise(&body, &start, &demand).unwrap().best;
    assert!(best.energy_error.is_some_and(|error| error <= 1e-12), "{best:?}");
}

#[test]
fn what_cannot_be_met_is_refused_with_the_reason() {
    let (body, start) = textbook();
    let refused = |demand: &Demand| advise(&body, &start, demand).unwrap_err();
    let error = refused(&Demand::new(-1.0, 1e-6)).to_string();
    assert_eq!(error, "the duration is -1 s; it must be a finite number above 0");
    assert!(refused(&Demand::new(1.0, f64::NAN)).to_string().starts_with("the attitude error is NaN rad"));
    assert!(refused(&Demand::new(1.0, 2.0)).to_string().contains("ask for 1 rad or less"));
    // one unit in the last digit of the start is more than this after so long a time
    match refused(&Demand::new(1e9, 1e-9)) {
        AdviseError::Conditioning { attainable, .. } => assert!(attainable > 1e-8 && attainable < 1e-5),
        error => panic!("{error}"),
    }
    let mut impatient = without_closed_form(1e4, 1e-9);
    impatient.budget = Some(1e-9);
    assert!(matches!(refused(&impatient), AdviseError::Budget { .. }));
    let mut coarse = without_closed_form(1000.0, 1e-6);
    coarse.excluded.extend(polhode::method::catalogue().iter().map(polhode::method::Claimed::name));
    coarse.excluded.extend(["dmv", "two-turn", "taylor", "kick-drift"].map(String::from));
    assert!(matches!(refused(&coarse), AdviseError::NoCandidate), "{}", refused(&coarse));
    coarse.excluded.retain(|name| name != "explicit-euler");
    match refused(&coarse) {
        AdviseError::Unreached { method, error, .. } => assert!(method == "explicit-euler" && error > 1e-6),
        error => panic!("{error}"),
    }
    // explicit Euler adds h^2 |m x w|^2 to |m|^2 in each step, which in its shortest ones makes the energy 1e-3 larger
    coarse.energy_error = Some(1e-15);
    let error = refused(&coarse);
    assert!(matches!(error, AdviseError::EnergyUnreached { error: off, .. } if off > 1e-6), "{error}");
    let says = "no method meets a relative energy error of 1.0e-15 until t = 1000 s; the best is explicit-euler with ";
    assert!(error.to_string().starts_with(says), "{error}");
    coarse.energy_error = Some(2e-16);
    assert!(matches!(refused(&coarse), AdviseError::EnergyBelowRounding { demand } if demand == 2e-16));
    let rest = body.state(UnitQuaternion::identity(), Vector3::zeros()).unwrap();
    assert!(matches!(advise(&body, &rest, &Demand::new(1.0, 1e-6)), Err(AdviseError::AtRest)));
    let braked = body.with(Force::drag(0.1, 0.0).unwrap());
    let mut demand = Demand::new(1.0, 1e-6);
    demand.energy_error = Some(1e-6);
    assert!(matches!(advise(&braked, &start, &demand), Err(AdviseError::NotConserved)));
}

/// A law in `f64` alone cannot be judged in double-double; a torque that starts a body from rest can.
#[test]
fn forces_decide_what_can_be_judged() {
    let (free, _) = textbook();
    let pushed = free.with(Force::constant_torque_space(Vector3::new(0.0, 0.1, 0.2)).unwrap());
    let rest = pushed.state(UnitQuaternion::identity(), Vector3::zeros()).unwrap();
    let demand = Demand::new(20.0, 1e-6);
    let best = advise(&pushed, &rest, &demand).unwrap().best;
    assert!(check(&pushed, &rest, &demand, &best).unwrap() <= 1e-6);
    assert_eq!(best.energy_error, None);
}

/// A thousand radians and more of bodies whose rate changes: the run that is advised was seen to its end, and the stated factor holds.
#[test]
fn the_stated_error_holds_where_the_rate_changes() {
    let inertia = || Inertia::from_moments([1.0, 2.0, 2.5]).unwrap();
    let torque = |x: f64, y: f64, z: f64| Force::constant_torque_body(Vector3::new(x, y, z)).unwrap();
    for (force, until) in [
        (torque(1e-4, 0.0, 0.0), 1000.0),
        (torque(0.0, 0.0, 0.02), 400.0),
        (Force::drag(5e-3, 1e-3).unwrap(), 3000.0),
        (Force::gravity_gradient(0.05, 0.2).unwrap(), 300.0),
    ] {
        let body = Body::free(inertia()).with(force);
        let start = body.state(UnitQuaternion::identity(), Vector3::new(0.4, 1.0, -0.3)).unwrap();
        let demand = without_closed_form(until, 1e-6);
        let best = advise(&body, &start, &demand).unwrap().best;
        let actual = check(&body, &start, &demand, &best).unwrap();
        let stated = best.attitude_error.value * best.attitude_error.factor;
        assert!(best.whole_time && actual <= 1e-6 && actual <= stated, "{actual:e}, {best:?}");
    }
}

/// A torque that jumps is no chaos: methods that choose their steps pass it, and where they do not agree it is named.
#[test]
fn a_torque_that_jumps_is_called_that() {
    let free = Body::free(Inertia::from_moments([1.0, 2.0, 2.5]).unwrap());
    let thruster = |t: f64, _, _| Vector3::new(if t > 60.0 && t < 65.0 { 0.05 } else { 0.0 }, 0.0, 0.0);
    let body = free.with(Force::torque_fn("thruster", thruster));
    let start = body.state(UnitQuaternion::identity(), Vector3::new(0.4, 1.0, -0.3)).unwrap();
    let advice = advise(&body, &start, &without_closed_form(100.0, 1e-5)).unwrap();
    assert!(advice.jump.is_some_and(|time| (time - 60.0).abs() < 1e-3), "{:?}", advice.jump);
    let later = |demand: f64| advise(&body, &start, &without_closed_form(100.0, demand));
    match later(1e-13) {
        Err(AdviseError::Jumps { time, .. }) => assert!((time - 60.0).abs() < 1e-3),
        other => assert!(!matches!(other, Err(AdviseError::Chaotic { .. })), "{other:?}"),
    }
    let hammering = Force::torque_fn("hammer", |t: f64, _, _| {
        Vector3::new(if ((t * 20.0) as u64).is_multiple_of(2) { 0.3 } else { -0.3 }, 0.0, 0.0)
    });
    let body = Body::free(Inertia::from_moments([1.0, 2.0, 2.5]).unwrap()).with(hammering);
    match advise(&body, &start, &without_closed_form(100.0, 1e-6)) {
        Err(error) => assert!(error.to_string().starts_with("the torque jumps at t = 0.05"), "{error}"),
        Ok(advice) => assert!(advice.jump.is_some(), "{advice:?}"),
    }
}

#[test]
fn a_chaotic_top_is_called_chaotic_and_a_body_that_spins_up_is_not() {
    let inertia = Inertia::from_moments([0.5, 0.85, 1.0]).unwrap();
    let top = Body::heavy(inertia, Vector3::new(0.0, 0.0, 1.0)).unwrap();
    let tilted = UnitQuaternion::from_scaled_axis(Vector3::new(0.1, 0.04, 0.0));
    let start = top.state(tilted, Vector3::new(0.2, 0.235, 0.5)).unwrap();
    match advise(&top, &start, &Demand::new(1000.0, 1e-6)) {
        Err(AdviseError::Chaotic { agree_until, .. }) => assert!(agree_until > 10.0 && agree_until < 900.0),
        other => panic!("{other:?}"),
    }
    let (free, _) = textbook();
    let spun = free.with(Force::constant_torque_body(Vector3::new(0.0, 0.0, 0.2)).unwrap());
    let start = spun.state(UnitQuaternion::identity(), Vector3::new(0.1, 0.2, 0.3)).unwrap();
    assert!(advise(&spun, &start, &Demand::new(200.0, 1e-6)).is_ok());
}

//! Events are found where they are, none is missed that the bounds exclude, and looking between steps changes no bit.

use nalgebra::{Matrix3, UnitQuaternion, Vector3};
use polhode::body::{Body, Force, Problem, State, Wheel};
use polhode::events::{Crossing, Event, EventError};
use polhode::flow::{ExactMotion, FreeMotion};
use polhode::inertia::Inertia;
use polhode::method::{AnyMethod, Claimed, catalogue, method};
use polhode::num::{Dd, Precise, Real};
use polhode::rotation::{Vec3, rotation_angle};
use polhode::run::{Run, RunError};

fn racket() -> Body {
    Body::free(Inertia::from_moments([1.0, 2.0, 3.0]).unwrap())
}

fn start(body: &Body, omega: [f64; 3]) -> State {
    body.state(UnitQuaternion::from_euler_angles(0.3, -0.5, 1.1), omega.into()).unwrap()
}

fn free(omega: [f64; 3]) -> FreeMotion {
    FreeMotion::from_state(racket().inertia(), &start(&racket(), omega)).unwrap()
}

/// A number in [0, 1) for each `k`, spread evenly.
fn spread(k: usize) -> f64 {
    (k as f64 * 0.618_033_988_749_894_9).fract()
}

/// The angle between an axis of the body and one of space, in double-double.
fn angle(motion: &FreeMotion, t: Dd, of_body: [f64; 3], in_space: [f64; 3]) -> Dd {
    let turned = motion.point_at_dd(t).attitude.rotate(Vec3(of_body).map(Dd::of));
    let other = Vec3(in_space).map(Dd::of);
    turned.cross(other).norm().atan2(turned.dot(other))
}

/// By bisection in double-double, which shares nothing with the search but the motion. `POLHODE_EVENTS` asks for another number
/// of motions; 90 have more than 10,000 crossings.
#[test]
fn crossings_of_a_cone_are_found_to_rounding_and_none_is_missed() {
    let (of_body, in_space) = ([0.6, 0.0, 0.8], [0.0, 0.0, 1.0]);
    let (mut count, mut looks, mut worst) = (0, 0, 0.0_f64);
    let motions: usize =
        std::env::var("POLHODE_EVENTS").ok().and_then(|count| count.parse().ok()).unwrap_or(20);
    for k in 0..motions {
        let motion = free([0.4 + spread(k), 1.0 - 2.0 * spread(3 * k + 1), 0.9 * spread(7 * k + 2) - 0.4]);
        let half = 0.6 + 1.2 * spread(5 * k + 4);
        let event = Event::enters_cone(of_body.into(), in_space.into(), half).unwrap();
        let (from, to) = (1000.0 * spread(k + 11), 1000.0 * spread(k + 11) + 900.0);
        let found = motion.events(&[event], from, to, 0.5).unwrap();
        assert!(found.may_miss.is_empty());
        looks += found.looks;
        let inside = |t: Dd| Dd::of(half) - angle(&motion, t, of_body, in_space);
        let fine = 1.0 / 32.0;
        let is_inside = |t: f64| {
            let turned = motion.at(t).unwrap().rotation() * Vector3::from(of_body);
            turned.angle(&Vector3::from(in_space)) < half
        };
        let (mut expected, mut before) = (Vec::new(), is_inside(from));
        for n in 1..=(900.0 / fine) as usize {
            let t = from + n as f64 * fine;
            let now = is_inside(t);
            if !before && now {
                let (mut low, mut high) = (Dd::of(t - fine), Dd::of(t));
                for _ in 0..60 {
                    let middle = (low + high) * 0.5;
                    if inside(middle).hi() < 0.0 { low = middle } else { high = middle }
                }
                expected.push(low);
            }
            before = now;
        }
        let entered: Vec<Dd> =
            found.found.iter().filter(|x| x.crossing == Crossing::Rising).map(|x| x.time).collect();
        // what the search finds between two fine looks, they cannot see
        assert!(entered.len() >= expected.len(), "{k}: {} of {}", entered.len(), expected.len());
        for time in expected {
            let nearest = entered.iter().map(|t| (*t - time).magnitude()).fold(f64::MAX, f64::min);
            worst = worst.max(nearest / time.hi());
            count += 1;
        }
    }
    let each = looks as f64 / count as f64;
    println!("{count} crossings, found within {worst:.1e} of their times, by {each:.1} looks each");
    assert!(count > 100 * motions && worst < 1e-13, "{count} crossings, {worst:.1e}");
    // an interval without exclusion would be looked at 4096 times
    assert!(each < 200.0, "{each} looks");
}

#[test]
fn flips_are_those_that_the_closed_form_counts_also_far_away() {
    let body = racket();
    for omega in [[1e-3, 1.0, 0.0], [1e-8, 1.0, 1e-9], [0.4, 1.0, -0.3]] {
        let motion = free(omega);
        for from in [0.0, 1e6, 1e12] {
            let to = from + 500.0;
            let found = motion.events(&[Event::flip(&body)], from, to, 0.25).unwrap();
            let counted = motion.flips(Dd::of(to)) - motion.flips(Dd::of(from));
            assert_eq!(found.found.len() as u64, counted, "{omega:?} from {from}");
        }
    }
}

/// Looks that are many events apart find what looks between any two of them find: the bounds divide the time.
#[test]
fn a_bounded_rate_misses_nothing_whatever_the_spacing() {
    let body = racket();
    for omega in [[1e-3, 1.0, 0.0], [0.4, 1.0, -0.3]] {
        let motion = free(omega);
        let events = [
            Event::flip(&body),
            Event::enters_cone(Vector3::z(), Vector3::x(), 1.0).unwrap(),
            Event::rate_above(&body, 0.9).unwrap(),
        ];
        let times = |spacing: f64| -> Vec<(usize, f64)> {
            let found = motion.events(&events, 0.0, 400.0, spacing).unwrap();
            assert!(found.may_miss.is_empty());
            found.found.iter().map(|one| (one.event, one.time.hi())).collect()
        };
        let fine = times(1.0 / 64.0);
        assert!(fine.len() > 20, "{}", fine.len());
        for spacing in [0.5, 3.0, 40.0] {
            let found = times(spacing);
            assert_eq!(found.len(), fine.len(), "{omega:?} {spacing}");
            for (a, b) in found.iter().zip(&fine) {
                assert!(a.0 == b.0 && (a.1 - b.1).abs() < 1e-12 * 400.0, "{omega:?} {spacing}: {a:?} {b:?}");
            }
        }
    }
}

/// Under gravity the momentum in the body turns faster than the body: the bound is that of ω.
#[test]
fn flips_of_a_top_are_all_found() {
    let top =
        Body::heavy(Inertia::from_moments([1.0, 1.0, 0.25]).unwrap(), Vector3::new(0.0, 0.0, 2.0)).unwrap();
    for omega in [[0.1, 0.2, 0.3], [0.0, 0.3, 0.01], [0.0, 0.0, 20.0]] {
        let motion = ExactMotion::new(&top, &start(&top, omega)).unwrap();
        let count = |spacing: f64| {
            let found = motion.events(&[Event::flip(&top)], 0.0, 100.0, spacing).unwrap();
            assert!(found.may_miss.is_empty());
            found.found.len()
        };
        let fine = count(1.0 / 128.0);
        assert!(fine > 20, "{omega:?}: {fine}");
        assert_eq!([count(0.5), count(2.0), count(10.0)], [fine; 3], "{omega:?}");
    }
}

/// The axis of a free symmetric top stays between two cones about any axis in space.
#[test]
fn a_cone_that_is_hardly_touched_is_touched_twice_or_not_at_all() {
    let body = Body::free(Inertia::from_moments([1.0, 1.0, 1.5]).unwrap());
    let motion = FreeMotion::from_state(body.inertia(), &start(&body, [0.5, 0.0, 2.0])).unwrap();
    let momentum = motion.at(0.0).unwrap().momentum_space().normalize();
    let tip = momentum.cross(&Vector3::x()).normalize();
    // an axis 0.7 rad from L; that of the body is `nutation` from L, so at least 0.7 − nutation away
    let axis = momentum * libm::cos(0.7) + tip * libm::sin(0.7);
    let nutation = libm::atan2(0.5, 3.0);
    let period = core::f64::consts::TAU / motion.at(0.0).unwrap().momentum().norm();
    let periods = 50.0;
    for margin in [1e-3, 1e-6, 1e-9, 1e-11] {
        for (sign, times) in [(1.0, 50), (-1.0, 0)] {
            let half = 0.7 - nutation + sign * margin;
            let event = Event::enters_cone(Vector3::z(), axis, half).unwrap();
            let found = motion.events(&[event], 0.0, periods * period, period / 3.0).unwrap();
            assert_eq!(found.found.len(), times, "{margin:e} {sign}");
        }
    }
}

/// What stays at its limit to within rounding is found once, at the start, and not wherever rounding passes the limit; a limit that is
/// further off than rounding is told from it.
#[test]
fn what_stays_at_its_limit_is_found_once() {
    let body = Body::free(Inertia::from_moments([1.0, 1.0, 2.0]).unwrap());
    let omega = Vector3::new(1.0, 0.0, 0.5);
    let motion = FreeMotion::from_omega(body.inertia(), UnitQuaternion::identity(), omega).unwrap();
    // L = (1, 0, 1), and |ω|² = 5/4
    let momentum = Vector3::new(1.0, 0.0, 1.0);
    let (angle, rate) = (core::f64::consts::FRAC_PI_4, 1.25_f64.sqrt());
    let events = |off: f64| {
        [
            Event::enters_cone(Vector3::z(), momentum, angle + off).unwrap(),
            Event::enters_cone(Vector3::z(), -momentum, 3.0 * angle + off).unwrap(),
            Event::rate_above(&body, rate - off).unwrap(),
            Event::rate_below(&body, rate + off).unwrap(),
        ]
    };
    for (off, count) in [(0.0, 4), (1e-13, 4), (-1e-13, 0)] {
        let found = motion.events(&events(off), 0.0, 2.0, 0.25).unwrap().found;
        assert!(found.iter().all(|one| one.crossing == Crossing::AtStart), "{off:e}: {found:?}");
        assert_eq!(found.len(), count, "{off:e}");
    }
}

/// Of a body whose wheel has a thousand times its momentum the rate has the rounding of that of the wheel, which is no event either.
#[test]
fn rounding_of_a_fast_wheel_is_no_event() {
    let wheel = Wheel::new(Vector3::z(), 0.1, 1e4).unwrap();
    let body = Body::free(Inertia::from_moments([1.0, 1.0, 2.0]).unwrap()).with_wheel(wheel).unwrap();
    let begin = body.state(UnitQuaternion::identity(), Vector3::new(1.0, 0.0, 0.5)).unwrap();
    let motion = ExactMotion::new(&body, &begin).unwrap();
    let rate = 1.25_f64.sqrt();
    let events = [Event::rate_above(&body, rate).unwrap(), Event::rate_below(&body, rate).unwrap()];
    let found = motion.events(&events, 0.0, 0.5, 0.1).unwrap().found;
    assert!(found.len() == 2 && found.iter().all(|one| one.crossing == Crossing::AtStart), "{found:?}");
    // one that is further off is told
    let beyond = Event::rate_above(&body, rate + 1e-11).unwrap();
    assert!(motion.events(&[beyond], 0.0, 0.5, 0.1).unwrap().found.is_empty());
}

/// Of a steady spin the momentum along the middle axis is rounding, whose signs are no flips; nor do they jump.
#[test]
fn rounding_about_a_steady_spin_turns_nothing_over() {
    let axes = UnitQuaternion::from_euler_angles(0.3, -0.5, 1.1).to_rotation_matrix().into_inner();
    let tensor = axes * Matrix3::from_diagonal(&Vector3::new(1.0, 2.0, 3.0)) * axes.transpose();
    let body = Body::free(Inertia::from_tensor(tensor).unwrap());
    for axis in [0, 2] {
        let begin = body.state(UnitQuaternion::identity(), axes.column(axis).into_owned()).unwrap();
        let motion = FreeMotion::from_state(body.inertia(), &begin).unwrap();
        let exact = motion.events(&[Event::flip(&body)], 0.0, 30.0, 0.25).unwrap();
        let mut run = Run::new(&method("rk4").unwrap(), &body, &begin, 0.1).unwrap();
        let stepped = run.events(&[Event::flip(&body)], 30.0, 0.1).unwrap();
        for found in [exact.found, stepped.found] {
            assert!(found.len() == 1 && found[0].crossing == Crossing::AtStart, "{axis}: {found:?}");
        }
    }
}

#[test]
fn the_nearest_approach_is_the_least_distance() {
    let (body, motion) = (racket(), free([0.4, 1.0, -0.3]));
    let target = UnitQuaternion::from_euler_angles(1.0, 0.2, -2.0);
    let found = motion.events(&[Event::nearest(&body, target)], 0.0, 200.0, 0.1).unwrap();
    assert_eq!(found.may_miss, [0]);
    assert!(found.found.len() > 20);
    for near in &found.found {
        let at = |t: f64| motion.at(t).unwrap().rotation().angle_to(&target);
        let t = near.time.hi();
        assert!(at(t) <= at(t - 1e-3) && at(t) <= at(t + 1e-3));
    }
}

#[test]
fn along_a_run_events_are_off_by_the_error_of_the_method() {
    let body = racket();
    let begin = start(&body, [0.4, 1.0, -0.3]);
    let motion = FreeMotion::from_state(body.inertia(), &begin).unwrap();
    let events = [
        Event::flip(&body),
        Event::enters_cone(Vector3::z(), Vector3::x(), 1.0).unwrap(),
        Event::rate_above(&body, 0.9).unwrap(),
    ];
    let exact = motion.events(&events, 0.0, 100.0, 0.05).unwrap().found;
    assert!(exact.len() > 20, "{}", exact.len());
    for (name, h, most) in [
        ("rk4", 0.01, 1e-7),
        ("two-turn@kahan-li-8", 0.05, 1e-7),
        ("gauss:8", 0.05, 1e-10),
        ("taylor", 0.05, 1e-12),
        ("taylor", 10.0, 1e-12),
        ("dop853:1e-12", 10.0, 1e-9),
        ("tsit5:1e-10", 10.0, 1e-6),
        ("exact-step", 0.05, 1e-12),
    ] {
        let mut run = Run::new(&method(name).unwrap(), &body, &begin, h).unwrap();
        let found = run.events(&events, 100.0, 0.05).unwrap();
        assert_eq!(found.found.len(), exact.len(), "{name}");
        for (a, b) in found.found.iter().zip(&exact) {
            assert_eq!((a.event, a.crossing), (b.event, b.crossing), "{name}");
            let off = (a.time - b.time).magnitude();
            assert!(off < most, "{name}: {off:.1e} at {}", b.time.hi());
        }
        assert_eq!(run.sample().time.hi(), 100.0);
    }
}

#[test]
fn a_search_ends_at_the_first_event_that_stops_and_the_run_stands_before_it() {
    let body = racket();
    let begin = start(&body, [1e-3, 1.0, 0.0]);
    let mut run = Run::new(&method("lie-poisson").unwrap(), &body, &begin, 0.01).unwrap();
    let untouched = |steps: u64| {
        Run::new(&method("lie-poisson").unwrap(), &body, &begin, 0.01).unwrap().advance_to(steps).unwrap()
    };
    let first = run.until(&Event::flip(&body), 100.0).unwrap().unwrap();
    let here = run.sample();
    assert!(here.time < first.time && first.time.hi() < here.time.hi() + 0.01);
    assert_eq!(here.point, untouched(here.steps).point);
    assert_eq!((here.flips, here.worst.energy), (Some(0), untouched(here.steps).worst.energy));
    // from there it goes on as if nobody had looked
    let second = run.until(&Event::flip(&body), 100.0).unwrap().unwrap();
    assert_eq!(second.time, first.time);
    let never = Event::rate_above(&body, 1e3).unwrap();
    assert_eq!(run.until(&never, 50.0).unwrap(), None);
    assert_eq!(run.sample().point, untouched(5000).point);
}

/// Every method of the catalogue, and others that remember something between steps.
fn methods() -> Vec<Box<dyn AnyMethod>> {
    let mut all = catalogue();
    for name in ["dmv:10", "taylor:8", "kick-drift@blanes-casas-murua-6-11", "dop853:1e-7", "lie-newmark"] {
        all.push(method(name).unwrap());
    }
    all
}

#[test]
fn looking_between_steps_changes_no_bit() {
    let body = racket();
    let begin = start(&body, [0.4, 1.0, -0.3]);
    for method in methods() {
        let run = || Run::new(&method, &body, &begin, 0.125).unwrap();
        let (mut looked, mut straight) = (run(), run());
        for t in [0.1, 0.2, 0.3125, 1.0, 3.7, 3.71, 7.99] {
            looked.at(t).unwrap();
        }
        looked.events(&[Event::flip(&body)], 9.0, 0.01).unwrap();
        let (a, b) = (looked.advance_to(80).unwrap(), straight.advance_to(80).unwrap());
        assert_eq!((a.point, a.worst, a.flips), (b.point, b.worst, b.flips), "{}", method.name());
        assert_eq!(looked.work(), straight.work(), "{}", method.name());
        assert_eq!(run().at(1.25).unwrap().point, run().advance_to(10).unwrap().point);
    }
}

/// The error of the state 0.4 of a step behind a step, against that of a step half as long.
#[test]
fn between_steps_a_method_has_the_local_order_that_it_claims() {
    let body = racket();
    let begin = start(&body, [0.4, 1.0, -0.3]);
    let motion = FreeMotion::from_state(body.inertia(), &begin).unwrap();
    let error = |method: &dyn AnyMethod, h: f64| {
        let t = 0.4 * h;
        let x = Run::new(method, &body, &begin, h).unwrap().at(t).unwrap().point;
        rotation_angle(x.attitude.map(Dd::of), motion.point_at_dd(Dd::of(t)).attitude).to_f64()
    };
    let mut measured = 0;
    for method in methods().iter().filter(|method| method.tolerance().is_none()) {
        let Some(order) = method.claims(Problem::Free).and_then(|claims| claims.order) else {
            continue;
        };
        // the shortest step whose error, and that of its half, is far from rounding
        let step = (0..8).map(|k| 0.02 * f64::from(1 << k)).find(|h| error(method, *h) > 1e-9);
        let h = step.unwrap_or_else(|| panic!("{}: no error", method.name()));
        let (coarse, fine) = (error(method, h), error(method, 0.5 * h));
        let found = libm::log2(coarse / fine);
        println!("{}: local order {found:.2} of {}", method.name(), order + 1);
        assert!(found > f64::from(order) + 0.6, "{}: {found:.2}, {coarse:.1e} {fine:.1e}", method.name());
        measured += 1;
    }
    assert!(measured > 20, "{measured}");
}

#[test]
fn dense_output_is_about_as_exact_as_the_steps() {
    let body = racket();
    let begin = start(&body, [0.4, 1.0, -0.3]);
    let motion = FreeMotion::from_state(body.inertia(), &begin).unwrap();
    // as far off as the tolerance lets a step be
    for (name, most) in
        [("dop853:1e-6", 1e-4), ("tsit5:1e-6", 1e-4), ("taylor:1e-8", 1e-7), ("taylor", 1e-14)]
    {
        let mut run = Run::new(&method(name).unwrap(), &body, &begin, 5.0).unwrap();
        let worst = (1..50).fold(0.0_f64, |worst, k| {
            let t = 0.1 * f64::from(k);
            let x = run.at(t).unwrap().state;
            worst.max(x.rotation().angle_to(&motion.at(t).unwrap().rotation()))
        });
        assert!(worst < most, "{name}: {worst:.1e}");
    }
}

#[test]
fn times_between_steps_know_the_energy_of_a_field_that_turns() {
    // a force that depends on time: the readings are of the time asked for
    let push = Force::torque_fn("push", |t, _, _| Vector3::new(0.0, 0.0, libm::sin(t)));
    let body = Body::free(Inertia::from_moments([1.0, 1.0, 2.0]).unwrap()).with(push);
    let begin = body.state(UnitQuaternion::identity(), Vector3::zeros()).unwrap();
    for name in ["rk8", "dop853:1e-12"] {
        let mut run = Run::new(&method(name).unwrap(), &body, &begin, 0.25).unwrap();
        let between = run.at(2.1).unwrap();
        // I ω = 1 − cos t
        assert!((between.omega_body.z - 0.5 * (1.0 - libm::cos(2.1))).abs() < 1e-9, "{name}");
        assert_eq!((between.steps, between.time.hi()), (8, 2.1));
    }
}

#[test]
fn what_is_already_so_is_said_and_what_never_happens_is_not_found() {
    let (body, motion) = (racket(), free([0.4, 1.0, -0.3]));
    let always = Event::when("always", |_, _| true);
    let found = motion.events(&[always.clone().stopping()], 5.0, 6.0, 0.1).unwrap().found;
    assert_eq!((found.len(), found[0].crossing, found[0].time), (1, Crossing::AtStart, Dd::of(5.0)));
    let found =
        motion.events(&[always, Event::zero("t = 5 s", |t, _| t - 5.0)], 5.0, 6.0, 0.1).unwrap().found;
    assert_eq!(found.len(), 2);
    let never = Event::rate_above(&body, 100.0).unwrap();
    assert!(motion.events(&[never], 0.0, 1e4, 1.0).unwrap().found.is_empty());
    // between looks, at a look, and between looks where the bound has it looked at
    for (at, spacing) in [(3.3, 0.5), (3.3, 1.0 / 256.0), (3.5, 0.5), (3.25, 0.5), (3.375, 0.5)] {
        let touching = Event::zero("touches", move |t, _| (t - at) * (t - at));
        for event in [touching.clone(), touching.changing_at_most(20.0)] {
            let found = motion.events(&[event], 0.0, 10.0, spacing).unwrap().found;
            assert_eq!((found.len(), found[0].crossing), (1, Crossing::Touching), "{at} {spacing}");
            assert!((found[0].time.hi() - at).abs() < 1e-6, "{at} {spacing}: {:?}", found[0].time);
        }
    }
}

#[test]
fn a_condition_is_found_where_it_begins_and_a_function_that_jumps_is_refused() {
    let motion = free([0.4, 1.0, -0.3]);
    let later = Event::when("later", |t, _| t > 4.56);
    let found = motion.events(&[later], 0.0, 10.0, 0.5).unwrap().found;
    assert_eq!(found.len(), 1);
    assert!((found[0].time.hi() - 4.56).abs() < 1e-14 && found[0].time.hi() > 4.56);
    let jumps = Event::zero("jumps", |t, _| if t > 4.56 { 2.0 } else { -1.0 });
    let error = motion.events(&[jumps], 0.0, 10.0, 0.5).unwrap_err();
    assert!(matches!(error, EventError::NotContinuous { before: -1.0, after: 2.0, .. }), "{error}");
    let nothing = Event::zero("nothing", |t, _| if t > 2.0 { f64::NAN } else { 1.0 });
    let error = motion.events(&[nothing], 0.0, 10.0, 0.5).unwrap_err();
    assert!(
        matches!(error, EventError::NotANumber { .. }) && error.to_string().contains("t = 2.5 s"),
        "{error}"
    );
    let fast = Event::zero("fast", |t, _| 10.0 * t - 3.0).changing_at_most(1.0);
    let error = motion.events(&[fast], 0.0, 10.0, 0.5).unwrap_err();
    assert!(matches!(error, EventError::FasterThanStated { change: 5.0, .. }), "{error}");
    // infinitely many roots before t = 7 s; each interval between looks has those that its looks show
    let zeno = Event::zero("zeno", |t, _| (7.0 - t) * libm::sin(1.0 / (7.0 - t + 1e-300)));
    assert!(motion.events(&[zeno], 0.0, 8.0, 0.01).unwrap().found.len() < 1000);
}

#[test]
fn searches_that_cannot_be_are_refused() {
    let (body, motion) = (racket(), free([0.4, 1.0, -0.3]));
    let flip = [Event::flip(&body)];
    let refused = |from: f64, to: f64, spacing: f64| motion.events(&flip, from, to, spacing).unwrap_err();
    assert!(matches!(refused(0.0, f64::NAN, 1.0), EventError::Time(_)));
    assert!(matches!(refused(1.0, 1.0, 1.0), EventError::NotAscending { .. }));
    assert!(matches!(refused(0.0, 1.0, 0.0), EventError::Spacing { .. }));
    assert!(matches!(refused(0.0, 1.0, f64::NAN), EventError::Spacing { .. }));
    assert!(matches!(refused(0.0, 1e9, 1e-9), EventError::TooMany { .. }));
    assert!(Event::enters_cone(Vector3::zeros(), Vector3::z(), 1.0).is_err());
    assert!(Event::enters_cone(Vector3::z(), Vector3::z(), -1.0).is_err());
    assert!(Event::rate_above(&body, 0.0).is_err());
    let begin = start(&body, [0.4, 1.0, -0.3]);
    let mut run = Run::new(&method("rk4").unwrap(), &body, &begin, 0.1).unwrap();
    run.advance_to(100).unwrap();
    assert!(matches!(run.at(-1.0), Err(RunError::Time(_))));
    assert!(matches!(run.at(f64::NAN), Err(RunError::Time(_))));
    assert!(matches!(run.at(5.03), Err(RunError::Past { asked: 5.03, reached: 10.0 })));
    assert!(matches!(run.events(&flip, 5.0, 0.1), Err(RunError::Event(_))));
    let fast = start(&body, [30.0, 20.0, -10.0]);
    let mut wild = Run::new(&method("explicit-euler").unwrap(), &body, &fast, 1.0).unwrap();
    assert!(matches!(wild.at(1000.5), Err(RunError::Diverged { .. })));
    let mut unsolved = Run::new(&method("rattle").unwrap(), &body, &fast, 1.0).unwrap();
    let error = unsolved.at(0.9).unwrap_err();
    assert!(matches!(error, RunError::Unsolved { .. }), "{error}");
}

#[test]
fn what_happened_before_a_run_diverged_is_kept() {
    let body = racket();
    let begin = start(&body, [0.4, 1.0, -0.3]);
    let mut run = Run::new(&method("explicit-euler").unwrap(), &body, &begin, 0.25).unwrap();
    let (found, ended) = run.events_so_far(&[Event::zero("t = 1.1 s", |t, _| t - 1.1)], 1e4, 0.25);
    let diverged = matches!(ended, Err(RunError::Diverged { .. } | RunError::OutOfRange { .. }));
    assert!(diverged, "{ended:?}");
    assert_eq!(found.found.len(), 1);
    assert!((found.found[0].time.hi() - 1.1).abs() < 1e-12);
}

/// Euler's method stretches the quaternion: what happens behind the last step at which it still is a rotation is left out.
#[test]
fn a_search_ends_where_the_numbers_are_no_rotation() {
    let body = racket();
    let begin = start(&body, [0.001, 1.0, 0.0]);
    let run = || Run::new(&method("explicit-euler").unwrap(), &body, &begin, 0.5).unwrap();
    let mut plain = run();
    let lost = (1..).find(|steps| plain.advance_to(*steps).unwrap().nonsense().is_some()).unwrap();
    let last = 0.5 * (lost - 1) as f64;
    // a quarter of a second past each full one, between two steps
    let past = Event::zero("a quarter past", |t, _| Real::sin_cos(core::f64::consts::PI * (t - 0.25)).0);
    let (found, ended) = run().events_so_far(&[past], 20.0, 0.5);
    let Err(RunError::Nonsense { why }) = &ended else { panic!("{ended:?}") };
    assert!(why.contains("no longer describe the motion"), "{why}");
    let before = (0..20).filter(|k| f64::from(*k) + 0.25 < last).count();
    assert!(before > 2 && found.found.len() == before, "{before} of {found:?}");
}

/// A closed form keeps what it has found, too.
#[test]
fn what_happened_before_a_search_failed_is_kept() {
    let motion = ExactMotion::new(&racket(), &start(&racket(), [0.4, 1.0, -0.3])).unwrap();
    let ends = Event::zero("ends", |t, _| if t > 5.0 { f64::NAN } else { 1.0 });
    let early = Event::zero("t = 1.1 s", |t, _| t - 1.1);
    let (found, ended) = motion.events_so_far(&[ends, early], 0.0, 10.0, 0.5);
    assert!(matches!(ended, Err(EventError::NotANumber { time: 5.5, .. })), "{ended:?}");
    assert!(found.found.len() == 1 && found.found[0].event == 1);
    let (none, refused) = motion.events_so_far(&[], 0.0, f64::NAN, 0.5);
    assert!(none.found.is_empty() && matches!(refused, Err(EventError::Time(_))), "{refused:?}");
}

#[test]
fn a_top_is_searched_like_a_free_body() {
    let top =
        Body::heavy(Inertia::from_moments([1.0, 1.0, 0.25]).unwrap(), Vector3::new(0.0, 0.0, 2.0)).unwrap();
    let tilted = UnitQuaternion::from_axis_angle(&Vector3::x_axis(), 0.5);
    let begin = top.state(tilted, Vector3::new(0.0, 0.0, 20.0)).unwrap();
    let motion = ExactMotion::new(&top, &begin).unwrap();
    let event = Event::enters_cone(Vector3::z(), Vector3::z(), 0.6).unwrap();
    let exact = motion.events(std::slice::from_ref(&event), 0.0, 100.0, 0.05).unwrap();
    let mut run = Run::new(&method("taylor").unwrap(), &top, &begin, 1.0).unwrap();
    let found = run.events(&[event], 100.0, 0.05).unwrap();
    assert!(exact.may_miss.is_empty() && found.may_miss == [0]);
    assert_eq!(exact.found.len(), found.found.len());
    assert!(exact.found.iter().zip(&found.found).all(|(a, b)| (a.time - b.time).magnitude() < 1e-11));
}

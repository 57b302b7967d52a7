//! What every method that chooses its steps has to do: output changes no bit, runs are taken up, no scale is special.

use crate::motions::{free, magnet, run, satellite, started, thruster, top};
use polhode::body::{Body, Force, State};
use polhode::inertia::Inertia;
use polhode::method::{AnyMethod, Claimed, catalogue, method};
use polhode::run::{Run, Watch};

fn adaptive_methods() -> impl Iterator<Item = Box<dyn AnyMethod>> {
    catalogue().into_iter().filter(|method| method.tolerance().is_some())
}

/// Every adaptive method with its usual tolerance and with a tight one, each with the motions that it is for.
fn adaptive() -> Vec<(String, Vec<(Body, State)>)> {
    let names = adaptive_methods()
        .flat_map(|base| [base.name(), format!("{}:1e-9", base.name()), format!("{}:1e-12", base.name())]);
    let with_cases = |name: String| {
        let mut cases = vec![free(), top(), magnet(), satellite()];
        if !method(&name).unwrap().needs_series() {
            cases.push(thruster());
        }
        (name, cases)
    };
    names.map(with_cases).collect()
}

/// The state at t = 28, whatever the interval of output, and wherever it was read.
#[test]
fn neither_output_nor_reading_changes_a_bit() {
    for (name, cases) in adaptive() {
        for case in cases {
            let at = |h: f64, steps: &[u64], watch: Watch| {
                let mut run = run(&name, &case, h).watching(watch);
                let samples: Vec<_> = steps.iter().map(|&n| run.advance_to(n).unwrap()).collect();
                samples.last().unwrap().state
            };
            let expected = at(28.0, &[1], Watch::EveryStep);
            for (h, steps) in [(28.0 / 1024.0, &[1024][..]), (3.5, &[1, 2, 5, 8]), (0.875, &[3, 4, 32])] {
                for watch in [Watch::EveryStep, Watch::AtSamples, Watch::Never] {
                    assert_eq!(at(h, steps, watch), expected, "{name} {h} {watch}");
                }
            }
        }
    }
}

#[test]
fn a_run_is_taken_up_within_and_between_its_steps() {
    for (name, cases) in adaptive() {
        for case in cases {
            for (h, taken) in [(0.01, 777), (5.0, 3)] {
                let mut straight = run(&name, &case, h);
                straight.advance_to(taken).unwrap();
                let text = straight.checkpoint().to_string();
                let mut resumed =
                    Run::resume(&method(&name).unwrap(), &case.0, &text.parse().unwrap()).unwrap();
                assert_eq!(resumed.sample().point, straight.sample().point, "{name}");
                let (a, b) =
                    (straight.advance_to(2 * taken).unwrap(), resumed.advance_to(2 * taken).unwrap());
                assert_eq!((a.point, a.worst), (b.point, b.worst), "{name}");
            }
        }
    }
}

/// Motions of any speed, on bodies of any size.
#[test]
fn speeds_and_sizes_at_the_ends_of_the_range_change_nothing_but_the_scale() {
    for method in adaptive_methods() {
        let name = method.name();
        let turned = |size: f64, speed: f64| {
            let body = Body::free(Inertia::from_moments([1.0, 2.0, 3.0].map(|i| i * size)).unwrap());
            let case = started(body, [0.4, 1.0, -0.3].map(|w| w * speed));
            run(&name, &case, 64.0 / speed).advance_to(2).unwrap().state.attitude
        };
        let expected = turned(1.0, 1.0);
        for (size, speed) in [(-150, 40), (110, -60), (0, 100), (0, -100)] {
            let found = turned(libm::scalbn(1.0, size), libm::scalbn(1.0, speed));
            assert_eq!(found, expected, "{name}: 2^{size}, 2^{speed}");
        }
    }
}

/// A method counts what it does; a map that is not asked for more does nothing.
#[test]
fn work_grows_with_the_steps_alone() {
    for (name, cases) in adaptive() {
        for case in cases {
            let work = |h: f64, steps: u64| {
                let mut run = run(&name, &case, h).watching(Watch::Never);
                run.advance_to(steps).unwrap();
                run.work().unwrap()
            };
            let (once, often) = (work(28.0, 1), work(28.0 / 64.0, 64));
            assert_eq!((once.accepted, once.rejected), (often.accepted, often.rejected), "{name}");
            assert!(once.evaluations > once.accepted, "{name}: {once:?}");
            let cost = method(&name).unwrap().claims(case.0.problem()).unwrap().cost;
            let claimed = u64::from(cost.right_sides) * (once.accepted + once.rejected);
            // what the beginning, a rejected step and dense output take less or more
            let apart = once.evaluations.abs_diff(claimed);
            assert!(apart <= 8 + u64::from(cost.right_sides) + once.rejected, "{name}: {once:?}, {cost}");
        }
    }
}

/// What a name says is what the method says, and a tolerance is of those alone that choose their steps.
#[test]
fn a_tolerance_is_a_property_and_not_a_spelling() {
    for (name, tolerance) in
        [("taylor:20", None), ("rk4", None), ("tsit5:1e-9", Some(1e-9)), ("dop853:0.001", Some(1e-3))]
    {
        let found = method(name).unwrap();
        assert_eq!(found.tolerance(), tolerance, "{name}");
        let tightened = found.with_tolerance(1e-10);
        assert_eq!(tightened.is_ok(), tolerance.is_some(), "{name}");
        if let Ok(tightened) = tightened {
            let base = name.split(':').next().unwrap();
            assert_eq!(tightened.name(), method(&format!("{base}:1e-10")).unwrap().name());
        }
    }
    let names: Vec<String> = adaptive_methods().map(|method| method.name()).collect();
    assert_eq!(names, ["tsit5", "dop853", "taylor"]);
    let refused =
        |name: &str, tolerance| method(name).unwrap().with_tolerance(tolerance).unwrap_err().to_string();
    assert_eq!(refused("rattle", 1e-9), "method \"rattle\" does not choose its steps and takes no tolerance");
    assert!(refused("taylor", f64::NAN).starts_with("the tolerance NaN of taylor must be from 1.2e-16"));
}

/// Drag of 1 N m s stops a ball of 2 kg m² as exp(−t/2): long after its speed is no normal double its attitude is that of 100 s.
#[test]
fn a_body_that_drag_stops_comes_to_rest() {
    let body =
        |moments| Body::free(Inertia::from_moments(moments).unwrap()).with(Force::drag(1.0, 0.0).unwrap());
    let end = |body: &Body, method: &dyn AnyMethod, until: f64| {
        let start = body.state(Default::default(), [0.4, 1.0, -0.3].into()).unwrap();
        Run::new(method, body, &start, until).unwrap().watching(Watch::Never).advance_to(1).unwrap()
    };
    let (ball, asymmetric) = (body([2.0; 3]), body([1.0, 2.0, 3.0]));
    for method in adaptive_methods() {
        let name = method.name();
        let slow = end(&ball, &method, 500.0).momentum_norm / end(&ball, &method, 0.0625).momentum_norm;
        let expected = libm::exp(-(500.0 - 0.0625) / 2.0);
        let off = slow / expected - 1.0;
        assert!(off.abs() < 500.0 * method.tolerance().unwrap(), "{name}: {off:e}");
        let stopped = end(&asymmetric, &method, 100.0).state.rotation();
        for until in [500.0, 2500.0, 20_000.0] {
            let rest = end(&asymmetric, &method, until);
            let turned = rest.state.rotation().angle_to(&stopped);
            assert!(rest.momentum_norm < 1e-70 && turned < 1e-12, "{name}, {until} s: {turned:e}");
        }
        assert!(end(&asymmetric, &method, 20_000.0).momentum_norm < 1e-280, "{name}");
    }
}

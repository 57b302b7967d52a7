//! A run is the same to the last bit in any unit of time and of moments, as no step, no equation and no search compares with a
//! number that has a unit, and on any machine: `tests/data/golden/runs.txt`. `POLHODE_BLESS=1` writes that file again; read the
//! difference.

use nalgebra::Vector3;
use polhode::body::{Body, Force};
use polhode::events::Event;
use polhode::inertia::Inertia;
use polhode::method::{Claimed, catalogue, method};
use polhode::observe::Errors;
use polhode::rotation::{Quat, Vec3};
use polhode::run::Run;

use crate::fixtures::golden;

/// Even powers of two, whose roots are powers of two as well.
const UNITS: [[f64; 2]; 2] = [[1.0, 1.0], [1.0 / 4096.0, 1048576.0]];

/// With all kinds of forces.
fn bodies([time, moment]: [f64; 2]) -> Vec<Body> {
    let inertia = || Inertia::from_moments([1.0, 2.0, 2.5].map(|x| x * moment)).unwrap();
    let torque = moment / (time * time);
    let weight = Vector3::new(0.2, 0.1, 0.4) * torque;
    let push = Force::constant_torque_body(Vector3::new(0.1, -0.2, 0.1) * torque).unwrap();
    vec![
        Body::free(inertia()),
        Body::heavy(inertia(), weight).unwrap(),
        Body::free(inertia()).with(Force::gravity_gradient(0.3 / time, 0.25).unwrap()),
        Body::free(inertia()).with(push).with(Force::drag(0.05 * moment / time, 0.02 * moment).unwrap()),
        Body::heavy(inertia(), weight).unwrap().with(Force::drag(0.05 * moment / time, 0.0).unwrap()),
    ]
}

/// What a run of 24 steps shows, its largest errors and its events, in the units of the first.
fn shown(name: &str, body: &Body, [time, moment]: [f64; 2]) -> Option<String> {
    let method = method(name).unwrap();
    let _ = method.claims(body.problem())?;
    let omega = Vector3::new(0.4, 1.0, -0.3) / time;
    let start = body.state(Quat::cayley(Vec3([0.3, -0.5, 0.2])).into(), omega).unwrap();
    let step = 0.25 * time;
    let mut run = Run::new(&method, body, &start, step).ok()?;
    let sample = run.advance_to(24).unwrap();
    let momentum = sample.state.momentum().map(|m| m * time / moment);
    let Errors { energy, momentum_norm, momentum_vector, momentum_z, jacobi, .. } = sample.worst;
    let errors = [energy, momentum_norm, momentum_vector, momentum_z, jacobi];
    let energy = sample.energy * time * time / moment;
    let work = run.work();
    let mut run = Run::new(&method, body, &start, step).unwrap();
    let events = [Event::rate_above(body, 1.05 / time).unwrap(), Event::flip(body)];
    let found = run.events(&events, 7.3 * time, 0.1 * time).unwrap();
    let times: Vec<_> = found.found.iter().map(|one| (one.event, one.time.hi() / time)).collect();
    Some(format!(
        "{:?}\n{momentum:?}\n{energy:?}\n{errors:?}\n{work:?}\n{times:?}\n{}",
        sample.state.attitude, found.looks
    ))
}

#[test]
fn a_run_is_the_same_in_any_units_and_on_any_machine() {
    let others = [
        "dmv:8",
        "gauss:6",
        "two-turn@kahan-li-8",
        "kick-drift@srkn-11b",
        "lie-poisson@suzuki-4",
        "taylor:20",
        "no-squish",
    ];
    let names: Vec<String> = catalogue().iter().map(Claimed::name).chain(others.map(String::from)).collect();
    let bodies = UNITS.map(bodies);
    let (mut seen, mut every) = (0, String::new());
    for name in &names {
        for (plain, other) in bodies[0].iter().zip(&bodies[1]) {
            let (here, there) = (shown(name, plain, UNITS[0]), shown(name, other, UNITS[1]));
            assert_eq!(here, there, "{name}: {:?}", plain.problem());
            seen += usize::from(here.is_some());
            every += &here.map_or(String::new(), |here| format!("# {name}: {:?}\n{here}\n", plain.problem()));
        }
    }
    assert!(seen > 3 * names.len(), "{seen}");
    golden("runs.txt", &every);
}

//! The steps that programs run today, with the figures that the programs themselves give for one body: moments 1, 2, 3,
//! ω = (0.4, 1, −0.3), steps of 0.01 to the time 10⁴; and single steps as papers write them.

use polhode::body::{Body, State};
use polhode::flow::FreeMotion;
use polhode::inertia::Inertia;
use polhode::method::method;
use polhode::num::Dd;
use polhode::rotation::{Quat, Vec3, rotation_angle};
use polhode::run::Run;

const STEP: f64 = 0.01;
const STEPS: u64 = 1_000_000;

fn body() -> (Body, State) {
    let body = Body::free(Inertia::from_moments([1.0, 2.0, 3.0]).unwrap());
    let start = body.state(Default::default(), [0.4, 1.0, -0.3].into()).unwrap();
    (body, start)
}

/// The largest errors of the energy, of |m| and of L over the run, and that of the attitude at its end, rad.
struct Figures {
    energy: f64,
    norm: f64,
    vector: f64,
    attitude: f64,
}

fn figures(name: &str) -> Figures {
    let (body, start) = body();
    let mut run = Run::new(&method(name).unwrap(), &body, &start, STEP).unwrap();
    let end = run.advance_to(STEPS).unwrap();
    let motion = FreeMotion::from_point(body.inertia(), body.enter(&start).unwrap());
    let exact = motion.point_at_dd(Dd::from(STEP) * Dd::from(STEPS));
    Figures {
        energy: end.worst.energy.unwrap(),
        norm: end.worst.momentum_norm.unwrap(),
        vector: end.worst.momentum_vector.unwrap(),
        attitude: rotation_angle(end.point.to_dd().attitude, exact.attitude).hi(),
    }
}

/// What a program gives, of data/programs.csv: energy, momentum, attitude.
fn of_program(program: &str, scheme: &str) -> [f64; 3] {
    let start = format!("{program},");
    let lines = include_str!("data/programs.csv").lines();
    let line =
        lines.filter(|line| line.starts_with(&start)).find(|line| line.split(',').nth(2) == Some(scheme));
    let fields: Vec<&str> = line.unwrap().split(',').collect();
    [5, 6, 7].map(|column| fields[column].parse().unwrap())
}

/// To the two digits that were published.
fn assert_figure(what: &str, found: f64, published: f64) {
    assert!((found / published - 1.0).abs() < 0.05, "{what} {found:.3e}, the program's {published:e}");
}

#[test]
fn no_squish_has_the_figures_of_lammps() {
    let found = figures("no-squish");
    let [energy, vector, attitude] = of_program("LAMMPS", "NO_SQUISH");
    assert_figure("energy", found.energy, energy);
    assert_figure("attitude", found.attitude, attitude);
    assert!(found.vector < vector, "{:e}", found.vector);
}

/// After 10⁴ s nothing is left of the attitude.
#[test]
fn richardson_has_the_figures_of_lammps() {
    let found = figures("richardson");
    let [energy, norm, attitude] = of_program("LAMMPS", "Richardson");
    assert_figure("energy", found.energy, energy);
    assert_figure("attitude", found.attitude, attitude);
    assert!(found.norm < norm, "{:e}", found.norm);
}

/// Basilisk and programs written by hand have the same.
#[test]
fn rk4_has_the_figures_of_programs() {
    let found = figures("rk4");
    let [energy, norm, attitude] = of_program("written by hand", "RK4");
    assert_figure("energy", found.energy, energy);
    assert_figure("|m|", found.norm, norm);
    assert_figure("attitude", found.attitude, attitude);
}

/// The step of game engines ends at the energy |m|²/(2 I₂) of the separatrix, from above and from below, and keeps |m|.
#[test]
fn the_step_of_game_engines_drives_every_motion_to_the_separatrix() {
    let body = Body::free(Inertia::from_moments([1.0, 2.0, 3.0]).unwrap());
    for omega in [[1.5, 0.2, -0.1], [-0.1, 0.3, 1.2]] {
        let start = body.state(Default::default(), omega.into()).unwrap();
        let separatrix = start.momentum().norm_squared() / (2.0 * 2.0);
        let mut run = Run::new(&method("momentum-euler").unwrap(), &body, &start, 1.0 / 60.0).unwrap();
        let mut far = f64::INFINITY;
        for seconds in [0, 10, 100, 1000] {
            let end = run.advance_to(60 * seconds).unwrap();
            let off = (end.energy / separatrix - 1.0).abs();
            assert!(off < far, "{omega:?}, {seconds} s: {off:.1e}");
            assert!(end.worst.momentum_norm.unwrap() < 1e-12);
            far = off;
        }
        assert!(far < 0.05, "{omega:?}: {far:.1e}");
    }
}

/// The attitude that MuJoCo 4.0.0 ends with, a free joint with `diaginertia="1 2 3"` and the integrator RK4: a hundred times nearer to
/// the step here than to the exact motion.
#[test]
fn mujoco_rk4_has_the_figures_and_the_attitude_of_mujoco() {
    let found = figures("mujoco-rk4");
    let [energy, norm, attitude] = of_program("MuJoCo", "RK4");
    assert_figure("energy", found.energy, energy);
    assert_figure("|m|", found.norm, norm);
    assert_figure("attitude", found.attitude, attitude);
    let (body, start) = body();
    let mut run = Run::new(&method("mujoco-rk4").unwrap(), &body, &start, STEP).unwrap();
    let end = run.advance_to(STEPS).unwrap();
    let theirs = [-0.8849716710643742, -0.043816569689128865, -0.2766145103545297, 0.372007610534421];
    let apart = rotation_angle(end.state.attitude, Quat::from_components(theirs));
    assert!(apart < 0.01 * found.attitude, "{apart:.1e} of {:.1e}", found.attitude);
}

/// Attitude and momentum of the body after one step of 1/4 s, as the papers write it: tests/data/one_step/generate.py.
const ONE_STEP: [(&str, [f64; 4], [f64; 3]); 3] = [
    (
        "variational-cayley",
        [0.7474730618622483, 0.3415167450286486, -0.050717192320078514, 0.5675192517073591],
        [0.47561981862601593, 1.9338590847897497, -1.0019854431608812],
    ),
    (
        "buss-2",
        [0.7472204758536344, 0.34134762272370706, -0.04689303740397502, 0.568281975755849],
        [0.47979739287590806, 1.9300592155993959, -1.0073062523727956],
    ),
    (
        "buss-2-augmented",
        [0.7470609873907091, 0.34137359639976406, -0.04689792989826625, 0.5684756221432604],
        [0.4807884615885325, 1.929671234026641, -1.0075769865243211],
    ),
];

#[test]
fn steps_are_those_of_the_papers() {
    let (body, State { momentum_body, .. }) = body();
    let start = State { attitude: Quat::from_components([1.0, 0.5, -0.25, 0.75]), momentum_body };
    for (name, attitude, momentum) in ONE_STEP {
        let end = Run::new(&method(name).unwrap(), &body, &start, 0.25).unwrap().advance_to(1).unwrap().state;
        let apart = rotation_angle(end.attitude, Quat::from_components(attitude));
        let off = (end.momentum_body - Vec3(momentum)).magnitude();
        assert!(apart < 1e-15 && off < 2e-15, "{name}: {apart:.1e}, {off:.1e}");
    }
}

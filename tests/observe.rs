//! What a run reports of its errors, computed again: every step of short runs, in double-double, from the definitions.

use nalgebra::{UnitQuaternion, Vector3};
use polhode::body::{Body, Conserved, Force, Potential, State, Time};
use polhode::inertia::Inertia;
use polhode::method::method;
use polhode::num::{Dd, Real};
use polhode::observe::{Invariants, secular_drift};
use polhode::rotation::{Quat, Vec3};
use polhode::run::{Run, RunError, Watch};

const MOMENTS: [f64; 3] = [10.0, 20.0, 26.0];
const OMEGA: [f64; 3] = [0.4, 1.0, -0.3];
const STEPS: u64 = 200;

/// Attitude and momentum in double-double.
fn exact(x: &State) -> (Quat<Dd>, Vec3<Dd>) {
    let q: Quat<f64> = x.attitude;
    (Quat::from_components(q.components().map(Dd::of)), Vec3(x.momentum_body.0.map(Dd::of)))
}

/// ½ Σ m²/I.
fn kinetic(m: Vec3<Dd>) -> Dd {
    let term = |k: usize| m[k] * m[k] / Dd::of(MOMENTS[k]);
    (term(0) + term(1) + term(2)) * Dd::of(0.5)
}

/// q m q* without the library's rotation: from the matrix of q, not divided by |q|².
fn momentum_space(q: Quat<Dd>, m: Vec3<Dd>) -> Vec3<Dd> {
    let [w, x, y, z] = q.components();
    let two = Dd::of(2.0);
    Vec3([
        (w * w + x * x - y * y - z * z) * m[0] + two * (x * y - w * z) * m[1] + two * (x * z + w * y) * m[2],
        two * (x * y + w * z) * m[0] + (w * w - x * x + y * y - z * z) * m[1] + two * (y * z - w * x) * m[2],
        two * (x * z - w * y) * m[0] + two * (y * z + w * x) * m[1] + (w * w - x * x - y * y + z * z) * m[2],
    ])
}

fn start_of(body: &Body) -> State {
    let attitude = UnitQuaternion::from_euler_angles(0.3, -0.4, 0.5);
    body.state(attitude, OMEGA.into()).unwrap()
}

/// States at every step of a run, the start first, and the run's own largest errors.
fn steps(name: &str, body: &Body, h: f64) -> (Vec<(Dd, State)>, Run) {
    let mut run = Run::new(&method(name).unwrap(), body, &start_of(body), h).unwrap();
    let first = run.sample();
    let mut states = vec![(first.time, first.state)];
    for n in 1..=STEPS {
        let sample = run.advance_to(n).unwrap();
        states.push((sample.time, sample.state));
    }
    (states, run)
}

/// The largest |value − value at the start| / scale over the states.
fn largest(states: &[(Dd, State)], scale: Dd, of: impl Fn(Dd, &State) -> Vec<Dd>) -> f64 {
    let start = of(states[0].0, &states[0].1);
    let apart = |(t, x): &(Dd, State)| {
        let squares =
            of(*t, x).iter().zip(&start).map(|(a, b)| (*a - *b) * (*a - *b)).fold(Dd::ZERO, |a, b| a + b);
        (squares.sqrt() / scale).hi()
    };
    states.iter().map(apart).fold(0.0, f64::max)
}

fn assert_close(reported: Option<f64>, expected: f64, floor: f64, what: &str) {
    let reported = reported.unwrap_or_else(|| panic!("{what}: nothing reported"));
    assert!(
        (reported - expected).abs() <= 1e-8 * expected + floor,
        "{what}: reported {reported:e}, expected {expected:e}"
    );
}

#[test]
fn errors_of_free_motion_are_the_largest_over_every_step() {
    let body = Body::free(Inertia::from_moments(MOMENTS).unwrap());
    for (name, h) in [("rk4", 0.05), ("explicit-euler", 0.001), ("lie-poisson", 0.05), ("rattle", 0.05)] {
        let (states, run) = steps(name, &body, h);
        let (q, m) = exact(&states[0].1);
        let (energy, size) = (kinetic(m), m.norm());
        let worst = run.sample().worst;
        let expected = largest(&states, energy, |_, x| vec![kinetic(exact(x).1)]);
        assert_close(worst.of(Conserved::Energy), expected, 1e-30, name);
        let expected = largest(&states, size, |_, x| vec![exact(x).1.norm()]);
        // to first order: the sign of the change is not looked at
        assert_close(worst.of(Conserved::MomentumNorm), expected, 1e-30 + expected * expected, name);
        let spatial = |x: &State| momentum_space(exact(x).0, exact(x).1).0.to_vec();
        let expected = largest(&states, size, |_, x| spatial(x));
        assert_close(worst.of(Conserved::Momentum), expected, 1e-30, name);
        // where L is conserved so is its z component, and nothing is said of Jacobi's constant
        assert_eq!(worst.of(Conserved::MomentumZ), worst.of(Conserved::Momentum));
        assert_eq!(worst.of(Conserved::Jacobi { rate: 1.0 }), None);
        let signed = (kinetic(exact(&states[STEPS as usize].1).1) - energy) / energy;
        let change = run.sample().energy_change;
        assert!((change - signed.hi()).abs() <= 1e-8 * change.abs() + 1e-30, "{name}: {change:e}");
        assert!((momentum_space(q, m).norm() / size - Dd::ONE).hi().abs() < 1e-15);
    }
}

#[test]
fn a_momentum_that_has_grown_many_times_is_measured_as_such() {
    let body = Body::free(Inertia::from_moments(MOMENTS).unwrap());
    let mut run = Run::new(&method("explicit-euler").unwrap(), &body, &start_of(&body), 0.5).unwrap();
    let start = exact(&run.sample().state).1.norm();
    let (mut steps, mut grown) = (0, 0.0);
    while grown < 10.0 {
        steps += 1;
        grown = ((exact(&run.advance_to(steps).unwrap().state).1.norm() - start) / start).hi();
    }
    assert_close(run.sample().worst.of(Conserved::MomentumNorm), grown, 1e-12 * grown, "explicit-euler");
}

#[test]
fn errors_under_gravity_are_measured_by_kinetic_energy_and_weight_moment() {
    let weight = Vector3::new(0.3, 0.5, 2.0);
    let body = Body::heavy(Inertia::from_moments(MOMENTS).unwrap(), weight).unwrap();
    let height = |x: &State| momentum_space(exact(x).0, Vec3([0, 1, 2].map(|k| Dd::of(weight[k]))))[2];
    for (name, h) in [("rk4", 0.05), ("explicit-euler", 0.001), ("kick-drift", 0.05)] {
        let (states, run) = steps(name, &body, h);
        let (_, m) = exact(&states[0].1);
        // W = T₀ + |c|, and √(2 I W) for L_z
        let size = kinetic(m) + Dd::of(weight.norm());
        let worst = run.sample().worst;
        let expected = largest(&states, size, |_, x| vec![kinetic(exact(x).1) + height(x)]);
        assert_close(worst.of(Conserved::Energy), expected, 1e-18, name);
        let across = (Dd::of(2.0 * MOMENTS[2]) * size).sqrt();
        let expected = largest(&states, across, |_, x| vec![momentum_space(exact(x).0, exact(x).1)[2]]);
        assert_close(worst.of(Conserved::MomentumZ), expected, 1e-18, name);
        assert_eq!((worst.of(Conserved::MomentumNorm), worst.of(Conserved::Momentum)), (None, None));
        let now = &states[STEPS as usize].1;
        let signed = (kinetic(exact(now).1) + height(now) - kinetic(m) - height(&states[0].1)) / size;
        let change = run.sample().energy_change;
        assert!((change - signed.hi()).abs() <= 1e-8 * change.abs() + 1e-18, "{name}: {change:e}");
    }
}

#[test]
fn jacobis_constant_is_measured_by_the_forces_and_the_turning_orbit() {
    let inertia = Inertia::from_moments(MOMENTS).unwrap();
    let gradient = Force::gravity_gradient(0.5, 0.0).unwrap();
    let body = Body::free(inertia).with(gradient);
    let mut run = Run::new(&method("rk4").unwrap(), &body, &start_of(&body), 0.05).unwrap();
    // of points, whose attitude is as the method left it; a state is normalised when it enters
    let jacobi = |run: &Run| {
        let sample = run.sample();
        let (q, m) = exact(&sample.state);
        body.energy_of(Time::from_dd(sample.time), &sample.point) - Dd::of(0.5) * momentum_space(q, m)[2]
    };
    let (at, point) = (Time::from_seconds(0.0), run.sample().point.to_dd());
    let (_, m) = exact(&run.sample().state);
    let potential = body.energy_of(at, &point) - kinetic(m);
    let torque = body.torque_of(at, &point).norm() * body.scale();
    let size = kinetic(m) + Dd::of(potential.magnitude()) + torque + Dd::of(0.5) * m.norm();
    let (first, mut expected) = (jacobi(&run), 0.0_f64);
    for n in 1..=STEPS {
        run.advance_to(n).unwrap();
        expected = expected.max(((jacobi(&run) - first) / size).hi().abs());
    }
    let worst = run.sample().worst;
    assert!(expected > 1e-9, "{expected:e}");
    assert_close(worst.of(Conserved::Jacobi { rate: 0.5 }), expected, 1e-18, "rk4");
    assert_eq!((worst.of(Conserved::Energy), worst.of(Conserved::MomentumZ)), (None, None));
}

#[test]
fn a_watched_run_is_the_same_in_one_piece_and_in_many() {
    // blocks of every length, plain looks included
    let free = Body::free(Inertia::from_moments(MOMENTS).unwrap());
    let heavy = Body::heavy(Inertia::from_moments(MOMENTS).unwrap(), Vector3::new(0.0, 0.5, 2.0)).unwrap();
    for body in [free, heavy] {
        for name in ["rk4", "lie-poisson"] {
            let whole = Run::new(&method(name).unwrap(), &body, &start_of(&body), 0.02)
                .unwrap()
                .advance_to(5000)
                .unwrap();
            let mut run = Run::new(&method(name).unwrap(), &body, &start_of(&body), 0.02).unwrap();
            let mut largest = run.sample().errors.of(Conserved::Energy).unwrap();
            for n in 1..=5000 {
                largest = largest.max(run.advance_to(n).unwrap().errors.of(Conserved::Energy).unwrap());
            }
            assert_eq!(run.sample().worst, whole.worst, "{name}");
            assert_eq!(run.sample().flips, whole.flips, "{name}");
            let worst = whole.worst.of(Conserved::Energy).unwrap();
            assert!((worst - largest).abs() <= 1e-12 * worst, "{name}: {worst:e}, {largest:e}");
        }
    }
}

#[test]
fn flips_are_changes_of_sign_along_the_middle_axis() {
    // the middle moment on each axis in turn; a turn that starts about the unstable axis
    for order in [[0, 1, 2], [1, 2, 0], [2, 0, 1], [0, 2, 1]] {
        let moments = order.map(|k| MOMENTS[k]);
        let body = Body::free(Inertia::from_moments(moments).unwrap());
        let middle = order.iter().position(|&k| k == 1).unwrap();
        let mut omega = Vector3::repeat(1e-3);
        omega[middle] = 2.0;
        let start = body.state(UnitQuaternion::identity(), omega).unwrap();
        let mut run = Run::new(&method("rattle").unwrap(), &body, &start, 0.02).unwrap();
        assert_eq!(run.sample().flips, Some(0));
        let (mut signs, mut counted) = (vec![true], Vec::new());
        for n in 1..=5000 {
            let sample = run.advance_to(n).unwrap();
            signs.push(sample.state.momentum_body[middle] > 0.0);
            counted.push(sample.flips.unwrap());
        }
        let changes = signs.windows(2).filter(|pair| pair[0] != pair[1]).count() as u64;
        assert!(changes >= 4, "{changes}");
        assert_eq!(counted.last(), Some(&changes));
        assert!(counted.windows(2).all(|pair| pair[1] - pair[0] <= 1));
    }
}

#[test]
fn a_body_at_rest_has_no_error() {
    let body = Body::free(Inertia::from_moments(MOMENTS).unwrap());
    let rest = body.state(UnitQuaternion::identity(), Vector3::zeros()).unwrap();
    let end = Run::new(&method("rk4").unwrap(), &body, &rest, 0.1).unwrap().advance_to(100).unwrap();
    for quantity in [Conserved::Energy, Conserved::MomentumNorm, Conserved::Momentum, Conserved::MomentumZ] {
        assert_eq!((end.worst.of(quantity), end.errors.of(quantity)), (Some(0.0), Some(0.0)), "{quantity:?}");
    }
    assert_eq!((end.energy_change, end.flips), (0.0, Some(0)));
}

#[test]
fn looking_at_samples_only_sees_what_the_samples_show() {
    let body = Body::free(Inertia::from_moments(MOMENTS).unwrap());
    let mut run = Run::new(&method("lie-poisson").unwrap(), &body, &start_of(&body), 0.05)
        .unwrap()
        .watching(Watch::AtSamples);
    let mut worst = 0.0_f64;
    for n in 1..=20 {
        worst = worst.max(run.advance_to(37 * n).unwrap().errors.of(Conserved::Energy).unwrap());
    }
    let sample = run.sample();
    assert!((sample.worst.of(Conserved::Energy).unwrap() - worst).abs() <= 1e-12 * worst);
    assert_eq!(sample.flips, None);
}

/// Trend, slope, half width of its 95 % interval, and whether that excludes 0: 30 digits, tests/data/observe/regression.py.
const SLOPES: [(f64, f64, f64, bool); 3] = [
    (0.0, 0.006_470_588_235_294_118, 0.068_007_420_161_905_78, false),
    (0.1, 0.106_470_588_235_294_12, 0.068_007_420_161_905_78, true),
    (-0.2, -0.193_529_411_764_705_88, 0.068_007_420_161_905_78, true),
];

#[test]
fn a_slope_and_its_interval_are_those_of_a_regression() {
    // 16 points: each is its own block
    let times: Vec<f64> = (0..16).map(f64::from).collect();
    let noise = [0.3, -0.1, 0.4, 0.1, -0.5, 0.9, -0.2, 0.6, -0.5, 0.3, 0.5, -0.8, 0.9, -0.7, 0.9, 0.3];
    for (trend, slope, half_width, secular) in SLOPES {
        let values: Vec<f64> = times.iter().zip(noise).map(|(t, n)| trend * t + n).collect();
        let drift = secular_drift(&times, &values).unwrap();
        assert!((drift.slope - slope).abs() < 1e-14, "{drift:?}");
        assert!((drift.half_width - half_width).abs() < 1e-14, "{drift:?}");
        assert_eq!(drift.is_secular(), secular, "{drift:?}");
    }
    assert_eq!(secular_drift(&times[..15], &noise[..15]), None);
    // longer series are averaged over 16 blocks, also where 16 does not divide their length
    let times: Vec<f64> = (0..1007).map(|k| 0.1 * f64::from(k)).collect();
    let values: Vec<f64> = times.iter().map(|t| 2e-3 * t).collect();
    let drift = secular_drift(&times, &values).unwrap();
    assert!(
        (drift.slope - 2e-3).abs() < 1e-16 && drift.half_width < 1e-16 && drift.is_secular(),
        "{drift:?}"
    );
}

#[test]
fn a_resumed_run_remembers_its_largest_errors_and_flips() {
    let body = Body::free(Inertia::from_moments(MOMENTS).unwrap());
    let splitting = method("lie-poisson").unwrap();
    let mut run = Run::new(&splitting, &body, &start_of(&body), 0.05).unwrap();
    // past the largest error and after a flip
    let before = run.advance_to(2000).unwrap();
    let now = before.errors.of(Conserved::Energy).unwrap();
    assert!(before.flips > Some(0) && before.worst.of(Conserved::Energy).unwrap() > 1.1 * now);
    let checkpoint = run.checkpoint().to_string().parse().unwrap();
    let resumed = Run::resume(&splitting, &body, &checkpoint).unwrap().sample();
    assert_eq!((resumed.worst, resumed.flips), (before.worst, before.flips));
}

/// A potential that is the same everywhere, which leaves a free motion.
struct Level;

impl<S: Real> Potential<S> for Level {
    fn energy(&self, _: Time, _: Quat<S>) -> S {
        S::of(3.0)
    }
    fn torque(&self, _: Time, _: Quat<S>) -> Vec3<S> {
        Vec3::zero()
    }
    fn conserved(&self) -> Vec<Conserved> {
        vec![Conserved::Energy, Conserved::MomentumNorm, Conserved::Momentum]
    }
}

#[test]
fn errors_in_a_level_potential_are_those_of_free_motion() {
    let free = Body::free(Inertia::from_moments(MOMENTS).unwrap());
    let level = free.clone().with(Force::potential("level", Level));
    let worst = |body: &Body| {
        // of which both motions are the same bits; rk4 takes free steps by other operations
        let mut run = Run::new(&method("mujoco-rk4").unwrap(), body, &start_of(body), 0.05).unwrap();
        run.advance_to(STEPS).unwrap().worst
    };
    let (free_worst, worst) = (worst(&free), worst(&level));
    for quantity in [Conserved::MomentumNorm, Conserved::Momentum] {
        assert_close(worst.of(quantity), free_worst.of(quantity).unwrap(), 1e-18, "level");
    }
    // relative to W = T₀ + |U₀|
    let kinetic = kinetic(exact(&start_of(&free)).1).hi();
    let expected = free_worst.of(Conserved::Energy).unwrap() * kinetic / (kinetic + 3.0);
    assert_close(worst.of(Conserved::Energy), expected, 1e-18, "level");
}

#[test]
fn a_run_ends_at_the_last_point_whose_errors_are_numbers() {
    let inertia = Inertia::from_moments(MOMENTS).unwrap();
    let bodies = [
        Body::free(inertia.clone()),
        Body::heavy(inertia.clone(), Vector3::new(0.0, 0.0, 2.0)).unwrap(),
        Body::free(inertia).with(Force::potential("level", Level)),
    ];
    for body in bodies {
        // Euler's method squares the momentum in each step: there is a point that is finite and whose energy is not
        let mut run = Run::new(&method("explicit-euler").unwrap(), &body, &start_of(&body), 100.0).unwrap();
        let error = run.advance_to(100).unwrap_err();
        let RunError::Diverged { last } = error else { panic!("{error}") };
        assert!(last.energy.is_finite() && last.momentum_norm > 1e30, "{last:?}");
        let invariants = Invariants::of(&body, Time::from_dd(last.time), &last.point);
        assert_eq!(invariants.momentum_norm().hi() * body.scale(), last.momentum_norm);
        assert!(invariants.momentum_norm() == last.point.to_dd().momentum_body.norm());
    }
}

/// Errors are relative: those of a body that turns 2^-100 times as fast, in steps 2^100 times as long, are the same bits.
#[test]
fn the_errors_of_a_slow_body_are_those_of_a_fast_one() {
    let body = Body::free(Inertia::from_moments(MOMENTS).unwrap());
    let worst = |name: &str, power: i32| {
        let start =
            body.state(UnitQuaternion::identity(), OMEGA.map(|w| libm::scalbn(w, -power)).into()).unwrap();
        let step = libm::scalbn(0.125, power);
        Run::new(&method(name).unwrap(), &body, &start, step).unwrap().advance_to(STEPS).unwrap().worst
    };
    for name in ["lie-poisson", "rattle", "rk4"] {
        let fast = worst(name, 0);
        assert!(
            fast.energy.is_some_and(|error| error > 0.0)
                && fast.momentum_norm.is_some_and(|error| error > 0.0)
        );
        for power in [17, 60, 100] {
            assert_eq!(worst(name, power), fast, "{name}: 2^-{power}");
        }
    }
}

#[test]
fn a_run_taken_up_after_steps_that_nobody_watched_counts_no_flips() {
    let body = Body::free(Inertia::from_moments(MOMENTS).unwrap());
    let start = body.state(UnitQuaternion::identity(), OMEGA.into()).unwrap();
    let rattle = method("rattle").unwrap();
    for (watch, counts) in [(Watch::EveryStep, true), (Watch::Never, false)] {
        let mut run = Run::new(&rattle, &body, &start, 0.125).unwrap().watching(watch);
        run.advance_to(STEPS).unwrap();
        let checkpoint = run.checkpoint().to_string().parse().unwrap();
        let mut resumed = Run::resume(&rattle, &body, &checkpoint).unwrap().watching(Watch::EveryStep);
        assert_eq!(resumed.advance_to(2 * STEPS).unwrap().flips.is_some(), counts, "{watch}");
    }
}

//! Forces against closed forms, against fixtures of 30 digits (tests/data/forces, mpmath) and against what they conserve.

use nalgebra::{Rotation3, UnitQuaternion, Vector3};
use polhode::body::{
    Body, Clock, Conserved, Force, ForceError, Orbit, Point, Potential, Problem, State, Time,
};
use polhode::inertia::Inertia;
use polhode::method::{AnyMethod, method};
use polhode::num::{Dd, Real};
use polhode::observe::secular_drift;
use polhode::rotation::{Quat, Vec3, rotation_angle};
use polhode::run::{Run, RunError, Schedule, Watch};

fn inertia(moments: [f64; 3]) -> Inertia {
    Inertia::from_moments(moments).unwrap()
}

fn run(name: &str, body: &Body, omega: [f64; 3], h: f64) -> Run {
    let start = body.state(UnitQuaternion::identity(), omega.into()).unwrap();
    Run::new(&method(name).unwrap(), body, &start, h).unwrap()
}

/// A satellite, tilted, on an orbit with the eccentricity `e`.
fn satellite(e: f64) -> Body {
    Body::free(inertia([10.0, 25.0, 30.0])).with(Force::gravity_gradient(0.001, e).unwrap())
}

const TUMBLING: [f64; 3] = [2e-4, -3e-4, 1.2e-3];

#[test]
fn jacobis_constant_is_bounded_without_secular_slope_on_a_circular_orbit() {
    let body = satellite(0.0);
    assert_eq!(body.conserved(), [Conserved::Jacobi { rate: 0.001 }]);
    for (name, most) in [("lie-poisson", 1e-3), ("rattle", 1e-3), ("kick-drift@srkn-6b", 1e-7)] {
        // 63 steps an orbit: 300 000 steps are 4 800 orbits
        let mut run = run(name, &body, TUMBLING, 100.0).watching(Watch::AtSamples);
        let (mut times, mut errors) = (Vec::new(), Vec::new());
        let jacobi = |run: &Run| {
            let sample = run.sample();
            let l = sample.state.momentum_space();
            body.energy_at(sample.time.hi(), &sample.state) - 0.001 * l.z
        };
        let (start, mut early) = (jacobi(&run), 0.0);
        for steps in (1..=1000).map(|k| 300 * k) {
            let sample = run.advance_to(steps).unwrap();
            assert_eq!((sample.worst.energy, sample.worst.momentum_z), (None, None));
            times.push(sample.elapsed.hi());
            errors.push(jacobi(&run) / start - 1.0);
            if steps == 30_000 {
                early = sample.worst.jacobi.unwrap();
            }
        }
        let (drift, worst) = (secular_drift(&times, &errors).unwrap(), run.sample().worst.jacobi.unwrap());
        println!("{name}: {worst:.1e}, {drift:?}");
        assert!(worst < most && worst > 1e-16, "{name}: {worst:.1e}");
        assert!(worst < 1.5 * early, "{name}: {worst:.1e}, in the first tenth {early:.1e}");
        assert!(drift.slope.abs() < 2.0 * drift.half_width, "{name}: {drift:?}");
    }
    // a method that keeps nothing loses it
    let mut run = run("rk4", &body, TUMBLING, 100.0);
    let early = run.advance_to(30_000).unwrap().worst.jacobi.unwrap();
    let late = run.advance_to(300_000).unwrap().worst.jacobi.unwrap();
    assert!(late > 1e-5 && late > 5.0 * early, "{late:e}, in the first tenth {early:e}");
}

#[test]
fn on_an_elliptic_orbit_doubles_and_double_double_are_the_same_map() {
    let body = satellite(0.3);
    assert_eq!(body.conserved(), []);
    for name in ["lie-poisson:321@kahan-li-6", "kick-drift@srkn-11b", "rattle", "rk4", "implicit-midpoint"] {
        let method = method(name).unwrap();
        let clock = Clock { start: 12_345.678, step: 99.9 };
        let state = body.state(UnitQuaternion::identity(), TUMBLING.into()).unwrap();
        let mut quick = body.enter(&state).unwrap().to_f64();
        let mut precise = quick.to_dd();
        let mut quick_step = method.prepare_f64(clock, &body).unwrap();
        let mut precise_step = method.prepare_dd(clock, &body).unwrap();
        // rounding alone, which the tumbling stretches
        for (steps, most) in [(20, 1e-13), (180, 2e-11)] {
            quick_step.steps(&mut quick, steps);
            precise_step.steps(&mut precise, steps);
            let apart = rotation_angle(quick.to_dd().attitude, precise.attitude).hi();
            assert!(apart < most, "{name}: {apart:.1e} after {steps} steps more");
        }
    }
}

/// The yaw axis along r, the roll axis along the velocity, the pitch axis along the normal: small pitch swings as
/// n √(3 (I_roll − I_yaw)/I_pitch) (Hughes, Spacecraft Attitude Dynamics, §9.1).
#[test]
fn small_pitch_librates_with_the_frequency_of_the_linear_theory() {
    let (n, [yaw, roll, pitch]) = (0.001, [10.0, 25.0, 30.0]);
    let expected = n * (3.0 * (roll - yaw) / pitch).sqrt();
    let body = satellite(0.0);
    for amplitude in [1e-2, 1e-3, 1e-4] {
        let (sin, cos) = libm::sincos(0.5 * amplitude);
        let start = State {
            attitude: Quat::from_components([cos, 0.0, 0.0, sin]),
            momentum_body: Vec3([0.0, 0.0, pitch * n]),
        };
        let mut run = Run::new(&method("kick-drift@srkn-11b").unwrap(), &body, &start, 20.0).unwrap();
        // the angle from r, about z, at the zeros of which half a period has gone by
        let angle = |x: &Point<f64>, t: f64| {
            let (sin, cos) = libm::sincos(n * t);
            let r = x.attitude.rotate_back(Vec3([cos, sin, 0.0]));
            -libm::atan2(r[1], r[0])
        };
        let (mut zeros, mut before) = (Vec::new(), None::<(f64, f64)>);
        for sample in run.samples(Schedule::every(1, 20_000)) {
            let sample = sample.unwrap();
            let t = sample.time.hi();
            let now = (t, angle(&sample.point, t));
            if let Some(before) = before.filter(|before| before.1 * now.1 < 0.0) {
                zeros.push(before.0 - before.1 * (now.0 - before.0) / (now.1 - before.1));
            }
            before = Some(now);
        }
        let half_periods = (zeros.len() - 1) as f64;
        let found = core::f64::consts::PI * half_periods / (zeros[zeros.len() - 1] - zeros[0]);
        let off = found / expected - 1.0;
        // a pendulum of 2θ is slower by (2θ)²/16
        let slower = -(2.0 * amplitude) * (2.0 * amplitude) / 16.0;
        println!("amplitude {amplitude:.0e} rad: {off:.3e} off, {slower:.3e} expected");
        assert!((off - slower).abs() < 2e-8 + 0.02 * slower.abs(), "{amplitude}: {off:e}");
    }
}

#[test]
fn drag_slows_a_ball_as_its_closed_form_says() {
    let (moment, omega) = (2.0, Vec3([0.3, -0.6, 0.6]));
    let speed = omega.norm();
    for (c1, c2) in [(0.1, 0.0), (0.0, 0.2), (0.1, 0.2)] {
        let body = Body::free(inertia([moment; 3])).with(Force::drag(c1, c2).unwrap());
        assert_eq!((body.problem(), body.conserved()), (Problem::Torque, vec![]));
        let mut run = run("rk4", &body, omega.0, 0.01);
        for steps in [100, 1000, 10_000] {
            let sample = run.advance_to(steps).unwrap();
            let t = sample.elapsed.hi();
            // I ω' = −c₁ ω − c₂ ω²
            let exact = if c1 == 0.0 {
                speed / (1.0 + c2 * speed * t / moment)
            } else {
                let fallen = libm::exp(-c1 * t / moment);
                speed * fallen / (1.0 + c2 * speed / c1 * (1.0 - fallen))
            };
            let off = sample.momentum_norm / (moment * exact) - 1.0;
            assert!(off.abs() < 1e-12, "c1 = {c1}, c2 = {c2}, t = {t}: {off:.1e}");
            let direction = sample.omega_body.normalize() - Vector3::from(omega) / speed;
            assert!(direction.norm() < 1e-14, "{direction:?}");
            assert_eq!(sample.worst.energy, None);
        }
    }
}

#[test]
fn constant_torques_add_up_in_their_axes() {
    let torque = Vector3::new(0.1, -0.2, 0.05);
    // in space: L = L₀ + τ t, whatever the body
    let asymmetric = Body::free(inertia([1.0, 2.0, 2.5])).with(Force::constant_torque_space(torque).unwrap());
    let mut moving = run("rk4-normalized", &asymmetric, [0.3, 1.0, -0.4], 0.005);
    let start = moving.sample().state.momentum_space();
    let end = moving.advance_to(2000).unwrap();
    let off = (end.state.momentum_space() - start - torque * 10.0).norm();
    assert!(off < 1e-8 && off > 1e-16, "{off:.1e}");
    // in the body: I ω = τ t of a ball at rest
    let ball = Body::free(inertia([2.0; 3])).with(Force::constant_torque_body(torque).unwrap());
    let end = run("implicit-midpoint", &ball, [0.0; 3], 0.01).advance_to(1000).unwrap();
    assert!((end.state.momentum() - torque * 10.0).norm() < 1e-13);
}

/// One line of tests/data/forces/reference.csv.
struct Fixture {
    name: String,
    body: Body,
    start: Point<Dd>,
    begin: f64,
    end: f64,
    exact: Point<Dd>,
}

fn fixtures() -> Vec<Fixture> {
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/data/forces/reference.csv");
    let text = std::fs::read_to_string(path).unwrap();
    let rows = text.lines().filter(|line| !line.starts_with('#')).skip(1);
    rows.map(|line| {
        let fields: Vec<&str> = line.split(',').collect();
        assert_eq!(fields.len(), 23, "{line}");
        let double = |k: usize| fields[k].parse::<f64>().unwrap();
        let digits = |k: usize| fields[k].parse::<Dd>().unwrap();
        let inertia = inertia([1, 2, 3].map(double));
        let parameters = [11, 12, 13].map(double);
        let force = match fields[0] {
            "gradient" => Force::gravity_gradient(parameters[0], parameters[1]),
            "conic" => {
                let [gm, periapsis, eccentricity] = parameters;
                let orbit = Orbit::conic(gm, periapsis, eccentricity).unwrap();
                let orbit = orbit.passing_at(3.0).unwrap().in_plane([0.4, 0.9, -1.3]).unwrap();
                Ok(Force::gravity_gradient_on(orbit))
            }
            "body" => Force::constant_torque_body(parameters.into()),
            "space" => Force::constant_torque_space(parameters.into()),
            "drag" => Force::drag(parameters[0], parameters[1]),
            other => panic!("{other}"),
        };
        let body = Body::free(inertia).with(force.unwrap());
        let state = State {
            attitude: Quat::from_components([4, 5, 6, 7].map(double)),
            momentum_body: Vec3([8, 9, 10].map(double)),
        };
        let exact = Vec3([20, 21, 22].map(digits)) * (Dd::ONE / Dd::from(body.scale()));
        Fixture {
            name: format!("{} {parameters:?}", fields[0]),
            start: body.enter(&state).unwrap(),
            begin: double(14),
            end: double(15),
            exact: Point::new(Quat::from_components([16, 17, 18, 19].map(digits)), exact),
            body,
        }
    })
    .collect()
}

/// The end of the fixture by `steps` steps of `method` in double-double: angle, and momentum over |m|.
fn errors(fixture: &Fixture, method: &dyn AnyMethod, steps: u64) -> f64 {
    let clock = Clock { start: fixture.begin, step: (fixture.end - fixture.begin) / steps as f64 };
    let mut x = fixture.start;
    method.prepare_dd(clock, &fixture.body).unwrap().steps(&mut x, steps);
    let angle = rotation_angle(x.attitude, fixture.exact.attitude);
    let momentum =
        (x.momentum_body - fixture.exact.momentum_body).norm() / fixture.exact.momentum_body.norm();
    (angle + momentum).hi()
}

/// Also that every evaluation takes the right time: in a substep of a composition the wrong one costs all orders.
#[test]
fn motions_under_forces_are_those_of_the_fixtures() {
    let fixtures = fixtures();
    assert_eq!(fixtures.len(), 9);
    for fixture in &fixtures {
        let methods: &[(&str, u64, f64)] = match fixture.body.problem() {
            Problem::Potential => &[
                ("kick-drift@sofroniou-spaletta-10", 2048, 1e-19),
                ("lie-poisson@kahan-li-8", 1024, 1e-13),
                ("taylor", 8, 1e-25),
                ("implicit-midpoint@kahan-li-6", 1024, 1e-10),
            ],
            _ => &[("implicit-midpoint@kahan-li-8", 1024, 1e-15), ("rk4", 4096, 1e-9)],
        };
        for (name, steps, most) in methods {
            let error = errors(fixture, &method(name).unwrap(), *steps);
            println!("{}: {name} {error:.1e}", fixture.name);
            assert!(error < *most, "{}: {name} {error:.1e}", fixture.name);
        }
    }
}

/// The asymmetric heavy body at about 80 free flows per unit time, over 64 units.
#[test]
fn nystrom_schemes_are_far_more_accurate_than_suzukis_at_equal_cost() {
    let body = Body::heavy(inertia([0.625, 0.75, 1.0]), [0.1, -0.2, 0.4].into()).unwrap();
    let start = body.enter_omega(Quat::identity(), Vec3([0.3, 1.0, -0.4])).unwrap().to_f64();
    let span = 64;
    let reference = |per_unit: u64| {
        let mut x = start.to_dd();
        let clock = Clock::new(1.0 / per_unit as f64);
        method("kick-drift@sofroniou-spaletta-10")
            .unwrap()
            .prepare_dd(clock, &body)
            .unwrap()
            .steps(&mut x, span * per_unit);
        x.attitude
    };
    let exact = reference(16);
    assert!(rotation_angle(reference(8), exact).hi() < 1e-15);
    let error = |name: &str, per_unit: u64| {
        let mut x = start;
        let clock = Clock::new(1.0 / per_unit as f64);
        method(name).unwrap().prepare_f64(clock, &body).unwrap().steps(&mut x, span * per_unit);
        rotation_angle(x.to_dd().attitude, exact).hi()
    };
    let suzuki = error("kick-drift@suzuki-4", 16); // 80 free flows per unit
    let fourth = error("kick-drift@srkn-6b", 13); // 78
    let sixth = error("kick-drift@srkn-11b", 7); // 77
    println!(
        "suzuki-4 {suzuki:.2e}, srkn-6b {fourth:.2e} ({:.0} times), srkn-11b {sixth:.2e} ({:.0} times)",
        suzuki / fourth,
        suzuki / sixth
    );
    assert!(suzuki > 20.0 * fourth && suzuki > 20.0 * sixth, "{suzuki:e}, {fourth:e}, {sixth:e}");
}

#[test]
fn what_is_conserved_together_is_what_each_conserves() {
    let moments = inertia([1.0, 2.0, 2.5]);
    let gradient = |n| Force::gravity_gradient(n, 0.0).unwrap();
    let heavy = Body::heavy(moments.clone(), [0.1, 0.0, 0.2].into()).unwrap();
    let jacobi = |rate| Conserved::Jacobi { rate };
    let free = Body::free(moments.clone());
    assert!(free.conserved().contains(&Conserved::Momentum));
    assert_eq!(heavy.conserved(), [Conserved::Energy, Conserved::MomentumZ]);
    assert_eq!(free.clone().with(gradient(0.5)).conserved(), [jacobi(0.5)]);
    // gravity along z turns with the orbit: Jacobi's constant is left
    assert_eq!(heavy.with(gradient(0.5)).conserved(), [jacobi(0.5)]);
    assert_eq!(free.clone().with(gradient(0.5)).with(gradient(0.25)).conserved(), []);
    assert_eq!(free.clone().with(gradient(0.5)).with(Force::drag(0.1, 0.0).unwrap()).conserved(), []);
    // a magnet along space x keeps the energy alone: Jacobi's constant needs L_z too
    let magnet = Force::potential_fn(
        "magnet",
        |q| -(q * Vector3::z()).x,
        |q| Vector3::z().cross(&(q.inverse() * Vector3::x())),
    );
    assert_eq!(free.clone().with(magnet.clone()).conserved(), [Conserved::Energy]);
    assert_eq!(free.with(gradient(0.5)).with(magnet).conserved(), []);
}

#[test]
fn the_gravity_gradient_is_that_of_the_body_on_which_it_acts() {
    let gradient = Force::gravity_gradient(0.001, 0.0).unwrap();
    let point = Point::new(Quat::new(0.8, Vec3([0.1, -0.5, 0.3])).map(Dd::of).normalized(), Vec3::zero());
    let torque = |moments: [f64; 3], force: &Force| {
        let body = Body::free(inertia(moments)).with(force.clone());
        body.torque_of(Time::from_seconds(100.0), &point) * Dd::of(body.scale())
    };
    let small = Body::free(inertia([1.0, 2.0, 2.5])).with(gradient.clone());
    // taken from another body, it is that of the new one all the same
    let moved = torque([100.0, 150.0, 170.0], &small.forces()[0]);
    let own = torque([100.0, 150.0, 170.0], &gradient);
    assert_eq!(moved, own);
    assert!((own - torque([1.0, 2.0, 2.5], &gradient) * Dd::of(50.0)).magnitude() > 1e-6);
}

/// A weight that a user writes: a potential linear in the vertical.
struct OwnWeight(Vec3<f64>);

impl<S: Real> Potential<S> for OwnWeight {
    fn energy(&self, _: Time, attitude: Quat<S>) -> S {
        attitude.rotate_back(Vec3::unit(2)).dot(Vec3::of(self.0))
    }
    fn torque(&self, _: Time, attitude: Quat<S>) -> Vec3<S> {
        attitude.rotate_back(Vec3::unit(2)).cross(Vec3::of(self.0))
    }
    fn linear_moment(&self) -> Option<Vec3<f64>> {
        Some(self.0)
    }
}

#[test]
fn a_linear_potential_of_a_user_is_served_as_gravity_is() {
    let weight = [0.1, -0.2, 0.4];
    let heavy = Body::heavy(inertia([1.0, 2.0, 2.5]), weight.into()).unwrap();
    let own =
        Body::free(inertia([1.0, 2.0, 2.5])).with(Force::potential("own weight", OwnWeight(Vec3(weight))));
    assert_eq!((own.problem(), own.conserved()), (Problem::Linear, heavy.conserved()));
    assert_eq!(own.forces().iter().map(Force::name).collect::<Vec<_>>(), ["own weight"]);
    for method in ["implicit-midpoint", "gauss:4", "taylor:12", "kick-drift@chin-4a", "lie-poisson"] {
        let end = |body: &Body| run(method, body, [0.4, 1.0, -0.3], 0.125).advance_to(100).unwrap().point;
        assert_eq!(end(&own), end(&heavy), "{method}");
    }
}

#[test]
fn weight_is_a_force_like_any_other() {
    let weight = Vector3::new(0.1, -0.2, 0.4);
    let free = || Body::free(inertia([1.0, 2.0, 2.5]));
    let heavy = Body::heavy(inertia([1.0, 2.0, 2.5]), weight).unwrap();
    let with = free().with(Force::gravity(weight).unwrap());
    assert_eq!((with.problem(), with.conserved()), (Problem::Linear, heavy.conserved()));
    let end = |body: &Body| run("implicit-midpoint", body, [0.4, 1.0, -0.3], 0.125).advance_to(100).unwrap();
    assert_eq!(end(&with).point, end(&heavy).point);
    // two weights are one, and opposite ones none
    let half = || Force::gravity(weight * 0.5).unwrap();
    assert_eq!(end(&free().with(half()).with(half())).point, end(&heavy).point);
    let none = free().with(Force::gravity(weight).unwrap()).with(Force::gravity(-weight).unwrap());
    assert_eq!(none.problem(), Problem::Free);
    assert_eq!(free().with(Force::gravity(Vector3::zeros()).unwrap()).problem(), Problem::Free);
    // beside drag it acts as it does beside the drag of a heavy body
    let drag = || Force::drag(0.01, 0.0).unwrap();
    assert_eq!(end(&with.with(drag())).point, end(&heavy.with(drag())).point);
    // out of range of the solver frame it acts as any potential does
    let faint = free().with(Force::gravity(Vector3::z() * 1e-250).unwrap());
    assert_eq!(faint.problem(), Problem::Potential);
    assert_eq!(faint.conserved(), [Conserved::Energy, Conserved::MomentumZ]);
}

#[test]
fn the_error_of_jacobis_constant_is_that_of_its_own_rate() {
    let body = satellite(0.0);
    let worst = run("kick-drift", &body, TUMBLING, 100.0).advance_to(10).unwrap().worst;
    assert_eq!(worst.of(Conserved::Jacobi { rate: 0.001 }), worst.jacobi);
    assert!(worst.jacobi.is_some());
    assert_eq!(worst.of(Conserved::Jacobi { rate: 123.0 }), None);
    let resumed = run("kick-drift", &body, TUMBLING, 100.0);
    let checkpoint = resumed.checkpoint().to_string().parse().unwrap();
    let resumed = Run::resume(&method("kick-drift").unwrap(), &body, &checkpoint).unwrap();
    assert!(resumed.sample().worst.of(Conserved::Jacobi { rate: 0.001 }).is_some());
}

#[test]
fn a_potential_by_closures_is_sampled_and_its_energy_watched() {
    let (strength, axis) = (0.2, Vector3::z());
    let make = |wrong: f64| {
        Force::potential_fn(
            "magnet",
            move |q| -strength * (q * axis).x,
            move |q| wrong * strength * axis.cross(&(q.inverse() * Vector3::x())),
        )
    };
    // a typed tensor off its principal axes, and a scale that is not 1: the closures see body axes and newton metres
    let tensor = nalgebra::Matrix3::new(20.0, 1.0, -2.0, 1.0, 30.0, 3.0, -2.0, 3.0, 40.0);
    let body = |wrong| Body::free(Inertia::from_tensor(tensor).unwrap()).with(make(wrong));
    let right = body(1.0);
    let worst = |body: &Body| {
        run("kick-drift@srkn-6b", body, [0.1, 0.05, 0.02], 0.5).advance_to(20_000).unwrap().worst
    };
    assert_eq!(right.conserved(), [Conserved::Energy]);
    let energy = worst(&right).of(Conserved::Energy).unwrap();
    assert!(energy < 1e-7 && energy > 1e-17, "{energy:e}");
    // and a torque that does not belong to the energy is seen
    assert!(worst(&body(-1.0)).energy.unwrap() > 0.1);
    // the same by an implementation in every scalar
    struct Magnet;
    impl<S: Real> Potential<S> for Magnet {
        fn energy(&self, _: Time, attitude: Quat<S>) -> S {
            -(attitude.rotate(Vec3::unit(2))[0] * S::of(0.2))
        }
        fn torque(&self, _: Time, attitude: Quat<S>) -> Vec3<S> {
            Vec3::unit(2).cross(attitude.rotate_back(Vec3::unit(0))) * S::of(0.2)
        }
    }
    let same = Body::free(Inertia::from_tensor(tensor).unwrap()).with(Force::potential("magnet", Magnet));
    let end =
        |body: &Body| run("rattle", body, [0.1, 0.05, 0.02], 0.5).advance_to(500).unwrap().state.rotation();
    assert!(end(&right).angle_to(&end(&same)) < 1e-11);
}

#[test]
fn a_force_that_is_not_finite_ends_the_run_with_its_name_and_time() {
    let body =
        |late: f64| {
            Body::free(inertia([10.0, 20.0, 30.0])).with(Force::drag(0.1, 0.0).unwrap()).with(
                Force::torque_fn("thruster", move |t, _, _| Vector3::x() / if t < late { 1.0 } else { 0.0 }),
            )
        };
    for watch in [Watch::EveryStep, Watch::AtSamples, Watch::Never] {
        let mut run = run("rk4", &body(0.96), [0.4, 1.0, -0.3], 0.125).watching(watch);
        // the fourth stage of the step from 0.875 on is at 1 s
        match run.advance_to(100).unwrap_err() {
            RunError::Force { force, time, last } => {
                assert_eq!((force.as_str(), time, last.steps), ("thruster", 1.0, 7));
                assert!(last.state.is_finite());
            }
            other => panic!("{other}"),
        }
    }
    let error = run("implicit-midpoint", &body(-1.0), [0.4, 1.0, -0.3], 0.125).advance_to(1).unwrap_err();
    assert_eq!(
        error.to_string(),
        "thruster is not finite at t = 0.0625 s, after 0 steps; the state at t = 0 s before it is finite: \
         q = [1.0, 0.0, 0.0, 0.0], omega_body = [0.4, 1.0, -0.3] rad/s"
    );
}

#[test]
fn a_run_that_diverges_is_not_blamed_on_its_force() {
    // steps of several radians: what overflows is the state, and the forces with it
    let inertia = inertia([10.0, 20.0, 30.0]);
    let gradient = Force::gravity_gradient(0.5, 0.0).unwrap();
    for force in [gradient, Force::drag(0.1, 2.0).unwrap()] {
        let body = Body::free(inertia.clone()).with(force);
        for name in ["explicit-euler", "rk4", "rk8"] {
            for watch in [Watch::EveryStep, Watch::AtSamples, Watch::Never] {
                let error =
                    run(name, &body, [4.0, 10.0, -3.0], 8.0).watching(watch).advance_to(10_000).unwrap_err();
                // the last state may be finite in the solver frame only
                let diverged = matches!(error, RunError::Diverged { .. } | RunError::OutOfRange { .. });
                assert!(diverged, "{name}, {watch}: {error}");
            }
        }
    }
}

/// A drag that would stop the body twice over in a step.
#[test]
fn an_implicit_step_that_a_torque_leaves_unsolved_is_refused() {
    let body = Body::free(inertia([1.0, 2.0, 2.5])).with(Force::drag(1.0, 0.0).unwrap());
    let after = |h| run("implicit-midpoint", &body, [1.0, 0.1, 0.1], h).advance_to(1);
    assert!(after(0.2).is_ok());
    let error = after(1.9).unwrap_err();
    assert!(matches!(error, RunError::Unsolved { residual, .. } if residual > 1e-6), "{error}");
}

#[test]
fn a_potential_whose_energy_alone_is_not_finite_is_named() {
    let hole = Force::potential_fn("hole", |q| (0.5 - q.w.abs()).sqrt(), |_| Vector3::zeros());
    let body = Body::free(inertia([10.0, 20.0, 30.0])).with(hole);
    let turned = UnitQuaternion::from_axis_angle(&Vector3::z_axis(), 2.5);
    let start = body.state(turned, [0.0, 0.0, 1.0].into()).unwrap();
    let error = Run::new(&method("rk4").unwrap(), &body, &start, 0.1).unwrap().advance_to(1000).unwrap_err();
    assert!(error.to_string().starts_with("hole is not finite at t = "), "{error}");
}

#[test]
fn parameters_that_no_force_has_are_refused() {
    let refused = |result: Result<Force, ForceError>| result.map(|_| ()).unwrap_err().to_string();
    assert_eq!(
        refused(Force::drag(-0.1, 0.0)),
        "c1 of the drag is -0.1; drag takes energy from the body, so its coefficients must not be negative: change the sign"
    );
    assert_eq!(
        refused(Force::gravity_gradient(0.001, 1.0)),
        "the eccentricity is 1; that of an elliptic orbit is in [0, 1), and 0 is a circle; give a parabola or a hyperbola by its periapsis distance"
    );
    assert!(Force::gravity_gradient(0.001, -0.1).is_err());
    assert!(Force::gravity_gradient(0.001, f64::NAN).is_err());
    assert_eq!(
        refused(Force::gravity_gradient(f64::INFINITY, 0.0)),
        "the mean motion of the orbit is inf; it must be a finite number"
    );
    assert!(Force::constant_torque_body(Vector3::new(0.0, f64::NAN, 0.0)).is_err());
    assert!(Force::constant_torque_space(Vector3::new(0.0, f64::INFINITY, 0.0)).is_err());
    assert_eq!(
        refused(Force::gravity(Vector3::new(0.0, f64::NAN, 0.0))),
        "a component of the weight moment of the uniform gravity is NaN; it must be a finite number"
    );
}

/// The place on the hyperbola of the fixture at the time t, by Kepler's equation.
fn on_the_hyperbola([gm, q, e]: [f64; 3], t: f64) -> [f64; 3] {
    let a = q / (e - 1.0);
    let mean = (t - 3.0) * (gm / (a * a * a)).sqrt();
    let mut f = libm::asinh(mean / e);
    for _ in 0..60 {
        f -= (e * libm::sinh(f) - f - mean) / (e * libm::cosh(f) - 1.0);
    }
    let across = a * (e * e - 1.0).sqrt() * libm::sinh(f);
    let turn = |axis: Vector3<f64>, angle: f64| Rotation3::from_scaled_axis(axis * angle);
    let plane = turn(Vector3::z(), 0.4) * turn(Vector3::x(), 0.9) * turn(Vector3::z(), -1.3);
    (plane * Vector3::new(a * (e - libm::cosh(f)), across, 0.0)).into()
}

#[test]
fn an_orbit_on_a_table_moves_the_body_as_the_conic_does() {
    let parameters = [2.0, 1.5, 4.25];
    let fixture = fixtures().into_iter().find(|one| one.name == format!("conic {parameters:?}")).unwrap();
    let mut before = f64::INFINITY;
    for rows in [40, 80, 160, 320] {
        let times: Vec<f64> = (0..=rows).map(|k| 8.0 * f64::from(k) / f64::from(rows)).collect();
        let places: Vec<[f64; 3]> = times.iter().map(|t| on_the_hyperbola(parameters, *t)).collect();
        let orbit = Orbit::table(parameters[0], &times, &places).unwrap();
        let estimate = orbit.interpolation_error().unwrap();
        assert_eq!(orbit.span(), Some([0.0, 8.0]));
        let body = Body::free(fixture.body.inertia().clone()).with(Force::gravity_gradient_on(orbit));
        let on_table = Fixture { body, name: String::new(), ..fixture };
        let error = errors(&on_table, &method("kick-drift@srkn-6b").unwrap(), 2560);
        println!("{rows} rows: {error:.1e}, estimate {estimate:.1e}");
        // through eight rows the error falls by 2^8 with half the interval, until steps or doubles end it
        assert!(error < before / 64.0 || error < 1e-11, "{rows} rows: {error:.1e} after {before:.1e}");
        assert!(error < 30.0 * estimate, "{rows} rows: {error:.1e}, estimate {estimate:.1e}");
        before = error;
        if rows == 320 {
            assert!(error < 1e-10, "{error:.1e}");
        }
    }
}

#[test]
fn tables_of_orbits_are_refused_by_their_law() {
    let times: Vec<f64> = (0..9).map(f64::from).collect();
    let places: Vec<[f64; 3]> = times.iter().map(|t| [10.0, *t, 0.0]).collect();
    let refused = |gm: f64, times: &[f64], places: &[[f64; 3]]| {
        Orbit::table(gm, times, places).unwrap_err().to_string()
    };
    assert!(refused(0.0, &times, &places).contains("must be positive"));
    assert!(refused(1.0, &times[..7], &places[..7]).contains("needs at least 8 of each"));
    assert!(refused(1.0, &times, &places[..8]).contains("9 times and 8 positions"));
    let twice = [0.0, 1.0, 2.0, 2.0, 4.0, 5.0, 6.0, 7.0, 8.0];
    assert!(refused(1.0, &twice, &places).contains("2 s follows 2 s"));
    let mut wrong = places.clone();
    wrong[4] = [0.0; 3];
    assert!(refused(1.0, &times, &wrong).contains("distance"));
    wrong[4] = [f64::NAN, 0.0, 0.0];
    assert!(refused(1.0, &times, &wrong).contains("finite"));
    // a circle of which half a revolution is missing
    let angles = [0.0, 0.1, 0.2, 0.3, 3.3, 3.4, 3.5, 3.6, 3.7];
    let circle = angles.map(|angle| [libm::cos(angle), libm::sin(angle), 0.0]);
    assert!(
        refused(1.0, &angles, &circle).contains("between 0.3 s and 3.3 s"),
        "{}",
        refused(1.0, &angles, &circle)
    );
    // a run that leaves the table ends there
    let orbit = Orbit::table(1.0, &times, &places).unwrap();
    let body = Body::free(inertia([1.0, 2.0, 2.5])).with(Force::gravity_gradient_on(orbit));
    let mut leaving = run("rk4", &body, [0.3, 1.0, -0.4], 0.125);
    assert!(leaving.advance_to(60).is_ok());
    let error = leaving.advance_to(80).unwrap_err().to_string();
    assert!(error.contains("gravity gradient"), "{error}");
}

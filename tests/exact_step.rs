//! The exact motion in steps: against fixtures of 36 digits and the closed form in double-double, in every regime.

use crate::fixtures::{PUBLISHED, free_body};
use polhode::body::{Body, Clock, Point, State, Time};
use polhode::flow::FreeMotion;
use polhode::inertia::Inertia;
use polhode::method::{AnyMethod, ExactStep, Step};
use polhode::num::{Dd, Real};
use polhode::observe::Invariants;
use polhode::rotation::{Quat, Vec3, rotation_angle};

/// A run and the closed form of its start.
struct Following {
    body: Body,
    h: f64,
    exact: FreeMotion,
    step: Box<dyn Step<f64>>,
    point: Point<f64>,
    start: Invariants,
}

/// Largest errors so far: attitude as a quaternion, momentum over |m|, energy and |m| relative.
#[derive(Clone, Copy, Debug, Default)]
struct Worst {
    attitude: f64,
    momentum: f64,
    energy: f64,
    norm: f64,
}

fn invariants(body: &Body, x: &Point<f64>) -> Invariants {
    Invariants::of(body, Time::from_seconds(0.0), x)
}

impl Following {
    fn new(moments: [f64; 3], m: [f64; 3], h: f64) -> Self {
        Self::from_attitude([0.5, -0.5, 0.5, 0.5], moments, m, h)
    }

    fn from_attitude(attitude: [f64; 4], moments: [f64; 3], m: [f64; 3], h: f64) -> Self {
        let body = Body::free(Inertia::from_moments(moments).unwrap());
        let attitude = Quat::from_components(attitude);
        let start = body.enter(&State { attitude, momentum_body: Vec3(m) }).unwrap().to_f64();
        let exact = FreeMotion::from_point(body.inertia(), start.to_dd());
        let mut step = ExactStep.prepare_f64(Clock::new(h), &body).unwrap();
        let mut point = start;
        step.open(&mut point);
        let start = invariants(&body, &start);
        Following { body, h, exact, step, point, start }
    }

    /// Takes `steps` steps.
    fn advance(&mut self, steps: u64) {
        self.step.advance(&mut self.point, steps);
    }

    /// Signed relative errors of energy and |m|.
    fn signed(&self) -> [f64; 2] {
        let now = invariants(&self.body, &self.point);
        let relative = |now: Dd, start: Dd| {
            if start == Dd::ZERO { now.hi() } else { ((now - start) / start).hi() }
        };
        [relative(now.energy, self.start.energy), relative(now.momentum_norm(), self.start.momentum_norm())]
    }

    /// Takes `steps` steps and looks at every seventh: so at each place between two renewals.
    fn worst(&mut self, steps: u64) -> Worst {
        let mut worst = Worst::default();
        for _ in 0..steps / 7 {
            self.advance(7);
            let t = Dd::of(self.h) * Dd::from(self.point.steps());
            let (x, exact) = (self.point.to_dd(), self.exact.point_at_dd(t));
            let size = exact.momentum_body.norm().hi().max(f64::MIN_POSITIVE); // at rest there is none
            let attitude = (x.attitude - exact.attitude).magnitude();
            let momentum = (x.momentum_body - exact.momentum_body).magnitude() / size;
            let [energy, norm] = self.signed();
            // f64::max would drop a NaN
            assert!([attitude, momentum, energy, norm].iter().all(|error| !error.is_nan()), "{x:?}");
            worst.attitude = worst.attitude.max(attitude);
            worst.momentum = worst.momentum.max(momentum);
            worst.energy = worst.energy.max(energy.abs());
            worst.norm = worst.norm.max(norm.abs());
        }
        worst
    }
}

/// Follows a run and asserts what is promised of any.
fn assert_exact(moments: [f64; 3], m: [f64; 3], h: f64) {
    let worst = Following::new(moments, m, h).worst(1400);
    let name = format!("{moments:?}, {m:?}, h = {h}: {worst:?}");
    assert!(worst.attitude < 1e-14 && worst.momentum < 5e-15, "{name}");
    assert!(worst.energy < 2e-15 && worst.norm < 1e-15, "{name}");
}

/// Starts of all regimes by the size of what is small, in half decades.
fn half_decades() -> impl Iterator<Item = f64> {
    (-32..=0).map(|half| libm::exp10(0.5 * f64::from(half)))
}

#[test]
fn the_dyadic_body_is_followed_for_eight_million_steps() {
    for case in free_body(PUBLISHED).into_iter().filter(|c| c.scenario == "E2" && c.t <= 1e6) {
        let mut run = Following::from_attitude(case.attitude, case.moments, case.start, 0.125);
        let steps = (case.t / 0.125) as u64;
        run.advance(steps - steps.min(70));
        // also between two renewals, not only at one
        let worst = run.worst(steps.min(70));
        run.advance(steps - run.point.steps());
        let attitude = rotation_angle(run.point.to_dd().attitude, Quat::from_components(case.result)).hi();
        let momentum = (run.point.to_dd().momentum_body - Vec3(case.momentum)).magnitude();
        println!("t = {:e}: attitude {attitude:.1e} rad, momentum {momentum:.1e}; before, {worst:?}", case.t);
        assert!(attitude < 5e-15 && momentum < 5e-15, "t = {:e}: {attitude:.1e}, {momentum:.1e}", case.t);
        assert!(worst.attitude < 1e-14 && worst.energy < 5e-16, "t = {:e}: {worst:?}", case.t);
    }
}

/// All orders of the axes, and with that both regimes; steps up to several turns, and backwards.
#[test]
fn every_order_of_axes_and_every_step_is_exact() {
    for (moments, m) in [
        ([0.625, 0.75, 1.0], [1.75, 0.375, -0.875]),
        ([1.0, 2.0, 3.0], [0.4, 2.0, -0.9]),
        ([1.0, 2.0, 2.5], [0.1, -0.2, 1.0]),
    ] {
        for [i, j, k] in [[0, 1, 2], [1, 2, 0], [2, 0, 1], [0, 2, 1], [2, 1, 0], [1, 0, 2]] {
            let ordered = |v: [f64; 3]| [v[i], v[j], v[k]];
            for h in [1e-6, 0.01, 0.125, 0.5, 0.6, 1.0, 2.0, 5.0, 1e4, -0.125, -2.0] {
                assert_exact(ordered(moments), ordered(m), h);
            }
        }
    }
}

#[test]
fn it_is_exact_next_to_the_separatrix_and_next_to_steady_turns() {
    for e in half_decades() {
        assert_exact([1.0, 2.0, 3.0], [0.0, 2.0, e], 0.1);
        assert_exact([1.0, 2.0, 2.5], [e, 1.0, 0.3 * e], 0.2);
        assert_exact([2.5, 2.0, 1.0], [0.3 * e, -1.0, e], 0.2);
        assert_exact([1.0, 2.0, 2.5], [1.0, e, 0.3 * e], 0.1);
        assert_exact([1.0, 2.0, 2.5], [e, -e, 1.0], 0.1);
    }
}

#[test]
fn it_is_exact_for_nearly_symmetric_bodies_rods_and_plates() {
    for e in half_decades() {
        assert_exact([1.0, 1.0 + e, 1.6 + e], [0.5, 0.3, 1.0], 0.1);
        assert_exact([1.0, 1.0 + e, 1.6], [0.5, 0.3, 1e-6], 0.1);
        assert_exact([1.0, 1.0 + 0.7 * e, 1.0 + e], [0.5, 0.3, 1.0], 0.1);
        assert_exact([e, 1.0, 1.0 + 0.3 * e], [0.5 * e, 0.3, 1.0], 0.1);
        assert_exact([1.0, 1.0 + e, 2.0 + e], [0.5, 0.3, 1.0], 0.1);
    }
}

#[test]
fn bodies_that_do_not_tumble_are_exact_too() {
    for moments in [[1.0, 1.0, 1.6], [1.6, 1.0, 1.0], [1.0, 1.6, 1.0], [1.0, 1.0, 1.0]] {
        for h in [0.1, 3.0] {
            assert_exact(moments, [0.5, 0.3, 1.0], h);
            assert_exact(moments, [0.0, -0.3, 0.0], h);
        }
    }
    for m in [[0.7, 0.0, 0.0], [0.0, 0.7, 0.0], [0.0, 0.0, -0.7], [0.0; 3]] {
        assert_exact([1.0, 2.0, 2.5], m, 0.1);
        assert_exact([1.0, 2.0, 2.5], m, 30.0);
    }
    for size in [1e-100, 1e-40, 1e40, 1e100] {
        assert_exact([1.0, 2.0, 2.5], [size, -size, 0.5 * size], 0.1 / size);
        assert_exact([1.0, 2.0, 2.5], [size, 1e-3 * size, 1e-3 * size], 3.0 / size);
    }
}

/// Fractional parts of multiples of the powers of the inverse of the root of x⁷ = x + 1: a quasi-random sequence.
fn spread(n: u32) -> [f64; 6] {
    let mut share = 1.0;
    [(); 6].map(|()| {
        share /= 1.112_775_684_278_705_5;
        (0.5 + share * f64::from(n)).fract()
    })
}

/// The errors of energy and |m| that rounding leaves have either sign, and are those of one step.
#[test]
fn energy_and_momentum_of_64_bodies_have_no_bias_after_a_hundred_thousand_steps() {
    let mut errors = [Vec::new(), Vec::new()];
    for n in 0..64 {
        let [d1, d2, d3, z, turn, size] = spread(n);
        let (sin, cos) = Real::sin_cos(core::f64::consts::TAU * turn);
        let (z, norm) = (2.0 * z - 1.0, 0.5 + size);
        let across = (1.0 - z * z).sqrt();
        // of any body each moment is the sum of two of three positive numbers
        let (moments, m) = ([d2 + d3, d1 + d3, d1 + d2], [across * cos, across * sin, z].map(|m| m * norm));
        let fastest = (0..3).map(|k| (m[k] / moments[k]).abs()).fold(0.0, f64::max);
        let mut run = Following::new(moments, m, 0.2 / fastest);
        run.advance(100_003);
        for (errors, error) in errors.iter_mut().zip(run.signed()) {
            errors.push(error);
        }
    }
    for (what, errors) in ["energy", "|m|"].iter().zip(&errors) {
        let count = errors.len() as f64;
        let mean = errors.iter().sum::<f64>() / count;
        let rms = (errors.iter().map(|error| error * error).sum::<f64>() / count).sqrt();
        println!("{what}: mean {mean:.1e}, rms {rms:.1e}");
        // 64 signs scatter by an eighth
        assert!(rms < 2.5e-16 && mean.abs() < 0.4 * rms, "{what}: mean {mean:.1e}, rms {rms:.1e}");
    }
}

/// A point that has taken fewer steps than the one that was opened begins an orbit of its own.
#[test]
fn an_earlier_point_is_moved_as_one_that_was_opened() {
    let body = Body::free(Inertia::from_moments([1.0, 2.0, 3.0]).unwrap());
    let state = State { attitude: Quat::identity(), momentum_body: Vec3([0.4, 2.0, -0.9]) };
    let start = body.enter(&state).unwrap().to_f64();
    let prepared = || ExactStep.prepare_f64(Clock::new(0.1), &body).unwrap();
    let (mut step, mut late) = (prepared(), start);
    step.steps(&mut late, 100);
    step.open(&mut late);
    let (mut other, mut early, mut alone) = (prepared(), start, start);
    step.advance(&mut early, 10);
    other.open(&mut alone);
    other.advance(&mut alone, 10);
    assert_eq!(early, alone);
}

/// In double-double the same steps are good to its digits, so that the rational map itself is exact.
#[test]
fn the_map_is_exact_in_double_double() {
    for (moments, m, h) in [
        ([0.625, 0.75, 1.0], [1.75, 0.375, -0.875], 0.125),
        ([1.0, 2.0, 3.0], [0.4, 2.0, -0.9], 0.5),
        ([3.0, 1.0, 2.5], [-0.4, 0.2, 1.9], 1.0),
        ([1.0, 2.0, 2.5], [1.0, 1e-8, 1e-9], 0.3),
    ] {
        let body = Body::free(Inertia::from_moments(moments).unwrap());
        let start = body.enter(&State { attitude: Quat::identity(), momentum_body: Vec3(m) }).unwrap();
        let mut step = ExactStep.prepare_dd(Clock::new(h), &body).unwrap();
        let mut x = start;
        // the last step before the closed form is taken again
        step.steps(&mut x, 63);
        let exact = FreeMotion::from_point(body.inertia(), start).point_at_dd(Dd::of(h) * 63.0);
        let off = (x.momentum_body - exact.momentum_body).magnitude();
        let apart = (x.attitude - exact.attitude).magnitude();
        assert!(off < 1e-28 && apart < 1e-28, "{moments:?}, {m:?}: {off:.1e}, {apart:.1e}");
    }
}

//! What rounding in double precision adds to quantities that are kept: a random walk, not a drift.

use polhode::body::{Body, Clock, Point, Time};
use polhode::inertia::Inertia;
use polhode::method::{AnyMethod, method};
use polhode::num::{Dd, Real};
use polhode::rotation::{Quat, Vec3};

/// A symmetric body with a fixed point: moments (kg m²), axis of symmetry, weight moment along it (N m), spin (rad/s) and
/// the step (s) with which it is followed.
struct Top {
    moments: [f64; 3],
    axis: usize,
    weight_moment: f64,
    spin: f64,
    h: f64,
}

/// Brüls and Cardona's, J. Comput. Nonlinear Dyn. 5 (2010) 031002.
const BRULS_CARDONA: Top =
    Top { moments: [15.234375, 0.46875, 15.234375], axis: 1, weight_moment: 147.15, spin: 150.0, h: 0.0005 };

/// Simo and Wong's, Int. J. Numer. Methods Eng. 31 (1991) 19.
const SIMO_WONG: Top = Top { moments: [5.0, 5.0, 1.0], axis: 2, weight_moment: 20.0, spin: 50.0, h: 0.003 };

const SLENDER: Top = Top { moments: [1.0, 1.0, 0.3], axis: 2, weight_moment: 1.7, spin: 20.0, h: 0.01 };

impl Top {
    fn body(&self) -> Body {
        let weight_moment = self.along(self.weight_moment);
        Body::heavy(Inertia::from_moments(self.moments).unwrap(), weight_moment.into()).unwrap()
    }

    fn along(&self, x: f64) -> [f64; 3] {
        let mut vector = [0.0; 3];
        vector[self.axis] = x;
        vector
    }

    /// One start out of many: all with the same spin, tilted and nutating in their own way.
    fn start(&self, member: u32) -> Point<f64> {
        let (sin, cos) = Real::sin_cos(0.37 * f64::from(member));
        let attitude = Quat::from_components([1.0, 0.8 * sin, 0.5 * cos, 0.6 * sin * cos]).normalized();
        let mut omega = [0.3 * cos, 0.2 * sin, 0.4 * cos - 0.3 * sin];
        omega[self.axis] = self.spin;
        self.body().enter_omega(Quat::of(attitude), Vec3(omega)).unwrap().to_f64()
    }

    /// What rounding makes of the energy and of L_z in `steps` steps, relative to the energy and to |L|.
    fn rounding(&self, method: &dyn AnyMethod, member: u32, steps: u64) -> [f64; 2] {
        let (body, start) = (self.body(), self.start(member));
        let (mut rounded, mut exact) = (start, start.to_dd());
        method.prepare_f64(Clock::new(self.h), &body).unwrap().steps(&mut rounded, steps);
        method.prepare_dd(Clock::new(self.h), &body).unwrap().steps(&mut exact, steps);
        let rounded = rounded.to_dd();
        let energy = |x| body.energy_of(Time::from_seconds(0.0), x);
        let l_z = rounded.momentum_space()[2] - exact.momentum_space()[2];
        [((energy(&rounded) - energy(&exact)) / energy(&exact)).hi(), (l_z / exact.momentum_body.norm()).hi()]
    }
}

/// Tops of the same spin turn about their axis by the same angle in every step, so that a bias of its sine and cosine would
/// move all of them one way.
#[test]
#[ignore = "an ensemble: takes seconds, `.ci/run` does it"]
fn rounding_moves_tops_of_an_ensemble_either_way() {
    const MEMBERS: u32 = 64;
    let method = method("kick-drift").unwrap();
    for top in [BRULS_CARDONA, SIMO_WONG, SLENDER] {
        let errors: Vec<[f64; 2]> = (0..MEMBERS).map(|n| top.rounding(&method, n, 10_000)).collect();
        for (k, what) in ["energy", "L_z"].into_iter().enumerate() {
            let average =
                |f: fn(f64) -> f64| errors.iter().map(|e| f(e[k])).sum::<f64>() / f64::from(MEMBERS);
            let (mean, rms) = (average(|e| e), average(|e| e * e).sqrt());
            assert!(mean.abs() <= 0.4 * rms, "{:?}: {what} moves by {mean:.1e}, rms {rms:.1e}", top.moments);
            assert!(rms > 1e-19, "{:?}: {what} moves by {rms:.1e} only", top.moments);
        }
    }
}

/// What rounding makes of |m|, and of the energy where the method keeps it, over 64 asymmetric bodies.
#[test]
#[ignore = "an ensemble: takes seconds, `.ci/run` does it"]
fn rounding_moves_free_bodies_of_an_ensemble_either_way() {
    const MEMBERS: u32 = 64;
    for (name, keeps_energy) in [
        ("two-turn", false),
        ("lie-poisson", false),
        ("rattle", true),
        ("dmv:10", true),
        ("exact-step", true),
    ] {
        let method = method(name).unwrap();
        let mut errors: [Vec<f64>; 2] = Default::default();
        for member in 0..MEMBERS {
            // multiples of the golden section modulo 1: bodies of every shape, momenta of every direction
            let number = |k: u32| (f64::from(7 * member + k) * 0.618_033_988_749_894_9).fract();
            let second = [1, 2, 3].map(|k| 0.1 + number(k));
            let moments = [second[1] + second[2], second[2] + second[0], second[0] + second[1]];
            let body = Body::free(Inertia::from_moments(moments).unwrap());
            let momentum = Vec3([4, 5, 6].map(|k| 2.0 * number(k) - 1.0));
            let start = Point::new(Quat::identity(), momentum);
            let mut x = start;
            method.prepare_f64(Clock::new(0.015_625), &body).unwrap().steps(&mut x, 100_000);
            let (before, after) = (start.to_dd(), x.to_dd());
            let change = |f: &dyn Fn(&Point<Dd>) -> Dd| ((f(&after) - f(&before)) / f(&before)).hi();
            errors[0].push(change(&|x| x.momentum_body.norm()));
            errors[1].push(change(&|x| body.energy_of(Time::from_seconds(0.0), x)));
        }
        for (errors, what) in errors.iter().zip(["|m|", "energy"]).take(1 + usize::from(keeps_energy)) {
            let average = |f: fn(f64) -> f64| errors.iter().map(|e| f(*e)).sum::<f64>() / f64::from(MEMBERS);
            let (mean, rms) = (average(|e| e), average(|e| e * e).sqrt());
            assert!(mean.abs() <= 0.4 * rms, "{name}: {what} moves by {mean:.1e}, rms {rms:.1e}");
            assert!(rms < 5e-16, "{name}: {what} walks by {rms:.1e}");
        }
    }
}

/// With sine and cosine rounded to one double each it drifts by 4e-13.
#[test]
fn rounding_of_a_top_walks_for_two_million_steps() {
    let (top, steps) = (BRULS_CARDONA, 2_000_000);
    let omega = Vec3([0.0, 150.0, -4.61538]);
    let body = top.body();
    let start = body.enter_omega(Quat::identity(), omega).unwrap().to_f64();
    let mut x = start;
    method("kick-drift").unwrap().prepare_f64(Clock::new(top.h), &body).unwrap().steps(&mut x, steps);
    let l_z = |x: Point<f64>| x.to_dd().momentum_space()[2];
    let moved = ((l_z(x) - l_z(start)) / start.to_dd().momentum_body.norm()).hi();
    assert!(moved.abs() < 2e-14, "L_z moves by {moved:.1e}");
    assert!(moved != 0.0);
}

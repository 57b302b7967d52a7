//! The closed form against central differences of the motion in double-double, over random bodies near every degenerate case.
//!
//! It cannot see an error next to the separatrix that is smaller than what differences of 106 bits leave uncertain there: that is
//! left to the fixtures of mpmath (`experiments/data/derivative.csv`). Cases of which a difference knows less than 10⁻¹⁴ are counted.

use core::array::from_fn;

use super::variation::{Columns, PAIRS};
use crate::body::Point;
use crate::flow::free::FreeOrbit;
use crate::num::{Dd, Precise, Random, Real};
use crate::rotation::{Quat, Vec3};

const PROMISE: f64 = 1e-13;

#[derive(Clone, Copy, Debug)]
struct Case {
    moments: [f64; 3],
    omega: [f64; 3],
    t: f64,
}

impl Case {
    fn momentum(&self) -> Vec3<Dd> {
        Vec3(from_fn(|k| Dd::product(self.moments[k], self.omega[k])))
    }

    fn orbit(&self) -> FreeOrbit {
        FreeOrbit::new(Vec3(self.moments.map(Dd::of)), Point::new(attitude(), self.momentum()))
    }

    fn columns(&self) -> Columns {
        let orbit = self.orbit();
        let t = Dd::of(self.t);
        orbit.variation().at(t, attitude().map(Dd::hi), orbit.at(t).attitude)
    }
}

fn attitude() -> Quat<Dd> {
    Quat::from_components([0.5, -0.3, 0.7, 0.1].map(Dd::of)).normalized()
}

/// The end of the motion when the momentum and the tensor are changed by the column `n` times `e`.
fn end(case: &Case, n: usize, e: Dd) -> (Quat<Dd>, Vec3<Dd>) {
    let (mut moments, mut m, mut turn) =
        (Vec3(case.moments.map(Dd::of)), case.momentum(), Quat::<Dd>::identity());
    if n < 3 {
        m[n] = m[n] + e;
    } else if n < 6 {
        moments[n - 3] = moments[n - 3] + e;
    } else {
        let [i, j, k] = PAIRS[n - 6];
        let (half, mean) = ((moments[i] - moments[j]) * 0.5, (moments[i] + moments[j]) * 0.5);
        let root = (half * half + e * e).sqrt();
        // the turn by less than 45° that diagonalises
        let (sign, root) = if half < Dd::ZERO { (-Dd::ONE, -root) } else { (Dd::ONE, root) };
        let angle = (e * sign).atan2(half * sign) * 0.25;
        (moments[i], moments[j]) = (mean + root, mean - root);
        let (sin, cos) = angle.sin_cos();
        let cyclic = if (i + 1) % 3 == j { Dd::ONE } else { -Dd::ONE };
        turn = Quat::new(cos, Vec3::unit(k) * (sin * cyclic));
        m = turn.rotate_back(m);
    }
    let x = FreeOrbit::new(moments, Point::new(attitude() * turn, m)).at_dd(Dd::of(case.t));
    (x.attitude * turn.conjugate(), turn.rotate(x.momentum_body))
}

/// The six rates of change by central differences of the size `e`.
fn difference(case: &Case, n: usize, e: Dd) -> [Dd; 6] {
    let ((q1, m1), (q2, m2)) = (end(case, n, e), end(case, n, -e));
    let twice = Dd::ONE / (e * 2.0);
    let q2 = if (q1.w * q2.w + q1.v.dot(q2.v)).hi() < 0.0 { -q2 } else { q2 };
    // rotation vector of q1 q2*, which is small
    let turn = (q1 * q2.conjugate()).v;
    let m = (m1 - m2) * twice;
    let turn = turn * (twice * 2.0);
    [turn[0], turn[1], turn[2], m[0], m[1], m[2]]
}

fn random_case(random: &mut Random) -> Case {
    let mut decades = |from: f64, to: f64| libm::exp10(random.between(from, to));
    let mass = [decades(-4.0, 0.0), decades(-4.0, 0.0), decades(-4.0, 0.0)];
    let mut moments = [mass[1] + mass[2], mass[0] + mass[2], mass[0] + mass[1]];
    let splits = [1.0 + decades(-16.0, -1.0), 1.0 + decades(-16.0, -1.0)];
    let near = [decades(-15.0, 0.0), decades(-15.0, 0.0), decades(-16.0, -1.0)];
    let t = decades(-2.0, 9.0);
    match random.below(4) {
        0 => moments[1] = moments[0] * splits[0],
        1 => moments = [moments[0], moments[0] * splits[0], moments[0] * splits[1]],
        _ => {}
    }
    moments.rotate_left(random.below(3) as usize);
    let largest = moments.iter().fold(0.0, |a: f64, &b| a.max(b));
    let moments = moments.map(|i| i / largest);
    let mut omega = from_fn(|_| random.between(-1.0, 1.0));
    let axis = random.below(3) as usize;
    match random.below(3) {
        0 => {
            omega[axis] *= near[0];
            omega[(axis + 1) % 3] *= near[1];
        }
        1 => {
            let [l, mu, h] = Vec3(moments).ascending();
            let ratio = moments[l] * (moments[mu] - moments[l]) / (moments[h] * (moments[h] - moments[mu]));
            if ratio.is_finite() {
                omega[h] = omega[l] * ratio.sqrt() * (1.0 + near[2]);
            }
        }
        _ => {}
    }
    let norm = Vec3(from_fn(|k| moments[k] * omega[k])).norm();
    Case { moments, omega: omega.map(|w| w / norm), t: if random.below(2) == 0 { t } else { -t } }
}

/// Largest difference of two sets of columns and the largest entry.
fn gap(a: &Columns, b: impl Fn(usize, usize) -> f64) -> (f64, f64) {
    let (mut worst, mut largest) = (0.0_f64, 0.0_f64);
    for n in 0..9 {
        for k in 0..6 {
            let (value, other) = (entry(a, n, k), b(n, k));
            worst = if (value - other).is_nan() { f64::INFINITY } else { worst.max((value - other).abs()) };
            largest = largest.max(other.abs());
        }
    }
    (worst, largest)
}

fn entry(columns: &Columns, n: usize, k: usize) -> f64 {
    if k < 3 { columns.rotation[n][k] } else { columns.momentum[n][k - 3] }
}

/// Error, uncertainty of the differences and condition, all relative to the largest entry.
fn judged(case: &Case) -> [f64; 3] {
    let found = case.columns();
    // phases change by this much: what the next order of Richardson's extrapolation leaves is some 1e-18
    let size = 1e-5 / (case.t.abs() / case.moments.iter().fold(1.0, |a: f64, &b| a.min(b))).max(1.0);
    let rough: [[Dd; 6]; 9] = from_fn(|n| {
        let wide = difference(case, n, Dd::of(size));
        let narrow = difference(case, n, Dd::of(0.5 * size));
        from_fn(|k| (narrow[k] * 4.0 - wide[k]) / 3.0)
    });
    let fine: [[Dd; 6]; 9] = from_fn(|n| {
        let wide = difference(case, n, Dd::of(0.25 * size));
        let narrow = difference(case, n, Dd::of(0.125 * size));
        from_fn(|k| (narrow[k] * 4.0 - wide[k]) / 3.0)
    });
    let (error, largest) = gap(&found, |n, k| fine[n][k].hi());
    let mut uncertain = 0.0_f64;
    for n in 0..9 {
        for k in 0..6 {
            uncertain = uncertain.max((rough[n][k] - fine[n][k]).magnitude());
        }
    }
    let mut condition = 0.0_f64;
    for n in 0..6 {
        let mut other = *case;
        let value = if n < 3 { &mut other.moments[n] } else { &mut other.omega[n - 3] };
        *value *= 1.0 + f64::EPSILON;
        let changed = other.columns();
        condition = condition.max(0.5 * gap(&found, |n, k| entry(&changed, n, k)).0);
    }
    [error / largest, uncertain / largest, condition / largest]
}

fn look_at(cases: usize, seed: u64) {
    let mut random = Random::new(seed);
    let (mut known, mut worst) = (0, [0.0_f64; 2]);
    for _ in 0..cases {
        let case = random_case(&mut random);
        let [error, uncertain, condition] = judged(&case);
        if uncertain > 1e-9 {
            continue; // nothing to compare with
        }
        let allowed = PROMISE + 4.0 * condition + 2.0 * uncertain;
        if error.is_nan() || error > allowed {
            panic!(
                "{case:?}: error {error:.1e}, differences known to {uncertain:.1e}, condition {condition:.1e}"
            );
        }
        if uncertain < 1e-14 {
            known += 1;
            worst[0] = worst[0].max(error);
            worst[1] = worst[1].max(error - 4.0 * condition);
        }
    }
    println!(
        "{known} of {cases} known; error {:.1e}, beyond four times the condition {:.1e}",
        worst[0], worst[1]
    );
    assert!(known * 10 > cases * 7, "{known} of {cases}");
}

#[test]
fn derivatives_agree_with_differences_in_double_double() {
    look_at(200, 1);
}

#[test]
#[ignore = "a hundred thousand bodies take an hour"]
fn derivatives_agree_with_differences_of_many_bodies() {
    look_at(100_000, 2);
}
